# SPDX-License-Identifier: GPL-2.0-or-later
"""The walls with results under all rules of README.md. A file for masonry_study."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import assumed
from masonry_study import Study

study = Study(
    "wall.py",
    design="grid",
    vary={
        "rule": [rule for rule in assumed.RULES if rule != assumed.CHOSEN],
        "wall": list(assumed.twins(assumed.known())),
    },
)
