# SPDX-License-Identifier: GPL-2.0-or-later
"""Masonry of one's own from what a data sheet and tests say of it: joints by stated formulas."""

import inspect
from dataclasses import dataclass
from typing import Annotated, Any, Callable, ParamSpec

from yade.wrapper import MasonryJoint, MasonryMat

from ..arguments import isA, number, validated
from ..errors import refuse
from ..terminal import say
from ..bricks.blocks import Sides
from .assumptions import BY_CODE, state
from .codes import MEAN
from .kinds import Masonry

#: Flexural strength of a bond over its direct tensile strength [-]: van der Pluijm, Out-of-plane
#: bending of masonry (Eindhoven, 1999) found about 1.5 in bond wrench tests.
WRENCH = 1.5

#: Fracture energy over strength [m] in tension and in shear without normal stress: the ductility
#: indices that Lourenço, Structural masonry analysis: recent developments and prospects (14th Int.
#: Brick and Block Masonry Conference, 2008), recommends.
TENSION_INDEX, SHEAR_INDEX = 0.029e-3, 0.093e-3
INDEX_SOURCE = "ductility index of Lourenço (2008)"
#: Of tension and shear: fracture energy, strength, and their index.
MODES = (
    ("modeIFractureEnergy", "tensileStrength", TENSION_INDEX),
    ("modeIIFractureEnergy", "cohesion", SHEAR_INDEX),
)

#: Range of the compressive fracture energy of Model Code 90 [Pa], and energy over strength below
#: and above it [m].
MODEL_CODE = 12e6, 80e6
BELOW_RANGE, ABOVE_RANGE = 1.6e-3, 0.33e-3

#: Strain at the compressive strength beyond which a modulus is questioned [-]. With 2 fc/E it is
#: 0.0024 by EN 1996-1-1, 3.7.2, and 0.003 to 0.005 in table C8.5.I of Circolare 7/2019.
MAX_PEAK_STRAIN = 0.01

#: What a clause of a code says of the bed joint, by the argument of :func:`masonry`.
OF_CLAUSES = dict(
    E="normalStiffness",
    G="shearStiffness",
    fc="compressiveStrength",
    fv0="cohesion",
    friction="friction",
    ft="tensileStrength",
)

#: By how much an assumed fracture energy is above the least that the law can follow [-].
MARGIN = 1.1

#: What the user gives. Beyond these bounds it is probably in another unit.
Modulus = Annotated[float, number("Pa", 1e6, 1e12)]
Crushing = Annotated[float, number("Pa", 1e4, 1e9)]
OfBond = Annotated[float, number("Pa", 0, 1e8)]  # a strength
OfBrick = Annotated[float, number("Pa", 1e3, 1e9)]  # a strength
Friction = Annotated[float, number("", 0, 5)]
Energy = Annotated[float, number("J/m²", 0.1, 1e5)]
EnergyOfBrick = Annotated[float, number("J/m²", 0.1, 1e6)]
Mortar = Annotated[float, number("m", 0, 0.1)]


def _ofMortar(value, context=None):
    """Validator of an argument of which no value is accepted: it explains what to give instead."""
    raise ValueError(
        "is the strength of the mortar in EN 1996 and on data sheets: give fc, the mean strength of"
        " the masonry, or fk; materials.en1996 finds it from unit and mortar"
    )


@validated
def compressiveFractureEnergy(fc: Crushing) -> tuple[float, str]:
    """Compressive fracture energy of masonry [J/m²], and its source.

    Gc = 15 + 0.43 fc - 0.0036 fc² with fc in MPa and Gc in N/mm, for fc from 12 to 80 MPa, after
    Model Code 90; below and above that 1.6 mm and 0.33 mm times fc, as Lourenço (2008) recommends.

    :param fc: compressive strength [Pa]
    """
    low, high = MODEL_CODE
    if fc < low:
        return BELOW_RANGE * fc, "1.6 mm·fc, Lourenço (2008) for fc below 12 MPa"
    if fc > high:
        return ABOVE_RANGE * fc, "0.33 mm·fc, Lourenço (2008) for fc above 80 MPa"
    found = 1e3 * (15 + 0.43 * (fc / 1e6) - 0.0036 * (fc / 1e6) ** 2)
    return found, "15 + 0.43 fc - 0.0036 fc² N/mm, Model Code 90 after Lourenço (2008)"


