# SPDX-License-Identifier: GPL-2.0-or-later
"""What a command takes, in words, as its validators say it: each is asked to refuse something that
fits none.

So the unit and the bounds that the site shows are those that the check has
(:mod:`masonry.arguments`).
"""

import inspect
import re


#: A value that no validator takes.
ODD = type("Odd", (), {"__repr__": lambda self: "odd"})()


def _refusal(validator, value):
    """What a validator says against a value: nothing if it takes it, None if it cannot tell without
    a scene."""
    try:
        validator(value, None)
    except ValueError as error:
        return str(error)
    except Exception:  # it looks at the scene, which is not there
        return None
    return ""


def meaning(validator):
    """What a validator takes, as ``a number at least 0 Pa, or None``; an empty text if it takes
    anything."""
    said = _refusal(validator, ODD)
    if said is None:
        about = re.match(r"Validator of (.*?)\.?$", inspect.getdoc(validator) or "", re.S)
        return " ".join(about[1].split()) if about else ""
    text = said.partition(" must be ")[2]
    inside = _refusal(validator, [ODD, ODD, ODD])
    if "list" in text and inside and inside.startswith("(value"):
        text = f"{text}; each is {inside.partition(' must be ')[2]}"
    if said and _refusal(validator, lambda: None) == "" and text != "a function":
        text += ", or a function"
    return text + ", or None" * (said != "" and _refusal(validator, None) == "")
