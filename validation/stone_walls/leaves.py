# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall of three leaves in space beside the same wall as one leaf in its plane: how much the
decision of README.md costs.

yade -n -x validation/stone_walls/leaves.py --wall 28 --leaves 3 --lean --out
results/stone_walls/leaves_3 yade -n -x validation/stone_walls/leaves.py --wall 28 --leaves 1 --lean
--out results/stone_walls/leaves_1

Leaves have other stones each, and the joint between them, the collar, is a bed joint.
"""

import os
import sys
from dataclasses import replace

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))  # in YADE, __file__ is YADE
import rules
from masonry import Scene, bricks, materials
from masonry.scene import options

parser = options.parser(__doc__, until=24, rate=50)
parser.add_argument("--wall", metavar="ID", default="28")
parser.add_argument("--leaves", type=int, default=3)
args = parser.parse_args()

row = rules.read()[args.wall]
thick = row.thickness / args.leaves
wall = bricks.Bricks()
for leaf in range(args.leaves):
    guess = rules.Guess(
        replace(row, thickness=thick, force=row.force / args.leaves), *rules.CHOSEN, leaf
    )
    wall += guess.bricks(bricks).moved(dy=leaf * thick).named(f"leaf {leaf + 1}")
stones = guess.masonry(materials)
stones.joints["collar"] = stones.joints["bed"]
scene = Scene(f"leaves_{args.leaves}", wall, stones, plane=False, arguments=args)
scene.platen("bottom")
above = dict(rotation="held") if row.clamped else dict(rotation="free", upTo=row.arm)
top = scene.platen("top", recorded=row.height, drive="xy", **above)
scene.press(top, guess.pressure, riding=False)
scene.settle(damping="local", record=False)
scene.push(top)
scene.finish()
