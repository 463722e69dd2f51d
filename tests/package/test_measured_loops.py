# SPDX-License-Identifier: GPL-2.0-or-later
"""The measured loops of the dry-joint walls are read, put in order and thinned as their README
says."""

from usual import *
import measured
from scipy.integrate import trapezoid


@mark.parametrize("wall", measured.walls())
def test_repaired_pieces_follow_each_other(wall):
    """Between two pieces the wall moves outwards on the negative side, where the force hardly
    changes with displacement, or the next piece begins where the last one ended. The hole of
    WS1.100 is the one exception.
    """
    found = measured.pieces(wall)
    holes = {repair[1] for repair in measured.REPAIRS[wall] if repair[0] == "hole"}
    for (number, piece), (_, after) in zip(found, found[1:]):
        if number in holes:
            continue
        (x1, f1), (x2, f2) = piece[-1], after[0]
        follows = abs(x2 - x1) < 1 and abs(f2 - f1) < 6.5
        outwards = x2 < x1 < 0
        assert (
            follows or outwards
        ), f"{wall}: piece {number} ends at {x1} mm, the next begins at {x2} mm"


@mark.parametrize("wall", ["WS2175", "WS3175"])
def test_without_the_repair_the_pieces_do_not_follow(wall):
    path = os.path.join(measured.REFERENCE, f"FD_{wall}_Vasconcelos2009.csv")
    raw, _ = measured.rawPieces(path)
    jumps = [after[0, 0] - piece[-1, 0] for piece, after in zip(raw, raw[1:])]
    assert max(jumps) > 13


def test_rows_that_are_no_numbers_are_left_out_and_counted(tmp_path):
    path = tmp_path / "FD.csv"
    path.write_text(
        "Test unit\nReference\nnames\nunits\n1,2,3\nNaN,NaN,NaN\n\n4,x,6\n5\n7,8,9\n7.5,8,9\n"
    )
    pieces, left = measured.rawPieces(path)
    assert left == 3
    assert [p.tolist() for p in pieces] == [[[1, 2]], [[7, 8], [7.5, 8]]]


def test_a_stray_row_is_found_and_a_turning_point_is_not():
    x = np.concatenate([np.arange(0, 10, 0.5), np.arange(10, 0, -0.5)])
    curve = np.column_stack([x, 6 * x])
    assert measured.strays(curve) == []
    for row, change in ((5, (0, 20)), (6, (0, -20)), (25, (2.0, 0))):
        off = curve.copy()
        off[row] += change
        assert measured.strays(off) == [row]


@mark.parametrize("wall", measured.walls())
def test_the_history_file_is_that_of_the_loops(wall):
    with open(measured.historyPath(wall)) as f:
        assert f.read() == measured.historyText(wall)
    history, (moved, _, _) = measured.history(wall), measured.curve(wall)
    steps = np.diff(history)
    assert (steps[1:] * steps[:-1] < 0).all()
    assert min(abs(steps[:-1])) > measured.THRESHOLD
    assert (history.min(), history.max()) == (moved.min(), moved.max())


@mark.parametrize("level", measured.LEVELS)
def test_the_loops_reach_the_peaks_that_the_database_gives(level):
    """Within 4 %: one row of WS3.100 has 39.3 kN where the database gives 38.0. The repaired
    WS1.250 no longer has the 102 kN of its file."""
    for wall, (positive, negative) in measured.peaks(level).items():
        _, force, _ = measured.curve(wall)
        assert force.max() == approx(positive, rel=0.04), wall
        assert -force.min() == approx(negative, rel=0.04), wall


def test_work_over_the_history_of_one_wall():
    """3,129 J is the net work over the raw rows of WS2.175 in the order of the file; that order
    ends at -6.6 mm. In the order of time the work up to that row differs by less than 1 %, because
    the file had only exchanged pieces.
    """
    path = os.path.join(measured.REFERENCE, "FD_WS2175_Vasconcelos2009.csv")
    raw = np.concatenate(measured.rawPieces(path)[0])
    assert trapezoid(raw[:, 1], raw[:, 0]) == approx(3129, abs=1)
    moved, force, number = measured.curve("WS2175")
    end = int(np.flatnonzero(number == 14)[-1]) + 1
    assert moved[end - 1] == raw[-1, 0]
    assert trapezoid(force[1:end], moved[1:end]) == approx(3129, rel=0.01)
