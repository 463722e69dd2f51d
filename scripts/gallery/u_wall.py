# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall in U, of mortar that holds, on a dry foundation: an acceleration away from its flanges, in
which it tips about its face.

It falls between 0.513 and 0.516 g; the distance of its centre of mass from the face over its
height is 0.5194. ``--tee``: a wall in T, between 0.385 and 0.388 g, 0.3936. It takes about 7 s.
"""

from masonry import AT_REST, Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument("--tee", action="store_true", help="a T in place of a U")
args = options.parse_args()

unit, height = (0.44, 0.22, 0.4), 2.4
wall = bricks.Room(2.2, 1.76, height, unit, back=None, halves=False)
if args.tee:
    wall = bricks.Tee(2.2, 1.76, 1.1, height, unit, halves=False)
stones = materials.dry(friction=0.8, normalStiffness=5e10)
stones.joints["bed"].elastic = True

title = f"Wall in {'T' if args.tee else 'U'}"
scene = Scene("u_wall", wall, stones, title=title, plane=False, arguments=args)
scene.platen("bottom")
scene.watch((1.1, 0.1, height), name="top")
scene.settle()
low, high = scene.bracket(lambda g: scene.lean(g, (0, -1, 0)) == AT_REST, 0.36, 0.56)
print(f"stands at {low:.4f} g, falls at {high:.4f} g")
scene.lean(1.02 * high, (0, -1, 0))  # to see how
scene.finish()
