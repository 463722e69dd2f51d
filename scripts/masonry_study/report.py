# SPDX-License-Identifier: GPL-2.0-or-later
"""What a study says: a table of statistics, and pictures.

/usr/bin/python3 -m masonry_study.report DIR
/usr/bin/python3 -m masonry_study.report DIR --measure base_shear_end_kN --demand 90,100,110
/usr/bin/python3 -m masonry_study.report DIR --limit 20          of an incremental dynamic analysis
/usr/bin/python3 -m masonry_study.report DIR --by damage         a fragility for each class

The pictures go into the folder of the study.
"""

import argparse
import math
import os
import sys
from collections import Counter
from functools import partial

import numpy as np

from masonry.errors import Refused
from masonry.terminal import say
from masonry.folders import check
from masonry.numbers.files import program
from masonry.numbers.quantities import IMBALANCE
from masonry.run import batch
from . import pictures, sensitivity, statistics
from .demands import QUANTILES, Demands
from .fragility import nrml as nrmlOf
from .gathering import Folder, written
from .records import CURVE, Record

MEASURE = "peak_base_shear_kN"
MODE = "failure_mode"
SHARES = 0.05, 0.5, 0.95  # of the rows, below the quantiles of the table


def label(name):
    """A column as the label of an axis: its unit, at the end of the name, goes into brackets."""
    *words, last = name.split("_")
    if words and last in ("kN", "mm", "J", "s", "m", "mrad", "g"):
        last = f"[{last}]"
    return " ".join([*words, last])


def table(record, measure):
    rows, _, values = record.complete(measure)
    yield f"{label(measure)}: {len(rows)} of {len(record)} rows"
    ended = record.cells["status"].count("ended")
    if ended > len(rows) or "failed" in record.cells["status"]:
        yield (
            f"  note: rows that have no {label(measure)} are left out. If they collapsed, or were"
            " refused for their values, the numbers below are on the unsafe side"
        )
    finds = [("mean", statistics.mean), ("standard deviation", statistics.deviation)]
    finds += [(f"{100 * q:g} % quantile", partial(statistics.quantile, share=q)) for q in SHARES]
    for name, find in finds:
        try:
            yield line(name, find(values))
        except Refused as refused:
            yield f"  {name:20} {refused}"
    if statistics.isLognormal(values):
        fit = statistics.lognormal(values)
        doubt = "" if not fit.fits < 0.05 else ", which does not fit"
        yield (
            f"  lognormal            median {fit.median:.5g}, dispersion {fit.dispersion:.3g} (p ="
            f" {fit.fits:.2g}{doubt})"
        )


def line(name, interval, form="{:.5g}"):
    """A number and its interval as a line of a table."""
    end = lambda v: form.format(v) if math.isfinite(v) else "unknown"
    value = form.format(interval.value)
    return f"  {name:20} {value:>9}   {end(interval.low)} … {end(interval.high)}"


def modes(record):
    labels = [text for text in record.cells.get(MODE, []) if text]
    if labels:
        yield "share of the rows that fail by"
        for mode, found in statistics.shares(labels).items():
            yield line(mode, found, "{:.3f}")


def statuses(record):
    fast = record.cells.get("too_fast", []).count("True")
    if fast:
        yield (
            f"note: {fast} of {len(record)} rows, all in the numbers above, were pushed too fast:"
            f" over {100 * IMBALANCE:g} % of the force does not reach the supports; lower the rate"
        )
    counts = Counter(text for text in record.cells["status"] if text != "ended")
    if counts:
        names = (f"{n} {status or 'not run'}" for status, n in sorted(counts.items()))
        yield f"rows that have not ended: {', '.join(names)}"


