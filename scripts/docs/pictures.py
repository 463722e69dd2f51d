# SPDX-License-Identifier: GPL-2.0-or-later
"""Draws the pictures of the READMEs, ``scripts/docs/pictures/*.png``.

    /usr/bin/python3 scripts/docs/pictures.py [NAME...]

Their numbers are those of runs that this program makes in ``build/pictures``, where they stay.
Needs the plugin, python3-matplotlib, python3-scipy, python3-pil, and chromium for the page of the
report.
"""

import glob
import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPTS = os.path.dirname(HERE)
ROOT = os.path.dirname(SCRIPTS)
sys.path[:0] = [SCRIPTS]

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyArrowPatch, Polygon, Rectangle
from PIL import Image

from masonry_view.painting import CRACKS, CRUSHED, SHADES

OUT = os.path.join(HERE, "pictures")
RUNS = os.path.join(ROOT, "build", "pictures")
WIDTH, DPI = 8.4, 160  # inches; a README shows 100 dots an inch
LARGEST = 200_000  # bytes
RED, BLUE = CRACKS["open"], CRACKS["slid"]
GREY = "#595959"
STYLE = {
    "font.size": 11,
    "axes.titlesize": 12,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "lines.linewidth": 2,
}
STUDY = """
from masonry_study import Study, lognormal

study = Study(
    "pier.py",
    options={"until": 3},
    runs=40,
    seed=1,
    vary={
        ("bed.friction", "bed.residualFriction"): lognormal(mean=0.6, cov=0.15),
        "bed.cohesion": lognormal(mean=0.25e6, cov=0.25),
    },
)
"""


# -- runs ------------------------------------------------------------------------------------------


def called(*words):
    environment = {**os.environ, "PYTHONPATH": SCRIPTS}
    subprocess.run(words, cwd=RUNS, env=environment, check=True, stdout=subprocess.DEVNULL)


def ran(scene, name, *options):
    """The folder of a run of a scene, which is made if it is not there."""
    folder = os.path.join(RUNS, name)
    if not os.path.isfile(os.path.join(folder, "run.json")):
        called("/usr/bin/python3", scene, *options, "--out", folder)
    return folder


def pier():
    """The scene of scripts/WALL.md, as a file."""
    path = os.path.join(RUNS, "pier.py")
    with open(os.path.join(SCRIPTS, "WALL.md"), encoding="utf-8") as file:
        text = re.search(r"^```python\n(.*?)^```", file.read(), re.M | re.S)[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def columns(folder):
    return np.genfromtxt(os.path.join(folder, "curve.csv"), delimiter=",", names=True)


def entries(folder, name="run.json"):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


# -- drawing ---------------------------------------------------------------------------------------


def saved(image, name):
    """Write a picture with as many colours as its size allows."""
    path = os.path.join(OUT, name + ".png")
    for colours in (256, 128, 64, 32, 16):
        image.convert("RGB").quantize(colours).save(path, optimize=True)
        if os.path.getsize(path) < LARGEST:
            return
    raise ValueError(f"{path} is too large")


def figureSaved(figure, name):
    figure.savefig(path := os.path.join(RUNS, name + ".png"), dpi=DPI)
    plt.close(figure)
    saved(Image.open(path), name)


def sheet(height, low, high, **settings):
    """A figure with axes for a drawing, whose units are equal in both directions."""
    figure = plt.figure(figsize=(WIDTH, height))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), **settings)
    axes.set_axis_off()
    return figure, axes


def arrow(axes, start, end, colour="black", width=1.6, style="-|>"):
    size = dict(mutation_scale=13, lw=width, shrinkA=0, shrinkB=0)
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle=style, color=colour, zorder=4, **size))


def box(axes, corner, width, height, text="", colour=SHADES["brick"], **settings):
    axes.add_patch(Rectangle(corner, width, height, fc=colour, ec=GREY, lw=1))
    middle = corner[0] + width / 2, corner[1] + height / 2
    axes.text(*middle, text, ha="center", va="center", **settings)


