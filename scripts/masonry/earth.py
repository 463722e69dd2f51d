# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure of soil without cohesion on a face, by EN 1997-1:2004 and EN 1998-5:2004, and of ground
water, as functions of the place for :meth:`masonry.Scene.pressure`::

    soil = [earth.Soil(18e3, friction=35)]
    at = earth.pressure(soil, top=2.5, surcharge=5e3, wall=20, kh=0.1, foot=0)
    scene.pressure(at, towards=(1, 0, 0), friction=20)

Strengths and weights are design values: no partial factor is in here. Clauses are cited from
memory. Angles are in degrees. This module needs no YADE.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Callable, Sequence

from .arguments import isA, listOf, number, orNone, validated
from .errors import Refused

WATER = 9810.0  # weight of water [N/m³]
NEAR = 1e-9  # round-off of a level [m]
LARGEST_FRICTION = 2 / 3  # of soil that shakes, on a wall, over its own: EN 1998-5, 7.3.2.3
Field = Callable[[float, float, float], float]
Level = Annotated[float, number("m", -1e6, 1e6)]
Friction = Annotated[float, number("degrees", 0, 60, above=True)]
OnWall = Annotated[float, number("degrees", 0, 60)]
Batter = Annotated[float, number("degrees", -45, 45)]
Slope = Annotated[float, number("degrees", -45, 60)]
Ratio = Annotated[float, number("", 1, 20)]
Horizontal = Annotated[float, number("", 0, 2)]
Vertical = Annotated[float, number("", -0.9, 0.9)]


@validated
@dataclass(frozen=True)
class Soil:
    """A level layer of soil.

    :param weight: [N/m³], saturated where it is below the water
    :param friction: angle of shearing resistance [degrees]
    :param thickness: [m]; None: down to any depth
    """

    weight: Annotated[float, number("N/m³", 0, 1e5, above=True)]
    friction: Friction
    thickness: Annotated[float | None, orNone(number("m", 0, 1e3, above=True))] = None


@validated
def atRest(friction: Friction, slope: Slope = 0.0, overconsolidation: Ratio = 1.0) -> float:
    """Horizontal over vertical stress at rest, K0 = (1 - sin φ) √OCR (1 + sin β): EN 1997-1,
    9.5.2(3) and (4), with the resultant parallel to the slope β. Raises Refused where β is below 0
    or above φ."""
    if not 0 <= slope <= friction:
        raise Refused(f"earth: a slope of {slope:g} degrees must be from 0 to {friction:g} at rest")
    sine = math.sin(math.radians(slope))
    return (1 - math.sin(math.radians(friction))) * math.sqrt(overconsolidation) * (1 + sine)


@validated
def active(
    friction: Friction,
    wall: OnWall = 0.0,
    batter: Batter = 0.0,
    slope: Slope = 0.0,
    kh: Horizontal = 0.0,
    kv: Vertical = 0.0,
) -> float:
    """The coefficient K of the active force E = ½ K γ (1 - kv) H²: Coulomb's without, and Mononobe
    and Okabe's with an acceleration, EN 1998-5, Annex E, (E.2), and (E.3) where the slope alone
    slides under it. With tan θ = kh/(1 - kv) and ψ = 90° - batter,

    K = sin²(ψ + φ - θ) / (cos θ sin² ψ sin(ψ - θ - δ) (1 + √r)²),
    r = sin(φ + δ) sin(φ - β - θ) / (sin(ψ - θ - δ) sin(ψ + β)); in (E.3) r = 0.

    :param wall: angle δ of friction on the face: up to φ (EN 1997-1, 9.5.1), of soil that shakes up
        to ⅔ φ (EN 1998-5, 7.3.2.3)
    :param batter: of the face from the vertical; above 0 the soil lies on it
    :param slope: angle β of the surface of the soil, above 0 upwards from the wall
    :param kh: horizontal acceleration towards the wall [g]; ``kv``: upwards [g], where a positive
        one makes the soil lighter; the code asks for both signs
    :raises Refused: where the formula has no value
    """
    most = friction * (LARGEST_FRICTION if kh or kv else 1)
    if wall > most + 1e-9:
        raise Refused(f"earth: wall friction {wall:g} degrees must be at most {most:.4g}")
    if slope > friction:
        raise Refused(
            f"earth: a slope of {slope:g} degrees must be at most {friction:g}: it slides"
        )
    phi, delta, beta = map(math.radians, (friction, wall, slope))
    psi, theta = math.radians(90 - batter), math.atan2(kh, 1 - kv)
    leaning, above = math.sin(psi - theta - delta), math.sin(psi + beta)
    if min(leaning, above, psi + phi - theta) <= 0:
        raise Refused("earth: no active pressure: batter, slope, wall friction or kh is too large")
    least = max(0.0, math.sin(phi - beta - theta))
    wedge = (1 + math.sqrt(math.sin(phi + delta) * least / (leaning * above))) ** 2
    down = math.cos(theta) * math.sin(psi) ** 2 * leaning
    return math.sin(psi + phi - theta) ** 2 / (down * wedge)


