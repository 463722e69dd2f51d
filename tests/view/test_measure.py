# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a crack pattern, on patterns made up so that the numbers are known."""

from usual import *
from masonry.numbers import cracks
from masonry.numbers.cracks import CRACK

COURSES, COLUMNS = 12, 12
WALL = {"unit_m": (0.22, 0.102, 0.08), "courses": COURSES, "half_units": COLUMNS}
NAMES = ("opening", "slide", "shear", "crushing", "past")
WIDE = 10 * CRACK


def blank():
    """A wall without a crack: bed and upright joints."""
    return (
        {name: np.zeros((COURSES - 1, COLUMNS)) for name in NAMES},
        {name: np.zeros((COURSES, COLUMNS - 1)) for name in NAMES},
    )


def stair(bed, upright, lines, shift=0):
    """A stepped crack that falls to the right by a half unit a course, through the upright joints
    ``lines``."""
    for line in lines:
        course = COURSES - 2 - line - shift
        upright["opening"][course, line] = WIDE
        if line + 1 in lines:
            bed["slide"][course - 1, line + 1] = WIDE
            bed["shear"][course - 1, line + 1] = 1.0


def test_an_uncracked_wall_has_no_pattern():
    bed, upright = blank()
    numbers = cracks.diagonal(bed, upright) | cracks.flexure(bed)
    numbers |= cracks.crushing(bed)
    assert "diagonal_band_courses" not in numbers
    assert 0.3 < numbers.pop("diagonal_joint_share") < 0.6
    assert numbers.pop("flexural_course_base") == 1
    assert numbers.pop("flexural_course_top") == 1
    assert set(numbers.values()) == {0}


def test_a_stepped_crack_reaches_as_far_as_it_steps():
    bed, upright = blank()
    stair(bed, upright, range(0, 11))
    numbers = cracks.diagonal(bed, upright)
    assert numbers["diagonal_reach"] == 10
    assert numbers["diagonal_energy_share"] == 1
    assert numbers["diagonal_band_courses"] == approx(0, abs=1e-12)
    assert numbers["parallel_cracks"] == 1
    # a gap in the crack ends its reach
    bed["slide"][COURSES - 3 - 6, 7] = 0  # between the uprights of lines 6 and 7
    assert cracks.diagonal(bed, upright)["diagonal_reach"] == 6


def test_parallel_cracks_are_counted():
    bed, upright = blank()
    stair(bed, upright, range(0, 8))
    stair(bed, upright, range(0, 8), shift=3)
    numbers = cracks.diagonal(bed, upright)
    assert numbers["diagonal_reach"] == 7
    inner = upright["opening"][2:-2] > 0
    assert numbers["parallel_cracks"] == approx(inner.sum() / len(inner))
    assert numbers["parallel_cracks"] > 1.4


def test_the_narrowest_band_holds_its_share():
    positions, weights = np.array([6.0, 0, 3, 4, 6]), np.array([1.0, 2, 1, 1, 1])
    assert cracks.narrowestBand(positions, weights, share=1 / 3) == 0
    assert cracks.narrowestBand(positions, weights) == 2  # from 4 to 6
    assert cracks.narrowestBand(positions, weights, share=1) == 6


def test_other_cracks_do_not_reach():
    bed, upright = blank()
    bed["slide"][5] = WIDE  # a bed joint slid from side to side
    assert cracks.diagonal(bed, upright)["diagonal_reach"] == 0
    upright["opening"][:, 4] = WIDE  # and a vertical split
    assert cracks.diagonal(bed, upright)["diagonal_reach"] == 0
    bed, upright = blank()
    for line in range(11):  # a stair that rises to the right
        upright["opening"][line, line] = WIDE
        bed["slide"][line, line] = WIDE
    assert cracks.diagonal(bed, upright)["diagonal_reach"] == 0
    # but a crack may follow a bed joint on its way
    bed, upright = blank()
    upright["opening"][7:10, 2] = WIDE
    upright["opening"][4:7, 8] = WIDE
    bed["slide"][6, 3:9] = WIDE
    assert cracks.diagonal(bed, upright)["diagonal_reach"] == 5  # of 6 half units


def test_flexural_cracks_are_counted_at_the_sides():
    bed, _ = blank()
    bed["opening"][0, :8] = 3e-3
    bed["opening"][3, :2] = WIDE
    bed["opening"][4, 3:9] = WIDE  # does not come out at a side
    bed["opening"][-2, -4:] = 1e-3
    numbers = cracks.flexure(bed)
    for end, found in (("base", (2, 3, 1)), ("top", (1, 1, 2))):
        names = f"cracks_{end} opening_{end}_mm course_{end}".split()
        assert [numbers[f"flexural_{n}"] for n in names] == approx(found)


@mark.filterwarnings("error")
@mark.parametrize("courses", range(1, 6))
def test_a_low_wall_has_the_numbers_of_the_joints_that_it_has(courses):
    bed, upright = (
        {n: v[: courses - k] for n, v in part.items()} for part, k in zip(blank(), (1, 0))
    )
    bed["beds"] = {name: np.zeros((courses + 1, COLUMNS)) for name in NAMES}
    bed["shear"][:], upright["opening"][:, 4:6] = 1, WIDE
    found = cracks.patternNumbers(bed, upright)
    assert all(map(math.isfinite, found.values()))
    # bed joints are two courses from base and top in four, a course is in five
    inner = {n for n in found if n.startswith("diagonal_")} - {"diagonal_reach"}
    assert len(inner) == (3 if courses > 3 else 0)
    assert found.get("parallel_cracks") == (2 if courses > 4 else None)
    assert found["flexural_opening_base_mm"] == 0
    assert cracks.failureMode(found, {**WALL, "courses": courses}) == "none"


