# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of loops, on loops of which they are known in closed form, whole and with the noise of a
measurement."""

from usual import *
from masonry.numbers import loops

FINE = 20001  # rows of a cycle


def path(*corners, rows=400):
    """A polyline through corners, with so many rows between two of them: one array for each
    coordinate."""
    corners = np.array(corners, float)
    places = np.linspace(0, len(corners) - 1, rows * (len(corners) - 1) + 1)
    return tuple(np.interp(places, range(len(corners)), column) for column in corners.T)


@given(some.floats(0.1, 100), some.floats(0.1, 300), some.floats(0.01, 0.5))
@settings(max_examples=30)
def test_an_ellipse_has_the_damping_that_drew_it(amplitude, stiffness, damping):
    # d = A sin p, F = K d + 2 ξ K A cos p: a spring and a dashpot, with work 2 π ξ K A² in a cycle
    p = np.linspace(0, 2 * np.pi, FINE)
    moved = amplitude * np.sin(p)
    force = stiffness * moved + 2 * damping * stiffness * amplitude * np.cos(p)
    (cycle,) = loops.cycles(moved, force, threshold=amplitude / 100)
    assert cycle.amplitude_mm == approx(amplitude, rel=1e-6)
    work = 2 * np.pi * damping * stiffness * amplitude**2
    assert cycle.work_J == approx(work, rel=1e-6)
    assert cycle.stiffness_kN_per_mm == approx(stiffness, rel=1e-3)
    assert cycle.damping == approx(damping, rel=1e-3)
    top = stiffness * amplitude * math.hypot(1, 2 * damping)
    assert cycle.largest_kN == approx(top, rel=1e-6)
    assert cycle.smallest_kN == approx(-top, rel=1e-6)
    # F vanishes where tan p = -2 ξ
    left = amplitude * math.sin(math.atan(2 * damping))
    assert cycle.residual_positive_mm == approx(left, rel=1e-3)


def test_a_slider_with_a_spring_draws_a_parallelogram():
    # spring 10 kN/mm, slips at 20 kN, amplitude 5 mm: W = 4 Fy (A - Fy/K) = 240 J, and after 5 mm
    # it is free at 3 mm
    loop = (5, 20), (1, -20), (-5, -20), (-1, 20)
    moved, force = path((0, 0), (2, 20), *loop, *loop, (0, 20))
    first, second = loops.cycles(moved, force, threshold=0.1)
    assert second.work_J == approx(240, rel=1e-9)
    # The first begins without force: it lacks the triangle of 2 mm and 20 kN that it has not
    # unloaded from.
    assert first.work_J == approx(240 - 20 * 2 / 2, rel=1e-9)
    for cycle in (first, second):
        assert cycle.stiffness_kN_per_mm == approx(4)
        assert (cycle.largest_mm, cycle.smallest_mm) == (5, -5)
        assert (cycle.largest_kN, cycle.smallest_kN) == (20, -20)
        assert cycle.residual_positive_mm == approx(3)
        assert cycle.residual_negative_mm == approx(-3)
    # ξ = W / (2 π K A²)
    assert second.damping == approx(240 / (2 * np.pi * 4 * 25))


def test_a_rocking_wall_with_friction_draws_a_flag():
    # 10 kN/mm to 20 kN, flat to 5 mm, 12 kN lower on the way back: a flag of 12 kN × (5 - 2) mm a
    # side
    side = ((0, 0), (2, 20), (5, 20), (3.8, 8), (0.8, 8), (0, 0))
    moved, force = path(*side, *[(-x, -f) for x, f in side[1:]])
    (cycle,) = loops.cycles(moved, force, threshold=0.1)
    assert cycle.work_J == approx(2 * 12 * 3, rel=1e-9)
    assert cycle.residual_positive_mm == approx(0, abs=1e-9)
    assert cycle.residual_negative_mm == approx(0, abs=1e-9)
    assert cycle.damping == approx(72 / (2 * np.pi * 4 * 25))


def test_a_spring_does_no_work_in_unequal_cycles_that_begin_on_either_side():
    moved, force = path((0, 0), (-1, -10), (2, 20), (-3, -30), (5, 50), (0, 0))
    found = loops.cycles(moved, force, threshold=0.1)
    assert [(c.smallest_mm, c.largest_mm) for c in found] == [(-1, 2), (-3, 5)]
    for cycle in found:
        assert cycle.work_J == approx(0, abs=1e-9) and cycle.damping < 1e-12
        assert cycle.stiffness_kN_per_mm == approx(10)


@given(some.integers(0, 2**32 - 1), some.floats(0, 0.05))
@settings(max_examples=30)
def test_noise_below_the_threshold_changes_no_count(seed, noise):
    amplitudes = [1, 1, 3, 3, 6]
    corners = [(0, 0)] + [(s * a, s * a) for a in amplitudes for s in (1, -1)]
    moved, force = path(*corners, (0, 0), rows=150)
    dice = np.random.default_rng(seed)
    noisy = moved + dice.uniform(-noise, noise, len(moved))
    assert len(loops.turningPoints(noisy, 0.2)) == len(corners) + 1
    found = loops.cycles(noisy, force, 0.2)
    sizes = [c.amplitude_mm for c in found]
    assert sizes == approx(amplitudes, abs=2 * noise + 1e-9)


displacements = some.lists(some.floats(-10, 10), min_size=1, max_size=60)


@given(displacements, some.floats(0, 5))
def test_turning_points_alternate_and_nothing_between_them_turns(values, threshold):
    rows = loops.turningPoints(values, threshold)
    assert (np.diff(rows) > 0).all() and np.ptp(values[: rows[0] + 1]) <= threshold
    ways = np.diff(np.array(values)[rows])
    assert (np.sign(ways[1:]) == -np.sign(ways[:-1])).all()
    assert (np.abs(ways) > threshold).all()
    for a, b in zip(rows, rows[1:]):
        direction = 1 if values[b] > values[a] else -1
        part = direction * np.array(values[a : b + 1])
        assert (np.maximum.accumulate(part) - part).max() <= threshold
    rest = np.array(values[rows[-1] :])
    assert np.ptp(rest) <= threshold or len(rows) == 1


@given(displacements, some.floats(0, 5), some.floats(-3, 3))
def test_half_cycles_follow_one_another_and_their_work_adds_up(values, least, zero):
    force = [math.sin(3 * v) for v in values]
    halves = loops.halfCycles(values, least, zero)
    for one, next in zip(halves, halves[1:]):
        assert one.end == next.start and one.side == -next.side
    for h in halves:
        assert h.side * (values[h.extreme] - zero) > least
        assert h.start <= h.extreme <= h.end
    if halves:
        parts = [loops.work(values, force, h.start, h.end) for h in halves]
        whole = loops.work(values, force, halves[0].start, halves[-1].end)
        assert sum(parts) == approx(whole, abs=1e-9)


def test_an_incomplete_half_cycle_is_reported_and_makes_no_cycle():
    moved, force = path((-2, 0), (3, 1), (-3, -1), (4, 0))
    halves = loops.halfCycles(moved, 0.1)
    assert [h.complete for h in halves] == [False, True, True, False]
    assert [round(moved[h.extreme], 9) for h in halves] == [-2, 3, -3, 4]
    (cycle,) = loops.cycles(moved, force, 0.1)
    assert (cycle.largest_mm, cycle.smallest_mm) == (3, -3)


def test_a_force_that_does_not_vanish_leaves_no_residual_displacement():
    moved, force = path((0, 5), (3, 9), (1, 4))
    assert math.isnan(loops.residualDisplacement(moved, force, 400))
    assert math.isnan(loops.residualDisplacement([0, 1, 0], [0, 0, -1], 1))
    assert math.isnan(loops.equivalentDamping(1, 0, 1))
    assert math.isnan(loops.secantStiffness([1, 1], [0, 1], 0, 1))

    # it is looked for up to where the next swing to the other side ends, not in later cycles
    moved, force = path((0, 0), (3, 5), (-3, 1), (0, 2), (2, 5), (-2, -5), (0, 0))
    first, second = loops.cycles(moved, force, 0.1)
    assert math.isnan(first.residual_positive_mm)
    assert math.isnan(loops.residualDisplacement(moved, force, 400, 800))
    # on the way from 5 kN at 2 mm to -5 kN at -2 mm
    assert second.residual_positive_mm == approx(0, abs=1e-9)


def test_the_envelope_is_what_no_earlier_row_has_reached():
    moved, force = path((0, 0), (1, 5), (-1, -5), (2, 7), (-2, -6), (1, 4), rows=100)
    right, left = loops.envelope(moved)
    assert (np.diff(moved[right]) > 0).all() and (np.diff(moved[left]) < 0).all()
    assert moved[right].max() == 2 and moved[left].min() == -2
    assert force[right].max() == 7 and force[left].min() == -6
    again = (right > 100) & (moved[right] <= 1)
    assert not again.any()


@mark.parametrize(
    "act, message",
    [
        (lambda: loops.turningPoints([]), "displacement must be a row of numbers"),
        (lambda: loops.turningPoints([1, math.nan]), "displacement in row 1 is nan"),
        (lambda: loops.turningPoints([1], -1), "threshold -1 mm must be at least 0"),
        (lambda: loops.halfCycles([1], math.nan), "threshold nan mm must be"),
        (lambda: loops.work([1, 2], [1]), "2 displacements and 1 forces"),
        (lambda: loops.cycles([1], [math.inf], 0), "force in row 0 is inf"),
    ],
)
def test_what_is_no_curve_is_refused(act, message):
    with raises(ValueError, match=message):
        act()
