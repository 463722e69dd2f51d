# SPDX-License-Identifier: GPL-2.0-or-later
"""Closed outlines of a drawing: DXF, SVG, GeoJSON, or CSV with rows of name, x and z."""

import json
import os
import re
from collections import defaultdict
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ...packages import needed
from ...texts import TextFile
from ..block_files import readBy

#: Sagitta of the chords that stand for the curves of a DXF file, over the size of the curve [-].
FLATTENED = 1e-3

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


@dataclass(eq=False)
class Outline:
    """An outline as it is drawn.

    :ivar ring: corners (x, z), (n, 2), the first not repeated
    :ivar closed: whether the drawing says that it is closed
    """

    name: str
    ring: Any
    closed: bool = True


def read(path: str, layer: str | None) -> list[Outline]:
    """The outlines of a file, in its units, z upwards. Raises ValueError for a file that cannot be
    read.

    :param layer: only those of this layer of a DXF file, or group of an SVG file
    """
    readers = {".csv": _csv, ".dxf": _dxf, ".geojson": _geoJson, ".json": _geoJson, ".svg": _svg}
    ending = os.path.splitext(path)[1].lower()
    if layer is not None and ending in (".csv", ".geojson", ".json"):
        raise ValueError(f"{path}: files that end with {ending} have no layers")
    found = readBy(readers, path, layer)
    if not found:
        raise ValueError(f"{path}: no outlines" + (f" in layer {layer!r}" if layer else ""))
    for outline in found:
        ring = np.asarray(outline.ring, float)
        if ring.ndim != 2 or not np.isfinite(ring).all():
            raise ValueError(
                f"{path}: outline {outline.name} has a corner that is not of two finite numbers"
            )
        ring = ring[:, :2]
        same = np.all(ring == np.roll(ring, 1, axis=0), axis=1)
        outline.closed |= bool(same[0])
        outline.ring = ring[~same]
    return found


def _csv(path, layer):
    file = TextFile(path)
    table, order = file.table(), (0, 1, 2)
    if table.heads:
        names = [cell.lower() for cell in table.heads[-1].cells]
        up = "z" if "z" in names else "y"
        if len(set(names)) != 3 or not {"x", up} < set(names):
            raise file.refused(
                f"the columns {', '.join(names)} must be a name, x and z", table.heads[-1].line
            )
        order = *(k for k in range(3) if names[k] not in ("x", up)), *map(names.index, ("x", up))
    rings = defaultdict(list)
    for row in table.rows:
        if len(row.cells) != 3:
            raise file.refused(f"{', '.join(row.cells)} is not name,x,z", row.line)
        name, x, z = (row.cells[k] for k in order)
        rings[name].append((file.number(x, row.line), file.number(z, row.line)))
    return [Outline(name, ring) for name, ring in rings.items()]


def _geoJson(path, layer):
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    features = data.get("features", [data])
    for n, feature in enumerate(features):
        shape = feature.get("geometry", feature)
        names = feature.get("properties") or {}
        name = str(feature.get("id", names.get("name", n)))
        kind, rings = shape.get("type"), shape.get("coordinates")
        if kind not in ("Polygon", "MultiPolygon"):
            raise ValueError(f"feature {name} is a {kind}, not a Polygon")
        for polygon in [rings] if kind == "Polygon" else rings:
            if len(polygon) > 1:
                raise ValueError(f"feature {name} has a hole: a stone has none")
            yield Outline(name, [point[:2] for point in polygon[0]])


def _dxf(path, layer):
    ezdxf = needed("ezdxf")
    from ezdxf.path import make_path

    try:
        lines = ezdxf.readfile(path).modelspace().query("LWPOLYLINE POLYLINE SPLINE CIRCLE ELLIPSE")
    except ezdxf.DXFError as error:
        raise ValueError(error) from None
    for entity in lines:
        if layer in (None, entity.dxf.layer):
            curve = make_path(entity)
            corners = np.array([tuple(v)[:2] for v in curve.control_vertices()])
            fine = FLATTENED * np.ptp(corners, axis=0).max() or 1.0
            ring = [tuple(v)[:2] for v in curve.flattening(fine)]
            yield Outline(f"{entity.dxftype()} {entity.dxf.handle}", ring, curve.is_closed)


