# SPDX-License-Identifier: GPL-2.0-or-later
"""The bilinear curve of a push, and its drifts: the numbers by which engineers compare walls.

``/usr/bin/python3 -m masonry_capacity.bilinear_curve results/wall_comp4`` prints them. In Python::

    from masonry_capacity import bilinear_curve

    found = bilinear_curve.ofRun("results/wall_comp4")
    found.stiffness, found.yieldForce, found.yieldDisplacement
    found.ultimateDisplacement, found.ductility
    found.notes  # sentences on what the numbers do not say
    bilinear_curve.drifts("results/wall_comp4")

A bilinear curve is elastic with the stiffness K up to the yield force Vy, and keeps that force up
to the ultimate displacement du. There are two rules:

- ``masonry``, a convention of tests on masonry walls and of no code: K is the secant stiffness at
  0.7 of the peak, du is where the force has fallen to 0.8 of the peak, and Vy is the force for
  which both curves have the same area up to du.
- ``en1998``: EN 1998-1:2004, annex B.3, equation (B.6). Vy is the force at which the plastic
  mechanism forms, at the displacement dm, and dy = 2 (dm - E/Vy), where E is the area under the
  curve up to dm. Annex B leaves it to its user when the mechanism forms: here at the peak, if
  nothing else is given. It has no rule for du, which is that of ``masonry``.

The force of a run is what both ends carry at once: in every row of curve.csv the smaller of the
force at the supports and that at the loaded point, so the peak is ``peak_at_both_ends_kN``.
"""

import math
import os
import sys
from dataclasses import dataclass, replace
from typing import Annotated, Any, Sequence, Union

import numpy as np

from masonry.arguments import FilePath, Numbers, Series, number, oneOf, path, validated
from masonry.errors import Refused
from masonry.terminal import say
from masonry.numbers import curves, loops, quantities
from masonry.numbers.files import filesOf, onFolder
from masonry.numbers.quantities import Number
from masonry.numbers.run_data import BASE, FALL, MOVED, TOP, RunData

SECANT = 0.7  # of the peak: where the secant stiffness is taken
#: What a curve may begin with, of the peak and of the displacement there [-].
MAX_START_RATIO = 0.01
#: By how much of its largest displacement a push may go back [-].
MAX_REVERSAL = 0.02
#: A curve that still grows in the last tenth of its displacement with more than this share of its
#: stiffness has no peak [-].
MAX_END_SLOPE = 0.05
#: A plateau is above this share of the peak [-], and makes the mechanism of annex B.3 uncertain if
#: it begins before this share of the displacement at the peak [-].
PLATEAU, PLATEAU_START = 0.95, 0.5
#: Round-off, relative [-].
ROUND_OFF = 1e-9

CONVENTION = "a convention for masonry walls"
WARNED = "the run warns: "  # how notes that repeat its warnings begin

#: The rules, and where each comes from.
RULES = {"masonry": CONVENTION, "en1998": "EN 1998-1:2004, annex B.3, equation (B.6)"}
#: A rule, a share of the peak, the displacement at which the plastic mechanism forms, and the
#: height of the recorded point.
Rule = Annotated[str, oneOf(*RULES)]
Share = Annotated[float, number("-", 0, 1, above=True, below=True)]
Mechanism = Annotated[float, number("mm", 0, above=True)]
Height = Annotated[float, number("m", 0, above=True)]


