# SPDX-License-Identifier: GPL-2.0-or-later
"""A panel under a load as large as its weight, held at foot and top: how much acceleration out of
its plane it stands.

A strip of thickness t and height h under a load O in the middle of its top, which weighs W and
cracks at the share ξ of its height, falls at (t/h)/ξ·(2 + (O/W)(1 + 1/(1 - ξ))). With O = W the
least is 9 t/h, at ξ = 2/3: 0.343 g. The run cracks there and falls between 0.338 and 0.344 g. It
takes about 10 s.
"""

from masonry import AT_REST, Scene, bricks, materials

wall = bricks.Wall(0.44, 2.673, halves=False)
weight = 2600 * 9.81 * 2.673  # [Pa] at the foot

scene = Scene("panel", wall, materials.dry(normalStiffness=2e11), plane=False)
base = scene.platen("bottom")
top = scene.platen("top", rotation="free", guided="xy", height=0.02)
scene.press(top, weight)
scene.watch((0.22, 0, 1.35), name="middle")
scene.view((1, 0, 0))
scene.settle()
low, high = scene.bracket(
    lambda g: scene.lean(g, towards=(0, 1, 0)) == AT_REST, 0.2, 0.6, within=0.02
)
print(f"stands at {low:.4f} g, falls at {high:.4f} g; 9 t/h is {9 * 0.102 / 2.673:.4f}")
scene.lean(1.02 * high, towards=(0, 1, 0))  # to see how
scene.finish()
