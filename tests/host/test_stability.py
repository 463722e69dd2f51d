# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs that cannot be trusted stop with an error; the energy balance against closed forms."""

from hosted import *

AREA = UNIT[0] * UNIT[1]
LIMIT = r"its limit \S+ s, which (joint \"bed\" between bodies \d+ and \d+|unit \d+) se"


def panel(blocks="rigid", young=4.8e9, rigid=0, **around):
    """A small panel under its weight on a fixed course; so many of its last bricks are rigid in any
    case. Returns its free ones."""
    O.reset()
    mat = unitMaterial(young=young)
    wall = bricks.Wall(2 * UNIT[0], 4 * UNIT[2], UNIT)
    laid = [addBlock(corners(b.low, b.high), mat, inPlane=True) for b in wall]
    first = len(wall.bottom())
    hold(*laid[:first])
    zones = None
    if blocks == "deformable":
        zones = MasonryZones(bodies=laid[first : len(laid) - rigid], blocked="y")
    join(share=0.8, inPlane=True, zones=zones, **around)
    return laid[first:]


# -- runs that cannot be trusted -------------------------------------------------------------------


@mark.parametrize("how", ["step", "run", "background"])
@FUNCTORS
@BLOCKS
def test_a_time_step_above_its_limit_is_refused_and_named(blocks, functors, how):
    panel(blocks, functors=functors)
    O.run(20, True)
    there = O.iter
    O.dt = 1.3 * O.dt  # 1.04 of the limit
    unstable = r"unstable: the time step is \S+ s, " + LIMIT
    with raises(RuntimeError, match=unstable):
        if how == "step":
            O.step()
        else:
            O.run(1000, how == "run")
            O.wait()
            # If YADE has only printed the error of the run, the next step raises it.
            O.step()
    assert O.iter == there and O.bodies[0].state.pos.norm() < 1
    O.dt = 0.99 * criticalTimeStep()[0]
    O.run(100, True)
    assert O.iter == there + 100


def test_a_testing_machine_that_sets_the_limit_is_named():
    upper = O.bodies[pile()[1]].state
    join()
    drive = dict(force=(0, 0, -1e3), direction=(0, 0, -1), stiffness=1e13)
    insert(MasonryLoad(body=1, point=upper.pos, engaged=True, **drive))
    with raises(RuntimeError, match="which the testing machine at body 1 sets"):
        run(200)


@FUNCTORS
@BLOCKS
def test_the_limit_follows_joints_and_damping(blocks, functors):
    """A run finds it by itself, without a question for the limit."""
    panel(blocks, functors=functors, damping=0, young=1e12)
    for zones in [e for e in O.engines if isinstance(e, MasonryZones)]:
        zones.damping = 0
    limit = criticalTimeStep()[0]
    O.dt = 0.99 * limit
    O.run(20, True)
    for damped in filter(None, (engine("integrator"), ofKind(MasonryZones))):
        damped.damping = 0.8
    with raises(RuntimeError, match="unstable: the time step is"):
        run(20)
    assert criticalTimeStep()[0] == approx(limit / math.sqrt(1.8), rel=1e-6)
    O.dt = 0.8 * criticalTimeStep()[0]
    O.run(20, True)
    stiff = MasonryJoint(name="bed", normalStiffness=1e14, shearStiffness=1e14)
    loop = O.engines[1]
    physics = loop.physDispatcher.functors[0] if functors else loop.physics
    for i in O.interactions:
        physics.assign(i, stiff)
    with raises(RuntimeError, match="unstable: the time step is"):
        run(10)


@BLOCKS
def test_motion_out_of_nothing_is_seen_within_a_hundred_steps(blocks):
    """A brick whose mass a script divides by 1000 in the middle of a run. No engine is informed of
    that."""
    rigid = max(panel(blocks, damping=0, rigid=1))
    O.run(20, True)
    O.bodies[rigid].state.mass /= 1000
    start, nothing = O.iter, r"unstable: motion out of nothing at step \d+.*" + LIMIT
    with raises(RuntimeError, match=nothing):
        run(100)
    assert O.iter - start < 100


def test_velocities_given_by_hand_are_no_motion_out_of_nothing_once_reported():
    free = panel(damping=0, gravity=(0, 0, 0))
    for throw in range(3):
        for body in free:
            O.bodies[body].state.vel += 30**throw * Vector3(0.1, 0, 0.2)
            O.bodies[body].state.angVel = Vector3(0, 1, 0)
        if throw == 2:
            with raises(RuntimeError, match="at once by MasonryEnergy.given"):
                run(20)
            break
        if throw == 1:
            energy().given()
        O.run(400, True)
        assert imbalance() < 1e-3


@FUNCTORS
@mark.parametrize("blocked", ["", "Y"], ids=lambda b: b or "free")
def test_a_spin_that_is_given_is_work_of_half_its_inertia_about_the_own_axes(functors, blocked):
    """A plate that stands askew: about its own axes the inertia differs by twenty times. YADE turns
    one that is held about an axis about the global ones."""
    plate = O.bodies[addBlock(box((1, 0, 0), (0.4, 0.3, 0.02), IN_SPACE), unitMaterial())].state
    pile()
    engines([MasonryJoint(elastic=True)], damping=0, gravity=(0, 0, 0), functors=functors)
    connect()
    plate.blockedDOFs = blocked
    run(10)
    velocity = Vector3(1, 0, 3)
    spin(plate, velocity)
    energy().given()
    axes = Quaternion.Identity if blocked else plate.ori.conjugate()
    expected = 0.5 * sum(i * w**2 for i, w in zip(plate.inertia, axes * velocity))
    assert balance()["external"] == approx(expected, rel=1e-12)
    run(500)
    assert imbalance() < 1e-3


