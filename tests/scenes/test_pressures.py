# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressures that vary, loads that grow together, and a load that travels, against answers by
hand."""

from hosted import *
from masonry.scene import pressures
from masonry.stages import travelling

WATER, DENSITY = 9810.0, 2400.0  # [N/m³], [kg/m³]
STONE = materials.dry(friction=0.7, normalStiffness=1e11, density=DENSITY)


def made(folder, blocks, *words, **settings):
    """A scene on a platen, with bounds beside the run."""
    scene = standing(folder, blocks, STONE, *words, **settings)
    scene.args.lean = False
    return scene


def moments(forces, about=(0, 0, 0)):
    """The sum of some forces and of their moments about a point."""
    force = np.sum([one.force for one in forces], axis=0)
    arms = [np.subtract(one.point, about) for one in forces]
    return force, np.sum(np.cross(arms, [one.force for one in forces]), axis=0)


def described(blocks, plane=None):
    return lean("nowhere", blocks, STONE, plane=plane).description


def pressed(description, field):
    """Forces of a pressure along x."""
    return pressures.pressures(description, field, (1, 0, 0), None, True)


def water(level):
    return lambda x, y, z: WATER * max(0, level - z)


# -- forces on faces -------------------------------------------------------------------------------


@mark.parametrize("plane", [None, False])
def test_the_resultant_of_water_acts_at_a_third_of_its_depth(plane):
    """Force γ h²/2 a metre, moment about the foot γ h³/6, whatever the height of the blocks."""
    dam = described(bricks.stack(4, (1.0, 0.8, 0.5)), plane)
    force, moment = moments(pressed(dam, water(2)), (0, 0.4, 0))
    assert force == approx([0.8 * WATER * 2**2 / 2, 0, 0], abs=1e-8)
    assert moment == approx([0, 0.8 * WATER * 2**3 / 6, 0], abs=1e-8)


def test_a_pressure_that_varies_to_both_sides_turns_a_face_without_pushing_it():
    """p = a y + b z from the middle of a face: moments a w h³/12 and the like, and no force."""
    block = described(bricks.block((0, -0.5, -1), (1, 0.5, 1)), False)
    force, moment = moments(pressed(block, lambda x, y, z: 300 * y + 700 * z))
    assert force == approx(np.zeros(3), abs=1e-9)
    assert moment == approx([0, 700 * 1 * 2**3 / 12, -300 * 2 / 12], abs=1e-9)


def test_what_a_joint_covers_of_a_face_has_no_pressure():
    """A low block before the foot of a high one, and water over both up to 2 m."""
    blocks = bricks.block((0, 0, 0), (1, 1, 2)) + bricks.block((-1, 0, 0), (0, 1, 1))
    found = pressed(described(blocks, False), water(2))
    high = moments([one for one in found if one.brick == 0], (0, 0.5, 0))
    assert high[0][0] == approx(WATER / 2)
    assert high[1][1] == approx(WATER / 2 * (1 + 1 / 3))


def test_snow_weighs_its_pressure_times_the_area_in_plan(tmp_path):
    """On a semicircular arch of 2.3 m to its outside: 1.2 kPa × 4.6 m × 0.5 m; water on it presses
    to the sides, too."""
    arch = bricks.Arch(0.3, 0.5, 21, radius=2.0)
    scene = made(tmp_path, arch)
    total = scene.pressure(1200, (0, 0, -1), part="arch", normal=False)
    # the outside of the arch is a polygon whose corners lie on the circle
    assert total == approx((0, 0, -1200 * 4.6 * 0.5), abs=1e-6)
    x, y, z = scene.pressure(water(3), (0, 0, -1), part="arch")
    assert x == approx(0, abs=1e-6)
    # by Gauss: the weight of the water between the polygon and its surface
    polygon = 0.5 * 21 * 2.3**2 * math.sin(math.pi / 21)
    assert z == approx(-WATER * 0.5 * (3 * 4.6 - polygon), rel=1e-9)


def test_a_level_within_a_face_is_found_within_a_part_of_it():
    dam = described(bricks.stack(2, (1.0, 0.8, 1.0)))
    force, _ = moments(pressed(dam, water(1.37)))
    assert force[0] == approx(0.8 * WATER * 1.37**2 / 2, rel=4e-3)


# -- runs ------------------------------------------------------------------------------------------


@mark.parametrize("words", [[], ["--preset", "bound"]])
def test_a_dam_of_blocks_tips_over_under_the_water_of_statics(tmp_path, words):
    """A dam of b × h tips about its foot under the factor f of a water level at its crown: W b/2 =
    f γ t h³/6."""
    h, b = 2.0, 0.8
    scene = made(tmp_path, bricks.stack(4, (b, 1.0, h / 4)), *words)
    scene.settle()
    scene.grow({}, most=2, pressure=water(h), towards=(1, 0, 0))
    scene.finish()
    limit = DENSITY * G * b * h * b / 2 / (WATER * h**3 / 6)
    (bound,) = readRun(tmp_path)["bounds"]
    assert bound["factor"] == approx(limit, rel=2e-3) and bound["exact"]
    assert words or 0.98 * limit < scene.factor < 1.002 * limit


def test_water_that_rises_in_stages_replaces_what_was_there(tmp_path):
    scene = made(tmp_path, bricks.stack(4, (1.0, 1.0, 0.5)))
    scene.settle()
    pushed = lambda: 1e3 * scene.results.column("base_force_x_kN")[-1]
    for level in (1.0, 1.5, 0.5):
        assert scene.pressure(water(level), (1, 0, 0)) == AT_REST
        assert pushed() == approx(WATER * level**2 / 2, rel=0.01)
    assert scene.pressure(0, (1, 0, 0)) == AT_REST
    assert abs(pushed()) < 10
    down = lambda: 1e3 * scene.results.column("base_force_z_kN")[-1]
    before = down()
    assert scene.pressure(1e3, (1, 0, 0), friction=20) == AT_REST
    dragged = 2e3 * math.tan(math.radians(20))
    assert (pushed(), before - down()) == (approx(2e3, rel=0.01), approx(dragged, rel=0.02))


def test_two_loads_in_proportion_tip_a_stack_at_the_factor_of_statics(tmp_path):
    """1 kN sideways tips it about its foot, and the load on the windward edge holds it, which grows
    along."""
    scene = made(tmp_path, bricks.stack(3, (0.3, 0.3, 0.2)), plane=False)
    side, edge = scene.handle((0.15, 0.15, 0.39)), scene.handle((0.0, 0.15, 0.55), name="edge")
    scene.load(edge, (0, 0, -300))
    scene.settle()
    grown = {side: (1e3, 0, 0), edge: (0, 0, -200)}
    assert scene.grow(grown, most=3, dead=True) == COLLAPSED
    scene.finish()
    weight = DENSITY * G * 0.3 * 0.3 * 0.6
    # about the edge at x = 0.3: W 0.15 + 300 (1 + f) 0.3 + 200 f 0.3 = f 1000 0.39
    limit = (weight * 0.15 + 300 * 0.3) / (1000 * 0.39 - (300 + 200) * 0.3)
    assert scene.factor == approx(limit, rel=0.01)
    (bound,) = readRun(tmp_path)["bounds"]
    assert bound["factor"] == approx(limit, rel=2e-3)


#: Points on the arch: place and height [m].
WATCHED = {"one": (0, 1.319), "two": (1, 1.571), "four": (3, 1.571), "five": (4, 1.319)}


def bridge(folder, *words):
    """An arch under fill, five places on it, and its highest stone."""
    arch = bricks.Arch(0.25, 0.5, 15, span=4.0, angle=140)
    scene = lean(folder, arch, STONE, *words)
    scene.args.lean = False
    for n in (0, 14):
        scene.hold(n)
    scene.pressure(lambda x, y, z: 18e3 * (2.2 - z), (0, 0, -1), normal=False)
    places = [(2 + x, 0.25, 9) for x in (-1.2, -0.6, 0, 0.6, 1.2)]
    for name, (n, z) in WATCHED.items():
        scene.watch((*places[n][:2], z), name=name)
    crown = scene.handle((2, 0.25, scene.description.high[2]), name="crown")
    scene.settle()
    assert scene.travel(2e3, places) == DONE
    return scene, crown


def test_an_axle_goes_over_an_arch_and_leaves_nothing(tmp_path):
    scene, _ = bridge(tmp_path)
    scene.finish()
    run, curve = readRun(tmp_path), readCurve(tmp_path)
    answers = {a["name"]: a["value"] for a in run["answers"]}
    assert answers["places_held"] == 5
    assert list(curve["load_factor"][-6:]) == [1, 2, 3, 4, 5, 0]
    loaded = []
    for n, name in enumerate(("one", "two", "crown", "four", "five"), 1):
        moved = curve[f"{name}_z_mm"]
        loaded.append(moved[-7 + n] - moved[-7])
    assert answers["largest_displacement"] == approx(min(loaded), rel=0.01)
    assert min(loaded) < 1.2 * max(loaded) < 0
    # what is elastic comes back
    assert answers["displacement_after"] < 0.05 * -answers["largest_displacement"]
    bounds = [b["factor"] for b in run["bounds"]]
    assert bounds == approx(bounds[::-1], rel=1e-3)
    assert answers["least_bound"] == min(bounds) < bounds[2]
    table = np.genfromtxt(tmp_path / "travel.csv", delimiter=",", names=True)
    assert table["bound_kN"] == approx(bounds, rel=1e-5)
    assert min(table["displacement_mm"]) == approx(answers["largest_displacement"], rel=1e-5)
    assert answers["largest_factor"] == approx(min(bounds) / 2)
    assert min(table["factor"]) == approx(min(bounds) / 2, rel=1e-5)


def test_the_bound_of_a_load_that_travels_is_that_of_one_that_stands_there(tmp_path):
    scene, crown = bridge(tmp_path, "--preset", "bound")
    scene.grow({crown: (0, 0, -1e5)})
    scene.finish()
    *travels, alone = [b["factor"] for b in readRun(tmp_path)["bounds"]]
    assert travels[2] == approx(alone, rel=1e-6)
    assert travels == approx(travels[::-1], rel=1e-3)


def test_a_load_that_travels_stands_on_the_highest_face_below(tmp_path):
    blocks = bricks.stack(3, (0.4, 0.4, 0.2)) + bricks.block((0.4, 0, 0), (0.8, 0.4, 0.2))
    description = described(blocks, False)
    below = lambda point: pressures.placesBelow(description, [point])
    for x, brick, z in ((0.1, 2, 0.6), (0.5, 3, 0.2)):
        assert below((x, 0.1, 5)) == [([brick], (x, 0.1, approx(z)))]
    for point in ((0.9, 0.1, 5), (0.5, 0.1, 0.1)):
        with raises(ValueError, match="no face that looks up is below"):
            travelling.sharesOf(description, [point], [(0.0, 1.0)], 0.0)


def test_pressures_that_are_no_numbers_and_loads_that_are_none_are_refused(tmp_path):
    scene = made(tmp_path, bricks.stack(2, (0.3, 0.3, 0.2)))
    for pressure, settings, message in (
        (lambda x, y, z: "deep", {}, r"pressure: its value at \(0, .*must be a number"),
        (lambda x: x, {}, "positional argument"),
        (lambda x, y, z: 1 / 0, {}, "division"),
        (0.0, {}, "0 on all faces"),
        (1.0, {"part": "roof"}, "'roof' must be one of stack"),
        (1.0, {"towards": (0, 1, 0)}, "the scene is in the x-z plane"),
    ):
        with raises(ValueError, match=message):
            scene.pressure(pressure, **{"towards": (1, 0, 0), **settings})
    scene.settle()
    with raises(ValueError, match="must say what grows"):
        scene.grow({})


# -- trains ----------------------------------------------------------------------------------------

#: Largest loads of a bridge of 8 m [kN] by a linear programme of its own, of a single axle and of
#: each of two with 1.5 m between them, by the place of the first [m].
SINGLE = {1.2: 285.1, 1.6: 273.0, 2.0: 288.3, 2.4: 337.6, 2.8: 442.6}
PAIR = {0.65: 205.9, 0.8: 227.7, 1.2: 260.3, 1.6: 360.1, 2.0: 671.0}


@mark.parametrize("held, axles", [(SINGLE, [(0, 1)]), (PAIR, [(0, 1), (1.5, 1)])])
def test_the_line_of_influence_of_a_bridge_is_that_of_its_linear_programme(tmp_path, held, axles):
    bridge = bricks.Arch(0.6, 1.0, 25, span=8.0, angle=105, skewback=0.5)
    stone = materials.dry(friction=0.6, normalStiffness=1e11, density=2200)
    scene = lean(tmp_path, bridge, stone, "--preset", "bound")
    for n in (25, 26):
        scene.hold(n)
    top = scene.description.high[2] + 0.4
    scene.pressure(lambda x, y, z: 18e3 * (top - z), (0, 0, -1), "arch", False)
    scene.settle()
    scene.travel(1e5, [(x, 0.5, 9) for x in held], axles=axles)
    scene.finish()
    table = np.genfromtxt(tmp_path / "travel.csv", delimiter=",", names=True)
    assert table["bound_kN"] == approx([*held.values()], rel=5e-3)
    assert table["factor"] == approx(table["bound_kN"] / 100)


def test_an_axle_on_fill_is_spread_over_the_bricks_below_it():
    """1 : 2 through 0.8 m: over 0.4 m to both sides, of bricks that end 0.4 m to the left of the
    first axle; of the second one, which is half as heavy, nothing stands on a brick."""
    blocks = bricks.block((0, 0, 0), (0.4, 0.4, 0.2)) + bricks.block((0.4, 0, 0), (1.0, 0.4, 0.2))
    description = described(blocks, False)
    shares = lambda x: travelling.sharesOf(description, [(x, 0.2, 1.0)], [(0, 1.0), (9, 0.5)], 0.5)
    (found,) = shares(0.4)
    assert found == [
        (0, (approx(0.2), 0.2, approx(0.2)), approx(0.5)),
        (1, (approx(0.6), 0.2, approx(0.2)), approx(0.5)),
    ]
    (found,) = shares(0.8)  # from 0.4 to 1.2, of which a quarter is beside the bricks
    assert found == [(1, (approx(0.7), 0.2, approx(0.2)), approx(0.75))]
