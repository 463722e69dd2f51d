"""Granite walls with dry joints, Vasconcelos and Lourenço (2009): 1.0 × 1.2 m, cantilever pushed at 1.325 m.

The vertical load is what the top course feels. The granite blocks do not crack.
"""

from functools import partial

from masonry import materials, options, walls

BLOCK = (0.200, 0.200, 0.150)  # [m] length, thickness, height
LOAD_HEIGHT = 1.325  # [m] displacements refer to it too

parser = options.parser(__doc__, until=30, rate=5)
parser.add_argument(
    "--level",
    metavar="KN",
    type=int,
    choices=list(materials.DRY_GRANITE_MASONRY),
    default=175,
    help="vertical load [kN]: 100, 175 or 250",
)
parser.add_argument(
    "--load-line",
    choices=["fixed", "riding"],
    default="fixed",
    help="whether the vertical load stays in place or moves with the wall",
)
parser.set_defaults(crack_surfaces="off", subcontacts=16)
args = parser.parse_args()

wall = walls.Wall(
    name="wall_dry",
    title=f"Dry-joint granite wall, 1.0 × 1.2 m, cantilever, {args.level} kN",
    halfUnits=10,
    courses=8,
    unit=BLOCK,
    precompression=args.level * 1e3 / (1.0 * BLOCK[1]),  # [Pa]
    loadHeight=LOAD_HEIGHT,
    measureHeight=LOAD_HEIGHT,
    loadLineFixed=args.load_line == "fixed",
    unitMaterial=materials.graniteUnit,
    joints=partial(materials.dryGraniteJoints, args.level, BLOCK[2]),
)
raise SystemExit(walls.test(wall, args))
