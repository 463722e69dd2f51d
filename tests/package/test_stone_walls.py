# SPDX-License-Identifier: GPL-2.0-or-later
"""Predictions of walls of stone and of bricks see nothing that was measured in the tests, and are
of what the rules say."""

from usual import *
import assumed  # first: it finds the modules of the stone walls
import codes
import rules
from masonry import bricks, materials

LAST_INPUT = "LMTvert [mm]"


@pytest.fixture()
def withoutResults(tmp_path, monkeypatch):
    """The table of walls with nonsense in place of all results."""
    with open(rules.WALLS, encoding="utf-8-sig", newline="") as f:
        head, *rows = csv.reader(f)
    inputs = head.index(LAST_INPUT) + 1
    rows = [row[:inputs] + ["nothing"] * (len(row) - inputs) for row in rows]
    path = tmp_path / "walls.csv"
    with open(path, "w", encoding="utf-8", newline="") as f:
        csv.writer(f).writerows([head, *rows])
    return str(path)


def test_rules_and_codes_see_no_results(withoutResults, monkeypatch):
    seen, said = rules.read(), [codes.predict(row) for row in codes.rows()]
    monkeypatch.setattr(rules, "WALLS", withoutResults)
    assert rules.read() == seen and len(seen) == 96
    assert [codes.predict(row) for row in codes.rows(withoutResults)] == said


def test_every_wall_is_either_known_or_blind():
    assert sorted(rules.KNOWN + rules.BLIND, key=int) == sorted(rules.read(), key=int)
    with open(rules.WALLS, encoding="utf-8-sig", newline="") as f:
        kept = [row["ID"] for row in csv.DictReader(f) if row["Failure type"] == "?"]
    assert kept == rules.BLIND


def test_draws_are_a_latin_hypercube_about_the_best_estimate():
    row = rules.read()["22"]
    shares = [
        rules.Guess(row, *rules.CHOSEN, n)._share("bond") for n in range(2, rules.SAMPLES + 2)
    ]
    assert sorted(int(rules.SAMPLES * share) for share in shares) == list(range(rules.SAMPLES))
    best = rules.Guess(row, *rules.CHOSEN, 0)
    assert set(best.factors.values()) == {1.0}


@mark.parametrize("wall", ["1", "22", "33", "50", "69", "90", "124"])
def test_blocks_are_of_the_size_of_the_wall(wall):
    row = rules.read()[wall]
    for sample in (0, 3):
        made = rules.Guess(row, *rules.CHOSEN, sample).bricks(bricks)
        assert made.high == approx((row.length, row.thickness, row.height))
        assert made.volume == approx(row.length * row.thickness * row.height)


def test_what_hand_calculation_says_of_a_wall():
    # WS1.100: N L / (2 H0) (1 - 1.15 sigma / fc), and friction 0.4 N of a dry joint
    row = next(row for row in codes.rows() if row["ID"] == "1")
    strength = 104.8 * 1000 / (2 * 1325) * (1 - 1.15 * 0.524 / 73)
    assert codes.flexure(codes.read(row), 1.15) / 1e3 == approx(strength, rel=1e-3)


def test_rules_of_bricks_see_no_results(tmp_path, monkeypatch):
    seen = assumed.read()
    assert len(seen) == 52 and len(assumed.known()) == 17
    with open(assumed.WALLS, encoding="utf-8", newline="") as f:
        head, *rows = csv.reader(f)
    inputs = head.index("mode")
    rows = [row[:inputs] + ["nothing"] * (len(row) - inputs) for row in rows]
    path = tmp_path / "walls.csv"
    with open(path, "w", encoding="utf-8", newline="") as f:
        csv.writer(f).writerows([head, *rows])
    monkeypatch.setattr(assumed, "WALLS", str(path))
    assert assumed.read() == seen


@mark.parametrize("wall", ["1", "26", "187", "193"])
def test_bricks_fill_the_wall_and_fit_their_materials(wall):
    row = assumed.read()[wall]
    for rule in assumed.RULES.values():
        guess = assumed.Guess(row, rule)
        made = guess.bricks(bricks)
        assert made.high == approx((row.length, row.thickness, row.height))
        bed, head = (guess.masonry(materials).joints[name] for name in ("bed", "head"))
        assert head.cohesion == approx(rule.heads * row.filled * bed.cohesion)
        assert bed.compressiveStrength == approx(rule.toe * row.fc)
