# SPDX-License-Identifier: GPL-2.0-or-later
"""Viscous damping, proportional to mass and to the stiffness of joints, against closed forms."""

from hosted import *
from kept import records
from masonry import rayleigh
from masonry._masonry import loadScene, saveScene
from motion_cases import damped, oscillator


@mark.parametrize("ratio", [0.02, 0.1])
@mark.parametrize("kind", ["mass", "stiffness"])
@mark.parametrize("inPlane", [False, True], ids=["space", "plane"])
def test_a_block_on_a_joint_loses_amplitude_by_the_decrement(kind, ratio, inPlane):
    expected, measured = damped(kind, ratio, inPlane)
    assert measured == approx(expected, rel=0.005)
    b = balance()
    assert abs(b["error"]) < 1e-9
    assert b["damping"] == approx(b["external"], rel=0.05 if ratio == 0.1 else 1)


@mark.parametrize("blocked", ["", "xyz", "yXZ"], ids=lambda b: b or "free")
def test_a_spin_dies_away_with_mass_damping(blocked):
    s = O.bodies[addBlock(box(), unitMaterial())].state
    s.blockedDOFs = blocked
    s.angVel = Vector3(0, 3, 0)
    if blocked in ("", "xyz"):
        s.angMom = Vector3(0, 3 * s.inertia[1], 0)
        s.inertia = Vector3(s.inertia[1], s.inertia[1], s.inertia[1])
    alone(energy=True, damping=0, massDamping=5)
    O.dt = 1e-3
    run(400)
    assert s.angVel[1] == approx(3 * math.exp(-5 * O.time), rel=1e-3)
    assert imbalance() < 1e-9


def test_driven_bodies_and_prescribed_motions_keep_their_velocity():
    oscillator(blocked="xyXYZ")
    ofKind(MasonryIntegrator).massDamping = 50
    insert(MasonryLoad(body=1, direction=(0, 0, 1), driven=True, velocity=0.001))
    O.dt = 1e-6
    run(200)
    assert O.bodies[1].state.vel[2] == approx(0.001, rel=1e-12)
    O.bodies[0].state.vel = Vector3(0.5, 0, 0)
    run(20)
    assert O.bodies[0].state.vel[0] == 0.5


def test_nodes_of_deformable_units_lose_momentum_at_the_same_rate():
    body = addBlock(box(), unitMaterial())
    zones = MasonryZones(bodies=[body], damping=0)
    engines([MasonryJoint()], damping=0, gravity=(0, 0, 0), zones=zones)
    ofKind(MasonryIntegrator).massDamping = 200
    for node in range(*zones.nodesOf(body)):
        zones.setVelocity(node, Vector3(0, 0, 0.01))
    O.dt = 1e-6
    run(2000)
    expected = 0.01 * math.exp(-200 * O.time)
    assert all(v[2] == approx(expected, rel=1e-4) for v in zones.velocities)
    assert imbalance() < 1e-9


@mark.parametrize("ratio, low, high", [(0.05, 2, 20), (0.3, 0.5, 0.7), (0, 1, 3)])
def test_rayleigh_damping_has_its_ratio_at_both_frequencies(ratio, low, high):
    mass, stiffness = rayleigh(ratio, low, high)

    def share(frequency):
        """Of the critical damping 2 ω of x'' + (mass + stiffness ω²) x' + ω² x = 0."""
        omega = 2 * math.pi * frequency
        return (mass + stiffness * omega**2) / (2 * omega)

    assert share(low) == approx(ratio, rel=1e-12)
    assert share(high) == approx(ratio, rel=1e-12)
    # where both parts are the same, and their sum is least
    middle = math.sqrt(low * high)
    assert share(middle) == approx(2 * ratio * middle / (low + high), rel=1e-12)


def swing(fraction, ratio):
    """Largest displacement after many steps over that of the first one."""
    omega = oscillator()
    loop().stiffnessDamping = 2 * ratio / omega
    O.dt = fraction * criticalTimeStep()[0]
    ofKind(MasonryEnergy).watch = False
    s = O.bodies[1].state
    s.vel = Vector3(0, 0, 1e-3)
    largest = 0
    for _ in range(600):
        O.step()
        largest = max(largest, abs(s.pos[2] - s.refPos[2]))
    return largest / (1e-3 * O.dt)


@mark.parametrize("ratio", [0, 0.05, 0.5, 2])
def test_the_limit_of_the_time_step_is_sharp_with_any_stiffness_damping(ratio):
    omega = oscillator()
    loop().stiffnessDamping = 2 * ratio / omega
    limit = (math.sqrt(1 + ratio**2) - ratio) * 2 / omega
    found, *bodies = criticalTimeStep()
    assert found == approx(limit, rel=1e-9) and bodies == [0, 1]
    assert swing(0.99, ratio) < 5
    assert swing(1.01, ratio) > 1e3


