# SPDX-License-Identifier: GPL-2.0-or-later
"""Ties, springs and fibre layers: records with their columns and entries of run.json."""

from dataclasses import dataclass, replace
from typing import Any

from yade import Vector3
from yade.wrapper import MasonrySprings, MasonryTies

from ..numbers.columns import Column
from ..materials.settings import Property, Settable
from .targets import Target

MAX_STIFFNESS = 1e15  # [N/m], [N m], and largest force [N]
#: What ``--set`` and ``--field`` can change of a tie and of a fibre layer.
OF_TIE = {
    "stiffness": Property("N/m", 0, MAX_STIFFNESS, True),
    "strength": Property("N", 0, MAX_STIFFNESS, True),
    "prestress": Property("N", 0, MAX_STIFFNESS),
    "slack": Property("m", 0, 1e3),
    "breaking": Property("", 0, 10, True),
}
OF_OVERLAY = {
    "stiffness": Property("N/m", 0, MAX_STIFFNESS, True),
    "strength": Property("N/m", 0, MAX_STIFFNESS, True),
    "strain": Property("", 0, 10, True),
}
#: Gauss points along an edge: two bundles of fibres, or two springs, there have the force and the
#: moment of a layer whose strain is linear.
BUNDLES = 0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5
NEVER = 1e300  # strength [N] and breaking elongation [m] of a tie that has none
GROUND = -1  # in place of the id of a body


@dataclass
class End:
    """An end of a tie or a spring; without target and brick it is on the ground."""

    point: tuple  # [m]
    target: Target | None = None
    brick: int | None = None  # index

    def bodyIn(self, ids):
        """YADE's id of its body, -1 for the ground and what is not there yet; ``ids``: those of the
        bricks."""
        if self.target:
            return GROUND if self.target.body is None else self.target.body
        return GROUND if self.brick is None else ids[self.brick]

    @property
    def isGround(self):
        """Whether it is on the ground."""
        return self.target is None and self.brick is None

    @property
    def words(self):
        """Where it is, in words."""
        if self.target:
            return self.target.name
        at = ", ".join(f"{v:.4g}" for v in self.point)
        return f"the ground at ({at}) m" if self.isGround else f"brick {self.brick} at ({at}) m"


class Connector(Settable):
    """A tie or springs, or another kind with one engine for all of it. ``number``: among those of
    the ``engine``; ``overlay``: name of that of which it is a fibre; ``isSupport``: whether its
    force on a platen is one of a support; ``isListed``: whether run.json has an entry of it"""

    overlay, isSupport, isListed = "", True, True

    @staticmethod
    def grow(records, engine, share):
        """Tighten connectors to a share of their prestress [-]."""

    @staticmethod
    def events(records, engine, since):
        """Connectors to which something has happened since a time step, and what."""
        return ()

    def _now(self, name, before):
        """A present value of its engine; ``before``: that before the first step."""
        values = getattr(self.engine, name)
        return values[self.number] if len(values) else before


