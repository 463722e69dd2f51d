# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts of blocks by functors in YADE's InteractionLoop: as the engine, in YADE's files, and what they refuse."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
from masonry import addBlock, connect, criticalTimeStep, engines, saveCheckpoint
from yade import O, Quaternion, Vector3, utils
from yade.wrapper import *

G = 9.81
BRICK = (0.22, 0.102, 0.081)
LAW = dict(normalStiffness=1e10, friction=0.5, restitution=0.5)
TILTED = Quaternion(Vector3(0, 1, 0), math.radians(30))

PHYSICS = "Ip2_MasonryMat_MasonryMat_MasonryContactPhys"


def cornersOf(size, middle, turn):
    return [
        Vector3(*middle) + turn * Vector3(*[size[i] * (c[i] - 0.5) for i in range(3)])
        for c in [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    ]


def box(size=BRICK, middle=(0, 0, 0), turn=Quaternion.Identity, held=False):
    id = addBlock(
        cornersOf(size, middle, turn),
        MasonryMat(density=1800, young=4.8e9, poisson=0.16),
    )
    if held:
        O.bodies[id].state.blockedDOFs = "xyzXYZ"
    return id


def ground(turn=Quaternion.Identity):
    """A slab whose upper face goes through the origin."""
    return box((4, 2, 0.4), turn * Vector3(0, 0, -0.2), turn, held=True)


def loop(**law):
    """Collider and InteractionLoop with the functors of contacts."""
    return [
        InsertionSortCollider([Bo1_MasonryBlock_Aabb(anyTurn=False)], verletDist=0),
        InteractionLoop(
            [Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom()],
            [Ip2_MasonryMat_MasonryMat_MasonryContactPhys(**{**LAW, **law})],
            [Law2_MasonryContactGeom_MasonryContactPhys_Potential()],
        ),
    ]


def prepare(engines, integrator=None, gravity=(0, 0, -G)):
    O.engines = [
        ForceResetter(),
        *engines,
        integrator or MasonryIntegrator(damping=0, gravity=gravity),
    ]


def theLaw():
    return O.engines[2].lawDispatcher.functors[0]


def states():
    return np.array(
        [[*s.pos, *s.vel, *s.angVel, *s.ori] for s in (b.state for b in O.bodies)]
    )


def falling():
    ground()
    box(middle=(0.3, 0.1, 0.02 + BRICK[2] / 2), turn=Quaternion(Vector3(1, 2, 3), 0.2))


def sliding():
    ground(TILTED)
    box(middle=TILTED * Vector3(0, 0, BRICK[2] / 2), turn=TILTED)


def oblique():
    box((0.1, 0.1, 0.1))
    turn = Quaternion(Vector3(1, 1, 0), 0.4)
    other = box((0.1, 0.1, 0.1), (0.13, 0.02, 0.01), turn)
    O.bodies[other].state.vel = Vector3(-2, 0.3, -0.2)
    O.bodies[other].state.angVel = Vector3(0.5, -1, 2)


def resting():
    ground()
    for n in range(3):
        box(middle=(0.03 * n, 0, BRICK[2] * (n + 0.5)))


#: What is built, gravity [m/s²] and how many steps.
SCENES = {
    "falling": (falling, (0, 0, -G), 6000),
    "sliding": (sliding, (0, 0, -G), 3000),
    "oblique": (oblique, (0, 0, 0), 3000),
    "resting": (resting, (0, 0, -G), 6000),
}


@pytest.mark.parametrize("kind", SCENES)
def test_functors_and_engine_agree(scene, kind):
    build, gravity, steps = SCENES[kind]
    build()
    contacts = MasonryContacts(**LAW)
    prepare([contacts], gravity=gravity)
    dt = O.dt = 0.5 * criticalTimeStep()[0]
    O.run(steps, True)
    expected = states()
    losses = contacts.lostInFriction, contacts.lostInDamping
    pairs = contacts.touching()
    pressed = {(i, j): contacts.forceOf(i, j) for j in range(len(O.bodies)) for i in range(j)}  # fmt: skip
    assert losses[1] > 0
    O.reset()
    build()
    prepare(loop(), gravity=gravity)
    functor = O.engines[2].physDispatcher.functors[0]
    O.dt = dt
    assert functor.timeStep() == pytest.approx(2 * dt, rel=0.02)
    O.run(steps, True)
    assert np.abs(states() - expected).max() < 1e-12
    law = theLaw()
    assert law.lostInFriction == pytest.approx(losses[0], rel=1e-9, abs=1e-12)
    assert law.lostInDamping == pytest.approx(losses[1], rel=1e-9, abs=1e-12)
    touching = [i for i in O.interactions if i.geom.touches]
    assert len(touching) == len(list(O.interactions)) == pairs
    for i in touching:
        force = pressed[tuple(sorted((i.id1, i.id2)))] * (1 if i.id1 < i.id2 else -1)
        assert (i.phys.force - force).norm() < 1e-6 * max(1, force.norm())


def newton(**given):
    return NewtonIntegrator(**{**dict(damping=0, gravity=(0, 0, -G), exactAsphericalRot=True), **given})  # fmt: skip


def test_stock_engines_carry_a_block_that_falls_and_comes_to_rest(scene):
    ground()
    brick = box(middle=(0, 0, 0.02 + BRICK[2] / 2))
    prepare(loop(), newton())
    O.dt = 0.1 * O.engines[2].physDispatcher.functors[0].timeStep()
    O.run(math.ceil(0.5 / O.dt), True)
    s = O.bodies[brick].state
    (contact,) = O.interactions
    g, p = contact.geom, contact.phys
    assert contact.isReal and g.touches
    assert s.vel.norm() < 1e-9
    weight = s.mass * G
    sign = 1 if contact.id2 == brick else -1
    assert sign * p.force[2] == pytest.approx(weight, rel=1e-6)
    assert (g.normal - Vector3(0, 0, sign)).norm() < 1e-9
    assert g.area == pytest.approx(BRICK[0] * BRICK[1], rel=1e-6)
    depth = weight / (LAW["normalStiffness"] * g.area)
    assert g.depth == pytest.approx(depth, rel=1e-3)
    assert (g.contactPoint - Vector3(0, 0, 0)).norm() < 1e-5
    assert g.potential == pytest.approx(g.area * depth**2 / 2, rel=1e-3)
    law = theLaw()
    assert law.stored() == pytest.approx(p.normalStiffness * g.potential + p.stored)
    # What the block has lost of its height it has given to damping, but for what is stored.
    fallen = weight * (0.02 + BRICK[2] / 2 - s.pos[2])
    assert law.lostInDamping + law.lostInFriction + law.stored() == pytest.approx(fallen, rel=2e-3)  # fmt: skip


def test_a_contact_is_real_while_its_blocks_touch_and_is_erased_when_their_boxes_part(scene):  # fmt: skip
    one, other = box((0.1, 0.1, 0.1)), box((0.1, 0.1, 0.1), (0.12, 0, 0), TILTED)
    O.bodies[other].state.vel = Vector3(-1, 0, 0)
    prepare(loop(restitution=1), gravity=(0, 0, 0))
    O.dt = 0.2 * O.engines[2].physDispatcher.functors[0].timeStep()
    law = theLaw()
    seen = set()
    energy = None
    for _ in range(3000):
        O.step()
        known = list(O.interactions.all(onlyReal=False))
        real = [i for i in known if i.isReal]
        seen.add((len(known), len(real)))
        assert all(i.geom.touches for i in real)
    # Boxes apart; boxes overlap; blocks touch; and all of it once more in the other order.
    assert seen == {(0, 0), (1, 0), (1, 1)}
    assert len(O.interactions.all(onlyReal=False)) == 0
    assert law.stored() == 0
    energy = sum(
        0.5 * b.state.mass * b.state.vel.squaredNorm()
        + 0.5 * b.state.inertia[0] * b.state.angVel.squaredNorm()
        for b in O.bodies
    )
    assert energy + law.lostInFriction == pytest.approx(0.5 * O.bodies[one].state.mass, rel=1e-4)  # fmt: skip


def test_a_block_that_spins_in_place_is_seen_by_a_collider_with_large_boxes(scene):
    """Such a collider looks at centres only, so the box holds the block however it turns."""

    def run(distance):
        O.reset()
        box((0.3, 0.1, 0.1))
        box((0.1, 0.1, 0.1), (0.02, 0.01, 0.18), held=True)
        O.bodies[0].state.angMom = Vector3(0, 0.15, 0)  # what NewtonIntegrator goes by
        prepare(loop(), newton(gravity=(0, 0, 0)))
        O.engines[1].verletDist = distance
        O.engines[1].boundDispatcher.functors[0].anyTurn = distance > 0
        O.dt = 1e-4
        O.run(6000, True)
        return states(), O.engines[1].numAction

    expected, often = run(0)
    found, seldom = run(0.02)
    assert expected[0][7] < 1  # it was hit: 3.3 rad/s before
    assert np.abs(found - expected).max() < 1e-12
    assert seldom < 0.5 * often


@pytest.mark.parametrize("kind", [".yade.gz", ".xml"])
def test_a_saved_scene_goes_on_to_the_bit(scene, tmp_path, kind):
    """While a block slides and one lies on it: friction's memory and that of damping are in the file."""
    sliding()
    box((0.1, 0.09, 0.05), TILTED * Vector3(0, 0, BRICK[2] + 0.025), TILTED)
    prepare(loop(), newton())
    O.dt = 0.5 * O.engines[2].physDispatcher.functors[0].timeStep()
    O.engines[2].ompThreads = 1
    O.run(500, True)
    file = str(tmp_path / f"slide{kind}")
    O.save(file)
    shown = sorted((i.id1, i.id2, tuple(i.geom.contactPoint), i.geom.depth, i.phys.stored) for i in O.interactions)  # fmt: skip
    losses = theLaw().lostInFriction, theLaw().lostInDamping
    assert len(shown) == 2 and min(losses) > 0
    O.run(1500, True)
    expected = states()
    after = theLaw().lostInFriction, theLaw().lostInDamping
    O.load(file)
    assert shown == sorted((i.id1, i.id2, tuple(i.geom.contactPoint), i.geom.depth, i.phys.stored) for i in O.interactions)  # fmt: skip
    assert (theLaw().lostInFriction, theLaw().lostInDamping) == losses
    O.run(1500, True)
    assert (states() == expected).all()
    assert (theLaw().lostInFriction, theLaw().lostInDamping) == after


def test_a_checkpoint_does_not_hold_them_and_says_so(scene, tmp_path):
    resting()
    prepare(loop())
    O.dt = 1e-6
    O.step()
    with pytest.raises(ValueError, match="contacts of functors are in no checkpoint"):
        saveCheckpoint(str(tmp_path / "rest.checkpoint"))


def test_a_process_with_two_threads():
    """The next test, where it is not skipped."""
    name = "test_two_threads_change_round_off_only"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"{__file__}::{name}"]  # fmt: skip
    run = subprocess.run(command, env={**os.environ, "OMP_NUM_THREADS": "2"}, capture_output=True, text=True, timeout=60)  # fmt: skip
    assert "1 passed" in run.stdout, run.stdout


