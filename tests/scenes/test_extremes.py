# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes at the extremes, as validation/stability/extremes.py draws them: other ones every
day."""

from usual import *

import extremes

SEED = os.environ.get("EXTREMES_SEED", str(int(time.time() // 86400)))


@pytest.fixture
def case():
    """A dry block of 1 × 1 × 2 m and 20 kN, without a platen on it."""
    made = extremes.Case(extremes.Dice("1"))
    values = dict(courses=1, length=1.0, thick=1.0, height=2.0, top=2.0, area=1.0)
    values.update(weight=2e4, kn=1e15, friction=0.8, cohesion=0.0, tension=0.0)
    values.update(rotation=None, own=0.0, above=0.0, platen=0.0, deformable=False)
    vars(made).update(values)
    return made


def test_scenes_of_today_are_confirmed_or_end_with_a_reason(scene, monkeypatch):
    monkeypatch.setattr(extremes, "MOST_STEPS", 100000)  # so that it takes seconds
    results = extremes.runAll(6, seed=SEED)
    for number, found in enumerate(results):
        why = f"EXTREMES_SEED={SEED}, scene {number}: {found['why']}\n{found['said']}"
        assert found["class"] != "failed", why
        assert found["why"] or found["class"] == "confirmed"


def test_walls_that_cannot_stand_collapse_with_a_balance_that_closes(scene):
    """Among them joints so soft that bricks would pass through each other between two looks a
    hundred steps apart."""
    results = extremes.runAll(6, seed="1", falls=True)
    assert [found["class"] for found in results] == ["collapsed"] * 6
    assert max(found["balance"] for found in results) < 1e-5


def test_closed_forms_of_a_block(case):
    assert case.mostPush(0, 1.0) == approx(1e4)  # it rocks
    assert case.mostPush(0, 0.5) == approx(1.6e4)  # it slides
    assert case.mostAcceleration(False) == approx(0.5)
    assert case.mostAcceleration(True) == approx(0.5)
    assert case.mostWind() == approx(2e4 * 0.5 / (2 * 1))
    case.cohesion, case.tension, case.friction = 1e4, 1e4, 0.1
    assert case.mostPush(0, 0.5) == approx(1.2e4)
    assert case.mostPush(0, 2.0) == approx(7.5e3)


def test_a_platen_that_cannot_turn_holds_the_top(case):
    case.rotation, case.above = "held", 1e4
    alone = (2e4 + 1e4) * 0.5 / 2
    assert case.mostPush(1, 9.0) == approx(min(alone + 1e4 * 0.5 / 2, 0.8e4))


@mark.parametrize(
    "found, run, said, message",
    [
        (("push", 1.05, 1.0), {"dynamic_imbalance": 0.02}, "", "above its closed form"),
        (("held", 0.52, 0.5), {}, "", "above its closed form"),
        (("held", 0.50, 0.5), {"energy_balance_error": 0.02}, "", "no warning"),
        (("held", 0.50, 0.5), {"factor": float("nan")}, "", "not finite"),
        (("push", 1.05, 1.0), {"dynamic_imbalance": 0.04}, "", None),
        (("push", 9.00, 1.0), {}, "warning: the push is too fast", None),
    ],
)
def test_the_oracle_sees_a_fault(found, run, said, message):
    results = SimpleNamespace(rows=[[0.0, 1.0]])
    play = SimpleNamespace(scene=SimpleNamespace(results=results), found=[found])
    wrong = raises(extremes.Wrong, match=message)
    with wrong if message else contextlib.nullcontext():
        extremes.judge(play, said, run)
