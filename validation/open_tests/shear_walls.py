# SPDX-License-Identifier: GPL-2.0-or-later
"""Brick shear walls of Raijmakers and Vermeltfoort (1992), with the properties of Lourenço and Rots
(1997).

yade -n -x validation/open_tests/shear_walls.py [--only NAME ...]

Walls of 990 × 1000 × 100 mm without openings, clamped between two courses in steel beams: pressed,
then pushed at the top while it neither turns nor moves up or down (``height held``), or while the
vertical load stays (``load held``).
"""

import os
import sys

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import finished, main, words  # noqa: E402
from masonry import MasonryJoint, MasonryMat, Scene, bricks, materials  # noqa: E402
from yade import O, Vector3  # noqa: E402

UNIT, COURSES = (
    0.220,
    0.100,
    0.062,
), 16  # [m] bricks of 210 × 100 × 52 mm, 10 mm joints
UNTIL = 4.0  # [mm]
#: Vertical stress [Pa]; kn, ks [Pa/m]; ft [Pa], GfI [J/m²]; c [Pa], GfII [J/m²]; fc [Pa]; peak of
#: the tests [kN]. README: origin.
WALLS = {
    "J4D, J5D": (0.30e6, 82e9, 36e9, 0.25e6, 18.0, 0.350e6, 125.0, 10.5e6, 50.0),
    "J6D": (1.21e6, 110e9, 50e9, 0.16e6, 12.0, 0.224e6, 50.0, 11.5e6, 72.0),
    "J7D": (2.12e6, 82e9, 36e9, 0.16e6, 12.0, 0.224e6, 50.0, 11.5e6, 97.0),
}
FRICTION = 0.75  # [-] initial and residual
CLOSURE = 0.09e-3  # [m] plastic closure at fc
GC, RESIDUAL, ELASTIC, CAP = 5000.0, 1 / 7, 1 / 3, 9.0  # [J/m²], [-] of fc, Css
YOUNG, POISSON, DENSITY = 16.7e9, 0.15, 1900.0
BRICK = dict(
    tensileStrength=2.0e6, modeIFractureEnergy=80.0, cohesion=4.0e6, modeIIFractureEnergy=800.0
)


def masonryOf(wall):
    """The materials of a wall."""
    _, kn, ks, ft, GfI, c, GfII, fc, _ = WALLS[wall]
    mortar = dict(
        normalStiffness=kn,
        shearStiffness=ks,
        tensileStrength=ft,
        modeIFractureEnergy=GfI,
        cohesion=c,
        modeIIFractureEnergy=GfII,
        friction=FRICTION,
        residualFriction=FRICTION,
        compressiveStrength=fc,
        compressiveFractureEnergy=GC,
        peakRatio=1 + kn * CLOSURE / fc,
        residualStrengthRatio=RESIDUAL,
        elasticLimitRatio=ELASTIC,
        capShear=CAP,
    )
    crack = MasonryJoint(
        name="crack",
        normalStiffness=1e15,
        shearStiffness=1e15,
        friction=FRICTION,
        residualFriction=FRICTION,
        cap=False,
        **BRICK,
    )
    joints = {name: MasonryJoint(name=name, **mortar) for name in ("bed", "head")}
    unit = MasonryMat(label="brick", young=YOUNG, poisson=POISSON, density=DENSITY)
    return materials.Masonry(unit, {**joints, "crack": crack})


def run(wall, heightHeld, *options):
    """Cells of a wall."""
    stress, measured = WALLS[wall][0], WALLS[wall][-1]
    length, thickness, height = 4.5 * UNIT[0], UNIT[1], COURSES * UNIT[2]
    scene = Scene(
        "shear_wall",
        bricks.Wall(length, height, unit=UNIT),
        masonryOf(wall),
        arguments=words("shear_wall", *options),
    )
    scene.platen("bottom")
    top = scene.platen("top", recorded=height, drive="x")
    scene.press(top, stress)
    scene.settle(damping="local", record=False)
    if heightHeld:
        state = O.bodies[top.body].state
        state.vel, state.blockedDOFs = Vector3.Zero, "yzXYZ"
    scene.push(top, UNTIL)
    found, curve = finished(scene)
    shear = curve["base_shear_kN"]
    down = [-1e-3 * n / (length * thickness) for n in curve["base_N_kN"]]
    row = lambda mm: next(i for i, d in enumerate(curve["displacement_mm"]) if d >= mm)
    peak, at = found["peak_at_both_ends_kN"], found["displacement_at_peak_mm"]
    return (
        peak,
        at,
        shear[-1],
        down[row(0.02)],
        down[row(at)],
        down[-1],
        measured,
        peak / measured,
    )


CASES = {
    f"{wall}, {how}, {blocks}": lambda w=wall, h=how, b=blocks: run(
        w, h == "height held", "--blocks", b
    )
    for blocks in ("rigid", "deformable")
    for wall in WALLS
    for how in ("height held", "load held")
}
NAMES = [
    "peak kN",
    "at mm",
    "end kN",
    "vertical stress, beginning MPa",
    "at the peak",
    "end",
    "tests kN",
    "over tests",
]

if __name__ == "__main__":
    sys.exit(main(__doc__, NAMES, CASES))
