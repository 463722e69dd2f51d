# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs that are killed, interrupted or stopped by a full disk, and resumed. Their curve must be
that of a whole run."""

from hosted import *
from pathlib import Path
from masonry.run import frame_writer, readings
from masonry.run.results import Results
from masonry.run.run import Run
from small_wall import SMALL, Wall, carryOut, parsed, scene as runScript


def contents(folder):
    """Contents of all files of a folder by name; None of what is no file."""
    paths = Path(folder).iterdir()
    return {p.name: p.read_bytes() if p.is_file() else None for p in paths}


def files(folder):
    """Contents of the files that a resumed run and a whole one must have in common, byte for byte.

    The mechanism of limit analysis is none of them: the process that finds it writes it at its end,
    and a kill comes before.
    """
    wanted = (".csv", ".vtu", ".vtp", ".pvd")
    found = contents(folder).items()
    return {n: c for n, c in found if n.endswith(wanted) and "mechanism" not in n}


PUSH = ["--until", "0.3", "--vtk-every", "0.1", "--rate", "40"]
LOOPS = ["--history", "0.1,0.25x2", "--rate", "40", "--vtk-every", "0.1"]


def run(out, *words, wall=SMALL, resume=False):
    where = ["--resume" if resume else "--out", str(out)]
    return carryOut(wall, parsed(*where, *words))


@pytest.fixture
def at(monkeypatch):
    """Do something just before the n-th ``advance`` from now on."""

    def plan(n, act):
        count = [n]

        def advance(self, steps):
            count[0] -= 1
            if count[0] == 0:
                act(self)
            original(self, steps)

        original = at.original
        monkeypatch.setattr(Run, "advance", advance)

    at.original = Run.advance
    return plan


def interrupt(run):
    os.kill(os.getpid(), signal.SIGINT if run.state.steps % 2 else signal.SIGTERM)


CANTILEVER = Wall(loadHeight=0.6, riding=False)  # under rollers


def interrupted(at, start, out, every):
    """Interrupt a run before every so many-th ``advance`` until it ends; ``start`` gets whether it
    is resumed. What was kept."""
    kept = []
    while True:
        at(every, interrupt)
        status = start(bool(kept))
        if status == 0:
            return kept
        assert status == 130
        kept.append(readCheckpoint(str(out / "run.checkpoint"))["state"])


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A push that was not disturbed."""
    out = tmp_path_factory.mktemp("whole")
    assert run(out, *PUSH) == 0
    return files(out)


@mark.parametrize("blocks", ["rigid", "deformable"])
@mark.parametrize("path", ["shear", "closure-shear"])
def test_a_couplet_interrupted_in_every_move(tmp_path, at, blocks, path):
    words = f"--path {path} --until 0.05 --rate 20 --closure 0.02 --blocks {blocks}"
    begin = lambda out: runScript("couplet", *words.split(), "--out", str(out))
    assert begin(tmp_path / "whole") == 0
    out = tmp_path / "broken"
    start = lambda again: runScript("couplet", "--resume", str(out)) if again else begin(out)
    moves = {one["number"] for one in interrupted(at, start, out, 700)}
    assert moves == ({1, 2, 3} if path == "shear" else {1, 2})
    assert files(out) == files(tmp_path / "whole")


def test_a_finished_run_can_be_pushed_on(tmp_path, whole):
    assert run(tmp_path, *PUSH, "--until", "0.15") == 0
    assert run(tmp_path, "--until", "0.3", resume=True) == 0
    assert files(tmp_path) == whole
    assert readRun(tmp_path)["options"]["rate"] == 40


def test_frames_can_begin_and_end_with_a_resumed_run(tmp_path, whole):
    assert run(tmp_path, *PUSH, "--no-vtk", "--until", "0.15") == 0
    args = parsed("--resume", str(tmp_path), "--until", "0.3")
    args.no_vtk = False
    assert carryOut(SMALL, args) == 0
    found = files(tmp_path)
    frames = [n for n in found if n.endswith("vtu")]
    assert frames == ["blocks_0000.vtu", "blocks_0001.vtu"]  # at 0.2 mm and the end
    assert found["curve.csv"] == whole["curve.csv"]


@mark.parametrize("rows", [0, 29])
def test_a_run_that_fails_is_taken_up_there(tmp_path, monkeypatch, rows, whole):
    read, count = readings.Reading, [rows + 1]

    def fail(model):
        count[0] -= 1
        if count[0] == 0:
            raise OSError("a pipe that broke")
        return read(model)

    monkeypatch.setattr(readings, "Reading", fail)
    with raises(OSError, match="a pipe that broke"):
        run(tmp_path, *PUSH)
    assert len((tmp_path / "curve.csv").read_text().splitlines()) == 1 + rows
    assert run(tmp_path, resume=True) == 0
    assert files(tmp_path) == whole


