# SPDX-License-Identifier: GPL-2.0-or-later
"""Joints that are handed over to contact: blocks that tip over or slide off go on, land and come to
rest."""

from hosted import *

B, H = 0.25, 1.0  # of what stands on the ground [m]
STIFF = 1e10  # [Pa/m]


def standing(count=1, push=1.2, step=0.5, joint=dry, beside=(), **around):
    """Blocks on top of each other, on the ground, under a horizontal gravity that is `push` times
    the one that tips them."""
    O.reset()
    mat = unitMaterial(young=1e12)
    addBlock(corners((-3, -1, -0.4), (3, 1, 0)), mat)
    for i in range(count):
        addBlock(corners((0, 0, i * H / count), (B, B, (i + 1) * H / count)), mat)
    for x in beside:
        addBlock(corners((x, 0, 0), (x + B, B, H)), mat)
    hold(0)
    gravity = push * G * B / H, 0, -G
    engines([joint()], gravity=gravity, **{"damping": 0, **around})
    like = dict(normalStiffness=STIFF, tangentialRatio=0.5, friction=0.7)
    contacts = insert(MasonryContacts(takesJoints=True, **like))
    connect(allowGaps=bool(beside))
    O.dt = step * criticalTimeStep()[0]
    return contacts


def test_a_block_tips_over_lands_on_its_side_and_rests():
    contacts = standing()
    until(0.6)
    assert contacts.handed == 1 and contacts.touching() == 1
    assert imbalance() < 1e-6
    until(1.0)
    mover = ofKind(MasonryIntegrator)
    mover.gravity = (0, 0, -G)
    until(2.5)
    s = O.bodies[1].state
    assert s.pos[2] == approx(B / 2, abs=1e-6)
    assert abs((s.ori * s.refOri.conjugate()).toRotationMatrix()[2, 0]) == approx(1, abs=1e-6)
    assert s.vel.norm() < 1e-9
    weight = s.mass * G
    assert contacts.forceOf(0, 1)[2] == approx(weight, rel=1e-6)
    assert imbalance() < 0.02  # of the impact of two faces


def test_the_force_of_a_joint_goes_on_when_it_is_handed_over():
    """Force on the ground in the last step of the joint and in the first of the contact, of a block
    that does not swing."""
    contacts = standing(damping=0.3)
    while contacts.handed == 0:
        O.step()
    force = O.forces.f(0)  # of the joint, which was handed over at the end of this step
    O.step()
    after = O.forces.f(0)
    assert after[2] == approx(force[2], rel=0.02) and force[2] < 0
    assert after[0] == approx(force[0], abs=0.02 * abs(force[2]))
    now = balance()
    assert now["elastic_shear"] == now["elastic_compression"] == 0
    assert abs(now["error"]) < 1e-5
    assert now["handing"] > 0


def test_a_joint_that_is_not_due_is_not_handed_over():
    contacts = standing(push=0.5)
    until(0.2)
    assert contacts.handed == 0 and contacts.touching() == 0
    bonded = lambda: dry(
        tensileStrength=1e6, cohesion=2e6, modeIFractureEnergy=100, modeIIFractureEnergy=1000
    )
    contacts = standing(joint=bonded)
    until(0.2)
    assert contacts.handed == 0


def test_a_joint_that_turns_while_its_bond_holds_is_not_handed_over():
    tough = lambda: dry(
        tensileStrength=1e3, cohesion=2e3, modeIFractureEnergy=1e6, modeIIFractureEnergy=1e6
    )
    contacts = standing(joint=tough)
    with raises(RuntimeError, match="^collapsed: block 1 has turned by"):
        until(3)
    assert contacts.handed == 0


def test_a_bond_that_is_left_at_the_edge_a_block_turns_about_does_not_hold_it():
    """The points there stay closed, so their bond outlives all others. Before 5° it counts."""
    brittle = lambda: dry(
        tensileStrength=1e3, cohesion=1e5, modeIFractureEnergy=0.1, modeIIFractureEnergy=1e6
    )
    contacts = standing(joint=brittle)
    s = O.bodies[1].state
    while contacts.handed == 0:
        run(10)
        assert s.rot().norm() < math.radians(5.5)
    assert s.rot().norm() > math.radians(5)
    until(1.0)
    assert s.rot().norm() > math.radians(45) and imbalance() < 0.02


