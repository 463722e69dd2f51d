# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of both studies of this folder, printed, and their pictures, which masonry_study.report
draws, copied into this folder.

/usr/bin/python3 validation/random_fields/results.py
"""

import os
import shutil
import sys
from functools import partial

from masonry_study import statistics
from masonry_study.records import Record
from masonry_study.report import MEASURE, MODE, SHARES

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies

STUDIES = {"one_metre": "1 m", "one_brick": "one brick"}
#: Pictures that are shown.
PICTURES = ("one_metre", "histogram"), ("one_brick", "histogram"), ("one_metre", "curves")
NUMBERS = {"mean": statistics.mean, "standard deviation": statistics.deviation}
NUMBERS |= {f"{100 * q:g} % quantile": partial(statistics.quantile, share=q) for q in SHARES}


def shown(one, factor=1.0):
    """An interval as a cell of a table."""
    value, low, high = (factor * number for number in (one.value, one.low, one.high))
    return f"{value:.1f} ({low:.1f} … {high:.1f})"


def main():
    folders = {
        name: os.path.join(studies.RESULTS, "validation/random_fields", name) for name in STUDIES
    }
    records = [Record(folder) for folder in folders.values()]
    values = [record.complete(MEASURE)[2] for record in records]
    rows = [[name, *(shown(find(one)) for one in values)] for name, find in NUMBERS.items()]
    print(studies.table(["peak base shear, kN", *STUDIES.values()], rows), end="\n\n")
    found = [dict(statistics.shares([t for t in r.cells[MODE] if t])) for r in records]
    rows = [
        [mode, *(shown(one[mode], 100) if mode in one else "0" for one in found)]
        for mode in dict.fromkeys(mode for one in found for mode in one)
    ]
    print(studies.table(["failure mode at 6 mm, %", *STUDIES.values()], rows))
    for name, picture in PICTURES:
        path = os.path.join(folders[name], picture + ".png")
        shutil.copy(path, os.path.join(HERE, f"{picture}_{name}.png"))


if __name__ == "__main__":
    main()
