# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry arch of 21 voussoirs whose supports spread until it falls, followed to the ground.

Its thickness is 0.12 of its middle radius. It falls with hinges, and its stones lie on the ground.
``--spread`` is how far the right support moves at most. It takes about 5 s.
"""

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None, rate=20)
options.add_argument(
    "--spread", metavar="MM", type=float, default=80, help="by how much at most [mm] (default: 80)"
)
args = options.parse_args()

MIDDLE = 1.0  # [m] radius of the middle line
THICK = 0.12 * MIDDLE
arch = bricks.Arch(THICK, depth=0.3, stones=21, radius=MIDDLE - THICK / 2, skewback=THICK)
stones = materials.dry(friction=0.6, density=2200, normalStiffness=2e10)

scene = Scene(
    "spreading_arch",
    arch,
    stones,
    title="Arch on supports that spread",
    collapse="follow",
    arguments=args,
)
scene.hold(21, name="still")
moved = scene.hold(22, name="moved")
scene.watch(10, name="keystone")
scene.settle()
scene.move(moved, x=args.spread)
scene.finish()
