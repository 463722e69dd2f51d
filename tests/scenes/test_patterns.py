# SPDX-License-Identifier: GPL-2.0-or-later
"""Pushes in a pattern: forces on several blocks in a fixed proportion."""

from hosted import *
from masonry.model.loading import pushTo
from masonry.model.period import firstMode
from masonry_capacity.bilinear_curve import pushover
from masonry.numbers.run_data import MOVED, RunData
from masonry.stages.push import patternOf

#: A dry pier of stiff joints [m], that turns about its toe.
WIDTH, HEIGHT = 0.6, 3.0
STONE = materials.dry(friction=2.0, normalStiffness=2e10, density=2400)


WEIGHT = WIDTH * 0.4 * HEIGHT * 2400 * G  # [N]


def pier(folder, *words, stone=STONE):
    """A pier that stands on its base, with a handle at its top and in its middle."""
    blocks = bricks.stack(6, (WIDTH, 0.4, HEIGHT / 6))
    scene = standing(folder, blocks, stone, *words, rate=20)
    handles = scene.handle(-1, "top"), scene.handle(2, "middle")
    scene.settle()
    return scene, *handles


@mark.parametrize("pattern", ["masses", "triangle", "place"])
def test_a_pier_turns_about_its_toe_at_the_force_by_hand(tmp_path, pattern):
    scene, top, middle = pier(tmp_path)
    heights = np.array([(n + 0.5) * HEIGHT / 6 for n in range(6)])
    forces = heights ** ["masses", "triangle", "place"].index(pattern)
    shape = pattern if pattern != "place" else lambda x, y, z: z**2
    lever = np.dot(heights, forces) / np.sum(forces)
    expected = 1e-3 * WEIGHT * WIDTH / 2 / lever  # [kN]
    bound = scene.bound(shape)
    scene.push(shape, 1.5, rate=1, control=top)
    scene.finish()
    curve = scene.curve()
    assert bound["factor"] == approx(expected, rel=1e-4)
    assert readRun(tmp_path)["first_period_s"] > 0
    assert curve["base_shear_kN"][-1] == approx(expected, rel=0.02)
    moment, shear = curve["base_M_y_kNm"][-1], curve["base_V_x_kN"][-1]
    assert moment / shear == approx(lever, rel=0.01)


def test_forces_on_targets_keep_their_shares_and_do_the_work_of_the_push(tmp_path):
    # the error of the balance falls with the square of the time step
    scene, top, middle = pier(tmp_path, "--dt-fraction", "0.4")
    scene.push({top: 1, middle: 3}, 1, control=middle)
    curve = scene.curve()
    above, below = (curve[f"{n}_force_x_kN"] for n in ("top", "middle"))
    assert np.allclose(below, 3 * above, rtol=1e-9) and abs(above[-1]) > 0.1
    assert np.allclose(-above - below, curve["top_shear_kN"], rtol=1e-9)
    assert curve["displacement_mm"][-1] == approx(1, abs=0.02)
    moved = curve["middle_x_mm"][-1] - curve["middle_x_mm"][1]
    assert curve["displacement_mm"][-1] == approx(moved, abs=1e-3)
    assert max(map(abs, curve["balance_error"])) < 1e-8


def test_the_first_mode_of_a_slender_pier_is_that_of_a_cantilever(tmp_path):
    blocks = bricks.stack(20, (0.1, 0.4, 0.05))
    scene = standing(tmp_path, blocks, materials.calciumSilicate())
    scene.watch(-1)
    scene.settle()
    shape = firstMode(scene.model, Vector3.UnitX, 1.0)
    found = [shape[body] for body in scene.model.ids]
    k = 1.8751  # of the first mode, over the length
    ratio = (math.sinh(k) - math.sin(k)) / (math.cosh(k) + math.cos(k))

    def bent(x):
        return math.cosh(k * x) - math.cos(k * x) - ratio * (math.sinh(k * x) - math.sin(k * x))

    expected = [bent((n + 0.5) / 20) / bent(19.5 / 20) for n in range(20)]
    assert np.allclose(np.array(found) / found[-1], expected, atol=0.02)


def test_a_drive_in_a_pattern_is_let_go_before_another_one_begins(tmp_path):
    scene, top, middle = pier(tmp_path)
    scene.push("masses", 0.2, control=top)
    triangle = patternOf(scene, "triangle", Vector3.UnitX, scene.args)
    with scene:
        for what, name in ((triangle, "triangle"), (top, "top")):
            with raises(ValueError, match=f"a drive holds {name} or some"):
                pushTo(scene.model.loading, what, top, Vector3.UnitX)
        assert "holds the structure" in scene.bound(towards=(1, 0, 0))["note"]
        scene.release(middle, "x")
        assert "factor" in scene.bound(towards=(-1, 0, 0))
        scene.push("triangle", 0.2, control=top)


@mark.parametrize(
    "pattern, sentence",
    [
        ("triangel", "did you mean|must be a platen"),
        (lambda x, y, z: "much", "must be a number"),
        (lambda x, y, z: -1.0, "must be above 0"),
        ({}, "must be a platen"),
    ],
)
def test_patterns_that_are_none_are_refused(tmp_path, pattern, sentence):
    scene, top, _ = pier(tmp_path)
    with raises(Refused, match=sentence):
        scene.push(pattern, 1, control=top)


def test_every_pattern_has_its_own_bound_and_curve(tmp_path):
    scene, top, middle = pier(tmp_path)
    for shares in ({top: 1, middle: 9}, {top: 1, middle: 1e-9}):
        scene.push(shares, 0.3, rate=3, control=middle)
        scene.release(top, "x")
        scene.settle()
    scene.finish()
    heights = np.array([top.point[2], middle.point[2]])
    expected = [1e-3 * WEIGHT * WIDTH / 2 / (heights @ s) for s in ([0.1, 0.9], [1, 0])]
    data = RunData.read(tmp_path)
    assert len(data.pushes) == 1 and max(data[MOVED]) == approx(0.3, abs=0.02)
    # the force works on the mean of both points, not on the displacement of the control
    assert data.isOfControl and "push_work_J" not in readRun(tmp_path)
    scene, top, middle = pier(tmp_path / "bound", "--preset", "bound")
    scene.push({top: 1, middle: 9}, 1)
    scene.release(top, "x")
    scene.push({top: 1, middle: 1e-9}, 1)
    scene.finish()
    found = [one["factor"] for one in readRun(tmp_path / "bound")["bounds"]]
    assert found == approx(expected, rel=1e-4)


def test_a_push_ends_where_another_part_gives_way_than_the_control(tmp_path):
    slippery = materials.dry(friction=0.1, normalStiffness=2e10, density=2400)
    scene, top, middle = pier(tmp_path, stone=slippery)
    scene.push({top: 1, middle: 1}, 0.5, control=middle)
    scene.finish()
    run = readRun(tmp_path)
    assert run["collapsed"] and "another part gives way" in run["collapse"]


def test_a_vertical_column_is_no_displacement_of_a_level_push(tmp_path):
    scene, top, middle = pier(tmp_path)
    scene.push({top: 2, middle: 1}, 0.3)
    scene.finish()
    assert pushover(tmp_path, "middle_x_mm").displacement[-1] < 0.25
    with raises(Refused, match="along the push: displacement_mm"):
        pushover(tmp_path, "middle_z_mm")
