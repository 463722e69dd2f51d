# SPDX-License-Identifier: GPL-2.0-or-later
"""The target displacement of a structure by the N2 method, EN 1998-1:2004, annex B.

Equations have the numbers of the annex. Units are those of curve.csv: mm, kN, and accelerations in
m/s².
"""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any

from masonry.arguments import Numbers, isA, isNumber, listOf, number, validated
from masonry.errors import Refused
from .bilinear_curve import Bilinear, Pushover
from .bilinear_curve import ofRun as bilinearOf
from masonry.numbers.files import filesOf
from masonry.numbers.quantities import Number
from .spectra import Spectrum

#: Names and units of the answers of a script by which a run says its equivalent system
#: (``scene.result``).
MASS, GAMMA = ("equivalent_mass", "kg"), ("participation_factor", "-")
ANNEX = "EN 1998-1:2004, annex B"
#: Rounds of :func:`iterated` at most, and the difference of two target displacements at which it
#: ends [-].
MAX_ROUNDS, SAME_DISPLACEMENT = 50, 1e-4
#: The largest ratio of the target displacement to that of the elastic system that annex B asks for
#: [-].
MAX_ELASTIC_RATIO = 3.0


@dataclass(frozen=True)
class Equivalent:
    """The equivalent system with one degree of freedom."""

    mass: float  #: m*, equation (B.2) [kg]
    gamma: float  #: transformation factor Γ, equation (B.3) [-]
    source: str  #: where both come from, a sentence


@validated
def equivalent(
    mass: Annotated[float, number("kg", 0, 1e12, above=True)],
    gamma: Annotated[float, number("-", 0, 100, above=True)],
) -> Equivalent:
    """The equivalent system of a mass and a transformation factor that are known.

    :param mass: m* [kg]
    :param gamma: Γ [-]; 1 where the whole mass moves with the point whose displacement is recorded
    """
    return Equivalent(mass, gamma, "mass and transformation factor are given")


@validated
def ofMasses(
    masses: Annotated[Numbers, listOf(number("kg", 0, above=True))],
    shape: Annotated[Numbers, listOf(number())],
) -> Equivalent:
    """The equivalent system of masses that move along a shape, equations (B.2) and (B.3).

    :param masses: of the storeys or points (n) [kg]
    :param shape: their displacements over that of the point whose displacement the push records (n)
        [-]
    :raises Refused: with what is wrong
    """
    if len(masses) != len(shape):
        raise Refused(
            "masses and shape must be lists of equal length: a mass [kg] and a displacement [-] for"
            " each point"
        )
    mass = float(sum(m * p for m, p in zip(masses, shape)))
    squares = float(sum(m * p * p for m, p in zip(masses, shape)))
    if mass <= 0:
        raise Refused(
            f"the equivalent mass of masses {masses!r} with the shape {shape!r} is {mass:.4g} kg,"
            " it must be above 0"
        )
    listed = lambda values: ", ".join(f"{v:g}" for v in values)
    return Equivalent(
        mass,
        mass / squares,
        f"masses of {listed(masses)} kg with the shape {listed(shape)}, equations (B.2) and (B.3)",
    )


@validated
def ofRun(run: Annotated[dict[str, Any], isA(dict)], directory: str = "run.json") -> Equivalent:
    """The equivalent system that a run has: its script says it by ``scene.result("equivalent_mass",
    30e3, "kg")`` and ``scene.result("participation_factor", 1.0)``.

    :param run: entries of run.json
    :param directory: folder, for messages
    :raises Refused: if mass or factor are missing, with how they are given
    """
    found, missing = [], []
    with filesOf(directory):
        answers = {a["name"]: a for a in run.get("answers", [])}
    for name, unit in (MASS, GAMMA):
        one = answers.get(name, {})
        if not isNumber(one.get("value")):
            missing.append(name)
        elif one.get("unit") != unit:
            raise Refused(
                f"{directory}: the answer {name} has the unit {one.get('unit')!r}, it must be in"
                f" {unit!r}"
            )
        else:
            found.append(one["value"])
    if missing:
        raise Refused(
            f"{directory}: run.json has no {' and no '.join(missing)}, and neither is guessed: give"
            " the equivalent mass m* and the factor Γ (--mass KG --gamma G; --masses KG,KG --shape"
            f' PHI,PHI), or say them in the script: scene.result("{MASS[0]}", 30e3, "kg") and'
            f' scene.result("{GAMMA[0]}", 1.0)'
        )
    return replace(equivalent(*found), source=f"answers of the script in {directory}")