def _svg(path, layer):
    root = ElementTree.parse(path).getroot()
    return _inGroup(root, np.diag([1.0, -1.0, 1.0]), layer is None, layer)


def _inGroup(element, matrix, wanted, layer):
    """Outlines of an element of SVG and of what is in it. SVG counts z downwards.

    :param matrix: (3, 3), from the coordinates of the element around it
    :param wanted: whether a group around it is the layer
    """
    tag = element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
    if tag in ("defs", "clipPath", "symbol", "marker", "pattern"):
        return
    names = [value for key, value in element.items() if key.rpartition("}")[2] in ("id", "label")]
    wanted = wanted or layer in names
    for word, numbers in re.findall(r"(\w+)\s*\(([^)]*)\)", element.get("transform", "")):
        matrix = matrix @ _matrix(word, [float(n) for n in re.findall(_NUMBER, numbers)])
    name = names[0] if names else tag
    for ring, closed in _drawn(element, tag, name) if wanted else ():
        yield Outline(name, np.column_stack([ring, np.ones(len(ring))]) @ matrix[:2].T, closed)
    for child in element:
        yield from _inGroup(child, matrix, wanted, layer)


def _matrix(word, numbers):
    if word == "translate":
        numbers = 1, 0, 0, 1, *numbers, *[0] * (2 - len(numbers))
    elif word == "scale":
        numbers = numbers[0], 0, 0, numbers[-1], 0, 0
    elif word != "matrix":
        raise ValueError(f"transform {word} is not known here: translate, scale and matrix are")
    return np.vstack([np.reshape(numbers, (3, 2)).T, [0, 0, 1]])


def _drawn(element, tag, name):
    """Corners (n, 2) of each outline of an element, and whether it is closed."""
    number = lambda key: float(element.get(key, 0))
    if tag in ("polygon", "polyline"):
        numbers = [float(n) for n in re.findall(_NUMBER, element.get("points", ""))]
        yield np.reshape(numbers, (-1, 2)), tag == "polygon"
    elif tag == "rect":
        x, y, width, height = map(number, ("x", "y", "width", "height"))
        yield np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)]), True
    elif tag in ("circle", "ellipse"):
        raise ValueError(f"{tag} {name} is a curve: make it a path of straight lines")
    elif tag == "path":
        yield from _subpaths(element.get("d", ""), name)


def _subpaths(text, name):
    tokens = re.findall(rf"[A-Za-z]|{_NUMBER}", text)[::-1]
    at, ring, word = (0.0, 0.0), [], ""
    while tokens:
        if tokens[-1].isalpha():
            word = tokens.pop()
        if word not in tuple("MmLlHhVvZz"):
            raise ValueError(
                f"path {name} has the command {word or tokens[-1]!r}, a curve or none: make it one"
                " of straight lines"
            )
        if word in "Zz":
            if ring:
                yield np.array(ring), True
                at, ring = ring[0], []
            if tokens and not tokens[-1].isalpha():
                raise ValueError(f"path {name} has a number behind {word!r}")
            continue
        if word in "Mm" and ring:
            yield np.array(ring), False
            ring = []
        here = at if word.islower() else (0.0, 0.0)
        x = here[0] + float(tokens.pop()) if word not in "Vv" else at[0]
        z = here[1] + float(tokens.pop()) if word not in "Hh" else at[1]
        if word not in "Mm" and not ring:
            ring = [at]  # a path that goes on from where it was closed
        at = x, z
        ring.append(at)
        word = {"M": "L", "m": "l"}.get(word, word)
    if len(ring) > 1:
        yield np.array(ring), False
