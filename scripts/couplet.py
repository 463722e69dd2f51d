"""Two bricks and one bed joint: opening, shear under constant normal stress, closure, or closure and then shear.

A fixed block holds the lower brick, a driven one that does not turn the upper.
"""

from masonry import couplet, options
from masonry.loading import drive
from masonry.run import Run

parser = options.parser(__doc__, until=2, rate=2, loops=False)
parser.add_argument(
    "--path", choices=couplet.PATHS, default="shear", help="what the driven block does"
)
parser.add_argument(
    "--normal-stress",
    metavar="MPA",
    type=lambda text: options.number(text, -1000, 0),
    default=-0.5,
    help="constant normal stress in shear [MPa], negative if it presses",
)
parser.add_argument(
    "--closure",
    metavar="MM",
    type=lambda text: options.number(text, 0, 1000, above=True),
    default=1.0,
    help="closure before shear [mm]",
)
parser.free.remove("until")  # the velocity and the rows follow from it
args = parser.parse_args()

with Run("couplet", args) as run:
    model = run.build(couplet.CoupletModel(args))
    if args.path == "opening":
        drive(run, model, "vertical", args.until * 1e-3)
    if args.path == "closure":
        drive(run, model, "vertical", -args.until * 1e-3)
    if args.path == "closure-shear":
        drive(run, model, "vertical", -args.closure * 1e-3)
        drive(run, model, "lateral", args.until * 1e-3)
    if args.path == "shear":
        couplet.press(run, model, args.normal_stress * 1e6)
        drive(run, model, "lateral", args.until * 1e-3)
raise SystemExit(run.status)
