# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall in Flemish bond, two wythes thick, between stiff beams: pushed along its plane. In space.

It shears through its bed joints. It takes about 15 s.
"""

from masonry import Scene, bricks, materials

wall = bricks.Wall(1.76, 1.62, bond="flemish", wythes=2, halves=False)

scene = Scene("flemish_wall", wall, materials.calciumSilicate(), rate=50)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)  # [Pa]
scene.settle()
scene.push(top, 6)  # [mm]
scene.finish()
