# SPDX-License-Identifier: GPL-2.0-or-later
"""Elevations of a structure: what is built, cracks.png, and the mechanism of limit analysis."""

import copy
import functools
import itertools
import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from masonry.errors import Refused
from masonry.bricks.geometry import SameTopologyBatch, Solids, boxCorners
from masonry.numbers import drawing
from masonry.numbers.cracks import CRACK, CRACK_SURFACE, CRUSHED, crushed, widths
from .curve_figure import bare, plan, unitOf
from masonry.numbers.files import readCurve, readRun
from masonry.numbers.frames import frameAt, frameTimes, readFrame

from .painting import MORTAR, NONE, SHADES, TIES, Painting, fromBackToFront, rgb
from .views import FROM_ABOVE, IN_SPACE, REACH, courseOf, magnificationOf, scaleText
from .views import spaceViewOf, viewOf

#: Share of its own depth, or of the façade's, by which a block of a part in an elevation reaches
#: into the façade; what belongs to no part, as a platen, need only touch it.
INSIDE = 0.25

#: Blocks of a part. Beside a part with more of them a single block, as a mass on a floor, has no
#: elevation.
SINGLE = 10

#: Arrays of frames of blocks and of joints that are drawn.
NEEDED = (
    "area bodies body cells crushing damage_shear damage_tension displacement kind normal opening"
    " points second_displacement slide".split()
)

LONGEST = 80  # of the scale on paper [1/72 inch]


@dataclass
class Structure:
    """Blocks and joints at one moment."""

    blocks: dict[str, Any]  #: as :func:`masonry.numbers.frames.readFrame` gives them
    joints: dict[str, Any] | None  #: as the blocks; None where there are none to show
    #: name -> ids of bodies, the façades first of all; all blocks are one part if it is empty
    parts: dict[str, list[int]] = field(default_factory=dict)
    #: key of :data:`SHADES` by the id of a body; others are bricks
    shades: dict[int, str] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)  #: texts that stand on bodies
    viewDirections: dict[str, Any] = field(default_factory=dict)  #: by part, as the user gave them
    ground: int | None = None  #: on which blocks fall; it is drawn as far as needed
    #: numbers of the kinds of joints inside units, which are not drawn unless they crack
    seams: tuple[int, ...] = ()
    still: Any = 0.0  #: displacement that is taken off all others [m]
    ties: list[dict[str, Any]] = field(default_factory=list)  #: entries of run.json

    def __post_init__(self):
        cells = {}
        for body, cell in zip(self.blocks["body"], self.blocks["cells"]):
            cells.setdefault(int(body), set()).update(cell)
        #: numbers of the points of every block, by the id of its body
        self.corners = {body: np.array(sorted(own)) for body, own in cells.items()}
        self._outer = {}  # by the shape of blocks
        self.moved = self.blocks["displacement"] - self.still
        if self.ground in self.corners:
            self._layGround()

    def _layGround(self):
        """Let the ground be a slab that is as large as what stands and lies on it."""
        points = self.blocks["points"]
        level = (points + self.moved)[self.corners.pop(self.ground), 2].max()
        nodes = self.points(self.corners)
        both = np.concatenate([points[nodes], (points + self.moved)[nodes]])
        (*low, _), (*high, _) = both.min(axis=0), both.max(axis=0)
        margin = 0.05 * np.ptp(both, axis=0).max()
        slab = boxCorners(
            (*np.array(low) - margin, level - margin), (*np.array(high) + margin, level)
        )
        self.blocks = {**self.blocks, "points": np.concatenate([points, slab])}
        self.moved = np.concatenate([self.moved, np.zeros((8, 3))])
        self.corners[self.ground] = np.arange(len(points), len(points) + 8)
        self.shades = {**self.shades, self.ground: "ground"}

    def points(self, bodies):
        return np.concatenate([self.corners[body] for body in bodies])

    def outer(self, body):
        """Numbers of the points of a block that are corners; a deformable unit has more."""
        own = self.corners[body]
        if len(own) <= 8:
            return own
        points = self.blocks["points"][own]
        shape = np.rint((points - points[0]) / (1e-6 * np.ptp(points))).astype(int).tobytes()
        if shape not in self._outer:  # those of blocks of one shape are the same
            from scipy.spatial import ConvexHull

            self._outer[shape] = np.sort(ConvexHull(points).vertices)
        return own[self._outer[shape]]

    @functools.cached_property
    def cracks(self):
        """Joints that are cracked, crushed or seams: a list with an entry for each side of all
        joints that have the same number of corners. An entry has arrays: the bodies on this side;
        the numbers of the joints; their kinds, as in :mod:`masonry_view.painting`; their crushing,
        or 0 [m]; their corners as built [m]; and how these move with the bodies [m].
        """
        j, found = self.joints, []
        if not j:
            return found
        _, opened, cracked = widths(j)
        spoilt = crushed(j)
        seam = np.isin(j["kind"], self.seams) if self.seams else spoilt & False
        kinds = np.select([cracked & opened, cracked, seam], range(NONE), NONE)
        closures = np.where(spoilt, j["crushing"], 0)
        chosen = np.flatnonzero((kinds < NONE) | spoilt)
        sizes = np.array([len(j["cells"][n]) for n in chosen])
        for size in np.unique(sizes):
            here = chosen[sizes == size]
            cells = np.array([j["cells"][n] for n in here])
            alike = here, kinds[here], closures[here], j["points"][cells]
            for own, name in zip(j["bodies"][here].T, ("displacement", "second_displacement")):
                found.append((own, *alike, j[name][cells] - self.still))
        return found


