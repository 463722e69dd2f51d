# SPDX-License-Identifier: GPL-2.0-or-later
"""Two bricks and one bed joint: opening, shear under constant normal stress, closure, or closure
and then shear.

A fixed block holds the lower brick, a driven one that does not turn the upper. The closed forms for
these paths are in yade_plugin/law/README.md (yield surfaces, softening tables, compression).
"""

from masonry import Scene, bricks, materials
from masonry.arguments import number
from masonry.scene import options
from yade import O

COLUMNS = "time_s opening_mm slide_mm normal_stress_MPa shear_stress_MPa".split()
COLUMNS += ["normal_force_kN", "shear_force_kN"]
*_, HEIGHT = UNIT = (0.220, 0.102, 0.081)  # [m] of a brick

parser = options.parser(__doc__, until=2, rate=2, loops=False)
parser.add_argument(
    "--path",
    choices=["opening", "shear", "closure", "closure-shear"],
    default="shear",
    help="what the driven block does",
)
parser.add_argument(
    "--normal-stress",
    metavar="MPA",
    type=options.reading(number("MPa", -1000, 0)),
    default=-0.5,
    help="constant normal stress in shear [MPa], negative if it presses",
)
parser.add_argument(
    "--closure",
    metavar="MM",
    type=options.reading(number("mm", 0, 1000, above=True)),
    default=1.0,
    help="closure before shear [mm]",
)
parser.free.remove("until")  # the velocity and the rows follow from it
args = parser.parse_args()

pair, clay = bricks.stack(2, UNIT), materials.calciumSilicate()
scene = Scene("couplet", pair, clay, gravity=0, columns=COLUMNS, arguments=args)
base = scene.platen("bottom", height=HEIGHT)
top = scene.platen("top", upTo=3 * HEIGHT, point=(0.110, 0.051, 2 * HEIGHT), drive="zx")
bed = scene.joint(0, 1, name="")
force = lambda i: 1e-3 * O.forces.f(base.body, True)[i]  # on the fixed block [kN]
scene.column("normal_force_kN", "force on it, upwards [kN]", lambda: force(2))
scene.column("shear_force_kN", "force on it, along the slide [kN]", lambda: force(0))
lift = {"opening": args.until, "closure": -args.until, "closure-shear": -args.closure}
if args.path in lift:
    scene.drive(top, z=lift[args.path])
if args.path == "shear":
    scene.pressJoint(top, bed, args.normal_stress * 1e6)
if args.path.endswith("shear"):
    scene.drive(top, x=args.until)
scene.finish()