def test_a_run_goes_on_after_a_full_disk(tmp_path, at, capsys, monkeypatch, whole):
    kept = tmp_path / "run.checkpoint"

    def fill(run):
        run.checkpoints.write()
        before = kept.read_bytes()
        with monkeypatch.context() as full:
            full.setattr(os, "fsync", noSpace)
            run.checkpoints.write()
        assert kept.read_bytes() == before

    at(30, fill)
    assert run(tmp_path, *PUSH) == 0
    said = f"no checkpoint could be written to {kept}: [Errno 28] No space left on"
    assert said in capsys.readouterr().err
    assert files(tmp_path) == whole
    # The disk has room again.
    assert readCheckpoint(str(kept))["state"]["memory"]["moved"] > 0.25


@mark.parametrize("lost", ["curve.csv", "joints_0001.vtp", "run.json.new"])
def test_results_wait_for_room(tmp_path, at, capsys, monkeypatch, lost, whole):
    monkeypatch.setattr(frame_writer, "SLOW_FRAME", math.inf)  # none is written beside
    out = tmp_path / "full"

    def fill(run):
        if lost == "curve.csv":
            full = os.open("/dev/full", os.O_WRONLY)
            os.dup2(full, run.results._file.fileno())
            os.close(full)
        elif lost == "run.json.new":
            monkeypatch.setattr(Results, "close", withoutSpace(Results.close))
        else:
            os.symlink("/dev/full", out / lost)

    def withoutSpace(close):
        def closed(self):
            with monkeypatch.context() as disk:
                disk.setattr(os, "fsync", noSpace)
                close(self)

        return closed

    at(2 if lost == "joints_0001.vtp" else 30, fill)
    assert run(out, *PUSH) == 1
    said = capsys.readouterr()
    monkeypatch.undo()
    lost = lost.removesuffix(".new")
    assert f"{lost}: No space left on device; what was written before" in said.err
    assert f"--resume {out} goes on from here" in said.out
    assert run(out, resume=True) == 0
    assert files(out) == whole


def test_a_lost_frame_is_said_and_in_no_list(tmp_path, at, capsys, monkeypatch):
    out = tmp_path / "full"
    monkeypatch.setattr(frame_writer, "SLOW_FRAME", -1)  # all are written beside the run
    at(2, lambda run: os.symlink("/dev/full", out / "joints_0001.vtp"))
    assert run(out, *PUSH) == 1
    said = capsys.readouterr().err
    assert re.search(r"the frame at [\d.]+ s is lost: .*No space left on dev", said)
    os.remove(out / "joints_0001.vtp")
    assert run(out, resume=True) == 0
    for name in "blocks", "joints":
        listed = re.findall(r'file="(.*?)"', (out / f"{name}.pvd").read_text())
        assert len(listed) > 2 and all((out / file).exists() for file in listed)


# -- rows that wait --------------------------------------------------------------------------------


def test_a_row_waits_for_a_fifth_of_a_second_at_most(tmp_path, at):
    """While steps are slow, every row is written at once; while they are fast, several rows are
    written together."""
    seen = []

    def look(run):
        read = run.readings.count
        seen.append((read, len(readCurve(tmp_path)["time_s"])))
        at(1, slow)

    def slow(run):
        time.sleep(0.15)
        at(1, look)

    at(2, slow)
    assert run(tmp_path, *PUSH, "--no-vtk", "--until", "0.1") == 0
    assert len(seen) > 3
    assert all(written == read for read, written in seen)
    assert seen[-1][0] == seen[0][0] + 2 * (len(seen) - 1)


@mark.parametrize("end", ["checkpoint", "interrupt", "error"])
def test_rows_that_wait_are_kept(tmp_path, at, monkeypatch, end):
    def act(run):
        waiting = len(run.readings.waiting)
        assert waiting > 1
        seen.append(len(run.results.rows) + waiting)
        if end == "checkpoint":
            run.args.checkpoint_every = 1e-9  # due after these steps
            at(1, lambda run: seen.append(len(readCurve(tmp_path)["time_s"])))
        elif end == "interrupt":
            interrupt(run)
        else:
            raise OSError("a pipe that broke")

    seen = []
    monkeypatch.setattr("masonry.run.readings.FLUSH_EVERY", 1e9)
    at(30, act)
    with raises(OSError) if end == "error" else contextlib.nullcontext():
        run(tmp_path, *PUSH, "--no-vtk")
    rows = len(readCurve(tmp_path)["time_s"])
    if end == "checkpoint":
        assert seen[1] == seen[0] and rows > seen[0]
    else:
        assert rows == seen[0]


