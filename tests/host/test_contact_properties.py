# SPDX-License-Identifier: GPL-2.0-or-later
"""Two convex blocks of any shape, size and relative position: what holds for their contact whatever they are.

Blocks are boxes and hulls of random points, slender up to 1:50, from 1 mm to 100 m. They meet with a face, an edge or a corner
of each, or anyhow. Where they touch follows here from the hull of all differences of their corners, which is no part of the
engine: both overlap if and only if the difference of their places lies inside.
"""

from hosted import *
from hypothesis import assume, given, settings
from hypothesis import strategies as some
from scipy.integrate import quad
from scipy.spatial import ConvexHull

STIFF = 1e10  # [Pa/m]


# -- shapes and places ------------------------------------------------------------------------------------------------


class Shape:
    """A convex block around corners."""

    def __init__(self, corners):
        self.hull = ConvexHull(corners)
        self.corners = self.hull.points[self.hull.vertices]
        self.normals = self.hull.equations[:, :3]
        self.surface = self.hull.area
        self.reach = np.ptp(self.corners, axis=0).max()
        self.thin = np.ptp(self.corners @ self.normals.T, axis=0).min()

    def feature(self, kind, number):
        """Where the block can meet another with a face, an edge or a corner: a direction out of it, and a point."""
        number %= len(self.normals)
        n, triangle = self.normals[number], self.hull.simplices[number]
        if kind == "face":
            heights = self.corners @ n
            return n, self.corners[heights > heights.max() - 1e-9 * self.reach].mean(axis=0)  # fmt: skip
        if kind == "corner":
            around = (self.hull.simplices == triangle[0]).any(axis=1)
            return unit(self.normals[around].sum(axis=0)), self.hull.points[triangle[0]]
        for other in self.hull.neighbors[number]:
            if n @ self.normals[other] < 1 - 1e-9:
                ends = np.intersect1d(triangle, self.hull.simplices[other])
                return unit(n + self.normals[other]), self.hull.points[ends].mean(axis=0)  # fmt: skip


def unit(v):
    return v / np.linalg.norm(v)


def rotation(q):
    return np.array(q.toRotationMatrix()).reshape(3, 3)


def towards(a, b):
    """The smallest turn that takes one direction to another."""
    axis, cosine = np.cross(a, b), float(a @ b)
    if np.linalg.norm(axis) < 1e-12:
        axis = np.cross(a, np.eye(3)[np.argmin(abs(a))])
    return Quaternion(Vector3(*unit(axis)), math.acos(max(-1, min(1, cosine))))


