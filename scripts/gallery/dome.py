# SPDX-License-Identifier: GPL-2.0-or-later
"""A dome of voussoirs with an oculus, under its own weight and then under a growing horizontal
acceleration.

Between 0.448 and 0.450 g one side opens along its meridians and turns outwards. It takes about
10 s.
"""

from masonry import Scene, bricks, materials

dome = bricks.Dome(radius=2.0, thickness=0.25, courses=8, stones=16, oculus=0.4)

scene = Scene("dome", dome, materials.dry(friction=0.7, normalStiffness=2e10))
scene.platen("bottom")
scene.watch((0.4, 0, dome.high[2]), name="crown")
scene.settle()
scene.accelerate(1.2, rate=0.2)  # [g], [g/s]
print(f"holds {scene.factor:.3f} g")
scene.finish()
