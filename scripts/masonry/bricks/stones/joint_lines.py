# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines between the stones of a drawing, straightened alike for both stones.

Cells of a Voronoi diagram give lines of many short pieces between nodes. At each node the two lines
that go on most nearly straight are one, so that a bed joint stays straight at head joints.
"""

from collections import defaultdict

import numpy as np

from .polygons import area, turns, withoutStraight


def straightened(cells, fine):
    """The outlines of stones, with as few corners as a tolerance allows.

    :param cells: sides of the cells: ``places`` (n, 2) [m], ``ends``, numbers of places (m, 2), and
        ``labels`` left and right of them (m, 2)
    :param fine: the tolerance [m]
    :returns: numbers of corners by label, counter-clockwise; the places of all corners; and the
        outlines of holes in the wall
    """
    ends, places = _contracted(cells, fine)
    rings, holes = _rings(ends, cells.labels, places)
    lines = _lines(ends, places)
    kept, between = set(), {}
    for line in _joined(lines, places, fine):
        corners = _corners(places[line], fine)
        kept.update(line[k] for k in corners)
        for a, b in zip(corners, corners[1:]):
            base = places[line[b]] - places[line[a]]
            for n in line[a + 1 : b]:
                share = (places[n] - places[line[a]]) @ base / max(base @ base, 1e-300)
                between[n] = line[a], line[b], min(max(share, 0.0), 1.0)
    nodes = {n for line in lines for n in (line[0], line[-1])}
    used = nodes | (kept - between.keys())
    rings = {label: [n for n in ring if n in used] for label, ring in rings.items()}
    between = {n: line for n, line in between.items() if n in used}
    while True:
        moved = _onLines(places, between)
        shallow = _shallow(rings, moved, between, fine)
        if not shallow:
            return rings, moved, holes
        between.update(shallow)


def _shallow(rings, places, between, fine):
    """Corners that are concave by less than the tolerance, as places between neighbours."""
    found = {}
    for ring in rings.values():
        good = withoutStraight(places[ring], numbers=True) if len(ring) > 2 else []
        ring = [ring[k] for k in good]
        for k, turn in enumerate(turns(places[ring]) if ring else ()):
            n, a, b = ring[k], ring[k - 1], ring[(k + 1) % len(ring)]
            if -fine < turn < 0 and n not in between and not found.keys() & {n, a, b}:
                base = places[b] - places[a]
                found[n] = a, b, (places[n] - places[a]) @ base / (base @ base)
    return found


def _contracted(cells, fine):
    """Sides and places with nodes nearer than two tolerances made one; a node moves by one at
    most."""
    places, first = cells.places.copy(), np.arange(len(cells.places))
    air = set(cells.ends[(cells.labels < 0).any(axis=1)].ravel().tolist())
    done, lines = set(), _lines(cells.ends, places)
    length = lambda line: np.hypot(*np.diff(cells.places[line], axis=0).T).sum()
    for line in sorted((line for line in lines if length(line) < 2 * fine), key=length):
        ends = {line[0], line[-1]}
        if len(ends) == 2 and not ends & done:
            done |= ends
            first[line] = line[0]
            outer = [n for n in ends if n in air]  # at the air they stay on the face
            places[line[0]] = places[outer or list(ends)].mean(axis=0)
    return first[cells.ends], places


def _rings(ends, labels, places):
    """Numbers of the places around the largest cell of each stone, counter-clockwise; and the
    outlines of holes."""
    following = defaultdict(lambda: defaultdict(list))
    for (v, w), (left, right) in zip(ends.tolist(), labels.tolist()):
        if v != w:
            following[left][v].append(w)
            following[right][w].append(v)
    rings, holes = {}, []
    for label, after in following.items():
        sizes = {}
        while after:
            at = next(iter(after))
            ring = []
            while at in after:
                ring.append(at)
                onward = after[at].pop()
                if not after[at]:
                    del after[at]
                at = onward
                if at in ring:  # also where cells touch themselves
                    ring, loop = ring[: ring.index(at)], ring[ring.index(at) :]
                    sizes[area(places[loop])] = loop
        if label >= 0:
            rings[label] = sizes[max(sizes)]
        else:
            holes = [places[loop] for size, loop in sizes.items() if size > 0]
    return rings, holes


def _lines(ends, places):
    """Lines from node to node, and closed ones from their lowest left corner: lists of numbers."""
    beside = defaultdict(dict)
    for v, w in ends.tolist():
        if v != w:
            beside[v][w] = beside[w][v] = None
    nodes = [n for n, others in beside.items() if len(others) != 2]
    lines, done = [], set()

    def follow(start, onward):
        line = [start, onward]
        while line[-1] != start and len(beside[line[-1]]) == 2:
            line.append(next(n for n in beside[line[-1]] if n != line[-2]))
        done.update(zip(line, line[1:]), zip(line[1:], line))
        lines.append(line)

    for start in (*nodes, *sorted(beside, key=lambda n: places[n].sum())):
        near = beside[start]
        if len(near) != 2 or not any((start, n) in done for n in near):
            for onward in near:
                if (start, onward) not in done:
                    follow(start, onward)
    return lines


def _joined(lines, places, fine):
    starts = defaultdict(list)
    for k, line in enumerate(lines):
        for side, points in enumerate((line, line[::-1])):
            starts[points[0]].append((k, side, _direction(places[points], fine)))
    mates = {}
    for here in starts.values():
        pairs = [
            (float(u @ v), a, i, b, j)
            for n, (a, i, u) in enumerate(here)
            for b, j, v in here[:n]
            if a != b
        ]
        if len(here) > 2 and pairs:
            _, a, i, b, j = min(pairs)
            mates[a, i], mates[b, j] = (b, j), (a, i)
    left = dict.fromkeys(range(len(lines)))
    # first open ones, then closed ones
    begins = [(k, side) for k in left for side in (0, 1) if (k, side) not in mates]
    for k, side in begins + [(k, 0) for k in left]:
        if k not in left:
            continue
        path = []
        while k in left:
            del left[k]
            path += (lines[k][::-1] if side else lines[k])[bool(path) :]
            k, side = mates.get((k, 1 - side), (None, 0))
        if path[0] == path[-1]:
            first = int(np.argmin(places[path[1:]].sum(axis=1))) + 1
            path = path[first:] + path[1 : first + 1]
        yield path


def _direction(points, fine):
    """Unit vector from the start of a line to its point two tolerances away."""
    far = np.linalg.norm(points - points[0], axis=1)
    n = int(np.argmax(far > 2 * fine)) or len(points) - 1
    return (points[n] - points[0]) / max(far[n], 1e-300)


def _corners(points, fine):
    """Positions of the points of a line that stay, by the method of Douglas and Peucker."""
    last = len(points) - 1
    kept, open_ = {0, last}, [(0, last)]
    while open_:
        a, b = open_.pop()
        if b - a < 2:
            continue
        base, arms = points[b] - points[a], points[a + 1 : b] - points[a]
        share = np.clip(arms @ base / max(base @ base, 1e-300), 0, 1)
        off = np.linalg.norm(arms - share[:, None] * base, axis=1)
        if off.max() > fine:
            n = a + 1 + int(off.argmax())
            kept.add(n)
            open_ += [(a, n), (n, b)]
    return sorted(kept)


def _onLines(places, between):
    """The places, with some put on the line between two others: ``between`` has by number these
    two, and the share of the distance."""
    if not between:
        return places
    numbers = list(between)
    a, b, share = map(np.array, zip(*between.values()))
    share = share[:, None]
    while True:
        new = (1 - share) * places[a] + share * places[b]
        change = np.abs(new - places[numbers]).max()
        places[numbers] = new
        if change < 1e-13:
            return places
