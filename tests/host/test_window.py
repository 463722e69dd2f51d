# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's own 3-D view of a scene, under a virtual display: what is drawn, and what it costs."""

from usual import *
import yade.config
from masonry import Gl1_MasonryBlock, Gl1_MasonryJointPhys

pytestmark = mark.slow

SCENE = """
import os, sys, time
from masonry import *
from masonry import window

mode, folder = sys.argv[1:]
unit, plate = MasonryMat(density=1800, label="brick"), MasonryMat(density=1800, label="plate")
L, T, H, COURSES = 0.22, 0.102, 0.081, 8

def box(x, z, length=L, height=H):
    return [(x + length * i, T * j, z + height * k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

bottom = addBlock(box(0, -0.1, 5 * L, 0.1), plate)
O.bodies[bottom].state.blockedDOFs = "xyzXYZ"
for course in range(COURSES):
    shift = L / 2 * (course % 2)
    for n in range(5 - course % 2):
        addBlock(box(n * L + shift, course * H), unit, inPlane=True)
    for x in (0, 4.5 * L) if course % 2 else ():
        addBlock(box(x, course * H, L / 2), unit, inPlane=True)
top = addBlock(box(0, COURSES * H, 5 * L, 0.1), plate)
O.bodies[top].state.blockedDOFs = "yXYZ"
point = (2.5 * L, T / 2, COURSES * H + 0.05)
press = MasonryLoad(body=top, point=point, force=(0, 0, -0.3e6 * 5 * L * T))
push = MasonryLoad(body=top, point=point, driven=True, direction=(1, 0, 0), velocity=0.005)
engines([MasonryJoint(name="bed")], loads=[press, push], inPlane=True)
connect()
O.dt = 0.8 * criticalTimeStep()[0]
if mode == "view":
    window.show(blocks="displacement", joints="damage", scale=30)
    before = window.drawingTime()
start = time.process_time()
advance(int(0.006 / 0.005 / O.dt))  # some seven pictures, ten a second
taken = time.process_time() - start
b = O.bodies[top].state
print("END", repr(tuple(b.pos)), repr(push.reaction))
print("TAKEN", taken, window.drawingTime() - before if mode == "view" else 0.0)
if mode == "view":
    shown = dict(displacement="damage", material="regime", velocity="opening", own=None)
    for n, (blocks, joints) in enumerate(shown.items()):
        window.show(blocks=blocks, joints=joints, scale=30)
        window.picture(os.path.join(folder, f"{n}.png"))
sys.stdout.flush()
os._exit(0)
"""


def run(mode, folder, command=()):
    script = folder / "scene.py"
    script.write_text(SCENE)
    end = ["yade", *["-n"] * (mode == "plain"), "-x", str(script), mode, str(folder)]
    done = ran([*command, *end], timeout=280)
    assert "TAKEN" in done.stdout, done.stdout + done.stderr
    ends = [line for line in done.stdout.splitlines() if line[:4] in ("END ", "TAKE")]
    lines = dict(line.split(" ", 1) for line in ends)
    return lines["END"], [float(x) for x in lines["TAKEN"].split()]


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """A run with the view and the same run without it."""
    if not shutil.which("xvfb-run"):
        pytest.skip("no display: xvfb-run is not installed")
    if "QT5" not in yade.config.features:
        pytest.skip("this YADE has no graphical interface")
    folder = tmp_path_factory.mktemp("window")
    display = ["xvfb-run", "-a", "-s", "-screen 0 1200x900x24"]
    probe = ran([*display, "true"])
    if probe.returncode:
        pytest.skip("no display: " + probe.stderr.strip())
    return folder, run("view", folder, display), run("plain", folder)


def colours(folder, number):
    """Pixels of a picture and how many differ from white."""
    from matplotlib.image import imread

    pixels = imread(str(folder / f"{number}.png"))[..., :3]
    return pixels, (pixels.min(axis=2) < 0.97).mean()


def share(pixels, colour, within=0.12):
    return (np.abs(pixels - np.array(colour)).max(axis=2) < within).mean()


def test_the_view_changes_no_bit_of_the_run(seen):
    _, view, plain = seen
    assert view[0] == plain[0]


def test_blocks_joints_and_the_legend_are_drawn(seen):
    folder = seen[0]
    for number in range(4):
        pixels, drawn = colours(folder, number)
        assert drawn > 0.05, f"picture {number} shows nothing"
    damage, regimes = (colours(folder, n)[0] for n in (0, 1))
    # cracked joints, and the end of the bar
    assert share(damage, (0.45, 0.0, 0.05)) > 2e-4
    assert share(regimes, (0.1, 0.45, 0.8)) > 2e-4  # opening
    assert share(regimes, (0.75, 0.75, 0.75)) > 2e-4  # elastic
    # Without joints, and with the blocks' own colour, there is nothing for a legend to tell.
    legend = [colours(folder, n)[0][-120:, -270:] for n in (0, 3)]
    black = [share(part, (0, 0, 0), 0.1) for part in legend]
    assert black[0] > 0.005 and black[0] > 5 * black[1]


def test_a_run_with_the_view_costs_no_more_than_the_drawing(seen):
    """The time of the processor beside that of the drawing, with half as much again for what a
    noisy machine adds."""
    _, (_, (view, drawing)), (_, (plain, _)) = seen
    assert drawing > 0
    assert view - drawing < 1.5 * plain


OF_BLOCKS = "'displacement', 'velocity', 'material' or 'own'"
OF_JOINTS = "'damage', 'opening' or 'regime'"


@mark.parametrize(
    "cls, good, known",
    [
        (Gl1_MasonryBlock, "velocity", OF_BLOCKS),
        (Gl1_MasonryJointPhys, "regime", OF_JOINTS),
    ],
)
def test_what_is_drawn_is_chosen_for_all_at_once_and_checked(cls, good, known):
    before = cls().colours
    cls(colours=good)
    assert cls().colours == good
    with raises(ValueError, match=f"colours 'pink' must be {known}"):
        cls().colours = "pink"
    assert cls().colours == good
    cls(colours=before)


def test_without_a_display_the_window_says_how_to_get_one(tmp_path):
    script = tmp_path / "scene.py"
    script.write_text("from masonry import window\nwindow.show()\n")
    done = runProgram(str(script), check=False)
    assert done.returncode == 1
    said = done.stdout + done.stderr
    assert "start yade without -n, on a display or under xvfb-run" in said
