# SPDX-License-Identifier: GPL-2.0-or-later
"""Mechanisms in which joints slip without opening, below the bound of associated flow.

When a part of a wall tips over a stepped crack, nearly all of its head joints are open, and slip
along their faces without resistance. Associated flow does not allow that, since joints that slip
would have to open more. So this module solves programmes of the same structure with less friction
where nothing presses joints together: in head joints first (:func:`_smooth`), then in every joint
that carries nothing (:func:`loosened`). :func:`repeated` replaces friction by a cohesion. A
mechanism counts only if hardly any friction is missing in it (:func:`_belongs`).
"""

import contextlib
from dataclasses import replace

import numpy as np

from masonry.errors import Refused

LOOSENING_ROUNDS = 8  # in which joints without pressure lose their friction, at most
COHESION_ROUNDS = 60  # in which friction is replaced by a cohesion, at most
SAME_FACTOR = 1e-3  # relative change of the factor at which these end [-]
OPEN_FORCE_RATIO = 1e-6  # force on a joint over the largest, below which it is open [-]
HEAD_JOINT_COSINE = 0.5  # between dead loads and normal, below which a joint is a head joint
MAX_MISSING_POWER = 0.02  # of the friction that a mechanism misses, over its power [-]


def loosened(assembly, live, dead):
    """The weakest mechanism that is found when joints without pressure lose their friction, head
    joints first, as a Bound; None if there is none.
    """
    smooth, least = _smooth(assembly, dead), None
    for _ in range(LOOSENING_ROUNDS if smooth else 0):
        try:
            bound = smooth.associated(live, dead)
        except Refused:  # without that friction it does not stand, or time is over
            break
        if _belongs(assembly, bound) and (least is None or bound.factor < least.factor):
            least = bound
        joint = assembly.contacts.joint
        pressed = np.bincount(joint, bound.normal, len(assembly.pairs))
        friction = np.where(pressed < OPEN_FORCE_RATIO * pressed.max(), 0, smooth.friction)
        if (friction == smooth.friction).all():
            break
        smooth = replace(assembly, friction=friction)
    return least


def withoutDilatancy(assembly, live, dead):
    """The smallest of all that this module finds: see :meth:`Assembly.withoutDilatancy`."""
    found = repeated(assembly, live, dead)
    smooth = _smooth(assembly, dead)
    if smooth:
        with contextlib.suppress(Refused):  # without that friction it does not stand
            other = repeated(smooth, live, dead)
            if other.factor < found.factor and _belongs(assembly, other):
                found = other
    loose = loosened(assembly, live, dead)
    if loose and loose.factor < found.factor:
        found, loose.settled = loose, True
    found.assembly = assembly
    found.dilates = False
    return found


def repeated(assembly, live, dead):
    """Rounds in which the friction of a joint is a cohesion: the friction under the normal force of
    the last round."""
    bound = assembly.associated(live, dead)
    pressed, factor, slope = bound.compressed, bound.factor, 0.3
    for _ in range(COHESION_ROUNDS):
        slope = max(1e-3, slope * 0.7)
        try:
            following = assembly.associated(live, dead, (pressed, slope), turns=2)
        except Refused:
            break
        change = abs(following.factor - factor) / max(abs(factor), 1e-12)
        pressed = 0.5 * pressed + 0.5 * following.compressed
        bound, factor = following, following.factor
        if change < SAME_FACTOR and slope < 2e-3 and bound.overstressed < 0.01:
            bound.settled = True
            break
    return bound


def _smooth(assembly, dead):
    """The same structure without friction in its head joints, which the dead loads do not press
    together; None if it has none."""
    down = np.where(assembly.held[:, :3], 0, dead[:, :3]).sum(axis=0)
    if not down.any():
        return None
    head = np.abs(assembly.normals @ (down / np.linalg.norm(down))) < HEAD_JOINT_COSINE
    smooth = replace(assembly, friction=np.where(head, 0, assembly.friction))
    return smooth if head.any() else None


def _belongs(assembly, bound):
    """Whether the mechanism of a structure with less friction is one of the whole structure,
    too."""
    c = assembly.contacts
    speed = np.linalg.norm(bound.jumps(c.joint, c.at)[1], axis=1)
    friction = (assembly.friction - bound.assembly.friction)[c.joint]
    missing = (friction * np.maximum(bound.normal, 0) * speed).sum()
    return missing <= MAX_MISSING_POWER * bound.powers["loads"]
