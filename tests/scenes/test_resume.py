# SPDX-License-Identifier: GPL-2.0-or-later
"""Any script of stages, stopped at any step and resumed, leaves what an unbroken run leaves.

``RESUME_SEED`` and ``RESUME_SCRIPTS`` choose the first script, and how many there are.
"""

from usual import *
import itertools
import signal
import stopped
from masonry import Scene, bricks, materials

SEED = int(os.environ.get("RESUME_SEED", 1000))
MOST = 20_000  # steps of a script
SCRIPTS = int(os.environ.get("RESUME_SCRIPTS", 20))
#: Stages from whose beginning displacements count on; supports and a search of later stages; loads
#: and accelerations beside each other; steps so long that a run is stopped within a look at rest; a
#: vertical load that keeps its line, so that it moves with every row; a fall to the ground beside a
#: tie.
KNOWN = {
    "stages": """
scene = Scene("s", bricks.Wall(0.44, 0.324), materials.calciumSilicate())
base, top = scene.platen("bottom"), scene.platen("top")
scene.press(top, 0.3e6)
scene.settle()
scene.push(top, 0.2)
scene.move(base, z=-0.1)
scene.cycle(top, [0.1])
scene.run(0.02)
scene.finish()
""",
    "search": """
stone = materials.dry(friction=0.7, normalStiffness=1e11, density=2600)
scene = Scene("s", bricks.stack(3, (0.3, 0.3, 0.2)), stone)
scene.platen("bottom")
top = scene.handle(2, name="stone")
scene.settle()
scene.load(top, (100, 0, -500))
scene.wind(100, (1, 0, 0))
scene.hold(top, "z")
scene.run(0.02)
scene.release(top, "z")
scene.settle()
scene.grow({top: (4000, 0, 0)})
scene.finish()
""",
    "together": """
stone = materials.dry(friction=0.7, normalStiffness=1e11, density=2600)
scene = Scene("s", bricks.stack(3, (0.3, 0.3, 0.2)), stone)
scene.platen("bottom")
top = scene.handle(2, name="stone")
scene.pressure(lambda x, y, z: 500 * (0.6 - z), (1, 0, 0))
scene.settle()
scene.pressure(lambda x, y, z: 900 * z, (-1, 0, 0))
scene.travel(500, [(0.1, 0.1, 1), (0.2, 0.1, 1)], axles=[(0, 1), (0.1, 0.5)], spread=0.1)
scene.grow({top: (2000, 0, 0)}, dead=True, pressure=lambda x, y, z: 1e3 * z, most=3)
scene.finish()
""",
    "beside": """
stone = materials.dry(friction=0.7, normalStiffness=1e11, density=2600)
scene = Scene("s", bricks.stack(2, (0.3, 0.3, 0.3)), stone, rate=1)
scene.platen("bottom")
top = scene.platen("top", rotation="free", height=0.1)
scene.press(top, 2e4)
scene.settle()
scene.push(top, 0.002)
scene.release(top, "x", force=(80, 0, 0))
scene.settle()
scene.grow({top: (50, 0, 0)})
scene.grow({top: 1e4})
scene.load(top, (20, 0, -300))
scene.press(top, 3e4)
scene.lean(0.02)
scene.tilt(1, rate=5)
scene.accelerate(0.02, rate=0.2)
scene.shake([0, 0.1, 0], 0.01, unit="m/s²")
scene.travel(500, [(0.15, 0.1, 1)])
scene.finish()
""",
    "soft": """
stone = materials.dry(friction=0.6, normalStiffness=1e8, density=2600)
scene = Scene("s", bricks.stack(3, (1.0, 1.0, 0.5)), stone)
scene.platen("bottom")
scene.watch(-1)
scene.settle(longest=5.0)
scene.finish()
""",
    "line": """
scene = Scene("s", bricks.Wall(0.22, 0.243), materials.calciumSilicate(), rate=4)
scene.platen("bottom")
top = scene.platen("top", rotation="free", upTo=0.3, drive="x")
scene.press(top, 0.5e6, riding=False)
scene.settle()
scene.push(top, 0.1)
scene.finish()
""",
    "machine": """
scene = Scene("s", bricks.stack(1, (0.5, 0.3, 1.0)), materials.dry(), rate=20)
scene.platen("bottom")
top = scene.platen("top", rotation="free")
scene.press(top, 0.2e6, friction=0.05, stiffness=2e6)
scene.settle()
scene.cycle(top, [1.0])
scene.press(top, 0.3e6)
scene.push(top, 1.0)
scene.finish()
""",
    "patterns": """
scene = Scene("s", bricks.Wall(0.44, 0.324), materials.calciumSilicate(), rate=100)
scene.platen("bottom")
low, high = scene.handle(0), scene.handle(-1)
scene.settle()
scene.push("mode", 0.1, control=high)
scene.release(high, "x")
scene.cycle({low: 1, high: 2}, [0.1], control=low)
scene.finish()
""",
    "fall": """
wall = bricks.Wall(0.6, 0.9, unit=(0.6, 0.3, 0.3), halves=False)
stones = materials.dry(0.6, 2e8, density=2200)
scene = Scene("s", wall, stones, plane=False, collapse="follow")
scene.platen("bottom")
scene.tie((0.3, 0.15, 0.75), anchor=(0.3, -1, 0.75), stiffness=1e6, strength=50)
scene.settle()
scene.lean(0.5, (0, 1, 0))
scene.result("reach", [a["value"] for a in scene.answers if a["name"] == "rubble_reach"][0], "m")
scene.finish()
""",
    "shaken": """
wall = bricks.Wall(0.6, 0.9, unit=(0.6, 0.3, 0.3), halves=False)
stones = materials.dry(0.6, 2e8, density=2200)
scene = Scene("s", wall, stones, plane=False, collapse="follow")
base = scene.platen("bottom")
scene.settle()
scene.move(base, z=-0.5)
scene.shake([0, 12.0, 12.0, 12.0, 0, -12.0, -12.0, 0], 0.05, direction=(0, 1, 0), after=0.3)
scene.finish()
""",
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = "displacement_mm\n0\n0.05\n-0.02\n0.08\n"
    (tmp_path / "path.csv").write_text(path)
    return tmp_path


def resumed(script, whole):
    """The run in the folder "stopped" goes on, and leaves what the unbroken one left."""
    status, _, said = stopped.carryOut(script, "--resume", "stopped")
    assert status == 0, said
    assert stopped.differences(stopped.left(whole), stopped.left("stopped")) == []


@mark.parametrize(
    "name, shares",
    [
        ("stages", (0.4, 0.6, 0.97)),
        ("search", (0.2, 0.5, 0.8)),
        ("together", (0.2, 0.3, 0.4, 0.6, 0.8)),
        ("beside", (0.2, 0.5, 0.8, 0.95)),
        ("soft", (0.01, 0.13, 0.75)),
        ("line", (0.3, 0.8, 0.9, 0.95)),
        ("machine", (0.02, 0.3, 0.6, 0.8, 0.95)),
        ("fall", (0.5, 0.95)),
        ("shaken", (0.1, 0.4, 0.55, 0.7)),
        ("patterns", (0.3, 0.5, 0.9)),
    ],
)
def test_a_run_stopped_again_and_again(here, name, shares):
    script = stopped.BEGIN + KNOWN[name]
    status, steps, said = stopped.carryOut(script, "--out", "whole")
    assert status == 0, said
    words, taken = ("--out", "stopped"), 0
    for share in shares:
        act = stopped.signalled(signal.SIGTERM, max(1, round(share * steps) - taken))
        status, more, said = stopped.carryOut(script, *words, stop=act)
        assert status == 130, said
        words, taken = ("--resume", "stopped"), taken + more
    resumed(script, "whole")


LONG = [[], [mark.long]]
SEEDS = [pytest.param(SEED + n, marks=LONG[n >= SCRIPTS // 4]) for n in range(SCRIPTS)]


@mark.parametrize("seed", SEEDS)
def test_a_script_stopped_and_resumed_leaves_what_an_unbroken_one_leaves(here, seed):
    dice = random.Random(f"{seed} stop")
    for trial in range(100):
        script = stopped.Writer(f"{seed} {trial}").write()
        out = f"whole{trial}"
        status, steps, said = stopped.carryOut(script, "--out", out, most=MOST)
        if status == 0 and steps > 10:
            break
    how = dice.choice([signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
    step = dice.randint(1, steps)
    print(f"RESUME_SEED={seed}: {how.name} at step {step} of {steps}\n{script}")
    assert status == 0, said
    if how == signal.SIGKILL:
        stop, out = stopped.killed("stopped", step), "killed"
    else:
        stop, out = stopped.signalled(how, step), "stopped"
    stopped.carryOut(script, "--out", out, stop=stop)
    if os.path.exists("stopped"):  # else it was over before it was killed
        resumed(script, f"whole{trial}")


def test_an_interrupted_scene_goes_on_as_a_new_one_and_so_does_that(here):
    rows, due = itertools.count(), []

    def button():
        if next(rows) in due:
            signal.raise_signal(signal.SIGINT)
        return 0

    def build(name):
        words = ["--lean", "--out", name]
        wall = bricks.Wall(0.44, 0.324)
        scene = Scene(name, wall, materials.calciumSilicate(), arguments=words, rate=50)
        scene.column("button", "a button that is pressed", button)
        return scene, scene.platen("bottom"), scene.platen("top")

    whole, base, top = build("whole")
    whole.settle()
    whole.push(top, 0.2)
    whole.push(top, 0.3)
    whole.finish()
    broken, base, top = build("broken")
    broken.settle()
    rows, due[:] = itertools.count(), [5]
    with raises(SystemExit):
        broken.push(top, 0.2)
    resumed = broken.resume()
    assert resumed is not broken and resumed.ended == "done" and resumed.targets["top"] is top
    rows, due[:] = itertools.count(), [2]
    with raises(SystemExit):
        resumed.push(top, 0.3)
    last = resumed.resume()
    last.finish()
    assert last.targets["base"] is base and last.ended == "done"
    curves = [open(f"{name}/curve.csv").read() for name in ("whole", "broken")]
    assert curves[0] == curves[1]
