# SPDX-License-Identifier: GPL-2.0-or-later
"""Columns on compliant beds under an eccentric load, by theory of second order."""

import numpy as np

from cases import case
from masonry import bricks, materials
from structures import G, sceneOf

SIDE, HEIGHT, DENSITY = 0.2, 3.0, 2000.0  # of the columns [m], [kg/m³]
COLUMNS = "Columns of 0.2 × 0.2 × 3 m on compliant beds, eccentric load"
CHAIN = "theory of second order: a chain of joints that open (`column_cases.largestLoad`)"


def rotation(lever):
    """Rotation of a joint over N/(kn·A·t) [-]: a linear bed without tension under a force N at this
    lever over the length t [-], whose pressed part is 3·(1/2 - lever) of the length."""
    return np.where(lever <= 1 / 6, 12 * lever, 2 / 9 / np.maximum(0.5 - lever, 1e-9) ** 2)


def largestLoad(lever, stiffness, count):
    """The largest load [N] of a column of its own weight, with a fixed foot, at this lever over the
    side at its head. From the slope of its top block on, each joint turns what is below it back;
    the foot must become upright."""
    weight, height = DENSITY * G * SIDE**2 * HEIGHT / count, HEIGHT / count / SIDE

    def reaches(load):
        slope = np.geomspace(1e-7, 0.3, 6000)
        at, moment, stands = np.full(slope.size, lever), load * lever, np.ones(slope.size, bool)
        for n in range(1, count + 1):
            force = load + n * weight  # below block n from the top, and its moment over the side
            moment = moment + slope * height * (force - weight / 2)
            at = moment / force
            slope = slope - force / (stiffness * SIDE**3) * rotation(at)
            stands &= (at < 0.4999) & (slope >= 0)
        return bool(stands.any())

    low, high = 0.0, 1e-2 * stiffness * SIDE**3
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reaches(middle) else (low, middle)
    return low


def column(lever, stiffness, count=10, axis=0, bond=None, words=()):
    """Expected load [N], and the bracket of the engine. With a bond [Pa], which is small, joints
    also have a cap, which the column does not reach."""
    beds = dict(normalStiffness=stiffness, shearStiffness=stiffness)
    masonry = materials.dry(friction=5, density=DENSITY, young=1e5 * stiffness, **beds)
    if bond:
        weak = dict(tensileStrength=bond, modeIFractureEnergy=bond**2 / stiffness)
        slip = dict(cohesion=10 * bond, modeIIFractureEnergy=400 * bond**2 / stiffness)
        crush = dict(compressiveStrength=1e4 * bond, compressiveFractureEnergy=1e4 * bond)
        for joint in masonry.joints.values():
            joint.set(cap=True, **weak, **slip, **crush)
    expected = largestLoad(lever, stiffness, count)
    blocks = bricks.stack(count, (SIDE, SIDE, HEIGHT / count))
    with sceneOf(blocks, masonry, words, plane=axis == 0) as s:
        s.platen("bottom")
        place = [SIDE / 2, SIDE / 2, HEIGHT - 1e-6]
        place[axis] += lever * SIDE
        head = s.handle(tuple(place), name="head")
        s.settle()
        # as long as its slowest vibration asks for
        over = 4 * (1e10 / stiffness) ** 0.5
        s.grow({head: (0, 0, -1.3 * expected)}, over=over, within=0.02)
        found = {a["name"]: a["value"] for a in s.answers}
        return expected, tuple(1e3 * found[f"factor_{end}"] for end in ("held", "not_held"))


def _case(name, what, aim=0.03, quick=False, **how):
    def measure(quick):
        return column(**how)

    measure.__name__ = name
    case(COLUMNS, what, CHAIN, aim=aim, quick=quick)(measure)


for _stiffness in (1e9, 1e11):
    for _lever in (0.1, 0.2, 0.25, 0.3, 0.35, 0.4):
        _case(
            f"column_{_stiffness:.0e}_{100 * _lever:.0f}".replace("e+", "e"),
            f"largest load [N] of 10 dry blocks at e/t = {_lever}, {_stiffness:.0e} Pa/m",
            aim=0.05 if _lever > 0.3 else 0.03,
            quick=(_stiffness, _lever) == (1e9, 0.25),
            lever=_lever,
            stiffness=_stiffness,
        )
_case(
    "column_bond",
    "the same of 10 with a bond of 5 kPa and a cap, 1e10",
    lever=0.25,
    stiffness=1e10,
    bond=5e3,
)
_case("column_30", "the same of 30 at 0.25, 1e10 Pa/m", lever=0.25, stiffness=1e10, count=30)
_case("column_across", "of 10 at 0.25 across, in space, 1e9", lever=0.25, stiffness=1e9, axis=1)
