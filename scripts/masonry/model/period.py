# SPDX-License-Identifier: GPL-2.0-or-later
"""The first period of a structure along a direction, and whether it buckles, measured on its
present state.

A sudden uniform acceleration sets an elastic structure swinging. With the angular frequencies ω_n
and mass shares c_n of its modes, its momentum is proportional to Σ c_n/ω_n sin(ω_n t). The first
mode has nearly all of that, and in a bar in shear that is held at both ends the others pass through
zero at the same moment: half a period is over when the momentum is first back at zero. It is the
integral over time of all forces on what can move, of rigid and deformable blocks alike.

Near buckling the stiffness against a push sideways vanishes, and the momentum does not come back to
zero: beyond that load it grows faster than that of a free body, the force times the time.

A structure at rest still moves a little, so both sides are measured, and the difference counts.

Of an elastic structure the first mode is found by the stiffness matrix; the forces after it was
moved to both sides along the mode show whether it is elastic, and give the square of the frequency
with the weights that it bears (Rayleigh's quotient).
"""

import functools
import math

from yade import O

from .._masonry import ElasticSolution, loadScene, saveScene
from ..units import GRAVITY

#: Shares of gravity: accelerations that act in the measurement, the next one if the period is
#: another one under the next one, as of what lifts off; largest difference that is none [-].
SHARES, ALIKE = (0.05, 5e-3, 5e-4, 5e-5, 5e-6), 0.01
SAMPLE = 2e-5  # [s] between readings of the forces, at true masses
FEWEST = 10  # readings in half a period, for half a per cent
#: Duration of the first side over its half period, so that the difference has its zero [-]; the
#: half period of a structure that still swings may be none of its own.
BEYOND = 1.1, 2.0, math.inf
#: Of an elastic structure: time step in which nothing moves [s]; how far the stiffness against the
#: mode may be from that of the matrix [-], which makes an error of less than 0.05 % of the period.
INSTANT, NEAR = 1e-30, 0.03
#: Search for buckling: acceleration over gravity [-], time between readings, time after which a
#: push that has not come back counts as growing [s], first number of readings, momentum of a
#: structure that buckles over that of a free body [-], and readings in a period on springs.
SMALL, LOOK, LONGEST, FIRST_LOOKS, FASTER, SLOW_LOOKS = 1e-6, 5e-4, 5.0, 32, 1.1, 400


def _ofTrueInertia(measure):
    """A measurement on a structure without added inertia, after which the scene is as before."""

    @functools.wraps(measure)
    def measured(structure, *how):
        before = saveScene("null")
        if not structure.scheme.useTrueInertia():
            return measure(structure, *how)
        try:
            return measure(structure, *how)
        finally:
            loadScene(before)

    return measured


def smallPeriod(structure, direction, longest):
    """The first period of small vibrations, which a smaller push does not change, and the share of
    gravity with which it was found [-]. Parameters as in :func:`firstPeriod`."""
    found = firstPeriod(structure, direction, longest)
    for share, smaller in zip(SHARES, SHARES[1:]):
        other = firstPeriod(structure, direction, longest, smaller)
        if found == other or found and other and abs(found - other) <= ALIKE * other:
            return found, share
        found = other
    return found, smaller


@_ofTrueInertia
def firstPeriod(structure, direction, longest, share=SHARES[0]):
    """The first period of a structure at rest along a direction in the time of the scene [s], or
    None if none is found, in the steps of a period or some more.

    Drives hold, and nothing is damped. Afterwards the scene is as before, to the last bit.

    :param direction: unit vector
    :param longest: the longest period that is looked for [s]
    :param share: of gravity, the acceleration that acts [-]
    """
    if found := _elasticPeriod(structure, direction, share):
        return found if found <= longest else None
    before = saveScene("null")
    every = max(1, int(SAMPLE * structure.args.density_scaling**0.5 / O.dt))
    most = int(0.5 * longest / (every * O.dt))
    if most < FEWEST:
        return None
    try:
        for beyond in BEYOND:
            there, back, end = [], [], min(beyond, 2.0) * most
            for momentum in _momenta(structure, direction, share, every):
                there.append(momentum)
                if momentum <= 0:
                    end = min(end, beyond * len(there))
                if not math.isfinite(momentum) or len(there) >= end:
                    break
            loadScene(before)
            for momentum in _momenta(structure, direction, -share, every):
                back.append(there[len(back)] - momentum)
                if not back[-1] > 0 or len(back) >= min(most, len(there)):
                    break
            loadScene(before)
            if back[-1] <= 0 or len(back) >= most:
                break
    except RuntimeError:  # it falls
        return None
    finally:
        loadScene(before)
    n = len(back) - 1
    if not back[n] <= 0 or n < FEWEST:
        return None
    # The first velocity is that after a whole step, as if the acceleration had begun half a step
    # before; the sum of the forces begins half a step after that velocity would have been zero.
    return 2 * O.dt * (1 + every * (n + back[n - 1] / (back[n - 1] - back[n])))