@pytest.mark.skipif(os.environ.get("OMP_NUM_THREADS") == "1", reason="needs two threads")  # fmt: skip
def test_two_threads_change_round_off_only(scene):
    """YADE adds up the forces on a body thread by thread."""
    resting()
    prepare(loop())
    O.dt = 1e-5
    O.engines[2].ompThreads = 2
    O.run(3000, True)
    expected = states()
    O.reset()
    resting()
    prepare(loop())
    O.dt = 1e-5
    O.engines[2].ompThreads = 1
    O.run(3000, True)
    assert np.abs(states() - expected).max() < 1e-11


@pytest.mark.skipif("Polyhedra" not in globals(), reason="this YADE has no Polyhedra")
@pytest.mark.parametrize("shapes", ["both", "upper"])
def test_polyhedra_of_yade_are_blocks_too(scene, shapes):
    """A Polyhedra on a Polyhedra or on a block, beside the same with blocks alone."""
    from yade import polyhedra_utils

    def run(upper, lower):
        O.reset()
        mat = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
        O.materials.append(mat)
        for n, poly in enumerate((lower, upper)):
            corners = cornersOf((0.2, 0.1, 0.1), (0.02 * n, 0, 0.1001 * n), Quaternion.Identity)  # fmt: skip
            if poly:
                body = polyhedra_utils.polyhedra(mat, v=[tuple(c) for c in corners])
                O.bodies.append(body)
            else:
                addBlock(corners, mat)
        O.bodies[0].state.blockedDOFs = "xyzXYZ"
        prepare(loop(), newton())
        O.engines[1].boundDispatcher.functors = [Bo1_MasonryBlock_Aabb(), Bo1_Polyhedra_Aabb()]  # fmt: skip
        O.engines[2].geomDispatcher.functors = [
            Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom(),
            Ig2_MasonryBlock_Polyhedra_MasonryContactGeom(),
            Ig2_Polyhedra_Polyhedra_MasonryContactGeom(),
        ]
        O.dt = 1e-5
        O.run(4000, True)
        assert len(list(O.interactions)) == 1
        return [tuple(b.state.pos) for b in O.bodies]

    expected = run(False, False)
    found = run(True, shapes == "both")
    assert np.abs(np.array(found) - expected).max() < 1e-9


