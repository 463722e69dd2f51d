# SPDX-License-Identifier: GPL-2.0-or-later
"""The one style of all pictures of blocks: its colours, which pages have, too, and how matplotlib
draws faces, light and cracks."""

import copy
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
MAX_CLOSURE = 5e-3  # [m] closure from which the sign of a crushed point is no larger
#: Lines of ties by their state.
TIES = {"elastic": ("#333333", "-"), "yielded": ("#ff7f0e", "-"), "broken": ("#9467bd", ":")}


def rgb(colour):
    """Red, green and blue of a colour "#rrggbb", from 0 to 255."""
    return np.array(list(bytes.fromhex(colour[1:])))


#: Of the faces of cracked joints, as ``rgb`` gives them, in the order of CRACKS.
FACES = np.rint([0.45 * rgb(c) + 0.55 * rgb(SHADES["brick"]) for c in CRACKS.values()])
#: Kinds of joints after those of CRACKS: seams, and what is only crushed.
SEAM, NONE = 2, 3
BEYOND_ALL = 1e9  # beyond all blocks [m]


def fromBackToFront(solids, sight):
    """Numbers of convex blocks in the order in which they are drawn.

    If a face separates two overlapping blocks, the one on the viewer's side is drawn later. Cycles
    are broken at the farthest block.

    :param solids: :class:`masonry.bricks.geometry.Solids`
    :param sight: unit vectors to the right, up and towards the viewer, rows of an array
    """
    seen, boxes = solids.padded("corners") @ sight.T, copy.copy(solids)
    boxes.low, boxes.high = seen.min(axis=1), seen.max(axis=1)
    depth, slack = (boxes.low + boxes.high)[:, 2].tolist(), 1e-3 * np.median(boxes.high - boxes.low)
    boxes.low[:, 2], boxes.high[:, 2] = -BEYOND_ALL, BEYOND_ALL  # pictures overlap at any depth
    pairs = boxes.nearPairs(np.full(solids.count, -slack / 2))
    after = [[] for _ in range(solids.count)]
    facing = solids.padded("normals")[pairs] @ sight[2] * [[[1]], [[-1]]]
    sides, gaps = (facing > LEVEL, facing < -LEVEL, np.abs(facing) <= LEVEL), solids.beyond(pairs)
    front, back, beside = (np.where(side, gaps, -np.inf).max(axis=(0, 2)) for side in sides)
    # no planes part them on both sides, or along the line of sight
    hides = (beside <= -slack) & (np.minimum(front, back) <= -slack)
    inOrder = np.where(front > back, pairs, pairs[::-1])
    for behind, before in inOrder[:, hides].T.tolist():
        after[behind].append(before)
    hidden = [n for fronts in after for n in fronts]
    pending = np.bincount(hidden, minlength=solids.count)
    left, order = set(range(solids.count)), []
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


