# SPDX-License-Identifier: GPL-2.0-or-later
"""Problems of compas_dem as bricks, masonry, supports and loads of a scene."""

import math
import os
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arguments import FilePath, isNumber, shown, validated
from ..bricks import Bricks, fromFile, readCompas
from ..bricks.compas_files import CompasFile, contentOf, kindOf
from ..errors import Refused, refuse
from ..materials import dry
from ..materials.kinds import RIGID
from ..terminal import say
from ..texts import MISREAD, printable
from ..units import GRAVITY
from .history import MAX_DISPLACEMENT

STIFFNESS = 1e12  # [Pa/m] of joints of rigid blocks, if the problem has no k_n
MAX_LEAN = 1000  # [g] as :func:`masonry.stages.lean`
#: Contacts of compas_dem have their points at corners, and so have joints of three by three points.
POINTS = "3,3"


@dataclass
class Problem:
    """What a problem of compas_dem asks for. Blocks have their numbers in the file.

    :ivar held: by the number of a block the axes along and about which it is held
    :ivar moved: by the number of a held block its displacement [m]
    :ivar loads: the number of a block, the force [N], and its point [m] or None: the middle
    :ivar body: horizontal body forces are the first two [m/s²]
    :ivar gravity: downwards, with vertical body forces [m/s²]
    :ivar options: of the scene
    :ivar problems: what cannot be said here
    """

    file: CompasFile
    bricks: Bricks
    masonry: Any = None
    friction: float = 0.0
    cohesion: float = 0.0
    held: dict[int, str] = field(default_factory=dict)
    moved: dict[int, tuple[float, ...]] = field(default_factory=dict)
    loads: list[tuple[int, tuple[float, ...], Any]] = field(default_factory=list)
    body: Any = (0.0, 0.0, 0.0)
    gravity: float = GRAVITY
    options: dict[str, Any] = field(default_factory=lambda: {"points": POINTS})
    problems: list[str] = field(default_factory=list)

    def blockAt(self, entry: dict[str, Any], where: str) -> int:
        """Number of the block of a load or displacement."""
        nodes = [stone.node for stone in self.file.stones]
        if entry["block_index"] in nodes:
            return nodes.index(entry["block_index"])
        self.problems.append(f"{where}: there is no block_index {shown(entry['block_index'])}")
        return 0


@validated
def readProblem(path: FilePath, results: FilePath) -> Problem:
    """A problem of compas_dem, whose results go to another file.

    :raises ValueError: with all that this solver cannot do, each by its name
    """
    if not os.path.isdir(os.path.dirname(os.path.abspath(results))):
        raise Refused(f"{results}: there is no such folder")
    file = readCompas(path)
    problem = Problem(file, fromFile(path))
    if not file.conditions:
        raise Refused(f"{path}: is no Problem of compas_dem: it has no boundary_conditions")
    if len(problem.bricks) != len(file.stones):
        raise Refused(f"{path}: {len(file.stones)} elements are {len(problem.bricks)} solids")
    if any(stone.node is None for stone in file.stones):
        raise Refused(f"{path}: an element has no node in the graph")
    problem.held = {n: "xyzXYZ" for n, stone in enumerate(file.stones) if stone.isSupport}
    try:
        _takeConditions(problem, **file.conditions)
        _takeContact(problem, **file.contact)
        _takeDensities(problem)
    except Refused:
        raise
    except MISREAD as error:
        raise Refused(
            f"{path}: cannot be read: {printable(error) or type(error).__name__}"
        ) from None
    if not problem.held:
        problem.problems.append("no block is held")
    refuse([*map(printable, problem.problems)], f"{path}: ", "; ")
    return problem


