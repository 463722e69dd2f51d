# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in ParaView, in whose Python :mod:`masonry_view.paraview_macro` works, or in a browser: the
program ``scripts/view.py``. No YADE is needed."""

import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile
from typing import Any, Sequence

import numpy as np

from masonry.arguments import FilePath
from masonry.errors import Refused
from . import page, pages, painting
from masonry.numbers.cracks import CRACK, DAMAGED
from masonry.numbers.files import filesOf, program, readCurve, readRun
from masonry.numbers.frames import frameAt, frameTimes
from .curve_figure import unitOf
from .model import GROUND, OPEN, PLATEN, Model

#: Where python3-paraview can be unpacked, since it cannot be installed beside python3-vtk9.
UNPACKED = os.path.expanduser("~/.local/share/masonry/paraview")
DEBIAN = "usr/lib/python3/dist-packages"  # where Debian's packages have Python
MODULES = os.path.join(UNPACKED, DEBIAN)
SIZE = 1500, 1000  # of ParaView's view [pixels]

MISSING = f"""ParaView is not there. As root:
  apt-get install --no-install-recommends paraview
and, since the package python3-paraview would remove python3-vtk9, on which other programs may \
depend, as yourself:
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
        own = unitOf(axis)
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


def sceneOf(directory: FilePath, number: int, magnification: float | None) -> dict[str, Any]:
    """What ParaView shall show of a run, for :mod:`masonry_view.paraview_macro`.

    :param number: of the frame that is shown, after which camera, magnification and the range of
        colours are chosen
    """
    model = Model(directory, number)
    sight = model.sight(magnification)
    towards = sight.towards + (0, 0, 0.15)
    towards /= np.linalg.norm(towards)
    right = np.cross((0, 0, 1), towards) / np.hypot(*towards[:2])
    axes = np.array([right, np.cross(towards, right)])
    middle, extent = 0.5 * (sight.low + sight.high), sight.high - sight.low
    (wide, tall), shape = np.abs(axes) @ extent, SIZE[0] / SIZE[1]
    half = 0.5 * max(1.4 * tall, 1.5 * wide / shape)
    middle = middle + 0.1 * half * shape * right  # the legend stands at the right
    opening = model.joints.opening[0][(model.joints.kind[0] & OPEN) > 0]
    widest = float(np.quantile(opening, 0.995)) if len(opening) else 0.0
    bodies = lambda look: model.bodies[model.looks == look].tolist()
    return {
        "folder": os.path.abspath(directory),
        "title": (
            f"{model.title}\ndisplacements × {sight.magnification:g}, slid joints in blue,"
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
        "time": model.times[0],
        "size": SIZE,
    }


def inParaView(directory: FilePath, at: Any, magnification: float | None) -> None:
    """Show a run in ParaView's window.

    :param at: the frame, as in :func:`frameNear`
    :param magnification: of displacements; None: chosen for the run
    :raises Refused: if ParaView is missing
    """
    scene = sceneOf(directory, frameNear(directory, at), magnification)
    path = shutil.which("paraview")
    isDebian = path and os.path.realpath(path) == "/usr/bin/paraview"  # others bring their Python
    found = [place for place in (MODULES, "/" + DEBIAN) if os.path.isdir(place + "/paraview")]
    if not path or isDebian and not found:
        raise Refused(MISSING)
    macro = os.path.join(os.path.dirname(__file__), "paraview_macro.py")
    with tempfile.TemporaryDirectory() as folder:
        viewFile = os.path.join(folder, "view.json")
        with open(viewFile, "w") as file:
            json.dump(scene, file)
        # PYTHONPATH and PYTHONHOME are of another Python
        elsewhere = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}
        if isDebian:
            elsewhere["PYTHONPATH"] = found[0]
        # without the user's settings no dialog of welcome stands before the macro
        words = [path, "--disable-registry", "--script=" + macro]
        subprocess.run(words, env={**elsewhere, "MASONRY_VIEW": viewFile})


@program
def main(words: Sequence[str] | None = None) -> None:
    """The program ``scripts/view.py``."""
    parser = argparse.ArgumentParser(
        description="Open a run in ParaView, or write it for a browser."
    )
    parser.add_argument("result", help="folder of results")
    parser.add_argument(
        "--html",
        metavar="FILE",
        nargs="?",
        default=False,
        help="a page that any browser shows in 3-D, without ParaView and without a network"
        " (view.html in the folder of results)",
    )
    parser.add_argument(
        "--at", metavar="PLACE", help="frame to show: 12, 12mm or 0.5s; else the last one"
    )
    parser.add_argument(
        "--magnify", type=float, help="magnification of displacements; else chosen for the run"
    )
    args = parser.parse_args(words)
    if args.magnify is not None and not 0 <= args.magnify < float("inf"):
        raise Refused(f"--magnify: {args.magnify:g} must be at least 0")
    directory = args.result
    readRun(directory)
    with filesOf(directory):
        if args.html is False:
            return inParaView(directory, args.at, args.magnify)
        number = args.at and frameNear(directory, args.at)
        make = lambda: page.page(directory, number, args.magnify)
        pages.save(make, args.html, directory, "view.html")
