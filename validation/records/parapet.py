# SPDX-License-Identifier: GPL-2.0-or-later
"""A parapet on the edge of a roof, shaken in three directions at once. The first component acts
along it.

With ``--collapse follow`` a run goes on when blocks fall, and stones that have slid become
contacts. README.md says what is assumed.
"""

import pathlib
import sys

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument(
    "--collapse",
    choices=["end", "follow"],
    default="end",
    help="what a run does when blocks fall (default: end)",
)
args = options.parse_args()

LENGTH, HEIGHT, THICK, PARAPET = 2.4, 0.6, 0.4, 0.8  # [m]

wall = bricks.Wall(LENGTH, HEIGHT, unit=(0.6, THICK, 0.2), halves=False)
parapet = bricks.Wall(LENGTH, PARAPET, unit=(0.6, THICK / 2, 0.2), halves=False)
wall += parapet.moved(0, THICK / 2, HEIGHT).named("parapet")

stones = materials.dry(friction=0.6, density=2000, normalStiffness=1e9 / 0.2)
scene = Scene(
    "parapet", wall, stones, plane=False, title="Parapet", collapse=args.collapse, arguments=args
)
scene.platen("bottom")
for x in (0.3, 0.9, 1.5, 2.1):  # the roof
    scene.spring((x, THICK / 2, HEIGHT - 0.1), stiffness=(20e6, 20e6, 0))
scene.watch((LENGTH / 2, THICK - 0.1, HEIGHT + PARAPET - 0.1), name="crest")
scene.settle()
files = [
    pathlib.Path(sys.argv[0]).with_name("reference") / f"19760911_1635_GMN_{c}.acc"
    for c in ("NS", "WE", "UD")
]
scene.shake(files, 0.005, unit="m/s²")
scene.finish()