@dataclass(frozen=True)
class Bilinear:
    """A bilinear curve: what :func:`bilinear` found."""

    rule: str  #: ``masonry`` or ``en1998``
    stiffness: float  #: K [kN/mm]
    yieldForce: float  #: Vy [kN]
    ultimateDisplacement: float  #: du [mm]
    peakForce: float  #: of the curve [kN]
    peakDisplacement: float  #: displacement at the peak [mm]
    area: float  #: under the curve up to du [J], which is kN mm
    secant: float  #: share of the peak at which K was taken [-]; not used by ``en1998``
    fall: float  #: share of the peak to which the force falls at du [-]
    #: displacement at which the plastic mechanism forms [mm]; not used by ``masonry``
    mechanism: float
    #: a sentence if the force does not fall so far, so that du is the end of the curve; else empty
    unreached: str
    remarks: tuple[str, ...]  #: other sentences on what the numbers do not say

    @property
    def reached(self) -> bool:
        """Whether the force falls to its share of the peak."""
        return not self.unreached

    @property
    def notes(self) -> tuple[str, ...]:
        """All sentences on what the numbers do not say."""
        return (*filter(None, [self.unreached]), *self.remarks)

    @property
    def yieldDisplacement(self) -> float:
        """dy = Vy/K [mm]."""
        return self.yieldForce / self.stiffness

    @property
    def ductility(self) -> float:
        """mu = du/dy [-]."""
        return self.ultimateDisplacement / self.yieldDisplacement

    def force(self, displacement: Numbers) -> np.ndarray:
        """Forces [kN] at displacements [mm]; beyond du there is none, and they are not numbers."""
        moved = np.asarray(displacement, float)
        force = np.minimum(self.stiffness * moved, self.yieldForce)
        return np.where(moved <= self.ultimateDisplacement, force, np.nan)

    def numbers(self) -> list[Number]:
        """K, Vy, dy, du, mu, and the peak, each with its unit, its meaning and its source."""
        source, missing = RULES[self.rule], self.unreached
        if self.rule == "masonry":
            line = f"Secant stiffness at {self.secant:g} of the peak, on the way to it."
            force = (
                "Force of the plateau for which both curves have the same area up to the ultimate"
                " displacement."
            )
        else:
            line = "Yield force over yield displacement."
            force = f"Force at which the plastic mechanism forms, at {self.mechanism:.4g} mm."
        return [
            Number("bilinear_stiffness_kN_per_mm", self.stiffness, "kN/mm", line, source),
            Number("yield_force_kN", self.yieldForce, "kN", force, source),
            Number(
                "yield_displacement_mm",
                self.yieldDisplacement,
                "mm",
                "Displacement at which the elastic line reaches the yield force.",
                source,
            ),
            Number(
                "ultimate_displacement_mm",
                self.ultimateDisplacement,
                "mm",
                (
                    "Displacement after the peak at which the force has fallen to"
                    f" {self.fall:g} of it."
                ),
                CONVENTION,
                missing,
            ),
            Number(
                "displacement_ductility",
                self.ductility,
                "-",
                "Ultimate displacement over yield displacement.",
                CONVENTION,
                missing,
            ),
            Number(
                "peak_force_kN",
                self.peakForce,
                "kN",
                "The largest force of the curve.",
                "the curve",
            ),
            Number(
                "peak_displacement_mm",
                self.peakDisplacement,
                "mm",
                "Displacement at the largest force.",
                "the curve",
            ),
        ]


def _reached(moved, force, level):
    """Displacement at which the force first reaches a level, on the line between rows."""
    row = int((force >= level).argmax())
    if row == 0:
        return float(moved[0])
    share = (level - force[row - 1]) / (force[row] - force[row - 1])
    return float(moved[row - 1] + share * (moved[row] - moved[row - 1]))


def _area(moved, force, end):
    """Area under a curve from its beginning to a displacement, and the force there."""
    inside, last = moved < end, float(np.interp(end, moved, force))
    area = loops.area(np.append(force[inside], last), np.append(moved[inside], end))
    return area, last


def _checked(moved, force):
    """Displacements that do not go back, and forces. Raises Refused if they are no push."""
    if moved.shape != force.shape:
        raise Refused(
            f"a curve must have as many displacements as forces, not {moved.size} and {force.size}"
        )
    if len(moved) == 0:
        raise Refused("the curve is empty: there is no row")
    if not (np.isfinite(moved).all() and np.isfinite(force).all()):
        raise Refused("the curve has a number that is not finite")
    reach, peak = float(moved.max()), float(force.max())
    if len(moved) < 3 or reach <= 0 or peak <= 0:
        raise Refused(
            f"the curve is no push: it has {len(moved)} rows, goes to {reach:.4g} mm, and its"
            f" largest force is {peak:.4g} kN"
        )
    back = float((np.maximum.accumulate(moved) - moved).max())
    if back > MAX_REVERSAL * reach:
        raise Refused(
            f"the displacement goes back by {back:.4g} mm: the curve is of cycles or of several"
            " pushes, and a bilinear curve is of one push"
        )
    at = int(force.argmax())
    if abs(force[0]) > MAX_START_RATIO * peak or abs(moved[0]) > MAX_START_RATIO * max(
        moved[at], 0
    ):
        raise Refused(
            f"the curve begins with {force[0]:.4g} kN at {moved[0]:.4g} mm: a bilinear curve is of"
            f" a push that begins at rest, with at most {100 * MAX_START_RATIO:g} % of the peak,"
            f" {peak:.4g} kN, and of the displacement there, {moved[at]:.4g} mm"
        )
    return np.maximum.accumulate(moved), force


