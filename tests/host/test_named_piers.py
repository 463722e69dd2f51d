# SPDX-License-Identifier: GPL-2.0-or-later
"""Piers that a scene names: what they carry, how far they drift, and what codes say of them."""

from hosted import *
from masonry_capacity import piers


def window(folder, **more):
    """Two piers of 0.66 m beside a window, under a beam."""
    opening = bricks.Opening(0.66, 0.243, 0.66, 0.648, bricks.Lintel(0.11, 0.162))
    wall = bricks.Wall(1.98, 1.134, openings=[opening])
    scene = lean(folder, wall, materials.calciumSilicate(), "--rate", "20")
    scene.platen("bottom")
    top = scene.platen("top", rotation="held")
    scene.press(top, 0.5e6)
    for name, x in (("left", 0.0), ("right", 1.32)):
        scene.pier((x, 0, 0.243), (x + 0.66, 0.102, 0.891), name)
    return scene, top


def test_piers_carry_together_what_the_wall_carries(tmp_path):
    scene, top = window(tmp_path)
    scene.section(0.567, name="all")
    scene.settle()
    scene.push(top, 0.5)
    scene.finish()
    curve = arrays(tmp_path)
    for name in ("N_kN", "V_x_kN"):
        both = curve[f"left_{name}"] + curve[f"right_{name}"]
        assert both == approx(curve[f"all_{name}"], abs=1e-5)
    arms = (curve["right_N_kN"] - curve["left_N_kN"]) * -0.66
    turned = curve["left_M_y_kNm"] + curve["right_M_y_kNm"] + arms
    assert turned == approx(curve["all_M_y_kNm"], abs=1e-5)
    run = readRun(tmp_path)
    assert [one["name"] for one in run["piers"]] == ["left", "right"]
    moved = curve["left_head_x_mm"] - curve["left_foot_x_mm"]
    assert curve["left_drift_x_mrad"] == approx(moved / 0.567)
    assert piers.main([str(tmp_path), "--fb", "20"]) == 0
    with open(tmp_path / "piers.csv", newline="") as file:
        found = list(csv.DictReader(file))
    assert [(row["pier"], row["code"]) for row in found] == [
        (name, code) for name in ("left", "right") for code in piers.CODES
    ]


def test_a_box_without_two_courses_is_no_pier(tmp_path):
    scene, _ = window(tmp_path)
    for high in ((0.66, 0.102, 0.3), (0.01, 0.102, 0.891)):
        with raises(ValueError, match="must have two courses"):
            scene.pier((0, 0, 0.243), high)
