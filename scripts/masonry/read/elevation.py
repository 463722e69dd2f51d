# SPDX-License-Identifier: GPL-2.0-or-later
"""Elevations of a structure: what is built, cracks.png, and the mechanism of limit analysis. This module needs no YADE."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arguments import FilePath
from ..basics import Refused
from . import drawing
from .cracks import CRACK, CRUSHED, crushed, widths
from .curve_figure import plan, unitOf
from .files import readCurve, readRun
from .frames import frameAt, frameTimes, readFrame
from .views import REACH, magnificationOf, outline, viewOf

ASKEW = 0.14  # cosine from which a joint is drawn as an area, not as a line: 8° between its face and the line of sight
#: A block of a part is in an elevation if it reaches into the depth of the façade by this share of its own depth or of the
#: façade's; what belongs to no part, as a platen, if it touches this depth.
INSIDE = 0.25

BRICK, PLATEN = "#f3e3c8", "#c3c6ca"
#: Colours of blocks that are no plain bricks, by what the legend says.
SHADES = {
    "held": "0.45",
    "loaded": "#9fc3e6",
    "watched": "#c7e0b4",
    "loaded or watched": "#9fc3e6",
    "platen": PLATEN,
}
CRACKS = {"open": "tab:red", "slid": "tab:blue"}
#: Lines of ties by their state.
TIES = {"elastic": ("0.2", "-"), "yielded": ("tab:orange", "-"), "broken": ("tab:purple", ":")}  # fmt: skip


@dataclass
class Structure:
    """Blocks and joints at one moment.

    - ``blocks``, ``joints``: as :func:`masonry.read.frames.readFrame` gives them; ``joints`` is None where there are none to show
    - ``parts``: name -> ids of bodies, the façades first of all; all blocks are one part if it is empty
    - ``shades``: key of :data:`SHADES` by the id of a body; others are bricks
    - ``names``: texts that stand on bodies, by their ids
    - ``sights``: directions of sight by part; ``hidden``: ids of bodies that are not drawn, such as that of the ground
    - ``still``: displacement that is taken off all others [m]
    - ``ties``: entries of run.json
    """

    blocks: dict[str, Any]
    joints: dict[str, Any] | None
    parts: dict[str, list[int]] = field(default_factory=dict)
    shades: dict[int, str] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    sights: dict[str, Any] = field(default_factory=dict)
    hidden: tuple[int, ...] = ()
    still: Any = 0.0
    ties: list[dict[str, Any]] = field(default_factory=list)

    def __post_init__(self):
        cells: dict[int, list[Any]] = {}
        for body, cell in zip(self.blocks["body"], self.blocks["cells"]):
            if body not in self.hidden:
                cells.setdefault(int(body), []).append(cell)
        #: numbers of the points of every block, by the id of its body
        self.corners = {body: np.unique(np.concatenate(c)) for body, c in cells.items()}
        self.moved = self.blocks["displacement"] - self.still

    def points(self, bodies):
        """Numbers of the points of some blocks."""
        return np.concatenate([self.corners[body] for body in bodies])


class Elevation:
    """A façade and what is seen of the structure in it."""

    def __init__(self, structure, name, members):
        self.structure, self.name = structure, name
        points, joints = structure.blocks["points"], structure.joints
        normals, areas = np.zeros((0, 3)), np.zeros(0)
        if joints:
            inside = np.isin(joints["bodies"], members).all(axis=1)
            normals, areas = joints["normal"][inside], joints["area"][inside]
        nodes = structure.points(members)
        self.view = viewOf(points[nodes], normals, areas, structure.sights.get(name))
        depth = points @ self.view.towards
        near, far = depth[nodes].max(), depth[nodes].min()
        parted = {body for part in structure.parts.values() for body in part}
        self.bodies = []
        for body, own in structure.corners.items():
            high, low = depth[own].max(), depth[own].min()
            common = min(high, near) - max(low, far)
            inside = INSIDE if body in parted else -1e-6
            if common >= inside * min(high - low, near - far):
                self.bodies.append(body)
        self.to = np.column_stack([self.view.right, self.view.up])
        self.nodes = structure.points(self.bodies)
        moved = structure.moved[nodes]
        self.inPlane = np.linalg.norm(moved @ self.to, axis=1)
        across = moved @ self.view.towards
        farthest = across[np.argmax(np.abs(across))]
        self.note = self.view.name
        if abs(farthest) > self.inPlane.max():
            sense = "towards" if farthest > 0 else "away from"
            self.note += f" (moved up to {1e3 * abs(farthest):.3g} mm {sense} the viewer)"  # fmt: skip

    def flat(self, points):
        return (points - self.view.start) @ self.to

    def size(self):
        return np.ptp(self.flat(self.structure.blocks["points"][self.nodes]), axis=0).max()  # fmt: skip

    def box(self, magnification):
        """Two corners of what is drawn: all of it, but for what flew away."""
        flat = self.flat(self.structure.blocks["points"][self.nodes])
        now = flat + magnification * self.structure.moved[self.nodes] @ self.to
        low, high = flat.min(axis=0), flat.max(axis=0)
        reach = REACH * (high - low).max()
        low = np.maximum(np.minimum(low, now.min(axis=0)), low - reach)
        high = np.minimum(np.maximum(high, now.max(axis=0)), high + reach)
        return np.array([low, high]) + 0.045 * (high - low).max() * np.array([[-1], [1]])  # fmt: skip

    def draw(self, axes, magnification, scale):
        """Draw it.

        :param magnification: of displacements; 0: as built
        :param scale: length of a metre on paper [1/72 inch], by which lines are as thin as needed
        """
        from matplotlib.collections import LineCollection, PolyCollection

        s = self.structure
        faces = []
        for body in self.bodies:
            points = s.blocks["points"][s.corners[body]]
            moved = magnification * s.moved[s.corners[body]]
            flat, depth = self.flat(points), points @ self.view.towards
            rim = outline(flat, depth)
            near = (depth + moved @ self.view.towards).max()
            faces.append((near, flat[rim], flat[rim] + moved[rim] @ self.to, s.shades.get(body)))  # fmt: skip
        faces.sort(key=lambda face: face[0])  # from the back to the front
        course = np.median([np.ptp(face[1], axis=0).min() for face in faces]) * scale
        thin, bold = np.clip(0.041 * course, 0.1, 0.35), np.clip(0.21 * course, 0.7, 1.8)  # fmt: skip
        many = len(faces) > 1500  # an SVG file has a picture of so many
        if magnification:
            axes.add_collection(PolyCollection([f[1] for f in faces], facecolor="0.9", edgecolor="0.8", lw=0.85 * thin, rasterized=many))  # fmt: skip
        colours = [SHADES.get(face[3], BRICK) for face in faces]
        axes.add_collection(PolyCollection([f[2] for f in faces], facecolor=colours, edgecolor="0.45", lw=thin, rasterized=many))  # fmt: skip
        for shade in sorted({face[3] for face in faces if face[3]}):
            axes.add_collection(PolyCollection([], facecolor=SHADES[shade], edgecolor="0.45", label=shade))  # fmt: skip
        for body in set(s.names) & set(self.bodies):
            middle = self.flat(s.blocks["points"][s.corners[body]]).mean(axis=0)
            axes.annotate(s.names[body], middle, ha="center", va="center", fontsize=8)
        if s.joints:
            self._cracks(axes, magnification, bold)
        for state, (colour, dash) in TIES.items():
            ends = [self._tie(one, magnification) for one in s.ties if one["state"] == state and set(one["bodies"]) & set(self.bodies)]  # fmt: skip
            if ends:
                label = "tie" if state == "elastic" else f"tie, {state}"
                axes.add_collection(LineCollection(ends, color=colour, lw=1.2 * bold, ls=dash, label=label, zorder=4))  # fmt: skip
        low, high = self.box(magnification)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        axes.set_xlabel(self.view.labels[0])
        axes.set_ylabel(self.view.labels[1])

    def _cracks(self, axes, magnification, bold):
        """Joints that are open, slid or crushed, on the faces of both blocks. What is cracked most is drawn last."""
        from matplotlib.collections import LineCollection, PolyCollection

        j = self.structure.joints
        size, opened, cracked = widths(j)
        spoilt = crushed(j)
        mine = np.isin(j["bodies"], self.bodies).any(axis=1)
        areas, lines, spots = {"open": [], "slid": []}, [], []
        for i in np.flatnonzero(mine & (cracked | spoilt))[np.argsort(size[mine & (cracked | spoilt)])]:  # fmt: skip
            cell, kind = j["cells"][i], "open" if opened[i] else "slid"
            flat = self.flat(j["points"][cell])
            along = np.cross(j["normal"][i], self.view.towards)
            for name in ("displacement", "second_displacement"):
                now = flat + magnification * (j[name][cell] - self.structure.still) @ self.to  # fmt: skip
                if spoilt[i] and name == "displacement":
                    spots.append((*now.mean(axis=0), 12 + 8e3 * j["crushing"][i]))
                if not cracked[i]:
                    continue
                if abs(j["normal"][i] @ self.view.towards) > ASKEW:
                    areas[kind].append(now)
                    continue
                reach = flat @ (along @ self.view.right, along @ self.view.up)
                lines.append((now[[reach.argmin(), reach.argmax()]], kind))
        for kind, colour in CRACKS.items():
            if areas[kind]:
                axes.add_collection(PolyCollection(areas[kind], facecolor=colour, alpha=0.35, lw=0, label=kind + ", its face"))  # fmt: skip
            axes.add_collection(LineCollection([], color=colour, lw=bold, label=kind))
        axes.add_collection(LineCollection([ends for ends, _ in lines], colors=[CRACKS[kind] for _, kind in lines], lw=bold))  # fmt: skip
        if spots:
            x, y, wide = np.transpose(spots)
            axes.scatter(x, y, s=wide * min(1, bold / 1.8) ** 2, color="black", marker="X", lw=0, label="crushed", zorder=5)  # fmt: skip

    def _tie(self, tie, magnification):
        s, ends = self.structure, []
        for body, end in zip(tie["bodies"], np.array(tie["ends_m"])):
            moved = np.zeros(3)
            # it moves with its corners; without one it is held by the ground
            if body in s.corners:
                nodes = s.corners[body]
                arms = s.blocks["points"][nodes] - end
                basis = np.column_stack([arms, np.ones(len(arms))])
                moved = np.linalg.lstsq(basis, s.moved[nodes], None)[0][3]
            ends.append(self.flat(end) + magnification * moved @ self.to)
        return ends


def elevationsOf(structure: Structure) -> list[Elevation]:
    """One elevation for each façade: the largest parts first, and none for a part that is seen in another one's."""
    parts = structure.parts or {"": list(structure.corners)}
    found: list[Elevation] = []
    seen: set[int] = set()
    for name, members in sorted(parts.items(), key=lambda part: -len(part[1])):
        if len(seen & set(members)) > 0.5 * len(members):
            continue
        found.append(Elevation(structure, name, members))
        seen |= set(found[-1].bodies)
    order = list(parts)
    return sorted(found, key=lambda one: order.index(one.name))


