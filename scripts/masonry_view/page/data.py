# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a run for ``viewer.js``: a JSON head, and arrays that are rounded, compressed and
written in base64.

A displacement is a whole number of steps of 1/32,767 of the largest, other values are whole numbers
of 1/4,000 of the largest in the frames, and damage is in steps of 1/255.
"""

import base64
import zlib

import numpy as np

from masonry.errors import Refused
from .. import painting
from masonry.numbers.cracks import CRACK, CRUSHED, DAMAGED
from masonry.numbers.files import filesOf
from masonry.numbers.frames import readFrame
from ..model import CRUSHED_TOO, LEAST, LOOKS, OPEN, SLID, Model
from ..views import courseOf


class _Arrays:
    """The arrays of a page in one row of bytes, and what the page must know to read them."""

    def __init__(self):
        self.known, self.bytes = {}, b""

    def add(self, name, values, kind, step=1.0, frames=False):
        """Append an array.

        :param kind: numpy's name of the type of the numbers: u1, u2, i2, u4 or f4
        :param step: by which the whole numbers are multiplied
        :param frames: whether the first axis is that of the frames
        """
        values = np.ascontiguousarray(values, "<" + kind)
        row = values[0].size if frames else 1
        self.known[name] = {
            "kind": kind,
            "at": len(self.bytes),
            "count": values.size,
            "row": row,
            "step": float(step),
        }
        self.bytes += values.tobytes() + bytes(-values.nbytes % 4)

    def addRounded(self, name, values, kind="i2", levels=32767):
        """Append numbers of frames, rounded to so many steps up to the largest."""
        step = float(np.abs(values).max(initial=0.0)) / levels or 1.0
        self.add(name, np.rint(values / step), kind, step, frames=True)


def dataOf(directory, number=None, magnification=None):
    """The head, a dict that can be written as JSON, and the arrays as a text in base64. Raises
    Refused if frames are missing or damaged.

    :param number: of the frame that is shown first, from 0; None: the last one
    :param magnification: of displacements at first [-]; None: as in cracks.png
    """
    model = Model(directory)
    if number is not None and not 0 <= number < model.count:
        raise Refused(
            f"{directory}: there is no frame {number}; its frames are 0 to {model.count - 1}"
        )
    return dataOfModel(model, number, magnification)


def dataOfModel(model, number=None, magnification=None, curve=None):
    """As :func:`dataOf`, of a run whose frames have been read.

    :param curve: columns of curve.csv for what is said beside the frames; None: they are read
    """
    arrays, joints = _Arrays(), model.joints
    with filesOf(model.directory):
        head = _head(model, magnification, curve)
        _addTies(arrays, model)
    kinds = {"points": "f4", "looks": "u1", "centres": "f4"}
    for name in "points owner triangles edges bodies looks centres free".split():
        arrays.add(name, getattr(model, name), kinds.get(name, "u4"))
    for name in ("shift", "turn", "moved"):
        arrays.addRounded(name, getattr(model, name))
    arrays.add("jointPoints", joints.corners, "f4")
    arrays.add("jointOwner", joints.owner, "u4")
    arrays.add("jointBlocks", joints.between, "u4")
    arrays.add("kind", joints.kind, "u1", frames=True)
    if joints.moved is not None:
        arrays.addRounded("jointMoved", np.moveaxis(joints.moved, 0, 1))
    head["values"] = {}
    for name, least in LEAST.items():
        values = np.clip(getattr(joints, name), 0, None)
        arrays.addRounded(name, values, *(("u1", 255) if name == "damage" else ("u2", 4000)))
        most = float(values.max(initial=0.0))
        shown = values[values > least]
        top = float(np.quantile(shown, 0.995)) if len(shown) else 0.0
        top = 1.0 if name == "damage" else nice(max(top, 4 * least))
        head["values"][name] = {"least": least, "top": top, "most": most}
    head.update(
        first=len(model.times) - 1 if number is None else number,
        jointPoints=joints.count,
        keptPoints=len(joints.between),
        arrays=arrays.known,
    )
    return head, base64.b64encode(zlib.compress(arrays.bytes, 4)).decode()


def _head(model, magnification, curve):
    sight = model.sight(magnification)
    return {
        "title": model.title,
        "frames": model.captions(curve),
        "magnification": sight.magnification,
        "low": sight.low.tolist(),
        "high": sight.high.tolist(),
        "towards": sight.towards.tolist(),
        "flat": sight.flat,
        "course": courseOf(model.corners()[:500]),
        "farthest": float(model.farthest.max()),
        "ramp": nice(float(model.farthest.max()) or 1.0),
        "kinds": {"open": OPEN, "slid": SLID, "crushed": CRUSHED_TOO},
        "colours": {
            **painting.CRACKS,
            "crushed": painting.CRUSHED,
            "looks": [painting.SHADES[look] for look in LOOKS],
            "ties": [c for c, _ in painting.TIES.values()],
        },
        "limits": {"crack": CRACK, "damaged": DAMAGED, "crushed": CRUSHED},
    }


def _addTies(arrays, model):
    """Add the ties: both ends of each, how they move, and 0 elastic, 1 yielded, 2 broken."""
    if not model.run.get("ties"):
        return
    frames = [readFrame(model.directory, "connectors", n) for n in model.numbers]
    bars = [n for n, cell in enumerate(frames[0]["cells"]) if len(cell) == 2]
    ends = np.concatenate([frames[0]["cells"][n] for n in bars])
    arrays.add("tiePoints", frames[0]["points"][ends], "f4")
    arrays.addRounded("tieMoved", np.array([one["displacement"][ends] for one in frames]))
    conditions = np.array([one["condition"][bars] for one in frames])
    arrays.add("tieCondition", conditions, "u1", frames=True)


def nice(value):
    """The smallest number of two digits at most with round quarters that is not below a value."""
    power = 10.0 ** np.floor(np.log10(value))
    steps = (1, 1.2, 1.6, 2, 2.4, 2.8, 3.2, 4, 5, 6, 8, 10)
    return float(next(s * power for s in steps if s * power >= value * (1 - 1e-9)))
