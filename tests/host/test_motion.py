# SPDX-License-Identifier: GPL-2.0-or-later
"""Damping, drives, prescribed places and neighbours of another kind, against numbers that follow by
hand."""

from hosted import *
from masonry._masonry import loadScene, saveScene
from yade.utils import sphere

# -- damping ---------------------------------------------------------------------------------------

#: For a motion along the force: the force over that of the first step, and what damping takes of it
#: over alpha times its size. Local damping takes all of that. Combined damping takes nothing while
#: the force grows, half of it while the force is steady, and all of it while the force falls.
HISTORY = {
    "local": [(1, 1), (2, 1), (2, 1), (1.5, 1), (0.5, 1)],
    "combined": [(1, 0), (2, 0), (2, 0.5), (1.5, 1), (0.5, 1)],
}
ALPHA, DT = 0.3, 1e-4


@mark.parametrize("kind", HISTORY)
@mark.parametrize("blocked", ["", "yXZ"], ids=lambda b: b or "free")
def test_damping_takes_its_share_of_force_and_torque(blocked, kind):
    s = O.bodies[addBlock(box(), unitMaterial())].state
    s.blockedDOFs = blocked
    inertia = s.inertia[1]
    # A block whose rotations are free is turned by its angular momentum.
    if not blocked:
        s.inertia, s.angMom = Vector3(1, 1, 1) * inertia, Vector3(0, 5 * inertia, 0)
    s.vel, s.angVel = Vector3(5, 0, 5), Vector3(0, 5, 0)
    alone(damping=ALPHA, dampingKind=kind)
    O.dt = DT
    velocity = turning = 5.0
    for share, taken in HISTORY[kind]:
        O.forces.setPermF(0, share * Vector3(10, 0, 10))
        O.forces.setPermT(0, Vector3(0, share * 0.1, 0))
        O.step()
        gain = DT * share * (1 - ALPHA * taken)
        velocity, turning = velocity + 10 * gain / s.mass, turning + 0.1 * gain / inertia
        assert (s.vel - Vector3(velocity, 0, velocity)).norm() < 1e-13 * velocity
        assert (s.angVel - Vector3(0, turning, 0)).norm() < 1e-12 * turning


def stack(count=4, **around):
    """Bricks on each other, the lowest fixed."""
    pile(count, inPlane=True)
    join(MasonryJoint(elastic=True), 0.8, inPlane=True, **around)


# -- drives ----------------------------------------------------------------------------------------


@mark.parametrize("blocked", ["", "XYZ", "yXZ"], ids=lambda b: b or "free")
@mark.parametrize("sign", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, 0, 3)])
def test_a_drive_meets_its_velocity_in_every_step(sign, blocked):
    stack(count=2, damping=0.5)
    s = O.bodies[1].state
    s.blockedDOFs = blocked
    corner = Vector3(0.2, 0.051, 0.16)
    direction = Vector3(*sign)
    driven = dict(direction=direction, driven=True, velocity=0.003)
    load = insert(MasonryLoad(body=1, point=corner, **driven))
    O.dt = 0.3 * criticalTimeStep()[0]
    load.ramp, load.acceleration = 50, 0.003 / (50 * O.dt)  # from rest on
    for step in range(1, 201):
        arm = s.ori * s.refOri.conjugate() * (corner - s.refPos)
        O.step()
        moving = s.vel + s.angVel.cross(arm)
        expected = 0.003 * min(1, step / 50)
        assert moving.dot(direction.normalized()) == approx(expected, rel=1e-5)
    assert imbalance() < 1e-6


def test_a_drive_in_a_pattern_moves_the_mean_of_its_points_with_forces_in_proportion():
    stack(count=3, damping=0.5)
    corners = {1: Vector3(0.2, 0.051, 0.16), 2: Vector3(0.1, 0.02, 0.3)}
    shares, direction = (0.25, 0.75), Vector3(1, 0, 2).normalized()
    states = [O.bodies[body].state for body in corners]
    driven = dict(direction=direction, driven=True, velocity=0.003)
    load = insert(
        MasonryLoad(
            body=1, point=corners[1], others=[2], otherPoints=[corners[2]], shares=shares, **driven
        )
    )
    O.dt = 0.3 * criticalTimeStep()[0]
    for step in range(200):
        arms = [
            s.ori * s.refOri.conjugate() * (corner - s.refPos)
            for s, corner in zip(states, corners.values())
        ]
        O.step()
        speeds = [(s.vel + s.angVel.cross(a)).dot(direction) for s, a in zip(states, arms)]
        assert np.dot(shares, speeds) == approx(0.003, rel=1e-5)
    assert speeds[0] != approx(speeds[1], rel=0.1)
    assert imbalance() < 1e-6


