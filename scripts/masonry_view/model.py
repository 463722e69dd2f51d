# SPDX-License-Identifier: GPL-2.0-or-later
"""The model of the 3-D picture of a run: its blocks, how they move, and what its joints do.

The page (:mod:`masonry_view.page`), the report and ParaView's window show this.
"""

from typing import NamedTuple

import numpy as np

from masonry.errors import Refused
from masonry.numbers.cracks import CRACK, DAMAGED, centresOf, crushed, widths
from .curve_figure import bare, plan, unitOf
from masonry.numbers.files import filesOf, readCurve, readRun
from masonry.numbers.frames import framePaths, frameTimes, readFrame, readSurfaces
from masonry.terminal import escapeControls
from .views import REACH, magnificationOf, viewOf

SHARP = np.cos(np.radians(20))  # of the angle from which an edge of a block is drawn
#: Kinds of a crack; a joint can be crushed beside the first or the second.
OPEN, SLID, CRUSHED_TOO = 1, 2, 4
#: Kinds of blocks.
PLATEN, BRICK, GROUND = 0, 1, 2
LOOKS = "platen", "brick", "ground"  # their names


class Sight(NamedTuple):
    """How the picture of a run is seen first."""

    magnification: float  #: of displacements [-]
    low: np.ndarray  #: corner of the box around all that is in it [m]
    high: np.ndarray  #: the opposite corner
    towards: np.ndarray  #: horizontal direction to the viewer
    flat: bool  #: whether this shows a wall or an arch from its front


