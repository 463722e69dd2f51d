# SPDX-License-Identifier: GPL-2.0-or-later
"""What was not given of a masonry is noted, printed and written; what cannot be assumed is
refused."""

from hosted import *
from masonry.units import GRAVITY
from masonry.materials.assumptions import DESCRIBED, copied

#: Values that are no defaults, of every number of a joint that goes with the others.
OTHER = dict(
    **dict(normalStiffness=3.4e11, shearStiffness=1e11, tensileStrength=0.05e6),
    **dict(modeIFractureEnergy=10.0, cohesion=0.2e6, residualCohesion=0.01e6),
    **dict(friction=0.7, residualFriction=0.4, dilatancy=0.1, dilatancyDecay=1.0),
    **dict(modeIIFractureEnergy=90.0, compressiveStrength=5e6, elasticLimitRatio=0.4),
    **dict(residualStrengthRatio=0.1, peakRatio=20.0, compressiveFractureEnergy=2e4),
    **dict(capNormal=1.1, capShear=8.0, capLinear=1.0, restitution=0.5),
)
STRENGTHS = dict(tensileStrength=0.1e6, cohesion=0.2e6, friction=0.6, compressiveStrength=8e6)


def own(joint=None, unit=None, **joints):
    """Masonry of one's own, complete but for what is given otherwise."""
    bed = MasonryJoint(**(STRENGTHS if joint is None else joint))
    unit = MasonryMat(**({"density": 1900} if unit is None else unit))
    return materials.Masonry(unit, {"bed": bed, **joints})


TWO = bricks.stack(2, (0.2, 0.1, 0.1))


def names(entries):
    return {entry["name"] for entry in entries}


# -- what counts as given --------------------------------------------------------------------------

WAYS = ["made", "attribute", "set", "updateAttrs"]


given_by = some.dictionaries(some.sampled_from(sorted(OTHER)), some.sampled_from(WAYS))


@given(given_by=given_by, brittle=some.booleans())
@settings(max_examples=100)
def test_all_that_was_not_given_is_noted(given_by, brittle):
    by = lambda one: {n: OTHER[n] for n, how in given_by.items() if how == one}
    joint = MasonryJoint(**by("made"))
    for name, value in by("attribute").items():
        setattr(joint, name, value)
    joint.set(**by("set")).updateAttrs(by("updateAttrs"))
    joint = copied(joint)
    rest = set(DESCRIBED[MasonryJoint]) - set(given_by)
    if brittle:
        joint = joint.brittleCoulomb()
        rest -= {"cap", "tensionTable", "shearTable"}
    assert set(joint.assumed()) == rest
    unit = MasonryMat(density=1, young=1e9, poisson=0)
    entries = materials.Masonry(unit, {"bed": joint, "support": joint}).assumed()
    assert not names(entries) & {f"bed.{name}" for name in given_by}
    assert not names(entries) & {f"unit.{n}" for n in ("density", "young", "poisson")}
    for entry in entries:
        kind, _, name = entry["name"].partition(".")
        assert entry["value"] == getattr(joint, name) and entry["source"]
        assert entry["unit"] == DESCRIBED[MasonryJoint][name]["unit"]


def test_a_value_that_is_refused_is_not_given():
    joint = MasonryJoint()
    with raises(ValueError):
        joint.friction = -1
    with raises(ValueError):
        joint.set(friction=-1)
    assert "friction" in joint.assumed()


@mark.parametrize(
    "changes, without",
    [
        (dict(elastic=True), "residualFriction dilatancy peakRatio capNormal"),
        (dict(cap=False), "peakRatio elasticLimitRatio compressiveFractureEnergy"),
        (dict(tensionTable=[(1, 0), (2, 1)]), "modeIFractureEnergy"),
        (dict(shearTable=[(1, 0), (2, 1)]), "modeIIFractureEnergy"),
        (dict(tensileStrength=0), "modeIFractureEnergy"),
    ],
)
def test_what_has_no_effect_is_not_named(changes, without):
    all_ = names(own().assumed())
    found = names(own({**STRENGTHS, **changes}).assumed())
    for name in without.split():
        assert f"bed.{name}" in all_ and f"bed.{name}" not in found
    assert "bed.normalStiffness" in found and "bed.name" not in found