def _elasticPeriod(structure, direction, share):
    """What :func:`firstPeriod` returns of an elastic structure; None of another."""
    if structure.contacts or structure.description.functors:
        return None
    before, dt = saveScene("null"), O.dt
    try:
        O.dt, structure.scheme.joints.impacts = INSTANT, False
        structure.scheme.damp(0.0, "local")
        O.step()
        solution = ElasticSolution()
        square = solution.findMode(direction)
        acceleration = share * GRAVITY / structure.args.density_scaling
        moved = square and 2 * acceleration * solution.participation() / square
        if not moved:  # nothing moves along the direction, or nothing resists it
            return None
        rest, forces, lost = solution.force(), [], structure.energies()[0]
        for amount in (moved, -2 * moved):
            solution.displace(amount)
            O.step()
            forces.append(solution.force() - rest)
        lost = structure.energies()[0] - lost
        isElastic = max(abs(sum(forces)), lost / moved) <= ALIKE * abs(forces[0])
        found = (forces[1] - forces[0]) / (2 * moved)
        if isElastic and abs(found - square) <= NEAR * square:
            return 2 * math.pi / math.sqrt(found)
    except (RuntimeError, ValueError):  # it falls, or can move without resistance
        pass
    finally:
        loadScene(before)
        O.dt = dt
    return None


@_ofTrueInertia
def firstMode(structure, direction, longest):
    """Displacements of all bodies along a direction in the first mode of a structure at rest, by
    YADE's ids, the largest amount 1; None if no first period is found. Afterwards the scene is as
    before.

    They are taken after half the first period under a uniform acceleration to both sides, where the
    share of another mode is below the square of its period over the first. Parameters as in
    :func:`firstPeriod`.
    """
    period = firstPeriod(structure, direction, longest)
    if period is None:
        return None
    before, sides = saveScene("null"), []
    steps = round(0.5 * period / O.dt)
    try:
        for share in (SHARES[0], -SHARES[0]):
            next(_momenta(structure, direction, share, steps))
            sides.append([body.state.pos.dot(direction) for body in O.bodies])
            loadScene(before)
    finally:
        loadScene(before)
    shape = [there - back for there, back in zip(*sides)]
    largest = max(map(abs, shape))
    return [one / largest for one in shape]


@_ofTrueInertia
def buckles(structure, direction):
    """Whether a small push along a direction grows, or does not come back within :data:`LONGEST`,
    or within a longer period on springs; and how many steps it took to see that. Afterwards the
    scene is as before, to the last bit. It sees modes in which the structure moves to one side."""
    before = saveScene("null")
    scaling = structure.args.density_scaling**0.5
    slowest = structure.supports.slowest()
    every = max(1, round(max(LOOK * scaling, slowest / SLOW_LOOKS) / O.dt))
    longest = max(LONGEST * scaling, slowest)
    looks, most = FIRST_LOOKS, longest / (every * O.dt)
    momenta = [_momenta(structure, direction, share, every) for share in (SMALL, -SMALL)]
    states, found = [before, before], ([], [])  # of both sides
    try:
        while True:
            for side, one in enumerate(momenta):
                loadScene(states[side])
                found[side].extend(next(one) for _ in range(looks - len(found[side])))
                states[side] = saveScene("null")
            momentum = [there - back for there, back in zip(*found)]
            free = looks * momentum[0]  # of a free body
            if min(momentum) <= 0:
                grows = False
            elif not momentum[-1] <= FASTER * free or looks >= most:
                grows = True
            else:
                looks *= 2
                continue
            return grows, 2 * looks * every
    except (RuntimeError, ValueError):  # it falls, to no finite state
        return True, every * sum(map(len, found))
    finally:
        loadScene(before)


def _momenta(structure, direction, share, every):
    """The momentum of a structure along a direction [N·s] every some steps, under a share of
    gravity along it [-]."""
    acceleration = share * GRAVITY / structure.args.density_scaling * direction
    structure.scheme.damp(0.0, "local")
    supports = structure.supports
    force = lambda: (supports.applied() + supports.carried()).dot(direction)
    rest, now = force(), structure.scheme.now
    structure.scheme.setGravity(now + acceleration)
    O.step()
    before, momentum = force() - rest, 0.0
    while True:
        for _ in range(every):
            O.step()
        after = force() - rest
        momentum += 0.5 * (before + after) * every * O.dt
        before = after
        yield momentum
