# SPDX-License-Identifier: GPL-2.0-or-later
"""Joints of blocks, and what is wrong: gaps, overlaps, slivers, loose parts, joints of odd size."""

from collections import defaultdict, namedtuple
from math import dist
from statistics import median

import numpy as np

from .geometry import COINCIDENT, NEARLY_OPPOSITE, OPPOSITE, REACH, clip, measures

#: A block is a sliver if it is thinner than this share of the median of its kind; a queen closer or
#: a quarter bat is thicker. Assumed.
SLIVER = 0.25
#: A joint is of odd size if its width, area over longest extent, is below this share of the thinner
#: block. Assumed.
NARROW = 0.1
LOOKING = float(np.cos(np.radians(45))) - COINCIDENT  # least cosine of normal and direction
ALONG = 1 - 1e-6  # cosine between normals of one face

#: Joint of two blocks: their numbers, the unit normal from the first to the second, the polygon
#: (counter-clockwise about the normal) [m], its area [m²] and its centroid [m].
Joint = namedtuple("Joint", "first second normal polygon area middle")

#: What no joint covers of a face: number of the block, outward normal, area [m²], centroid [m],
#: polygons of the face and of the joints in it [m].
FreePart = namedtuple("FreePart", "block normal area middle face covers")


def findJoints(solids):
    """Joints, sorted by the numbers of the blocks, and misfits: numbers of both blocks, gap [m]
    (negative for an overlap) and place [m]."""
    if not solids.groups:  # none of them is one
        return [], []
    thickness = solids.thicknesses()
    one, two = solids.nearPairs(REACH / 2 * thickness)
    apart, faces, cosine = solids.compare(one, two)
    width = COINCIDENT * np.minimum(solids.diagonal[one], solids.diagonal[two])
    # bounding boxes of blocks that share a face overlap along two axes at least
    common = np.minimum(solids.high[one], solids.high[two])
    common -= np.maximum(solids.low[one], solids.low[two])
    flat = (common > 0.1 * width[:, None]).sum(axis=1) < 2
    near = (apart <= REACH * np.minimum(thickness[one], thickness[two])) & ~flat
    near &= (apart < -width) | (cosine <= NEARLY_OPPOSITE)
    rows = (one, two, width, apart, cosine, *faces)
    joints, misfits = [], []
    for i, j, w, gap, cos, f, g in zip(*(row[near].tolist() for row in rows)):
        if gap < -w:
            gap = float(solids.separation(i, j))
            if gap < -w:
                low = np.maximum(solids.low[i], solids.low[j])
                high = np.minimum(solids.high[i], solids.high[j])
                misfits.append((i, j, gap, tuple((low + high) / 2)))
            continue
        mine, normal, area = _side(solids, i, f)
        theirs, other, otherArea = _side(solids, j, g)
        shared = clip(mine, theirs, normal)
        if len(shared) < 3:
            continue
        size, perimeter, middle = measures(shared, normal)
        if middle is None or size < 0.5 * perimeter * w:
            continue
        (x, y, z), (nx, ny, nz) = theirs[0], other
        widest = max(abs((p - x) * nx + (q - y) * ny + (r - z) * nz) for p, q, r in shared)
        if widest <= w and cos < OPPOSITE:
            joints.append(Joint(i, j, normal, tuple(shared), size, middle))
        elif size > 0.01 * min(area, otherArea):
            away = sum((m - p) * n for m, p, n in zip(middle, theirs[0], other)) / 2
            place = tuple(m - away * n for m, n in zip(middle, other))
            if not _filled(solids, place, (i, j)):
                misfits.append((i, j, widest, place))
    joints.sort(key=lambda joint: joint[:2])
    return joints, misfits


def _side(solids, solid, face):
    """Corners of a face as lists of numbers, its outward normal, and its area."""
    group, row = solids.of(solid)
    normal, area = group.normals[row, face].tolist(), float(group.areas[row, face])
    return solids.face(solid, face).tolist(), tuple(normal), area


def _filled(solids, place, but):
    around = (solids.low <= place) & (solids.high >= place)
    for n in np.flatnonzero(around.all(axis=1) & (solids.groupOf >= 0)):
        group, row = solids.of(n)
        if n not in but and (group.normals[row] @ place <= group.offsets[row]).all():
            return True
    return False


