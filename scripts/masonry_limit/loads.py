# SPDX-License-Identifier: GPL-2.0-or-later
"""The loads of a scene that stands in YADE, as limit analysis takes them.

``model`` is what the scene has built in YADE, and ``assembly`` a
:class:`masonry_limit.assembly.Assembly`.
"""

import numpy as np
from masonry.errors import Refused
from masonry.model import arrays


def forces(model, assembly, pushed=None, pressed=None):
    """Presses, dead loads and wind with their whole; points that drives hold become props.
    ``pushed`` and ``pressed`` are those of a :class:`masonry_limit.search.Load`.
    """
    loads = np.zeros_like(assembly.held, float)
    for load in arrays.deadLoads(model):
        block, force = assembly.ids.index(load.body), load.force
        point = _placeOf(assembly, load.body, load.point)
        # of all vertical loads on it the press counts, with its weight
        if pressed and load.body == pressed[0].body and not load.isLift:
            isPress = load.label == f"{pressed[0].name}_press"
            down = 1e3 * pressed[1] - model.supports.weightOf(pressed[0])
            force = np.array([force[0], force[1], -down * isPress])
        if force.any():
            loads += assembly.force(block, force, point)
        if load.held is None:
            continue
        own = pushed and [body for body, *_ in pushed[0].parts] == load.bodies
        if own and abs(load.held @ pushed[1]) > 1 - 1e-9:
            continue
        if len(load.bodies) > 1:
            raise Refused(
                "limit analysis: the drive of a push in a pattern holds the structure; release()"
                " lets it go"
            )
        assembly.props.append((block, load.held, point))
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
    return np.array(point) if assembly.stood else arrays.placeNow(body, point)


def carriedBy(assembly, dead):
    """Vertical force of dead loads on all blocks that are free to move down: the supports carry it,
    compression is positive [kN]."""
    return -1e-3 * float(dead[~assembly.held[:, 2], 2].sum())
