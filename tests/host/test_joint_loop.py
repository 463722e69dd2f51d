# SPDX-License-Identifier: GPL-2.0-or-later
"""MasonryJointLoop and MasonryIntegrator against the functors and NewtonIntegrator, which are the
reference."""


from hosted import *


#: Properties of a joint that slips and crushes early.
EARLY = dict(compressiveStrength=1e6, peakRatio=20, compressiveFractureEnergy=3000)
EARLY.update(dilatancy=0.1, residualFriction=0.3)


STRAIGHT = Quaternion.Identity


def panel(functors, blocks="rigid", halves=True, turn=STRAIGHT, size=4, **how):
    """A small panel that is pressed and torn at once, so that joints open, slip and crush within
    some hundred steps. ``how``: damping and points, and properties of its joints."""
    O.reset()
    damping = how.pop("damping", 0)
    points = dict(rows=how.pop("rows", 2), subcontacts=how.pop("subcontacts", None))
    unit, plate = unitMaterial(), unitMaterial(young=1e16, jointSet="plate")
    length, height = size * UNIT[0] / 2, size * UNIT[2]
    turned = lambda *ends: [turn * Vector3(*c) for c in corners(*ends)]
    put = lambda low, high, mat: addBlock(turned(low, high), mat, inPlane=turn == STRAIGHT)
    hold(put((0, 0, -0.1), (length, UNIT[1], 0), plate))
    wall = bricks.Wall(length, height, UNIT, halves=halves)
    laid = [put(b.low, b.high, unit) for b in wall]
    top = put((0, 0, height), (length, UNIT[1], height + 0.1), plate)
    joint = MasonryJoint(name="weak", **{**EARLY, **how})
    zones = None
    if blocks == "deformable":
        zones = MasonryZones(bodies=laid, damping=damping, divisions=[1, 1, 1])
    load = MasonryLoad(body=top, driven=True, velocity=0.5)
    load.point = turn * Vector3(0.3 * length, UNIT[1] / 3, height)
    load.force = turn * Vector3(0, 0, -0.6e6 * length * UNIT[1])
    load.direction = turn * Vector3(1, 0.1, 0)
    joints = [MasonryJoint(name="plate", jointSet="plate", elastic=True), joint]
    around = dict(damping=damping, gravity=turn * Vector3(0, 0, -9.81), loads=[load])
    return join(joints, zones=zones, functors=functors, **points, **around)


def state(interactions):
    """All that must agree between two runs: stresses, jumps, damages, energies and places, each
    over its own size."""
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


@mark.parametrize("case", CASES)
def test_the_loop_gives_the_functors_run(case):
    # Without damping, because damping depends on the sign of velocities that may be round-off. The
    # differences that remain start at 1e-16 and grow slowly.
    runs, balances = [], []
    for functors in (True, False):
        interactions = panel(functors, **CASES[case])
        run(400)
        runs.append(state(interactions))
        balances.append(balance())
    size = max(abs(v) for v in balances[0].values())
    # MasonryEnergy only predicts the angular velocity of a body that is free to turn in space.
    # MasonryIntegrator knows it.
    errors = [one.pop("error") for one in balances]
    assert errors[1] == approx(errors[0], abs=1e-4)
    assert balances[1] == approx(balances[0], abs=1e-6 * size)
    # Joints have opened, slipped and crushed.
    assert runs[0]["damage"].max(axis=0).min() > 0.01
    assert all(column.any() for column in runs[0].values())
    agree(*runs, 1e-8)


@mark.parametrize("kind", ["local", "combined"])
@mark.parametrize("blocked", ["", "yXZ"], ids=lambda b: b or "free")
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


@mark.parametrize("kind", ["local", "combined"])
@BLOCKS
def test_damping_calms_all_up_to_the_undamped_time_step(blocks, kind):
    bricks, zones = pile(6, inPlane=True), None
    if blocks == "deformable":
        zones = MasonryZones(bodies=bricks[1:], blocked="y")
    around = dict(damping=0.8, dampingKind=kind, gravity=(0, 0, 0), inPlane=True)
    join(MasonryJoint(elastic=True), 0.98 * 1.8**0.5, zones=zones, **around)
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
    agree(*runs, 0)


@BLOCKS
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
