# SPDX-License-Identifier: GPL-2.0-or-later
"""The first period along a push, and what begins with it."""

from hosted import *
from masonry._masonry import saveScene
from masonry.model.period import firstPeriod
from masonry.stages import pushing
from small_wall import SMALL, carryOut, parsed

LEAN = ["--lean", "--checkpoint-every", "0"]


@mark.parametrize("scaling", [1, 25])
def test_the_period_of_a_brick_between_two_joints_is_its_closed_form(tmp_path, scaling, capsys):
    """The joints above and below it turn it by opposite moments, so it only slides."""
    size, stones = (0.5, 0.1, 0.5), materials.calciumSilicate()  # [m]
    settings = dict(density_scaling=scaling, dt_fraction=0.1)
    scene = standing(tmp_path, bricks.stack(1, size), stones, **settings)
    top = scene.platen("top", rotation="held", drive="x")
    scene.press(top, 0.5e6)
    scene.settle()
    model = scene.model
    springs = sum(i.phys.shearStiffness * sum(i.geom.areas) for i in model.interactions)
    mass = size[0] * size[1] * size[2] * model.unit.density
    expected = 2 * math.pi * math.sqrt(mass / springs)
    before = saveScene("null")
    found = firstPeriod(model, Vector3.UnitX, 0.05)
    assert found == approx(expected, rel=1e-3)
    assert saveScene("null") == before
    assert firstPeriod(model, Vector3.UnitX, 0.5 * expected) is None
    # what a user reads are true seconds
    scene.period()
    scene.push(top, 0.01, rate=1)
    scene.finish()
    run = readRun(tmp_path)
    [answer] = [a["value"] for a in run["answers"] if a["name"] == "first_period"]
    assert answer == approx(expected / scaling**0.5, rel=1e-3)
    # the drive holds the top, whose joint is one of the two springs
    assert "first period along it while the drive holds" in capsys.readouterr().out
    assert run["first_period_s"] == approx(expected / scaling**0.5, rel=1e-3)


@mark.parametrize("stage, given", [("run", [1.0]), ("shake", [[1.0, 1.0], 0.01])])
def test_what_runs_in_real_time_is_refused_with_scaled_masses(tmp_path, stage, given, capsys):
    scene = standing(tmp_path, bricks.stack(1, (0.3,) * 3), None, "--density-scaling", "4")
    with raises((Refused, SystemExit)) as end:
        getattr(scene, stage)(*given)
    said = str(end.value) + capsys.readouterr().err
    assert f"--density-scaling 4: {stage} runs in real time, with true masses" in said
    assert scene.model is None


@BLOCKS
@mark.parametrize("by", ["platen", "spring"])
def test_nothing_is_damped_unasked_beside_springs(tmp_path, blocks, by):
    """One spring sways two blocks and, with a platen, that one."""
    made = standing if by == "spring" else lean
    scene = made(
        tmp_path, bricks.stack(2, (0.4, 0.4, 0.2)), materials.calciumSilicate(), blocks=blocks
    )
    if by == "platen":
        scene.platen("bottom", springs={"x": 2e6})
    else:
        scene.spring(1, stiffness=(1e6, 0, 0))
    scene.watch(1, name="top")
    scene.settle(longest=4)
    if by == "platen":
        scene.period()
        mass = 2 * 0.4 * 0.4 * 0.2 * scene.model.unit.density
        mass += O.bodies[scene.targets["base"].body].state.mass
        expected = 2 * math.pi * math.sqrt(mass / 2e6)
        [answer] = [a["value"] for a in scene.answers if a["name"] == "first_period"]
        assert answer == approx(expected, rel=0.01)
    scene.shake([3.0] * 20, 0.005)
    damping = scene.results.column("damping_J")
    first = scene.running.state.stages[-1]["first_row"]
    assert max(scene.results.column("kinetic_J")[first:]) > 1e-6
    assert damping[-1] == approx(damping[first], abs=1e-12)


#: A clamped wall that is pushed fast begins to crack within the first quarter of its peak, and then
#: seems softer.
@mark.parametrize("turns, within", [(False, 0.08), (True, 0.05)])
def test_the_initial_stiffness_hardly_depends_on_the_rate(tmp_path, turns, within):
    found = {}
    wall = type(SMALL)(courses=12, length=1.32, loadHeight=1.1 if turns else None)
    for rate in ("20", "100"):
        words = ["--out", str(tmp_path), "--rate", rate, "--until", "1"]
        carryOut(wall, parsed(*LEAN, *words))
        found[rate] = readRun(tmp_path)
    slow, fast = found.values()
    stiffness = "initial_stiffness_kN_per_mm"
    assert fast[stiffness] == approx(slow[stiffness], rel=within)
    assert fast["first_period_s"] == slow["first_period_s"] > 0
    assert 0.6 < fast["base_weight"] < 0.8


@mark.parametrize("plane", [True, False])
def test_a_brick_that_the_drive_alone_moves_has_no_period(tmp_path, capsys, plane):
    stones = materials.dry(friction=0.6, density=2000)
    scene = standing(tmp_path, bricks.block((0, 0, 0), (0.3, 0.1, 0.2)), stones, plane=plane)
    brick = scene.handle((0.15, 0.05, 0.1))
    scene.settle()
    scene.push(brick, 1, rate=20)
    assert "no first period" in capsys.readouterr().out
    weight = 2000 * 9.81 * 0.3 * 0.1 * 0.2
    assert scene.curve()["base_shear_kN"][-1] == approx(0.6e-3 * weight, rel=0.05)  # it swings


def test_a_push_without_a_period_says_so(tmp_path, capsys):
    words = ["--out", str(tmp_path), "--rate", "100", "--until", "0.02"]
    carryOut(SMALL, parsed(*LEAN, *words))
    assert "no first period up to 0.2 ms was found" in capsys.readouterr().out
    assert readRun(tmp_path)["first_period_s"] is None


def test_the_cure_of_a_push_that_long_time_steps_brake_is_shorter_ones():
    args = lambda f: SimpleNamespace(rate=20, damping=0.8, damping_kind="combined", dt_fraction=f)
    assert "--dt-fraction 0.8 would do" in pushing.tooFast(args(0.95), 0.47)
    assert "--rate 4.3 would do" in pushing.tooFast(args(0.93), 0.47)
