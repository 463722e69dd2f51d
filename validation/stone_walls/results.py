# SPDX-License-Identifier: GPL-2.0-or-later
"""What the runs of the stone walls say, and what was measured; README.md says how each number is
defined.

/usr/bin/python3 validation/stone_walls/results.py results/validation/stone_walls/push
/usr/bin/python3 validation/stone_walls/results.py --opened

The first compares runs of today with the 39 known walls, in table.md; the second predictions.csv,
as it was made blind, with the 57 walls whose results came afterwards, in opened.md.
"""

import argparse
import csv
import math
import os
import sys
from dataclasses import dataclass, fields
from statistics import NormalDist, fmean, quantiles, stdev, variance

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import codes
import numpy as np
import rules
from masonry.numbers import curves
from masonry.numbers.files import readCurve

FLEXURE = 0.8  # least peak over the strength in flexure of a wall that fails in flexure [-]
LOST, COLLAPSED = (
    0.8,
    0.5,
)  # share of the peak at the ultimate drift and at collapse [-]
ELASTIC, EFFECTIVE = 0.15, 0.7  # share of the peak at the secants [-]
BEYOND = NormalDist().inv_cdf(0.9)  # standard deviations from the median to the 90 % quantile
STANDS = 0.05  # drift that a wall reaches which carries its vertical load [%]
WAVE = 0.2  # a fall of the force that is over within this displacement is a wave [mm]
TYPES = {0.0: "shear", 0.5: "hybrid", 1.0: "flexure"}


@dataclass
class Numbers:
    """Of one push: force [kN], secant stiffnesses [kN/mm], drifts [%]."""

    peak: float
    elastic: float
    effective: float
    atPeak: float
    ultimate: float
    collapse: float

    def failure(self, wall):
        """0 shear, 1 flexure: whether the peak is near the strength in flexure of EN 1998-3,
        C.4.2.1.

        :param wall: its number
        """
        return float(self.peak >= FLEXURE * STRENGTHS[wall])


#: Strength in flexure by number of a wall [kN].
STRENGTHS = {row["ID"]: 1e-3 * codes.flexure(codes.read(row), 1.15) for row in codes.rows()}


NAMES = [one.name for one in fields(Numbers)]
MEANINGS = dict(
    peak="peak",
    elastic="initial stiffness",
    effective="effective stiffness",
    atPeak="drift at the peak",
    ultimate="ultimate drift",
    collapse="drift of collapse",
)
UNITS = dict(peak="kN", elastic="kN/mm", effective="kN/mm", atPeak="%", ultimate="%", collapse="%")


def ofRun(folder, height):
    """The :class:`Numbers` of a push; None if the wall could not carry its vertical load, and fell
    before it was pushed.

    :param height: of the wall [m]
    """
    curve = {name: np.array(values) for name, values in readCurve(folder).items()}
    moved = np.maximum.accumulate(curve["displacement_mm"])
    # what both ends carry, so that no wave counts
    force = np.minimum(curve["base_shear_kN"], curve["top_shear_kN"])
    drift = lambda mm: 0.1 * mm / height
    if len(force) < 3 or force.max() <= 0 or drift(moved[-1]) < STANDS:
        return None
    at = int(force.argmax())
    peak = float(force[at])
    ends = [_fallen(moved, force, at, share * peak) for share in (LOST, COLLAPSED)]
    secants = [_secant(moved, force, share) for share in (ELASTIC, EFFECTIVE)]
    return Numbers(peak, *secants, drift(moved[at]), *map(drift, ends))


def _fallen(moved, force, at, level):
    """Displacement after the peak at which the force has fallen to a level, or the end [mm]."""
    place = curves.fallen(moved, force, at, level, WAVE)
    return float(moved[-1] if place is None else np.interp(place, np.arange(len(moved)), moved))


def _secant(moved, force, share):
    """Secant stiffness at a share of the peak, on the way to it [kN/mm]."""
    level = share * force.max()
    row = int(np.flatnonzero(force >= level)[0])
    reached = (
        np.interp(level, force[row - 1 : row + 1], moved[row - 1 : row + 1]) if row else moved[0]
    )
    return float(level / max(reached, 1e-6))


