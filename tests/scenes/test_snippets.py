# SPDX-License-Identifier: GPL-2.0-or-later
"""Every command and every piece of Python in the documents is run, or has a reason here why it is
not.

Commands run in the order of the documents, in one folder, as a reader types them but for what
REPLACED says: scenes take a tenth of their way, and names such as FILE get a meaning. Those of the
tutorial are run by test_tutorial.py.
"""

from hosted import *
from masonry_capacity import bilinear_curve


sys.path.insert(1, os.path.join(ROOT, "tests", "gates"))
import tree  # noqa: E402

TUTORIAL = ("scripts/docs/",)
PROGRAMS = (
    "yade",
    "bash",
    "/usr/bin/python3",
    "python3",
    "jupyter",
    "for",
    "cd",
    "seq",
    "squeue",
    "apt-get",
    "unshare",
)

#: Commands that are not run here, and why: who runs them, or what they need.
REASONS = {
    r"bash scripts/(setup|test|package|docs|try_release|container)\.sh": (
        "installs packages, or runs the tests themselves"
    ),
    r"bash scripts/run\.sh \w+$": (
        "installs packages; the scene itself is run by tests/scenes/test_walls.py"
    ),
    r".*(view\.py|view_html)": "needs ParaView: tests/view/test_view.py",
    r".*--slurm|squeue|seq ": "needs a cluster: tests/study/test_run.py has one of Slurm",
    r".*tests/references/references\.py": "tests/host/test_references.py",
    r".*validation/\w+/?\w*\.py": (
        "minutes or hours; tests/scenes/test_validation.py and its like run parts of them"
    ),
    r".*masonry_study(\.report)? (validation|results/validation)/": (
        "minutes or hours: a study of validation/"
    ),
    r".*wall_comp4\.py --accuracy": "minutes: tests/scenes/test_accuracy.py has a small wall",
    r".*check_host\.py (FOLDER|libyade)": "needs an unpacked YADE of another release",
    r".*compas\.py": "needs a problem of compas_dem: tests/scenes/test_compas.py",
    r".*-m masonry_capacity": "a tenth of a push has no peak: tests/capacity/test_capacity.py",
    r"jupyter": "opens a browser",
    r"unshare": "needs namespaces of users, which containers may refuse",
}
#: What is replaced in a command before it is run.
REPLACED = (
    (r"bash scripts/run\.sh (\w+)", r"yade -n -x scripts/\1.py"),
    (
        (
            r"^((?:yade -n -x|/usr/bin/python3) (?:scripts/(?:gallery/)?\w+|my_\w+)\.py\b"
            r"(?!.*--(?:resume|preset bound|help)).*)"
        ),
        r"\1 --quick",
    ),
    (r"(/usr/bin/python3 scripts/plot\.py.*) --quick", r"\1"),
    (r"(.*--preset bound)", r"\1 --out results/bound"),
    (r"(.*wall_\w+\.py (?:--history|--joint).*)", r"\1 --lean --out results/other"),
    (r"\bFILE\b", "study.py"),
    (r"\bDIR\b", "study"),
)
#: Documents with Python, and what becomes of it: a file that commands name, or a program of its
#: own.
BLOCKS = {
    "README.md": ["my_scene.py"],
    "scripts/CHECKPOINTS.md": ["checkpoint.py"],
    "scripts/STUDIES.md": ["study.py", "ida.py", "cracked.py", "after.py", "couplets.py"],
    "scripts/WALL.md": ["my_wall.py"],
    "yade_plugin/FOR_YADE_USERS.md": ["joints.py"],
}
#: What makes studies shorter.
SHORTER = {
    "study.py": [("runs=200", "runs=3"), ('"until": 6', '"until": 0.2')],
    "ida.py": [
        ("levels=[0.2, 0.4, 0.6, 0.9, 1.3, 1.8]", "levels=[0.2, 0.4]"),
        ('"parapet",', '"parapet", options={"quick": True},'),
    ],
    "after.py": [("levels=[0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]", "levels=[0.2]")],
    "couplets.py": [("unknown=", "runs=9,\n    unknown=")],
}
#: A record of the format of PEER: a sine that swells and fades, with another frequency in every
#: file.
PEER = """PEER NGA STRONG MOTION DATABASE RECORD
none
ACCELERATION TIME SERIES IN UNITS OF G
NPTS= 201, DT= .0050 SEC
"""
SCENE = """
from masonry_capacity import bilinear_curve
from masonry import Scene, bricks, materials
scene = Scene("panel", bricks.stack(2, (0.3, 0.3, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom")
scene.settle()
"""


def documents():
    return [d for d in tree.files((".md",)) if not d.startswith(TUTORIAL)]


def commands(text):
    """The commands of a document: lines of its indented blocks, without comments, those that go on
    joined."""
    fenced = re.compile(r"^```(?!bash|sh).*?^```", re.M | re.S)
    lines = fenced.sub("", text).replace("\\\n", " ").splitlines()
    inside = False
    for line in lines:
        inside = not inside if line.startswith("```") else inside
        if line.startswith("    ") or inside:
            words = re.sub(r"\s+# .*$", "", line).split()
            if words and words[0] in PROGRAMS:
                yield " ".join(words)


ALL = {d: list(commands(tree.read(d))) for d in documents()}
PYTHON = {d: re.findall(r"^```python\n(.*?)^```", tree.read(d), re.M | re.S) for d in documents()}


