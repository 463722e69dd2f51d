# SPDX-License-Identifier: GPL-2.0-or-later
"""Ties and springs of a scene: plain records with their columns, and their entries of run.json."""

from __future__ import annotations

import copy
from dataclasses import dataclass, replace
from typing import Any, Iterator

from yade import Vector3
from yade.wrapper import MasonrySprings, MasonryTies

from ..assembly.columns import Column
from .settings import Factor, Property, Settable
from .targets import Target

MOST = 1e15  # of stiffness [N/m], [N m] and force [N]: more has no structure
#: What ``--set`` and ``--field`` can change of a tie and of a fibre layer.
OF_TIE = {
    "stiffness": Property("N/m", 0, MOST, True),
    "strength": Property("N", 0, MOST, True),
    "prestress": Property("N", 0, MOST),
    "slack": Property("m", 0, 1e3),
    "breaking": Property("", 0, 10, True),
}
OF_OVERLAY = {
    "stiffness": Property("N/m", 0, MOST, True),
    "strength": Property("N/m", 0, MOST, True),
    "strain": Property("", 0, 10, True),
}
NEVER = 1e300  # strength [N] and breaking elongation [m] of a tie that has none
GROUND = -1  # in place of the id of a body


@dataclass
class End:
    """An end of a tie or a spring.

    :param point: where it is fixed [m]
    :param target: a platen or brick, or None
    :param brick: index of a brick, or None. If both are None, the end is on the ground
    """

    point: tuple
    target: Target | None = None
    brick: int | None = None

    def bodyIn(self, ids: list[int]) -> int:
        """YADE's id of its body, -1 for the ground.

        :param ids: of the bricks, in their order
        """
        if self.target:
            assert self.target.body is not None
            return self.target.body
        return GROUND if self.brick is None else ids[self.brick]

    @property
    def isGround(self) -> bool:
        """Whether it does not move."""
        return self.target is None and self.brick is None

    @property
    def words(self) -> str:
        """Where it is, in words."""
        if self.target:
            return self.target.name
        at = ", ".join(f"{v:.4g}" for v in self.point)
        return f"the ground at ({at}) m" if self.isGround else f"brick {self.brick} at ({at}) m"  # fmt: skip


