# SPDX-License-Identifier: GPL-2.0-or-later
"""What a record takes on a wall of 100 bricks, which rocks out of its plane for two seconds.

    yade -n -x validation/benchmark/shaken_wall.py --lean
"""

import math

from masonry import Scene, bricks, materials

EVERY = 0.005  # [s]
record = [
    4 * math.sin(math.pi * EVERY * n / 2) * math.sin(4 * math.pi * EVERY * n) for n in range(401)
]

wall = bricks.Wall(4.4, 0.81, unit=(0.44, 0.22, 0.081), halves=False)
scene = Scene("shaken_wall", wall, materials.dry(normalStiffness=1e9), plane=False)
scene.platen("bottom")
scene.watch(wall.high, name="top")
scene.settle()
scene.shake(record, EVERY, direction=(0, 1, 0))
scene.finish()