# ---- what is refused ----------------------------------------------------------------------------------------------


def refused(message):
    """Within two steps, and O.engines are then those from before."""
    before = [type(e) for e in O.engines]
    with pytest.raises((ValueError, RuntimeError), match=message):
        for _ in range(2):
            O.step()
    assert [type(e) for e in O.engines] == before


def test_parameters_must_be_given(scene):
    with pytest.raises(
        ValueError, match=f"{PHYSICS}.normalStiffness 0 Pa/m must be given, above 0"
    ):
        loop(normalStiffness=0)
    with pytest.raises(
        ValueError, match=f"{PHYSICS}.friction -1 must be given, at least 0"
    ):
        loop(friction=-1)
    functor = loop()[1].physDispatcher.functors[0]
    with pytest.raises(ValueError, match="normalStiffness 0 Pa/m must be given"):
        functor.normalStiffness = 0
    with pytest.raises(ValueError, match="friction 11 must be -1 to 10"):
        Ip2_MasonryMat_MasonryMat_MasonryContactPhys(friction=11)
    with pytest.raises(ValueError, match="normalStiffness 0 Pa/m must be given"):
        Ip2_MasonryMat_MasonryMat_MasonryContactPhys().timeStep()


def test_bodies_that_the_collider_does_not_see(scene):
    resting()
    O.bodies[2].bounded = False
    prepare(loop(), newton())
    O.dt = 1e-6
    refused(r"body 2 has no bound, so InsertionSortCollider does not see it: set O.bodies\[2\].bounded = True")  # fmt: skip