class Painting:
    """Polygons and lines from the back to the front, and where joints are crushed.

    :param towards: unit vector to the viewer; ``thin``, ``bold``: widths of the lines of blocks and
        cracks [1/72 inch]
    """

    def __init__(self, towards, thin, bold):
        self.towards, self.thin, self.bold = towards, thin, bold
        self.polygons, self.spots, self.kinds = [], [], set()

    def add(self, places, points, fill, edge, wide):
        """Add polygons, or lines, of corners in space (n, corners, 3) [m].

        :param places: numbers that grow to the front; of equal ones, what comes later is in front
        :param fill: colours (n, 3), one for all, or None, as ``edge``; ``wide``: the edge
        """
        looks = np.zeros((len(points), 9))
        looks[:, 8] = wide
        for at, colour in ((0, fill), (4, edge)):
            if colour is not None:
                looks[:, at : at + 3], looks[:, at + 3] = np.divide(colour, 255), 1
        self.polygons.append((places, points, looks))

    def blocks(self, places, alike, colours=None):
        """Add the visible faces of blocks (:class:`masonry.bricks.geometry.SameTopologyBatch`), lit
        from the viewer and from above; without colours, where blocks stood."""
        for n, face in enumerate(alike.faces):
            normals = alike.normals[:, n]
            seen = normals @ self.towards > LEVEL
            fill = rgb(GHOST) if colours is None else self.lit(colours[seen], normals[seen])
            edge = rgb(GHOST if colours is None else MORTAR)
            self.add(places[seen], alike.corners[seen][:, face], fill, edge, self.thin)

    def lit(self, colours, normals):
        light = 0.55 + 0.45 * normals @ self.towards + 0.3 * np.maximum(normals[:, 2], 0)
        return np.rint(np.minimum(1, light)[:, None] * colours)

    def cracks(self, places, crack, built, now, colours):
        """Add open, slid or crushed joints: their visible faces, and their edges on other faces of
        their blocks; edges of seams are painted over.

        :param places: of all blocks; ``colours``: theirs
        :param crack: an entry of :attr:`masonry_view.elevation.Structure.cracks`, but with numbers
            of blocks, and at the end the corners as drawn
        :param built: :class:`masonry.bricks.geometry.Solids` as built; ``now``: as drawn
        """
        block, joint, kinds, closures, corners, drawn = crack
        places, normals = places[block] + 1 + joint, now.padded("normals")[block]
        heights = (
            np.einsum("nck,nfk->ncf", corners, built.padded("normals")[block])
            - built.padded("offsets")[block][:, None]
        )
        seen = normals @ self.towards > LEVEL
        # a corner lies on a face if it is nearer than this
        on = (np.abs(heights) < 1e-4 * built.diagonal[block, None, None]) & seen[:, None]
        whole = on.all(axis=1)
        n = np.flatnonzero(whole.any(axis=1) & (kinds < SEAM))
        self.add(
            places[n],
            drawn[n],
            self.lit(FACES[kinds[n]], normals[n, whole[n].argmax(axis=1)]),
            None,
            0,
        )
        self.kinds.update(kinds[n])
        both = on & np.roll(on, 1, axis=1) & ~whole[:, None]
        n, c = np.nonzero(both.any(axis=2))
        places, kinds, closures = places[n], kinds[n], closures[n]
        ends = np.stack([drawn[n, c - 1], drawn[n, c]], axis=1)
        edge = self.lit(colours[block[n]], normals[n, both[n, c].argmax(axis=1)])
        for kind, colour in enumerate(CRACKS.values()):
            edge[kinds == kind] = rgb(colour)
        line, spot = kinds < NONE, closures > 0
        wide = np.where(kinds < SEAM, self.bold, 2 * self.thin)
        self.add(places[line], ends[line], None, edge[line], wide[line])
        self.spots += zip(
            places[spot],
            ends[spot].mean(axis=1),
            12 + 8e3 * np.minimum(closures[spot], MAX_CLOSURE),
        )

    def finish(self, axes, flat, legend):
        """Put all into axes; ``legend``: whether it names cracks.

        :param flat: function of points in space that gives their places in the picture
        """
        from matplotlib.collections import LineCollection, PolyCollection

        places, points, looks = zip(*self.polygons)
        order = np.argsort(np.concatenate(places), kind="stable")
        polygons = [polygon for alike in points for polygon in flat(alike)]
        fills, edges, wides = np.split(np.concatenate(looks)[order], (4, 8), axis=1)
        many = len(polygons) > 3000  # an SVG file has a picture of so many
        axes.add_collection(
            PolyCollection(
                [polygons[n] for n in order],
                facecolors=fills,
                edgecolors=edges,
                linewidths=wides.ravel(),
                rasterized=many,
            )
        )
        for n, (kind, colour) in enumerate(CRACKS.items() if legend else ()):
            axes.add_collection(LineCollection([], color=colour, lw=self.bold, label=kind))
            if n in self.kinds:
                axes.add_collection(
                    PolyCollection([], facecolor=FACES[n] / 255, lw=0, label=kind + ", its face")
                )
        if self.spots:
            _, points, wide = map(np.array, zip(*sorted(self.spots, key=lambda spot: spot[0])))
            axes.scatter(
                *flat(points).T,
                s=wide * min(1, self.bold / 1.8) ** 2,
                color=CRUSHED,
                marker="X",
                lw=0,
                label="crushed",
                zorder=5,
            )
