# SPDX-License-Identifier: GPL-2.0-or-later
"""How the blocks of a run move, and what its joints do, from all of its frames. This module needs no YADE.

The 3-D page (:mod:`masonry.read.page`) and glTF files (:mod:`masonry.read.gltf`) are made of this.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ..basics import Refused
from .cracks import CRACK, CRUSHED, DAMAGED, centresOf, crushed, widths
from .curve_figure import plan, unitOf
from .files import filesOf, readCurve, readRun
from .frames import framePaths, frameTimes, readFrame, readSurfaces

SHARP = np.cos(np.radians(20))  # of the angle from which an edge of a block is drawn
STIFF = 1e-6  # [-] how far corners of a rigid block may be off a rigid motion, of the size of the structure
FARTHEST = 1e6  # [m] from the origin
OPEN, SLID, CRUSHED_TOO = (
    1,
    2,
    4,
)  # kinds of a crack; a joint can be crushed beside the first or the second


class Motion:
    """Blocks of a run in all of its frames, or in one. N points, B blocks, F frames.

    - ``run``, ``title``: run.json and its title; ``times``: of the frames [s]; ``numbers``: of the frames that were read, from 0;
      ``count``: of all frames of the run
    - ``points`` (N, 3): corners and nodes as built [m]; ``owner`` (N): number of the block of each
    - ``bodies`` (B): ids of the bodies of the blocks; ``centres`` (B, 3): means of their points [m]
    - ``brick`` (B): whether a block is one of the masonry, not a platen, a support or the like
    - ``framed`` (N): whether a point is to be in the picture, and not one of the ground on which blocks fall
    - ``triangles`` (n, 3): surfaces of the blocks, seen from outside counter-clockwise, and ``edges`` (n, 2): their edges,
      both as numbers of points
    - ``rigid`` (B): whether a block is rigid
    - ``shift`` (F, B, 3): displacement of the centre of every rigid block [m], and ``turn`` (F, B, 3): its rotation as a vector
      along the axis, of the length of the angle [rad]; zero for deformable units
    - ``free``: numbers of the points of deformable units; ``moved`` (F, len(free), 3): their displacements [m]
    - ``farthest`` (F): largest displacement of a point [m]

    If run.json names a ``reference_body``, as the ground of a shaken structure, its displacement is taken off all others.
    """

    def __init__(self, directory, number=None, chosen=None):
        """Read a run.

        :param directory: folder of results
        :param number: of the only frame to read, from 0; None: all
        :param chosen: function of the number of frames and of the number of blocks that gives the numbers of the frames to read;
            None: all
        :raises Refused: if the folder has no frames, if they are damaged or of different structures, or without that frame
        """
        self.directory, self.run = directory, readRun(directory)
        with filesOf(directory):
            self.title = str(
                self.run.get("title") or os.path.basename(os.path.abspath(directory))
            )
            times = self._times()
            count = len(times)
            if number is not None and not 0 <= number < count:
                raise Refused(f"{directory}: there is no frame {number}; its frames are 0 to {count - 1}")  # fmt: skip
            self.numbers = list(range(count)) if number is None else [number]
            self.count = count  # of all frames of the run
            self._build()
            if chosen:
                self.numbers = list(chosen(count, len(self.bodies)))
            self.times = [times[n] for n in self.numbers]
            self._move()

    def _times(self):
        """Times of the frames, as joints.pvd lists them [s]. Raises Refused with the reason if there is none.

        A run that was killed can have written a frame more, which is not shown.
        """
        options = self.run.get("options") or {}
        try:
            counts = [len(framePaths(self.directory, k)) for k in ("blocks", "joints")]
            times = frameTimes(self.directory)
        except Refused as problem:
            for name in ("lean", "no_vtk"):
                if options.get(name):
                    raise Refused(
                        f"{self.directory} has no frames to show, because its run was started with --{name.replace('_', '-')}"
                    ) from None
            raise Refused(f"{self.directory} has no frames to show: {problem}") from None  # fmt: skip
        # the last frame of a run can be written twice
        if not (np.isfinite(times).all() and (np.diff(times) >= 0).all()):
            raise Refused(f"{self.directory}: the times of its frames in joints.pvd go back or are not finite")  # fmt: skip
        if not times or min(counts) < len(times):
            raise Refused(
                f"{self.directory}: joints.pvd lists {len(times)} frames, and there are {counts[0]} files blocks_*.vtu "
                f"and {counts[1]} files joints_*.vtp"
            )
        return times

    def _build(self):
        """The blocks as they were built."""
        first = self._blocks(self.numbers[0])
        triangles, cells, rigid = readSurfaces(self.directory, self.numbers[0])
        self.points = first["points"]
        self.bodies, block = np.unique(first["body"], return_inverse=True)
        self.owner = np.full(len(self.points), -1)
        for cell, corners in enumerate(first["cells"]):
            self.owner[corners] = block[cell]
        if (self.owner < 0).any():
            raise Refused(f"{self.directory}: points of its frames belong to no block")
        self.rigid = np.bincount(block, rigid) > 0
        self.centres = self._means(self.points)
        members = [
            body for part in (self.run.get("parts") or {}).values() for body in part
        ]
        self.brick = np.isin(self.bodies, members) if members else np.ones(len(self.bodies), bool)  # fmt: skip
        self.framed = self.bodies[self.owner] != self.run.get("ground_body")
        if not self.framed.any():
            self.framed[:] = True
        # the side of a zone that another zone has, too, is inside the unit
        _, where, often = np.unique(
            np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        outside = (often[where.ravel()] == 1) | rigid[cells]
        triangles, cells = triangles[outside], cells[outside]
        inside = np.array([self.points[c].mean(axis=0) for c in first["cells"]])[cells]
        a, b, c = (self.points[triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        inward = ((a - inside) * normals).sum(axis=1) < 0
        triangles[inward] = triangles[inward][:, ::-1]
        normals[inward] *= -1
        self.triangles = triangles
        self.edges = sharpEdges(triangles, normals)
        self.free = np.flatnonzero(~self.rigid[self.owner])

    def _move(self):
        """The blocks in all frames."""
        count, blocks = len(self.numbers), len(self.bodies)
        self.shift, self.turn = np.zeros((2, count, blocks, 3))
        self.moved = np.zeros((count, len(self.free), 3))
        self.farthest = np.zeros(count)
        size = np.ptp(self.points, axis=0).max()
        arms = self.points - self.centres[self.owner]
        reference = self.run.get("reference_body")
        held = self.bodies[self.owner] == reference
        if reference is not None and not held.any():
            raise Refused(f"{self.directory}: run.json names body {reference}, which is not in the frames")  # fmt: skip
        for k, number in enumerate(self.numbers):
            frame = self._blocks(number)
            if not np.array_equal(frame["points"], self.points):
                raise Refused(f"{self.directory}: frame {number} has other blocks than frame {self.numbers[0]}")  # fmt: skip
            moved = frame["displacement"]
            if held.any():
                moved = moved - moved[held].mean(axis=0)
            self.farthest[k] = np.linalg.norm(moved, axis=1).max()
            self.moved[k] = moved[self.free]
            centre = self._means(moved)
            away = arms + moved - centre[self.owner]
            turn = self._turns(arms, away)
            off = np.linalg.norm(turned(turn[self.owner], arms) + arms - away, axis=1)
            off[self.free] = 0
            if off.max() > STIFF * size:
                raise Refused(
                    f"{self.directory}: block {self.bodies[self.owner[off.argmax()]]} does not move as a rigid body in frame {number}"
                )
            self.shift[k][self.rigid] = centre[self.rigid]
            self.turn[k][self.rigid] = turn[self.rigid]

    def _blocks(self, number):
        frame = readFrame(self.directory, "blocks", number)
        for name in ("points", "displacement"):
            if not (np.abs(frame[name]) < FARTHEST).all():
                raise Refused(f"{self.directory}: a number of the blocks in frame {number} is not finite, or {FARTHEST:g} m and more")  # fmt: skip
        return frame

    def _means(self, values):
        """Means of the rows of points by their blocks."""
        sums = [np.bincount(self.owner, column) for column in values.T]
        return np.column_stack(sums) / np.bincount(self.owner)[:, None]

    def _turns(self, arms, away):
        """Rotations of all blocks as vectors, which bring arms next to where they are. By Horn's method: the quaternion is
        the eigenvector of the largest eigenvalue of a matrix of the sums of products.
        """
        s = np.empty((3, 3, len(self.bodies)))
        for i in range(3):
            for j in range(3):
                s[i, j] = np.bincount(self.owner, arms[:, i] * away[:, j])
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = s
        rows = [
            [xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, xx - yy - zz, xy + yx, zx + xz],
            [zx - xz, xy + yx, yy - xx - zz, yz + zy],
            [xy - yx, zx + xz, yz + zy, zz - xx - yy],
        ]
        q = np.linalg.eigh(np.moveaxis(np.array(rows), -1, 0))[1][:, :, -1]
        q *= np.where(q[:, :1] < 0, -1, 1)
        sine = np.linalg.norm(q[:, 1:], axis=1)
        angle = 2 * np.arctan2(sine, q[:, 0])
        factor = np.divide(angle, sine, out=np.full(len(q), 2.0), where=sine > 0)
        return factor[:, None] * q[:, 1:]

    def displacements(self, k):
        """Displacements of all points in the k-th of the frames that were read, an array (N, 3) [m]."""
        arms = self.points - self.centres[self.owner]
        found = self.shift[k][self.owner] + turned(self.turn[k][self.owner], arms)
        found[self.free] = self.moved[k]
        return found

    def captions(self, curve=None):
        """What is shown beside every frame: a list of dicts with ``stage``, or None, and ``values``, a list of texts as
        "supports: 92.1 kN" of the columns that curve.png shows.

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
            if spec and "time_s" in data:
                for axis in (spec["x"], *spec["y"]):
                    if axis["column"] == "time_s":
                        continue
                    unit = unitOf(axis if axis is spec["x"] else {**axis, "label": spec["y_label"]})  # fmt: skip
                    name = axis["label"].rsplit(" [", 1)[0]
                    value = np.interp(time, data["time_s"], data[axis["column"]])
                    values.append(f"{name}: {value:.4g} {unit}")
            found.append({"stage": self._stage(time, data), "values": values})
        return found

    def _stage(self, time, data):
        """Name of the stage to which a time belongs, or None if the files do not tell, as after a change of the time step."""
        stages, step = self.run.get("stages"), self.run.get("time_step_s")
        if not stages or not step or "time_s" not in data:
            return None
        ends = step * np.cumsum([stage["steps"] for stage in stages])
        if abs(ends[-1] - data["time_s"][-1]) > 0.01 * ends[-1]:
            return None
        return stages[min(int(np.searchsorted(ends, time - 0.5 * step)), len(stages) - 1)]["stage"]  # fmt: skip


