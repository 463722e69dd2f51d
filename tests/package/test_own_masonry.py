# SPDX-License-Identifier: GPL-2.0-or-later
"""Masonry of one's own by formulas: the numbers of its joints, what it refuses and warns of, and
one wall that has its modulus."""

from hosted import *

SIZE, MORTAR = (0.25, 0.12, 0.065), 0.010
CLAY = dict(
    E=4e9,
    unit_E=9e9,
    fc=14e6,
    fv0=0.25e6,
    friction=0.6,
    ft=0.2e6,
    unit=SIZE,
    joint=MORTAR,
    density=1800,
)


def clay(**changes):
    values = {**CLAY, **changes}
    return materials.masonry(**{n: v for n, v in values.items() if v is not None})


def sources(masonry):
    return {entry["name"]: entry["source"] for entry in masonry.assumed()}


legal = some.fixed_dictionaries(
    dict(
        E=some.floats(1e9, 8e9),
        share=some.floats(0.05, 0.9),  # E over unit_E
        fc=some.floats(2e6, 20e6),
        fv0=some.floats(0.05e6, 0.5e6),
        friction=some.floats(0.4, 1.0),
        bond=some.floats(0.01, 1.0),  # ft over fv0/friction
        poisson=some.floats(0.0, 0.3),
        length=some.floats(0.15, 0.4),
        height=some.floats(0.04, 0.25),
        joint=some.floats(0.001, 0.02),
        stiff=some.floats(0.1, 0.9),  # G over its bound
        along=some.floats(0.2, 0.9),  # head_E over unit_E
        strain=some.floats(1.5, 2.5),  # peak strain over fc/E
    )
)


def clayOf(p, **more):
    unitE, ft = p["E"] / p["share"], p["bond"] * p["fv0"] / p["friction"]
    own = {n: p[n] for n in ("E", "fc", "fv0", "friction", "joint", "poisson")}
    unit = (p["length"], 0.1, p["height"])
    return clay(unit_E=unitE, ft=ft, unit=unit, **own, **more), unitE


@given(legal)
@settings(max_examples=80)
def test_bricks_and_joints_in_series_are_the_masonry(p):
    unitE = p["E"] / p["share"]
    shear = 1 / (2 * (1 + p["poisson"]))
    values = dict(
        G=p["stiff"] * shear * unitE,
        head_E=p["along"] * unitE,
        Gc=1e6,
        peak_strain=p["strain"] * max(p["fc"] / p["E"], p["fc"] / (p["along"] * unitE)),
    )
    assume(values["peak_strain"] < 0.09)
    made, _ = clayOf(p, **values)
    bed, head = made.joints["bed"], made.joints["head"]
    bedSpacing, headSpacing = p["height"] + p["joint"], p["length"] + p["joint"]
    inSeries = lambda k, spacing, own: 1 / (1 / (k * spacing) + 1 / own)
    assert inSeries(bed.normalStiffness, bedSpacing, unitE) == approx(p["E"])
    assert inSeries(head.normalStiffness, headSpacing, unitE) == approx(values["head_E"])
    assert inSeries(bed.shearStiffness, bedSpacing, shear * unitE) == approx(values["G"])
    # brick and joint together have the peak strain at fc
    closure = bed.peakRatio * p["fc"] / bed.normalStiffness
    strain = closure / bedSpacing + p["fc"] / unitE
    assert strain == approx(values["peak_strain"])
    assert made.joints["support"].dict() == {**bed.dict(), "name": "support"}
    # the crack surface leaves 0.99 of half a brick
    half = headSpacing / 2 / unitE
    assert half / (half + 1 / made.joints["crack"].normalStiffness) == approx(1 / 1.01)
    given = "shearStiffness tensileStrength peakRatio compressiveFractureEnergy"
    named = {
        "head.normalStiffness",
        "unit.poisson",
        *(f"bed.{n}" for n in given.split()),
    }
    assert not named & set(sources(made))


