# SPDX-License-Identifier: GPL-2.0-or-later
"""The comparison of the dry-joint walls' loops says yes to the measured curves themselves, and no
to others."""

from usual import *
import compare_loops
import measured


def asMeasured(wall, stiffness=1.0, shift=0.0):
    moved, force, _ = measured.curve(wall)
    return moved + shift, stiffness * force


def verdicts(rows, column):
    return [str(row[column]).split()[-1] for row in rows]


def curves(**change):
    return {wall: asMeasured(wall, **change) for wall in measured.walls()}


def cycleRows(found):
    return compare_loops.cycleRows(
        {wall: compare_loops.pairs(wall, *curve) for wall, curve in found.items()}
    )


def test_the_measured_curves_themselves_hold_all_limits():
    rows = cycleRows(curves())
    assert sum(row[2] for row in rows) > 80
    for column in (4, 6, 8, 10):
        assert set(verdicts(rows, column)) == {"holds"}
    for row in compare_loops.historyRows(curves()):
        assert row[2] == "1.00"


def test_peaks_are_held_against_those_of_the_database():
    for column in (2, 4, 6):
        assert set(verdicts(compare_loops.peakRows(curves()), column)) == {"holds"}
        for stiffness in (0.85, 1.15):
            rows = compare_loops.peakRows(curves(stiffness=stiffness))
            assert set(verdicts(rows, column)) == {"missed"}


@mark.parametrize(
    "factor, verdict",
    [(0.75, "missed"), (0.85, "holds"), (1.15, "holds"), (1.25, "missed")],
)
def test_work_is_held_within_a_fifth(factor, verdict):
    """Forces that are all multiplied leave the residual displacements, and multiply the work."""
    rows = cycleRows(curves(stiffness=factor))
    assert set(verdicts(rows, 4)) == {verdict}
    assert set(verdicts(rows, 6)) == {"holds"}


def test_residual_displacements_are_held_against_each_other():
    """A shift of all displacements by 0.4 mm moves both residual displacements, and leaves the
    width of the loops."""
    rows = cycleRows(curves(shift=0.4))
    assert "missed" in verdicts(rows, 6) and "missed" in verdicts(rows, 8)
    assert set(verdicts(rows, 10)) == {"holds"}


def test_another_history_is_refused():
    moved, force = asMeasured("WS1175")
    with raises(ValueError, match="WS1175: the measured cycle"):
        compare_loops.pairs("WS1175", 0.8 * moved, force)


def test_doubtful_cycles_are_left_out():
    whole = len(measured.cycles("WS2100"))
    assert len(compare_loops.pairs("WS2100", *asMeasured("WS2100"))) == whole - 3


def test_tables_and_figure_are_made(tmp_path):
    found = curves()
    assert "| mean 175 kN |" in compare_loops.tables("cyclic", found)
    path = tmp_path / "loops.png"
    compare_loops.draw("cyclic", 175, found, path)
    assert path.stat().st_size > 10000


def test_runs_get_every_property_of_the_blind_set_for_every_kind_of_joint():
    words = compare_loops.options("WS2250", "cyclic", 20)
    assert words[:4] == ["--level", "250", "--joints", "cyclic"]
    given = [words[i + 1] for i, word in enumerate(words) if word == "--set"]
    assert len(given) == 3 * len(compare_loops.BLIND["properties"])
    assert "head.closureLimit=0.000136" in given
    assert "--set" not in compare_loops.options("WS2250", "softening", 20)


def test_the_closing_curve_gives_the_measured_moduli():
    """Em of a course with one joint, tangent to the curve at the mean stress of the tests: within
    1.5 % of the data."""
    blind, height, block = compare_loops.BLIND["properties"], 0.15, 20.2e9
    first, limit = blind["initialClosingStiffness"], blind["closureLimit"]
    for load, modulus in ((104.8e3, 3287e6), (179.8e3, 4068e6), (254.8e3, 4722e6)):
        tangent = first * (1 + load / 0.2 / (first * limit)) ** 2
        assert tangent < blind["normalStiffness"]
        assert 1 / (1 / block + 1 / (height * tangent)) == approx(modulus, rel=0.015)
    assert blind["normalStiffness"] == approx(block / height, rel=0.01)
