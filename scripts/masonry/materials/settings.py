# SPDX-License-Identifier: GPL-2.0-or-later
"""``--set NAME.PROPERTY=VALUE``: from its text to the property of a joint, a beam, a tie, springs
or a fibre layer."""

import copy
from typing import Any, Callable, NamedTuple

from ..arguments import nearest, number, shown
from ..errors import refuse

#: A function of x, y and z [m] that gives a factor [-].
Factor = Callable[[float, float, float], float]


class Property(NamedTuple):
    """Unit and bounds of a property of something settable; ``above``: it must be above ``low``."""

    unit: str
    low: float
    high: float
    above: bool = False

    @property
    def validator(self) -> Callable[..., Any]:
        return number(self.unit, self.low, self.high, above=self.above)


class Settable:
    """What ``--set`` and ``--field`` change beside joints; where it can vary, ``place()`` [m]."""

    WORD = "thing"  # in messages
    known: Any = {}  # its properties by name: Property

    def values(self):
        """Present values; None: not given."""
        return {name: getattr(self, name) for name in self.known}

    def copied(self):
        return copy.copy(self)

    def problems(self):
        return []

    def take(self, values):
        """Take checked values, by property."""
        vars(self).update(values)

    def updateAttrs(self, values):
        """Change properties. Raises ValueError with all problems."""
        problems = []
        for name, value in values.items():
            try:
                self.known[name].validator(value)
            except ValueError as error:
                problems.append(f"{name} {error}")
        if not problems:
            before = {n: v for n, v in self.values().items() if n in values}
            self.take(values)
            problems = self.problems()
            if problems:
                self.take(before)
        if problems:
            raise ValueError("\n".join(f"{self.name}: {one}" for one in problems))

    def scatter(self, name, factor):
        """Multiply a property by the value of a field. Raises ValueError."""
        if self.values()[name] is None:
            raise ValueError(f"{self.name}: {name} was not given, so nothing can vary about it")
        self.vary(name, factor)

    def vary(self, name, factor):
        """Multiply a property by the value of a field at its place."""
        self.updateAttrs({name: self.values()[name] * factor(*self.place())})


def matching(fits, what):
    """A validator of values for which ``fits`` is true; ``what`` names them in the error."""

    def take(value, context=None):
        if not fits(value):
            raise ValueError(f"{shown(value)} must be {what}")
        return value

    return take


def valuesOf(thing):
    """Values by property, of a joint or something settable."""
    return thing.values() if isinstance(thing, Settable) else thing.dict()


def scatterAll(connectors, names, factor):
    """Let properties vary by a field. Raises ValueError with all problems.

    :param connectors: ties, springs and fibre layers by name
    :param names: as ``"wire.strength"``; those of joints are skipped
    :param factor: :data:`Factor`
    """
    problems = []
    for one in names:
        name, _, attribute = one.partition(".")
        if name not in connectors:
            continue
        thing = connectors[name]
        try:
            if attribute not in thing.known:
                raise ValueError(_noSuch(one, thing, attribute))
            thing.scatter(attribute, factor)
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise ValueError("\n".join(problems))


def _noSuch(what, thing, attribute):
    return (
        f"{what}: a {thing.WORD} has no such property, there are"
        f" {', '.join(thing.known)}{nearest(attribute, thing.known)}"
    )


def setting(text):
    """The joint, the property and the text of the value of ``--set``. Raises ValueError."""
    target, equals, value = text.partition("=")
    joint, _, attribute = target.partition(".")
    if not (equals and joint and attribute):
        raise ValueError(
            f"'{text}' must read JOINT.PROPERTY=VALUE, for example bed.tensileStrength=2e5"
        )
    return joint, attribute, value


def applySettings(joints, settings):
    """Set values of ``--set``. Raises Refused with all problems.

    :param joints: MasonryJoint and :class:`Settable` by name
    :param settings: list of (joint, property, text of the value)
    """
    problems, changes = [], {}
    for name, attribute, text in settings:
        what, thing = f"--set {name}.{attribute}", joints.get(name)
        if thing is None:
            more = any(isinstance(one, Settable) for one in joints.values())
            kinds = "joint, beam, tie, spring or fibre layer" if more else "joint"
            problems.append(f"{what}: no {kinds} '{name}', there are {', '.join(joints)}")
            continue
        values = valuesOf(thing)
        if isinstance(thing, Settable) and attribute not in values:
            problems.append(_noSuch(what, thing, attribute))
        elif attribute not in values or attribute in ("name", "jointSet", "direction"):
            close = [a for a in values if a.lower() == attribute.lower()]
            hint = f", did you mean {close[0]}?" if close else ""
            problems.append(f"{what}: a MasonryJoint has no such property{hint}")
        else:
            try:
                found = _value(text, values[attribute])
                changes.setdefault(name, {})[attribute] = found
            except ValueError:
                kind = KINDS.get(type(values[attribute]), "a number")
                problems.append(f"{what}={text}: must be {kind}")
    for name, change in changes.items():
        joint, of = joints[name], "--set "
        if not isinstance(joint, Settable):
            of = ""
            if "friction" in change and joint.residualFriction == joint.friction:
                # joints with one value of friction keep one
                change.setdefault("residualFriction", change["friction"])
        try:
            joint.updateAttrs(change)
        except ValueError as error:
            problems += [of + line for line in str(error).splitlines()]
    refuse(problems)


#: What values must be that are no numbers, by type.
KINDS = {bool: "on or off", list: "rows as ratio:damage,ratio:damage,..."}
SWITCH = {"on": True, "true": True, "1": True, "off": False, "false": False, "0": False}


def _value(text, example):
    if isinstance(example, bool):
        if text.lower() not in SWITCH:
            raise ValueError(text)
        return SWITCH[text.lower()]
    if isinstance(example, list):
        rows = [tuple(map(float, row.split(":"))) for row in text.split(",")]
        if any(len(row) != 2 for row in rows):
            raise ValueError(text)
        return rows
    return float(text)