PREDICTIONS = os.path.join(HERE, "predictions.csv")
#: Results of the 57 walls that came after they had been predicted.
OPENED = os.path.join(HERE, "reference", "opened.csv")


def measured(path=rules.WALLS, numbers=rules.KNOWN):
    """By number of a wall, what was measured: dict of means of both sides by the names of
    :class:`Numbers`, NaN: not measured."""
    columns = dict(
        peak="Vmax,{} [kN]",
        elastic="Kel,{} [kN/mm]",
        effective="Keff,{} [kN/mm]",
        atPeak="dmax,{} [%]",
        ultimate="du,{} [%]",
        collapse="dc,{} [%]",
    )
    found = {}
    with open(path, encoding="utf-8-sig", newline="") as f:
        for cells in csv.DictReader(f):
            if cells["ID"] not in numbers:
                continue
            own = {}
            for name, column in columns.items():
                sides = [float(s) for sign in "+-" if (s := cells[column.format(sign)])]
                own[name] = fmean(sides) if sides else math.nan
            own["failure"] = float(cells["Failure type"])
            found[cells["ID"]] = own
    return found


def rows(folder):
    """Rows of a study that ended: pairs of a dict of what varies and the folder of a row, once for
    every wall that is like the one that was run."""
    same = rules.twins([*rules.read()])
    with open(os.path.join(folder, "study.csv"), encoding="utf-8", newline="") as f:
        for values in csv.DictReader(f):
            row = os.path.join(folder, "rows", f"{int(values['run']):04}")
            if values["status"] == "ended":
                for wall in same[values["wall"]]:
                    yield {**values, "wall": wall}, row


def runs(folder):
    """The rows of a study of pushes, with the :class:`Numbers` of each."""
    walls = rules.read()
    for values, row in rows(folder):
        if numbers := ofRun(row, walls[values["wall"]].height):
            yield values, numbers


def spread(ratios):
    """Mean and coefficient of variation of what is not NaN."""
    ratios = [one for one in ratios if not math.isnan(one)]
    mean = fmean(ratios)
    return mean, (stdev(ratios) / mean if len(ratios) > 1 else math.nan)


# -- predictions -----------------------------------------------------------------------------------


@dataclass
class Prediction:
    """Of one wall: the best estimate and, where it was made blind, the 10 and 90 % quantiles of
    every name of :class:`Numbers`."""

    best: dict
    low: dict | None = None
    high: dict | None = None


def predictions(pushes):
    """The :class:`Prediction` of every wall without its interval.

    :param pushes: folder of the study push.py
    """
    found, made = {}, {}
    for values, numbers in runs(pushes):
        found.setdefault(values["wall"], []).append(numbers)
    for wall, samples in found.items():
        best = {name: fmean(getattr(one, name) for one in samples) for name in NAMES}
        # two best estimates that differ are the hybrid of both
        best["failure"] = round(2 * fmean(one.failure(wall) for one in samples)) / 2
        made[wall] = Prediction(best)
    return made


def errors(made):
    """What the walls with results say of the model: mean and standard deviation of the logarithms
    of measured over predicted values, by the names of :class:`Numbers`."""
    tests = measured()
    logs = {name: [math.log(tests[w][name] / made[w].best[name]) for w in tests] for name in NAMES}
    return {name: (fmean(values), stdev(values)) for name, values in logs.items()}


def expected(prediction, error):
    """Between which values four of five tests are expected, by name: the interval of a wall, moved
    and widened by the error of the model as the known walls have it.

    :param error: of :func:`errors`
    """
    found = {}
    for name, (shift, spread) in error.items():
        best = math.log(prediction.best[name])
        own = math.log(prediction.high[name] / prediction.low[name]) / (2 * BEYOND)
        half = BEYOND * math.hypot(spread, own)
        found[name] = math.exp(best + shift - half), math.exp(best + shift + half)
    return found


