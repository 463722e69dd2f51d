# SPDX-License-Identifier: GPL-2.0-or-later
"""A free-standing parapet, 0.9 m high and 0.22 m thick, shaken out of its plane by a record.
Without damping.

It rocks, slides and stays. It takes about 4 s.
"""

import math

from masonry import Scene, bricks, materials

wall = bricks.Wall(0.88, 0.891, unit=(0.44, 0.22, 0.081), halves=False)
every = 0.005  # [s]
times = [every * n for n in range(401)]
# a record of 2 s: a sine of 2 Hz that swells and fades, 4 m/s²
record = [4 * math.sin(math.pi * t / 2) * math.sin(4 * math.pi * t) for t in times]  # [m/s²]

scene = Scene("parapet", wall, materials.dry(normalStiffness=1e9), plane=False)
scene.platen("bottom")
scene.watch(wall.high, name="top")
scene.settle()
scene.shake(record, every, direction=(0, 1, 0), after=1.0)
scene.finish()