@validated
def leastEnergy(
    strength: Annotated[float, number("Pa", 0, 1e12)],
    stiffness: Annotated[float, number("Pa/m", 0, above=True)],
    lumped: Annotated[float, number("m/Pa", 0)] = 0.0,
) -> float:
    """The least fracture energy [J/m²] with which the law softens as it is asked to.

    Below strength²/stiffness, twice the elastic energy at the peak, the law takes another energy.
    Between rigid units, whose elasticity is lumped into the joint, softening snaps back below
    strength² (lumped + 1/(2 stiffness)): yade_plugin/law/README.md, Softening and Rigid units.

    :param strength: [Pa]
    :param stiffness: of the joint [Pa/m]
    :param lumped: distance of the units' centroids over their modulus [m/Pa]
    """
    return strength**2 * max(1 / stiffness, lumped + 0.5 / stiffness)


class _Joint:
    """A joint while it is made: its properties, and the sources of those that are assumed."""

    def __init__(self, name, **values):
        self.name, self.values, self.sources = name, values, {}

    def take(self, name, given, assumed, source):
        """Take a property that the user gave; None: it is assumed by ``source``. Returns its
        value."""
        self.values[name] = assumed if given is None else given
        if given is None:
            self.sources[name] = source
        return self.values[name]

    def energy(self, mode, strength, stiffness, lumped, given):
        """Take a fracture energy, which is large enough if assumed; warn of a given one that is
        too small."""
        name, _, index = mode
        least = leastEnergy(strength, stiffness, lumped)
        if given is not None and given <= least:
            what = "unit_" * (self.name == "crack") + ("GfI" if mode is MODES[0] else "GfII")
            elastic = strength**2 / (2 * stiffness)
            say(
                f"warning: materials.masonry: {what} {given:.4g} J/m² of the {self.name} joint"
                " softens more steeply than joint and rigid units are stiff and can snap back: it"
                f" must be above {least:.4g} J/m² (the elastic energy of the joint at its peak is"
                f" {elastic:.4g} J/m²)"
            )
        typical = index * strength
        source = f"{1e3 * index:g} mm times the strength, {INDEX_SOURCE}"
        if typical < MARGIN * least:
            source = (
                f"{MARGIN:g} times the least that does not snap back between rigid units;"
                f" {source} would be {typical:.3g} J/m²"
            )
        self.take(name, given, max(typical, MARGIN * least, 1e-3), source)

    def made(self):
        joint = MasonryJoint(name=self.name, **self.values)
        return state(joint, **joint.assumed(), **self.sources)