@dataclass
class Tie(Connector):
    """A bar between two points; ``scene.tie`` says what the values mean."""

    name: str
    ends: tuple[End, End]
    stiffness: float  # [N/m]
    strength: float | None  # [N]
    prestress: float  # [N]
    slack: float  # [m]
    breaking: float | None  # strain [-]
    compression: bool
    engine: Any = None  # YADE's, when the scene is built
    number: int = 0
    overlay: str = ""  # a fibre has no columns of its own

    WORD, PLURAL = "tie", "ties"  # in messages, and in run.json
    isSupport = False
    known = OF_TIE

    @staticmethod
    def engineOf(records, **ends):
        never = lambda value: NEVER if value is None else value
        breaks = lambda one: one.breaking and one.breaking * one.length
        return MasonryTies(
            label="ties",
            stiffness=[one.stiffness for one in records],
            strength=[never(one.strength) for one in records],
            breaking=[never(breaks(one)) for one in records],
            compression=[int(one.compression) for one in records],
            rest=[one.rest(0) for one in records],
            **ends,
        )

    @staticmethod
    def grow(records, engine, share):
        engine.rest = [one.rest(share) for one in records]

    @staticmethod
    def events(records, engine, since):
        for what, steps in (("yields", engine.yieldedAt), ("breaks", engine.brokenAt)):
            for one, step in zip(records, steps):
                if step >= since:
                    yield one, what

    def place(self):
        """The middle between its ends [m]."""
        a, b = (end.point for end in self.ends)
        return tuple(0.5 * (x + y) for x, y in zip(a, b))

    def problems(self):
        prestress, found = self.prestress, []
        if prestress and self.slack:
            found.append(
                f"a prestress of {prestress:g} N and a slack of {self.slack:g} m exclude each other"
            )
        if self.strength is not None and prestress >= self.strength:
            found.append(
                f"prestress {prestress:g} N must be below its strength, {self.strength:g} N"
            )
        breaks = (self.breaking or 0) * self.length * self.stiffness
        if prestress >= breaks > 0:
            found.append(
                f"prestress {prestress:g} N must be below the force at which it breaks,"
                f" {breaks:g} N"
            )
        return found

    @property
    def bodies(self):
        """YADE's ids of the bodies of its ends, -1 for the ground."""
        return self.engine.bodies1[self.number], self.engine.bodies2[self.number]

    @property
    def length(self) -> float:
        """Distance of its ends when the scene is built [m]."""
        a, b = (end.point for end in self.ends)
        return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5

    def rest(self, share: float) -> float:
        """Elongation without force when a share of the prestress, 0 to 1, has grown [m]."""
        return self.slack - share * self.prestress / self.stiffness

    @property
    def force(self) -> float:
        """Present force, positive in tension [N]."""
        return self.engine.forceOf(self.number)

    @property
    def elongation(self) -> float:
        """Present elongation of the distance between its ends [m]."""
        return self._now("elongations", 0.0)

    def on(self, end, connectors):
        """Force [N] and moment [N m] on one of its ends, with the
        :class:`masonry.model.connectors.Connectors`."""
        other = self.ends[1] if end is self.ends[0] else self.ends[0]
        away = connectors.placeOf(other) - connectors.placeOf(end)
        return self.force * away.normalized(), 0 * away

    def columns(self, plane):
        if self.overlay:
            return
        where = f"{self.ends[0].words} and {self.ends[1].words}"
        yield Column(
            f"{self.name}_force",
            "kN",
            f"force of the tie between {where}, positive in tension",
            lambda r: 1e-3 * self.force,
        )
        yield Column(
            f"{self.name}_elongation",
            "mm",
            f"elongation of the distance between {where}",
            lambda r: 1e3 * self.elongation,
        )

    @property
    def isListed(self):
        """Of a fibre only when it is no longer elastic."""
        return not self.overlay or self.state != "elastic"

    @property
    def state(self) -> str:
        """``elastic``, ``yielded`` or ``broken``."""
        if self._now("brokenAt", -1) >= 0:
            return "broken"
        return "yielded" if self._now("yieldedAt", -1) >= 0 else "elastic"

    def entry(self):
        return {
            "name": self.name,
            "ends_m": [list(end.point) for end in self.ends],
            "bodies": list(self.bodies),
            "between": [end.words for end in self.ends],
            "stiffness_N_per_m": self.stiffness,
            "strength_N": self.strength,
            "prestress_N": self.prestress,
            "slack_m": self.slack,
            "breaking_strain": self.breaking,
            "compression": self.compression,
            "state": self.state,
            "force_N": self.force,
            "plastic_elongation_m": self._now("flows", 0.0),
        }


