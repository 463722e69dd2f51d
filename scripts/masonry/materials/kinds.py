# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks and joints of a structure, which joint a pair of blocks gets, and the materials of beams
and floors."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Callable, Iterable

from yade.wrapper import MasonryJoint, MasonryMat

from . import fields
from ..arguments import Names, isA, isNumber, nearest, number, shown, validated
from ..arguments import byName as dictOf
from ..model.engines import LAWS
from ..errors import Refused, refuse
from ..bricks import Bricks
from .settings import Factor, Property, Settable, applySettings, matching
from .assumptions import AS_BED, copied, entriesOf, isDefault, missing, state

FACTOR = number("", 0, above=True)  # validator of factors of a variation

#: A joint with a steeper normal is a bed joint: 45 degrees.
STEEP = math.cos(math.radians(45))


_slides = matching(lambda v: hasattr(v, "residualFriction"), "a MasonryJoint")
_options = matching(lambda v: hasattr(v, "joints"), "the options of a scene")
_isVaried = lambda v: isinstance(v, tuple) and len(v) == 4
_varied = matching(
    lambda v: isinstance(v, list) and all(map(_isVaried, v)), "a list that vary() has made"
)


@validated
def withResidual(
    names: Names, joints: Annotated[dict[str, MasonryJoint], dictOf(_slides)]
) -> list[str]:
    """Names of properties, as ``"bed.friction"``, with the residual friction of joints whose
    friction is among them and has one value."""
    one = [n.partition(".")[0] for n in names if n.endswith(".friction")]
    alike = lambda n: n in joints and joints[n].friction == joints[n].residualFriction
    residual = [f"{n}.residualFriction" for n in one if alike(n)]
    return [*dict.fromkeys([*names, *residual])]


_fits = lambda value: isinstance(value, Bricks) and len(value)
_pieces = matching(_fits, "what bricks.Beam or bricks.Floor gives")


def _bearing(value, context=None):
    if isinstance(value, str) and value != "fixed":
        raise ValueError(f"{shown(value)} must be 'fixed', a friction [-] or None")
    if value is None or isinstance(value, str):
        return value
    return number("", 0, 5)(value)


Modulus = Annotated[float, number("Pa", 0, 1e15, above=True)]
Density = Annotated[float, number("kg/m³", 0, 1e6, above=True)]
Poisson = Annotated[float, number("", -1, 0.5, above=True, below=True)]
InPlane = Annotated[float, number("N/m", 0, 1e15, above=True)]  # a stiffness of a floor
STIFFER = 1e4  # normal stiffness of the joints of a beam over that of its pieces [-]
RIGID = 1e14  # Young's modulus of a piece that does not deform [Pa]


@validated
def withBeam(
    masonry: Any,
    beam: Annotated[Any, _pieces],
    young: Modulus,
    density: Density,
    poisson: Poisson = 0.2,
    bearing: Annotated[float | str | None, _bearing] = None,
) -> Any:
    """Give the elastic material of a beam of :func:`masonry.bricks.Beam`. Returns the same masonry.

    Joints of its name connect its pieces, with the bending stiffness E I and the shear stiffness
    5/6 G A of the beam. Torsion has G (Iy + Iz), which is too stiff for flat sections.

    :param young: [Pa]; ``poisson``: [-]
    :param density: [kg/m³]
    :param bearing: the joint NAME_bearing between it and masonry: None: the bed joint; a number: a
        dry joint of this friction [-]; ``"fixed"``: an elastic joint
    """
    name, pitch = _newKind(masonry, "withBeam", beam)
    shear = young / (2 * (1 + poisson))
    # in series with the lumped elasticity of the pieces: E / l, and 5/6 G / l
    glue = MasonryJoint(
        name=name,
        elastic=True,
        normalStiffness=STIFFER * young / pitch,
        shearStiffness=5 * shear / pitch,
    )
    unit = MasonryMat(label=name, young=young, poisson=poisson, density=density)
    return _take(masonry, name, unit, glue, bearing)


