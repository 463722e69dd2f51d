# SPDX-License-Identifier: GPL-2.0-or-later
"""A problem of compas_dem under its weight and loads, until it is at rest, and its results in a file
that compas_dem reads.

    yade -n -x scripts/compas.py DEM_problem.json DEM_results.json

Blocks are rigid, and joints have their points at corners and half way, as contacts of compas_dem
do. The weight always acts, as in the solvers of compas_dem, whatever ``gravity`` says. Then come
horizontal body forces, and last displacements of supports. The file has what LMGC90 leaves there:
contact forces [N] at the corners of each contact, on the block of the lower number, and
transformations of blocks. The barrel vault of compas_dem takes 2 s.
"""

import json
import math
import os
from dataclasses import replace

import numpy as np
from masonry import AT_REST, Scene, bricks, materials
from masonry.bricks.compas_files import contentOf, kindOf
from masonry.errors import Refused
from masonry.arguments import isNumber, shown
from masonry.scene.options import parser
from masonry.texts import MISREAD
from masonry.units import GRAVITY
from yade import O

STIFFNESS = 1e12  # [Pa/m] of joints of rigid blocks, if the problem has no k_n
AT_MOST = 1e-3  # share of the loads that supports do not carry
WAITS = 20  # times that rest is waited for
NOTHING = 1e-9  # force of a contact over the largest one, below which it is none


def point(value, what):
    """Three numbers of a point or vector of COMPAS. Raises Refused."""
    row = contentOf(value)
    if not isinstance(row, list) or len(row) != 3 or not all(map(isNumber, row)):
        raise Refused(f"{what} {shown(row)} must be three numbers")
    if not all(map(math.isfinite, row)):
        raise Refused(f"{what} {shown(row)} must be finite")
    return np.array(row, float)


class Problem:
    """What a file asks for: ``bricks``, ``masonry``, what is held, loaded and moved. Refuses what
    cannot be said here, by its name.

    :ivar held: by the number of a block the axes along and about which it is held
    :ivar moved: by the number of a block its displacement [m]
    :ivar loads: triples of the number of a block, the force [N], and its point [m]
    """

    def __init__(self, path):
        self.file = bricks.readCompas(path)
        self.problems, stones = [], self.file.stones
        self.bricks = bricks.fromFile(path)
        if not self.file.conditions:
            self.problems.append("it has no boundary_conditions: is it a Problem of compas_dem?")
        if len(self.bricks) != len(stones):
            self.problems.append(f"{len(stones)} elements are {len(self.bricks)} solids")
        self.blocks = {stone.node: n for n, stone in enumerate(stones)}
        self.held = {n: "xyzXYZ" for n, stone in enumerate(stones) if stone.isSupport}
        self.moved, self.loads = {}, []
        refuse(path, self.problems)
        self.takeConditions(**self.file.conditions)
        self.masonry = self.materialsOf(**self.file.contact)
        if not self.held:
            self.problems.append("no block is held")
        refuse(path, self.problems)

    def materialsOf(self, contact_model=None, joint_model=None, **others):
        """Joints of the contact model, and a unit for each density."""
        if joint_model:
            self.problems.append(
                "joint_model: kn and kt [N/m] are of a contact, whatever its area; say k_n and k_t"
                " of MohrCoulomb [Pa/m]"
            )
        if kindOf(contact_model) != "MohrCoulomb":
            self.problems.append(f"contact_model {kindOf(contact_model)}: must be MohrCoulomb")
            return None
        said = contentOf(contact_model)
        phi, self.friction = said.get("phi"), said.get("mu")
        if phi is not None:
            self.friction = math.tan(math.radians(phi))
        normal = said.get("k_n") or STIFFNESS
        shear = said.get("k_t") or 0.4 * normal
        densities = [stone.material.get("density") for stone in self.file.stones]
        missing = [n for n, density in enumerate(densities) if not density]
        if missing or self.friction is None:
            self.problems += [f"element {n}: its material has no density" for n in missing[:1]]
            self.problems += ["MohrCoulomb: neither phi nor mu"] * (self.friction is None)
            return None
        of = lambda density: materials.dry(self.friction, normal, shear, density)
        kinds = {density: f"stone of {density:g} kg/m³" for density in densities}
        kinds[densities[0]] = "block"
        self.bricks = bricks.Bricks(
            [replace(block, kind=kinds[rho]) for block, rho in zip(self.bricks, densities)]
        )
        units = {kind: of(density).unit for density, kind in kinds.items() if kind != "block"}
        masonry = replace(of(densities[0]), units=units)
        self.cohesion, tension = said.get("c") or 0.0, said.get("t_c") or 0.0
        for joint in masonry.joints.values():
            joint.cohesion, joint.tensileStrength = self.cohesion, tension
        self.hasBond = bool(self.cohesion or tension)
        return masonry

    def takeConditions(
        self,
        gravity=False,
        g=GRAVITY,
        body_forces=(),
        point_loads=(),
        surface_loads=(),
        displacements=(),
        name=None,
        **others,
    ):
        """Loads and supports of the boundary conditions."""
        self.problems += [f"{key} is not known here" for key in others]
        if not gravity:
            print("note: gravity is False; the weight acts, as in the solvers of compas_dem")
        bodies = [point(one, "body_forces") for one in body_forces]
        self.body = sum(bodies, np.zeros(3))  # [m/s²]
        self.gravity = g - self.body[2]
        if self.gravity < 0:
            self.problems.append(f"body_forces lift the blocks by {-self.gravity:g} m/s²")
        for load in point_loads:
            n = self.blockOf(load, "point_loads")
            if load.get("moment") and any(load["moment"]):
                self.problems.append(f"point_loads: moment on block {n}: say force and point")
            if load.get("loading_type", "ramp") != "ramp":
                self.problems.append(f"point_loads: loading_type {load['loading_type']} is no ramp")
            at = load.get("point")
            at = None if at is None else point(at, "point_loads: point [m]")
            self.loads.append((n, point(load["force"], "point_loads: force [N]"), at))
        for load in surface_loads:
            corners = contentOf(load["polygon"])["points"]
            areas, middle = areasOf(np.array([point(one, "polygon") for one in corners]))
            size = np.linalg.norm(areas)
            towards = load.get("direction")
            towards = areas / size if towards is None else point(towards, "direction")
            force = load["magnitude"] * size * towards
            self.loads.append((self.blockOf(load, "surface_loads"), force, middle))
        self.takeDisplacements(displacements)

    def takeDisplacements(self, displacements):
        asked = {}  # later numbers replace earlier ones, as in compas_dem
        for one in displacements:
            own = asked.setdefault(self.blockOf(one, "displacements"), 6 * [None])
            row = [*(one.get("translation") or 3 * [None]), *(one.get("rotation") or 3 * [None])]
            own[:] = [old if new is None else float(new) for old, new in zip(own, row)]
        for n, row in asked.items():
            axes = "".join(axis for axis, value in zip("xyzXYZ", row) if value is not None)
            if axes:
                self.held.setdefault(n, axes)
            if any(row[3:]):
                self.problems.append(f"displacements: rotation of block {n}: supports do not turn")
            if any(row[:3]):
                self.moved[n] = np.array([value or 0.0 for value in row[:3]])

    def blockOf(self, entry, where):
        number = entry["block_index"]
        if number not in self.blocks:
            self.problems.append(f"{where}: block_index {number}: there is no such block")
        return self.blocks.get(number, 0)


