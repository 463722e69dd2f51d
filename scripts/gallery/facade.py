# SPDX-License-Identifier: GPL-2.0-or-later
"""A façade of two storeys with doors, windows and spandrels, 16.28 × 6.885 m, 5,010 bricks: pushed
at its top.

It carries 150.5 kN, until the piers of its upper storey slide. It takes about a minute.
"""

from masonry import Scene, bricks, materials

opening = lambda x, z, height: bricks.Opening(x, z, 1.32, height, bricks.Lintel(0.22, 0.162))
places = (1.1, 4.29, 7.48, 10.67, 13.86)  # [m]
doors = [opening(x, 0, 2.106) for x in places]
windows = [opening(x, 3.969, 1.377) for x in places]
wall = bricks.Wall(16.28, 6.885, openings=[*doors, *windows], halves=False)

scene = Scene("facade", wall, materials.calciumSilicate(), rate=50)
base, top = scene.platen("bottom"), scene.platen("top", rotation="free")
scene.press(top, 0.1e6)  # [Pa], the roof
scene.settle()
scene.push(top, 20)  # [mm]
scene.finish()