@given(legal, some.floats(0.5e6, 5e6))
@settings(max_examples=80)
def test_what_is_assumed_is_what_the_law_can_follow(p, brickStrength):
    assume(p["fc"] / p["E"] * (p["height"] + p["joint"]) < 3e-4)  # else Gc is too small
    made, unitE = clayOf(p, unit_ft=brickStrength)
    length, shearing = p["length"] + p["joint"], 2 * (1 + p["poisson"])
    distances = {"bed": p["height"] + p["joint"], "head": length, "crack": length / 2}
    for name, distance in distances.items():
        joint = made.joints[name]
        lumped = distance / unitE
        tension = materials.leastEnergy(joint.tensileStrength, joint.normalStiffness, lumped)
        shear = materials.leastEnergy(joint.cohesion, joint.shearStiffness, shearing * lumped)
        assert joint.modeIFractureEnergy >= max(0.029e-3 * joint.tensileStrength, 1.099 * tension)
        assert joint.modeIIFractureEnergy >= max(0.093e-3 * joint.cohesion, 1.099 * shear)
    bed = made.joints["bed"]
    assert bed.peakRatio == approx(1 + 1 / (1 - p["share"]))  # of 2 fc/E
    assert bed.shearStiffness * shearing == approx(bed.normalStiffness)
    assert bed.residualFriction == p["friction"] and bed.dilatancy == 0
    said = sources(made)
    assert (
        "Kaushik" in said["bed.peakRatio"] and "Lourenço" in said["bed.compressiveFractureEnergy"]
    )
    assert not {"bed.cohesion", "bed.friction", "unit.density", "unit.young"} & set(said)


def test_the_compressive_fracture_energy_is_that_of_its_sources():
    energy = lambda fc: materials.compressiveFractureEnergy(fc)[0]
    assert energy(20e6) == approx(22160)  # 15 + 8.6 - 1.44 N/mm
    assert energy(10e6) == approx(16000) and energy(100e6) == approx(33000)
    for edge in (12e6, 80e6):  # the parts nearly meet
        assert energy(edge * (1 - 1e-9)) == approx(energy(edge * (1 + 1e-9)), rel=0.03)


@mark.parametrize("fc, said", [(5e6, "1.6 mm·fc"), (14e6, ""), (90e6, "0.33 mm·fc")])
def test_outside_its_range_a_formula_is_a_warning(fc, said, capsys):
    made = clay(fc=fc, E=40e9, unit_E=120e9)
    printed = capsys.readouterr().out
    assert ("outside of 12 to 80 MPa" in printed and said in printed) == bool(said)
    assert said in sources(made)["bed.compressiveFractureEnergy"]
    clay(fc=fc, E=40e9, unit_E=120e9, Gc=40000)
    assert not capsys.readouterr().out


@mark.parametrize(
    "changes, strain",
    [
        (dict(E=1.9e9), ""),
        (dict(E=0.7e9), "2.9 % (2 fc/E)"),  # E/fc = 70, as of prisms of stone in lime mortar
        (dict(fc=None, fk=10e6, E=2e9), "1.2 % (2 fc/E)"),
        (dict(peak_strain=0.02), "2 % (peak_strain)"),
        (materials.ntc2018("rubble", "LC2") | dict(E=0.2e9), "1.2 % (2 fc/E)"),
    ],
)
def test_a_modulus_with_which_masonry_would_shorten_too_much_is_questioned(changes, strain, capsys):
    made = clay(**dict(dict(fc=10e6, Gc=1e6), **changes))
    printed = capsys.readouterr().out
    assert (f"shortens by {strain} before it crushes" in printed) == bool(strain)
    if "G" not in changes:
        modulus = changes.get("E", 4e9) / 2.4
        assert f"masonry has G = {modulus:.4g} Pa, 0.42 E" in sources(made)["bed.shearStiffness"]


def test_other_strengths_are_converted_and_said():
    bed = clay(fc=None, fk=6e6).joints["bed"]
    assert bed.compressiveStrength == approx(7.2e6, rel=1e-12)
    assert "EN 1052-1" in bed.assumed()["compressiveStrength"]
    made = clay(ft=None, bond_wrench=0.3e6)
    assert made.joints["bed"].tensileStrength == approx(0.2e6)
    said = sources(made)["bed.tensileStrength"]
    assert "bond_wrench 300000 Pa over 1.5" in said and "van der Pluijm" in said
    other = clay(ft=None, bond_wrench=0.3e6, bond_ratio=2)
    assert other.joints["head"].tensileStrength == approx(0.15e6)
    assert "bed.tensileStrength" not in sources(clay())


