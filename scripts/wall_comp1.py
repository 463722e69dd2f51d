# SPDX-License-Identifier: GPL-2.0-or-later
"""TUD-COMP-1: slender calcium-silicate wall, cantilever, 0.70 MPa. Tables 1 and 2 of the paper."""

from masonry import Scene, bricks, materials
from masonry.numbers import columns

scene = Scene(
    "wall_comp1",
    bricks.Wall(1.1, 2.754),
    materials.calciumSilicate(),
    title="TUD-COMP-1: 1.1 × 2.76 m, cantilever, 0.70 MPa",
    columns=columns.heads(columns.PUSH),
    until=40,  # [mm], where --until says nothing else
)
scene.platen("bottom")
# pushed at its upper side: shear ratio × width above the base
top = scene.platen("top", rotation="free", upTo=3.19, recorded=2.754, drive="x")
scene.press(top, 0.70e6)  # [Pa] on the top course
scene.settle(damping="local", record=False)
scene.push(top)  # to --until or along --history
scene.finish()
