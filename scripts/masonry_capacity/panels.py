# SPDX-License-Identifier: GPL-2.0-or-later
"""Panels under pressure out of their plane, held along four edges: virtual work of AS 3700:2018,
clause 7.4.4.

Cracks run from the corners in steps of the bond. Where they meet before mid-height, a vertical
crack joins them, else a horizontal one without moment. The coefficients k1, k2 and af of the clause
are the virtual work of this mechanism. Its strengths are from memory, and as in a public program
that gives the 1.11 kPa of an example of Think Brick Australia (4 × 3 m, hinged).
"""

import math
from typing import Annotated

from masonry.arguments import number, validated
from masonry.bricks.blocks import Length, Sides

Strength = Annotated[float, number("Pa", 0, 1e9, above=True)]


@validated
def panelPressure(
    length: Length,
    height: Length,
    unit: Sides,
    flexural: Strength,
    rupture: Strength,
    stress: Annotated[float, number("Pa", 0, 1e9)] = 0.0,
) -> tuple[float, float]:
    """The pressure that a panel of one leaf in running bond carries, without safety factors [Pa]:
    with its vertical edges hinged, and clamped. Foot and top are held and turn freely.

    :param unit: length, thickness and height of a unit, with its mortar [m]
    :param flexural: strength of bed joints in bending, as of a bond wrench, f'mt [Pa]
    :param rupture: modulus of rupture of the units, f'ut [Pa]
    :param stress: vertical compression at mid-height, fd [Pa]
    """
    long, thick, high = unit
    bond, fd = flexural / 1e6, stress / 1e6  # [MPa], in which the clause has its roots
    # moments per length [N]: across a vertical crack (7.4.3.2), and along a diagonal one (7.4.4.3)
    spacing = min(1.0, long / 2 / thick, long / 2 / high)
    stepped = 2 * spacing * math.sqrt(bond) * min(1 + fd / bond, 2)
    straight = 0.44 * rupture / 1e6 + 0.56 * bond
    horizontal = 1e6 * min(stepped, straight) * thick**2 / 6
    slope = 2 * high / long  # G
    root = math.sqrt(1 + slope**2)
    short, wide = sorted((high / root, thick))
    modulus = 2 * (short * wide) ** 2 / (3 * wide + 1.8 * short) / (long * root)
    diagonal = 1e6 * (2.25 * math.sqrt(bond) + 0.15 * fd) * modulus
    reach = slope * length / height  # alpha: the height of diagonal cracks that meet, over height/2
    if reach <= 1:
        aspect, middle, stepping = 1 / (1 - reach / 3), 1 - reach, reach
    else:
        aspect, middle, stepping = reach / (1 - 1 / (3 * reach)), 0.0, 1.0
    stepping *= 1 + 1 / slope**2
    of = (
        lambda edges: 8
        * aspect
        / length**2
        * ((middle + edges) * horizontal + stepping * diagonal)
    )
    return of(0.0), of(1.0)
