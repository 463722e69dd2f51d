# SPDX-License-Identifier: GPL-2.0-or-later
"""A gable wall of dry stones that turns over out of its plane, with a ring beam at the eaves or
with stones there.

``--eaves beam``: a ring beam of concrete, which the cross walls hold at its ends, so that only the
triangle above it turns over, about its lower edge, at 3 t / (2 h). ``--eaves stones``: the whole
wall turns over about its foot, at t / (2 z). In both the thickness is t, h is the height of the
triangle and z that of the centroid of rectangle and triangle together.

With the beam the gable falls between 0.187 and 0.188 g, with stones between 0.0693 and 0.0697 g;
limit analysis and closed forms have 0.1875 and 0.0746 g, and theory of second order, in which beds
of 2e11 Pa/m give way at their edges, 0.0708 g for the latter. It takes about half a minute, and
more than a minute with stones.
"""

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

options = parser(__doc__, until=None)
options.add_argument(
    "--eaves",
    choices=["beam", "stones"],
    default="beam",
    help="what stands at the eaves (default: beam)",
)
args = options.parse_args()

LENGTH, EAVES, RISE, THICK, COURSE = 4.8, 2.7, 2.4, 0.3, 0.3  # [m]
UNIT = 0.6, THICK, COURSE  # [m] squared stones
beamed = args.eaves == "beam"

below = EAVES - COURSE if beamed else EAVES
gable = bricks.Wall(LENGTH, RISE, unit=UNIT, halves=False)
for side in (-1, 1):  # both verges
    gable = gable.cut((LENGTH / 2, 0, RISE), (side * RISE, 0, LENGTH / 2), own=True)
inside = lambda b: abs(b.middle[0] - LENGTH / 2) < (RISE - b.middle[2]) * LENGTH / 2 / RISE
wall = bricks.Wall(LENGTH, below, unit=UNIT, halves=False)
wall += gable.where(inside).moved(0, 0, EAVES)
stones = materials.dry(friction=0.6, density=2200, normalStiffness=2e11)
if beamed:
    beam = bricks.Beam((0, 0, below), LENGTH, THICK, COURSE, pieces=16, name="ring beam")
    stones.withBeam(beam, young=30e9, density=2400)
    wall += beam

title = f"Gable with {'a ring beam' if beamed else 'stones'} at its eaves"
scene = Scene(
    "gable_ring_beam", wall.named("gable"), stones, plane=False, title=title, arguments=args
)
scene.platen("bottom")
if beamed:
    for x in (0.01, LENGTH - 0.01):  # stiffness of a cross wall
        scene.spring((x, THICK / 2, EAVES - COURSE / 2), stiffness=(0, 20e6, 0))
scene.watch((LENGTH / 2, THICK / 2, EAVES + RISE - 0.1), name="ridge")
scene.watch((LENGTH / 2, THICK / 2, EAVES - 0.1), name="eaves")
scene.settle()
scene.accelerate(0.4 if beamed else 0.2, towards=(0, 1, 0), rate=0.4)
areas, heights = (LENGTH * EAVES, LENGTH * RISE / 2), (EAVES / 2, EAVES + RISE / 3)
z = RISE / 3 if beamed else sum(a * h for a, h in zip(areas, heights)) / sum(areas)
print(f"holds {scene.factor:.4f} g; by hand {THICK / (2 * z):.4f} g")
scene.finish()
