"""Two bricks and one bed joint: opening, shear under constant normal stress, closure, or closure and then shear.

A fixed block holds the lower brick, a driven one that does not turn the upper. Closed forms: law.md §6.
"""

from masonry import couplet, options

parser = options.parser(__doc__, until=2, rate=2)
parser.add_argument(
    "--path", choices=couplet.PATHS, default="shear", help="what the driven block does"
)
parser.add_argument(
    "--normal-stress",
    metavar="MPA",
    type=lambda text: options.number(text, -1000, 0),
    default=-0.5,
    help="constant normal stress in shear [MPa], negative closed",
)
parser.add_argument(
    "--closure",
    metavar="MM",
    type=lambda text: options.number(text, 0, 1000, above=True),
    default=1.0,
    help="closure before shear [mm]",
)
parser.free.remove("until")  # rows and velocity follow from it
raise SystemExit(couplet.test(parser.parse_args()))
