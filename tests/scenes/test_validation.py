# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick variants of the validation cases hold their limits, and the program says so when one
does not."""

from hosted import *
import pathlib
import runpy
import invariance
import observed
import stability
import studies
import validate
from masonry.scene import options
from masonry.materials.settings import applySettings

# There is also a package of the name tornado, which notebooks import.
PATH = os.path.join(ROOT, "validation", "sensitivity", "tornado.py")
ROWS = runpy.run_path(PATH)["ROWS"]

CASES = sorted(path.parent.name for path in pathlib.Path(studies.HERE).glob("*/case.json"))
QUICK = [case for case in CASES if "quick" in studies.readCase(case)]


@mark.parametrize("case", QUICK)
def test_the_quick_variant_holds_its_limits(case, tmp_path, capsys):
    assert validate.main([case, "quick", "--results", str(tmp_path)]) == 0
    assert "MISSED" not in capsys.readouterr().out


def test_a_missed_limit_is_said_and_counted(capsys):
    limits = {"peak": [1, 2], "drop": [None, 0.5], "band": ["other", None], "fall": [20, None]}
    numbers = {"peak": 1.5, "drop": 0.6, "band": 4}
    assert not validate.check(limits, numbers, lambda case: {"band": len(case)})
    peak, drop, band, fall = capsys.readouterr().out.splitlines()
    assert peak.endswith("holds") and drop.endswith("MISSED")
    assert band.endswith("[5, inf]  MISSED") and fall.endswith("nan  [20, inf]  MISSED")


def test_every_limit_is_an_interval():
    for case in CASES:
        for name, run in studies.readCase(case).items():
            assert studies.scenePath(run["scene"])
            for limit, (low, high) in run["limits"].items():
                assert (low, high) != (None, None), (case, name, limit)
                if isinstance(low, (int, float)) and isinstance(high, (int, float)):
                    assert low <= high, (case, name, limit)


def test_an_unknown_run_is_refused(capsys):
    with raises(SystemExit) as refused:
        validate.main(["wall_comp4", "soft"])
    assert refused.value.code == 2
    assert "no run soft; there are rigid, deformable" in capsys.readouterr().err


@mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_a_variation_changes_joints_within_their_bounds(row):
    assert row.low or row.high
    for text in (row.low, row.high):
        args = options.parser("a wall", until=1).parse_args(text.split())
        applySettings(materials.calciumSilicateJoints(), args.set)


@mark.parametrize("axis", [a for a in stability.AXES if "COMP-4" not in a])
def test_walls_at_the_extremes_are_stable_or_stopped_with_a_reason(axis):
    points = stability.AXES[axis]
    ends = (0, -2) if axis == "size / usual" else (0, -1)
    runs = [(points[end], "rigid") for end in ends]
    for point, blocks in [*runs, (points[len(points) // 2], "deformable")]:
        found = stability.run(point, blocks)
        assert found["verdict"] != "failed", (point, blocks, found)
        unstable = point.dt is not None and point.dt > 1
        assert (found["verdict"] == "warned") >= unstable, (point, blocks, found)


def test_energy_that_joints_make_is_an_error_of_the_balance():
    """Undamped nodes that open and close their joints within a step, far from a slow test."""
    (point,) = stability.points([164], stability.drawn)
    found = stability.run(point, "deformable")
    assert found["made"] > 0.01 and found["verdict"] == "warned"
    assert "the run says so" in found["why"]


@mark.parametrize("blocks", observed.BLOCKS)
def test_a_panel_in_other_units_turned_and_renumbered(blocks):
    units = dict(length=1e-3, stress=1e6)
    order = dict(turn=invariance.TURN, shuffle=True, mirror=blocks == "rigid")
    early, late = invariance.difference(blocks, {**units, **order})
    assert early < 1e-9 and late < 1e-7