def test_head_joints_are_of_the_same_mortar_or_have_their_share():
    bed, head = (clay().joints[name].dict() for name in ("bed", "head"))
    alike = {
        "normalStiffness",
        "shearStiffness",
        "tensileStrength",
        "cohesion",
        "friction",
        "peakRatio",
        "compressiveStrength",
    }
    assert {n: bed[n] for n in alike} == {n: head[n] for n in alike}
    poor = clay(head_share=0.5, GfI=20).joints
    assert poor["head"].tensileStrength == 0.1e6 and poor["head"].cohesion == 0.125e6
    assert poor["head"].modeIFractureEnergy == 10
    dry = clay(head_share=0).joints["head"]
    assert dry.tensileStrength == 0 and dry.cohesion == 0


def test_the_least_fracture_energy_is_that_of_the_law_or_of_rigid_units():
    """strength²/stiffness, or strength² (lumped + 1/(2 stiffness)) where the units give more than
    half of that back."""
    assert materials.leastEnergy(0.2e6, 1e10) == approx(0.2e6**2 / 1e10)
    for lumped, share in ((0.4e-10, 1e-10), (2e-10, 2e-10 + 0.5e-10)):
        found = materials.leastEnergy(0.2e6, 1e10, lumped)
        assert found == approx(0.2e6**2 * share)


@mark.parametrize("side", [1, -1])
@mark.parametrize("angle, name", [(0, "bed"), (44, "bed"), (46, "head"), (90, "head")])
def test_a_joint_steeper_than_45_degrees_is_a_head_joint(side, angle, name):
    """Whichever side its normal points to. ``angle``: of the normal with the vertical [degrees]."""
    one, other = (SimpleNamespace(brick=n, part="wall") for n in (1, 2))
    turned = math.radians(angle)
    normal = [side * math.sin(turned), 0, side * math.cos(turned)]
    assert clay()._kind(one, other, normal) == name
    assert clay()._kind(one, None, normal) == "support"
    assert clay()._kind(one, one, normal) == "crack"


def test_bricks_crack_if_their_strength_is_given():
    assert clay().joints["crack"].elastic
    assert "bricks do not crack" in sources(clay())["crack.elastic"]
    given = dict(ft=2e6, GfI=90, fv0=3e6, friction=0.9, GfII=700)
    made = clay(**{f"unit_{name}": value for name, value in given.items()})
    crack = made.joints["crack"]
    names = "tensileStrength modeIFractureEnergy cohesion friction modeIIFractureEnergy"
    assert [getattr(crack, n) for n in names.split()] == [*given.values()]
    assert not (crack.elastic or crack.cap)
    assert not {"crack.elastic", "crack.cohesion"} & set(sources(made))
    crack = clay(unit_ft=2e6).joints["crack"]
    assert crack.cohesion == 2 * 2e6
    assert crack.friction == crack.residualFriction == 0.75


@mark.parametrize(
    "changes, message",
    [
        (dict(E=9e9), "E 9e+09 Pa must be below unit_E 9e+09 Pa: bricks and joints are in series"),
        (dict(joint=0.07), "joint 0.07 m must be below length and height of the unit"),
        (dict(unit=(250, 120, 65)), "must be at most 5 m: is it in m?"),
        (
            dict(ft=None),
            "give either ft, the direct tensile strength of bed joints, or bond_wrench",
        ),
        (dict(bond_wrench=0.3e6), "give either ft, the direct"),
        (
            dict(ft=0.5e6),
            "ft 500000 Pa must be at most fv0/friction = 416667 Pa, the apex of the Coulomb cone",
        ),
        (
            dict(ft=None, bond_wrench=0.9e6),
            "bond_wrench/1.5 = 600000 Pa must be at most fv0/friction = 416667 Pa",
        ),
        (
            dict(unit_ft=2e6, unit_fv0=1e6),
            "unit_ft 2e+06 Pa must be at most unit_fv0/unit_friction = 1.33333e+06 Pa",
        ),
        (
            dict(G=4e9),
            "G 4e+09 Pa must be below that of the bricks, unit_E/(2 (1 + nu)) = 3.75e+09 Pa",
        ),
        (dict(residual_friction=0.7), "residual_friction 0.7 must be at most friction 0.6"),
        (
            dict(dilatancy=0.5, residual_friction=0.4),
            "dilatancy 0.5 must be at most residual_friction 0.4",
        ),
        (dict(peak_strain=1e-3), "peak_strain 0.001 must be at least fc/E = 0.0035"),
        (dict(Gc=3000), "compressive fracture energy 3000 J/m² is too small for peak ratio"),
        (dict(Gc=3000), "; Gc and peak_strain, and fc and E, decide"),
        (dict(unit_GfI=60), "unit_GfI without unit_ft: bricks do not crack then"),
        (dict(bond_ratio=2), "bond_ratio goes with bond_wrench"),
        (dict(density=None, joint=None), "joint, density must be given"),
        (dict(fc=None), "give fc, the mean compressive strength of the masonry, or fk"),
        (dict(fk=8e6), "give fc, the mean"),
        (dict(fm=5e6), "fm is the strength of the mortar in EN 1996 and on data sheets: give fc"),
    ],
)
def test_wrong_values_are_refused_with_the_bound(changes, message):
    with raises(Refused) as refused:
        clay(**changes)
    assert message in str(refused.value)


