# SPDX-License-Identifier: GPL-2.0-or-later
"""The 39 walls with results under all eight combinations of rules. A file for masonry_study;
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
        "bond": list(rules.BONDS),
        "stiffness": list(rules.STIFFNESSES),
        "wall": list(rules.twins(rules.KNOWN)),
    },
)
