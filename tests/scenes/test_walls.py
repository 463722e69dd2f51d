# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls as a user runs them: quick variants of the scenes, what they leave behind, and how they
end."""

from hosted import *
import glob
import masonry
from masonry.numbers.frames import readFrame
from masonry.run import readings, results
from masonry.scene import options
from masonry.stages import rest
from small_wall import SMALL, carryOut, parsed, settled

ENERGY_IN = "external_J", "gravity_J", "refining_J"
ENERGY_OUT = "kinetic_J", "damping_J", "impacts_J"


@pytest.fixture(scope="module")
def squat(tmp_path_factory):
    """COMP-4 pushed past its peak, twice as fast as the default."""
    out = str(tmp_path_factory.mktemp("squat"))
    runProgram("wall_comp4", "--until", 4, "--rate", 40, "--out", out, cwd="/")
    return out


def test_the_squat_wall_peaks_between_friction_and_the_cracked_section(squat):
    run = readRun(squat)
    # validation/README.md, for 3.96 of 4.00 m.
    assert 92.0 * 0.99 <= run["peak_base_shear_kN"] <= 130.6 * 0.99
    assert 1 < run["displacement_at_peak_mm"] < 4
    counts = [run[n] for n in ("units", "joint_count", "subcontacts")]
    assert counts == [1224, 2450, 7350]
    kinds = dict(bed=1188, head=595, crack=595, support=72)
    assert run["joints_by_kind"] == kinds
    assert run["energy_balance_error"] < 1e-6


def documented():
    """The keys of run.json that the docstring of the module results lists."""
    return set(re.findall(r"``(\w+)``", results.__doc__))


def test_the_squat_wall_leaves_what_is_promised(squat):
    promised = "curve.csv run.json blocks.pvd joints.pvd curve.png cracks.png"
    assert {*promised.split()} <= {*os.listdir(squat)}
    for picture in ("curve.png", "cracks.png"):
        assert os.path.getsize(os.path.join(squat, picture)) > 10000
    run = readRun(squat)
    assert not set(run) - documented()
    promised = (
        "peak_base_shear_kN displacement_at_peak_mm base_shear_end_kN initial_stiffness_kN_per_mm"
        " wall_clock_s "
    )
    promised += (
        "microseconds_per_step nanoseconds_per_subcontact_step energy_balance_error commit versions"
        " time_step_s "
    )
    promised += "time_step_limit_s steps options joints columns"
    assert {*promised.split()} <= {*run}
    assert run["versions"]["masonry"] == masonry.__version__
    assert run["commit"] == masonry.commit
    stages = {stage["stage"]: stage["steps"] for stage in run["stages"]}
    assert list(stages) == ["settle", "push"] and sum(stages.values()) == run["steps"]
    curve = arrays(squat)
    assert list(run["columns"]) == list(curve)
    assert {"time_s", "displacement_mm", "base_shear_kN", "vertical_mm"} <= set(curve)
    # At least one row every 0.02 mm.
    assert 0.005 < np.max(np.diff(curve["displacement_mm"])) <= 0.02
    total = lambda columns: sum(curve[c] for c in columns)
    stored = [c for c in curve if c.startswith(("elastic_", "dissipated_"))]
    assert np.allclose(total(ENERGY_IN), total(ENERGY_OUT) + total(stored), rtol=1e-6)


def test_frames_show_units_and_subcontacts_with_their_state(squat):
    for pattern in ("blocks_*.vtu", "joints_*.vtp"):
        assert len(glob.glob(os.path.join(squat, pattern))) == 5
    blocks, joints = readFrame(squat, "blocks"), readFrame(squat, "joints")
    assert len(blocks["cells"]) == 1226
    assert len(joints["cells"]) > 7350  # three a joint, more where it yields
    assert blocks["displacement"][:, 0].max() == approx(4e-3, rel=0.02)
    # No displacement out of the plane of the wall.
    assert np.abs(blocks["displacement"][:, 1]).max() < 1e-12
    area = 35 * 3.96 * 0.102 + 34 * 35 * 0.081 * 0.102
    assert joints["area"].sum() == approx(area, rel=2**-24)  # frames have seven digits
    for name, values in joints.items():
        assert name == "cells" or np.all(np.isfinite(values)), name
    assert set(np.unique(joints["regime"])) <= {0, 1, 2, 3}
    assert set(readRun(squat)["kinds"]) == {"support", "bed", "head", "crack"}


def test_deformable_units_carry_the_weight_and_keep_the_balance(tmp_path):
    run, model, top = settled(tmp_path, "--blocks", "deformable", "--until", "0.3")
    weight = 6 * 3 * 0.22 * 0.102 * 0.081 * 1800 * 9.81
    load = 0.5e6 * 0.66 * 0.102 + weight
    carried = O.forces.f(model.description.targets["base"].body, True)[2]
    assert carried == approx(-load, rel=rest.REST)
    run.push(top)
    assert max(run.results.column("base_shear_kN")) > 5
    assert model.energy.largestError < 1e-3


@mark.parametrize("blocks", ["rigid", "deformable"])
def test_density_scaling_is_another_rate(tmp_path, blocks):
    """Four times the mass at half the rate: the same run in twice the time, bit for bit, as these
    are powers of two."""
    curves = []
    for scaling, rate in ((1, 40), (4, 20)):
        words = f"--density-scaling {scaling} --rate {rate} --until 0.3"
        run, _, top = settled(tmp_path, "--blocks", blocks, *words.split())
        run.push(top)
        curves.append(run.results.column)
    one, other = curves
    assert len(one("time_s")) > 20
    assert other("time_s") == approx([2 * t for t in one("time_s")], rel=1e-9)
    for name in ("displacement_mm", "base_shear_kN", "dissipated_shear_J"):
        assert one(name) == other(name)


@mark.parametrize(
    "name, scene, note",
    [("fast", "wall_comp1", "of 44 walls"), ("accurate", "wall_dry", "without a promise")],
)
def test_a_preset_runs_and_says_what_it_promises(runScene, name, scene, note):
    process, out = runScene(scene, "--preset", name, "--until", "0.3", "--no-vtk")
    run = readRun(out)
    assert run["preset"]["name"] == name
    assert len(re.findall(f"preset {name}:? {note}", process.stdout)) == 2
    chosen = options.PRESETS[name]
    assert {option: run["options"][option] for option in chosen} == chosen


@mark.parametrize(
    "words, cure",
    [
        ("--until 10 --rate 800", "--rate"),
        ("--until 10 --damping-kind local --rate 100", "--damping-kind"),
        ("--until 3 --blocks deformable --damping-kind local", "--damping-kind"),
    ],
)
def test_a_push_that_is_too_fast_says_so_and_what_would_do(runScene, words, cure):
    words = ["--no-vtk", *words.split()]
    process, out = runScene("wall_comp1", *words)
    assert readRun(out)["too_fast"] and readRun(out)["dynamic_imbalance"] > 0.1
    slower = re.search("the push is too fast.*; (.*) would do", process.stdout)[1]
    assert slower.startswith(cure)
    process, out = runScene("wall_comp1", *words, *slower.split())
    assert not readRun(out)["too_fast"] and "too fast" not in process.stdout


def test_a_reading_that_is_not_finite_ends_the_run(tmp_path, monkeypatch):
    read, count = readings.Reading, [20]

    def broken(model):
        count[0] -= 1
        reading = read(model)
        if not count[0]:
            reading.up = float("nan")
        return reading

    monkeypatch.setattr(readings, "Reading", broken)
    with raises(FloatingPointError, match="finite numbers in vertical_mm"):
        carryOut(SMALL, parsed("--no-vtk", "--until", "0.5", "--out", str(tmp_path)))
    assert len(readCurve(tmp_path)["time_s"]) == 19
    assert "finite numbers in vertical_mm" in readRun(tmp_path)["error"]
    assert (tmp_path / "curve.png").exists()
