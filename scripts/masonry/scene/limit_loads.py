# SPDX-License-Identifier: GPL-2.0-or-later
"""The loads of a scene that stands in YADE, as limit analysis takes them.

``model`` is a :class:`masonry.assembly.structure.Structure`, and ``assembly`` a
:class:`masonry.limit.assembly.Assembly`.
"""

import numpy as np
from yade import O, Vector3

from ..assembly.blocks import placeOf
from ..assembly.loading import bodiesOf
from ..basics import Refused


def beside(model, gravity):
    """What acts beside a load and what holds the structure now: data that can be compared."""
    loads = [[load.body, *force, load.driven] for load, force in model.loading.deadLoads()]
    held = [O.bodies[target.body].state.blockedDOFs for target in model.supports.held]
    return [list(gravity), loads, held]


def forces(model, assembly, pushed=None, pressed=None):
    """Presses, dead loads and wind with their whole; points that drives hold become props.

    :param pushed: target or pattern, and direction, of a push, whose own drive is no prop, or None
    :param pressed: target and normal force [kN] that replaces its press, or None
    """
    loads = np.zeros_like(assembly.held, float)
    for load, force in model.loading.deadLoads():
        block = assembly.ids.index(load.body)
        point = _placeOf(assembly, load.body, load.point)
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
            raise Refused(
                "limit analysis: the drive of a push in a pattern holds the structure; release()"
                " lets it go"
            )
        assembly.props.append((block, along, point))
    return loads


def sumOf(assembly, acting):
    """The live load of some forces.

    :param acting: triples of a body, a point of it in the structure as built, and the force [N]
    """
    found = np.zeros_like(assembly.held, float)
    for body, point, force in acting:
        block, at = assembly.ids.index(body), _placeOf(assembly, body, point)
        found += assembly.force(block, np.array(force), at)
    return found


def _placeOf(assembly, body, point):
    """Where a point of a body is on blocks as the assembly has them [m]: ``point`` is its place in
    the structure as built."""
    return np.array(point if assembly.stood else placeOf(body, point))


def carriedBy(assembly, dead):
    """Vertical force of dead loads on all blocks that are free to move down: the supports carry it,
    compression is positive [kN]."""
    return -1e-3 * float(dead[~assembly.held[:, 2], 2].sum())