def test_a_pattern_of_a_drive_that_does_not_fit_is_refused():
    point = dict(point=(0, 0, 0), otherPoints=[(0, 0, 0)])
    with raises(ValueError, match="shares must be 1 in sum"):
        MasonryLoad(body=1, others=[2], shares=[0.5, 0.6], **point)
    with raises(ValueError, match="must have a number of each other body"):
        MasonryLoad(body=1, others=[2], shares=[1.0], **point)
    with raises(ValueError, match="must be different bodies"):
        MasonryLoad(body=1, others=[1], shares=[0.5, 0.5], **point)


def test_a_drive_at_rest_carries_the_weight_and_what_pushes():
    stack(count=2)
    O.bodies[1].state.blockedDOFs = "XYZ"
    held = dict(direction=(0, 0, 1), driven=True, velocity=0, force=(0, 0, -50))
    load = insert(MasonryLoad(body=1, point=O.bodies[1].state.pos, **held))
    for gravity in (-9.81, -20, 5, 0):
        O.engines[-1].gravity = (0, 0, gravity)
        O.step()
        weight = O.bodies[1].state.mass * gravity
        assert load.reaction == approx(50 - weight, rel=1e-9)
        assert O.forces.f(1, True)[2] == approx(-weight, abs=1e-7)


#: A machine that loads with 1 kN: friction [-], stiffness [N/m], where its point moves [mm];
#: what it adds there [N], and what its friction has dissipated [J], which slips after 0.02 mm.
MACHINES = {
    "a dead load": (0.0, 0.0, [2, -1], 0, 0),
    "follows uplift": (0.0, 2e5, [2, 1.5], 300, 0),
    "is kept back as it rises": (0.1, 0.0, [2], 100, 0.1 * (2 - 0.02)),
    "is kept back as it sinks": (0.1, 0.0, [2, 1], -100, 0.1 * (3 - 0.06)),
    "sticks": (0.1, 0.0, [2, 1.99], 50, 0.1 * (2 - 0.02)),
    "both": (0.1, 2e5, [2, 1], 200 - 120, None),
    "never pulls": (0.1, 2e5, [2, -6], -1000, None),
}


@mark.parametrize("case", MACHINES)
def test_the_load_of_a_testing_machine(case):
    friction, stiffness, path, added, lost = MACHINES[case]
    stack(count=2)
    upper = O.bodies[1].state
    upper.blockedDOFs = "xyzXYZ"
    load = insert(
        MasonryLoad(
            body=1,
            point=upper.pos,
            force=(0, 0, -1e3),
            direction=(0, 0, -1),
            friction=friction,
            stiffness=stiffness,
            guideStiffness=friction * 1e3 / 2e-5,
            engaged=friction + stiffness > 0,
        )
    )
    O.dt = 1e-4
    for a, b in zip([0, *path], path):
        upper.vel = Vector3(0, 0, (b - a) / 400 / O.dt / 1e3)
        run(400)
    upper.vel = Vector3.Zero
    run(2)
    assert load.reaction == approx(added, abs=1e-6)
    assert load.dissipated == approx(load.dissipated if lost is None else lost, abs=1e-9)
    assert load.elastic >= 0


def test_a_testing_machine_that_does_not_fit_is_refused():
    for wrong, of in (
        ("friction needs a guideStiffness", dict(friction=0.1)),
        ("no drive", dict(stiffness=1e5, driven=True)),
        ("has stiffness or friction", dict(engaged=True)),
        ("friction 1 must be .* below 1", dict(friction=1, guideStiffness=1e5)),
    ):
        with raises(ValueError, match=wrong):
            MasonryLoad(**of)


def test_gravity_that_is_set_during_a_record_acts_beside_it():
    stack(count=2)
    mover = ofKind(MasonryIntegrator)
    mover.shake([0.0, 2.0, 2.0, 2.0], [Vector3.UnitX], 1.0, 1.0)
    O.dt = 1e-5
    run(2)
    mover.gravity = (0, 0, -5)
    run(2)
    assert mover.gravity == approx((-2 * 3.5 * O.dt, 0, -5))  # in the middle of the fourth step
    mover.shake([], [], 1.0, 1.0)
    assert mover.gravity == (0, 0, -5)


def test_a_load_that_is_dead_does_no_work():
    stack(count=2, damping=0.1)
    where = O.bodies[1].state.pos
    load = insert(MasonryLoad(body=1, point=where, force=(100, 0, -500)))
    run(50)
    assert load.work != 0
    load.dead = True
    run(1)  # the other half of the last step's work
    work = load.work
    run(50)
    assert load.work == work


