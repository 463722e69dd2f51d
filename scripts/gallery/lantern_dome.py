# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry dome whose lantern becomes heavier until the dome falls.

It carries 19.7 kN beside the weight of the lantern; statics of a lune, whose stones press on their
neighbours but do not pull, have 19.93 kN. It takes about 10 s.
"""

from masonry import Scene, bricks, materials

dome = bricks.Dome(radius=2.0, thickness=0.2, courses=8, stones=16, oculus=0.4, lantern=0.5)

stones = materials.dry(friction=0.7, normalStiffness=2e10)
scene = Scene("lantern_dome", dome, stones, title="Dome with a lantern")
scene.platen("bottom")
lid = scene.handle(len(dome) - 1, name="lid")
scene.settle()
scene.grow({lid: (0, 0, -25e3)}, most=1)  # [N]
print(f"carries {scene.factor:.2f} kN")
scene.finish()
