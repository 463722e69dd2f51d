# SPDX-License-Identifier: GPL-2.0-or-later
"""Dry columns on compliant beds under an eccentric load, by theory of second order."""

import numpy as np

from cases import case
from masonry import bricks, materials
from structures import sceneOf

COUNT, SIDE, HEIGHT = 10, 0.2, 0.3  # blocks, their sides in plan [m], their height [m]
COLUMNS = "Dry columns on compliant beds"
CHAIN = "theory of second order: a chain of joints that open (`column_cases.largestLoad`)"


def rotation(lever):
    """Rotation of a joint over N/(kn·A·t) [-]: a linear bed without tension under a force N at this
    lever over the length t [-], whose pressed part is 3·(1/2 - lever) of the length."""
    return np.where(lever <= 1 / 6, 12 * lever, 2 / 9 / np.maximum(0.5 - lever, 1e-9) ** 2)


def largestLoad(lever):
    """The largest load over kn·A·t [-] of a column with a fixed foot, at this lever over the side
    at its head. From a lever at the foot on, each joint turns the blocks above it towards the load.
    """

    def reaches(load):
        at, slope = np.linspace(lever, 0.4999, 4000), 0.0
        within = np.ones(at.size, bool)
        for _ in range(COUNT):
            slope = slope + load * rotation(at)
            at = at - slope * HEIGHT / SIDE
            within &= at > 0
            at = np.maximum(at, 0)
        return bool((within & (at >= lever)).any())

    low, high = 0.0, 1e-2
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reaches(middle) else (low, middle)
    return low


def column(lever, stiffness=1e10, axis=0, plane=True):
    """Expected load [N], and the bracket of the engine."""
    dry = materials.dry(
        friction=5,
        normalStiffness=stiffness,
        shearStiffness=stiffness,
        density=2e-7 * stiffness,  # so that it moves alike with any stiffness
        young=1e5 * stiffness,
    )
    expected = largestLoad(lever) * stiffness * SIDE**3
    blocks = bricks.stack(COUNT, (SIDE, SIDE, HEIGHT))
    with sceneOf(blocks, dry, gravity=0, plane=plane) as s:
        s.platen("bottom")
        place = [SIDE / 2, SIDE / 2, COUNT * HEIGHT - 1e-6]
        place[axis] += lever * SIDE
        head = s.handle(tuple(place), name="head")
        s.settle()
        s.grow({head: (0, 0, -1.3 * expected)}, over=4, within=0.02)
        found = {a["name"]: a["value"] for a in s.answers}
        held, lost = (found[f"factor_{end}"] for end in ("held", "not_held"))
        return expected, (1e3 * held, 1e3 * lost)


@case(COLUMNS, "largest load [N] at e/t = 0.2, 1e10 Pa/m", CHAIN, aim=0.03)
def column_fifth(quick):
    return column(0.2)


@case(COLUMNS, "the same at e/t = 0.25", CHAIN, aim=0.03, quick=True)
def column_quarter(quick):
    return column(0.25)


@case(COLUMNS, "the same at e/t = 0.25, 1e12 Pa/m", CHAIN, aim=0.03)
def column_quarter_stiff(quick):
    return column(0.25, 1e12)


@case(COLUMNS, "the same at e/t = 0.25 across, in space, 1e9 Pa/m", CHAIN, aim=0.03)
def column_quarter_across(quick):
    return column(0.25, 1e9, axis=1, plane=False)


@case(COLUMNS, "the same at e/t = 0.4, 1e10 Pa/m", CHAIN, aim=0.05)
def column_edge(quick):
    return column(0.4)
