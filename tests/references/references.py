# SPDX-License-Identifier: GPL-2.0-or-later
"""Short runs whose numbers are stored, so that a rewrite of the internals can be compared with
them.

    yade -n -x tests/references/references.py             # compares all runs with what is stored
    yade -n -x tests/references/references.py --write     # stores anew, from the imported plugin
    yade -n -x tests/references/references.py rigid ...   # only the runs whose names begin so

A run is a scene and its stages. After each stage the state is read through the public Python
interface alone: reactions of loads, forces on the base, energies, two bodies, sums and extremes
over all joints, and a fingerprint of every number of every joint, body and node. Time steps are
written down here and not taken from criticalTimeStep(), so that a change of the limit in its last
digit changes the limit alone. The numbers are those of glibc 2.36 on a processor with FMA (glibc
uses other polynomials without it). They do not depend on the number of threads.
"""

import hashlib
import json
import math
import os
import re
import struct
import sys
import tempfile
from dataclasses import dataclass

import masonry
from masonry import addBlock, bricks, connect, criticalTimeStep, engines
from masonry import loadCheckpoint, saveCheckpoint
from yade import O, Quaternion, Vector3
from yade.wrapper import *

SELF = sys.argv[0] if __name__ == "__main__" else __file__
FOLDER = os.path.dirname(os.path.abspath(SELF))
REMAKE = "yade -n -x tests/references/references.py --write"

LENGTH, THICKNESS, HEIGHT = 0.220, 0.102, 0.081  # of a brick [m]
TURN = Quaternion(Vector3(1, 2, 0.5).normalized(), 0.7)
STRAIGHT = Quaternion.Identity


# -- what is read ----------------------------------------------------------------------------------

REGIMES = ("elastic", "opening", "slipping", "crushing")
peaks = {}  # smallest and largest reaction of every load since the run began [N]


def ofKind(kind):
    return [e for e in O.engines if isinstance(e, kind)]


def loads():
    return ofKind(MasonryLoad)


def step(count):
    driven = loads()
    for _ in range(count):
        O.step()
        for number, load in enumerate(driven):
            low, high = peaks.get(number, (0.0, 0.0))
            peaks[number] = min(low, load.reaction), max(high, load.reaction)


def spread(rows):
    """Sum, smallest and largest of every column. The sum is rounded once, so the order of the rows
    does not matter."""
    return [f(column) for column in zip(*rows) for f in (math.fsum, min, max)]