@dataclass
class Tie(Settable):
    """A bar between two points; ``scene.tie`` makes it and says what the values mean."""

    name: str
    ends: tuple[End, End]
    stiffness: float  # [N/m]
    strength: float | None  # [N]
    prestress: float  # [N]
    slack: float  # [m]
    breaking: float | None  # strain [-]
    compression: bool
    engine: Any = None  # YADE's, when the scene is built
    number: int = 0  # among the ties of the engine
    overlay: str = ""  # name of the overlay of which it is a fibre; then it has no columns of its own

    WORD, PLURAL = "tie", "ties"  # in messages, and in run.json
    isSupport = False  # whether its force on a platen is one of a support

    @staticmethod
    def engineOf(records: list[Tie], **ends: Any) -> Any:
        """The engine of all ties of a scene.

        :param ends: their bodies and points
        """
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
    def grow(records: list[Tie], engine: Any, share: float) -> None:
        """Tighten ties to a share of their prestress [-]."""
        engine.rest = [one.rest(share) for one in records]

    @staticmethod
    def events(
        records: list[Tie], engine: Any, since: int
    ) -> Iterator[tuple[Tie, str]]:
        """Ties to which something has happened since a time step, and what."""
        for what, steps in (("yields", engine.yieldedAt), ("breaks", engine.brokenAt)):
            for one, step in zip(records, steps):
                if step >= since:
                    yield one, what

    def known(self) -> dict[str, Property]:
        """As of :class:`Settable`, and so are those that follow."""
        return OF_TIE

    def values(self) -> dict[str, float | None]:
        return {name: getattr(self, name) for name in OF_TIE}

    def copied(self) -> Tie:
        return copy.copy(self)

    def place(self) -> tuple[float, ...]:
        a, b = (end.point for end in self.ends)
        return tuple(0.5 * (x + y) for x, y in zip(a, b))

    def problems(self) -> list[str]:
        found = []
        if self.prestress and self.slack:
            found.append(f"a prestress of {self.prestress:g} N and a slack of {self.slack:g} m exclude each other")  # fmt: skip
        if self.strength is not None and self.prestress >= self.strength:
            found.append(f"prestress {self.prestress:g} N must be below its strength, {self.strength:g} N")  # fmt: skip
        breaks = None if self.breaking is None else self.breaking * self.length * self.stiffness  # fmt: skip
        if breaks is not None and self.prestress >= breaks > 0:
            found.append(f"prestress {self.prestress:g} N must be below the force at which it breaks, {breaks:g} N")  # fmt: skip
        return found

    @property
    def bodies(self) -> tuple[int, int]:
        """YADE's ids of the bodies of its ends, -1 for the ground."""
        return self.engine.bodies1[self.number], self.engine.bodies2[self.number]

    @property
    def length(self) -> float:
        """Distance of its ends when the scene is built [m]."""
        a, b = (end.point for end in self.ends)
        return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5

    def rest(self, share: float) -> float:
        """Elongation without force when so much of the prestress has grown [m].

        :param share: 0 to 1 [-]
        """
        return self.slack - share * self.prestress / self.stiffness

    @property
    def force(self) -> float:
        """Present force, positive in tension [N]."""
        return self.engine.forceOf(self.number)

    @property
    def elongation(self) -> float:
        """Present elongation of the distance between its ends [m]."""
        return self.engine.elongations[self.number] if len(self.engine.elongations) else 0.0  # fmt: skip

    def on(self, end: End, connectors: Any) -> Any:
        """Force [N] and moment [N m] on one of its ends: two vectors.

        :param connectors: :class:`masonry.assembly.connectors.Connectors`
        """
        other = self.ends[1] if end is self.ends[0] else self.ends[0]
        away = connectors.placeOf(other) - connectors.placeOf(end)
        return self.force * away.normalized(), 0 * away

    def columns(self, plane: bool) -> Iterator[Column]:
        """What is recorded of it."""
        if self.overlay:
            return
        where = f"{self.ends[0].words} and {self.ends[1].words}"
        yield Column(f"{self.name}_force", "kN", f"force of the tie between {where}, positive in tension", lambda r: 1e-3 * self.force)  # fmt: skip
        yield Column(f"{self.name}_elongation", "mm", f"elongation of the distance between {where}", lambda r: 1e3 * self.elongation)  # fmt: skip

    @property
    def isListed(self) -> bool:
        """Whether run.json has an entry of it: of a fibre only when it is no longer elastic."""
        return not self.overlay or self.state != "elastic"

    @property
    def state(self) -> str:
        """``elastic``, ``yielded`` or ``broken``."""
        engine, n = self.engine, self.number
        if not len(engine.forces):
            return "elastic"
        return "broken" if engine.brokenAt[n] >= 0 else "yielded" if engine.yieldedAt[n] >= 0 else "elastic"  # fmt: skip

    def entry(self) -> dict[str, Any]:
        """What run.json says of it."""
        engine, n = self.engine, self.number
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
            "plastic_elongation_m": engine.flows[n] if len(engine.flows) else 0.0,
        }


