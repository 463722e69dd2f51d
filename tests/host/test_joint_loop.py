# SPDX-License-Identifier: GPL-2.0-or-later
"""MasonryJointLoop and MasonryIntegrator against the functors and NewtonIntegrator, which are the reference."""


from hosted import *
from masonry.assembly.engines import ROTATION


#: Properties of a joint that slips and crushes early.
EARLY = dict(compressiveStrength=1e6, peakRatio=20, compressiveFractureEnergy=3000)
EARLY.update(dilatancy=0.1, residualFriction=0.3)


def panel(
    functors,
    blocks="rigid",
    halves=True,
    turn=Quaternion.Identity,
    damping=0,
    size=4,
    rows=2,
    subcontacts=None,
    **properties,
):
    """A small panel that is pressed and torn at once, so that joints open, slip and crush within some hundred steps."""
    O.reset()
    unit, plate = unitMaterial(), unitMaterial(young=1e16, jointSet="plate")
    length, height = size * UNIT[0] / 2, size * UNIT[2]
    around = dict(inPlane=turn == Quaternion.Identity)
    turned = lambda *ends: [turn * Vector3(*c) for c in corners(*ends)]
    put = lambda low, high, mat: addBlock(turned(low, high), mat, **around)
    hold(put((0, 0, -0.1), (length, UNIT[1], 0), plate))
    wall = bricks.Wall(length, height, UNIT, halves=halves)
    laid = [put(b.low, b.high, unit) for b in wall]
    top = put((0, 0, height), (length, UNIT[1], height + 0.1), plate)
    joint = MasonryJoint(name="weak", **{**EARLY, **properties})
    zones = None
    if blocks == "deformable":
        zones = MasonryZones(bodies=laid, damping=damping, divisions=[1, 1, 1])
    load = MasonryLoad(
        body=top,
        point=turn * Vector3(0.3 * length, UNIT[1] / 3, height),
        force=turn * Vector3(0, 0, -0.6e6 * length * UNIT[1]),
        direction=turn * Vector3(1, 0.1, 0),
        driven=True,
        velocity=0.5,
    )
    joints = [MasonryJoint(name="plate", jointSet="plate", elastic=True), joint]
    around = dict(damping=damping, gravity=turn * Vector3(0, 0, -9.81), loads=[load])
    points = dict(rows=rows, subcontacts=subcontacts)
    return join(joints, zones=zones, functors=functors, **points, **around)


def state(interactions):
    """All that must agree between two runs: stresses, jumps, damages, energies and places, each over its own size."""
    columns = {
        "stress": [s for i in interactions for s in i.phys.stress],
        "jump": [j for i in interactions for j in i.geom.jumps],
        "damage": [d for i in interactions for d in i.phys.damage],
        "slip": [[s] for i in interactions for s in i.phys.slip],
        "lost": [i.phys.dissipated for i in interactions],
        "place": [b.state.pos - b.state.refPos for b in O.bodies],
        "turn": [list(b.state.ori) for b in O.bodies],
    }
    return {name: np.array([list(row) for row in c]) for name, c in columns.items()}


def agree(one, other, apart):
    """Two states are the same but for this share of the size of each of their columns."""
    for name in one:
        size = np.abs(one[name]).max()
        assert np.abs(one[name] - other[name]).max() <= apart * size, name


CASES = {
    "rigid": {},
    "rigid in space": dict(turn=IN_SPACE),
    "cyclic": dict(law="cyclic", shearStiffnessLoss=0.3),
    "cyclic in space": dict(law="cyclic", dilatancyDecay=100, turn=IN_SPACE),
    "deformable": dict(blocks="deformable"),
    "deformable, meshes that do not match": dict(blocks="deformable", halves=False),
    "deformable in space": dict(blocks="deformable", turn=IN_SPACE),
}


@pytest.mark.parametrize("case", CASES)
def test_the_loop_gives_the_functors_run(case):
    # Without damping, because damping depends on the sign of velocities that may be round-off. The differences that
    # remain start at 1e-16 and grow slowly.
    runs, balances = [], []
    for functors in (True, False):
        interactions = panel(functors, **CASES[case])
        run(400)
        runs.append(state(interactions))
        balances.append(balance())
    size = max(abs(v) for v in balances[0].values())
    for name, value in balances[0].items():
        # MasonryEnergy only predicts the angular velocity of a body that is free to turn in space. MasonryIntegrator
        # knows it.
        tolerance = 1e-4 if name == "error" else 1e-6 * size
        assert balances[1][name] == pytest.approx(value, abs=tolerance), name
    # Joints have opened, slipped and crushed.
    assert runs[0]["damage"].max(axis=0).min() > 0.01
    assert all(column.any() for column in runs[0].values())
    agree(*runs, 1e-8)