def state():
    """What is stored of an instant: quantity -> list of numbers; and a fingerprint of all numbers
    of the state."""
    joints = sorted(O.interactions.all(), key=lambda i: (i.id1, i.id2))
    points = {
        "stress [Pa]": [s for i in joints for s in i.phys.stress],
        "jump [m]": [j for i in joints for j in i.geom.jumps],
        "damage [-]": [d for i in joints for d in i.phys.damage],
        "slip [m]": [[s] for i in joints for s in i.phys.slip],
        "dissipated [J]": [i.phys.dissipated for i in joints],
    }
    regimes = [r for i in joints for r in i.phys.regime]
    for zones in ofKind(MasonryZones):
        points["node displacement [m]"] = zones.displacements
        points["node velocity [m/s]"] = zones.velocities
    bodies = [b.state for b in O.bodies if b]
    motions = {
        "position [m]": [b.pos for b in bodies],
        "orientation [-]": [b.ori for b in bodies],
        "velocity [m/s]": [b.vel for b in bodies],
        "spin [rad/s]": [b.angVel for b in bodies],
    }
    shown = sorted({len(bodies) // 2, len(bodies) - 1})
    balance = ofKind(MasonryEnergy)[0].balance()
    numbers = {
        "step": [float(O.iter)],
        "limit of the time step [s]": [criticalTimeStep()[0]],
        "peak reaction [N]": [p for n in sorted(peaks) for p in peaks[n]],
        "reaction [N]": [e.reaction for e in loads()],
        "work of loads [J]": spread([[e.work] for e in loads()]),
        "displacement of loads [m]": spread([e.displacement() for e in loads()]),
        "force on the base [N]": list(O.forces.f(0, True)),
        "torque on the base [N m]": list(O.forces.t(0, True)),
        "error of the balance [-]": [balance.pop("error")],
        # no reference has joints that get more points, and most have no impacts
        "energy [J]": [
            balance[n] for n in balance if n != "refining" and (n != "impacts" or balance[n])
        ],
        "subcontacts in a regime": [float(regimes.count(r)) for r in REGIMES],
    }
    numbers.update({name: spread(rows) for name, rows in points.items() if rows})
    for name, rows in motions.items():
        numbers[name] = [x for n in shown for x in rows[n]]
    every = *points.values(), *motions.values(), numbers.values()
    behind = [x for rows in every for r in rows for x in r]
    # + 0.0 turns -0.0 into 0.0.
    packed = struct.pack(f"{len(behind)}d", *(x + 0.0 for x in behind))
    return numbers, hashlib.sha256(packed).hexdigest()[:16]


# -- scenes ----------------------------------------------------------------------------------------


def put(low, high, material, turn=STRAIGHT):
    """A box between two corners, turned about the origin; without a turn it stays in its plane."""
    (x0, x1), (y0, y1), (z0, z1) = zip(low, high)
    corners = [(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
    points = [turn * Vector3(*corner) for corner in corners]
    return addBlock(points, material, inPlane=turn == STRAIGHT)


def unitAndPlate():
    unit = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    return unit, MasonryMat(density=2400, young=1e16, jointSet="plate")


CRUSHING = dict(peakRatio=20, compressiveFractureEnergy=3000)
DILATANT = dict(dilatancy=0.1, dilatancyDecay=200, residualFriction=0.3)
DRY = dict(tensileStrength=0, cohesion=0, friction=0.6, residualFriction=0.6)


def laid(courses, halfUnits, material, turn, halves=True):
    """A running bond: body and brick of every block."""
    unit = LENGTH, THICKNESS, HEIGHT
    blocks = bricks.Wall(halfUnits * LENGTH / 2, courses * HEIGHT, unit, halves=halves)
    return {put(b.low, b.high, material, turn): b.brick for b in blocks}


def scene(dt, joints, turn, rule=None, **around):
    """Engines and joints of the blocks; in the plane unless they are turned."""
    inPlane, gravity = turn == STRAIGHT, turn * Vector3(0, 0, -9.81)
    engines(joints, gravity=gravity, inPlane=inPlane, **around)
    connect(rule)
    O.dt = dt


def wall(
    dt,
    courses=4,
    halfUnits=6,
    halves=True,
    turn=STRAIGHT,
    rows=1,
    deformable=False,
    divisions=(1, 1, 1),
    rigidBricks=0,
    kind="local",
    functors=False,
    cyclic=False,
):
    """A small wall in running bond between plates: bed, head, crack and support joints; the upper
    plate is driven."""
    inPlane = turn == STRAIGHT
    unit, plate = unitAndPlate()
    length, height = halfUnits * LENGTH / 2, courses * HEIGHT
    base = put((0, 0, -0.1), (length, THICKNESS, 0), plate, turn)
    brickOf = laid(courses, halfUnits, unit, turn, halves)
    top = put((0, 0, height), (length, THICKNESS, height + 0.1), plate, turn)
    O.bodies[base].state.blockedDOFs = "xyzXYZ"
    up, along = turn * Vector3(0, 0, 1), turn * Vector3(1, 0, 0)
    support = MasonryJoint(name="support", jointSet="plate", elastic=True)
    crushes = dict(compressiveStrength=1.2e6, **CRUSHING, **DILATANT)
    bed = MasonryJoint(name="bed", direction=up, **crushes)
    low = dict(tensileStrength=0.05e6, cohesion=0.06e6)
    joints = [support, bed, MasonryJoint(name="head", direction=along, **low)]
    crack = MasonryJoint(name="crack", tensileStrength=0.2e6, cohesion=0.4e6, cap=False)
    for joint in (*joints, crack) if cyclic else ():
        joint.law, joint.shearStiffnessLoss = "cyclic", 0.3
    load = MasonryLoad(
        body=top,
        point=turn * Vector3(0.4 * length, THICKNESS / 3, height),
        force=turn * Vector3(0, 0, -0.12e6 * length * THICKNESS),
        direction=turn * Vector3(1, 0 if inPlane else 0.1, 0),
        driven=True,
        velocity=0.005,
    )
    zones = None
    if deformable:
        bodies = sorted(brickOf)[: len(brickOf) - rigidBricks]
        zones = MasonryZones(bodies=bodies, divisions=list(divisions), damping=0.6)
        zones.dampingKind, zones.blocked = kind, "y" if inPlane else ""

    def rule(one, two, geom):
        isCrack = one.id in brickOf and brickOf.get(two.id) == brickOf[one.id]
        return crack if isCrack else None

    around = dict(damping=0.6, dampingKind="local" if functors else kind)
    around.update(rows=rows, loads=[load], zones=zones, functors=functors)
    scene(dt, joints, turn, rule, **around)


def drive(*velocities):
    """A change of the velocities of the loads [m/s], in turn."""

    def change():
        for number, load in enumerate(loads()):
            load.velocity = velocities[number % len(velocities)]

    return change


PUSH = [
    ("pressed", 60, None),
    ("pushed", 600, drive(0.15)),
    ("pushed far", 1200, drive(0.3)),
    ("pulled back", 600, drive(-0.3)),
]
SHORT = [("pressed", 60, None), ("pushed", 600, drive(0.2))]


def kinds():
    """All kinds of joints that a user can make."""
    brittle = MasonryJoint().brittleCoulomb()
    brittle.name = "brittle"
    loose = dict(dilatancy=0.2, dilatancyDecay=3000, residualFriction=0.3)
    tables = dict(tensionTable=[(1, 0), (40, 0.6), (400, 1)])
    tables.update(shearTable=[(1, 0), (30, 0.5), (300, 1)], residualCohesion=0.02e6)
    soft = dict(compressiveStrength=1e6, capShear=2, capLinear=2e4, **CRUSHING)
    return [
        MasonryJoint(name="default"),
        MasonryJoint(name="elastic", elastic=True),
        brittle,
        MasonryJoint(name="dry", **DRY),
        MasonryJoint(name="dilatant", **loose),
        MasonryJoint(name="tables", **tables),
        MasonryJoint(name="crushing", **soft),
        MasonryJoint(name="without cap", cap=False, residualFriction=0.2),
    ]


def couplets(dt, turn=STRAIGHT, damping=0.6, kind="local"):
    """One stack for every kind of joint: two bricks with this joint, and a driven block on them
    with an elastic one."""
    inPlane = turn == STRAIGHT
    mat, _ = unitAndPlate()
    offered, drives = kinds(), []
    for number in range(len(offered)):
        for level, blocked in enumerate(("xyzXYZ", "yXZ" if inPlane else "", "yXYZ")):
            low = (number, 0, level * HEIGHT)
            high = (number + LENGTH, THICKNESS, (level + 1) * HEIGHT)
            body = put(low, high, mat, turn)
            O.bodies[body].state.blockedDOFs = blocked
        if not inPlane:
            O.bodies[body].state.blockedDOFs = "XYZ"
        top = turn * Vector3(number + LENGTH / 2, THICKNESS / 2, 3 * HEIGHT)
        driven = dict(body=body, point=top, driven=True)
        for sign in ((0, 0, 1), (1, 0, 0)):
            drives.append(MasonryLoad(direction=turn * Vector3(*sign), **driven))
    elastic = MasonryJoint(name="between", elastic=True)
    rule = lambda one, two, geom: elastic if one.id % 3 else offered[one.id // 3]
    around = dict(damping=damping, dampingKind=kind, rows=None, loads=drives)
    scene(dt, offered, turn, rule, **around)


#: Velocities of the couplets' driven blocks up and along x [m/s].
PATH = [
    ("pressed", 100, drive(-0.0005, 0)),
    ("opened", 300, drive(0.01, 0)),
    ("closed again", 320, drive(-0.01, 0)),
    ("slid", 400, drive(-0.0005, 0.02)),
    ("slid back", 600, drive(-0.0005, -0.02)),
    ("crushed", 400, drive(-0.02, 0.005)),
    ("torn", 600, drive(0.05, 0.01)),
]


def tilted(
    dt,
    turn=STRAIGHT,
    rows=1,
    deformable=False,
    about=(0, 1, 0),
    rate=2.0,
    impacts=False,
):
    """A wall without an upper plate on a base that turns until the wall topples; ``impacts``:
    whether corners that land lose energy."""
    unit, plate = unitAndPlate()
    base = put((0, 0, -0.1), (4 * LENGTH / 2, THICKNESS, 0), plate, turn)
    bodies = [*laid(5, 4, unit, turn, halves=False)]
    soft = dict(normalStiffness=4e9, shearStiffness=2e9)
    support = dict(name="support", jointSet="plate", elastic=True)
    zones = None
    if deformable:
        zones = MasonryZones(bodies=bodies, blocked="y" if turn == STRAIGHT else "")
    dry = MasonryJoint(name="dry", cap=False, **DRY, **soft)
    joints = [MasonryJoint(**support, **soft), dry]
    around = dict(damping=0.3, dampingKind="local", rows=rows, zones=zones)
    scene(dt, joints, turn, **around)
    ofKind(MasonryEnergy)[0].watch = False  # the runs go on after the collapse
    for loop in ofKind(MasonryJointLoop):
        loop.impacts = impacts
    s = O.bodies[base].state
    s.blockedDOFs = "xyzXYZ"
    s.angVel = turn * (rate * Vector3(*about))


def flying(dt, kind="local", damping=0.1):
    """A brick that spins about none of its principal axes, and a pair that spins until its joint
    breaks."""
    mat, _ = unitAndPlate()
    for low in ((0, 0, 0), (0, 0, HEIGHT), (1, 0, 0)):
        high = [a + b for a, b in zip(low, (LENGTH, THICKNESS, HEIGHT))]
        put(low, high, mat, TURN)
    engines([MasonryJoint()], damping=damping, rows=None)
    ofKind(MasonryIntegrator)[0].dampingKind = kind
    connect()
    for body, spin in ((0, (3, 1, -2)), (1, (-4, 2, 1)), (2, (3, -14, 5))):
        s = O.bodies[body].state
        s.vel = Vector3(0.5, -0.1, 2)
        s.angVel = Vector3(*spin)
        own = s.ori.conjugate() * s.angVel
        s.angMom = s.ori * Vector3(*(i * w for i, w in zip(s.inertia, own)))
    O.forces.setPermF(2, Vector3(1, 2, -3))
    O.forces.setPermT(2, Vector3(0.02, 0.01, -0.03))
    O.dt = dt


def otherProperties():
    joint = next(i.phys.joint for i in O.interactions if i.phys.joint.name == "bed")
    joint.updateAttrs(dict(cohesion=0.02e6, tensileStrength=0.02e6, dilatancy=0.05))


def otherEngines():
    (integrator,) = ofKind(MasonryIntegrator)
    integrator.damping, integrator.dampingKind = 0.3, "combined"
    integrator.gravity = (0.5, 0, -12)
    load = loads()[0]
    load.driven, load.force = False, Vector3(2e3, 0, -4e3)
    O.dt *= 0.75


def outOfThePlane():
    """A run that is planar at first, and then leaves the plane."""
    for body in (5, 9):
        O.bodies[body].state.pos += Vector3(0, 2e-6, 0)
        O.bodies[body].state.blockedDOFs = ""
    O.bodies[7].state.blockedDOFs = "yX"


CHANGES = [
    ("pressed", 60, None),
    ("pushed", 300, drive(0.2)),
    ("other properties", 200, otherProperties),
    ("other engines", 300, otherEngines),
    ("out of the plane", 200, outOfThePlane),
]


# -- runs ------------------------------------------------------------------------------------------


@dataclass
class Run:
    build: callable  # takes the keywords
    stages: list  # (instant, steps to it, what is changed before them)
    keywords: dict
    # after its second stage the scene is saved and loaded: by "checkpoint" or "file"
    through: str = ""
    like: str = ""  # the run whose stored numbers this one must give; empty: its own


def run(build, stages, through="", like="", **keywords):
    return Run(build, stages, keywords, through, like)


def alone(**steps):
    """Stages of a scene that is left to itself: steps to each instant."""
    return [(instant, count, None) for instant, count in steps.items()]


SPACE = dict(turn=TURN, rows=None)
RIGID, ZONED = 2.5e-5, 7e-6  # time steps of the walls [s]
SOFT = dict(dt=ZONED, deformable=True, kind="combined")
UNLIKE, MIXED = dict(halves=False, **SOFT), dict(rigidBricks=2, divisions=(2, 1, 1))
QUICKLY = dict(dt=1e-5, deformable=True, rate=8.0)
LARGE = dict(halfUnits=8, courses=5)
CYCLIC = dict(dt=RIGID, cyclic=True)
ALONE = alone(early=200, late=6000)
FALL = alone(early=400, tilted=2000, fallen=5000)
OUT = dict(about=(1, 0.3, 0), **SPACE)
RUNS = {
    "rigid": run(wall, PUSH, dt=RIGID, **LARGE),
    "rigid_combined": run(wall, PUSH, dt=RIGID, kind="combined"),
    "rigid_space": run(wall, PUSH, dt=RIGID, **SPACE),
    "rigid_space_combined": run(wall, SHORT, dt=RIGID, kind="combined", **SPACE),
    "rigid_functors": run(wall, SHORT, dt=RIGID, functors=True),
    "rigid_space_functors": run(wall, SHORT, dt=RIGID, functors=True, **SPACE),
    "rigid_resumed": run(wall, PUSH, "checkpoint", "rigid", dt=RIGID, **LARGE),
    "rigid_saved": run(wall, PUSH[:3], "file", dt=RIGID, kind="combined"),
    "deformable": run(wall, PUSH, **SOFT),
    "deformable_local": run(wall, SHORT, dt=ZONED, deformable=True),
    "deformable_space": run(wall, PUSH[:3], **SOFT, **SPACE),
    "deformable_unlike": run(wall, PUSH[:3], **MIXED, **UNLIKE),
    "deformable_space_unlike": run(wall, SHORT, divisions=(2, 2, 2), **UNLIKE, **SPACE),
    "deformable_functors": run(wall, SHORT, functors=True, **SOFT),
    "deformable_resumed": run(wall, PUSH, "checkpoint", "deformable", **SOFT),
    "deformable_saved": run(wall, PUSH[:3], "file", **SOFT),
    "couplets": run(couplets, PATH, dt=2.5e-5),
    "couplets_combined": run(couplets, PATH, dt=2.5e-5, turn=TURN, kind="combined"),
    "couplets_undamped": run(couplets, PATH[:3], dt=2.5e-5, damping=0),
    "flying": run(flying, ALONE, dt=3e-5),
    "flying_combined": run(flying, ALONE, dt=3e-5, kind="combined"),
    "collapse": run(tilted, alone(early=400, tilted=3000, fallen=5000), dt=5e-5),
    "collapse_space": run(tilted, FALL, dt=5e-5, **OUT),
    "impacts": run(tilted, FALL, dt=5e-5, impacts=True, **OUT),
    "collapse_deformable": run(tilted, alone(early=1000, fallen=12000), **QUICKLY),
    "changes": run(wall, CHANGES, dt=RIGID),
    "cyclic": run(wall, PUSH, **CYCLIC, **LARGE),
    "cyclic_functors": run(wall, SHORT, functors=True, **CYCLIC),
    "cyclic_resumed": run(wall, PUSH, "checkpoint", "cyclic", **CYCLIC, **LARGE),
}


def go(name):
    """The run's instants: name -> (quantity -> numbers, fingerprint). Leaves the scene as it is at
    the end."""
    wanted, instants = RUNS[name], {}
    O.reset()
    peaks.clear()
    wanted.build(**wanted.keywords)
    for number, (instant, steps, change) in enumerate(wanted.stages):
        if number == 2 and wanted.through:
            through(wanted)
        if change:
            change()
        step(steps)
        instants[instant] = state()
    return instants


def through(wanted):
    with tempfile.TemporaryDirectory() as folder:
        if wanted.through == "file":
            path = os.path.join(folder, "scene.yade.gz")
            O.save(path)
            O.load(path)
            return
        path = os.path.join(folder, "checkpoint")
        saveCheckpoint(path)
        O.reset()
        wanted.build(**wanted.keywords)
        loadCheckpoint(path)


# -- files -----------------------------------------------------------------------------------------


def pathOf(name):
    return os.path.join(FOLDER, (RUNS[name].like or name) + ".json")


def brief(number):
    """float.hex() without the zeros at its end; float.fromhex() reads it."""
    return re.sub(r"\.?0+p", "p", number.hex())


def write(name, instants):
    made = {"made by": f"masonry {masonry.commit}", "to remake it": REMAKE}
    made["instants"] = {
        instant: {"fingerprint": fingerprint}
        | {name: " ".join(map(brief, of)) for name, of in numbers.items()}
        for instant, (numbers, fingerprint) in instants.items()
    }
    with open(pathOf(name), "w") as f:
        json.dump(made, f, indent=1, ensure_ascii=True)
        f.write("\n")


def stored(name):
    """The stored instants of a run, in the form in which go() gives them."""
    with open(pathOf(name)) as f:
        instants = json.load(f)["instants"]
    found = {}
    for instant, rows in instants.items():
        fingerprint = rows.pop("fingerprint")
        numbers = {n: [*map(float.fromhex, of.split())] for n, of in rows.items()}
        found[instant] = numbers, fingerprint
    return found


def sizes(instants):
    """Largest number of every quantity in a run. The error of a balance is relative already, so its
    size is 1."""
    largest = {}
    for numbers, _ in instants.values():
        for quantity, values in numbers.items():
            largest[quantity] = max([largest.get(quantity, 0.0), *map(abs, values)])
    largest["error of the balance [-]"] = 1.0
    return largest


def differences(name, instants):
    """All that differs in any bit from the stored numbers: (instant, quantity, difference over the
    quantity's size)."""
    before, found = stored(name), []
    if list(before)[: len(instants)] != list(instants):
        return [("all", "instants", math.inf)]
    size = sizes(before)
    for instant, (numbers, fingerprint) in instants.items():
        old, oldFingerprint = before[instant]
        for quantity in {**old, **numbers}:
            pair = old.get(quantity, []), numbers.get(quantity, [])
            if pair[0] == pair[1]:
                continue
            apart = math.inf
            if len(pair[0]) == len(pair[1]) and size[quantity] > 0:
                apart = max(abs(a - b) for a, b in zip(*pair)) / size[quantity]
            found.append((instant, quantity, apart))
        if fingerprint != oldFingerprint:
            found.append((instant, "fingerprint", 0.0))
    return found


def main(words):
    writing, telling = "--write" in words, "--told" in words
    names = [w for w in words if not w.startswith("--")]
    different = 0
    for name in RUNS:
        if names and not name.startswith(tuple(names)):
            continue
        if O.numThreads > 1 and RUNS[name].keywords.get("functors"):
            print(name, "is left out: the host's own loop sums forces by threads")
            continue
        instants = go(name)
        for instant, (_, fingerprint) in instants.items() if telling else ():
            print("told", name, instant, fingerprint)
        if writing and not RUNS[name].like:
            write(name, instants)
        found = differences(name, instants)
        different += bool(found)
        print(name, "differs:" if found else "is the same, bit for bit")
        for instant, quantity, apart in found:
            print(f"    {instant}: {quantity}: {apart:.2g}")
    O.reset()
    print(f"{different} runs differ, with {O.numThreads} threads; {masonry.__file__}")
    return 1 if different else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
