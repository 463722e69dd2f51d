# SPDX-License-Identifier: GPL-2.0-or-later
"""What the tilt of a rigid tower takes, which stands on soil without tension.

    yade -n -x validation/benchmark/tower_on_soil.py --lean
"""

from masonry import Scene, bricks, materials

stone = materials.dry(friction=0.9, density=1000, normalStiffness=1e12, young=1e15)
scene = Scene("tower_on_soil", bricks.stack(1, (3.6, 3.6, 20.0)), stone, plane=False)
scene.platen("bottom", springs={"z": 2e9}, uplift=True, height=0.2)
scene.watch((1.8, 1.8, 19.9), name="top")
scene.settle()
scene.tilt(12, rate=2)
scene.finish()
