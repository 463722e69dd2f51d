# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks of our own beside YADE's Polyhedra: the same numbers and the same runs."""

import yade.wrapper
from hosted import *

polyhedra = mark.skipif(not hasattr(yade.wrapper, "Polyhedra"), reason="this YADE has no Polyhedra")


def samples():
    """Corners of many blocks: boxes, turned boxes, prisms and random ones, of at most 14
    points."""
    rng = random.Random(15)
    place = lambda: [rng.uniform(-3, 3) for _ in range(3)]
    size = lambda: [rng.uniform(0.05, 0.5) for _ in range(3)]
    for _ in range(40):
        yield box(place(), size())
    for _ in range(40):
        turn = Quaternion(*[rng.gauss(0, 1) for _ in range(4)]).normalized()
        shift = Vector3(*place())
        yield [turn * p + shift for p in box((0, 0, 0), size())]
    for corners in (3, 4, 5, 6, 7):
        angles = [2 * math.pi * i / corners for i in range(corners)]
        rays = [Vector3(math.cos(a), math.sin(a), 0) for a in angles]
        yield [0.2 * ray + Vector3(0, 0, z) for ray in rays for z in (0, 0.1)]
    for _ in range(60):
        yield cloud(rng, rng.randint(4, 14))


def cloud(rng, count):
    return [Vector3(*(rng.gauss(0, 0.2) for _ in range(3))) for _ in range(count)]


# -- shape -----------------------------------------------------------------------------------------


@polyhedra
def test_a_block_has_every_bit_of_a_polyhedra_of_the_same_points():
    # of more points the order in which Polyhedra has them is one of chance
    for points in (points for points in samples() if len(points) <= 8):
        own, centroid, orientation = MasonryBlock.around(points)
        host = Polyhedra(v=points)
        assert own.volume == host.GetVolume()
        assert own.inertia == host.GetInertia()
        assert centroid == host.GetCentroid()
        assert orientation == host.GetOri()
        assert list(own.v) == list(host.v)
        assert own.triangles == host.GetSurfaceTriangulation()


def test_a_block_has_the_same_bits_wherever_its_memory_lies():
    """Prisms over regular polygons, whose faces CGAL divides as it likes, and clouds of points."""
    dice, made = random.Random(1), {}
    several = [*list(samples())[80:85], *(cloud(dice, 40) for _ in range(5))]
    for _ in range(60):
        for n, points in enumerate(several):
            # what is free of the memory decides which of two addresses is the lower
            kept = [bytearray(dice.randint(500, 5000)) for _ in range(40)]
            del kept[:: dice.randint(2, 3)]
            block, *place = MasonryBlock.around(points)
            bits = [x.hex() for corner in block.v for x in corner]
            made.setdefault(n, set()).add(str((bits, block.triangles, place)))
    assert all(len(found) == 1 for found in made.values())


def test_volume_centroid_and_inertia_are_those_of_a_box():
    a, b, c = UNIT
    block, centroid, orientation = MasonryBlock.around(box((1, -2, 3)))
    assert block.volume == approx(a * b * c, rel=1e-12)
    assert (centroid - Vector3(1 + a / 2, -2 + b / 2, 3 + c / 2)).norm() < 1e-12
    expected = [a * b * c * (p * p + q * q) / 12 for p, q in ((b, c), (a, c), (a, b))]
    assert sorted(block.inertia) == approx(sorted(expected), rel=1e-9)
    turned = [orientation * v + centroid for v in block.v]
    assert all(min((t - p).norm() for t in turned) < 1e-12 for p in box((1, -2, 3)))


def test_the_surface_of_a_block_is_closed_and_faces_outward():
    for points in samples():
        block = MasonryBlock.around(points)[0]
        t = block.triangles
        triangles = [t[i : i + 3] for i in range(0, len(t), 3)]
        edges = [(a, b) for x, y, z in triangles for a, b in ((x, y), (y, z), (z, x))]
        assert sorted(edges) == sorted((b, a) for a, b in edges)
        for x, y, z in triangles:
            a, b, c = block.v[x], block.v[y], block.v[z]
            assert (b - a).cross(c - a).dot(a) > 0  # the centroid is the origin


def test_a_new_block_has_the_looks_of_a_new_shape():
    block, sphere = MasonryBlock(), Sphere()
    for name in ("color", "wire", "highlight"):
        assert getattr(block, name) == getattr(sphere, name)


