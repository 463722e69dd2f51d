# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView, with the real pvpython where it is installed."""

from hosted import *
from masonry.read import viewer
from matplotlib.image import imread

UNPACKED = os.path.join(viewer.UNPACKED, "usr", "bin", "pvpython")
isThere = shutil.which("pvpython") or os.path.exists(UNPACKED)
needsParaView = pytest.mark.skipif(not isThere, reason="ParaView is not installed")


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """A run of a cantilever that cracks at its heel."""
    out = tmp_path_factory.mktemp("wall") / "out"
    runProgram("wall_comp1", "--until", 6, "--vtk-every", 2, "--rate", 80, "--out", out)
    return str(out)


def view(*words):
    """Run scripts/view.py as a user does."""
    program = os.path.join(ROOT, "scripts", "view.py")
    return subprocess.run(["/usr/bin/python3", program, *words], capture_output=True, text=True)


def cracked(path):
    """Pixels in the colours of cracks, beside the legend."""
    pixels = imread(path)
    left = pixels[:, : int(0.8 * pixels.shape[1])]
    return int((left[..., 0] - left[..., 2] > 0.45).sum())


@needsParaView
def test_a_picture_shows_bricks_and_the_crack(wall, tmp_path):
    path, early = str(tmp_path / "wall.png"), str(tmp_path / "early.png")
    for words in ((path,), (early, "--at", "0")):
        run = view(wall, "--size", "600x400", "--picture", *words)
        assert run.returncode == 0, run.stderr
    pixels = imread(path)[..., :3]
    bricks = (pixels >= (0.6, 0.5, 0.35)) & (pixels <= (0.98, 0.9, 0.75))
    assert pixels.shape == (400, 600, 3) and bricks.all(axis=2).mean() > 0.05
    assert cracked(path) > cracked(early) + 30  # none before the push


@needsParaView
def test_a_film_has_all_frames(wall, tmp_path):
    folder, film = tmp_path / "film", tmp_path / "film.avi"
    for path in (folder, film):
        assert view(wall, "--film", str(path), "--size", "300x200").returncode == 0
    assert len(os.listdir(folder)) == len(viewer.frameTimes(wall))
    assert film.read_bytes().startswith(b"RIFF")


@needsParaView
def test_what_paraview_says_comes_back(wall, tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "sceneOf", lambda *words: {"widest_mm": 1.0})
    with pytest.raises(Refused, match="ParaView ended with an error:(.|\n)*KeyError"):
        viewer.inParaView([wall], None, None, str(tmp_path / "p.png"))


def test_the_window_is_opened_on_the_macro(wall, monkeypatch):
    called = []

    def run(words, env, **settings):
        called.append((words, json.load(open(env["MASONRY_VIEW"]))))

    monkeypatch.setattr(viewer.shutil, "which", lambda name: "/bin/true")
    monkeypatch.setattr(viewer.subprocess, "run", run)
    assert viewer.main([wall, "--at", "3mm", "--magnify", "7"]) == 0
    (((program, script), job),) = called
    assert program == "/bin/true" and script.endswith("paraview_macro.py")
    (run,) = job["runs"]
    assert run["folder"] == wall and run["magnification"] == 7
    assert job["picture"] is None and job["time"] in viewer.frameTimes(wall)


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


def test_without_paraview_the_packages_are_named(wall, monkeypatch):
    monkeypatch.setattr(viewer.shutil, "which", lambda name: None)
    monkeypatch.setattr(viewer, "UNPACKED", "/nowhere")
    with pytest.raises(Refused, match="apt-get install --no-install-recommends paraview xvfb"):
        viewer.inParaView([wall], None, None)


@pytest.mark.parametrize(
    "words, message",
    [
        (["nowhere"], "cannot read nowhere/run.json: No such file"),
        (["RUN", "--size", "big"], "'big' must be WIDTHxHEIGHT"),
        (["RUN", "--picture", "p.jpg"], "p.jpg must end in .png"),
        (["RUN", "--film", "p.mp4"], "p.mp4 must end in .avi or .ogv"),
        (["RUN", "--picture", "p.png", "--at", "x"], "--at: 'x' must be a number"),
        (["RUN", "--rate", "0"], "--rate: 0 must be from 1 to 100"),
    ],
)
def test_what_cannot_be_shown(wall, monkeypatch, tmp_path, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert viewer.main([wall if w == "RUN" else w for w in words]) == 2
    assert message in capsys.readouterr().err
    assert not os.listdir(tmp_path)


def test_it_needs_no_yade():
    code = "import sys, masonry.read.viewer; print({'yade', 'vtk'} & {*sys.modules})"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.stdout.strip() == "set()", run.stderr
