# SPDX-License-Identifier: GPL-2.0-or-later
"""Units of accelerations as files write them."""

import re

from ...arguments import shown
from ...units import ACCELERATION_UNITS as UNITS

#: How the units are written once blanks and signs are left out, see :func:`unitNamed`.
WRITTEN = {"m/s2": "m/s²", "ms-2": "m/s²", "cm/s2": "cm/s²", "cms-2": "cm/s²"}
WRITTEN |= {"gal": "cm/s²", "gals": "cm/s²", "g": "g", "g's": "g"}

_SECOND = r"\s*(?:sec|s)\b"
_SQUARE = r"\s*(?:sec|s)\s*(?:\^|\*\*)?\s*[2²]"
#: A length over the square of seconds, in any unit of length, or cm s-2.
_COMPOUND = rf"[a-z]+\s*/(?:{_SQUARE}|{_SECOND}\s*/{_SECOND})|[cm]?m[ .·]?(?:sec|s)\^?-2"
_COMPOUND += r"|\bgals?\b"
#: As free text has it: a number before it would be a peak.
_FREE = re.compile(rf"(?<![\d.])(?<![\d.] )\b(?:{_COMPOUND})", re.I)
_MARKED = re.compile(rf"(?:{_COMPOUND})|(?<![\w/])(?:m|milli-?)?g(?:'s)?(?![\w/])", re.I)


def unitNamed(word: str) -> str:
    """The key of UNITS that a word stands for. Raises ValueError."""
    plain = re.sub(r"[\s^()\[\].·]|\*\*", "", word.lower()).replace("sec", "s").replace("²", "2")
    found = WRITTEN.get(re.sub(r"/s/s$", "/s2", plain))
    if not found:
        raise ValueError(f"unit {shown(word.strip())} must be one of {', '.join(UNITS)}")
    return found


def unitSaid(text: str) -> str | None:
    """The unit of accelerations that a comment or a head says; None: it says none.

    Understood are a unit behind the word unit or units, in brackets, and cm/s² or Gal anywhere but
    behind a number.

    :raises ValueError: if it says one that is not known, or two
    """
    marked = re.search(r"\bunits?\b\s*(?:of|in|is|are)?\s*[:=]?\s*(.*)", text, re.I)
    if marked:
        words = _MARKED.findall(marked[1]) or [(marked[1].split() or [""])[0].rstrip(",;.")]
    else:
        bracketed = re.findall(r"[\[(]\s*([^\])]*?)\s*[\])]", text)
        words = [word for word in bracketed if _MARKED.fullmatch(word)] or _FREE.findall(text)
        if not words and re.search(r"\bacc", text, re.I):
            words = [word for word in bracketed if re.search(r"/\s*s|g$", word, re.I)]
    found = list(dict.fromkeys(map(unitNamed, words)))
    if len(found) > 1:
        raise ValueError(f"it says two units, {' and '.join(found)}")
    return found[0] if found else None
