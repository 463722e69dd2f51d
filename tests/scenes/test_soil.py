# SPDX-License-Identifier: GPL-2.0-or-later
"""A tower on soil that turns: it leans by its weight, and above a height it falls over however
small the load is."""

from hosted import *
from masonry.stages import rest

SIDE, HEIGHT, DENSITY = 2.0, 20.0, 2000.0  # [m], [m], [kg/m³]
#: Weight times the height of the middle [N m]: a soil that is less stiff per radian does not hold
#: the tower upright.
OVERTURNING = DENSITY * G * SIDE**2 * HEIGHT**2 / 2


def tower(folder, stiffness):
    blocks = bricks.stack(2, (SIDE, SIDE, HEIGHT / 2))
    # stones whose bending the formulas may leave out: with 2e10 Pa a tower leans by 2.7 % more
    stones = materials.dry(friction=0.7, density=DENSITY, young=2e11, normalStiffness=5e10)
    scene = lean(folder, blocks, stones)
    springs = {"x": 1e8, "z": 1e8, "Y": stiffness}
    scene.platen("bottom", springs=springs, height=0.01)
    scene.watch(-1, name="top")
    return scene


def test_a_tower_leans_as_its_soil_gives_way_and_waits_for_its_slow_period(tmp_path):
    stiffness, pressure = 1.3 * OVERTURNING, 100.0  # its period is 14 s
    scene = tower(tmp_path, stiffness)
    assert scene.settle() == AT_REST
    assert scene.wind(pressure, (1, 0, 0)) == AT_REST
    moment = pressure * SIDE * HEIGHT**2 / 2
    leans = moment / (stiffness - OVERTURNING)
    moved = 1e3 * leans * 0.75 * HEIGHT  # in the middle of the upper stone
    assert scene.curve()["top_x_mm"][-1] == approx(moved, rel=0.03)


def test_a_tower_that_its_soil_does_not_hold_upright_is_not_at_rest(tmp_path, capsys):
    scene = tower(tmp_path, 0.9 * OVERTURNING)
    assert scene.settle() == MOVING
    assert "buckles" in capsys.readouterr().out


@mark.parametrize("length, height", [(8.0, 1.0), (1.0, 8.0)])
@mark.parametrize("place", [(0, 0, 0), (30, 0, -10)])
def test_the_slowest_period_is_that_of_rocking(tmp_path, length, height, place):
    """T = 2π √(I / (k - W h/2)), with the inertia I = m (l²/12 + h²/3) about the soil."""
    wall = bricks.Wall(length, height, (0.5, 0.3, 0.25), halves=False).moved(*place)
    scene = lean(tmp_path, wall, materials.dry(density=DENSITY))
    mass = DENSITY * length * height * 0.3
    stiffness = 2 * mass * G * height / 2
    scene.platen("bottom", springs={"Y": stiffness}, height=0.01)
    scene.begin()
    inertia = mass * (length**2 / 12 + height**2 / 3)
    expected = 2 * math.pi * math.sqrt(inertia / (stiffness / 2))
    assert scene.model.supports.slowest() == approx(expected, rel=0.03)


@mark.parametrize("plane, slender", [(True, False), (False, True)])
def test_a_thin_wall_is_slender_unless_it_stays_in_its_plane(plane, slender):
    box = SimpleNamespace(low=(0, 0, 0), high=(1.0, 0.125, 1.0), plane=plane)
    supports = SimpleNamespace(slowest=lambda: 0.0)
    scene = SimpleNamespace(description=box, model=SimpleNamespace(supports=supports))
    assert rest.isSlender(scene) == slender


@mark.parametrize("turned", [0, 90])
def test_without_tension_the_slowest_period_is_about_the_longer_side(tmp_path, turned):
    """T = 2π √(I/(k b²/12 - W h/2)), I = m (b²/12 + h²/3), of the shorter side b."""
    length, height, thickness, stiffness = 4.0, 3.0, 1.0, 1e8
    wall = bricks.Wall(length, height, (0.5, thickness, 0.25), halves=False).turned(turned)
    scene = lean(tmp_path, wall, materials.dry(density=DENSITY), plane=False)
    scene.platen("bottom", springs={"z": stiffness}, uplift=True, height=0.01)
    scene.begin()
    mass = DENSITY * length * height * thickness
    inertia = mass * (thickness**2 / 12 + height**2 / 3)
    turning = stiffness * thickness**2 / 12 - mass * G * height / 2
    expected = 2 * math.pi * math.sqrt(inertia / turning)
    assert scene.model.supports.slowest() == approx(expected, rel=0.03)


def test_the_period_is_that_of_small_motions_also_where_a_larger_one_lifts_off(tmp_path):
    """A rigid tower on soil that takes no tension: T = 2π √(I/(k l²/12 - W h/2)). Under 0.05 g an
    edge lifts off, and the period would be 8 % longer."""
    side, high, below, soil = 3.6, 20.0, 0.2, 2e9  # [m], [m], [m], [N/m]
    stone = materials.dry(0.9, density=1000, normalStiffness=1e12, young=1e15)
    scene = lean(tmp_path, bricks.stack(1, (side, side, high)), stone)
    scene.platen("bottom", springs={"z": soil}, uplift=True, height=below)
    scene.settle()
    scene.period()
    middle = below + high / 2
    inertia = 1000 * side**2 * high * ((side**2 + high**2) / 12 + middle**2)
    stiffness = soil * side**2 / 12 - 1000 * side**2 * high * G * middle
    [found] = [a["value"] for a in scene.answers if a["name"] == "first_period"]
    assert found == approx(2 * math.pi * math.sqrt(inertia / stiffness), rel=0.01)


def test_small_horizontal_loads_must_be_carried_on_their_own(tmp_path):
    scene = tower(tmp_path, 3 * OVERTURNING)
    scene.begin()
    supports = scene.model.supports
    for across, missing in ((0.5, 0.5e-3), (2.0, 1.0)):  # of a load of 1 kN
        supports.applied = lambda: Vector3(across, 0, -1000)
        supports.carried = lambda: Vector3(0, 0, 1000)
        assert supports.unrest()[0] == approx(missing, rel=1e-3)


def test_a_wall_that_is_soft_sinks_far_and_slowly_and_has_not_fallen(tmp_path):
    """Its blocks move by a tenth of their size, as fast as blocks fall if the load comes in the
    usual time."""
    side, pressure, stiffness = 0.25, 1e6, 2e8
    blocks = bricks.stack(4, (side, side, side))
    stones = materials.dry(friction=0.7, density=DENSITY, normalStiffness=stiffness)
    scene = standing(tmp_path, blocks, stones)
    scene.press(scene.platen("top", guided="x"), pressure)
    assert scene.settle() == AT_REST
    sinks = 5 * pressure / stiffness + sum(range(1, 5)) * DENSITY * G * side / stiffness
    assert scene.curve()["top_z_mm"][-1] == approx(-1e3 * sinks, rel=0.01)


def test_a_press_over_rollers_keeps_its_line_while_what_it_presses_leans(tmp_path):
    """If it rode with the platen until a push begins, and then came back to its line at once, that
    would be a blow."""
    scene = tower(tmp_path, 3 * OVERTURNING)
    roof = scene.platen("top", rotation="free", name="roof")
    scene.press(roof, 1e4, riding=False)
    scene.load(roof, (3e3, 0, 0))
    assert scene.settle() == AT_REST
    load = scene.model.loading.loads["roof_press"]
    moved = load.displacement()[0]
    middle = approx(SIDE / 2, abs=1e-2 * moved)
    assert moved > 1e-3 and load.point[0] + moved == middle
