# SPDX-License-Identifier: GPL-2.0-or-later
"""``--set JOINT.PROPERTY=VALUE``: from its text to the property of a joint."""

import argparse

from ..basics import Refused


def setting(text):
    """The joint, the property and the text of the value of ``--set``. Raises argparse.ArgumentTypeError."""
    target, equals, value = text.partition("=")
    joint, dot, attribute = target.partition(".")
    if not (equals and dot and joint and attribute):
        raise argparse.ArgumentTypeError(
            f"'{text}' must read JOINT.PROPERTY=VALUE, for example bed.tensileStrength=2e5"
        )
    return joint, attribute, value


def applySettings(joints, settings):
    """Give joints the values of ``--set``. Raises Refused with all problems at once.

    :param joints: dict of MasonryJoint by name
    :param settings: list of (joint, property, text of the value)
    """
    problems, changes = [], {}
    for name, attribute, text in settings:
        if name not in joints:
            problems.append(
                f"--set {name}.{attribute}: no joint '{name}', there are {', '.join(joints)}"
            )
            continue
        values = joints[name].dict()
        if attribute not in values or attribute in ("name", "jointSet", "direction"):
            close = [a for a in values if a.lower() == attribute.lower()]
            hint = f", did you mean {close[0]}?" if close else ""
            problems.append(
                f"--set {name}.{attribute}: a MasonryJoint has no such property{hint}"
            )
            continue
        try:
            changes.setdefault(name, {})[attribute] = _value(text, values[attribute])
        except ValueError:
            kind = {
                bool: "on or off",
                list: "rows as ratio:damage,ratio:damage,...",
            }.get(type(values[attribute]), "a number")
            problems.append(f"--set {name}.{attribute}={text}: must be {kind}")
    for name, change in changes.items():
        joint = joints[name]
        if joint.residualFriction == joint.friction and "friction" in change:
            # joints with one value of friction keep one
            change.setdefault("residualFriction", change["friction"])
        try:
            joint.updateAttrs(change)
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise Refused("\n".join(problems))


def _value(text, example):
    """The value that the text of a setting stands for, of the kind of ``example``. Raises ValueError if it is none."""
    if isinstance(example, bool):
        switches = {
            "on": True,
            "true": True,
            "1": True,
            "off": False,
            "false": False,
            "0": False,
        }
        if text.lower() not in switches:
            raise ValueError(text)
        return switches[text.lower()]
    if isinstance(example, list):
        rows = [tuple(float(v) for v in row.split(":")) for row in text.split(",")]
        if any(len(row) != 2 for row in rows):
            raise ValueError(text)
        return rows
    return float(text)