def freeParts(solids, joints, direction, least):
    """See :meth:`masonry.bricks.Bricks.freeFaces`: a list of :class:`FreePart`."""
    sight = np.array(direction, float)
    sight /= np.linalg.norm(sight)
    covered = defaultdict(list)
    for joint in joints:
        outward = np.array(joint.normal)
        covered[joint.first].append((outward, joint))
        covered[joint.second].append((-outward, joint))
    faces = []
    for n in range(solids.count):
        group, row = solids.of(n)
        for face, normal in enumerate(group.normals[row]):
            if normal @ sight < least:
                continue
            whole = [tuple(c) for c in solids.face(n, face)]
            area, _, middle = measures(whole, normal)
            free, moment, covers = area, area * np.array(middle), []
            for outward, joint in covered[n]:
                if outward @ normal > ALONG:
                    free -= joint.area
                    moment -= joint.area * np.array(joint.middle)
                    covers.append(joint.polygon)
            if free > COINCIDENT * area:
                place = tuple(moment / free)
                faces.append(FreePart(n, tuple(normal), float(free), place, whole, covers))
    return faces


def components(count, joints):
    """The connected part of each block, numbered by its first block."""
    parent = list(range(count))

    def root(n):
        while parent[n] != n:
            parent[n] = parent[parent[n]]
            n = parent[n]
        return n

    for joint in joints:
        a, b = root(joint[0]), root(joint[1])
        parent[max(a, b)] = min(a, b)
    return [root(n) for n in range(count)]


def findProblems(blocks, solids, joints, misfits):
    """See :meth:`masonry.bricks.Bricks.problems`."""
    found = []
    thickness = solids.thicknesses().tolist()
    nameOf = lambda n: f"block {n} of brick {blocks[n].brick}"
    for n, problem in sorted(solids.problems.items()):
        found.append(f"{nameOf(n)} ({blocks[n].part}): {problem}")
    neighbours = defaultdict(set)
    for one, two, *_ in joints:
        neighbours[one].add(two)
        neighbours[two].add(one)
    for i, j, gap, place in misfits:
        around = ((solids.low <= place) & (place <= solids.high)).all(axis=1)
        filling = {*np.flatnonzero(around)} - {i, j}
        if gap > 0 and filling & neighbours[i] and filling & neighbours[j]:
            continue  # thin blocks fill it, which have joints with both
        both = f"{nameOf(i)} and {nameOf(j)}"
        if gap < 0:
            found.append(f"{both} overlap by {-gap:.3g} m near {where(place)}")
        else:
            found.append(f"{both}: a gap of up to {gap:.3g} m near {where(place)}")
    good = [n for n in range(len(blocks)) if n not in solids.problems]
    kinds, parts = defaultdict(list), defaultdict(list)
    for n in good:
        kinds[blocks[n].kind].append(n)
    for kind, members in kinds.items():
        least = SLIVER * median(thickness[n] for n in members)
        for n in members:
            if thickness[n] < least * (1 - 1e-9):
                found.append(
                    f"{nameOf(n)} near {where(blocks[n].middle)} is a sliver: {thickness[n]:.3g} m"
                    f" thin, less than {least:.3g} m, a quarter of what is usual for a {kind} here"
                )
    for joint in joints:
        i, j, polygon = joint.first, joint.second, joint.polygon
        longest = max(dist(p, q) for n, p in enumerate(polygon) for q in polygon[:n])
        width, least = joint.area / longest, NARROW * min(thickness[i], thickness[j])
        if width < least:
            found.append(
                f"{nameOf(i)} and {nameOf(j)} share a joint of odd size near {where(joint.middle)}:"
                f" {longest:.3g} m long but {width:.3g} m wide, less than {least:.3g} m, a tenth of"
                " the thinner block"
            )
    partOf = components(len(blocks), joints)
    for n in good:
        parts[partOf[n]].append(n)
    largest = max(parts.values(), key=len, default=[])
    for members in parts.values():
        if members is not largest:
            what = nameOf(members[0])
            what = f"{len(members)} blocks from {what} on" if len(members) > 1 else what
            found.append(
                f"{what}, near {where(blocks[members[0]].middle)}: no joint with the other"
                f" {len(good) - len(members)} blocks"
            )
    return found


def where(point):
    """A place as text [m]."""
    return "(" + ", ".join(f"{x + 0.0:.3f}" for x in point) + ") m"
