# SPDX-License-Identifier: GPL-2.0-or-later
"""What a word takes, in words, as the word itself says it: a kind of argument is asked to refuse something that fits none.

So the unit and the bounds that the site shows are those that the check has (:mod:`masonry.common.arguments`).
"""

import inspect
import re


class _Odd:
    """A value that is of no kind."""

    def __repr__(self):
        return "odd"


ODD = _Odd()


def _refusal(kind, value):
    """What a kind says against a value, or None if it takes it or cannot tell without a scene."""
    try:
        kind(value, None)
    except ValueError as error:
        return str(error)
    except Exception:  # it looks at the scene, which is not there
        pass
    return None


def _takes(kind, value):
    try:
        kind(value, None)
    except Exception:
        return False
    return True


def meaning(kind):
    """What a kind takes, as ``a number at least 0 Pa, or None``; an empty text if the kind takes anything."""
    said = _refusal(kind, ODD)
    if said is None:
        about = inspect.getdoc(kind) or ""
        found = re.match(r"The kind of (.*?)\.?$", about, re.S)
        return "" if _takes(kind, ODD) or not found else " ".join(found[1].split())
    text = said.partition(" must be ")[2]
    inside = _refusal(kind, [ODD, ODD, ODD])
    if "list" in text and inside and inside.startswith("(value"):
        text = f"{text}; each is {inside.partition(' must be ')[2]}"
    if _takes(kind, lambda: None) and text != "a function":
        text += ", or a function"
    if _takes(kind, None):
        text += ", or None"
    return text
