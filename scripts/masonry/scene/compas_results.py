# SPDX-License-Identifier: GPL-2.0-or-later
"""Results of a problem of compas_dem in a file as LMGC90 leaves them there."""

import json
from typing import Any

import numpy as np
from yade import O

from ..bricks.compas_files import contentOf
from .compas_problems import Problem, areasOf

NOTHING = 1e-9  # force of a contact over the largest one, below which it is none


def _typed(kind, **data):
    return {"dtype": kind, "data": data}


def _frame(at, xaxis, yaxis):
    values = dict(point=at.tolist(), xaxis=xaxis.tolist(), yaxis=yaxis.tolist())
    return _typed("compas.geometry/Frame", **values)


def writeResults(path: str, problem: Problem, scene: Any) -> None:
    """Write the file of a problem again, with what a scene at rest has: a transformation for each
    node, and contact forces for each edge."""
    graph = contentOf(contentOf(contentOf(problem.file.data)["model"])["graph"])
    motions = {body: _motionOf(O.bodies[body].state) for body in scene.model.ids}
    nodes = dict(zip(motions, (stone.node for stone in problem.file.stones)))
    for stone, (turn, shift) in zip(problem.file.stones, motions.values()):
        matrix = np.block([[turn, shift[:, None]], [np.zeros(3), 1.0]]).tolist()
        kind = "compas.geometry/Transformation"
        graph["node"][str(stone.node)]["transformation"] = _typed(kind, matrix=matrix)
    edges = graph["edge"]
    found = [_contactOf(problem, i, motions, nodes) for i in O.interactions if i.isReal]
    largest = max(contact["force_magnitude"] for *_, contact in found)
    for edge in (edge for ends in edges.values() for edge in ends.values()):
        for name in found[0][2].keys() & edge.keys():  # of another run
            del edge[name]
    for u, v, contact in found:
        if contact["force_magnitude"] > NOTHING * largest:
            one, other = (v, u) if u in edges.get(v, ()) else (u, v)
            edges.setdefault(one, {}).setdefault(other, {}).update(contact)
    with open(path, "w") as file:
        json.dump(problem.file.data, file)


def _motionOf(state):
    """Rotation (3, 3) and shift (3,) that take a body from where it was built to where it is."""
    turn = np.array((state.ori * state.refOri.conjugate()).toRotationMatrix())
    return turn, np.array(state.pos) - turn @ np.array(state.refPos)


def _contactOf(problem, joint, motions, nodes):
    """Nodes of a contact, the lower one first, and what the edge between them has."""
    rows = lambda vectors: np.array([[*v] for v in vectors])
    one, other = motions[joint.id1], motions[joint.id2]
    moved = lambda points, by: points @ by[0].T + by[1]
    midway = lambda points: (moved(points, one) + moved(points, other)) / 2
    turn = (one[0] + other[0]) / 2
    out, along = (turn @ np.array([*v]) for v in (joint.geom.normal, joint.geom.tangent))
    axes = np.array([out, along, np.cross(out, along)])
    forces = rows(joint.phys.stress) * np.array(joint.geom.areas)[:, None] @ axes  # on the first
    u, v = nodes[joint.id1], nodes[joint.id2]
    sign = 1 if u < v else -1
    reference = rows(joint.geom.polygon)
    normal = -sign * out / np.linalg.norm(out)  # towards the block of the lower number
    if areasOf(reference)[0] @ normal < 0:
        reference = reference[::-1]
    corners = midway(reference)
    forces = sign * _sharesOf(midway(rows(joint.geom.centres)), corners).T @ forces
    gaps = sign * (moved(reference, one) - moved(reference, other)) @ normal
    first = corners[1] - corners[0]
    first -= first @ normal * normal
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    edge = _edgeOf(problem, corners, forces, gaps, (first, second, normal))
    return str(min(u, v)), str(max(u, v)), edge


def _sharesOf(points, corners):
    """Shares (n, k) of corners of a convex polygon in forces at points of it, which keep forces and
    moments: those in the triangle of two corners and the middle."""
    count = len(corners)
    middle = corners.mean(axis=0)
    shares = []
    for at in points:
        found = []
        for k in range(count):
            sides = np.array([corners[k], corners[(k + 1) % count]]) - middle
            a, b = np.linalg.lstsq(sides.T, at - middle, rcond=None)[0]
            found.append((min(a, b, 1 - a - b), k, a, b))
        _, k, a, b = max(found)
        own = np.full(count, (1 - a - b) / count)
        own[k] += a
        own[(k + 1) % count] += b
        shares.append(own)
    return np.array(shares)


def _edgeOf(problem, corners, forces, gaps, axes):
    """Attributes of an edge as LMGC90 leaves them in compas_dem, where the signs of
    ``force_tangent2`` and ``c_v`` differ.

    :param axes: both tangents and the normal
    """
    first, second, normal = axes
    along, across, pressed = (forces @ axis for axis in axes)
    shear = np.hypot(along, across)
    area = np.linalg.norm(areasOf(corners)[0])
    strength = problem.friction * pressed + problem.cohesion * area / len(corners)
    status = np.where(pressed <= 0, "noct", np.where(shear > 0.999 * strength, "slid", "stic"))
    places, sizes = corners.tolist(), np.linalg.norm(forces, axis=1)
    frames = [_frame(corner, first, normal) for corner in corners]
    components = [
        dict(c_np=max(n, 0.0), c_nn=max(-n, 0.0), c_u=a, c_v=b)
        for n, a, b in zip(pressed.tolist(), along.tolist(), across.tolist())
    ]
    contact = _typed(
        "compas_dem.interactions/FrictionContact",
        points=[{"dtype": "compas.geometry/Point", "data": place} for place in places],
        frame=_frame(corners[0], first, second),
        size=float(area),
        mesh=None,
        name="FrictionContact",
        forces=components,
    )
    return dict(
        contact_point=places,
        force_normal=pressed.tolist(),
        force_tangent1=along.tolist(),
        force_tangent2=(-across).tolist(),
        gap=gaps.tolist(),
        status=status.tolist(),
        force_magnitude=float(sizes.sum()),
        force_vector=forces.tolist(),
        force=forces.sum(axis=0).tolist(),
        face_contact=True,
        point_contact=False,
        edge_contact=False,
        contact_frame=frames[0],
        contact_frames=frames,
        contact_polygon=_typed("compas.geometry/Polygon", points=places),
        contact_data=contact,
    )