@dataclass(kw_only=True)
class DataSheet:
    """Masonry of one's own, from what a data sheet and tests of the masonry say. :func:`masonry`
    makes a :class:`Masonry` of it.

    ::

        clay = materials.masonry(
            E=4e9, unit_E=9e9, fc=10e6, fv0=0.2e6, friction=0.6, bond_wrench=0.3e6,
            unit=(0.25, 0.12, 0.065), joint=0.010, density=1800)

    What is not given is assumed by the formulas below; a scene prints it once, and run.json has it
    under ``assumed``. Codes (:func:`en1996`, :func:`ntc2018`) give some of these:

    :param E: Young's modulus of the masonry under compression across its bed joints [Pa]
    :param unit_E: Young's modulus of the bricks [Pa], above E
    :param fc: mean compressive strength of the masonry [Pa]; give this or ``fk``
    :param fk: characteristic compressive strength of the masonry [Pa]; fc is 1.2 fk, as in EN
        1052-1
    :param fv0: initial shear strength of the bed joints (EN 1052-3) [Pa], the cohesion
    :param friction: coefficient of friction of the bed joints [-]
    :param ft: **direct** tensile strength of the bed joints [Pa]; give this or ``bond_wrench``
    :param bond_wrench: strength of the bond in a bond wrench test (EN 1052-5) [Pa]. The test
        divides the moment by the elastic section modulus, but the bond has softened at its edge
        when it fails, so this overestimates: ft is bond_wrench/bond_ratio
    :param unit: length, thickness and height of a brick without mortar [m]
    :param joint: thickness of the mortar [m]
    :param density: of the masonry, bricks and mortar together [kg/m³]
    :param fm: never: in EN 1996 it is the strength of the mortar
    :param bond_ratio: flexural over direct tensile strength of the bond [-]; default 1.5, after van
        der Pluijm (1999)
    :param G: shear modulus of the masonry [Pa]: 1/ks = s (1/G - 1/Gu), where s = height + joint, Gu
        = unit_E/(2 (1 + nu)). Default: ks = kn/(2 (1 + nu)), so that G = E/(2 (1 + nu))
    :param head_E: Young's modulus along the courses [Pa]. Default: head joints are of the same
        mortar and as thick as bed joints, and have their stiffness
    :param poisson: nu of the bricks [-]; default 0.2, usual for masonry units
    :param GfI: mode I fracture energy of bed joints [J/m²]; default 0.029 mm times ft, Lourenço
        (2008)
    :param GfII: mode II fracture energy of bed joints without normal stress [J/m²]; default 0.093
        mm times fv0, from the same source
    :param Gc: compressive fracture energy [J/m²]; default as in :func:`compressiveFractureEnergy`
    :param peak_strain: strain of the masonry at fc [-]; default 2 fc/E, of a parabola with the
        initial modulus E: Kaushik, Rai and Jain (2007), J. Mater. Civ. Eng. 19(9)
    :param residual_friction: [-]; default: the friction
    :param dilatancy: tan(psi) [-]; default 0
    :param head_share: strengths and energies of tension and shear of head joints over those of bed
        joints [-]; default 1
    :param unit_ft: direct tensile strength of the bricks [Pa]. Default: bricks do not crack
    :param unit_GfI: mode I fracture energy of the bricks [J/m²]; default as GfI, of unit_ft
    :param unit_fv0: cohesion of the bricks [Pa]; default 2 unit_ft, as in the crack joints of
        :func:`calciumSilicate`
    :param unit_friction: coefficient of friction of cracks in bricks [-]; default 0.75, as in these
    :param unit_GfII: mode II fracture energy of the bricks [J/m²]; default as GfII, of unit_fv0
    :param clauses: of a code: by the name of an argument its value and what says it
    :raises Refused: with all problems at once

    Stiffness: bricks and joints in series have the modulus of the masonry, E across bed joints,
    head_E across head joints: 1/kn = s (1/E - 1/unit_E). For bed joints s = height + joint; for
    head joints s = length + joint, also of bricks in two rigid halves, whose crack surface leaves
    0.99 of the stiffness of a half. Blocks contain their mortar and have the modulus unit_E, rigid
    ones lumped into their joints.

    Crushing: the closure of a joint at its strength is ucp = s (peak_strain - fc/unit_E), and the
    law's peak ratio n = kn ucp/fc. Head joints have the same strength and Gc.

    Masonry whose peak strain is above 0.01 is a warning: its modulus is probably too small.

    An assumed energy in tension or shear is at least 1.1 :func:`leastEnergy`, so that softening
    does not snap back between rigid units; a given one below leastEnergy is a warning. Joints to
    platens take the bed joint.
    """

    E: Modulus
    unit_E: Modulus
    fv0: OfBond
    friction: Friction
    unit: Sides
    joint: Mortar
    density: Annotated[float, number("kg/m³", 100, 1e4)]
    fc: Crushing | None = None
    fk: Crushing | None = None
    fm: Annotated[None, _ofMortar] = None
    ft: OfBond | None = None
    bond_wrench: OfBond | None = None
    bond_ratio: Annotated[float, number("", 1, 5)] | None = None
    G: Modulus | None = None
    head_E: Modulus | None = None
    poisson: Annotated[float, number("", 0, 0.49)] | None = None
    GfI: Energy | None = None
    GfII: Energy | None = None
    Gc: Annotated[float, number("J/m²", 10, 1e7)] | None = None
    peak_strain: Annotated[float, number("", 1e-5, 0.1)] | None = None
    residual_friction: Friction | None = None
    dilatancy: Friction | None = None
    head_share: Annotated[float, number("", 0, 1)] | None = None
    unit_ft: OfBrick | None = None
    unit_GfI: EnergyOfBrick | None = None
    unit_fv0: OfBrick | None = None
    unit_friction: Friction | None = None
    unit_GfII: EnergyOfBrick | None = None
    clauses: Annotated[dict[str, Any], isA(dict)] | None = None

    @property
    def nu(self) -> float:
        """Poisson's ratio of the bricks [-]."""
        return 0.2 if self.poisson is None else self.poisson

    @property
    def shearing(self) -> float:
        """E/G of the bricks [-]."""
        return 2 * (1 + self.nu)

    @property
    def height(self) -> float:
        """Distance from one bed joint to the next [m]."""
        return self.unit[2] + self.joint

    @property
    def length(self) -> float:
        """Distance from one head joint to the next [m]."""
        return self.unit[0] + self.joint

    @property
    def compressive(self) -> Any:
        """Mean compressive strength of the masonry [Pa], or None."""
        return self.fc or self.fk and MEAN * self.fk

    @property
    def wrench(self) -> float:
        """Flexural over direct tensile strength of the bond [-]."""
        return WRENCH if self.bond_ratio is None else self.bond_ratio

    @property
    def tensile(self) -> Any:
        """Direct tensile strength of the bed joints [Pa], or None."""
        return self.ft if self.bond_wrench is None else self.bond_wrench / self.wrench

    def problems(self) -> list[str]:
        """Sentences on values that do not go together."""
        return [*_problems(self)]

    def masonry(self) -> Masonry:
        """The masonry of these values. Raises Refused with all problems."""
        _refuse(self.problems())
        joints, problems = {}, []
        for one in (*_mortarJoints(self), _crackJoint(self)):
            try:
                joints[one.name] = one.made()
            except ValueError as error:
                problems += _sentencesOf(error)
        _refuse(problems)
        if self.unit_ft is None:
            why = "unit_ft was not given: bricks do not crack"
            state(joints["crack"], **{**joints["crack"].assumed(), "elastic": why})
        brick = MasonryMat(label="brick", young=self.unit_E, poisson=self.nu, density=self.density)
        assumed = {"poisson": "usual for masonry units"} if self.poisson is None else {}
        state(joints["bed"], **{**joints["bed"].assumed(), **self._stated(OF_CLAUSES)})
        assumed |= self._stated({"density": "density"})
        return Masonry(state(brick, **assumed), joints, course=self.height)

    def _stated(self, names):
        """Sources of properties whose value is that of a clause; ``names``: by the arguments."""
        given = {**vars(self), "fc": self.compressive}
        of = {n: (self.clauses or {}).get(n, (None, "")) for n in names}
        stated = {n: why for n, (value, why) in of.items() if value and given[n] == value}
        return {names[n]: BY_CODE + why for n, why in stated.items()}


