# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic behaviour: stiffness of joints, cantilevers of deformable units, patch tests, waves."""

import math

import numpy as np
from cases import case
from masonry import (
    MasonryLoad,
    MasonryMat,
    MasonryZones,
    addBlock,
    connect,
    criticalTimeStep,
    engines,
)
from masonry.bricks import boxCorners as corners
from structures import box, elastic, fix, mat
from yade import O, Quaternion, Vector3

JOINTS, BEAMS = "Stiffness of a joint", "Cantilevers of deformable units"
PATCH, WAVES = "Patch tests in space", "Waves"
BRICK = (0.22, 0.102, 0.081)  # [m]


# -- joints ----------------------------------------------------------------------------------------


def jointMoment(about, points=None, functors=False, divisions=None, blocked=""):
    """Moment that turns one brick against another by an angle, over that angle: expected and
    measured [N m/rad].

    :param divisions: zones of the upper brick; None: it is rigid
    """
    length, thickness, height = BRICK
    k, angle = 1e10, 1e-7
    base = box((0, 0, -height), BRICK, mat())
    unit = MasonryMat(young=1e10, poisson=0.2, density=1800) if divisions else mat()
    brick = box((0, 0, 0), BRICK, unit)
    fix(base)
    zones = None
    if divisions:
        zones = MasonryZones(bodies=[brick], divisions=divisions, blocked=blocked)
    engines(
        [elastic(k)],
        gravity=(0, 0, 0),
        subcontacts=points,
        rows=points,
        zones=zones,
        functors=functors,
    )
    connect()
    O.dt = 1e-12  # nothing moves in the step that reads the moment
    # a deformable brick stays, and its base turns
    moved, turn = base if divisions else brick, Quaternion(Vector3(*about), angle)
    state, foot = O.bodies[moved].state, Vector3(length / 2, thickness / 2, 0)
    state.pos, state.ori = foot + turn * (state.pos - foot), turn * state.ori
    O.step()
    extent = length if about == (0, 1, 0) else thickness
    true = k * length * thickness * extent**2 / 12
    return true, -O.forces.t(moved).dot(Vector3(*about)) / angle


TURNS = "kn·A·L²/12"


@case(
    JOINTS,
    "moment over rotation along a joint, rigid, three points [N m/rad]",
    TURNS,
    aim=1e-6,
    quick=True,
)
def joint_turns_along(quick):
    O.reset()
    return jointMoment((0, 1, 0))


@case(
    JOINTS,
    "moment over rotation across a joint, rigid, three rows [N m/rad]",
    TURNS,
    aim=1e-6,
    quick=True,
)
def joint_turns_across(quick):
    O.reset()
    return jointMoment((1, 0, 0))


@case(JOINTS, "the same, sixteen points and rows", TURNS, aim=1e-6)
def joint_turns_16(quick):
    O.reset()
    return jointMoment((1, 0, 0), points=16)


@case(
    JOINTS,
    "moment over rotation of a joint on a deformable brick of 3 × 2 × 2 cells [N m/rad]",
    TURNS,
    aim=1e-6,
    quick=True,
)
def joint_turns_deformable(quick):
    O.reset()
    return jointMoment((1, 0, 0), divisions=(3, 2, 2))


@case(
    JOINTS,
    "the same with two points along the joint, rigid",
    "3·kn·A·L²/12: all of it at the ends",
    aim=1e-6,
)
def joint_turns_2(quick):
    O.reset()
    true, measured = jointMoment((0, 1, 0), points=2)
    return 3 * true, measured


# -- cantilevers of deformable units ---------------------------------------------------------------

E, NU, RHO = 4.8e9, 0.16, 1800.0


def deflection(cells, length=0.4, section=0.05):
    """Deflection of the tip of a deformable bar under its own weight sideways: of the beam, and
    measured [m].

    :param cells: across the bar; it has eight times as many along its length
    """
    O.reset()
    unit = MasonryMat(density=RHO, young=E, poisson=0.0)
    base = addBlock(corners((0, 0, -section), (section, section, 0)), mat())
    bar = addBlock(corners((0, 0, 0), (section, section, length)), unit)
    fix(base)
    zones = MasonryZones(
        bodies=[bar],
        divisions=[cells, cells, 8 * cells],
        damping=0.8,
        dampingKind="local",
        gravity=(9.81, 0, 0),
    )
    engines([elastic(1e14)], gravity=(9.81, 0, 0), damping=0, zones=zones)
    connect()
    O.dt = 0.9 * criticalTimeStep()[0]
    tip = [
        n
        for n in range(*zones.nodesOf(bar))
        if abs(zones.referencePoint(bar, n)[2] - length) < 1e-9
    ]
    for _ in range(int(8 * 0.0021 / O.dt)):  # eight times the slowest period
        O.step()
    moved = np.mean([zones.displacements[n][0] for n in tip])
    load, inertia, area = RHO * 9.81 * section**2, section**4 / 12, section**2
    bent = load * length**4 / (8 * E * inertia)
    return bent + 1.2 * load * length**2 / (2 * area * E / 2), moved