def test_other_shapes_and_materials(scene):
    resting()
    prepare(loop(), newton())
    O.dt = 1e-6
    O.engines[1].boundDispatcher.functors = [Bo1_MasonryBlock_Aabb(), Bo1_Sphere_Aabb()]
    sphere = O.bodies.append(utils.sphere((0, 0, 1), 0.1))
    refused(
        f"contacts: body {sphere} has the shape Sphere, which blocks would go through"
    )
    O.bodies[sphere].bounded = False
    O.reset()
    resting()
    O.bodies[box(middle=(1, 0, 5))].material = FrictMat()
    prepare(loop(), newton())
    O.dt = 1e-6
    refused("contacts: body 4 has FrictMat, must have a MasonryMat")


def test_engines_that_do_not_go_with_them(scene):
    resting()
    O.dt = 1e-6
    prepare([*loop(), MasonryContacts(**LAW)])
    refused("MasonryContacts and the functors of contacts would both press")
    prepare([*loop(), MasonryEnergy()])
    refused("MasonryEnergy does not know contacts of functors")
    O.reset()
    resting()
    prepare(loop(), newton())
    O.dt = 1e-6
    O.periodic = True
    O.cell.setBox(100, 100, 100)
    refused("O.periodic: contacts of blocks do not reach across a periodic cell")


def test_scenes_with_joints_take_the_engine(scene, tmp_path):
    mat = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    for n in range(2):
        addBlock(cornersOf(BRICK, (0, 0, BRICK[2] * n), Quaternion.Identity), mat)
    engines([MasonryJoint(name="bed")])
    connect()
    file = str(tmp_path / "joint.yade.gz")
    O.save(file)
    O.load(file)
    prepare(loop(), newton())
    O.dt = 1e-7
    refused(
        "bodies 0 and 1 have a MasonryJointGeom, which functors of contacts do not know"
    )


def test_the_program_of_the_benchmark_prints_its_table():
    """validation/benchmark/heap.py, of two bricks that fall freely."""
    root = os.path.join(os.path.dirname(__file__), "..", "..")
    program = os.path.join(root, "validation", "benchmark", "heap.py")
    words = ["--blocks", "2", "--seconds", "0.02", "--only", "engine", "--only", "functors"]  # fmt: skip
    run = subprocess.run([sys.executable, program, *words], capture_output=True, text=True, timeout=60)  # fmt: skip
    rows = dict(
        (cells[0], cells[1:])
        for cells in (
            [c.strip() for c in line.strip("|").split("|")]
            for line in run.stdout.splitlines()
            if line.startswith("| ")
        )
    )
    assert rows["time reached, s"] == ["0.02", "0.02"], run.stderr
    # Two bricks of 3.27 kg that have fallen by 2 mm
    assert rows["potential energy lost, J"] == ["0.1", "0.1"]