@validated
def pressure(
    layers: Annotated[Sequence[Soil], listOf(isA(Soil))],
    top: Level,
    surcharge: Annotated[float, number("Pa", 0, 1e7)] = 0.0,
    water: Annotated[float | None, orNone(number("m", -1e6, 1e6))] = None,
    wall: OnWall = 0.0,
    batter: Batter = 0.0,
    slope: Slope = 0.0,
    rest: bool = False,
    foot: Annotated[float | None, orNone(number("m", -1e6, 1e6))] = None,
    kh: Horizontal = 0.0,
    kv: Vertical = 0.0,
) -> Field:
    """Effective pressure of soil normal to a face [Pa], a function of the place: K σv cos δ cos ω
    with the batter ω and the vertical stress σv = Σγz + q cos ω cos β/cos(β - ω), which is γ less
    9810 N/m³ below the water (EN 1997-1, 9.5.1 and Annex C without cohesion). Each layer has the K
    of its own friction.

    With an acceleration the increment over the static pressure is even over the height, so that it
    acts at its middle (EN 1998-5, 7.3.2.3); below the water tan θ = γ/(γ - γw) kh/(1 - kv), as in
    soil that holds its water (Annex E, (E.6)).

    :param layers: from the top down; the last one may have no thickness
    :param top: level of the soil at the face [m]
    :param surcharge: q on its surface, of the area in plan [Pa]
    :param water: level of the ground water [m], whose own pressure is :func:`groundWater`
    :param wall: friction on the face; give it as ``friction`` to :meth:`masonry.Scene.pressure`
    :param batter: as in :func:`active`, with ``slope``, ``kh`` and ``kv``
    :param rest: whether it is at rest (:func:`atRest`), on a vertical face; the ``friction`` of the
        scene is then the slope
    :param foot: level of the foot of the wall [m], needed with ``kh`` or ``kv``
    :raises Refused: where a formula has no value, or nothing is known below the layers
    """
    shaken = bool(kh or kv)
    if rest and (shaken or wall or batter):
        raise Refused("earth: at rest there is no wall friction, batter, kh or kv")
    if shaken and (foot is None or foot >= top):
        raise Refused(f"earth: kh and kv need the foot [m] of the wall, below its top at {top:g} m")
    omega, beta = math.radians(batter), math.radians(slope)
    sigma = surcharge * math.cos(omega) * math.cos(beta) / math.cos(beta - omega)
    share = 1.0 if rest else math.cos(math.radians(wall)) * math.cos(omega)
    spans, high, increment = [], top, 0.0
    for soil in layers:
        if high == -math.inf:
            raise Refused("earth: each layer but the last needs a thickness [m]")
        low = -math.inf if soil.thickness is None else high - soil.thickness
        level = low if water is None else min(high, max(low, water))
        for upper, lower, wet in ((high, level, False), (level, low, True)):
            if not upper > lower:
                continue
            weight = soil.weight - WATER * wet
            if weight <= 0:
                raise Refused(f"earth: a saturated weight must be above {WATER:g} N/m³")
            k = atRest(soil.friction, slope) if rest else active(soil.friction, wall, batter, slope)
            spans.append((upper, lower, sigma, weight, k * share))
            if shaken:
                end = max(lower, foot)
                heavier = soil.weight / weight
                moving = active(soil.friction, wall, batter, slope, heavier * kh, kv)
                mean = sigma + weight * (upper - end) / 2
                increment += ((1 - kv) * moving - k) * mean * max(0.0, upper - end)
            sigma += weight * (upper - lower)
        high = low
    increment *= share / (top - foot) if shaken else 0.0

    def at(x: float, y: float, z: float) -> float:
        if z > top + NEAR:
            return 0.0
        for upper, lower, stress, weight, k in spans:
            if z >= lower - NEAR:
                return k * (stress + weight * max(0.0, upper - z)) + increment
        raise ValueError(f"earth: there is no soil below {spans[-1][1]:g} m")

    if foot is not None:
        at(0.0, 0.0, foot)
    return at


@validated
def groundWater(level: Level) -> Field:
    """Pressure of water at rest up to a level [m], 9810 N/m³ times the depth: a function of the
    place [Pa]."""
    return lambda x, y, z: WATER * max(0.0, level - z)
