# SPDX-License-Identifier: GPL-2.0-or-later
"""Results are the user's: what a run may touch, when, and how it ends when something is odd."""

from hosted import *
import socket
import threading
from masonry.model.loading import Loading
from masonry.model.structure import Structure
from masonry.model.restraints import Supports
from masonry.run import checkpoints, lock, run as running
from masonry.run.results import Results
from masonry.run.run import Run
from masonry.run.drawing_program import DrawingProgram
from small_wall import Wall
from test_checkpoints import contents, noSpace, run as playWall

SHORT = ["--until", "0.05", "--rate", "40", "--no-vtk"]
LIGHT = Wall("light", length=0.22, courses=4, precompression=0.0, loadHeight=3.0)


@pytest.fixture(autouse=True)
def undrawn(monkeypatch):
    """Figures take longer than these runs."""
    for name in ("begin", "draw"):
        monkeypatch.setattr(DrawingProgram, name, lambda self, directory: None)


def run(out, *words, **settings):
    """Exit status of a run, refused or not."""
    try:
        return playWall(out, *words, **settings)
    except SystemExit as end:
        return end.code


@pytest.fixture
def finished(tmp_path):
    out = tmp_path / "finished"
    assert run(out, *SHORT) == 0
    return out


def test_a_run_without_rows_leaves_the_results_of_before(finished, monkeypatch, capsys):
    before = contents(finished)

    def spoilt(*patch):
        with monkeypatch.context() as m:
            m.setattr(*patch)
            try:
                return run(finished, *SHORT)
            except RuntimeError as error:
                return str(error)
            finally:
                assert contents(finished) == before

    def stop(self, *words):
        os.kill(os.getpid(), signal.SIGINT)
        return 1.0, 1.0

    def unstable(self, *words):
        raise RuntimeError("unstable")

    full = lambda folder: SimpleNamespace(free=10)
    assert spoilt(shutil, "disk_usage", full) == 2
    assert spoilt(Structure, "build", unstable) == "unstable"
    assert spoilt(Run, "_take", unstable) == "unstable"
    assert spoilt(Supports, "unrest", stop) == 130
    assert "still has the results of an earlier one" in capsys.readouterr().out
    # The other run has its rows now.
    assert run(finished, *SHORT, "--rate", "30") == 0
    assert readRun(str(finished))["options"]["rate"] == 30
    assert sorted(os.listdir(finished)) == sorted(before)


def test_files_that_no_run_has_left_are_refused(finished, tmp_path, capsys):
    own = tmp_path / "own"
    own.mkdir()
    (own / "curve.csv").write_text("my_own_numbers\n1\n")
    (own / "notes.txt").write_text("beside it")
    before = contents(own)
    assert run(own, *SHORT) == 2
    assert contents(own) == before
    assert "own holds curve.csv, which no run has left" in capsys.readouterr().err
    # Beside the record of a run, but with other columns.
    (finished / "curve.csv").write_text("my_own_numbers\n1\n")
    assert run(finished, *SHORT) == 2
    assert (finished / "curve.csv").read_text() == "my_own_numbers\n1\n"
    # run.json of somebody else.
    (own / "curve.csv").unlink()
    (own / "run.json").write_text('{"scene": 1}')
    assert run(own, *SHORT) == 2
    # A folder that a refused run made is gone again.
    assert run(tmp_path / "new", *SHORT, "--set", "bed.cohesion=-1") == 2
    assert not (tmp_path / "new").exists()


def noLocks(file, how):
    raise OSError(errno.ENOLCK, "No locks available")


@mark.parametrize("locks", [True, False])
def test_a_folder_is_for_one_run_at_a_time(finished, monkeypatch, capsys, locks):
    """Also where the file system has no locks, as some network folders: then the text of the file
    counts."""
    if not locks:
        monkeypatch.setattr(lock.fcntl, "flock", noLocks)
    report, tell = os.pipe()
    child = os.fork()
    if child == 0:
        held = Results(str(finished), ["a_mm"], True, "other")
        os.write(tell, b"x")
        time.sleep(60)
        os._exit(int(held is None))
    os.read(report, 1)
    before = contents(finished)
    try:
        who = (
            f"a run of other on host {socket.gethostname()}, process {child}, is writing to"
            f" {finished}"
        )
        for words, resume in ((SHORT, False), ([], True)):
            assert run(finished, *words, resume=resume) == 2
            said = capsys.readouterr().err
            assert who in said and len(said.splitlines()) == 1
        assert contents(finished) == before
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    assert (finished / "run.lock").exists()
    assert run(finished, *SHORT) == 0
    assert not (finished / "run.lock").exists()
    if not locks:
        (finished / "run.lock").write_text('{"host": "elsewhere", "process": 1, "scene": "s"}')
        assert run(finished, *SHORT) == 2
        assert "on host elsewhere, process 1," in capsys.readouterr().err