# -- what must be given ----------------------------------------------------------------------------


@mark.parametrize(
    "joint, unit, message",
    [
        (
            {},
            None,
            (
                "joint 'bed': tensileStrength [Pa], cohesion [Pa], friction [-],"
                " compressiveStrength [Pa] must be given"
            ),
        ),
        (
            dict(cap=False),
            None,
            "joint 'bed': tensileStrength [Pa], cohesion [Pa], friction [-] must be given",
        ),
        (
            {n: v for n, v in STRENGTHS.items() if n != "cohesion"},
            None,
            "joint 'bed': cohesion [Pa] must be given",
        ),
        (None, dict(young=10e9), "unit 'unit': density [kg/m³] must be given"),
    ],
)
def test_what_cannot_be_assumed_is_refused(joint, unit, message, tmp_path, capsys):
    with raises(SystemExit) as end:
        standing(tmp_path, TWO, own(joint, unit)).settle()
    assert end.value.code == 2 and message in capsys.readouterr().err
    assert not (tmp_path / "run.json").exists()


def test_all_that_is_missing_is_named_with_the_other_problems(tmp_path, capsys):
    masonry = own({}, {}, head=MasonryJoint(**{**STRENGTHS, "cap": False}), pier=MasonryJoint())
    with raises(SystemExit):
        standing(tmp_path, TWO, masonry, "--set", "bed.frictoin=1").settle()
    said = capsys.readouterr().err
    named = set(re.findall(r"(joint '\w+'|unit 'unit'|bed\.frictoin)", said))
    assert named == {"joint 'bed'", "joint 'pier'", "unit 'unit'", "bed.frictoin"}


def test_what_the_command_line_gives_is_given(tmp_path):
    words = [f"--set=bed.{name}={value}" for name, value in STRENGTHS.items()]
    made = standing(tmp_path, TWO, own({}), *words)
    made.settle()
    assert not names(made.assumed) & {f"bed.{name}" for name in STRENGTHS}
    # --set keeps one value of friction, where there is one
    assert made.masonry.joints["bed"].residualFriction == STRENGTHS["friction"]


def test_an_elastic_joint_needs_no_strength(tmp_path):
    assert standing(tmp_path, TWO, own(dict(elastic=True))).settle() == AT_REST


# -- what is said ----------------------------------------------------------------------------------


def test_a_scene_prints_once_what_it_assumes_and_writes_it(tmp_path, capsys):
    made = standing(tmp_path, TWO, own(), "--density-scaling", "4")
    made.settle()
    made.settle()
    made.finish()
    said = capsys.readouterr().out
    assert said.count("assumed, because it was not given") == 1
    assert said.count("  bed: residualFriction 0.43  (default of MasonryJoint") == 1
    assert said.count("joints to platens take the bed joint") == 1
    entries = readRun(tmp_path)["assumed"]
    (friction,) = [e for e in entries if e["name"] == "bed.residualFriction"]
    assert friction["value"] == 0.43 and friction["unit"] == "-"
    assert "law/README.md" in friction["source"]
    assert {"unit.young", "unit.poisson", "support"} < names(entries)


def test_a_scene_with_all_given_says_nothing(tmp_path, capsys):
    unit = dict(young=1e10, poisson=0.2, density=1900)
    bed = MasonryJoint(**{**OTHER, "name": "bed"})
    made = standing(tmp_path, TWO, own(OTHER, unit, support=bed))
    made.settle()
    made.finish()
    assert "assumed" not in capsys.readouterr().out
    assert readRun(tmp_path)["assumed"] == []


