# SPDX-License-Identifier: GPL-2.0-or-later
"""Draws the pictures of the READMEs, ``scripts/docs/pictures/*.png``.

    /usr/bin/python3 scripts/docs/pictures.py [NAME...]

Their numbers are those of runs that this program makes in ``build/pictures``, where they stay.
Needs the plugin, python3-matplotlib, python3-scipy, python3-pil, and chromium for the page of the
report.
"""

import csv
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
from PIL import Image, ImageOps

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
    return script("WALL.md", 0, "pier.py")


def script(document, number, name):
    """A piece of Python of a document, as a file."""
    path = os.path.join(RUNS, name)
    with open(os.path.join(SCRIPTS, document), encoding="utf-8") as file:
        text = re.findall(r"^```python\n(.*?)^```", file.read(), re.M | re.S)[number]
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
    image, path = image.convert("RGB"), os.path.join(OUT, name + ".png")
    for colours in (256, 128, 64, 32, 16):
        image.quantize(colours, Image.Quantize.FASTOCTREE).save(path, optimize=True)
        if os.path.getsize(path) < LARGEST:
            return
    raise ValueError(f"{path} is too large")


def figureSaved(figure, name):
    figure.savefig(path := os.path.join(RUNS, name + ".png"), dpi=DPI)
    plt.close(figure)
    saved(Image.open(path), name)


def sheet(height, low, high):
    """A figure with axes for a drawing, whose units are equal in both directions."""
    figure = plt.figure(figsize=(WIDTH, height))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
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
    """A picture with little of its white margin."""
    image = Image.open(path).convert("RGB")
    box = ImageOps.invert(image).point(lambda value: 255 * (value > 5)).getbbox()
    return ImageOps.expand(image.crop(box), 10, "white")


# -- the pictures ----------------------------------------------------------------------------------


def gallery():
    """All structures of the gallery, of each the last of its large drawings."""
    from scipy import ndimage

    paths = sorted(glob.glob(os.path.join(SCRIPTS, "gallery", "*.png")))
    figure, grid = plt.subplots(5, 6, figsize=(WIDTH, 7.7))
    figure.subplots_adjust(0.01, 0.005, 0.99, 0.97, wspace=0.08, hspace=0.17)
    for axes, path in zip(grid.flat, paths):
        image = np.asarray(Image.open(path).convert("RGB")).astype(int)
        isDrawn = (np.ptp(image, axis=2) > 12) & (image.min(axis=2) > 60)
        near = ndimage.binary_dilation(isDrawn, iterations=6)
        labels, count = ndimage.label(near)
        sizes = ndimage.sum(isDrawn, labels, range(1, count + 1))
        large = [n for n in range(count) if sizes[n] > 0.5 * sizes.max()]
        places = ndimage.find_objects(labels)
        rows, along = max((places[n] for n in large), key=lambda p: p[0].stop + 0.1 * p[1].start)
        axes.imshow(image[rows, along])
        place = axes.get_position()
        name = os.path.basename(path)[:-4]
        figure.text((place.x0 + place.x1) / 2, place.y1 + 0.01, name, ha="center", fontsize=9)
    for axes in grid.flat:
        axes.set_axis_off()
    figureSaved(figure, "gallery")


