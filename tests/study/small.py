# SPDX-License-Identifier: GPL-2.0-or-later
"""A small wall for studies: ``--fall`` lets it fail. A line a run that ended is added to the file
ended.txt beside the table."""

import os

from masonry import Scene, bricks, materials
from masonry.scene import options

parser = options.parser(__doc__, until=1, rate=20)
parser.add_argument("--fall", action="store_true", help="fail")
args = parser.parse_args()
scene = Scene("small", bricks.Wall(0.88, 0.648), materials.calciumSilicate(), arguments=args)
scene.platen("bottom")
top = scene.platen("top", drive="x")
scene.press(top, 0.3e6)
scene.settle()
if args.fall:
    raise RuntimeError("it was told to fall")
scene.push(top)
scene.finish()
if "YADE_BATCH" in os.environ:
    table = os.environ["YADE_BATCH"].rpartition(":")[0]
    with open(os.path.join(os.path.dirname(table), "ended.txt"), "a") as f:
        f.write(os.path.basename(scene.results.directory) + "\n")
