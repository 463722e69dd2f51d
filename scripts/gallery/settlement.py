# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall with a door and a window on a support whose right half settles by 15 mm.

The support takes half of the wall with it. It takes about 6 s.
"""

from masonry import Scene, bricks, materials

lintel = bricks.Lintel(0.22, 0.162)
wall = bricks.Wall(
    4.4,
    2.916,
    openings=[
        bricks.Opening(0.88, 0, 0.88, 2.106, lintel),
        bricks.Opening(2.64, 0.81, 0.88, 1.296, lintel),
    ],
    halves=False,
)
left = bricks.block((0, 0, -0.2), (2.2, 0.102, 0), part="footing")
right = bricks.block((2.2, 0, -0.2), (4.4, 0.102, 0), part="footing")

scene = Scene("settlement", wall + left + right, materials.calciumSilicate(), rate=20)
rests = scene.hold((1.1, 0.05, -0.2), name="rests")
sinks = scene.hold((3.3, 0.05, -0.2), name="sinks")
scene.settle()
scene.move(sinks, z=-15)  # [mm]
scene.finish()