@validated
def withFloor(
    masonry: Any,
    floor: Annotated[Any, _pieces],
    shear: InPlane,
    mass: Annotated[float, number("kg/m²", 0, 1e6, above=True)],
    across: InPlane | None = None,
    bearing: Annotated[float | str | None, _bearing] = 0.5,
) -> Any:
    """Give the properties of a floor of :func:`masonry.bricks.Floor`, which shears elastically in
    its plane. Returns the same masonry.

    :param shear: shear stiffness G t of its plane [N/m]: a square floor with one edge held moves by
        V / (G t) under a force V along the opposite edge
    :param mass: with what lies on it [kg/m²]
    :param across: stiffness E t across the strips [N/m]; None: ten times ``shear``, assumed
    :param bearing: as in :meth:`withBeam`; the default, friction 0.5, is of joists on masonry
    """
    name, pitch = _newKind(masonry, "withFloor", floor)
    low, high = floor[0].low, floor[0].high
    height = high[2] - low[2]
    # strips are rigid, so the forces of their joints are G t / pitch times the slip
    area = pitch * height
    stiff = dict(normalStiffness=(across or 10 * shear) / area, shearStiffness=shear / area)
    glue = MasonryJoint(name=name, elastic=True, **stiff)
    if across is None:
        state(
            glue,
            normalStiffness=(
                "assumed by withFloor(): across its strips a floor is ten times as stiff as in"
                " shear"
            ),
        )
    unit = MasonryMat(label=name, young=RIGID, poisson=0.0, density=mass / height)
    return _take(masonry, name, unit, glue, bearing)


def _newKind(masonry, word, pieces):
    """The kind of pieces of a beam or a floor, and the distance of their middles [m]. Raises
    Refused."""
    kinds, problems = sorted({block.kind for block in pieces}), []
    name = kinds[0]
    if len(kinds) > 1:
        problems.append(
            f"the pieces are of the kinds {', '.join(kinds)}: give those of one beam or floor"
        )
    if name in masonry.units or name in masonry.joints:
        problems.append(f"this masonry has {name!r} already; give the beam or floor another name")
    if len(pieces) < 2:
        problems.append(f"{name} is one piece, which is rigid: bricks.Beam(..., pieces=8) bends")
    refuse([f"{word}: {one}" for one in problems])
    return name, math.dist(pieces[0].middle, pieces[1].middle)


def _take(masonry, name, unit, glue, bearing):
    masonry.units[name], masonry.joints[name] = unit, glue
    masonry.stiff = masonry.stiff | {name}
    if bearing is not None:
        bed, name = masonry.joints["bed"], f"{name}_bearing"
        own = {"elastic": True} if bearing == "fixed" else slipping(bearing)
        joint = masonry.joints[name] = MasonryJoint(name=name, **own)
        joint.set(normalStiffness=bed.normalStiffness, shearStiffness=bed.shearStiffness)
    return masonry


def slipping(friction: float) -> dict[str, Any]:
    """Properties of a joint with friction alone."""
    return dict(
        tensileStrength=0, cohesion=0, friction=friction, residualFriction=friction, cap=False
    )


def _isBeam(masonry, name):
    """Whether a name is that of a beam; pieces of a floor are rigid."""
    return name in masonry.stiff and masonry.units[name].young < RIGID


class _OfBeam(Settable):
    """Material of a beam for ``--set``; the stiffness of its joints follows."""

    WORD = "beam"
    known = {
        "young": Property("Pa", 0, RIGID, True),
        "density": Property("kg/m³", 0, 1e6, True),
    }

    def __init__(self, name, masonry):
        self.name = name
        self.unit, self.joint = masonry.units[name], masonry.joints[name]

    def values(self):
        return {name: getattr(self.unit, name) for name in self.known}

    def take(self, values):
        share = values.get("young", self.unit.young) / self.unit.young
        names = ("normalStiffness", "shearStiffness")
        self.joint.updateAttrs({n: share * getattr(self.joint, n) for n in names})
        self.unit.updateAttrs(values)


