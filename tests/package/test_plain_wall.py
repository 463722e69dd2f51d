# SPDX-License-Identifier: GPL-2.0-or-later
"""The plain model of the dry-joint wall against statics, and against the closed form of its shear
stiffness."""

from usual import *
import plain_wall


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return plain_wall.build(str(tmp_path_factory.mktemp("plain") / "plain_wall"))


def test_the_wall_rocks_below_the_limit_of_a_rigid_one(program):
    """N L/(2 h0) is 68.3 kN with the weight of the blocks; soft joints take a few percent of the
    lever arm."""
    moved, force = plain_wall.run([10], program, points=2, rate=100)
    assert moved[-1] == approx(10, abs=0.06)
    assert 0.85 * 68.3 < force.max() < 68.3


def test_soft_joints_shear_as_springs_in_series(program):
    """Nine joints of 0.2 m² with ks in series, while nothing slips or opens: 9/(ks A).

    Bending adds what it has with stiff shear, therefore two runs are compared. Courses that stay
    rigid would be stiffer than loose blocks, which also turn on their own: so that is the least,
    and a tenth more is allowed.
    """
    flexibility = []
    for ks in (0.5e9, 1e12):
        moved, force = plain_wall.run(
            [0.1], program, points=2, rate=0.3, every=0.01, ks=ks, friction=50
        )
        flexibility.append(1e-6 * moved[-1] / force[-1])
    series = 9 / (0.5e9 * 0.2)
    assert series < flexibility[0] - flexibility[1] < 1.1 * series


def test_an_unknown_option_is_refused(program):
    with raises(subprocess.CalledProcessError):
        plain_wall.run([1], program, stiffness=3)
