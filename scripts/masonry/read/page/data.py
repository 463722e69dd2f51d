# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a run for ``viewer.js``: a JSON head, and arrays that are rounded, compressed and written in base64.

A displacement is a whole number of steps of 1/32,767 of the largest, other values are whole numbers of 1/4,000 of the largest
in the frames, and damage is in steps of 1/255. This module needs no YADE.
"""

import base64
import zlib

import numpy as np

from ...basics import Refused, plain
from ..crack_figure import magnificationOf
from ..files import filesOf
from ..frames import readFrame
from ..motion import CRUSHED_TOO, LEAST, LIMITS, OPEN, SLID, Cracks, Motion
from ..views import viewOf

LEVELS = 4000  # of values of joints that are shown in colours


class Arrays:
    """Arrays on their way to a page, and what the page must know to read them.

    Of an array of frames each row but the first is the difference to the row before; of indices each number is the difference
    to the number before. Then all first bytes of the numbers follow each other, then all second bytes, and so on. All that
    only makes them shorter when they are compressed.
    """

    def __init__(self):
        self.known, self._bytes, self._at = {}, [], 0

    def add(self, name, values, kind, step=1.0, frames=False):
        """Append an array.

        :param kind: numpy's name of the type of the numbers: u1, u2, i2, u4 or f4
        :param step: by which the whole numbers are multiplied
        :param frames: whether the first axis is that of the frames
        """
        values = np.asarray(values).astype("<" + kind)
        whole = values.view(f"<u{values.itemsize}")
        rows = whole.reshape((len(whole), -1) if frames else (-1, 1))
        coded = rows.copy()
        coded[1:] -= rows[:-1]  # of unsigned numbers, which wrap
        planes = coded.reshape(-1, 1).view("u1").T if coded.size else coded
        data = planes.tobytes()
        self.known[name] = {
            "kind": kind,
            "at": self._at,
            "count": int(values.size),
            "row": int(rows.shape[1]),
            "step": float(step),
        }
        self._bytes.append(data)
        self._at += len(data)

    def addMotion(self, name, values):
        """Append displacements or rotations, rounded to steps of 1/32,767 of the largest."""
        most = float(np.abs(values).max(initial=0.0))
        step = most / 32767 or 1.0
        self.add(name, np.rint(values / step), "i2", step, frames=True)

    def text(self):
        return base64.b64encode(zlib.compress(b"".join(self._bytes), 9)).decode()


def dataOf(directory, number=None, magnification=None):
    """The head, a dict that can be written as JSON, and the arrays as a text in base64.

    :param directory: folder of results
    :param number: of the frame that is shown first, from 0; None: the last one
    :param magnification: of displacements at first [-]; None: as in cracks.png
    :raises Refused: if the folder has no frames, if they are damaged, or without that frame
    """
    motion = Motion(directory)
    count = len(motion.times)
    if number is not None and not 0 <= number < count:
        raise Refused(f"{directory}: there is no frame {number}; its frames are 0 to {count - 1}")  # fmt: skip
    return dataOfMotion(motion, number, magnification)


def dataOfMotion(motion, number=None, magnification=None, curve=None):
    """As :func:`dataOf`, of a run whose frames have been read.

    :param motion: :class:`masonry.read.motion.Motion`
    :param number: of the frame that is shown first among those that were read, from 0
    :param curve: columns of curve.csv for what is said beside the frames; None: they are read
    """
    count = len(motion.times)
    with filesOf(motion.directory):
        cracks = Cracks(motion)
        arrays, head = Arrays(), _head(motion, magnification, curve)
    _addBlocks(arrays, motion)
    head["values"] = _addJoints(arrays, cracks)
    _addTies(arrays, motion)
    head.update(
        first=count - 1 if number is None else number,
        jointPoints=cracks.count,
        keptPoints=len(cracks.cells),
        rigid=cracks.moved is None,
        arrays=arrays.known,
    )
    return head, arrays.text()


def _head(motion, magnification, curve):
    """What is said about a run, and how it is seen first."""
    with filesOf(motion.directory):
        joints = readFrame(motion.directory, "joints", motion.numbers[0])
        points = motion.points[motion.framed]
        view = viewOf(points, joints["normal"], joints["area"])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    moved = motion.displacements(len(motion.times) - 1)[motion.framed]
    if magnification is None:
        magnification = magnificationOf(size, np.linalg.norm(moved, axis=1))
    # all is in the picture at the end, but for what flew away, as in cracks.png
    seen = points + magnification * moved
    seen = np.clip(seen, low - 0.6 * size, high + 0.6 * size)
    low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
    courses = _extents(motion)[motion.brick]
    towards = view.towards.tolist()
    return {
        "title": plain(motion.title),
        "frames": [
            {"time": time, "stage": found["stage"] and plain(found["stage"]), "values": [plain(v) for v in found["values"]]}
            for time, found in zip(motion.times, motion.captions(curve))
        ],
        "magnification": magnification,
        "low": low.tolist(),
        "high": high.tolist(),
        "towards": towards if abs(towards[2]) < 0.9 else [0.0, -1.0, 0.0],
        "flat": abs(towards[2]) < 0.9,
        "course": float(np.median(courses)) if len(courses) else size,
        "farthest": float(motion.farthest.max()),
        "ramp": nice(float(motion.farthest.max()) or 1.0),
        "blocks": int(len(motion.bodies)),
        "deformable": int((~motion.rigid).sum()),
        "kinds": {"open": OPEN, "slid": SLID, "crushed": CRUSHED_TOO},
        "limits": LIMITS,
    }  # fmt: skip


def _extents(motion):
    """The smallest extent of every block [m]."""
    order = np.argsort(motion.owner, kind="stable")
    starts = np.searchsorted(motion.owner[order], np.arange(len(motion.bodies)))
    points = motion.points[order]
    extents = np.maximum.reduceat(points, starts) - np.minimum.reduceat(points, starts)
    return extents.min(axis=1)


def _addBlocks(arrays, motion):
    arrays.add("points", motion.points, "f4")
    arrays.add("owner", motion.owner, "u4")
    arrays.add("triangles", motion.triangles, "u4")
    arrays.add("edges", motion.edges, "u4")
    arrays.add("bodies", motion.bodies, "u4")
    arrays.add("brick", motion.brick, "u1")
    arrays.add("centres", motion.centres, "f4")
    arrays.add("free", motion.free, "u4")
    arrays.addMotion("shift", motion.shift)
    arrays.addMotion("turn", motion.turn)
    arrays.addMotion("moved", motion.moved)


def _addJoints(arrays, cracks):
    """The joints; returns what the colours of their values need."""
    arrays.add("jointPoints", cracks.points, "f4")
    arrays.add("jointOwner", cracks.owner, "u4")
    arrays.add("jointBlocks", cracks.between, "u4")
    arrays.add("kind", cracks.kind, "u1", frames=True)
    if cracks.moved is not None:
        arrays.addMotion("jointMoved", cracks.moved)
    found = {}
    for name in ("opening", "slide", "closure", "damage"):
        values = getattr(cracks, name)
        if name == "damage":
            arrays.add(name, np.rint(255 * np.clip(values, 0, 1)), "u1", 1 / 255, frames=True)  # fmt: skip
            found[name] = {"least": LEAST[name], "top": 1.0, "most": float(values.max(initial=0.0))}  # fmt: skip
            continue
        most = float(values.max(initial=0.0))
        step = most / LEVELS or 1.0
        arrays.add(name, np.rint(np.clip(values, 0, None) / step), "u2", step, frames=True)  # fmt: skip
        shown = values[values > LEAST[name]]
        top = float(np.quantile(shown, 0.995)) if len(shown) else 0.0
        found[name] = {"least": LEAST[name], "top": nice(max(top, 4 * LEAST[name])), "most": most}  # fmt: skip
    return found


def _addTies(arrays, motion):
    """The bars between blocks: both ends of each, how they move, and 0 elastic, 1 has yielded, 2 broken."""
    if not motion.run.get("ties"):
        return
    with filesOf(motion.directory):
        frames = [readFrame(motion.directory, "connectors", n) for n in motion.numbers]
    bars = [n for n, cell in enumerate(frames[0]["cells"]) if len(cell) == 2]
    ends = np.concatenate([frames[0]["cells"][n] for n in bars])
    arrays.add("tiePoints", frames[0]["points"][ends], "f4")
    arrays.addMotion("tieMoved", np.array([one["displacement"][ends] for one in frames]))  # fmt: skip
    arrays.add("tieCondition", np.array([one["condition"][bars] for one in frames]), "u1", frames=True)  # fmt: skip


def nice(value):
    """The smallest number, of two digits at most and a power of ten, that is not below a value and has round quarters."""
    power = 10.0 ** np.floor(np.log10(value))
    steps = (1, 1.2, 1.6, 2, 2.4, 2.8, 3.2, 4, 5, 6, 8, 10)
    return float(next(s * power for s in steps if s * power >= value * (1 - 1e-9)))
