# SPDX-License-Identifier: GPL-2.0-or-later
"""What a report is made of: the files of a run, as far as they can be read."""

import base64
import csv
import functools
import math
import os

import numpy as np

from masonry.errors import Refused
from masonry_capacity import bilinear_curve
from masonry.numbers import quantities
from masonry.numbers.cracks import CRACK_SURFACE
from ..curve_figure import plan
from masonry.numbers.files import filesOf, readRun, readText, readWhole
from masonry.numbers import drawing
from .. import elevation
from masonry.numbers.frames import readFrame
from ..model import Model, chosenFrames
from ..page.data import dataOfModel
from masonry.numbers.run_data import BASE, MOVED, TOP, RunData
from .pieces import written

MAX_NAMES = 12  # of blocks in the drawing
LARGEST_PICTURE = 600e3  # [bytes] of a figure that goes into a report


class Record:
    """The files of a run. Raises Refused if the folder has no run.json."""

    def __init__(self, directory):
        self.directory = os.fspath(directory)
        self.run = readRun(directory)  #: its entries
        self.title = str(self.run.get("title") or self.directory)
        #: sentences on what is damaged or missing in the files
        self.problems = []
        #: arrays of curve.csv by name; what is no finite number there is NaN. Empty without rows
        self.columns = self._columns()
        #: the entry ``figure`` of run.json as :func:`masonry_view.curve_figure.plan` completes it,
        #: or None, and the rows that it shows
        self.spec, self.rows = None, np.zeros(0, int)
        self._plan()
        self.picture = None  #: head and numbers of the 3-D picture, or None
        self.missing = ""  #: why there is none
        self.whenCracked = "of the run"  #: the moment that cracks.png shows
        #: the drawing of what was built as SVG and a sentence about it, or None
        self.elevation = None
        self.frameTimes, self.frameCount = [], 0
        self._frames()

    def _columns(self):
        """The columns of curve.csv without lines that are torn; what is left out is a problem."""
        try:
            text = readText(os.path.join(self.directory, "curve.csv"))
        except Refused as refused:
            self.problems.append(str(refused))
            return {}
        heads, *lines = [*csv.reader(text.splitlines())] or [[]]
        rows = [[*map(_finite, line)] for line in lines if len(line) == len(heads)]
        if torn := len(lines) - len(rows):
            self.problems.append(
                f"curve.csv: {torn:,} lines do not have a number for every column, and are left out"
                " of this report"
            )
        if not rows:
            return {}
        found = dict(zip(heads, np.array(rows, float).T))
        for name, values in found.items():
            if bad := np.isnan(values).sum():
                self.problems.append(
                    f"curve.csv: {bad:,} of {len(values):,} values of {name} are no finite numbers,"
                    " and are left out of this report"
                )
        return found

    def _plan(self):
        if not self.columns:
            return
        self.rows = np.arange(len(next(iter(self.columns.values()))))
        try:
            with filesOf(self.directory):
                spec = plan(self.run, self.columns, self.directory)
                rows = np.array(spec["rows"], int)
                shown = [axis["column"] for axis in (spec["x"], *spec["y"])]
        except (Refused, ValueError) as refused:
            self.problems.append(f"the curve is not drawn: {self._bare(refused)}")
            return
        good = np.isfinite([self.columns[name][rows] for name in shown[:2]]).all(axis=0)
        self.spec, self.rows = spec, rows[good]

    def _frames(self):
        try:
            with filesOf(self.directory):
                model = Model(self.directory, chosen=chosenFrames)
                self.elevation = self._drawing()
                self.picture = dataOfModel(model, curve=self.columns)
                number = elevation.frameOfCracks(self.run, self.directory)
                self.whenCracked = elevation.whenOf(self.run, self.directory, number)
        except Refused as refused:
            self.missing = str(refused)
        except (ValueError, ArithmeticError, np.linalg.LinAlgError, OSError) as error:
            self.missing = (
                f"{self.directory}: its frames cannot be read ({type(error).__name__}: {error})"
            )
        else:
            self.frameTimes, self.frameCount = model.times, model.count

    def _drawing(self):
        blocks = readFrame(self.directory, "blocks", 0, elevation.NEEDED)
        # it is seen from the front, also where cracks.png looks askew
        run = {**self.run, "views": {}}
        structure = self._whole(elevation.structureOf(run, blocks, None, self.directory))
        bricks = [b for b in structure.corners if structure.shades.get(b, "held") == "held"]
        low, high = (
            f(blocks["points"][structure.points(bricks)], axis=0) for f in (np.min, np.max)
        )
        targets = self.run.get("targets") or []
        for one in targets:
            structure.shades[one["body"]] = "held" if one.get("held") else "loaded or watched"
            if len(targets) <= MAX_NAMES:
                structure.names[one["body"]] = str(one["name"])
        size = " × ".join(written(float(v), 3) for v in high - low)
        about = f"The {len(bricks):,} bricks or other blocks as built, {size} m"
        with drawing.style():
            drawn = drawing.svg(elevation.figureOf(structure, "", 0), "built")
        return drawn, f"{about} (x × y × z)."

    def _whole(self, structure):
        """A structure in which the halves of bricks on both sides of a crack surface are one."""
        kinds = self.run.get("kinds") or []
        if CRACK_SURFACE in kinds:
            joints = readFrame(self.directory, "joints", 0, ["bodies", "kind"])
            inside = joints["kind"] == kinds.index(CRACK_SURFACE)
            for a, b in np.unique(np.sort(joints["bodies"][inside], axis=1), axis=0):
                if a in structure.corners and b in structure.corners:
                    both = structure.corners[int(a)], structure.corners.pop(int(b))
                    structure.corners[int(a)] = np.concatenate(both)
        structure.parts = {
            n: [b for b in part if b in structure.corners] for n, part in structure.parts.items()
        }
        return structure

    def image(self, name):
        """A figure of the folder as an address that holds it all, or None if it is not there."""
        try:
            data = readWhole(os.path.join(self.directory, name))
        except OSError:
            return None
        if not data.startswith(b"\x89PNG\r\n\x1a\n") or len(data) > LARGEST_PICTURE:
            return None
        return "data:image/png;base64," + base64.b64encode(data).decode()

    @functools.cached_property
    def data(self):
        """What these numbers are found from, without rows whose forces are not finite."""
        data = RunData(self.run, self.columns.get)
        known = [self.columns[h] for h in (MOVED, BASE, TOP) if h in self.columns]
        with filesOf(self.directory):
            rows = [n for n in data.rows if all(math.isfinite(v[n]) for v in known)]
        data.rows = rows  # type: ignore[misc]
        return data

    @functools.cached_property
    def numbers(self):
        """Numbers of the run, by their entries in run.json."""
        return quantities.known(self.data)

    @property
    def isPush(self):
        return bool(self.data.pushes)

    @property
    def isLooped(self):
        return bool(self.spec and self.spec["looped"])

    @functools.cached_property
    def ideals(self):
        """The bilinear curve of the push by every rule of :mod:`masonry_capacity.bilinear_curve`,
        or why there is none."""
        push, found = None, {}
        for rule in bilinear_curve.RULES:
            try:
                with filesOf(self.directory):
                    push = push or bilinear_curve.pushover(self.directory)
                    found[rule] = bilinear_curve.ofRun(push, rule)
            except Refused as refused:
                found[rule] = self._bare(refused)
        return found

    def _bare(self, refused):
        return str(refused).removeprefix(f"{self.directory}: ")


def _finite(text):
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan
