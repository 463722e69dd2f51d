# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView: in its window in a ready state, or as a picture and a film without a display; and in a browser, or as a
3-D model, without ParaView. No YADE is needed.

``scripts/view.py`` is the program. ParaView's own Python works in a process of its own (:mod:`masonry.read.viewer_scene`).
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from typing import Any, Sequence

import numpy as np

from .. import folders, memory
from ..arguments import FilePath
from ..basics import Refused, say
from . import gltf, page
from .crack_figure import magnificationOf, whenOf
from .cracks import CRACK, DAMAGED
from .files import filesOf, readCurve, readRun
from .frames import framePaths, frameTimes, readFrame
from .views import viewOf

#: Folder into which python3-paraview can be unpacked where it cannot be installed beside python3-vtk9.
UNPACKED = os.path.expanduser("~/.local/share/masonry/paraview")
FILMS = (".avi", ".ogv")  # what ParaView of Debian 12 writes; it has no .mp4

MISSING = f"""ParaView's Python (pvpython) is not there. As root:
  apt-get install --no-install-recommends paraview xvfb
and, since the package python3-paraview would remove python3-vtk9, on which other programs may depend, as yourself:
  cd /tmp && apt-get download python3-paraview && dpkg -x python3-paraview_*.deb {UNPACKED}"""


def findPvpython() -> tuple[str, str | None] | None:
    """Path of pvpython, and the folder of its Python modules if they are not where it looks itself, else None.

    :raises Refused: if there is none, with the packages to install
    """
    installed = shutil.which("pvpython")
    if installed:
        return installed, None
    unpacked = os.path.join(UNPACKED, "usr")
    path = os.path.join(unpacked, "bin", "pvpython")
    if os.path.exists(path) and shutil.which("paraview"):
        return path, os.path.join(unpacked, "lib", "python3", "dist-packages")
    raise Refused(MISSING)


def frameNear(directory: FilePath, at: Any) -> int:
    """Number of the frame next to a place in a run, from 0.

    :param at: text: a number with ``s``, a time, or a number with or without the unit of x of curve.png; None: the end
    :raises Refused: if the text is no such place, or if the run never comes there
    """
    times = frameTimes(directory)
    if at is None:
        return len(times) - 1
    found = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d\s]*)\s*", at)
    if not found:
        raise Refused(f"--at: '{at}' must be a number, with mm or s behind it")
    value, unit = float(found[1]), found[2]
    if unit != "s":
        axis = readRun(directory).get("figure", {}).get("x")
        if axis is None:
            raise Refused(f"{directory}: its x is not known; give --at a time as 0.5s")
        data = readCurve(directory)
        x = np.array(data[axis["column"]])
        own = axis["column"].rsplit("_", 1)[-1]
        if unit not in ("", own):
            raise Refused(f"--at: '{at}' must be in {own} or in s")
        reached = np.flatnonzero(x >= value if value >= x[0] else x <= value)
        if not len(reached):
            raise Refused(
                f"--at: {directory} never comes to {value:g} {own}; it goes from {x.min():g} to {x.max():g} {own}"
            )
        value = data["time_s"][reached[0]]
    elif not min(times) * (1 - 1e-9) <= value <= max(times) * (1 + 1e-9):
        raise Refused(
            f"--at: {directory} has frames from {min(times):g} to {max(times):g} s, not at {value:g} s"
        )
    return int(np.argmin(np.abs(np.array(times) - value)))


