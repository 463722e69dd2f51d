# SPDX-License-Identifier: GPL-2.0-or-later
"""The first period along a push, and what begins with it."""

from hosted import *
from masonry._masonry import saveScene
from masonry.model.period import firstPeriod
from masonry.stages import pushing
from small_wall import SMALL, carryOut, parsed

LEAN = ["--lean", "--checkpoint-every", "0"]


@mark.parametrize("scaling", [1, 25])
def test_the_period_of_a_brick_between_two_joints_is_its_closed_form(tmp_path, scaling):
    """The joints above and below it turn it by opposite moments, so it only slides."""
    size, stones = (0.5, 0.1, 0.5), materials.calciumSilicate()  # [m]
    scene = standing(tmp_path, bricks.stack(1, size), stones, density_scaling=scaling)
    top = scene.platen("top", rotation="held", drive="x")
    scene.press(top, 0.5e6)
    scene.settle()
    model = scene.model
    springs = sum(i.phys.shearStiffness * sum(i.geom.areas) for i in model.interactions)
    mass = size[0] * size[1] * size[2] * model.unit.density
    expected = 2 * math.pi * math.sqrt(mass / springs)
    model.scheme.chooseTimeStep(0.2 * model.scheme.limit)
    before = saveScene("null")
    found = firstPeriod(model, Vector3.UnitX, 0.05)
    assert found == approx(expected, rel=0.003)
    assert saveScene("null") == before
    assert firstPeriod(model, Vector3.UnitX, 0.5 * expected) is None


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


def test_a_push_without_a_period_says_so(tmp_path, capsys):
    words = ["--out", str(tmp_path), "--rate", "100", "--until", "0.02"]
    carryOut(SMALL, parsed(*LEAN, *words))
    assert "no first period up to 0.2 ms was found" in capsys.readouterr().out
    assert readRun(tmp_path)["first_period_s"] is None


def test_the_cure_of_a_push_that_long_time_steps_brake_is_shorter_ones():
    args = lambda f: SimpleNamespace(rate=20, damping=0.8, damping_kind="combined", dt_fraction=f)
    assert "--dt-fraction 0.8 would do" in pushing.tooFast(args(0.95), 0.47)
    assert "--rate 4.3 would do" in pushing.tooFast(args(0.93), 0.47)
