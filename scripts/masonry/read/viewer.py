# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView: in its window, or as a picture and a film without a display; and in a browser
without ParaView. No YADE is needed.

``scripts/view.py`` is the program. In ParaView's own Python works
:mod:`masonry.read.paraview_macro`.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile
from typing import Any, Sequence

import numpy as np

from ..common import folders
from ..common.arguments import FilePath
from ..basics import Refused, say
from . import page, painting
from .cracks import CRACK, DAMAGED
from .elevation import whenOf
from .files import filesOf, program, readCurve, readRun
from .frames import frameAt, frameTimes
from .model import GROUND, OPEN, PLATEN, Model

#: Folder into which python3-paraview can be unpacked where it cannot be installed beside
#: python3-vtk9.
UNPACKED = os.path.expanduser("~/.local/share/masonry/paraview")
FILMS = (".avi", ".ogv")  # what ParaView of Debian 12 writes; it has no .mp4
DISPLAY = "-screen 0 1600x1200x24 -nolisten tcp -noreset"  # that nobody sees

MISSING = f"""ParaView's Python (pvpython) or a display that nobody sees is not there. As root:
  apt-get install --no-install-recommends paraview xvfb xauth
and, since the package python3-paraview would remove python3-vtk9, on which other programs may depend, as yourself:
  cd /tmp && apt-get download python3-paraview && dpkg -x python3-paraview_*.deb {UNPACKED}"""