def _secant(moved, force, share):
    """The secant stiffness at a share of the peak, on the way to it."""
    level = share * float(force.max())
    upper = _reached(moved, force, level)
    if upper <= 0:
        raise Refused(
            f"the curve has {share:g} of its peak at its first row: there is no stiffness"
        )
    return level / upper


def _checkPeak(moved, force, stiffness):
    """Refuse a curve that still grows at its end."""
    end = float(moved[-1])
    start = float(np.interp(0.9 * end, moved, force))
    slope = (float(force[-1]) - start) / (0.1 * end)
    highest = float(force.max())
    if highest <= 1.001 * float(force[-3:].max()) and slope > MAX_END_SLOPE * stiffness:
        raise Refused(
            f"the curve has no peak: its force still grows at its end, {end:.4g} mm, with"
            f" {slope:.3g} kN/mm, which is more than {100 * MAX_END_SLOPE:g} % of its stiffness,"
            f" {stiffness:.3g} kN/mm; push farther"
        )


@validated
def bilinear(
    displacement: Series,
    force: Series,
    rule: Rule = "masonry",
    secant: Share = SECANT,
    fall: Share = FALL,
    mechanism: Mechanism | None = None,
    pulse: Annotated[float, number("mm", 0)] = 0.0,
) -> Bilinear:
    """The bilinear curve of a push, by one of the rules that the module describes.

    :param displacement: along the push, from 0 on [mm] (n)
    :param force: along the push [kN] (n)
    :param rule: ``"masonry"`` or ``"en1998"``
    :param secant: share of the peak at which ``masonry`` takes the stiffness, between 0 and 1 [-]
    :param fall: share of the peak to which the force falls at the ultimate displacement, between 0
        and 1 [-]
    :param mechanism: of ``en1998``, displacement at which the plastic mechanism forms [mm]; None:
        at the peak
    :param pulse: a fall that is over within this displacement, or begins within it of the end, may
        be a wave that passes through the structure, and does not count [mm]
    :raises Refused: if there is no such curve: it is empty, goes back, does not begin at zero, has
        no peak, or has more area than any bilinear one with its stiffness
    """
    moved, forces = _checked(displacement, force)
    at = int(forces.argmax())
    peak = float(forces[at])
    stiffness = _secant(moved, forces, secant)
    _checkPeak(moved, forces, stiffness)
    end, unreached, notes = _end(moved, forces, at, fall, pulse)
    if at >= len(forces) - 3:
        notes.append(
            "the force is largest at the end of the curve, on a plateau: farther on it may be"
            " larger"
        )
    area, _ = _area(moved, forces, end)
    forms = float(moved[at]) if mechanism is None else mechanism
    if rule == "masonry":
        yieldForce = _equalArea(stiffness, end, area)
    else:
        stiffness, yieldForce = _annexB(moved, forces, forms, end)
        if mechanism is None:
            notes += _onPlateau(moved, forces, forms, stiffness)
    if yieldForce > peak * (1 + ROUND_OFF):
        notes.append(
            f"the yield force is above the peak, {peak:.4g} kN: the curve lies far above its secant"
            f" at {secant:g} of the peak; one at a smaller share (secant=) has a lower yield force"
        )
    return Bilinear(
        rule=rule,
        stiffness=stiffness,
        yieldForce=yieldForce,
        ultimateDisplacement=end,
        peakForce=peak,
        peakDisplacement=float(moved[at]),
        area=area,
        secant=secant,
        fall=fall,
        mechanism=forms,
        unreached=unreached,
        remarks=tuple(notes),
    )


def _end(moved, force, at, fall, pulse):
    """The ultimate displacement; a sentence if the force does not fall so far, else an empty text;
    and further sentences."""
    level = fall * float(force[at])
    place = curves.fallen(moved, force, at, level, pulse)
    if place is None:
        wave = f" for longer than a wave of {pulse:.2g} mm" if (force[at:] < level).any() else ""
        unreached = (
            f"not reached: the force never falls to {fall:g} of its peak{wave}, so the ultimate"
            " displacement is the end of the curve, and the ductility is that of the part which"
            " was run"
        )
        return float(moved[-1]), unreached, []
    end = float(np.interp(place, np.arange(len(moved)), moved))
    again = moved[(moved > end + pulse) & (force >= level)]
    if not len(again):
        return end, "", []
    note = (
        f"after it fell to {fall:g} of its peak at {end:.4g} mm, the force came back above that, up"
        f" to {again.max():.4g} mm"
    )
    return end, "", [note]