def table(made, tests):
    """Lines of a table: mean and coefficient of variation of predicted over measured, by typology
    and for all.

    :param tests: of :func:`measured`
    """
    walls = rules.read()
    of = lambda kind: [w for w in tests if kind in ("all", walls[w].typology)]
    kinds = [kind for kind in (*rules.TABLE, "all") if of(kind)]
    cell = lambda ratios: (
        "{:.2f} ({:.0f} %)".format(spread(ratios)[0], 100 * spread(ratios)[1]) if ratios else "–"
    )
    yield "| predicted over measured | " + " | ".join(f"{k} ({len(of(k))})" for k in kinds) + " |"
    yield "|---" * (len(kinds) + 1) + "|"
    for name in NAMES:
        cells = [cell([made[w].best[name] / tests[w][name] for w in of(k)]) for k in kinds]
        yield f"| this model: {MEANINGS[name]} | {' | '.join(cells)} |"
    if all(one.low for one in made.values()):
        yield from _within(made, tests, kinds, of)
    right = lambda k: sum(made[w].best["failure"] == tests[w]["failure"] for w in of(k))
    yield f"| failure type right | {' | '.join(str(right(k)) for k in kinds)} |"
    said = {row["ID"]: codes.predict(row) for row in codes.rows()}
    for rule in codes.RULES:
        peaks = {w: said[w][rule].peak for w in tests}
        drifts = {w: said[w][rule].drift for w in tests}
        for what, own, name in (("peak", peaks, "peak"), ("drift capacity", drifts, "ultimate")):
            if any(own.values()):
                cells = [cell([own[w] / tests[w][name] for w in of(k) if own[w]]) for k in kinds]
                yield f"| {rule}: {what} | {' | '.join(cells)} |"
        right = lambda k: sum(_type(said[w][rule]) == tests[w]["failure"] for w in of(k))
        yield f"| {rule}: failure type right | {' | '.join(str(right(k)) for k in kinds)} |"


def _within(made, tests, kinds, of):
    """Lines of a table: how many tests lie within the intervals of their walls."""
    error = errors(made)
    known = {w: expected(made[w], error) for w in tests}
    for name in ("peak", "ultimate"):
        narrow = lambda k: sum(
            made[w].low[name] <= tests[w][name] <= made[w].high[name] for w in of(k)
        )
        wide = lambda k: sum(
            known[w][name][0] <= tests[w][name] <= known[w][name][1] for w in of(k)
        )
        yield (
            f"| {MEANINGS[name]} within the interval of what is unknown |"
            f" {' | '.join(str(narrow(k)) for k in kinds)} |"
        )
        yield (
            f"| {MEANINGS[name]} within that and the error of the model |"
            f" {' | '.join(str(wide(k)) for k in kinds)} |"
        )


def _type(prediction):
    return {"flexure": 1.0, "shear": 0.0, "sliding": 0.0}.get(prediction.failure)


# -- the 57 walls whose results came afterwards ----------------------------------------------------

SHOWN = "peak", "effective", "ultimate"  # whose intervals opened.md has


def predicted():
    """predictions.csv: dict of :class:`Prediction` by wall."""
    column = lambda name: f"{name}_{UNITS[name].replace('/', '_per_').replace('%', 'percent')}"
    types = {text: value for value, text in TYPES.items()}
    made = {}
    with open(PREDICTIONS, encoding="utf-8", newline="") as f:
        for cells in csv.DictReader(f):
            of = lambda head: {name: float(cells[head(name)]) for name in NAMES}
            best = {**of(column), "failure": types[cells["failure"]]}
            ends = (of(lambda name: f"{name}_{end}") for end in ("low", "high"))
            made[cells["ID"]] = Prediction(best, *ends)
    return made


def ratiosOf(made, tests, name):
    """Measured over predicted values of a quantity by wall, where it was measured."""
    found = {wall: own[name] / made[wall].best[name] for wall, own in tests.items()}
    return {wall: ratio for wall, ratio in found.items() if not math.isnan(ratio)}


