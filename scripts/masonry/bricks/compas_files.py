# SPDX-License-Identifier: GPL-2.0-or-later
"""Stones in JSON files of COMPAS: models of compas_model and compas_dem, problems of compas_dem,
assemblies of compas_assembly, meshes, boxes and polyhedra."""

import json
import math
from collections import Counter
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, Iterator

import numpy as np

from ..arguments import FilePath, isNumber, shown, validated
from ..errors import Refused
from ..texts import MISREAD, TextFile, printable

#: Corners of a box over half its sides, and its faces.
_BOX = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
_SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


@dataclass
class Stone:
    """A stone of a COMPAS file, where the transformations of its element, its groups and its model
    place it.

    :ivar name: of its element or mesh; empty: none
    :ivar points: (n, 3), in the unit of the file
    :ivar faces: tuples of point numbers
    :ivar digits: decimals of the numbers of the points; None: of a box
    :ivar node: number of its node in the graph of its model or assembly; None: none
    :ivar isSupport: whether the file says that it is a support
    :ivar material: what the file says of its material: density [kg/m³] and others
    """

    name: str
    points: Any
    faces: list[tuple[int, ...]]
    digits: float | None = None
    node: int | None = None
    isSupport: bool = False
    material: dict[str, Any] = field(default_factory=dict)


@dataclass
class CompasFile:
    """What a COMPAS file says.

    :ivar stones: in the order of the file
    :ivar conditions: boundary conditions of a problem: gravity, g, body_forces, point_loads,
        surface_loads, displacements
    :ivar contact: contact_model and joint_model of a problem, or None
    :ivar data: the whole file
    """

    stones: list[Stone]
    conditions: dict[str, Any]
    contact: dict[str, Any]
    data: Any

    def beside(self) -> Iterator[str]:
        """What the file says beside stones."""
        if supports := sum(stone.isSupport for stone in self.stones):
            yield f"supports ({supports})"
        for density in Counter(stone.material.get("density") for stone in self.stones):
            if density is not None:
                yield f"density {shown(density)} kg/m³"
        yield from (kindOf(model) for model in self.contact.values() if kindOf(model))
        yield from (
            key for key, value in self.conditions.items() if isinstance(value, list) and value
        )


@validated
def readCompas(path: FilePath) -> CompasFile:
    """Stones, supports, materials, contact properties and boundary conditions of a COMPAS file.

    :raises ValueError: if it is damaged, or with the name of a type that is not known here
    """
    try:
        data = json.loads("\n".join(TextFile(path).lines))
        stones = list(_stones(data, ""))
        problem = contentOf(data)
        of = lambda key: contentOf(problem.get(key) if isinstance(problem, dict) else None) or {}
        found = CompasFile(stones, of("boundary_conditions"), of("contact_properties"), data)
        [*found.beside()]  # reads all that it names
    except Refused:
        raise
    except MISREAD as error:
        raise Refused(f"{path}: cannot be read: {printable(error)}") from None
    if not stones:
        raise Refused(f"{path}: no mesh, box or polyhedron")
    return found


def kindOf(value: Any) -> str:
    """Name of the type of a value in COMPAS, without its package; empty: none."""
    kind = value.get("dtype") or value.get("datatype") if isinstance(value, dict) else None
    return str(kind or "").rpartition("/")[2]


def contentOf(value: Any) -> Any:
    """What a value of COMPAS holds, without its type."""
    while kindOf(value) and ("data" in value or "value" in value):
        value = value["data" if "data" in value else "value"]
    return value


def _stones(value, name):
    """The stones of a value, whose holder has a name."""
    if isinstance(value, list):
        for one in value:
            yield from _stones(one, name)
        return
    kind, data = kindOf(value), contentOf(value)
    if not isinstance(data, dict):
        if kind:
            raise ValueError(f"{kind} is no solid")
        return
    graph = contentOf(data.get("graph") or data.get("network") or data)
    if "model" in data:
        yield from _stones(data["model"], name)
    elif "elements" in data:
        yield from _ofModel(data)
    elif isinstance(graph, dict) and isinstance(graph.get("node"), dict):
        yield from _ofAssembly(graph)
    elif kind or "vertex" in data and "face" in data:
        yield _solid(value, _nameOf(data) or name)
    else:
        for one in data.values():
            yield from _stones(one, name)


def _nameOf(data):
    own = data.get("attributes")
    name = (own.get("name") if isinstance(own, dict) else None) or data.get("name")
    return name if isinstance(name, str) else ""


