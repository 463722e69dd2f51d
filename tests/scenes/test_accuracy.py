# SPDX-License-Identifier: GPL-2.0-or-later
"""--accuracy: the interval covers what companions differ by, and every way in which a run with it
can end is in order."""

from usual import *
from masonry.run import accuracy
from masonry.run.presets import CHOSEN, COMPANIONS, FIDELITIES, MAIN, Source, fidelityOf

SCENE = """
import sys
from masonry import Scene, bricks, materials
scene = Scene("pier", bricks.Wall(0.44, 0.324), materials.calciumSilicate(), until=1)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)
scene.settle()
scene.push(top)
scene.finish()
"""


@pytest.fixture
def pier(tmp_path):
    (tmp_path / "pier.py").write_text(SCENE)
    return tmp_path


COMMAND = [sys.executable, "pier.py", "--lean", "--out", "out"]


def run(folder, *words, command=COMMAND):
    return subprocess.run(
        [*command, *words], cwd=folder, capture_output=True, text=True, timeout=120
    )


def recorded(folder):
    return json.loads((folder / "out" / "run.json").read_text())


def test_differences_that_shrink_as_those_of_an_order_count_by_richardson_and_others_whole():
    source = Source("rate", ("a", "b", "c"))
    # second order: errors of 16, 4 and 1 % make differences of 12 and 3 %; 1 % is left
    assert accuracy.shown(source, {"a": 116, "b": 104, "c": 101}, 100) == approx(0.01)
    # the other way round, or growing: the last difference counts whole
    assert accuracy.shown(source, {"a": 92, "b": 104, "c": 101}, 100) == approx(0.03)
    assert accuracy.shown(source, {"a": 105, "b": 104, "c": 101}, 100) == approx(0.03)
    assert accuracy.shown(source, {"a": 101, "b": 101, "c": 101}, 100) == 0


def test_two_runs_count_by_their_share_and_chance_by_its_range():
    assert accuracy.shown(Source("mesh", ("a", "b"), 0.5), {"a": 104, "b": 100}, 100) == approx(
        0.02
    )
    chance = Source("chance", ("a", "b", "c"), chance=True)
    found = accuracy.shown(chance, {"a": 100, "b": 101, "c": 100.5}, 100)
    assert found == approx(0.01 * accuracy.BY_CHANCE)
    assert accuracy.shown(chance, {"a": 100, "b": 101}, 100) is None


def test_the_table_of_fidelities_names_runs_and_options_that_there_are():
    for number, fidelity in enumerate(FIDELITIES):
        assert set(fidelity.options) <= set(CHOSEN)
        assert set(fidelity.error) == {name for name, _, _ in accuracy.QUANTITIES}
        for source in fidelity.sources:
            assert set(source.runs) <= {*COMPANIONS, MAIN}
            assert len(source.runs) == 3 if source.chance else len(source.runs) >= 2
            if MAIN in source.runs:  # what it counts before the run itself is there
                assert source.name in {s.name for s in FIDELITIES[number - 1].sources}
        args = type("Options", (), {**CHOSEN, **fidelity.options})
        assert fidelityOf(args) is fidelity
    used = {n for fidelity in FIDELITIES for s in fidelity.sources for n in s.runs}
    assert used == {*COMPANIONS, MAIN}


def test_a_finer_fidelity_takes_what_it_does_not_know_yet_from_the_one_before():
    values = dict.fromkeys(COMPANIONS, 100.0)
    values["two cells, 100 mm/s"] = 102.0
    before, parts = accuracy.halfWidth(3, "peak", values, 100)
    assert parts["mesh"] == approx(0.01)
    after, parts = accuracy.halfWidth(3, "peak", {**values, MAIN: 101.8}, 100)
    assert parts["mesh"] == approx(0.001)
    assert after < before and sum(parts.values()) == approx(after)


def test_a_push_says_its_peak_and_work_with_half_widths_everywhere(pier):
    done = run(pier, "--accuracy", "20")
    assert done.returncode == 0, done.stdout + done.stderr
    found = recorded(pier)
    entry, values = found["accuracy"], {}
    for q in entry["quantities"]:
        values[q["name"]] = q
        assert q["half_width"] == approx(q["value"] * sum(q["parts_percent"].values()) / 100)
    assert values["peak"]["value"] == found["peak_at_both_ends_kN"]
    assert values["work"]["value"] == found["push_work_J"]
    assert found["peak_half_width_kN"] == values["peak"]["half_width"]
    answers = {a["name"]: a for a in found["answers"]}
    assert answers["peak"]["uncertainty"] == values["peak"]["half_width"]
    assert answers["work"]["unit"] == "J" and "does not cover" in answers["work"]["how"]
    assert f"push: peak {values['peak']['value']:.4g} ± " in done.stdout
    assert entry["reached"] and entry["fidelity"] == FIDELITIES[0].name
    # the run has the options of that fidelity, and the companions theirs
    assert found["options"]["rate"] == 50 and found["options"]["blocks"] == "rigid"
    assert {c["name"] for c in entry["companions"]} == set(accuracy.needed(0))
    for one in entry["companions"]:
        other = json.loads(open(os.path.join(pier, one["folder"], "run.json")).read())
        assert {n: other["options"][n] for n in one["options"]} == one["options"]
        assert other["peak_at_both_ends_kN"] == one["peak"]
    # the run is the same, to the last bit, as one with these options
    again = run(pier, "--rate", "50", "--out", "plain")
    assert again.returncode == 0
    assert (pier / "out" / "curve.csv").read_bytes() == (pier / "plain" / "curve.csv").read_bytes()