def test_crushing_is_shared_by_the_corners():
    bed, _ = blank()
    bed["crushing"][0, -1] = 3e-6
    bed["crushing"][-1, 0] = 1e-6
    bed["past"][0, -1] = 112e-4
    numbers = cracks.crushing(bed)
    assert numbers["crushed_volume_cm3"] == approx(4)
    assert numbers["crushed_share_toe"] == approx(0.75)
    assert numbers["crushed_share_top_left"] == approx(0.25)
    assert numbers["past_peak_area_cm2"] == approx(112)


def test_joints_of_a_frame_find_their_place():
    # two subcontacts of the bed joint above course 2, column 5, one of the upright joint of course
    # 2 at line 5, and one of the support, below a brick of two half units from column 5 on
    points, cells = [], []
    half, height = 0.11, 0.08
    for x, z in ((5.25, 3.0), (5.75, 3.0), (6.0, 2.5), (6.0, 0.0)):
        cells.append([len(points)])
        points.append((x * half, 0.05, z * height))
    frame = {
        "points": np.array(points),
        "cells": cells,
        "bodies": np.array([[3, 8], [3, 8], [3, 4], [0, 1]]),
        "area": np.array([2e-3, 6e-3, 4e-3, 2 * 0.11 * 0.102]),
        "normal": np.array([(0, 0, 1.0), (0, 0, 1.0), (1.0, 0, 0), (0, 0, 1.0)]),
        "opening": np.array([1e-3, 2e-3, 5e-3, 0]),
        "slide": np.array([(1e-3, 0, 0)] * 4),
        "crushing": np.array([1e-3, 0, 0, 0]),
        "damage_compression": np.array([0, 0.5, 0, 0]),
        "joint_dissipated": np.array([(0, 7.0, 0)] * 2 + [(0, 9.0, 0), (0, 1.0, 0)]),
    }
    bed, upright = cracks.layOut(frame, WALL)
    assert bed["opening"][2, 5] == approx(1.75e-3)
    assert bed["slide"][2, 5] == approx(1e-3)
    assert bed["shear"].sum() == bed["shear"][2, 5] == 7  # once a joint; no support
    beds = bed["beds"]
    assert beds["shear"][3, 5] == 7 and beds["shear"].sum() == 8
    assert list(np.flatnonzero(beds["slide"][0])) == [5, 6]
    assert list(beds["shear"][0, 5:7]) == [0.5, 0.5]
    assert bed["crushing"][2, 5] == approx(2e-6)
    assert bed["past"][2, 5] == approx(6e-3)
    assert upright["opening"].sum() == upright["opening"][2, 5] == 5e-3
    assert upright["shear"][2, 5] == 9


def test_heights_above_the_diagonal_vanish_on_it():
    bed = cracks.acrossDiagonal((COURSES - 1, COLUMNS), upright=False)
    for column in range(3, 9):
        assert bed[COURSES - 2 - column, column] == approx(-0.5)
    upright = cracks.acrossDiagonal((COURSES, COLUMNS - 1), upright=True)
    assert upright[5, 5] == approx(-0.5)
    assert np.isnan(bed[0]).all() and np.isnan(upright[:2]).all()


#: Numbers of a wall of which nothing is cracked.
WHOLE = dict.fromkeys(
    "slid_share slid_mm sliding_energy_share diagonal_reach past_peak_area_cm2 flexural_cracks_base"
    " flexural_cracks_top flexural_opening_base_mm flexural_opening_top_mm".split(),
    0,
)
SLID = {"slid_share": 1.0, "slid_mm": 5.0, "sliding_energy_share": 0.8}
LEANS = {"flexural_cracks_base": 2, "flexural_opening_base_mm": 6.0}


@mark.parametrize(
    "found, mode",
    [
        ({}, "none"),
        ({"lost": True}, "other"),  # it has lost force by what is not known here
        (LEANS, "rocking"),
        ({**LEANS, "past_peak_area_cm2": 200}, "toe crushing"),
        ({**LEANS, "past_peak_area_cm2": 100}, "rocking"),  # less than half a unit
        ({**LEANS, "diagonal_reach": 5}, "diagonal cracking"),
        (SLID, "bed sliding"),
        ({**SLID, "diagonal_reach": 10}, "bed sliding"),
        ({**SLID, "slid_share": 0.8}, "partial cracking"),
        ({**SLID, "sliding_energy_share": 0.4}, "partial cracking"),
        ({**SLID, "slid_share": 0.8, **LEANS, "slid_mm": 7.0}, "partial cracking"),
        # a wall that rocks on a bed joint slides along all of it, too, but opens it by far more
        ({**SLID, **LEANS}, "rocking"),
    ],
)
def test_a_failure_mode_is_the_first_that_applies(found, mode):
    wall = {"courses": 10, "half_units": 36, "unit_m": (0.22, 0.102, 0.081)}
    lost = found.get("lost", False)
    assert cracks.failureMode({**WHOLE, **found}, wall, lost=lost) == mode
