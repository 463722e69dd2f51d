# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView: its window, and the files that it opens."""

from hosted import *
from masonry.numbers.frames import frameTimes, readFrame
from masonry_view import viewer
from matplotlib.image import imread

withParaView = [
    mark.skipif(
        not (shutil.which("pvbatch") and os.path.isdir(viewer.MODULES)),
        reason="not there: bash scripts/setup.sh --with paraview",
    ),
    mark.skipif(not shutil.which("Xvfb"), reason="no display: Xvfb is not installed"),
    mark.long,
    mark.xdist_group("paraview"),
]
#: Programs with the options of a short run.
SCENES = {
    "plane": "wall_comp1 --until 3 --vtk-every 1 --rate 80",
    "deformable": "wall_comp1 --blocks deformable --until 0.5 --vtk-every 0.25 --rate 80",
    "space": "parapet --quick",
    "ties": "tied_arch --quick",
    "falls": "shaken_parapet --quick",
}
BRICK, CRACK = (0.83, 0.78, 0.69), (0.85, 0.2, 0.1)  # as ParaView draws them, in its light
PATIENCE = 240  # for ParaView on a busy machine [s]


def screenshot(file):
    """Pixels of the screen that Xvfb keeps in a file, an array (high, wide, 3) from 0 to 1."""
    data = np.fromfile(file, np.uint8)
    head = data[:100].view(">u4")  # as xwd writes it: its own length, ..., width, height, ...
    start, wide, high, bytesPerLine, colours = (int(head[n]) for n in (0, 4, 5, 12, 19))
    rows = data[start + 12 * colours :][: high * bytesPerLine].reshape(high, bytesPerLine)
    return rows[:, : 4 * wide].reshape(high, wide, 4)[..., 2::-1] / 255


def share(pixels, colour):
    """Share of pixels with nearly a colour."""
    return (np.abs(pixels - np.array(colour)).max(axis=2) < 0.15).mean()


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """A run of a cantilever that cracks at its heel."""
    out = tmp_path_factory.mktemp("wall") / "out"
    runProgram("wall_comp1", "--until", 6, "--vtk-every", 2, "--rate", 80, "--out", out)
    return str(out)


def test_the_window_is_opened_on_the_macro(wall, monkeypatch):
    called = []

    def run(words, env, **settings):
        called.append((words, json.load(open(env["MASONRY_VIEW"]))))

    monkeypatch.setattr(viewer.shutil, "which", lambda name: "/bin/true")
    monkeypatch.setattr(viewer.subprocess, "run", run)
    assert viewer.main([wall, "--at", "3mm", "--magnify", "7"]) == 0
    (((program, *options, script), run),) = called
    assert [program, *options] == ["/bin/true", "--disable-registry"]
    assert script.endswith("paraview_macro.py")
    assert run["folder"] == wall and run["magnification"] == 7
    assert run["time"] in viewer.frameTimes(wall)


def test_places_in_a_run(wall):
    times = viewer.frameTimes(wall)
    assert viewer.frameNear(wall, None) == len(times) - 1
    assert viewer.frameNear(wall, f"{times[1]:.12g}s") == 1
    moved = viewer.readCurve(wall)
    middle = len(times) // 2
    row = int(np.argmin(np.abs(np.array(moved["time_s"]) - times[middle])))
    for unit in ("", "mm", " mm"):
        place = f"{moved['displacement_mm'][row]:.9g}{unit}"
        assert abs(viewer.frameNear(wall, place) - middle) <= 1
    for text, message in (
        ("3 kN", "'3 kN' must be in mm or in s"),
        ("900", "never comes to 900 mm; it goes from"),
        ("-1s", "has frames from"),
    ):
        with pytest.raises(Refused, match=message):
            viewer.frameNear(wall, text)


@mark.parametrize("path", [None, "/usr/bin/paraview"], ids=["nothing", "no Python"])
def test_without_paraview_the_packages_are_named(wall, monkeypatch, path):
    monkeypatch.setattr(viewer.shutil, "which", lambda name: path)
    monkeypatch.setattr(viewer.os.path, "isdir", lambda path: False)
    with pytest.raises(Refused, match="apt-get install --no-install-recommends paraview"):
        viewer.inParaView(wall, None, None)


