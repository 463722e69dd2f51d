# SPDX-License-Identifier: GPL-2.0-or-later
"""Work of a gravity that changes during a run: raised step by step, turned, and under blocks that
were moved before."""

from hosted import *
from motion_cases import gravityWork

WAYS = mark.parametrize("direction", ["rigid", "deformable", "functors"])


def stack(direction, joint=None, damping=0.5, free=(1, 2), blocked="", **around):
    """Two bricks on a fixed one: rigid, or those that are free deformable, or with YADE's own loop
    and integrator."""
    O.reset()
    for body in pile(3)[1:]:
        O.bodies[body].state.blockedDOFs = blocked
    if direction == "deformable":
        around["zones"] = MasonryZones(bodies=list(free), damping=damping)
    around = {"gravity": (0, 0, 0), **around}
    joint = joint or MasonryJoint(elastic=True)
    join(joint, damping=damping, functors=direction == "functors", **around)


@WAYS
def test_gravity_that_is_raised_step_by_step_does_half_the_work(direction):
    half, counted = gravityWork(direction)
    assert counted == approx(half, rel=2e-3)
    assert imbalance() < 1e-9


@WAYS
def test_the_balance_closes_while_gravity_turns(direction):
    stack(direction, damping=0.2, gravity=(0, 0, -G))
    turned, steps = 0.6, 3000
    for n in range(steps):
        a = turned * (n + 1) / steps
        gravity = Vector3(G * math.sin(a), 0.1 * G * a, -G * math.cos(a))
        engine("integrator").gravity = gravity
        O.step()
    b = balance()
    assert b["gravity"] > 0
    assert abs(b["error"]) < 1e-6
    if direction == "deformable":
        assert ofKind(MasonryZones).gravity == gravity


@mark.parametrize("direction", ["rigid", "functors"])
def test_blocks_moved_before_the_first_step_fall_from_where_they_are(direction):
    """connect() refuses blocks that were moved before it, so the joints are those of the
    reference."""
    dry = MasonryJoint(tensileStrength=0, cohesion=0, friction=0, residualFriction=0)
    stack(direction, dry, damping=0, gravity=(0, 0, -G))
    bodies = [O.bodies[k].state for k in (1, 2)]
    for k, s in enumerate(bodies, 1):
        s.pos += Vector3(0, 0, 0.05 * k)
    start = [s.pos[2] for s in bodies]
    run(1000)
    # The balance belongs to the beginning of the last step.
    ways = [z - s.pos[2] + O.dt * s.vel[2] for s, z in zip(bodies, start)]
    fallen, b = sum(s.mass * z for s, z in zip(bodies, ways)), balance()
    assert fallen > 0
    assert b["gravity"] == approx(G * fallen, rel=1e-9)
    assert abs(b["error"]) < 1e-9


@mark.parametrize("direction", ["rigid", "functors"])
def test_held_blocks_that_go_down_do_the_work_of_their_weight(direction):
    stack(direction, gravity=(0, 0, -G), blocked="xyzXYZ")
    O.dt, bodies = 1e-5, [O.bodies[k].state for k in range(3)]
    for state in bodies:
        state.vel = Vector3(0, 0, -0.05)
    run(500)
    # the balance belongs to the beginning of the last step
    down, b = 0.05 * (O.time - O.dt), balance()
    whole = G * sum(state.mass for state in bodies)
    assert b["gravity"] == approx(whole * down, rel=1e-9)
    # what holds them acts along the velocity, which is half a step beside the places
    half = 0.5 * 0.05 * O.dt * whole
    assert b["external"] == approx(-whole * down, abs=1.001 * half)
    for state in bodies:
        state.vel = Vector3.Zero
    run(20)
    stayed = 0.05 * 500 * O.dt  # when they stand again, their work stays
    assert balance()["gravity"] == approx(whole * stayed, rel=1e-9)


def test_deformable_units_know_one_gravity():
    stack("deformable", gravity=(0, 0, -G))
    zones = ofKind(MasonryZones)
    zones.gravity = (0, 0, -1)  # before the run the integrator's is taken over
    O.step()
    assert zones.gravity == Vector3(0, 0, -G)
    engine("integrator").gravity = (1, 0, -2)
    O.step()
    assert zones.gravity == Vector3(1, 0, -2)
    zones.gravity = (0, 0, -1)
    refused = r"MasonryZones.gravity \(0, 0, -1\) m/s² is not that of the integrator, \(1, 0, -2\)"
    refused += ".* set the gravity of the integrator alone"
    with raises(ValueError, match=refused):
        O.step()


@WAYS
@mark.parametrize("through", ["checkpoint", "file"])
def test_the_work_goes_on_after_saving_and_loading(direction, through, tmp_path):
    ends = []
    for interrupted in (False, True):
        stack(direction)
        for n in range(300):
            engine("integrator").gravity = (0, 0, -G * (n + 1) / 300)
            O.step()
        if interrupted:
            saveAndLoad(through, str(tmp_path / "c"), lambda: stack(direction))
        engine("integrator").gravity = (0.5, 0, -12)
        run(200)
        ends.append(balance())
    if through == "file" or direction == "functors":  # sums in another order
        assert ends[0] == approx(ends[1], rel=1e-9, abs=1e-12)
    else:
        assert ends[0] == ends[1]
    assert abs(ends[1]["error"]) < 1e-9


@WAYS
def test_a_load_on_a_block_that_vibrates_does_force_times_displacement(direction):
    load = MasonryLoad(body=2, force=(0, 0, -500), point=(0.11, 0.051, 3 * UNIT[2]))
    # loads act on rigid bodies, so that one unit alone is deformable
    stack(direction, damping=0, free=[1], share=0.2, loads=[load])
    for _ in range(500):
        before = O.bodies[2].state.pos[2] - O.bodies[2].state.refPos[2]
        O.step()
        b = balance()
        assert abs(b["error"]) < 1e-6  # round-off of small displacements
        assert b["external"] == approx(-500 * before, rel=1e-6, abs=1e-12)
    assert b["external"] > 1e-5
