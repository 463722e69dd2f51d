# SPDX-License-Identifier: GPL-2.0-or-later
"""Ties and springs between two blocks, body by body, against their forces by hand. In scenes:
tests/scenes/test_connections.py."""

from hosted import *

STIFF = 1e6  # [N/m] of a bar that is 1 m long
#: strength [N], elongation at which it breaks [m], whether it carries compression, rest [m];
#: elongation [m] and force [N]
BARS = {
    "elastic": (1e4, 1, 0, 0, 0.004, 4e3),
    "yields": (1e4, 1, 0, 0, 0.02, 1e4),
    "slack": (1e4, 1, 0, 0.003, 0.004, 1e3),
    "prestressed": (1e4, 1, 0, -0.003, 0.004, 7e3),
    "carries no compression": (1e4, 1, 0, 0, -0.004, 0),
    "strut": (1e4, 1, 1, 0, -0.004, -4e3),
    "strut that yields": (1e4, 1, 1, 0, -0.02, -1e4),
    "holds below its breaking elongation": (1e9, 0.012, 0, 0, 0.011, 11e3),
    "breaks by what it was tightened": (1e9, 0.012, 0, -0.005, 0.008, 0),
}


def pair(connectors):
    """Two free bricks, 1 m from middle to middle along x, and what connects them; far away a joint,
    which every scene has."""
    places = (0, 0, 0), (1, 0, 0), (9, 0, 0), (9, 0, UNIT[2])
    ids = [addBlock(box(place), unitMaterial()) for place in places]
    engines([MasonryJoint(elastic=True)], gravity=(0, 0, 0))
    connect()
    O.engines = [*O.engines[:2], connectors, *O.engines[2:]]
    O.dt = 1e-7  # so short that nothing moves
    return [O.bodies[i].state for i in ids[:2]]


@mark.parametrize("case", BARS)
def test_the_force_of_a_bar(case):
    strength, breaking, compression, rest, longer, force = BARS[case]
    middles = [Vector3(x + UNIT[0] / 2, UNIT[1] / 2, UNIT[2] / 2) for x in (0, 1)]
    ties = MasonryTies(
        bodies1=[0],
        bodies2=[1],
        points1=middles[:1],
        points2=middles[1:],
        stiffness=[STIFF],
        strength=[strength],
        breaking=[breaking],
        compression=[compression],
        rest=[rest],
    )
    _, other = pair(ties)
    other.pos += Vector3(longer, 0, 0)
    O.step()
    assert ties.forces[0] == approx(force, rel=1e-9, abs=1e-6)
    for body, sign in ((0, 1), (1, -1)):
        assert O.forces.f(body, True)[0] == approx(sign * force, rel=1e-9, abs=1e-6)


def test_springs_between_two_bricks_turn_both():
    """At the middle between both, the second turned by 1 mrad about y: its point moves up, and the
    spring turns it back."""
    kz, rotational, turn = 2e6, 3e5, 1e-3
    point = Vector3(0.5 + UNIT[0] / 2, UNIT[1] / 2, UNIT[2] / 2)
    springs = MasonrySprings(
        bodies1=[0],
        bodies2=[1],
        points1=[point],
        points2=[point],
        stiffness=[(0, 0, kz)],
        rotationalStiffness=[(0, rotational, 0)],
    )
    _, other = pair(springs)
    other.ori = Quaternion(Vector3(0, 1, 0), turn) * other.ori
    O.step()
    lift = 0.5 * turn * kz  # [N], at arms of 0.5 m
    torques = [O.forces.t(body, True)[1] for body in (0, 1)]
    assert O.forces.f(1, True)[2] == approx(-lift, rel=1e-5)
    # about y, z × x: a force up on the first, right of its middle, turns it by -0.5 lift
    assert torques[0] == approx(rotational * turn - 0.5 * lift, rel=1e-5)
    assert torques[1] == approx(-rotational * turn - 0.5 * lift, rel=1e-5)
    assert balance()["elastic_connectors"] == approx(
        0.5 * (rotational * turn**2 + lift**2 / kz), rel=1e-5
    )
