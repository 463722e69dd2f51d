# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of natural stone fill their rectangle with convex stones, and interlock as they are asked
to."""

from usual import *
from masonry import bricks
from masonry.bricks.stones.stone_wall import (
    LEAST,
    SHORTEST,
    _joints,
)

patterns = mark.parametrize("pattern", ["squared", "irregular"])
lengths = some.floats(0.8, 2.5)
sizes = some.floats(0.15, 0.4)


@given(
    pattern=some.sampled_from(["squared", "irregular"]),
    length=lengths,
    height=lengths,
    unit=some.tuples(sizes, some.just(0.3), sizes),
    scatter=some.floats(0, 0.4),
    seed=some.integers(0, 1000),
)
@settings(max_examples=60, deadline=None)
def test_stones_fill_the_wall_and_touch(pattern, length, height, unit, scatter, seed):
    wall = bricks.StoneWall(length, height, unit, pattern, scatter, seed=seed)
    assert wall.volume == approx(length * height * unit[1], rel=1e-9)
    assert wall.low == approx((0, 0, 0), abs=1e-12)
    assert wall.high == approx((length, unit[1], height), rel=1e-12)
    assert not [p for p in wall.problems() if "odd size" not in p]
    assert bricks.leastTrace(wall) >= 1 - 1e-9


@patterns
def test_a_seed_is_a_wall(pattern):
    wall = lambda **how: list(bricks.StoneWall(1.2, 1.2, (0.2, 0.3, 0.15), pattern, **how))
    assert wall() == wall(seed=1, scatter=0.2) != wall(seed=2)


@mark.parametrize("seed", range(3))
def test_joints_of_irregular_stones_are_long_and_level_at_the_ends(seed):
    wall = bricks.StoneWall(1.5, 1.2, (0.3, 0.2, 0.1), "irregular", 0.2, seed=seed)
    for one, two in _joints(wall):
        along = abs(two - one) / (0.3, 0.1)
        assert np.hypot(*along) > LEAST
        if min(one[0], two[0]) < 1e-9 or max(one[0], two[0]) > wall.length - 1e-9:
            assert along[1] < LEAST / 2  # where a short side beside it was closed


def test_head_joints_scatter_to_both_sides_and_overlap_or_lie_in_line():
    scatter, count = 0.3, 60
    wall = bricks.StoneWall(count, 4, (1, 1, 1), scatter=scatter)
    ends = [np.array([b.low[0] for b in wall if b.course == n] + [count]) for n in range(4)]
    moved = ends[0][1:-1] - np.arange(1, count)
    assert -scatter < min(moved) < -0.9 * scatter and 0.9 * scatter < max(moved) < scatter
    for below, above in zip(ends, ends[1:]):
        assert min(np.diff(above)) > SHORTEST - 1e-9
        apart = abs(np.subtract.outer(below, above))
        assert apart[apart > 1e-9].min() > LEAST - 1e-9


def test_the_trace_of_other_walls():
    stack = bricks.Wall(1.0, 1.0, unit=(0.25, 0.2, 0.1), bond="stack")
    assert bricks.leastTrace(stack) == approx(1)
    assert bricks.leastTrace(bricks.stack(4, (1, 1, 0.5))) == math.inf
    assert bricks.leastTrace(stack.moved(3, 1, -2)) == approx(1)


@mark.parametrize("scatter", [0, 0.2, 0.4])
def test_the_trace_goes_up_through_one_head_joint_of_every_course(scatter):
    wall = bricks.StoneWall(1.6, 1.2, (0.2, 0.3, 0.15), scatter=scatter).moved(3, 1, -2)
    heads = [[b.low[0] for b in wall if b.course == n][1:] for n in range(8)]
    ways = dict.fromkeys(heads[0], 1.2)
    for above in heads[1:]:
        ways = {x: min(path + abs(x - other) for other, path in ways.items()) for x in above}
    assert bricks.leastTrace(wall) == approx(min(ways.values()) / 1.2)


@mark.parametrize("trace", [1.1, 1.17, 1.25])
@patterns
def test_the_wall_has_the_trace_that_was_asked_for(pattern, trace):
    walls = [
        bricks.StoneWall(1.6, 1.6, (0.2, 0.3, 0.15), pattern, trace=trace, seed=n) for n in range(5)
    ]
    found = [bricks.leastTrace(wall) for wall in walls]
    assert max(found) < 1.1 * trace and min(found) > 0.9 * trace
    assert len({round(f, 6) for f in found}) > 1


def test_the_first_wall_that_is_near_the_trace_is_taken():
    build = lambda **how: bricks.StoneWall(1.2, 1.2, (0.2, 0.3, 0.15), **how)
    running = build(scatter=0)
    near = 0.972 * bricks.leastTrace(running)
    assert list(build(trace=near)) == list(running)


def test_what_is_refused():
    with raises(ValueError, match="length of a stone, 2 m.*\n?.*height of a stone, 3 m"):
        bricks.StoneWall(1.0, 1.0, (2, 0.3, 3))
    with raises(ValueError, match="are all lengths in m"):
        bricks.StoneWall(1000, 1200, (0.2, 0.3, 0.15))
