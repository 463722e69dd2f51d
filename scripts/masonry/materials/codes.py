# SPDX-License-Identifier: GPL-2.0-or-later
"""Masonry of building codes: arguments for :func:`masonry`, each with its clause.

::

    materials.masonry(**materials.en1996("clay", fb=15e6, mortar="M5"),
        ft=0.1e6, unit_E=8e9, unit=(0.25, 0.12, 0.065), joint=0.010, density=1800)
    materials.masonry(**materials.ntc2018("squared stone", "LC2"),
        unit_E=40e9, unit=(0.5, 0.4, 0.25), joint=0.010)

A value that is given in place of the code's loses its clause: ``{**materials.ntc2018("rubble",
"LC1"), "E": 1e9}``.
"""

import re
from typing import Annotated, Any, NamedTuple

from ..arguments import number, oneOf, validated, whole
from ..errors import refuse
from .settings import matching

#: Mean over characteristic compressive strength (EN 1052-1), characteristic over mean cohesion and
#: friction (EN 1052-3) [-].
MEAN, SHEAR = 1.2, 0.8

#: K of EN 1996-1-1:2005, table 3.3 [-], by unit and mortar for groups 1, 2, ...
GENERAL, THIN = "general purpose", "thin layer"
K: dict[str, dict[str, tuple[float, ...]]] = {
    "clay": {GENERAL: (0.55, 0.45, 0.35, 0.35), THIN: (0.75, 0.70, 0.50, 0.35)},
    "calcium silicate": {GENERAL: (0.55, 0.45), THIN: (0.80, 0.65)},
    "aggregate concrete": {GENERAL: (0.55, 0.45, 0.40, 0.35), THIN: (0.80, 0.65, 0.50)},
    "autoclaved aerated concrete": {GENERAL: (0.55,), THIN: (0.80,)},
    "manufactured stone": {GENERAL: (0.45,), THIN: (0.75,)},
    "natural stone": {GENERAL: (0.45,)},
}

#: fvk0 of EN 1996-1-1:2005, table 3.4 [Pa]: in general purpose mortar from a strength [MPa] on, and
#: in thin layer mortar.
OTHERS = (10.0, 0.20e6), (2.5, 0.15e6), (0.0, 0.10e6)
FVK0 = {
    "clay": (((10.0, 0.30e6), (2.5, 0.20e6), (0.0, 0.10e6)), 0.30e6),
    "calcium silicate": (OTHERS, 0.40e6),
}

#: Friction of bed joints, bound of fvk over fb, E over fk and G over E [-]: EN 1996-1-1:2005, 3.6.2
#: and 3.7.
FRICTION, MAX_SHEAR, STIFFNESS, SHEARING = 0.4, 0.065, 1000, 0.4
#: Strongest units of equations (3.2), and of (3.3) and (3.4) [Pa].
STRONGEST = {GENERAL: 75e6, THIN: 50e6}

#: Confidence factor of a level of knowledge [-]: Circolare 7/2019, table C8.5.IV.
CONFIDENCE = {"LC1": 1.35, "LC2": 1.2}
_knowledge = matching(
    lambda v: isinstance(v, str) and v in CONFIDENCE,
    "LC1 or LC2; LC3 needs tests: give what they say to materials.masonry",
)
#: Friction in a joint: Circolare 7/2019, C8.7.1.3.1.1. Tensile strength over tau0: C8.7.1.16 [-].
LOCAL_FRICTION, TENSION = 0.577, 1.5
#: Direct tensile strength over cohesion of a joint [-], Lourenço and Rots (1997).
BOND = 0.7
GRAVITY = 9.81  # [m/s²]


class Row(NamedTuple):
    """A row of table C8.5.I of Circolare 7/2019: ranges [Pa]; of the weight [N/m³]."""

    number: int
    fm: tuple[float, float]
    tau0: tuple[float, float]
    fv0: tuple[float, float] | None  # of regular bond
    E: tuple[float, float]
    G: tuple[float, float]
    w: tuple[float, float]


