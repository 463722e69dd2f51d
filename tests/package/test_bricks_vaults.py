# SPDX-License-Identifier: GPL-2.0-or-later
"""Arches, barrel vaults and domes against closed forms of their polygons, and as sets of blocks
that fit."""

from usual import *
from masonry.bricks import Arch, BarrelVault, Bricks, CrossVault, Dome
from collections import Counter
from scipy.spatial import ConvexHull

few = settings(max_examples=40)
sizes = some.floats(0.05, 3.0)
angles = some.one_of(some.just(180.0), some.floats(20, 179))


def ringArea(radius, thickness, stones, angle):
    """Area between two inscribed polygons [m²]: their triangles about the centre."""
    ring = (radius + thickness) ** 2 - radius**2
    return stones / 2 * math.sin(math.radians(angle) / stones) * ring


@few
@given(sizes, some.floats(0.02, 1.0), sizes, some.integers(3, 60), angles)
def test_an_arch_is_that_of_its_circles(radius, share, depth, stones, angle):
    thickness = share * radius
    arch = Arch(thickness, depth, stones, radius=radius, angle=angle)
    area = ringArea(radius, thickness, stones, angle)
    assert arch.volume == approx(depth * area, rel=1e-9)
    span = 2 * radius * math.sin(math.radians(angle / 2))
    centre = np.array([span / 2, -radius * math.cos(math.radians(angle / 2))])
    for b in arch:
        far = np.linalg.norm(np.array(b.corners)[:, [0, 2]] - centre, axis=1)
        near = np.isclose(far, radius, rtol=1e-9)
        assert near.sum() == 4
        assert far[~near] == approx(radius + thickness, rel=1e-9)
    joints = arch.joints()
    assert [j[:2] for j in joints] == [(n, n + 1) for n in range(stones - 1)]
    for j in joints:
        assert j.area == approx(thickness * depth, rel=1e-6)
    assert [p for p in arch.problems() if "sliver" not in p] == []
    assert [b.course for b in arch] == list(range(stones))


def test_span_and_radius_say_the_same():
    """A segment of 90° over a span of 3 m has a radius of 3 m / (2 sin 45°)."""
    by = dict(thickness=0.2, depth=0.3, stones=15, angle=90)
    one, two = Arch(span=3.0, **by), Arch(radius=3 / math.sqrt(2), **by)
    assert np.allclose([b.corners for b in one], [b.corners for b in two], atol=1e-12)
    inner = [c for b in (one[0], one[14]) for c in b.corners if c[2] == 0]
    assert sorted({round(c[0], 12) for c in inner}) == [0, 3]


def test_a_half_circle_stands_on_level_joints():
    arch = Arch(0.3, 0.5, 27, radius=2.0)
    assert [b.course for b in arch.bottom()] == [0, 26]
    assert arch.low == (approx(-0.3), 0.0, 0.0)
    # or on blocks of its width
    arch = Arch(0.2, 0.3, 9, radius=2, skewback=0.4)
    left, right = (block for block in arch if block.part == "skewback")
    sides = lambda b, f: [f(p[i] for p in b.corners) for i in range(3)]
    assert sides(left, min) == approx([-0.2, 0, -0.4])
    assert sides(left, max) == approx([0, 0.3, 0])
    assert sides(right, min) == approx([4, 0, -0.4])
    assert arch.problems() == []


def test_skewbacks_carry_a_segmental_arch_on_level_ground():
    arch = Arch(0.2, 0.3, 15, span=3.0, angle=90, skewback=0.25)
    assert {b.part for b in arch.bottom()} == {"skewback"} and len(arch.bottom()) == 2
    assert len(arch.joints()) == 16 and arch.problems() == []
    outer = 0.2 * math.sin(math.pi / 4)
    assert arch.low == approx((-outer - 0.25, 0, 0))
    for joint in arch.joints():
        assert joint.area == approx(0.2 * 0.3)


@few
@given(some.integers(3, 20), some.integers(1, 8), angles, some.booleans())
def test_a_barrel_vault_is_an_arch_in_rows(stones, rows, angle, staggered):
    by = dict(radius=2.0, angle=angle)
    vault = BarrelVault(0.2, 4.0, stones, rows, staggered=staggered, **by)
    arch = Arch(0.2, 4.0, stones, **by)
    assert vault.volume == approx(arch.volume, rel=1e-9)
    bad = [p for p in vault.problems() if "odd size" not in p and "sliver" not in p]
    assert not bad
    odd = sum(1 for c in range(stones) if c % 2)
    assert len(vault) == stones * rows + (odd if staggered else 0)
    # joints between rows, and between courses
    across = lambda j: vault[j.first].course != vault[j.second].course
    between = sum(j.area for j in vault.joints() if across(j))
    assert between == approx((stones - 1) * 0.2 * 4.0, rel=1e-6)