class Elevation:
    """What is seen of a structure from one side: a façade with all that stands in it, or all of it
    in space.

    :param view: a :class:`masonry_view.views.View`; ``bodies``: ids of the blocks that are drawn
    :param members: those of the façade, of which it is said whether they moved across it
    :param moment: said of it if the other elevations show another one
    """

    def __init__(self, structure, name, view, bodies, members=(), moment=""):
        self.structure, self.name, self.view, self.bodies = structure, name, view, bodies
        self.to = np.column_stack([view.right, view.up])
        self.nodes = structure.points(bodies)
        self.note, self.across = " ".join(t for t in (view.name, moment) if t), 0.0
        if len(members):
            moved = structure.moved[structure.points(members)]
            across = moved @ view.towards
            farthest = across[np.argmax(np.abs(across))]
            if abs(farthest) > 0.5 * np.linalg.norm(moved @ self.to, axis=1).max():
                self.across = abs(farthest)
                sense = "towards" if farthest > 0 else "away from"
                self.note += f"\n(moved up to {1e3 * self.across:.3g} mm {sense} the viewer)"

    def flat(self, points):
        return (points - self.view.start) @ self.to

    def box(self, magnification):
        """Two corners of what is drawn but for what flew away, with room for the scale below."""
        flat = self.flat(self.structure.blocks["points"][self.nodes])
        now = flat + magnification * self.structure.moved[self.nodes] @ self.to
        low, high = flat.min(axis=0), flat.max(axis=0)
        reach = REACH * (high - low).max()
        low = np.maximum(np.minimum(low, now.min(axis=0)), low - reach)
        high = np.minimum(np.maximum(high, now.max(axis=0)), high + reach)
        margins = np.array([[-0.045, -0.12], [0.045, 0.045]])
        return np.array([low, high]) + (high - low).max() * margins

    def draw(self, axes, magnification, scale):
        """Draw it.

        :param magnification: of displacements; 0: as built
        :param scale: length of a metre on paper [1/72 inch], which sets the widths of lines
        """
        from matplotlib.collections import LineCollection, PolyCollection

        s, sight = self.structure, np.array([*self.to.T, self.view.towards])
        nodes = [s.outer(body) for body in self.bodies]
        corners = [s.blocks["points"][own] for own in nodes]
        built, course = Solids(corners), scale * courseOf(corners)
        thin, bold = np.clip(0.06 * course, 0.15, 0.5), np.clip(0.21 * course, 0.7, 1.8)
        painting = Painting(self.view.towards, thin, bold)
        now = copy.copy(built)
        now.groups = []
        for g in built.groups:
            moved = s.moved[np.array([nodes[n] for n in g.index])]
            now.groups.append(
                SameTopologyBatch(g.index, g.corners + magnification * moved, g.faces)
            )
            if magnification:
                painting.blocks(np.full(len(g.index), -1), g)
        colours = np.array([rgb(SHADES[s.shades.get(body, "brick")]) for body in self.bodies])
        # the joints of a block come after it and before the next block
        places = 10**9 * np.argsort(fromBackToFront(now, sight))
        for g in now.groups:
            painting.blocks(places[g.index], g, colours[g.index])
        number = {body: n for n, body in enumerate(self.bodies)}
        for own, *crack, moved in s.cracks:
            block = np.array([number.get(body, -1) for body in own.tolist()])
            crack = [v[block >= 0] for v in (block, *crack, crack[-1] + magnification * moved)]
            painting.cracks(places, crack, built, now, colours)
        painting.finish(axes, self.flat, s.joints is not None)
        for shade in sorted({s.shades[b] for b in self.bodies if b in s.shades}):
            look = dict(facecolor=SHADES[shade], edgecolor=MORTAR, label=shade)
            axes.add_collection(PolyCollection([], **look))
        for body in set(s.names) & set(self.bodies):
            middle = self.flat(s.blocks["points"][s.corners[body]]).mean(axis=0)
            axes.annotate(s.names[body], middle, ha="center", va="center", fontsize=8)
        for state, (colour, dash) in TIES.items():
            ties = [t for t in s.ties if t["state"] == state and set(t["bodies"]) & {*self.bodies}]
            if ties:
                ends = [self._tie(tie, magnification) for tie in ties]
                look = dict(color=colour, lw=1.2 * bold, ls=dash, zorder=4)
                label = "tie" if state == "elastic" else f"tie, {state}"
                axes.add_collection(LineCollection(ends, **look, label=label))
        self._frame(axes, magnification, scale)

    def _frame(self, axes, magnification, scale):
        low, high = self.box(magnification)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        axes.spines[["top", "right"]].set_visible(False)
        if self.view.name == IN_SPACE:
            axes.set_axis_off()
        axes.set_xlabel(self.view.labels[0])
        axes.set_ylabel(self.view.labels[1])
        most = LONGEST / scale
        power = 10.0 ** np.floor(np.log10(most))
        length = max(n * power for n in (1, 2, 5) if n * power <= most)
        x, y = low + 8 / scale
        look = dict(color="black", lw=2, solid_capstyle="butt", label="_scale")
        axes.plot([x, x + length], [y, y], **look)
        place = dict(xytext=(4, 0), textcoords="offset points", va="center")
        axes.annotate(f"{length:g} m", (x + length, y), **place, fontsize=8)

    def _tie(self, tie, magnification):
        s, ends = self.structure, []
        for body, end in zip(tie["bodies"], np.array(tie["ends_m"])):
            moved = np.zeros(3)  # it is held by the ground, or moves with its corners
            if body in s.corners:
                nodes = s.corners[body]
                arms = s.blocks["points"][nodes] - end
                basis = np.column_stack([arms, np.ones(len(arms))])
                moved = np.linalg.lstsq(basis, s.moved[nodes], None)[0][3]
            ends.append(self.flat(end) + magnification * moved @ self.to)
        return ends


