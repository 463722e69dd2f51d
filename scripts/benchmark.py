"""Cost of a step on the wall TUD-COMP-4, side by side in one run: this plugin, and YADE's volumetric polyhedra law.

yade -n -x [-j THREADS] scripts/benchmark.py [STEPS]
"""

import sys
import tempfile
import time

from masonry import brickwork, materials, options, walls
from yade import O, Vector3, polyhedra_utils, timing
from yade.wrapper import *


def cost(steps):
    """Seconds a step, the best of three goes."""
    best = float("inf")
    for _ in range(3):
        began = time.perf_counter()
        for _ in range(steps):
            O.step()
        best = min(best, (time.perf_counter() - began) / steps)
    return best


def plugin(steps):
    wall = walls.Wall(
        name="benchmark", title="TUD-COMP-4", halfUnits=36, precompression=0.5e6
    )
    model = walls.WallModel(
        wall,
        options.parser("", until=12).parse_args(
            ["--no-vtk", "--out", tempfile.mkdtemp()]
        ),
    )
    model.load.velocity = 0.02
    O.timingEnabled = True
    seconds = cost(steps)
    print(
        f"this plugin: {len(model.interactions)} joints, {model.subcontacts} subcontacts"
    )
    timing.stats()
    O.timingEnabled = False
    return seconds, model.subcontacts


def stock(steps):
    """The same half bricks, laid 0.1 mm into each other so that every bed joint is a contact."""
    O.reset()
    mat = PolyhedraMat(density=1800, young=1e12, poisson=0.2, frictionAngle=0.4)
    O.materials.append(mat)
    for block in brickwork.runningBond(34, 36):
        low, high = (
            [v * (0.999 if axis == 2 else 1.001) for axis, v in enumerate(p)]
            for p in (block.low, block.high)
        )
        high[2] = low[2] + 0.081
        O.bodies.append(
            polyhedra_utils.polyhedra(
                mat, v=[Vector3(*p) for p in brickwork.corners(low, high)]
            )
        )
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Polyhedra_Aabb()]),
        InteractionLoop(
            [Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
            [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
            [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
        ),
        NewtonIntegrator(damping=0.8),
    ]
    O.dt = 1e-7
    O.step()
    seconds = cost(steps)
    print(
        f"YADE's volumetric law: {sum(1 for i in O.interactions if i.isReal)} contacts"
    )
    return seconds


steps = int(sys.argv[1]) if len(sys.argv) > 1 else 500
mine, subcontacts = plugin(steps)
theirs = stock(3)
print(f"threads                              {O.numThreads}")
print(f"this plugin, a step                  {1e6 * mine:12.0f} µs")
print(f"this plugin, a subcontact and step   {1e9 * mine / subcontacts:12.1f} ns")
print(f"YADE's volumetric law, a step        {1e6 * theirs:12.0f} µs")
print(f"ratio                                {theirs / mine:12.0f}")
