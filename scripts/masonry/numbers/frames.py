# SPDX-License-Identifier: GPL-2.0-or-later
"""Frames for ParaView that MasonryVtkRecorder wrote, read again without YADE and VTK.

The Python modules of VTK (python3-vtk9 or python3-paraview) can end a process in which YADE runs
with a VTK of its own. MasonryVtkRecorder writes one kind of file, with all numbers appended and
compressed by zlib; before version 3 they were in base64.
"""

import base64
import glob
import os
import re
import struct
import zlib
from xml.etree import ElementTree
from typing import Annotated, Any, Sequence

import numpy as np

from ..arguments import FilePath, Names, number, oneOf, validated, whole
from ..errors import Refused
from .files import readWhole

#: Files of blocks, of joints, or of ties and springs.
Kind = Annotated[str, oneOf("blocks", "joints", "connectors")]
#: Number of a frame, from 0; negative numbers count from the end.
FrameNumber = Annotated[int, whole(-(10**9))]
TYPES = {"Float64": "f8", "Float32": "f4", "Int64": "i8", "Int32": "i4", "UInt8": "u1"}


@validated
def framePaths(directory: FilePath, kind: Kind) -> list[str]:
    """Paths of all frames of a run, in the order of time. Raises Refused if there is none."""
    pattern = os.path.join(glob.escape(os.fspath(directory)), kind + "_*.vt[up]")
    found = {path: re.search(r"_(\d+)\.vt[up]$", path) for path in glob.glob(pattern)}
    numbers = {path: int(match[1]) for path, match in found.items() if match}
    if not numbers:
        raise Refused(f"no file {kind}_*.vt? in {directory}")
    return sorted(numbers, key=lambda path: numbers[path])


@validated
def frameTimes(directory: FilePath) -> list[float]:
    """Times of all frames of a run, as joints.pvd has them [s]."""
    path = os.path.join(directory, "joints.pvd")
    return _read(path, lambda root, _: [float(s.get("timestep")) for s in root.iter("DataSet")])


@validated
def frameAt(directory: FilePath, time: Annotated[float, number("s")]) -> int:
    """Number of the frame nearest to a time [s], from 0."""
    return int(np.argmin(np.abs(np.array(frameTimes(directory)) - time)))


@validated
def readFrame(
    directory: FilePath, kind: Kind, number: FrameNumber = -1, names: Names | None = None
) -> dict[str, Any]:
    """A frame as a dict: ``points`` [m], ``cells`` (arrays of point numbers), and every data array.
    Raises Refused if there is no such frame, or if its file is damaged.

    :param names: of the arrays that are needed, ``points`` and ``cells`` among them; None: all
    """
    return _read(_pathOf(directory, kind, number), lambda *file: _frame(names, *file))


