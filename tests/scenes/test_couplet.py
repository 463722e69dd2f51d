# SPDX-License-Identifier: GPL-2.0-or-later
"""Two bricks through the whole of the host against the closed forms of the law, with both block
models."""

from hosted import *
from scipy.integrate import trapezoid


@pytest.fixture(params=["rigid", "deformable"])
def couplet(request, runScene):
    """Runs a path with its options, whose energy balance must close; returns the curve and the
    run."""

    def couplet(path, *options):
        words = ("--path", path, "--blocks", request.param, "--no-vtk", *options)
        _, out = runScene("couplet", *words)
        run = readRun(out)
        # zones in turning axes: 1e-3, as walls
        assert run["energy_balance_error"] < (1e-6 if request.param == "rigid" else 1e-3)
        return arrays(out), run

    return couplet


@mark.parametrize(
    "words, numbers",
    [
        # Rigid units give back what they held at the peak (law/README.md, rigid units).
        (
            "opening --until 3 --rate 40",
            dict(
                end_normal_stress_MPa=approx(0, abs=1e-6),
                dissipated_tension_J_per_m2=approx(16, rel=0.002),
            ),
        ),
        ("opening --until 0.01", dict(peak_normal_stress_MPa=approx(0.1, rel=0.005))),
        (
            "shear --joints brittle --until 0.1",
            dict(end_shear_stress_MPa=approx(0.215, rel=0.002)),
        ),
    ],
)
def test_numbers_of_a_path_are_those_of_the_law(couplet, words, numbers):
    _, run = couplet(*words.split())
    assert {name: run[name] for name in numbers} == numbers
    if "brittle" in words:  # the stress drops at once
        assert run["dissipated_shear_J_per_m2"] < 0.25e6 * 0.1e-3


@mark.parametrize("stress", [-0.1, -0.5, -1.0])
def test_shear_peaks_on_the_coulomb_line_and_keeps_friction(couplet, stress):
    # at 100 mm/s the first wave through the bricks adds 1 % to the peak
    words = f"--normal-stress {stress} --until 60 --rate 50"
    curve, run = couplet("shear", *words.split())
    peak, residual = 0.11 - 0.43 * stress, -0.43 * stress
    assert run["peak_shear_stress_MPa"] == approx(peak, rel=0.005)
    assert run["end_shear_stress_MPa"] == approx(residual, rel=0.005)
    above = 1e3 * trapezoid(curve["shear_stress_MPa"] - residual, curve["slide_mm"])
    above += 1e6 * residual**2 / 2 / 2.17e10  # J/m²
    assert above == approx(160 * peak / 0.11, rel=0.02)
    assert np.allclose(curve["normal_stress_MPa"][-1000:], stress, rtol=1e-3)


def test_closure_peaks_at_fc_and_ends_at_the_residual(couplet):
    curve, run = couplet("closure", "--until", "12", "--rate", "40")
    assert run["peak_compressive_stress_MPa"] == approx(7.55, rel=0.002)
    assert run["end_normal_stress_MPa"] == approx(-1.51, rel=0.02)
    work = trapezoid(curve["normal_force_kN"], curve["opening_mm"])
    ends = [curve[f"{part}_compression_J"][-1] for part in ("dissipated", "elastic")]
    assert sum(ends) == approx(work, rel=0.01)


def test_shear_after_closure_stays_inside_the_cap(couplet):
    curve, run = couplet("closure-shear", "--until", "2", "--rate", "20")
    sigma, tau = curve["normal_stress_MPa"], curve["shear_stress_MPa"]
    assert np.all(np.sqrt(sigma**2 + 9 * tau**2) <= 7.55 * 1.001)
    assert tau.max() > 1.5


@mark.parametrize("axis", ["x", "y"])
@mark.parametrize("side", [1, -1])
def test_the_largest_shear_stress_is_that_of_the_vector_to_whichever_side(tmp_path, axis, side):
    scene = lean(
        tmp_path, bricks.stack(2, UNIT), materials.calciumSilicate(), rate=2, gravity=0, plane=False
    )
    scene.platen("bottom", height=UNIT[2])
    at = (UNIT[0] / 2, UNIT[1] / 2, 2 * UNIT[2])
    top = scene.platen("top", upTo=3 * UNIT[2], point=at, drive=f"z{axis}")
    bed = scene.joint(0, 1, name="j")
    scene.pressJoint(top, bed, -0.5e6)
    scene.drive(top, **{axis: 0.1 * side})
    scene.finish()
    run = readRun(tmp_path)
    peak = 0.11 + 0.43 * 0.5
    assert run["j_peak_shear_stress_MPa"] == approx(peak, rel=0.005)
    (answer,) = (a["value"] for a in run["answers"][-3:] if a["name"] == "j_peak_shear_stress")
    assert answer == run["j_peak_shear_stress_MPa"]
    assert run["figure"]["x"]["column"] == f"j_slide{'_across' * (axis == 'y')}_mm"
    slide = readCurve(tmp_path)[run["figure"]["x"]["column"]][-1]
    assert 0.02 < side * slide < 0.1
