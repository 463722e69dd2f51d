# SPDX-License-Identifier: GPL-2.0-or-later
"""Random fields: mean, spread and correlation are those that were asked for."""

from usual import *
from masonry import fields, materials
from masonry.materials import withResidual

POINTS = np.random.default_rng(7).uniform(-50, 50, (2000, 3))


def values(field, points=POINTS):
    return np.array([field(*p) for p in points])


@mark.parametrize("make", [fields.lognormal, fields.normal])
@mark.parametrize("length", [0.0, 0.5])
def test_mean_and_coefficient_of_variation(make, length):
    found = values(make(cov=0.2, length=length, seed=3))
    assert found.mean() == approx(1, abs=0.02)
    assert found.std() == approx(0.2, rel=0.06)


@mark.parametrize("share", [0.25, 0.5, 1.0, 1.5])
def test_correlation_falls_with_the_distance(share):
    length, found = 2.0, []
    for seed in range(6):
        field = fields.normal(cov=0.1, length=length, seed=seed)
        one, two = values(field), values(field, POINTS + [0, 0, share * length])
        found.append(np.corrcoef(one, two)[0, 1])
    assert np.mean(found) == approx(math.exp(-(share**2)), abs=0.05)


def test_a_seed_gives_the_same_field_again_and_another_seed_another_one():
    for length in (0.0, 0.3):
        of = lambda seed: values(fields.lognormal(0.3, length, seed), POINTS[:50])
        a, b, c = map(of, (1, 1, 2))
        assert (a == b).all() and (a != c).any()


def test_residual_friction_that_is_the_friction_varies_with_it():
    joints = {
        "bed": SimpleNamespace(friction=0.43, residualFriction=0.43),
        "head": SimpleNamespace(friction=0.43, residualFriction=0.3),
    }
    names = ["bed.friction", "head.friction", "bed.cohesion"]
    assert withResidual(names, joints) == [*names, "bed.residualFriction"]
    known = [*names, "bed.residualFriction"]
    assert withResidual(known, joints) == known


@mark.parametrize("factor", [1e-3, 0.3, 1.0, 1.7, 250.0])
def test_a_property_that_varies_is_rounded_by_half_a_step_at_most(factor):
    """Each kind of joint in its own steps, although the property has the same name."""
    steps = {"bed": 0.01, "head": 0.5}
    varied = materials.dry(normalStiffness=1e9)
    varied.joints["head"] = varied.joints["bed"].__class__(**varied.joints["bed"].dict())
    for name, step in steps.items():
        varied.vary(f"{name}.normalStiffness", lambda x, y, z: factor * (1 + z), step)
    geom = SimpleNamespace(centres=[(0, 0, 0), (0, 0, 1)])  # its middle is at z = 0.5
    for name, step in steps.items():
        made = varied._at(name, varied.joints[name], geom).normalStiffness
        off = math.log(made / (1e9 * factor * 1.5)) / math.log1p(step)
        assert abs(off) <= 0.5 + 1e-6