def _nice(value):
    """The largest of 1, 2 and 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value * 1.0001)


def sceneOf(
    directory: FilePath,
    at: Any = None,
    magnification: float | None = None,
    shape: float = 1.5,
    still: bool = True,
) -> dict[str, Any]:
    """What ParaView shall show of a run: a dict for :mod:`masonry.read.viewer_scene`.

    :param directory: folder of the run
    :param at: as of :func:`frameNear`
    :param magnification: of displacements; None: chosen as for cracks.png
    :param shape: width of the picture over its height
    :param still: whether one frame is shown, whose place the title then tells
    """
    run, number = readRun(directory), frameNear(directory, at)
    blocks = readFrame(directory, "blocks", number)
    joints = readFrame(directory, "joints", number)
    framed = np.ones(len(blocks["points"]), bool)
    for body, cell in zip(blocks["body"], blocks["cells"]):
        framed[cell] = body != run.get("ground_body")
    points, moved = blocks["points"][framed], blocks["displacement"][framed]
    size = np.ptp(points, axis=0).max()
    if magnification is None:
        magnification = magnificationOf(size, np.linalg.norm(moved, axis=1))
    part = viewOf(points, joints["normal"], joints["area"])
    flat = part.towards[2] > 0.9
    away = (
        np.array([-0.45, -1.0, 0.9])
        if flat
        else part.towards - 0.16 * part.right + 0.13 * part.up
    )
    away /= np.linalg.norm(away)
    right = np.cross([0, 0, 1], away)
    right /= np.linalg.norm(right)
    up = np.cross(away, right)
    corners = np.concatenate([points, points + magnification * moved])
    # what flew away is left out of the picture, as in cracks.png
    low, high = points.min(axis=0) - 0.6 * size, points.max(axis=0) + 0.6 * size
    corners = np.clip(corners, low, high)
    seen = np.column_stack([corners @ right, corners @ up, corners @ away])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    wide, tall = np.ptp(seen[:, 0]), np.ptp(seen[:, 1])
    half = 0.5 * max(1.26 * tall, 1.34 * wide / shape)
    # the legend stands at the right
    beside = middle[0] + 0.09 * half * shape
    centre = beside * right + middle[1] * up + middle[2] * away
    length = float(_nice(0.3 * np.ptp(seen[:, 0])))
    begin = (
        centre - 0.5 * length * right - (0.5 * tall + 0.11 * half) * up + size * away
    )
    opening = joints["opening"][
        np.maximum(joints["damage_tension"], joints["damage_shear"]) > DAMAGED
    ]
    widest = 1e3 * float(np.quantile(opening, 0.995)) if len(opening) else 0.0
    widest = max(widest, 4e3 * CRACK)
    step = _nice(widest / 4)
    title = str(run.get("title", os.path.basename(os.path.abspath(directory))))
    when = ""
    if still:
        when = whenOf(run, directory, number) + ", "
    bodies = np.unique(blocks["body"])
    course = size / max(2.0, np.sqrt(len(bodies)))
    return {
        **{
            kind: os.path.abspath(
                framePaths(directory, kind)[number]
                if still
                else os.path.join(directory, kind + ".pvd")
            )
            for kind in ("blocks", "joints", *["connectors"] * bool(run.get("ties")))
        },
        "still": still,
        "title": f"{title}\n{when}displacements × {magnification:g}, slid joints in blue",
        "time": frameTimes(directory)[number],
        "magnification": magnification,
        "crack": CRACK,
        "damaged": DAMAGED,
        "widest_mm": float(np.ceil(widest / step) * step),
        "tube": float(np.clip(0.05 * course, 0.0008 * size, 0.0035 * size)),
        "line": 1.0,
        "forward": (0.002 * size * away).tolist(),
        "scale": [begin.tolist(), (begin + length * right).tolist()],
        "scale_m": length,
        "eye": (centre + 4 * size * away).tolist(),
        "middle": centre.tolist(),
        "up": up.tolist(),
        "half_height": float(half),
    }


@contextlib.contextmanager
def _display():
    """A display of its own that nobody sees, for as long as the context lasts: its name.

    xvfb-run is not used: its display starts anew whenever its last window is closed, and is away for a moment then.
    """
    if not shutil.which("Xvfb"):
        raise Refused("to draw without a display: apt-get install xvfb")
    answers, tells = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(tells), "-screen", "0", "1600x1200x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[tells],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        os.close(tells)
        with os.fdopen(answers) as answer:  # it comes when the display is ready
            number = answer.readline().strip()
        if not number:
            raise Refused("Xvfb, the display that nobody sees, does not start")
        yield ":" + number
    finally:
        server.terminate()
        server.wait()


def _run(job):
    """Let pvpython carry out a job, without a display. Raises Refused with what it said."""
    pvpython, job["path"] = findPvpython()
    # one scale of colours for all
    widest = max(view["widest_mm"] for view in job["views"])
    for view in job["views"]:
        view["widest_mm"] = widest
    inside = os.path.join(os.path.dirname(__file__), "viewer_scene.py")
    elsewhere = dict(os.environ)
    for name in ("PYTHONPATH", "PYTHONHOME"):  # they are of another Python
        elsewhere.pop(name, None)
    with tempfile.TemporaryDirectory() as folder, _display() as display:
        path = os.path.join(folder, "job.json")
        with open(path, "w") as f:
            json.dump(job, f)
        made = subprocess.run(
            [pvpython, inside, path],
            capture_output=True,
            text=True,
            env={**elsewhere, "DISPLAY": display},
        )
    if made.returncode:
        said = (made.stderr + made.stdout).strip().splitlines()
        raise Refused("ParaView ended with an error:\n" + "\n".join(said[-15:]))


def _fresh(path):
    """A path that can be written, without an older file in its place. Raises Refused if its folder is missing."""
    path = os.path.abspath(path)
    if not os.path.isdir(os.path.dirname(path)):
        raise Refused(f"cannot write {path}: there is no folder {os.path.dirname(path)}")  # fmt: skip
    if os.path.lexists(path) and not os.path.isdir(path):
        os.remove(path)  # also a link, which would lead elsewhere
    return path


def render(
    directories: Sequence[FilePath],
    picture: str | None = None,
    film: str | None = None,
    at: Any = None,
    magnification: float | None = None,
    size: Sequence[int] = (1500, 1000),
    rate: int = 10,
) -> None:
    """Draw runs, side by side, to a picture, a film or both.

    :param directories: folders of runs
    :param picture: path of a .png file
    :param film: path of an .avi or .ogv file, or of a folder, which gets a .png file for every frame
    :param at: the frame of the picture, as of :func:`frameNear`
    :param magnification: of displacements; None: chosen for each run
    :param size: of the picture [pixels]
    :param rate: frames of the film a second
    :raises Refused: if something is missing, or if ParaView ends with an error
    """
    shape = size[0] / len(directories) / size[1]
    for path, what in ((picture, "picture"), (film, "film")):
        if not path:
            continue
        job: dict[str, Any] = dict(
            picture=None, film=None, state=None, size=list(size), rate=rate
        )
        if what == "film" and not path.lower().endswith(FILMS):
            if os.path.splitext(path)[1]:
                raise Refused(f"--film: {path} must end in {', '.join(FILMS)}, or be a folder")  # fmt: skip
            os.makedirs(path, exist_ok=True)
            folders.check(path)
            target = os.path.join(os.path.abspath(path), "frame.png")
        else:
            if what == "picture" and not path.lower().endswith(".png"):
                raise Refused(f"--picture: {path} must end in .png")
            target = _fresh(path)
        still = what == "picture"
        job[what] = target
        job["views"] = [
            sceneOf(d, at if still else None, magnification, shape, still)
            for d in directories
        ]
        _run(job)
        written = os.listdir(path) if os.path.isdir(path) else os.path.exists(target)
        if not written:
            raise Refused(f"ParaView wrote no {what} {path}")


def show(
    directories: Sequence[FilePath], at: Any = None, magnification: float | None = None
) -> None:
    """Open ParaView's window on runs. The state is kept as view.pvsm in the folder of the first run."""
    if not shutil.which("paraview"):
        raise Refused(MISSING)
    state = _fresh(os.path.join(directories[0], "view.pvsm"))
    shape = 1.6 / len(directories)
    views = [sceneOf(d, at, magnification, shape, False) for d in directories]
    job = dict(picture=None, film=None, state=state, size=[1600, 1000], rate=10)
    _run({**job, "views": views})
    os.execvp("paraview", ["paraview", "--state=" + state])