def figureOf(structure: Structure, title: str, magnification: float | None = None) -> Any:  # fmt: skip
    """A figure of all façades in one scale, to be drawn and saved in :func:`masonry.read.drawing.style`: the deformed structure,
    magnified, over the undeformed one, with its cracks.

    :param title: above it; ``{}`` in it is the magnification
    :param magnification: of displacements; 0: the structure as it is built; None: as in :func:`magnificationOf`
    """
    elevations = elevationsOf(structure)
    if magnification is None:
        size = max(one.size() for one in elevations)
        magnification = magnificationOf(size, np.concatenate([one.inPlane for one in elevations]))  # fmt: skip
    boxes = [one.box(magnification) for one in elevations]
    sizes = np.array([high - low for low, high in boxes])
    columns = max(range(1, len(sizes) + 1), key=lambda n: _scale(sizes, n))
    scale = _scale(sizes, columns)
    rows = [range(n, min(n + columns, len(sizes))) for n in range(0, len(sizes), columns)]  # fmt: skip
    wides = [scale * max(sizes[c::columns, 0]) for c in range(columns)]
    highs = [scale * max(sizes[n, 1] for n in row) for row in rows]
    # inches for labels beside and below each, for the legend at the right, and for the title
    above = 0.75 if title else 0.3
    width, height = max(sum(wides) + 0.85 * columns + 1.6, 7.0), sum(highs) + 0.75 * len(rows) + above  # fmt: skip
    figure = drawing.empty(width, height)
    y, handles = height - above, {}
    for row, high in zip(rows, highs):
        x, y = 0.7, y - high
        for n, wide in zip(row, wides):
            w, h = scale * sizes[n]
            axes = figure.add_axes([x / width, y / height, w / width, h / height])
            elevations[n].draw(axes, magnification, 72 * scale)
            head = f"{elevations[n].name if len(sizes) > 1 else ''} {elevations[n].note}"  # fmt: skip
            axes.set_title(head.strip(), fontsize=9, pad=3)
            handles.update((label, handle) for handle, label in zip(*axes.get_legend_handles_labels()))  # fmt: skip
            x += wide + 0.85
        y -= 0.75
    if title:
        figure.suptitle(title.replace("{}", str(magnification)), fontsize=10, y=1 - 0.1 / height)  # fmt: skip
    if handles:
        figure.legend(handles.values(), handles, loc="upper right", fontsize=8, bbox_to_anchor=(1 - 0.08 / width, 1 - above / height))  # fmt: skip
    return figure


