# SPDX-License-Identifier: GPL-2.0-or-later
"""All walls, each pushed as often as its interval needs. A file for masonry_study; README.md says
how."""

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
        "sample": list(range(rules.SAMPLES + 2)),
    },
)
