# SPDX-License-Identifier: GPL-2.0-or-later
"""The cyclic law in YADE: properties, and scenes of two laws. Its runs are those of
test_joint_loop.py and others."""

from hosted import *


def stack(functors=False):
    pile(3, inPlane=True)
    load = MasonryLoad(body=2, point=(0.11, 0.051, 0.243), force=(0, 0, -2e3))
    load.updateAttrs(dict(direction=(1, 0, 0), driven=True, velocity=0.02))
    join(MasonryJoint(), loads=[load], functors=functors, damping=0.3)
    return load


def test_a_functor_of_another_law_is_reported():
    stack(functors=True)
    next(iter(O.interactions)).phys.joint.law = "cyclic"
    with raises(Exception, match="follows another law.*CyclicSoftening"):
        O.run(5, True)


def test_a_joint_can_change_its_law_between_steps():
    load, damage = stack(), []
    for law in ("softening", "cyclic"):
        next(iter(O.interactions)).phys.joint.law = law
        for velocity in (0.02, -0.02):
            load.velocity = velocity
            O.run(500, True)
        damage.append(np.array([i.phys.damage for i in O.interactions]))
    assert (damage[1] >= damage[0] - 1e-12).all()
    assert all(np.isfinite(i.phys.stress).all() for i in O.interactions)


@mark.parametrize(
    "properties, message",
    [
        (dict(shearStiffnessLoss=1), "shear stiffness loss 1 must be 0 to 0.99"),
        (
            dict(initialClosingStiffness=1e12, tensileStrength=0),
            "1e.12 Pa/m must be below",
        ),
        (
            dict(initialClosingStiffness=1e10, closureLimit=1e-4),
            "must be 0 for a joint that",
        ),
        (
            dict(closureLimit=1e-4),
            "closure limit 0.0001 m needs an initial closing stiff",
        ),
        (dict(dilatancy=0.43, shearStiffness=1e10), "dilatancy 0.43 must be below"),
        (dict(capNormal=2), "cap normal 2 and cap linear 0 Pa must be 1 and 0"),
        (dict(capLinear=-1e4), "cap linear -10000 Pa must be at least 0"),
    ],
)
def test_what_the_law_cannot_follow_is_refused(properties, message):
    with raises(ValueError, match=message):
        MasonryJoint(law="cyclic", **properties)
    MasonryJoint(**{k: v for k, v in properties.items() if k != "shearStiffnessLoss"})