@mark.parametrize("axis", [0, 1], ids="xy")
def test_a_joint_slides_out_of_its_place_along_either_side(axis):
    """Handed over at 2 % of its length: without that the run would end where the block has left the
    joint."""
    slippery = lambda: dry(0.05)
    contacts = standing(push=0, joint=slippery, step=0.9)
    gravity = [0, 0, -G]
    gravity[axis] = 0.15 * G
    engine("integrator").gravity = gravity
    s = O.bodies[1].state
    while contacts.handed == 0:
        run(10)
        assert s.pos[axis] - s.refPos[axis] < 0.05 * B
    assert s.pos[axis] - s.refPos[axis] == approx(0.02 * B, rel=0.2)


def neighbours(gap):
    """Two blocks on the ground, side by side along x, without gravity; they wake when they have
    come by half the skin, 1 mm."""
    contacts = standing(push=0, beside=[B + gap])
    contacts.skin, engine("integrator").gravity, O.dt = 2e-3, (0, 0, 0), 1e-9
    run(10)
    assert contacts.touching() == 0 and len(O.interactions) == 2
    return contacts, O.bodies[1].state


def test_blocks_that_lie_in_each_other_when_one_wakes_just_touch():
    """0.2 mm, which the stress of joints around may press them together, would be 500 kN all at
    once. What comes then counts."""
    contacts, s = neighbours(1e-3)
    s.pos += Vector3(1.2e-3, 0, 0)
    run(10)
    assert contacts.forceOf(1, 2).norm() < 1e-3 * STIFF * B * H * 2e-4
    s.pos += Vector3(1e-5, 0, 0)
    run(10)
    assert contacts.forceOf(1, 2)[0] == approx(STIFF * B * H * 1e-5, rel=0.01)


def test_a_block_that_turns_in_its_place_wakes():
    """By 0.002 its edges move by a millimetre, by 0.01 they go through the gap of 0.5 mm: 1.25 mm
    along x. Its joint stays, since that is handed over at 1°."""
    contacts, s = neighbours(5e-4)
    for turn in (0.002, 0.008):
        s.ori = Quaternion(Vector3(0, 0, 1), turn) * s.ori
        run(10)
    assert contacts.handed == 0 and contacts.touching() == 1
    assert contacts.forceOf(1, 2)[0] > 0


def test_the_largest_energy_of_a_fallen_block_has_its_spin():
    contacts = standing()
    s, most = O.bodies[1].state, 0
    while O.time < 0.55:
        run(50)
        spin = s.ori.conjugate() * s.angVel
        turning = 0.5 * sum(i * w * w for i, w in zip(s.inertia, spin))
        most = max(most, 0.5 * s.mass * s.vel.squaredNorm() + turning)
    assert turning > 0.1 * most
    assert contacts.fallen()[1]["most"] == approx(most, rel=0.02)


def test_a_joint_of_a_block_without_contacts_is_not_handed_over():
    contacts = standing()
    contacts.bodies = [0]
    with raises(RuntimeError, match="^collapsed: block 1 has turned by"):
        until(2)
    assert contacts.handed == 0


def test_a_stack_that_falls_has_the_same_bits_with_threads_and_from_a_checkpoint(tmp_path):
    found = []
    for threads in (1, 2):
        contacts = standing(3)
        allowThreads(threads)
        run()
        while contacts.handed == 0:
            run(10)
        # the step after that counts what changed by it
        saveCheckpoint(str(tmp_path / "now"))
        until(1.3)
        assert contacts.handed >= 2
        found.append(bits())
    allowThreads(1)
    assert found[0] == found[1]
    contacts = standing(3)
    loadCheckpoint(str(tmp_path / "now"))
    assert contacts.handed > 0
    until(1.3)
    assert bits() == found[0]


def test_hand_over_with_functors_is_refused():
    with raises(ValueError, match="takesJoints needs MasonryJointLoop"):
        standing(functors=True)