def test_published_sets_name_what_they_assume(tmp_path, capsys):
    found = names(materials.calciumSilicate().assumed())
    assert {"bed.residualFriction", "crack.cohesion"} < found
    assert not found & {"bed.friction", "head.compressiveStrength", "unit.density"}
    assert not any(name.startswith("support") for name in found)
    granite = materials.dryGranite(175, 0.15).assumed()
    assert {"unit.density", "unit.poisson", "bed.friction", "head.normalStiffness"} < names(granite)
    assert not names(granite) & {"bed.normalStiffness", "bed.cohesion", "unit.young"}
    changed = materials.calciumSilicate()
    changed.joints["bed"].dilatancy = 0.1
    assert found - names(changed.assumed()) == {"bed.dilatancy"}
    standing(tmp_path, TWO, changed).settle()
    assert (
        f"note: {len(found) - 1} properties of the materials are assumed" in capsys.readouterr().out
    )


DRY = dict(
    friction=0.6, normalStiffness=1e10, shearStiffness=5e9, density=2500, young=3e10, poisson=0.1
)


def test_calcium_silicate_has_the_moduli_and_closures_that_its_help_names():
    made, moduli = materials.calciumSilicate(), (4079e6, 4507e6)
    young, lengths = made.unit.young, {"bed": 0.081, "head": 0.220}
    for (name, length), modulus, closure in zip(lengths.items(), moduli, (1.54, 1.21)):
        joint = made.joints[name]
        series = 1 / (1 / (length * joint.normalStiffness) + 1 / young)
        assert series == approx(modulus, rel=2e-4)
        peak = joint.peakRatio * joint.compressiveStrength / joint.normalStiffness
        assert 1e3 * peak == approx(closure, abs=0.005)
        shear = joint.normalStiffness / (2 * (1 + made.unit.poisson))
        assert joint.shearStiffness == approx(shear, rel=2e-3)
    bed, support, crack = (made.joints[name] for name in ("bed", "support", "crack"))
    assert support.elastic and support.normalStiffness == bed.normalStiffness
    # it is brick, which the mortar does not change: 0.99 of E/L with a half brick
    half = 0.220 / 2
    soft = 1 / (half / young + 1 / crack.normalStiffness)
    assert soft == approx(0.99 * young / half, rel=5e-3)


@mark.parametrize("level, modulus", [(100, 3.287e9), (175, 4.068e9), (250, 4.722e9)])
def test_granite_blocks_and_their_dry_joints_have_the_measured_modulus(level, modulus):
    height = 0.15
    made = materials.dryGranite(level, height)
    for joint in made.joints.values():
        series = 1 / (1 / (height * joint.normalStiffness) + 1 / made.unit.young)
        assert series == approx(modulus)
        assert joint.shearStiffness == approx(0.4 * joint.normalStiffness)


@given(own=some.sets(some.sampled_from(sorted(DRY))))
def test_dry_joints_name_the_defaults_that_were_not_given(own):
    masonry = materials.dry(**{name: DRY[name] for name in own})
    of = lambda n: ["unit"] if n in ("density", "young", "poisson") else ["bed", "support"]
    expected = {f"{kind}.{n}" for n in set(DRY) - own for kind in of(n)}
    assert names(masonry.assumed()) == expected
    for name in own:
        thing = masonry.unit if of(name) == ["unit"] else masonry.joints["support"]
        assert getattr(thing, name) == DRY[name]


def test_the_defaults_of_dry_joints_are_those_of_its_help():
    bed, unit = materials.dry().joints["bed"], materials.dry().unit
    assert (bed.friction, bed.residualFriction, bed.normalStiffness) == (0.7, 0.7, 5e9)
    assert (bed.shearStiffness, bed.cohesion, bed.tensileStrength) == (2e9, 0, 0)
    assert (unit.density, unit.young, unit.poisson) == (2600, 20e9, 0.2)


# -- joints to platens -----------------------------------------------------------------------------


