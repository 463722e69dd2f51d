# SPDX-License-Identifier: GPL-2.0-or-later
"""Where runs become unstable, over the limit of the time step that criticalTimeStep() gives.

yade -n -x validation/stability/onset.py

Elastic columns of two and four bricks and COMP-4 are thrown at random and run for some thousand
steps, with time steps above the limit. Without damping the onset is where motion grows a
hundredfold, with damping where it does not fall to a thousandth. Every onset must lie within 1.0
and 1.6 times the limit.
"""

import os
import sys
import tempfile

import numpy as np
from masonry import (
    MasonryJoint,
    MasonryMat,
    MasonryZones,
    addBlock,
    connect,
    criticalTimeStep,
    engines,
)
from masonry.bricks import boxCorners as corners
from yade import O, Vector3
from yade.wrapper import MasonryEnergy

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
from observed import BLOCKS, UNIT, Observed, Point  # noqa: E402
from studies import head, line  # noqa: E402

STEPS = 3000
RESOLUTION = 0.002
DAMPINGS = {"none": 0, "local 0.8": 0.8, "combined 0.8": 0.8}


def column(bricks, blocks, functors=False):
    """Bricks on each other, the lowest one fixed, joined elastically; the ids of the others."""
    O.reset()
    mat = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    box = lambda k: corners((0, 0, k * UNIT[2]), (*UNIT[:2], (k + 1) * UNIT[2]))
    ids = [addBlock(box(k), mat, inPlane=True) for k in range(bricks)]
    O.bodies[ids[0]].state.blockedDOFs = "xyzXYZ"
    zones = None
    if blocks == "deformable":
        zones = MasonryZones(bodies=ids[1:], blocked="y")
    around = dict(gravity=(0, 0, 0), inPlane=True, zones=zones, functors=functors)
    engines([MasonryJoint(elastic=True)], **around)
    connect()
    return ids[1:]


def comp4(blocks):
    joints = {"all": dict(elastic=True)}
    with tempfile.TemporaryDirectory() as folder:
        point = Point(0, whole=True, gravity=False, joints=joints)
        return list(Observed(point, blocks, folder).model.bricks)


def isCalm(make, damping, share):
    """Whether motion stays within bounds, with damping whether it calms down, at a share of the
    limit."""
    bodies = make()
    for engine in O.engines:
        if hasattr(engine, "damping"):
            engine.damping = DAMPINGS[damping]
        if hasattr(engine, "dampingKind"):
            engine.dampingKind = "local" if "local" in damping else "combined"
    energy = next(e for e in O.engines if isinstance(e, MasonryEnergy))
    energy.watch = False
    O.dt = share * criticalTimeStep()[0]
    dice = np.random.default_rng(1)
    throw = lambda: 1e-3 * Vector3(dice.normal(), 0, dice.normal())
    zones = next((e for e in O.engines if hasattr(e, "setVelocity")), None)
    if zones:
        for node in range(len(zones.masses)):
            zones.setVelocity(node, throw())
    else:
        for body in bodies:
            O.bodies[body].state.vel = throw()
    O.run(STEPS, True)
    b = energy.balance()
    return abs(b["kinetic"]) < (1e-3 if DAMPINGS[damping] else 1e2) * b["external"]


def onset(make, damping):
    """The onset over the limit, to RESOLUTION, from below; 0.99 if there the run is not calm."""
    low, high = 0.99, 3.0
    if not isCalm(make, damping, low):
        return low
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        if isCalm(make, damping, middle):
            low = middle
        else:
            high = middle
    return low


SCENES = {
    "single joint": lambda blocks: lambda: column(2, blocks),
    "four bricks": lambda blocks: lambda: column(4, blocks),
    "four bricks, YADE's loop": lambda blocks: lambda: column(4, blocks, True),
    "COMP-4": lambda blocks: lambda: comp4(blocks),
}


def main(scenes=SCENES):
    print(head(["scene", "units", "damping", "onset / limit"]))
    fine = True
    for scene, of in scenes.items():
        for blocks in BLOCKS:
            for damping in DAMPINGS:
                found = onset(of(blocks), damping)
                fine = fine and 1.0 <= found + RESOLUTION and found <= 1.6
                print(line([scene, blocks, damping, f"{found:.3f}"]), flush=True)
    return fine


if __name__ == "__main__":
    raise SystemExit(not main())