@dataclass(frozen=True)
class Demand:
    """What :func:`demand` found. An asterisk of the annex is ``equivalent`` here: of the equivalent
    system."""

    curve: Bilinear  #: of the structure
    system: Equivalent
    spectrum: Spectrum
    period: float  #: T* [s]
    strength: float  #: Fy*/m* [m/s²]
    elasticAcceleration: float  #: Se(T*) [m/s²]
    elasticDisplacement: float  #: det* [mm]
    equivalentDisplacement: float  #: dt* [mm]
    targetDisplacement: float  #: dt, of the structure [mm]
    ductility: float  #: dt*/dy* [-]
    reduction: float  #: qu, Se(T*) over Fy*/m* [-]
    branch: str  #: number of the equation that gave dt*
    #: by which the spectrum may be multiplied until the demand is the ultimate displacement [-]
    scale: float
    holds: bool | None  #: whether du is at least dt; None: the curve ends before that can be seen
    notes: tuple[str, ...]  #: sentences

    def verdict(self) -> str:
        """Whether the capacity exceeds the demand, as a sentence."""
        has, needs = self.curve.ultimateDisplacement, self.targetDisplacement
        if self.holds is None:
            return (
                f"not known: the demand is {needs:.4g} mm, and the push was not taken to its"
                f" ultimate displacement, it ends at {has:.4g} mm: push farther"
            )
        verb = "exceeds" if self.holds else "does not reach"
        ratio = f"{has:.4g} mm is {has / needs:.3g} times {needs:.4g} mm"
        return f"the capacity {verb} the demand: {ratio}"

    def numbers(self) -> list[Number]:
        """All numbers, each with its unit, its meaning and its source."""
        b = lambda equation: f"{ANNEX}, equation (B.{equation})"
        curve, gamma = self.curve, self.system.gamma
        end = (
            "the push was not taken to its ultimate displacement: the end of the curve stands for"
            " it"
        )
        end = "" if curve.reached else end
        return [
            Number(
                "equivalent_mass_kg",
                self.system.mass,
                "kg",
                "Mass m* of the equivalent system.",
                self.system.source,
            ),
            Number(
                "participation_factor",
                gamma,
                "-",
                (
                    "Factor by which displacements and forces of the structure are those of the"
                    " equivalent system."
                ),
                self.system.source,
            ),
            Number(
                "equivalent_yield_force_kN",
                curve.yieldForce / gamma,
                "kN",
                "Yield force Fy* of the equivalent system.",
                b(4),
            ),
            Number(
                "equivalent_yield_displacement_mm",
                curve.yieldDisplacement / gamma,
                "mm",
                "Yield displacement dy* of the equivalent system.",
                b(5),
            ),
            Number(
                "equivalent_period_s", self.period, "s", "Period T* of the equivalent system.", b(7)
            ),
            Number(
                "elastic_acceleration_m_per_s2",
                self.elasticAcceleration,
                "m/s²",
                "Acceleration Se of the elastic spectrum at T*.",
                self.spectrum.source,
            ),
            Number(
                "yield_acceleration_m_per_s2",
                self.strength,
                "m/s²",
                "Yield force over mass of the equivalent system.",
                b(11),
            ),
            Number(
                "force_ratio",
                self.reduction,
                "-",
                "Ratio qu of the force that an elastic system would feel to the yield force.",
                b(11),
            ),
            Number(
                "elastic_displacement_mm",
                self.elasticDisplacement,
                "mm",
                "Displacement det* of an elastic system with the period T*.",
                b(8),
            ),
            Number(
                "equivalent_target_displacement_mm",
                self.equivalentDisplacement,
                "mm",
                "Target displacement dt* of the equivalent system.",
                f"{ANNEX}, equation ({self.branch})",
            ),
            Number(
                "target_displacement_mm",
                self.targetDisplacement,
                "mm",
                "Target displacement dt of the structure: the demand.",
                b(13),
            ),
            Number(
                "ductility_demand",
                self.ductility,
                "-",
                "Target displacement over yield displacement.",
                ANNEX,
            ),
            Number(
                "capacity_over_demand",
                curve.ultimateDisplacement / self.targetDisplacement,
                "-",
                "Ultimate displacement over target displacement.",
                "capacity over demand",
                end,
            ),
            Number(
                "spectrum_factor_held",
                self.scale,
                "-",
                (
                    "Factor by which the spectrum may be multiplied until the target displacement"
                    " is the ultimate displacement."
                ),
                f"{ANNEX}, solved for the spectrum",
                end,
            ),
        ]


#: What :func:`demand` takes.
System = Annotated[Equivalent, isA(Equivalent)]
Elastic = Annotated[Spectrum, isA(Spectrum)]