@dataclass
class Spring(Settable):
    """Springs at a point; ``scene.spring`` makes them and says what the values mean."""

    name: str
    ends: tuple[End, End]
    stiffness: tuple  # along x, y and z [N/m]
    rotation: tuple  # about x, y and z [N m]
    engine: Any = None  # YADE's, when the scene is built
    number: int = 0  # among the springs of the engine

    WORD, PLURAL = "spring", "springs"
    isSupport, isListed, overlay = True, True, ""

    @staticmethod
    def engineOf(records: list[Spring], **ends: Any) -> Any:
        """The engine of all springs of a scene, as that of ties, and so are those that follow."""
        return MasonrySprings(
            label="springs",
            stiffness=[one.stiffness for one in records],
            rotationalStiffness=[one.rotation for one in records],
            **ends,
        )

    @staticmethod
    def grow(records: list[Spring], engine: Any, share: float) -> None:
        pass

    @staticmethod
    def events(records: list[Spring], engine: Any, since: int) -> Iterator[Any]:
        return iter(())

    def known(self) -> dict[str, Property]:
        """As of :class:`Settable`, and so are those that follow. A direction without a spring gets none."""
        units = (("stiffness", "N/m"), ("rotation", "N m/rad"))
        return {
            f"{what}_{axis}": Property(unit, 0, MOST, True)
            for what, unit in units
            for axis, value in zip("xyz", getattr(self, what))
            if value > 0
        }

    def values(self) -> dict[str, float | None]:
        return {n: getattr(self, n[:-2])["xyz".index(n[-1])] for n in self.known()}

    def copied(self) -> Spring:
        return copy.copy(self)

    def place(self) -> tuple[float, ...]:
        return self.ends[0].point

    def take(self, values: dict[str, float]) -> None:
        for name, value in values.items():
            what, axis = name.split("_")
            present = dict(zip("xyz", getattr(self, what))) | {axis: value}
            setattr(self, what, tuple(present.values()))

    @property
    def force(self) -> Any:
        """Present force on the first end [N]."""
        return self.engine.forces[self.number] if len(self.engine.forces) else (0.0, 0.0, 0.0)  # fmt: skip

    @property
    def moment(self) -> Any:
        """Present moment on the first end, about its point [N m]."""
        return self.engine.moments[self.number] if len(self.engine.moments) else (0.0, 0.0, 0.0)  # fmt: skip

    def on(self, end: End, connectors: Any) -> Any:
        """As :meth:`Tie.on`."""
        sign = 1 if end is self.ends[0] else -1
        return sign * Vector3(*self.force), sign * Vector3(*self.moment)

    def columns(self, plane: bool) -> Iterator[Column]:
        """What is recorded of it."""
        where = f"the spring between {self.ends[0].words} and {self.ends[1].words}"
        for i, axis in enumerate("xyz"):
            if self.stiffness[i] and not (plane and axis == "y"):
                yield Column(f"{self.name}_force_{axis}", "kN", f"force of the first on {where}, along {axis}", lambda r, i=i: -1e-3 * self.force[i])  # fmt: skip
        for i, axis in enumerate("xyz"):
            if self.rotation[i]:
                yield Column(f"{self.name}_moment_{axis}", "kNm", f"moment of the first on {where}, about {axis}", lambda r, i=i: -1e-3 * self.moment[i])  # fmt: skip

    def entry(self) -> dict[str, Any]:
        """What run.json says of it."""
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
    """Fibres over the joints of a face; ``scene.overlay`` makes them and says what the values mean."""

    name: str
    ties: list[Tie]
    stiffness: float  # E t of the fibres [N/m]
    strength: float  # [N/m]
    gauge: float  # [m]
    strain: float | None  # at which they break [-]

    WORD = "fibre layer"

    def known(self) -> dict[str, Property]:
        """As of :class:`Settable`, and so are those that follow."""
        return OF_OVERLAY

    def values(self) -> dict[str, float | None]:
        return {name: getattr(self, name) for name in OF_OVERLAY}

    def copied(self) -> Overlay:
        return replace(self, ties=[one.copied() for one in self.ties])

    def take(self, values: dict[str, float]) -> None:
        for name, value in values.items():
            for one in self.ties:
                if name == "strain":
                    one.breaking = value
                else:
                    share = value / getattr(self, name)
                    setattr(one, name, getattr(one, name) * share)
            setattr(self, name, value)

    def scatter(self, name: str, factor: Factor) -> None:
        """Every bundle has the value of the field at its own place; the layer keeps the mean."""
        if getattr(self, name) is None:
            raise ValueError(f"{self.name}: {name} was not given, so nothing can vary about it")  # fmt: skip
        for one in self.ties:
            one.scatter("breaking" if name == "strain" else name, factor)

    def columns(self, plane: bool) -> Iterator[Column]:
        """What is recorded of it."""
        for n, what in enumerate(("yielded", "broken")):
            meaning = f"how many of the {len(self.ties)} bundles of fibres of {self.name} have {what}"
            yield Column(f"{self.name}_{what}", "-", meaning, lambda r, n=n: self._count()[n])  # fmt: skip

    def _count(self):
        engine = self.ties[0].engine
        if not len(engine.forces):
            return 0, 0
        numbers = [one.number for one in self.ties]
        count = lambda steps: sum(steps[n] >= 0 for n in numbers)
        return count(list(engine.yieldedAt)), count(list(engine.brokenAt))

    def entry(self) -> dict[str, Any]:
        """What run.json says of it."""
        yielded, broken = self._count()
        return {
            "name": self.name,
            "stiffness_N_per_m": self.stiffness,
            "strength_N_per_m": self.strength,
            "gauge_m": self.gauge,
            "breaking_strain": self.strain,
            "bundles": len(self.ties),
            "yielded": yielded,
            "broken": broken,
        }