@validated
def readSurfaces(
    directory: FilePath, number: FrameNumber = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangles around the blocks of a frame, with points and cells as :func:`readFrame` numbers
    them.

    :returns: the corners of triangles, an array (n, 3) of point numbers; the cell of each; and
        whether cells are rigid blocks, else zones of deformable units, with sides inside the unit
    :raises Refused: as :func:`readFrame`
    """
    return _read(_pathOf(directory, "blocks", number), _surfaces)


def _pathOf(directory, kind, number):
    paths = framePaths(directory, kind)
    if not -len(paths) <= number < len(paths):
        raise Refused(f"no frame {number} in {directory}: there are {len(paths)}")
    return paths[number]


def _read(path, parsed):
    """What a function makes of the root of an XML file and of the bytes of its AppendedData. Raises
    Refused if it is damaged."""
    try:
        head, mark, appended = readWhole(path).partition(b"<AppendedData")
        return parsed(ElementTree.fromstring(head + b"</VTKFile>" * bool(mark)), appended)
    except OSError as error:
        raise Refused(f"cannot read {path}: {error.strerror}") from None
    except Exception as error:  # whatever a damaged file leads to
        raise Refused(
            f"cannot read {path}: it holds no frame ({type(error).__name__}: {error})"
        ) from None


def asFrame(found: Any, names: Sequence[str] | None = None) -> dict[str, Any]:
    """What ``MasonryVtkRecorder().joints()`` gives without a file, as :func:`readFrame` gives it.

    :param names: of the arrays that are needed, beside the cells; None: all, which takes twice as
        long
    """
    arrays = [name for name in names or found if name != "cells"]
    cells = [np.array(cell) for cell in found["cells"]]
    return {**{name: np.array(found[name]) for name in arrays}, "cells": cells}


POLYHEDRON, TETRAHEDRON = 42, 10  # numbers of VTK for the cells of blocks


def _surfaces(*file):
    piece, read = _opened(*file)
    cells = {a.get("Name"): read(a) for a in piece.findall("Cells/DataArray")}
    types, ends, corners = cells["types"], cells["offsets"], cells["connectivity"]
    rigid = types == POLYHEDRON
    if not (rigid | (types == TETRAHEDRON)).all():
        raise ValueError("its cells are neither polyhedra nor tetrahedra")
    sides = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    first = np.append(0, ends[:-1])
    zones = np.flatnonzero(~rigid)
    ofZones = corners[first[zones, None, None] + sides].reshape(-1, 3)
    found = [(ofZones, np.repeat(zones, len(sides)))]
    if "face_offsets" in cells:
        found.append(_newFaces(cells))
    else:
        found += _oldFaces(cells, np.flatnonzero(rigid))
    triangles, owners = map(np.concatenate, zip(*found))
    triangles = triangles.astype(int)
    if triangles.min() < 0 or triangles.max() >= int(piece.get("NumberOfPoints")):
        raise ValueError("its faces have points that are not there")
    return triangles, owners, rigid


def _oldFaces(cells, polyhedra):
    """Triangles of each polyhedron and their cell, as VTK wrote them before 9.4: the number of
    faces, then of each the number of corners, and these."""
    start = 0
    for cell in polyhedra:
        faces = cells["faces"][start : cells["faceoffsets"][cell]]
        start = cells["faceoffsets"][cell]
        found = faces[1:].reshape(-1, 4)
        if len(found) != faces[0] or (found[:, 0] != 3).any():
            raise ValueError(f"faces of cell {cell} are no triangles")
        yield found[:, 1:], np.full(len(found), cell)


def _newFaces(cells):
    """Triangles of all polyhedra and their cells, as later versions write them: corners by face,
    and faces by cell."""
    if (np.diff(cells["face_offsets"], prepend=0) != 3).any():
        raise ValueError("faces of its cells are no triangles")
    faces = cells["face_connectivity"].reshape(-1, 3)[cells["polyhedron_to_faces"]]
    ends = cells["polyhedron_offsets"]
    return faces, np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))


def _opened(root, appended):
    form = root.get("compressor"), root.get("byte_order")
    if form != ("vtkZLibDataCompressor", "LittleEndian"):
        raise ValueError("it was not written by MasonryVtkRecorder")
    encoding, _, data = appended.partition(b"_")
    isRaw = b'"raw"' in encoding
    if not (isRaw or b'"base64"' in encoding):
        raise ValueError("its numbers are not appended")
    letters = lambda count: count if isRaw else -(-count // 3) * 4  # of bytes in base64
    decode = lambda text: text if isRaw else base64.b64decode(text)
    taken = lambda at, count: (decode(data[at : at + letters(count)]), at + letters(count))
    size = {"UInt32": "I", "UInt64": "Q"}[root.get("header_type")]
    return root[0].find("Piece"), lambda array: _array(array, taken, size)


def _frame(names, root, appended):
    piece, read = _opened(root, appended)
    data = piece.findall("PointData/DataArray") + piece.findall("CellData/DataArray")
    found = {"points": piece.find("Points/DataArray"), **{a.get("Name"): a for a in data}}
    frame = {n: read(a) for n, a in found.items() if names is None or n in names}
    if names is not None and "cells" not in names:
        return frame
    frame["cells"] = []
    for kind in ("Verts", "Lines", "Polys") if root.get("type") == "PolyData" else ("Cells",):
        of = {a.get("Name"): a for a in piece.findall(f"{kind}/DataArray")}
        ends, corners = read(of["offsets"]), read(of["connectivity"])
        if not len(ends):
            continue
        if ends[-1] != len(corners) or corners.max() >= len(frame["points"]):
            raise ValueError("its cells have points that are not there")
        places = [0, *ends.tolist()]  # np.split does the same in ten times the time
        frame["cells"] += [corners[a:b] for a, b in zip(places, places[1:])]
    if not len(frame["points"]) or not frame["cells"]:
        raise ValueError("it has no points or no cells")
    return frame


def _array(array, taken, size):
    """The numbers of a DataArray, a row a tuple if it has several components.

    It is a head and the data, each encoded on its own. The head has the number of blocks, the bytes
    of a full block and of the last one before compression, and the compressed bytes of each.

    :param taken: function of a place and a number of bytes, which gives these, and the place behind
    """
    start, width = int(array.get("offset")), struct.calcsize(size)
    blocks = struct.unpack_from("<" + size, taken(start, width)[0])[0]
    head, start = taken(start, width * (3 + blocks))
    sizes = struct.unpack_from(f"<{3 + blocks}{size}", head)[3:]
    data, ends = taken(start, sum(sizes))[0], np.cumsum(sizes)
    parts = [zlib.decompress(data[b - n : b]) for n, b in zip(sizes, ends)]
    numbers = np.frombuffer(b"".join(parts), "<" + TYPES[array.get("type")])
    if numbers.dtype == np.float32:
        numbers = numbers.astype(float)  # sums are of doubles
    components = int(array.get("NumberOfComponents") or 1)
    return numbers.reshape(-1, components) if components > 1 else numbers
