# SPDX-License-Identifier: GPL-2.0-or-later
"""A cracked wall in one-way bending, pushed at mid-height: semi-rigid against rigid rocking,
Doherty and others (2002).

yade -n -x validation/open_tests/strips.py [--only NAME ...]

A strip of 17 courses, 1.462 m high and 110 mm thick, stands on a base; its top course is held along
the push and turns freely. It has cracked at its foot, below course 9 of 17, and at its top. It is
pushed at the crack in the middle.
"""

import os
import sys

import numpy as np
from scipy.optimize import brentq

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import finished, main, words  # noqa: E402
from masonry import MasonryJoint, MasonryMat, Scene, bricks, materials  # noqa: E402

UNIT, COURSES = (0.110, 0.240, 0.086), 17  # [m] the thickness lies along x
HEIGHT, THICKNESS = COURSES * UNIT[2], UNIT[0]
MIDDLE = COURSES // 2  # the crack is below this course
CRACK = MIDDLE * UNIT[2]
DENSITY, YOUNG, COURSE = 1900.0, 52.7e9, 3.54e9
KN = 1 / (UNIT[2] * (1 / COURSE - 1 / YOUNG))  # [Pa/m] of a joint in masonry of 3.54 GPa
G = 9.81


def masonryOf(softer):
    """Elastic joints, and dry ones where it has cracked, which are softer by a factor."""
    crack = dict(
        normalStiffness=KN / softer,
        shearStiffness=0.4 * KN,
        tensileStrength=0,
        cohesion=0,
        friction=0.6,
        residualFriction=0.6,
        cap=False,
    )
    joints = {name: MasonryJoint(name=name, **crack) for name in ("support", "gap")}
    bed = MasonryJoint(name="bed", elastic=True, normalStiffness=KN, shearStiffness=0.4 * KN)
    unit = MasonryMat(label="clay", young=YOUNG, poisson=0.2, density=DENSITY)
    own = lambda one, two, geom: (
        "gap" if one and two and {one.course, two.course} == {MIDDLE - 1, MIDDLE} else None
    )
    return materials.Masonry(unit, {**joints, "bed": bed}, choose=own)


def rocking(overburden, softer=1.0, points="12"):
    """Cells of a strip: its largest force beside that of rigid halves."""
    scene = Scene(
        "strip",
        bricks.stack(COURSES, UNIT),
        masonryOf(softer),
        arguments=words("strip", "--points", points),
    )
    scene.platen("bottom")
    if overburden:
        top = scene.platen("top", rotation="free", height=0.001)
        scene.press(top, overburden)
    scene.hold(COURSES - 1, axes="x", name="top_course")
    pushed = scene.handle((THICKNESS / 2, UNIT[1] / 2, CRACK + 1e-3), name="middle")
    scene.settle()
    scene.push(pushed, 600 * THICKNESS, rate=10)
    _, curve = finished(scene)
    moved, force = (np.array(curve[n]) for n in ("displacement_mm", "base_shear_kN"))
    rigid = rigidForce(overburden)
    falls = brentq(rigid, 0, 1.0)
    quiet = moved > 10 * falls  # [mm] a hundredth of it; before that the strip swings
    peak, at = force[quiet].max(), 1e-3 * moved[quiet][force[quiet].argmax()]
    half = np.interp(500 * falls, moved, force) / rigid(falls / 2)
    return rigid(0), peak, peak / rigid(0), 1e3 * falls, at / falls, half


def rigidForce(overburden):
    """The force of two rigid halves at a displacement [m] of the crack between them, small turns: a
    function [kN]."""
    t, lower, upper = THICKNESS, CRACK, HEIGHT - CRACK
    arm = HEIGHT - UNIT[2] / 2 - CRACK  # from the crack to where the top is held
    area = UNIT[0] * UNIT[1]
    below, above = (1e-3 * DENSITY * G * area * h for h in (lower, upper))
    load = 1e-3 * overburden * area  # in the middle of the thickness

    def force(d):
        lifts = (below / 2 + above + load) * (t - d) / lower
        leans = above * (t - upper * d / arm) / 2 + load * (t / 2 - upper * d / arm)
        return lifts + leans / arm

    return force


LEVELS = {"no overburden": 0.0, "0.15 MPa": 0.15e6}
VARIANTS = {
    "joints of 3.54 GPa": {},
    "cracks 10 times softer": dict(softer=10),
    "cracks 100 times softer": dict(softer=100),
}
CASES = {
    f"{level}, {name}": lambda o=o, v=v: rocking(o, **v)
    for level, o in LEVELS.items()
    for name, v in VARIANTS.items()
}
NAMES = [
    "rigid F0 kN",
    "peak kN",
    "peak over F0",
    "du mm",
    "d of the peak/du",
    "over rigid at du/2",
]

if __name__ == "__main__":
    sys.exit(main(__doc__, NAMES, CASES))
