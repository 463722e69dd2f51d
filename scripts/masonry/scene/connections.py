# SPDX-License-Identifier: GPL-2.0-or-later
"""Ties, springs and fibre layers: commands that describe a scene."""

from typing import Annotated, Any, Union

import numpy as np

from ..arguments import Direction, Name, Numbers, number, oneOf, validated
from ..arguments import vector as numbers
from ..model.bodies import vector
from ..errors import Refused, refuse
from ..bricks import Block, Bricks
from .platens import Point
from .targets import Part, Target, brick, isOwn
from .ties import BUNDLES, MAX_STIFFNESS, OF_OVERLAY, OF_TIE, End, Overlay, Spring, Tie
from .script import describes


def _end(value, context):
    if not isinstance(value, Target):
        return brick(value, context)
    if not isOwn(value, context):
        raise ValueError(f"{value.name!r}, which is of another scene, must be of this one")
    return value


EndAt = Annotated[Union[Target, Numbers, int, Block], _end]


def _endOf(description, where):
    if isinstance(where, Target):
        return End(tuple(where.point), where, where.brick)
    index, point = description.find(where)
    return End(tuple(point or description.middle(index)), None, index)


@describes
@validated
def tie(
    description: Any,
    one: EndAt,
    other: EndAt | None = None,
    *,
    stiffness: Annotated[float, OF_TIE["stiffness"].validator],
    strength: Annotated[float, OF_TIE["strength"].validator] | None = None,
    prestress: Annotated[float, OF_TIE["prestress"].validator] = 0.0,
    slack: Annotated[float, OF_TIE["slack"].validator] = 0.0,
    breaking: Annotated[float, OF_TIE["breaking"].validator] | None = None,
    compression: bool = False,
    anchor: Point | None = None,
    name: Name | None = None,
) -> Tie:
    """A bar between a point of a brick and another one, or the ground: a tie rod, an anchor, a
    strut.

    It has no mass, does not bend, and pulls along the line between its ends, however far they move.
    Its columns of curve.csv are its force [kN] and elongation [mm]; the terminal says when it
    yields or breaks. Bricks at its ends are rigid also with ``--blocks deformable``.

    :param one: a point (x, y, z) [m] in a brick or near it; a brick, or its index: its middle; or a
        target: the point on which loads act
    :param other: the other end; None: ``anchor`` says where
    :param anchor: (x, y, z) [m] of an end on the ground, which does not move
    :param stiffness: E A / L [N/m]
    :param strength: force at which it yields, and then keeps [N]; None: it does not yield
    :param prestress: force by which :meth:`settle` tightens it [N]: it is shortened by prestress /
        stiffness, so masonry that gives way reduces the force
    :param slack: elongation before it carries anything [m]
    :param breaking: strain of the distance between its ends, its tightening included, at which it
        breaks [-]; None: it does not
    :param compression: whether it also carries compression, as a strut, with the same strength
    :param name: of its columns; None: ``tie`` and a number
    :returns: a :class:`Tie`, whose ``force`` and ``elongation`` can be read between stages
    """
    if (other is None) == (anchor is None):
        raise Refused("tie: give either other or anchor")
    far = _endOf(description, other) if anchor is None else End(tuple(map(float, anchor)))
    ends = _endOf(description, one), far
    if description.plane:  # both ends are in the plane of the first one's middle
        level = ends[0].point[1]
        if ends[0].brick is not None:
            level = description.middle(ends[0].brick)[1]
        for end in ends:
            end.point = (end.point[0], level, end.point[2])
    name = name or f"tie{len(description.connectorsOf(Tie))}"
    made = Tie(name, ends, stiffness, strength, prestress, slack, breaking, compression)
    problems = [*_onOneBrick(*ends)]
    if made.length > 0:
        problems += made.problems()
    elif not problems:
        problems = [f"its ends are both at {ends[0].point} m"]
    return _take(description, "tie", made, problems)


def _springs(value, context=None):
    found = numbers("", MAX_STIFFNESS)(value)
    if min(found) < 0:
        raise ValueError(f"{value!r} must be three numbers of at least 0")
    return tuple(found)


Springs = Annotated[Numbers, _springs]


@describes
@validated
def spring(
    description: Any,
    one: EndAt,
    other: EndAt | None = None,
    *,
    stiffness: Springs = (0.0, 0.0, 0.0),
    rotation: Springs = (0.0, 0.0, 0.0),
    name: Name | None = None,
) -> Spring:
    """Linear springs at a point, along and about x, y and z, between two bricks or platens, or one
    and the ground.

    They have no force as the scene is built, and neither yield nor break. They keep the global
    axes, so turns must be small. Columns of curve.csv are the forces [kN] and moments [kN m] of
    ``one`` on them. Bricks at their ends are rigid also with ``--blocks deformable``.

    :param one: where they are fixed, as for :meth:`tie`
    :param other: the other brick or platen, at the same point; None: the ground
    :param stiffness: along x, y and z, three numbers [N/m]
    :param rotation: about x, y and z, three numbers [N m/rad]
    :param name: of the columns; None: ``spring`` and a number
    :returns: a :class:`Spring`, whose ``force`` and ``moment`` can be read between stages
    """
    name = name or f"spring{len(description.connectorsOf(Spring))}"
    first = _endOf(description, one)
    second = End(first.point) if other is None else _endOf(description, other)
    second.point = first.point
    problems = [*_onOneBrick(first, second)]
    if not any((*stiffness, *rotation)):
        problems.append("a stiffness must be above 0")
    if description.plane and (stiffness[1] or rotation[0] or rotation[2]):
        problems.append(
            "the scene is in the x-z plane: stiffness along x and z, and rotation about y, are what"
            " it can have; Scene(..., plane=False) is in space"
        )
    made = Spring(name, (first, second), tuple(stiffness), tuple(rotation))
    return _take(description, "spring", made, problems)


