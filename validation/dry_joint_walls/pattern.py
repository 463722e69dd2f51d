# SPDX-License-Identifier: GPL-2.0-or-later
"""Draws cracks.png: the crack pattern of the dry wall at 3 mm.

/usr/bin/python3 validation/dry_joint_walls/pattern.py
"""

import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from studies import RESULTS, ROOT  # noqa: E402

folder = os.path.join(RESULTS, "validation", "dry_joint_walls", "pattern")
scene = os.path.join(ROOT, "scripts", "gallery", "wall_dry.py")
subprocess.run(["yade", "-n", "-x", scene, "--until", "3", "--out", folder], check=True)
shutil.copy(os.path.join(folder, "cracks.png"), os.path.join(HERE, "cracks.png"))