STIFF = (
    "zones of constant strain are too stiff in bending; the excess falls to a third with half their"
    " size"
)


@case(
    BEAMS,
    "deflection of a deformable cantilever, one cell across [m]",
    "q·L⁴/8EI + 1.2·q·L²/2GA",
    aim=0.01,
    misses=STIFF,
    quick=True,
)
def cantilever_1(quick):
    return deflection(1)


@case(
    BEAMS,
    "the same, two cells across",
    "q·L⁴/8EI + 1.2·q·L²/2GA",
    aim=0.01,
    misses=STIFF,
)
def cantilever_2(quick):
    return deflection(2)


@case(
    BEAMS,
    "the same, four cells across",
    "q·L⁴/8EI + 1.2·q·L²/2GA",
    aim=0.01,
    misses=STIFF,
)
def cantilever_4(quick):
    return deflection(4)


# -- patch tests -----------------------------------------------------------------------------------


def patch(deformable, force=(3.0, -2.0, -60.0), where=(0.02, -0.01)):
    """Largest error of the stress at points of a joint under a force on the block above it, over
    the largest stress.

    The blocks are turned in space. The force acts at a point off the middle of a joint that is much
    longer than wide, so the stress is linear along both: N/A + M·y/I about both axes. What turns
    about the normal is held.
    """
    O.reset()
    length, thickness, height = BRICK
    turn = Quaternion(Vector3(1, 2, 3).normalized(), 0.7)
    put = lambda low, high, m: addBlock([turn * Vector3(*c) for c in corners(low, high)], m)
    base = put((0, 0, -height), (length, thickness, 0), mat())
    unit = MasonryMat(young=4.8e10, poisson=0.0, density=RHO)
    brick = put((0, 0, 0), (length, thickness, height), unit if deformable else mat())
    top = put((0, 0, height), (length, thickness, 2 * height), mat())
    fix(base)
    middle = Vector3(length / 2, thickness / 2, 0)
    point = middle + Vector3(*where, 2 * height)
    load = MasonryLoad(body=top, point=turn * point)
    zones = None
    if deformable:
        zones = MasonryZones(bodies=[brick], divisions=[2, 1, 1], damping=0.5, dampingKind="local")
    engines(
        [elastic(1e10)],
        loads=[load],
        gravity=(0, 0, 0),
        damping=0.5,
        dampingKind="local",
        zones=zones,
    )
    made = connect()
    O.dt = 0.5 * criticalTimeStep()[0]
    for n in range(12000):
        if n % 20 == 0 and n <= 4000:
            x = n / 4000
            load.force = x * x * (3 - 2 * x) * (turn * Vector3(*force))
        O.step()
    joint = next(i for i in made if base in (i.id1, i.id2))
    area = length * thickness
    bent = (point - middle).cross(Vector3(*force))  # moment about the middle of the joint
    about = bent[0] / (area * thickness**2 / 12), -bent[1] / (area * length**2 / 12)
    errors, sizes = [], []
    back = turn.conjugate()
    for centre, stress in zip(joint.geom.centres, joint.phys.stress):
        place = back * Vector3(*centre) - middle
        exact = force[2] / area + about[0] * place[1] + about[1] * place[0]
        errors.append(abs(stress[0] - exact))
        sizes.append(abs(exact))
    return max(errors) / max(sizes)


LINEAR = "N/A + M·y/I at every point"


@case(
    PATCH,
    "error of the stress at the points of a joint, rigid blocks turned in space [-]",
    LINEAR,
    aim=1e-3,
    absolute=True,
    quick=True,
)
def patch_rigid(quick):
    return 0.0, patch(False)


@case(
    PATCH,
    "the same under a deformable block, centred force",
    LINEAR,
    aim=1e-3,
    absolute=True,
)
def patch_deformable(quick):
    return 0.0, patch(True, (0.0, 0.0, -60.0), (0.0, 0.0))


