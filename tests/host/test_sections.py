# SPDX-License-Identifier: GPL-2.0-or-later
"""What horizontal sections transmit, against statics: weight and loads above, and the reaction of
the base."""

from hosted import *

from masonry._masonry import loadScene, resultant, saveScene
from masonry.units import GRAVITY
from motion_cases import oscillator

#: [m]: foot, a bed joint, the middle of a course, and top.
LEVELS = (0.0, 0.162, 0.2025, 0.486)


def made(folder, blocks, *words, masonry=None, **settings):
    return lean(folder, blocks, masonry or materials.calciumSilicate(), *words, **settings)


def weightAbove(scene, z):
    """Weight of the bricks whose centroid is above z [N]."""
    above = [O.bodies[i] for i in scene.model.ids if O.bodies[i].state.refPos[2] > z + 1e-9]
    return GRAVITY * sum(body.state.mass for body in above)


def column(scene, head):
    return scene.results.column(head)


@BLOCKS
@mark.parametrize("plane, axis", [(True, 0), (False, 0), (False, 1)], ids=["plane", "x", "y"])
def test_a_push_is_the_shear_and_its_lever_arm_the_moment(tmp_path, plane, axis, blocks):
    """The platen can turn, so what acts on it are the push and the pressure, at places that are
    known."""
    words = "--blocks", blocks, "--rate", "2.5"
    wall = made(tmp_path, bricks.Wall(0.66, 0.486), *words, plane=plane)
    wall.platen("bottom")
    top = wall.platen("top", rotation="free", height=0.1)
    wall.press(top, 0.3e6)
    for z in LEVELS:
        wall.section(z)
    wall.settle()
    direction = [0, 0, 0]
    direction[axis] = 1
    wall.push(top, (0.1, 0.3)[axis], direction=direction)
    pushed, along = 1e3 * column(wall, "top_shear_kN")[-1], "xy"[axis]
    moved = 1e-3 * column(wall, f"top_{along}_mm")[-1]
    assert pushed > 100
    for n, z in enumerate(LEVELS):
        head = f"section{n}_"
        shear = 1e3 * column(wall, head + f"V_{along}_kN")[-1]
        assert shear == approx(pushed, rel=0.008)
        moment = 1e3 * column(wall, head + ("M_y_kNm", "M_x_kNm")[axis])[-1]
        pressed = 0.3e6 * 0.66 * 0.102
        expected = pushed * (0.586 - z) + pressed * moved
        assert (1, -1)[axis] * moment == approx(expected, rel=0.003)
        normal = 1e3 * column(wall, head + "N_kN")[-1]
        weight = weightAbove(wall, z)
        assert normal == approx(-(pressed + weight), rel=3e-3)
    wall.finish()
    curve = readCurve(tmp_path)
    assert ("section0_M_x_kNm" in curve) == (not plane)
    meaning = readRun(tmp_path)["columns"]["section1_M_y_kNm"]
    assert "about y through (0.33, 0.051, 0.162) m by the right-hand rule" in meaning
    assert meaning.endswith("[kNm]")


@BLOCKS
@PLANES
def test_the_section_at_the_foot_has_what_the_base_feels(tmp_path, plane, blocks):
    """Also of a wall that has cracked and moved far, in the middle of a push, but for the motion of
    a step."""
    wall = made(tmp_path, bricks.Wall(0.44, 0.648), "--blocks", blocks, plane=plane)
    base = wall.platen("bottom")
    top = wall.platen("top", rotation="free", height=0.1)
    wall.press(top, 0.1e6)
    foot = wall.section(0, name="foot")
    wall.settle()
    wall.push(top, 20 if blocks == "rigid" else 3, rate=200)
    force, moment = foot.forces()
    there, arm = base.body, O.bodies[base.body].state.pos - Vector3(*foot.middle)
    felt = O.forces.f(there, True)
    assert felt.norm() > 1000
    assert (force - felt).norm() < 1e-6 * felt.norm()
    turned = O.forces.t(there, True) + arm.cross(felt)
    assert abs(moment[1] - turned[1]) < 1e-4 * abs(turned[1])
    for head, other in (("foot_V_x_kN", "x"), ("foot_N_kN", "z")):
        reaction = column(wall, f"base_force_{other}_kN")[-1]
        assert column(wall, head)[-1] == approx(reaction, rel=1e-5)
    before = foot.forces()
    saved = saveScene("")
    wall.running.advance(50)
    assert foot.forces() != before
    loadScene(saved)
    assert foot.forces() == before
    wall.finish()