def test_numbers_that_are_not_finite_stop_the_run_and_are_named():
    panel()
    O.run(20, True)
    O.bodies[9].state.vel = Vector3(math.nan, 0, 0)
    named = r"numbers of body \d+ are not finite at step \d+; .*its limit \S+ s$"
    with raises(RuntimeError, match=named):
        run(20)


def test_a_user_who_knows_better_can_go_on():
    panel(damping=0)
    energy().watch = False
    O.dt = 1.01 * criticalTimeStep()[0]
    O.run(50, True)
    assert O.iter == 50


# -- the energy balance against closed forms -------------------------------------------------------


def pair(joint, functors, damping=0.0):
    """A fixed brick, and one on it whose motion is prescribed, except in directions that a test
    sets free."""
    hold(pile()[1])
    (made,) = join(joint, damping=damping, gravity=(0, 0, 0), functors=functors)
    O.dt = 1e-5
    return made.phys


def move(distance, direction, steps=4000):
    O.bodies[1].state.vel = distance / (steps * O.dt) * Vector3(*direction)
    O.run(steps, True)
    O.bodies[1].state.vel = Vector3.Zero
    O.run(2, True)  # the work of a step is complete when the next begins


def perArea(**expected):
    """Compare the energies over the joint's area [J/m²] with the expected ones; all that are not
    given must be zero."""
    b = balance()
    size = max(expected.values())
    # where a prescribed velocity jumps under load, half of a step's work is not counted
    assert abs(b.pop("error")) < 1e-3
    for name, value in b.items():
        there = approx(expected.get(name, 0), rel=5e-3, abs=1e-4 * size)
        assert value / AREA == there, name


@FUNCTORS
def test_an_elastic_joint_stores_half_of_stiffness_times_jump_squared(functors):
    phys = pair(MasonryJoint(elastic=True), functors)
    kn, ks = phys.normalStiffness, phys.shearStiffness
    move(2e-6, (0, 0, 1))
    perArea(external=0.5 * kn * 4e-12, elastic_tension=0.5 * kn * 4e-12)
    move(-5e-6, (0, 0, 1))  # to 3 µm of closure
    perArea(external=0.5 * kn * 9e-12, elastic_compression=0.5 * kn * 9e-12)
    move(4e-6, (0.6, 0.8, 0))
    stored = dict(elastic_compression=0.5 * kn * 9e-12, elastic_shear=0.5 * ks * 16e-12)
    perArea(external=sum(stored.values()), **stored)
    move(-4e-6, (0.6, 0.8, 0))
    move(3e-6, (0, 0, 1))
    # the error is relative to the largest work, also where all of it has come back
    assert imbalance() < 1e-3


def test_round_off_is_no_error_where_no_work_is_done():
    panel(gravity=(0, 0, 0))
    for n in range(20):
        O.bodies[0].state.vel = Vector3(1, 0, 1) * (-1) ** n * 1e-13
        run(1)
    assert imbalance() < 1e-6


@FUNCTORS
def test_a_joint_torn_open_dissipates_its_fracture_energy(functors):
    pair(MasonryJoint(), functors)
    move(4e-3, (0, 0, 1), 20000)
    # the bricks in series give back what they stored (law/README.md, rigid units)
    perArea(external=16, dissipated_tension=16)


@FUNCTORS
@mark.parametrize("pressure", [0.0, 0.5e6])
def test_a_sliding_joint_dissipates_its_energy_and_friction(functors, pressure):
    joint = MasonryJoint()
    phys = pair(joint, functors)
    move(-pressure / phys.normalStiffness, (0, 0, 1))
    pressed = 0.5 * pressure**2 / phys.normalStiffness
    slide = 60e-3
    move(slide, (1, 0, 0), 60000)
    peak, friction = 0.11e6 + 0.43 * pressure, 0.43 * pressure
    # An elastic triangle to the peak, an exponential above friction whose length grows with the
    # peak, and friction (law/README.md, softening). The bricks in series store energy, and give
    # back all but what friction holds.
    elastic = peak / joint.shearStiffness
    length = joint.shearStiffness * 160 / 0.11e6**2 - 0.5  # over the elastic slide
    kept = 0.5 * friction**2 / phys.shearStiffness
    slip = slide - friction / phys.shearStiffness + friction / joint.shearStiffness
    work = 0.5 * peak * elastic + (peak - friction) * length * elastic
    work += friction * (slip - elastic)  # of the joint without bricks
    lost = work - 0.5 * friction**2 / joint.shearStiffness
    stored = dict(elastic_shear=kept, elastic_compression=pressed)
    perArea(external=pressed + lost + kept, dissipated_shear=lost, **stored)


@FUNCTORS
def test_a_joint_crushed_to_its_peak_dissipates_what_lies_under_its_curve(functors):
    joint = MasonryJoint()
    phys = pair(joint, functors)
    fcp, fel = joint.compressiveStrength, 0.3 * joint.compressiveStrength
    bricks = 1 / phys.normalStiffness - 1 / joint.normalStiffness
    elastic = fel / joint.normalStiffness
    peak = joint.peakRatio * fcp / joint.normalStiffness
    move(-(peak + fcp * bricks), (0, 0, 1), 20000)
    # a quarter of an ellipse from the elastic limit to the peak (law/README.md, compression), and
    # what bricks store
    work = 0.5 * fel * elastic + (peak - elastic) * (fel + (fcp - fel) * math.pi / 4)
    work += 0.5 * fcp**2 * bricks
    kept = 0.5 * fcp**2 / phys.normalStiffness
    perArea(external=work, dissipated_compression=work - kept, elastic_compression=kept)
