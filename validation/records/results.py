# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables, figure and fragility model of the analyses of this folder.

/usr/bin/python3 validation/records/results.py DIR

DIR has the folders of the studies: ida_parapet, ida_gable, ida_facade.
"""

import os
import sys

import numpy as np
from masonry.errors import Refused
from masonry.numbers import drawing
from masonry.scene.ground import readRecord
from masonry_study import Sa, fragility
from masonry_study.demands import Demands
from masonry_study.gathering import written
from masonry_study.incremental import Measure
from masonry_study.records import Record

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies

#: Of every structure the point whose largest displacement out of the plane is the demand, and half
#: the thickness [mm].
POINTS = {"parapet": ("crest", 100), "gable": ("ridge", 150), "facade": ("top", 200)}
MEASURES = Measure(), Sa(0.3), Sa(1.0)
WHAT = (
    "collapse of three structures of dry stones, twelve records of three components; PGA is the"
    " geometric mean of both horizontal components"
)


def fits(found, folder, limit=None):
    """The fragility of collapse by every measure of intensity, dict of its name -> Fit. The levels
    of each record are converted by its own ratio of the measures.

    :param limit: of the demand in place of collapse [mm]
    """
    low, high = found.intervals(limit)
    motions = [
        readRecord(os.path.join(folder, "records", f"{name}.txt"), None) for name in found.names
    ]
    peaks = np.array([Measure().of(*motion) for motion in motions])
    made = {}
    for measure in MEASURES:
        ratio = np.array([measure.of(*motion) for motion in motions]) / peaks
        made[measure.name] = fragility.fit(low * ratio, high * ratio)
    return made


def medians(name, made):
    """Rows of a table: median and dispersion with their intervals, by the measure of intensity."""
    for measure, fit in made.items():
        numbers = [
            f"{one.value:.2f} ({one.low:.2f} … {one.high:.2f})"
            for one in (fit.median, fit.dispersion)
        ]
        yield [name, measure, *numbers, f"{fit.reached} of {fit.records}"]


def demands(name, found):
    """Rows of a table: quantiles of the demand at every level [mm]."""
    for level, fell, known in found.counts():
        quantiles = [f"{q:.0f}" for q in found.quantiles(level)]
        yield [name, f"{level:g}", *quantiles, f"{fell} of {known}"]


def draw(path, all):
    """The fragilities of all structures by the peak ground acceleration, and the shares of records
    that fell."""
    with drawing.picture(path, 6.0, 3.8, 110, {"font.size": 8}) as figure:
        axis = figure.subplots()
        for n, (name, (found, made)) in enumerate(all.items()):
            x, fit = np.linspace(0.02, 1.1 * found.levels[-1], 300), made["PGA_g"]
            label = (
                f"{name}: median {fit.median.value:.2f} g, dispersion {fit.dispersion.value:.2f}"
            )
            axis.plot(x, [fit.probability(v).value for v in x], color=f"C{n}", label=label)
            axis.plot(
                *zip(*((v, k / of) for v, k, of in found.counts() if of)),
                ls="",
                marker="o",
                ms=4,
                color=f"C{n}",
            )
        drawing.finish(axis, "PGA [g]", "probability of collapse", loc="lower right")


def main(folder):
    """The program."""
    all, fitted, moved = {}, [], []
    for name, (point, half) in POINTS.items():
        place = os.path.join(folder, f"ida_{name}")
        try:
            found = Demands(Record(place), f"shake_2_largest_displacement_of_{point}_y_mm")
            all[name] = found, fits(found, place)
        except Refused as refused:
            print(refused)
            continue
        fitted += medians(f"{name}, falls", all[name][1])
        fitted += medians(f"{name}, {half} mm", fits(found, place, half))
        moved += demands(name, found)
    heads = "structure and limit, measure, median, dispersion, records that reach it"
    print(studies.table(heads.split(", "), fitted), end="\n\n")
    heads = "structure, PGA g, 16 % mm, 50 % mm, 84 % mm, fell"
    print(studies.table(heads.split(", "), moved))
    models = {name: made["PGA_g"] for name, (_, made) in all.items()}
    highest = max(found.levels[-1] for found, _ in all.values())
    written(
        os.path.join(HERE, "fragility.xml"),
        fragility.nrml(models, "PGA_g", "collapse", WHAT, highest),
    )
    draw(os.path.join(HERE, "fragility.png"), all)


if __name__ == "__main__":
    main(sys.argv[1])