def draw(record, measure):
    """Write the pictures that the rows allow, and yield a line for each, or why there is none."""
    rows, inputs, values = record.complete(measure)
    title = label(measure)
    inputs = {name: column for name, column in inputs.items() if np.ptp(column) > 0}
    modes = record.cells.get(MODE)
    modes = modes and [modes[row] or "unknown" for row in rows]

    def fan(path):
        curves = record.curves(rows, *CURVE)
        if not curves:
            raise Refused("no row has a curve of " + " and ".join(CURVE))
        pictures.fan(path, curves, *map(label, CURVE))

    shares = {"sobol.png": (sensitivity.sobol, pictures.sobol)}
    drawn = {pair: rank for pair, rank in record.correlation.items() if {*pair} <= {*inputs}}
    if pairs := drawn or sensitivity.dependent(inputs):
        shares = {"shapley.png": (sensitivity.shapley, pictures.shapley)}
        tied = ", ".join(f"{one} and {two} by {rank:.2f}" for (one, two), rank in pairs.items())
        yield (
            f"note: correlated by rank are {tied}: Shapley effects, which divide evenly what these"
            " explain together, stand in place of Sobol indices"
        )
    fields = [name for name in record.varied if name.startswith(batch.FIELD)]
    rest = "random fields\nand what is not followed" if fields else "what is not followed"

    def variance(path):
        find, picture = shares[os.path.basename(path)]
        picture(path, find(inputs, values), title, rest)

    effects = sensitivity.effects
    makes = {
        "scatter.png": lambda path: pictures.scatter(path, inputs, values, title),
        "tornado.png": lambda path: pictures.tornado(path, effects(inputs, values), title),
        **dict.fromkeys(shares, variance),
        "histogram.png": lambda path: pictures.histogram(path, values, title, modes),
        "fragility.png": lambda path: pictures.fragility(path, values, title),
        "curves.png": fan,
    }
    yield from _drawn(record.directory, makes)


def _drawn(directory, makes):
    """Write files, and yield a line for each, or why there is none.

    :param makes: dict of a name of a file -> function of the path that writes it or raises Refused
    """
    for name, make in makes.items():
        path = os.path.join(directory, name)
        try:
            make(path)
            yield path
        except Refused as refused:
            yield f"no {name}: {refused}"


def incremental(demands, limit, intensities):
    """Lines of what an incremental dynamic analysis says: demands at every level, and the fragility
    of a limit of the demand (None: collapse), with its probability at some intensities."""
    measure, reaches = label(demands.intensityName), reached(demands, limit)
    yield (
        f"incremental dynamic analysis of {len(demands.names)} records; the intensity is {measure}"
    )
    if demands.measure:
        yield (
            f"the demand is the amount of {label(demands.measure)}; where the structure falls, and"
            " above, it is infinite"
        )
    else:
        yield "no row has a demand: scene.watch() records one"
    row = lambda cells: "".join(f"{cell:>11}" for cell in cells)
    heads = row(f"{100 * share:g} %" for share in QUANTILES)
    yield f"  {measure:>12} {heads}   records: {reaches}"
    for level, count, known in demands.counts(limit):
        cells = row(map(_cell, demands.quantiles(level)))
        yield f"  {level:12.4g} {cells}   {count} of {known}"
    try:
        fit = demands.fragility(limit)
    except Refused as refused:
        yield str(refused)
        return
    yield f"fragility, {reaches}: lognormal, of {fit.reached} of {fit.records} records"
    yield line(f"median {measure.partition('[')[2] and '[g]'}", fit.median)
    yield line("dispersion [-]", fit.dispersion)
    yield (
        "  maximum likelihood of the levels between which each record reaches the limit;"
        f" {100 * statistics.CONFIDENCE:g} % intervals of the profile likelihood, records being"
        " independent"
    )
    if intensities:
        yield f"probability that {reaches}, at {measure}"
        for one in intensities:
            yield line(f"{one:g}", fit.probability(one), "{:.3f}")


def reached(demands, limit):
    if limit is None:
        return "the structure falls"
    return f"{label(demands.measure or 'demand')} reaches {limit:g}"


def _cell(value):
    return "-" if math.isnan(value) else "infinite" if math.isinf(value) else f"{value:.4g}"