@dataclass
class Spring(Connector):
    """Springs at a point; ``scene.spring`` says what the values mean."""

    name: str
    ends: tuple[End, End]
    stiffness: tuple  # along x, y and z [N/m]
    rotation: tuple  # about x, y and z [N m]
    engine: Any = None  # YADE's, when the scene is built
    number: int = 0
    overlay: str = ""  # one of a line has no columns of its own

    WORD, PLURAL = "spring", "springs"

    @staticmethod
    def engineOf(records, **ends):
        return MasonrySprings(
            label="springs",
            stiffness=[one.stiffness for one in records],
            rotationalStiffness=[one.rotation for one in records],
            **ends,
        )

    @property
    def known(self):
        """Properties by name, of directions with a spring."""
        return {
            f"{what}_{axis}": Property(unit, 0, MAX_STIFFNESS, True)
            for what, unit in (("stiffness", "N/m"), ("rotation", "N m/rad"))
            for axis, value in zip("xyz", getattr(self, what))
            if value > 0
        }

    def values(self):
        return {n: getattr(self, n[:-2])["xyz".index(n[-1])] for n in self.known}

    def place(self):
        """Where they are [m]."""
        return self.ends[0].point

    def take(self, values):
        for name, value in values.items():
            what, axis = name.split("_")
            present = dict(zip("xyz", getattr(self, what))) | {axis: value}
            setattr(self, what, tuple(present.values()))

    @property
    def force(self) -> Any:
        """Present force on the first end [N]."""
        return self._now("forces", (0.0, 0.0, 0.0))

    @property
    def moment(self) -> Any:
        """Present moment on the first end, about its point [N m]."""
        return self._now("moments", (0.0, 0.0, 0.0))

    def on(self, end, connectors):
        """As :meth:`Tie.on`."""
        sign = 1 if end is self.ends[0] else -1
        return sign * Vector3(*self.force), sign * Vector3(*self.moment)

    @property
    def isListed(self):
        return not self.overlay

    def columns(self, plane):
        if self.overlay:
            return
        where = f"the spring between {self.ends[0].words} and {self.ends[1].words}"
        for what, unit, along in (("force", "kN", "along"), ("moment", "kNm", "about")):
            stiff = self.stiffness if what == "force" else self.rotation
            for i, axis in enumerate("xyz"):
                if stiff[i] and not (plane and what == "force" and axis == "y"):
                    value = lambda r, i=i, what=what: -1e-3 * getattr(self, what)[i]
                    meaning = f"{what} of the first on {where}, {along} {axis}"
                    yield Column(f"{self.name}_{what}_{axis}", unit, meaning, value)

    def entry(self):
        return {
            "name": self.name,
            "at_m": list(self.ends[0].point),
            "between": [end.words for end in self.ends],
            "stiffness_N_per_m": list(self.stiffness),
            "rotational_stiffness_Nm": list(self.rotation),
            "force_N": list(self.force),
            "moment_Nm": list(self.moment),
        }


@dataclass
class Overlay(Settable):
    """Fibres over the joints of a face; ``scene.overlay`` says what the values mean."""

    name: str
    ties: list[Tie]
    stiffness: float  # E t of the fibres [N/m]
    strength: float  # [N/m]
    gauge: float  # [m]
    strain: float | None  # at which they break [-]

    WORD = "fibre layer"
    known = OF_OVERLAY

    def copied(self):
        return replace(self, ties=[one.copied() for one in self.ties])

    def take(self, values):
        for name, value in values.items():
            for one in self.ties:
                if name == "strain":
                    one.breaking = value
                else:
                    share = value / getattr(self, name)
                    setattr(one, name, getattr(one, name) * share)
            setattr(self, name, value)

    def vary(self, name, factor):
        """Give every bundle the value at its own place; the layer keeps the mean."""
        for one in self.ties:
            one.scatter("breaking" if name == "strain" else name, factor)

    def columns(self, plane):
        for what in ("yielded", "broken"):
            meaning = (
                f"how many of the {len(self.ties)} bundles of fibres of {self.name} have {what}"
            )
            yield Column(
                f"{self.name}_{what}", "-", meaning, lambda r, what=what: self._count(what)
            )

    def _count(self, what):
        steps = list(getattr(self.ties[0].engine, f"{what}At"))
        return sum(steps[one.number] >= 0 for one in self.ties) if steps else 0

    def entry(self):
        return {
            "name": self.name,
            "stiffness_N_per_m": self.stiffness,
            "strength_N_per_m": self.strength,
            "gauge_m": self.gauge,
            "breaking_strain": self.strain,
            "bundles": len(self.ties),
            "yielded": self._count("yielded"),
            "broken": self._count("broken"),
        }