def _scale(sizes, columns):
    """The largest scale with which elevations of these sizes [m] stand on a page in so many columns [inch/m]."""
    wide = sum(max(sizes[c::columns, 0]) for c in range(columns))
    high = sum(max(sizes[n : n + columns, 1]) for n in range(0, len(sizes), columns))
    rows = -(-len(sizes) // columns)
    return min((10.0 - 0.85 * columns) / wide, (9.5 - 0.75 * rows) / high, 7.2 / wide if len(sizes) == 1 else np.inf)  # fmt: skip


# -- of a run ---------------------------------------------------------------------------------------------------------


def structureOf(run: dict[str, Any], blocks: dict[str, Any], joints: dict[str, Any] | None, directory: FilePath) -> Structure:  # fmt: skip
    """The blocks and joints of a frame with what run.json says of them. Raises Refused.

    :param run: entries of run.json: ``parts``, ``views``, ``targets``, ``ties``, ``reference_body`` and ``ground_body``
    :param directory: folder, for messages
    """
    bodies = set(map(int, blocks["body"]))
    parts, reference = run.get("parts") or {}, run.get("reference_body")
    wrong = {body for part in parts.values() for body in part} - bodies
    still = np.zeros(3)
    if reference is not None:
        nodes = [c for b, c in zip(blocks["body"], blocks["cells"]) if b == reference]
        if nodes:
            still = blocks["displacement"][np.concatenate(nodes)].mean(axis=0)
        else:
            wrong.add(reference)
    if wrong:
        raise Refused(f"{directory}: run.json names bodies {sorted(wrong)[:10]}, which are not in the ParaView files")  # fmt: skip
    for name, members in parts.items():
        if not members:
            raise Refused(f"{directory}: parts: {name} has no bodies")
    masonry = {body for part in parts.values() for body in part} or bodies
    ground = run.get("ground_body")
    return Structure(
        blocks,
        joints,
        parts,
        {body: "platen" for body in bodies - masonry},
        sights=run.get("views") or {},
        hidden=() if ground is None else (ground,),
        still=still,
        ties=run.get("ties") or [],
    )


def cracksOf(run: dict[str, Any], blocks: dict[str, Any], joints: dict[str, Any], when: str, directory: FilePath) -> Any:  # fmt: skip
    """The figure of cracks.png. Cracks are red, joints that slid are blue, and crushed spots are black. Raises Refused.

    :param when: text that says when the frame was written; the others are those of :func:`structureOf`
    """
    title = (
        f"{run['title']}\n{when}, displacements × {{}}; "
        f"open or slid more than {1e3 * CRACK:g} mm, crushed more than {1e3 * CRUSHED:g} mm"
    )
    return figureOf(structureOf(run, blocks, joints, directory), title)


def cracks(directory: FilePath, number: int | None = None) -> None:
    """Draw cracks.png of a frame that a run has left.

    :param number: of the frame, from 0; negative numbers count from the end; None: as in :func:`frameOfCracks`
    """
    run = readRun(directory)
    number = frameOfCracks(run, directory) if number is None else number
    blocks, joints = (readFrame(directory, kind, number) for kind in ("blocks", "joints"))  # fmt: skip
    with drawing.style():
        figure = cracksOf(run, blocks, joints, whenOf(run, directory, number), directory)  # fmt: skip
        drawing.save(figure, os.path.join(directory, "cracks.png"), 90)


def frameOfCracks(run: dict[str, Any], directory: FilePath) -> int:
    """Number of the frame whose cracks are drawn, from 0: the last one, or, of a run that followed a collapse to the ground, that
    when the collapse was noticed or the first block had fallen.

    :param run: entries of run.json
    """
    answers = {a["name"]: a["value"] for a in run.get("answers") or [] if a["stage"] == "fall"}  # fmt: skip
    found = [answers[n] for n in ("noticed_at", "first_fall") if n in answers]
    return frameAt(directory, min(found)) if found else len(frameTimes(directory)) - 1


def whenOf(run: dict[str, Any], directory: FilePath, number: int) -> str:
    """When a frame was written: the x of curve.png at its time, else its time."""
    time = frameTimes(directory)[number]
    data = readCurve(directory) if "figure" in run else {}
    if "time_s" in data:
        spec = plan(run, data, directory)["x"]
        if spec["column"] != "time_s":
            value, unit = np.interp(time, data["time_s"], data[spec["column"]]), unitOf(spec)  # fmt: skip
            return f"at {value:{'.1f' if unit == 'mm' else '.3g'}} {unit}"
    return f"at {time:.3g} s"
