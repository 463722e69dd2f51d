# SPDX-License-Identifier: GPL-2.0-or-later
"""One of the 96 stone walls of reference/walls.csv, pushed until it has lost half of its force.

Its joints, stones and scatter come from rules.py; README.md says how.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))  # in YADE, __file__ is YADE
import pushed
import rules
from masonry.scene import options

parser = options.parser(__doc__, until=None)
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
args = parser.parse_args()

row = rules.read()[args.wall]
guess = rules.Guess(row, args.bond, args.stiffness, args.sample)
side = -1 if args.sample % 2 else 1  # of the push; stones are not symmetrical
pushed.carryOut(f"stone_wall_{args.wall}", guess, args, side=side)