def _ofModel(data):
    """The stones of a model: its elements, but groups. The tree says which are in which group.
    Older files have lists of elements and materials, and call a geometry shape."""
    elements, materials = _byGuid(data["elements"]), _byGuid(data.get("materials") or {})
    places, graph = {}, contentOf(data.get("graph")) or {}

    def place(node, matrix):
        for child in node.get("children") or ():
            guid = child["element"]
            if guid not in elements:
                raise ValueError(f"the tree of the model has an element {shown(guid)} that is none")
            own = contentOf(elements[guid]).get("transformation")
            places[guid] = matrix @ _matrix(own)
            place(child, places[guid])

    whole = _matrix(data.get("transformation"))
    place((data.get("tree") or {}).get("root") or {}, whole)
    for ends in (graph.get("edge") or {}).values():
        for edge in ends.values():
            if edge.get("modifiers"):
                kinds = ", ".join(map(kindOf, edge["modifiers"]))
                raise ValueError(f"modifiers of elements ({kinds}) are not known here")
    nodes = {node["element"]: int(n) for n, node in (graph.get("node") or {}).items()}
    for guid, element in elements.items():
        kind, own = kindOf(element), contentOf(element)
        if kind == "Group":
            continue
        solid = own.get("geometry") or own.get("shape")
        if not solid:
            raise ValueError(f"element {_nameOf(own) or guid}: a {kind} without a mesh of its own")
        if guid not in places:  # of no group
            places[guid] = whole @ _matrix(own.get("transformation"))
        stone = _solid(solid, _nameOf(own), places[guid])
        stone.node, stone.isSupport = nodes.get(guid), own.get("is_support") is True
        material = own.get("material") or (data.get("element_material") or {}).get(guid)
        stone.material = contentOf(materials.get(material)) or {}
        yield stone


def _byGuid(values):
    return values if isinstance(values, dict) else {value["guid"]: value for value in values}


def _ofAssembly(graph):
    """The stones of an assembly: blocks at nodes of its graph, whose edges hold interfaces."""
    for number, node in graph["node"].items():
        if node.get("block"):
            stone = _solid(node["block"], "")
            stone.node, stone.isSupport = int(number), node.get("is_support") is True
            yield stone


def _solid(value, name, matrix=np.eye(4)):
    """The stone of a mesh, a box or a polyhedron, placed by a matrix (4, 4)."""
    kind, data, digits = kindOf(value), contentOf(value), None
    if "vertex" in data and "face" in data:
        points, faces, digits = _mesh(data)
    elif "vertices" in data and "faces" in data:
        rows = {n: dict(zip("xyz", row)) for n, row in enumerate(data["vertices"])}
        points, faces, digits = _mesh({"vertex": rows, "face": dict(enumerate(data["faces"]))})
    elif kind == "Box":
        frame = contentOf(data.get("frame")) or dict(
            point=(0, 0, 0), xaxis=(1, 0, 0), yaxis=(0, 1, 0)
        )
        at, x, y = (np.array(_numbers(frame[key], key)) for key in ("point", "xaxis", "yaxis"))
        z = np.cross(x, y)
        axes = np.array([axis / np.linalg.norm(axis) for axis in (x, np.cross(z, x), z)])
        sides = _numbers([data[key] for key in ("xsize", "ysize", "zsize")], "sides of a box")
        points, faces = at + np.array(_BOX) * sides @ axes, _SIDES
    else:
        raise ValueError(f"{kind or 'a value without dtype'} is no mesh, box or polyhedron")
    if digits is not None:
        digits -= math.log10(np.linalg.norm(matrix[:3, :3], 2))
    return Stone(_nameOf(data) or name, points @ matrix[:3, :3].T + matrix[:3, 3], faces, digits)


def _mesh(data):
    """Points, faces and decimals of a mesh."""
    usual = data.get("default_vertex_attributes") or data.get("dva") or {}
    keys, points = {str(key): n for n, key in enumerate(data["vertex"])}, []
    for key, vertex in data["vertex"].items():
        row = [vertex.get(axis, usual.get(axis, 0.0)) for axis in "xyz"]
        points.append(_numbers(row, f"vertex {key}"))
    faces = []
    for key, face in data["face"].items():
        if missing := [v for v in face if str(v) not in keys]:
            raise ValueError(f"face {key} has a vertex {missing[0]} that is none")
        faces.append(tuple(keys[str(v)] for v in face))
    decimals = (-Decimal(str(x)).as_tuple().exponent for point in points for x in point)
    return np.array(points, float).reshape(-1, 3), faces, max(decimals, default=0)


def _numbers(row, what):
    row = list(row)
    if len(row) != 3 or not all(isNumber(x) and math.isfinite(x) for x in row):
        raise ValueError(f"{what}: {shown(row)} is no point of three finite numbers")
    return row


def _matrix(value):
    """The matrix (4, 4) of a transformation; None: none."""
    if value is None:
        return np.eye(4)
    found = contentOf(value)
    found = found.get("matrix") if isinstance(found, dict) else None
    if found is None:
        raise ValueError(f"transformation: {kindOf(value) or shown(value)} has no matrix")
    matrix = np.array(found, float)
    turns = matrix.shape == (4, 4) and np.isfinite(matrix).all() and np.linalg.det(matrix[:3, :3])
    if not turns or (matrix[3] != (0, 0, 0, 1)).any():
        raise ValueError(f"transformation: {shown(found)} places no solid")
    return matrix
