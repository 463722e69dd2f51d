# SPDX-License-Identifier: GPL-2.0-or-later
"""One of the 96 stone walls of reference/walls.csv, pushed until it has lost half of its force, or
in cycles.

Its joints, stones and scatter come from rules.py; README.md says how.
"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))  # in YADE, __file__ is YADE
import rules
from masonry import Scene, bricks, materials
from masonry.scene import options

LOST = 0.5  # share of the peak at which a push ends [-]
STEP = 0.25  # drift from one look at the force to the next [%]
FARTHEST = 4.0  # drift at which a push ends [%]
# of a wall whose modulus is 1 GPa [mm/s]; with its root for others, as the period of a soft wall is
# longer
RATE = 30

parser = options.parser(__doc__, until=1)
parser.add_argument(
    "--wall", metavar="ID", required=True, help="number of the wall in reference/walls.csv"
)
parser.add_argument(
    "--sample",
    metavar="N",
    type=int,
    default=0,
    help="0: best estimate; others: one of the interval",
)
parser.add_argument("--bond", choices=list(rules.BONDS), default=rules.CHOSEN[0])
parser.add_argument("--stiffness", choices=list(rules.STIFFNESSES), default=rules.CHOSEN[1])
parser.add_argument("--cyclic", type=int, default=0, help="1: in cycles")
args = parser.parse_args()

row = rules.read()[args.wall]
guess = rules.Guess(row, args.bond, args.stiffness, args.sample)
args.points = guess.points
wall = guess.bricks(bricks)
height = row.height
scene = Scene(
    f"stone_wall_{args.wall}",
    wall,
    guess.masonry(materials),
    title=f"{row.campaign} {row.name}",
    arguments=args,
)
scene.platen("bottom")
above = dict(rotation="held") if row.clamped else dict(rotation="free", upTo=row.arm)
top = scene.platen("top", recorded=height, **above)
scene.press(top, guess.pressure, riding=False)
scene.settle(damping="local", record=False)
rate = RATE * math.sqrt(guess.E / 1e9)
side = -1 if args.sample % 2 else 1  # of the push; stones are not symmetrical
drifts = guess.drifts if args.cyclic else [STEP * n for n in range(1, 1 + round(FARTHEST / STEP))]
peak, seen = 0.0, 0
for n, drift in enumerate(drifts):
    away = 1e1 * drift * height  # [mm]
    if args.cyclic:
        ended = scene.cycle(top, [away], rate=2 * rate)
    else:
        ended = scene.push(top, away, direction=(side, 0, 0), rate=rate, continued=n > 0)
    shear = scene.results.column("base_shear_kN")  # along the push
    force = max(shear[seen:]) if args.cyclic else shear[-1]
    seen, peak = len(shear), max(peak, force)
    if ended == "collapsed" or force < LOST * peak:
        break
scene.finish()
