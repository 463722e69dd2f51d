# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step costs.

yade -n -x [-j THREADS] validation/benchmark/benchmark.py [STEPS]

compares, on the wall TUD-COMP-4 and side by side in one run: the plugin with rigid and deformable
units from the first push to the end of the test, with features on and off, and through YADE's own
interaction loop and integrator; walls of 1,000 to 100,000 half bricks and their memory; YADE's
volumetric law on the half bricks of COMP-4; YADE's one-point mortar law on spheres in their places.
It prints one table, and writes results/benchmark/benchmark.json.

yade -n -x [-j THREADS] validation/benchmark/benchmark.py --push wall_comp4 --until 3 --rate 20

runs a scene with its options, in a process of its own, and prints the mean cost of a step over its
whole push, and of a row of curve.csv. Two builds of the plugin are compared by PYTHONPATH.

yade -n -x validation/benchmark/benchmark.py --wide 224 224

builds one wall of so many courses and half units, and prints what its set-up and a step take and
its memory.
"""

import json
import os
import resource
import sys
import time

from masonry import Scene, addBlock, bricks, connect, engines, materials
from masonry.numbers import columns
from masonry.model import threads
from masonry.numbers.files import readCurve, readRun
from yade import O, Vector3, timing, utils
from yade.wrapper import *

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path.insert(0, os.path.dirname(HERE))  # yade leaves it out
import studies  # noqa: E402

OUT = os.path.join("results", "benchmark")
BLOCKS = bricks.Wall(3.96, 2.754)
PUSH = sys.argv[1:2] == ["--push"]
WIDE = sys.argv[1:2] == ["--wide"]
STEPS = int(sys.argv[1]) if len(sys.argv) > 1 and not (PUSH or WIDE) else 500


def cost(steps):
    """Seconds a step, the best of three goes."""
    best = float("inf")
    for _ in range(3):
        began = time.perf_counter()
        for _ in range(steps):
            O.step()
        best = min(best, (time.perf_counter() - began) / steps)
    return best


def plugin(words="", until=0.2, functors=False):
    """Cost of a step of COMP-4, when it is pushed to ``until`` [mm] with these options.

    :returns: seconds a step, subcontacts, and microseconds of each engine
    """
    words = f"--no-vtk --checkpoint-every 0 --rate 50 --until {until} --out {OUT} {words}".split()
    run = Scene(
        "benchmark",
        BLOCKS,
        materials.calciumSilicate(),
        columns=columns.heads(columns.PUSH),
        functors=functors,
        arguments=words,
    )
    run.platen("bottom")
    top = run.platen("top", recorded=2.754, drive="x")
    run.press(top, 0.5e6)
    run.settle(damping="local", record=False)
    run.push(top)
    model = run.model
    seconds = cost(STEPS)
    O.timingEnabled = True
    timing.reset()
    cost(STEPS)
    O.timingEnabled = False
    engines = {
        e.label or type(e).__name__: e.execTime / e.execCount / 1e3
        for e in O.engines
        if e.execCount
    }
    rows = len(run.results.rows)
    engines["a row of curve.csv"] = 1e6 * run.running.state.seconds["rows"] / rows
    return seconds, model.subcontacts, engines


def resident():
    """Memory of this process [B]."""
    with open("/proc/self/statm") as f:
        return int(f.read().split()[1]) * resource.getpagesize()


def wide(courses, halfUnits):
    """Cost of a step of a wall as laid, and of its set-up.

    :returns: seconds a step, subcontacts, and a dict: bytes a half brick of YADE's bodies and of
        our joints, and seconds of set-up with the first step
    """
    O.reset()
    began = time.perf_counter()
    unit, joints = materials.calciumSilicateUnit(), materials.calciumSilicateJoints()
    before = resident()
    for b in bricks.Wall(0.11 * halfUnits, 0.081 * courses):
        addBlock(b.corners, unit, inPlane=True)
    bodies = resident()
    O.bodies[0].state.blockedDOFs = "xyzXYZ"
    engines(list(joints.values()), inPlane=True)
    contacts = 4 * len(connect())
    O.dt = 1e-8
    O.step()
    count = len(O.bodies)
    memory = {
        "body, B": (bodies - before) / count,
        "joints, B": (resident() - bodies) / count,
        "set-up, s": time.perf_counter() - began,
    }
    return cost(max(1, STEPS * 1000 // count)), contacts, memory


def volumetric():
    """The same half bricks, laid 0.1 mm into each other so that every bed joint is a contact."""
    from yade import polyhedra_utils  # not in the YADE of Debian 13

    O.reset()
    mat = PolyhedraMat(density=1800, young=1e12, poisson=0.2, frictionAngle=0.4)
    O.materials.append(mat)
    for block in BLOCKS:
        low, high = (
            [v * (0.999 if axis == 2 else 1.001) for axis, v in enumerate(p)]
            for p in (block.low, block.high)
        )
        high[2] = low[2] + 0.081
        O.bodies.append(
            polyhedra_utils.polyhedra(mat, v=[Vector3(*p) for p in bricks.boxCorners(low, high)])
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
    return cost(3), sum(1 for i in O.interactions if i.isReal), {}


def mortar():
    """A sphere in the place of every half brick, one contact a joint, without a collider as our
    walls."""
    O.reset()
    O.materials.append(MortarMat(density=1800, young=4.8e9, poisson=0.2, neverDamage=True))
    length, height = 0.11, 0.081
    for block in BLOCKS:
        centre = [(a + b) / 2 for a, b in zip(block.low, block.high)]
        O.bodies.append(utils.sphere(Vector3(*centre), 0.055))
    O.engines = [
        ForceResetter(),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=2)],
            [Ip2_MortarMat_MortarMat_MortarPhys(cohesiveThresholdIter=10**6)],
            [Law2_ScGeom_MortarPhys_Lourenco()],
        ),
        NewtonIntegrator(damping=0.8),
    ]
    rows = {}
    for body in O.bodies:
        rows.setdefault(int(body.state.pos[2] / height), []).append(body)
    for row, bodies in rows.items():
        for body in bodies:
            for other in bodies + rows.get(row + 1, []):
                along = abs(other.state.pos[0] - body.state.pos[0])
                beside = other.id > body.id and along < 1.1 * length
                over = other not in bodies and along < 0.9 * length
                if (other in bodies and beside) or over:
                    utils.createInteraction(body.id, other.id)
    O.dt = 1e-7
    O.step()
    return cost(100), sum(1 for i in O.interactions if i.isReal), {}


CASES = {
    "rigid units": lambda: plugin(),
    "rigid units, at the peak": lambda: plugin(until=2.5),
    "rigid units, at the end": lambda: plugin(until=12),
    "    cyclic law, at the peak": lambda: plugin("--joints cyclic", until=2.5),
    "    cyclic law, at the end": lambda: plugin("--joints cyclic", until=12),
    "    local damping": lambda: plugin("--damping-kind local"),
    "    no crack surfaces": lambda: plugin("--crack-surfaces off"),
    "    dilatancy": lambda: plugin("--set bed.dilatancy=0.1 --set bed.dilatancyDecay=100"),
    "    three points": lambda: plugin("--points 3"),
    "    twelve points": lambda: plugin("--points 12"),
    "    YADE's loop and integrator": lambda: plugin(functors=True),
    "deformable units": lambda: plugin("--blocks deformable"),
    "deformable units, at the peak": lambda: plugin("--blocks deformable", until=2.5),
    "    two by two cells": lambda: plugin("--blocks deformable --divisions 2"),
    "    three by three cells": lambda: plugin("--blocks deformable --divisions 3"),
    "1,020 half bricks, as laid": lambda: wide(34, 30),
    "10,272 half bricks": lambda: wide(107, 96),
    "100,480 half bricks": lambda: wide(320, 314),
    "YADE's volumetric law, half bricks": volumetric,
    "YADE's mortar law, spheres": mortar,
}


def compare():
    """Run all cases, and print and write their table."""
    results = {}
    for name, case in CASES.items():
        seconds, contacts, engines = case()
        results[name] = {
            "step_us": 1e6 * seconds,
            "contacts": contacts,
            "contact_ns": 1e9 * seconds / contacts,
            "engines_us": engines,
        }
    base = results["rigid units"]
    print(f"\n{threads.allowed()} threads; ratios to the first")
    print(f"{'':42}{'µs a step':>12}{'ratio':>8}{'contacts':>10}{'ns each':>10}{'ratio':>8}")
    for name, r in results.items():
        ratio, each = (r[k] / base[k] for k in ("step_us", "contact_ns"))
        print(
            f"{name:42}{r['step_us']:12.1f}{ratio:8.2f}{r['contacts']:10d}"
            f"{r['contact_ns']:10.1f}{each:8.2f}"
        )
        for engine, us in r["engines_us"].items():
            print(f"    {engine:38}{us:12.1f}")
    os.makedirs(OUT, exist_ok=True)
    with open(os.path.join(OUT, "benchmark.json"), "w") as f:
        json.dump({"threads": threads.allowed(), "cases": results}, f, indent=1)


def wholePush(name, *words):
    """Run a scene, and print the cost of a step of its push and of a row, from its own clocks."""
    out = os.path.join(OUT, name)
    quiet = ["--no-vtk", "--checkpoint-every", "0"]
    studies.run(name, [*quiet, *words], out, threads.allowed(), quiet=True)
    run, rows = readRun(out), len(readCurve(out)["time_s"])
    stages = [s for s in run["stages"] if s["stage"] != "settle"]
    steps = sum(stage["steps"] for stage in stages)
    step = 1e6 * sum(stage["seconds"] for stage in stages) / steps
    row = 1e6 * run["seconds"]["rows"] / rows
    print(
        f"{name}, plugin {run['commit']}, threads {run['threads']}: {step:.1f} µs a step of"
        f" {steps}, {row:.1f} µs a row of {rows}, which is {row / step:.2f} of a step"
    )


if PUSH:
    wholePush(*sys.argv[2:])
elif WIDE:
    seconds, contacts, more = wide(*map(int, sys.argv[2:4]))
    print(f"{1e6 * seconds:.0f} µs a step, {contacts} subcontacts")
    for name, value in more.items():
        print(f"{name:12} {value:.1f}")
else:
    compare()
