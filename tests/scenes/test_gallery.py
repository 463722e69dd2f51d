# SPDX-License-Identifier: GPL-2.0-or-later
"""Every scene of the gallery runs in its quick variant, ends in order and leaves its files."""

from hosted import *
import glob


#: The scenes of the gallery, which have a picture.
GALLERY = [
    os.path.basename(p)[:-4]
    for p in sorted(glob.glob(os.path.join(ROOT, "scripts", "gallery", "*.png")))
]
#: Those that take longest.
LONGEST = {"corner", "facade", "falling_gable", "flemish_wall", "gable_ring_beam"}
LONGEST |= {"house", "shaken_parapet", "storeys"}
#: Scenes that are compared with published results.
PUBLISHED = ["couplet"] + ["wall_" + n for n in "comp0a comp1 comp4 comp6 dry".split()]


def test_the_gallery_has_as_many_scenes_as_the_readme_says():
    with open(os.path.join(ROOT, "README.md")) as f:
        (number,) = re.findall(r"gallery\]?(?:\S*)? has (\w+) structures", f.read())
    assert (number, len(GALLERY)) == ("28", 28)


def test_every_scene_is_of_the_gallery_published_or_of_compas_and_the_manual_has_it():
    folders = os.path.join(ROOT, "scripts"), os.path.join(ROOT, "scripts", "gallery")
    paths = [path for folder in folders for path in glob.glob(os.path.join(folder, "*.py"))]
    scenes = [os.path.basename(p)[:-3] for p in paths if "Scene(" in open(p).read()]
    assert sorted(scenes) == sorted([*GALLERY, *PUBLISHED, "compas"])
    with open(os.path.join(ROOT, "scripts", "README.md")) as f:
        manual = f.read()
    links = [f"[{n}]({os.path.relpath(scenePath(n), folders[0])})" for n in scenes]
    assert [link for link in links if link not in manual] == []


@mark.parametrize(
    "name",
    [pytest.param(n, marks=[mark.long] * (n in LONGEST)) for n in GALLERY],
)
def test_a_scene_of_the_gallery(runScene, name):
    _, out = runScene(name, "--quick", "--rate", "100")
    run = readRun(out)
    assert re.fullmatch("at rest|done|collapsed( and (at rest|moving))?", run["ended"])
    assert run["energy_balance_error"] < 0.01
    assert len(readCurve(out)["time_s"]) > 1
    assert {"curve.png", "cracks.png"} <= {*os.listdir(out)}


@mark.long
def test_a_table_of_runs_beside_bounds_needs_none(runScene):
    """With --lean there is no limit analysis."""
    process, _ = runScene("storeys", "--quick", "--rate", "100", "--lean")
    assert len(re.findall(r"^ +[+-][xy] +-?\d+% +[\d.]+ g +none$", process.stdout, re.M)) == 6
