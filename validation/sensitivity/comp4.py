# SPDX-License-Identifier: GPL-2.0-or-later
"""COMP-4 with all values that the paper leaves open, each anywhere in its range. README.md says how
to run it."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from masonry.study import Study
from ranges import VARY

study = Study(
    "wall_comp4",
    options={"preset": "fast", "until": 12},
    runs=300,
    seed=1,
    vary=VARY,
    design="latin",
)
