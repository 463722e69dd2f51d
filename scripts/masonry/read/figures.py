"""Figures of a run, made from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry.read.figures results/wall_comp4`` draws curve.png and, if there are ParaView files, cracks.png.
From a script, also one of YADE, ``masonry.read.figures.draw(folder)`` does the same. This module needs no YADE, and loads
neither VTK nor a display, so it does no harm to the process that calls it.

What curve.png shows is said by the entry ``figure`` of run.json, and what the panels of cracks.png are by ``parts``; see
:mod:`masonry.run.results`.
"""

import glob
import os
import re
import sys
from collections import namedtuple

import numpy as np

from . import loops
from ..basics import Refused
from .frames import frameTimes, readFrame
from .files import filesOf, onFolder, readCurve, readRun

MAGNIFICATION = 30  # of displacements in cracks.png, as in figure 6 of the paper (see yade_plugin/law/README.md)
CRACK = 0.05e-3  # [m] opening or slip from which a joint is drawn as cracked
CRUSHED = 0.5e-3  # [m] plastic closure from which a joint is drawn as crushed
DAMAGED = 0.05  # [-] damage in tension or shear from which a joint is drawn as cracked

#: Displacements are drawn this large beside the structure, else another magnification than the usual one is taken.
SEEN = 0.002, 0.6
SHOWN = 0.06  # so large, if the usual magnification is not taken
FACING = 0.87  # cosine from which a joint that faces the viewer is drawn as an area, not as a line: less than 30°

COLOURS = {"open": "tab:red", "slid": "tab:blue"}
LINES = ["black", "tab:orange", "tab:green", "tab:purple", "tab:brown", "tab:cyan"]


