# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves as arrays with units, and the table of results."""

from usual import *
from masonry_view.notebook import Curve, resultsOf, unitOf


@mark.parametrize(
    "head, meaning, unit",
    [
        ("base_shear_kN", "force on what is held [kN]", "kN"),
        ("load_factor", "factor of the load [-]", "-"),
        ("acceleration_x_g", "horizontal acceleration [g]", "g"),
        ("drift_mm", "of the script, without a unit", "mm"),
        ("my_own", "of the script, without a unit", "-"),
        ("slope", "rise [m] over run [m/m]", "m/m"),
    ],
)
def test_a_column_has_the_unit_of_its_meaning_or_of_its_name(head, meaning, unit):
    assert unitOf(head, meaning) == unit


def test_a_curve_is_arrays_by_name():
    curve = Curve({"time_s": [0, 0.5, 1], "top_mm": [0, 1, -2]}, {"time_s": "time [s]"})
    assert list(curve) == ["time_s", "top_mm"] and len(curve) == 3 and "top_mm" in curve
    assert curve["top_mm"].dtype == float and np.abs(curve["top_mm"]).max() == 2
    assert curve.units == {"time_s": "s", "top_mm": "mm"}
    with raises(KeyError, match="no column 'top', did you mean 'top_mm'"):
        curve["top"]
    page = curve._repr_html_()
    for text in ("3 rows, 2 columns", "<th", ">time_s<", ">-2<", ">0.5<"):
        assert (text in page) == (text != ">0.5<"), text


def test_results_that_were_not_found_are_not_shown():
    answers = [
        dict(stage="tilt", name="factor_held", unit="-", value=None, uncertainty=None),
        dict(stage="push", name="peak", unit="kN", value=12.345, uncertainty=0.5),
        dict(stage="tilt", name="displacement_held", unit="mm", value=1.0, uncertainty=None),
    ]
    run = dict(answers=answers, steps=7, largest_crack_mm=None, bound_acceleration=float("nan"))
    assert resultsOf(run) == [
        ("tilt: factor held", "not found", ""),
        ("push: peak", "12.35 ± 0.5", "kN"),
        ("time steps", "7", ""),
    ]
