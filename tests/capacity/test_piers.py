# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of piers and spandrels by codes, against numbers by hand."""

from usual import *
from dataclasses import replace
from made_runs import writeRun
from masonry_capacity import piers

PUSH = {"stage": "push", "first_row": 0, "load": ["push", "top along x", ""]}
HEADS = ["time_s", "displacement_mm", "base_shear_kN", "top_shear_kN"]
COLUMNS = {"N": "a_N_kN", "V": "a_V_x_kN", "M": "a_M_y_kNm", "drift": "a_drift_x_mrad"}
box = lambda *high: {"low_m": [0.0, 0.0, 0.0], "high_m": [*high]}
PIER = {"name": "a", "kind": "pier", **box(1.0, 0.2, 1.5), **COLUMNS}
#: 1.5 m long and 1 m deep.
SPANDREL = {"name": "a", "kind": "spandrel", **box(1.5, 0.2, 1.0), **COLUMNS}
BED = {"compressiveStrength": 5e6, "cohesion": 0.2e6, "cap": True}


def made(folder, normal=-100.0, moment=5.0, **entries):
    """A run of a pier of 1 × 0.2 × 1.5 m under 100 kN, pushed with up to 20 kN."""
    row = lambda x: [x, x, 20 * x, 20 * x, normal, 20 * x, moment * x, 4 * x]
    entries = {"piers": [PIER], "joints": {"bed": BED}, "stages": [PUSH], **entries}
    return writeRun(folder, [*HEADS, *COLUMNS.values()], map(row, (0, 0.5, 1)), **entries)


def test_a_pier_has_the_strength_and_the_drift_of_hand_calculation(tmp_path):
    """H0 = 5/20 + 0.75 = 1 m, σ0 = 0.5 MPa, ν = 0.1, D' = 3 (0.5 - 20/100) = 0.9 m. Flexure: 50 kN
    (1 - 1.15 ν) and 50 kN (1 - ν/0.85); sliding (60 + 40)/2.2 = 45.45 kN."""
    one, other = piers.check(made(tmp_path, failure_mode="diagonal cracking"))
    assert (one["H0_m"], one["nu"], one["D_m"]) == approx((1.0, 0.1, 0.9))
    assert (one["failure"], one["clause"]) == ("flexure", "EN 1998-3 C.4.2.1")
    assert one["capacity_kN"] == approx(44.25)
    assert other["capacity_kN"] == approx(50 * (1 - 0.1 / 0.85))
    assert one["demand_over_capacity"] == approx(20 / 44.25)
    # 4 mrad; near collapse 4/3 of 0.8 % H0/L, and 1 %
    assert one["drift_over_capacity"] == approx(0.4 / (0.8 * 4 / 3))
    assert other["drift_over_capacity"] == approx(0.4)
    assert one["otherwise"] == other["otherwise"] == "*"
    *_, row = piers.check(made(tmp_path, failure_mode="rocking"))
    assert row["otherwise"] == ""


def test_a_short_span_slides_and_irregular_masonry_cracks_along_its_diagonal(tmp_path):
    """H0 = 0.75 m: sliding 100/(1 + 0.9) = 52.6 kN before flexure of 59 kN; with tau0 Turnšek and
    Čačovič, 0.2 m² ft/1.5 √(1 + 0.5/ft), ft = 0.09 MPa."""
    folder = made(tmp_path, moment=0.0)
    one, _ = piers.check(folder)
    assert (one["failure"], one["capacity_kN"]) == ("sliding", approx(100 / 1.9))
    assert one["clause"] == "EN 1998-3 C.4.3.1"
    _, row = piers.check(folder, tau0=0.06)
    assert row["failure"] == "shear"
    assert row["capacity_kN"] == approx(0.2e3 * 0.09 / 1.5 * math.sqrt(1 + 0.5 / 0.09))


#: 1.2 m high, 1 m long, 0.2 m thick, under 100 kN: σ0 = 0.5 MPa, b = 1.2.
SQUAT = piers.Pier(1200, 1000, 200, 250, 100e3, 5.0, 10.0, 0.06, 0.1, 1.0)


@mark.parametrize(
    "strength, newtons",
    [
        # the whole base is compressed: 0.1 · 0.2e6 + 0.4 · 100e3
        (lambda: piers.alongBed(SQUAT, 0.1, 0.4), 60e3),
        (lambda: piers.diagonal(SQUAT, 0.09), 0.2e6 * 0.09 / 1.2 * math.sqrt(1 + 0.5 / 0.09)),
        (lambda: piers.stepped(SQUAT, 0.1), 0.2e6 / 1.2 * (0.1 + 0.577 * 0.5) / 1.577),
        # cracks through units of 1 MPa: ft = 0.1 MPa
        (
            lambda: piers.stepped(replace(SQUAT, unit=1.0), 0.1),
            0.2e6 * 0.1 / 1.2 * math.sqrt(1 + 0.5 / 0.1) / 2.3,
        ),
    ],
)
def test_formulas_are_those_of_the_codes(strength, newtons):
    assert strength() == approx(newtons, rel=1e-3)


