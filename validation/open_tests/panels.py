# SPDX-License-Identifier: GPL-2.0-or-later
"""A clay brick panel under pressure out of its plane, Griffith, Vaculik and others (Adelaide): what
decides its strength.

yade -n -x validation/open_tests/panels.py [--only NAME ...]

4.0 × 2.5 m, 110 mm thick, returns of 0.48 m at both ends; pressed by 0.1 MPa on top. What
the rig gave the edges lies between hinges and clamps.
"""

import os
import sys

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import main, words  # noqa: E402
import masonry_capacity as capacity  # noqa: E402
from masonry import Scene, bricks, materials  # noqa: E402

BRICK, MORTAR = (0.230, 0.110, 0.076), 0.010  # [m]
UNIT, COURSES, UNITS = (0.240, 0.110, 0.086), 29, 17
RETURN = 0.480  # [m]
HEIGHT, LENGTH = COURSES * UNIT[2], UNITS * UNIT[0]
STRESS, TESTED = 0.1e6, 4.76  # on top [Pa], and what wall s1 held [kPa]
MOST = 16e3  # [Pa]
#: Bond wrench, friction, compressive strength, moduli, modulus of rupture of bricks: README.
DATA = dict(E=3.54e9, unit_E=52.7e9, fc=16e6, friction=0.576, density=1900, unit_ft=3.55e6 / 1.5)
PER_G = DATA["density"] * 9.81 * UNIT[1]  # [Pa] pressure of an acceleration of 1 g
WRENCH, RUPTURE = 0.61e6, 3.55e6  # [Pa]
INDEX, SHEAR_INDEX = 0.029e-3, 0.093e-3  # [m] GfI/ft, GfII/c, as materials.masonry() assumes


def masonryOf(cohesion=1.4, energies=1.0, **changed):
    """The materials: cohesion over direct tensile strength, and the share of the energies of bond
    that :func:`masonry.materials.masonry` assumes [-]."""
    ft = WRENCH / 1.5
    fv0 = cohesion * ft
    bond = dict(ft=ft, fv0=fv0, GfI=energies * INDEX * ft, GfII=energies * SHEAR_INDEX * fv0)
    return materials.masonry(unit=BRICK, joint=MORTAR, **{**DATA, **bond, **changed})


def blocksOf():
    """The bricks: a wall with both returns."""
    walls = bricks.Room(LENGTH, 4 * UNIT[0], HEIGHT, unit=UNIT)
    walls = walls.where(lambda b: b.part != "back").cut((0, RETURN, 0), (0, 1, 0))
    return walls.where(lambda b: b.middle[1] < RETURN)


def hold(scene, blocks, edges):
    """Hold the ends of the returns and the top, pressed by a beam that turns."""
    for n, block in enumerate(blocks):
        if block.high[1] > RETURN - 1e-6:
            scene.hold(n, axes=EDGES[edges])
    beam = scene.platen("top", rotation="free", guided="xy", height=0.02, part=blocks[0].part)
    scene.press(beam, STRESS)


def panel(edges="hinged", energies=1.0):
    """Cells of a case: pressure that is held [kPa], and over the test."""
    blocks = blocksOf()
    scene = Scene(
        "panel", blocks, masonryOf(energies=energies), plane=False, arguments=words("panel")
    )
    scene.platen("bottom")
    hold(scene, blocks, edges)
    scene.settle()
    scene.accelerate(MOST / PER_G, towards=(0, 1, 0), rate=20, within=0.01)
    found = 1e-3 * PER_G * scene.factor
    scene.finish()
    return found, found / TESTED


def byCode(edges, stress=STRESS, tested=TESTED):
    """Cells of AS 3700: pressure [kPa] and over the test; with half the weight of the wall."""
    middle = stress + DATA["density"] * 9.81 * HEIGHT / 2
    pair = capacity.panelPressure(LENGTH, HEIGHT, UNIT, WRENCH, RUPTURE, middle)
    found = 1e-3 * pair[[*EDGES].index(edges)]
    return found, found / tested


#: How the edges are held: out of the plane; about z, too.
EDGES = {"hinged": "y", "clamped": "yZ"}
CASES = {
    "hinged, as it is": panel,
    "clamped, as it is": lambda: panel(edges="clamped"),
    "hinged, a quarter of the energies of bond": lambda: panel(energies=0.25),
}
for _edges in EDGES:
    CASES[f"AS 3700, {_edges}"] = lambda e=_edges: byCode(e)
    CASES[f"AS 3700, {_edges}, without vertical load"] = lambda e=_edges: byCode(e, 0.0, 3.04)

if __name__ == "__main__":
    sys.exit(main(__doc__, ["held kPa", "over test"], CASES))
