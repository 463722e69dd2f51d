# SPDX-License-Identifier: GPL-2.0-or-later
"""Beams that bend and floors that shear, against their closed forms."""

from hosted import *
from masonry.basics import GRAVITY

LEAN = ["--lean", "--checkpoint-every", "0"]
LENGTH, WIDTH, HEIGHT, YOUNG = 2.0, 0.1, 0.2, 10e9
INERTIA, AREA = WIDTH * HEIGHT**3 / 12, WIDTH * HEIGHT
SHEAR = YOUNG / 2.4


def beam(tmp_path, pieces, held, *words):
    """A beam without weight that is held at some pieces, and its middle piece, on which a force acts."""
    made = bricks.Beam((0, 0, 0), LENGTH, WIDTH, HEIGHT, pieces=pieces)
    stones = materials.dry(0.6).withBeam(made, young=YOUNG, density=500)
    scene = Scene("beam", made, stones, gravity=0.0, arguments=[*LEAN, "--out", str(tmp_path), *words])  # fmt: skip
    for n, (piece, axes) in enumerate(held):
        scene.hold(piece, name=f"end{n}", axes=axes)
    return scene


@pytest.mark.parametrize("words", [(), ("--blocks", "deformable")])
def test_a_cantilever_sags_as_a_beam_with_shear(tmp_path, words):
    """F l³ / 3EI + F l / (5/6 G A), between the middles of the first and the last piece."""
    scene = beam(tmp_path, 33, [(0, "xyzXYZ")], *words)
    tip = scene.handle(32, "tip")
    force, span = 1e3, LENGTH * 32 / 33
    scene.load(tip, (0, 0, -force))
    assert scene.settle() == "at rest"
    expected = force * span**3 / (3 * YOUNG * INERTIA) + force * span / (5 / 6 * SHEAR * AREA)  # fmt: skip
    assert -scene.model.supports.moved(tip)[0][2] == pytest.approx(expected, rel=0.003)
    scene.finish()


@pytest.mark.parametrize("along", ["x", "y"])
def test_a_floor_shares_a_force_as_its_shear_stiffness_says(tmp_path, along):
    """Walls of stiffness k1 and k2 hold the outer strips; between them and the loaded strip the floor has G t l / (n w)."""
    strips, length, pitch, shear, k1, k2 = 9, 4.0, 0.5, 2e6, 3e6, 1e6
    floor = bricks.Floor((0, 0, 3), length, strips * pitch, 0.2, along=along, strips=strips)  # fmt: skip
    stones = materials.dry(0.6).withFloor(floor, shear=shear, mass=100)
    scene = Scene("floor", floor, stones, plane=False, gravity=0.0, arguments=[*LEAN, "--out", str(tmp_path)])  # fmt: skip
    other = "y" if along == "x" else "x"
    for n in range(strips):
        scene.hold(n, name=f"strip{n}", axes=f"z{other}XYZ")
    axis = "xyz".index(along)
    at = lambda k: tuple(k if i == axis else 0 for i in range(3))
    one = scene.spring(0, stiffness=at(k1), name="one")
    two = scene.spring(strips - 1, stiffness=at(k2), name="two")
    pushed, force = scene.handle(3, "pushed"), 1e3
    scene.load(pushed, at(force))
    assert scene.settle(longest=5) == "at rest"
    panel = lambda n: shear * length / (n * pitch)
    to1, to2 = 1 / (1 / k1 + 1 / panel(3)), 1 / (1 / k2 + 1 / panel(5))
    assert -one.force[axis] == pytest.approx(force * to1 / (to1 + to2), rel=1e-3)
    assert -two.force[axis] == pytest.approx(force * to2 / (to1 + to2), rel=1e-3)
    scene.finish()


def test_the_mass_and_the_weight_of_a_floor(tmp_path):
    floor = bricks.Floor((0, 0, 0.5), 2.0, 1.0, 0.25, strips=4)
    stones = materials.dry(0.6).withFloor(floor, 1e7, mass=200)
    scene = Scene("mass", floor, stones, plane=False, arguments=[*LEAN, "--out", str(tmp_path)])  # fmt: skip
    for n in range(4):
        scene.hold(n, name=f"strip{n}")
    scene.begin()
    masses = [O.bodies[body].state.mass for body in scene.model.ids]
    assert sum(masses) == pytest.approx(200 * 2.0) and GRAVITY > 0
    scene.finish()


BEAM = bricks.Beam((0, 0, 0), 2, 0.1, 0.2)
FLOOR = bricks.Floor((0, 0, 1), 2, 1, 0.2)
ONE = bricks.Beam((0, 0, 0), 2, 0.1, 0.2, pieces=1)


@pytest.mark.parametrize(
    "act, text",
    [
        (
            lambda m: m.withBeam([1], 1e9, 500),
            "must be what bricks.Beam or bricks.Floor",
        ),
        (lambda m: m.withBeam(ONE, 1e9, 500), "beam is one piece, which is rigid"),
        (
            lambda m: m.withBeam(BEAM, 1e9, 500, bearing="glued"),
            "must be 'fixed', a fric",
        ),
        (lambda m: [m.withBeam(BEAM, 1e9, 500) for _ in "ab"], "has 'beam' already"),
        (
            lambda m: m.withFloor(BEAM + FLOOR, 1e7, 100),
            "give those of one beam or floor",
        ),
    ],
)
def test_what_is_no_beam_or_floor_is_refused(act, text):
    with pytest.raises(ValueError, match=text):
        act(materials.dry(0.6))


def test_a_beam_of_which_the_materials_do_not_know_is_refused(tmp_path, capsys):
    wall, beam = bricks.stack(2, (1, 0.1, 0.2)), bricks.Beam((0, 0, 0.4), 1, 0.1, 0.2, name="ring")  # fmt: skip
    scene = Scene("ring", wall + beam, materials.dry(0.6), arguments=["--out", str(tmp_path)])  # fmt: skip
    scene.platen("bottom")
    with pytest.raises(SystemExit):
        scene.settle()
    assert "the materials have nothing for blocks of the kind 'ring'" in capsys.readouterr().err  # fmt: skip
    chosen = materials.dry(0.6)
    chosen.units["ring"] = chosen.unit
    assert not scene.description.problems(chosen)
