# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks from files of surface meshes: OBJ, OFF, STL, PLY, and JSON of COMPAS.

meshio reads PLY and binary STL; it loses the names of groups (OBJ) and of solids (STL as text),
takes triangles alone (OFF) and knows no COMPAS.
"""

import json
import math
import os
from collections import defaultdict, namedtuple

from typing import Annotated, Any

import numpy as np

from ..arguments import FilePath, number, validated
from ..errors import Refused
from ..packages import needed
from .blocks import FARTHEST, Block, Bricks, refuse
from .checks import components, where
from .geometry import FLAT
from .stones.mortar import closed

#: Distance of points that are the same over the size of the solid [-]; STL as bytes, and text of
#: six digits, round by less.
SAME = 1e-6

#: Angle about an edge between coinciding faces of two solids [rad]. Single precision turns the
#: smallest faces by less, and no solid has so sharp an edge.
COINCIDE = 1e-3

#: A surface as a file has it: name, points (n, 3), and faces, tuples of point numbers.
_Surface = namedtuple("_Surface", "name points faces")


@validated
def fromFile(
    path: FilePath,
    scale: Annotated[float, number("m", 0, 1e6, above=True)] = 1.0,
    kind: str = "block",
    mortar: Annotated[float, number("m", 0, 1)] = 0.0,
) -> Bricks:
    """Blocks from a file, one for each closed convex surface in it: a :class:`Bricks`, each block a
    brick of its own.

    Formats: ``.obj`` (each ``g`` or ``o`` is a group), ``.off``, ``.stl`` (as text, each ``solid``
    is a group, or as bytes), ``.ply``, and ``.json`` of COMPAS with meshes. Solids in one group may
    touch. Parts have the names of groups, or of the file. Faces run counter-clockwise seen from
    outside, or all of them clockwise.

    :param scale: metres in one unit of the file; 0.001 if it is in millimetres
    :param kind: kind of the blocks
    :param mortar: largest thickness of the mortar between two faces that look at each other within
        20° [m]: they move to its middle, with all faces in line with them; 0: none
    :raises ValueError: with every solid that is open, not convex or has a bent face, by its group
        and number, with the face and its place
    """
    problems = []
    surfaces = readBy(_READERS, path)
    solids = [
        (surface.name, corners)
        for surface in surfaces
        for corners in _solids(surface, scale, problems)
    ]
    names, bodies = zip(*solids) if solids else ((), ())
    if mortar and not problems:
        bodies = closed(bodies, mortar, problems)
    blocks = []
    for name, corners in zip(names, bodies):
        try:
            blocks.append(Block(corners, len(blocks), name, -1, kind))
        except ValueError as error:  # of its name
            problems.append(str(error))
    if not blocks and not problems:
        problems.append("no faces, so no solids")
    refuse(os.fspath(path), problems)
    return Bricks(blocks)


#: Errors of damaged files.
MISREAD = OSError, SyntaxError, ValueError, LookupError, TypeError, AttributeError, RecursionError


# -- formats ---------------------------------------------------------------------------------------


def readBy(readers: dict[str, Any], path: FilePath, *more: Any) -> list[Any]:
    """What the reader for the ending of a file finds in it. Raises ValueError."""
    ending = os.path.splitext(path)[1].lower()
    if ending not in readers:
        raise ValueError(f"{path}: must end with one of {', '.join(readers)}")
    if not os.path.isfile(path):
        raise ValueError(f"{path}: no such file")
    try:
        return list(readers[ending](path, *more) or ())
    except Refused:
        raise
    except MISREAD as error:
        raise ValueError(f"{path}: cannot be read: {error}") from None


def _plain(path):
    return os.path.splitext(os.path.basename(path))[0]


def _lines(path):
    """Number and words of each line of a text, without comments."""
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read().replace("\\\n", " ")
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].split()
        if words:
            yield number, words


def _readObj(path):
    points, groups, name = [], defaultdict(list), _plain(path)
    for number, words in _lines(path):
        what = words[0]
        if what == "v":
            points.append(_point(words[1:4], number))
        elif what in ("g", "o"):
            name = " ".join(words[1:]) or _plain(path)
        elif what == "f":
            face = []
            for word in words[1:]:
                n = int(word.split("/")[0])
                n = n - 1 if n > 0 else len(points) + n
                if not 0 <= n < len(points):
                    raise ValueError(
                        f"line {number}: face with point {word}, of {len(points)} so far"
                    )
                face.append(n)
            groups[name].append(tuple(face))
    return [_Surface(name, np.array(points), faces) for name, faces in groups.items()]


def _point(words, number):
    try:
        point = tuple(map(float, words))
    except ValueError:
        point = ()
    if len(point) != 3 or not all(map(math.isfinite, point)):
        raise ValueError(f"line {number}: {' '.join(words)} is no point of three finite numbers")
    return point


def _readOff(path):
    (_, (word, *head)), *lines = [*_lines(path)] or [(0, [""])]
    if not word.endswith("OFF"):
        raise ValueError("does not start with OFF")
    if word != "OFF":
        raise ValueError(f"{word} is a variant of OFF that is not known here")
    if not head:
        (_, head), *lines = lines
    count, faces = int(head[0]), int(head[1])
    if count < 0 or faces < 0 or len(lines) < count + faces:
        raise ValueError(f"{count} points and {faces} faces are told, fewer lines are there")
    points = [_point(words[:3], n) for n, words in lines[:count]]
    found = []
    for number, words in lines[count : count + faces]:
        face = tuple(map(int, words[1 : 1 + int(words[0])]))
        if len(face) != int(words[0]) or not all(0 <= n < count for n in face):
            raise ValueError(f"line {number}: a face with points {face} of {count}")
        found.append(face)
    yield _Surface(_plain(path), np.array(points), found)


def _readStl(path):
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        head = file.read(84)
    count = int.from_bytes(head[80:84], "little")
    if len(head) == 84 and size == 84 + 50 * count:
        yield from _byMeshio(path)
        return
    if not head.lstrip().startswith(b"solid"):
        raise ValueError(f"neither text that starts with solid, nor bytes of {count} triangles")
    points, name = None, ""
    for number, words in _lines(path):
        what = words[0].lower()
        if what == "solid":
            name, points = " ".join(words[1:]) or _plain(path), []
        elif what == "vertex" and points is not None:
            points.append(_point(words[1:4], number))
        elif what == "endsolid" and points is not None:
            if len(points) % 3:
                raise ValueError(f"line {number}: solid {name} has a facet without three points")
            faces = [(n, n + 1, n + 2) for n in range(0, len(points), 3)]
            if faces:
                yield _Surface(name, np.array(points), faces)
            points = None
    if points is not None:
        raise ValueError(f"solid {name} has no end")


def _byMeshio(path):
    meshio = needed("meshio")  # takes a second, and few scenes need it
    with open(path, "rb") as file:
        content = file.read()
    # meshio would look for it without end
    if content.startswith(b"ply") and b"end_header" not in content:
        raise ValueError("its head has no end")
    try:
        mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio ends the program for some files
        raise ValueError(f"meshio: {error or type(error).__name__}") from None
    points = np.asarray(mesh.points, float)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise ValueError("points must be three finite numbers each")
    faces = []
    for cells in mesh.cells:
        if cells.type not in ("triangle", "quad", "polygon"):
            raise ValueError(f"cells of type {cells.type} are no faces")
        faces += [tuple(int(n) for n in face) for face in cells.data]
    if any(not 0 <= n < len(points) for face in faces for n in face):
        raise ValueError(f"a face has a point that is none of the {len(points)}")
    yield _Surface(_plain(path), points, faces)


def _readJson(path):
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    found = list(_meshes(data, ""))
    if not found:
        raise ValueError("no mesh: nothing with both vertex and face")
    for n, (name, mesh) in enumerate(found):
        defaults = mesh.get("default_vertex_attributes") or mesh.get("dva") or {}
        keys = {key: k for k, key in enumerate(mesh["vertex"])}
        points = []
        for key, vertex in mesh["vertex"].items():
            point = [vertex.get(axis, defaults.get(axis, 0.0)) for axis in "xyz"]
            points.append(_point([str(x) for x in point], f"of vertex {key}"))
        faces = []
        for key, face in mesh["face"].items():
            missing = [v for v in face if str(v) not in keys]
            if missing:
                raise ValueError(f"face {key} has a vertex {missing[0]} that is none")
            faces.append(tuple(keys[str(v)] for v in face))
        name = name or (f"{_plain(path)} {n}" if len(found) > 1 else _plain(path))
        yield _Surface(name, np.array(points), faces)


def _meshes(data, name):
    """Every COMPAS mesh, with the name of it or its holder."""
    if isinstance(data, dict):
        own = data.get("attributes")
        own = own.get("name") if isinstance(own, dict) else None
        name = own or data.get("name") or name
        name = name if isinstance(name, str) else ""
        if isinstance(data.get("vertex"), dict) and isinstance(data.get("face"), dict):
            yield name, data
            return
        data = list(data.values())
    for value in data if isinstance(data, list) else ():
        yield from _meshes(value, name)


_READERS = {
    ".obj": _readObj,
    ".off": _readOff,
    ".stl": _readStl,
    ".ply": _byMeshio,
    ".json": _readJson,
}


# -- from surfaces to solids -----------------------------------------------------------------------


def _solids(surface, scale, problems):
    """Corners of each convex solid of a surface."""
    name = surface.name
    if not len(surface.points):
        problems.append(f"{name}: no points")
        return
    points = surface.points * scale
    far = np.abs(points).max()
    if not far <= FARTHEST:
        problems.append(
            f"{name}: a coordinate of {far:g} m is above {FARTHEST:g} m: is scale, metres in one"
            " unit of the file, right?"
        )
        return
    used = sorted({n for face in surface.faces for n in face})
    merge = _merged(points, used) if used else {}
    faces, numbers = [], []
    for number, face in enumerate(surface.faces):
        face = [merge[n] for n in face]
        face = tuple(p for k, p in enumerate(face) if p != face[k - 1])
        if len(face) >= 3 and len(set(face)) == len(face):
            faces.append(face)
            numbers.append(number)
        elif len(set(face)) > 2:
            problems.append(f"{name}, face {number}: comes back to one of its points")
    if not faces:
        problems.append(f"{name}: no faces")
        return
    # if all faces run clockwise, their volume is negative
    about = points[used].mean(axis=0)
    volume = sum(
        np.dot(points[f[0]] - about, np.cross(points[a] - about, points[b] - about))
        for f in faces
        for a, b in zip(f[1:], f[2:])
    )
    if volume < 0:
        faces = [face[::-1] for face in faces]
    mates, open_ = _mates(points, faces)
    for face, (a, b) in open_[:3]:
        middle = (points[a] + points[b]) / 2
        problems.append(
            f"{name}, face {numbers[face]}: an edge at {where(middle)} without a second face that"
            " runs the other way: the solid is open, or its faces run in different senses"
        )
    if len(open_) > 3:
        problems.append(f"{name}: {len(open_) - 3} more such edges")
    if open_:
        return
    solids = defaultdict(list)
    for face, first in enumerate(components(len(faces), mates)):
        solids[first].append(face)
    for n, members in enumerate(solids.values()):
        solid = f"{name}, solid {n}"
        if corners := _corners(points, faces, numbers, members, solid, problems):
            yield corners


def _merged(points, used):
    """For each point the number of the first one at its place."""
    from scipy.spatial import cKDTree

    merge = np.arange(len(points))
    width = SAME * np.ptp(points[used], axis=0).max()
    for a, b in sorted(cKDTree(points[used]).query_pairs(width) if width else ()):
        merge[[used[a], used[b]]] = min(merge[used[a]], merge[used[b]])
    return merge.tolist()


def _mates(points, faces):
    """Pairs of faces of a solid that share an edge, and edges without a second face.

    Where solids touch, an edge has more than two faces: the first one on the way from a face
    through the inside of its solid is of the same solid.
    """
    edges = defaultdict(list)
    for n, face in enumerate(faces):
        for edge in zip(face, face[1:] + face[:1]):
            edges[edge].append(n)
    normals = [_normal(points[list(face)]) for face in faces]
    mates, open_ = [], []
    for (a, b), here in edges.items():
        there = edges.get((b, a), [])
        if len(here) != len(there):
            open_ += [(n, (a, b)) for n in here[len(there) :]]
            continue
        if a > b:
            continue
        if len(here) == 1:
            mates.append((here[0], there[0]))
            continue
        along = points[b] - points[a]
        along = along / np.linalg.norm(along)
        taken = set()
        for n in here:
            # into the face, at right angles to the edge
            into = np.cross(normals[n], along)
            turn = lambda m: _turn(into, -normals[n], np.cross(normals[m], -along))
            best = min(there, key=turn)
            if best in taken:
                open_.append((n, (a, b)))
            taken.add(best)
            mates.append((n, best))
    return mates, open_


def _turn(into, inside, other):
    """Angle between faces about their edge through the inside of the solid; a whole turn if they
    coincide."""
    angle = math.atan2(np.dot(other, inside), np.dot(other, into))
    return angle if angle > COINCIDE else angle + 2 * math.pi


def _normal(polygon):
    arms = polygon - polygon.mean(axis=0)
    normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else normal


def _corners(points, faces, numbers, members, solid, problems):
    """Corners of a convex solid, without points inside a face or an edge; of another one None and
    a sentence."""
    used = sorted({n for face in members for n in faces[face]})
    own = points[used]
    width = FLAT * np.linalg.norm(np.ptp(own, axis=0))
    planes, meeting = [], defaultdict(set)
    for face in members:
        polygon = points[list(faces[face])]
        normal, middle = _normal(polygon), polygon.mean(axis=0)
        if not normal.any():
            continue  # of no area, as some programs write for T-shaped edges
        bent = np.abs((polygon - middle) @ normal).max()
        place = where(middle)
        if bent > width:
            problems.append(
                f"{solid}, face {numbers[face]} at {place}: bent by {bent:.3g} m, not plane"
            )
            return None
        beyond = ((own - middle) @ normal).max()
        if beyond > width:
            problems.append(
                f"{solid}, face {numbers[face]} at {place}: the solid reaches {beyond:.3g} m beyond"
                " its plane, so it is not convex"
            )
            return None
        alike = lambda n, at: n @ normal > 1 - 1e-6 and abs((middle - at) @ n) <= width
        k = next((k for k, plane in enumerate(planes) if alike(*plane)), len(planes))
        planes[k:] = planes[k:] or [(normal, middle)]
        for n in faces[face]:
            meeting[n].add(k)
    if len(planes) < 4:
        problems.append(f"{solid}: only {len(planes)} planes, so no volume")
        return None
    corners = (points[n] for n in used if len(meeting[n]) >= 3)
    return tuple(tuple(map(float, corner)) for corner in corners)