P = ParamSpec("P")


def _making(sheet: Callable[P, DataSheet]) -> Callable[P, Masonry]:
    """The function that makes the masonry of a data sheet, whose arguments and help it has."""

    def masonry(*args: P.args, **values: P.kwargs) -> Masonry:
        return sheet(*args, **values).masonry()

    signature = inspect.signature(sheet).replace(return_annotation=Masonry)
    vars(masonry).update(__signature__=signature)
    masonry.__doc__, masonry.__annotations__ = sheet.__doc__, DataSheet.__annotations__
    return validated(masonry)


masonry = _making(DataSheet)


def _refuse(problems):
    refuse([f"materials.masonry: {one}" for one in problems])


def _sentencesOf(error):
    """Sentences of a joint that is refused, with the arguments that decide."""
    for problem in error.problems:
        isSmall = problem["code"] == "smallEnergy"
        yield problem["text"] + "; Gc and peak_strain, and fc and E, decide" * isSmall


def _mortarJoints(v):
    bed, head = _Joint("bed"), _Joint("head")
    _stiffnesses(v, bed, head)
    _bond(v, bed, head)
    for joint in (bed, head):
        joint.values["friction"] = v.friction
        joint.take("residualFriction", v.residual_friction, v.friction, "the friction")
        joint.take("residualCohesion", None, 0.0, "no cohesion is left of a bond")
        joint.take("dilatancy", v.dilatancy, 0.0, "none")
    head.sources["friction"] = "like the bed joint"
    _crushing(v, bed, head)
    return bed, head