def test_all_wrong_values_are_named_at_once():
    with raises(Refused) as refused:
        clay(fc=-1, joint=1, density=None, friction=9)
    for word in ("fc -1", "joint 1 m", "density must be given", "friction 9"):
        assert word in str(refused.value)


def wall(masonry, folder, length=0.52, height=0.375, **settings):
    """A small wall of these bricks between platens, before its first stage, and its upper
    platen."""
    scene = standing(
        folder, bricks.Wall(length, height, unit=SIZE, joint=MORTAR), masonry, **settings
    )
    return scene, scene.platen("top", rotation="held")


@mark.parametrize(
    "energy, joint, strength, stiffness, distance, changes",
    [
        ("GfI", "head", "tensileStrength", "normalStiffness", 0.26, dict(ft=0.4e6)),
        ("GfII", "head", "cohesion", "shearStiffness", 0.26, {}),
        ("unit_GfI", "crack", "tensileStrength", "normalStiffness", 0.13, dict(unit_ft=2e6)),
        ("unit_GfII", "crack", "cohesion", "shearStiffness", 0.13, dict(unit_ft=2e6)),
    ],
)
def test_softening_that_snaps_back_is_a_warning_and_no_scene(
    energy, joint, strength, stiffness, distance, changes, tmp_path, capsys
):
    # so stiff a joint has most of its elasticity from the units
    changes = dict(E=7e9, fc=20e6, unit_E=7.5e9, **changes)
    made = clay(**changes).joints[joint]
    soft = 2.4 if "II" in energy else 1.0  # E/G of the bricks
    least = materials.leastEnergy(
        getattr(made, strength), getattr(made, stiffness), soft * distance / 7.5e9
    )
    # bricks in halves share their shear, and are half as far apart
    for share, snaps in ((1.02, False), (0.2, True)):
        capsys.readouterr()
        masonry = clay(**changes, **{energy: share * least})
        said = capsys.readouterr().out
        assert (f"it must be above {least:.4g} J/m²" in said) == snaps
        if snaps:
            assert f"{energy} {share * least:.4g} J/m² of the {joint} joint" in said
        scene, _ = wall(masonry, tmp_path / "r")
        if snaps:
            with raises(ValueError, match="would snap back"):
                scene.settle()
        else:
            assert scene.settle() == AT_REST
            letGo()


def test_a_wall_has_the_modulus_of_its_masonry(tmp_path):
    scene, top = wall(clay(), tmp_path / "r", height=0.75, gravity=0)
    lower = scene.watch((0.26, 0.06, 0.1125), name="lower")
    upper = scene.watch((0.26, 0.06, 0.6375), name="upper")
    scene.press(top, 0.4e6)
    assert scene.settle() == AT_REST
    moved = [scene.model.supports.moved(target)[0][2] for target in (lower, upper)]
    strain = (moved[0] - moved[1]) / (0.6375 - 0.1125)
    assert 0.4e6 / strain == approx(CLAY["E"], rel=0.01)


def test_bricks_of_another_course_than_that_of_the_joints_are_noted(tmp_path, capsys):
    for name, size in (("same", SIZE), ("other", (0.25, 0.12, 0.09))):
        wall = bricks.Wall(2 * (size[0] + 0.01), 2 * (size[2] + 0.01), unit=size, joint=0.01)
        standing(tmp_path / name, wall, clay()).settle()
        said = capsys.readouterr().out
        assert ("the joints are for courses of 75 mm" in said) == (name == "other")
        letGo()
