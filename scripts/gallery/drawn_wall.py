# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall of stones from their outlines in a drawing, with mortar between them and a window, pushed
along itself.

Cracks go through the mortar, from the corners of the window to those of the wall. It takes about 5
s.
"""

import os
import sys

from masonry import Scene, bricks, materials

here = os.path.dirname(os.path.abspath(sys.argv[0]))
wall = bricks.fromOutlines(
    os.path.join(here, "drawn_wall.svg"), thickness=0.4, mortar=0.04, scale=0.001
)
stone = materials.masonry(
    E=1.5e9,
    unit_E=20e9,
    fc=4e6,
    fv0=0.1e6,
    friction=0.6,
    ft=0.05e6,
    unit=wall.unit,
    joint=wall.mortar,
    density=2200,
)
scene = Scene("drawn_wall", wall, wall.withMortar(stone), rate=50)  # mm/s
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)  # Pa
scene.settle()
scene.push(top, 8)  # mm
scene.finish()