def _annexB(moved, force, forms, end):
    """Stiffness and yield force by equation (B.6), for a mechanism that forms at a displacement."""
    if forms > end * (1 + ROUND_OFF):
        raise Refused(
            f"the plastic mechanism forms at {forms:.4g} mm, which is beyond the ultimate"
            f" displacement, {end:.4g} mm"
        )
    work, yieldForce = _area(moved, force, forms)
    yields = 2 * (forms - work / yieldForce) if yieldForce > 0 else -1.0
    if not 0 < yields <= forms * (1 + ROUND_OFF):
        raise Refused(
            "equation (B.6) of EN 1998-1:2004 gives no yield displacement between 0 and"
            f" {forms:.4g} mm, where the mechanism forms with {yieldForce:.4g} kN: the area up to"
            f" there is {work:.4g} J"
        )
    return yieldForce / yields, yieldForce


def _onPlateau(moved, force, forms, stiffness):
    """A sentence if the curve is nearly at its peak long before, so that the stiffness of annex B.3
    depends on where within the plateau the peak happens to be; else nothing."""
    early = _reached(moved, force, PLATEAU * float(force.max()))
    work, highest = _area(moved, force, early)
    yields = 2 * (early - work / highest)
    if early > PLATEAU_START * forms or yields <= 0:
        return []
    return [
        f"the force is above {PLATEAU:g} of its peak from {early:.4g} mm on, and the peak is at"
        f" {forms:.4g} mm: where the mechanism forms is not sharp, and the stiffness of annex B.3"
        f" is {highest / yields:.4g} kN/mm with the first and {stiffness:.4g} kN/mm with the second"
        " (mechanism=, --mechanism)"
    ]


def _equalArea(stiffness, end, area):
    """The plateau Vy whose curve has this area up to its end: the smaller root of Vy end - Vy²/(2
    K) = area."""
    rest = end * end - 2 * area / stiffness
    if rest < -ROUND_OFF * end * end:
        raise Refused(
            f"no bilinear curve with the stiffness {stiffness:.4g} kN/mm has the area of the curve"
            f" up to {end:.4g} mm, {area:.4g} J: the whole triangle has"
            f" {0.5 * stiffness * end * end:.4g} J, because the curve lies far above its secant;"
            " take the stiffness at another share of the peak (secant=)"
        )
    return stiffness * (end - math.sqrt(max(rest, 0.0)))


@dataclass(frozen=True)
class Pushover:
    """The curve of one push of a run: what :func:`pushover` read."""

    directory: str
    data: RunData  #: of the run
    displacement: np.ndarray  #: of the pushed point along the push [mm]
    force: np.ndarray  #: that both ends carry at once, along the push [kN]
    notes: tuple[str, ...]  #: sentences on the run

    @property
    def run(self) -> dict[str, Any]:
        """Entries of run.json."""
        return self.data.run


@validated
def pushover(directory: FilePath, column: str | None = None) -> Pushover:
    """Read the curve of the push of a run.

    :param directory: folder of results
    :param column: of curve.csv, for example ``roof_x_mm``, whose displacement from where the push
        began the curve has; None: that of the pushed point
    :raises Refused: if the run has no push, was interrupted, failed, or goes along a history
    """
    data = RunData.read(directory, column)
    run = data.run
    if run.get("interrupted"):
        raise Refused(
            f"{directory}: the run was interrupted, so its curve is not whole; continue it with"
            f" --resume {directory}"
        )
    if run.get("error"):
        raise Refused(f"{directory}: the run ended by an error: {run['error']}")
    if data.isLooped:
        raise Refused(
            f"{directory}: the run goes along a history of loading, there and back, and a bilinear"
            " curve is of one push"
        )
    missing = [head for head in (MOVED, BASE, TOP) if data.column(head) is None]
    with filesOf(directory):
        if missing or not data.isPush:
            why = f": curve.csv has no column {', '.join(missing)}" if missing else ""
            raise Refused(f"{directory}: the run has no push{why}")
        # what spoils the force of the run spoils stiffness and ductility, too
        notes = tuple(f"{WARNED}{text}" for text in run.get("warnings") or ())
        moved = np.array(data[MOVED])
        return Pushover(str(directory), data, moved, data.carried(), notes)


