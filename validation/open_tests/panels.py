# SPDX-License-Identifier: GPL-2.0-or-later
"""A clay brick panel under pressure out of its plane, Griffith, Vaculik and others (Adelaide): what
decides its strength.

yade -n -x validation/open_tests/panels.py [--only NAME ...]

4.0 × 2.5 m, 110 mm thick, returns of 0.48 m at both ends; pressed by 0.1 MPa on top (wall s1, 4.76
kPa) or not (s2, 3.04 kPa). Every case is the first one with one thing changed.
"""

import os
import sys

from scipy.optimize import brentq

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import main, section, words  # noqa: E402
from masonry import MasonryMat, Scene, bricks, materials  # noqa: E402

BRICK, MORTAR = (0.230, 0.110, 0.076), 0.010  # [m]
UNIT, COURSES, UNITS = (0.240, 0.110, 0.086), 29, 17
RETURN = 0.480  # [m]
HEIGHT, LENGTH = COURSES * UNIT[2], UNITS * UNIT[0]
BALLAST = 0.02  # [m] height of a load that lies on each brick of the top course by itself
MOST = 16e3  # [Pa]
#: Bond wrench, friction, compressive strength, moduli, modulus of rupture of bricks: README.
DATA = dict(E=3.54e9, unit_E=52.7e9, fc=16e6, friction=0.576, density=1900, unit_ft=3.55e6 / 1.5)
PER_G = DATA["density"] * 9.81 * UNIT[1]  # [Pa] pressure of an acceleration of 1 g
WRENCH, RUPTURE = 0.61e6, 3.55e6  # [Pa]
INDEX = 0.029e-3  # [m] GfI over ft, as materials.masonry() assumes


def direct(flexural, stiffness):
    """The direct tensile strength with which a joint as thick as the wall has a flexural strength
    [Pa] in bending."""
    of = lambda ft: section(ft, INDEX * ft, stiffness, UNIT[1]) - flexural
    return brentq(of, flexural / 3, flexural / 1.01, rtol=1e-3)


#: Strengths that give both tests back when they are simulated. Stiffness of a joint with the bricks
#: around it [Pa/m].
GIVEN_BACK = dict(
    ft=direct(WRENCH, DATA["E"] / UNIT[2]),
    unit_ft=direct(RUPTURE, DATA["unit_E"] / (UNIT[0] / 2)),
)


def masonryOf(ft=WRENCH / 1.5, cohesion=1.4, **changed):
    """The materials: direct tensile strength [Pa], and the cohesion over it [-]."""
    changed.setdefault("fv0", cohesion * ft)
    return materials.masonry(unit=BRICK, joint=MORTAR, ft=ft, **{**DATA, **changed})


def blocksOf(edges, halves):
    """The bricks: a wall with both returns, or without them."""
    if edges != "returns":
        return bricks.Wall(LENGTH, HEIGHT, unit=UNIT, halves=halves)
    walls = bricks.Room(LENGTH, 4 * UNIT[0], HEIGHT, unit=UNIT, halves=halves)
    walls = walls.where(lambda b: b.part != "back").cut((0, RETURN, 0), (0, 1, 0))
    return walls.where(lambda b: b.middle[1] < RETURN)


def hold(scene, blocks, edges):
    """Hold the edges: ends of the returns, or of the wall."""
    for n, block in enumerate(blocks):
        if edges == "returns":
            if block.high[1] > RETURN - 1e-6:
                scene.hold(n, axes="xyXYZ")
        elif edges != "free" and min(block.low[0], LENGTH - block.high[0]) < 1e-6:
            scene.hold(n, axes="y" if edges == "hinged" else "xyZ")


def support(scene, blocks, stress, top):
    """Hold the top against moving out of the plane, and press it, through a beam that turns or each
    brick by itself."""
    if stress and top == "beam":
        beam = scene.platen("top", rotation="free", guided="xy", height=0.02, part=blocks[0].part)
        scene.press(beam, stress)
        return
    kind = "ballast" if stress else blocks[0].kind
    for n, block in enumerate(blocks):
        own = block.part in (blocks[0].part, "ballast") and block.kind == kind
        if own and block.high[2] > HEIGHT - 1e-6:
            scene.hold(n, axes="y")


