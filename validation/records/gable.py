# SPDX-License-Identifier: GPL-2.0-or-later
"""A gable that carries the purlins of a roof, shaken in three directions at once. The first
component acts along it.

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

LENGTH, EAVES, RISE, THICK, COURSE = 4.8, 0.8, 2.4, 0.3, 0.4  # [m]
PURLIN = 3e3  # [N] that each of three purlins puts on the gable
FRICTION = 0.4  # of timber on masonry

gable = bricks.Wall(LENGTH, RISE, unit=(0.8, THICK, COURSE), halves=False)
for side in (-1, 1):  # both verges
    gable = gable.cut((LENGTH / 2, 0, RISE), (side * RISE, 0, LENGTH / 2), own=True)
inside = lambda b: abs(b.middle[0] - LENGTH / 2) < (RISE - b.middle[2]) * LENGTH / 2 / RISE
wall = bricks.Wall(LENGTH, EAVES, unit=(0.8, THICK, COURSE), halves=False)
wall += gable.where(inside).moved(0, 0, EAVES)

stones = materials.dry(friction=0.6, density=2000, normalStiffness=1e9 / COURSE)
scene = Scene(
    "gable",
    wall.named("gable"),
    stones,
    plane=False,
    title="Gable",
    collapse=args.collapse,
    arguments=args,
)
scene.platen("bottom")
for x in (0.2, LENGTH - 0.2):  # the cross walls
    scene.spring((x, THICK / 2, EAVES - COURSE / 2), stiffness=(0, 20e6, 0))
for x, z in ((LENGTH / 2, RISE - 0.6), (1.2, 0.6), (LENGTH - 1.2, 0.6)):
    stone = scene.handle((x, THICK / 2, EAVES + z))
    scene.load(stone, (0, 0, -PURLIN))
    for anchor in ((x, THICK / 2 + 4, EAVES + z), (x + 4, THICK / 2, EAVES + z)):
        scene.tie(
            stone, anchor=anchor, stiffness=10e6, strength=FRICTION * PURLIN, compression=True
        )
scene.watch((LENGTH / 2, THICK / 2, EAVES + RISE - 0.6), name="ridge")
scene.settle()
files = [
    pathlib.Path(sys.argv[0]).with_name("reference") / f"19760911_1635_GMN_{c}.acc"
    for c in ("NS", "WE", "UD")
]
scene.shake(files, 0.005, unit="m/s²")
scene.finish()
