# SPDX-License-Identifier: GPL-2.0-or-later
"""What the checks of a set of blocks find: gaps, overlaps, slivers, loose parts and joints of odd
size."""

from usual import *
from masonry.bricks import Block, Bricks, Wall, block, stack
from masonry.bricks.geometry import FLAT, Solids, hull

few = settings(max_examples=40)
CUBE = ((0, 0, 0), (1, 1, 1))
TETRA = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))


def beside(dx, dy=0.0, dz=0.0):
    return block(*CUBE) + block(*CUBE).moved(1 + dx, dy, dz)


def test_a_cube_has_six_faces_that_run_counter_clockwise_outside():
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    faces = hull(corners)
    assert sorted(map(len, faces)) == [4] * 6
    for face in faces:
        a, b, c = corners[list(face[:3])]
        outward = np.cross(b - a, c - b)
        assert np.dot(outward, a - 0.5) > 0


@few
@given(some.integers(4, 12), some.integers(0, 10**6))
def test_volume_of_any_convex_solid(count, seed):
    """Against the sum of tetrahedra of Qhull's own triangles."""
    from scipy.spatial import ConvexHull

    points = np.random.default_rng(seed).normal(size=(count, 3))
    points = points / np.linalg.norm(points, axis=1)[:, None]  # all are corners
    try:
        solids = Solids([points])
        assume(not solids.problems)
    except ValueError:
        assume(False)
    volume = 0.0
    found = ConvexHull(points)
    for triangle, plane in zip(found.simplices, found.equations):
        a, b, c = points[triangle]
        six = abs(np.dot(a, np.cross(b, c))) * np.sign(-plane[3])
        volume += six / 6
    # a corner may lie FLAT of the diagonal, which is 2 at most, beside the plane of its face
    assert solids.volumes()[0] == approx(volume, abs=FLAT * 2 * found.area)


@mark.parametrize(
    "corners, said",
    [
        (((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)), "lie in one plane: no volume"),
        (((0, 0, 0),) * 4, "all its corners are one point"),
        (TETRA + ((0.1, 0.1, 0.1),), r"4 at \(0.1, 0.1, 0.1\) m is no corner of"),
        (TETRA + ((1, 0, 0),), "corner 4 .* is given twice"),
    ],
)
def test_a_block_that_is_no_convex_solid_is_reported(corners, said):
    blocks = Bricks([Block(corners, 0, "rubble")])
    (message,) = blocks.problems()
    assert (blocks + block((5, 5, 5), (6, 6, 6))).problems() == [message]
    assert re.search(r"block 0 of brick 0 \(rubble\): .*" + said, message)
    with raises(ValueError, match=said):
        blocks.cut((0, 0, 0.2), (0, 0, 1))


def test_blocks_that_fit_have_one_joint_and_no_problem():
    pair = beside(0, 0.25, 0.5)
    (joint,) = pair.joints()
    assert (joint.first, joint.second) == (0, 1) and joint.normal == (1, 0, 0)
    assert joint.area == approx(0.75 * 0.5)
    assert joint.middle == approx((1, 0.625, 0.75))
    assert pair.problems() == []


@few
@given(some.floats(3e-4, 0.2), some.floats(-400, 400), some.sampled_from("xyz"))
def test_gaps_and_overlaps_are_reported_with_bricks_depth_and_place(depth, turn, axis):
    for sign, word in ((1, "gap of up to"), (-1, "overlap by")):
        pair = beside(sign * depth).turned(turn, axis)
        (message,) = [p for p in pair.problems() if word in p]
        assert message.startswith("block 0 of brick 0 and block 1 of brick 1")
        size = float(re.search(word + r" (\S+) m", message)[1])
        assert size == approx(depth, rel=0.02)
        place = [float(x) for x in re.search(r"\((.*)\) m$", message)[1].split(",")]
        right = block((1, 0.5, 0.5), (1.1, 0.6, 0.6)).turned(turn, axis)[0].corners[0]
        assert math.dist(place, right) < (0.51 * depth + 0.002 if sign > 0 else 1.5)
        assert not pair.joints()


