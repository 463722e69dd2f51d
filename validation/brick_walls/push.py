# SPDX-License-Identifier: GPL-2.0-or-later
"""All walls under the rule that was chosen, those with results first. A file for masonry_study."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import assumed
from masonry_study import Study

study = Study(
    "wall.py",
    design="grid",
    vary={"wall": list(assumed.twins([*assumed.known(), *assumed.read()]))},
)
