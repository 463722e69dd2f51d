# SPDX-License-Identifier: GPL-2.0-or-later
"""Studies that run: here, killed at random moments, on Slurm, and by plain yade-batch; always with
the same study.csv."""

from commands import *
from masonry.run import batch
from masonry.numbers.cracks import failureMode
from masonry_view.measure import measure
from masonry.numbers.files import readRun

pytest.importorskip("openturns", reason="python3-openturns is not installed")

SMALL = os.path.join(HERE, "small.py")
STUDY = f"""
from masonry_study import Study, field, lognormal
study = Study({SMALL!r}, runs=4, seed=1,
    options={{"rate": 2, "until": 1, "checkpoint_every": 0.002}},
    vary={{"bed.friction": lognormal(mean=0.43, cov=0.05), "joints": ["softening", "cyclic"],
           ("bed.cohesion", "bed.tensileStrength"): field(cov=0.2, length=0.3)}})
"""
#: Generations of processes after the command: what imports YADE, its copies that run rows, and
#: those that run scenes.
WARM, ROWS, SCENES = 1, 2, 3


def write(folder, text=STUDY):
    path = folder / "study.py"
    path.write_text(text)
    return path


def family(process):
    """Ids of a process and of all that it has started and that live, by generations."""
    every = [line.split() for line in run("ps", "-e", "-o", "pid=,ppid=").stdout.splitlines()]
    found = [[str(process.pid)]]
    while found[-1]:
        found.append([pid for pid, parent in every if parent in found[-1]])
    return [[*map(int, one)] for one in found] + [[]] * SCENES


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study that was not disturbed: its folder, and what it said."""
    folder = tmp_path_factory.mktemp("whole")
    return folder / "out", done(write(folder), "--out", folder / "out", "--jobs", "2")


def test_a_study_runs_all_rows_once(whole):
    out, message = whole
    assert "4 of 4 rows" in message and "4 ended" in message
    assert sorted(ended(out)) == ["0001", "0002", "0003", "0004"]
    rows = table(out)
    assert [row["status"] for row in rows] == ["ended"] * 4
    field = "bed.cohesion+bed.tensileStrength"
    for row, asked in zip(rows, batch.readTable(str(out / "table.txt")).values()):
        folder = out / "rows" / row["run"]
        found = readRun(folder)
        assert float(row["peak_base_shear_kN"]) == found["peak_base_shear_kN"] > 1
        friction = found["joints"]["bed"]["friction"]
        assert float(row["bed.friction"]) == friction == float(asked["bed.friction"])
        law = found["options"]["joints"]
        assert law == row["joints"] == batch.value(asked["joints"])
        values = batch.value(asked[f"field:{field}"])
        assert found["options"]["field"] == [f"{field}={values}"]
        assert row["failure_mode"] and float(row["push_work_J"]) > 0
        assert sorted(os.listdir(folder)) == ["curve.csv", "run.json"]
    assert len({row["peak_base_shear_kN"] for row in rows}) == 4
    assert not any("seconds" in name or "host" in name for name in rows[0])


def test_a_study_that_is_done_runs_nothing(whole):
    out, *_ = whole
    before = read(out)
    done(out.parent / "study.py", "--out", out)
    assert read(out) == before and len(ended(out)) == 4
    os.remove(out / "study.csv")
    done("--out", out, "--gather")
    assert read(out) == before


def test_a_row_by_hand_gives_the_same(whole, tmp_path):
    """Also its crack pattern, which masonry_view.measure then finds in the frames for ParaView."""
    out, *_ = whole
    words = batch.optionWords(batch.readTable(str(out / "table.txt"))[3])
    words.remove("--lean")
    runProgram(SMALL, *words, "--out", tmp_path / "r")
    curves = [read(folder, "curve.csv") for folder in (tmp_path / "r", out / "rows" / "0002")]
    assert curves[0] == curves[1]
    numbers, row = measure(str(tmp_path / "r")), table(out)[1]
    alike = [n for n in row.keys() & numbers.keys() if row[n] and n != "failure_mode"]
    assert len(alike) > 20
    for name in alike:  # curve.csv has nine digits, and the frames have all
        assert float(row[name]) == approx(numbers[name], rel=1e-6), name
    wall = readRun(str(tmp_path / "r"))["wall"]
    assert row["failure_mode"] == failureMode(numbers, wall)


def test_plain_yade_batch_runs_the_table(whole, tmp_path):
    out, *_ = whole
    (tmp_path / "t").mkdir()
    for name in ("table.txt", "study.json"):
        shutil.copy(out / name, tmp_path / "t")
    words = "yade-batch -j 2 --lines 2,4 --log t/@.log t/table.txt"
    command = [*words.split(), SMALL]
    # its own port stays closed in a network of its own, if that can be had
    alone = ["unshare", "--user", "--map-current-user", "--net"]
    if run(*alone, "true").returncode == 0:
        command = alone + command
    run(*command, cwd=tmp_path, check=True)
    assert study("--out", tmp_path / "t", "--gather").returncode == 1
    mine = read(tmp_path / "t").splitlines()
    assert mine[1] in (theirs := read(out).splitlines()) and mine[3] in theirs
    assert b",missing," in mine[2] and b",missing," in mine[4]


def kill(process, who):
    """Kill a process of a generation. Returns whether there was one."""
    found = family(process)[who]
    if not found:
        return False
    with contextlib.suppress(ProcessLookupError):
        os.kill(random.choice(found), signal.SIGKILL)
    return True


@mark.parametrize("seed", [16])
def test_kills_at_random_moments_change_no_number(whole, tmp_path, seed):
    random.seed(seed)
    path, out, kills = write(tmp_path), tmp_path / "out", []
    for victims in ([SCENES, ROWS, 0], [ROWS, 0], [SCENES, ROWS, WARM]):
        process = start(path, "--out", out, "--jobs", 2)
        runs = lambda: family(process)[SCENES]
        for who in victims:
            while process.poll() is None and not runs():
                time.sleep(0.05)
            time.sleep(random.uniform(0, 2))
            if process.poll() is None and kill(process, who):
                kills.append(who)
        message = process.communicate(timeout=120)[0]
        if WARM in kills:
            assert process.returncode == 1 and "was killed" in message
        elif process.returncode != -signal.SIGKILL:
            assert process.returncode == 0, message
    assert len(kills) >= 3, kills
    done(path, "--out", out)
    assert read(out) == read(whole[0])
    assert sorted(ended(out)) == sorted(set(ended(out))), "a row was run twice"


def test_ctrl_c_leaves_checkpoints_and_the_study_goes_on(whole, tmp_path):
    path, out = write(tmp_path), tmp_path / "out"
    process = start(path, "--out", out, "--jobs", 2)
    while process.poll() is None and not [*out.glob("rows/*/run.checkpoint")]:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    message = process.communicate(timeout=60)[0]
    assert process.returncode == 130 and "goes on from here" in message
    assert b"missing" in read(out)
    assert str(out) not in run("ps", "-e", "-o", "args=").stdout
    interrupted = [p.parent for p in out.glob("rows/*/run.checkpoint")]
    done(path, "--out", out, "--jobs", "2")
    assert read(out) == read(whole[0])
    assert any(readRun(folder)["resumed_at_s"] for folder in interrupted)


FAILS = f"""
from masonry_study import Study
study = Study({SMALL!r}, design="grid", options={{"until": 0.1}}, vary={{"fall": [False, True]}})
"""


def test_a_row_that_fails_is_named_and_the_others_run(tmp_path):
    path, out = write(tmp_path, FAILS), tmp_path / "out"
    process = study(path, "--out", out, "--jobs", "2")
    assert process.returncode == 1
    assert "row 0002 failed: RuntimeError: it was told to fall; see " in process.stdout
    assert "1 ended, 1 failed" in process.stdout
    rows = table(out)
    assert [row["status"] for row in rows] == ["ended", "failed"]
    assert rows[1]["fall"] == "True"
    assert "it was told to fall" in table(out, "times.csv")[1]["told"]


# -- bad input -------------------------------------------------------------------------------------


def refused(tmp_path, text, *words, env=None):
    path, out = write(tmp_path, text), tmp_path / "out"
    process = study(path, "--out", out, *words, env=env)
    assert process.returncode == 2, process.stdout + process.stderr
    assert "Traceback" not in process.stderr
    places = [out, tmp_path / "results", os.path.join(HERE, "results")]
    assert not any(map(os.path.exists, places))
    return process.stderr


def test_what_the_scene_cannot_take_is_reported_at_once_and_nothing_runs(tmp_path):
    text = f"""