def joint():
    """Two bricks that have come apart, and the jump at the points of their joint."""
    from masonry import MasonryJoint, MasonryMat, addBlock, advance, connect, engines
    from yade import O

    length, thickness, height, magnified = 0.21, 0.10, 0.065, 60
    for z in (0, height):
        corners = [(x, y, h) for x in (0, length) for y in (0, thickness) for h in (z, z + height)]
        addBlock(corners, MasonryMat(density=1800))
    lower, upper = O.bodies[0].state, O.bodies[1].state
    lower.blockedDOFs, upper.blockedDOFs = "xyzXYZ", "xyzXYZ"
    engines([MasonryJoint(friction=0.6)], subcontacts=8)
    connect()
    O.dt = 1e-6
    upper.vel, upper.angVel = (0.26, 0, 0.24), (0, -2.2, 0)
    advance(1000)
    geometry = O.interactions[0, 1].geom
    points = np.array(geometry.centres)[:, [0, 2]]
    jumps, areas = np.array(geometry.jumps), np.array(geometry.areas)
    axis, angle = upper.ori.toAxisAngle()
    tilt = -magnified * angle * axis[1]
    middle, shift = np.array(upper.refPos)[[0, 2]], np.array(upper.pos - upper.refPos)[[0, 2]]
    turned = np.array([[1, -tilt], [tilt, 1]])
    moved = lambda place: middle + turned @ (place - middle) + magnified * shift

    figure, axes = sheet(4.0, (-0.02, -0.025), (0.40, 0.175))
    box(axes, (0, 0), length, height, "brick, fixed")
    rim = [(0, height), (length, height), (length, 2 * height), (0, 2 * height)]
    axes.add_patch(Polygon([moved(np.array(p)) for p in rim], fc=SHADES["brick"], ec=GREY))
    label = dict(ha="center", va="center", rotation=np.degrees(tilt))
    axes.text(*moved(np.array((length / 2, 1.5 * height))), "brick, moved", **label)
    for point, area in zip(points, areas):
        arrow(axes, point, moved(point), "black", 1.2)
        axes.plot(*point, "o", color=BLUE, ms=3 + 1e3 * area, zorder=5)
    last = points[-1]
    corner = last[0], moved(last)[1]
    arrow(axes, last, corner, RED, 2.4)
    arrow(axes, corner, moved(last), BLUE, 2.4)
    text = f"opening {1e3 * jumps[-1][0]:.2f} mm\n(positive)"
    axes.text(last[0] + 0.024, (last[1] + corner[1]) / 2, text, color=RED, va="center")
    text = f"slip {1e3 * abs(jumps[-1][1]):.2f} mm"
    axes.text(corner[0] + 0.024, corner[1] + 0.012, text, color=BLUE)
    said = (
        "jump = motion of one face against the\nother, at every subcontact of the joint\n\n"
        "law: jump and old state → traction [Pa]\n× area of the subcontact → force [N]"
    )
    axes.text(0.225, 0.035, said, va="center", fontsize=10.5)
    below = f"8 subcontacts, large dots for large shares of the area; displacements × {magnified}"
    axes.text(0, -0.016, below, color=GREY)
    figureSaved(figure, "joint")


def law():
    """The joint law in tension, shear and compression: runs of two bricks, and its parameters."""
    from masonry import materials

    bed = materials.calciumSilicateJoints()["bed"]
    scene = os.path.join(SCRIPTS, "gallery", "couplet.py")
    paths = {"opening": [], "shear": "--until 20 --rate 20".split(), "closure": ["--until", "5"]}
    runs = {p: columns(ran(scene, p, "--path", p, "--lean", *more)) for p, more in paths.items()}
    figure, panels = plt.subplots(1, 3, figsize=(WIDTH, 3.5))

    def drawn(axes, x, stress, colour, until, levels, names):
        """One panel; ``levels`` are stresses [MPa] with their symbols, the largest first."""
        top, axis = 1.25 * max(levels), axes.get_yaxis_transform()
        axes.plot(abs(x), abs(stress), color=colour)
        axes.set(xlim=(0, until), ylim=(0, top), **dict(zip(("title", "xlabel", "ylabel"), names)))
        for level, symbol in levels.items():
            axes.axhline(level, color=GREY, ls=":", lw=1)
            place = dict(ha="right", va="bottom" if level == max(levels) else "top")
            axes.text(0.97, level, f"${symbol}$ = {level:.4g} MPa", transform=axis, **place)

    run = runs["opening"]
    opening, stress = 1e3 * run["opening_mm"], run["normal_stress_MPa"]
    names = "tension", "opening [µm]", "normal stress [MPa]"
    drawn(panels[0], opening, stress, RED, 420, {1e-6 * bed.tensileStrength: "f_t"}, names)
    panels[0].fill_between(opening, stress, color=RED, alpha=0.15)
    text = f"area $G_I$ =\n{bed.modeIFractureEnergy:g} J/m²"
    panels[0].text(250, 0.06, text, color=RED, ha="center")

    run, pressed = runs["shear"], 0.5  # the default of --normal-stress
    levels = {1e-6 * bed.cohesion + pressed * bed.friction: r"c + \mu\,\sigma"}
    levels[pressed * bed.residualFriction] = r"\mu\,\sigma"
    names = "shear, pressed by 0.5 MPa", "slip [mm]", "shear stress [MPa]"
    drawn(panels[1], run["slide_mm"], run["shear_stress_MPa"], BLUE, 20, levels, names)

    run, levels = runs["closure"], {1e-6 * bed.compressiveStrength: "f_c"}
    names = "compression", "closure [mm]", "pressure [MPa]"
    drawn(panels[2], run["opening_mm"], run["normal_stress_MPa"], CRUSHED, 4, levels, names)
    figure.tight_layout()
    figureSaved(figure, "law")


