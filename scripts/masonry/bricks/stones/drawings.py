# SPDX-License-Identifier: GPL-2.0-or-later
"""Closed outlines of a drawing: DXF (by ezdxf), SVG (by svgelements), GeoJSON, or CSV with rows of
name, x and z. What is no outline is counted by kind, and never left out in silence."""

import io
import json
import os
import re
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ...packages import needed
from ...terminal import say
from ...texts import TextFile
from ..block_files import readBy
from ..checks import components

#: Sagitta of the chords that stand for the curves of a DXF file, over the size of the curve [-];
#: number of chords for a curve of an SVG file, of at most half a turn.
FLATTENED, CHORDS = 1e-3, 32
#: Distance of points that are one, over the size of the drawing; and how far a drawing may be from
#: its plane [-].
SAME, BENT = 1e-6, 1e-3
#: Size of a drawing that may be in degrees of longitude and latitude.
DEGREES = 0.01
DEEPEST = 20  # blocks within blocks of a DXF file

#: Entities of DXF that are no part of a wall.
TEXTS = set(
    "TEXT MTEXT DIMENSION ARC_DIMENSION POINT LEADER MLEADER MULTILEADER ATTDEF ATTRIB VIEWPORT"
    " TOLERANCE IMAGE WIPEOUT XLINE RAY LIGHT SUN OLE2FRAME".split()
)
#: Elements of SVG that are drawn as outlines, where something names them, and not at all.
SHAPES = set("path polygon polyline rect circle ellipse line".split())
ASIDE = set("symbol marker pattern clipPath mask".split())
BESIDE = set("image text foreignObject".split())
MEASURES = "x y width height cx cy r rx ry x1 y1 x2 y2".split()  # attributes that are lengths
_LENGTH = re.compile(r"\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*(?:px|mm|cm|in|pt|pc)?\s*")
#: Units of length of SVG, and codes of $INSUNITS of DXF [m].
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "pt": 0.0254 / 72, "pc": 0.0254 / 6}
INSUNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 14: 0.1}


@dataclass(eq=False)
class Outline:
    """An outline as it is drawn.

    :ivar ring: corners (x, z), (n, 2), the first not repeated
    :ivar closed: whether the drawing says that it is closed
    """

    name: str
    ring: Any
    closed: bool = True


@dataclass
class Drawing:
    """What a file holds.

    :ivar outlines: in the file's units, z upwards
    :ivar unit: metres in one unit of the file; None: the file does not say it
    :ivar beside: number, by kind, of what is no outline and no part of a wall, such as texts
    :ivar lost: number, by kind, of what may be a part of the wall and cannot be read
    """

    outlines: list[Outline] = field(default_factory=list)
    unit: float | None = None
    beside: Counter = field(default_factory=Counter)
    lost: Counter = field(default_factory=Counter)


def read(path: str, layer: str | None) -> Drawing:
    """The drawing of a file. Raises ValueError for a file that cannot be read, or of which a part
    of the wall would be lost.

    :param layer: only outlines of this layer of a DXF file, or group of an SVG file
    """
    readers = {".csv": _csv, ".dxf": _dxf, ".geojson": _geoJson, ".json": _geoJson, ".svg": _svg}
    ending = os.path.splitext(path)[1].lower()
    if layer is not None and ending in (".csv", ".geojson", ".json"):
        raise ValueError(f"{path}: files that end with {ending} have no layers")
    drawing = Drawing()
    readBy(readers, path, layer, drawing)
    named = lambda counts: ", ".join(f"{n} {kind}" for kind, n in sorted(counts.items()))
    of = f" in layer {layer!r}" if layer else ""
    if drawing.lost:
        raise ValueError(f"{path}: {named(drawing.lost)}{of} would be left out: make them outlines")
    if not drawing.outlines:
        beside = f", only {named(drawing.beside)}" if drawing.beside else ""
        raise ValueError(f"{path}: no outlines{of}{beside}")
    if drawing.beside:
        say(f"note: fromOutlines: left out: {named(drawing.beside)}")
    for outline in drawing.outlines:
        ring = np.asarray(outline.ring, float)
        if ring.ndim != 2 or ring.shape[1] < 2 or not np.isfinite(ring).all():
            raise ValueError(
                f"{path}: outline {outline.name} has a corner that is not of two finite numbers"
            )
        outline.ring = ring[:, :3]
    _bringUpright(path, drawing.outlines)
    size = np.ptp(np.concatenate([o.ring for o in drawing.outlines]), axis=0).max()
    if ending in (".geojson", ".json") and 0 < size < DEGREES:
        far = max(abs(o.ring).max() for o in drawing.outlines)
        if 100 * size < far <= 180:
            raise ValueError(
                f"{path}: a drawing of {size:.2g} at {far:.4g} is in degrees of longitude and"
                " latitude: write it in metres"
            )
    _join(drawing, SAME * size)
    for outline in drawing.outlines:
        same = np.linalg.norm(outline.ring - np.roll(outline.ring, 1, axis=0), axis=1)
        outline.closed |= bool(same[0] <= SAME * size)
        same[1:][same[1:] > 0] = np.inf  # only the gap where it closes may be one of rounding
        outline.ring = outline.ring[same > SAME * size]
        if len(outline.ring) < 3:
            raise ValueError(f"{path}: outline {outline.name} has not three corners")
    return drawing