@some.composite
def shapes(draw, size):
    slender = np.array([1, draw(some.floats(0.02, 1)), draw(some.floats(0.02, 1))])
    if draw(some.booleans()):
        points = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        return Shape(size * slender * (points - 0.5))
    dice = np.random.default_rng(draw(some.integers(0, 2**32 - 1)))
    points = dice.normal(size=(draw(some.integers(5, 12)), 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    shape = Shape(0.5 * size * slender * points)
    assume(shape.thin > 1e-3 * shape.reach)
    return shape


class Pair:
    """Two shapes and a pose of the second, turn and place, in which it is pressed into the first by ``depth`` along a line."""

    def __init__(self, one, other, turn, along, aside, depth):
        self.one, self.other, self.turn = one, other, turn
        self.depth = depth
        turned = other.corners @ rotation(turn).T
        self.differences = ConvexHull((one.corners[:, None] - turned).reshape(-1, 3))
        start = aside
        planes = self.differences.equations
        while (
            True
        ):  # the line along which it comes must meet the hull of the differences
            rate, value = planes[:, :3] @ along, planes[:, :3] @ start + planes[:, 3]
            with np.errstate(divide="ignore"):
                at = -value / rate
            out, into = at[rate > 1e-12].min(), at[rate < -1e-12].max()
            if out > into:
                break
            start = 0.5 * start
            assume(np.linalg.norm(start) > 1e-6 * self.reach)
        self.line = Vector3(*along)
        self.place = Vector3(*(start + (out - depth) * along))

    @property
    def reach(self):
        return self.one.reach + self.other.reach

    @property
    def surface(self):
        """No smaller than that of the overlap."""
        return min(self.one.surface, self.other.surface)

    def inside(self, place):
        """By how much the other shape would have to move to get clear, in its present turn; negative: how far it is at least."""
        planes = self.differences.equations
        return -(planes[:, :3] @ np.array(place) + planes[:, 3]).max()


@some.composite
def pairs(draw, depths=(-8, -1)):
    size = 10 ** draw(some.floats(-3, 2))
    one = draw(shapes(size))
    other = draw(shapes(min(100, max(1e-3, size * 10 ** draw(some.floats(-1, 1))))))
    kinds, numbers = some.sampled_from(["face", "edge", "corner"]), some.integers(0, 100)  # fmt: skip
    along, at = one.feature(draw(kinds), draw(numbers))
    against, touch = other.feature(draw(kinds), draw(numbers))
    small = min(one.reach, other.reach)
    twist = draw(some.sampled_from([0, math.pi / 2, None]))
    if twist is None:
        twist = draw(some.floats(0, 2 * math.pi))
    turn = Quaternion(Vector3(*along), twist) * towards(against, -along)
    off = draw(some.sampled_from([0, 1e-6, 0.3])) * small
    dice = np.random.default_rng(draw(some.integers(0, 2**32 - 1)))
    if draw(some.integers(0, 3)) == 0:  # anyhow
        q = dice.normal(size=4)
        turn = Quaternion(*(q / np.linalg.norm(q)))
        along = unit(dice.normal(size=3))
    depth = min(one.thin, other.thin) * 10 ** draw(some.floats(*depths))
    return Pair(one, other, turn, along, at - rotation(turn) @ touch + off * dice.uniform(-1, 1, 3), depth)  # fmt: skip


# -- the engine -------------------------------------------------------------------------------------------------------


class Rig:
    """A pair in YADE: the first block is held, and the second is put to a pose before every step, which is so short that it
    does not move."""

    def __init__(self, pair, friction=0.0, swapped=False, shift=(0, 0, 0), turn=Quaternion.Identity):  # fmt: skip
        O.reset()
        stone = unitMaterial()
        self.pair, self.shift, self.turn = pair, Vector3(*shift), turn
        self.ids = {}
        for n in (1, 0) if swapped else (0, 1):
            shape = (pair.one, pair.other)[n]
            self.ids[n] = addBlock([Vector3(*c) for c in shape.corners], stone)
        self.states = [O.bodies[self.ids[n]].state for n in (0, 1)]
        self.first = [(Vector3(s.pos), Quaternion(s.ori)) for s in self.states]
        self.put(0, Quaternion.Identity, Vector3.Zero)
        self.states[0].blockedDOFs = "xyzXYZ"
        self.contacts = MasonryContacts(normalStiffness=STIFF, friction=friction, restitution=1)  # fmt: skip
        O.engines = [ForceResetter(), self.contacts, MasonryIntegrator(damping=0, gravity=(0, 0, 0))]  # fmt: skip
        O.dt = 1e-9 * criticalTimeStep()[0]

    def put(self, n, turn, place):
        """Put a block to a pose: its turn and the displacement of the origin of its corners, a Vector3."""
        s, (middle, axes) = self.states[n], self.first[n]
        whole = self.turn * turn
        s.pos = self.shift + self.turn * place + whole * middle
        s.ori = whole * axes
        s.vel = s.angVel = Vector3.Zero

    def at(self, place, turn=None):
        """Force on the second block in a pose, and its moment about the place of that block's corners [N, N m]."""
        turn = turn or self.pair.turn
        self.put(1, turn, place)
        O.step()
        back = self.turn.conjugate()
        force = back * O.forces.f(self.ids[1])
        return force, back * O.forces.t(self.ids[1]) + (turn * self.first[1][0]).cross(force)  # fmt: skip


@pytest.fixture(autouse=True)
def empty():
    yield
    O.reset()


#: What round-off of places does to a force: stiffness, surface, and this share of the size of the pair.
ROUND = 1e-14


def tolerance(pair):
    return ROUND * STIFF * pair.surface * pair.reach


@settings(max_examples=120)
@given(pairs(), some.sampled_from([-1, 1]))
def test_blocks_press_when_they_overlap_with_forces_and_moments_that_are_opposite(pair, sign):  # fmt: skip
    rig = Rig(pair)
    place = pair.place + (0 if sign > 0 else 2 * pair.depth) * pair.line
    force, _ = rig.at(place)
    deep, pressing = pair.inside(place), force.norm()
    one, other = rig.ids[0], rig.ids[1]
    if deep > 1e-11 * pair.reach:
        assert pressing > 0 and rig.contacts.touching() == 1
    if deep < -1e-11 * pair.reach:
        assert pressing == 0 and rig.contacts.touching() == 0
    assert rig.contacts.forceOf(one, other) == O.forces.f(other)
    assert rig.contacts.forceOf(other, one) == -O.forces.f(other)
    assert O.forces.f(one) == -O.forces.f(other)
    between = rig.states[1].pos - rig.states[0].pos
    rest = O.forces.t(one) + O.forces.t(other) + between.cross(O.forces.f(other))
    assert rest.norm() <= 1e-13 * pressing * (between.norm() + pair.reach)


@pytest.mark.slow
@settings(max_examples=100)
@given(
    pairs(depths=(-3, -1)),
    some.tuples(*[some.floats(-1, 1)] * 3),
    some.tuples(*[some.floats(-1, 1)] * 4),
)
def test_where_the_pair_stands_and_which_block_comes_first_changes_nothing(pair, shift, q):  # fmt: skip
    assume(np.linalg.norm(q) > 0.1)
    force, moment = Rig(pair).at(pair.place)
    turn = Quaternion(*(np.array(q) / np.linalg.norm(q)))
    allowed = 1e-9 * force.norm() + tolerance(pair)
    for same in (dict(swapped=True), dict(shift=pair.reach * np.array(shift), turn=turn)):  # fmt: skip
        again, momentAgain = Rig(pair, **same).at(pair.place)
        assert (again - force).norm() <= allowed
        assert (momentAgain - moment).norm() <= allowed * pair.reach


@pytest.mark.slow
@settings(max_examples=100)
@given(pairs(depths=(-4, -1)), some.integers(0, 2**32 - 1))
def test_the_force_does_not_jump(pair, seed):
    """Of 64 parts of a way, the one in whose middle the force is farthest from the mean of its ends is halved again and again by
    the same rule. In the end the force changes by what the stiffness of the surface explains, and by round-off.
    """
    rig = Rig(pair)
    dice = np.random.default_rng(seed)
    shift = Vector3(*(pair.depth * dice.uniform(-3, 3, 3)))
    axis = Vector3(*unit(dice.normal(size=3)))
    angle = dice.uniform(-3, 3) * pair.depth / pair.reach
    at = lambda t: rig.at(pair.place + t * shift, Quaternion(axis, t * angle) * pair.turn)[0]  # fmt: skip

    def part(low, high, first, last):
        middle = at(0.5 * (low + high))
        return (middle - 0.5 * (first + last)).norm(), low, high, first, middle, last

    forces = [at(n / 64) for n in range(65)]
    parts = [part(n / 64, (n + 1) / 64, *forces[n : n + 2]) for n in range(64)]
    for _ in range(40):
        _, low, high, first, middle, last = max(parts, key=lambda one: one[0])
        half = 0.5 * (low + high)
        parts = [part(low, half, first, middle), part(half, high, middle, last)]
    moved = 2 * (half - low) * (shift.norm() + abs(angle) * pair.reach)
    assert (last - first).norm() <= STIFF * pair.surface * moved + tolerance(pair)


class Path:
    """A closed path in six dimensions through the pose of a pair.

    :param wide: its size over the depth of the pair; beyond 1 it leaves contact
    :param afar: distance over the depth, along the line on which both meet, from which it comes and to which it goes
    """

    def __init__(self, pair, seed, wide, afar=0):
        dice = np.random.default_rng(seed)
        self.pair, self.afar = pair, afar * pair.depth
        some = lambda: Vector3(*(wide * pair.depth * dice.uniform(-1, 1, 3)))
        self.places = [[some(), some()], [some(), some()]]
        self.axes = [Vector3(*unit(dice.normal(size=3))) for _ in (0, 1)]
        self.angles = wide * pair.depth / pair.other.reach * dice.uniform(-1, 1, (2, 2, 2))  # fmt: skip
        self.angles = self.angles.tolist()

    def at(self, t):
        """Pose at t from 0 to 1, velocity, and angular velocity."""
        place, velocity = Vector3(self.pair.place), Vector3.Zero
        a = b = da = db = 0.0
        for n in (0, 1):
            rate = 2 * math.pi * (n + 1)
            sine, cosine = math.sin(rate * t), math.cos(rate * t)
            (p, q), (one, other) = self.places[n], self.angles[n]
            place += sine * p + (cosine - 1) * q
            velocity += rate * (cosine * p - sine * q)
            a += sine * one[0] + (cosine - 1) * one[1]
            b += sine * other[0] + (cosine - 1) * other[1]
            da += rate * (cosine * one[0] - sine * one[1])
            db += rate * (cosine * other[0] - sine * other[1])
        if self.afar:
            c = math.cos(math.pi * t)
            place += self.afar * c**8 * self.pair.line
            velocity -= self.afar * 8 * math.pi * c**7 * math.sin(math.pi * t) * self.pair.line  # fmt: skip
        first = Quaternion(self.axes[0], a)
        spin = da * self.axes[0] + db * (first * self.axes[1])
        return (
            place,
            first * Quaternion(self.axes[1], b) * self.pair.turn,
            velocity,
            spin,
        )


@pytest.mark.slow
@settings(max_examples=40)
@given(pairs(depths=(-3, -1)), some.integers(0, 2**32 - 1), some.sampled_from([1, 5]))
def test_a_closed_path_gives_back_its_work(pair, seed, wide):
    rig, path = Rig(pair), Path(pair, seed, wide)

    def power(t):
        place, turn, velocity, spin = path.at(t)
        force, moment = rig.at(place, turn)
        return force.dot(velocity) + moment.dot(spin)

    points = np.linspace(0, 1, 201)
    largest = np.ptp(np.cumsum([power(t) for t in points])) / 200
    assume(largest > 0)
    total = 0.0
    for a, b in zip(points[:-1:10], points[10::10]):
        total += quad(power, a, b, epsabs=1e-8 * largest, epsrel=0, limit=20)[0]
    assert abs(total) <= 1e-6 * largest


@pytest.mark.slow
@settings(max_examples=25)
@given(pairs(depths=(-3, -1)), some.integers(0, 2**32 - 1), some.floats(0.05, 2))
def test_friction_only_takes_energy(pair, seed, friction):
    """Both blocks come from afar, meet, slide and turn on each other, and part. What was put in is what friction has taken."""
    path, missing = Path(pair, seed, 2, 30), []
    for steps in (700, 1400):
        rig, lost, works, before = Rig(pair, friction=friction), 0.0, [0.0], 0.0
        for n in range(steps + 1):
            place, turn, velocity, spin = path.at(n / steps)
            force, moment = rig.at(place, turn)
            power = -(force.dot(velocity) + moment.dot(spin))
            works.append(works[-1] + 0.5 * (before + power) / steps)
            before = power
            assert rig.contacts.lostInFriction >= lost
            lost = rig.contacts.lostInFriction
        assume(rig.contacts.touching() == 0 and max(works) > 0)
        missing.append((works[-1] - lost) / max(works))
    assert works[-1] >= 0
    # what is missing falls with the step, and nothing remains where it is extrapolated to none
    assert abs(2 * missing[1] - missing[0]) < 3e-3 + 0.1 * abs(missing[0])