@validated
@dataclass
class Masonry:
    """Bricks and joints of a structure, and which joint a pair of blocks gets.

    A pair of blocks gets the joint ``support`` if one of them is a platen, ``crack`` if they are
    pieces of one brick, that of a beam or floor (:meth:`withBeam`, :meth:`withFloor`) if they are
    pieces of one, and ``NAME_bearing`` if one of them is; ``collar``, if there is one, between two
    parts of a structure, such as the wythes of a wall; else ``bed`` if its normal is less than 45
    degrees off the vertical, or there is no ``head``; else ``head``.

    Properties that were not given have the default of their class and are noted
    (:mod:`masonry.materials.assumptions`). These must be given: the density of units, and strengths
    (tensileStrength, cohesion, friction, and compressiveStrength unless cap=False) of joints that
    are not elastic.

    :param unit: MasonryMat of the bricks
    :param joints: dict of MasonryJoint by these names; ``bed`` must be there. A missing ``support``
        is the bed joint, with its strength and friction, also after ``--set``, but without its
        random field
    :param units: dict of MasonryMat by the ``kind`` of a block, for example ``{"lintel":
        concrete}``; other bricks, lintels, voussoirs and blocks are of the unit
    :param choose: function (block1, block2, geom) of the records of two bricks, or None for a
        platen; it returns the name of a joint, or None for the rule above
    :param brief: whether a scene prints only how many properties are assumed
    """

    unit: Annotated[MasonryMat, isA(MasonryMat)]
    joints: Annotated[dict, dictOf(isA(MasonryJoint), "bed")]
    units: Annotated[dict, dictOf(isA(MasonryMat))] = field(default_factory=dict)
    choose: Callable[..., str | None] | None = None
    #: of :meth:`vary`: joint, property, function and step
    varied: Annotated[list, _varied] = field(default_factory=list)
    brief: bool = False
    #: height of a course for which the joints were made [m]; None: any
    course: Annotated[float, number("m", 0, above=True)] | None = None
    #: kinds of blocks that are always rigid: pieces of beams and floors
    stiff: Annotated[frozenset, isA(frozenset)] = frozenset()

    def __post_init__(self):
        for name, joint in self.joints.items():
            if isDefault(joint, "name"):
                joint.name = name
        if "support" not in self.joints:
            support = copied(self.joints["bed"])
            support.name = "support"
            names = support.dict().keys() - {"name", "jointSet", "direction"}
            self.joints["support"] = state(support, **dict.fromkeys(names, AS_BED))

    def _follow(self):
        """Give a support joint that is the bed joint the present values of that."""
        support, bed = self.joints["support"], self.joints["bed"]
        sources = support.assumed()
        support.updateAttrs({n: getattr(bed, n) for n, s in sources.items() if s == AS_BED})
        state(support, **sources)

    def apply(self, settings: Iterable[tuple[str, str, str]], connectors: Any = None) -> None:
        """Give joints, beams and connectors the values of ``--set``. Raises Refused with all
        problems at once.

        :param settings: list of (name, property, text of the value)
        :param connectors: ties, springs and fibre layers of the scene by name
        """
        made = {name: _OfBeam(name, self) for name in self.stiff if _isBeam(self, name)}
        applySettings({**self.joints, **made, **(connectors or {})}, settings)
        try:
            self._follow()
        except ValueError as error:
            raise Refused(str(error)) from None

    @validated
    def vary(
        self,
        name: Names,
        value: Factor,
        step: Annotated[float, number("", 1e-6, 1, below=True)] = 0.01,
    ) -> Masonry:
        """Let a property change from place to place. Returns the same masonry.

        :param name: joint and property, for example ``"bed.cohesion"``, or a list of these that
            change alike. The tensile strength must be at most cohesion over friction everywhere
        :param value: function of the x, y and z [m] of a joint's middle that gives a factor on the
            property [-]; :mod:`masonry.materials.fields` has random ones
        :param step: values are rounded to steps of this ratio, so that many joints share one [-]
        """
        found, problems = [], []
        for one in [name] if isinstance(name, str) else name:
            joint, _, attribute = one.partition(".")
            if _isBeam(self, joint):  # its stiffness is that of its pieces
                problems.append(
                    f"vary: {one!r}: a beam has its young and its density all over, which --set"
                    f" {joint}.young=... changes"
                )
                continue
            values = self.joints[joint].dict() if joint in self.joints else {}
            numbers = [n for n, v in values.items() if isNumber(v)]
            if attribute in numbers:
                found.append((joint, attribute, value, step))
                continue
            close = nearest(one, [f"{joint}.{n}" for n in numbers])
            problems.append(
                f"vary: no property {one!r}; joints are {', '.join(self.joints)},"
                f" help(masonry.MasonryJoint) lists properties{close}"
            )
        if problems:
            raise ValueError("\n".join(problems))
        self.varied += found
        return self

    withBeam, withFloor = withBeam, withFloor
    assumed, missing = entriesOf, missing

    @validated
    def variant(self, args: Annotated[Any, _options], connectors: Any = None) -> Masonry:
        """A copy for the options ``--joints`` and ``--field``.

        :param connectors: names of ties, springs and fibre layers, whose fields are not of joints
        """
        joints = {name: copied(joint) for name, joint in self.joints.items()}
        if args.joints == "brittle":
            joints = {name: _brittle(joint) for name, joint in joints.items()}
        elif args.joints != next(iter(LAWS)):
            for joint in joints.values():
                joint.law = args.joints
        units = {kind: copied(mat) for kind, mat in self.units.items()}
        own = replace(
            self, unit=copied(self.unit), joints=joints, units=units, varied=[*self.varied]
        )
        own._follow()
        known = list(connectors or ())
        for text in args.field:
            names, function = fields.read(text)
            names = [n for n in names if n.partition(".")[0] not in known]
            try:
                if names:
                    own.vary(withResidual(names, joints), function)
            except ValueError as error:
                also = f"; ties, springs and fibre layers are {', '.join(known)}" if known else ""
                raise Refused(f"--field {text}: {error}{also}") from None
        return own

    def rule(self, blocks: dict[int, Any]) -> Callable[..., MasonryJoint | None]:
        """The rule of :func:`masonry.model.connecting.connect`. A joint is monolithic between the
        two blocks of one brick alone.

        :param blocks: records of the bricks by body id
        """
        pieces = Counter(block.brick for block in blocks.values())

        def rule(one, two, geom):
            first, second = blocks.get(one.id), blocks.get(two.id)
            name = self.choose and self.choose(first, second, geom)
            if name and name not in self.joints:
                raise ValueError(
                    f"choose gave {name!r} for bodies {one.id} and {two.id}; there are"
                    f" {', '.join(self.joints)}"
                )
            name = name or self._kind(first, second, geom.normal)
            joint = self.joints[name]
            if self.varied:
                joint = self._at(name, joint, geom)
            halves = first and second and first.brick == second.brick and pieces[first.brick] == 2
            if joint.monolithic and not halves:
                joint = self._changed(id(joint), joint, {"monolithic": False})
            return joint

        return rule

    def _changed(self, key, joint, values):
        if key not in self._made:
            own = copied(joint)
            own.updateAttrs(values)
            self._made[key] = own
        return self._made[key]

    def _kind(self, first, second, normal):
        if first is None or second is None:
            return "support"
        if first.brick == second.brick and "crack" in self.joints:
            return "crack"
        if self.stiff and first.kind == second.kind and first.kind in self.stiff:
            return first.kind
        for block in (first, second) if self.stiff else ():
            if block.kind in self.stiff and f"{block.kind}_bearing" in self.joints:
                return f"{block.kind}_bearing"
        if first.part != second.part and "collar" in self.joints:
            return "collar"
        steep = abs(normal[2]) > STEEP or "head" not in self.joints
        return "bed" if steep else "head"

    def _at(self, name, joint, geom):
        steps, values, centres = {}, {}, geom.centres
        centre = [sum(c[i] for c in centres) / len(centres) for i in range(3)]
        for kind, attribute, value, step in self.varied:
            if kind != name:
                continue
            try:
                factor = FACTOR(value(*centre))
            except ValueError as error:
                raise ValueError(
                    f"vary {kind}.{attribute}: the factor at {centre} m: {error}"
                ) from None
            n = steps[attribute] = round(math.log(factor) / math.log1p(step))
            values[attribute] = getattr(joint, attribute) * (1 + step) ** n
        if not any(steps.values()):
            return joint
        try:
            return self._changed((name, *sorted(steps.items())), joint, values)
        except ValueError as error:
            place = ", ".join(f"{v:.3g}" for v in centre)
            raise ValueError(f"vary: at ({place}) m: {error}") from None

    _made = property(lambda self: self.__dict__.setdefault("_kept", {}))


def _brittle(joint):
    return joint if joint.elastic else joint.brittleCoulomb()
