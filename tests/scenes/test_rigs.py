# SPDX-License-Identifier: GPL-2.0-or-later
"""Piers as they are tested in rigs: what the top may do, and cycles of drift."""

from hosted import *
from masonry.numbers import drawing
from masonry_view import curve_figure

LENGTH, HEIGHT, THICKNESS, STRESS = 0.88, 0.972, 0.102, 0.4e6


PRESSED = 1e-3 * STRESS * LENGTH * THICKNESS  # [kN]


def pier(folder, rotation="free", **platen):
    wall = bricks.Wall(length=LENGTH, height=HEIGHT)
    scene = standing(folder, wall, materials.calciumSilicate(), rate=40)
    top = scene.platen("top", rotation=rotation, **platen)
    scene.press(top, STRESS)
    scene.settle()
    return scene, top


def test_a_top_that_keeps_its_height_presses_more_when_the_pier_rocks(tmp_path):
    scene, top = pier(tmp_path)
    scene.hold(top, "zY")
    scene.push(top, 2)
    force, up, turned = (scene.curve()[f"top_{n}"] for n in ("force_z_kN", "z_mm", "rotation_mrad"))
    assert force[1] == approx(PRESSED, rel=1e-3)
    assert np.ptp(up[1:]) == np.ptp(turned[1:]) == 0
    assert force.max() > 1.1 * PRESSED


def test_a_top_whose_force_is_kept_rises_when_the_pier_rocks(tmp_path):
    scene, top = pier(tmp_path)
    scene.push(top, 2)
    force, up = scene.curve()["top_force_z_kN"], scene.curve()["top_z_mm"]
    assert np.allclose(force[1:], PRESSED, rtol=0.02)
    assert up[-1] - up[1] > 0.3


BLOCK = (0.5, 0.3, 1.0)  # [m], pressed by 30 kN
PATH = 10, 2, 10, -10, 0  # [mm]


def inMachine(folder, path=PATH, **press):
    """A block that rocks between platens, the upper of which a machine presses."""
    scene = standing(folder, bricks.stack(1, BLOCK), materials.dry(normalStiffness=1e11), rate=40)
    top = scene.platen("top", rotation="free")
    scene.press(top, 0.2e6, **press)
    scene.settle()
    (folder / "path.csv").write_text("\n".join(["displacement_mm", *map(str, path)]))
    scene.follow(top, str(folder / "path.csv"))
    return scene, top


@mark.parametrize("friction, stiffness", [(0, 0), (0.05, 0), (0, 2e6), (0.05, 2e6)])
def test_the_load_of_a_machine_follows_uplift_and_lags(tmp_path, friction, stiffness):
    """N(u) = (N + k u)(1 ± f), and friction takes f of that over all that the platen travels, but
    for the 0.02 mm in which it grows and the 0.04 mm of a reversal."""
    scene, top = inMachine(tmp_path, friction=friction, stiffness=stiffness)
    curve, weight = scene.curve(), 1e-3 * scene.model.supports.weightOf(top)
    force, up = curve["top_force_z_kN"], curve["top_z_mm"] - curve["top_z_mm"][0]
    load = 30 - weight + 1e-6 * stiffness * up
    rises = np.sign(np.gradient(up))
    steady = [n for n in range(9, len(up) - 9) if abs(rises[n - 9 : n + 9].sum()) == 18]
    assert len(steady) > 500 and up.max() > 1
    off = (force - weight - load * (1 + friction * rises))[steady]
    assert abs(np.median(off)) < 0.002 * 30 and np.quantile(abs(off), 0.9) < 0.01 * 30
    assert curve["balance_error"].max() < 1e-6
    if not friction + stiffness:
        assert "dissipated_connectors_J" not in scene.results.columns
        return
    travelled = abs(np.diff(up))
    slipped = friction * (load[:-1] @ travelled - 30 * (0.02 + 6 * 0.04))  # up, and down, six times
    assert curve["dissipated_connectors_J"][-1] == approx(slipped, rel=0.02)
    stored = 0.5e-6 * stiffness * up.max() ** 2 + 0.5 * friction * 0.02 * load[0] ** 2 / 30
    assert curve["elastic_connectors_J"].max() == approx(stored, rel=0.02)


