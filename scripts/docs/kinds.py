# SPDX-License-Identifier: GPL-2.0-or-later
"""What a word takes, in words, as the word itself says it: a kind of argument is asked to refuse
something that fits none.

So the unit and the bounds that the site shows are those that the check has
(:mod:`masonry.arguments`).
"""

import inspect
import re


#: A value that is of no kind.
ODD = type("Odd", (), {"__repr__": lambda self: "odd"})()


def _refusal(kind, value):
    """What a kind says against a value: nothing if it takes it, None if it cannot tell without a
    scene."""
    try:
        kind(value, None)
    except ValueError as error:
        return str(error)
    except Exception:  # it looks at the scene, which is not there
        return None
    return ""


def meaning(kind):
    """What a kind takes, as ``a number at least 0 Pa, or None``; an empty text if the kind takes
    anything."""
    said = _refusal(kind, ODD)
    if said is None:
        found = re.match(r"Validator of (.*?)\.?$", inspect.getdoc(kind) or "", re.S)
        return " ".join(found[1].split()) if found else ""
    text = said.partition(" must be ")[2]
    inside = _refusal(kind, [ODD, ODD, ODD])
    if "list" in text and inside and inside.startswith("(value"):
        text = f"{text}; each is {inside.partition(' must be ')[2]}"
    if said and _refusal(kind, lambda: None) == "" and text != "a function":
        text += ", or a function"
    return text + ", or None" * (said != "" and _refusal(kind, None) == "")