def elevationsOf(structure):
    """One elevation for each façade; none for a part that is held, or seen in that of a larger
    one."""
    stands = lambda part: any(structure.shades.get(body) != "held" for body in part)
    parts = {n: part for n, part in structure.parts.items() if stands(part)} or {
        "": list(structure.corners)
    }
    least = 2 if max(map(len, parts.values())) > SINGLE else 1
    found, seen = {}, set()
    isIn = lambda part, bodies: len(bodies.intersection(part)) > 0.5 * len(part)
    for name, members in sorted(parts.items(), key=lambda part: -len(part[1])):
        if len(members) >= least and not isIn(members, seen):
            found[name] = one = _facade(structure, name, members)
            seen.update(one.bodies)
            # "front" of "front 1", "front 2" and "front 2 pier 1"
            words = [n.split() for n, part in parts.items() if isIn(part, {*one.bodies})]
            alike = zip(*(w for w in words if w[:1] == name.split()[:1]))
            same = itertools.takewhile(lambda nth: len({*nth}) == 1, alike)
            one.name = " ".join(nth[0] for nth in same)
    return [found[name] for name in parts if name in found]


def _facade(structure, name, members):
    """The :class:`Elevation` of a part, with all that reaches into the depth of it."""
    points, joints = structure.blocks["points"], structure.joints
    normals, areas = np.zeros((0, 3)), np.zeros(0)
    if joints:
        own = np.isin(joints["bodies"], members).all(axis=1)
        normals, areas = joints["normal"][own], joints["area"][own]
    nodes = structure.points(members)
    view = viewOf(points[nodes], normals, areas, structure.viewDirections.get(name))
    depth = points @ view.towards
    near, far = depth[nodes].max(), depth[nodes].min()
    parted = {body for part in structure.parts.values() for body in part}

    def reaches(body, own):
        high, low = depth[own].max(), depth[own].min()
        inside = INSIDE if body in parted else -1e-6
        return min(high, near) - max(low, far) >= inside * min(high - low, near - far)

    bodies = [body for body, own in structure.corners.items() if reaches(body, own)]
    return Elevation(structure, name, view, bodies, members)


