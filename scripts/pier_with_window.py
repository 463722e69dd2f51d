# SPDX-License-Identifier: GPL-2.0-or-later
"""A pier with a window, under cycles: calcium-silicate wall of 3.08 × 2.43 m between stiff beams,
0.3 MPa.

Cycles of 2, 4 and 8 mm crack it in steps to both sides. It takes about 20 s.
"""

from masonry import Scene, bricks, materials

window = bricks.Opening(x=0.99, z=0.81, width=1.1, height=0.972, lintel=bricks.Lintel(0.22, 0.162))
wall = bricks.Wall(length=3.08, height=2.43, openings=[window])

scene = Scene("pier_with_window", wall, materials.calciumSilicate(), rate=50)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)  # [Pa]
scene.pier()
scene.spandrel()
scene.settle()
scene.cycle(top, [2, 4, 8])  # [mm]
scene.finish()
