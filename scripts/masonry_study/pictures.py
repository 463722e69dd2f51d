# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of a study, for print. Each function writes one PNG file. ``inputs`` is a dict of the
name of a varied property -> its values, one a row, and ``label`` says what the output is, with its
unit in brackets."""

import contextlib
import itertools
import textwrap

import numpy as np
from scipy import stats

from masonry_view.comparison import COLOURS, DASHES
from masonry.errors import Refused
from masonry.numbers import drawing
from . import statistics

DPI = 200
BAND = 0.05, 0.95  # quantiles between which a fan is shaded
POINTS = 400  # along the axis of a fan, and of a fragility curve
STYLE = {"font.size": 8, "axes.titlesize": 9, "legend.fontsize": 7.5}
STYLE["axes.axisbelow"] = True
POINT, LINE = COLOURS[:2]
PART_COLOURS = [POINT, *COLOURS[2:], "#F0E442"]  # of bars
BAND_STYLE = dict(color=POINT, alpha=0.2, lw=0)
BAND_LABEL = f"{100 * statistics.CONFIDENCE:g} % confidence"
ABOVE = dict(loc="lower center", bbox_to_anchor=(0.5, 1.01))  # of a legend


def _picture(path, width, height):
    return drawing.picture(path, width, height, DPI, STYLE)


# -- one property against another ------------------------------------------------------------------


def scatter(path, inputs, output, label):
    """Every varied property and the output against each other, with histograms on the diagonal. The
    number in a panel is Spearman's correlation of ranks; k and M at a number stand for a thousand
    and a million. Raises Refused if there is no property."""
    from matplotlib.ticker import EngFormatter

    if not inputs:
        raise Refused(f"no number varies in this study beside {label}")
    columns = {**inputs, label: output}
    names, k = list(columns), len(columns)
    size = max(6.0, min(1.35 * k, 11.0))
    dot = float(np.clip(60 / np.sqrt(len(output)), 1.0, 10.0))
    with _picture(path, size, size) as figure:
        axes = figure.subplots(k, k, squeeze=False)
        for i, down in enumerate(names):
            for j, right in enumerate(names):
                axis, x, y = axes[i, j], columns[right], columns[down]
                if j > i:
                    axis.set_visible(False)
                    continue
                if i == j:
                    axis.hist(x, bins=_bins(x), color=POINT, alpha=0.6)
                    axis.set_yticks([])
                else:
                    style = dict(color=LINE if i == k - 1 else POINT, lw=0, alpha=0.7)
                    axis.scatter(x, y, s=dot, rasterized=True, **style)
                    rank = stats.spearmanr(x, y).statistic
                    axis.set_title(f"{rank:+.2f}", fontsize=7, pad=2)
                axis.tick_params(labelsize=6)
                axis.locator_params(nbins=3)
                for line, name in ((axis.xaxis, right), (axis.yaxis, down)):
                    if name != label and np.abs(columns[name]).max() >= 1e4:
                        line.set_major_formatter(EngFormatter(sep=""))
                if i < k - 1:
                    axis.set_xticklabels([])
                if j > 0:
                    axis.set_yticklabels([])
            if i:
                axes[i, 0].set_ylabel(_broken(down), fontsize=7)
        for j, right in enumerate(names):
            axes[-1, j].set_xlabel(_broken(right), fontsize=7)
        figure.align_labels()


# -- what decides ----------------------------------------------------------------------------------


def tornado(path, effects, label):
    """Change of the output by every property, largest on top, with its interval, and the
    correlations of ranks."""
    effects = dict(reversed(effects.items()))
    with _picture(path, 6.8, 1.1 + 0.3 * len(effects)) as figure:
        left, right = figure.subplots(1, 2, sharey=True, width_ratios=[3, 2])
        for axis, found in zip((left, right), zip(*effects.values())):
            colours = [LINE if one.value < 0 else POINT for one in found]
            _bars(axis, effects, found, color=colours, height=0.65)
            axis.axvline(0, color="black", lw=0.8)
        left.set_xlabel(f"change of {label}\nfrom the 5 % to the 95 % quantile of a property")
        right.set_xlim(-1.05, 1.05)
        right.set_xlabel("correlation of ranks [-]")


def sobol(path, found, label, rest):
    """First and total Sobol indices with their intervals, largest on top, and below the share of
    the variance that they leave.

    :param rest: what has that share
    """
    indices = dict(reversed(found.indices.items()))
    first, total = zip(*indices.values())
    with _shares(path, f"{label}: Sobol indices", found.explained, indices, rest) as axis:
        style = dict(height=0.34, cap=2)
        text = "total, with all interactions"
        _bars(axis, indices, total, -0.18, color=LINE, label=text, **style)
        _bars(axis, indices, first, 0.18, color=POINT, label="first, alone", **style)
        axis.legend(loc="lower right")


def shapley(path, found, label, rest):
    """Shapley effects with their intervals. Parameters as in :func:`sobol`."""
    effects = dict(reversed(found.effects.items()))
    title = f"{label}: Shapley effects of properties that depend on each other"
    with _shares(path, title, found.explained, effects, rest) as axis:
        _bars(axis, effects, [*effects.values()], color=POINT, height=0.65)


@contextlib.contextmanager
def _shares(path, title, explained, names, rest):
    """A picture of shares of the variance, to whose axis bars of some names are added."""
    with _picture(path, 6.0, 1.5 + 0.38 * len(names)) as figure:
        axis = figure.subplots()
        yield axis
        axis.barh(-1, 1 - explained, color="0.6", height=0.65)
        axis.set_yticks(range(-1, len(names)), [rest, *map(_shown, names)])
        axis.set_ylim(-1.7, len(names) - 0.3)
        axis.set_xlim(0, 1.05)
        axis.set_xlabel("share of the variance [-]")
        text = f"{title},\nof a surrogate that explains {100 * explained:.0f} % of the variance"
        figure.suptitle(text, fontsize=9)


def _bars(axis, names, intervals, shift=0.0, cap=2.5, **settings):
    """A bar with its interval for every name, the last on top."""
    rows = np.arange(len(names))
    value, low, high = np.transpose(intervals)
    ends = np.maximum([value - low, high - value], 0)
    whiskers = dict(ecolor="black", elinewidth=0.8, capsize=cap)
    axis.barh(rows + shift, value, xerr=ends, alpha=0.75, error_kw=whiskers, **settings)
    axis.set_yticks(rows, map(_shown, names))
    axis.set_ylim(-0.7, len(names) - 0.3)
    axis.grid(axis="x", alpha=0.3)


# -- how it scatters -------------------------------------------------------------------------------


def histogram(path, values, label, modes=None):
    """Histogram of the output with its quantiles of 5, 50 and 95 %, their intervals, and the fitted
    lognormal density.

    :param modes: a word for every value, which divides the bars into colours
    """
    words = np.asarray(modes or [f"{len(values)} rows"] * len(values))
    named = sorted(set(words), key=lambda word: (-np.sum(words == word), word))
    shares = [f"{word}, {100 * np.mean(words == word):.3g} %" for word in named]
    with _picture(path, 6.0, 3.8) as figure:
        axis = figure.subplots()
        axis.hist(
            [values[words == word] for word in named],
            bins=np.histogram_bin_edges(values, _bins(values)),
            density=True,
            stacked=True,
            color=[PART_COLOURS[n % len(PART_COLOURS)] for n in range(len(named))],
            alpha=0.5,
            label=shares if len(named) > 1 else named,
        )
        x = np.linspace(*axis.get_xlim(), POINTS)
        _lognormal(axis, values, x, stats.lognorm.pdf, lw=1.2)
        for share, dashes in zip((0.05, 0.5, 0.95), DASHES[1:]):
            found = statistics.quantile(values, share)
            text = f"{100 * share:g} % quantile: {found.value:.4g}"
            axis.axvline(found.value, color=LINE, lw=1.2, ls=dashes, label=text)
            low, high = np.clip([found.low, found.high], values.min(), values.max())
            axis.axvspan(low, high, color=LINE, alpha=0.12, lw=0)
        axis.set_xlabel(label)
        axis.set_ylabel("density")
        axis.legend(**ABOVE, ncols=2)


def fragility(path, capacities, label):
    """Probability that the capacity is not above a demand, with its band, and the fitted lognormal
    distribution."""
    reach = np.ptp(capacities) or abs(capacities[0]) or 1.0
    low, high = capacities.min() - 0.15 * reach, capacities.max() + 0.15 * reach
    demands = np.linspace(low, high, POINTS)
    probability, low, high = statistics.fragility(capacities, demands)
    with _picture(path, 6.0, 3.6) as figure:
        axis = figure.subplots()
        axis.fill_between(demands, low, high, **BAND_STYLE, step="post", label=BAND_LABEL)
        rows = f"{len(capacities)} rows"
        axis.step(demands, probability, where="post", color=POINT, lw=1.3, label=rows)
        _lognormal(axis, capacities, demands, stats.lognorm.cdf, lw=1, ls=DASHES[1])
        axis.set_ylim(0, 1)
        axis.set_xlim(demands[0], demands[-1])
        below = "probability that the capacity is below"
        drawing.finish(axis, f"demand on {label}", below, loc="lower right")


def _lognormal(axis, values, x, curve, **line):
    """The lognormal distribution that fits values, if there is one.

    :param curve: function of x, the dispersion and ``scale``, the median
    """
    if statistics.isLognormal(values):
        fit, x = statistics.lognormal(values), x[x > 0]
        text = f"lognormal: median {fit.median:.4g}, dispersion {fit.dispersion:.3g}"
        y = curve(x, fit.dispersion, scale=fit.median)
        axis.plot(x, y, color="black", label=text, **line)


# -- incremental dynamic analysis ------------------------------------------------------------------


def ida(path, rows, fell, quantiles, xLabel, yLabel):
    """Demand and intensity of every record, with the quantiles of the demand over the records.

    A curve ends at the last level at which the structure stood; a thin line leads from there to the
    right at the level at which it fell, or at which a quantile is infinite.

    :param rows: of every record its intensities and demands
    :param fell: of every record the intensity at which it fell; infinite: it stood
    :param quantiles: dict of a share -> list of (intensity, demand)
    :raises Refused: if no record has a demand
    """
    curves = [_standing(*one) for one in rows]
    largest = max(max(demands) for demands, _ in curves)
    if not largest > 0:
        raise Refused("no record has a demand at a level at which the structure stood")
    right = 1.15 * largest
    stands = dict(color="0.55", lw=0.7, marker=".", ms=3)
    falls = dict(color="0.55", lw=0.5, ls=DASHES[3])
    with _picture(path, 6.0, 4.2) as figure:
        axis = figure.subplots()
        for (demands, intensities), level in zip(curves, fell):
            axis.plot(demands, intensities, **stands)
            if np.isfinite(level):
                axis.plot([demands[-1], right], [level, level], **falls)
        for (share, points), dashes in zip(quantiles.items(), (DASHES[1], "-", DASHES[2])):
            demands, intensities = _standing(*zip(*points)) if points else ([0], [0])
            text = f"{100 * share:g} %"
            axis.plot(demands, intensities, color=LINE, lw=1.8, ls=dashes, label=text)
            beyond = [x for x, demand in points if np.isinf(demand)]
            if beyond:
                axis.plot([demands[-1], right], [beyond[0]] * 2, color=LINE, lw=1, ls=dashes)
        axis.plot([], [], **stands, label=f"{len(rows)} records")
        axis.plot([], [], **falls, label="falls at this level")
        axis.set_xlim(0, right)
        axis.set_ylim(bottom=0)
        drawing.finish(axis, xLabel, yLabel, **ABOVE, ncols=3)


def _standing(intensities, demands):
    """Demands and intensities from zero to the last level at which the structure stood; unknown
    ones are left out."""
    stood = itertools.takewhile(lambda one: not np.isinf(one[0]), zip(demands, intensities))
    found = [(0.0, 0.0), *(one for one in stood if not np.isnan(one[0]))]
    return tuple(map(list, zip(*found)))


def fitted(path, fits, xLabel, yLabel):
    """Fitted fragilities with their bands, and the shares of the records at every level.

    :param fits: by the name of a group of records, empty if it is the only one: the fit, and a list
        of (intensity, how many records have reached the limit, of how many)
    """
    known = {name: [(x, k / n) for x, k, n in counts if n] for name, (_, counts) in fits.items()}
    ends = [x for points in known.values() for x, _ in points]
    x = 1.3 * max([fit.median.value for fit, _ in fits.values()] + ends)
    x = x * np.arange(1, POINTS + 1) / POINTS
    with _picture(path, 6.0, 3.8) as figure:
        axis = figure.subplots()
        for n, (name, (fit, _)) in enumerate(fits.items()):
            values, low, high = np.transpose([fit.probability(v) for v in x])
            line, dot = (f"C{n}", f"C{n}") if name else ("black", LINE)
            band = dict(BAND_STYLE, color=line, alpha=0.15) if name else BAND_STYLE
            axis.fill_between(x, low, high, **band, label="" if n else BAND_LABEL)
            median, dispersion = fit.median.value, fit.dispersion.value
            text = f"{name or 'lognormal'}: median {median:.3g}, dispersion {dispersion:.3g}"
            axis.plot(x, values, color=line, lw=1.2, label=text)
            points = np.reshape(known[name], (-1, 2)).T
            own = f"share of {fit.records} records"
            axis.plot(*points, "o", ms=4, color=dot, label=own)
        axis.set_ylim(-0.02, 1.02)
        axis.set_xlim(0, x[-1])
        drawing.finish(axis, xLabel, textwrap.fill(yLabel, 45), loc="best")


# -- all curves ------------------------------------------------------------------------------------


def fan(path, curves, xLabel, yLabel):
    """All curves (x, y) over each other, with their median and the band that 90 % of them are in:
    of those that go on, up to where half have ended."""
    from matplotlib.collections import LineCollection

    curves = [increasing(*curve) for curve in curves]
    end = np.median([x[-1] for x, _ in curves])
    grid = np.linspace(min(x[0] for x, _ in curves), end, POINTS)
    values = [np.interp(grid, *curve, left=np.nan, right=np.nan) for curve in curves]
    low, median, high = np.nanquantile(values, (BAND[0], 0.5, BAND[1]), axis=0)
    with _picture(path, 6.0, 4.0) as figure:
        axis = figure.subplots()
        alpha = float(np.clip(12 / len(curves), 0.05, 0.6))
        lines, thin = [*map(np.column_stack, curves)], dict(color="0.35", lw=0.5)
        axis.add_collection(LineCollection(lines, alpha=alpha, zorder=1, **thin))
        band = "between the 5 % and the 95 % quantile"
        style = {**BAND_STYLE, "alpha": 0.25}
        axis.fill_between(grid, low, high, **style, zorder=2, label=band)
        axis.plot(grid, median, color=LINE, lw=1.8, zorder=3, label="median")
        axis.plot([], [], **thin, label=f"{len(curves)} curves")
        axis.autoscale_view()
        drawing.finish(axis, xLabel, yLabel, loc="lower right")


def calibration(path, found):
    """Measured curves with the band of what the draws of the properties say, and a run with their
    means."""
    (low, high), at = found.bands(), 0
    curves = [one.grid is not None for one in found.calibration.specimens]
    with _picture(path, 6.0, 3.2 * sum(curves)) as figure:
        axes = iter(figure.subplots(sum(curves), 1, squeeze=False)[:, 0])
        for one, isCurve in zip(found.calibration.specimens, curves):
            here, at = slice(at, at + len(one.names)), at + len(one.names)
            if not isCurve:
                continue
            axis, x = next(axes), one.grid
            axis.fill_between(x, low[here], high[here], **BAND_STYLE, label="95 % of the draws")
            for run in found.run:
                axis.plot(x, run[here], color=LINE, lw=1.4, label="run with their means")
            axis.plot(*one.curve, color="black", lw=0.8, alpha=0.5, label="measured")
            style = dict(color="black", fmt=".", lw=0.8, label="compared, ± 2 standard deviations")
            axis.errorbar(x, one.values, 2 * one.errors, **style)
            drawing.finish(axis, *(name.replace("_", " ") for name in one.columns), loc="best")


def increasing(x, y):
    """A curve without the rows that go back, thinned to no more than twice POINTS rows."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    rows = np.flatnonzero(x > np.append(-np.inf, np.maximum.accumulate(x)[:-1]))
    rows = rows[:: max(1, len(rows) // (2 * POINTS))]
    return x[rows], y[rows]


def _bins(values):
    """How many bins a histogram has: by the rule of Freedman and Diaconis, between 5 and 40."""
    return int(np.clip(len(np.histogram_bin_edges(values, "fd")) - 1, 5, 40))


def _shown(name):
    """A varied name for readers: kinds of joints that share their properties stand together, ``bed,
    head: cohesion``."""
    pairs = [part.partition(".")[::2] for part in name.split("+")]
    kinds, properties = map(dict.fromkeys, zip(*pairs))
    if not all(properties) or len(kinds) * len(properties) != len(pairs):
        return name.replace("+", ", ")
    return f"{', '.join(kinds)}: {', '.join(properties)}"


def _broken(name):
    return _shown(name).replace(": ", ":\n").replace(", ", ",\n").replace(" [", "\n[")