def figureOf(structure, title, magnification=None, later=None):
    """A figure of all façades in one scale, for use in :func:`masonry.numbers.drawing.style`: the
    magnified deformed structure over the undeformed one, with its cracks. What moves across a
    façade, is seen from above or falls is seen in space, too.

    :param title: ``{}`` in it is what is said of the magnification
    :param magnification: 0: as built; None: that of :func:`magnificationOf`
    :param later: a moment and the structure then, drawn true to scale; or None
    """
    elevations = elevationsOf(structure)
    if magnification is None:
        nodes = structure.points(structure.corners)
        blocks = [structure.blocks["points"][own] for own in structure.corners.values()]
        magnification = magnificationOf(structure.joints, structure.moved[nodes], blocks)
    scales = [magnification] * len(elevations)
    front = max(elevations, key=lambda one: (one.across, len(one.bodies))).view.towards
    names = {one.view.name for one in elevations}
    across = FROM_ABOVE in names or any(one.across for one in elevations)
    moments = [(*later, 1)] if later else []
    if across and IN_SPACE not in names:
        moments.insert(0, ("", structure, magnification))
    for moment, one, m in moments:
        nodes = one.points(one.corners)
        view = spaceViewOf(front, one.blocks["points"][nodes], one.moved[nodes])
        elevations.append(Elevation(one, "", view, list(one.corners), moment=moment))
        scales.append(m)
    boxes = [one.box(m) for one, m in zip(elevations, scales)]
    sizes = np.array([high - low for low, high in boxes])
    columns = max(range(1, len(sizes) + 1), key=lambda n: _scale(sizes, n))
    scale = _scale(sizes, columns)
    wides, highs = (scale * cells for cells in _cells(sizes, columns))
    # inches for labels beside and below each, for the legend at the right, and for the title
    above = 0.85 if title else 0.3
    width = max(sum(wides) + 0.85 * columns + 1.6, 7.0)
    height = sum(highs) + 0.75 * len(highs) + above
    figure, handles = drawing.empty(width, height), {}
    for n, one in enumerate(elevations):
        row, column = divmod(n, columns)
        x = 0.7 + sum(wides[:column]) + 0.85 * column
        y = height - above - sum(highs[: row + 1]) - 0.75 * row
        w, h = scale * sizes[n]
        axes = figure.add_axes([x / width, y / height, w / width, h / height])
        one.draw(axes, scales[n], 72 * scale)
        head = f"{one.name if len(sizes) > 1 else ''} {one.note}".strip()
        axes.set_title(head, fontsize=9, pad=3)
        handles.update((label, handle) for handle, label in zip(*axes.get_legend_handles_labels()))
    if title:
        if structure.joints is not None:  # else nothing has moved
            title = title.replace("{}", scaleText(structure.joints, magnification))
        figure.suptitle(title, fontsize=9, x=0.3 / width, y=1 - 0.1 / height, ha="left")
    if handles:
        place = dict(loc="upper right", bbox_to_anchor=(1 - 0.08 / width, 1 - above / height))
        figure.legend(handles.values(), handles, **place, fontsize=8)
    return figure


def _cells(sizes, columns):
    wides = [max(sizes[c::columns, 0]) for c in range(columns)]
    highs = [max(sizes[n : n + columns, 1]) for n in range(0, len(sizes), columns)]
    return np.array(wides), np.array(highs)


def _scale(sizes, columns):
    wides, highs = _cells(sizes, columns)
    most = 7.2 if len(sizes) == 1 else 10.0 - 0.85 * columns
    return min(most / sum(wides), (9.5 - 0.75 * len(highs)) / sum(highs))