def _stiffnesses(v, bed, head):
    """Stiffness of bed and head joints: bricks and joints in series."""
    kn = bed.values["normalStiffness"] = 1 / (v.height * (1 / v.E - 1 / v.unit_E))
    own = v.G and 1 / (v.height * (1 / v.G - v.shearing / v.unit_E))
    G = v.E / v.shearing
    why = f"kn/(2 (1 + nu)), nu = {v.nu:g}: masonry has G = {G:.4g} Pa, {G / v.E:.2g} E"
    ks = bed.take("shearStiffness", own, kn / v.shearing, why)
    own = v.head_E and 1 / (v.length * (1 / v.head_E - 1 / v.unit_E))
    same = "like the bed joint: the same mortar, as thick"
    headKn = head.take("normalStiffness", own, kn, same)
    why = "the bed joint's ratio to kn" if own else same
    head.take("shearStiffness", None, headKn * ks / kn, why)


def _bond(v, bed, head):
    if v.bond_wrench is not None:
        reason = (
            f"bond_wrench {v.bond_wrench:g} Pa over {v.wrench:g}: linear stresses of the test"
            " overestimate"
        )
        reason += "; van der Pluijm (1999)" * (v.bond_ratio is None)
        bed.sources["tensileStrength"] = reason
    kn, ks = (bed.values[name] for name in ("normalStiffness", "shearStiffness"))
    headKn = head.values["normalStiffness"]
    share = 1.0 if v.head_share is None else v.head_share
    for mode, strength, stiffness, energy, soft in zip(
        MODES, (v.tensile, v.fv0), (kn, ks), (v.GfI, v.GfII), (1.0, v.shearing)
    ):
        bed.values[mode[1]] = strength
        if strength > 0:
            bed.energy(mode, strength, stiffness, soft * v.height / v.unit_E, energy)
        own = share * strength
        given = None if v.head_share is None else own
        head.take(mode[1], given, own, "like the bed joint")
        if own > 0:
            energy = None if energy is None else share * energy
            lumped = soft * v.length / v.unit_E  # of whole bricks
            head.energy(mode, own, stiffness * headKn / kn, lumped, energy)


def _crushing(v, bed, head):
    fc = v.compressive
    energy, source = (v.Gc, "") if v.Gc is not None else compressiveFractureEnergy(fc)
    if v.Gc is None and not MODEL_CODE[0] <= fc <= MODEL_CODE[1]:
        say(
            f"warning: materials.masonry: fc {fc / 1e6:g} MPa is outside of 12 to 80 MPa, the"
            f" range of Model Code 90 for the compressive fracture energy: Gc is {energy:.4g} J/m²,"
            f" {source}"
        )
    shortened = v.peak_strain or 2 * fc / v.E
    if shortened > MAX_PEAK_STRAIN:
        strain = "peak_strain" if v.peak_strain else "2 fc/E"
        say(
            f"warning: materials.masonry: with E {v.E:.4g} Pa and fc {fc:.4g} Pa masonry shortens"
            f" by {100 * shortened:.2g} % ({strain}) before it crushes, more than"
            f" {100 * MAX_PEAK_STRAIN:g} %: walls then lean and crush early. 2 fc/E is 0.24 % with"
            " E = 1000 fk of EN 1996-1-1, 3.7.2, and 0.3 to 0.5 % in table C8.5.I of Circolare"
            " 7/2019: is E of the masonry, and in Pa?"
        )
    bed.take("compressiveStrength", v.fc, fc, f"{MEAN:g} fk, EN 1052-1")
    head.take("compressiveStrength", None, fc, "like the bed joint")
    # without a modulus of its own the head joint is that of the bed
    along = (v.head_E, v.length) if v.head_E else (v.E, v.height)
    for joint, (modulus, spacing) in ((bed, (v.E, v.height)), (head, along)):
        joint.take("compressiveFractureEnergy", v.Gc, energy, source)
        strain = v.peak_strain or 2 * fc / modulus
        closure = spacing * (strain - fc / v.unit_E)
        n = joint.values["normalStiffness"] * closure / fc
        why = "peak strain 2 fc/E, parabola of Kaushik, Rai and Jain (2007)"
        joint.take("peakRatio", v.peak_strain and n, n, why)


