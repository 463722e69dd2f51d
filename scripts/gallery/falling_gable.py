# SPDX-License-Identifier: GPL-2.0-or-later
"""A gable on a thicker wall is shaken out of its plane by pulses that grow, until it falls. The
wall below stands.

The triangle is 0.22 m thick, in a weak lime mortar, so what falls is pieces that hold together
until they land. About 45 stones fall; impacts decide how many exactly. Without damping. It takes
about 100 s.
"""

import math

from masonry import Scene, bricks, materials

LENGTH, EAVES, RISE, THICK, COURSE = 3.6, 0.9, 1.8, 0.22, 0.15  # [m]
UNIT = 0.45, THICK, COURSE  # [m]
EVERY = 0.01  # [s]

gable = bricks.Wall(LENGTH, RISE, unit=UNIT, halves=False)
for side in (-1, 1):  # both verges
    gable = gable.cut((LENGTH / 2, 0, RISE), (side * RISE, 0, LENGTH / 2), own=True)
inside = lambda b: abs(b.middle[0] - LENGTH / 2) < (RISE - b.middle[2]) * LENGTH / 2 / RISE
wall = bricks.Wall(LENGTH, EAVES, unit=(0.45, 2 * THICK, COURSE), halves=False)
wall += gable.where(inside).moved(0, THICK / 2, EAVES).named("gable")

stone = materials.masonry(
    E=1e9,
    unit_E=5e9,
    fc=3e6,
    fv0=0.05e6,
    friction=0.6,
    bond_wrench=0.04e6,
    unit=(0.45, THICK, 0.14),
    joint=0.01,
    density=2000,
)
# pulses of one second, a whole sine each, with a peak of 3 and 4 m/s²
pulses = [peak * math.sin(2 * math.pi * EVERY * i) for peak in (3, 4) for i in range(100)]

scene = Scene(
    "falling_gable", wall, stone, plane=False, title="Gable under growing pulses", collapse="follow"
)
scene.platen("bottom")
scene.watch((LENGTH / 2, THICK, EAVES + RISE - 0.1), name="ridge")
scene.watch((LENGTH / 2, THICK, EAVES - 0.1), name="eaves")
scene.settle()
scene.shake(pulses, EVERY, direction=(0, 1, 0), after=0.5)
scene.finish()
