# SPDX-License-Identifier: GPL-2.0-or-later
"""TUD-COMP-4: squat calcium-silicate wall, double clamped, 0.50 MPa. Tables 1 and 2 of the paper.

The wall is 4.0 m long, 18.18 units; it is built of 18 units, 3.96 m.
"""

from masonry import Scene, bricks, materials
from masonry.numbers import columns

scene = Scene(
    "wall_comp4",
    bricks.Wall(3.96, 2.754),
    materials.calciumSilicate(),
    title="TUD-COMP-4: 4.0 × 2.76 m, double clamped, 0.50 MPa",
    columns=columns.heads(columns.PUSH),
    until=12,  # [mm], where --until says nothing else
)
scene.platen("bottom")
top = scene.platen("top", recorded=2.754, drive="x")
scene.press(top, 0.50e6)  # [Pa] on the top course
scene.settle(damping="local", record=False)
scene.push(top)  # to --until or along --history
scene.finish()