spheres = some.floats(0.5, 10), some.floats(0.02, 0.4)  # radius, and share of it
numbers = some.integers(1, 8), some.integers(3, 24)
holes = some.one_of(some.none(), some.floats(0.05, 0.6))


@few
@given(*spheres, *numbers, angles, holes, some.booleans())
def test_a_dome_fits(radius, share, courses, stones, angle, hole, staggered):
    """Inner and outer surface are similar about the centre, as (r + t) / r; so the shell has ((r +
    t)³ - r³) / r³ of the volume of the pyramids from the centre to the inner surface."""
    thickness = share * radius
    oculus = None if hole is None else hole * radius * math.sin(math.radians(angle / 2))
    # stones on either side of a hole that is narrower than a third of them seem to have a gap
    # between them
    assume(oculus is None or 2 * oculus > thickness / 3)
    dome = Dome(radius, thickness, courses, stones, oculus, angle, staggered)
    sectors = 2 * stones if staggered else stones
    assert len(dome) == courses * sectors + (oculus is None)
    assert len({b.brick for b in dome}) == courses * stones + (oculus is None)
    problems = [p for p in dome.problems() if "sliver" not in p and "odd size" not in p]
    assert problems == []
    joints = dome.joints()
    assert len(joints) == courses * sectors + (courses - (oculus is not None)) * sectors
    # Corners lie on two spheres about (0, 0, -radius cos(angle/2)).
    corners = np.array([c for b in dome for c in b.corners])
    centre = np.array([0, 0, -radius * math.cos(math.radians(angle / 2))])
    far = np.linalg.norm(corners - centre, axis=1)
    near = np.isclose(far, radius, rtol=1e-9)
    assert near.sum() * 2 == len(corners)
    assert far[~near] == approx(radius + thickness, rel=1e-9)
    inner = 0.0
    for b in dome:
        on = np.array(b.corners) - centre
        on = on[np.isclose(np.linalg.norm(on, axis=1), radius, rtol=1e-6)]
        inner += ConvexHull([*on, (0, 0, 0)]).volume
    shell = inner * ((1 + share) ** 3 - 1)
    assert dome.volume == approx(shell, rel=1e-6)


def test_stones_of_a_staggered_dome_cover_the_joints_below():
    """Sector k of 2 n belongs to stone k // 2 in even courses and to (k - 1) // 2 in odd ones."""
    dome = Dome(3.0, 0.3, 4, 8, oculus=0.6, staggered=True)
    pieces = {}
    for b in dome:
        pieces.setdefault(b.brick, []).append(b)
    assert {len(p) for p in pieces.values()} == {2}
    vertical = {}
    for j in dome.joints():
        one, two = dome[j.first], dome[j.second]
        if one.course == two.course and one.brick != two.brick:
            at = math.degrees(math.atan2(j.middle[1], j.middle[0])) % 360
            vertical.setdefault(one.course, set()).add(round(at, 6) % 360)
    for course in range(3):
        assert len(vertical[course]) == 8
        assert not vertical[course] & vertical[course + 1]


@mark.parametrize(
    "make, said",
    [
        (lambda: Arch(0.2, 0.3, 15, span=1, radius=1), "either span or radius"),
        (lambda: Arch(0.2, 0.3, 1, radius=2), "1 voussoirs are too few for 180°"),
        (lambda: Dome(3, 0.3, 4, 2), "stones 2 must be at least 3"),
        (lambda: Dome(3, 0.3, 4, 9, oculus=3.5), "smaller than the springing's radius"),
        (lambda: Dome(3, 0.3, 4, 9, lantern=1), "needs an oculus that is wider than its wall"),
        (lambda: Arch(0.2, 0.3, 15, span=3, rise=2), "stones 15 must be even"),
        (lambda: Arch(0.2, 0.3, 15, radius=3, rise=2), "rise .* needs span"),
        (lambda: CrossVault(3, 0.2, 9, 4, pier=0.1), "pier 0.1 m must be at least the thickness"),
    ],
)
def test_an_impossible_vault_is_refused(make, said):
    with raises(ValueError, match=said):
        make()


