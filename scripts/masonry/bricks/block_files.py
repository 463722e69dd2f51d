# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks from files of surface meshes: OBJ, OFF, STL, PLY, and JSON of COMPAS.

The formats are read here, COMPAS in :mod:`masonry.bricks.compas_files`: meshio refuses PLY whose
faces have colours or are called vertex_index, loses the names of groups (OBJ) and of solids (STL as
text), and takes triangles alone (OFF).
"""

import math
import os
import re
import struct
from collections import Counter, defaultdict
from dataclasses import dataclass
from decimal import Decimal

from typing import Annotated, Any

import numpy as np

from ..arguments import FilePath, number, validated
from ..errors import Refused
from ..terminal import say
from ..texts import MISREAD, TextFile, printable
from .blocks import FARTHEST, Block, Bricks, refuse
from .checks import components, where
from .compas_files import readCompas
from .geometry import FLAT
from .stones.mortar import closed

#: Distance of points that are the same over the size of the solid [-]; STL as bytes, and text of
#: six digits, round by less.
SAME = 1e-6

#: Angle about an edge between coinciding faces of two solids [rad]. Single precision turns the
#: smallest faces by less, and no solid has so sharp an edge.
COINCIDE = 1e-3

#: Largest share of a solid's smallest side by which rounded numbers may bend its faces [-].
ROUNDED = 0.02


@dataclass
class _Surface:
    """A surface as a file has it.

    :ivar points: (n, 3)
    :ivar faces: tuples of point numbers
    :ivar digits: most decimals of the numbers of the points; None: bytes
    """

    name: str
    points: Any
    faces: list[tuple[int, ...]]
    digits: int | None = None


@validated
def fromFile(
    path: FilePath,
    scale: Annotated[float, number("m", 0, 1e6, above=True)] = 1.0,
    kind: str = "block",
    mortar: Annotated[float, number("m", 0, 1)] = 0.0,
    tolerance: Annotated[float, number("m", 0, 1)] | None = None,
) -> Bricks:
    """Blocks from a file, one for each closed convex surface in it: a :class:`Bricks`, each block a
    brick of its own.

    Formats: ``.obj`` (each ``g`` or ``o`` is a group), ``.off``, ``.stl`` (as text, each ``solid``
    is a group, or as bytes), ``.ply``, and ``.json`` of COMPAS, of which :func:`readCompas` also
    gives supports, densities, contact properties and loads. Solids in one group may touch. Parts
    have the names of groups, or of the file; groups of one solid each whose names differ in a
    number at their end alone are one part. Faces run counter-clockwise seen from outside, or all of
    them clockwise. Where rounded numbers bend a face, it is made plane, with a note.

    :param scale: metres in one unit of the file; 0.001 if it is in millimetres
    :param kind: kind of the blocks
    :param mortar: largest thickness of the mortar between two faces that look at each other within
        20° [m]: they move to its middle, with all faces in line with them; 0: none
    :param tolerance: how far corners may be from the planes of their faces [m]; None: as the last
        digit of the file's numbers rounds them
    :raises ValueError: with every solid that is open, not convex or has a bent face, by its group
        and number, with the face and its place
    """
    problems, moved = [], []
    surfaces = readBy(_READERS, path)
    solids = [
        (surface.name, corners)
        for surface in surfaces
        for corners in _solids(surface, scale, tolerance, problems, moved)
    ]
    if moved and not problems:
        say(
            f"note: fromFile: {len(moved)} of {len(solids)} solids have bent faces, as rounded"
            f" numbers make them; their corners move by up to {max(moved):.2g} m"
        )
    names, bodies = zip(*solids) if solids else ((), ())
    names = _parts(names)
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


def _parts(names):
    """The parts of solids of some groups: of groups of one solid each whose names differ in a
    number at their end alone, what they have in common."""
    counts = Counter(names)
    stems = {name: re.sub(r"[\s_.#:-]*\d+$", "", name) for name in counts if counts[name] == 1}
    alike = Counter(stem for stem in stems.values() if stem)
    return [stems[name] if name in stems and alike[stems[name]] > 1 else name for name in names]


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
        raise ValueError(f"{path}: cannot be read: {printable(error)}") from None


def _plain(path):
    return os.path.splitext(os.path.basename(path))[0]


def _words(path):
    """Number and words of each line of a text, without what follows a # at its beginning or behind
    a blank."""
    lines, joined = TextFile(path).lines, ""
    for number, line in enumerate(lines, 1):
        if line.endswith("\\") and number < len(lines):
            joined += line[:-1] + " "
            continue
        words = re.split(r"(?:^|\s)#", joined + line)[0].split()
        joined = ""
        if words:
            yield number, words


def _readObj(path):
    points, groups, name, digits = [], defaultdict(list), _plain(path), 0
    for number, words in _words(path):
        what = words[0]
        if what == "v":
            points.append(_point(words[1:4], number))
            digits = max(digits, _decimals(words[1:4]))
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
    return [_Surface(name, np.array(points), faces, digits) for name, faces in groups.items()]


def _decimals(words):
    """Most decimals of the numbers of a point."""
    return max(-Decimal(word).as_tuple().exponent for word in words)


def _point(words, number):
    try:
        point = tuple(map(float, words))
    except ValueError:
        point = ()
    if len(point) != 3 or not all(map(math.isfinite, point)):
        raise ValueError(f"line {number}: {' '.join(words)} is no point of three finite numbers")
    return point


def _readOff(path):
    (_, (word, *head)), *lines = [*_words(path)] or [(0, [""])]
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
    digits = max((_decimals(words[:3]) for _, words in lines[:count]), default=0)
    yield _Surface(_plain(path), np.array(points), found, digits)


#: A triangle of STL as bytes.
_TRIANGLE = np.dtype([("normal", "<3f4"), ("points", "<9f4"), ("more", "<u2")])


def _readStl(path):
    with open(path, "rb") as file:
        content = file.read()
    isText = content[:80].lstrip()[:5].lower() == b"solid" and re.search(
        rb"\b(?:facet|vertex|endsolid)\b", content[:2000], re.I
    )
    if not isText:
        count = int.from_bytes(content[80:84], "little")
        if not 0 < count <= (len(content) - 84) // _TRIANGLE.itemsize:
            raise ValueError(
                f"neither text that starts with solid, nor bytes of the {count} triangles that it"
                " says it has"
            )
        triangles = np.frombuffer(content, _TRIANGLE, count, 84)
        points = triangles["points"].astype(float).reshape(-1, 3)
        yield _Surface(_plain(path), _finite(points), _triples(points))
        return
    points, name = None, ""
    for number, words in _words(path):
        what = words[0].lower()
        if what == "solid":
            name, points, digits = " ".join(words[1:]) or _plain(path), [], 0
        elif what == "vertex" and points is not None:
            points.append(_point(words[1:4], number))
            digits = max(digits, _decimals(words[1:4]))
        elif what == "endsolid" and points is not None:
            if len(points) % 3:
                raise ValueError(f"line {number}: solid {name} has a facet without three points")
            if points:
                yield _Surface(name, np.array(points), _triples(points), digits)
            points = None
    if points is not None:
        raise ValueError(f"solid {name} has no end")


def _triples(points):
    return [(n, n + 1, n + 2) for n in range(0, len(points), 3)]


def _finite(points):
    if not np.isfinite(points).all():
        raise ValueError("points must be three finite numbers each")
    return points


#: Types of numbers in PLY files; the older names and those with their size.
_TYPES = dict(zip("char uchar short ushort int uint float double".split(), "bBhHiIfd"))
_TYPES |= dict(zip("int8 uint8 int16 uint16 int32 uint32 float32 float64".split(), "bBhHiIfd"))
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}


def _readPly(path):
    with open(path, "rb") as file:
        content = file.read()
    head, end, body = content.partition(b"end_header")
    lines = head.decode("latin-1").split("\n")
    if lines[0].strip() != "ply" or not end:
        raise ValueError("does not start with ply, or its head has no end")
    body = body[body.index(b"\n") + 1 :]
    order, elements = None, []
    for words in filter(None, map(str.split, lines[1:])):
        if words[0] == "format":
            order = _ORDERS[words[1]]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            types = [_TYPES[word] for word in words[1 + (words[1] == "list") : -1]]
            elements[-1][2].append((words[-1], types))
    if order is None:
        raise ValueError("its head has no format")
    take = _asciiNumbers(body) if not order else _binaryNumbers(body, order)
    points, faces = np.zeros((0, 3)), []
    for name, count, properties in elements:
        if not 0 <= count <= len(body):
            raise ValueError(f"{count} of {name} in {len(body)} bytes")
        rows = [
            {key: take(types) for key, types in properties} if properties else {}
            for _ in range(count)
        ]
        if name == "vertex":
            points = _finite(np.array([[row[axis] for axis in "xyz"] for row in rows], float))
        elif name == "face":
            listed = [key for key, _ in properties if key.startswith("vertex_ind")]
            if not listed:
                raise ValueError("its faces have no vertex_indices")
            faces = [tuple(map(int, row[listed[0]])) for row in rows]
    if any(not 0 <= n < len(points) for face in faces for n in face):
        raise ValueError(f"a face has a point that is none of the {len(points)}")
    yield _Surface(_plain(path), points.reshape(-1, 3), faces)


def _asciiNumbers(body):
    """Function that takes the next number, or list of numbers, of a body."""
    words = iter(body.split())

    def take(types):
        try:
            first = float(next(words))
            return first if len(types) == 1 else [float(next(words)) for _ in range(int(first))]
        except StopIteration:
            raise ValueError("it ends before its last number") from None

    return take


def _binaryNumbers(body, order):
    at = 0

    def take(types):
        nonlocal at
        count = 1
        if len(types) == 2:
            [count] = struct.unpack_from(order + types[0], body, at)
            at += struct.calcsize(types[0])
        numbers = struct.unpack_from(f"{order}{count}{types[-1]}", body, at)
        at += count * struct.calcsize(types[-1])
        return numbers[0] if len(types) == 1 else numbers

    return take


def _readJson(path):
    found = readCompas(path)
    if beside := list(found.beside()):
        say(f"note: fromFile: {path} also has {', '.join(beside)}: bricks.readCompas gives them")
    names = [stone.name or _plain(path) for stone in found.stones]
    for n, (name, stone) in enumerate(zip(names, found.stones)):
        own = f"{name} {n}" if names.count(name) > 1 else name
        yield _Surface(own, stone.points, stone.faces, stone.digits)


_READERS = {
    ".obj": _readObj,
    ".off": _readOff,
    ".stl": _readStl,
    ".ply": _readPly,
    ".json": _readJson,
}


# -- from surfaces to solids -----------------------------------------------------------------------


def _solids(surface, scale, tolerance, problems, moved):
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
    if tolerance is None:  # the diagonal of half a unit in three coordinates, at two ends
        tolerance = (
            3**0.5 * 10.0**-surface.digits * scale if surface.digits is not None else 0.0
        )
    solids = defaultdict(list)
    for face, first in enumerate(components(len(faces), mates)):
        solids[first].append(face)
    for n, members in enumerate(solids.values()):
        solid = f"{name}, solid {n}"
        if corners := _corners(points, faces, numbers, members, solid, tolerance, problems, moved):
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


def _corners(points, faces, numbers, members, solid, tolerance, problems, moved):
    """Corners of a convex solid, without points inside a face or an edge; of another one None and a
    sentence. ``moved`` takes how far they were moved to make faces plane [m]."""
    used = sorted({n for face in members for n in faces[face]})
    own = points[used]
    exact = FLAT * np.linalg.norm(np.ptp(own, axis=0))
    polygons = {face: points[list(faces[face])] for face in members}
    # a face of no area, as some programs write for T-shaped edges, has no plane
    planes = {face: (_normal(polygon), polygon.mean(axis=0)) for face, polygon in polygons.items()}
    planes = {face: plane for face, plane in planes.items() if plane[0].any()}
    bends = {f: np.abs((polygons[f] - at) @ normal).max() for f, (normal, at) in planes.items()}
    beyond = {face: ((own - at) @ normal).max() for face, (normal, at) in planes.items()}
    isExact = max(0.0, *bends.values(), *beyond.values()) <= exact
    thinnest = min([np.ptp(own @ normal) for normal, _ in planes.values()], default=0.0)
    width = exact if isExact else max(exact, min(tolerance, ROUNDED * thinnest))
    for face in planes:
        place = where(planes[face][1])
        if bends[face] > width:
            problems.append(
                f"{solid}, face {numbers[face]} at {place}: bent by {bends[face]:.3g} m, not plane"
            )
            return None
        if beyond[face] > width:
            problems.append(
                f"{solid}, face {numbers[face]} at {place}: the solid reaches"
                f" {beyond[face]:.3g} m beyond its plane, so it is not convex"
            )
            return None
    # cosine of the angle between planes that are one
    same = 1 - 1e-6 if isExact else math.cos(4 * width / max(thinnest, 1e-300))
    merged, meeting = [], defaultdict(set)
    for face, (normal, middle) in planes.items():
        alike = lambda n, at: n @ normal > same and abs((middle - at) @ n) <= width
        k = next((k for k, plane in enumerate(merged) if alike(*plane)), len(merged))
        merged[k:] = merged[k:] or [(normal, middle)]
        for n in faces[face]:
            meeting[n].add(k)
    if len(merged) < 4:
        problems.append(f"{solid}: only {len(merged)} planes, so no volume")
        return None
    corners = [n for n in used if len(meeting[n]) >= 3]
    places = points[corners]
    if not isExact:
        places = _onPlanes(points, corners, meeting, len(merged))
        moved.append(float(np.linalg.norm(places - points[corners], axis=1).max()))
    return tuple(tuple(map(float, corner)) for corner in places)


def _onPlanes(points, corners, meeting, count):
    """Corners of a solid at the intersections of the planes of least squares through those of each
    face."""
    of = [[n for n in corners if k in meeting[n]] for k in range(count)]
    middles = np.array([points[members].mean(axis=0) for members in of])
    normals = np.array([np.linalg.svd(points[m] - middle)[2][2] for m, middle in zip(of, middles)])
    offsets = (normals * middles).sum(axis=1)
    found = []
    for n in corners:
        mine = sorted(meeting[n])
        away = offsets[mine] - normals[mine] @ points[n]
        found.append(points[n] + np.linalg.lstsq(normals[mine], away, rcond=1e-3)[0])
    return np.array(found)
