# SPDX-License-Identifier: GPL-2.0-or-later
"""Houses fit together, and the weight that is found by hand is all of it, where it stands."""

from hosted import *
from masonry import bricks, materials

UNIT = 0.8, 0.4, 0.4
LINTEL = bricks.Lintel(bearing=0.4, height=0.4)
sides = some.fixed_dictionaries(
    {side: some.sampled_from([None, 1.0, 1.2]) for side in ("front", "right", "back", "left")}
)


def built(houses, ring=0.0, eccentricity=(0, 0), height=1.2):
    storeys = [
        bricks.Storey(
            2.4,
            **{
                side: [bricks.Opening(x, 0.8, 1.2, height, LINTEL)]
                for side, x in walls.items()
                if x
            },
            span=span,
            ring=ring,
        )
        for walls, span in zip(houses, "xyx")
    ]
    house = bricks.House(4.0, 3.2, storeys, unit=UNIT, eccentricity=eccentricity)
    stones = materials.dry(friction=0.6, density=2000)
    return house, house.withFloors(stones, shear=1e6, mass=400)


@given(houses=some.lists(sides, min_size=1, max_size=3), ring=some.sampled_from([0.0, 0.2]))
@settings(max_examples=12, deadline=None)
def test_storeys_fit_and_all_weight_goes_to_a_pier(houses, ring):
    house, stones = built(houses, ring)
    assert not [p for p in house.problems() if "overlap" in p or "gap" in p or "no joint" in p]
    densities = [stones.units.get(b.kind, stones.unit).density for b in house]
    volumes = [bricks.Bricks([b]).volume for b in house]
    for n, (z, piers) in enumerate(zip(house.heights, house.piers), 1):
        weights = house.weights(stones, n)
        assert weights.keys() == piers.keys() == {b.part for b in house if b.part in piers}
        above = sum(d * v for b, d, v in zip(house, densities, volumes) if b.middle[2] > z)
        assert sum(weights.values()) == approx(above * 9.81e-3)
        assert any(abs(b.low[2] - z) < 1e-9 for b in house if b.part in piers)  # a bed joint


def test_weights_on_the_piers_of_one_wall_by_hand():
    # the mirror image of a wall has the same weight; the floor spans to left and right alone
    house, stones = built([dict(left=1.0, right=1.0)])
    weights = house.weights(stones)
    assert weights.keys() == {
        "front 1",
        "back 1",
        "left 1 pier 1",
        "left 1 pier 2",
        "right 1 pier 1",
        "right 1 pier 2",
    }
    for n in (1, 2):
        assert weights[f"left 1 pier {n}"] == approx(weights[f"right 1 pier {n}"])
    z = house.heights[0]
    wall = sum(
        bricks.Bricks([b]).volume for b in house if b.part.startswith("left") and b.middle[2] > z
    )
    floor = 400 * 4.0 * 3.2 / 2
    both = weights["left 1 pier 1"] + weights["left 1 pier 2"]
    assert both == approx((2000 * wall + floor) * 9.81e-3)


@mark.parametrize("off", [(0.05, 0), (0, -0.05), (0.05, 0.05)])
def test_the_mass_of_a_floor_is_off_its_middle(off):
    house, stones = built([{}], eccentricity=off)
    parts = [b for b in house if b.part.startswith(("floor", "ballast"))]
    masses = np.array([stones.units[b.kind].density * bricks.Bricks([b]).volume for b in parts])
    middles = np.array([b.middle[:2] for b in parts])
    assert masses.sum() == approx(400 * 4.0 * 3.2)
    assert masses @ middles / masses.sum() == approx((4.0 * (0.5 + off[0]), 3.2 * (0.5 + off[1])))
    assert not [p for p in house.problems() if "overlap" in p]


def test_openings_without_a_common_height_are_refused():
    low, high = bricks.Opening(1.0, 0, 1.2, 0.8), bricks.Opening(1.0, 1.2, 1.2, 0.8)
    with raises(ValueError, match="storey 1: no height is common"):
        bricks.House(4.0, 3.2, [bricks.Storey(2.4, front=[low], back=[high])], unit=UNIT)


@mark.parametrize("off", [0.05, -0.05])
def test_the_mass_that_is_off_the_middle_goes_to_the_nearer_wall(off):
    pairs = (built([{}], eccentricity=(e, 0)) for e in (off, 0))
    with_, without = (house.weights(stones) for house, stones in pairs)
    floor = 400 * 4.0 * 3.2 * 9.81e-3  # [kN], which spans along x
    for side, share in (("right 1", off), ("left 1", -off), ("front 1", 0), ("back 1", 0)):
        assert with_[side] - without[side] == approx(share * floor, abs=1e-6)


@mark.parametrize(
    "mass, what", [([300], "one for each of the 2"), ("300", "must be a number, or one")]
)
def test_masses_that_do_not_fit_the_floors_are_refused(mass, what):
    house, stones = built([{}, {}])
    with raises(ValueError, match=what):
        house.withFloors(stones, shear=1e6, mass=mass)
    with raises(ValueError, match="storey 3 must be at most 2"):
        house.weights(stones, 3)