def structureOf(run, blocks, joints, directory):
    """The blocks and joints of a frame with what run.json says of them. Raises Refused.

    :param directory: folder, for messages
    """
    bodies = set(map(int, blocks["body"]))
    parts, reference = run.get("parts") or {}, run.get("reference_body")
    members = {body for part in parts.values() for body in part}
    ground, still = run.get("ground_body"), np.zeros(3)
    wrong = (members | {reference} - {None}) - bodies
    if wrong:
        raise Refused(
            f"{directory}: run.json names bodies {sorted(wrong)[:10]}, which are not in the"
            " ParaView files"
        )
    if reference is not None:
        nodes = [c for b, c in zip(blocks["body"], blocks["cells"]) if b == reference]
        still = blocks["displacement"][np.concatenate(nodes)].mean(axis=0)
    for name, part in parts.items():
        if not part:
            raise Refused(f"{directory}: parts: {name} has no bodies")
    targets, kinds = run.get("targets") or [], run.get("kinds") or []
    shades = {one["body"]: "held" for one in targets if one.get("held")}
    shades.update(dict.fromkeys(bodies - (members or bodies) - {ground}, "platen"))
    seams = tuple(n for n, kind in enumerate(kinds) if kind == CRACK_SURFACE)
    views, ties = run.get("views") or {}, run.get("ties") or []
    seen = dict(viewDirections=views, ground=ground, seams=seams, still=still, ties=ties)
    return Structure(blocks, joints, parts, shades, **seen)


def cracksOf(run, blocks, joints, when, directory, later=None):
    """The figure of cracks.png: open joints red, slid ones blue, crushed spots black. Raises
    Refused.

    :param when: names the moment of the frame; ``later`` is as in :func:`figureOf`
    """
    limits = f"open or slid more than {1e3 * CRACK:g} mm, crushed more than {1e3 * CRUSHED:g} mm"
    title = f"{run['title']}\n{when}\n{{}}; {limits}"
    return figureOf(structureOf(run, blocks, joints, directory), title, later=later)


def cracksOfRun(run, directory):
    """The figure of cracks.png of a run; of a collapse with its end beside it."""
    frames = lambda n: [readFrame(directory, kind, n, NEEDED) for kind in ("blocks", "joints")]
    last, chosen, later = len(frameTimes(directory)) - 1, frameOfCracks(run, directory), None
    if chosen != last:
        end = structureOf(run, *frames(last), directory)
        later = f"{whenOf(run, directory, last)}, true to scale", end
    when = whenOf(run, directory, chosen)
    return cracksOf(run, *frames(chosen), when, directory, later)


def cracks(directory):
    with drawing.style():
        figure = cracksOfRun(readRun(directory), directory)
        drawing.save(figure, os.path.join(directory, "cracks.png"), 110)


#: What is said of the moments of a collapse, by their names among the answers of the run.
MOMENTS = {
    "noticed_at": "when the collapse was noticed",
    "first_fall": "when the first block had fallen",
}


def _moments(run, directory):
    """Numbers of the frames nearest to the moments of a collapse, and what they are, in order."""
    times = {a["name"]: a["value"] for a in run.get("answers") or [] if a["stage"] == "fall"}
    found = sorted((times[name], text) for name, text in MOMENTS.items() if name in times)
    return [(frameAt(directory, time), text) for time, text in found]


def frameOfCracks(run, directory):
    """Number of the frame whose cracks are drawn, from 0: the last one, or that when a collapse was
    noticed or the first block had fallen."""
    moments = _moments(run, directory)
    return moments[0][0] if moments else len(frameTimes(directory)) - 1


def whenOf(run, directory, number):
    """Which moment a frame shows: what it is, its time, and the x of curve.png."""
    times = frameTimes(directory)
    names = {len(times) - 1: "at the end", **dict(reversed(_moments(run, directory)))}
    texts = [f"t = {times[number]:.3g} s"]
    data = readCurve(directory) if "figure" in run else {}
    if "time_s" in data:
        spec = plan(run, data, directory)["x"]
        if spec["column"] != "time_s":
            value, unit = np.interp(times[number], data["time_s"], data[spec["column"]]), unitOf(
                spec
            )
            shown = f"{value:.1f}" if unit == "mm" else f"{value:.3g}"
            texts.append(f"{bare(spec['label'])} = {shown} {unit}")
    return f"{names.get(number, 'during the run')}: {', '.join(texts)}"