def drawIncremental(demands, groups, limit):
    """Write the pictures of an incremental dynamic analysis, and the fragilities of its groups by
    their names, also for OpenQuake. Yields as :func:`draw`."""
    measure, reaches = label(demands.intensityName), reached(demands, limit)

    def curves(path):
        if not demands.measure:
            raise Refused("no row has a demand")
        points = [(level, demands.quantiles(level)) for level in demands.levels]
        quantiles = {
            share: [(level, q[n]) for level, q in points if not math.isnan(q[n])]
            for n, share in enumerate(QUANTILES)
        }
        pictures.ida(path, demands.rows, demands.fell, quantiles, label(demands.measure), measure)

    def fits():
        found, why = {}, None
        for name, one in groups.items():
            try:
                found[name] = one.fragility(limit)
            except Refused as refused:
                why = refused
        if not found:
            raise why or Refused("no record is in a group")
        return found

    def fragility(path):
        found = {name: (fit, groups[name].counts(limit)) for name, fit in fits().items()}
        pictures.fitted(path, found, measure, f"probability: {reaches}")

    def nrml(path):
        folder = os.path.basename(os.path.abspath(demands.directory))
        own = {f"{folder} {name}".strip(): fit for name, fit in fits().items()}
        state = "collapse" if limit is None else "limit"
        written(path, nrmlOf(own, demands.intensityName, state, reaches, demands.levels[-1]))

    makes = {"ida.png": curves, "fragility.png": fragility, "fragility.xml": nrml}
    yield from _drawn(demands.directory, makes)


#: Options beside the folder, and what ``--help`` says of them.
OPTIONS = {
    "--measure": (
        f"column of study.csv; by default {MEASURE}, or the first answer of a stage if there is no"
        " push"
    ),
    "--demand": (
        "demands, with commas between them, for which the probability that the measure is not above"
        " them is told"
    ),
    "--limit": (
        "of an incremental dynamic analysis: the demand whose fragility is found; without it that"
        " of collapse. --measure is the demand, and --demand has intensities at which the"
        " probability is printed"
    ),
    "--by": (
        "of an incremental dynamic analysis: a column that says one thing of all rows of a record,"
        " as the class of damage with which they begin; each of its values has its own fragility"
    ),
}


def parser():
    parser = argparse.ArgumentParser(
        prog="python3 -m masonry_study.report",
        description="Statistics and pictures of a study.",
    )
    parser.add_argument("study", help="folder of a study, with its study.csv")
    for name, what in OPTIONS.items():
        parser.add_argument(name, help=what)
    parser.add_argument("--no-pictures", action="store_true", help="the table alone")
    return parser


@program
def main(words=None):
    args = parser().parse_args(words)
    demands = sorted(_listed("--demand", args.demand))
    limit = _listed("--limit", args.limit)
    check(args.study)
    said = _ofIncremental if isIncremental(args.study) else _ofRows
    try:
        for text in said(Record(args.study), args, limit, demands):
            say(text)
    except OSError as error:
        raise Refused(f"cannot write to {args.study}: {error.strerror}") from None


def isIncremental(directory):
    try:
        return Folder(directory).chains.plan is not None
    except Refused:
        return False


def _ofRows(record, args, limit, demands):
    if limit or args.by:
        raise Refused(f"--{'limit' if limit else 'by'}: this is no incremental dynamic analysis")
    measure = args.measure or record.measure(MEASURE)
    yield from (*table(record, measure), *modes(record), *statuses(record))
    if demands:
        values = record.complete(measure)[2]
        yield f"probability that {label(measure)} is not above"
        for demand, *found in zip(demands, *statistics.fragility(values, demands)):
            yield line(f"{demand:g}", statistics.Interval(*found), "{:.3f}")
    if not args.no_pictures:
        yield from draw(record, measure)


def _ofIncremental(record, args, limit, intensities):
    if len(limit) > 1 or limit and not limit[0] > 0:
        raise Refused(f"--limit {args.limit} must be one number above 0")
    if intensities and not intensities[0] > 0:
        raise Refused(f"--demand {args.demand}: intensities must be above 0")
    limit = limit[0] if limit else None
    found = Demands(record, args.measure)
    groups = {"": found}
    if args.by:
        groups = {f"{args.by} {v}": one for v, one in found.apart(record, args.by).items()}
    for name, one in groups.items():
        yield from [f"{name}:"] * bool(name)
        yield from incremental(one, limit, intensities)
    yield from statuses(record)
    if not args.no_pictures:
        yield from drawIncremental(found, groups, limit)


def _listed(option, text):
    try:
        numbers = list(map(float, text.split(","))) if text else []
    except ValueError:
        numbers = [math.nan]
    if not all(map(math.isfinite, numbers)):
        raise Refused(f"{option} {text} must be numbers with commas between them")
    return numbers


if __name__ == "__main__":
    sys.exit(main())