def refuse(path, problems):
    if problems:
        raise Refused(f"{path}: " + "; ".join(problems))


def areasOf(corners):
    """Normal of a polygon times its area [m²], and its middle [m]."""
    parts = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0]) / 2
    areas = parts.sum(axis=0)
    shares = parts @ areas / (areas @ areas)
    return areas, shares @ (corners[0] + corners[1:-1] + corners[2:]) / 3


def run(problem, args):
    """Builds the scene and runs it. Returns it."""
    bond = {"joints": "brittle"} if problem.hasBond else {}
    scene = Scene(
        "compas",
        problem.bricks,
        problem.masonry,
        plane=False,
        gravity=problem.gravity,
        arguments=args,
        points="3,3",
        **bond,
    )
    for k, (n, force, at) in enumerate(problem.loads):
        loaded = scene.handle(n, name=f"load_{k}")
        if at is not None:
            loaded.point = tuple(at)
        scene.load(loaded, tuple(force))
    held = {n: scene.hold(n, name=f"held_{n}", axes=axes) for n, axes in problem.held.items()}
    rest(scene)
    if sideways := math.hypot(*problem.body[:2]):
        scene.lean(sideways / GRAVITY, towards=(*problem.body[:2], 0))
        rest(scene)
    if problem.moved:
        by = {held[n].recorded: 1e3 * path for n, path in problem.moved.items()}
        along = [lambda x, y, z, i=i: float(by[x, y, z][i]) for i in range(3)]
        scene.move([held[n] for n in problem.moved], *along)
        rest(scene)
    return scene


def rest(scene):
    """Waits until supports carry all loads but a thousandth."""
    for _ in range(WAITS):
        if scene.settle() != AT_REST or scene.model.supports.unrest()[0] < AT_MOST:
            return


# -- results ---------------------------------------------------------------------------------------


def typed(kind, **data):
    return {"dtype": kind, "data": data}


def frame(at, xaxis, yaxis):
    values = dict(point=at.tolist(), xaxis=xaxis.tolist(), yaxis=yaxis.tolist())
    return typed("compas.geometry/Frame", **values)