@mark.parametrize("damping", [0, 1e-5], ids=["elastic", "damped"])
@mark.parametrize("negative", [False, True], ids=["", "negative"])
def test_a_joint_transmits_what_both_of_its_blocks_feel(damping, negative):
    """Far from the reference state and by a large jump; a quaternion and its negative are the same
    rotation."""
    joint = MasonryJoint(elastic=True, normalStiffness=1e9, shearStiffness=5e8)
    oscillator(joint, blocked="xyzXYZ")
    loop().stiffnessDamping, O.dt = damping, 1e-5
    O.step()
    turn = Quaternion(Vector3(1, 2, 3).normalized(), 0.5)
    states = [body.state for body in O.bodies]
    for state in states:
        state.pos, state.ori = turn * state.pos, turn * state.ori
    states[1].pos += Vector3(1e-3, 2e-3, -1.5e-3)
    states[1].ori = Quaternion(Vector3(2, -1, 1).normalized(), 0.01) * states[1].ori
    if negative:
        states[1].ori = Quaternion(*(-value for value in states[1].ori))
    O.step()
    made = O.interactions[0, 1]
    for body, sign in ((0, 1), (1, -1)):
        force, moment = resultant([made], [sign], states[body].pos)
        felt, turned = O.forces.f(body, True), O.forces.t(body, True)
        assert felt.norm() > 1000 and turned.norm() > 10
        assert (force - felt).norm() < 1e-9 * felt.norm()
        assert (moment - turned).norm() < 1e-9 * turned.norm()


def test_the_parts_of_a_corner_add_up(tmp_path):
    blocks = bricks.Corner(1.1, 0.88, 0.486, halves=False)
    corner = made(tmp_path, blocks, masonry=materials.dry(normalStiffness=5e10))
    corner.platen("bottom")
    corner.press(corner.platen("top"), 1e5)
    parts = sorted({block.part for block in blocks})
    assert len(parts) == 2
    every = [corner.section(0.243, part, name=part or "all") for part in (None, *parts)]
    corner.settle()
    sums = [section.forces()[0] for section in every]
    assert (sums[1] + sums[2] - sums[0]).norm() < 1e-9 * sums[0].norm()
    assert all(force[2] < -1000 for force in sums)
    partOf = dict(zip(corner.model.ids, (block.part for block in blocks)))
    between = 0
    for section in every[1:]:
        for one, sign in zip(section.interactions, section.signs):
            lower, upper = (one.id1, one.id2) if sign > 0 else (one.id2, one.id1)
            assert O.bodies[lower].state.pos[2] < 0.243 < O.bodies[upper].state.pos[2]
            assert partOf[upper] == section.part
            between += partOf[lower] != section.part
    assert between
    corner.finish()


@mark.parametrize(
    "act, message",
    [
        (lambda s: s.section(3), "no brick reaches z = 3 m; they are from 0 to 0.324 m"),
        (
            lambda s: s.section(0.324) and s.begin(),
            "section section0: no joint crosses z = 0.324 m",
        ),
        (lambda s: s.section(0.1).forces(), "section section0: the scene is not built yet"),
        (
            lambda s: (s.section(0.1, name="a"), s.section(0.2, name="a"), s.begin()),
            "two columns have the name a_M_y_kNm",
        ),
    ],
)
def test_sections_that_cannot_be_are_refused(tmp_path, act, message):
    wall = made(tmp_path, bricks.Wall(0.44, 0.324))
    wall.platen("bottom")
    wall.handle(-1)
    with raises((ValueError, Refused)) as refused:
        act(wall)
    assert message in str(refused.value)
    wall.running.release()
    wall.finished = True


@mark.parametrize(
    "act, present, missing",
    [
        (lambda s: s.platen("bottom"), "base_N_kN", "section0_N_kN"),
        (lambda s: (s.platen("bottom"), s.section(0)), "section0_N_kN", "base_N_kN"),
        (lambda s: (s.platen("bottom"), s.section(0, name="base")), "base_N_kN", "base2_N_kN"),
        (lambda s: (s.platen("bottom"), s.section(0.2, name="base")), "base2_N_kN", "base3_N_kN"),
        (
            lambda s: (s.platen("bottom"), s.column("base_N", "mine", lambda: 1.0)),
            "base2_N_kN",
            "base3_N_kN",
        ),
        (lambda s: s.hold(0, name="foot"), "foot_force_z_kN", "base_N_kN"),
    ],
)
def test_the_base_is_recorded_once(tmp_path, act, present, missing):
    stack = made(tmp_path, bricks.stack(3, (0.4, 0.3, 0.2)), masonry=materials.dry(0.6))
    act(stack)
    stack.begin()
    heads = [one.head for one in stack.columns]
    assert present in heads and missing not in heads