def supports():
    """A wall between platens, with what may be said of them."""
    from masonry import bricks

    figure, axes = sheet(4.4, (-0.32, -0.75), (4.88, 1.98))
    wall = bricks.Wall(length=1.04, height=1.25, unit=(0.25, 0.12, 0.115), joint=0.01)
    solids = {}
    for block in wall:
        solids.setdefault(block.brick, []).extend(block.corners)
    hatched = np.linspace(0.02, 1.06, 14)
    for left, kind in ((0, "held"), (1.75, "free"), (3.6, "springs")):
        for corners in solids.values():
            low, high = np.min(corners, axis=0), np.max(corners, axis=0)
            box(axes, (left + low[0], low[2]), high[0] - low[0], high[2] - low[2])
        box(axes, (left, -0.13), 1.04, 0.13, 'platen("bottom")', SHADES["platen"], fontsize=10)
        ground = -0.36 if kind == "springs" else -0.13
        axes.plot([left - 0.05, left + 1.09], [ground, ground], color="black", lw=1.5)
        for x in left + hatched:
            axes.plot([x, x - 0.05], [ground, ground - 0.06], color="black", lw=0.8)
        says = dict(ha="center", va="center", fontsize=10.5)
        if kind == "springs":
            for x in left + np.linspace(0.08, 0.96, 8):
                across = x + 0.035 * np.array([0, 0, 1, -1, 1, -1, 0, 0])
                axes.plot(across, np.linspace(-0.36, -0.13, 8), color="black", lw=1)
            axes.plot(left + 0.65, 1.25, "o", color=RED, ms=7, zorder=5)
            axes.text(left + 0.65, 1.45, "watch: recorded,\nnot moved", color=RED, **says)
            arrow(axes, (left - 0.4, 0.81), (left, 0.81), BLUE, 2.4)
            axes.text(left - 0.3, 0.98, "handle:\none brick", color=BLUE, **says)
            axes.text(left + 0.3, -0.6, 'springs={"z": 1e8}, uplift=True', **says)
            continue
        box(axes, (left, 1.25), 1.04, 0.13, 'platen("top")', SHADES["platen"], fontsize=10)
        for x in left + np.linspace(0.1, 0.94, 5):
            arrow(axes, (x, 1.66), (x, 1.40), GREY, 1.2)
        axes.text(left + 0.52, 1.75, "press(top, 0.3e6)", color=GREY, **says)
        arrow(axes, (left - 0.24, 1.315), (left, 1.315), RED, 2.4)
        axes.text(left - 0.15, 1.45, "push", color=RED, **says)
        said = {"held": "the top stays level", "free": "the top may turn"}[kind]
        axes.text(left + 0.52, -0.42, f'rotation="{kind}":\n{said}', **says)
    figureSaved(figure, "supports")


