# SPDX-License-Identifier: GPL-2.0-or-later
"""TUD-COMP-6: squat calcium-silicate wall, cantilever, 0.50 MPa. Tables 1 and 2 of the paper.

The wall is 4.0 m long, 18.18 units; it is built of 18 units, 3.96 m.
"""

from masonry import Scene, bricks, materials
from masonry.numbers import columns

scene = Scene(
    "wall_comp6",
    bricks.Wall(3.96, 2.754),
    materials.calciumSilicate(),
    title="TUD-COMP-6: 4.0 × 2.76 m, cantilever, 0.50 MPa",
    columns=columns.heads(columns.PUSH),
    until=25,  # [mm], where --until says nothing else
)
scene.platen("bottom")
# pushed at its upper side: shear ratio × width above the base
top = scene.platen("top", rotation="free", upTo=3.20, recorded=2.754, drive="x")
scene.press(top, 0.50e6)  # [Pa] on the top course
scene.settle(damping="local", record=False)
scene.push(top)  # to --until or along --history
scene.finish()
