# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry-stone wall of 2.5 m holds soil in an earthquake: the pressure of a horizontal acceleration
by Mononobe and Okabe is there, and the inertia of the stones grows.

At 0.135 g a wedge in steps tips, at ``--kh 0.125`` the wall stands; limit analysis without
dilatancy has 0.1305. By hand it slides at 0.145, and one block of its shape tips at 0.176. It takes
about 3 s.
"""

from masonry import Scene, bricks, earth, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument("--kh", type=float, default=0.135, help="horizontal acceleration [g]")
args = options.parse_args()

HIGH, BASE, CREST = 2.5, 1.2, 0.6  # [m]
wall = bricks.Wall(BASE, HIGH, (0.4, 1.0, 0.25), halves=False)
wall = wall.cut((BASE, 0, 0), (HIGH, 0, BASE - CREST))  # the front, which leans
wall = wall.where(lambda b: (b.middle[0] - BASE) * HIGH < -b.middle[2] * (BASE - CREST))
stones = materials.dry(friction=0.65, normalStiffness=1e11, density=2200)
soil = earth.pressure([earth.Soil(18e3, 35)], HIGH, surcharge=5e3, foot=0, kh=args.kh)

scene = Scene("retaining_wall", wall, stones, title="Retaining wall", arguments=args)
scene.platen("bottom")
scene.watch((0.2, 0.5, HIGH), name="crest")
scene.pressure(soil, towards=(1, 0, 0))
scene.settle()
print(f"kh {args.kh:g}: {scene.lean(args.kh, (1, 0, 0))}")
scene.finish()
