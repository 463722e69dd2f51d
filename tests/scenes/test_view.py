# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView, with the real pvpython where it is installed."""

import os
import subprocess
import sys

from hosted import *
from masonry.read import viewer

try:
    viewer.findPvpython()
    MISSING = ""
except Refused as refused:
    MISSING = str(refused).splitlines()[0]

needsParaView = pytest.mark.skipif(bool(MISSING), reason=MISSING)


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """A run of a cantilever that cracks at its heel."""
    out = tmp_path_factory.mktemp("wall") / "out"
    scene = os.path.join(ROOT, "scripts", "wall_comp1.py")
    words = ["--until", "6", "--vtk-every", "2", "--rate", "80", "--out", str(out)]
    run = subprocess.run(["yade", "-n", "-x", scene, *words], capture_output=True, text=True)  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    return str(out)


def view(*words):
    """Run scripts/view.py as a user does."""
    program = os.path.join(ROOT, "scripts", "view.py")
    return subprocess.run(["/usr/bin/python3", program, *words], capture_output=True, text=True)  # fmt: skip


def share(path, low, high):
    """Share of the pixels of a picture whose colours lie between two [0 to 1]."""
    from matplotlib.image import imread

    pixels = imread(path)[..., :3]
    return (((pixels >= low) & (pixels <= high)).all(axis=2)).mean(), pixels.shape


def cracked(path):
    """Pixels in the colours of cracks, beside the legend."""
    from matplotlib.image import imread

    pixels = imread(path)
    left = pixels[:, : int(0.8 * pixels.shape[1])]
    return int((left[..., 0] - left[..., 2] > 0.45).sum())


@needsParaView
def test_a_picture_shows_bricks_and_the_crack(wall, tmp_path):
    path = str(tmp_path / "wall.png")
    run = view(wall, "--picture", path, "--size", "600x400")
    assert run.returncode == 0, run.stderr
    brick, shape = share(path, (0.6, 0.5, 0.35), (0.98, 0.9, 0.75))
    assert shape == (400, 600, 3)
    assert brick > 0.05
    white, _ = share(path, 0.99, 1.0)
    assert white > 0.4

    # before the push there is no crack
    early = str(tmp_path / "early.png")
    assert view(wall, "--picture", early, "--size", "600x400", "--at", "0").returncode == 0  # fmt: skip
    assert cracked(path) > cracked(early) + 30


@needsParaView
def test_a_film_has_all_frames(wall, tmp_path):
    frames = len(viewer.frameTimes(wall))
    folder = tmp_path / "film"
    assert view(wall, "--film", str(folder), "--size", "300x200").returncode == 0
    assert len(os.listdir(folder)) == frames
    film = tmp_path / "film.avi"
    assert view(wall, "--film", str(film), "--size", "300x200").returncode == 0
    assert film.read_bytes().startswith(b"RIFF")


@needsParaView
def test_the_window_gets_a_state_that_shows_the_run(wall, monkeypatch):
    called = []
    monkeypatch.setattr(os, "execvp", lambda *words: called.append(words))
    viewer.show([wall])
    ((program, (_, state)),) = called
    assert program == "paraview" and state == "--state=" + os.path.join(wall, "view.pvsm")  # fmt: skip
    text = open(os.path.join(wall, "view.pvsm")).read()
    for words in ("blocks.pvd", "joints.pvd", "WarpVector", "opening [mm]"):
        assert words in text


@needsParaView
def test_what_paraview_says_comes_back(wall, tmp_path, monkeypatch):
    scene = viewer.sceneOf(wall)
    scene["blocks"] = str(tmp_path / "nothing.vtu")
    job = dict(picture=str(tmp_path / "p.png"), film=None, state=None, size=[300, 200], rate=10)  # fmt: skip
    with pytest.raises(Refused, match="ParaView ended with an error:"):
        viewer._run({**job, "views": [scene]})


def test_places_in_a_run(wall):
    times = viewer.frameTimes(wall)
    assert viewer.frameNear(wall, None) == len(times) - 1
    assert viewer.frameNear(wall, f"{times[1]:.12g}s") == 1
    moved = viewer.readCurve(wall)
    middle = len(times) // 2
    row = int(np.argmin(np.abs(np.array(moved["time_s"]) - times[middle])))
    for text in ("{:.9g}", "{:.9g}mm", "{:.9g} mm"):
        place = text.format(moved["displacement_mm"][row])
        assert abs(viewer.frameNear(wall, place) - middle) <= 1
    for text, message in (
        ("soon", "'soon' must be a number"),
        ("3 kN", "'3 kN' must be in mm or in s"),
        ("900", "never comes to 900 mm; it goes from"),
        ("-1s", "has frames from"),
    ):
        with pytest.raises(Refused, match=message):
            viewer.frameNear(wall, text)


def test_the_camera_shows_all_of_the_run(wall):
    scene = viewer.sceneOf(wall, shape=1.5)
    frame = viewer.readFrame(wall, "blocks")
    points = frame["points"] + scene["magnification"] * frame["displacement"]
    middle, up = np.array(scene["middle"]), np.array(scene["up"])
    away = np.array(scene["eye"]) - middle
    right = np.cross(up, away / np.linalg.norm(away))
    assert np.abs((points - middle) @ up).max() < scene["half_height"]
    assert np.abs((points - middle) @ right).max() < 1.5 * scene["half_height"]
    length = np.linalg.norm(np.subtract(*scene["scale"]))
    assert length == pytest.approx(scene["scale_m"]) and length < 2


def test_without_paraview_the_packages_are_named(tmp_path, monkeypatch):
    monkeypatch.setattr(viewer.shutil, "which", lambda name: None)
    monkeypatch.setattr(viewer, "UNPACKED", str(tmp_path))
    with pytest.raises(Refused, match="apt-get install --no-install-recommends paraview xvfb"):  # fmt: skip
        viewer.findPvpython()


@pytest.mark.parametrize(
    "words, message",
    [
        (["nowhere"], "cannot read nowhere/run.json: No such file"),
        (["RUN", "--size", "big"], "'big' must be WIDTHxHEIGHT"),
        (["RUN", "--picture", "p.jpg"], "p.jpg must end in .png"),
        (["RUN", "--picture", "no/p.png"], "there is no folder"),
        (["RUN", "--film", "p.mp4"], "p.mp4 must end in .avi, .ogv, or be a folder"),
        (["RUN", "--picture", "p.png", "--at", "x"], "--at: 'x' must be a number"),
        (["RUN", "--magnify", "-1"], "--magnify: -1 must be at least 0"),
        (["RUN", "--rate", "0"], "--rate: 0 must be from 1 to 100"),
    ],
)
def test_what_cannot_be_shown_is_refused(
    wall, monkeypatch, tmp_path, capsys, words, message):  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert viewer.main([wall if w == "RUN" else w for w in words]) == 2
    assert message in capsys.readouterr().err
    assert not os.listdir(tmp_path)


def test_it_needs_no_yade():
    message = subprocess.run([sys.executable, "-c", "import sys, masonry.read.viewer; print([m for m in sys.modules if 'yade' in m or 'vtk' in m])"], capture_output=True, text=True)  # fmt: skip
    assert message.stdout.strip() == "[]", message.stderr
