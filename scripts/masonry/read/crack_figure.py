# SPDX-License-Identifier: GPL-2.0-or-later
"""cracks.png: the deformed structure with its cracks, and the mechanism of limit analysis. This module needs no YADE."""

from __future__ import annotations

import os
from collections import namedtuple
from typing import Any

import numpy as np

from ..arguments import FilePath
from ..basics import Refused
from . import drawing
from .cracks import CRACK, CRUSHED, crushed, widths
from .curve_figure import plan, unitOf
from .files import readCurve, readRun
from .frames import frameTimes, readFrame
from .views import outline, viewOf

MAGNIFICATION = 30  # of displacements in cracks.png, as in figure 6 of the paper (see yade_plugin/law/README.md)

#: Smallest and largest size of the drawn displacements over the size of the structure with the usual magnification. Outside
#: these limits another magnification is chosen, so that they are about as large as :data:`SHOWN`.
SEEN = 0.002, 0.6
SHOWN = 0.06
FACING = 0.87  # cosine from which a joint that faces the viewer is drawn as an area, not as a line: less than 30°

BRICK = "#f3e3c8"  # the colour of a block
COLOURS = {"open": "tab:red", "slid": "tab:blue"}
#: Lines of ties by their state.
TIES = {
    "elastic": ("0.2", "-"),
    "yielded": ("tab:orange", "-"),
    "broken": ("tab:purple", ":"),
}

#: A part in its view. ``faces`` and ``moved`` are outlines of its blocks, from the back to the front, at rest and moved,
#: where displacements are magnified; ``lines`` are pairs of ends of the cracks by kind; ``areas`` are those that face the
#: viewer; ``spots`` are crushed places (x, y, closure); ``shades`` are the colour of every block and its label in the legend,
#: or None; ``ties`` are pairs of ends by state.
Picture = namedtuple(
    "Picture", "view faces moved lines areas spots shades ties", defaults=[(), ()]
)


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
            sense = "towards the viewer" if farthest > 0 else "away from the viewer"
            self.view = self.view._replace(
                name=f"{self.view.name} (moved up to {1e3 * abs(farthest):.3g} mm {sense})".strip()
            )
        return np.ptp(flat, axis=0).max(), moved

    def picture(self, magnification):
        faces = []
        for nodes in self.corners.values():
            points = self.blocks["points"][nodes]
            flat, depth = self.flat(points), points @ self.view.towards
            rim = outline(flat, depth)
            shift = self.shift(self.blocks["displacement"][nodes[rim]])
            faces.append((depth.max(), flat[rim], flat[rim] + magnification * shift))
        faces.sort(key=lambda face: face[0])
        lines, areas, spots = self._cracks(magnification)
        return Picture(
            self.view, [f[1] for f in faces], [f[2] for f in faces], lines, areas, spots
        )

    def ties(self, entries, magnification):
        """The ties of which an end is in the part: pairs of ends by state.

        :param entries: ``ties`` of run.json
        """
        found = {}
        for one in entries:
            if not set(one["bodies"]) & set(self.corners):
                continue
            ends = [
                self.flat(np.array(point)) + magnification * self.shift(self._movedAt(body, np.array(point)))
                for body, point in zip(one["bodies"], one["ends_m"])
            ]  # fmt: skip
            found.setdefault(one["state"], []).append(ends)
        return found

    def _movedAt(self, body, point):
        """Displacement of a point of a body, rigid or strained evenly: of the others it is that of the ground [m]."""
        nodes = [c for b, c in zip(self.blocks["body"], self.blocks["cells"]) if b == body]  # fmt: skip
        if not nodes:
            return np.zeros(3)
        nodes = np.unique(np.concatenate(nodes))
        places = self.blocks["points"][nodes]
        from_middle = np.column_stack([places - places.mean(axis=0), np.ones(len(places))])  # fmt: skip
        field = np.linalg.lstsq(from_middle, self.blocks["displacement"][nodes], None)[0]  # fmt: skip
        return np.append(point - places.mean(axis=0), 1) @ field

    def _cracks(self, magnification):
        """Lines, areas and spots of :class:`Picture`."""
        j = self.joints
        size, opened, cracked = widths(j)
        kinds, spoilt = np.where(opened, "open", "slid"), crushed(j)
        middles = self._middles()
        traces, areas, spots = [], {"open": [], "slid": []}, {}
        for i in self.cells:
            if not cracked[i] and not spoilt[i]:
                continue
            cell = j["cells"][i]
            flat = self.flat(j["points"][cell])
            shift = magnification * self.shift(j["displacement"][cell])
            if spoilt[i]:
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
                start, end, _, kind, first, last = best[2:]
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