@PLANES
def test_a_motion_that_a_script_changes_at_every_step_does_its_work(plane):
    """The work of a step is done with the velocity of that step, also if the next one has another,
    or several ones while bodies are added and states are loaded."""
    stack(count=2, damping=0.1)
    base, dice = O.bodies[0].state, random.Random(3)
    if not plane:
        O.bodies[1].state.blockedDOFs = ""
    run(1)
    for step in range(300):
        if step % 50 == 25:
            state = saveScene("null")
            base.vel = 2 * base.vel
            run(2)
            loadScene(state)
        base.vel = Vector3(dice.uniform(-1, 1), 0, dice.uniform(-1, 1)) * 1e-3
        base.angVel = Vector3(0, dice.uniform(-1, 1) * 1e-2, 0)
        if step % 50 == 0:
            other = O.bodies.append(sphere((5, 0, step), 0.1, fixed=True))
            O.bodies[other].state.vel = Vector3(0, 0, 1e-3)
            criticalTimeStep()
            base.vel = -base.vel
        run(1)
    assert abs(balance()["external"]) > 1e-4
    assert imbalance() < 1e-6


# -- joints that are nearly alike ------------------------------------------------------------------

#: The property of which the last of seventy couplets has one per cent more. Its joint is in another
#: batch than the first ones.
UNLIKE = {
    "stiffness": dict(young=4.8e9 * 1.01),
    "length": dict(size=(UNIT[0] * 1.01, *UNIT[1:])),
    "thickness": dict(size=(UNIT[0], UNIT[1] * 1.01, UNIT[2])),
    "height": dict(size=(*UNIT[:2], UNIT[2] * 1.01)),
}


def couplets(other, functors, turn):
    """Seventy separate couplets, of which the last differs a little. Every upper brick gets a
    velocity."""
    O.reset()
    dice = np.random.default_rng(5)
    for number in range(70):
        about = UNLIKE[other] if number == 69 else {}
        mat = unitMaterial(young=about.get("young", 4.8e9))
        around = dict(turn=turn, material=mat, inPlane=turn == Quaternion.Identity)
        ids = pile(2, 0.25 * number, about.get("size", UNIT), **around)
        s, sign = O.bodies[ids[1]].state, dice.normal(size=3) * 1e-3
        s.vel = turn * Vector3(sign[0], 0, sign[1])
        spin(s, turn * Vector3(0, 5 * sign[2], 0))
    rows = 2 if turn == IN_SPACE else 1
    around = dict(damping=0, gravity=turn * Vector3(0, 0, -9.81), rows=rows)
    around.update(inPlane=turn == Quaternion.Identity, functors=functors)
    made = join(MasonryJoint(elastic=True), **around)
    O.dt = 2e-5
    run(30)
    return made


@mark.parametrize("turn", [Quaternion.Identity, IN_SPACE], ids=["plane", "space"])
@mark.parametrize("other", UNLIKE)
def test_one_couplet_of_seventy_that_is_other_keeps_its_numbers(other, turn):
    ends = []
    for functors in (True, False):
        joints = couplets(other, functors, turn)
        stress = [s for i in joints for s in i.phys.stress]
        push = [O.forces.f(b.id, True) for b in O.bodies]
        turned = [O.forces.t(b.id, True) for b in O.bodies]
        there = [b.state.pos for b in O.bodies]
        ends.append([np.array(v) for v in (stress, push, turned, there)])
        # Elastic: the stress is the jump times the joint's own stiffness.
        for i in joints:
            stiffness = i.phys.normalStiffness, i.phys.shearStiffness
            expected = np.array(i.geom.jumps)[:, :2] * stiffness
            found = np.array(i.phys.stress)[:, :2]
            assert np.allclose(found, expected, rtol=1e-9, atol=1e-3)
    # The round-off of places 17 m from the origin is 2e-15 m. Times the stiffness that is 1e-4 of
    # stresses of some 1e3 Pa.
    for one, same in zip(*ends):
        assert np.abs(one - same).max() < 1e-6 * np.abs(one).max()


# -- joints that go, and units that differ ---------------------------------------------------------


@FUNCTORS
def test_a_block_whose_joint_is_erased_in_the_middle_of_a_run_falls_freely(functors):
    stack(count=3, damping=0, functors=functors)
    run(50)
    O.interactions.erase(1, 2)
    # Until now YADE has only noted that the interaction is to be erased.
    O.interactions.eraseNonReal()
    before = O.bodies[2].state.vel[2]
    run(100)
    fall = O.bodies[2].state.vel[2] - before
    assert fall == approx(-9.81 * 100 * O.dt, rel=1e-9)


def test_deformable_units_of_one_shape_and_two_materials_have_their_own_numbers():
    dense = unitMaterial(density=2400, young=9.6e9)
    units = [addBlock(box((k, 0, 0)), unitMaterial() if k else dense) for k in (0, 1)]
    zones = MasonryZones(bodies=units)
    volume = UNIT[0] * UNIT[1] * UNIT[2]
    for unit, density in zip(units, (2400, 1800)):
        mass = sum(zones.masses[n] for n in range(*zones.nodesOf(unit)))
        assert mass == approx(density * volume, rel=1e-9)
