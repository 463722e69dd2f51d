# SPDX-License-Identifier: GPL-2.0-or-later
"""validation/remake.py knows what makes every result of validation/, in which order, and which of
them are stale."""

from usual import *
import fnmatch

import remake

EVERY = remake.everything()


def committed():
    done = ran(["git", "-C", remake.HERE, "ls-files"])
    return done.stdout.splitlines()


@mark.skipif(not os.path.exists(os.path.join(ROOT, ".git")), reason="no repository of git")
def test_every_figure_and_table_is_made_by_one_result():
    made = [
        f
        for f in committed()
        if f.endswith((".png", "table.md", "walls.md", ".json")) or "/loops_" in f
    ]
    given = {"case.json", "blind.json", "made.json"}  # written by hand, or by remake.py
    made = [f for f in made if os.path.basename(f) not in given and "/reference/" not in f]
    assert len(made) > 50
    for path in made:
        makers = [r.name for r in EVERY.values() if any(fnmatch.fnmatch(path, p) for p in r.makes)]
        assert len(makers) == 1, (path, makers)


def test_results_come_after_those_that_they_need():
    order = list(EVERY)
    for result in EVERY.values():
        for name in result.needs:
            assert order.index(name) < order.index(result.name)
    assert "wall_comp4/rigid" in EVERY["wall_comp6/rigid"].needs


@pytest.fixture
def tree(tmp_path, monkeypatch):
    for folder in ("validation/one", "tests/references", "results/one", "results/other"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "validation/one/run.py").write_text("open('results/one/new', 'w')\n")
    (tmp_path / "tests/references/rigid.json").write_text('{"made by": "a", "x": 1}')
    sources = "validation/one/*.py", "tests/references/rigid*.json"
    programs = ((sys.executable, "validation/one/run.py"),)
    result = remake.Result("one", programs, sources=sources, results=("one",))
    places = dict(ROOT=".", HERE="validation", RESULTS="results")
    places.update(MADE="validation/made.json", README="validation/README.md")
    for name, path in places.items():
        monkeypatch.setattr(remake, name, str(tmp_path / path))
    monkeypatch.setattr(remake, "everything", lambda: {"one": result})
    (tmp_path / "validation/README.md").write_text("\n".join(["a", *remake.MARKS, "b"]))
    return tmp_path, result


def state(result):
    return remake.stateOf(result, remake.readMade(), {"one": result})[0]


def test_a_result_is_stale_when_what_decides_its_numbers_has_changed_and_only_then(tree):
    path, result = tree
    assert state(result) == "unrecorded"
    remake.record(result, remake.fingerprint(result), 60, "abc")
    assert state(result) == "fresh"
    program, reference = path / "validation/one/run.py", path / "tests/references/rigid.json"
    program.write_text('"""What it is."""\n# why\n' + program.read_text())
    reference.write_text('{"made by": "b", "x": 1}')
    assert state(result) == "fresh"  # a comment, and the name of a build
    reference.write_text('{"made by": "b", "x": 2}')
    assert state(result) == "stale"
    remake.record(result, remake.fingerprint(result), 60, "abc")
    program.write_text(program.read_text() + "print(1)\n")
    assert state(result) == "stale"


def test_what_is_stale_is_made_recorded_and_in_the_table(tree, capfd):
    path, result = tree
    folder = path / "results/one"
    program = "import os; os.makedirs('results/one', exist_ok=True); open('results/one/new', 'w'); "
    (path / "validation/one/run.py").write_text(program + "assert os.path.exists('fine')")
    (folder / "old").write_text("of an older state")
    assert remake.main(["--built", "abc"]) == 1
    assert os.listdir(folder) == ["new"]  # what was older is gone
    assert os.path.exists(path / "results/other")
    (folder / "kept").write_text("of the attempt that was stopped")
    (path / "fine").write_text("")
    assert remake.main(["--built", "abc"]) == 0
    assert sorted(os.listdir(folder)) == ["kept", "new"]
    made = json.loads((path / "validation/made.json").read_text())
    assert made["one"]["commit"] == "abc"
    assert "| fresh | abc |" in (path / "validation/README.md").read_text()
    capfd.readouterr()
    assert remake.main(["--built", "abc"]) == 0
    assert capfd.readouterr().out == ""  # nothing is stale
    assert remake.main(["--built", "abc", "--force", "one"]) == 0
    assert os.listdir(folder) == ["new"]