def frameNear(directory: FilePath, at: Any) -> int:
    """Number of the frame next to a place in a run, from 0.

    :param at: text: a number with ``s``, a time, or a number with or without the unit of x of
        curve.png; None: the end
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
                f"--at: {directory} never comes to {value:g} {own}; it goes from {x.min():g} to"
                f" {x.max():g} {own}"
            )
        value = data["time_s"][reached[0]]
    elif not min(times) * (1 - 1e-9) <= value <= max(times) * (1 + 1e-9):
        raise Refused(
            f"--at: {directory} has frames from {min(times):g} to {max(times):g} s, not at"
            f" {value:g} s"
        )
    return frameAt(directory, value)


def sceneOf(
    directory: FilePath, number: int, magnification: float | None, shape: float, still: bool
) -> dict[str, Any]:
    """What ParaView shall show of a run: an entry ``runs`` for :mod:`masonry.read.paraview_macro`.

    :param number: of the frame after which camera, magnification and the range of colours are
        chosen
    :param shape: width of the picture over its height
    :param still: whether this frame alone is shown, whose place the title then tells
    """
    model = Model(directory, number)
    sight = model.sight(magnification)
    towards = sight.towards + (0, 0, 0.15)
    towards /= np.linalg.norm(towards)
    right = np.cross((0, 0, 1), towards) / np.hypot(*towards[:2])
    axes = np.array([right, np.cross(towards, right)])
    middle, extent = 0.5 * (sight.low + sight.high), sight.high - sight.low
    wide, tall = np.abs(axes) @ extent
    half = 0.5 * max(1.4 * tall, 1.5 * wide / shape)
    middle = middle + 0.1 * half * shape * right  # the legend stands at the right
    opening = model.joints.opening[0][(model.joints.kind[0] & OPEN) > 0]
    widest = float(np.quantile(opening, 0.995)) if len(opening) else 0.0
    when = whenOf(model.run, directory, number) + ", " if still else ""
    bodies = lambda look: model.bodies[model.looks == look].tolist()
    return {
        "folder": os.path.abspath(directory),
        "title": (
            f"{model.title}\n{when}displacements × {sight.magnification:g}, slid joints in blue,"
            " scale in m"
        ),
        "magnification": sight.magnification,
        "ground": bodies(GROUND),
        "platens": bodies(PLATEN),
        "widest_mm": page.data.nice(1e3 * max(widest, 4 * CRACK)),
        "colours": {
            n: (painting.rgb(c) / 255).tolist()
            for n, c in {**painting.SHADES, **painting.CRACKS, "mortar": painting.MORTAR}.items()
        },
        "crack": CRACK,
        "damaged": DAMAGED,
        "bounds": np.column_stack([sight.low, sight.high]).ravel().tolist(),
        "middle": middle.tolist(),
        "towards": towards.tolist(),
        "half_height": float(half),
    }


def inParaView(
    directories: Sequence[FilePath],
    at: Any,
    magnification: float | None,
    target: str | None = None,
    film: bool = False,
    size: Sequence[int] = (1500, 1000),
    rate: int = 10,
) -> None:
    """Show runs side by side in ParaView's window, or draw them to a picture or a film.

    :param at: the frame, as in :func:`frameNear`
    :param magnification: of displacements; None: chosen for each run
    :param target: path of a .png file or, of a ``film``, of an .avi or .ogv file, or of a folder,
        which gets a .png file for every frame; None: the window
    :param size: of the picture [pixels]
    :param rate: frames of the film a second
    :raises Refused: if something is missing, or if ParaView ends with an error
    """
    numbers = [frameNear(d, at) for d in directories]
    shape = size[0] / len(directories) / size[1]
    still = bool(target) and not film
    job: dict[str, Any] = {
        "runs": [sceneOf(d, n, magnification, shape, still) for d, n in zip(directories, numbers)],
        "time": frameTimes(directories[0])[numbers[0]],
        "size": size,
        "rate": rate,
        "picture": target if still else None,
        "film": target if film else None,
    }
    # one scale of colours for all
    widest = max(run["widest_mm"] for run in job["runs"])
    for run in job["runs"]:
        run["widest_mm"] = widest
    unpacked = os.path.join(UNPACKED, "usr")
    program = "pvpython" if target else "paraview"
    path = shutil.which(program) or os.path.join(unpacked, "bin", program)
    if not os.path.exists(path) or target and not shutil.which("xvfb-run"):
        raise Refused(MISSING)
    macro = os.path.join(os.path.dirname(__file__), "paraview_macro.py")
    words = (
        ["xvfb-run", "-a", "-s", DISPLAY, path, macro] if target else [path, "--script=" + macro]
    )
    modules = os.path.join(unpacked, "lib", "python3", "dist-packages")
    with tempfile.TemporaryDirectory() as folder:
        viewFile = os.path.join(folder, "view.json")
        with open(viewFile, "w") as file:
            json.dump(job, file)
        # PYTHONPATH and PYTHONHOME are of another Python
        elsewhere = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}
        if os.path.isdir(modules):
            elsewhere["PYTHONPATH"] = modules
        done = subprocess.run(
            words,
            text=True,
            capture_output=bool(target),
            env={**elsewhere, "MASONRY_VIEW": viewFile},
        )
    if target and (
        done.returncode or not os.path.exists(os.path.dirname(target) if film else target)
    ):
        lines = (done.stderr + done.stdout).strip().splitlines()
        raise Refused("ParaView ended with an error:\n" + "\n".join(lines[-15:]))


def _writable(path, directory, name, endings):
    """The path of a file to write: as it was given, or ``name`` in the folder of the run.

    :raises Refused: if it has another ending, or if it is a folder or in a folder that is not there
    """
    if path is None:
        folders.check(directory)
        path = os.path.join(directory, name)
    if os.path.isdir(path):
        raise Refused(f"{path} is a folder; name a file that ends in {' or '.join(endings)}")
    if not path.lower().endswith(endings):
        raise Refused(f"{path} must end in {' or '.join(endings)}")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise Refused(f"cannot write {path}: there is no folder {os.path.dirname(path)}")
    return path


def _drawn(path, isFilm):
    """The path that ParaView shall write, without an older file in its place."""
    if isFilm and not os.path.splitext(path)[1]:
        os.makedirs(path, exist_ok=True)
        folders.check(path)
        return os.path.join(os.path.abspath(path), "frame.png")
    path = os.path.abspath(_writable(path, None, None, FILMS if isFilm else (".png",)))
    if os.path.lexists(path):
        os.remove(path)  # also a link, which would lead elsewhere
    return path


def _handOn(args):
    """--html: a page that needs no ParaView."""
    if args.picture or args.film or len(args.result) > 1:
        raise Refused(
            "--html writes one page of one run; start view.py again for other files or runs"
        )
    if args.frame is not None and args.at is not None:
        raise Refused("--frame and --at both name a frame; give one of them")
    (directory,) = args.result
    number = args.frame if args.at is None else frameNear(directory, args.at)
    try:
        path = _writable(args.html, directory, "view.html", (".html", ".htm"))
        page.write(directory, path, number, args.magnify)
        say(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB; any browser opens it")
    except OSError as problem:
        raise Refused(f"cannot write {path}: {problem.strerror}") from None


@program
def main(words: Sequence[str] | None = None) -> None:
    """The program ``scripts/view.py``."""
    parser = argparse.ArgumentParser(
        description=(
            "Open runs in ParaView, draw them to a picture or a film without a display, or write"
            " one for a browser."
        )
    )
    parser.add_argument("result", nargs="+", help="folder of results")
    parser.add_argument("--picture", metavar="FILE.png", help="draw a picture")
    parser.add_argument(
        "--film",
        metavar="FILE",
        help=f"a film ({', '.join(FILMS)}), or a folder for a picture of every frame",
    )
    parser.add_argument(
        "--html",
        metavar="FILE",
        nargs="?",
        default=False,
        help=(
            "a page that any browser shows in 3-D, without ParaView and without a network"
            " (view.html in the folder of results)"
        ),
    )
    parser.add_argument(
        "--frame", metavar="N", type=int, help="frame to show first in --html, from 0"
    )
    parser.add_argument(
        "--at", metavar="PLACE", help="frame to show: 12, 12mm or 0.5s; else the last one"
    )
    parser.add_argument(
        "--magnify",
        type=float,
        help="magnification of displacements; else chosen for each run",
    )
    parser.add_argument(
        "--size", default="1500x1000", help="of picture and film in pixels (default 1500x1000)"
    )
    parser.add_argument(
        "--rate",
        type=int,
        default=10,
        help="frames of the film a second (default 10)",
    )
    args = parser.parse_args(words)
    size = re.fullmatch(r"(\d+)x(\d+)", args.size)
    if not size or not all(200 <= int(n) <= 10000 for n in size.groups()):
        raise Refused(f"--size: '{args.size}' must be WIDTHxHEIGHT, each from 200 to 10000 pixels")
    if args.magnify is not None and not 0 <= args.magnify < float("inf"):
        raise Refused(f"--magnify: {args.magnify:g} must be at least 0")
    if not 1 <= args.rate <= 100:
        raise Refused(f"--rate: {args.rate} must be from 1 to 100 frames a second")
    for directory in args.result:
        readRun(directory)
    with filesOf(", ".join(args.result)):
        if args.html is not False:
            return _handOn(args)
        if args.frame is not None:
            raise Refused("--frame is for --html; --at names a frame for ParaView")
        pixels = tuple(map(int, size.groups()))
        for path, isFilm in ((args.picture, False), (args.film, True)):
            if path:
                inParaView(
                    args.result,
                    args.at,
                    args.magnify,
                    _drawn(path, isFilm),
                    isFilm,
                    pixels,
                    args.rate,
                )
        if not args.picture and not args.film:
            inParaView(args.result, args.at, args.magnify)
