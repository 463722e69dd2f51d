# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in the window of ParaView."""

from hosted import *
from masonry_view import viewer


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
    (((program, script), run),) = called
    assert program == "/bin/true" and script.endswith("paraview_macro.py")
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


def test_without_paraview_the_packages_are_named(wall, monkeypatch):
    monkeypatch.setattr(viewer.shutil, "which", lambda name: None)
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
