# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks that are held along lines and edges, against statics."""

from hosted import *

WIDTH, THICKNESS, HEIGHT, COURSES = 0.5, 0.1, 1.0, 4


def strip():
    return bricks.stack(COURSES, (WIDTH, THICKNESS, HEIGHT / COURSES))


@mark.parametrize("y", [0, THICKNESS])
def test_a_strip_held_along_an_edge_of_its_top_falls_as_statics_have_it(tmp_path, y):
    """With a hinge at the foot and one below the top block, at the share s of the height, it falls
    at 2 t/(s h) times its weight; at its middle the block would be held below its top."""
    falls = 2 * THICKNESS / (HEIGHT * (1 - 1 / COURSES))
    stiff = materials.dry(friction=0.8, normalStiffness=1e11)
    scene = standing(tmp_path, strip(), stiff, plane=False)
    scene.hold((0, y, HEIGHT), "edge", "y", to=(WIDTH, y, HEIGHT))
    scene.settle()
    assert scene.lean(0.96 * falls, towards=(0, 1, 0)) == AT_REST
    assert scene.lean(1.03 * falls, towards=(0, 1, 0)) == COLLAPSED


def test_a_pushed_block_turns_about_a_line_and_its_edges_carry_its_weight_and_its_moment(tmp_path):
    high, wide = 0.6, 0.4
    block, glue = bricks.stack(2, (wide, 0.2, high / 2)), materials.dry(friction=0.7)
    glue.joints["bed"].elastic = True
    scene = Scene("block", block, glue, arguments=["--out", str(tmp_path)])
    for name, x, axes in (("left", 0, "z"), ("right", wide, "xz")):
        scene.hold((x, 0, 0), name, axes, to=(x, 0.2, 0))
    top = scene.handle((wide / 2, 0.1, high), "top")
    scene.settle()
    scene.push(top, 0.02, rate=0.5)
    curve = scene.curve()
    weight, pushed = 1e-3 * block.volume * 2600 * G, curve["top_shear_kN"][-1]
    assert pushed > weight / 5
    assert curve["left_force_z_kN"][-1] == approx(-weight / 2 + pushed * high / wide, rel=5e-3)
    assert curve["right_force_x_kN"][-1] == approx(pushed, rel=5e-3)


def test_a_line_that_sinks_bends_a_beam_as_springs_of_its_joints_say(tmp_path):
    """A row of blocks on three lines, the middle one 0.1 mm lower: each joint turns by M/(kn I) and
    slides by V/(ks A)."""
    count, long, size, kn, ks, sunk = 10, 0.2, 0.1, 1e10, 4e9, 1e-4
    row = bricks.stack(count, (size, size, long)).turned(90, "y")
    glue = materials.dry(normalStiffness=kn, shearStiffness=ks, young=1e14)
    for joint in glue.joints.values():
        joint.elastic = True
    out = ["--out", str(tmp_path)]
    scene = Scene("beam", row, glue, gravity=0, arguments=out)
    x = [0, count * long / 2, count * long]
    ends = [dict(where=(at, 0, -size / 2), to=(at, size, -size / 2), stiffness=1e12) for at in x]
    left, middle, right = (scene.hold(**end, axes="z") for end in ends)
    scene.handle(0, "first")
    scene.move(middle, z=-1e3 * sunk)
    scene.settle()
    area, inertia = size**2, size**4 / 12
    levers = [min(n, count - n) * long / 2 for n in range(1, count)]
    slides = [0.0 if n == count / 2 else 0.5 for n in range(1, count)]
    yields = sum(m**2 / (kn * inertia) + v**2 / (ks * area) for m, v in zip(levers, slides))
    force = {one: scene.curve()[f"{one.name}_force_z_kN"][-1] for one in (left, middle, right)}
    assert force[middle] == approx(1e-3 * sunk / yields, rel=0.01)
    assert [force[left], force[right]] == approx([-force[middle] / 2] * 2, rel=2e-3)


def test_what_a_line_cannot_be_is_refused_before_the_first_step(tmp_path):
    scene = Scene(
        "strip", strip(), materials.dry(), plane=False, arguments=["--out", str(tmp_path)]
    )
    for words, settings in {
        "no brick has a part of the line": dict(where=(0, 0.3, 0), to=(1, 0.3, 0)),
        "begins at a point": dict(where=0, to=(WIDTH, 0, 0)),
        "along x, y or z": dict(where=(0, 0, 0), to=(WIDTH, 0, 0), axes="Y"),
        "whose end to=": dict(where=0, stiffness=1e9),
    }.items():
        with raises(ValueError, match=words):
            scene.hold(**settings)


def test_ends_of_a_panel_are_hinges_on_lines_and_clamped_at_middles(tmp_path):
    """5 q L⁴/384 E I against q L⁴/384 E I: middles of whole and half bricks are 55 mm apart."""
    bend, (length, thickness, high) = {}, (2.2, UNIT[1], 4 * UNIT[2])
    wall = bricks.Wall(length, high, halves=False)
    for how in ("line", "middles"):
        glue = materials.dry(normalStiffness=1e10)
        for joint in glue.joints.values():
            joint.elastic = True
        scene = lean(tmp_path / how, wall, glue, plane=False, gravity=0)
        for x, axes in ((0, "xyz"), (length, "y")):
            if how == "line":
                scene.hold((x, thickness / 2, 0), axes=axes, to=(x, thickness / 2, high))
            else:
                at = lambda b: min(abs(b.low[0] - x), abs(b.high[0] - x)) < 1e-6
                ends = [n for n, b in enumerate(wall) if at(b)]
                for n in ends:
                    scene.hold(n, axes=axes)
        scene.watch((length / 2, thickness / 2, high / 2), "middle")
        scene.wind(1e3, (0, 1, 0))
        scene.settle(longest=5)
        bend[how] = scene.curve()["middle_y_mm"][-1]
        scene.finish()
    assert bend["line"] / bend["middles"] == approx(5, rel=0.1)