ROOMS = {  # the floors of the core, from the top
    "scene, stages": "what a script says: platens, loads, push, cycle, shake",
    "run": "checkpoints, files of results, presets, options",
    "materials": "joints and units, from data sheets, codes and papers",
    "model": "bodies, joints and engines in YADE",
    "numbers": "columns, frames, curves, loops, crack widths",
    "bricks": "walls, arches, vaults, stones, houses",
    "arguments, errors, folders …": "the ground floor",
}
WINGS = {
    "masonry_study": "many runs, fragility",
    "masonry_view": "figures, report, 3-D",
    "masonry_capacity": "bilinear curves, N2, N-V",
    "masonry_limit": "limit analysis: the bound of a load, and its mechanism",
}


def house():
    """The packages: the core, the four wings, and the folder of results between them."""
    figure, axes = sheet(5.2, (0, 0), (8.4, 5.2))
    axes.text(2.1, 4.95, "masonry, the core", ha="center", fontsize=13, weight="bold")
    axes.text(6.5, 4.95, "four wings", ha="center", fontsize=13, weight="bold")
    for n, (rooms, what) in enumerate(ROOMS.items()):
        for name in re.findall(r"\w+", rooms):
            if not glob.glob(os.path.join(SCRIPTS, "masonry", name + "*")):
                raise ValueError(f"the core has no {name}")
        low = 4.25 - 0.52 * n
        box(axes, (0.1, low), 4.0, 0.5)
        axes.text(0.2, low + 0.33, rooms, weight="bold", va="center", fontsize=10.5)
        axes.text(0.2, low + 0.14, what, va="center", fontsize=9.5)
    text = "plugin in C++: law, blocks, step"
    box(axes, (0.1, 0.5), 4.0, 0.5, text, SHADES["held"], color="white")
    box(axes, (0.1, 0.05), 4.0, 0.4, "YADE", "#e6e6e6")
    text = "results/SCENE\n\ncurve.csv\nrun.json\nframes\ncheckpoint"
    box(axes, (4.85, 2.1), 1.25, 1.75, text, "white")
    arrow(axes, (4.1, 3.79), (4.85, 3.79))
    axes.text(4.47, 3.86, "writes", ha="center", fontsize=9.5)
    for n, (wing, what) in enumerate(WINGS.items()):
        low = 4.05 - 0.97 * n
        width = 1.72 if n < 3 else 3.47
        box(axes, (8.32 - width, low), width, 0.7, colour=SHADES["loaded"])
        middle = 8.32 - width / 2
        axes.text(middle, low + 0.46, wing, ha="center", va="center", weight="bold", fontsize=10)
        axes.text(middle, low + 0.2, what, ha="center", va="center", fontsize=9)
        if n < 3:
            arrow(axes, (6.1, 3.0), (6.6, low + (0.1, 0.35, 0.35)[n]))
    axes.text(6.33, 2.45, "read", ha="center", fontsize=9.5)
    arrow(axes, (6.6, 4.5), (4.1, 4.5))
    axes.text(5.35, 4.57, "runs scenes", ha="center", fontsize=9.5)
    arrow(axes, (4.1, 2.85), (4.85, 1.75), style="<|-|>")
    axes.text(4.2, 1.9, "arrays", fontsize=9.5)
    text = "Wings know the core. The core finds them\nby one table of names, masonry/wings.py."
    axes.text(6.58, 0.5, text, ha="center", va="center", color=GREY)
    figureSaved(figure, "house")


