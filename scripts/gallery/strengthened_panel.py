# SPDX-License-Identifier: GPL-2.0-or-later
"""A panel held at foot and top, under an acceleration out of its plane, as it is and with a textile
in mortar on the face that opens.

``--layer`` puts the textile on. The panel stands 0.159 g without it, and 0.430 g with it, when it
slides off its top; limit analysis, whose blocks turn about their edges and not about a place
inside, has 0.1745 and 0.462 g at most. It takes about a minute.
"""

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument("--layer", action="store_true", help="with the textile")
args = options.parse_args()

wall = bricks.Wall(0.44, 2.673, halves=False)
title = "Panel with a textile" if args.layer else "Panel"
scene = Scene(
    "strengthened_panel",
    wall,
    materials.dry(normalStiffness=2e11),
    plane=False,
    title=title,
    arguments=args,
)
scene.platen("bottom")
top = scene.platen("top", rotation="free", guided="xy", height=0.02)
scene.press(top, 20e3)  # [Pa] a light roof
if (
    args.layer
    # glass: E t of the fibres, their strength, their strain when they break; free over 0.1 m at a
    # crack
):
    scene.overlay(
        (0, 1, 0),
        stiffness=3e6,
        strength=45e3,
        strain=0.02,
        gauge=0.1,
        fibres="vertical",
        name="textile",
    )
scene.watch((0.22, 0, 1.35), name="middle")
scene.view((1, 0, 0))
scene.settle()
scene.accelerate(10.0 if args.layer else 1.0, towards=(0, 1, 0))
scene.finish()