@pytest.mark.parametrize(
    "words, message",
    [
        (["RUN", "--at", "x"], "--at: 'x' must be a number"),
        (["RUN", "--magnify", "-1"], "--magnify: -1 must be at least 0"),
    ],
)
def test_what_cannot_be_shown(wall, monkeypatch, tmp_path, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert viewer.main([wall if w == "RUN" else w for w in words]) == 2
    assert message in capsys.readouterr().err
    assert not os.listdir(tmp_path)


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """What ParaView finds in the runs of all scenes, a list of frames for each, and their
    folders."""
    folder = tmp_path_factory.mktemp("scenes")
    for name, words in SCENES.items():
        runProgram(*words.split(), "--out", folder / name)
        os.mkdir(folder / name / "pictures")
    program = os.path.join(ROOT, "tests", "view", "colour_frames.py")
    command = ["xvfb-run", "-a", "pvbatch", program, *(str(folder / name) for name in SCENES)]
    environment = {**os.environ, "PYTHONPATH": viewer.MODULES}
    done = ran(command, env=environment, timeout=2 * PATIENCE)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    frames = [json.loads(line) for line in done.stdout.splitlines()]
    return {name: [f for f in frames if f["run"] == str(folder / name)] for name in SCENES}, folder


class TestFiles:
    pytestmark = withParaView

    @mark.parametrize("scene", SCENES)
    def test_paraview_reads_what_was_written(self, opened, scene):
        frames, folder = opened[0][scene], str(opened[1] / scene)
        kinds = {f["kind"] for f in frames}
        written = [
            name for name in os.listdir(folder) if re.match(r".*\.pvd|mechanism.*\.vtu", name)
        ]
        assert kinds == {name[:-4] for name in written} >= {"blocks", "joints"}
        assert ("connectors" in kinds) == (scene in ("ties", "falls"))
        for kind in {"blocks", "joints", "connectors"} & kinds:
            numbers = [f["number"] for f in frames if f["kind"] == kind]
            assert numbers == [*range(len(frameTimes(folder)))]
        for frame in frames:
            if frame["kind"].startswith("mechanism"):
                continue
            own = readFrame(folder, frame["kind"], frame["number"])
            assert (frame["points"], frame["cells"]) == (len(own["points"]), len(own["cells"]))
            assert {*frame["ranges"]} == {*own} - {"points", "cells"}
            for name, ranges in frame["ranges"].items():
                parts = own[name].reshape(len(own[name]), -1).T
                assert ranges == [[part.min(), part.max()] for part in parts], name

    @mark.parametrize("scene", SCENES)
    def test_every_array_has_colours(self, opened, scene):
        """A picture of each shows something."""
        last = {f["kind"]: f["ranges"] for f in opened[0][scene]}
        for kind, name in ((kind, name) for kind, ranges in last.items() for name in ranges):
            pixels = imread(opened[1] / scene / "pictures" / f"{kind}-{name}.png")[..., :3]
            assert (pixels.min(axis=2) < 0.97).sum() > 50, (kind, name)


class TestWindow:
    pytestmark = withParaView

    def test_the_window_shows_the_cracked_wall(self, wall, tmp_path):
        """No dialog stands before it, and ParaView complains of nothing."""
        screen = ["-screen", "0", "1600x1100x24", "-fbdir", str(tmp_path), "-nolisten", "tcp"]
        inside, outside = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(outside), *screen],
            pass_fds=[outside],
            stderr=subprocess.DEVNULL,
        )
        os.close(outside)
        try:
            display = ":" + os.read(inside, 100).decode().strip()
            with open(tmp_path / "said", "w") as said:
                program = os.path.join(ROOT, "scripts", "view.py")
                window = subprocess.Popen(
                    ["/usr/bin/python3", program, wall],
                    env={**os.environ, "DISPLAY": display},
                    stdout=said,
                    stderr=said,
                    start_new_session=True,
                )
            bricks = crack = 0
            end = time.monotonic() + PATIENCE
            while not (bricks > 0.01 and crack > 2e-4) and time.monotonic() < end:
                time.sleep(1)
                assert window.poll() is None, (tmp_path / "said").read_text()
                pixels = screenshot(tmp_path / "Xvfb_screen0")
                bricks, crack = share(pixels, BRICK), share(pixels, CRACK)
            text = (tmp_path / "said").read_text()
            os.killpg(window.pid, signal.SIGKILL)
            window.wait()
        finally:
            server.terminate()
            server.wait()
            os.close(inside)
        assert bricks > 0.01 and crack > 2e-4, text
        assert "array range" not in text and "ERR|" not in text and "WARN|" not in text, text