def test_what_cannot_be_reached_is_said_with_the_width_that_was_found(pier):
    done = run(pier, "--accuracy", "0.01", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    found = recorded(pier)["accuracy"]
    assert not found["reached"] and found["fidelity"] == FIDELITIES[-1].name
    assert "0.01 % is not reached by the finest fidelity there is" in done.stdout


@mark.parametrize(
    "words, sentence",
    [
        (["--accuracy", "60"], "60.0 % must be above 0 and at most 50"),
        (["--accuracy", "2", "--preset", "bound"], "leave --preset away"),
        (["--accuracy", "2", "--rate", "20"], "leave --rate away"),
        (["--accuracy", "2", "--history", "1,2"], "loops of --history"),
    ],
)
def test_wrong_values_and_options_are_one_sentence(pier, words, sentence):
    done = run(pier, *words)
    assert done.returncode == 2
    assert sentence in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr
    assert not os.path.exists(pier / "out")


PUSH = "scene.push(top)"


@mark.parametrize(
    "what, other, sentence",
    [
        (PUSH, "scene.lean(0.01)", "this scene has the stage lean"),
        (PUSH, "scene.run(0.01)", "this scene has the stage run"),
        (PUSH, "pass", "this scene has no push of one target that takes force"),
        (PUSH, "scene.push(top, rate=5)", "push() has one of its own: rate=5 mm/s"),
        (
            "until=1",
            "arguments=['--accuracy', '2']",
            "that takes its options from the command line",
        ),
    ],
)
def test_scenes_of_which_it_says_nothing_are_refused(pier, what, other, sentence):
    (pier / "pier.py").write_text(SCENE.replace(what, other))
    done = run(pier, *["--accuracy", "2"] * (what == PUSH))
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith("--accuracy: ")
    assert sentence in done.stderr and "Traceback" not in done.stderr
    assert not os.path.exists(pier / "out")


def test_a_stack_that_falls_has_its_answer_and_a_sentence(pier):
    falls = SCENE.replace("held", "free").replace("until=1", "until=50")
    falls = falls.replace("Wall(0.44, 0.324)", "stack(2, (0.06, 0.06, 0.06))")
    (pier / "pier.py").write_text(falls.replace("calciumSilicate()", "dry(0.7)"))
    done = run(pier, "--accuracy", "50")
    assert done.returncode == 0, done.stdout + done.stderr
    found = recorded(pier)
    assert found["collapsed"]
    assert all(c["collapsed"] for c in found["accuracy"]["companions"])
    assert "the work of a run that collapses ends there" in done.stdout


@mark.parametrize("name", ["accuracy", "accuracy/rigid_50_mm_s.log"])
def test_nothing_is_written_through_a_link(pier, name):
    (pier / "other").mkdir()
    (pier / "out" / name).parent.mkdir(parents=True)
    os.symlink(pier / "other", pier / "out" / name)
    done = run(pier, "--accuracy", "20")
    assert done.returncode == 2 and "a symbolic link" in done.stderr
    assert os.listdir(pier / "other") == []


def companions():
    """Ids of processes that are companions of this test's runs."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError), open(f"/proc/{name}/cmdline") as file:
            words = file.read()
            if "pier.py\0" in words and "--checkpoint-every=0\0" in words:
                found.append(int(name))
    return found


@mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_companions_end_with_the_run_and_the_same_command_goes_on(pier, number):
    (pier / "pier.py").write_text(
        SCENE.replace("0.44, 0.324", "1.1, 1.62").replace("until=1", "until=6")
    )
    with open(pier / "log", "w") as log:
        process = subprocess.Popen([*COMMAND, "--accuracy", "50"], cwd=pier, stdout=log, stderr=log)
        while "accuracy: rigid" not in (pier / "log").read_text():
            time.sleep(0.05)
            assert process.poll() is None
        process.send_signal(number)
        status = process.wait(timeout=20)
    assert status == (130 if number != signal.SIGKILL else -9)
    until = time.monotonic() + 10
    while companions():
        assert time.monotonic() < until
        time.sleep(0.1)
    if number == signal.SIGINT:
        done = run(pier, "--accuracy", "50")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "of an interrupted start are taken from" in done.stdout
        # what has ended is not taken again
        assert not (pier / "out" / "accuracy" / "plan.json").exists()


def test_a_run_that_is_resumed_has_its_half_widths_too(pier):
    (pier / "pier.py").write_text(SCENE.replace("until=1", "until=2"))
    # a lean run that ended has no checkpoint: one that draws nothing else keeps it
    began = ["--no-vtk", "--out", "kept", "--accuracy", "20", "--until", "1"]
    for words in (began, ["--resume", "kept", "--until", "1.2"]):
        done = run(pier, *words, command=COMMAND[:2])
        assert done.returncode == 0, done.stdout + done.stderr
    assert "longer push than its companions" in done.stdout