from masonry_study import *
study = Study({SMALL!r}, runs=20, seed=1, options={{"until": 1, "dance": 3}}, vary={{
    "bed.friction": normal(mean=0.43, cov=0.5), "crack.cohesion": lognormal(mean=1e3, cov=0.1),
    "bed.stickiness": uniform(0, 1), "wall.cohesion": uniform(1, 2),
    "support.cohesion": uniform(1e5, 2e5), "rate": uniform(-30, 30), "color": ["red"],
}})
"""
    message = refused(tmp_path, text)
    for sentence in (
        "dance: the scene has no such option",
        "color: the scene has no such option",
        "bed.friction: normal(mean=0.43, cov=0.5) gives impossible values in 2.3 % of all rows:",
        "it must be at least 0; low=",
        "support.cohesion: support joints of the scene are linear elastic and ignore it",
        "bed.stickiness: a MasonryJoint has no such property",
        "no joint 'wall', there are ",
        "argument --rate: -",
    ):
        assert sentence in message, message


def test_rows_that_contradict_themselves_are_reported_by_their_number(tmp_path):
    vary = '{"bed.tensileStrength": uniform(1e4, 5e5), ("head.tensileStrength",): field(cov=0.5)}'
    text = f"study = Study({SMALL!r}, runs=8, seed=1, vary={vary})"
    message = refused(tmp_path, "from masonry_study import *\n" + text)
    assert re.search(r'row 000\d.*: joint "bed": tensile strength', message)
    field = r"--field head.tensileStrength=.*where the field is [\d.]+ of the mean"
    assert re.search(field, message), message


DEAF = """
from masonry import Scene, bricks, materials
scene = Scene("deaf", bricks.stack(2, (0.22, 0.1, 0.08)), materials.calciumSilicate(), arguments=[])
scene.platen("bottom")
scene.settle()
scene.finish()
"""


def test_a_scene_that_ignores_what_varies_is_refused(tmp_path):
    vary = {"head.friction": [0.4, 0.5]}
    text = f"from masonry_study import *\nstudy = Study('scene.py', vary={vary}, design='grid')"
    ignored = "head.friction: the scene has no head joint and would ignore it"
    for scene, message in (
        (DEAF, "takes no options from the command line"),
        (DEAF.replace("arguments=[]", "until=1"), ignored),
        ("print('hello')", "no masonry.Scene began a stage"),
        ("import masonry\n1 / 0", "ZeroDivisionError: division by zero"),
    ):
        (tmp_path / "scene.py").write_text(scene)
        assert message in refused(tmp_path, text)


def test_another_study_in_the_folder_is_refused(whole, tmp_path):
    out, *_ = whole
    before = {path: path.read_bytes() for path in out.glob("*.*")}
    path = write(tmp_path, STUDY.replace("seed=1", "seed=2").replace("0.05", "0.06"))
    process = study(path, "--out", out)
    assert process.returncode == 2
    said = ("holds another study", "seed is 1, not 2", '"cov": 0.05}', '"cov": 0.06}')
    assert all(part in process.stderr for part in said), process.stderr
    assert before == {path: path.read_bytes() for path in out.glob("*.*")}
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "letter.txt").write_text("expensive")
    process = study(path, "--out", mine)
    assert process.returncode == 2
    assert "is not empty (letter.txt) and holds no study" in process.stderr
    assert os.listdir(mine) == ["letter.txt"]


# -- a folder that somebody else has packed --------------------------------------------------------


@pytest.fixture
def packed(whole, tmp_path):
    """A copy of a study that has ended: a function that goes on with it, and its folder."""
    out = tmp_path / "out"
    shutil.copytree(whole[0], out)
    path = write(tmp_path)
    return lambda *words: study(path, "--out", out, *words), out


def contents(folder):
    """What is in a folder, by paths; of what is no file whether it is a pipe."""
    of = lambda path: path.read_bytes() if path.is_file() else path.is_fifo()
    return {path: of(path) for path in folder.rglob("*")}


def changed(path, change):
    """Change what a JSON file holds."""
    record = json.loads(path.read_text())
    change(record)
    path.write_text(json.dumps(record))


def test_a_changed_scene_is_another_study(packed):
    again, out = packed
    changed(out / "study.json", lambda record: record.update(scene_sha256="0" * 64))
    process = again()
    assert process.returncode == 2 and "the file of its scene" in process.stderr


@mark.parametrize(
    "pattern, text", [(r"(?m)^(0003 .*) 0\.4\d+", r"\g<1> 0.5"), (r"(?m)^0004 .*\n", "")]
)
def test_a_table_that_no_study_draws_is_refused(packed, pattern, text):
    again, out = packed
    table, whole = out / "table.txt", read(out, "table.txt")
    table.write_text(re.sub(pattern, text, whole.decode()))
    shutil.rmtree(out / "rows" / "0003")
    before = contents(out)
    process = again()
    assert process.returncode == 2 and "is not what the study draws" in process.stderr
    assert contents(out) == before
    os.remove(table)
    assert again("--prepare").returncode == 0
    assert table.read_bytes() == whole


def test_a_row_whose_checkpoint_has_other_values_begins_again(packed):
    again, out = packed
    before, row = read(out), out / "rows" / "0002"
    words = batch.optionWords(batch.readTable(str(out / "table.txt"))[3])
    words = [re.sub(r"(bed.friction)=.*", r"\1=0.6", word) for word in words]
    shutil.rmtree(row)
    command = ["yade", "-n", "-x", SMALL, *words, "--out", row]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    wait(lambda: (row / "run.checkpoint").exists(), 60)
    process.terminate()
    assert process.wait() == 130
    process = again()
    assert process.returncode == 0, process.stdout + process.stderr
    assert read(out) == before
    assert (row / "run.checkpoint.refused").exists()


@mark.parametrize("name", ["study.csv", "rows/0001.log"])
def test_a_folder_with_links_is_refused(packed, tmp_path, name):
    again, out = packed
    other = tmp_path / "other"
    other.write_text("of the user")
    (out / name).unlink(missing_ok=True)
    os.symlink(other, out / name)
    before = contents(out)
    alone = run(*ROW, "--scene", SMALL, out, 1, timeout=60)
    for process in (again(), again("--gather"), alone):
        said = process.stderr
        assert process.returncode == 2 and said.count("\n") == 1
        assert os.path.basename(name) in said
    assert contents(out) == before and other.read_text() == "of the user"


def test_a_row_runs_the_scene_that_its_user_names(packed, tmp_path):
    _, out = packed
    process = run(*ROW, out, 1)
    assert process.returncode == 2
    assert "outside the folder of the study" in process.stderr
    process = run(*ROW, "--scene", SMALL, out, 1, 2)
    assert process.returncode == 0 and process.stdout == f"note: this runs {SMALL}\n"
    other = tmp_path / "other.py"
    other.write_text("print('another one')")
    process = run(*ROW, "--scene", other, out, 1)
    assert process.returncode == 2 and "another file than the one" in process.stderr
    scene = shutil.copy(SMALL, out / "scene.py")
    changed(out / "study.json", lambda record: record.update(script=str(scene)))
    assert run(*ROW, out, 1).returncode == 0


@mark.parametrize("text", ["[", '{"study": {"runs": 4}}'])
def test_a_damaged_description_is_refused(packed, text):
    again, out = packed
    (out / "study.json").write_text(text)
    process = again()
    assert process.returncode == 2 and "study" in process.stderr
    assert "Traceback" not in process.stderr


def test_damaged_records_of_rows_count_as_none_and_steer_no_terminal(packed):
    again, out = packed
    failed = {"host": "h", "status": 1, "seconds": 1.0, "told": "\x1b]0;owned\x07"}
    for number, record in (("0001", "{"), ("0002", json.dumps(failed))):
        shutil.rmtree(out / "rows" / number)
        (out / "rows" / f"{number}.job").write_text(record)
    process = again("--gather")
    assert process.returncode == 1 and "1 missing" in process.stdout
    (out / "rows" / "0003" / "run.json").write_text('{"options": "\\u001b[2J"}')
    process = again("--gather")
    assert "\x1b" not in process.stdout + process.stderr
    assert "Traceback" not in process.stderr


def test_ctrl_c_while_a_study_is_prepared_ends_in_order(tmp_path):
    process = start(write(tmp_path), "--out", tmp_path / "out", "--prepare")
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    message = process.communicate(timeout=60)[0]
    if "4 rows" not in message:  # else it was over
        assert process.returncode == 130 and message.startswith("interrupted: ")
        assert message.count("\n") == 1 and not (tmp_path / "out").exists()


def test_a_limit_on_the_size_of_files_fails_rows_in_order(tmp_path):
    path, out = write(tmp_path), tmp_path / "out"
    limited = f"ulimit -f 8; exec {' '.join(COMMAND)} {path} --out {out} --jobs 2"
    process = run("bash", "-c", limited)
    said = process.stdout + process.stderr
    assert process.returncode == 1 and "Traceback" not in said
    assert "File too large" in said
    done(path, "--out", out, "--jobs", "2")


def test_a_cluster_that_is_missing_is_reported_before_anything_runs(tmp_path):
    (tmp_path / "bin").mkdir()
    os.symlink(shutil.which("yade"), tmp_path / "bin" / "yade")
    env = {**os.environ, "PATH": str(tmp_path / "bin")}
    message = refused(tmp_path, STUDY, "--slurm", env=env)
    assert "sbatch" in message and message.count("\n") == 1


@contextlib.contextmanager
def disk(place, size):
    """A small file system of its own."""
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place]
    if subprocess.run(words).returncode:
        pytest.skip("no file system can be mounted here")
    try:
        yield place
    finally:
        subprocess.run(["umount", place], check=True)


@mark.skipif(os.geteuid() != 0, reason="only root mounts a small disk")
def test_a_full_disk_is_reported_before_anything_runs(tmp_path):
    with disk(tmp_path / "disk", "1m") as small:
        process = study(write(tmp_path), "--out", small / "out")
        assert process.returncode == 2 and os.listdir(small) == []
        assert re.search(r"has 1 MB free, the study writes some \d+ MB", process.stderr)


@mark.skipif(os.geteuid() != 0, reason="only root mounts a small disk")
def test_a_disk_that_fills_up_stops_the_study_in_order(whole, tmp_path):
    with disk(tmp_path / "disk", "60m") as small:
        shutil.copytree(whole[0], small / "out")
        shutil.rmtree(small / "out" / "rows" / "0003")
        (small / "filler").write_bytes(bytes(shutil.disk_usage(small).free - 6_000_000))
        words = [write(tmp_path), "--out", small / "out", "--jobs", "2"]
        process = study(*words)
        assert process.returncode == 1 and "Traceback" not in process.stderr
        assert re.search(r"has [56].\d MB free, too little for 2 runs", process.stderr)
        assert "goes on when there is space" in process.stderr
        os.remove(small / "filler")
        done(*words)
        assert read(small / "out") == read(whole[0])
        assert ended(small / "out")[4:] == ["0003"]


# -- Slurm -----------------------------------------------------------------------------------------


def test_slurm_gives_the_same(whole, slurm, tmp_path):
    """Three tasks for four rows; one task is out of time, another one's node fails, and both go
    on."""
    path, out = write(tmp_path), tmp_path / "out"
    done(path, "--out", out, "--slurm", "--partition=walls", env=slurm)
    job = (out / "slurm.job").read_text().strip()
    assert "#SBATCH --array=0-1" in (out / "slurm.sh").read_text()
    again = study(path, "--out", out, "--slurm", env=slurm)
    assert again.returncode == 2 and f"job array {job} still has tasks" in again.stderr
    asked = lambda *words: run(*words, env=slurm, check=True).stdout
    wait(lambda: [*out.glob("rows/*/run.checkpoint")], 60)
    # as at the end of its time
    asked("scancel", "--signal=USR1", "--batch", f"{job}_0")
    asked("scontrol", "requeue", f"{job}_1")
    wait(lambda: not asked("squeue", "--noheader"), 120)
    done("--out", out, "--gather", env=slurm)
    assert read(out) == read(whole[0])
    assert sorted(ended(out)) == sorted(set(ended(out))), "a row was run twice"
    runs = [readRun(path.parent) for path in out.glob("rows/*/run.json")]
    assert any(one["resumed_at_s"] for one in runs)