@few
@given(sizes, some.floats(0.5, 2.0), some.floats(0.03, 0.3), some.integers(2, 20), some.booleans())
def test_a_pointed_arch_has_its_span_rise_and_thickness(span, tall, share, half, skewed):
    """Inner corners lie on two arcs about points of the springing line, outer ones on two that are
    ``thickness`` larger."""
    rise, thickness = (0.5 + tall) * span, share * span / half**0.5
    skewback = thickness if skewed else None
    arch = Arch(thickness, 0.3, 2 * half, span=span, rise=rise, skewback=skewback)
    stones = arch[: 2 * half]
    radius = (span**2 / 4 + rise**2) / span
    for n, b in enumerate(stones):
        centre = radius if n < half else span - radius
        far = [math.hypot(x - centre, z) for x, _, z in b.corners]
        assert sum(abs(r - radius) < 1e-9 * radius for r in far) == 4
        assert sum(abs(r - radius - thickness) < 1e-9 * radius for r in far) == 4
    assert max(min(c[2] for c in b.corners) for b in (stones[0], stones[-1])) == 0
    crown = [c[2] for c in stones[half - 1].corners if abs(c[0] - span / 2) < 1e-9 * span]
    assert min(crown) == approx(rise)
    assert len(arch.joints()) == len(arch) - 1
    assert [p for p in arch.problems() if "overlap" in p or "gap" in p or "no joint" in p] == []


def test_a_rise_up_to_half_the_span_is_that_of_a_circle():
    by = dict(thickness=0.2, depth=0.3, stones=9, span=3.0)
    rise = 1.5 * math.tan(math.radians(22.5))
    for one, two in (
        (Arch(rise=rise, **by), Arch(angle=90, **by)),
        (Arch(rise=1.5, **by), Arch(**by)),
    ):
        assert np.allclose([b.corners for b in one], [b.corners for b in two], atol=1e-12)


@few
@given(some.integers(2, 9), some.integers(2, 5), some.booleans(), some.integers(0, 2))
def test_webs_of_a_cross_vault_meet_in_its_diagonals(stones, rows, cloister, shape):
    """Its volume is that of strips along the webs: their area times the length between the diagonal
    and the edge, or between both diagonals."""
    span, thickness, pier, length = 3.0, 0.15, 0.4, 3.6
    rise = (None, 0.9, 2.0)[shape]
    stones += stones % 2 if shape == 2 else 0
    stones = max(stones, 4)
    how = dict(rise=rise, length=length, cloister=cloister)
    vault = CrossVault(span, thickness, stones, rows, pier=pier, **how)
    expected = 0.0
    for b in Arch(thickness, 1.0, stones, span=span, rise=rise):
        for part in Bricks([b]).cut((span / 2, 0, 0), (1, 0, 0)):
            (x, _, _), volume = middleOf(part), Bricks([part]).volume
            away = abs(x - span / 2)
            expected += volume * 2 * (2 * away if cloister else 2 * (span / 2 + pier - away))
    assert vault.volume == approx(expected * length / span, rel=1e-9)
    assert vault.problems() == []
    high = Arch(thickness, 1.0, stones, span=span, rise=rise).high[2]
    assert vault.high[2] == approx(high)
    # a brick at a diagonal is in both webs
    counts = Counter(b.brick for b in vault)
    corners = 4 * (stones // 2)
    assert Counter(counts.values())[2] == corners
    assert Counter(counts.values())[4] == stones % 2


def middleOf(block):
    """The centre of volume of a block [m]."""
    points = np.array(block.corners)
    hull, inner = ConvexHull(points), points.mean(axis=0)
    parts = [points[s] - inner for s in hull.simplices]
    volumes = [abs(np.linalg.det(p)) for p in parts]
    return inner + sum(v * p.sum(axis=0) / 4 for v, p in zip(volumes, parts)) / sum(volumes)


@mark.parametrize("staggered", [False, True])
def test_a_lantern_closes_the_bed_of_the_oculus(staggered):
    plain, dome = (Dome(2.0, 0.15, 6, 12, 0.4, staggered=staggered, lantern=h) for h in (None, 0.5))
    assert dome[: len(plain)] == plain and dome.problems() == []
    assert dome.high[2] == approx(plain.high[2] + 0.5 + 0.15)
    ring = dome.where(lambda b: b.part == "lantern")
    assert len({b.brick for b in ring}) == 13
    # trapezoids between two regular polygons on a cone
    inner, n = 0.4, 24 if staggered else 12
    outer, angle = inner * 2.15 / 2, math.asin(inner / 2)
    slant = math.hypot((outer - inner) * math.cos(math.pi / n), 0.15 * math.cos(angle))
    bed = [j.area for j in dome.joints() if j.first < len(plain) <= j.second]
    assert sum(bed) == approx(n * math.sin(math.pi / n) * (inner + outer) * slant)