def _pushOf(value, context=None):
    """Validator of what :func:`pushover` read, or of a folder of results."""
    return value if isinstance(value, Pushover) else path(value)


#: A folder of results, or what :func:`pushover` read of it.
PushOf = Annotated[Union[str, "os.PathLike[str]", Pushover], _pushOf]


@validated
def ofRun(
    directory: PushOf,
    rule: Rule = "masonry",
    secant: Share = SECANT,
    fall: Share = FALL,
    mechanism: Mechanism | None = None,
) -> Bilinear:
    """The bilinear curve of the push of a run. A fall of the force that is over within the first
    period of the structure does not count.

    :param directory: folder of results, or what :func:`pushover` read of it; other parameters as in
        :func:`bilinear`
    :raises Refused: if the run has no whole push, or its curve has no bilinear one
    """
    push = directory if isinstance(directory, Pushover) else pushover(directory)
    try:
        curve = push.displacement, push.force
        found = bilinear(*curve, rule, secant, fall, mechanism, push.data.pulse)
    except Refused as refused:
        raise Refused(f"{push.directory}: {refused}") from None
    unreached = found.unreached
    if unreached and push.data.collapse is not None:
        unreached = (
            f"not reached: the structure collapsed at {found.ultimateDisplacement:.4g} mm before"
            f" the force had fallen to {fall:g} of its peak, so the ultimate displacement is that"
            " of the collapse"
        )
    return replace(found, unreached=unreached, remarks=(*found.remarks, *push.notes))


@validated
def drifts(
    directory: PushOf,
    height: Height | None = None,
    fall: Share = FALL,
) -> list[Number]:
    """Drifts of the push of a run [mrad], displacement of the masonry over its height, at the first
    crack, at the peak, where the force has fallen to a share of the peak, and at the collapse.

    :param directory: folder of results, or what :func:`pushover` read of it
    :param height: of the point whose displacement is recorded above the base [m], for drifts of
        that point; None: those of the masonry, of which run.json has the height
    :param fall: as in :func:`bilinear`
    :returns: four numbers; a missing one has the value None and a note that says why
    :raises Refused: if the run has no whole push, or if there is no height
    """
    push = directory if isinstance(directory, Pushover) else pushover(directory)
    data = RunData(push.run, push.data.column, height=height)
    if not data.height:
        raise Refused(
            f"{push.directory}: run.json does not have the height of the recorded point above the"
            " base, so drifts need height=, in m"
        )
    found = []
    for state in quantities.STATES:
        place = data.fallenTo(fall) if state.share else data.place(state.find)
        one = Number(
            state.drift,
            data.drift(place),
            "mrad",
            f"Over the height, {data.height:.4g} m. {state.meaning}",
            "displacement over height",
        )
        found.append(one if place is not None else one._replace(note=state.missing))
    return found


def lines(numbers: list[Number], notes: Sequence[str] = ()) -> list[str]:
    """Numbers as lines for the terminal: name, value, unit, meaning, and a mark where a note below
    says more.

    :param numbers: to print
    :param notes: more sentences, which follow
    """
    marks: dict[str, int] = {}
    found = []
    for one in numbers:
        value = "none" if one.value is None else f"{one.value:.6g} {one.unit}".removesuffix(" -")
        mark = f" [{marks.setdefault(one.note, len(marks) + 1)}]" if one.note else ""
        found.append(f"{one.name:34} {value + mark:20} {one.meaning}")
    found += [f"[{mark}] {note}" for note, mark in marks.items()]
    return found + [f"note: {note}" for note in notes if note not in marks]


def show(directory: FilePath) -> None:
    """Print the bilinear curve of a run by every rule, and its drifts."""
    push = pushover(directory)
    for rule, source in RULES.items():
        found = ofRun(push, rule)
        say(f"{rule}: {source}")
        say("\n".join([*lines(found.numbers(), found.notes), ""]))
    try:
        say("\n".join(lines(drifts(push))))
    except Refused as refused:
        say(f"note: {refused}")


if __name__ == "__main__":
    sys.exit(onFolder(show, sys.argv[1:]))
