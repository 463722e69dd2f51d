# SPDX-License-Identifier: GPL-2.0-or-later
"""COMP-1 with all values that the paper leaves open, each anywhere in its range. README.md says how
to run it."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from masonry.study import Study
from ranges import VARY

study = Study(
    "wall_comp1",
    options={"preset": "fast", "until": 25},
    runs=300,
    seed=1,
    vary=VARY,
    design="latin",
)
