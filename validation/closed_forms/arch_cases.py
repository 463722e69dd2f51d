# SPDX-License-Identifier: GPL-2.0-or-later
"""Arches: least thickness, friction, horizontal acceleration, tilt, thrust and spreading
supports."""

from cases import between, case
from masonry import AT_REST, bricks
import masonry_limit as limit
from structures import (
    bound,
    holdFeet,
    leans,
    leastFriction,
    leastThickness,
    rigidlike,
    sceneOf,
    semicircle,
)
from yade import O

GROUP = "Arches"
LIMIT = "limit analysis of these blocks (`masonry_limit`)"
LONGEST = 4.0  # [s] in which an arch comes to rest or falls


def stands(stones, thickness, friction=0.9, stiffness=1e11):
    """Whether a semicircle comes to rest under its weight."""
    with sceneOf(semicircle(stones, thickness), rigidlike(friction, stiffness)) as s:
        holdFeet(s)
        return s.settle(longest=LONGEST) == AT_REST


def thickness(stones, quick, friction=0.9, stiffness=1e11):
    """Expected and measured least thickness over mean radius [-]."""
    least = leastThickness(stones, friction)
    slender = lambda t: not stands(stones, t, friction, stiffness)
    return least, between(slender, least, 0.01, quick, spread=0.05)


@case(GROUP, "least t/R, semicircle of 7 flat voussoirs", LIMIT, aim=0.01, quick=True)
def arch_7_thickness(quick):
    return thickness(7, quick)


@case(GROUP, "least t/R, semicircle of 16 flat voussoirs", LIMIT, aim=0.01)
def arch_16_thickness(quick):
    return thickness(16, quick)


@case(
    GROUP,
    "least t/R, semicircle of 40 flat voussoirs",
    "Cocchetti and Rizzi 2020: 0.107426 for many (Milankovitch 1907: 0.1075)",
    aim=0.01,
)
def arch_40_thickness(quick):
    return 0.107426, thickness(40, quick)[1]


def friction(stones, thickness, quick):
    """Expected and measured least friction of a semicircle [-]."""
    with sceneOf(semicircle(stones, thickness), rigidlike()) as s:
        holdFeet(s)
        s.settle(longest=LONGEST)
        least = leastFriction(limit.read())
    slips = lambda mu: not stands(stones, thickness, mu)
    aim = 0.01 / least
    return least, between(slips, least, aim, quick, spread=0.1, within=0.006)


@case(
    GROUP,
    "least friction, semicircle of 16, t/R = 0.15 (slides and hinges)",
    LIMIT,
    aim=0.01,
    absolute=True,
)
def arch_friction_hinging(quick):
    return friction(16, 0.15, quick)


@case(
    GROUP,
    "least friction, semicircle of 16, t/R = 0.25 (slides)",
    LIMIT,
    aim=0.01,
    absolute=True,
)
def arch_friction_sliding(quick):
    return friction(16, 0.25, quick)


def oppenheim():
    """The arch of Oppenheim 1992: mean radius 1 m, between two blocks that are its last bricks."""
    return bricks.Arch(0.15, 0.3, 7, radius=0.925, angle=157.5, skewback=0.2)


def acceleration(blocks, quick, stiffness=1e11, words=(), expected=None):
    """Horizontal acceleration of an arch [g]: of limit analysis, if no other is given, and bracket
    of the engine."""
    with sceneOf(blocks, rigidlike(stiffness=stiffness), words) as s:
        holdFeet(s)
        s.settle()
        expected = expected or bound().factor
        return expected, between(leans(s), expected, 0.01, quick)


def tilting(rate, stiffness=1e11):
    """tan of the tilt at which Oppenheim's arch leaves rest: of limit analysis, and measured.

    :param rate: of the tilt [degrees/s]
    """
    with sceneOf(oppenheim(), rigidlike(stiffness=stiffness)) as s:
        holdFeet(s)
        s.settle()
        expected = bound().factor
        s.tilt(28, rate=rate)
        return expected, s.factor


@case(
    GROUP,
    "horizontal acceleration [g], 7 voussoirs, 157.5°, t/R = 0.15",
    LIMIT + "; Oppenheim 1992: 0.37",
    aim=0.01,
    quick=True,
)
def arch_7_acceleration(quick):
    return acceleration(oppenheim(), quick)


@case(GROUP, "the same, deformable voussoirs", LIMIT + ", rigid", aim=0.01)
def arch_7_deformable(quick):
    with sceneOf(oppenheim(), rigidlike()) as s:
        holdFeet(s)
        s.settle()
        rigid = bound().factor
    words = ["--blocks", "deformable", "--divisions", "1"]
    return acceleration(oppenheim(), quick, words=words, expected=rigid)


@case(
    GROUP,
    "horizontal acceleration [g], semicircle of 27, t/R = 0.2",
    LIMIT,
    aim=0.01,
)
def arch_27_acceleration(quick):
    return acceleration(semicircle(27, 0.2), quick)


@case(
    GROUP,
    "tan of the tilt at which 7 voussoirs, 157.5°, leave rest",
    LIMIT,
    aim=0.02,
)
def arch_7_tilt(quick):
    return tilting(4 if quick else 2)


def thrust(assembly, foot):
    """Smallest thrust by limit analysis [N]: the least force along -x that holds a support which
    could slide away."""
    number = assembly.ids.index(foot)
    assembly.held[number, 0] = False
    live = assembly.force(number, (-1, 0, 0))
    return assembly.smallest(live, assembly.weights((0, 0, -9.81))).factor


@case(
    GROUP,
    "thrust [weight per length × R], semicircle of 40, t/R = 0.109",
    "Cocchetti and Rizzi 2020: 0.621772 at the least thickness, many voussoirs",
    aim=0.01,
)
def arch_thrust(quick):
    thick = 0.109
    with sceneOf(semicircle(40, thick), rigidlike(0.9)) as s:
        left, right = holdFeet(s)
        s.settle(longest=LONGEST)
        weight = 2600 * 9.81 * thick * 0.3
        return 0.621772, 1e3 * s.results.column("right_force_x_kN")[-1] / weight


def spread(quick, share):
    """Thrust of an arch whose support has moved away, against the least one of the displaced
    polygon [N]."""
    with sceneOf(oppenheim(), rigidlike(), rate=50) as s:
        left, right = holdFeet(s)
        s.settle()
        s.move(right, x=share * 1e3)
        s.settle()
        measured = 1e3 * s.results.column("right_force_x_kN")[-1]
        return thrust(limit.read(), O.bodies[right.body].id), measured


@case(
    GROUP,
    "thrust [N] of 7 voussoirs, 157.5°, supports 20 mm apart",
    LIMIT + " of the displaced polygon: the least thrust",
    aim=0.01,
    quick=True,
)
def arch_spread_20(quick):
    return spread(quick, 0.02)


@case(
    GROUP,
    "thrust [N] of 7 voussoirs, 157.5°, supports 60 mm apart",
    LIMIT + " of the displaced polygon: the least thrust",
    aim=0.01,
)
def arch_spread_60(quick):
    return spread(quick, 0.06)