def panel(stress=0.1e6, edges="returns", top="beam", halves=True, base=None, options=(), **changed):
    """Cells of a case: pressure that is held [kPa], over the test."""
    blocks, masonry = blocksOf(edges, halves), masonryOf(**changed)
    if top == "ballast" and stress:
        on = [b for b in blocks.top() if b.part in ("front", "wall")]
        for b in on:
            blocks += bricks.block(
                (b.low[0], b.low[1], HEIGHT),
                (b.high[0], b.high[1], HEIGHT + BALLAST),
                part="ballast",
                kind="ballast",
            )
        masonry.units["ballast"] = MasonryMat(
            label="ballast", young=30e9, poisson=0.2, density=stress / 9.81 / BALLAST
        )
    scene = Scene("panel", blocks, masonry, plane=False, arguments=words("panel", *options))
    scene.platen("bottom", springs={"X": 1.0} if base == "hinged" else None)
    support(scene, blocks, stress, top)
    hold(scene, blocks, edges)
    scene.settle()
    scene.accelerate(MOST / PER_G, towards=(0, 1, 0), rate=20, within=0.01)
    found = 1e-3 * PER_G * scene.factor
    scene.finish()
    return found, found / (4.76 if stress else 3.04)


def byHand(vertical, fixed=True, stress=0.1e6):
    """Cells of yield lines: pressure [kPa] with AS 3700's stepped strength along the courses and
    the bond wrench's across them.

    Diagonal cracks follow the bond, two courses in a unit; a horizontal crack joins them in the
    middle.

    :param vertical: whether bending across the bed joints carries at the same time
    :param fixed: whether the vertical edges carry moments
    """
    modulus, run = UNIT[1] ** 2 / 6, HEIGHT / 2 * UNIT[0] / (2 * UNIT[2])
    weight = DATA["density"] * 9.81 * HEIGHT / 2
    along = 2e6 * (WRENCH / 1e6) ** 0.5 * modulus  # [N]
    across = (WRENCH + stress + weight) * modulus * vertical
    ridge = LENGTH - 2 * run
    work = (2 + 2 * fixed) * HEIGHT / run * along + 4 * LENGTH / HEIGHT * across
    found = 1e-3 * work / (HEIGHT * (2 * LENGTH + ridge) / 6)
    return found, found / (4.76 if stress else 3.04)


NO_TENSION = dict(options=("--set", "bed.tensileStrength=1000"))
VARIANTS = {
    "as it is": {},
    "without vertical load": dict(stress=0),
    "vertical load on every brick by itself": dict(top="ballast"),
    "joints lose their bond at once": dict(options=("--joints", "brittle")),
    "bricks do not crack": dict(unit_ft=None),
    "hinged at its edges, no returns": dict(edges="hinged"),
    "clamped at its edges, no returns": dict(edges="clamped"),
    "no bond": dict(ft=0.0, fv0=0.0),
    "cohesion 0.7 of ft": dict(cohesion=0.7),
    "head joints half as strong": dict(head_share=0.5),
    "base on a hinge": dict(base="hinged"),
    "strengths that give the tests back": GIVEN_BACK,
    "hinged, bed joints without tensile strength": {**NO_TENSION, "edges": "hinged"},
    "bed joints without tensile strength, joints lose their bond at once": dict(
        options=(*NO_TENSION["options"], "--joints", "brittle"), top="ballast"
    ),
    "the same, without vertical load": dict(
        options=(*NO_TENSION["options"], "--joints", "brittle"), stress=0
    ),
    "whole bricks": dict(halves=False, unit_ft=None),
}
CASES = {name: lambda v=v: panel(**v) for name, v in VARIANTS.items()}
CASES["by hand, both ways of bending at once"] = lambda: byHand(True)
CASES["by hand, along the courses alone"] = lambda: byHand(False)
CASES["by hand, along the courses alone, hinged at its edges"] = lambda: byHand(False, fixed=False)

if __name__ == "__main__":
    sys.exit(main(__doc__, ["held kPa", "over test"], CASES))
