# SPDX-License-Identifier: GPL-2.0-or-later
"""The same panel described in other words: in millimetres and tonnes, mirrored, turned in space,
numbered in another order.

yade -n -x validation/stability/invariance.py

A panel of half bricks on a fixed plate is pressed and pushed by the plate above at once, in space,
so hard that its joints open, slip and crush. Without damping, which acts along the axes of space,
the force on the base must be the same in every telling, but for round-off that grows as in any
motion of many bodies.
"""

import os
import sys
import numpy as np
from masonry import (
    MasonryJoint,
    MasonryLoad,
    MasonryMat,
    MasonryZones,
    addBlock,
    connect,
    criticalTimeStep,
    engines,
)
from masonry import bricks
from masonry.bricks import boxCorners as corners
from yade import O, Quaternion, Vector3

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
from observed import BLOCKS, UNIT  # noqa: E402
from studies import head, line  # noqa: E402

COURSES, COLUMNS = 4, 4
ROWS, EVERY = 60, 10  # rows of the curve, steps between them
JOINT = dict(
    normalStiffness=3.352e11,
    shearStiffness=1.445e11,
    tensileStrength=0.1e6,
    modeIFractureEnergy=16,
    cohesion=0.11e6,
    modeIIFractureEnergy=160,
    compressiveStrength=1e6,
    compressiveFractureEnergy=3000,
)
DIMENSIONS = dict(  # powers of stress and length in the joint's properties
    normalStiffness=(1, -1),
    shearStiffness=(1, -1),
    tensileStrength=(1, 0),
    modeIFractureEnergy=(1, 1),
    cohesion=(1, 0),
    modeIIFractureEnergy=(1, 1),
    compressiveStrength=(1, 0),
    compressiveFractureEnergy=(1, 1),
)
TURN = Quaternion(Vector3(1, 2, 0.5).normalized(), np.pi / 6)


def curve(
    blocks,
    length=1.0,
    stress=1.0,
    mirror=False,
    turn=Quaternion.Identity,
    shuffle=False,
    damping=0.0,
):
    """Force of the base on the panel along the push, up and across it, at every row [N], array
    (ROWS, 3).

    :param length: metres of a unit of length, over one, and ``stress`` Pascals of a unit of stress
    """
    O.reset()
    size, force = 1 / length, 1 / (stress * length**2)
    place = lambda p: turn * (size * Vector3(-p[0] if mirror else p[0], p[1], p[2]))
    sign = lambda x, y, z: turn * Vector3(-x if mirror else x, y, z)
    density = length**2 / stress  # of mass over volume, with seconds
    mats = [
        MasonryMat(density=1800 * density, young=young / stress, jointSet=name)
        for young, name in ((4.8e9, "brick"), (1e16, "plate"))
    ]
    long, high = COLUMNS * UNIT[0] / 2, COURSES * UNIT[2]
    boxes = [(b.low, b.high, mats[0]) for b in bricks.Wall(long, high, UNIT)]
    boxes.append(((0, 0, -0.1), (long, UNIT[1], 0), mats[1]))
    boxes.append(((0, 0, high), (long, UNIT[1], high + 0.1), mats[1]))
    order = np.random.default_rng(3).permutation(len(boxes)) if shuffle else range(len(boxes))
    ids = {}
    for n in order:
        low, top, mat = boxes[n]
        ids[n] = addBlock([place(p) for p in corners(low, top)], mat)
    base, plate = ids[len(boxes) - 2], ids[len(boxes) - 1]
    O.bodies[base].state.blockedDOFs = "xyzXYZ"
    scaled = {
        name: value / stress ** DIMENSIONS[name][0] / length ** DIMENSIONS[name][1]
        for name, value in JOINT.items()
    }
    zones = None
    if blocks == "deformable":
        laid = [ids[n] for n in sorted(ids) if n < len(boxes) - 2]
        zones = MasonryZones(bodies=laid, damping=damping)
    load = MasonryLoad(
        body=plate,
        point=place((0.3 * long, UNIT[1] / 3, high)),
        force=force * sign(0, 0, -0.6e6 * long * UNIT[1]),
        direction=sign(1, 0.1, 0),
        driven=True,
        velocity=0.5 * size,
    )
    stiff = MasonryJoint(name="plate", jointSet="plate", elastic=True)
    stiff.updateAttrs(
        {k: v for k, v in scaled.items() if k in ("normalStiffness", "shearStiffness")}
    )
    joint = MasonryJoint(name="joint", peakRatio=20, residualFriction=0.3, dilatancy=0.1)
    joint.updateAttrs(scaled)
    down = size * sign(0, 0, -9.81)
    engines([stiff, joint], damping, down, loads=[load], zones=zones, rows=2)
    connect()
    O.dt = 0.5 * criticalTimeStep()[0]
    rows = []
    for _ in range(ROWS):
        O.run(EVERY, True)
        f = O.forces.f(base, True)
        rows.append([f.dot(sign(*axis)) / force for axis in np.eye(3)])
    return np.array(rows)


TELLINGS = {
    "millimetres, newtons, tonnes": dict(length=1e-3, stress=1e6),
    "mirrored": dict(mirror=True),
    "turned by 30° in space": dict(turn=TURN),
    "numbered in another order": dict(shuffle=True),
    "all at once": dict(length=1e-3, stress=1e6, mirror=True, turn=TURN, shuffle=True),
}


def difference(blocks, telling, damping=0.0):
    """Largest difference of the forces over the largest force, over the first tenth of the curve
    and over all of it."""
    reference = curve(blocks, damping=damping)
    apart = np.abs(curve(blocks, damping=damping, **telling) - reference)
    return [apart[:n].max() / np.abs(reference).max() for n in (ROWS // 10, ROWS)]


def main():
    after = [f"after {n} steps" for n in (ROWS * EVERY // 10, ROWS * EVERY)]
    print(head(["telling", "units", "damping", *after]))
    fine = True
    for name, telling in TELLINGS.items():
        for blocks in BLOCKS:
            for damping in (0.0, 0.8):
                if damping and "turn" in telling:
                    continue
                early, late = difference(blocks, telling, damping)
                fine = fine and late < 1e-6
                numbers = f"{damping:g}", f"{early:.0e}", f"{late:.0e}"
                print(line([name, blocks, *numbers]), flush=True)
    return fine


if __name__ == "__main__":
    raise SystemExit(not main())
