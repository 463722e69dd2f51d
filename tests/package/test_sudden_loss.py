# SPDX-License-Identifier: GPL-2.0-or-later
"""A push whose force falls at once is doubted; ordinary softening and waves are not."""

from usual import *
from masonry.read.curves import suddenLoss


def curve(force, step=0.01, until=5.0):
    """Displacements [mm], and the force at both ends [kN], of a function of the displacement."""
    moved = [n * step for n in range(int(until / step) + 1)]
    return moved, [force(u) for u in moved]


def test_a_fall_is_found_with_its_place_and_share_of_the_peak():
    moved, force = curve(lambda u: 25.0 * min(u, 1.0) - (4.0 if u >= 2.05 else 0.0))
    share, at = suddenLoss(moved, force, force)
    assert share == pytest.approx(4 / 25)
    assert 1.94 < at < 2.06


def test_steady_softening_is_no_sudden_loss():
    # a quarter of the peak is lost over each millimetre
    moved, force = curve(lambda u: 40.0 * min(u, 1.0) * math.exp(-0.29 * max(u - 1, 0)))
    assert suddenLoss(moved, force, force)[0] < 0.03


def test_a_wave_that_one_end_feels_before_the_other_counts_by_half():
    moved, base = curve(lambda u: 30.0 if u < 2 else 30.0 + 5 * math.sin(100 * u))
    top = [60.0 - b for b in base]  # against phase
    assert suddenLoss(moved, top, base)[0] < 1e-9


@pytest.mark.parametrize("rows", [0, 1])
def test_a_push_without_rows_and_rows_far_apart_show_none(rows):
    assert suddenLoss([0.0] * rows, [1.0] * rows, [1.0] * rows) == (0.0, 0.0)
    moved, force = curve(lambda u: 10.0 if u < 2 else 5.0, step=0.5)
    assert suddenLoss(moved, force, force) == (0.0, 0.0)
