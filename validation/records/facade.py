# SPDX-License-Identifier: GPL-2.0-or-later
"""A façade of two storeys on which two floors lie, shaken in three directions at once. The first
component acts along it.

``--floors loose``: the joists hold the façade by friction. ``--floors tied``: every joist has an
anchor. With ``--collapse follow`` a run goes on when blocks fall, and stones that have slid become
contacts. README.md says what is assumed.
"""

import pathlib
import sys

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument(
    "--floors",
    choices=["loose", "tied"],
    default="loose",
    help="what holds the façade (default: loose)",
)
options.add_argument(
    "--collapse",
    choices=["end", "follow"],
    default="end",
    help="what a run does when blocks fall (default: end)",
)
args = options.parse_args()

LENGTH, STOREY, THICK, COURSE = 4.8, 2.7, 0.4, 0.45  # [m]
JOISTS, LOAD, ANCHOR = (0.2, 1.8, 3.0, 4.6), 6e3, 20e3  # [m], [N], [N]
FRICTION = 0.4  # of timber on masonry

lintel = bricks.Lintel(0.4, COURSE)
openings = [
    bricks.Opening(x, z, 1.2, height, lintel)
    for x in (0.8, 2.8)
    for z, height in ((0.0, 1.8), (STOREY + 0.9, 0.9))
]
wall = bricks.Wall(LENGTH, 2 * STOREY, unit=(0.8, THICK, COURSE), openings=openings, halves=False)

stones = materials.dry(friction=0.6, density=2000, normalStiffness=1e9 / COURSE)
title, strength = (
    f"Façade, floors {args.floors}",
    {"loose": FRICTION * LOAD, "tied": ANCHOR}[args.floors],
)
scene = Scene(
    "facade", wall, stones, plane=False, title=title, collapse=args.collapse, arguments=args
)
scene.platen("bottom")
for z in (STOREY - COURSE / 2, 2 * STOREY - COURSE / 2):
    for x in JOISTS:
        joist = scene.handle((x, THICK / 2, z))
        scene.load(joist, (0, 0, -LOAD))
        scene.tie(
            joist, anchor=(x, THICK / 2 + 4, z), stiffness=10e6, strength=strength, compression=True
        )
        scene.tie(
            joist,
            anchor=(x + 4, THICK / 2, z),
            stiffness=10e6,
            strength=FRICTION * LOAD,
            compression=True,
        )
scene.watch((LENGTH / 2, THICK / 2, 2 * STOREY - 0.1), name="top")
scene.watch((LENGTH / 2, THICK / 2, STOREY - 0.1), name="floor")
scene.settle()
files = [
    pathlib.Path(sys.argv[0]).with_name("reference") / f"19760911_1635_GMN_{c}.acc"
    for c in ("NS", "WE", "UD")
]
scene.shake(files, 0.005, unit="m/s²")
scene.finish()
