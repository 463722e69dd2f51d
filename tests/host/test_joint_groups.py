# SPDX-License-Identifier: GPL-2.0-or-later
"""Joints are grouped by the values of their properties, whether these stand in one MasonryJoint or
in many."""

from hosted import *


def couplets(count, joint):
    """Separate couplets whose upper bricks are pulled up. ``joint``: gives the MasonryJoint of
    each."""
    O.reset()
    mat = unitMaterial()
    for n in range(count):
        hold(pile(x=0.25 * n, material=mat)[1])
        O.bodies[2 * n + 1].state.vel = Vector3(0.02, 0, 0.05)
    engines([MasonryJoint()], gravity=(0, 0, 0), damping=0, rows=1)
    made = connect(lambda one, two, geom: joint())
    O.dt = 1e-5
    return made


def stresses(made):
    return [[tuple(s) for s in i.phys.stress] for i in made]


def test_equal_values_in_many_objects_are_one_group():
    shared = MasonryJoint()
    made = couplets(500, lambda: shared)
    assert loop().groups == 1
    O.run(200, True)
    one = stresses(made)
    made = couplets(500, MasonryJoint)
    assert len({id(i.phys.joint) for i in made}) == 500
    assert loop().groups == 1
    O.run(200, True)
    assert stresses(made) == one


OTHERS = dict(name="other", tensileStrength=0.05e6, cap=False)
OTHERS["tensionTable"] = [(1, 0), (40, 1)]


@mark.parametrize("name", OTHERS)
def test_other_values_are_another_group(name):
    couplets(40, MasonryJoint)
    assert loop().groups == 1
    joints = [MasonryJoint(**{name: OTHERS[name]} if n == 7 else {}) for n in range(40)]
    made = couplets(40, iter(joints).__next__)
    assert loop().groups == 2
    known = [i.phys.joint.dict() for i in made]
    assert [n for n, values in enumerate(known) if values != known[0]] == [7]


def test_a_later_change_of_one_object_acts_on_its_own_joints_alone():
    made = couplets(40, MasonryJoint)
    O.run(2, True)
    made[7].phys.joint.tensileStrength = 0.02e6
    assert loop().groups == 2
    O.run(300, True)
    damage = [max(d[0] for d in i.phys.damage) for i in made]
    assert damage[0] > 0.1 < damage[7] < damage[0] - 0.1
    for n in range(40):
        assert n == 7 or damage[n] == approx(damage[0], rel=1e-9)
    made[7].phys.joint.tensileStrength = 0.10e6
    assert loop().groups == 1
    O.run(2, True)
    assert max(d[0] for d in made[7].phys.damage) >= damage[7]


def test_every_joint_keeps_its_own_object_through_a_file(tmp_path):
    made = couplets(5, MasonryJoint)
    O.run(2, True)
    path = str(tmp_path / "scene.yade.gz")
    O.save(path)
    O.load(path)
    made = sorted(O.interactions, key=lambda i: i.id1)
    assert loop().groups == 1
    made[3].phys.joint.cohesion = 0.2e6
    assert loop().groups == 2
    assert [i.phys.joint.cohesion for i in made] == [0.11e6] * 3 + [0.2e6, 0.11e6]
