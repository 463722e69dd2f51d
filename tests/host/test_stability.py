"""Runs that cannot be trusted stop with an error; the energy balance against closed forms."""

import math

import numpy as np
import pytest
from masonry import MasonryJoint, addBlock, connect, criticalTimeStep, engines
from masonry.brickwork import corners, runningBond
from yade import O, Vector3
from yade.wrapper import *

UNIT = (0.22, 0.102, 0.081)
AREA = UNIT[0] * UNIT[1]
LIMIT = (
    r"its limit \S+ s, which (joint \"bed\" between bodies \d+ and \d+|unit \d+) sets"
)


def energy():
    return next(e for e in O.engines if isinstance(e, MasonryEnergy))


def panel(
    blocks="rigid", functors=False, size=4, young=4.8e9, rigidLast=False, **around
):
    """A small panel under its weight on a fixed course; ``rigidLast``: the last brick is rigid in any case."""
    O.reset()
    mat = MasonryMat(density=1800, young=young, poisson=0.16)
    bricks = {
        addBlock(corners(b.low, b.high), mat, inPlane=True): b
        for b in runningBond(size, size, UNIT)
    }
    fixed = [i for i, b in bricks.items() if b.course == 0]
    for body in fixed:
        O.bodies[body].state.blockedDOFs = "xyzXYZ"
    zones = None
    if blocks == "deformable":
        free = [i for i in bricks if i not in fixed][: -1 if rigidLast else None]
        zones = MasonryZones(bodies=free, blocked="y")
    engines([MasonryJoint()], inPlane=True, zones=zones, functors=functors, **around)
    connect()
    O.dt = 0.8 * criticalTimeStep()[0]
    return bricks


# -- runs that cannot be trusted --------------------------------------------------------------------------------------


@pytest.mark.parametrize("run", ["step", "run", "background"])
@pytest.mark.parametrize("functors", [False, True], ids=["loop", "functors"])
@pytest.mark.parametrize("blocks", ["rigid", "deformable"])
def test_a_time_step_above_its_limit_is_refused_and_named(scene, blocks, functors, run):
    panel(blocks, functors)
    O.run(20, True)
    there = O.iter
    O.dt = 1.3 * O.dt  # 1.04 of the limit
    with pytest.raises(
        RuntimeError, match=r"unstable: the time step is \S+ s, " + LIMIT
    ):
        if run == "step":
            O.step()
        elif run == "run":
            O.run(1000, True)
        else:
            O.run(1000)
            O.wait()
            O.step()  # YADE only prints the error of a run that nobody waited for in time
    assert O.iter == there and O.bodies[0].state.pos.norm() < 1
    O.dt = 0.99 * criticalTimeStep()[0]
    O.run(100, True)
    assert O.iter == there + 100


@pytest.mark.parametrize("dt", [0.0, math.nan, math.inf])
def test_a_time_step_that_is_none_is_refused(scene, dt):
    panel()
    O.dt = dt
    with pytest.raises(RuntimeError, match="unstable: the time step is"):
        O.step()


@pytest.mark.parametrize("blocks", ["rigid", "deformable"])
def test_the_limit_follows_joints_and_damping(scene, blocks):
    panel(blocks, damping=0, young=1e12)
    for zones in [e for e in O.engines if isinstance(e, MasonryZones)]:
        zones.damping = 0
    limit = criticalTimeStep()[0]
    O.dt = 0.99 * limit
    O.run(20, True)
    for engine in O.engines:
        if isinstance(engine, (MasonryZones, MasonryIntegrator)):
            engine.damping = 0.8
    assert criticalTimeStep()[0] == pytest.approx(limit / math.sqrt(1.8), rel=1e-6)
    with pytest.raises(RuntimeError, match="unstable: the time step is"):
        O.run(10, True)
    O.dt = 0.8 * criticalTimeStep()[0]
    O.run(20, True)
    stiff = MasonryJoint(name="bed", normalStiffness=1e14, shearStiffness=1e14)
    loop = next(e for e in O.engines if isinstance(e, MasonryJointLoop))
    for i in O.interactions:
        loop.physics.assign(i, stiff)
    with pytest.raises(RuntimeError, match="unstable: the time step is"):
        O.run(10, True)


@pytest.mark.parametrize("blocks", ["rigid", "deformable"])
def test_motion_out_of_nothing_is_seen_within_a_hundred_steps(scene, blocks):
    """A brick that loses its mass behind the engines' back."""
    rigid = max(panel(blocks, damping=0, rigidLast=True))
    O.run(20, True)
    O.bodies[rigid].state.mass /= 1000
    start = O.iter
    with pytest.raises(
        RuntimeError, match=r"unstable: motion out of nothing at step \d+.*" + LIMIT
    ):
        for _ in range(100):
            O.step()
    assert O.iter - start < 100


def test_velocities_given_by_hand_are_no_motion_out_of_nothing_once_told(scene):
    bricks = panel(damping=0, gravity=(0, 0, 0))
    for throw in range(3):
        for body in bricks:
            if bricks[body].course > 0:
                O.bodies[body].state.vel += 30**throw * Vector3(0.1, 0, 0.2)
                O.bodies[body].state.angVel = Vector3(0, 1, 0)
        if throw == 2:
            with pytest.raises(
                RuntimeError, match=r"told at once by MasonryEnergy.given"
            ):
                O.run(20, True)
            break
        if throw == 1:
            energy().given()
        O.run(400, True)
        assert abs(energy().balance()["error"]) < 1e-3


def test_numbers_that_are_not_finite_stop_the_run_and_are_named(scene):
    panel()
    O.run(20, True)
    O.bodies[9].state.vel = Vector3(math.nan, 0, 0)
    with pytest.raises(
        RuntimeError,
        match=r"numbers of body \d+ are not finite at step \d+; .*" + LIMIT,
    ):
        O.run(20, True)


def test_a_user_who_knows_better_can_go_on(scene):
    panel(damping=0)
    energy().watch = False
    O.dt = 1.01 * criticalTimeStep()[0]
    O.run(50, True)
    assert O.iter == 50


def test_a_body_without_mass_is_named(scene):
    panel()
    O.bodies[5].state.mass = 0
    with pytest.raises(ValueError, match="body 5 has no mass"):
        criticalTimeStep()
