# SPDX-License-Identifier: GPL-2.0-or-later
"""``--set NAME.PROPERTY=VALUE``: from its text to the property of a joint, a beam, a tie, springs or a fibre layer."""

from __future__ import annotations

from typing import Any, Callable, NamedTuple

from ..common.arguments import nearest, number
from ..basics import refuse


#: A function of x, y and z [m] that gives a factor [-].
Factor = Callable[[float, float, float], float]


class Property(NamedTuple):
    """A property of what is no joint: its unit and its bounds.

    :param above: whether it must be above ``low``, not at least
    """

    unit: str
    low: float
    high: float
    above: bool = False

    @property
    def kind(self) -> Callable[..., Any]:
        """The kind of its values, as in :mod:`masonry.common.arguments`."""
        return number(self.unit, self.low, self.high, above=self.above)


class Settable:
    """What ``--set`` and ``--field`` change beside joints. Classes have what raises NotImplementedError here."""

    WORD = "thing"  # what it is, in messages

    def known(self) -> dict[str, Property]:
        """Its properties by name."""
        raise NotImplementedError

    def values(self) -> dict[str, float | None]:
        """Their present values; None: it was not given."""
        raise NotImplementedError

    def copied(self) -> Settable:
        """Another one, whose changes leave this one as it is."""
        raise NotImplementedError

    def problems(self) -> list[str]:
        """Sentences on values that do not go together."""
        return []

    def take(self, values: dict[str, float]) -> None:
        """Take values that were checked, by property."""
        for name, value in values.items():
            setattr(self, name, value)

    def updateAttrs(self, values: dict[str, float]) -> None:
        """Change properties. Raises ValueError with all problems."""
        known, problems, own = self.known(), [], getattr(self, "name", self.WORD)
        for name, value in values.items():
            try:
                known[name].kind(value)
            except ValueError as error:
                problems.append(f"{own}: {name} {error}")
        if not problems:
            before = {n: v for n, v in self.values().items() if n in values}
            self.take(values)
            problems = [f"{own}: {one}" for one in self.problems()]
            if problems:
                self.take(before)  # type: ignore[arg-type]  # what was not given, is so again
        if problems:
            raise ValueError("\n".join(problems))

    def scatter(self, name: str, factor: Factor) -> None:
        """Multiply a property by the value of a field where this is. Raises ValueError.

        :param factor: function of x, y and z [m] that gives a factor [-]
        """
        value = self.values()[name]
        if value is None:
            raise ValueError(f"{getattr(self, 'name', self.WORD)}: {name} was not given, so nothing can vary about it")  # fmt: skip
        self.updateAttrs({name: value * factor(*self.place())})

    def place(self) -> tuple[float, ...]:
        """Where it is [m]."""
        raise NotImplementedError


def valuesOf(thing: Any) -> dict[str, Any]:
    """The properties of a joint, or of what is settable beside joints, with their values.

    :param thing: a MasonryJoint or a :class:`Settable`
    """
    return thing.values() if isinstance(thing, Settable) else thing.dict()


def copiedAll(connectors: dict[str, Any]) -> dict[str, Any]:
    """Copies of ties, springs and fibre layers by name, whose changes leave the scene as it is."""
    return {name: one.copied() for name, one in connectors.items()}


def scatterAll(
    connectors: dict[str, Any],
    names: list[str],
    factor: Factor,
) -> None:
    """Let properties of ties, springs and fibre layers vary by a field. Raises ValueError with all problems.

    :param connectors: ties, springs and fibre layers by name
    :param names: as ``"wire.strength"``; those of joints are left alone
    :param factor: as in :meth:`Settable.scatter`
    """
    problems = []
    for one in names:
        name, _, attribute = one.partition(".")
        thing = connectors.get(name)
        if thing is None:
            continue
        if attribute not in thing.known():
            problems.append(_noSuch(one, thing, attribute))
            continue
        try:
            thing.scatter(attribute, factor)
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise ValueError("\n".join(problems))


def _noSuch(what, thing, attribute):
    """A sentence on a property that a tie, springs, a layer or a beam does not have."""
    known = thing.known()
    return f"{what}: a {thing.WORD} has no such property, there are {', '.join(known)}{nearest(attribute, known)}"  # fmt: skip


def setting(text):
    """The joint, the property and the text of the value of ``--set``. Raises ValueError."""
    target, equals, value = text.partition("=")
    joint, dot, attribute = target.partition(".")
    if not (equals and dot and joint and attribute):
        raise ValueError(
            f"'{text}' must read JOINT.PROPERTY=VALUE, for example bed.tensileStrength=2e5"
        )
    return joint, attribute, value


def applySettings(joints, settings):
    """Give joints, and what is settable beside them, the values of ``--set``. Raises Refused with all problems at once.

    :param joints: dict of MasonryJoint and :class:`Settable` by name
    :param settings: list of (joint, property, text of the value)
    """
    problems, changes = [], {}
    for name, attribute, text in settings:
        if name not in joints:
            more = any(isinstance(one, Settable) for one in joints.values())
            what = "joint, beam, tie, spring or fibre layer" if more else "joint"
            problems.append(
                f"--set {name}.{attribute}: no {what} '{name}', there are {', '.join(joints)}"
            )
            continue
        values = valuesOf(joints[name])
        if isinstance(joints[name], Settable) and attribute not in values:
            what = f"--set {name}.{attribute}"
            problems.append(_noSuch(what, joints[name], attribute))
            continue
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
        one = not isinstance(joint, Settable) and joint.residualFriction == joint.friction  # fmt: skip
        if "friction" in change and one:
            # joints with one value of friction keep one
            change.setdefault("residualFriction", change["friction"])
        try:
            joint.updateAttrs(change)
        except ValueError as error:
            of = "--set " if isinstance(joint, Settable) else ""
            problems += [of + line for line in str(error).splitlines()]
    refuse(problems)


def _value(text, example):
    """The value that the text of a setting stands for, of the kind of ``example``. Raises ValueError if it is not one."""
    if isinstance(example, bool):
        if text.lower() in ("on", "true", "1"):
            return True
        if text.lower() in ("off", "false", "0"):
            return False
        raise ValueError(text)
    if isinstance(example, list):
        rows = [tuple(float(v) for v in row.split(":")) for row in text.split(",")]
        if any(len(row) != 2 for row in rows):
            raise ValueError(text)
        return rows
    return float(text)
