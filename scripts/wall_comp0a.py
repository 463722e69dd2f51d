# SPDX-License-Identifier: GPL-2.0-or-later
"""TUD-COMP-0a: slender calcium-silicate wall, double clamped, 0.70 MPa. Tables 1 and 2 of the
paper."""

from masonry import Scene, bricks, materials
from masonry.numbers import columns

scene = Scene(
    "wall_comp0a",
    bricks.Wall(1.1, 2.754),
    materials.calciumSilicate(),
    title="TUD-COMP-0a: 1.1 × 2.76 m, double clamped, 0.70 MPa",
    columns=columns.heads(columns.PUSH),
    until=40,  # [mm], where --until says nothing else
)
scene.platen("bottom")
top = scene.platen("top", recorded=2.754, drive="x")
scene.press(top, 0.70e6)  # [Pa] on the top course
scene.settle(damping="local", record=False)
scene.push(top)  # to --until or along --history
scene.finish()
