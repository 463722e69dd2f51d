# SPDX-License-Identifier: GPL-2.0-or-later
"""The one style of all pictures of blocks: its colours, which pages, models and ParaView have, too, and how matplotlib draws faces,
light and cracks."""

import heapq
import numpy as np

from .views import LEVEL

GHOST = "#e6e6e6"  # where blocks stood
MORTAR = "#595959"  # joints that are not cracked
#: Colours of blocks, by what the legend says of them if they are no bricks.
SHADES = {
    "brick": "#f3e3c8",
    "held": "#85898f",
    "loaded": "#9fc3e6",
    "watched": "#c7e0b4",
    "loaded or watched": "#9fc3e6",
    "platen": "#c3c6ca",
    "ground": "#a3ad98",
}
CRACKS, CRUSHED = {"open": "#d62728", "slid": "#1f77b4"}, "#101010"
MOST = 5e-3  # [m] closure from which the sign of a crushed point is no larger
#: Lines of ties by their state.
TIES = {"elastic": ("#333333", "-"), "yielded": ("#ff7f0e", "-"), "broken": ("#9467bd", ":")}  # fmt: skip


def rgb(colour):
    """Red, green and blue of a colour "#rrggbb", from 0 to 255."""
    return np.array(list(bytes.fromhex(colour[1:])))


def mixed(first, share, second):
    """A colour that has this share of a first one, and of a second one the rest."""
    parts = np.rint(share * rgb(first) + (1 - share) * rgb(second)).astype(int)
    return "#" + bytes(parts.tolist()).hex()


#: Of the faces of cracked joints.
FACES = {kind: mixed(colour, 0.45, SHADES["brick"]) for kind, colour in CRACKS.items()}


def fromBackToFront(solids, sight):
    """Numbers of convex blocks in the order in which they are drawn, so that each hides what is behind it.

    Of two blocks whose pictures overlap, that is in front which lies on the viewer's side of a face that parts them.
    Where these answers go in a circle, the block that is farthest away comes first.

    :param solids: :class:`masonry.bricks.geometry.Solids`
    :param sight: unit vectors of the picture: right, up and towards the viewer, the rows of an array
    """
    low, high = np.zeros((2, solids.count, 3))
    for group in solids.groups:
        seen = group.corners @ sight.T
        low[group.index], high[group.index] = seen.min(axis=1), seen.max(axis=1)
    slack = 1e-3 * np.median(high - low)
    of = {n: one for group in solids.groups for n, *one in zip(group.index.tolist(), group.corners, group.normals, group.offsets)}  # fmt: skip
    after = [[] for _ in range(solids.count)]
    for a in range(solids.count):
        over = (low[a, :2] < high[a + 1 :, :2] - slack) & (low[a + 1 :, :2] < high[a, :2] - slack)  # fmt: skip
        for b in (a + 1 + np.flatnonzero(over.all(axis=1))).tolist():
            nearer = _nearer(of[a], of[b], sight[2], slack)
            if nearer:
                after[a if nearer > 0 else b].append(b if nearer > 0 else a)
    hidden = [n for fronts in after for n in fronts]
    pending = np.bincount(hidden, minlength=solids.count)
    depth, left, order = (low + high)[:, 2], set(range(solids.count)), []
    ready = [(depth[n], n) for n in np.flatnonzero(pending == 0).tolist()]
    heapq.heapify(ready)
    while left:
        n = heapq.heappop(ready)[1] if ready else min(left, key=lambda n: depth[n])
        if n in left:
            left.remove(n)
            order.append(n)
            for front in after[n]:
                pending[front] -= 1
                if not pending[front]:
                    heapq.heappush(ready, (depth[front], front))
    return order


def _nearer(first, second, towards, slack):
    """1 if the second of two blocks can hide the first, -1 if the first can hide the second, 0 if none hides the other.

    :param first: corners, normals and offsets of its faces
    """
    gaps, facing = [], []
    for (_, normals, offsets), (corners, *_), sign in ((first, second, 1), (second, first, -1)):  # fmt: skip
        gaps.append((corners @ normals.T).min(axis=0) - offsets)
        facing.append(sign * (normals @ towards))
    gaps, facing = np.concatenate(gaps), np.concatenate(facing)
    sides = facing > LEVEL, facing < -LEVEL, np.abs(facing) <= LEVEL
    front, back, beside = (gaps[side].max(initial=-np.inf) for side in sides)
    # planes that part them on both sides, or along the line of sight
    if beside > -slack or min(front, back) > -slack:
        return 0
    return 1 if front > back else -1