def test_files_of_a_run_that_was_killed_are_replaced(tmp_path):
    child = os.fork()
    if child == 0:
        Results(str(tmp_path / "r"), ["a_mm"]).append([[1.0]])
        os.kill(os.getpid(), signal.SIGKILL)
    os.waitpid(child, 0)
    assert sorted(os.listdir(tmp_path / "r")) == ["curve.csv", "run.lock"]
    assert run(tmp_path / "r", *SHORT) == 0
    assert not (tmp_path / "r" / "run.lock").exists()


def test_a_slow_push_obeys_at_once_and_keeps_checkpoints(tmp_path, monkeypatch):
    monkeypatch.setattr(running, "LOOK_EVERY", 0.1)
    ends = []
    left = lambda: readCheckpoint(str(tmp_path / "run.checkpoint"))["state"]["left"]

    def end():
        ends.extend((time.perf_counter(), left()))
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(2.0, end).start()
    words = "--rate 0.001 --no-vtk --checkpoint-every 0.002 --until 0.05"
    assert run(tmp_path, *words.split()) == 130
    assert time.perf_counter() - ends[0] < 1
    assert ends[1] > 1000 and left() > 1000  # of the steps of a row


def test_what_is_no_checkpoint_is_refused_at_once(finished, capsys):
    kept = finished / "run.checkpoint"
    for make in (lambda path: os.symlink("nowhere", path), os.mkdir):
        kept.unlink()
        make(kept)
        before = set(os.listdir(finished))
        assert run(finished, resume=True) == 2
        said = capsys.readouterr().err
        assert "run.checkpoint" in said and len(said.splitlines()) == 1
        assert set(os.listdir(finished)) == before


def test_odd_names_and_terminals_end_in_order(tmp_path):
    plain = dict(os.environ, PYTHONIOENCODING="ascii:strict")
    words = ("--quick", "--lean", "--out", tmp_path / "r")
    report = runProgram("couplet", *words, env=plain, text=False)
    assert b"\\xb5s" in report.stdout
    odd = os.fsencode(tmp_path) + b"/caf\xe9"
    report = runProgram("couplet", "--out", os.fsdecode(odd), check=False)
    assert report.returncode == 2 and "is not UTF-8" in report.stderr
    with raises(Refused, match="its name is not UTF-8"):
        Results(os.fsdecode(odd), ["a_mm"])
    assert not os.path.exists(odd)


def test_a_wall_that_falls_before_its_push_has_status_1(tmp_path, monkeypatch):
    monkeypatch.setattr(Loading, "hasSunk", lambda self, down=None: True)
    assert run(tmp_path / "r", *SHORT) == 1
    assert readRun(tmp_path / "r")["collapsed"]


def test_a_wall_that_moves_against_its_push_has_collapsed(tmp_path, capsys):
    """The foot of a tall loading block on slippery joints moves back while its head is pushed."""
    words = ["--rate", "100", "--until", "10", "--no-vtk"]
    slippery = "residualFriction=0.01 friction=0.01 cohesion=0 tensileStrength=0"
    words += [f"--set=bed.{what}" for what in slippery.split()]
    assert run(tmp_path, *words, wall=LIGHT) == 0
    report = "collapsed: at -1.00 mm it moves against its push"
    assert report in capsys.readouterr().out
    assert len(readCurve(tmp_path)["time_s"]) < 1000


def test_no_earlier_checkpoint_is_promised(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(checkpoints, "saveCheckpoint", lambda *words: noSpace(None))
    assert run(tmp_path / "r", *SHORT) == 0
    assert capsys.readouterr().err.endswith("No space left on device\n")