class Cracks:
    """What the joints of a run do in its frames: all points of joints that crack, slide or crush in one of them. P points.

    - ``cells``: of every point of a joint that is kept, the numbers of the corners of its part of the joint
    - ``points`` (n, 3): these corners as built [m]; ``owner`` (n): the point of a joint that each belongs to
    - ``between`` (P, 2): numbers of the two blocks in a :class:`Motion`
    - ``opening``, ``slide``, ``closure`` (F, P): opening, length of the slide, plastic closure [m]; ``damage`` (F, P) in tension
      or shear, the larger [-]
    - ``kind`` (F, P): OPEN or SLID as :func:`masonry.read.cracks.widths` finds it, plus CRUSHED_TOO, or 0
    - ``moved`` (F, n, 3): displacements of the corners [m]; None if both blocks of all joints are rigid: then it is the
      mean of what they do there
    - ``count``: how many points joints have in all
    """

    def __init__(self, motion):
        names = ("opening", "slide", "closure", "damage", "kind")
        rows = {name: [] for name in names}
        moved = []
        deforms = not motion.rigid.all()
        # joints never get fewer points during a run
        last = readFrame(motion.directory, "joints", motion.numbers[-1])
        for number in motion.numbers:
            frame = readFrame(motion.directory, "joints", number)
            with filesOf(motion.directory):
                same = pointsFor(last, frame)
                if same is None:
                    raise Refused(f"{motion.directory}: frame {number} has other joints than frame {motion.numbers[-1]}")  # fmt: skip
                slide = np.linalg.norm(frame["slide"], axis=1)
                _, opened, cracked = widths(frame)
                kind = np.where(cracked, np.where(opened, OPEN, SLID), 0)
                damage = np.maximum(frame["damage_tension"], frame["damage_shear"])
                values = (frame["opening"], slide, frame["crushing"], damage, kind + CRUSHED_TOO * crushed(frame))  # fmt: skip
                for name, value in zip(names, values):
                    if not np.isfinite(value).all():
                        raise Refused(f"{motion.directory}: the {name} of a joint in frame {number} is not finite")  # fmt: skip
                    rows[name].append(value[same])
                if deforms:
                    moved.append(frame["displacement"] - self._still(motion, number))
        self.count = len(last["cells"])
        rows = {name: np.array(values) for name, values in rows.items()}
        shown = (
            (rows["kind"] > 0)
            | (rows["damage"] > DAMAGED)
            | (np.maximum(rows["opening"], rows["slide"]) > CRACK)
            | (rows["closure"] > CRACK)
        ).any(axis=0)
        kept = np.flatnonzero(shown)
        for name in names:
            setattr(self, name, rows[name][:, kept])
        cells = [last["cells"][n] for n in kept]
        corners = np.concatenate(cells) if cells else np.zeros(0, int)
        self.points = last["points"][corners]
        sizes = np.array([len(c) for c in cells], int)
        self.owner = np.repeat(np.arange(len(kept)), sizes)
        self.cells = np.split(np.arange(len(corners)), np.cumsum(sizes)[:-1]) if cells else []  # fmt: skip
        between = np.searchsorted(motion.bodies, last["bodies"][kept])
        if between.size and (
            between.max() >= len(motion.bodies)
            or (motion.bodies[between] != last["bodies"][kept]).any()
        ):
            raise Refused(f"{motion.directory}: its joints are of bodies that are no blocks")  # fmt: skip
        self.between = between
        self.moved = None
        if deforms and not motion.rigid[between].all():
            self.moved = np.array(moved)[:, corners]

    @staticmethod
    def _still(motion, number):
        """Displacement of the reference body in a frame, which is taken off."""
        reference = motion.run.get("reference_body")
        if reference is None:
            return 0.0
        frame = readFrame(motion.directory, "blocks", number)
        return frame["displacement"][motion.bodies[motion.owner] == reference].mean(axis=0)  # fmt: skip

    def displacements(self, motion, k):
        """Displacements of all corners in the k-th frame, an array (n, 3) [m]."""
        if self.moved is not None:
            return self.moved[k]
        found = 0.0
        for side in range(2):
            block = self.between[self.owner, side]
            arms = self.points - motion.centres[block]
            found = found + 0.5 * (motion.shift[k][block] + turned(motion.turn[k][block], arms))  # fmt: skip
        return found