def loop():
    """Cycles of a pier, and what the numbers of one of them mean."""
    history = "--history", "1,2x2,4", "--joints", "cyclic", "--lean"
    folder = ran(pier(), "cycles", *history)
    curve, cycle = columns(folder), entries(folder)["cycles"][2]
    figure, axes = plt.subplots(figsize=(WIDTH, 4.6))
    x, force = curve["displacement_mm"], curve["base_shear_kN"]
    first, last = cycle["rows"]
    axes.plot(x, force, color="#bbbbbb", lw=1, label="four cycles of 1, 2, 2 and 4 mm")
    axes.fill(x[first : last + 1], force[first : last + 1], color=BLUE, alpha=0.15)
    amplitude, stiffness = cycle["amplitude_mm"], cycle["stiffness_kN_per_mm"]
    text = f"the third, work W = {cycle['work_J']:.0f} J: the area"
    axes.plot(x[first : last + 1], force[first : last + 1], color=BLUE, lw=1.5, label=text)
    ends = np.array([-amplitude, amplitude])
    text = f"secant stiffness K = {stiffness:.1f} kN/mm, to ± A = {amplitude:.1f} mm"
    axes.plot(ends, stiffness * ends, color=RED, marker="o", label=text)
    residuals = [cycle["residual_positive_mm"], cycle["residual_negative_mm"]]
    text = "residual displacements {:.1f} and {:.1f} mm".format(*residuals).replace("-", "−")
    axes.plot(residuals, [0, 0], "D", color="black", ms=7, ls="", label=text)
    damping = f"ξ = W / (4π · ½ · K · A²) = {cycle['damping']:.2f}"
    axes.plot([], [], " ", label=f"equivalent viscous damping {damping}")
    axes.set(xlabel="displacement of the top [mm]", ylabel="base shear [kN]", ylim=(-118, 70))
    axes.legend(loc="lower right", fontsize=10)
    figure.tight_layout()
    figureSaved(figure, "loop")


TREE = {
    "report.html": "all of the run on one page, for any browser",
    "curve.csv": "a row a reading: forces, displacements, energies, with units",
    "run.json": "answers, properties, versions, warnings, errors, cost",
    "curve.png": "the curve and the energies",
    "cracks.png": "the crack pattern",
    "mechanism.png": "the mechanism of limit analysis, from mechanism.json",
    "blocks.pvd": "frames of the blocks for ParaView",
    "joints.pvd": "frames of the joints",
    "run.checkpoint": "the state from which --resume goes on",
}


def results():
    """The folder of results as a tree, with sizes of a run."""
    folder = ran(pier(), "pier")
    figure, axes = sheet(3.6, (0, -0.4), (8.4, len(TREE) + 0.8))
    axes.text(0.1, len(TREE) + 0.3, "results/pier/", weight="bold", va="center", fontsize=12)
    for n, (name, what) in enumerate(TREE.items()):
        z = len(TREE) - 1 - n + 0.3
        files = [os.path.join(folder, name)]
        if name.endswith(".pvd"):
            files += glob.glob(os.path.join(folder, name.removesuffix(".pvd") + "_*.vt?"))
        size = sum(map(os.path.getsize, files)) / 1e3
        axes.plot([0.25, 0.25, 0.5], [z + 1 if n else z + 0.7, z, z], color=GREY, lw=1)
        axes.text(0.58, z, name, va="center", family="monospace", fontsize=11)
        axes.text(3.05, z, f"{size:,.0f} kB", va="center", ha="right", color=GREY, fontsize=10)
        axes.text(3.25, z, what, va="center", fontsize=11)
    figureSaved(figure, "results")


def report():
    """The first page of the report of a run."""
    path, shot = os.path.join(ran(pier(), "pier"), "report.html"), os.path.join(RUNS, "report.png")
    words = "chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars".split()
    words += ["--window-size=1000,1150", "--force-device-scale-factor=1.3", "--screenshot=" + shot]
    words += ["--virtual-time-budget=20000", "file://" + path]
    subprocess.run(words, check=True, capture_output=True, timeout=300)
    page = cropped(shot)
    saved(page.crop((0, 0, page.width, page.height - 30)), "report")


def mechanism():
    """The mechanism that limit analysis finds for the arch of the gallery."""
    folder = ran(os.path.join(SCRIPTS, "arch.py"), "arch", "--preset", "bound")
    saved(cropped(os.path.join(folder, "mechanism.png")), "mechanism")


def capacity():
    """The bilinear curve of a pier, and the displacement that an earthquake asks of it."""
    folder = ran(pier(), "pier")
    demand = "--mass 30e3 --gamma 1 --type 1 --ground B --ag 0.1g".split()
    called("/usr/bin/python3", "-m", "masonry_capacity", folder, *demand)
    saved(cropped(os.path.join(folder, "capacity.png")), "capacity")


