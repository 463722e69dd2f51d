# SPDX-License-Identifier: GPL-2.0-or-later
"""The core finds its wings beside itself, says which one is missing, and where old modules are."""

from usual import *
import glob
import importlib.util

import masonry
from masonry import moved

INSTALLED = os.path.dirname(masonry.__path__[0])
WINGS = "view limit capacity study".split()
WHERE = f"""
import os, masonry
folder = os.path.dirname(masonry.__path__[0])
for wing in {WINGS}:
    path = __import__("masonry_" + wing).__path__
    assert list(path) == [os.path.join(folder, "masonry_" + wing)], (wing, list(path), folder)
print("one folder:", folder)
"""
SCENE = """
from masonry import Scene, bricks, materials

scene = Scene("wall", bricks.Wall(0.44, 0.243), materials.calciumSilicate(), rate=50)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.settle()
scene.push(top, 0.2)
{more}
scene.finish()
"""


@pytest.fixture
def clone(tmp_path):
    """The packages of a clone, which have no plugin."""
    for name in ("masonry", *(f"masonry_{wing}" for wing in WINGS)):
        ignored = shutil.ignore_patterns("*.so", "__pycache__")
        shutil.copytree(os.path.join(ROOT, "scripts", name), tmp_path / name, ignore=ignored)
    return tmp_path


@mark.parametrize("program", ["yade", "python", "-m"])
def test_core_and_wings_come_from_the_folder_of_the_plugin(clone, program):
    (clone / "where.py").write_text(WHERE)
    (clone / "masonry_view" / "where.py").write_text("raise SystemExit('of the clone')")
    command = {
        "yade": ["yade", "-n", "-x", "where.py"],
        "python": [sys.executable, "where.py"],
        "-m": [sys.executable, "-m", "masonry_view.measure", "--help"],
    }[program]
    done = ran(command, cwd=clone, env={**os.environ, "PYTHONPATH": INSTALLED})
    assert done.returncode == (2 if program == "-m" else 0), done.stdout + done.stderr
    if program != "-m":
        assert f"one folder: {INSTALLED}" in done.stdout


def without(clone, wing, more=""):
    """A scene with a core that has the plugin beside it, and without a wing: the process."""
    (plugin,) = glob.glob(os.path.join(glob.escape(INSTALLED), "masonry", "_masonry*.so"))
    shutil.copy(plugin, clone / "masonry")
    shutil.rmtree(clone / f"masonry_{wing}")
    (clone / "scene.py").write_text(SCENE.format(more=more))
    words = ["yade", "-n", "-x", "scene.py", "--out", "results"]
    return ran(words, cwd=clone, env={**os.environ, "PYTHONPATH": str(clone)})


def test_a_run_without_limit_analysis_has_no_bound(clone):
    done = without(clone, "limit")
    assert done.returncode == 0, done.stdout + done.stderr
    run = json.loads((clone / "results" / "run.json").read_text())
    assert "bounds" not in run and run["peak_base_shear_kN"] > 0
    assert "limit analysis" not in done.stdout


def test_a_command_whose_wing_is_missing_names_the_package(clone):
    done = without(clone, "limit", "scene.bound(top)")
    assert done.returncode
    assert "bound needs the package masonry_limit, which is not installed" in done.stderr


def test_a_run_without_the_viewer_has_its_numbers_and_no_figures(clone):
    done = without(clone, "view")
    assert done.returncode == 0, done.stdout + done.stderr
    files = set(os.listdir(clone / "results"))
    assert {"curve.csv", "run.json"} < files
    assert not {"curve.png", "report.html"} & files


@mark.parametrize(
    "old, new",
    [
        ("figures", "masonry_view.figures"),
        ("study", "masonry_study"),
        ("study.report", "masonry_study.report"),
    ],
)
def test_an_old_program_says_the_new_one(old, new):
    done = ran([sys.executable, "-m", f"masonry.{old}", "results"])
    said = f"masonry.{old} has moved: /usr/bin/python3 -m {new}\n"
    assert (done.returncode, done.stderr) == (2, said)


@mark.parametrize("old, new", moved.MODULES.items())
def test_an_old_import_says_the_new_one(old, new):
    with raises(ModuleNotFoundError, match=f"^{old} has moved: it is {new} now"):
        __import__(old)
    assert importlib.util.find_spec(new)


def test_an_old_name_says_the_new_one():
    with raises(ModuleNotFoundError, match="masonry.columns has moved: it is masonry.numbers"):
        from masonry import columns  # noqa: F401


def test_a_module_that_never_was_is_missing_as_others():
    with raises(ModuleNotFoundError, match="No module named 'masonry.nothing'"):
        __import__("masonry.nothing")
