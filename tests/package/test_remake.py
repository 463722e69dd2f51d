# SPDX-License-Identifier: GPL-2.0-or-later
"""validation/remake.py knows what makes every result of validation/, in which order, and which of
them are stale."""

from usual import *
import ast
import fnmatch
import glob

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
    known = {path.split("/")[0] for path in committed() if "/" in path} - {"benchmark"}
    assert known == {name.split("/")[0] for name in EVERY}
    made = [f for f in made if os.path.basename(f) not in given and "/reference/" not in f]
    assert len(made) > 50
    for path in made:
        makers = [r.name for r in EVERY.values() if any(fnmatch.fnmatch(path, p) for p in r.makes)]
        assert len(makers) == 1, (path, makers)


PROGRAMS = sorted(glob.glob("**/*.py", root_dir=remake.HERE, recursive=True))


def nodesOf(path):
    with open(os.path.join(remake.HERE, path)) as file:
        return [*ast.walk(ast.parse(file.read()))]


def given(module):
    """The names that programs with this name of a file define or import."""
    paths = [path for path in PROGRAMS if os.path.basename(path) == f"{module}.py"]
    nodes = [node for path in paths for node in nodesOf(path)]
    names = {n.name for n in nodes if isinstance(n, (ast.FunctionDef, ast.ClassDef, ast.alias))}
    return names | {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


@mark.parametrize("path", PROGRAMS)
def test_what_a_program_takes_from_packages_and_other_programs_is_there(path):
    nodes = nodesOf(path)
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and node.module.startswith("masonry"):
            names = ", ".join(one.name for one in node.names)
            exec(f"from {node.module} import {names}", {})
    imports = [node for node in nodes if isinstance(node, ast.Import)]
    names = {name: given(name) for node in imports for name in [one.name for one in node.names]}
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            known = names.get(node.value.id)
            assert not known or node.attr in known, f"{node.value.id}.{node.attr}"


def test_all_is_made_in_two_hours_on_two_cores():
    made = remake.readMade()
    minutes = [remake.minutesOf(result, made) for result in EVERY.values()]
    assert sum(minutes) < 240 and max(minutes) < 60


def test_results_come_after_those_that_they_need():
    order = list(EVERY)
    for result in EVERY.values():
        for name in result.needs:
            assert order.index(name) < order.index(result.name)
    assert "wall_comp4/rigid" in EVERY["wall_comp6/rigid"].needs


def writeReference(path, force, build="a"):
    numbers = {"fingerprint": build, "force on the base [N]": f"{force.hex()} {0.5.hex()}"}
    content = {"made by": build, "instants": {"pressed": numbers}}
    (path / "tests/references/rigid.json").write_text(json.dumps(content))


@pytest.fixture
def tree(tmp_path, monkeypatch):
    for folder in ("validation/one", "tests/references", "results/one", "results/other"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "validation/one/run.py").write_text("open('results/one/new', 'w')\n")
    writeReference(tmp_path, force=1000.0)
    sources = "validation/one/*.py", "tests/references/rigid*.json"
    programs = ((sys.executable, "validation/one/run.py"),)
    result = remake.Result("one", programs, 1, sources=sources, results=("one",))
    places = dict(ROOT=".", HERE="validation", RESULTS="results", MADE="validation/made.json")
    for name, path in places.items():
        monkeypatch.setattr(remake, name, str(tmp_path / path))
    monkeypatch.setattr(remake, "everything", lambda: {"one": result})
    for path, name in (("README.md", "remake.py"), ("one/README.md", "one")):
        marks = f"<!-- {name}: begin -->\n<!-- {name}: end -->\n"
        (tmp_path / "validation" / path).write_text(f"a\n{marks}b")
    for words in ("init -q", "add -A", "-c user.name=a -c user.email=a commit -qm a"):
        assert ran(["git", "-C", str(tmp_path), *words.split()]).returncode == 0
    return tmp_path, result, remake.git("rev-parse", "HEAD")


def record(result, commit):
    remake.record(result, {"fingerprint": remake.fingerprint(result), "minutes": 1}, commit)


def state(result):
    return remake.stateOf(result, remake.readMade(), {"one": result})[0]


def test_a_result_is_stale_when_what_decides_its_numbers_has_changed_and_only_then(tree):
    path, result, commit = tree
    assert state(result) == "unrecorded"
    record(result, commit)
    assert state(result) == "fresh"
    program = path / "validation/one/run.py"
    program.write_text('"""What it is."""\n# why\n' + program.read_text())
    writeReference(path, force=1000.9, build="b")
    assert state(result) == "fresh"  # a comment, the name of a build, and 0.09 % of the force
    writeReference(path, force=1001.1)
    assert state(result) == "stale"
    writeReference(path, force=1000.0)
    program.write_text(program.read_text() + "print(1)\n")
    assert state(result) == "stale"
    record(result, commit)
    assert state(result) == "fresh"
    record(result, "0000000")  # a commit that git has not
    assert state(result) == "stale"


def test_what_is_stale_is_made_recorded_and_in_the_tables(tree, capfd):
    path, result, commit = tree
    folder = path / "results/one"
    program = "import os; os.makedirs('results/one', exist_ok=True); open('results/one/new', 'w'); "
    program += "assert os.path.exists('fine'); "
    program += "print('so:\\n| a |\\n|---|\\nwell\\n| 1 |\\n'); raise SystemExit(1)"
    (path / "validation/one/run.py").write_text(program)
    (folder / "old").write_text("of an older state")
    assert remake.main(["--built", commit]) == 1
    said = capfd.readouterr().out
    assert "not made: one, exit status 1 of" in said and "made 0 of 1 results" in said
    assert os.listdir(folder) == ["new"]  # what was older is gone
    assert os.path.exists(path / "results/other")
    (folder / "kept").write_text("of the attempt that was stopped")
    (path / "fine").write_text("")
    assert remake.main(["--built", commit]) == 0
    assert sorted(os.listdir(folder)) == ["kept", "new"]
    made = json.loads((path / "validation/made.json").read_text())
    assert made["one"]["commit"] == commit and made["one"]["limits missed"]
    assert f"| fresh | {commit} |" in (path / "validation/README.md").read_text()
    assert (
        "begin -->\n| a |\n|---|\n| 1 |\n<!-- one: end"
        in (path / "validation/one/README.md").read_text()
    )
    capfd.readouterr()
    assert remake.main(["--built", commit]) == 0
    assert capfd.readouterr().out == "made 0 of 0 results in 0 min\n"  # nothing is stale
    assert remake.main(["--built", commit, "--force", "one"]) == 0
    assert os.listdir(folder) == ["new"]


def test_a_failure_stops_only_what_needs_it(tree, monkeypatch):
    path, result, commit = tree
    (path / "validation/one/run.py").write_text("import sys; sys.exit(sys.argv[1] == 'bad' and 3)")
    of = lambda name, *needs: remake.Result(
        name, ((sys.executable, "validation/one/run.py", name),), 1, needs=needs
    )
    every = {r.name: r for r in (of("bad"), of("after", "bad"), of("good"), of("last", "good"))}
    failed = remake.makeAll([every["last"], *every.values()], every, 2, commit)
    assert failed["after"] == "needs bad" and failed["bad"].startswith("exit status 3 of")
    assert set(remake.readMade()) == {"good", "last"}
