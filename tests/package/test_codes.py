# SPDX-License-Identifier: GPL-2.0-or-later
"""What building codes say of a masonry, worked out by hand, and what run.json says of it."""

from usual import *
from masonry import materials
from masonry.materials import assumptions
from masonry.materials.codes import K, TABLE

BRICK = dict(unit_E=40e9, unit=(0.24, 0.12, 0.065), joint=0.01)


@mark.parametrize(
    "words, fk, fvk0",
    [
        (dict(unit="clay", fb=15e6, mortar="M5"), 0.55 * 15**0.7 * 5**0.3, 0.2),
        (dict(unit="clay", fb=10e6, mortar="M10", group=3), 0.35 * 10**0.7 * 10**0.3, 0.3),
        (
            dict(unit="clay", fb=10e6, mortar="M10", group=2, joints="thin layer"),
            0.70 * 10**0.7,
            0.3,
        ),
        (
            dict(unit="calcium silicate", fb=20e6, mortar="M10", joints="thin layer"),
            0.80 * 20**0.85,
            0.4,
        ),
        (dict(unit="natural stone", fb=60e6, mortar="M2"), 0.45 * 60**0.7 * 2**0.3, 0.1),
        (
            dict(unit="autoclaved aerated concrete", fb=3e6, mortar="M5"),
            0.55 * 3**0.7 * 5**0.3,
            0.15,
        ),
        (
            dict(unit="autoclaved aerated concrete", fb=2e6, mortar="M4"),
            0.55 * 2**0.7 * 4**0.3,
            0.13,
        ),  # 0.065 fb
    ],
)
def test_what_eurocode_6_says_of_a_unit_and_a_mortar(words, fk, fvk0):
    found = materials.en1996(**words, value="characteristic")
    numbers = [found[n] for n in ("fc", "E", "G", "fv0", "friction")]
    assert numbers == approx([1e6 * fk, 1e9 * fk, 0.4e9 * fk, 1e6 * fvk0, 0.4], rel=1e-12)
    mean = materials.en1996(**words)
    ratios = [mean[n] / found[n] for n in ("fc", "E", "G", "fv0", "friction")]
    assert ratios == approx([1.2, 1, 1, 1.25, 1.25], rel=1e-12)


@mark.parametrize(
    "words, message",
    [
        (("natural stone", 2e7, "M5", 2), "table 3.3 has no K for natural stone of group 2"),
        (
            ("natural stone", 2e7, "M5", 1, "thin layer"),
            "has no K for natural stone of group 1 in thin layer mortar",
        ),
        (("clay", 6e7, "M5", 1, "thin layer"), "fb 6e+07 Pa must be at most 5e+07 Pa"),
        (("clay", 3e6, "M10"), "mortar M10 must be at most twice as strong as the units"),
        (("clay", 3e6, "M30"), "mortar 'M30' must be a class of mortar from 'M1' to 'M20'"),
    ],
)
def test_what_eurocode_6_does_not_have_is_refused(words, message):
    with raises(Refused) as refused:
        materials.en1996(*words)
    assert message in str(refused.value)


def test_more_holes_and_thicker_mortar_make_no_masonry_stronger():
    for factors in K.values():
        for row in factors.values():
            assert list(row) == sorted(row, reverse=True)


def test_knowledge_and_confidence_decide_what_the_italian_table_says():
    first = materials.ntc2018("squared stone", "LC1")
    second = materials.ntc2018("squared stone", "LC2")
    assert [1e-6 * first[n] * 1.35 for n in ("fc", "fv0", "ft")] == approx([5.8, 0.18, 1.5 * 0.09])
    assert [1e-6 * second[n] * 1.2 for n in ("fc", "fv0", "ft")] == approx([7.0, 0.23, 1.5 * 0.105])
    for found in (first, second):
        values = [found["E"], found["G"], found["friction"], found["density"]]
        assert values == approx([2850e6, 950e6, 0.577, 22e3 / 9.81])
    rubble = materials.ntc2018("rubble", "LC2", confidence=1)
    assert rubble["fv0"] == approx(1.5 * 0.025e6 / 0.7)
    with raises(Refused, match="'LC3' must be LC1 or LC2; LC3 needs tests"):
        materials.ntc2018("rubble", "LC3")


HEADS = "given by a code", "assumed, because it was not given"


@mark.parametrize("row", TABLE)
@mark.parametrize("knowledge", ["LC1", "LC2"])
def test_every_row_makes_masonry_whose_properties_name_their_clauses(row, knowledge):
    made = materials.masonry(**materials.ntc2018(row, knowledge), **BRICK)
    said = {entry["name"]: entry["source"] for entry in made.assumed()}
    number = f"table C8.5.I, row {TABLE[row].number}"
    of = "normalStiffness shearStiffness cohesion tensileStrength compressiveStrength"
    assert all(number in said[f"bed.{name}"] for name in of.split())
    assert number in said["unit.density"]
    assert "C8.7.1.3.1.1" in said["bed.friction"]
    assert all(said[f"bed.{name}"].startswith("by a code: ") for name in of.split())
    lines = assumptions.linesOf(made.assumed(), False)
    code, assumed = (lines.index(f"{what} (run.json: assumed):") for what in HEADS)
    assert code == 0 and all("table C8.5.I" in one or "C8.7.1" in one for one in lines[1:assumed])
    brief = "\n".join(assumptions.linesOf(made.assumed(), True))
    count = len([one for one in made.assumed() if "by a code" in one["source"]])
    assert f"and {count} given by a code" in brief


def test_a_value_of_the_users_own_has_no_clause():
    code = materials.en1996("clay", fb=15e6, mortar="M5")
    made = materials.masonry(**{**code, "fv0": 0.3e6}, **BRICK, ft=0.1e6, density=1800)
    said = {entry["name"]: entry["source"] for entry in made.assumed()}
    assert "bed.cohesion" not in said and "table 3.3" in said["bed.compressiveStrength"]
    assert made.joints["bed"].cohesion == 0.3e6