def frameOfCracks(run: dict[str, Any], directory: FilePath) -> int:
    """Number of the frame whose cracks are drawn, from 0: the last one, or, of a run that followed a collapse to the ground, that
    when the collapse was noticed or the first block had fallen.

    :param run: entries of run.json
    """
    times = frameTimes(directory)
    answers = {a["name"]: a["value"] for a in run.get("answers") or [] if a["stage"] == "fall"}  # fmt: skip
    found = [answers[n] for n in ("noticed_at", "first_fall") if n in answers]
    if not found:
        return len(times) - 1
    return int(np.argmin(np.abs(np.asarray(times) - min(found))))


def cracks(directory: FilePath, number: int | None = None) -> None:
    """Draw cracks.png of a frame that a run has left.

    :param number: of the frame, from 0; negative numbers count from the end; None: as of :func:`frameOfCracks`
    """
    run = readRun(directory)
    number = frameOfCracks(run, directory) if number is None else number
    blocks = readFrame(directory, "blocks", number)
    joints = readFrame(directory, "joints", number)
    when = whenOf(run, directory, number)
    with drawing.style():
        figure = figureOf(run, blocks, joints, when, directory)
        drawing.save(figure, os.path.join(directory, "cracks.png"), 90)


def figureOf(run, blocks, joints, when, directory):
    """The figure of cracks.png, to be drawn and saved in :func:`masonry.read.drawing.style`: the deformed structure, magnified,
    over the undeformed one, each part in a panel of its own. Raises Refused.

    Cracks are red, joints that slid are blue, and crushed spots are black. Joints that face the viewer are areas, the
    others lines. :func:`viewOf` says how a part is seen.

    :param run: entries of run.json: ``title``, ``parts``, ``views`` and ``reference_body``
    :param blocks: frame of the blocks, and ``joints`` that of the joints
    :param when: text that says when the frame was written
    :param directory: folder, for messages
    """
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
    tied = run.get("ties", [])
    pictures = {
        n: part.picture(magnification)._replace(ties=part.ties(tied, magnification))
        for n, part in parts.items()
    }
    title = (
        f"{run['title']}\n{when}, displacements × {magnification}; "
        f"open or slid more than {1e3 * CRACK:g} mm, crushed more than {1e3 * CRUSHED:g} mm"
    )
    return page(pictures, title)


def mechanism(
    path: FilePath,
    blocks: dict[str, Any],
    joints: dict[str, Any],
    title: str,
    groups: dict[str, Any] | None = None,
    sights: dict[str, Any] | None = None,
) -> None:
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
    with drawing.style():
        drawing.save(page(pictures, title), path, 90)


def page(pictures, title):
    """All parts on a page, in one scale."""
    boxes = {name: _box(picture) for name, picture in pictures.items()}
    if len(pictures) == 1:
        figure = drawing.empty(9, 8)
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
    figure = drawing.empty(page, height)
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
    tied = [np.array(ends) for ends in dict(picture.ties).values()]
    rest = np.concatenate([*picture.faces, *(ends.reshape(-1, 2) for ends in tied)])
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
    colours = [shade[1] if shade else BRICK for shade in picture.shades] or BRICK
    axes.add_collection(
        PolyCollection(picture.faces, facecolor="0.9", edgecolor="0.8", lw=0.85 * thin)
    )
    axes.add_collection(
        PolyCollection(picture.moved, facecolor=colours, edgecolor="0.45", lw=thin)
    )
    for label, colour in sorted({shade for shade in picture.shades if shade}):
        axes.add_collection(
            PolyCollection([], facecolor=colour, edgecolor="0.45", label=label)
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
    wides = {"slid": bold * 1.6 / 1.8, "open": bold}
    for kind, wide in wides.items() if picture.lines else ():
        axes.add_collection(
            LineCollection(
                picture.lines[kind], color=COLOURS[kind], lw=wide, label=kind
            )
        )
    for state, lines in dict(picture.ties).items():
        colour, dash = TIES[state]
        label = "tie" if state == "elastic" else f"tie, {state}"
        axes.add_collection(
            LineCollection(lines, color=colour, lw=1.2 * bold, ls=dash, label=label, zorder=4)
        )  # fmt: skip
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


def whenOf(run, directory, number):
    """When a frame was written: the x of curve.png at its time, else its time."""
    time = frameTimes(directory)[number]
    data = readCurve(directory) if "figure" in run else {}
    if "time_s" in data:
        spec = plan(run, data, directory)["x"]
        if spec["column"] != "time_s":
            value, unit = np.interp(time, data["time_s"], data[spec["column"]]), unitOf(spec)  # fmt: skip
            return (
                f"at {value:.1f} {unit}" if unit == "mm" else f"at {value:.3g} {unit}"
            )
    return f"at {time:.3g} s"
