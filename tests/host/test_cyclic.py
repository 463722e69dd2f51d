# SPDX-License-Identifier: GPL-2.0-or-later
"""The cyclic law in YADE: files, properties, and scenes of two laws."""

from hosted import *

CYCLIC = dict(law="cyclic", shearStiffnessLoss=0.3)


def stack(joint, functors=False):
    """Three bricks on each other; the middle one is free, the top one is driven along x."""
    pile(3, inPlane=True)
    load = MasonryLoad(body=2, point=(0.11, 0.051, 0.243), force=(0, 0, -2e3))
    load.updateAttrs(dict(direction=(1, 0, 0), driven=True, velocity=0.02))
    join(joint, loads=[load], functors=functors, damping=0.3)
    return load


def states():
    known = "stress slip damage opening".split()
    return [[getattr(i.phys, name) for name in known] for i in O.interactions]


def finite():
    return all(np.isfinite(part).all() for joint in states() for part in joint)


def sway(load, steps=3000, turns=4):
    for turn in range(turns):
        load.velocity = 0.02 * (-1) ** turn
        O.run(steps, True)


def test_cycles_take_energy_and_the_balance_closes():
    load = stack(MasonryJoint(name="bed", **CYCLIC))
    sway(load)
    assert balance()["dissipated_shear"] > 0
    assert abs(balance()["error"]) < 1e-6


def test_a_scene_that_was_saved_goes_on(tmp_path):
    load = stack(MasonryJoint(name="bed", **CYCLIC))
    sway(load, 1000, 3)
    file = str(tmp_path / "scene.yade.gz")
    O.save(file)
    before = states()
    O.reset()
    O.load(file)
    assert states() == before
    assert all(i.phys.joint.law == "cyclic" for i in O.interactions.all())


def test_an_elastic_joint_may_stand_beside_cyclic_ones_under_the_functors():
    joints = [
        MasonryJoint(name="bed", direction=(0, 0, 1), **CYCLIC),
        MasonryJoint(name="other", elastic=True),
    ]
    load = stack(joints, functors=True)
    sway(load, 100, 1)
    assert any(np.any(part) for joint in states() for part in joint)


def test_a_functor_of_another_law_is_reported():
    stack(MasonryJoint(name="bed"), functors=True)
    next(iter(O.interactions.all())).phys.joint.law = "cyclic"
    with pytest.raises(Exception, match="follows another law.*CyclicSoftening"):
        O.run(5, True)


def test_a_joint_can_change_its_law_between_steps():
    load = stack(MasonryJoint(name="bed"))
    sway(load, 500, 2)
    damage = lambda: np.array([i.phys.damage for i in O.interactions])
    before = damage()
    next(iter(O.interactions)).phys.joint.law = "cyclic"
    sway(load, 500, 2)
    assert (damage() >= before - 1e-12).all() and finite()


@pytest.mark.parametrize(
    "properties, message",
    [
        (dict(shearStiffnessLoss=1), "shear stiffness loss 1 must be 0 to 0.99"),
        (
            dict(initialClosingStiffness=1e12, tensileStrength=0),
            "1e.12 Pa/m must be below the normal stiffness",
        ),
        (
            dict(initialClosingStiffness=1e10, closureLimit=1e-4),
            "must be 0 for a joint that closes on a curve",
        ),
        (
            dict(closureLimit=1e-4),
            "closure limit 0.0001 m needs an initial closing stiffness",
        ),
        (dict(dilatancy=0.43, shearStiffness=1e10), "dilatancy 0.43 must be below"),
        (dict(capNormal=2), "cap normal 2 and cap linear 0 Pa must be 1 and 0"),
        (dict(capLinear=-1e4), "cap linear -10000 Pa must be at least 0"),
    ],
)
def test_what_the_law_cannot_follow_is_refused(properties, message):
    with pytest.raises(ValueError, match=message):
        MasonryJoint(law="cyclic", **properties)
    MasonryJoint(**{k: v for k, v in properties.items() if k != "shearStiffnessLoss"})