def _takeConditions(
    problem,
    gravity=False,
    g=GRAVITY,
    body_forces=(),
    point_loads=(),
    surface_loads=(),
    displacements=(),
    name=None,
    **others,
):
    problem.problems += [f"{key} is not known here" for key in others]
    if not gravity:
        say("note: gravity is False; the weight acts, as LMGC90 in compas_dem always has it")
    problem.body = sum((_numbers(one, "body_forces") for one in body_forces), np.zeros(3))
    problem.gravity = g - problem.body[2]
    if math.hypot(*problem.body) > MAX_LEAN * GRAVITY:
        problem.problems.append(f"body_forces {shown([*problem.body])} m/s² are above {MAX_LEAN} g")
    if problem.gravity < 0:
        problem.problems.append(f"body_forces lift the blocks by {-problem.gravity:g} m/s²")
    for load in point_loads:
        n, at = problem.blockAt(load, "point_loads"), load.get("point")
        if load.get("moment") and any(contentOf(load["moment"])):
            problem.problems.append(f"point_loads: moment on block {n}: say force and point")
        if load.get("loading_type", "ramp") != "ramp":
            problem.problems.append(f"point_loads: {shown(load['loading_type'])} is no ramp")
        at = None if at is None else tuple(_numbers(at, "point_loads: point [m]"))
        problem.loads.append((n, tuple(_numbers(load["force"], "point_loads: force [N]")), at))
    for load in surface_loads:
        corners = [_numbers(p, "polygon") for p in contentOf(load["polygon"])["points"]]
        areas, middle = areasOf(np.array(corners))
        size, towards = np.linalg.norm(areas), load.get("direction")
        if not size > 0:
            raise Refused("surface_loads: polygon without an area")
        towards = areas / size if towards is None else _numbers(towards, "direction")
        force = load["magnitude"] * size * towards
        problem.loads.append((problem.blockAt(load, "surface_loads"), tuple(force), tuple(middle)))
    asked = {}  # later numbers replace earlier ones, as in compas_dem
    for one in displacements:
        own = asked.setdefault(problem.blockAt(one, "displacements"), 6 * [None])
        row = [*(one.get("translation") or 3 * [None]), *(one.get("rotation") or 3 * [None])]
        for value in row:
            if not (value is None or isNumber(value) and abs(value) <= 1e-3 * MAX_DISPLACEMENT):
                raise Refused(
                    f"displacements: {shown(value)} must be None or a number within"
                    f" ±{1e-3 * MAX_DISPLACEMENT:g} m"
                )
        own[:] = [old if new is None else new for old, new in zip(own, row)]
    for n, row in asked.items():
        if axes := "".join(a for a, value in zip("xyzXYZ", row) if value is not None):
            problem.held.setdefault(n, axes)
        if any(row[3:]):
            problem.problems.append(f"displacements: rotation of block {n}: supports do not turn")
        if any(row[:3]):
            problem.moved[n] = tuple(value or 0.0 for value in row[:3])


def _takeContact(problem, contact_model=None, joint_model=None, name=None, **others):
    problem.problems += [f"{key} is not known here" for key in others]
    if joint_model:
        problem.problems.append(
            "joint_model: kn and kt [N/m] are of a contact whatever its area; say k_n and k_t of"
            " MohrCoulomb [Pa/m]"
        )
    found = contentOf(contact_model) or {}
    if kindOf(contact_model) != "MohrCoulomb":
        problem.problems.append(f"contact_model {kindOf(contact_model)}: must be MohrCoulomb")
    elif found.get("phi") is None and found.get("mu") is None:
        problem.problems.append("MohrCoulomb: neither phi nor mu")
    elif found.get("phi") is None:
        problem.friction = found["mu"]
    else:
        problem.friction = math.tan(math.radians(found["phi"]))


def _takeDensities(problem):
    """Joints of the contact model, and a unit for each density."""
    densities = [stone.material.get("density") for stone in problem.file.stones]
    if missing := [n for n, density in enumerate(densities) if not density]:
        problem.problems.append(f"block {missing[0]}: its material has no density")
    if problem.problems:
        return
    found = contentOf(problem.file.contact["contact_model"])
    normal = found.get("k_n") or STIFFNESS
    shear = found.get("k_t") or 0.4 * normal
    made = {rho: dry(problem.friction, normal, shear, rho, RIGID, 0.0) for rho in densities}
    kinds = {rho: f"stone of {rho:g} kg/m³" for rho in made}
    kinds[densities[0]] = "block"
    pairs = zip(problem.bricks, densities)
    problem.bricks = Bricks([replace(block, kind=kinds[rho]) for block, rho in pairs])
    units = {kinds[rho]: masonry.unit for rho, masonry in made.items() if kinds[rho] != "block"}
    problem.masonry = replace(made[densities[0]], units=units)
    problem.cohesion, tension = found.get("c") or 0.0, found.get("t_c") or 0.0
    if problem.cohesion or tension:
        problem.options["joints"] = "brittle"
        for joint in problem.masonry.joints.values():
            joint.cohesion, joint.tensileStrength = problem.cohesion, tension


def _numbers(value, what):
    """Three numbers of a point or vector of COMPAS. Raises Refused."""
    row = contentOf(value)
    if not isinstance(row, list) or len(row) != 3 or not all(map(isNumber, row)):
        raise Refused(f"{what} {shown(row)} must be three numbers")
    if not all(map(math.isfinite, row)):
        raise Refused(f"{what} {shown(row)} must be finite")
    return np.array(row, float)


def areasOf(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Normal of a plane polygon times its area [m²], and its middle [m]."""
    parts = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0]) / 2
    areas = parts.sum(axis=0)
    shares = parts @ areas / (areas @ areas)
    return areas, shares @ (corners[0] + corners[1:-1] + corners[2:]) / 3
