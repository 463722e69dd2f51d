"""Every scene of the gallery runs in its quick variant, ends in order and leaves its files."""

import glob
import os

import pytest
from conftest import ROOT
from masonry.read.files import readCurve, readRun

GALLERY = sorted(
    os.path.basename(path)[:-3]
    for path in glob.glob(os.path.join(ROOT, "scripts", "*.py"))
    if "Scene(" in open(path).read()
)


def test_there_are_twelve_scenes_and_each_is_short():
    assert len(GALLERY) >= 12
    for name in GALLERY:
        with open(os.path.join(ROOT, "scripts", name + ".py")) as f:
            assert len(f.readlines()) < 60, name


@pytest.mark.parametrize("name", GALLERY)
def test_a_scene_of_the_gallery(runScene, name):
    words = ["--quick", "--rate", "100"]
    _, out = runScene(name, *words)
    run = readRun(out)
    assert run["ended"] in ("at rest", "done", "collapsed")
    assert run["energy_balance_error"] < 0.01
    assert len(readCurve(out)["time_s"]) > 1
    assert os.path.exists(os.path.join(out, "curve.png"))
    assert os.path.exists(os.path.join(out, "cracks.png"))
