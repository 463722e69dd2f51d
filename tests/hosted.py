# SPDX-License-Identifier: GPL-2.0-or-later
"""What tests of scenes in YADE begin with, for ``from hosted import *``: names that nearly all of them use, and small helpers."""

from usual import *
from yade.wrapper import *  # first: its Scene is not ours
from masonry import *
from masonry import addBlock, engine  # noqa: F401
from masonry._masonry import allowThreads  # noqa: F401
from masonry.bricks import boxCorners as corners
from masonry.read.files import readCurve, readRun  # noqa: F401
from yade import O, Quaternion, Vector3

G = 9.81  # [m/s²]
#: The brick of the calcium-silicate walls, with its mortar [m].
UNIT = (0.22, 0.102, 0.081)
#: Turns a scene out of its plane.
IN_SPACE = Quaternion(Vector3(1, 2, 0.5).normalized(), 0.7)


def unitMaterial(**other):
    """The material of calcium-silicate bricks."""
    return MasonryMat(**{**dict(density=1800, young=4.8e9, poisson=0.16), **other})


def box(low=(0, 0, 0), size=UNIT, turn=Quaternion.Identity):
    """Corners of a box with this lowest corner and these sides [m], turned about the origin."""
    high = [a + b for a, b in zip(low, size)]
    return [turn * Vector3(*corner) for corner in corners(low, high)]


def hold(*bodies):
    for body in bodies:
        O.bodies[body].state.blockedDOFs = "xyzXYZ"


def run(steps=1):
    """Take steps one by one: O.run(steps, True) may end before it waits, and then only prints an error."""
    for _ in range(steps):
        O.step()


def until(time):
    """Run to a time of the scene [s]."""
    O.run(max(1, math.ceil((time - O.time) / O.dt)), True)


def ofKind(kind):
    """The first engine of a class, or None."""
    return next((e for e in O.engines if isinstance(e, kind)), None)


def balance():
    return ofKind(MasonryEnergy).balance()