def test_round_off_is_neither_gap_nor_overlap():
    for dx in (1e-5, -1e-5):
        assert beside(dx).problems() == [] and len(beside(dx).joints()) == 1


def test_a_gap_that_another_block_fills_is_none():
    three = beside(0.2) + block((1, 0, 0), (1.2, 1, 1))
    assert not [p for p in three.problems() if "gap" in p]
    assert [p for p in three[:2].problems() if "gap of up to 0.2 m" in p]


@few
@given(some.integers(0, 10**6))
def test_blocks_at_any_angle_overlap_as_sampled_points_say(seed):
    """Two boxes at random. Points are sampled in one; the checks tell an overlap if any lies
    clearly in the other, and tell none if a plane (one of many directions) parts them."""
    random = np.random.default_rng(seed)
    one = block((0, 0, 0), tuple(random.uniform(0.3, 1, 3)))
    two = block((0, 0, 0), tuple(random.uniform(0.3, 1, 3)))
    for axis in "xyz":
        two = two.turned(float(random.uniform(0, 360)), axis)
    two = two.moved(*random.uniform(-1, 1, 3))
    message = any("overlap" in p for p in (one + two).problems())
    low, high = np.array(one.low), np.array(one.high)
    corners = np.array(two[0].corners)
    # a corner and its three neighbours: the axes of a turned box
    origin, axes = corners[0], corners[[4, 2, 1]] - corners[0]
    inside = random.uniform(size=(20000, 3)) @ axes + origin
    margin = 0.01
    if ((inside > low + margin) & (inside < high - margin)).all(axis=1).any():
        assert message
    directions = random.normal(size=(3000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    a, b = (np.array(x[0].corners) @ directions.T for x in (one, two))
    gaps = a.min(axis=0) - b.max(axis=0), b.min(axis=0) - a.max(axis=0)
    if np.max(gaps) > 0:
        assert not message


def test_edges_that_cross_are_parted_although_no_face_parts_them():
    """Two wedges, edge above edge at right angles: only the product of the edges is an axis that
    separates them."""
    corners = [(x, y, -abs(y)) for x in (-1, 1) for y in (-1, 0, 1)]
    wedge = Bricks([Block(tuple(corners), 0)])
    other = wedge.turned(180, "x").turned(90, "z")
    found = lambda dz: " ".join((wedge + other.moved(dz=dz)).problems())
    assert "overlap" not in found(0.01) and "overlap by 0.01 m" in found(-0.01)


def test_loose_parts_are_reported_with_their_size():
    both = stack(3, (1, 1, 1)) + stack(2, (1, 1, 1)).moved(dx=5)
    (message,) = both.problems()
    assert message.startswith("2 blocks from block 3 of brick 3 on, near (5.500, 0.500")
    assert message.endswith("no joint with the other 3 blocks")


def test_touching_edges_and_corners_make_no_joint():
    for direction in ((0, 1, 0), (0, 1, 1)):
        pair = beside(0, *direction[1:])
        assert pair.joints() == [] and "no joint with the other" in pair.problems()[0]


def test_a_sliver_and_a_narrow_joint_are_reported():
    wall = Wall(0.66, 0.243, halves=False)
    sliver = wall.cut((0, 0, 0.172), (0, 0, 1))
    message = [p for p in sliver.problems() if "sliver: 0.01 m thin, less than" in p]
    assert len(message) == 3  # course 2 has three whole bricks
    shifted = stack(2, (1, 1, 1))[:1] + stack(1, (1, 1, 1)).moved(0.95, 0, 1)
    (message,) = shifted.problems()
    what = r"share a joint of odd size near \(0.975, 0.500, 1.000\) m: 1 m long but 0.04"
    assert re.search(what, message)


def test_ten_thousand_blocks_take_seconds():
    """In CPU time, so that a busy machine does not fail it."""
    for made in (Wall(11, 8.1), Wall(11, 8.1).turned(10, "x").turned(20)):
        start = time.process_time()
        assert len(made) == 10_000 and made.problems() == []
        assert time.process_time() - start < 5
