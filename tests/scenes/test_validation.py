"""The quick variants of the validation cases hold their limits, and the program says so when one does not."""

import glob
import os
import sys

import pytest
from conftest import ROOT
from masonry import materials, options

sys.path.insert(0, os.path.join(ROOT, "validation"))
sys.path.insert(0, os.path.join(ROOT, "validation", "sensitivity"))
import tornado  # noqa: E402
import validate  # noqa: E402

CASES = [
    os.path.basename(os.path.dirname(path))
    for path in sorted(glob.glob(os.path.join(validate.HERE, "*", "case.json")))
]


@pytest.mark.parametrize(
    "case", [case for case in CASES if "quick" in validate.readCase(case)]
)
def test_the_quick_variant_holds_its_limits(case, tmp_path, capsys):
    assert validate.main([case, "quick", "--results", str(tmp_path)]) == 0
    assert "MISSED" not in capsys.readouterr().out


def test_a_missed_limit_is_said_and_counted(capsys):
    limits = {"peak": [1, 2], "drop": [None, 0.5], "band": ["other", None]}
    numbers = {"peak": 1.5, "drop": 0.6, "band": 4}
    assert not validate.check(limits, numbers, lambda case: {"band": len(case)})
    peak, drop, band = capsys.readouterr().out.splitlines()
    assert peak.endswith("holds") and drop.endswith("MISSED")
    assert band.endswith("[5, inf]  MISSED")


def test_every_limit_is_an_interval():
    for case in CASES:
        for name, run in validate.readCase(case).items():
            assert os.path.exists(os.path.join(ROOT, "scripts", run["scene"]))
            for limit, (low, high) in run["limits"].items():
                assert (low, high) != (None, None), (case, name, limit)
                if isinstance(low, (int, float)) and isinstance(high, (int, float)):
                    assert low <= high, (case, name, limit)


def test_an_unknown_run_is_refused(capsys):
    with pytest.raises(SystemExit) as refused:
        validate.main(["wall_comp4", "soft"])
    assert refused.value.code == 2
    assert "no run soft; there are rigid, deformable" in capsys.readouterr().err


@pytest.mark.parametrize("row", tornado.ROWS, ids=lambda row: row.name)
def test_a_variation_changes_joints_within_their_bounds(row):
    assert row.low or row.high
    for text in (row.low, row.high):
        args = options.parser("a wall", until=1).parse_args(text.split())
        options.applySettings(materials.calciumSilicateJoints(), args.set)