def reasonOf(command):
    return next((why for pattern, why in REASONS.items() if re.match(pattern, command)), None)


def test_commands_are_found():
    text = (
        "    yade -n -x a.py \\\n        --quick   # why\n\n```python\nfor x in y:\n   "
        " yade\n```\n\n```bash\nbash b.sh\n```\n"
    )
    assert list(commands(text)) == ["yade -n -x a.py --quick", "bash b.sh"]
    assert sum(map(len, ALL.values())) > 50


def test_every_reason_is_for_a_command_and_names_tests_that_are_there():
    every = [c for found in ALL.values() for c in found]
    may = {"jupyter", r".*check_host\.py (FOLDER|libyade)"}
    for pattern, why in REASONS.items():
        assert pattern in may or any(re.match(pattern, c) for c in every), pattern
        for path in re.findall(r"tests/[\w/]+\.py", why):
            assert os.path.isfile(os.path.join(ROOT, path)), path


def test_every_piece_of_python_is_run():
    assert {d for d, found in PYTHON.items() if found} == set(BLOCKS)
    assert {d: len(PYTHON[d]) for d in BLOCKS} == {d: len(n) for d, n in BLOCKS.items()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder of a reader, with what the documents take for granted there."""
    path = tmp_path_factory.mktemp("reader")
    for name in ("scripts", "validation", "yade_plugin", "tests"):
        os.symlink(os.path.join(ROOT, name), path / name)
    for document, names in BLOCKS.items():
        for name, text in zip(names, PYTHON[document]):
            for before, after in SHORTER.get(name, ()):
                assert text.count(before) == 1, before
                text = text.replace(before, after)
            (path / name).write_text(text)
    for name, residual in (("low", 0.1), ("high", 0.35)):
        rows = [f"{0.1 * n},{residual + 0.2 * math.exp(-n / 3)}" for n in range(10)]
        (path / f"{name}.csv").write_text("\n".join(["slide,stress", *rows]))
    (path / "records").mkdir()
    for hertz in (2, 3, 4):
        wave = [
            math.sin(0.005 * n * math.pi) ** 4 * math.sin(0.01 * n * math.pi * hertz)
            for n in range(201)
        ]
        (path / "records" / f"sine{hertz}.AT2").write_text(
            PEER + "\n".join(f"{0.3 * a:.6E}" for a in wave)
        )
    (path / "measured.csv").write_text("displacement_mm\n0.1\n-0.1\n0\n")
    (path / "test.csv").write_text("d,F\n0,0\n1,50\n2,60\n")
    checkpoint = SCENE + (path / "checkpoint.py").read_text()
    checkpoint += "assert pushed == 1000\nscene.finish()\n"
    (path / "checkpoint.py").write_text(checkpoint)
    return path


def typed(folder, command):
    """Run a command as a reader types it."""
    began = time.monotonic()
    run = subprocess.run(
        command, shell=True, cwd=folder, capture_output=True, text=True, timeout=280
    )
    print(f"{time.monotonic() - began:5.1f} s  {command}")
    assert run.returncode == 0, f"{command}\n{run.stdout}{run.stderr}"
    assert "rror" not in run.stderr, f"{command}\n{run.stderr}"


def test_every_command_that_has_no_reason_runs(folder):
    ran = 0
    typed(folder, "yade -n -x checkpoint.py")
    typed(folder, "yade -n -x joints.py")
    # README.md at the top, then scripts/, which goes on with its results
    every = [command for document in sorted(ALL) for command in ALL[document]]
    for command in every:
        if reasonOf(command):
            continue
        for pattern, text in REPLACED:
            command = re.sub(pattern, text, command)
        typed(folder, command)
        ran += 1
    assert ran >= 10
    for path in (
        "results/wall_comp4/curve.png",
        "study/study.csv",
        "IDA/study.csv",
        "COUPLETS/calibration.png",
    ):
        assert (folder / path).exists()


def test_the_page_of_a_wall_has_the_numbers_of_its_run(folder):
    """Those of WALL.md, to the digits that stand there; errors of the balance are round-off."""
    page = tree.read("scripts/WALL.md")
    run = subprocess.run(
        ["yade", "-n", "-x", "my_wall.py"], cwd=folder, capture_output=True, text=True, timeout=280
    )
    said = [" ".join(line.split()) for line in run.stdout.splitlines()]
    printed = re.findall(r"^    (limit analysis: .*|pier: .*)$", page, re.M)
    assert len(printed) == 2 and {*printed} <= {*said}
    entries = json.loads((folder / "results" / "pier" / "run.json").read_text())
    rows = dict(re.findall(r"^\| `(\w+)` \| (\S+) \|", page, re.M))
    assert rows.pop("warnings") == "none" and entries["warnings"] == []
    assert entries["energy_balance_error"] < 30 * float(rows.pop("energy_balance_error"))
    capacity = bilinear_curve.ofRun(folder / "results" / "pier", "en1998")
    entries.update(K=capacity.stiffness, Vy=capacity.yieldForce, du=capacity.ultimateDisplacement)
    pattern = r"of (\S+) kN/mm, a yield force of (\S+) kN and an ultimate displacement of (\S+) mm"
    rows.update(zip(("K", "Vy", "du"), re.search(pattern, page).groups()))
    assert len(rows) == 6
    for name, text in rows.items():
        digits = len(text.replace(".", "").lstrip("0"))
        assert f"{entries[name]:.{digits}g}" == text, name
