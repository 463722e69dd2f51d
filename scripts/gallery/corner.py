# SPDX-License-Identifier: GPL-2.0-or-later
"""Two walls that interlock at a corner: a horizontal acceleration out of the plane of one of them,
until it falls.

Between 0.1097 and 0.1103 g the return bends off the wall with which it interlocks. It takes about
two minutes.
"""

from masonry import Scene, bricks, materials

corner = bricks.Corner(1.65, 1.65, 1.62, halves=False)

scene = Scene("corner", corner, materials.dry(friction=0.6))
scene.platen("bottom")
scene.watch((0.05, 0.05, 1.62), name="corner")
scene.watch((0.05, 1.65, 1.62), name="end")
scene.settle()
scene.accelerate(0.3, towards=(1, 0, 0), rate=0.2)  # [g], [g/s]
print(f"holds {scene.factor:.3f} g")
scene.finish()