TABLE = {
    "rubble": Row(1, (1e6, 2e6), (0.018e6, 0.032e6), None, (690e6, 1050e6), (230e6, 350e6), (19e3, 19e3)),
    "roughly cut stone": Row(2, (2e6, 2e6), (0.035e6, 0.051e6), None, (1020e6, 1440e6), (340e6, 480e6), (20e3, 20e3)),
    "split stone": Row(3, (2.6e6, 3.8e6), (0.056e6, 0.074e6), None, (1500e6, 1980e6), (500e6, 660e6), (21e3, 21e3)),
    "irregular soft stone": Row(4, (1.4e6, 2.2e6), (0.028e6, 0.042e6), None, (900e6, 1260e6), (300e6, 420e6), (13e3, 16e3)),
    "squared soft stone": Row(5, (2e6, 3.2e6), (0.04e6, 0.08e6), (0.10e6, 0.19e6), (1200e6, 1620e6), (400e6, 500e6), (13e3, 16e3)),
    "squared stone": Row(6, (5.8e6, 8.2e6), (0.09e6, 0.12e6), (0.18e6, 0.28e6), (2400e6, 3300e6), (800e6, 1100e6), (22e3, 22e3)),
    "solid brick in lime mortar": Row(7, (2.6e6, 4.3e6), (0.05e6, 0.13e6), (0.13e6, 0.27e6), (1200e6, 1800e6), (400e6, 600e6), (18e3, 18e3)),
    "perforated brick in cement mortar": Row(8, (5e6, 8e6), (0.08e6, 0.17e6), (0.20e6, 0.36e6), (3500e6, 5600e6), (875e6, 1400e6), (15e3, 15e3)),
}  # fmt: skip


def _mortar(value, context=None):
    """Validator of a class of mortar; returns its strength [MPa]."""
    found = re.fullmatch(r"M(\d+(?:\.\d+)?)", value) if isinstance(value, str) else None
    if not found or not 1 <= float(found[1]) <= 20:
        raise ValueError(f"{value!r} must be a class of mortar from 'M1' to 'M20'")
    return float(found[1])


def _arguments(clauses):
    """The arguments of :func:`masonry`, with their clauses."""
    return {**{name: value for name, (value, _) in clauses.items()}, "clauses": clauses}


@validated
def en1996(
    unit: Annotated[str, oneOf(*K)],
    fb: Annotated[float, number("Pa", 1e6, 75e6)],
    mortar: Annotated[str, _mortar],
    group: Annotated[int, whole(1, 4)] = 1,
    joints: Annotated[str, oneOf(GENERAL, THIN)] = GENERAL,
    value: Annotated[str, oneOf("mean", "characteristic")] = "mean",
) -> dict[str, Any]:
    """Masonry of EN 1996-1-1:2005, with the values that the standard recommends; a national annex
    can have others.

    E = 1000 fk, G = 0.4 E (3.7.2, 3.7.3), fc, fv0 and friction. The factor 0.8 on K of a wall with
    a mortar joint along it, 3.6.1.2(6), is not applied. The standard has no direct tensile strength
    of bed joints: give ``ft`` or ``bond_wrench``. Characteristic values give a characteristic
    answer and not the most likely one.

    :param unit: what the bricks are of
    :param fb: their normalised mean compressive strength [Pa]
    :param mortar: its class, as ``"M5"``
    :param group: of the units, by their holes
    :param joints: the kind of mortar
    :param value: ``"mean"``: fc = 1.2 fk as in EN 1052-1, fv0 = fvk0/0.8 and friction = 0.4/0.8 as
        in EN 1052-3; ``"characteristic"``: fc = fk, fvk0 and 0.4. E and G are the same
    :raises Refused: if the standard has no K for it, or the units or the mortar are too strong for
        its equations
    """
    fm, code = float(mortar), "EN 1996-1-1:2005"
    factors, problems = K[unit].get(joints, ()), []
    if group > len(factors):
        problems.append(f"table 3.3 has no K for {unit} of group {group} in {joints} mortar")
    if fb > STRONGEST[joints]:
        problems.append(
            f"fb {fb:g} Pa must be at most {STRONGEST[joints]:g} Pa in {joints} mortar: 3.6.1.2"
        )
    if joints == GENERAL and fm > 2e-6 * fb:
        problems.append(
            f"mortar M{fm:g} must be at most twice as strong as the units, fb {fb:g} Pa: equation"
            " (3.2)"
        )
    refuse(problems, "en1996: ")
    factor = factors[group - 1]
    if joints == GENERAL:
        fk, by = factor * (1e-6 * fb) ** 0.7 * fm**0.3, "(3.2)"
    elif unit == "clay" and group in (2, 3):
        fk, by = factor * (1e-6 * fb) ** 0.7, "(3.4)"
    else:
        fk, by = factor * (1e-6 * fb) ** 0.85, "(3.3)"
    ofMortar, thin = FVK0.get(unit, (OTHERS, 0.30e6))
    general = next(v for least, v in ofMortar if fm >= least)
    fvk0 = min(general if joints == GENERAL else thin, MAX_SHEAR * fb)
    strength, shear, over = (MEAN, SHEAR, True) if value == "mean" else (1, 1, False)
    mean = lambda what: f" {what}" if over else ""
    E = 1e6 * STIFFNESS * fk
    return _arguments(
        {
            "E": (E, f"{STIFFNESS} fk, {code}, 3.7.2"),
            "G": (SHEARING * E, f"{SHEARING} E, {code}, 3.7.3"),
            "fc": (
                1e6 * fk * strength,
                (
                    f"fk {fk:.3g} MPa{mean('times 1.2 of EN 1052-1')}, {code}, equation {by} with K"
                    f" = {factor} of table 3.3"
                ),
            ),
            "fv0": (
                fvk0 / shear,
                (
                    f"fvk0 {1e-6 * fvk0:g} MPa{mean('over 0.8 of EN 1052-3')}, {code}, table 3.4,"
                    " at most 0.065 fb"
                ),
            ),
            "friction": (
                FRICTION / shear,
                f"{FRICTION}{mean('over 0.8 of EN 1052-3')}, {code}, 3.6.2",
            ),
        }
    )


