# SPDX-License-Identifier: GPL-2.0-or-later
"""The analysis of gable.py. A file for masonry_study; README.md says how."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from quakes import study

ida = study("gable.py")
