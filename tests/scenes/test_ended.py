# SPDX-License-Identifier: GPL-2.0-or-later
"""A run ends in order and in time when it is interrupted while it does not step, and when the
system sets a limit."""

from hosted import *
import threading
import yade
from masonry_limit import solver
from masonry.memory import FULL
from masonry.run.run import Run
from masonry.scene import outcome
from masonry_limit.beside_run import NOTE_INTERRUPTED
from masonry.run.drawing_program import DrawingProgram
from small_wall import SMALL, carryOut, parsed

PROMPT = 2.0  # [s] from a signal to the end
SHORT = ["--until", "0.05", "--rate", "40", "--no-vtk"]
HOST = os.path.dirname(os.path.dirname(os.path.abspath(yade.__file__)))


@pytest.fixture
def undrawn(monkeypatch):
    """Figures take longer than these runs."""
    monkeypatch.setattr(DrawingProgram, "draw", lambda self, directory: None)


@pytest.fixture
def signalled():
    """Function that sends this process a signal when something is so; returns the moments at which
    signals were sent."""
    sent, threads = [], []

    def act(number, isSo):
        for _ in range(1000):
            if isSo():
                time.sleep(0.1)
                sent.append(time.monotonic())
                os.kill(os.getpid(), number)
                return
            time.sleep(0.01)

    def watch(*words):
        threads.append(threading.Thread(target=act, args=words))
        threads[-1].start()
        return sent

    yield watch
    for thread in threads:
        thread.join()


def started(out, *words):
    """Exit status of a short run."""
    return carryOut(SMALL, parsed(*SHORT, *words, "--out", str(out)))


@mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_a_bound(tmp_path, undrawn, monkeypatch, signalled, number):
    asked, solved = tmp_path / "asked", solver._solved

    def slow(*words):
        asked.write_text(str(os.getpid()))
        time.sleep(60)

    monkeypatch.setattr(solver, "_solved", slow)
    sent = signalled(number, asked.exists)
    assert started(tmp_path) == 130
    assert time.monotonic() - sent[0] < PROMPT
    gone = f"/proc/{asked.read_text()}"
    time.sleep(0.2)  # a process that was killed with its parent needs a moment to end
    assert not os.path.exists(gone) or "(zombie)" in open(gone + "/status").read()
    run = readRun(tmp_path)
    assert run["interrupted"] and run["bounds"][0]["note"] == NOTE_INTERRUPTED
    monkeypatch.setattr(solver, "_solved", solved)
    assert carryOut(SMALL, parsed("--resume", str(tmp_path))) == 0
    assert readRun(tmp_path)["bounds"][0]["note"] == NOTE_INTERRUPTED  # its stage was over
    assert started(tmp_path / "whole") == 0
    assert readCurve(tmp_path) == readCurve(tmp_path / "whole")


def test_a_signal_ends_drawing(tmp_path, monkeypatch, signalled, capsys):
    slow, begun = tmp_path / "slow", tmp_path / "begun"
    slow.write_text(f"#!/bin/sh\ntouch {begun}\nexec sleep 60\n")
    slow.chmod(0o755)
    monkeypatch.setattr(outcome.sys, "executable", str(slow))
    drawing = lambda: begun.exists() and Scene.present.finished
    sent = signalled(signal.SIGTERM, drawing)
    assert started(tmp_path / "out") == 130
    assert time.monotonic() - sent[0] < PROMPT
    assert "the figures are not drawn; /usr/bin" in capsys.readouterr().out
    assert readRun(tmp_path / "out")["ended"] == "done"


def test_a_drawing_program_that_is_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(outcome.sys, "executable", "/nowhere/python3")
    assert started(tmp_path) == 1
    said = "the figures are not drawn: No such file or directory; what"
    assert said in capsys.readouterr().err
    assert readRun(tmp_path)["peak_base_shear_kN"] > 0


@mark.parametrize("steps", [0, 150])
def test_too_little_memory(tmp_path, monkeypatch, undrawn, capsys, steps):
    take = Run._take

    def full(run, count):
        if run.state.steps >= steps:
            raise MemoryError
        take(run, count)

    monkeypatch.setattr(Run, "_take", full)
    assert started(tmp_path) == 1
    assert capsys.readouterr().err.startswith(FULL + "; what was written before")
    assert readRun(tmp_path)["error"] == FULL


#: Lets a process have 100 MB more than it has.
LIMITED = """
import resource
pages = int(open("/proc/self/statm").read().split()[0])
most = pages * resource.getpagesize() + (100 << 20)
resource.setrlimit(resource.RLIMIT_AS, (most, most))
"""
SCENE = f"""
import sys
sys.path.insert(0, {HOST!r})
import yade
{LIMITED}
import masonry_limit
"""
FIGURES = f"""
import sys
from masonry.numbers import files
from masonry_view import figures
{LIMITED}
sys.exit(files.onFolder(figures.draw, ["nowhere"]))
"""
PRODUCT = """
import numpy as np
np.ones((9, 9)) @ (2 * np.ones((9, 9)))
"""


@mark.parametrize("program", [SCENE + PRODUCT, FIGURES], ids=["scene", "figures"])
def test_too_little_memory_for_numerical_libraries_is_one_sentence(program):
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=30
    )
    assert (done.returncode, done.stderr) == (1, FULL + "\n")


def test_a_clock_that_jumps_changes_nothing(tmp_path, monkeypatch, undrawn):
    folders, words = [tmp_path / "one", tmp_path / "two"], ("--checkpoint-every", "5")
    assert started(folders[0], *words) == 0
    now = iter(range(10**9, 0, -(10**5)))
    monkeypatch.setattr(time, "time", lambda: float(next(now)))
    began = time.monotonic()
    assert started(folders[1], *words) == 0
    one, two = map(readRun, folders)
    assert one["bounds"] == two["bounds"] and one["steps"] == two["steps"]
    assert 0 < two["wall_clock_s"] <= time.monotonic() - began
    assert readCurve(folders[0]) == readCurve(folders[1])


STUDY = """
from masonry_study import Study, lognormal
study = Study("s.py", runs=2, vary={"bed.friction": lognormal(mean=0.5, cov=0.1)})
"""
STONES = """
from masonry import Scene, bricks, materials
scene = Scene("s", bricks.stack(2, (0.3, 0.3, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom"); scene.settle(); scene.finish()
"""


def test_a_limit_of_the_size_of_files_is_no_fault_of_the_scene_of_a_study(tmp_path):
    (tmp_path / "study.py").write_text(STUDY)
    (tmp_path / "s.py").write_text(STONES)
    command = f"ulimit -f 1; exec {sys.executable} -m masonry_study study.py --out out --prepare"
    words = dict(cwd=tmp_path, capture_output=True, text=True, timeout=60)
    done = subprocess.run(["bash", "-c", command], **words)
    assert done.returncode == 1
    _, _, said = done.stderr.rpartition("cannot write ")  # behind what libraries say
    assert "File too large" in said and "scene" not in said
