# SPDX-License-Identifier: GPL-2.0-or-later
"""The bilinear curve of a push, and its drifts: the numbers by which engineers compare walls.

``/usr/bin/python3 -m masonry.read.bilinear results/wall_comp4`` prints them. In Python::

    from masonry.read import bilinear

    found = bilinear.ofRun("results/wall_comp4")
    found.stiffness, found.yieldForce, found.yieldDisplacement, found.ultimateDisplacement, found.ductility
    found.notes                                              # sentences on what the numbers do not say
    bilinear.drifts("results/wall_comp4")

A bilinear curve is elastic with the stiffness K up to the yield force Vy, and keeps that force up to the ultimate displacement
du. There are two rules:

- ``masonry``, a convention of tests on masonry walls and of no code in particular: K is the secant stiffness at 0.7 of the peak, du is
  where the force has fallen to 0.8 of the peak, and Vy is the force for which both curves have the same area up to du.
- ``en1998``: EN 1998-1:2004, annex B.3, equation (B.6). Vy is the force at which the plastic mechanism forms, at the displacement
  dm, and dy = 2 (dm - E/Vy), where E is the area under the curve up to dm. Annex B leaves it to its user when the mechanism
  forms; here that is at the peak, if nothing else is given. It has no rule for du, which is that of ``masonry``.

The curve of a run is the force that both ends carry at once: in every row of curve.csv the smaller of the force at the supports and
that at the loaded point, so its peak is ``peak_at_both_ends_kN`` of run.json. This module needs no YADE.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Sequence

import numpy as np

from ..arguments import FilePath, Numbers, isNumber, number, oneOf, orNone, takes
from ..basics import Refused, say
from .files import filesOf, onFolder, readCurve, readRun

#: Share of the peak at which the secant stiffness is taken, and to which the force falls at the ultimate displacement [-].
SECANT, FALL = 0.7, 0.8
#: What a curve may begin with, of the peak and of the displacement there [-].
BEGIN = 0.01
#: By how much of its largest displacement a push may go back [-].
BACK = 0.02
#: A curve that still grows in the last tenth of its displacement with more than this share of its stiffness has no peak [-].
GROWS = 0.05
#: A plateau is above this share of the peak [-], and makes the mechanism of annex B.3 uncertain if it begins before this share of
#: the displacement at the peak [-].
PLATEAU, LONG = 0.95, 0.5
#: Round-off, relative [-].
SMALL = 1e-9

CONVENTION = "a convention for masonry walls"
ANNEX_B = "EN 1998-1:2004, annex B.3, equation (B.6)"
#: The rules, and where each comes from.
RULES = {"masonry": CONVENTION, "en1998": ANNEX_B}


class Number(NamedTuple):
    """A number for a report."""

    name: str  #: with its unit at the end, as in run.json
    value: float | None  #: None if there is none; ``note`` says why
    unit: str
    meaning: str  #: one sentence
    source: str  #: of the rule
    note: str = ""  #: what the number does not say, a sentence

    def entry(self) -> dict[str, Any]:
        """The number as an entry of a JSON file."""
        return self._asdict()


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
    reached: bool  #: whether the force falls so far; else du is the end of the curve
    mechanism: float  #: displacement at which the plastic mechanism forms [mm]; not used by ``masonry``
    notes: tuple[str, ...]  #: sentences on what the numbers do not say

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
        source = RULES[self.rule]
        if self.rule == "masonry":
            stiff = (
                f"Secant stiffness at {self.secant:g} of the peak, on the way to it."
            )
            force = "Force of the plateau for which both curves have the same area up to the ultimate displacement."
        else:
            stiff = "Yield force over yield displacement."
            force = f"Force at which the plastic mechanism forms, at {self.mechanism:.4g} mm."
        ultimate = f"Displacement after the peak at which the force has fallen to {self.fall:g} of it."
        missing = "" if self.reached else self.notes[0]
        return [
            Number("bilinear_stiffness_kN_per_mm", self.stiffness, "kN/mm", stiff, source),
            Number("yield_force_kN", self.yieldForce, "kN", force, source),
            Number("yield_displacement_mm", self.yieldDisplacement, "mm", "Displacement at which the elastic line reaches the yield force.", source),
            Number("ultimate_displacement_mm", self.ultimateDisplacement, "mm", ultimate, CONVENTION, missing),
            Number("displacement_ductility", self.ductility, "-", "Ultimate displacement over yield displacement.", CONVENTION, missing),
            Number("peak_force_kN", self.peakForce, "kN", "The largest force of the curve.", "the curve"),
            Number("peak_displacement_mm", self.peakDisplacement, "mm", "Displacement at the largest force.", "the curve"),
        ]  # fmt: skip


def _crossing(moved, force, level, row):
    """Displacement at which the line from the row before to this row has a force."""
    if row == 0 or force[row] == force[row - 1]:
        return float(moved[row])
    share = (level - force[row - 1]) / (force[row] - force[row - 1])
    return float(moved[row - 1] + share * (moved[row] - moved[row - 1]))


def _area(moved, force, end):
    """Area under a curve from its beginning to a displacement, and the force there."""
    inside = moved < end
    last = float(np.interp(end, moved, force))
    d, f = np.append(moved[inside], end), np.append(force[inside], last)
    return float(np.trapz(f, d)), last


def _fallen(moved, force, at, level, pulse):
    """Displacement at which the force falls below a level after row ``at`` and stays below for longer than a pulse; else None.

    What falls within a pulse before the end of the curve may be a wave, too. Without pulses the first fall counts.
    """
    below = force < level
    row = at
    while True:
        under = np.flatnonzero(below[row:])
        if not len(under):
            return None
        first = row + int(under[0])
        back = np.flatnonzero(~below[first:])
        last = first + int(back[0]) if len(back) else len(moved) - 1
        down = _crossing(moved, force, level, first)
        if pulse == 0 or moved[last] - down > pulse:
            return down
        if not len(back):
            return None
        row = last


def _checked(displacement, force):
    """Both as arrays. Raises Refused if they are no push."""
    moved, force = np.asarray(displacement, float), np.asarray(force, float)
    if moved.ndim != 1 or moved.shape != force.shape:
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
            f"the curve is no push: it has {len(moved)} rows, goes to {reach:.4g} mm, and its largest force is {peak:.4g} kN"
        )
    back = float((np.maximum.accumulate(moved) - moved).max())
    if back > BACK * reach:
        raise Refused(
            f"the displacement goes back by {back:.4g} mm: the curve is of cycles or of several pushes, and a bilinear curve is "
            "of one push"
        )
    at = int(force.argmax())
    begun = abs(force[0]) > BEGIN * peak or abs(moved[0]) > BEGIN * max(moved[at], 0)
    if begun:
        raise Refused(
            f"the curve begins with {force[0]:.4g} kN at {moved[0]:.4g} mm: a bilinear curve is of a push that begins at rest, "
            f"with at most {100 * BEGIN:g} % of the peak, {peak:.4g} kN, and of the displacement there, {moved[at]:.4g} mm"
        )
    return np.maximum.accumulate(moved), force


def _checkPeak(moved, force, stiffness):
    """Refuse a curve that still grows at its end."""
    end = float(moved[-1])
    start = float(np.interp(0.9 * end, moved, force))
    slope = (float(force[-1]) - start) / (0.1 * end)
    highest = float(force.max())
    if highest <= 1.001 * float(force[-3:].max()) and slope > GROWS * stiffness:
        raise Refused(
            f"the curve has no peak: its force still grows at its end, {end:.4g} mm, with {slope:.3g} kN/mm, which is more than "
            f"{100 * GROWS:g} % of its stiffness, {stiffness:.3g} kN/mm; push farther"
        )


@takes(
    rule=oneOf(*RULES),
    secant=number("-", 0, 1, above=True, below=True),
    fall=number("-", 0, 1, above=True, below=True),
    mechanism=orNone(number("mm", 0, above=True)),
    pulse=number("mm", 0),
)
def bilinear(
    displacement: Numbers,
    force: Numbers,
    rule: str = "masonry",
    secant: float = SECANT,
    fall: float = FALL,
    mechanism: float | None = None,
    pulse: float = 0.0,
) -> Bilinear:
    """The bilinear curve of a push, by one of the rules that the module describes.

    :param displacement: along the push, from 0 on [mm] (n)
    :param force: along the push [kN] (n)
    :param rule: ``"masonry"`` or ``"en1998"``
    :param secant: share of the peak at which ``masonry`` takes the stiffness, between 0 and 1 [-]
    :param fall: share of the peak to which the force falls at the ultimate displacement, between 0 and 1 [-]
    :param mechanism: of ``en1998``, displacement at which the plastic mechanism forms [mm]; None: that of the peak
    :param pulse: a fall that is over within this displacement, or begins within it of the end, may be a wave that passes through
        the structure, and does not count [mm]
    :raises Refused: if there is no such curve: it is empty, goes back, does not begin at zero, has no peak, or has more
        area than any bilinear one with its stiffness
    """
    moved, forces = _checked(displacement, force)
    at = int(forces.argmax())
    peak = float(forces[at])
    level = secant * peak
    upper = _crossing(moved, forces, level, int(np.flatnonzero(forces >= level)[0]))
    if upper <= 0:
        raise Refused(
            f"the curve has {secant:g} of its peak at its first row: there is no stiffness"
        )
    stiffness = level / upper
    _checkPeak(moved, forces, stiffness)
    end, notes = _fallen(moved, forces, at, fall * peak, pulse), []
    reached = end is not None
    if end is None:
        end = float(moved[-1])
        dips = (forces[at:] < fall * peak).any()
        wave = f" for longer than a wave of {pulse:.2g} mm" if dips else ""
        notes.append(
            f"not reached: the force never falls to {fall:g} of its peak{wave}, so the ultimate displacement is the end of the curve, and "
            "the ductility is that of the part which was run"
        )
    else:
        again = (moved > end + pulse) & (forces >= fall * peak)
        if again.any():
            notes.append(
                f"after it fell to {fall:g} of its peak at {end:.4g} mm, the force came back above that, up to "
                f"{moved[again].max():.4g} mm"
            )
    if at >= len(forces) - 3:
        notes.append(
            "the force is largest at the end of the curve, on a plateau: farther on it may be larger"
        )
    area, _ = _area(moved, forces, end)
    forms = float(moved[at]) if mechanism is None else mechanism
    if rule == "masonry":
        yieldForce = _equalArea(stiffness, end, area)
    else:
        if forms > end * (1 + SMALL):
            raise Refused(
                f"the plastic mechanism forms at {forms:.4g} mm, which is beyond the ultimate displacement, {end:.4g} mm"
            )
        work, yieldForce = _area(moved, forces, forms)
        yields = 2 * (forms - work / yieldForce) if yieldForce > 0 else -1.0
        if not 0 < yields <= forms * (1 + SMALL):
            raise Refused(
                f"equation (B.6) of EN 1998-1:2004 gives no yield displacement between 0 and {forms:.4g} mm, where the mechanism "
                f"forms with {yieldForce:.4g} kN: the area up to there is {work:.4g} J"
            )
        stiffness = yieldForce / yields
        if mechanism is None:
            notes += _onPlateau(moved, forces, forms, stiffness)
    if yieldForce > peak * (1 + SMALL):
        notes.append(
            f"the yield force is above the peak, {peak:.4g} kN: the curve lies far above its secant at {secant:g} of the peak; one at "
            "a smaller share (secant=) has a lower yield force"
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
        reached=reached,
        mechanism=forms,
        notes=tuple(notes),
    )


def _onPlateau(moved, force, forms, stiffness):
    """A sentence if the curve is nearly at its peak long before, so that the stiffness of annex B.3 depends on where within the
    plateau the peak happens to be; else nothing."""
    level = PLATEAU * float(force.max())
    early = _crossing(moved, force, level, int(np.flatnonzero(force >= level)[0]))
    work, highest = _area(moved, force, early)
    yields = 2 * (early - work / highest)
    if early > LONG * forms or yields <= 0:
        return []
    return [
        f"the force is above {PLATEAU:g} of its peak from {early:.4g} mm on, and the peak is at {forms:.4g} mm: where the mechanism forms is not "
        f"sharp, and the stiffness of annex B.3 is {highest / yields:.4g} kN/mm with the first and {stiffness:.4g} kN/mm with the second "
        "(mechanism=, --mechanism)"
    ]


def _equalArea(stiffness, end, area):
    """The plateau Vy whose curve has this area up to its end: the smaller root of Vy end - Vy²/(2 K) = area."""
    rest = end * end - 2 * area / stiffness
    if rest < -SMALL * end * end:
        raise Refused(
            f"no bilinear curve with the stiffness {stiffness:.4g} kN/mm has the area of the curve up to {end:.4g} mm, {area:.4g} J: the "
            f"whole triangle has {0.5 * stiffness * end * end:.4g} J, because the curve lies far above its secant; take the stiffness at "
            "another share of the peak (secant=)"
        )
    return stiffness * (end - math.sqrt(max(rest, 0.0)))


# -- of a run ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Pushover:
    """The curve of one push of a run: what :func:`pushover` read."""

    directory: str
    displacement: np.ndarray  #: of the pushed point along the push [mm]
    force: np.ndarray  #: that both ends carry at once, along the push [kN]
    pulse: float  #: displacement of the drive within the first period of the structure [mm]; 0 if that is not known
    height: float | None  #: of the recorded point above the lowest brick [m], if run.json has it
    run: dict[str, Any]  #: entries of run.json
    notes: tuple[str, ...]  #: sentences on the run


def pushover(directory: FilePath) -> Pushover:
    """Read the curve of the push of a run.

    :param directory: folder of results
    :raises Refused: if the run has no push, was interrupted, failed, or goes along a history
    """
    run = readRun(directory)
    if run.get("interrupted"):
        raise Refused(
            f"{directory}: the run was interrupted, so its curve is not whole; continue it with --resume {directory}"
        )
    if run.get("error"):
        raise Refused(f"{directory}: the run ended by an error: {run['error']}")
    if "history" in run:
        raise Refused(
            f"{directory}: the run goes along a history of loading, there and back, and a bilinear curve is of one push"
        )
    data = readCurve(directory)
    heads = ("displacement_mm", "base_shear_kN", "top_shear_kN")
    missing = [head for head in heads if head not in data]
    if "peak_base_shear_kN" not in run or missing:
        why = f": curve.csv has no column {', '.join(missing)}" if missing else ""
        raise Refused(f"{directory}: the run has no push{why}")
    with filesOf(directory):
        rows = run["figure"].get("rows")
        values = {name: np.array(column) for name, column in data.items()}
        if rows is not None:
            values = {name: column[rows] for name, column in values.items()}
        moved, base, top = (values[head] for head in heads)
        pulse, period = 0.0, _known(run, "first_period_s")
        if period and "time_s" in values and len(moved) > 1:
            lasted = float(np.ptp(values["time_s"]))
            pulse = period * float(np.ptp(moved)) / lasted if lasted > 0 else 0.0
        notes = []
        if run.get("too_fast"):
            notes.append(
                f"the push was too fast: {100 * run['dynamic_imbalance']:.2g} % of the force did not reach the supports"
            )
        return Pushover(
            directory=str(directory),
            displacement=moved,
            force=np.minimum(base, top),
            pulse=pulse,
            height=_heightOf(run),
            run=run,
            notes=tuple(notes),
        )


def _known(run, key):
    """A finite number of run.json, or None."""
    value = run.get(key)
    return float(value) if isNumber(value) and math.isfinite(value) else None


def _heightOf(run):
    """Height of the recorded point above the lowest brick [m], or None if run.json does not have it, as of an older run that saw
    no crack."""
    known = _known(run, "recorded_height_m")
    moved, drift = _known(run, "displacement_at_first_crack_mm"), _known(run, "drift_at_first_crack_mrad")  # fmt: skip
    if known is None and moved and drift:
        known = moved / drift
    if known is None and "wall" in run:
        known = _known(run["wall"], "measure_height_m")
    return known if known and known > 0 else None


def ofRun(
    directory: FilePath | Pushover,
    rule: str = "masonry",
    secant: float = SECANT,
    fall: float = FALL,
    mechanism: float | None = None,
) -> Bilinear:
    """The bilinear curve of the push of a run. A fall of the force that is over within the first period of the structure does
    not count.

    :param directory: folder of results, or what :func:`pushover` read of it; other parameters as of :func:`bilinear`
    :raises Refused: if the run has no whole push, or its curve has no bilinear one; the message names the folder
    """
    push = directory if isinstance(directory, Pushover) else pushover(directory)
    try:
        found = bilinear(
            push.displacement, push.force, rule, secant, fall, mechanism, push.pulse
        )
    except Refused as refused:
        raise Refused(f"{push.directory}: {refused}") from None
    notes = (*found.notes, *push.notes)
    if not found.reached and _known(push.run, "collapse_displacement_mm") is not None:
        notes = (
            f"not reached: the structure collapsed at {found.ultimateDisplacement:.4g} mm before the force had fallen to {fall:g} of its "
            "peak, so the ultimate displacement is that of the collapse",
            *notes[1:],
        )
    return replace(found, notes=notes)


@takes(height=orNone(number("m", 0, above=True)))
def drifts(
    directory: FilePath | Pushover, height: float | None = None, fall: float = FALL
) -> list[Number]:
    """Drifts of the push of a run [mrad]: displacement over height, at the first crack, at the peak, where the force has
    fallen to a share of the peak, and at the collapse.

    :param directory: folder of results, or what :func:`pushover` read of it
    :param height: of the point whose displacement is recorded above the base [m]; None: that of run.json
    :param fall: as of :func:`bilinear`
    :returns: four numbers; one that the run does not have has the value None and a note that says why
    :raises Refused: if the run has no whole push, or if there is no height
    """
    push = directory if isinstance(directory, Pushover) else pushover(directory)
    high = height or push.height
    if not high:
        raise Refused(
            f"{push.directory}: run.json does not have the height of the recorded point above the base, so drifts need height=, in m"
        )
    found, note = ofRun(push, fall=fall), ""
    if not found.reached:
        note = found.notes[0]
    run = push.run
    first, last = _known(run, "displacement_at_first_crack_mm"), _known(run, "collapse_displacement_mm")  # fmt: skip
    over = f"over the height, {high:.4g} m"
    source = "displacement over height"
    mrad = lambda moved: None if moved is None else moved / high
    return [
        Number("drift_at_first_crack_mrad", mrad(first), "mrad", f"Displacement at the first crack that is seen, {over}.", source, "" if first is not None else "no crack was seen in the push"),
        Number("drift_at_peak_mrad", mrad(found.peakDisplacement), "mrad", f"Displacement at the largest force, {over}.", source),
        Number("drift_at_fall_mrad", mrad(found.ultimateDisplacement if found.reached else None), "mrad", f"Displacement after the peak at which the force has fallen to {fall:g} of it, {over}.", source, note),
        Number("drift_at_collapse_mrad", mrad(last), "mrad", f"Last displacement before the collapse, {over}.", source, "" if last is not None else "the push did not end in a collapse"),
    ]  # fmt: skip


def lines(numbers: list[Number], notes: Sequence[str] = ()) -> list[str]:
    """Numbers as lines for the terminal: name, value, unit, meaning, and a mark where a note below says more.

    :param numbers: to print
    :param notes: more sentences, which follow
    """
    marks: dict[str, int] = {}
    found = []
    for one in numbers:
        value = "none" if one.value is None else f"{one.value:.6g} {one.unit}".removesuffix(" -")  # fmt: skip
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
