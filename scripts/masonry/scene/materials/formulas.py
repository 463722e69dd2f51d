# SPDX-License-Identifier: GPL-2.0-or-later
"""Masonry of one's own from what a data sheet and tests say of it: joints by stated formulas."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Annotated, Any

from yade.wrapper import MasonryJoint, MasonryMat

from ...common.arguments import isA, number, validated
from ...basics import refuse, say
from ...bricks.blocks import Sides
from .assumptions import state
from .codes import MEAN
from .kinds import Masonry

#: Flexural strength of a bond over its direct tensile strength [-]: van der Pluijm, Out-of-plane bending of masonry
#: (Eindhoven, 1999) found about 1.5 in bond wrench tests.
WRENCH = 1.5

#: Fracture energy over strength [m] in tension and in shear without normal stress: the ductility indices that Lourenço,
#: Structural masonry analysis: recent developments and prospects (14th Int. Brick and Block Masonry Conference, 2008),
#: recommends.
TENSION_INDEX, SHEAR_INDEX = 0.029e-3, 0.093e-3
INDEX_SOURCE = "ductility index of Lourenço (2008)"

#: Range of the compressive fracture energy of Model Code 90 [Pa], and energy over strength below and above it [m].
MODEL_CODE = 12e6, 80e6
BELOW_RANGE, ABOVE_RANGE = 1.6e-3, 0.33e-3

#: What a clause of a code says of the bed joint, by the argument of :func:`masonry`.
OF_CLAUSES = dict(E="normalStiffness", G="shearStiffness", fc="compressiveStrength", fv0="cohesion", friction="friction", ft="tensileStrength")  # fmt: skip

#: By how much an assumed fracture energy is above the least that the law can follow [-].
MARGIN = 1.1

#: What the user gives. Beyond these bounds it is probably in another unit.
Modulus = Annotated[float, number("Pa", 1e6, 1e12)]
Crushing = Annotated[float, number("Pa", 1e4, 1e9)]
OfBond = Annotated[float, number("Pa", 0, 1e8)]  # a strength
OfBrick = Annotated[float, number("Pa", 1e3, 1e9)]  # likewise
Friction = Annotated[float, number("", 0, 5)]
Energy = Annotated[float, number("J/m²", 0.1, 1e5)]
EnergyOfBrick = Annotated[float, number("J/m²", 0.1, 1e6)]
Mortar = Annotated[float, number("m", 0, 0.1)]


def _ofMortar(value, first=None):
    """The kind of an argument that is never right."""
    raise ValueError(
        "is the strength of the mortar in EN 1996 and on data sheets: give fc, the mean strength of the masonry, or fk; "
        "materials.en1996 finds it from unit and mortar"
    )


@validated
def compressiveFractureEnergy(fc: Crushing) -> tuple[float, str]:
    """Compressive fracture energy of masonry [J/m²], and where it is from.

    Gc = 15 + 0.43 fc - 0.0036 fc² with fc in MPa and Gc in N/mm, for fc from 12 to 80 MPa, after Model Code 90; below and
    above that 1.6 mm and 0.33 mm times fc, as Lourenço (2008) recommends.

    :param fc: compressive strength [Pa]
    """
    low, high = MODEL_CODE
    if fc < low:
        return BELOW_RANGE * fc, "1.6 mm·fc, Lourenço (2008) for fc below 12 MPa"
    if fc > high:
        return ABOVE_RANGE * fc, "0.33 mm·fc, Lourenço (2008) for fc above 80 MPa"
    found = fc / 1e6
    return (
        1e3 * (15 + 0.43 * found - 0.0036 * found**2),
        "15 + 0.43 fc - 0.0036 fc² N/mm, Model Code 90 after Lourenço (2008)",
    )


@validated
def leastEnergy(
    strength: Annotated[float, number("Pa", 0, 1e12)],
    stiffness: Annotated[float, number("Pa/m", 0, above=True)],
    lumped: Annotated[float, number("m/Pa", 0)] = 0.0,
) -> float:
    """The least fracture energy [J/m²] with which the law softens as it is asked to.

    Below strength²/stiffness, twice the elastic energy at the peak, the law takes another energy; below half of that no
    law could take it, since softening would snap back. Between rigid units, which have their elasticity lumped into the
    joint, softening snaps back below strength² (lumped + 1/(2 stiffness)): yade_plugin/law/README.md, Softening and Rigid
    units.

    :param strength: [Pa]
    :param stiffness: of the joint [Pa/m]
    :param lumped: distance of the units' centroids over their modulus [m/Pa]
    """
    return strength**2 * max(1 / stiffness, lumped + 0.5 / stiffness)


@dataclass
class _Kind:
    """A joint while it is made: its properties, and the sources of those that are assumed."""

    name: str
    values: dict
    sources: dict = field(default_factory=dict)

    def take(self, name, value, given, source):
        """Take a property; ``given`` says whether the user gave it, else it is assumed by ``source``."""
        self.values[name] = value
        if not given:
            self.sources[name] = source

    def energy(self, name, strength, stiffness, lumped, given, index):
        """Take a fracture energy. One that is assumed is large enough; of one that is given and too small a warning."""
        what = "GfII" if "II" in name else "GfI"
        what = f"unit_{what}" if self.name == "crack" else what
        least = leastEnergy(strength, stiffness, lumped)
        if given is not None:
            if given <= least:
                elastic = strength**2 / (2 * stiffness)
                say(
                    f"warning: materials.masonry: {what} {given:.4g} J/m² of the {self.name} joint softens more steeply than "
                    f"joint and rigid units are stiff and can snap back: it must be above {least:.4g} J/m² (the "
                    f"elastic energy of the joint at its peak is {elastic:.4g} J/m²)"
                )
            self.values[name] = given
            return
        typical = index * strength
        source = f"{1e3 * index:g} mm times the strength, {INDEX_SOURCE}"
        if typical < MARGIN * least:
            source = (
                f"{MARGIN:g} times the least that does not snap back between rigid units; {source} would be "
                f"{typical:.3g} J/m²"
            )
        self.take(name, max(typical, MARGIN * least, 1e-3), False, source)

    def made(self):
        joint = MasonryJoint(name=self.name, **self.values)
        return state(joint, **joint.assumed(), **self.sources)


@validated
def masonry(
    *,
    E: Modulus,
    unit_E: Modulus,
    fv0: OfBond,
    friction: Friction,
    unit: Sides,
    joint: Mortar,
    density: Annotated[float, number("kg/m³", 100, 1e4)],
    fc: Crushing | None = None,
    fk: Crushing | None = None,
    fm: Annotated[None, _ofMortar] = None,
    ft: OfBond | None = None,
    bond_wrench: OfBond | None = None,
    bond_ratio: Annotated[float, number("", 1, 5)] | None = None,
    G: Modulus | None = None,
    head_E: Modulus | None = None,
    poisson: Annotated[float, number("", 0, 0.49)] | None = None,
    GfI: Energy | None = None,
    GfII: Energy | None = None,
    Gc: Annotated[float, number("J/m²", 10, 1e7)] | None = None,
    peak_strain: Annotated[float, number("", 1e-5, 0.1)] | None = None,
    residual_friction: Friction | None = None,
    dilatancy: Friction | None = None,
    head_share: Annotated[float, number("", 0, 1)] | None = None,
    unit_ft: OfBrick | None = None,
    unit_GfI: EnergyOfBrick | None = None,
    unit_fv0: OfBrick | None = None,
    unit_friction: Friction | None = None,
    unit_GfII: EnergyOfBrick | None = None,
    clauses: Annotated[dict[str, Any], isA(dict)] | None = None,
) -> Masonry:
    """Masonry of one's own, from what a data sheet and tests of the masonry say. Returns a :class:`Masonry`.

    ::

        clay = materials.masonry(
            E=4e9, unit_E=9e9, fc=10e6, fv0=0.2e6, friction=0.6, bond_wrench=0.3e6,
            unit=(0.25, 0.12, 0.065), joint=0.010, density=1800)

    What is not given is assumed by the formulas below; a scene prints it once, and run.json has it under ``assumed``.
    These must be given, by hand or by a code (:func:`en1996`, :func:`ntc2018`):

    :param E: Young's modulus of the masonry under compression across its bed joints [Pa]
    :param unit_E: Young's modulus of the bricks [Pa], above E
    :param fc: mean compressive strength of the masonry [Pa]; give this or ``fk``
    :param fk: characteristic compressive strength of the masonry [Pa]; fc is 1.2 fk, as in EN 1052-1
    :param fv0: initial shear strength of the bed joints (EN 1052-3) [Pa], the cohesion
    :param friction: coefficient of friction of the bed joints [-]
    :param ft: **direct** tensile strength of the bed joints [Pa]; give this or ``bond_wrench``
    :param bond_wrench: strength of the bond in a bond wrench test (EN 1052-5) [Pa]. It is no direct tensile strength: the
        test divides the moment by the elastic section modulus, as if stresses were linear when the bond fails, but by
        then the bond has softened at its edge and the stresses behind it have grown, so that it overestimates. ft is
        bond_wrench/bond_ratio
    :param unit: length, thickness and height of a brick without mortar [m]
    :param joint: thickness of the mortar [m]
    :param density: of the masonry, bricks and mortar together [kg/m³], since blocks contain their mortar

    These can be given:

    :param fm: never: in EN 1996 it is the strength of the mortar
    :param bond_ratio: flexural over direct tensile strength of the bond [-]; default 1.5, after van der Pluijm (1999)
    :param G: shear modulus of the masonry [Pa]: 1/ks = s (1/G - 1/Gu), where s = height + joint, Gu = unit_E/(2 (1 + nu)).
        Default: ks = kn/(2 (1 + nu))
    :param head_E: Young's modulus along the courses [Pa]. Default: head joints are of the same mortar and as thick as bed
        joints, and have their stiffness
    :param poisson: nu of the bricks [-]; default 0.2, usual for masonry units
    :param GfI: mode I fracture energy of bed joints [J/m²]; default 0.029 mm times ft, Lourenço (2008)
    :param GfII: mode II fracture energy of bed joints without normal stress [J/m²]; default 0.093 mm times fv0, Lourenço
        (2008)
    :param Gc: compressive fracture energy [J/m²]; default as in :func:`compressiveFractureEnergy`
    :param peak_strain: strain of the masonry at fc [-]; default 2 fc/E, that of a parabola which begins with the modulus
        E, the branch up to the peak of Kaushik, Rai and Jain (2007), J. Mater. Civ. Eng. 19(9)
    :param residual_friction: [-]; default: the friction
    :param dilatancy: tan(psi) [-]; default 0
    :param head_share: strengths and energies of tension and shear of head joints over those of bed joints [-]; default 1
    :param unit_ft: direct tensile strength of the bricks [Pa]. Default: bricks do not crack
    :param unit_GfI: mode I fracture energy of the bricks [J/m²]; default 0.029 mm times unit_ft, Lourenço (2008)
    :param unit_fv0: cohesion of the bricks [Pa]; default 2 unit_ft, as in the crack joints of :func:`calciumSilicate`
    :param unit_friction: coefficient of friction of cracks in bricks [-]; default 0.75, as in these
    :param unit_GfII: mode II fracture energy of the bricks [J/m²]; default 0.093 mm times unit_fv0, Lourenço (2008)
    :param clauses: of a code: by the name of an argument its value and what says it
    :raises Refused: with all problems at once

    Stiffness: bricks and joints in series have the modulus of the masonry, E of bed joints, head_E of head joints:
    1/kn = s (1/E - 1/unit_E). For bed joints s = height + joint; for head joints s = length + joint, the distance from one
    to the next, also of bricks that are two rigid halves, because the halves together are as long. Their crack surface
    is so stiff that it leaves 0.99 of the stiffness of a half. Blocks contain their mortar and have the modulus unit_E,
    rigid ones lumped into their joints.

    Crushing: the closure of a joint at its strength is ucp = s (peak_strain - fc/unit_E), what the bricks leave of the
    strain, and the law's peak ratio n = kn ucp/fc. Head joints have the same strength and Gc.

    An assumed energy in tension or shear with which softening would snap back between rigid units is raised to 1.1 times
    the least that does not, and its source says so; a given one that is too small is a warning with that least.
    :func:`leastEnergy` has the formula. Joints to platens take the bed joint.
    """
    values = SimpleNamespace(**locals())
    given = {n: v for n, v in vars(values).items() if v is not None}
    problems = []
    if ("fc" in given) == ("fk" in given):
        problems.append("give fc, the mean compressive strength of the masonry, or fk, the characteristic one")  # fmt: skip
    elif fk is not None:
        values.fc = given["fc"] = MEAN * fk
    problems += _problems(given)
    refuse([f"materials.masonry: {one}" for one in problems])
    joints = {}
    for kind in (*_mortarJoints(values), _crackJoint(values)):
        try:
            joints[kind.name] = kind.made()
        except ValueError as error:
            problems += [
                f"{one}; Gc and peak_strain, and fc and E, decide"
                * ("too small for peak ratio" in one)
                or one
                for one in str(error).splitlines()
            ]
    refuse([f"materials.masonry: {one}" for one in problems])
    if unit_ft is None:
        why = "unit_ft was not given: bricks do not crack"
        state(joints["crack"], **{**joints["crack"].assumed(), "elastic": why})
    nu = _poisson(values)
    brick = MasonryMat(label="brick", young=unit_E, poisson=nu, density=density)
    assumed = {"poisson": "usual for masonry units"} if poisson is None else {}
    state(
        joints["bed"],
        **{**joints["bed"].assumed(), **_stated(clauses, given, OF_CLAUSES)},
    )
    assumed |= _stated(clauses, given, {"density": "density"})
    return Masonry(state(brick, **assumed), joints, course=unit[2] + joint)


def _stated(clauses, given, names):
    """Sources of properties of which a clause says the value that is given.

    :param names: of the properties by the arguments
    """
    of = {n: clauses[n] for n in names if clauses and n in clauses}
    return {names[n]: why for n, (value, why) in of.items() if given.get(n) == value}


def _poisson(v):
    return 0.2 if v.poisson is None else v.poisson


def _spacings(v):
    """The distances from one bed joint to the next, and from one head joint to the next [m]."""
    return v.unit[2] + v.joint, v.unit[0] + v.joint


def _mortarJoints(v):
    bed, head = _Kind("bed", {}), _Kind("head", {})
    _stiffnesses(v, bed, head)
    _bond(v, bed, head)
    lasting = v.friction if v.residual_friction is None else v.residual_friction
    for kind in (bed, head):
        kind.values["friction"] = v.friction
        given = v.residual_friction is not None
        kind.take("residualFriction", lasting, given, "the friction")
        kind.take("residualCohesion", 0.0, False, "no cohesion is left of a bond")
        kind.take("dilatancy", v.dilatancy or 0.0, v.dilatancy is not None, "none")
    head.sources["friction"] = "like the bed joint"
    _crushing(v, bed, head)
    return bed, head


def _stiffnesses(v, bed, head):
    """Stiffness of bed and head joints: bricks and joints in series."""
    height, length = _spacings(v)
    nu = _poisson(v)
    shearing = 2 * (1 + nu)  # E/G of the bricks [-]
    kn = 1 / (height * (1 / v.E - 1 / v.unit_E))
    ks = kn / shearing
    if v.G is not None:
        ks = 1 / (height * (1 / v.G - shearing / v.unit_E))
    bed.values["normalStiffness"] = kn
    bed.take("shearStiffness", ks, v.G is not None, f"kn/(2 (1 + nu)), nu = {nu:g}")
    same = "like the bed joint: the same mortar, as thick"
    alike = v.head_E is None
    headKn = kn if alike else 1 / (length * (1 / v.head_E - 1 / v.unit_E))
    head.take("normalStiffness", headKn, not alike, same)
    why = same if alike else "the bed joint's ratio to kn"
    head.take("shearStiffness", headKn * ks / kn, False, why)


def _bond(v, bed, head):
    """Strength and energy of bed and head joints in tension and in shear."""
    ft = v.ft
    if ft is None:
        factor = WRENCH if v.bond_ratio is None else v.bond_ratio
        ft = v.bond_wrench / factor
        reason = f"bond_wrench {v.bond_wrench:g} Pa over {factor:g}: linear stresses of the test overestimate"
        if v.bond_ratio is None:
            reason += "; van der Pluijm (1999)"
        bed.sources["tensileStrength"] = reason
    height, length = _spacings(v)
    kn, ks = (bed.values[name] for name in ("normalStiffness", "shearStiffness"))
    headKn, shearing = head.values["normalStiffness"], 2 * (1 + _poisson(v))
    energies = (
        ("modeIFractureEnergy", "tensileStrength", ft, kn, v.GfI, TENSION_INDEX, 1.0),
        ("modeIIFractureEnergy", "cohesion", v.fv0, ks, v.GfII, SHEAR_INDEX, shearing),
    )
    share = 1.0 if v.head_share is None else v.head_share
    for name, strengthName, strength, stiffness, energy, index, soft in energies:
        bed.values[strengthName] = strength
        if strength > 0:
            lumped = soft * height / v.unit_E
            bed.energy(name, strength, stiffness, lumped, energy, index)
        given = v.head_share is not None
        head.take(strengthName, share * strength, given, "like the bed joint")
        if share * strength > 0:
            own = stiffness * headKn / kn
            energy = None if energy is None else share * energy
            lumped = soft * length / v.unit_E  # of whole bricks
            head.energy(name, share * strength, own, lumped, energy, index)


def _crushing(v, bed, head):
    """Strength, energy and peak ratio of bed and head joints in compression."""
    energy, source = (v.Gc, "") if v.Gc is not None else compressiveFractureEnergy(v.fc)
    if v.Gc is None and not MODEL_CODE[0] <= v.fc <= MODEL_CODE[1]:
        say(
            f"warning: materials.masonry: fc {v.fc / 1e6:g} MPa is outside of 12 to 80 MPa, the range of Model Code 90 for the "
            f"compressive fracture energy: Gc is {energy:.4g} J/m², {source}"
        )
    height, length = _spacings(v)
    # without a modulus of its own the head joint is that of the bed
    along = (v.E, height) if v.head_E is None else (v.head_E, length)
    for kind, (modulus, spacing) in ((bed, (v.E, height)), (head, along)):
        isGiven = kind is bed and v.fk is None
        kind.take("compressiveStrength", v.fc, isGiven, f"{MEAN:g} fk, EN 1052-1" if kind is bed else "like the bed joint")  # fmt: skip
        kind.take("compressiveFractureEnergy", energy, v.Gc is not None, source)
        strain = 2 * v.fc / modulus if v.peak_strain is None else v.peak_strain
        closure = spacing * (strain - v.fc / v.unit_E)
        why = "peak strain 2 fc/E, parabola of Kaushik, Rai and Jain (2007)"
        n = kind.values["normalStiffness"] * closure / v.fc
        kind.take("peakRatio", n, v.peak_strain is not None, why)


def _crackJoint(v):
    halves = 0.5 * _spacings(v)[1] / v.unit_E  # what is lumped into it [m/Pa]
    shearing = 2 * (1 + _poisson(v))
    crack = _Kind("crack", {"elastic": True})
    kn = 100 / halves
    stiff = "100 times that of half a brick"
    crack.take("normalStiffness", kn, False, stiff)
    crack.take("shearStiffness", kn / shearing, False, stiff)
    if v.unit_ft is None:
        return crack
    like = "as of the crack joints of calciumSilicate()"
    crack.values.update(elastic=False, cap=False, tensileStrength=v.unit_ft)
    cohesion = 2 * v.unit_ft if v.unit_fv0 is None else v.unit_fv0
    slides = 0.75 if v.unit_friction is None else v.unit_friction
    crack.take("cohesion", cohesion, v.unit_fv0 is not None, f"2 unit_ft, {like}")
    for name in ("friction", "residualFriction"):
        crack.take(name, slides, v.unit_friction is not None, like)
    crack.take("residualCohesion", 0.0, False, "no cohesion is left of a bond")
    crack.take("dilatancy", 0.0, False, "none")
    for name, strength, stiffness, lumped, energy, index in (
        ("modeIFractureEnergy", v.unit_ft, kn, halves, v.unit_GfI, TENSION_INDEX),
        ("modeIIFractureEnergy", cohesion, kn / shearing, shearing * halves, v.unit_GfII, SHEAR_INDEX),
    ):  # fmt: skip
        crack.energy(name, strength, stiffness, lumped, energy, index)
    return crack


def _problems(given):
    found = []
    if ("ft" in given) == ("bond_wrench" in given):
        found.append(
            "give either ft, the direct tensile strength of bed joints, or bond_wrench, that of a bond wrench test"
        )
    n, length, height = given.get, given["unit"][0], given["unit"][2]
    if max(given["unit"]) > 5:
        found.append(f"unit {given['unit']} m must be at most 5 m: is it in m?")
    elif given["joint"] >= min(length, height):
        found.append(f"joint {given['joint']:g} m must be below length and height of the unit {given['unit']} m")  # fmt: skip
    for one in ("E", "head_E"):
        if n(one) is not None and n("unit_E") is not None and not n(one) < n("unit_E"):
            found.append(
                f"{one} {n(one):g} Pa must be below unit_E {n('unit_E'):g} Pa: bricks and joints are in series"
            )
    if n("G") and n("unit_E"):
        most = n("unit_E") / (2 * (1 + n("poisson", 0.2)))
        if not n("G") < most:
            found.append(
                f"G {n('G'):g} Pa must be below that of the bricks, unit_E/(2 (1 + nu)) = {most:g} Pa"
            )
    pairs = [("residual_friction", "friction"), ("dilatancy", "residual_friction")]
    for one, other in pairs:
        most = n(other, n("friction"))
        if n(one) is not None and most is not None and n(one) > most:
            found.append(f"{one} {n(one):g} must be at most {other} {most:g}")
    found += _aboveCone(n)
    strains = None not in (n("peak_strain"), n("fc"), n("E"))
    if strains and n("peak_strain") < n("fc") / n("E"):
        found.append(
            f"peak_strain {n('peak_strain'):g} must be at least fc/E = {n('fc') / n('E'):g}, that of elastic masonry"
        )
    if "bond_ratio" in given and "bond_wrench" not in given:
        found.append("bond_ratio goes with bond_wrench")
    alone = [one for one in ("unit_GfI", "unit_fv0", "unit_friction", "unit_GfII") if one in given]  # fmt: skip
    if alone and "unit_ft" not in given:
        found.append(f"{', '.join(alone)} without unit_ft: bricks do not crack then")
    return found


def _aboveCone(n):
    """Sentences on tensile strengths above the apex of the Coulomb cone.

    :param n: function of a name that gives what was given, or None
    """
    tensile, source = n("ft"), "ft"
    if n("bond_wrench") is not None:
        ratio = n("bond_ratio", WRENCH)
        tensile, source = n("bond_wrench") / ratio, f"bond_wrench/{ratio:g} ="
    bond = tensile, source, n("fv0"), n("friction"), "fv0/friction"
    cracks = n("unit_ft"), "unit_ft", n("unit_fv0"), n("unit_friction", 0.75), "unit_fv0/unit_friction"  # fmt: skip
    for strength, what, cohesion, slides, names in (bond, cracks):
        known = None not in (strength, cohesion, slides)
        if known and strength * slides > cohesion * (1 + 1e-12):
            yield (
                f"{what} {strength:g} Pa must be at most {names} = {cohesion / slides:g} Pa, the apex of the Coulomb cone"
            )
