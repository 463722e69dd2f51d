# SPDX-License-Identifier: GPL-2.0-or-later
"""COMP-4 with bond strengths that vary over one brick. A file for masonry_study; README.md says
how."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from walls import walls

study = walls(length=0.22)