class Model:
    """The blocks and joints of a run in all of its frames, or in some. N points, B blocks, F
    frames.

    - ``run``, ``title``: run.json and its title; ``times``: of the frames [s]; ``numbers``: of the
      frames that were read, from 0; ``count``: of all frames of the run
    - ``points`` (N, 3): corners and nodes as built [m]; ``owner`` (N): number of the block of each
    - ``bodies`` (B): ids of the blocks; ``centres`` (B, 3): means of their points [m]; ``looks``
      (B): PLATEN (also supports and the like), BRICK or GROUND; ``rigid`` (B): whether it is rigid
    - ``framed`` (N): whether a point is in the picture: none of the ground on which blocks fall
    - ``triangles`` (n, 3): surfaces of the blocks, counter-clockwise from outside, and ``edges``
      (n, 2): their edges, both as numbers of points
    - ``shift``, ``turn`` (F, B, 3): displacement of the centre of every rigid block [m], and its
      rotation vector [rad]; zero for deformable units
    - ``free``: numbers of the points of deformable units; ``moved`` (F, len(free), 3): their
      displacements [m]; ``farthest`` (F): largest displacement of a point [m]
    - ``joints``: :class:`Joints`

    The displacement of a ``reference_body`` in run.json, as the ground of a shaken structure, is
    taken off all others.
    """

    def __init__(self, directory, number=None, chosen=None):
        """
        :param directory: folder of results
        :param number: of the only frame to read, from 0; None: all
        :param chosen: function of the number of frames and of the number of blocks that gives the
            numbers of the frames to read; None: all
        :raises Refused: if the folder has no frames, if they are damaged, or without that frame
        """
        self.directory, self.run = directory, readRun(directory)
        with filesOf(directory):
            self.title = escapeControls(self.run.get("title") or directory)
            times = self._times()
            self.count = count = len(times)
            if number is not None and not 0 <= number < count:
                raise Refused(
                    f"{directory}: there is no frame {number}; its frames are 0 to {count - 1}"
                )
            self.numbers = list(range(count)) if number is None else [number]
            self._build(
                readFrame(directory, "blocks", self.numbers[0], ["body", "cells", "points"])
            )
            if chosen:
                self.numbers = list(chosen(count, len(self.bodies)))
            self.times = [times[n] for n in self.numbers]
            self._move()

    def _times(self):
        """Times of the frames that joints.pvd lists [s]; a run that was killed can have written one
        more. Raises Refused with the reason if there is none."""
        options = self.run.get("options") or {}
        try:
            counts = [len(framePaths(self.directory, k)) for k in ("blocks", "joints")]
            times = frameTimes(self.directory)
        except Refused as problem:
            for name in ("lean", "no_vtk"):
                if options.get(name):
                    problem = f"its run was started with --{name.replace('_', '-')}"
            raise Refused(f"{self.directory} has no frames to show: {problem}") from None
        if not times or min(counts) < len(times):
            raise Refused(
                f"{self.directory}: joints.pvd lists {len(times)} frames, and there are"
                f" {counts[0]} files blocks_*.vtu and {counts[1]} files joints_*.vtp"
            )
        return times

    def _build(self, first):
        triangles, cells, rigid = readSurfaces(self.directory, self.numbers[0])
        self.points = first["points"]
        self.bodies, block = np.unique(first["body"], return_inverse=True)
        self.owner = np.empty(len(self.points), int)
        corners = first["cells"]
        self.owner[np.concatenate(corners)] = np.repeat(block, [*map(len, corners)])
        self.rigid = np.bincount(block, rigid) > 0
        self.centres = self._means(self.points)
        parts = (self.run.get("parts") or {}).values()
        members = [body for part in parts for body in part] or self.bodies
        self.looks = np.where(np.isin(self.bodies, members), BRICK, PLATEN)
        self.looks[self.bodies == self.run.get("ground_body")] = GROUND
        self.framed = self.looks[self.owner] != GROUND
        # the side of a zone that another zone has, too, is inside the unit
        _, where, often = np.unique(
            np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        outside = (often[where.ravel()] == 1) | rigid[cells]
        triangles, cells = triangles[outside], cells[outside]
        inside = centresOf(self.points, corners)[cells]
        a, b, c = (self.points[triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        inward = ((a - inside) * normals).sum(axis=1) < 0
        triangles[inward] = triangles[inward][:, ::-1]
        normals[inward] *= -1
        self.triangles, self.edges = triangles, sharpEdges(triangles, normals)
        self.free = np.flatnonzero(~self.rigid[self.owner])

    def _move(self):
        reference = self.run.get("reference_body")
        held = self.bodies[self.owner] == reference
        if reference is not None and not held.any():
            raise Refused(
                f"{self.directory}: run.json names body {reference}, which is not in the frames"
            )
        shape = len(self.numbers), len(self.bodies), 3
        self.shift, self.turn = np.zeros(shape), np.zeros(shape)
        self.moved = np.zeros((len(self.numbers), len(self.free), 3))
        self.farthest = np.zeros(len(self.numbers))
        self.joints = Joints(self)
        needed = ("blocks", ["body", "displacement", "rotation"]), ("joints", self.joints.needed)
        for k, number in enumerate(self.numbers):
            blocks, joints = (
                readFrame(self.directory, kind, number, names) for kind, names in needed
            )
            for frame in (blocks, joints):
                for name, values in frame.items():
                    if name != "cells" and not np.isfinite(values).all():
                        raise Refused(f"{self.directory}: {name} in frame {number} is not finite")
            still = blocks["displacement"][held].mean(axis=0) if held.any() else 0.0
            moved = blocks["displacement"] - still
            self.farthest[k] = np.linalg.norm(moved, axis=1).max()
            self.moved[k] = moved[self.free]
            self.shift[k] = self._means(moved) * self.rigid[:, None]
            # every zone of a deformable unit has a row
            self.turn[k, np.searchsorted(self.bodies, blocks["body"])] = blocks["rotation"]
            self.joints.add(joints, still)
        self.joints.end()

    def corners(self):
        """Points of every block but the ground, a list of arrays (n, 3) [m]."""
        order, counts = np.argsort(self.owner, kind="stable"), np.bincount(self.owner)
        blocks = np.split(self.points[order], np.cumsum(counts)[:-1])
        return [own for own, look in zip(blocks, self.looks) if look != GROUND]

    def _means(self, values):
        """Means of the rows of points by their blocks."""
        sums = [np.bincount(self.owner, column) for column in values.T]
        return np.column_stack(sums) / np.bincount(self.owner)[:, None]

    def displacements(self, k):
        """Displacements of all points in the k-th of the frames that were read (N, 3) [m]."""
        found = self.displacementsOf(k, self.owner, self.points)
        found[self.free] = self.moved[k]
        return found

    def displacementsOf(self, k, block, points):
        """Displacements of points (n, 3) that move with rigid blocks of these numbers (n), in the
        k-th frame [m]."""
        arms = points - self.centres[block]
        return self.shift[k][block] + turned(self.turn[k][block], arms)

    def sight(self, magnification=None):
        """The :class:`Sight` of the last of the frames that were read, with all in it but for what
        flew away.

        :param magnification: None: that of :func:`masonry_view.views.magnificationOf`
        """
        needed = "area bodies damage_shear damage_tension normal opening slide".split()
        joints = readFrame(self.directory, "joints", self.numbers[-1], needed)
        points = self.points[self.framed]
        towards = viewOf(points, joints["normal"], joints["area"]).towards
        low, high = points.min(axis=0), points.max(axis=0)
        size = float((high - low).max())
        moved = self.displacements(-1)[self.framed]
        if magnification is None:
            magnification = magnificationOf(joints, moved, self.corners())
        seen = np.clip(points + magnification * moved, low - REACH * size, high + REACH * size)
        low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        if moved.mean(axis=0) @ towards < -0.1 * size:  # it fell to the other side
            towards = -towards
        flat = bool(abs(towards[2]) < 0.9)
        return Sight(
            magnification, low, high, towards if flat else np.array([0.0, -1.0, 0.0]), flat
        )

    def captions(self, curve=None):
        """What is shown beside every frame: dicts with ``time``, ``stage``, or None, and
        ``values``, texts as "supports: 92.1 kN" of the columns that curve.png shows.

        :param curve: columns of curve.csv; None: they are read
        """
        data, spec = {}, None
        if "figure" in self.run:
            curve = readCurve(self.directory) if curve is None else curve
            data = {k: np.array(v) for k, v in curve.items()}
            spec = plan(self.run, data, self.directory)
        found = []
        for time in self.times:
            values = []
            for axis in (spec["x"], *spec["y"]) if spec and "time_s" in data else ():
                if axis["column"] != "time_s":
                    unit = unitOf(axis if axis is spec["x"] else {**axis, "label": spec["y_label"]})
                    value = np.interp(time, data["time_s"], data[axis["column"]])
                    values.append(escapeControls(f"{bare(axis['label'])}: {value:.4g} {unit}"))
            stage = self._stage(time, data)
            found.append({"time": time, "stage": stage and escapeControls(stage), "values": values})
        return found

    def _stage(self, time, data):
        """Name of the stage of a time; None if the files do not tell, as after a change of the time
        step."""
        stages, step = self.run.get("stages"), self.run.get("time_step_s")
        if not stages or not step or "time_s" not in data:
            return None
        ends = step * np.cumsum([stage["steps"] for stage in stages])
        if abs(ends[-1] - data["time_s"][-1]) > 0.01 * ends[-1]:
            return None
        return stages[min(int(np.searchsorted(ends, time - 0.5 * step)), len(stages) - 1)]["stage"]


#: Displacements of the corners of a joint with its first and with its second block.
SIDES = ["displacement", "second_displacement"]
PAIR, POINT = 16, 24  # bytes of two numbers of bodies, and of a point


class Joints:
    """Points of the joints of a :class:`Model` that crack, slide or crush in one of its frames. P
    points, with n corners of their parts of the joints. A joint that gets other points during the
    run has in each frame those of that time.

    - ``corners`` (n, 3): as built [m]; ``owner`` (n): number of the point of each
    - ``between`` (P, 2): numbers of the two blocks
    - ``opening``, ``slide``, ``closure`` (F, P): opening, length of the slide, plastic closure [m];
      ``damage`` (F, P) in tension or shear, the larger [-]
    - ``kind`` (F, P): OPEN or SLID as :func:`masonry.numbers.cracks.widths` finds it, plus
      CRUSHED_TOO, or 0
    - ``moved`` (2, F, n, 3): displacements of the corners with the first and with the second block
      [m]; None if all of these blocks are rigid
    - ``count``: how many points joints have in the last frame
    """

    def __init__(self, model):
        self._model = model
        self._numbers = {}  # of points of joints, by their bodies and corners as bytes
        self._frames = []  # numbers, values and displacements of every frame
        self._last = None
        #: names of the arrays of a frame that :meth:`add` needs
        self.needed = (
            "bodies cells crushing damage_shear damage_tension opening points slide".split()
        )
        self.needed += [] if model.rigid.all() else SIDES

    def add(self, frame, still):
        """Add the joints of the next frame; ``still`` is taken off all displacements [m]."""
        points, cells, known = frame["points"], frame["cells"], self._numbers
        if self._last is None or not np.array_equal(self._last[0], points):
            corners = points[np.concatenate(cells)].tobytes()
            ends = (POINT * np.cumsum([0, *map(len, cells)])).tolist()
            keys = [
                pair.tobytes() + corners[a:b]
                for pair, a, b in zip(frame["bodies"].astype(int), ends, ends[1:])
            ]
            numbers = [known.setdefault(key, len(known)) for key in keys]
            self._last = points, np.array(numbers)
        _, opened, cracked = widths(frame)
        values = np.array(
            [
                frame["opening"],
                np.linalg.norm(frame["slide"], axis=1),
                frame["crushing"],
                np.maximum(frame["damage_tension"], frame["damage_shear"]),
                np.where(cracked, np.where(opened, OPEN, SLID), 0) + CRUSHED_TOO * crushed(frame),
            ]
        )
        shown = (
            (values[0] > CRACK) | (values[1] > CRACK) | (values[2] > CRACK) | (values[3] > DAMAGED)
        )
        rigid = self._model.rigid.all()
        moved = [] if rigid else [np.array([frame[s] for s in SIDES]) - still, cells]
        self._frames.append((self._last[1], values, shown, *moved))
        self.count = len(cells)

    def end(self):
        """Keep the points that do something in one of the frames."""
        total = np.zeros(len(self._numbers), bool)
        for numbers, _, shown, *_ in self._frames:
            total[numbers[shown]] = True
        kept = np.flatnonzero(total)
        place = np.full(len(total), -1)
        place[kept] = np.arange(len(kept))
        found = np.zeros((5, len(self._frames), len(kept)))
        for k, (numbers, values, *_) in enumerate(self._frames):
            mine = place[numbers] >= 0
            found[:, k, place[numbers[mine]]] = values[:, mine]
        self.opening, self.slide, self.closure, self.damage, kind = found
        self.kind = kind.astype(int)
        known = [key for key, isKept in zip(self._numbers, total) if isKept]
        sizes = [(len(key) - PAIR) // POINT for key in known]
        corners, bodies = (
            b"".join(key[part] for key in known) for part in (slice(PAIR, None), slice(PAIR))
        )
        self.corners = np.frombuffer(corners).reshape(-1, 3)
        self.owner = np.repeat(np.arange(len(kept)), sizes)
        bodies = np.frombuffer(bodies, int).reshape(-1, 2)
        self.between = np.searchsorted(self._model.bodies, bodies)
        self.moved = None
        if not self._model.rigid[self.between].all():
            self.moved = np.zeros((2, len(self._frames), len(self.corners), 3))
            starts = np.cumsum([0, *sizes])
            for k, (numbers, _, _, moved, cells) in enumerate(self._frames):
                for n, cell in zip(place[numbers], cells):
                    if n >= 0:
                        self.moved[:, k, starts[n] : starts[n + 1]] = moved[:, cell]
        del self._numbers, self._frames, self._last


#: From where on a value of a joint is drawn; the same for all frames.
LEAST = {"opening": CRACK, "slide": CRACK, "closure": CRACK, "damage": DAMAGED}


def turned(turn, arms):
    """How far arms move that rotation vectors turn: arrays (n, 3), with all digits at small
    angles."""
    angle = np.linalg.norm(turn, axis=1)[:, None]
    half = np.sinc(angle / (2 * np.pi))  # sin(angle/2) / (angle/2)
    first = np.cross(turn, arms)
    return np.sinc(angle / np.pi) * first + 0.5 * half**2 * np.cross(turn, first)


def sharpEdges(triangles, normals):
    """Edges at which surfaces bend by more than 20°, or end: point numbers (n, 2).

    :param triangles: numbers of corners (n, 3); ``normals``: theirs, of any length (n, 3)
    """
    sides = np.sort(triangles[:, [(0, 1), (1, 2), (2, 0)]].reshape(-1, 2), axis=1)
    faces = np.repeat(normals / np.linalg.norm(normals, axis=1)[:, None], 3, axis=0)
    order = np.lexsort(sides.T)
    sides, faces = sides[order], faces[order]
    starts = np.append(True, (np.diff(sides, axis=0) != 0).any(axis=1))
    first = np.flatnonzero(starts)
    often = np.diff(np.append(first, len(sides)))
    bends = (faces[first] * faces[first + often - 1]).sum(axis=1) < SHARP
    return sides[first[bends | (often != 2)]]


# frames times blocks; reading them takes seconds, and they take some 12 bytes each in a page
MAX_PLACES = 80_000
MIN_FRAMES = 10  # frames that are shown all the same


def chosenFrames(count, blocks):
    """Numbers of the frames of a long or large run that are shown: evenly spaced, with the first
    and the last."""
    many = max(MIN_FRAMES, MAX_PLACES // max(blocks, 1))
    return sorted({round(n) for n in np.linspace(0, count - 1, min(count, many))})
