# SPDX-License-Identifier: GPL-2.0-or-later
"""Few accurate runs and many fast ones, against accurate runs alone: what both say of the peak of
two walls.

/usr/bin/python3 validation/multifidelity/multifidelity.py [--jobs 2] [--compare]

Runs what is missing in results/validation/multifidelity, prints the table and draws
multifidelity.png beside itself; --compare leaves out the runs.
"""

import argparse
import math
import os
import sys

import numpy as np
from masonry.basics import Refused
from masonry.study import Study, estimate, lognormal, statistics
from masonry.study.gathering import gather
from masonry.study.local import Local
from masonry.study.records import Record, paired
from masonry.study.start import begin

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from studies import RESULTS, table

MEASURE = "peak_base_shear_kN"
#: The measure without pulses that one end alone feels. It was added when all studies had been run;
#: README.md has why.
BOTH_ENDS = "peak_at_both_ends_kN"

# All numbers below were fixed before any run of these studies was made, but for slower, which was
# fixed when the others had been run; README.md has the reasons.

#: Scene, and how far it is pushed [mm].
WALLS = {"COMP-4": ("wall_comp4", 4), "COMP-1": ("wall_comp1", 25)}

BONDS = lambda name: (f"bed.{name}", f"head.{name}")
#: What varies in both walls, independently of each other.
VARY = {
    BONDS("cohesion"): lognormal(mean=0.11e6, cov=0.2),
    BONDS("friction") + BONDS("residualFriction"): lognormal(mean=0.43, cov=0.05),
    "bed.capNormal": lognormal(mean=1.0, cov=0.2),
}

#: Options, rows and seed of each study. The rows of ``few`` are the first of those with the same
#: seed, ``alone`` has others.
STUDIES = {
    "few": ({"preset": "accurate"}, 12, 1),
    "many": ({"preset": "fast"}, 150, 1),
    "alone": ({"preset": "accurate"}, 24, 2),
    "slower": ({"preset": "fast", "rate": 50}, 150, 1),
}

#: Walls and cheap studies that are compared. The last one was added when those before had been run;
#: README.md has why.
COMPARED = [
    ("COMP-4", "many"),
    ("COMP-1", "many"),
    ("COMP-1", "slower"),
]

#: What multifidelity.png shows.
DRAWN = ["COMP-4", "COMP-1", "COMP-1, at both ends"]

#: The most that few and many may cost, over the cost of accurate runs alone [-].
SHARE = 0.2


def folder(wall, name):
    return os.path.join(
        RESULTS,
        "validation",
        "multifidelity",
        wall.replace("-", "_").lower() + "_" + name,
    )


def study(wall, name):
    scene, until = WALLS[wall]
    options, runs, seed = STUDIES[name]
    return Study(
        scene,
        options={**options, "until": until},
        runs=runs,
        seed=seed,
        vary=VARY,
    )


def recorded(wall, name):
    """The :class:`masonry.study.records.Record` of a study; its BOTH_ENDS are found from the
    curves."""
    found = Record(folder(wall, name))
    curves = found.curves(range(len(found)), "top_shear_kN", "base_shear_kN")
    if len(curves) < len(found):
        raise Refused(f"{found.directory}: {len(found) - len(curves)} rows have no curve")
    found.cells[BOTH_ENDS] = [repr(float(max(map(min, zip(*curve))))) for curve in curves]
    return found


def check(wall, cheap):
    """Refuse studies of which the first rows of the cheap one are not those of *few*."""
    few, many = (
        [{n: row[n] for n in made.vary} for row in made.rows()]
        for made in (study(wall, "few"), study(wall, cheap))
    )
    if few != many[: len(few)]:
        raise Refused(
            f"{wall}: the first {len(few)} of {len(many)} rows are not the {len(few)} rows of the"
            " same seed"
        )


def run(jobs):
    """Run the rows that are missing, study by study. Returns whether all have ended."""
    whole = True
    for wall, cheap in COMPARED:
        check(wall, cheap)
    for wall, cheap in COMPARED:
        for name in ("few", cheap, "alone"):
            made = study(wall, name)
            place = begin(made, folder(wall, name), HERE)
            Local(place, made.runs, jobs).run()
            whole &= set(gather(place)) == {"ended"}
    return whole


def alone(values):
    """What accurate runs alone say: name -> Interval."""
    found = {
        "mean": statistics.mean(values),
        "standard deviation": statistics.deviation(values),
    }
    for share in estimate.QUANTILES:
        found[f"{100 * share:g} % quantile"] = statistics.quantile(values, share)
    return found