def _bringUpright(path, outlines):
    """Turn outlines in space into (x, z) of their plane, in which z is as near to upwards as can
    be, and x goes with the axis that is nearest. A drawing in the plane x-y has z along y."""
    flat = [len(o.ring[0]) < 3 or not np.ptp(o.ring[:, 2]) for o in outlines]
    if all(flat):
        for outline in outlines:
            outline.ring = outline.ring[:, :2]
        return
    points = np.concatenate([o.ring for o in outlines])
    middle = points.mean(axis=0)
    size = np.ptp(points, axis=0).max()
    normal = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    off = abs((points - middle) @ normal).max()
    if off > BENT * size:
        raise ValueError(
            f"{path}: the drawing is not in one plane: a corner is {off:.3g} from it, in a drawing"
            f" of {size:.3g}"
        )
    up = np.eye(3)[2] if abs(normal[2]) < 0.9 else np.eye(3)[1]
    up = up - (up @ normal) * normal
    up = up / np.linalg.norm(up)
    along = np.cross(up, normal)
    along = along * np.sign(along[np.argmax(abs(along))])
    say("note: fromOutlines: the drawing is in a plane in space; x is along it, z is up")
    for outline in outlines:
        outline.ring = (outline.ring - middle) @ np.column_stack([along, up])