class Painting:
    """Polygons and lines, which have two corners, from the back to the front, and where joints are crushed.

    :param towards: unit vector to the viewer; ``thin`` and ``bold``: widths of the lines of blocks and cracks [1/72 inch]
    """

    def __init__(self, towards, thin, bold):
        self.towards, self.thin, self.bold = towards, thin, bold
        self.polygons, self.looks, self.spots, self.kinds = [], [], [], set()

    def add(self, points, fill, edge, wide):
        """A polygon or a line of points in space [m]."""
        self.polygons.append(points)
        self.looks.append((fill, edge, wide))

    def block(self, corners, faces, normals, colour):
        """The faces of a block that are seen, in a colour on which light falls from the viewer and from above."""
        for face, normal in zip(faces, normals):
            if normal @ self.towards > LEVEL:
                edge = GHOST if colour == GHOST else MORTAR
                self.add(corners[list(face)], self.lit(colour, normal), edge, self.thin)

    def lit(self, colour, normal):
        light = min(1, 0.55 + 0.45 * normal @ self.towards + 0.3 * max(normal[2], 0))
        return mixed(colour, light, "#000000") if colour != GHOST else colour

    def cracks(self, found, built, now, near, magnification, colour):
        """Joints of a block that are open, slid or crushed: their faces that are seen, and their edges on its other faces, from
        which the edges of seams are taken away.

        :param found: as :meth:`masonry.read.elevation.Structure.cracks` gives them
        :param built: normals and offsets of the faces of the block as it was built; ``now``: normals as it is drawn
        :param colour: of the block; ``near``: how far a corner is from a face at most that it lies on [m]
        """
        seen = now @ self.towards > LEVEL
        normals, offsets = built[0][seen], built[1][seen]
        for kind, closure, corners, moved in found:
            drawn = corners + magnification * moved
            on = np.abs(corners @ normals.T - offsets) < near
            whole = on.all(axis=0)
            for normal in now[seen][whole] if kind in CRACKS else ():
                self.add(drawn, self.lit(FACES[kind], normal), "none", 0)
                self.kinds.add(kind)
            both = (on & np.roll(on, 1, axis=0))[:, ~whole].any(axis=1)
            for k in np.flatnonzero(both):
                ends = drawn[[k - 1, k]]
                if kind:
                    side = now[seen][(on[[k - 1, k]].all(axis=0) & ~whole).argmax()]
                    edge = CRACKS.get(kind) or self.lit(colour, side)
                    self.add(ends, "none", edge, self.bold if kind in CRACKS else 2 * self.thin)  # fmt: skip
                if closure is not None:
                    size = 12 + 8e3 * min(closure, MOST)
                    self.spots.append((ends.mean(axis=0), size))

    def finish(self, axes, flat, legend):
        """Put it into axes, with names for the legend.

        :param flat: function of points in space that gives their places in the picture
        :param legend: whether cracks are in it
        """
        from matplotlib.collections import LineCollection, PolyCollection

        fills, edges, wides = zip(*self.looks)
        many = len(self.polygons) > 3000  # an SVG file has a picture of so many
        axes.add_collection(PolyCollection(list(map(flat, self.polygons)), facecolors=fills, edgecolors=edges, linewidths=wides, rasterized=many))  # fmt: skip
        for kind, colour in CRACKS.items() if legend else ():
            axes.add_collection(LineCollection([], color=colour, lw=self.bold, label=kind))  # fmt: skip
            if kind in self.kinds:
                axes.add_collection(PolyCollection([], facecolor=FACES[kind], lw=0, label=kind + ", its face"))  # fmt: skip
        if self.spots:
            points, wide = map(np.array, zip(*self.spots))
            axes.scatter(*flat(points).T, s=wide * min(1, self.bold / 1.8) ** 2, color=CRUSHED, marker="X", lw=0, label="crushed", zorder=5)  # fmt: skip