def pointsFor(last: dict[str, Any], frame: dict[str, Any]) -> np.ndarray | None:
    """For every point of joints in a frame, the number of the nearest point of the same joint in an earlier frame, where the
    joint may have fewer. None if the joints are others, or if one has fewer points later.

    :param last: the frame, of joints, as of :func:`masonry.read.frames.readFrame`
    :param frame: the earlier one
    """
    if np.array_equal(frame["points"], last["points"]):
        return np.arange(len(last["cells"]))
    starts, numbers = [], []
    for one in (frame, last):
        changes = (np.diff(one["bodies"], axis=0) != 0).any(axis=1)
        starts.append(np.append(0, np.flatnonzero(changes) + 1))
        numbers.append(np.diff(np.append(starts[-1], len(one["cells"]))))
    if not np.array_equal(frame["bodies"][starts[0]], last["bodies"][starts[1]]):
        return None
    if (numbers[0] > numbers[1]).any():
        return None
    centres = [centresOf(one["points"], one["cells"]) for one in (frame, last)]
    found = np.repeat(starts[0] - starts[1], numbers[1]) + np.arange(len(last["cells"]))
    same = np.repeat(numbers[0] == numbers[1], numbers[1])
    moved = np.abs(centres[0][found[same]] - centres[1][same])
    if moved.max(initial=0.0) > 1e-9 * np.ptp(last["points"], axis=0).max():
        return None  # by more than round-off
    for n in np.flatnonzero(numbers[0] != numbers[1]):
        few, many = (slice(s[n], s[n] + c[n]) for s, c in zip(starts, numbers))
        apart = centres[1][many, None] - centres[0][None, few]
        found[many] = starts[0][n] + (apart**2).sum(axis=2).argmin(axis=1)
    return found


#: From where on a value of a joint is drawn; the same for all frames.
LEAST = {"opening": CRACK, "slide": CRACK, "closure": CRACK, "damage": DAMAGED}
LIMITS = {"crack": CRACK, "damaged": DAMAGED, "crushed": CRUSHED}


def turned(turn, arms):
    """How far arms move when they are turned by rotation vectors: arrays (n, 3), without a loss of digits at small angles."""
    angle = np.linalg.norm(turn, axis=1)[:, None]
    half = np.sinc(angle / (2 * np.pi))  # sin(angle/2) / (angle/2)
    first = np.cross(turn, arms)
    return np.sinc(angle / np.pi) * first + 0.5 * half**2 * np.cross(turn, first)


def sharpEdges(triangles, normals):
    """Edges of surfaces at which they bend by more than 20°, or end: an array (n, 2) of point numbers.

    :param triangles: numbers of corners (n, 3); two triangles share an edge if they share both of its points
    :param normals: of the triangles, of any length (n, 3)
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