def test_the_watch_knows_the_limit_with_stiffness_damping():
    omega = oscillator()
    O.dt = 0.9 * criticalTimeStep()[0]
    run(20)
    loop().stiffnessDamping = 1 / omega
    with raises(RuntimeError, match="unstable: the time step is"):
        run(20)


@mark.parametrize("inPlane", [False, True], ids=["space", "plane"])
def test_an_open_joint_transmits_nothing_and_a_pressed_dry_one_does_not_pull(inPlane):
    bond = dict(tensileStrength=0, cohesion=0)
    dry = MasonryJoint(**bond, friction=0.6, residualFriction=0.6)
    omega = oscillator(dry, blocked="xyzXYZ", inPlane=inPlane)
    loop().stiffnessDamping = 2 / omega
    O.dt = 1e-6
    s = O.bodies[1].state
    s.vel = Vector3(0, 0, -5e-3)
    run(200)
    made = O.interactions[0, 1]
    pressed = -O.forces.f(0, True)[2]
    assert pressed > 0
    s.vel = Vector3(0.01, 0, 5e-3)
    for _ in range(400):
        O.step()
        x, _, z = O.forces.f(0, True)
        law = sum(m[0] * a for m, a in zip(made.phys.stress, made.geom.areas))
        assert z <= 0 and abs(x) <= 0.6 * max(-z, -law) * (1 + 1e-9)
    assert O.forces.f(0, True) == Vector3.Zero
    b = balance()
    assert b["damping"] > 0
    # a prescribed velocity that jumps under load, as in test_stability.py
    assert abs(b["error"]) < 0.05


@mark.parametrize("through", ["checkpoint", "file"])
def test_a_damped_run_goes_on_bit_for_bit_after_saving_and_loading(tmp_path, through):
    def build():
        omega = vibrating(steps=0)
        ofKind(MasonryIntegrator).massDamping = 0.1 * omega
        O.dt = 0.5 * criticalTimeStep()[0]

    ends = []
    for interrupted in (False, True):
        build()
        run(150)
        if interrupted:
            saveAndLoad(through, str(tmp_path / "c"), build)
        ends.append(ended(150))
    assert ends[0] == ends[1]
    assert ends[0][0]["damping"] > 0 and abs(ends[0][0]["error"]) < 1e-5


def dampingStresses():
    """The stresses of damping in the state that a checkpoint keeps [Pa], three for every
    subcontact."""
    found = records(saveScene(""))
    joints = O.interactions[0, 1].geom.areas
    numbers = np.frombuffer(found["scene.joints"])
    # 14 numbers of the joint; then of each point its jump, this stress, and four numbers of impacts
    return numbers[14 : 14 + 10 * len(joints)].reshape(len(joints), 10)[:, 3:6]


def vibrating(blocked="", steps=30):
    """A block on a damped joint in the middle of its vibration; returns its circular frequency."""
    omega = oscillator(blocked=blocked, gravity=(100, 200, -1000))
    loop().stiffnessDamping = 0.1 / omega
    O.dt = 0.5 * criticalTimeStep()[0]
    run(steps)
    return omega


def ended(steps):
    run(steps)
    return balance(), [tuple(b.state.pos) for b in O.bodies]


def test_damping_that_is_switched_off_is_gone_after_the_next_step():
    """Half of the work of its last stress is done in that step, and the balance stays closed."""
    vibrating("xyXYZ")
    assert dampingStresses()[:, 0].all()
    loop().stiffnessDamping = 0
    last = balance()["damping"]
    O.step()
    assert not dampingStresses().any()
    made = O.interactions[0, 1]
    force = sum(s[0] * a for s, a in zip(made.phys.stress, made.geom.areas))
    assert O.forces.f(0, True)[2] == approx(force, rel=1e-9)
    b = balance()
    assert b["damping"] > last
    assert abs(b["error"]) < 1e-9
    O.step()
    O.step()
    assert balance()["damping"] == b["damping"]


@mark.parametrize("steps", [0, 1, 5])
def test_a_state_right_after_damping_goes_on_bit_for_bit_in_a_scene_that_ran_on(steps):
    vibrating("xyXYZ")
    loop().stiffnessDamping = 0
    saved = saveScene("")
    whole = ended(20)
    loadScene(saved)
    ended(steps)
    loadScene(saved)
    assert ended(20) == whole
