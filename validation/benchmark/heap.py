# SPDX-License-Identifier: GPL-2.0-or-later
"""A heap of boxes that fall on a slab: contacts of the plugin beside YADE's own polyhedra.

/usr/bin/python3 validation/benchmark/heap.py [--blocks 60] [--seconds 1.5] [--stiffness 1e8]
[--damping 0.2] [--friction 0.5]
    [--step 0.5] [--stock-step SECONDS] [--minutes 60] [--only engine|stock ...]

drops the same bricks, turned at random, in two processes that step in turns of a hundredth of a
second of the heap: with the engine MasonryContacts, and with YADE's polyhedra and their volumetric
law (where YADE has them). It prints one table. Times are those of the processor, on one thread.

The volumetric law presses with kn times the volume of the overlap. Two faces that overlap by a
depth d over an area A have the volume A d, so kn in N/m³ is the stiffness per area in Pa/m, and the
same number is taken for both: each block has twice of it as `young`. Its shear stiffness is one of
a contact, not of an area: that of the plugin on a whole bed face. It has no damping of its own, so
NewtonIntegrator damps its blocks by --damping, and the plugin's contacts have a restitution of 0.3
and no other damping. The time step is the share --step of the plugin's limit for the plugin, and
the same number of seconds for the volumetric law, which knows no limit for itself, unless
--stock-step gives another one in seconds.

After --minutes the table shows what has been reached until then.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import time

BRICK = (0.22, 0.102, 0.081)
KINDS = ("engine", "stock")
RATIO, DENSITY, G = 0.4, 1800, 9.81
WINDOW = 0.01  # of the time of the heap, between two rows [s]
RESTS = 1e-6  # kinetic energy of a heap at rest, over the potential energy that it has lost


def options():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--blocks", type=int, default=60)
    parser.add_argument("--seconds", type=float, default=1.5)
    parser.add_argument("--stiffness", type=float, default=1e8)
    parser.add_argument("--damping", type=float, default=0.2)
    parser.add_argument("--friction", type=float, default=0.5)
    parser.add_argument("--step", type=float, default=0.5)
    parser.add_argument("--stock-step", type=float, default=0)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--only", choices=KINDS, action="append")
    parser.add_argument("--child", choices=KINDS)
    return parser.parse_args()


# ---- in YADE
# --------------------------------------------------------------------------------------------------


def corners(middle, turn, size):
    from yade import Vector3

    units = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    return [middle + turn * Vector3(*(s * u for s, u in zip(size, unit))) for unit in units]


def places(count):
    """Middle and turn of every brick: nine a level, turned at random."""
    import random

    from yade import Quaternion, Vector3

    dice = random.Random(7)
    for n in range(count):
        level, column = divmod(n, 9)
        turn = Quaternion(*(dice.gauss(0, 1) for _ in range(4)))
        turn.normalize()
        shift = [0.02 * dice.uniform(-1, 1) for _ in range(2)]
        yield Vector3(
            0.27 * (column % 3) + shift[0], 0.27 * (column // 3) + shift[1], 0.14 + 0.27 * level
        ), turn


def build(given):
    """The bricks of a child, their slab and their engines. Returns the law functor or engine that
    knows energies."""
    from masonry import addBlock
    from yade import O, Quaternion, Vector3
    from yade.wrapper import (
        ForceResetter,
        InsertionSortCollider,
        InteractionLoop,
        MasonryContacts,
        MasonryMat,
        NewtonIntegrator,
    )

    kind = given.child
    if kind == "stock":
        from yade import polyhedra_utils
        from yade.wrapper import (
            Bo1_Polyhedra_Aabb,
            Ig2_Polyhedra_Polyhedra_PolyhedraGeom,
            Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys,
            Law2_PolyhedraGeom_PolyhedraPhys_Volumetric,
            PolyhedraMat,
        )

        # Two equal materials: kn is half of `young`, ks that times `poisson`.
        shear = RATIO * BRICK[0] * BRICK[1]
        mat = PolyhedraMat(
            density=DENSITY,
            young=2 * given.stiffness,
            poisson=shear,
            frictionAngle=math.atan(given.friction),
        )
        O.materials.append(mat)
    else:
        mat = MasonryMat(density=DENSITY, young=4.8e9, poisson=0.16)
    slab = Vector3(0.27, 0.27, -0.2), Quaternion.Identity, (6, 6, 0.4)
    for middle, turn, size in [slab, *((*place, BRICK) for place in places(given.blocks))]:
        points = corners(middle, turn, size)
        if kind == "stock":
            O.bodies.append(polyhedra_utils.polyhedra(mat, v=points))
        else:
            addBlock(points, mat)
    O.bodies[0].state.blockedDOFs = "xyzXYZ"
    if kind == "engine":
        energies = MasonryContacts(
            normalStiffness=given.stiffness,
            friction=given.friction,
            restitution=0.3,
            tangentialRatio=RATIO,
        )
        contacts = [energies]
    else:
        energies = Law2_PolyhedraGeom_PolyhedraPhys_Volumetric(traceEnergy=True)
        contacts = [
            InsertionSortCollider([Bo1_Polyhedra_Aabb()], verletDist=0),
            InteractionLoop(
                [Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
                [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
                [energies],
            ),
        ]
    damping = given.damping if kind == "stock" else 0
    newton = NewtonIntegrator(gravity=(0, 0, -G), damping=damping, exactAsphericalRot=True)
    O.engines = [ForceResetter(), *contacts, newton]
    O.trackEnergy = kind == "stock"
    return energies


class Heap:
    """A heap in a process of its own, and what is known of it."""

    def __init__(self, given):
        from yade import O

        self.given, self.clock, self.O = given, time.process_time, O
        self.energies = build(given)
        self.took = self.contacts = 0.0
        self.begin = self.height()

    def height(self):
        return sum(b.state.mass * G * b.state.pos[2] for b in self.O.bodies if b.id > 0)

    def kinetic(self):
        sum_ = 0.0
        for b in self.O.bodies:
            s = b.state
            spin = s.ori.conjugate() * s.angVel
            sum_ += 0.5 * s.mass * s.vel.squaredNorm() + 0.5 * sum(
                i * w * w for i, w in zip(s.inertia, spin)
            )
        return sum_

    def touching(self):
        return (
            self.energies.touching()
            if self.given.child == "engine"
            else sum(1 for _ in self.O.interactions)
        )

    def lost(self):
        """Energy that friction and damping took [J]."""
        law = self.energies
        if self.given.child == "engine":
            return law.lostInFriction + law.lostInDamping
        return dict(self.O.energy.items()).get("nonviscDamp", 0) + law.plasticDissipation()

    def sunk(self):
        """How far the lowest corner is below the slab's face, and the least distance of two middles
        [m]."""
        bodies = [b for b in self.O.bodies if b.id > 0]
        low = min((b.state.pos + b.state.ori * v)[2] for b in bodies for v in b.shape.v)
        near = min(
            (a.state.pos - b.state.pos).norm() for n, a in enumerate(bodies) for b in bodies[:n]
        )
        return max(0.0, -low), near

    def advance(self, until):
        """Steps up to a time. Returns a row of numbers."""
        O = self.O
        steps = max(1, round((until - O.time) / O.dt))
        before = self.touching()
        began = self.clock()
        O.run(steps, True)
        took = self.clock() - began
        self.took += took
        self.contacts += 0.5 * (before + self.touching()) * steps
        depth, near = self.sunk()
        return dict(
            time=O.time,
            steps=O.iter,
            took=self.took,
            contacts=self.contacts,
            touching=self.touching(),
            kinetic=self.kinetic(),
            fallen=self.begin - self.height(),
            lost=self.lost(),
            depth=depth,
            near=near,
            dt=O.dt,
        )


def child(given):
    """Answers every line of standard input: a number is a time to step to, ``dt NUMBER`` sets the
    time step."""
    heap = Heap(given)
    limit = None
    if given.child == "engine":
        from masonry import criticalTimeStep

        limit = criticalTimeStep()[0]
    print("ROW " + json.dumps(dict(limit=limit)), flush=True)
    for line in sys.stdin:
        words = line.split()
        if words[0] == "dt":
            heap.O.dt = float(words[1])
        else:
            print("ROW " + json.dumps(heap.advance(float(words[0]))), flush=True)
    os._exit(0)  # the scene has no end that would be of use


# ---- beside it
# --------------------------------------------------------------------------------------------------


class Process:
    def __init__(self, kind, given):
        words = [
            f"--{k}={getattr(given, k)}" for k in ("blocks", "stiffness", "damping", "friction")
        ]
        command = [
            "yade",
            "-n",
            "-j1",
            "-x",
            os.path.abspath(__file__),
            *words,
            "--child",
            kind,
        ]
        self.kind, self.rows, self.ended = kind, [], False
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if kind == "stock" else None,
            text=True,
        )
        self.limit = self.answer().get("limit")

    def answer(self):
        for line in self.process.stdout:
            if line.startswith("ROW "):
                return json.loads(line[4:])
        self.ended = True
        return {}

    def say(self, line):
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()


def main(given):
    kinds = given.only or KINDS
    heaps = [Process(kind, given) for kind in kinds]
    limits = [h.limit for h in heaps if h.limit]
    heaps = [h for h in heaps if not h.ended]
    for h in heaps:
        step = (
            given.stock_step
            if h.kind == "stock" and given.stock_step
            else given.step * min(limits, default=1e-5)
        )
        h.say(f"dt {step!r}")
    ends = time.monotonic() + 60 * given.minutes
    for n in range(1, round(given.seconds / WINDOW) + 1):
        if time.monotonic() > ends:
            break
        for h in heaps:
            if not h.ended:
                h.say(n * WINDOW)
                row = h.answer()
                if row:
                    h.rows.append(row)
    for h in heaps:
        h.process.stdin.close()
        h.process.wait()
    table(heaps, given, min(limits, default=math.nan))


def table(heaps, given, limit):
    print(
        f"{given.blocks} bricks, {given.stiffness:g} Pa/m, limit of the plugin's time step"
        f" {limit:.3g} s"
    )
    names = [
        "time reached, s",
        "time step, us",
        "a step, us",
        "a contact and step, us",
        "a second of the heap, s",
        "pairs that touch at the end",
        "error of the energy, %",
        "potential energy lost, J",
        "at rest after, s",
        "deepest corner below the slab, mm",
        "least distance of two middles, mm",
    ]
    columns = []
    for h in heaps:
        last = h.rows[-1]
        rest = None
        for row in reversed(h.rows):
            if row["kinetic"] > RESTS * max(row["fallen"], 1e-9):
                break
            rest = row["time"]
        error = 100 * (last["kinetic"] + last["lost"] - last["fallen"]) / last["fallen"]
        columns.append(
            [
                f"{last['time']:.2f}",
                f"{1e6 * last['dt']:.1f}",
                f"{1e6 * last['took'] / last['steps']:.1f}",
                f"{1e6 * last['took'] / last['contacts']:.2f}" if last["contacts"] else "-",
                f"{last['took'] / last['time']:.2f}",
                last["touching"],
                f"{error:.3f}",
                f"{last['fallen']:.1f}",
                f"{rest:.2f}" if rest else "not yet",
                f"{1e3 * max(r['depth'] for r in h.rows):.1f}",
                f"{1e3 * min(r['near'] for r in h.rows):.1f}",
            ]
        )
    print("| |", " | ".join(h.kind for h in heaps), "|")
    print("|---" * (len(heaps) + 1) + "|")
    for n, name in enumerate(names):
        print(f"| {name} |", " | ".join(str(c[n]) for c in columns), "|")


if __name__ == "__main__":
    chosen = options()
    child(chosen) if chosen.child else main(chosen)
