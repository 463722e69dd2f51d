# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes in plain Python: YADE is found and started, and the run is that of the program yade."""

import importlib.util

import yade
from usual import *

HOST = os.path.dirname(os.path.dirname(os.path.abspath(yade.__file__)))
INSTALLED = os.path.dirname(importlib.util.find_spec("masonry").origin)
SCENE = """
from masonry import Scene, bricks, materials
scene = Scene("plain", bricks.stack(2, (0.3, 0.3, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom"); scene.settle(); scene.finish()
"""
FOUND = f"import sys; sys.path.insert(0, {HOST!r})\n"  # YADE is on sys.path


def environment(**more):
    """That of the tests, without the variable that says how many threads there are."""
    return {**{k: v for k, v in os.environ.items() if k != "OMP_NUM_THREADS"}, **more}


def python(*words, cwd=None, env=None):
    around = dict(cwd=cwd, env=env or environment(), timeout=200)
    command = [sys.executable, *words]
    return ran(command, **around)


def played(tmp_path, begin, *words, end=""):
    """Run a scene in plain Python after some lines, which must not fail."""
    script = tmp_path / "plain.py"
    script.write_text(begin + SCENE + end)
    run = python(str(script), *words, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    return run


def done(code, **more):
    """Run lines of Python, and return what they print."""
    run = python("-c", code, **more)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


# -- how YADE starts -------------------------------------------------------------------------------


@mark.slow
def test_a_scene_finds_yade_and_starts_it_as_it_must(tmp_path):
    begin = "import sys; before = list(sys.argv), list(sys.path)\n"
    end = """
import ctypes, gc, os, socketserver, threading
assert sys.argv == before[0], sys.argv
assert sys.path[:len(before[1])] == before[1], sys.path
paths = [f"/proc/self/fd/{f}" for f in os.listdir("/proc/self/fd")]
sockets = [p for p in paths if os.path.exists(p) and "socket" in os.readlink(p)]
assert not sockets and threading.active_count() == 1, sockets
assert not [o for o in gc.get_objects() if isinstance(o, socketserver.BaseServer)]
assert "OMP_NUM_THREADS" not in os.environ
threads = lambda: print("threads", ctypes.CDLL(None).omp_get_max_threads())
threads()
other = threading.Thread(target=threads)
other.start()
other.join()
"""
    run = played(tmp_path, begin, "--out", "elsewhere", end=end)
    assert run.stdout.count("threads 1\n") == 2 and "plain: at rest" in run.stdout
    assert "Using python version" not in run.stdout and not run.stderr
    assert (tmp_path / "elsewhere" / "run.json").exists()


@mark.slow
def test_threads_are_those_that_are_asked_for(tmp_path):
    code = "from masonry import Scene; from yade import O; print(O.numThreads)"
    assert done(code, env=environment(OMP_NUM_THREADS="2")) == "2\n"
    assert done(code) == "1\n"
    script = tmp_path / "threads.py"
    script.write_text(
        """
import ctypes
from masonry.model import threads
print("steps", threads.allowed())
for host in (False, True):
    threads.beginScene(host)
    print("YADE", ctypes.CDLL(None).omp_get_max_threads())
"""
    )
    usual = min(4, len(os.sched_getaffinity(0)))
    for words, count, host in (([], usual, 1), (["-j1"], 1, 1), (["--threads", "3"], 3, 3)):
        command = ["yade", *words, "-n", "-x", str(script), "-j7"]
        run = ran(command, env=environment())
        assert f"steps {count}\nYADE 1\nYADE {host}\n" in run.stdout


@mark.parametrize(
    "asked, allowed, few, said",
    [(True, 4, 900, True), (False, 4, 900, False), (True, 1, 900, False), (True, 4, 100, False)],
)
def test_fewer_threads_than_were_asked_for_are_remarked_upon(
    monkeypatch, asked, allowed, few, said
):
    from masonry.model import threads

    taken = {1: (few, 1e-5), 4: (1000 - few, 2e-5)}
    records = [
        dict(threads=n, steps=steps, time=steps * each) for n, (steps, each) in taken.items()
    ]
    monkeypatch.setattr(threads, "records", lambda: records)
    monkeypatch.setattr(threads, "_asked", asked)
    monkeypatch.setattr(threads, "_allowed", allowed)
    expected = (
        "4 threads were allowed, and 90 % of the steps used 1, which was quicker: a step took 10"
        " µs, and 20 µs on 4"
    )
    assert threads.remark() == (expected if said else None)


def test_a_process_without_HOME_starts_yade():
    env = {name: value for name, value in environment().items() if name != "HOME"}
    assert done("from masonry import Scene; print('yes')", env=env) == "yes\n"


@mark.slow
def test_a_yade_that_was_imported_before_has_one_thread(tmp_path):
    end = "import ctypes; print('threads', ctypes.CDLL(None).omp_get_max_threads())"
    run = played(tmp_path, FOUND + "import yade\n", end=end)
    assert "threads 1" in run.stdout and "plain: at rest" in run.stdout


@mark.parametrize(
    "code",
    [
        "import masonry, yade; from yade import O; yade.wrapper.MasonryMat",
        "from masonry import *; MasonryMat, Scene, engines, window",
        "import masonry.model.bodies, masonry; masonry.MasonryJoint.set",
        "from masonry import _masonry; import masonry; masonry.commit, masonry.Scene",
        (
            "from masonry.materials import dry;"
            " dry(friction=0.6).joints['bed'].set(friction=0.5, residualFriction=0.5)"
        ),
        (
            "from masonry.run.checkpoints import readCheckpoint; import masonry;"
            " masonry.MasonryJoint.set"
        ),
        "from masonry.numbers import columns; from masonry import Scene",
        FOUND + "import yade, masonry; masonry.Scene, masonry.scene, masonry.MasonryJoint.set",
        FOUND + "import masonry, yade; masonry.Scene, yade.wrapper.MasonryJoint.set",
    ],
)
def test_whatever_is_imported_first(code):
    done(code + "; import importlib, masonry; importlib.reload(masonry).Scene")


@mark.slow
def test_what_reads_results_does_not_start_yade():
    code = """
import sys, masonry, masonry_view.measure, masonry_view.notebook, masonry_study, masonry.run.batch
from masonry import bricks, fields, numbers
assert not hasattr(masonry, "__wrapped__") and "Scene" in dir(masonry)
bricks.Wall(1.1, 0.81).joints()
print([name for name in sys.modules if name.split(".")[0] == "yade"])
"""
    assert done(code) == "[]\n"
    code = "import masonry\nmasonry.Scenes"
    assert "module 'masonry' has no attribute 'Scenes'" in python("-c", code).stderr


@mark.slow
def test_the_importer_of_yade_works_before_and_after(tmp_path):
    (tmp_path / "yadeimport.py").symlink_to("/usr/bin/yade")
    first = "import sys; sys.path.insert(0, '.'); import yadeimport\n"
    run = played(tmp_path, first)
    assert "plain: at rest" in run.stdout
    after = (
        "from yadeimport import *\nassert O.iter > 0 and utils.sphere and yade.wrapper.MasonryMat"
    )
    played(tmp_path, "import sys; sys.path.insert(0, '.')\n", end=after)


@mark.slow
def test_words_of_a_notebook_are_not_those_of_the_scene(tmp_path):
    begin = """
import sys, types
import IPython.core.getipython
IPython.core.getipython.get_ipython = lambda: types.SimpleNamespace(kernel=True)
sys.argv = ['ipykernel_launcher.py', '-f', 'x.json']
"""
    end = "assert sys.argv[1:] == ['-f', 'x.json']"
    played(tmp_path, begin.lstrip(), end=end)


# -- where it cannot -------------------------------------------------------------------------------

ASK = """
import masonry
try:
    masonry.Scene
except ImportError as error:
    print("REFUSED:", error)
from masonry import bricks
print(len(bricks.stack(2, (0.3, 0.3, 0.2))))
"""


def test_a_machine_without_yade_gives_a_sentence(tmp_path):
    env = environment(PATH=str(tmp_path), YADE_PREFIX=str(tmp_path))
    said = done(ASK, env=env)
    assert "REFUSED: masonry runs in YADE, which is not installed" in said
    assert "apt-get install yade" in said and said.endswith("2\n")
    assert "Traceback" not in said


def test_another_python_gives_the_one_that_yade_needs(tmp_path):
    program = tmp_path / "yade"
    text = open("/usr/bin/yade").read()
    program.write_text(re.sub(r"^#!.*", "#!/usr/bin/python3.99", text, 1))
    program.chmod(0o755)
    said = done(ASK, env=environment(PATH=str(tmp_path)))
    assert "REFUSED: the YADE of this machine is built for Python 3.99" in said
    assert said.count("run the script with /usr/bin/python3.99") == 1


def test_a_virtual_environment_without_what_yade_needs_gives_a_sentence(tmp_path):
    (tmp_path / "masonry").symlink_to(INSTALLED)
    env = environment(PYTHONPATH=str(tmp_path))
    run = python("-S", "-c", ASK.split("from masonry import bricks")[0], env=env)
    assert "REFUSED: YADE needs the Python module '" in run.stdout, run.stderr
    assert "--system-site-packages" in run.stdout


@mark.slow
def test_a_source_tree_without_the_plugin_says_how_to_build_it(tmp_path):
    shutil.copytree(os.path.join(ROOT, "scripts", "masonry"), tmp_path / "masonry")
    env = environment(PYTHONPATH=str(tmp_path))
    hide = (
        "import sys; sys.path[1:] = [p for p in sys.path[1:] if not (p != %r and"
        " __import__('glob').glob(p + '/masonry/_masonry*.so'))]\n"
    )
    said = done(hide % str(tmp_path) + ASK, env=env)
    assert "REFUSED: the masonry plugin is not built" in said and "setup.sh" in said


@mark.slow
def test_a_scene_beside_the_sources_uses_the_installed_package(tmp_path):
    shutil.copytree(os.path.join(ROOT, "scripts", "masonry"), tmp_path / "masonry")
    end = "import sys; print(sys.modules['masonry.scene'].__file__)"
    run = played(tmp_path, "", end=end)
    assert run.stdout.splitlines()[-1].startswith(INSTALLED)


# -- the same as the program yade ------------------------------------------------------------------

BANNER = (
    "Welcome to Yade",
    "Using python version",
    "TCP python prompt",
    "XMLRPC info",
    "Running script",
)
#: Times of the clock, and what is as fast as the machine.
TIMES = re.compile(
    r'"(date|seconds|setup|steps|rows|frames|wall_clock_s|microseconds_per_step'
    r'|nanoseconds_per_subcontact_step|out)": .*'
)

#: The same in a report: when the run ended, and how long it took; and numbers of its picture, whose
#: last digits depend on where LAPACK finds its arrays in the memory.
CLOCK = re.compile(
    (
        r"\d{4}-\d\d-\d\d [\d:]+ UTC|time of (the run|a step[^<]*)</th><td[^>]*>[^<]*|<script"
        r" type.*?</script>"
    ),
    re.S,
)


def both(tmp_path, name, *words):
    """A scene of scripts/ in YADE and in plain Python, in folders of the same name: pairs of
    process and folder."""
    scene = scenePath(name)
    for how in (["yade", "-n", "-x"], [sys.executable]):
        folder = tmp_path / how[0].rpartition("/")[2]
        folder.mkdir(exist_ok=True)
        around = dict(cwd=folder, env=environment(), timeout=200)
        command = [*how, scene, *words]
        run = ran(command, **around)
        yield run, folder / "out"


def lines(run, folder):
    """What a run prints, without YADE's own lines and what depends on the clock: progress, and
    whether it waited for a figure."""
    text = (run.stdout + run.stderr).replace(str(folder.parent), "")
    kept = [n for n in text.splitlines() if not n.startswith(BANNER)]
    kept = [re.sub(r"in \d+ µs; the run took [\d.]+ s|^(yade|python3)\b", "", n) for n in kept]
    return [n for n in kept if "steps/s" not in n and not n.startswith("waiting for ")]


@mark.slow
@mark.parametrize("name", ["couplet", "arch", pytest.param("wall_comp1", marks=mark.long)])
def test_a_scene_is_the_same_in_plain_python(tmp_path, name):
    (one, first), (two, second) = both(tmp_path, name, "--out", "out", "--quick")
    assert one.returncode == two.returncode == 0, one.stderr + two.stderr
    assert lines(one, first) == lines(two, second)
    names = sorted(os.listdir(first))
    assert sorted(os.listdir(second)) == names and "curve.csv" in names
    for name in set(names) - {"run.json", "run.checkpoint", "report.html"}:
        assert (first / name).read_bytes() == (second / name).read_bytes(), name
    pages = [CLOCK.sub("", (f / "report.html").read_text()) for f in (first, second)]
    assert pages[0] == pages[1]
    records = [TIMES.sub("", (f / "run.json").read_text()) for f in (first, second)]
    assert records[0] == records[1]


@mark.slow
@mark.parametrize("words", [["--rate", "fast"], ["--resume", "nowhere"]])
def test_what_is_refused_is_refused_alike(tmp_path, words):
    (one, first), (two, second) = both(tmp_path, "couplet", *words)
    assert one.returncode == two.returncode != 0
    ours = lambda n: "File " not in n and not n.startswith(("  ", "usage"))
    alike = [list(filter(ours, lines(*run))) for run in ((one, first), (two, second))]
    assert alike[0] == alike[1]


@mark.slow
def test_the_help_is_that_of_the_program_that_runs_the_scene(tmp_path):
    (one, first), (two, second) = both(tmp_path, "couplet", "--help")
    assert one.returncode == two.returncode == 0
    assert "usage: yade couplet.py" in one.stdout
    assert "usage: python3 couplet.py" in two.stdout
    rest = [n.partition("options:")[2] for n in (one.stdout, two.stdout)]
    assert rest[0] and rest[0] == rest[1]
