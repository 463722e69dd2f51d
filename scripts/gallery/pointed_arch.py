# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry pointed arch of 16 voussoirs, pushed sideways by a growing acceleration until it falls.

It falls with four hinges, between 0.164 and 0.166 g; limit analysis of rigid blocks has 0.1662 g,
and a least thickness of 0.130 m. It takes about 2 s.
"""

from masonry import AT_REST, Scene, bricks, materials

arch = bricks.Arch(thickness=0.25, depth=0.5, stones=16, span=3.0, rise=2.0, skewback=0.2)
stones = materials.dry(friction=0.7, normalStiffness=1e11)

scene = Scene("pointed_arch", arch, stones, title="Pointed arch of 16 voussoirs")
scene.hold(16, name="left")
scene.hold(17, name="right")
scene.watch(7, name="crown")
scene.settle()
low, high = scene.bracket(lambda g: scene.lean(g) == AT_REST, 0.1, 0.2)
print(f"stands at {low:.4f} g, falls at {high:.4f} g")
scene.lean(1.02 * high)  # to see how
scene.finish()
