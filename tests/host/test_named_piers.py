# SPDX-License-Identifier: GPL-2.0-or-later
"""Piers that a scene names: what they carry, how far they drift, and what codes say of them."""

from hosted import *
from masonry_capacity import piers


def window(folder):
    """Two piers of 0.66 m beside a window, under a beam."""
    opening = bricks.Opening(0.66, 0.243, 0.66, 0.648, bricks.Lintel(0.11, 0.162))
    wall = bricks.Wall(1.98, 1.134, openings=[opening])
    scene = lean(folder, wall, materials.calciumSilicate(), "--rate", "20")
    scene.platen("bottom")
    top = scene.platen("top", rotation="held")
    scene.press(top, 0.5e6)
    return scene, top


def named(folder):
    scene, top = window(folder)
    for name, x in (("left", 0.0), ("right", 1.32)):
        scene.pier((x, 0, 0.243), (x + 0.66, 0.102, 0.891), name)
    return scene, top


def test_piers_carry_together_what_the_wall_carries(tmp_path):
    scene, top = named(tmp_path)
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
    scene, _ = named(tmp_path)
    for high in ((0.66, 0.102, 0.3), (0.01, 0.102, 0.891)):
        with raises(ValueError, match="must have two courses"):
            scene.pier((0, 0, 0.243), high)
    with raises(ValueError, match="both corners"):
        scene.pier((0, 0, 0.243))


def test_piers_stand_beside_openings(tmp_path):
    """Beside a window there are two, of a wall without openings it is the whole wall; of a wall
    along y the length is along y."""
    given, _ = named(tmp_path)
    letGo()
    scene, _ = window(tmp_path)
    scene.pier()
    sizes = lambda scene: [[v for v in p.values() if not isinstance(v, str)] for p in scene]
    found = scene.description.piers
    assert sizes(found) == [approx(size) for size in sizes(given.description.piers)]
    assert [one["name"] for one in found] == ["pier0", "pier1"]
    letGo()
    scene = lean(tmp_path, bricks.Wall(0.66, 0.324).turned(90), materials.calciumSilicate())
    scene.pier(name="wall")
    (one,) = scene.description.piers
    assert sizes([one]) == [approx([0.66, 0.102, 0.324])]
    assert (one["V"], one["M"]) == ("wall_V_y_kN", "wall_M_x_kNm")


def test_a_facade_has_the_piers_of_each_storey(tmp_path):
    """Doors and windows above each other: two storeys with three piers each."""
    holes = [
        bricks.Opening(x, z, 0.44, h) for x in (0.44, 1.32) for z, h in ((0, 0.486), (0.81, 0.324))
    ]
    scene = lean(tmp_path, bricks.Wall(2.2, 1.458, openings=holes), materials.calciumSilicate())
    scene.pier()
    heights = [one["height_m"] for one in scene.description.piers]
    assert heights == [approx(h) for h in (0.486,) * 3 + (0.324,) * 3]