def compare(wall, cheap, measure):
    """Lines of the table of a measure of a wall and its cheap study, and whether each of their
    three limits is met.

    The limits are: (1) few and many together differ from accurate runs alone by no more than both
    intervals together tell; (2) they cost at most SHARE of what accurate runs alone would cost for
    the same variance; (3) the interval of the mean is not wider than that of accurate runs alone,
    which cost more.
    """
    few, many, other = (recorded(wall, name) for name in ("few", cheap, "alone"))
    y, x, shared, rows = paired(few, many, measure)
    if len(y) < STUDIES["few"][1]:
        raise Refused(f"{wall}: {len(y)} rows are shared, of {STUDIES['few'][1]}")
    title = titled(wall, cheap, measure)
    values = other.complete(measure)[2]
    prices = few.price(shared), many.price(rows)
    spent = len(y) * prices[0] + len(x) * prices[1]
    whole = len(values) * other.price(range(len(values)))
    reference, lines, met = alone(values), [], [True, True, True]
    for found in estimate.estimate(y, x):
        known = reference[found.name]
        paid = estimate.saved(found, prices)
        reach = math.hypot(_half(found), _half(known))
        measured = math.isfinite(reach)  # a few rows alone give no interval of a quantile far out
        agrees = abs(found.value - known.value) <= reach
        met[0] &= agrees or not measured
        met[1] &= paid.share <= SHARE
        if found.name == "mean":
            met[2] &= _half(found) <= _half(known)
        lines.append(
            [
                title,
                found.name,
                _intervalText(known),
                _intervalText(found),
                ("yes" if agrees else "no") if measured else "not told",
                f"{paid.alone:.0f}",
                f"{100 * paid.share:.0f} %",
            ]
        )
    correlation = np.corrcoef(y, x[: len(y)])[0, 1]
    summary = (
        f"{title}: correlation {correlation:.4f} over {len(y)} shared rows; a run of accurate takes"
        f" {prices[0]:.1f} s, one of fast {prices[1]:.1f} s; {len(y)} and {len(x)} of them"
        f" {spent / 60:.0f} min, {len(values)} accurate runs alone {whole / 60:.0f} min"
        f" ({100 * spent / whole:.0f} %)"
    )
    notes = [summary, *(f"{title}: {doubt}" for doubt in estimate.doubts(y, x))]
    return lines, met, notes, (y, x[: len(y)], values)


def titled(wall, cheap, measure):
    """A wall, its cheap study and the measure, for readers."""
    rate = STUDIES[cheap][0].get("rate")
    ends = ", at both ends" if measure == BOTH_ENDS else ""
    return wall + (f", fast at {rate} mm/s" if rate else "") + ends


def _half(interval):
    """Half of the width of an interval."""
    return (interval.high - interval.low) / 2


def _intervalText(interval):
    return f"{interval.value:.4g} ({interval.low:.4g} … {interval.high:.4g})"


def draw(found):
    """multifidelity.png: accurate over fast for the shared rows, and both distributions, wall by
    wall."""
    from masonry.read.comparison import COLOURS
    from masonry.read import drawing

    with drawing.style():
        figure = drawing.empty(3.4 * len(found), 3.2)
        for axis, (wall, (y, x, values)) in zip(
            figure.subplots(1, len(found), squeeze=False)[0], found.items()
        ):
            axis.plot(x, y, "o", color=COLOURS[0], ms=4, label="shared rows")
            ends = np.array([min(*x, *y), max(*x, *y)])
            axis.plot(ends, ends, color="0.6", lw=0.8, label="fast = accurate")
            axis.plot(
                np.full(len(values), ends[0]),
                values,
                "_",
                color=COLOURS[1],
                ms=8,
                alpha=0.5,
                label="accurate alone",
            )
            axis.set_title(wall, fontsize=10)
            axis.set_xlabel("peak of fast [kN]")
            axis.set_ylabel("peak of accurate [kN]")
            axis.grid(alpha=0.3)
            axis.legend(fontsize=7)
        figure.tight_layout()
        drawing.save(figure, os.path.join(HERE, "multifidelity.png"), 150)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at a time"
    )
    parser.add_argument("--compare", action="store_true", help="compare what is there, run nothing")
    args = parser.parse_args()
    try:
        if not args.compare and not run(args.jobs):
            raise Refused("some rows have failed: see the times.csv of their studies")
        lines, sentences, pictures, limits = [], [], {}, []
        for measure in (MEASURE, BOTH_ENDS):
            for wall, cheap in COMPARED:
                title = titled(wall, cheap, measure)
                more, met, notes, pictures[title] = compare(wall, cheap, measure)
                lines += more
                sentences += notes
                limits.append([title, *("met" if one else "not met" for one in met)])
    except Refused as refused:
        print(refused, file=sys.stderr)
        return 2
    heads = [
        "wall",
        "peak, kN",
        "accurate alone",
        "few and many",
        "agree",
        "accurate runs for the same",
        "cost over theirs",
    ]
    print(table(heads, lines), "", *sentences, "", sep="\n")
    print(
        table(
            ["wall", "agrees", f"cost at most {100 * SHARE:.0f} %", "mean as narrow"],
            limits,
        )
    )
    draw({title: pictures[title] for title in DRAWN})
    return 0


if __name__ == "__main__":
    sys.exit(main())
