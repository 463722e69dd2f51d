# SPDX-License-Identifier: GPL-2.0-or-later
"""The loads of a scene that stands in YADE, as limit analysis takes them.

``model`` is a :class:`masonry.assembly.structure.Structure`, and ``assembly`` a :class:`masonry.limit.assembly.Assembly`.
"""

import numpy as np
from yade import O, Vector3

from ..assembly.loading import bodiesOf
from ..basics import Refused


def beside(model, gravity):
    """What acts beside a load and what holds the structure now: data that can be compared."""
    loads = [[load.body, *force, load.driven] for load, force in model.loading.deadLoads()]  # fmt: skip
    held = [O.bodies[target.body].state.blockedDOFs for target in model.supports.held]
    return [list(gravity), loads, held]


def forces(model, assembly, pushed=None, pressed=None):
    """Presses, dead loads and wind with their whole; points that drives hold become props.

    :param pushed: target or pattern, and direction, of a push, whose own drive is no prop, or None
    :param pressed: target and normal force [kN] that replaces its press, or None
    """
    loads = np.zeros_like(assembly.held, float)
    for load, force in model.loading.deadLoads():
        block, point = assembly.ids.index(load.body), pointOf(load, assembly)
        if pressed and load.label == f"{pressed[0].name}_force":
            own = model.supports.weightOf(pressed[0])
            force = Vector3(force[0], force[1], own - 1e3 * pressed[1])
        if force.norm():
            loads += assembly.force(block, np.array(force), point)
        if not load.driven:
            continue
        along = np.array(load.direction.normalized())
        own = pushed and [body for body, *_ in pushed[0].parts] == [*bodiesOf(load)]
        if own and abs(along @ pushed[1]) > 1 - 1e-9:
            continue
        if load.others:
            raise Refused("limit analysis: the drive of a push in a pattern holds the structure; release() lets it go")  # fmt: skip
        assembly.props.append((block, along, point))
    return loads


def push(assembly, pushed, direction):
    """The live load of a push of a target, or in a pattern: 1 kN along a direction."""
    found = np.zeros_like(assembly.held, float)
    for body, point, share in pushed.parts:
        at = np.array(point if assembly.stood else placeOf(body, point))
        force = 1e3 * share * np.array(direction)
        found += assembly.force(assembly.ids.index(body), force, at)
    return found


def placeOf(body, point):
    """Where a point of a body is now [m]: ``point`` is its place in the structure as built."""
    state = O.bodies[body].state
    return state.pos + state.ori * state.refOri.conjugate() * (Vector3(*point) - state.refPos)  # fmt: skip


def sumOf(assembly, loads):
    """The live load of pairs of a MasonryLoad and its force [N]."""
    found = np.zeros_like(assembly.held, float)
    for load, force in loads:
        block = assembly.ids.index(load.body)
        found += assembly.force(block, np.array(force), pointOf(load, assembly))
    return found


def pointOf(load, assembly):
    """Where a MasonryLoad acts, on blocks as the assembly has them [m]."""
    return load.point if assembly.stood else placeOf(load.body, load.point)


def carriedBy(assembly, dead):
    """Vertical force of dead loads on all blocks that are free to move down, compression is positive [kN]: the supports carry
    it."""
    return -1e-3 * float(dead[~assembly.held[:, 2], 2].sum())