def test_a_wall_in_a_machine_is_the_mirror_image_of_itself(tmp_path):
    of = dict(friction=0.05, stiffness=2e6)
    curves = []
    for sign in (1, -1):
        folder = tmp_path / str(sign)
        scene, _ = inMachine(folder, [sign * x for x in (10, 2, 10)], **of)
        curves.append(scene.curve())
        scene.finish()
    for name, sign in (("base_shear_kN", -1), ("top_force_z_kN", 1)):
        there, back = (one[name] for one in curves)
        # impacts of the block on its joints enlarge round-off
        assert np.allclose(there, sign * back, atol=1e-3 * np.abs(there).max())


def test_a_machine_begins_anew_when_it_presses_again(tmp_path):
    scene, top = inMachine(tmp_path, (5, 10), friction=0.05, stiffness=2e6, riding=False)
    force = lambda: scene.curve()["top_force_z_kN"][-1]
    assert force() > 31
    assert scene.press(top, 0.3e6, longest=2) == AT_REST
    assert force() == approx(45, rel=1e-3)
    scene.hold(top, "zY")
    scene.push(top, 0.5)


BESIDE = {
    "lean": lambda scene, top: scene.lean(0.05) == AT_REST,
    "load": lambda scene, top: scene.load(top, (500, 0, -1e3)) == AT_REST,
    "grow": lambda scene, top: scene.grow({top: (1e3, 0, 0)}, over=0.5) and scene.factor > 0.9,
    "accelerate": lambda scene, top: scene.accelerate(0.05) and scene.factor > 0.04,
    "hold": lambda scene, top: not scene.hold(top, "zY") or scene.push(top, 0.2, rate=4),
    "settle": lambda scene, top: scene.settle() == AT_REST,
}


@BLOCKS
@mark.parametrize("beside", BESIDE)
def test_a_machine_presses_beside_other_loads(tmp_path, blocks, beside):
    """At rest the supports carry its present load, too."""
    wall = bricks.Wall(length=0.44, height=0.324)
    material, of = materials.calciumSilicate(), dict(blocks=blocks, divisions="1", rate=40)
    scene = standing(tmp_path, wall, material, **of)
    top = scene.platen("top", rotation="free")
    scene.press(top, STRESS, friction=0.05, stiffness=1e6)
    scene.settle()
    assert BESIDE[beside](scene, top)
    curve = scene.curve()
    pressed = 1e-3 * STRESS * 0.44 * THICKNESS
    assert curve["top_force_z_kN"][-1] == approx(pressed, rel=0.08 if beside != "load" else 0.13)
    assert curve["balance_error"].max() < 1e-3


def test_soft_guides_give_way_before_their_friction_slips(tmp_path):
    scene, top = inMachine(tmp_path, (5, 10), friction=0.05, guides=5e5)
    up = scene.curve()["top_z_mm"]
    load = scene.model.loading.loads["top_press"]
    assert load.slip == approx(0, abs=1e-12) and up[-1] - up[0] > 0.5
    assert load.reaction == approx(500 * (up[-1] - up[0]), rel=0.01)


@mark.parametrize("loads, dead", [(lambda top: {top: 1e4}, False), (lambda top: {}, True)])
def test_a_load_of_a_machine_does_not_grow(tmp_path, loads, dead):
    scene, top = inMachine(tmp_path, (0.1, 0.2), friction=0.05)
    with raises(ValueError, match="press top again"), scene:
        scene.grow(loads(top), dead=dead)


def test_the_base_shear_of_a_push_is_all_that_the_push_meets(tmp_path):
    """Also what the drive of an earlier push, which keeps its brick in place, carries of it."""
    scene = standing(tmp_path, bricks.stack(4, (0.4, 0.3, 0.2)), materials.dry(), rate=10)
    middle, top = scene.handle(1, name="middle"), scene.handle(3, name="top")
    scene.settle()
    scene.push(middle, 0.01)
    scene.push(top, 0.05)
    curve = scene.curve()
    base, pushed = curve["base_shear_kN"][-1], curve["top_shear_kN"][-1]
    assert base == approx(pushed, rel=0.02)
    assert 0 < -curve["base_force_x_kN"][-1] < 0.9 * base