@pytest.mark.parametrize("damping", [0, 0.3])
@pytest.mark.parametrize(
    "blocked", ["", "yXZ", "xyzXYZ", "XYZ", "x"], ids=lambda b: b or "free"
)
def test_a_body_moves_as_with_the_hosts_integrator(blocked, damping):
    ends = []
    for own in (False, True):
        O.reset()
        body = addBlock(box(), unitMaterial())
        s = O.bodies[body].state
        s.blockedDOFs = blocked
        s.vel, s.angVel = Vector3(0.5, -0.1, 0.2), Vector3(0, 3, 0)
        # The host turns a body whose rotations are free by its angular momentum.
        if blocked in ("", "x"):
            s.angMom = Vector3(0.03, 0.02, -0.01)
        O.dt = 1e-3
        host = dict(kind=NewtonIntegrator, **ROTATION)
        kind = dict(dampingKind="local") if own else host
        alone(damping=damping, gravity=(0, 0, -9.81), **kind)
        for step in range(300):
            O.forces.setPermF(body, Vector3(10, 2 * step - 300, 60))
            O.forces.setPermT(body, Vector3(0.1, 0.3, -0.2))
            O.step()
        s = O.bodies[body].state
        ends.append([*s.pos, *s.vel, *s.angVel, *s.ori])
    # Where a velocity changes its sign, our damping stops at zero and the host's goes beyond zero. Each such step makes
    # a difference.
    tolerance = 2e-3 if damping else 1e-9
    assert ends[0] == pytest.approx(ends[1], rel=tolerance, abs=tolerance)
    assert np.abs(ends[0]).max() > 0.5


@pytest.mark.parametrize("kind", ["local", "combined"])
@pytest.mark.parametrize("blocked", ["", "yXZ"], ids=lambda b: b or "free")
def test_damping_takes_energy_in_every_step_whatever_the_force(blocked, kind):
    body = addBlock(box(), unitMaterial())
    O.bodies[body].state.blockedDOFs = blocked
    integrator = alone(damping=0.8, dampingKind=kind)
    O.dt = 1e-4
    dice, taken = np.random.default_rng(1), [0]
    for _ in range(1000):
        push = dice.normal(size=6) * 10 ** dice.uniform(-4, 2)
        O.forces.setPermF(body, Vector3(*push[:3]))
        O.forces.setPermT(body, Vector3(*0.05 * push[3:]))
        O.step()
        O.forces.reset(resetAll=True)
        # The second half of a step's work is counted at the beginning of the next step.
        O.step()
        taken.append(integrator.damped)
    assert np.all(np.diff(taken) >= 0) and taken[-1] > 0


@pytest.mark.parametrize("kind", ["local", "combined"])
@pytest.mark.parametrize("blocks", ["rigid", "deformable"])
def test_damping_calms_everything_up_to_the_undamped_limit_of_the_time_step(
    blocks, kind
):
    """A chain of bricks on elastic joints, thrown at random, comes to rest."""
    bricks, zones = pile(6, inPlane=True), None
    if blocks == "deformable":
        zones = MasonryZones(bodies=bricks[1:], blocked="y", dampingKind=kind)
    around = dict(damping=0.8, gravity=(0, 0, 0), inPlane=True, zones=zones)
    engines([MasonryJoint(elastic=True)], **around)
    engine("integrator").dampingKind = kind
    connect()
    O.dt = 0.98 * 1.8**0.5 * criticalTimeStep()[0]
    engine("energy").watch = False
    dice = np.random.default_rng(1)
    throw = lambda: Vector3(dice.normal(), 0, dice.normal())
    for b in [] if zones else bricks[1:]:
        O.bodies[b].state.vel = throw()
    for n in range(len(zones.masses) if zones else 0):
        zones.setVelocity(n, throw())
    O.step()
    start = balance()["kinetic"]
    O.run(5000, True)
    assert abs(balance()["kinetic"]) < 1e-6 * start


def test_joints_can_go_from_one_engine_to_the_other_in_the_middle_of_a_run():
    interactions = panel(True)
    run(400)
    whole = state(interactions)
    interactions = panel(True)
    slow = list(O.engines)
    dispatchers = slow[1].geomDispatcher, slow[1].physDispatcher
    geometry, physics = (dispatcher.functors[0] for dispatcher in dispatchers)
    fast = [slow[0], MasonryJointLoop(geometry=geometry, physics=physics), *slow[2:]]
    for turn in range(4):
        O.engines = fast if turn % 2 else slow
        run(100)
    agree(state(interactions), whole, 1e-8)


def test_a_property_changed_in_the_middle_of_a_run_is_followed():
    interactions = panel(False)
    run(100)
    joint = next(i.phys.joint for i in interactions if i.phys.joint.name == "weak")
    before = state(interactions)["slip"].max()
    smooth = "cohesion tensileStrength friction residualFriction dilatancy".split()
    joint.updateAttrs(dict.fromkeys(smooth, 0))
    run(20)
    slid = [i for i in interactions if i.phys.joint is joint]
    assert state(interactions)["slip"].max() > before
    assert max(abs(s[1]) for i in slid for s in i.phys.stress) < 1


def test_arrays_made_anew_in_every_step_change_nothing():
    """The meshes do not match, so that the places of dependent points are made anew, too."""
    runs = []
    for anew in (False, True):
        interactions = panel(False, blocks="deformable", halves=False)
        for _ in range(100):
            if anew:
                # After any new joint the plan and its arrays are made anew.
                MasonryJoint()
            O.step()
        runs.append(state(interactions))
    for name, values in runs[0].items():
        assert (values == runs[1][name]).all(), name


@pytest.mark.parametrize("blocks", ["rigid", "deformable"])
def test_a_run_is_the_same_bit_for_bit_with_any_number_of_threads(blocks):
    ends = []
    for threads in (1, 2, 3):
        allowThreads(threads, True)
        interactions = panel(False, blocks, size=12, damping=0.8)
        run(200)
        values = [column.tobytes() for column in state(interactions).values()]
        ends.append((values, balance()))
    allowThreads(1)
    assert ends[0] == ends[1] == ends[2]