def together(seed, functors=False):
    """Largest jump in the joint of two deformable bricks of other meshes that move together, over
    their way [-]."""
    O.reset()
    dice = np.random.default_rng(seed)
    turn = Quaternion(*dice.normal(size=4))
    turn.normalize()
    x, y, z = BRICK
    unit = MasonryMat(young=E, poisson=NU, density=RHO)
    put = lambda low, high: addBlock([turn * Vector3(*c) for c in corners(low, high)], unit)
    units = [put((0, 0, 0), (x, y, z)), put((0, 0, z), (x / 2, y, 2 * z))]
    zones = MasonryZones(bodies=units, divisions=[2, 1, 1], damping=0)
    around = dict(gravity=(0, 0, 0), damping=0, rows=2, functors=functors)
    engines([elastic(1e10)], zones=zones, **around)
    (interaction,) = connect()
    O.dt = 0.1 * criticalTimeStep()[0]
    for node in range(len(zones.masses)):
        zones.setVelocity(node, Vector3(0.3, -0.2, 0.5))
    for _ in range(20):
        O.step()
    moved = zones.displacements[0].norm()
    return max(j.norm() for j in interaction.geom.jumps) / moved


@case(
    PATCH,
    "jump between deformable bricks of other meshes that move together, over their way [-]",
    "0",
    aim=1e-9,
    absolute=True,
    quick=True,
)
def patch_together(quick):
    return 0.0, together(1)


# -- waves -----------------------------------------------------------------------------------------


def frequency(cells, length=0.4, section=0.05):
    """First longitudinal frequency of a deformable bar: of theory, and measured from its free
    vibration [Hz]."""
    O.reset()
    unit = MasonryMat(density=RHO, young=E, poisson=0.0)
    base = addBlock(corners((0, 0, -section), (section, section, 0)), mat())
    bar = addBlock(corners((0, 0, 0), (section, section, length)), unit)
    fix(base)
    zones = MasonryZones(bodies=[bar], divisions=[1, 1, cells], damping=0, gravity=(0, 0, 0))
    engines([elastic(1e16)], gravity=(0, 0, 0), damping=0, zones=zones)
    connect()
    O.dt = min(0.9 * criticalTimeStep()[0], 1e-7)  # so that the error is the zones'
    for number in range(*zones.nodesOf(bar)):
        z = zones.referencePoint(bar, number)[2]
        speed = 1e-3 * math.sin(0.5 * math.pi * z / length)
        zones.setVelocity(number, Vector3(0, 0, speed))
    tip = max(range(*zones.nodesOf(bar)), key=lambda n: zones.referencePoint(bar, n)[2])
    crossings, last = [], 0.0
    while len(crossings) < 5:
        O.step()
        now = zones.displacements[tip][2]
        if last < 0 <= now or last > 0 >= now:
            crossings.append(O.time - O.dt * now / (now - last))
        last = now
    return math.sqrt(E / RHO) / (4 * length), 2 / (crossings[4] - crossings[0])


@case(WAVES, "first frequency of a bar of 8 cells [Hz]", "√(E/ρ)/4L", aim=0.01)
def wave_8(quick):
    return frequency(8)


@case(WAVES, "first frequency of a bar of 16 cells [Hz]", "√(E/ρ)/4L", aim=0.01)
def wave_16(quick):
    return frequency(16)


@case(
    WAVES,
    "first frequency of a column of 20 rigid blocks [Hz]",
    "√(kn·s/ρ)/4L, discrete",
    aim=0.005,
    quick=True,
)
def wave_rigid(quick):
    O.reset()
    size, count, kn = (0.2, 0.2, 0.1), 20, 1e10
    fix(box((0, 0, -size[2]), size, mat()))
    bodies = [box((0, 0, n * size[2]), size, mat(), inPlane=True) for n in range(count)]
    engines([elastic(kn)], gravity=(0, 0, 0), damping=0)
    connect()
    O.dt = 0.1 * criticalTimeStep()[0]
    mass, spring = 1800.0 * size[0] * size[1] * size[2], kn * size[0] * size[1]
    half = math.pi / (2 * (2 * count + 1))
    expected = math.sqrt(spring / mass) * math.sin(half) / math.pi
    states = [O.bodies[b].state for b in bodies]
    for n, s in enumerate(states):
        s.vel = Vector3(0, 0, 1e-3 * math.sin(2 * half * (n + 1)))
    tip, crossings, last = states[-1], [], 0.0
    while len(crossings) < 3:
        O.step()
        now = tip.pos[2] - tip.refPos[2]
        if last < 0 <= now or last > 0 >= now:
            crossings.append(O.time - O.dt * now / (now - last))
        last = now
    return expected, 1 / (crossings[2] - crossings[0])
