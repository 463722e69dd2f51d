# SPDX-License-Identifier: GPL-2.0-or-later
"""From where a structure is seen in a picture, and how much its displacements are magnified."""

from collections import namedtuple
import numpy as np

from masonry.numbers.cracks import widths

#: Magnifications of displacements in cracks.png, the usual one first, as in figure 6 of the paper
#: (see yade_plugin/law/README.md).
MAGNIFICATIONS = 30, 20, 10, 5, 2, 1
MAX_DISPLACEMENT = 0.25  # largest drawn displacement over the size of the structure
OVERLAP = 0.25  # how far blocks overlap at most where a joint closed, over the height of a course
MAX_GAP = 1.0  # how far a block is drawn away from all others at most, over the height of a course
#: From where a structure is seen in space, in plan beside its front and over the ground [°].
ASIDE, ABOVE = 32, 24
#: Names of views that are not from the front.
FROM_ABOVE, IN_SPACE = "from above", "in space"
LEVEL = 1e-3  # cosine below which a face stands along the line of sight
REACH = 1.5  # how far what moved is in a picture, over the size of what was built
#: How a part is seen: unit vectors to the right, up and towards the viewer, labels of the axes, and
#: where the viewer stands. A point p lies at ((p - start)·right, (p - start)·up).
View = namedtuple("View", "right up towards start labels name")


def viewOf(points, normals, areas, direction=None):
    """The :class:`View` of a part, chosen by its shape.

    If no joint looks along one horizontal direction, as in an arch or a wall of one wythe, the part
    is seen along it; else along the short side of the smallest rectangle around its plan, or from
    above if it is wider than high, as a dome or a vault is. What is up stays up; from above, y is
    up.

    :param points: corners of its blocks (n, 3) [m]
    :param normals: unit normals of its joints, with their ``areas`` [m²]
    :param direction: of sight (x, y, z), if the user gave one
    """
    from scipy.spatial import ConvexHull

    flat, height = points[:, :2], np.ptp(points[:, 2])
    corners = flat[ConvexHull(flat).vertices]
    edges = np.roll(corners, -1, axis=0) - corners
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    best = None
    # of rectangles that are as small, as far as files with seven digits say, one along an axis
    for along in sorted(edges, key=lambda edge: round(np.abs(edge).min(), 6)):
        across = np.array([-along[1], along[0]])
        sides = np.ptp(flat @ along), np.ptp(flat @ across)
        if best is None or sides[0] * sides[1] < best[0] * best[1] * (1 - 1e-5):
            best = (*sides, along, across)
    first, second, along, across = best
    towardsX = abs(across[0]) > abs(along[0])
    if second > 1.05 * first or second > first / 1.05 and towardsX:
        first, second, along, across = second, first, across, along
    if direction is not None:
        return _viewFrom(-np.array(direction, float) / np.linalg.norm(direction), points, False)
    total = areas.sum()
    stands = lambda side: areas @ (normals[:, :2] @ side) ** 2 < 1e-6 * total
    standing = [side for side in (across, along) if total and stands(side)]
    if standing or second <= height:
        return _viewFrom(np.append([*standing, across][0], 0), points, True)
    return _viewFrom(np.array([0, 0, 1.0]), points, True)


def spaceViewOf(front, points, moved):
    """The view of a structure from above at the side to which it moved, so that what fell lies in
    front, and turned to where most of it moved.

    :param front: ``towards`` of the view of the part that shows it
    :param points: as built, ``moved``: their displacements (n, 3) [m]
    """
    side = front[:2] if abs(front[2]) < 0.9 else np.array([0, -1.0])
    side = side / np.linalg.norm(side)
    if moved.mean(axis=0)[:2] @ side < 0:
        side = -side
    weights = np.linalg.norm(moved, axis=1) + 1e-9
    lean = np.average(points, axis=0, weights=weights) - points.mean(axis=0)
    turn, rise = np.radians(ASIDE), np.radians(ABOVE)
    along = np.array([-side[1], side[0]])
    if round(lean[:2] @ along / np.ptp(points, axis=0).max(), 3) < 0:
        along = -along
    plan = np.cos(turn) * side + np.sin(turn) * along
    return _viewFrom(np.append(np.cos(rise) * plan, np.sin(rise)), points, False)


def _viewFrom(away, points, either):
    """The view of points by a viewer in this direction; ``either``: or opposite, if that turns x or
    y to the right."""
    if abs(away[2]) > 1 - 1e-6:
        (right, up), name = np.eye(3)[:2], FROM_ABOVE
    else:
        up = np.array([0, 0, 1]) - away[2] * away
        up /= np.linalg.norm(up)
        right = np.cross(up, away)
        if either and (right[0] < -1e-3 or (abs(right[0]) <= 1e-3 and right[1] < 0)):
            right = -right
        name = IN_SPACE if abs(away[2]) > LEVEL else ""
    towards = np.cross(right, up)
    start, labels = np.zeros(3), []
    for direction in (right, up):
        axis = int(np.argmax(np.abs(direction)))
        if abs(direction[axis]) > 1 - 1e-5:
            labels.append("−" * int(direction[axis] < 0) + "xyz"[axis] + " [m]")
            continue
        start = start + (points @ direction).min() * direction
        angle = np.degrees(np.arctan2(direction[1], direction[0]))
        level = f"along the part, {angle:.0f}° from x [m]"
        labels.append(level if abs(direction[2]) < 1e-6 else "upwards in the picture [m]")
    return View(right, up, towards, start, labels, name)


def magnificationOf(joints, moved, blocks):
    """How much displacements are magnified: as usual, less where blocks would be drawn far away,
    over each other or in the air, and not at all where no joint is cracked.

    :param moved: displacements of points of the blocks (n, 3) [m]
    :param blocks: arrays of the corners of each (n, 3) [m]
    """
    if not joints or not widths(joints)[2].any():
        return 1
    size = np.ptp(np.concatenate(blocks), axis=0).max()
    far = np.linalg.norm(moved, axis=1).max()
    closed, gap, course = max(-joints["opening"].min(), 0), _largestGap(joints), courseOf(blocks)
    limits = (far, MAX_DISPLACEMENT * size), (closed, OVERLAP * course), (gap, MAX_GAP * course)
    fits = lambda m: all(m * value <= most for value, most in limits)
    return next(filter(fits, MAGNIFICATIONS), 1)


def _largestGap(joints):
    """How far the loosest block is away from all its neighbours [m]: 0 if each touches one."""
    bodies, index = np.unique(joints["bodies"], return_inverse=True)
    gaps = np.full(len(bodies), np.inf)
    np.minimum.at(gaps, index.reshape(-1), np.repeat(joints["opening"], 2))
    return gaps.max()


def courseOf(blocks):
    """The median of the shortest sides of blocks [m], of arrays of their corners (n, 3) [m]."""
    starts, points = np.cumsum([0, *map(len, blocks)])[:-1], np.concatenate(blocks)
    high, low = (end.reduceat(points, starts) for end in (np.maximum, np.minimum))
    return float(np.median((high - low).min(axis=1)))


def scaleText(joints, magnification):
    """What a picture says of its magnification, and where no joint of a frame is cracked."""
    parted = "" if widths(joints)[2].any() else "no joint is cracked, "
    return parted + (
        "true to scale" if magnification == 1 else f"displacements × {magnification:g}"
    )