# -- what is refused -------------------------------------------------------------------------------


@pytest.fixture
def broken(tmp_path, at):
    out = tmp_path / "broken"
    at(20, interrupt)
    assert run(out, *PUSH, "--set", "bed.cohesion=2e5") == 130
    return out


def refused(out, *words, wall=SMALL):
    """Exit status of a run that is refused. The refusal must not change the folder."""
    everything = contents(out)
    try:
        status = run(out, *words, wall=wall, resume=True)
    except SystemExit as end:
        status = end.code
    assert contents(out) == everything
    return status


@mark.parametrize(
    "words, message",
    [
        (["--rate", "10"], "a run goes on as it began: --rate is 40.0"),
        (["--blocks", "deformable", "--divisions", "2"], "is rigid, --divisions is 1"),
        (["--set", "bed.cohesion=1e5"], "--set is [('bed', 'cohesion', '2e5')]"),
        (["--out", "elsewhere"], "--out is "),
        (["--until", "0.001"], "(--until 0.001): the run is at 0."),
    ],
)
def test_options_that_would_change_the_run_are_refused(broken, capsys, words, message):
    assert refused(broken, *words) == 2
    assert message in capsys.readouterr().err


def test_links_are_not_taken_up(broken, tmp_path, capsys):
    other = tmp_path / "other"
    other.write_text("of the user")
    (broken / "curve.csv").unlink()
    os.symlink(other, broken / "curve.csv")
    names = set(os.listdir(broken))
    assert run(broken, resume=True) == 2
    said = capsys.readouterr().err
    assert "curve.csv" in said and "a symbolic link" in said and len(said.splitlines()) == 1
    assert set(os.listdir(broken)) == names and other.read_text() == "of the user"


def test_a_script_whose_last_word_was_refused_goes_on_when_mended(tmp_path):
    text = """
from masonry import Scene, bricks, materials
arguments = ["--no-vtk", {!r}, {!r}]
scene = Scene("s", bricks.Wall(0.44, 0.162), materials.calciumSilicate(), arguments=arguments)
base, top = scene.platen("bottom"), scene.platen("top")
scene.press(top, 1e5)
scene.settle()
{}
scene.finish()
"""
    push = "scene.push(top, 0.05, rate=20)"
    exec(text.format("--out", str(tmp_path / "whole"), push), {})
    refused = "try: scene.release(top, 'x')\nexcept ValueError: pass"
    exec(text.format("--out", str(tmp_path / "mended"), refused), {})
    assert readRun(tmp_path / "mended")["error"] == "release: top is not held along x"
    exec(text.format("--resume", str(tmp_path / "mended"), push), {})
    assert files(tmp_path / "mended") == files(tmp_path / "whole")


def test_options_that_say_the_same_are_welcome(broken):
    words = ["--rate", "40", "--set", "bed.cohesion=2e5", "--checkpoint-every", "1"]
    assert run(broken, *words, resume=True) == 0


def test_what_cannot_be_taken_up_is_refused(broken, capsys):
    def says(message, wall=SMALL):
        assert refused(broken, wall=wall) == 2
        error = capsys.readouterr().err
        assert message in error and len(error.splitlines()) == 1

    kept = broken / "run.checkpoint"
    data, text = kept.read_bytes(), readCheckpoint(str(kept))
    for change, message in (
        (dict(stage="dance"), "of another version of the plugin: stage 'dance'"),
        (dict(luck=1), "of another version of the plugin"),
    ):
        saveCheckpoint(str(kept), dict(text, state=dict(text["state"], **change)))
        says(message)
    kept.write_bytes(data)
    says("holds a run of small, this is other", Wall(name="other"))
    says("run.checkpoint is of another scene: its blocks are others", Wall(courses=7))
    kept.write_bytes(data[:-9])
    says("run.checkpoint is cut short: ")
    saveCheckpoint(str(kept), "a user's own")
    says("was not left by a run in stages")


def test_another_build_or_number_of_threads_is_reported(broken, capsys):
    kept = str(broken / "run.checkpoint")
    text = readCheckpoint(kept)
    text["host"].update(threads=7, build="v0")
    saveCheckpoint(kept, text)
    capsys.readouterr()
    assert run(broken, resume=True) == 0
    out = capsys.readouterr().out
    assert "note: the checkpoint was made with threads 7, this run has 1" in out
    assert "note: the checkpoint was made with build v0, this run has " in out
    assert "made with masonry" not in out  # the version is the same