#: Corners so near to a face lie on it, over the largest extent of the structure [-].
NEAR = 1e-6


@describes
@validated
def overlay(
    description: Any,
    side: Direction,
    *,
    stiffness: Annotated[float, OF_OVERLAY["stiffness"].validator],
    strength: Annotated[float, OF_OVERLAY["strength"].validator],
    gauge: Annotated[float, number("m", 0, 10, above=True)],
    strain: Annotated[float, OF_OVERLAY["strain"].validator] | None = None,
    fibres: Annotated[str, oneOf("both", "vertical", "horizontal")] = "both",
    part: Part | None = None,
    name: Name | None = None,
) -> Overlay:
    """A fibre layer on a face: textile or steel in mortar, over every joint that ends at the face.

    Fibres carry tension only. Two bundles over the edge of every joint are bars (:meth:`tie`)
    between both bricks, at right angles to the joint. Mortar and bond of the layer are modelled by
    ``gauge`` alone, the free length of fibres across a crack.

    :param side: outward direction of the face, for example (0, -1, 0)
    :param stiffness: E t of the fibres [N/m]
    :param strength: force per width at which they slip or yield [N/m]
    :param gauge: length over which they stretch at a crack [m]
    :param strain: at which they break [-]; None: they do not
    :param fibres: ``"vertical"``: over joints that are nearer to level; ``"horizontal"``: over the
        others; ``"both"``
    :param part: name of a part of the bricks; None: all
    :param name: of its columns, how many bundles have yielded and broken; None: ``overlay`` and a
        number
    :returns: an :class:`Overlay`, whose ``ties`` are the bundles
    """
    if description.plane:
        raise Refused(
            "overlay: the scene is in the x-z plane, in which a layer on one face would bend it;"
            " Scene(..., plane=False) is in space"
        )
    name = name or f"overlay{len(description.overlays)}"
    outward = np.asarray(vector(side, "overlay: side").normalized(), float)
    size = max(b - a for a, b in zip(description.low, description.high))
    fronts = [max(np.dot(c, outward) for c in b.corners) for b in description.bricks]
    made = []
    for joint in Bricks(description.bricks).joints():
        pair, normal = (joint.first, joint.second), np.array(joint.normal)
        level = abs(normal[2]) > 0.5**0.5
        if abs(normal @ outward) > 0.5 or fibres == ("horizontal" if level else "vertical"):
            continue
        if part is not None and {description.bricks[n].part for n in pair} != {part}:
            continue
        corners = np.array(joint.polygon)
        heights = corners @ outward
        edge = corners[heights > min(fronts[n] for n in pair) - NEAR * size]
        if len(edge) < 2:
            continue
        along = np.cross(normal, outward)
        first, last = edge[np.argmin(edge @ along)], edge[np.argmax(edge @ along)]
        width = float(np.linalg.norm(last - first))
        if not width > NEAR * size:
            continue
        across = normal - (normal @ outward) * outward
        across *= 0.5 * gauge / np.linalg.norm(across)
        for share in BUNDLES:
            point = first + share * (last - first)
            at = lambda sign, n: End(tuple(map(float, point + sign * across)), None, n)
            ends = at(-1, pair[0]), at(1, pair[1])
            made.append(
                Tie(
                    f"{name}_{len(made)}",
                    ends,
                    0.5 * width * stiffness / gauge,
                    0.5 * width * strength,
                    0.0,
                    0.0,
                    strain,
                    False,
                    overlay=name,
                )
            )
    if not made:
        raise Refused(f"overlay: no joint ends at a face that looks along {tuple(side)}")
    layer = Overlay(name, made, stiffness, strength, gauge, strain)
    _take(description, "overlay", layer, [])
    description.connectors += made
    return layer


def _onOneBrick(one, other):
    same = one.target is not None and one.target is other.target
    if same or one.brick is not None and one.brick == other.brick:
        yield f"its ends, {one.words} and {other.words}, are on one brick"


def _take(description, word, made, problems):
    refuse([f"{word}: {one}" for one in problems])
    connectors, overlays = description.connectors, description.overlays
    taken = {one.name for one in (*connectors, *overlays)}
    if made.name in {*taken, *description.targets, *description.materials.joints}:
        raise Refused(f"{word}: there is a {made.name!r} already; give one of them another name")
    (overlays if isinstance(made, Overlay) else connectors).append(made)
    return made
