# SPDX-License-Identifier: GPL-2.0-or-later
"""One of the walls of walls.csv, pushed until it has lost half of its force or to a drift of 2 %.

Its joints and bricks come from assumed.py; README.md says how.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))  # in YADE, __file__ is YADE
import assumed
import pushed
from masonry.scene import options

parser = options.parser(__doc__, until=None)
parser.add_argument("--wall", metavar="N", required=True, help="number of the wall in walls.csv")
parser.add_argument("--rule", choices=list(assumed.RULES), default=assumed.CHOSEN)
args = parser.parse_args()

guess = assumed.Guess(assumed.read()[args.wall], assumed.RULES[args.rule])
pushed.carryOut(f"brick_wall_{args.wall}", guess, args, farthest=2.0)