def _join(drawing, width):
    """Join open lines at ends where two of them meet."""
    lines = [o for o in drawing.outlines if not o.closed and len(o.ring) > 1]
    lines = [o for o in lines if np.linalg.norm(o.ring[0] - o.ring[-1]) > width]
    if len(lines) < 2:
        return
    from scipy.spatial import cKDTree

    ends = np.concatenate([o.ring[[0, -1]] for o in lines])
    nodes = components(len(ends), cKDTree(ends).query_pairs(width))
    meeting = defaultdict(list)
    for end, node in enumerate(nodes):
        meeting[node].append(end)
    left = dict.fromkeys(range(len(lines)))

    def follow(end):
        """Corners from an end of a line on, and how many lines."""
        found = []
        while len(meeting[nodes[end]]) == 2:
            [other] = [e for e in meeting[nodes[end]] if e != end]
            if other // 2 not in left:
                break
            del left[other // 2]
            ring = lines[other // 2].ring
            found.append(ring[::-1] if other % 2 else ring)
            end = other ^ 1
        return found

    joined = []
    while left:
        first = min(left)
        del left[first]
        after, before = follow(2 * first + 1), follow(2 * first)
        parts = [ring[::-1] for ring in before[::-1]] + [lines[first].ring] + after
        corners = [ring[1:] if k else ring for k, ring in enumerate(parts)]
        more = f" and {len(parts) - 1} more" if len(parts) > 1 else ""
        joined.append(Outline(lines[first].name + more, np.concatenate(corners), False))
    taken = set(map(id, lines))
    drawing.outlines = [o for o in drawing.outlines if id(o) not in taken] + joined


# -- formats ---------------------------------------------------------------------------------------


def _csv(path, layer, drawing):
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
    drawing.outlines = [Outline(name, ring) for name, ring in rings.items()]


def _geoJson(path, layer, drawing):
    data = json.loads("\n".join(TextFile(path).lines))
    if not isinstance(data, dict) or not isinstance(data.get("features", []), list):
        raise ValueError("it is no GeoJSON: no feature, geometry or collection of features")
    for n, feature in enumerate(data.get("features", [data])):
        name = str(feature.get("id", (feature.get("properties") or {}).get("name", n)))
        shape = feature.get("geometry", feature)
        if shape is None:  # RFC 7946, 3.2: a feature that has no place
            drawing.beside["features without geometry"] += 1
            continue
        kind = shape.get("type")
        if kind not in ("Polygon", "MultiPolygon"):
            raise ValueError(f"feature {name} is a {kind}, not a Polygon")
        polygons = shape["coordinates"]
        for polygon in [polygons] if kind == "Polygon" else polygons:
            drawing.outlines.append(Outline(name, _outerRing(polygon, name)))


def _outerRing(polygon, name):
    if not polygon:
        raise ValueError(f"feature {name} has no ring")
    if len(polygon) > 1:
        raise ValueError(f"feature {name} has a hole: a stone has none")
    isPoint = (
        lambda p: isinstance(p, list) and len(p) > 1 and all(type(c) in (int, float) for c in p)
    )
    ring = polygon[0]
    wrong = next((k for k, point in enumerate(ring) if not isPoint(point)), None)
    if wrong is not None or len({tuple(point[:3]) for point in ring}) < 3:
        what = f"corner {wrong} is no place" if wrong is not None else "it has not three corners"
        raise ValueError(f"feature {name}: {what}")
    dimensions = min(3, *map(len, ring))
    return [point[:dimensions] for point in ring]


def _dxf(path, layer, drawing):
    ezdxf = needed("ezdxf")
    from ezdxf.path import from_hatch, make_path

    try:
        document = ezdxf.readfile(path)
    except Exception as error:  # DXFError, and what damaged files lead to in ezdxf
        raise ValueError(f"ezdxf: {error or type(error).__name__}") from None
    drawing.unit = INSUNITS.get(document.units)
    hidden = {x.dxf.name.lower() for x in document.layers if x.is_off() or x.is_frozen()}
    filled = []
    for entity, own in _entities(document.modelspace()):
        kind = entity.dxftype()
        if layer not in (None, own):
            continue
        if own.lower() in hidden or entity.dxf.get("invisible", 0):
            drawing.beside[f"{kind} in hidden layers"] += 1
            continue
        if kind in TEXTS:
            drawing.beside[kind] += 1
            continue
        try:
            curves = (
                list(from_hatch(entity)) if kind in ("HATCH", "MPOLYGON") else [make_path(entity)]
            )
        except TypeError:
            drawing.lost[kind] += 1
            continue
        for curve in curves:
            corners = np.array([tuple(v) for v in curve.control_vertices()])
            fine = FLATTENED * np.ptp(corners, axis=0).max() or 1.0
            ring = np.array([tuple(v) for v in curve.flattening(fine)])
            outline = Outline(f"{kind} {entity.dxf.handle or own}", ring, curve.is_closed)
            (filled if kind == "HATCH" else drawing.outlines).append(outline)
    drawn = {_box(outline) for outline in drawing.outlines}
    drawing.outlines += [o for o in filled if _box(o) not in drawn]  # else it fills an outline
    if not drawing.outlines and (
        sheets := sum(map(len, document.layouts)) - len(document.modelspace())
    ):
        drawing.beside["entities on sheets of paper"] += sheets


def _box(outline):
    """Corners of the box around an outline, to six digits of its size."""
    low, high = outline.ring.min(axis=0), outline.ring.max(axis=0)
    return tuple(np.round(np.concatenate([low, high]) / max(np.ptp([low, high]), 1e-300), 6))


def _entities(entities, within="", depth=0):
    """Entities of DXF and their layers, those of blocks in place. What is on layer 0 of a block is
    on the layer of the block."""
    if depth > DEEPEST:
        raise ValueError(f"blocks lie within blocks more than {DEEPEST} deep")
    for entity in entities:
        own = entity.dxf.get("layer", "0")
        own = within if within and own == "0" else own
        if entity.dxftype() != "INSERT":
            yield entity, own
            continue
        for one in entity.multi_insert() if entity.mcount > 1 else [entity]:
            yield from _entities(one.virtual_entities(), own, depth + 1)


def _svg(path, layer, drawing):
    svg = needed("svgelements")
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise ValueError(f"no SVG: {error}") from None
    drawing.unit = _userUnit(root)
    for key in ("viewBox", "width", "height", "x", "y"):  # so that numbers stay as they are written
        root.attrib.pop(key, None)
    _check(root, drawing)
    try:
        tree = svg.SVG.parse(io.BytesIO(ElementTree.tostring(root)))
    except Exception as error:  # of transforms and paths
        raise ValueError(f"svgelements: {error or type(error).__name__}") from None
    waiting = [(tree, layer is None)]
    while waiting:
        element, wanted = waiting.pop()
        names = _names(element)
        wanted = wanted or layer in names
        if isinstance(element, list) and not isinstance(element, svg.Shape):
            waiting += [(child, wanted) for child in reversed(element)]
        elif isinstance(element, svg.Shape) and wanted:
            kind = type(element).__name__
            if element.values.get("visibility") in ("hidden", "collapse"):
                drawing.beside[f"hidden {kind}"] += 1
                continue
            for ring, closed in _corners(svg, element):
                drawing.outlines.append(Outline(names[0] if names else kind, ring, closed))


def _tag(element):
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def _userUnit(root):
    """Metres in one unit of the numbers of an SVG file, if it says its size in mm or the like."""
    box = re.split(r"[\s,]+", root.get("viewBox", "").strip())
    width = re.fullmatch(r"\s*([\d.]+)\s*([a-z]+)\s*", root.get("width", ""))
    try:
        return float(width[1]) * LENGTHS[width[2]] / float(box[2])
    except (TypeError, KeyError, ValueError, IndexError, ZeroDivisionError):
        return None


def _check(root, drawing):
    """Count what svgelements leaves out, refuse what it reads wrongly, and put aside what is drawn
    only where something names it."""
    for parent in list(root.iter()):
        for n, child in enumerate(list(parent)):
            tag = _tag(child)
            if tag in ASIDE and _tag(parent) != "defs":
                aside = ElementTree.Element(root.tag.removesuffix("svg") + "defs")
                parent[n] = aside
                aside.append(child)
            elif tag in BESIDE:
                drawing.beside[tag] += 1
    for element in root.iter():
        tag = _tag(element)
        name = element.get("id") or tag
        if tag not in SHAPES | {"use", "svg"}:
            continue
        for key in MEASURES:
            if (text := element.get(key)) is not None and not _LENGTH.fullmatch(text):
                if (key, text) not in (("rx", "auto"), ("ry", "auto")):
                    raise ValueError(
                        f"{tag} {name}: {key} {text[:40]!r} is no length in user units"
                    )
        if tag == "rect" and any(
            element.get(k, "0").lstrip().startswith("-") for k in ("width", "height")
        ):
            raise ValueError(f"rect {name}: its width or height is below 0")
        numbers = re.findall(r"[^\s,]+", element.get("points", ""))
        if len(numbers) % 2 or not all(map(_LENGTH.fullmatch, numbers)):
            raise ValueError(f"{tag} {name}: its points are not pairs of numbers")
        if tag == "path":
            _checkPath(element.get("d", ""), name)


#: How many numbers each command of a path takes.
_COMMANDS = dict(zip("MLHVCSQTAZ", (2, 2, 1, 1, 6, 4, 4, 2, 7, 0)))


def _checkPath(text, name):
    """Refuse a path that svgelements would cut short."""
    pieces = re.split(r"([A-DF-Za-df-z])", text)
    if pieces[0].strip():
        raise ValueError(f"path {name} begins without a command")
    for command, numbers in zip(pieces[1::2], pieces[2::2]):
        count = _COMMANDS.get(command.upper())
        words = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", numbers)
        if count is None:
            raise ValueError(f"path {name} has the command {command!r}, which SVG does not have")
        flags = command in "Aa"  # whose two flags may touch other numbers
        wrong = bool(words) if not count else not words or (len(words) % count and not flags)
        if wrong:
            each = f"{count} numbers each" if count else "no number"
            raise ValueError(f"path {name}: {command!r} takes {each}, and has {len(words)}")


def _names(element):
    own = getattr(element, "values", {}).get("attributes", {})
    return [own[key] for key in own if key.rpartition("}")[2] in ("id", "label")]


def _corners(svg, shape):
    """Corners (n, 2) of each outline of a shape, and whether it is closed. SVG counts z
    downwards."""
    path = svg.Path(shape)
    path.reify()
    for part in path.as_subpaths():
        ring, closed = [], False
        for segment in svg.Path(part):
            if isinstance(segment, svg.Close):
                closed = True
            elif isinstance(segment, (svg.Move, svg.Line)):
                ring.append(tuple(segment.end))
            else:
                ring += [tuple(segment.point(k / CHORDS)) for k in range(1, CHORDS + 1)]
        if len(ring) > 1:
            yield np.array(ring) * (1, -1), closed
