# SPDX-License-Identifier: GPL-2.0-or-later
"""A free block of 0.25 × 1.0 m that a short pulse sets rocking, without damping.

It swings with the periods of Housner's rigid block. It takes about 2 s.
"""

from masonry import Scene, bricks, materials

block = bricks.stack(1, (0.25, 0.25, 1.0))

scene = Scene(
    "rocking_block",
    block,
    materials.dry(friction=5, normalStiffness=1e10),
    dt_fraction=0.1,
)
scene.platen("bottom")
scene.watch((0, 0, 1.0), name="corner")
scene.settle()
scene.shake([4.0] * 51 + [0.0], every=0.004, after=3.0)  # 4 m/s² for 0.2 s
scene.finish()
