# SPDX-License-Identifier: GPL-2.0-or-later
"""What the stages of a scene answer, in run.json, on the terminal and in the table of a study."""

from hosted import *
from masonry_view.report.structure import sought
from masonry.run import run
from masonry.stages.answers import answersText
from masonry_study.gathering import _answerName
from small_wall import SMALL, carryOut, parsed

STONE = dict(friction=0.7, normalStiffness=2e9)


def stack(*words):
    """Three stones, twice as high as wide, on a base."""
    stones, blocks = materials.dry(**STONE), bricks.stack(3, (0.3, 0.3, 0.2))
    scene = Scene("stones", blocks, stones, arguments=["--no-vtk", *map(str, words)])
    scene.platen("bottom")
    scene.settle()
    return scene


def answers(folder):
    return {f"{a['stage']} {a['name']}": a for a in readRun(str(folder))["answers"]}


def test_a_push_answers_with_its_peak_and_where_it_was(tmp_path, capsys):
    assert carryOut(SMALL, parsed("--no-vtk", "--until", "0.4", "--out", str(tmp_path))) == 0
    run, found = readRun(tmp_path), answers(tmp_path)
    peak = found["push peak"]
    assert (peak["value"], peak["unit"]) == (run["peak_at_both_ends_kN"], "kN")
    # one run has no measure of its own error, and says so
    assert peak["uncertainty"] is None
    assert f"the supports alone had {run['peak_base_shear_kN']:.4g} kN" in peak["how"]
    where = found["push displacement_at_peak"]
    assert (where["value"], where["unit"]) == (run["displacement_at_peak_mm"], "mm")
    assert where["uncertainty"] is None and peak["number"] == 2
    assert f"push: peak {peak['value']:.4g} kN\n" in capsys.readouterr().out
    assert _answerName(peak) == "push_2_peak_kN"


def test_a_lean_answers_with_what_was_held_and_with_nothing_if_it_was_not(tmp_path):
    scene = stack("--out", tmp_path)
    # the stack is 0.3 m wide and 0.6 m high: it tips at 0.5 g
    assert scene.lean(0.3) == AT_REST
    assert scene.lean(0.6) == COLLAPSED
    scene.finish()
    found = readRun(tmp_path)["answers"]
    assert [a["name"] for a in found] == ["factor_held", "factor_not_held"] * 2
    assert [a["value"] for a in found] == [0.3, None, None, 0.6]
    assert "did not come to rest under 0.6 g" in found[2]["how"]
    assert scene.factor == readRun(tmp_path)["factor"] == 0.3


def brackets(stage, unit, *factors):
    """Answers of stages from the second on with a load that was held, or, of negative factors, not
    held."""
    for number, factor in enumerate(factors, 2):
        held, lost = (factor, None) if factor > 0 else (None, -factor)
        for name, value in (("factor_held", held), ("factor_not_held", lost)):
            yield dict(
                stage=stage,
                number=number,
                name=name,
                unit=unit,
                value=value,
                uncertainty=None,
                how="none",
            )


def test_the_line_of_a_bracket_has_the_largest_held_and_the_smallest_not_held():
    (line,) = answersText(brackets("lean", "g", 0.2, -0.6, 0.35, -0.4, 0.3, -0.5))
    assert line == "lean: factor held 0.35 g (6 stages); factor not held 0.4 g"
    # what was held at last, in a smaller step
    (line,) = answersText(brackets("lean", "g", 0.2, -0.3, 0.35))
    assert line == "lean: factor held 0.35 g (3 stages); factor not held: not found: none"
    (line,) = answersText(brackets("lean", "g", 0.2))
    assert line == "lean: factor held 0.2 g; factor not held: not found: none"


def test_loads_on_several_blocks_have_a_line_each():
    answers = [*brackets("load", "kN", 16, -1.4, 12)]
    stages = [{"load": None}] + [
        {"load": ["lean", f"load on {name} along y", ""]} for name in ("foot", "top", "foot")
    ]
    assert list(answersText(answers, stages)) == [
        "load on foot along y: factor held 16 kN (2 stages); factor not held: not found: none",
        "load on top along y: factor held: not found: none; factor not held 1.4 kN",
    ]
    # the report names no largest load, since these are different ones
    assert sought({"answers": answers, "stages": stages}) == []
    assert len(sought({"answers": answers[:2] + answers[4:], "stages": stages})) == 1


def test_a_resumed_run_of_what_fell_says_so_as_before(tmp_path):
    runs = []
    for word in ("--out", "--resume"):
        scene = stack(word, tmp_path)
        assert scene.lean(0.6) == COLLAPSED
        scene.finish()
        runs.append(readRun(tmp_path))
    one, other = ([run[n] for n in ("collapse", "collapsed", "steps")] for run in runs)
    assert one == other and all(one)


def test_steps_are_counted_once_although_a_run_looks_up(tmp_path, monkeypatch):
    scene = stack("--out", tmp_path)
    monkeypatch.setattr(run, "LOOK_EVERY", 0.0)  # after every step
    before, first = scene.running.state.steps, O.iter
    scene.running.advance(10)
    assert scene.running.state.steps - before == O.iter - first == 10