@mark.parametrize(
    "code, unit, failure, numbers",
    [
        # flexure of 177 kN, units of 98.7 kN
        (piers.EN, 10.0, "sliding", (60, 4 / 3 * 0.4)),
        # 0.065 · 1 MPa on the whole base
        (piers.EN, 1.0, "shear", (13, 4 / 3 * 0.4)),
        # in steps, as above
        (piers.NTC, 10.0, "shear", (41.059, 0.5)),
        (piers.NTC, 1.0, "shear", (17.750, 0.5)),
    ],
)
def test_the_smallest_strength_has_its_drift(code, unit, failure, numbers):
    found = piers.CODES[code](replace(SQUAT, unit=unit))
    assert found.failure == failure
    assert (found.peak, found.drift) == approx(numbers, rel=1e-4)


@mark.parametrize(
    "normal, tie, capacities, clause",
    [
        # fh = 2.5 MPa, σ0 = 0.5, H0 = 1 m: 50 kN (1 - 1.15/5), and 50 kN (1 - 1/5/0.85)
        (-100, None, (38.5, 50 * (1 - 0.2 / 0.85)), "NTC 7.8.2.2.1 by 7.8.2.2.4"),
        (3, None, (0, 0), "NTC 7.8.2.2.1 by 7.8.2.2.4"),
        # Hp = 60 kN: Mu = 60 · 0.5 (1 - 60/(0.85 · 500)) = 25.76 kN m, Vp = 2 Mu/1.5
        (3, 60, (0, 34.353), "NTC (7.8.6)"),
        # Hp = 0.4 · 500 kN: Vp = 2 · 100 (1 - 200/425)/1.5 = 70.6; Vt = 1 · 0.2 m² · 0.2 MPa
        (-100, 900, (38.5, 40), "NTC (7.8.4)"),
    ],
)
def test_a_spandrel_is_checked_as_a_pier_on_its_side_or_by_its_tie(
    tmp_path, normal, tie, capacities, clause
):
    rows = piers.check(made(tmp_path, normal, piers=[SPANDREL]), tie=tie)
    assert [row["capacity_kN"] for row in rows] == approx(capacities, rel=1e-4)
    assert rows[0]["clause"] == "EN 1998-3 C.4.2.1 as a pier"
    assert rows[1]["clause"] == clause
    assert rows[0]["H0_m"] == approx(1.0)
    assert rows[0]["nu"] == approx(-normal / 500)
    assert {row["drift_over_capacity"] for row in rows} == {""}


def joints(kind, *widths):
    """Joints of a box of 1 × 0.2 × 1 m: three beds of two joints, and a head joint between them,
    with opening and slide [mm] of foot, middle and head, and of the head joint."""
    beds = [(x, z, 2, width) for z, width in zip((0, 0.5, 1), widths) for x in (0.25, 0.75)]
    rows = [*beds, (0.5, 0.75, 0, widths[3])]
    flip = lambda x, z: (x, z) if kind == "pier" else (z, x)
    places = [flip(x, z) for x, z, *_ in rows]
    axes = [axis if kind == "pier" else 2 - axis for *_, axis, _ in rows]
    return {
        "bodies": np.array([[n, n + 1] for n in range(len(rows))]),
        "area": np.full(len(rows), 0.1),
        "points": np.array([[x, 0.1, z] for x, z in places]),
        "cells": [np.array([n]) for n in range(len(rows))],
        "normal": np.eye(3)[axes],
        "opening": np.array([1e-3 * width[0] for *_, width in rows]),
        "slide": np.array([[1e-3 * width[1], 0, 0] for *_, width in rows]),
        "damage_compression": np.array([float(len(width) > 2) for *_, width in rows]),
    }


NOT = (0.0, 0.0)


@mark.parametrize("kind, axis", [("pier", 2), ("spandrel", 0)])
@mark.parametrize(
    "widths, mode",
    [
        ((NOT, NOT, NOT, (0.04, 0)), "none"),
        (((2, 0.1), NOT, (1, 0), (0.5, 0)), "rocking"),
        (((2, 0.1), NOT, (1, 0, "crushed"), (0.5, 0)), "toe crushing"),
        ((NOT, (0.2, 3), NOT, (3.1, 0)), "diagonal cracking"),
        (((0.1, 0), (0.2, 3), NOT, (0.1, 0)), "bed sliding"),
    ],
)
def test_the_widest_joints_say_how_a_pier_or_a_spandrel_gives_way(kind, axis, widths, mode):
    found = piers.failureOf(joints(kind, *widths), np.zeros(3), np.array([1, 0.2, 1]), axis)
    assert found == ("rocking" if kind == "spandrel" and mode == "bed sliding" else mode)


def test_the_table_is_a_file_and_what_cannot_be_checked_is_refused(tmp_path, capsys):
    assert piers.main([made(tmp_path), "--fm", "10", "--fb", "20"]) == 0
    with open(tmp_path / "piers.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["nu"] for row in rows] == ["0.05", "0.05"]
    assert "EN 1998-3:2005" in capsys.readouterr().out
    for entries, message in (
        ({"piers": []}, "names no piers"),
        ({"normal": 3.0}, "pier a has no compression"),
        ({"joints": {"bed": {**BED, "cap": False}}}, "give fm"),
    ):
        with raises(Refused, match=message):
            piers.check(made(tmp_path, **entries))
