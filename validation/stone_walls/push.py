# SPDX-License-Identifier: GPL-2.0-or-later
"""The best estimates of all walls, pushed to the right and to the left. A file for masonry_study;
README.md says how."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rules
from masonry_study import Study

study = Study(
    "wall.py",
    design="grid",
    vary={
        "wall": list(rules.twins([*rules.read()])),
        "sample": [0, 1],
    },
)
