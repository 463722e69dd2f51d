# SPDX-License-Identifier: GPL-2.0-or-later
"""Joints that have always been elastic are advanced without their points, and nobody sees a
difference."""

from hosted import *
from test_checkpoint import bits
from test_joint_loop import agree, panel, state

STRONG = dict(cap=False, tensileStrength=5e7, cohesion=1e8)
STRONG.update(modeIFractureEnergy=1e6, modeIIFractureEnergy=1e7)
CASES = {
    "plane": {},
    "space": dict(turn=IN_SPACE),
    "cyclic": dict(law="cyclic"),
    "cyclic in space": dict(law="cyclic", turn=IN_SPACE),
}


@mark.parametrize("case", CASES)
def test_before_anything_yields_all_is_as_point_by_point(case):
    runs = []
    for functors in (True, False):
        interactions = panel(functors, **STRONG, **CASES[case])
        run(300)
        runs.append(state(interactions))
        largest = [pair for i in interactions for pair in i.phys.largest]
        runs[-1]["largest"] = np.array(largest)
    assert loop().intactJoints == len(interactions)
    assert np.abs(runs[0]["stress"]).max() > 1e5  # [Pa]
    agree(*runs, 1e-9)


@mark.parametrize("case", CASES)
def test_a_joint_that_yields_is_advanced_by_its_points_from_then_on(case):
    interactions = panel(False, **CASES[case])
    run(1)
    counts = [loop().intactJoints]
    for _ in range(20):
        run(20)
        counts.append(loop().intactJoints)
        # A joint at which anything has yielded is no longer intact.
        isSound = lambda phys: np.max(phys.damage) <= 0 and max(phys.slip) <= 0
        assert counts[-1] <= sum(isSound(i.phys) for i in interactions)
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


CLOSES = dict(law="cyclic", tensileStrength=0, compressionStiffnessLoss=0)
CLOSES.update(initialClosingStiffness=1e9, closureLimit=1e-3)
KINDS = {"elastic": dict(elastic=True), "deformable": dict(blocks="deformable")}
KINDS["closes on a curve"] = CLOSES


@mark.parametrize("kind", KINDS)
def test_elastic_joints_of_rigid_units_alone_stay_without_their_points(kind):
    interactions = panel(False, **KINDS[kind])
    run(400 if kind == "elastic" else 2)
    elastic = sum(i.phys.joint.elastic for i in interactions)
    assert loop().intactJoints == (0 if kind == "deformable" else elastic)


@mark.parametrize("case", CASES)
@mark.parametrize("damped", [False, True])
def test_a_run_saved_among_intact_joints_goes_on_in_the_same_bits(case, damped, tmp_path):
    path = str(tmp_path / "c")

    def build():
        interactions = panel(False, **CASES[case])
        if damped:
            loop().stiffnessDamping = 1e-6
            O.dt *= 0.5
        return interactions

    def end(interactions):
        return bits(interactions), loop().dampingWork, loop().intactJoints

    interactions = build()
    run(200)
    whole = end(interactions)
    for at in (1, 60, 130):
        interactions = build()
        run(at)
        saveCheckpoint(path)
        interactions = build()
        loadCheckpoint(path)
        run(200 - at)
        assert end(interactions) == whole, at
    assert 0 < whole[2] < len(interactions)


def test_damping_of_intact_joints_takes_the_energy_that_points_would_give():
    # The balance closes only if what damping takes is the work of its stresses.
    panel(False, **STRONG)
    loop().stiffnessDamping = 2e-6
    O.dt *= 0.5
    run(400)
    assert loop().dampingWork > 1e-3 * abs(balance()["external"])
    assert imbalance() < 1e-6


def test_all_points_are_looked_at_where_the_elastic_domain_is_not_convex():
    # With a linear term of the cap above zero, a point between the corners of a joint may yield
    # first.
    runs = []
    for functors in (True, False):
        interactions = panel(functors, capLinear=5e5)
        run(150)
        runs.append(state(interactions))
    assert runs[0]["damage"].max() > 0.01
    agree(*runs, 1e-8)
