# SPDX-License-Identifier: GPL-2.0-or-later
"""The walls that were tested in cycles, with both laws. A file for masonry_study; README.md says
how."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rules
from masonry_study import Study

cyclic = [number for number, row in rules.read().items() if row.cyclic]
study = Study(
    "wall.py",
    options={"cyclic": 1},
    design="grid",
    vary={"joints": ["cyclic", "softening"], "wall": list(rules.twins(cyclic))},
)