def test_stones_slide_on_their_platen(tmp_path):
    stones = bricks.stack(2, (0.3, 0.2, 0.1))
    bed = dict(
        normalStiffness=1e10,
        shearStiffness=4e9,
        tensileStrength=0,
        cohesion=0,
        friction=0.4,
        residualFriction=0.4,
        cap=False,
    )
    density = 216 / GRAVITY / 0.012  # 216 N in all
    made = standing(tmp_path, stones, own(bed, dict(density=density)), rate=1)
    made.args.lean = False  # the bound is found
    pushed = made.handle(0, name="lower")
    assert made.settle() == AT_REST
    made.push(pushed, 0.3)
    made.finish()
    run = readRun(tmp_path)
    assert run["bound_base_shear_kN"] == approx(0.0864, rel=1e-6)
    assert run["base_shear_end_kN"] == approx(0.0864, rel=0.03)
    assert run["peak_base_shear_kN"] < 1.3 * 0.0864  # the push begins with a jerk


def test_a_support_joint_follows_the_bed_joint_until_it_is_given():
    known = own()
    known.joints["bed"].friction = 0.5
    known.joints["support"].cohesion = 0.3e6
    made = variant(known)
    assert made.joints["support"].friction == 0.5
    made.apply([("bed", "cohesion", "0.25e6"), ("support", "dilatancy", "0.1")])
    support = made.joints["support"]
    assert (support.friction, support.cohesion, support.dilatancy) == (0.5, 0.3e6, 0.1)
    assert made.joints["bed"].dilatancy == 0 and not support.elastic
    made.apply([("bed", "tensileStrength", "0.02e6"), ("bed", "dilatancy", "0.2")])
    assert (support.tensileStrength, support.dilatancy) == (0.02e6, 0.1)


def variant(known, *words):
    return known.variant(options.parser("", until=1).parse_args(words))


def test_joints_without_a_name_have_that_of_their_place():
    both = MasonryJoint(**STRENGTHS)
    known = own(STRENGTHS, None, head=both, collar=both)
    assert [j.name for j in known.joints.values()] == ["bed", "head", "head", "support"]
    for words in ([], ["--joints", "brittle"]):
        names = " ".join(variant(known, *words).joints)
        assert names == "bed head collar support"


# -- properties that go together -------------------------------------------------------------------


@given(
    some.permutations(["friction", "residualFriction", "dilatancy", "cohesion", "tensileStrength"])
)
def test_properties_are_set_together_in_any_order(order):
    values = dict(
        friction=0.2, residualFriction=0.15, dilatancy=0.1, cohesion=0.9e6, tensileStrength=1e6
    )
    joint = MasonryJoint()
    assert joint.set(**{name: values[name] for name in order}) is joint
    assert {name: getattr(joint, name) for name in order} == values


def test_what_cannot_be_set_together_has_all_problems_and_changes_nothing():
    joint = MasonryJoint()
    before, noted = joint.dict(), dict(joint.assumed())
    with raises(ValueError) as refused:
        joint.set(residualFrictoin=0.1, friction=-1, cohesion=2e5)
    assert "no attribute 'residualFrictoin', did you mean 'residualFriction'?" in str(refused.value)
    assert "friction -1 must be at least 0" in str(refused.value)
    with raises(ValueError, match="residual friction 0.43 must be at most 0.3"):
        joint.set(friction=0.3)
    assert joint.dict() == before and joint.assumed() == noted


@mark.parametrize(
    "name, value, together",
    [
        ("friction", 0.5, True),
        ("residualFriction", 0.8, True),
        ("tensileStrength", 1e6, True),
        ("cap", True, True),
        ("cohesion", -1, False),
        ("elasticLimitRatio", 1.0, False),
    ],
)
def test_an_error_names_how_to_set_several(name, value, together):
    brittle = dict(cap=False, compressiveFractureEnergy=100) if name == "cap" else {}
    joint = MasonryJoint(friction=0.7, residualFriction=0.7, **brittle)
    with raises(ValueError) as refused:
        setattr(joint, name, value)
    assert (f"joint.set({name}=..., ...)" in str(refused.value)) == together


def test_what_yade_has_loaded_counts_as_given():
    addBlock(bricks.boxCorners((0, 0, 0), (1, 1, 1)), MasonryMat(density=1800))
    assert "young" in O.bodies[0].mat.assumed()
    O.saveTmp()
    O.loadTmp()
    assert O.bodies[0].mat.assumed() == {} and copied(O.bodies[0].mat).assumed() == {}