def fourOfFive(ratios, campaigns):
    """The 10 and 90 % quantiles of ratios, and how many of them such quantiles of the other
    campaigns hold.

    :param ratios: by wall; ``campaigns``: name of the campaign by wall
    """
    ends = lambda values: quantiles(values, n=10, method="inclusive")[::8]
    held = 0
    for wall, ratio in ratios.items():
        low, high = ends([r for w, r in ratios.items() if campaigns[w] != campaigns[wall]])
        held += low <= ratio <= high
    return *ends([*ratios.values()]), held


def opened():
    """Lines of opened.md."""
    made, blind = predicted(), measured(OPENED, rules.BLIND)
    tests = {**measured(), **blind}
    yield "**The 57 walls, as they were predicted**\n"
    yield from table(made, blind)
    plain = {wall: own for wall, own in blind.items() if own["failure"] != 0.5}
    right = sum(made[wall].best["failure"] == own["failure"] for wall, own in plain.items())
    yield f"\nOf {len(plain)} failure types other than hybrid {right} are right."
    yield "\n**All 96 walls**\n"
    yield from table(made, tests)
    yield "\n**Intervals for four of five**\n"
    yield from _intervals(made, blind, tests)
    yield "\n**After the answers**\n"
    yield from _afterwards(made, tests)


def _intervals(made, blind, tests):
    """Lines: coverage of the intervals that were predicted, and intervals of all walls."""
    yield (
        "| | held, of the 57 | four of five of all 96, measured over predicted |"
        " held, if fitted to the other campaigns |"
    )
    yield "|---|---|---|---|"
    error, campaigns = errors(made), {wall: row.campaign for wall, row in rules.read().items()}
    for name in SHOWN:
        ratios, every = ratiosOf(made, blind, name), ratiosOf(made, tests, name)
        ends = {wall: expected(made[wall], error)[name] for wall in ratios}
        held = sum(low <= blind[wall][name] <= high for wall, (low, high) in ends.items())
        low, high, others = fourOfFive(every, campaigns)
        yield (
            f"| {MEANINGS[name]} | {held} of {len(ratios)} | {low:.2f} to {high:.2f} |"
            f" {others} of {len(every)} |"
        )


def _afterwards(made, tests):
    """Lines: scatter of walls with equal inputs, and walls that carry more than N L/2H0."""
    walls, more = rules.read(), {}
    same = [group for group in rules.twins([*walls]).values() if len(group) > 1]
    logs = [[math.log(tests[wall]["peak"]) for wall in group] for group in same]
    free = sum(len(own) - 1 for own in logs)
    scatter = math.sqrt(sum((len(own) - 1) * variance(own) for own in logs) / free)
    yield (
        f"Walls with equal inputs, {sum(map(len, same))} in {len(same)} groups: peaks scatter by"
        f" {100 * scatter:.0f} %.\n"
    )
    yield "| carries more than N L/2H0 | measured, kN | N L/2H0, kN | ratio |"
    yield "|---|---|---|---|"
    for row in codes.rows():
        wall, peak = codes.read(row), tests[row["ID"]]["peak"]
        given = 1e-3 * curves.rocking(wall.force, wall.length, wall.span)
        if peak / given >= 1 + curves.TOLERANCE - 5e-4:  # to three digits
            more[row["ID"]] = given
            name = f"{row['Reference']} {row['Test unit name']}"
            yield f"| {name} | {peak:.1f} | {given:.1f} | {peak / given:.2f} |"
    rest = [made[wall].best["peak"] / tests[wall]["peak"] for wall in tests if wall not in more]
    mean, cov = spread(rest)
    yield (
        f"\nWithout these {len(more)}, predicted over measured peaks have a mean of {mean:.2f} and"
        f" a coefficient of variation of {100 * cov:.1f} %."
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--opened", action="store_true")
    parser.add_argument("study", nargs="?", help="of push.py")
    args = parser.parse_args()
    if args.opened:
        with open(os.path.join(HERE, "opened.md"), "w", encoding="utf-8") as f:
            f.write("".join(line + "\n" for line in opened()))
    if args.study:
        with open(os.path.join(HERE, "table.md"), "w", encoding="utf-8") as f:
            f.write("".join(line + "\n" for line in table(predictions(args.study), measured())))
