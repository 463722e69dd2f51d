# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure of soil: coefficients against the wedge that they stand for and against numbers by hand,
and a dry-stone retaining wall that it overturns."""

from hosted import *
from masonry import earth
from masonry.scene import pressures

SLOPES = [
    (35, 0, 0, 0, 0, 0),
    (32, 20, 10, 15, 0, 0),
    (30, 10, -8, -10, 0, 0),
    (35, 0, 0, 0, 0.145, 0),
    (38, 20, 6, 12, 0.2, 0.1),
    (33, 15, -5, 5, 0.15, -0.08),
]


def wedge(friction, wall, batter, slope, kh, kv, surcharge=0.0):
    """The largest force of a wedge on a face of 1 m, for γ = 1, by the equilibrium of its two
    directions."""
    phi, delta, omega, beta = map(math.radians, (friction, wall, batter, slope))
    crest = np.array([math.tan(omega), 1.0])
    uphill = np.array([-math.cos(beta), math.sin(beta)])
    onto = np.array([-math.cos(omega + delta), math.sin(omega + delta)])
    most = 0.0
    for angle in np.radians(np.linspace(max(1, slope + 0.5), 89 + min(0, batter), 6000)):
        plane = np.array([-math.cos(angle), math.sin(angle)])
        length, _ = np.linalg.solve(np.column_stack([plane, -uphill]), crest)
        if length <= 0:
            continue
        end = length * plane
        weight = 0.5 * abs(crest[0] * end[1] - crest[1] * end[0])
        weight += surcharge * (crest[0] - end[0])
        below = np.array([math.sin(angle - phi), math.cos(angle - phi)])
        load = weight * np.array([kh, kv - 1])
        force, _ = np.linalg.solve(np.column_stack([onto, below]), -load)
        most = max(most, force)
    return most


@mark.parametrize("given", SLOPES)
def test_the_active_force_is_that_of_the_worst_wedge(given):
    assert 0.5 * earth.active(*given) * (1 - given[-1]) == approx(wedge(*given), rel=1e-4)


@mark.parametrize("given", SLOPES)
def test_a_surcharge_adds_what_it_adds_to_the_weight_of_the_wedge(given):
    *_, batter, slope, kh, kv = given
    shaken = dict(foot=0.0) if kh else {}
    names = ("wall", "batter", "slope", "kh", "kv")
    soil = [earth.Soil(1.0, given[0])]
    at = earth.pressure(soil, 1.0, 0.7, **dict(zip(names, given[1:])), **shaken)
    height = np.linspace(0, 1, 2001)
    normal = np.mean([at(0, 0, z) for z in height]) / math.cos(math.radians(batter))
    assert normal / math.cos(math.radians(given[1])) == approx(wedge(*given, 0.7), rel=1e-3)


def test_earth_at_rest_has_the_coefficients_of_the_code():
    assert earth.atRest(30) == approx(0.5)
    assert earth.atRest(30, overconsolidation=4) == approx(1.0)
    assert earth.atRest(30, slope=20) == approx(0.5 * (1 + math.sin(math.radians(20))))


def test_layers_and_water_by_hand():
    """2 m of 18 kN/m³ and 30° over 20 kN/m³ (saturated) and 35°, water from 1 m below the top."""
    soil = [earth.Soil(18e3, 30, 2.0), earth.Soil(20e3, 35)]
    at = earth.pressure(soil, top=5.0, surcharge=10e3, water=4.0)
    over, under = 1 / 3, earth.active(35)
    assert at(0, 0, 5) == approx(over * 10e3)
    assert at(0, 0, 4) == approx(over * 28e3)
    assert at(0, 0, 3.0001) == approx(over * (28e3 + 8190), rel=1e-3)
    assert at(0, 0, 2) == approx(under * (28e3 + 8190 + 10190))
    assert at(0, 0, 5.1) == 0
    assert earth.groundWater(4.0)(0, 0, 2) == approx(2 * 9810)
    # what holds its water shakes with its whole weight: tan θ = 20/10.19 kh
    wet = earth.pressure([earth.Soil(20e3, 35)], top=1.0, water=1.0, foot=0.0, kh=0.1)
    force = np.mean([wet(0, 0, z) for z in np.linspace(0, 1, 11)])
    assert force == approx(0.5 * 10190 * earth.active(35, kh=0.1 * 20 / 10.19))


@mark.parametrize(
    "act, message",
    [
        (lambda: earth.active(30, slope=31), "slope of 31 degrees must be at most 30"),
        (lambda: earth.active(30, wall=31), "wall friction 31 degrees must be at most 30"),
        (lambda: earth.active(30, wall=21, kh=0.1), "wall friction 21 degrees must be at most 20"),
        (lambda: earth.active(30, batter=45, kh=1.2), "no active pressure"),
        (lambda: earth.active(0), "0 degrees must be above 0"),
        (lambda: earth.atRest(30, slope=-1), "must be from 0 to 30"),
        (lambda: earth.pressure([earth.Soil(18e3, 30)], 1, kh=0.1), "need the foot"),
        (lambda: earth.pressure([earth.Soil(18e3, 30, 1.0)], 2, foot=0), "no soil below 1 m"),
        (lambda: earth.pressure([earth.Soil(18e3, 30)] * 2, 2), "needs a thickness"),
        (lambda: earth.pressure([earth.Soil(9e3, 30)], 2, water=1), "saturated weight"),
        (lambda: earth.pressure([earth.Soil(18e3, 30)], 2, rest=True, kh=0.1), "at rest there"),
    ],
)
def test_what_has_no_value_is_refused(act, message):
    with raises(ValueError, match=message):
        act()


def test_wall_friction_drags_a_face_down_along_its_slope():
    """On a vertical face p tan δ, on a battered one along it."""
    for batter, point in ((0, (0, 0, 1)), (20, (math.tan(math.radians(20)), 0, 1))):
        block = bricks.block((0, 0, 0), (2, 1, 1))
        if batter:
            block = block.cut(point, (-1, 0, math.tan(math.radians(batter))))[:1]
        description = lean("nowhere", block, plane=False).description
        found = pressures.pressures(description, 1e3, (1, 0, 0), None, True, 25)
        x, _, z = np.sum([one.force for one in found], axis=0)
        lies = math.radians(25 + batter)
        whole = 1e3 / math.cos(math.radians(batter)) / math.cos(math.radians(25))
        assert (x, z) == approx((whole * math.cos(lies), -whole * math.sin(lies)))
        letGo()


# -- a retaining wall ------------------------------------------------------------------------------

HEIGHT, BASE, CREST, COURSES = 2.5, 1.2, 0.6, 10  # [m]


#: By hand, of 1 m: weight and active force [N].
WEIGHT = 2200 * G * HEIGHT * (BASE + CREST) / 2
ACTIVE = 0.2710 * (18e3 * HEIGHT**2 / 2 + 5e3 * HEIGHT)


def retaining(folder, length=BASE, friction=0.65):
    """The wall, 1 m of it, its front battered, in courses of blocks of a length [m]."""
    course = (length, 1.0, HEIGHT / COURSES)
    wall = bricks.stack(COURSES, course)
    if length < BASE:
        wall = bricks.Wall(BASE, HEIGHT, course, halves=False)
    foot, front = (BASE, 0, 0), (HEIGHT, 0, BASE - CREST)
    behind = lambda b: np.dot(np.mean(b.corners, axis=0) - foot, front) < 0
    wall = bricks.Bricks([b for b in wall.cut(foot, front) if behind(b)])
    stone = materials.dry(friction=friction, normalStiffness=1e11, density=2200)
    scene = standing(folder, wall, stone, "--preset", "bound")
    scene.args.lean = False
    return scene


def behindIt(kh=0.0):
    return earth.pressure([earth.Soil(18e3, 35)], HEIGHT, 5e3, foot=0.0, kh=kh)


def test_a_dry_stone_wall_slides_at_the_safety_of_statics(tmp_path):
    """Safety μ W/E against sliding: 1.694."""
    scene = retaining(tmp_path)
    assert scene.pressure(behindIt(), (1, 0, 0)) == approx((ACTIVE, 0, 0), rel=1e-3)
    letGo()
    scene = retaining(tmp_path)
    scene.grow({}, most=2, pressure=behindIt(), towards=(1, 0, 0))
    scene.finish()
    (bound,) = readRun(tmp_path)["bounds"]
    assert 0.65 * WEIGHT / ACTIVE == approx(1.694, rel=1e-3)
    assert bound["factor"] == approx(1.694, rel=1e-3)


@mark.parametrize(
    "key, kh, length, friction",
    [
        ("factor", 0.1450, BASE, 0.65),  # slides
        ("factor", 0.1757, BASE, 3.0),  # tips over
        ("without_dilatancy", 0.1305, 0.4, 0.65),  # a stepped wedge tips, by another programme
    ],
)
def test_a_dry_stone_wall_falls_at_the_acceleration_that_presses_it(
    tmp_path, key, kh, length, friction
):
    """The pressure of kh is there, and the inertia of the wall grows to the same kh."""
    scene = retaining(tmp_path, length, friction)
    scene.pressure(behindIt(kh), towards=(1, 0, 0))
    scene.settle()
    scene.accelerate(0.3, (1, 0, 0))
    scene.finish()
    (bound,) = readRun(tmp_path)["bounds"]
    assert bound[key] == approx(kh, rel=6e-3 if length < BASE else 2e-3)
