# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene records: platens, bricks, drifts and joints, with their columns, and the validators
of arguments that name them."""

from dataclasses import dataclass
from typing import Annotated, Any, Iterator, Sequence, Union

from ..arguments import Numbers, isListed, listOf, oneOf, shown
from ..numbers.columns import Column
from ..bricks import Block


@dataclass(eq=False)  # compared by identity, and keys of dicts
class Target:
    """A platen, or a brick that is held, loaded or watched."""

    name: str  # in the columns of curve.csv
    fixed: bool = False  # it moves by ``scene.move`` alone
    point: tuple | None = None  # [m] on which loads act
    recorded: tuple | None = None  # [m] whose motion is recorded
    brick: int | None = None  # index of a brick, None for a platen
    box: tuple | None = None  # opposite corners of a platen
    freedom: str = ""  # YADE's blockedDOFs
    loaded: bool = True
    drives: str = ""  # axes along which a drive holds it from the beginning
    body: int | None = None  # YADE's id, when the scene is built
    force: tuple | None = None  # [N] dead load
    pressed: float | None = None  # [Pa] on the bricks below
    weight: float | None = None  # [N] of a platen; None: that of its mass
    riding: bool = True  # the load moves with the platen
    friction: float = 0.0  # of the machine that presses, over its load [-]
    stiffness: float = 0.0  # with which its load follows uplift [N/m]
    guides: float | None = None  # stiffness of jack and guides until that friction slips [N/m]
    joined: bool = True  # a platen has joints with what it touches
    line: bool = False  # it is a bar from which springs hold bricks along a line

    @property
    def isInMachine(self) -> bool:
        """Whether the load that presses it follows its motion."""
        return self.friction > 0 or self.stiffness > 0

    @property
    def parts(self) -> tuple[tuple[Any, Any, float]]:
        """As in :class:`masonry.model.loading.Pattern`."""
        return ((self.body, self.point, 1.0),)

    def columns(self, plane: bool) -> Iterator[Column]:
        """What is recorded of it; ``plane``: whether the scene is in the x-z plane."""
        name, axes = self.name, "xz" if plane else "xyz"
        supports = lambda r: r.structure.supports

        def force(axis, on, vector):
            i, what = "xyz".index(axis), f"force of the structure on {on} along {axis}"
            return Column(f"{name}_force_{axis}", "kN", what, lambda r: vector(r)[i])

        for axis in axes:
            what, i = f"displacement of {name} along {axis}", "xyz".index(axis)
            moved = lambda r, i=i: 1e3 * r.moved(self)[0][i]
            yield Column(f"{name}_{axis}", "mm", what, moved)
            if self.fixed or axis in (self.freedom or ""):
                yield force(axis, name, lambda r: 1e-3 * r.forces[name])
            if not (self.joined or self.line):
                what = f"impulse so far of what strikes {name}, along {axis}"
                of = lambda r, i=i: r.structure.contacts.impulse(self.body)[i]
                yield Column(f"{name}_impulse_{axis}", "Ns", what, of)
        if self.brick is not None and self.loaded and not self.fixed:
            for axis in axes:
                on = f"what loads, drives or holds {name}"
                yield force(axis, on, lambda r: -1e-3 * supports(r).forceFrom(self))
        elif self.box and not self.fixed and "z" not in self.drives + (self.freedom or ""):
            yield force("z", name, lambda r: 1e-3 * supports(r).jointsOn(self))
        for axis in self.drives:
            own = lambda r, a=axis: -1e-3 * r.structure.loading.driveForce(self, a)
            yield force(axis, f"the drive of {name}", own)
        if not self.fixed:
            what = f"rotation of {name}" + (" about y" if plane else ", its angle")
            turned = lambda r: 1e3 * r.moved(self)[1]
            yield Column(f"{name}_rotation", "mrad", what, turned)


@dataclass
class Drift:
    """How far a target moves horizontally against a lower one."""

    name: str
    lower: Target
    upper: Target

    def columns(self, plane: bool) -> Iterator[Column]:
        height = self.upper.recorded[2] - self.lower.recorded[2]
        for i, axis in enumerate("x" if plane else "xy"):
            name = f"{self.name}_{axis}"
            what = f"displacement of {self.upper.name} along {axis} less that of {self.lower.name}"
            away = lambda r, i=i: 1e3 * (r.moved(self.upper)[0][i] - r.moved(self.lower)[0][i])
            turned = lambda r, away=away: away(r) / height
            yield Column(name, "mm", what, away)
            yield Column(name, "mrad", f"{what}, over the height between them", turned)


@dataclass
class JointRecord:
    """A joint between two bricks whose means are recorded."""

    name: str
    bricks: tuple  # indices of the two bricks
    interaction: Any = None  # YADE's, when the scene is built

    @property
    def area(self) -> float:
        """[m²]"""
        return sum(self.interaction.geom.areas)

    @property
    def normalStiffness(self) -> float:
        """[Pa/m]"""
        return self.interaction.phys.normalStiffness

    def _mean(self, values):
        areas = self.interaction.geom.areas
        return sum(a * v for a, v in zip(areas, values)) / sum(areas)

    def opening(self) -> float:
        """Mean over the joint [m], negative if it closes."""
        return self._mean(self.interaction.phys.opening)

    def slide(self, axis: int = 1) -> float:
        """Mean over the joint along its first direction [m]; ``axis`` 2: its second one."""
        return self._mean(jump[axis] for jump in self.interaction.geom.jumps)

    def normalStress(self) -> float:
        """Mean over the joint [Pa], positive in tension."""
        return self._mean(stress[0] for stress in self.interaction.phys.stress)

    def shearStress(self, axis: int = 1) -> float:
        """Mean over the joint, along an axis of :meth:`slide` [Pa]."""
        return self._mean(stress[axis] for stress in self.interaction.phys.stress)

    def prefixed(self, name: str) -> str:
        """A name behind that of the joint, if it has one."""
        return f"{self.name}_{name}" if self.name else name

    def dissipated(self) -> dict[str, float]:
        """Entries of run.json: dissipated energy over the area [J/m²]."""
        lost = zip(("tension", "shear", "compression"), self.interaction.phys.dissipated)
        return {self.prefixed(f"dissipated_{mode}_J_per_m2"): j / self.area for mode, j in lost}

    def columns(self, plane: bool) -> Iterator[Column]:
        between = "the joint between bricks {} and {}".format(*self.bricks)
        for name, unit, meaning, factor, mean in (*OF_JOINTS, *(() if plane else ACROSS)):
            value = lambda r, factor=factor, mean=mean: factor * mean(self)
            yield Column(self.prefixed(name), unit, meaning.format(between), value)


#: What is recorded of a joint: name, unit, meaning, the factor from SI units, and the mean.
OF_JOINTS = (
    ("opening", "mm", "mean opening of {}, negative if it closes", 1e3, JointRecord.opening),
    ("slide", "mm", "mean slide of {}, along its first direction", 1e3, JointRecord.slide),
    (
        "normal_stress",
        "MPa",
        "mean normal stress of {}, positive in tension",
        1e-6,
        JointRecord.normalStress,
    ),
    (
        "shear_stress",
        "MPa",
        "mean shear stress of {}, along the slide",
        1e-6,
        JointRecord.shearStress,
    ),
)
#: In space, too.
ACROSS = (
    (
        "slide_across",
        "mm",
        "mean slide of {}, along its second direction",
        1e3,
        lambda joint: joint.slide(2),
    ),
    (
        "shear_stress_across",
        "MPa",
        "mean shear stress of {}, along that",
        1e-6,
        lambda joint: joint.shearStress(2),
    ),
)


def _descriptionOf(context):
    """The description of a scene: the first argument of a command, or its attribute."""
    return getattr(context, "description", context)


def isOwn(target: Any, context: Any) -> bool:
    return _descriptionOf(context).targets.get(target.name) is target


def _target(what, fits):
    """Validator of targets of the scene for which a function is true."""

    def take(value, context):
        known = isinstance(value, Target)
        own = known and isOwn(value, context)
        if not (own and fits(value)):
            got = repr(value.name) if known else shown(value)
            other = ", which is of another scene" if known and not own else ""
            raise ValueError(f"{got}{other} must be {what}")
        return value

    return take


def _recordedJoint(value, context):
    if not any(value is one for one in _descriptionOf(context).joints):
        raise ValueError(f"{shown(value)} must be a joint of this scene, as joint() gave it")
    return value


def _part(value, context):
    return oneOf(*sorted({block.part for block in _descriptionOf(context).bricks}))(value)


def brick(value: Any, context: Any) -> Any:
    """Validator of a brick: its index, a point in it or near it [m], or the block itself."""
    _descriptionOf(context).find(value)
    return value


_any = _target(
    "a target of this scene, as platen(), hold(), watch() or handle() give it", lambda t: True
)
kindOfLoaded = _target("a platen that moves, or a handle(), of this scene", lambda t: t.loaded)
_moving = _target("a platen of this scene that moves", lambda t: t.box and not t.fixed)
_held = _target(
    "a platen or brick of this scene that is held from its beginning", lambda t: t.fixed
)
_allHeld = lambda v, context: listOf(_held)(v if isListed(v) else [v], context)
AnyTarget = Annotated[Target, _any]
Loaded = Annotated[Target, kindOfLoaded]
MovingPlaten = Annotated[Target, _moving]
HeldTargets = Annotated[Union[Target, Sequence[Target]], _allHeld]
RecordedJoint = Annotated[JointRecord, _recordedJoint]
Part = Annotated[str, _part]
BrickAt = Annotated[Union[Numbers, int, Block], brick]