def writeResults(path, problem):
    """The file of the problem with a transformation for each node, and contacts for each edge."""
    graph = contentOf(contentOf(contentOf(problem.file.data)["model"])["graph"])
    turns = {n: motionOf(O.bodies[n].state) for n in range(len(problem.bricks))}
    for stone, (turn, shift) in zip(problem.file.stones, turns.values()):
        matrix = np.block([[turn, shift[:, None]], [np.zeros(3), 1.0]]).tolist()
        kind = "compas.geometry/Transformation"
        graph["node"][str(stone.node)]["transformation"] = typed(kind, matrix=matrix)
    edges = graph["edge"]
    for ends in edges.values():  # of another run
        ends.update({v: {"contacts": edge.get("contacts")} for v, edge in ends.items()})
    joints = [contactOf(problem, i, turns) for i in O.interactions if i.isReal]
    largest = max(joint["force_magnitude"] for *_, joint in joints)
    for u, v, contact in joints:
        if contact["force_magnitude"] > NOTHING * largest:
            ends = (v, u) if u in edges.get(v, ()) else (u, v)
            edges.setdefault(ends[0], {}).setdefault(ends[1], {}).update(contact)
    with open(path, "w") as file:
        json.dump(problem.file.data, file)


def motionOf(state):
    """Rotation (3, 3) and shift (3,) that take a body from where it was built to where it is."""
    turn = np.array((state.ori * state.refOri.conjugate()).toRotationMatrix())
    return turn, np.array(state.pos) - turn @ np.array(state.refPos)


def contactOf(problem, joint, turns):
    """Nodes of a contact, the lower one first, and what the edge between them has."""
    rows = lambda vectors: np.array([[*v] for v in vectors])
    one, other = turns[joint.id1], turns[joint.id2]
    moved = lambda points, by: points @ by[0].T + by[1]
    midway = lambda points: (moved(points, one) + moved(points, other)) / 2
    turn = (one[0] + other[0]) / 2
    out, along = (turn @ np.array([*v]) for v in (joint.geom.normal, joint.geom.tangent))
    axes = np.array([out, along, np.cross(out, along)])
    forces = rows(joint.phys.stress) * np.array(joint.geom.areas)[:, None] @ axes  # on the first
    u, v = (problem.file.stones[n].node for n in (joint.id1, joint.id2))
    sign = 1 if u < v else -1
    reference = rows(joint.geom.polygon)
    normal = -sign * out / np.linalg.norm(out)  # towards the block of the lower number
    if areasOf(reference)[0] @ normal < 0:
        reference = reference[::-1]
    corners = midway(reference)
    forces = sign * sharesOf(midway(rows(joint.geom.centres)), corners).T @ forces
    gaps = sign * (moved(reference, one) - moved(reference, other)) @ normal
    first = corners[1] - corners[0]
    first -= first @ normal * normal
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    edge = edgeOf(problem, corners, forces, gaps, (first, second, normal))
    return str(min(u, v)), str(max(u, v)), edge


def sharesOf(points, corners):
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


def edgeOf(problem, corners, forces, gaps, axes):
    """Attributes of an edge as LMGC90 leaves them in compas_dem, where ``force_tangent2`` and
    ``c_v`` have other signs; ``axes``: both tangents and the normal."""
    first, second, normal = axes
    along, across, pressed = (forces @ axis for axis in axes)
    shear = np.hypot(along, across)
    area = np.linalg.norm(areasOf(corners)[0])
    strength = problem.friction * pressed + problem.cohesion * area / len(corners)
    status = np.where(pressed <= 0, "noct", np.where(shear > 0.999 * strength, "slid", "stic"))
    places, sizes = corners.tolist(), np.linalg.norm(forces, axis=1)
    frames = [frame(corner, first, normal) for corner in corners]
    components = [
        dict(c_np=max(n, 0.0), c_nn=max(-n, 0.0), c_u=a, c_v=b)
        for n, a, b in zip(pressed.tolist(), along.tolist(), across.tolist())
    ]
    contact = typed(
        "compas_dem.interactions/FrictionContact",
        points=places,
        frame=frame(corners[0], first, second),
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
        contact_polygon=typed("compas.geometry/Polygon", points=places),
        contact_data=contact,
    )


def main(words=None):
    """Runs the problem that the words of a command line name; None: those of this program."""
    options = parser(__doc__, until=None)
    options.add_argument("problem", help="file of a Problem of compas_dem")
    options.add_argument("results", help="file that is written")
    args = options.parse_args(words)
    try:
        problem = Problem(args.problem)
    except MISREAD as error:
        options.error(str(error) or type(error).__name__)
    if not os.path.isdir(os.path.dirname(os.path.abspath(args.results))):
        options.error(f"{args.results}: there is no such folder")
    scene = run(problem, args)
    if scene.ended == AT_REST:
        writeResults(args.results, problem)
    else:
        print(f"note: the structure is not at rest, so {args.results} is not written")
    scene.finish()


if __name__ == "__main__":
    main()