def cropped(path):
    """A picture without its white margin."""
    image = Image.open(path).convert("RGB")
    rows, along = np.nonzero((np.asarray(image) < 250).any(axis=2))
    return image.crop((along.min() - 8, rows.min() - 8, along.max() + 9, rows.max() + 9))


# -- the pictures ----------------------------------------------------------------------------------


def gallery():
    """All structures of the gallery, of each the largest of its drawings."""
    from scipy import ndimage

    paths = sorted(glob.glob(os.path.join(SCRIPTS, "gallery", "*.png")))
    figure, grid = plt.subplots(4, 6, figsize=(WIDTH, 6.4))
    for axes, path in zip(grid.flat, paths):
        image = np.asarray(Image.open(path).convert("RGB")).astype(int)
        isDrawn = (np.ptp(image, axis=2) > 12) & (image.min(axis=2) > 60)
        near = ndimage.binary_dilation(isDrawn, iterations=6)
        labels, count = ndimage.label(near)
        sizes = ndimage.sum(isDrawn, labels, range(1, count + 1))
        large = [n for n in range(count) if sizes[n] > 0.5 * sizes.max()]
        places = ndimage.find_objects(labels)
        rows, along = max((places[n] for n in large), key=lambda place: place[0].stop)
        axes.imshow(image[rows, along])
        axes.set_title(os.path.basename(path)[:-4].replace("_", "\n", 1), fontsize=10, pad=3)
    for axes in grid.flat:
        axes.set_axis_off()
    figure.tight_layout(pad=0.4, h_pad=0.8)
    figureSaved(figure, "gallery")


def joint():
    """Two bricks that are apart, and the jump at the points of their joint."""
    from masonry import MasonryJoint, MasonryMat, addBlock, advance, connect, engines
    from yade import O

    length, height, magnified = 0.21, 0.07, 60
    for z in (0, height):
        places = [(x, y, z + h) for x in (0, length) for y in (0, 0.1) for h in (0, height)]
        addBlock(places, MasonryMat(density=1800))
    lower, upper = O.bodies[0].state, O.bodies[1].state
    lower.blockedDOFs = upper.blockedDOFs = "xyzXYZ"
    engines([MasonryJoint(friction=0.6)])
    O.engines[0].points = 8
    connect()
    upper.vel, upper.angVel = (0.30, 0, 0.20), (0, -2.5, 0)
    advance(int(1e-3 / O.dt))  # 0.30 mm along the joint
    found = O.interactions[0, 1].geom
    shift, turn = np.array(upper.pos - upper.refPos), upper.ori.toAngleAxis()
    angle = turn[0] * turn[1][1]
    middle = np.array(upper.refPos)

    def moved(x, z):
        x, z = x - middle[0], z - middle[2]
        along = x + magnified * (angle * z + shift[0])
        return middle[0] + along, middle[2] + z + magnified * (-angle * x + shift[2])

    figure, axes = sheet(4.3, (-0.03, -0.012), (0.39, 0.203))
    box(axes, (0, 0), length, height, "lower brick")
    rim = [(0, height), (length, height), (length, 2 * height), (0, 2 * height)]
    axes.add_patch(Polygon([moved(*p) for p in rim], fc=SHADES["brick"], ec=GREY))
    axes.text(*moved(length / 2, 1.5 * height), "upper brick", ha="center", rotation=-np.degrees(magnified * angle) * 0 + 8)
    rows = sorted({round(c[0], 6): (c, j) for c, j in zip(found.centres, found.jumps)}.items())
    for x, _ in rows:
        start, end = (x, height), moved(x, height)
        arrow(axes, start, end, RED, 1.5)
        axes.plot(*start, "o", color="black", ms=5, zorder=5)
    figureSaved(figure, "joint")


DRAWN = [gallery, joint]


def main(names):
    os.makedirs(OUT, exist_ok=True)
    os.makedirs(RUNS, exist_ok=True)
    plt.rcParams.update(STYLE)
    for draw in DRAWN:
        if not names or draw.__name__ in names:
            draw()
            print(draw.__name__)


if __name__ == "__main__":
    main(sys.argv[1:])
