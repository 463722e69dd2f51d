# SPDX-License-Identifier: GPL-2.0-or-later
"""Piers as they are tested in rigs: what the top may do, and cycles of drift."""

from hosted import *

LENGTH, HEIGHT, THICKNESS, STRESS = 0.88, 0.972, 0.102, 0.4e6


def pier(tmp_path, *words, **platen):
    words = ["--out", str(tmp_path / "pier"), "--lean", "--rate", "40", *words]
    wall = bricks.Wall(length=LENGTH, height=HEIGHT)
    scene = Scene("pier", wall, materials.calciumSilicate(), arguments=words)
    scene.platen("bottom")
    top = scene.platen("top", **{"rotation": "free", **platen})
    scene.press(top, STRESS)
    scene.settle()
    return scene, top


def columnsOf(tmp_path, *names):
    curve = readCurve(tmp_path / "pier")
    return [np.array(curve[name]) for name in names]


def test_a_top_that_keeps_its_height_presses_more_when_the_pier_rocks(tmp_path):
    scene, top = pier(tmp_path)
    scene.hold(top, "zY")
    scene.push(top, 2)
    scene.finish()
    force, up, turned = columnsOf(tmp_path, "top_force_z_kN", "top_z_mm", "top_rotation_mrad")  # fmt: skip
    pressed = 1e-3 * STRESS * LENGTH * THICKNESS
    assert force[1] == pytest.approx(pressed, rel=1e-3)
    assert np.ptp(up[1:]) == np.ptp(turned[1:]) == 0
    assert force.max() > 1.1 * pressed


def test_a_top_whose_force_is_kept_rises_when_the_pier_rocks(tmp_path):
    scene, top = pier(tmp_path)
    scene.push(top, 2)
    scene.finish()
    force, up = columnsOf(tmp_path, "top_force_z_kN", "top_z_mm")
    pressed = 1e-3 * STRESS * LENGTH * THICKNESS
    assert np.allclose(force[1:], pressed, rtol=0.02)
    assert up[-1] - up[1] > 0.3


@pytest.mark.parametrize("height", [0.5, 0.75])
def test_the_moment_is_zero_where_the_drive_of_a_free_top_acts(tmp_path, height):
    point = (LENGTH / 2, THICKNESS / 2, height * HEIGHT)
    scene, top = pier(tmp_path, point=point, recorded=HEIGHT)
    scene.push(top, 1, rate=10)
    scene.finish()
    moment, shear, moved = columnsOf(tmp_path, "base_M_y_kNm", "base_V_x_kN", "displacement_mm")  # fmt: skip
    steady = moved > 0.3  # the drive has its velocity
    assert steady.sum() > 10
    assert np.allclose((moment / shear)[steady], height * HEIGHT, atol=0.03 * HEIGHT)


@pytest.mark.parametrize("rotation", ["free", "held"])
def test_cycles_go_to_drifts_over_the_height_of_what_turns_or_of_the_bricks(
    tmp_path, rotation
):
    scene, top = pier(tmp_path, rotation=rotation)
    scene.cycle(top, [0.05, 0.1], unit="%")
    scene.finish()
    height = HEIGHT + (0.2 if rotation == "free" else 0)
    found = [a for a, _ in readRun(tmp_path / "pier")["history"]["amplitudes_mm"]]
    assert found == pytest.approx([0.5 * height, height], rel=1e-5)
    assert columnsOf(tmp_path, "displacement_mm")[0].max() == pytest.approx(height, abs=0.02)  # fmt: skip


def test_a_handle_on_a_wall_of_deformable_bricks_is_a_rigid_brick_that_can_be_pushed(
    tmp_path,
):
    words = ["--out", str(tmp_path / "pier"), "--lean", "--rate", "40", "--blocks", "deformable", "--divisions", "1"]  # fmt: skip
    wall = bricks.Wall(length=0.44, height=0.324)
    scene = Scene("pier", wall, materials.calciumSilicate(), arguments=words)
    scene.platen("bottom")
    top = scene.handle(-1, "brick")
    scene.settle()
    scene.push(top, 0.2)
    scene.finish()
    assert top.body not in scene.model.zones.bodies
    assert len(scene.model.zones.bodies) == len(wall) - 1
    assert columnsOf(tmp_path, "brick_x_mm")[0][-1] == pytest.approx(0.2, abs=0.02)


def test_a_platen_is_not_held_along_an_axis_without_a_column_for_its_reaction(tmp_path):
    scene, top = pier(tmp_path)
    with pytest.raises(ValueError, match="no column for its reaction along x"), scene:
        scene.hold(top, "x")
