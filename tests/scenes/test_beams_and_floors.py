# SPDX-License-Identifier: GPL-2.0-or-later
"""Floors that shear, against their closed form, and what is no beam or floor; beams that bend:
validation/closed_forms."""

from hosted import *


@mark.parametrize("along", ["x", "y"])
def test_a_floor_shares_a_force_as_its_shear_stiffness_says(tmp_path, along):
    """Walls of stiffness k1 and k2 hold the outer strips; between them and the loaded strip the
    floor has G t l / (n w)."""
    strips, length, pitch, shear, k1, k2 = 9, 4.0, 0.5, 2e6, 3e6, 1e6
    floor = bricks.Floor((0, 0, 3), length, strips * pitch, 0.2, along=along, strips=strips)
    stones = materials.dry(0.6).withFloor(floor, shear=shear, mass=100)
    scene = lean(tmp_path, floor, stones, plane=False, gravity=0.0)
    for n in range(strips):
        scene.hold(n, name=f"strip{n}", axes="xyzXYZ".replace(along, ""))
    axis = "xyz".index(along)
    at = lambda k: tuple(k * Vector3.Unit(axis))
    one = scene.spring(0, stiffness=at(k1), name="one")
    two = scene.spring(strips - 1, stiffness=at(k2), name="two")
    pushed, force = scene.handle(3, "pushed"), 1e3
    scene.load(pushed, at(force))
    assert scene.settle(longest=5) == AT_REST
    panel = lambda n: shear * length / (n * pitch)
    to1, to2 = 1 / (1 / k1 + 1 / panel(3)), 1 / (1 / k2 + 1 / panel(5))
    assert -one.force[axis] == approx(force * to1 / (to1 + to2), rel=1e-3)
    assert -two.force[axis] == approx(force * to2 / (to1 + to2), rel=1e-3)
    masses = [O.bodies[body].state.mass for body in scene.model.ids]
    assert sum(masses) == approx(100 * length * strips * pitch)


BEAM = bricks.Beam((0, 0, 0), 2, 0.1, 0.2)
FLOOR = bricks.Floor((0, 0, 1), 2, 1, 0.2)
ONE = bricks.Beam((0, 0, 0), 2, 0.1, 0.2, pieces=1)


@mark.parametrize(
    "act, text",
    [
        (lambda m: m.withBeam([1], 1e9, 500), "must be what bricks.Beam or"),
        (lambda m: m.withBeam(ONE, 1e9, 500), "beam is one piece, which is rigid"),
        (lambda m: m.withBeam(BEAM, 1e9, 500, bearing="glued"), "must be 'fixed', a"),
        (lambda m: [m.withBeam(BEAM, 1e9, 500) for _ in "ab"], "has 'beam' already"),
        (lambda m: m.withFloor(BEAM + FLOOR, 1e7, 100), "give those of one beam or"),
    ],
)
def test_what_is_no_beam_or_floor_is_refused(act, text):
    with raises(ValueError, match=text):
        act(materials.dry(0.6))


def test_a_beam_of_which_the_materials_do_not_know_is_refused(tmp_path, capsys):
    beam = bricks.Beam((0, 0, 0.4), 1, 0.1, 0.2, name="ring")
    scene = standing(tmp_path, bricks.stack(2, (1, 0.1, 0.2)) + beam)
    with raises(SystemExit):
        scene.settle()
    assert "the materials have nothing for blocks of the kind 'ring'" in capsys.readouterr().err
    chosen = materials.dry(0.6)
    chosen.units["ring"] = chosen.unit
    assert not scene.description.problems(chosen)