def piers():
    """Piers and spandrel of a wall with a window: what a code says of each, and the run."""
    folder = ran(os.path.join(SCRIPTS, "pier_with_window.py"), "pier_with_window")
    called("/usr/bin/python3", "-m", "masonry_capacity.piers", folder, "--fb", "20", "--tie", "30")
    with open(os.path.join(folder, "piers.csv"), newline="", encoding="utf-8") as file:
        rows = {row["name"]: row for row in csv.DictReader(file) if row["code"] == "NTC 2018"}
    figure, axes = sheet(4.2, (-1.1, -0.15), (4.2, 2.5))
    for z in (-0.05, 2.43):
        box(axes, (0, z), 3.08, 0.05, colour=GREY)
    box(axes, (0, 0), 3.08, 2.43, colour=SHADES["brick"])
    box(axes, (0.99, 0.81), 1.1, 0.972, colour="white")
    for one in entries(folder)["piers"]:
        (x, _, z), (right, _, top) = one["low_m"], one["high_m"]
        row = rows[one["name"]]
        share = float(row["demand_over_capacity"])
        text = f"{one['name']}\n{row['failure']}: {row['capacity_kN']} kN\n"
        text += f"demand / capacity {share:.2f}\nrun: {row['run']} {row['otherwise']}"
        colour = matplotlib.colors.to_rgba(RED if share > 1 else BLUE, 0.25)
        box(axes, (x, z), right - x, top - z, text, colour, fontsize=9)
    figureSaved(figure, "piers")


def strengthened():
    """A pier of poor mortar and repointed, in ratios."""
    values = "cohesion=4e4", "tensileStrength=2e4"
    poor = [f"--set={kind}.{value}" for kind in ("bed", "head") for value in values]
    before = ran(pier(), "poor", *poor)
    axes = "--x drift_percent --y force_over_weight --label poor --label repointed".split()
    path = os.path.join(RUNS, "strengthened.png")
    plot = os.path.join(SCRIPTS, "plot.py")
    called("/usr/bin/python3", plot, before, ran(pier(), "pier"), *axes, "--out", path)
    saved(cropped(path), "strengthened")


def damaged():
    """Fragility of the parapet of scripts/STUDIES.md, by what a main shock has left."""
    script("STUDIES.md", 2, "cracked.py")
    after, folder = script("STUDIES.md", 3, "after.py"), os.path.join(RUNS, "after")
    os.makedirs(os.path.join(RUNS, "records"), exist_ok=True)
    for n in range(8, 20):  # pulses of 0.4 to 0.95 s, a whole sine each
        wave = 0.3 * np.sin(2 * np.pi * np.arange(5 * n + 1) / (5 * n))
        path = os.path.join(RUNS, "records", f"pulse{n:02}.AT2")
        head = f"\n\nACCELERATION IN UNITS OF G\nNPTS= {len(wave)}, DT= .0100 SEC"
        np.savetxt(path, wave, header=head, comments="")
    called("/usr/bin/python3", "-m", "masonry_study", after, "--out", folder)
    measure = "--by damage --limit 100 --measure shake_5_largest_displacement_of_crest_y_mm"
    called("/usr/bin/python3", "-m", "masonry_study.report", folder, *measure.split())
    saved(cropped(os.path.join(folder, "fragility.png")), "damaged")


def study():
    """Forty piers whose cohesion and friction scatter."""
    pier()
    file, folder = os.path.join(RUNS, "study.py"), os.path.join(RUNS, "study")
    with open(file, "w", encoding="utf-8") as written:
        written.write(STUDY)
    called("/usr/bin/python3", "-m", "masonry_study", file, "--out", folder)
    called("/usr/bin/python3", "-m", "masonry_study.report", folder)
    saved(cropped(os.path.join(folder, "scatter.png")), "study")


DRAWN = [gallery, joint, law, supports, house, results, report, loop, mechanism, capacity, piers]
DRAWN += [strengthened, damaged, study]


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
