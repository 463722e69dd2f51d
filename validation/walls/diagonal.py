"""Share of the energy lost in shear within three courses of the corner-to-corner diagonal, without the joints of the
first and last courses, beside the share of the joints that lie there; from the last frame of a run.

/usr/bin/python3 validation/walls/diagonal.py results/wall_comp4
"""

import sys

import numpy as np
from masonry.figures import readFrame
from masonry.results import readRun

directory = sys.argv[1]
wall, joints = readRun(directory)["wall"], readFrame(directory, "joints")
_, first = np.unique(
    joints["bodies"], axis=0, return_index=True
)  # one subcontact a joint
centres = np.array([joints["points"][joints["cells"][i]].mean(axis=0) for i in first])
lost = joints["joint_dissipated"][first, 1]
along, down = centres[:, 0] / wall["length_m"], 1 - centres[:, 2] / wall["height_m"]
inner = (down > 0.05) & (down < 0.95)
near = inner & (np.abs(down - along) * wall["height_m"] < 3 * wall["unit_m"][2])
print(
    f"energy lost in shear near the diagonal {lost[near].sum() / lost[inner].sum():.2f}"
)
print(f"joints near the diagonal               {near.sum() / inner.sum():.2f}")
