# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of joints that close: what a block that rocks keeps, and that they take energy and never
give any."""

from hosted import *
from motion_cases import restitution
from structures import box, dry, fix, mat

B, H = 0.25, 1.0  # of a stack [m]


def stack(count=3, inPlane=False, law="softening", restitution=0.0, step=0.5):
    O.reset()
    fix(box((-1, -1, -0.2), (2 + B, 2 + B, 0.2), mat()))
    for k in range(count):
        box((0, 0, k * H / count), (B, B, H / count), mat(), inPlane=inPlane)
    engines([dry(1e9, law=law, restitution=restitution)], damping=0)
    connect()
    loop().impacts = True
    O.dt = step * criticalTimeStep()[0]


def shake(seconds, seed=1):
    """Gravity that jumps about, so that blocks rock, hop and slide."""
    dice = random.Random(seed)
    for _ in range(round(seconds / 0.05)):
        aside = [dice.uniform(-5, 5), 0 if isPlane() else dice.uniform(-5, 5)]
        engine("integrator").gravity = Vector3(*aside, -9.81)
        run(round(0.05 / O.dt))


def isPlane():
    return "y" in O.bodies[1].state.blockedDOFs


def untilImpact():
    taken = loop().impactWork
    while loop().impactWork == taken:
        O.step()


CASES = {
    "plane": dict(inPlane=True),
    "space": {},
    "cyclic": dict(law="cyclic"),
    "cyclic in the plane": dict(law="cyclic", inPlane=True),
    "half": dict(restitution=0.5),
}


@mark.parametrize("size", [(0.25, 0.5), (0.25, 1.0), (0.25, 2.0)], ids=str)
def test_a_block_that_rocks_keeps_what_that_of_housner_keeps(size):
    for points, least, most in ((3, -0.005, 0.015), (8, -0.005, 0.07)):
        rigid, kept = restitution(size, restitution=0, points=points)
        assert least < kept - rigid < most, points
    now = balance()
    assert now["impacts"] > 0 and abs(now["error"]) < 1e-4


@mark.parametrize("share", [0.0, 0.3, 0.6, 1.0])
def test_a_block_that_lands_on_its_face_leaves_with_its_restitution(share):
    step, speed = 0.02, 0.1  # of the largest; [m/s]
    stack(count=1, restitution=share, step=step)
    engine("integrator").gravity = (0, 0, 0)
    state = O.bodies[1].state
    state.pos += Vector3(0, 0, 1e-6)
    state.vel = Vector3(0, 0, -speed)
    ofKind(MasonryEnergy).given()
    O.run(2000, True)
    # in the step in which they meet the joint takes a little up, and gives it back
    assert state.vel[2] == approx(speed * share, abs=step * speed)
    assert imbalance() < 1e-3


@mark.parametrize("slides", [-1, 1])  # [m/s]
def test_an_edge_that_lands_while_it_slides_is_not_thrown_up(slides):
    step, speed, turn = 0.01, 0.1, Quaternion(Vector3.UnitY, 0.01)
    stack(count=1, step=step)
    engine("integrator").gravity = (0, 0, 0)
    state = O.bodies[1].state
    edge = turn * Vector3(B / 2, 0, -H / 2)
    state.ori, state.pos = turn, Vector3(B / 2, B / 2, 1e-4 - edge[2])
    state.vel = Vector3(slides, 0, -speed)
    ofKind(MasonryEnergy).given()
    untilImpact()
    O.run(20, True)
    # the joint takes a little up beside the impulses
    assert (state.vel + state.angVel.cross(edge))[2] == approx(0, abs=0.05 * speed)
    assert imbalance() < 1e-3


@mark.parametrize("case", CASES)
@mark.parametrize("step", [pytest.param(0.1, marks=mark.slow), 0.4, 0.8])
def test_impacts_never_give_energy(case, step):
    for seed in range(3):
        stack(step=step, **CASES[case])
        most = fallen = 0
        # in space, blocks that turn far have an error of the balance without impacts, too
        for part in range(20 if isPlane() else 10):
            shake(0.05, seed + 10 * part)
            now = loop().impactWork
            fallen, most = max(fallen, most - now), max(most, now)
        now = balance()
        assert most > 0.2 and fallen < 0.01 * most
        assert abs(now["error"]) < 3e-3


@mark.parametrize("case", CASES)
def test_threads_and_a_checkpoint_change_no_bit(case, tmp_path):
    found = []
    for threads in (1, 2):
        allowThreads(threads)
        stack(**CASES[case])
        shake(0.5)
        untilImpact()
        saveCheckpoint(str(tmp_path / "now"))
        shake(0.2)
        found.append(bits())
    allowThreads(1)
    assert found[0] == found[1]
    stack(**CASES[case])
    loadCheckpoint(str(tmp_path / "now"))
    shake(0.2)
    assert bits() == found[0]


def test_what_is_pressed_or_bonded_has_no_impacts():
    bonds = dict(
        tensileStrength=5e6, cohesion=1e7, modeIFractureEnergy=1e4, modeIIFractureEnergy=1e5
    )
    for joint, speed in ((dry(1e9), 0.002), (MasonryJoint(cap=False, **bonds), 0.3)):
        O.reset()
        fix(box((-1, 0, -0.2), (2 + B, B, 0.2), mat()))
        block = box((0, 0, 0), (B, B, H), mat(), inPlane=True)
        engines([joint], damping=0.8)
        connect()
        O.dt = 0.5 * criticalTimeStep()[0]
        run(500)
        engine("integrator").damping, loop().impacts = 0, True
        O.bodies[block].state.vel = Vector3(0, 0, -speed)
        engine("energy").given()
        run(1000)
        now = balance()
        assert now["impacts"] == 0
        assert now["external"] > 0  # the motion that was given


def test_without_impacts_nothing_is_taken_and_the_last_half_is_counted():
    stack()
    shake(0.3, seed=2)
    untilImpact()
    taken = loop().impactWork
    loop().impacts = False
    O.step()
    assert loop().impactWork != taken
    taken = loop().impactWork
    shake(0.5)
    assert loop().impactWork == taken
    assert imbalance() < 1e-3
