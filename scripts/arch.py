# SPDX-License-Identifier: GPL-2.0-or-later
"""A voussoir arch, 7 flat stones, springing angle 157.5°: pushed sideways by a growing
acceleration, until it falls.

It falls with four hinges, between 0.371 and 0.373 g; limit analysis of rigid blocks has 0.3736 g.
``--spread`` moves its supports apart instead. It takes about 1 s.
"""


from masonry import AT_REST, Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument("--spread", metavar="MM", type=float, help="by how much [mm]")
args = options.parse_args()

arch = bricks.Arch(thickness=0.15, depth=0.3, stones=7, radius=0.925, angle=157.5, skewback=0.2)
stones = materials.dry(friction=0.7, normalStiffness=1e11)
scene = Scene("arch", arch, stones, title="Arch of 7 voussoirs", arguments=args)
left, right = scene.hold(7, name="left"), scene.hold(8, name="right")
scene.watch(3, name="keystone")
scene.settle()
if args.spread:
    scene.move(right, x=args.spread)
else:
    low, high = scene.bracket(lambda g: scene.lean(g) == AT_REST, 0.2, 0.5)
    print(f"stands at {low:.4f} g, falls at {high:.4f} g")
    scene.lean(1.02 * high)  # to see how
scene.finish()