def test_points_without_volume_are_refused():
    flat = [Vector3(x, y, 0) for x in (0, 1) for y in (0, 1)]
    for points in ([], flat, flat[:2], [Vector3(1, 2, 3)] * 5):
        with raises(ValueError, match="the corners of the block have no volume"):
            MasonryBlock.around(points)


def test_a_body_with_a_block_without_corners_is_refused():
    pile()
    O.bodies[1].shape = MasonryBlock()
    engines([MasonryJoint()])
    with raises(ValueError, match="body 1 has a MasonryBlock without corners"):
        connect()


# -- runs ------------------------------------------------------------------------------------------


def addPolyhedra(points, material):
    """A brick as YADE makes it: what scenes did before there was MasonryBlock."""
    from yade import polyhedra_utils

    body = polyhedra_utils.polyhedra(material, v=points)
    body.state.refPos, body.state.refOri = body.state.pos, body.state.ori
    body.bounded = False
    return O.bodies.append(body)


def stack(kinds, functors=False, zones=False, steps=1500):
    """Three turned bricks, the lowest held, the highest driven sideways until joints are damaged.
    All state at the end."""
    O.reset()
    turn = IN_SPACE
    material = MasonryMat(density=1800)
    for course, make in enumerate(kinds):
        make([turn * p for p in box((0.03 * course, 0, UNIT[2] * course))], material)
    hold(0)
    held = MasonryZones(bodies=[1], divisions=[2, 1, 1]) if zones else None
    driven = dict(driven=True, direction=turn * Vector3(1, 0, 0.25), velocity=0.02)
    load = MasonryLoad(body=2, point=O.bodies[2].state.pos, label="load", **driven)
    join(loads=[load], zones=held, functors=functors)
    run(steps)
    return state()


def state():
    phys = lambda p: (p.stress, p.damage, p.slip)
    ours = lambda i: (i.id1, i.id2, *phys(i.phys), i.geom.jumps, i.geom.areas)
    joints = [ours(i) for i in O.interactions]
    motion = lambda s: (s.pos, s.ori, s.vel, s.angVel, s.mass, s.inertia)
    bodies = [motion(b.state) for b in O.bodies]
    return O.iter, engine("load").reaction, joints, bodies


@polyhedra
@mark.parametrize("how", [{}, {"functors": True}, {"zones": True}])
def test_runs_of_both_kinds_of_body_are_equal_to_the_bit(how):
    own = stack([addBlock] * 3, **how)
    assert any(d != 0 for joint in own[2] for point in joint[3] for d in point)
    assert stack([addPolyhedra] * 3, **how) == own
    assert stack([addBlock, addBlock, addPolyhedra], **how) == own


@polyhedra
def test_a_joint_may_lie_between_both_kinds_of_body():
    """YADE swaps the bodies of a joint whose functor names the other kind first, which turns signs
    and rounding."""
    own = stack([addBlock] * 3, steps=50)
    mixed = stack([addPolyhedra, addBlock, addPolyhedra], steps=50)
    assert [(j[0], j[1]) for j in mixed[2]] == [(1, 0), (1, 2)]
    assert mixed[1] == approx(own[1], rel=1e-9)
    for one, two in zip(own[3], mixed[3]):
        assert (one[0] - two[0]).norm() < 1e-12


@polyhedra
def test_a_scene_with_the_functor_for_polyhedra_goes_on_working():
    material = MasonryMat(density=1800)
    for course in range(2):
        addPolyhedra(box((0, 0, UNIT[2] * course)), material)
    hold(0)
    geometry = Ig2_Polyhedra_Polyhedra_MasonryJointGeom(subcontacts=4, rows=2)
    physics = Ip2_MasonryMat_MasonryMat_MasonryJointPhys(joints=[MasonryJoint()])
    law = Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening()
    O.engines = [
        ForceResetter(),
        InteractionLoop([geometry], [physics], [law]),
        MasonryEnergy(),
        NewtonIntegrator(gravity=(0, 0, -9.81)),
    ]
    (interaction,) = connect()
    assert len(interaction.geom.areas) == 8
    O.dt = 0.5 * criticalTimeStep()[0]
    run(200)
    assert O.forces.f(1, True)[2] > 0


def test_the_attributes_of_a_block_are_read_only():
    block = MasonryBlock.around(box((0, 0, 0)))[0]
    for name in ("v", "triangles", "volume", "inertia"):
        with raises(AttributeError):
            setattr(block, name, getattr(block, name))
