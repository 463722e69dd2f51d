# SPDX-License-Identifier: GPL-2.0-or-later
"""Inertia without a weight: motion, forces at rest, the energy balance, and scenes that add it."""

import functools
import operator

from hosted import *

# a slab of 2 cm between blocks
LEVELS = 0, 0.2, 0.4, 0.42, 0.6, 0.8
_block = lambda low, high: bricks.block((0, 0, low), (0.25, 0.1, high))
WALL = functools.reduce(operator.add, map(_block, LEVELS, LEVELS[1:]))


@PLANES
def test_a_block_falls_as_much_slower_and_keeps_its_weight(plane):
    (block,) = pile(1, inPlane=plane)
    O.bodies[block].state.blockedDOFs = "yXZ" if plane else ""
    integrator = alone(energy=True, gravity=(0, 0, -G), damping=0)
    O.dt = 1e-4
    for factor in (1, 4, 2):
        integrator.inertiaFactors = [1.0] * block + [factor]
        before = O.bodies[block].state.vel[2]
        run(100)
        assert O.bodies[block].state.vel[2] - before == approx(-G * 1e-2 / factor, rel=1e-9)
        assert imbalance() < 1e-9


def test_a_driven_block_of_added_inertia_has_its_velocity_and_the_supports_its_weight():
    ids = pile(2, inPlane=True)
    load = MasonryLoad(body=ids[1], point=O.bodies[ids[1]].state.pos, velocity=1e-3)
    load.damped = True
    join(gravity=(0, 0, -G), inPlane=True, loads=[load])
    limit = criticalTimeStep()[0]
    engine("integrator").inertiaFactors = [1, 9]
    assert criticalTimeStep()[0] == approx(3 * limit, rel=0.02)
    run(3000)
    weight = O.bodies[ids[1]].state.mass * G
    assert -O.forces.f(ids[0], True)[2] == approx(weight, rel=1e-3)
    load.driven = True
    run(50)
    assert O.bodies[ids[1]].state.vel[0] == approx(1e-3, rel=1e-9)
    assert imbalance() < 1e-6
    with raises(ValueError, match="inertiaFactors has 0.5, must be a finite number of at least 1"):
        engine("integrator").inertiaFactors = [0.5]


def settled(folder, *words):
    """A wall with a course of thin slabs that settles, and its period then."""
    scene = standing(folder, WALL, None, *words)
    scene.settle()
    scene.period()
    step, share = O.dt, scene.model.scheme.addedInertia
    scene.run(0.01)
    assert not scene.model.scheme.integrator.inertiaFactors
    run = scene.finish()
    return step, share, {one["name"]: one["value"] for one in scene.answers}


def test_a_thin_stone_sets_no_step_at_rest_and_periods_stay(tmp_path):
    true, none, period = settled(tmp_path / "true", "--added-inertia", "0")
    step, share, same = settled(tmp_path / "added")
    assert none == 0 and 0 < share < 0.0501
    assert step > 1.3 * true
    assert same["first_period"] == approx(period["first_period"], rel=1e-3)
