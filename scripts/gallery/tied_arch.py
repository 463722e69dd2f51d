# SPDX-License-Identifier: GPL-2.0-or-later
"""A voussoir arch on a support that can slide, held by an iron tie: a load on its keystone grows
until the tie yields and the arch falls.

The tie yields and the arch falls between 2.700 and 2.713 kN; limit analysis, which knows the tie,
has 2.713 kN. It takes about 2 s.
"""

from masonry import Scene, bricks, materials

arch = bricks.Arch(thickness=0.15, depth=0.3, stones=11, radius=0.925, angle=157.5, skewback=0.2)
stones = materials.dry(friction=0.7, normalStiffness=1e11)
scene = Scene("tied_arch", arch, stones, title="Arch of 11 voussoirs with a tie")
left, right = scene.hold(11, name="left"), scene.hold(12, name="right", axes="zY")
keystone = scene.handle(5, name="keystone")
# a bar of 12 mm of wrought iron: E A / L with E = 200 GPa, and a yield stress of 20 MPa, as of a
# hook that bends
area, length = 113e-6, 1.75  # [m²], [m]
tie = scene.tie(0, 10, stiffness=200e9 * area / length, strength=20e6 * area, name="tie")
scene.settle()
print(f"tie under the weight alone: {tie.force:.0f} N")
scene.grow({keystone: (0, 0, -10e3)})
scene.finish()