def _drawing(width, height):
    """An empty figure [inch]. It has no window, and pyplot, whose settings YADE changes, has no part in it."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def _style():
    """The settings of matplotlib that all figures are drawn with, whatever the caller has set: a context."""
    import matplotlib.style

    return matplotlib.style.context("default")


def _save(figure, path, dpi):
    """Write a picture, whole or not at all."""
    try:
        figure.savefig(path, dpi=dpi)
    except OSError:
        if os.path.exists(path):
            os.remove(path)
        raise


# -- curve.png --------------------------------------------------------------------------------------------------------


def plan(run, data, directory):
    """The entry ``figure`` of run.json, with all that may be left out. Raises Refused for one that cannot be drawn.

    :param run: what :func:`masonry.read.files.readRun` returns
    :param data: what :func:`masonry.read.files.readCurve` returns
    :param directory: folder, for messages
    """
    told = run.get("figure")
    if told is None:
        raise Refused(
            f'{directory}: run.json has no entry "figure", which says what to draw: an older version of the plugin made it'
        )
    told = {
        "y_label": "",
        "looped": False,
        "marks": [],
        "bounds": [],
        **told,
    }
    for axis in (told["x"], *told["y"]):
        if axis["column"] not in data:
            raise Refused(
                f"{directory}: figure: curve.csv has no column {axis['column']}, it has {', '.join(data)}"
            )
    if not told["y"]:
        raise Refused(f'{directory}: figure: "y" must name one column at least')
    return told


def energies(data):
    """Energies to draw, since the first row: a dict of name -> values [J], and the work done, or None if there is none.

    :param data: dict of column name -> array; what has an energy ends in ``_J``
    """
    since = {k[:-2]: v - v[0] for k, v in data.items() if k.endswith("_J")}
    work = [since.pop(name) for name in ("external", "gravity") if name in since]
    elastic = [since.pop(name) for name in list(since) if name.startswith("elastic_")]
    stack = {"elastic": sum(elastic)} if elastic else {}
    for name in ("dissipated_tension", "dissipated_shear", "dissipated_compression"):
        if name in since:
            stack[name.split("_")[1]] = since.pop(name)
    if "damping" in since:
        stack["damping"] = since.pop("damping")
    kinetic = since.pop("kinetic", None)
    stack.update((name.replace("_", " "), values) for name, values in since.items())
    largest = max((np.abs(v).max() for v in (*stack.values(), *work)), default=0)
    if kinetic is not None and kinetic.max() > 0.02 * largest:
        stack["kinetic"] = kinetic
    return stack, sum(work) if work else None


def curve(directory):
    """Draw curve.png: what the entry ``figure`` of run.json says and, below it, the energies.

    Loops have axes through zero and their envelope in bold, and their energies are drawn over the length of the way.
    Without columns of energies there is no panel of them.
    """
    run = readRun(directory)
    data = {name: np.array(values) for name, values in readCurve(directory).items()}
    told = plan(run, data, directory)
    looped, x = told["looped"], data[told["x"]["column"]]
    used = {axis["column"] for axis in told["y"]}
    stack, work = energies({k: v for k, v in data.items() if k not in used})
    with _style():
        if stack:
            figure = _drawing(7, 7)
            top, bottom = figure.subplots(2, 1, sharex=not looped, height_ratios=[3, 2])
        else:
            figure = _drawing(7, 4.6)
            top, bottom = figure.subplots(), None
        _curves(top, told, data, x)
        top.set_title(run["title"])
        label = told["x"]["label"]
        if bottom is None or looped:
            top.set_xlabel(label)
        if bottom:
            over = np.append(0, np.cumsum(np.abs(np.diff(x)))) if looped else x
            for name, values in stack.items():
                bottom.plot(over, values, lw=1, label=name)
            if work is not None:
                bottom.plot(over, work, color="black", lw=1, ls="--", label="work done")
            unit = _unit(told["x"])
            bottom.set_xlabel(
                f"length of the way there and back [{unit}]" if looped else label
            )
            first = "the push began" if "wall" in run else "the first row"
            bottom.set_ylabel(f"energy since {first} [J]")
            bottom.legend(fontsize=8)
            bottom.grid(alpha=0.3)
        figure.tight_layout()
        _save(figure, os.path.join(directory, "curve.png"), 110)


def _curves(axes, told, data, x):
    """The upper panel of curve.png."""
    looped = told["looped"]
    first = data[told["y"][0]["column"]]
    for n, axis in enumerate(told["y"]):
        wide = (0.7, 0.4) if looped else (1.2, 0.6)
        axes.plot(
            x,
            data[axis["column"]],
            color=LINES[n % len(LINES)],
            lw=wide[n > 0],
            label=axis["label"],
            zorder=1 if n else 2,
        )
    if looped:
        for rows, label in zip(loops.envelope(x), ("envelope", None)):
            axes.plot(x[rows], first[rows], color="tab:blue", lw=1.8, label=label)
        axes.axvline(0, color="0.3", lw=0.8, zorder=0)
        axes.margins(y=0.12)
    else:
        axes.set_ylim(*_limits(told, data))
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0, color="0.3", lw=0.8, zorder=0)
    for mark in told["marks"]:
        at, value = mark["x"], mark["y"]
        left = (at > 0) if looped else at > 0.7 * x.max() + 0.3 * x.min()
        axes.plot(at, value, "o", color="tab:red", ms=5)
        axes.annotate(
            mark["text"],
            (at, value),
            textcoords="offset points",
            xytext=(-6 if left and not looped else 6, 8) if value >= 0 else (-6, -14),
            ha="right" if left else "left",
        )
    for bound in told["bounds"]:
        axes.axhline(bound["y"], color="0.35", lw=0.9, ls=(0, (6, 3)), zorder=0)
        axes.annotate(
            bound["text"],
            (0.01, bound["y"]),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            xytext=(0, 3),
            fontsize=8,
            color="0.25",
        )
    axes.set_ylabel(told["y_label"])
    if len(told["y"]) > 1 or looped:
        axes.legend(loc="lower right")
    axes.grid(alpha=0.3)


def _limits(told, data):
    """Range of the upper panel that has all of the first curve, and of the others what is more than single swings."""
    columns = [data[axis["column"]] for axis in told["y"]]
    marks = [thing["y"] for key in ("marks", "bounds") for thing in told[key]]
    low = min([columns[0].min(), *(np.quantile(c, 0.01) for c in columns), *marks])
    high = max([columns[0].max(), *(np.quantile(c, 0.99) for c in columns), *marks])
    reach = max(high, 0) - min(low, 0) or 1.0
    if low >= -0.02 * reach:
        return 0, 1.15 * reach
    if high <= 0.02 * reach:
        return -1.15 * reach, 0
    return low - 0.15 * reach, high + 0.15 * reach


def _unit(axis):
    """Unit of an axis: in the brackets of its label, else at the end of the name of its column."""
    found = re.search(r"\[([^\]]*)\]\s*$", axis["label"])
    return found[1] if found else axis["column"].rsplit("_", 1)[-1]


# -- cracks.png: how a part is seen --------------------------------------------------------------------------------------

#: How a part is seen. ``right`` and ``up`` are unit vectors of the picture, ``towards`` is that to the viewer; ``labels``
#: are those of the axes, and ``name`` says where the viewer stands. A point p lies at ((p - start)·right, (p - start)·up).
View = namedtuple("View", "right up towards start labels name")


def viewOf(points, normals, areas, sight=None):
    """The view of a part: a :class:`View`, chosen by its shape.

    If all joints stand across one horizontal direction, as those of a wall of one wythe at any angle in plan and those of
    an arch do, the part is seen along this direction. Else it is seen along the short side of the smallest rectangle
    around its plan, or from above if it is wider than high, as a dome or a vault is. What is up stays up; from above, x
    is to the right and y is up.

    :param points: corners of its blocks, an array of (x, y, z) [m]
    :param normals: unit normals of its joints, an array
    :param areas: areas of these joints [m²]
    :param sight: direction of sight (x, y, z), if the user gave one
    """
    flat, height = points[:, :2], np.ptp(points[:, 2])
    corners = hull(flat)
    edges = np.roll(corners, -1, axis=0) - corners
    best = None
    for edge in edges[np.linalg.norm(edges, axis=1) > 1e-9]:
        along = edge / np.linalg.norm(edge)
        across = np.array([-along[1], along[0]])
        sides = np.ptp(flat @ along), np.ptp(flat @ across)
        if best is None or sides[0] * sides[1] < best[0] * best[1] * (1 - 1e-9):
            best = (*sides, along, across)
    first, second, along, across = best
    if second > 1.05 * first or (
        second > first / 1.05 and abs(across[0]) > abs(along[0])
    ):
        first, second, along, across = second, first, across, along
    if sight is not None:
        away = -np.array(sight, float) / np.linalg.norm(sight)
    else:
        away = np.array([0, 0, 1.0])
        total = areas.sum()
        standing = [
            side
            for side in (across, along)
            if total and areas @ (normals[:, :2] @ side) ** 2 < 1e-6 * total
        ]
        if standing or second <= height:
            away = np.append(standing[0] if standing else across, 0)
    return _viewFrom(away, points, sight is None)


def _viewFrom(away, points, either):
    """The view of points by a viewer in this direction; ``either``: or opposite, if that turns x or y to the right."""
    if abs(away[2]) > 1 - 1e-6:
        right, up = np.eye(3)[:2]
        name = "from above"
    else:
        up = np.array([0, 0, 1]) - away[2] * away
        up /= np.linalg.norm(up)
        right = np.cross(up, away)
        if either and (right[0] < -1e-3 or (abs(right[0]) <= 1e-3 and right[1] < 0)):
            right = -right
        name = ""
    towards = np.cross(right, up)
    start, labels = np.zeros(3), []
    for direction in (right, up):
        axis = int(np.argmax(np.abs(direction)))
        if direction[axis] > 1 - 1e-5:
            labels.append("xyz"[axis] + " [m]")
            continue
        start = start + (points @ direction).min() * direction
        angle = np.degrees(np.arctan2(direction[1], direction[0]))
        labels.append(
            f"along the part, {angle:.0f}° from x [m]"
            if abs(direction[2]) < 1e-6
            else "upwards in the picture [m]"
        )
    return View(right, up, towards, start, labels, name)


def hull(points):
    """Corners of the convex hull of points in a plane, counter-clockwise: an array of (x, y)."""
    points = np.unique(np.asarray(points, float).round(12), axis=0)
    if len(points) < 3:
        return points

    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2], chain[-1]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    ordered = points.tolist()
    return np.array(half(ordered) + half(ordered[::-1]))


def _outline(flat, depth):
    """Numbers of the points that lie on the outline of a block, in order around it.

    Of points behind each other the one next to the viewer is taken. Points between corners are kept, since the side of a
    deformable block can bend.
    """
    corners = hull(flat)
    near = 1e-6 * np.ptp(flat, axis=0).max()
    order, place = [], []
    behind = np.argsort(-depth, kind="stable")
    for n, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0))):
        length = np.linalg.norm(b - a)
        if length <= near:
            continue
        along = (b - a) / length
        off = flat[behind] - a
        s = off @ along
        on = np.abs(off[:, 0] * along[1] - off[:, 1] * along[0]) < near
        on &= (s > -near) & (s < length - near)
        order += behind[on].tolist()
        place += (n + s[on] / length).tolist()
    order, place = np.array(order, int), np.array(place)
    ranks = np.argsort(place, kind="stable")
    keep = np.append(True, np.diff(place[ranks]) > 1e-6)
    return order[ranks][keep]


# -- cracks.png: what is seen ------------------------------------------------------------------------------------------

#: A part in its view. ``faces`` and ``moved`` are outlines of its blocks, from the back to the front, at rest and moved,
#: where displacements are magnified; ``lines`` are pairs of ends of the cracks by kind; ``areas`` are those that face the
#: viewer; ``spots`` are crushed places (x, y, closure).
Picture = namedtuple("Picture", "view faces moved lines areas spots")


class _Part:
    """A part of a structure, in a frame of blocks and joints."""

    def __init__(self, bodies, blocks, joints, sight, still):
        members = np.array(sorted(bodies))
        self.joints, self.blocks, self.still = joints, blocks, still
        mine = np.isin(joints["bodies"], members)
        inside = mine.all(axis=1)
        self.cells = np.flatnonzero(mine.any(axis=1))
        corners = {}
        for body, cell in zip(blocks["body"], blocks["cells"]):
            corners.setdefault(int(body), []).append(cell)
        self.corners = {
            body: np.unique(np.concatenate(corners[body]))
            for body in map(int, members)
            if body in corners
        }
        points = blocks["points"][np.concatenate(list(self.corners.values()))]
        self.view = viewOf(
            points, joints["normal"][inside], joints["area"][inside], sight
        )
        to = np.column_stack([self.view.right, self.view.up])
        self.flat = lambda p: (p - self.view.start) @ to
        self.shift = lambda u: (u - still) @ to

    def sizes(self):
        """Largest extent of the part in the picture, and displacements of the corners of its blocks there [m].

        If the part moves more across the picture than in it, the name of its view says how far.
        """
        nodes = np.concatenate(list(self.corners.values()))
        flat = self.flat(self.blocks["points"][nodes])
        displacement = self.blocks["displacement"][nodes]
        moved = np.linalg.norm(self.shift(displacement), axis=1)
        across = (displacement - self.still) @ self.view.towards
        farthest = across[np.argmax(np.abs(across))]
        if abs(farthest) > moved.max():
            way = "towards the viewer" if farthest > 0 else "away from the viewer"
            self.view = self.view._replace(
                name=f"{self.view.name} (moved up to {1e3 * abs(farthest):.3g} mm {way})".strip()
            )
        return np.ptp(flat, axis=0).max(), moved

    def picture(self, magnification):
        faces = []
        for nodes in self.corners.values():
            points = self.blocks["points"][nodes]
            flat, depth = self.flat(points), points @ self.view.towards
            rim = _outline(flat, depth)
            shift = self.shift(self.blocks["displacement"][nodes[rim]])
            faces.append((depth.max(), flat[rim], flat[rim] + magnification * shift))
        faces.sort(key=lambda face: face[0])
        lines, areas, spots = self._cracks(magnification)
        return Picture(
            self.view, [f[1] for f in faces], [f[2] for f in faces], lines, areas, spots
        )

    def _cracks(self, magnification):
        """Lines, areas and spots of :class:`Picture`."""
        j = self.joints
        slide = np.linalg.norm(j["slide"], axis=1)
        opened = j["opening"] > np.maximum(CRACK, 0.5 * slide)
        damaged = np.maximum(j["damage_tension"], j["damage_shear"]) > DAMAGED
        cracked = damaged & (opened | (slide > CRACK))
        kinds = np.where(opened, "open", "slid")
        size = np.maximum(j["opening"], slide)
        middles = self._middles()
        traces, areas, spots = [], {"open": [], "slid": []}, {}
        for i in self.cells:
            if not cracked[i] and not j["crushing"][i] > CRUSHED:
                continue
            cell = j["cells"][i]
            flat = self.flat(j["points"][cell])
            shift = magnification * self.shift(j["displacement"][cell])
            if j["crushing"][i] > CRUSHED:
                place = flat.mean(axis=0)
                key = tuple(np.round(place / 1e-3 + 0.137).astype(int))
                if j["crushing"][i] > spots.get(key, (0, 0, 0))[2]:
                    spots[key] = (*(place + shift.mean(axis=0)), j["crushing"][i])
            if not cracked[i]:
                continue
            along = np.cross(j["normal"][i], self.view.towards)
            if np.linalg.norm(along) < np.sqrt(1 - FACING**2):
                areas[kinds[i]].append(flat + shift)
                continue
            t = np.array([along @ self.view.right, along @ self.view.up])
            t /= np.linalg.norm(t)
            if t[0] < -1e-3 or (abs(t[0]) <= 1e-3 and t[1] < 0):
                t = -t
            s, ends = flat @ t, []
            near = 1e-6 * np.ptp(s)
            for at in (s.min(), s.max()):
                ends.append(shift[np.abs(s - at) <= near].mean(axis=0))
            off = middles[i] @ [-t[1], t[0]]
            angle = np.arctan2(t[1], t[0])
            traces.append((angle, off, s.min(), s.max(), size[i], kinds[i], *ends))
        return merged(traces), areas, list(spots.values())

    def _middles(self):
        """Middle of the joint of every subcontact of the part in the picture: a dict by its number."""
        j, cells = self.joints, self.cells
        if not len(cells):
            return {}
        pairs, which = np.unique(
            np.column_stack([j["bodies"], j["normal"].round(6)])[cells],
            axis=0,
            return_inverse=True,
        )
        centres = np.array([self.flat(j["points"][j["cells"][i]]).mean(axis=0) for i in cells])  # fmt: skip
        weights = j["area"][cells]
        total = np.bincount(which, weights)
        middle = [np.bincount(which, weights * c) / total for c in centres.T]
        return dict(zip(cells, np.column_stack(middle)[which]))


def merged(traces):
    """Cracks drawn once: lines by kind, each a pair of ends. Where several lie behind each other, the largest counts.

    :param traces: lists of angle, offset from the origin, start and end along the line, size of the crack, kind, and
        the shifts of both ends
    """
    lines = {"open": [], "slid": []}
    if not traces:
        return lines
    lengths = [trace[3] - trace[2] for trace in traces]
    near = 5e-3 * float(np.median(lengths))
    for alike in _clusters(traces, 0, 2e-3):
        for row in _clusters(alike, 1, near):
            angle, off = row[0][0], row[0][1]
            t = np.array([np.cos(angle), np.sin(angle)])
            base = off * np.array([-t[1], t[0]])
            starts, ends, sizes = (np.array([r[k] for r in row]) for k in (2, 3, 4))
            places = np.unique(np.concatenate([starts, ends]))
            places = places[np.append(True, np.diff(places) > near)]
            for a, b in zip(places, places[1:]):
                middle = (a + b) / 2
                over = np.flatnonzero((starts < middle) & (middle < ends))
                if not len(over):
                    continue
                best = row[over[np.argmax(sizes[over])]]
                start, end, kind, first, last = *best[2:4], *best[5:]
                shares = [np.clip((p - start) / (end - start), 0, 1) for p in (a, b)]
                lines[kind].append(
                    [
                        base + p * t + (1 - share) * first + share * last
                        for p, share in zip((a, b), shares)
                    ]
                )
    return lines


def _clusters(rows, key, near):
    """Rows in groups: within a group, sorted by a number, neighbours differ by no more than ``near``."""
    rows = sorted(rows, key=lambda row: row[key])
    values = np.array([row[key] for row in rows])
    cuts = np.flatnonzero(np.diff(values) > near) + 1
    return [rows[a:b] for a, b in zip([0, *cuts], [*cuts, len(rows)])]


def magnificationOf(size, moved):
    """How much displacements are magnified: as usual, or by 1, 2 or 5 times a power of ten if that would be absurd.

    :param size: largest extent of the structure [m]
    :param moved: displacements of the corners of its blocks [m]. If some are far too large, as those of bricks that fell,
        one in fifty is left out of consideration
    """
    far = max(moved, default=0.0)
    if MAGNIFICATION * far > SEEN[1] * size:
        most = float(np.quantile(moved, 0.98))
        if MAGNIFICATION * most >= SEEN[0] * size:
            far = most
    if not far or SEEN[0] * size <= MAGNIFICATION * far <= SEEN[1] * size:
        return MAGNIFICATION
    wanted = SHOWN * size / far
    power = 10 ** np.floor(np.log10(wanted))
    nice = max(step * power for step in (1, 2, 5) if step * power <= wanted)
    return max(1, int(nice))


def cracks(directory, number=-1):
    """Draw cracks.png: the deformed structure, magnified, over the undeformed one, each part in a panel of its own.

    Cracks are red, joints that slid are blue, and crushed spots are black. Joints that face the viewer are areas, the
    others lines. :func:`viewOf` says how a part is seen.

    :param number: of the frame, from 0; negative numbers count from the end
    """
    run = readRun(directory)
    blocks = readFrame(directory, "blocks", number)
    joints = readFrame(directory, "joints", number)
    still, wrong = np.zeros(3), set()
    bodies = set(map(int, blocks["body"]))
    groups = run.get("parts") or {"": sorted(bodies)}
    sights = run.get("views", {})
    body = run.get("reference_body")
    if body is not None:
        nodes = [c for b, c in zip(blocks["body"], blocks["cells"]) if b == body]
        if not nodes:
            wrong.add(body)
        else:
            still = blocks["displacement"][np.concatenate(nodes)].mean(axis=0)
    for name, members in groups.items():
        wrong |= set(members) - bodies
        if not members:
            raise Refused(f"{directory}: parts: {name} has no bodies")
    if wrong:
        raise Refused(
            f"{directory}: run.json names bodies {sorted(wrong)[:10]}, which are not in the ParaView files"
        )
    parts = {
        name: _Part(members, blocks, joints, sights.get(name), still)
        for name, members in groups.items()
    }
    sizes, moved = zip(*(part.sizes() for part in parts.values()))
    magnification = magnificationOf(max(sizes), np.concatenate(moved))
    pictures = {n: part.picture(magnification) for n, part in parts.items()}
    title = (
        f"{run['title']}\n{whenOf(run, directory, number)}, displacements × {magnification}; "
        f"open or slid more than {1e3 * CRACK:g} mm, crushed more than {1e3 * CRUSHED:g} mm"
    )
    with _style():
        figure = _page(pictures, title)
        _save(figure, os.path.join(directory, "cracks.png"), 90)


def mechanism(path, blocks, joints, title, groups=None, sights=None):
    """Draw a mechanism of :mod:`masonry.limit` as :func:`cracks` draws a frame.

    :param path: of the picture
    :param blocks: frame of the blocks, and ``joints`` that of the joints, whose displacements are drawn as they are
    :param title: above the picture
    :param groups: dict of name -> ids of bodies, a panel each; None: all in one
    :param sights: directions of sight by name
    """
    groups = groups or {"": [int(body) for body in blocks["body"]]}
    sights, still = sights or {}, np.zeros(3)
    pictures = {}
    for name, members in groups.items():
        part = _Part(members, blocks, joints, sights.get(name), still)
        part.sizes()
        pictures[name] = part.picture(1)
    with _style():
        _save(_page(pictures, title), path, 90)


def whenOf(run, directory, number):
    """When a frame was written: the x of curve.png at its time, else its time."""
    time = frameTimes(directory)[number]
    data = readCurve(directory) if "figure" in run else {}
    if "time_s" in data:
        told = plan(run, data, directory)["x"]
        if told["column"] != "time_s":
            value, unit = np.interp(time, data["time_s"], data[told["column"]]), _unit(told)  # fmt: skip
            return (
                f"at {value:.1f} {unit}" if unit == "mm" else f"at {value:.3g} {unit}"
            )
    return f"at {time:.3g} s"


def _page(pictures, title):
    """All parts on a page, in one scale."""
    boxes = {name: _box(picture) for name, picture in pictures.items()}
    if len(pictures) == 1:
        figure = _drawing(9, 8)
        axes = figure.subplots()
        (picture,), (box,) = pictures.values(), boxes.values()
        wide, high = box[1] - box[0]
        _panel(axes, picture, box, 72 * min(7.2 / wide, 6.5 / high))
        seen = f"\n{picture.view.name}" if picture.view.name else ""
        axes.set_title(title + seen, fontsize=10)
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
        figure.tight_layout()
        return figure
    rim, edge, head = 0.85, 0.75, 0.75  # [inch] beside and below a panel, above all
    names, best = list(pictures), None
    for columns in range(1, len(names) + 1):
        rows = [names[n : n + columns] for n in range(0, len(names), columns)]
        wides = [
            max((boxes[n][1] - boxes[n][0])[0] for n in names[c::columns])
            for c in range(columns)
        ]
        highs = [max((boxes[n][1] - boxes[n][0])[1] for n in row) for row in rows]
        scale = min(
            (10.5 - 1.0 - rim * columns) / sum(wides),
            (11 - head - edge * len(rows)) / sum(highs),
        )
        if best is None or scale > best[0]:
            best = scale, rows, wides, highs
    scale, rows, wides, highs = best
    width = 1.0 + rim * len(wides) + scale * sum(wides)
    height = head + edge * len(rows) + scale * sum(highs)
    page = max(width, 7.5)
    figure = _drawing(page, height)
    y, handles = height - head, {}
    for row, high in zip(rows, highs):
        x, y = rim * 0.75, y - scale * high
        for name, wide in zip(row, wides):
            w, h = scale * (boxes[name][1] - boxes[name][0])
            axes = figure.add_axes([x / page, y / height, w / page, h / height])
            picture = pictures[name]
            _panel(axes, picture, boxes[name], 72 * scale)
            axes.set_title(f"{name} {picture.view.name}", fontsize=9, pad=3)
            found, labels = axes.get_legend_handles_labels()
            handles.update(zip(labels, found))
            x += scale * wide + rim
        y -= edge
    figure.suptitle(title, fontsize=10, y=1 - 0.12 / height)
    figure.legend(
        handles.values(), handles, loc="upper right", fontsize=8,
        bbox_to_anchor=(1 - 0.1 / page, 1 - head / height),
    )  # fmt: skip
    return figure


def _box(picture):
    """Two corners of what is drawn of a part: all of it, but not much farther than the part is large."""
    rest = np.concatenate(picture.faces)
    low, high = rest.min(axis=0), rest.max(axis=0)
    reach = 0.6 * (high - low).max()
    moved = np.concatenate(picture.moved)
    low = np.maximum(np.minimum(low, moved.min(axis=0)), low - reach)
    high = np.minimum(np.maximum(high, moved.max(axis=0)), high + reach)
    rim = 0.045 * (high - low).max()
    return np.array([low - rim, high + rim])


def _panel(axes, picture, box, points):
    """Draw a part. ``points`` is the length of a metre on paper [1/72 inch], by which lines are as thin as needed."""
    from matplotlib.collections import LineCollection, PolyCollection

    course = np.median([np.ptp(face, axis=0).min() for face in picture.faces]) * points
    thin, bold = np.clip(0.041 * course, 0.1, 0.35), np.clip(0.21 * course, 0.7, 1.8)
    axes.add_collection(
        PolyCollection(picture.faces, facecolor="0.9", edgecolor="0.8", lw=0.85 * thin)
    )
    axes.add_collection(
        PolyCollection(picture.moved, facecolor="#f3e3c8", edgecolor="0.45", lw=thin)
    )
    for kind, polygons in picture.areas.items():
        if polygons:
            axes.add_collection(
                PolyCollection(
                    polygons,
                    facecolor=COLOURS[kind],
                    alpha=0.35,
                    lw=0,
                    label=kind + ", seen face-on",
                )
            )
    for kind, wide in (("slid", bold * 1.6 / 1.8), ("open", bold)):
        axes.add_collection(
            LineCollection(
                picture.lines[kind], color=COLOURS[kind], lw=wide, label=kind
            )
        )
    if picture.spots:
        x, y, closure = np.array(picture.spots).T
        axes.scatter(
            x,
            y,
            s=(12 + 8e3 * closure) * min(1, bold / 1.8) ** 2,
            color="black",
            marker="X",
            lw=0,
            label="crushed",
            zorder=5,
        )
    axes.set_xlim(box[:, 0])
    axes.set_ylim(box[:, 1])
    axes.set_aspect("equal")
    axes.set_xlabel(picture.view.labels[0])
    axes.set_ylabel(picture.view.labels[1])


def draw(directory):
    """Draw all figures that the files of a run allow. Raises Refused if something is wrong with them."""
    with filesOf(directory):
        curve(directory)
        if glob.glob(os.path.join(glob.escape(directory), "joints_*.vtp")):
            cracks(directory)


if __name__ == "__main__":
    sys.exit(onFolder(draw, sys.argv[1:]))
