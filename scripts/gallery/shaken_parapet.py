# SPDX-License-Identifier: GPL-2.0-or-later
"""A parapet that pulses shake off a façade onto the pavement, whose reaction is recorded. Two
floors hold the façade. Without damping.

It takes about 16 s.
"""

import math

from masonry import Scene, bricks, materials

LENGTH, HEIGHT, THICK, PARAPET = 1.6, 2.4, 0.4, 0.8  # [m]
EVERY = 0.01  # [s]

facade = bricks.Wall(LENGTH, HEIGHT, unit=(0.4, THICK, 0.2), halves=False)
parapet = bricks.Wall(LENGTH, PARAPET, unit=(0.4, THICK / 2, 0.2), halves=False)
walls = facade + parapet.moved(0, THICK / 2, HEIGHT).named("parapet")
footing = bricks.block((0, 0, -0.2), (LENGTH, THICK, 0), part="footing")
pavement = bricks.block((-1, THICK + 0.1, -0.2), (LENGTH + 1, 4.5, 0), part="pavement")
# pulses of 0.8 s, a whole sine each, with a peak of 2.5, 3, 3.5, ... m/s²
pulses = [
    (2.5 + 0.5 * n) * math.sin(2 * math.pi * EVERY * i / 0.8) for n in range(5) for i in range(80)
]

stones = materials.dry(friction=0.6, density=2000, normalStiffness=5e9)
scene = Scene(
    "shaken_parapet",
    walls + footing + pavement,
    stones,
    plane=False,
    title="Parapet shaken off a façade",
    collapse="follow",
)
scene.hold((LENGTH / 2, THICK / 2, -0.1), name="footing")
scene.hold((0, 2, -0.1), name="pavement")
for z in (HEIGHT / 2, HEIGHT - 0.1):  # two floors
    for x in (0.2, 0.6, 1.0, 1.4):
        scene.spring((x, THICK / 2, z), stiffness=(0, 20e6, 0))
scene.watch((LENGTH / 2, THICK - 0.1, HEIGHT + PARAPET - 0.1), name="crest")
scene.settle()
scene.shake(pulses, EVERY, direction=(0, -1, 0))
blow = max(-1e3 * force for force in scene.results.column("pavement_force_z_kN"))
scene.result("largest_force_on_the_pavement", 1e-3 * blow, "kN", "of the rows of curve.csv")
scene.finish()