def _onePlace(directory, number, at):
    """Number of the frame that --frame or --at names, or None if neither does."""
    if number is not None and at is not None:
        raise Refused("--frame and --at both name a frame; give one of them")
    if at is not None:
        return frameNear(directory, at)
    return number


def _writable(path, directory, name, endings):
    """The path of a file to write: as it was given, or ``name`` in the folder of the run.

    :raises Refused: if it has another ending, or if it is a folder or in a folder that is not there
    """
    if path is None:
        folders.check(directory)
        path = os.path.join(directory, name)
    if os.path.isdir(path):
        raise Refused(f"{path} is a folder; name a file that ends in {' or '.join(endings)}")  # fmt: skip
    if not path.endswith(endings):
        raise Refused(f"{path} must end in {' or '.join(endings)}")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise Refused(f"cannot write {path}: there is no folder {os.path.dirname(path)}")  # fmt: skip
    return path


def _handOn(args):
    """--html and --gltf: a file that needs no ParaView."""
    if args.picture or args.film or len(args.result) > 1:
        raise Refused("--html and --gltf write one file of one run; start view.py again for other files or runs")  # fmt: skip
    (directory,) = args.result
    number = _onePlace(directory, args.frame, args.at)
    try:
        if args.html is not False:
            path = _writable(args.html, directory, "view.html", (".html", ".htm"))
            page.write(directory, path, number, args.magnify)
            say(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB; any browser opens it")
        if args.gltf is not None:
            path = _writable(args.gltf, directory, None, (".glb",))
            say(gltf.write(directory, path, number, 1.0 if args.magnify is None else args.magnify, args.rate))  # fmt: skip
    except OSError as problem:
        raise Refused(f"cannot write {path}: {problem.strerror}") from None


def main(words: Sequence[str] | None = None) -> int:
    """The program ``scripts/view.py``. Returns its exit status."""
    parser = argparse.ArgumentParser(
        description="Open runs in ParaView, draw them to a picture or a film without a display, or write them for a browser or as a 3-D model."
    )
    parser.add_argument("result", nargs="+", help="folder of results")
    parser.add_argument("--picture", metavar="FILE.png", help="draw a picture")
    parser.add_argument("--film", metavar="FILE", help=f"a film ({', '.join(FILMS)}), or a folder for a picture of every frame")  # fmt: skip
    parser.add_argument("--html", metavar="FILE", nargs="?", default=False, help="a page that any browser shows in 3-D, without ParaView and without a network (view.html in the folder of results)")  # fmt: skip
    parser.add_argument("--gltf", metavar="FILE.glb", help="a 3-D model: of the frame that --frame or --at names, else all frames as an animation")  # fmt: skip
    parser.add_argument("--frame", metavar="N", type=int, help="frame to show first in --html, or to write with --gltf, from 0")  # fmt: skip
    parser.add_argument("--at", metavar="PLACE", help="frame to show: 12, 12mm or 0.5s; else the last one")  # fmt: skip
    parser.add_argument("--magnify", type=float, help="magnification of displacements; else chosen for each run, with --gltf 1")  # fmt: skip
    parser.add_argument("--size", default="1500x1000", help="of picture and film in pixels (default 1500x1000)")  # fmt: skip
    parser.add_argument("--rate", type=int, default=10, help="frames of the film or of the animation of --gltf a second (default 10)")  # fmt: skip
    args = parser.parse_args(words)
    try:
        size = re.fullmatch(r"(\d+)x(\d+)", args.size)
        if not size or not all(200 <= int(n) <= 10000 for n in size.groups()):
            raise Refused(f"--size: '{args.size}' must be WIDTHxHEIGHT, each from 200 to 10000 pixels")  # fmt: skip
        if args.magnify is not None and not 0 <= args.magnify < float("inf"):
            raise Refused(f"--magnify: {args.magnify:g} must be at least 0")
        if not 1 <= args.rate <= 100:
            raise Refused(f"--rate: {args.rate} must be from 1 to 100 frames a second")
        for directory in args.result:
            readRun(directory)
        with filesOf(", ".join(args.result)):
            if args.html is not False or args.gltf:
                _handOn(args)
            elif args.frame is not None:
                raise Refused("--frame is for --html and --gltf; --at names a frame for ParaView")  # fmt: skip
            elif args.picture or args.film:
                pixels = tuple(int(n) for n in size.groups())
                render(args.result, args.picture, args.film, args.at, args.magnify, pixels, args.rate)  # fmt: skip
            else:
                show(args.result, args.at, args.magnify)
    except (Refused, OSError) as problem:
        say(problem, sys.stderr)
        return 2
    except MemoryError:
        say(memory.FULL, sys.stderr)
        return 1
    return 0
