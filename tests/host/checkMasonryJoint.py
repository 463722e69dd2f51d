# SPDX-License-Identifier: GPL-2.0-or-later
"""A check in YADE's form: a brick is lifted off another one, and their joint cracks.

    yade -n -x tests/host/checkMasonryJoint.py

The largest force is tensile strength times area, and the energy that the joint takes is fracture
energy times area.
"""

import masonry
from masonry import MasonryEnergy, MasonryJoint, MasonryLoad, MasonryMat, addBlock

if "YadeCheckError" not in globals():  # `yade --check` brings it

    class YadeCheckError(Exception):
        pass


STRENGTH, ENERGY = 0.2e6, 30.0  # [Pa], [J/m²]
LENGTH, WIDTH, HEIGHT = 0.22, 0.10, 0.08  # of a brick [m]
AREA = LENGTH * WIDTH

for low in (0, HEIGHT):
    corners = [(x, y, z) for x in (0, LENGTH) for y in (0, WIDTH) for z in (low, low + HEIGHT)]
    addBlock(corners, MasonryMat(density=1800))
O.bodies[0].state.blockedDOFs, O.bodies[1].state.blockedDOFs = "xyzXYZ", "xyXYZ"
masonry.engines(
    [MasonryJoint(tensileStrength=STRENGTH, modeIFractureEnergy=ENERGY)],
    gravity=(0, 0, 0),
)
masonry.connect()
lift = MasonryLoad(
    body=1,
    point=(LENGTH / 2, WIDTH / 2, 2 * HEIGHT),
    direction=(0, 0, 1),
    driven=True,
    velocity=0.02,
)
O.engines = O.engines[:2] + [lift] + O.engines[2:]

largest = 0.0
while O.bodies[1].state.displ()[2] < 1e-3:
    O.step()
    largest = max(largest, abs(lift.reaction))
energy = next(e for e in O.engines if isinstance(e, MasonryEnergy)).balance()

for what, found, expected, tolerance in (
    ("largest force [N]", largest, 4400.0, 0.01),
    ("energy taken by the joint [J]", energy["dissipated_tension"], 0.66, 0.02),
):
    print(f"{what}: {found:.6g}, expected {expected:g}")
    if abs(found - expected) > tolerance * expected:
        raise YadeCheckError(f"{what}: {found:.6g} instead of {expected:g}")
