# SPDX-License-Identifier: GPL-2.0-or-later
"""A house of one storey under a growing acceleration: what it carries with a timber floor, with a
floor that does not shear, and with joists that only weigh.

``--diaphragm timber``, ``rigid`` or ``none``: shear stiffness G t of the floor of 1, 1000 or 0.001
MN/m. The house carries 0.36 g with a timber floor, 0.46 g with a rigid one and 0.31 g with
joists that only weigh; limit analysis, whose floor is rigid, has 0.557 g at most. It takes about
two minutes, and five with a rigid floor.
"""

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

STIFFNESS = {"timber": 1e6, "rigid": 1e9, "none": 1e3}  # [N/m]
options = parser(__doc__, until=None)
options.add_argument(
    "--diaphragm", choices=STIFFNESS, default="timber", help="kind of the floor (default: timber)"
)
args = options.parse_args()

UNIT = 0.6, 0.3, 0.3  # [m] squared stones
door = bricks.Opening(1.8, 0, 1.2, 1.8, bricks.Lintel(bearing=0.3, height=0.3))
walls = bricks.Room(4.8, 4.8, height=2.4, unit=UNIT, front=[door], halves=False)
floor = bricks.Floor((0, 0, 2.4), 4.8, 4.8, 0.2, along="x", strips=16)
stones = materials.dry(friction=0.6, density=2200)
stones.withFloor(floor, shear=STIFFNESS[args.diaphragm], mass=300, bearing="fixed")
scene = Scene(
    "house", walls + floor, stones, title=f"House, floor: {args.diaphragm}", arguments=args
)
scene.platen("bottom")
scene.watch((0.1, 2.4, 2.3), name="left")
scene.watch((2.4, 4.7, 2.3), name="back")
scene.settle()
scene.accelerate(1.0, towards=(1, 0, 0))
scene.finish()
