# SPDX-License-Identifier: GPL-2.0-or-later
"""Two axles of 50 kN, 1.5 m apart, go over a dry arch bridge of 8 m under its fill; then they grow
where it carries least, until it falls.

With the first axle at 0.65 m it falls between 200 and 201 kN each; the line of influence in
``travel.csv`` has 205.4, and a linear programme of rigid blocks 205.9. It takes about 5 s.
"""

from masonry import Scene, bricks, materials

arch = bricks.Arch(0.6, 1.0, 25, span=8.0, angle=105, skewback=0.5)
stones = materials.dry(friction=0.6, normalStiffness=1e11, density=2200)
road = arch.high[2] + 0.4  # [m]

scene = Scene("bridge", arch, stones, title="Arch bridge under axles")
scene.hold(25, name="left")
scene.hold(26, name="right")
first = scene.handle((0.65, 0.5, 1.45), name="first")
second = scene.handle((2.15, 0.5, 2.24), name="second")
scene.pressure(lambda x, y, z: 18e3 * (road - z), (0, 0, -1), "arch", normal=False)
scene.settle()
places = [0.65, 0.8, 1.2, 1.4, 1.6, 2.0, 2.4, 2.8]  # of the first axle [m]
scene.travel(50e3, [(x, 0.5, road) for x in places], axles=[(0, 1), (1.5, 1)])
scene.grow({first: (0, 0, -50e3), second: (0, 0, -50e3)}, most=6)
scene.finish()