@validated
def ntc2018(
    masonry: Annotated[str, oneOf(*TABLE)],
    knowledge: Annotated[str, _knowledge],
    confidence: Annotated[float, number("", 1, 2)] | None = None,
) -> dict[str, Any]:
    """Existing masonry of table C8.5.I of Circolare 7/2019 to NTC 2018: E, G, fc, fv0, ft, friction
    and density.

    Strengths are over the confidence factor; coefficients of table C8.5.II are not applied, nor is
    the safety factor.

    :param masonry: its row in the table
    :param knowledge: ``"LC1"``: the least strengths; ``"LC2"``: those in the middle of the ranges;
        moduli are those in the middle (C8.5.4.1). LC3 needs tests: give what they say to
        :func:`masonry`
    :param confidence: the factor [-]; default 1.35 of LC1, 1.2 of LC2. 1 gives the most likely
        answer, with LC2

    ft is 1.5 tau0, which the code means of diagonal cracks. Rubble, roughly cut and split stone and
    irregular soft stone have no fv0 in the table: ft/0.7 of Lourenço and Rots (1997) stands for it.
    """
    row, factor = TABLE[masonry], confidence or CONFIDENCE[knowledge]
    middle = lambda ends: (ends[0] + ends[1]) / 2
    strength = lambda ends: (min(ends) if knowledge == "LC1" else middle(ends)) / factor
    which = "least" if knowledge == "LC1" else "middle"
    table = f"Circolare 7/2019, table C8.5.I, row {row.number}"
    said = f"{which} value over {factor:g} ({knowledge}), {table}"
    ft = TENSION * strength(row.tau0)
    if row.fv0 is None:
        fv0 = ft / BOND, f"none in {table}: ft/{BOND}, Lourenço and Rots (1997)"
    else:
        fv0 = strength(row.fv0), said
    return _arguments(
        {
            "E": (middle(row.E), f"middle value, {table}"),
            "G": (middle(row.G), f"middle value, {table}"),
            "fc": (strength(row.fm), said),
            "fv0": fv0,
            "ft": (ft, f"{TENSION} tau0 as in C8.7.1.16; tau0 is the {said}"),
            "friction": (LOCAL_FRICTION, "Circolare 7/2019, C8.7.1.3.1.1"),
            "density": (middle(row.w) / GRAVITY, f"middle weight, {table}"),
        }
    )
