# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks of a scene: bodies of YADE. Bad input raises ValueError, with all problems at once."""

import math
from typing import Annotated, Any, Sequence

from yade import Body, O, Vector3
from yade.wrapper import MasonryBlock, MasonryMat

from ..arguments import Numbers, isA, listOf, shown, validated
from ..arguments import vector as coordinates
from ..errors import firstOf

#: The colour of a block in YADE's 3-D view: red, green and blue [-].
PALE = (0.75, 0.7, 0.65)
THINNEST = 1e-6  # thickness over length of a block [-]


def properties(cls) -> list[dict[str, Any]]:
    """The properties of a class of the plugin, dicts with ``name``, ``unit``, ``meaning``,
    ``source``, the bounds ``low`` and ``high``, and the usual ones ``usual_low`` and
    ``usual_high``; a value beyond these is probably given in ``other_unit``."""
    return cls.properties()


def units(cls) -> dict[str, str]:
    return {p["name"]: p["unit"] for p in properties(cls) if p["unit"]}


def refuse(problems: list[str], *hints: str) -> None:
    """Raise ValueError with the first problems of a list, if there are any, and hints."""
    if problems:
        raise ValueError("\n".join([*firstOf(problems), *hints]))


def vector(value: Any, what: str) -> Any:
    """Three finite numbers as a Vector3. Raises ValueError, which begins with ``what``."""
    try:
        found = Vector3(*value)
        if len(value) == 3 and math.isfinite(found.norm()):
            return found
    except Exception:  # Boost.Python's ArgumentError has no name in Python
        pass
    raise ValueError(f"{what} must be three finite numbers, got {shown(value)}")


def placeOf(body: int, point: Any) -> Any:
    """Where a point of a body, given in the structure as built, is now [m]."""
    state = O.bodies[body].state
    turn = state.ori * state.refOri.conjugate()
    return state.pos + turn * (Vector3(*point) - state.refPos)


def _extent(points):
    """Longest extent of points, and how far they reach out of a plane through three [m]."""
    first = points[0]
    away = max((p - first for p in points), key=Vector3.norm)
    side = max((away.cross(p - first) for p in points), key=Vector3.norm)
    height = max(abs(side.dot(p - first)) for p in points)
    return away.norm(), height / side.norm() if side.norm() > 0 else 0.0


@validated
def addBlock(
    vertices: Annotated[Any, listOf(coordinates("m"), 4)],
    material: Annotated[MasonryMat, isA(MasonryMat)],
    inPlane: bool = False,
    color: Annotated[Numbers, coordinates()] = PALE,
) -> int:
    """Append a convex block to the scene. Returns its body id.

    :param vertices: corners [m] in global axes, at least four, none inside the block
    :param inPlane: only x, z and the rotation about y stay free
    """
    return placeBlock(vertices, material, inPlane, color)


def placeBlock(vertices: Sequence[Any], material: Any, inPlane: bool, color: Any = PALE) -> int:
    """:func:`addBlock` without checks of types."""
    points = [Vector3(*v) for v in vertices]
    length, thickness = _extent(points)
    if not thickness > THINNEST * length:
        raise ValueError(
            f"block: its {len(points)} corners span {length:g} m but only {thickness:g} m out of a"
            " plane: no volume"
        )
    if length < 1e-8 * max(map(Vector3.norm, points)):
        raise ValueError(
            f"block: {length:g} m is too small to be told so far from the origin, corner 0 at"
            f" {vertices[0]} m"
        )
    shape, centroid, orientation = MasonryBlock.around(points)
    shape.color = color
    body = Body(shape=shape, material=material)
    body.aspherical = True
    body.state = state = material.newAssocState()  # beside those of the other blocks
    state.mass = material.density * shape.volume
    state.inertia = material.density * shape.inertia
    state.pos, state.ori = centroid, orientation
    hull, problems = shape.v, []
    for n, p in enumerate(points if len(hull) < len(points) else []):
        if p in points[:n]:
            problems.append(f"block: corner {n} {vertices[n]} m is given twice")
        elif all((state.pos + state.ori * v - p).norm() > 1e-6 * length for v in hull):
            problems.append(
                f"block: corner {n} {vertices[n]} m is no corner of the convex block around all of"
                " them"
            )
    if not all(0 < v < math.inf for v in (state.mass, *state.inertia)):
        problems.append(
            f"block: {length:g} m long, its mass of {state.mass:g} kg and inertia are no numbers"
            " above 0"
        )
    refuse(problems)
    state.refPos, state.refOri = state.pos, state.ori
    body.bounded = False  # no collider runs
    if inPlane:
        # with blocked rotations the integrator takes `inertia` in global axes
        axes, own = state.ori.toRotationMatrix(), state.inertia
        turned = (sum(axes[i, k] ** 2 * own[k] for k in range(3)) for i in range(3))
        state.inertia = Vector3(*turned)
        state.blockedDOFs = "yXZ"
    return O.bodies.append(body)