def _crackJoint(v):
    halves = 0.5 * v.length / v.unit_E  # what is lumped into it [m/Pa]
    kn = 100 / halves
    crack = _Joint("crack", elastic=v.unit_ft is None)
    for name, stiffness in (("normal", kn), ("shear", kn / v.shearing)):
        crack.take(f"{name}Stiffness", None, stiffness, "100 times that of half a brick")
    if v.unit_ft is None:
        return crack
    like = "as of the crack joints of calciumSilicate()"
    crack.values.update(cap=False, tensileStrength=v.unit_ft)
    cohesion = crack.take("cohesion", v.unit_fv0, 2 * v.unit_ft, f"2 unit_ft, {like}")
    for name in ("friction", "residualFriction"):
        crack.take(name, v.unit_friction, 0.75, like)
    crack.take("residualCohesion", None, 0.0, "no cohesion is left of a bond")
    crack.take("dilatancy", None, 0.0, "none")
    crack.energy(MODES[0], v.unit_ft, kn, halves, v.unit_GfI)
    crack.energy(MODES[1], cohesion, kn / v.shearing, v.shearing * halves, v.unit_GfII)
    return crack


def _problems(v):
    if (v.fc is None) == (v.fk is None):
        yield "give fc, the mean compressive strength of the masonry, or fk, the characteristic one"
    if (v.ft is None) == (v.bond_wrench is None):
        yield (
            "give either ft, the direct tensile strength of bed joints, or bond_wrench, that of a"
            " bond wrench test"
        )
    if max(v.unit) > 5:
        yield f"unit {v.unit} m must be at most 5 m: is it in m?"
    elif v.joint >= min(v.unit[0], v.unit[2]):
        yield f"joint {v.joint:g} m must be below length and height of the unit {v.unit} m"
    for name, modulus in (("E", v.E), ("head_E", v.head_E)):
        if modulus and modulus >= v.unit_E:
            yield (
                f"{name} {modulus:g} Pa must be below unit_E {v.unit_E:g} Pa: bricks and joints are"
                " in series"
            )
    bound = v.unit_E / v.shearing
    if v.G and v.G >= bound:
        yield f"G {v.G:g} Pa must be below that of the bricks, unit_E/(2 (1 + nu)) = {bound:g} Pa"
    residual = v.friction if v.residual_friction is None else v.residual_friction
    for name, value, other, bound in (
        ("residual_friction", v.residual_friction, "friction", v.friction),
        ("dilatancy", v.dilatancy, "residual_friction", residual),
    ):
        if value and value > bound:
            yield f"{name} {value:g} must be at most {other} {bound:g}"
    slides = 0.75 if v.unit_friction is None else v.unit_friction
    source = "ft" if v.bond_wrench is None else f"bond_wrench/{v.wrench:g} ="
    for strength, name, cohesion, friction, names in (
        (v.tensile, source, v.fv0, v.friction, "fv0/friction"),
        (v.unit_ft, "unit_ft", v.unit_fv0, slides, "unit_fv0/unit_friction"),
    ):
        known = strength is not None and cohesion is not None
        if known and strength * friction > cohesion * (1 + 1e-12):
            yield (
                f"{name} {strength:g} Pa must be at most {names} = {cohesion / friction:g} Pa, the"
                " apex of the Coulomb cone"
            )
    fc = v.compressive
    if v.peak_strain and fc and v.peak_strain < fc / v.E:
        yield (
            f"peak_strain {v.peak_strain:g} must be at least fc/E = {fc / v.E:g}, that of elastic"
            " masonry"
        )
    if v.bond_ratio and v.bond_wrench is None:
        yield "bond_ratio goes with bond_wrench"
    needing = ("unit_GfI", "unit_fv0", "unit_friction", "unit_GfII")
    alone = [name for name in needing if getattr(v, name) is not None]
    if alone and v.unit_ft is None:
        yield f"{', '.join(alone)} without unit_ft: bricks do not crack then"