@validated
def demand(
    curve: Annotated[Bilinear, isA(Bilinear)],
    system: System,
    spectrum: Elastic,
    limited: bool = False,
) -> Demand:
    """The target displacement that a spectrum demands of a structure, EN 1998-1:2004, annex B.

    :param curve: bilinear curve of the structure; the annex has the rule ``en1998``
    :param system: of :func:`equivalent`, :func:`ofMasses` or :func:`ofRun`
    :param spectrum: of :func:`masonry_capacity.elastic` or :func:`masonry_capacity.readSpectrum`
    :param limited: whether the target displacement is at most 3 det*, which annex B allows; else it
        is what equation (B.10) gives, which is more where the period is short
    :raises Refused: if the spectrum does not have the period of the structure
    """
    gamma, mass = system.gamma, system.mass
    yields = curve.yieldDisplacement / gamma
    strength = 1e3 * curve.yieldForce / gamma / mass
    period = 2 * math.pi * math.sqrt(1e-3 * yields / strength)
    try:
        needed = spectrum.acceleration(period)
    except Refused as refused:
        raise Refused(f"the equivalent period (B.7) is {period:.4g} s: {refused}") from None
    if not needed > 0:
        raise Refused(
            f"the spectrum ({spectrum.name}) is zero at the equivalent period, {period:.4g} s"
        )
    elastic = spectrum.displacement(period)
    ratio, corner = needed / strength, spectrum.corner
    short = period < corner
    target, branch, notes = elastic, "B.9" if short else "B.12", []
    if short and ratio > 1:
        branch = "B.10"
        target = max(elastic, elastic / ratio * (1 + (ratio - 1) * corner / period))
        most = MAX_ELASTIC_RATIO * elastic
        if target > most and limited:
            target, branch = most, "B.10, at most 3 det*"
        elif target > most:
            notes.append(
                "annex B lets the target displacement of the equivalent system be at most 3 det*,"
                f" {most:.4g} mm, in place of {target:.4g} mm (limited=True, --limited)"
            )
    ultimate = curve.ultimateDisplacement / gamma
    scale = _scale(ultimate / yields, corner / period if short else 1.0, limited) / ratio
    moved = gamma * target
    enough = curve.ultimateDisplacement >= moved
    return Demand(
        curve=curve,
        system=system,
        spectrum=spectrum,
        period=period,
        strength=strength,
        elasticAcceleration=needed,
        elasticDisplacement=elastic,
        equivalentDisplacement=target,
        targetDisplacement=moved,
        ductility=target / yields,
        reduction=ratio,
        branch=branch,
        scale=scale,
        holds=enough or (False if curve.reached else None),
        notes=(*notes, *_remarks(curve, moved, ratio)),
    )


def _remarks(curve, target, ratio):
    """Sentences on a capacity curve, the target displacement of its structure [mm] and the ratio
    qu."""
    if curve.ultimateDisplacement < 1.5 * target and not curve.reached:
        yield (
            "EN 1998-1:2004, 4.3.3.4.2.3(1), wants a capacity curve up to 1.5 times the target"
            f" displacement, {1.5 * target:.4g} mm; this one ends at"
            f" {curve.ultimateDisplacement:.4g} mm"
        )
    if ratio <= 1:
        yield "the structure stays below its yield force"
    if curve.rule != "en1998":
        yield "the bilinear curve is not that of annex B.3, but of the convention for masonry walls"


def _scale(ductility, corner, limited):
    """The ratio qu at which the demand is a ductility of at least 1: (B.9), (B.10) or (B.12) solved
    for qu.

    :param corner: TC/T*, or 1 where the period is longer
    """
    ratio = 1 + (ductility - 1) / corner
    return max(ratio, ductility / MAX_ELASTIC_RATIO) if limited else ratio


@validated
def iterated(
    push: Annotated[Pushover, isA(Pushover)],
    system: System,
    spectrum: Elastic,
    limited: bool = False,
) -> Demand:
    """The target displacement by the iterative procedure of EN 1998-1:2004, annex B: the plastic
    mechanism forms at the target displacement, which is found again until both agree. Where the
    procedure leads nowhere, a note says so, and the result is that of its last round.

    :param push: of :func:`masonry_capacity.bilinear_curve.pushover`; other parameters and errors as
        in :func:`demand`
    """
    found = demand(bilinearOf(push, "en1998"), system, spectrum, limited)
    for _ in range(MAX_ROUNDS):
        target, before = found.targetDisplacement, found.curve
        if abs(target - before.mechanism) <= SAME_DISPLACEMENT * target:
            return found
        if target > before.ultimateDisplacement:
            return _notIterated(
                found,
                f"the target displacement, {target:.4g} mm, is beyond the ultimate displacement",
            )
        try:
            curve = bilinearOf(push, "en1998", mechanism=target)
        except Refused as refused:
            return _notIterated(found, str(refused))
        found = demand(curve, system, spectrum, limited)
    return _notIterated(
        found,
        f"the last two target displacements are {target:.4g} and {found.targetDisplacement:.4g} mm",
    )


def _notIterated(found, why):
    """The same demand, with a note that its mechanism does not form at the target displacement."""
    note = (
        f"the iteration of annex B was ended with a mechanism at {found.curve.mechanism:.4g} mm:"
        f" {why}"
    )
    return replace(found, notes=(note, *found.notes))