@mark.parametrize("height", [0.5, 0.75])
def test_the_moment_is_zero_where_the_drive_of_a_free_top_acts(tmp_path, height):
    point = (LENGTH / 2, THICKNESS / 2, height * HEIGHT)
    scene, top = pier(tmp_path, point=point, recorded=HEIGHT)
    scene.push(top, 1, rate=10)
    curve = scene.curve()
    steady = curve["displacement_mm"] > 0.3  # the drive has its velocity
    assert steady.sum() > 10
    lever = (curve["base_M_y_kNm"] / curve["base_V_x_kN"])[steady]
    assert np.allclose(lever, height * HEIGHT, atol=0.03 * HEIGHT)


@mark.parametrize("rotation", ["free", "held"])
def test_drifts_are_over_the_height_of_what_turns_or_of_bricks(tmp_path, rotation):
    scene, top = pier(tmp_path, rotation)
    scene.cycle(top, [0.05, 0.1], unit="%")
    scene.finish()
    height = HEIGHT + (0.2 if rotation == "free" else 0)
    found = [a for a, _ in readRun(tmp_path)["history"]["amplitudes_mm"]]
    assert found == approx([0.5 * height, height], rel=1e-5)
    moved = scene.curve()["displacement_mm"]
    assert [-moved.min(), moved.max()] == approx([height] * 2, abs=0.02)


def test_a_handle_of_deformable_bricks_is_a_rigid_one_that_can_be_pushed(tmp_path):
    wall = bricks.Wall(length=0.44, height=0.324)
    scene = standing(
        tmp_path, wall, materials.calciumSilicate(), rate=40, blocks="deformable", divisions="1"
    )
    top = scene.handle(-1, "brick")
    scene.settle()
    scene.push(top, 0.2)
    assert top.body not in scene.model.zones.bodies
    assert len(scene.model.zones.bodies) == len(wall) - 1
    assert scene.curve()["brick_x_mm"][-1] == approx(0.2, abs=0.02)


def test_a_platen_is_not_held_along_an_axis_without_a_column_for_its_reaction(tmp_path):
    scene, top = pier(tmp_path)
    with raises(ValueError, match="no column for its reaction along x"), scene:
        scene.hold(top, "x")


@mark.parametrize("pressed", [False, True])
@mark.parametrize("weight", [0.0, 500.0])
def test_a_platen_weighs_what_it_is_said_to(tmp_path, weight, pressed):
    """With a press the stress counts, which has its weight."""
    blocks = bricks.stack(3, (0.4, 0.2, 0.2))
    scene = standing(tmp_path, blocks, materials.dry(friction=0.7))
    top = scene.platen("top", weight=weight)
    if pressed:
        scene.press(top, 1e4)
    scene.settle()
    carried = 1e4 * 0.4 * 0.2 if pressed else weight
    expected = 2600 * G * blocks.volume + carried
    assert scene.curve()["base_force_z_kN"][-1] == approx(-1e-3 * expected, rel=1e-3)


def test_a_push_is_shown_over_its_drift_and_its_force_over_the_weight(tmp_path):
    scene, top = pier(tmp_path, rotation="held")
    scene.args.ratios = True
    scene.push(top, 1)
    scene.finish()
    run, curve = readRun(tmp_path), arrays(tmp_path)
    expected = 0.1 * curve["masonry_displacement_mm"] / HEIGHT
    assert curve["drift_percent"] == approx(expected, rel=1e-6, abs=1e-9)
    figure, (at, peak) = run["figure"], (run["figure"]["marks"][0][k] for k in "xy")
    assert figure["x"]["column"] == "drift_percent" and at > 0
    assert float(f"{at:.9g}") in curve["drift_percent"]  # of a row, with the digits of curve.csv
    assert figure["weight_kN"] == approx(PRESSED + 1.8 * G * LENGTH * THICKNESS * HEIGHT, rel=0.02)
    with drawing.style():
        upper, _ = curve_figure.figureOf(run, readCurve(tmp_path), tmp_path).axes
        (right,) = upper.child_axes
    assert right.get_ylim()[1] == approx(upper.get_ylim()[1] / figure["weight_kN"])
