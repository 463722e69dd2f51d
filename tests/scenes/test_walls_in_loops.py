# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that follow a history: where they turn, what they leave, how they collapse, and how they
are taken up again."""

from hosted import *
from masonry.numbers import drawing, loops
from masonry_view import figures, measure
from masonry.run import results
from masonry.scene import history
from masonry.stages import pushing, rest
from small_wall import SMALL, parsed
from test_checkpoints import CANTILEVER, LOOPS, PUSH, files, interrupt, refused, run
from test_checkpoints import at  # noqa: F401: a fixture


@mark.parametrize(
    "wall, words",
    [
        (SMALL, "--rate 2 --density-scaling 100"),
        (SMALL, "--rate 300"),
        (SMALL, "--rate 40 --blocks deformable"),
        (CANTILEVER, "--rate 150"),
    ],
)
def test_a_wall_turns_at_its_amplitudes_and_ends_at_zero(tmp_path, wall, words):
    words = ["--no-vtk", "--history", "0.1,0.3x2,1", *words.split()]
    assert run(tmp_path, *words, wall=wall) == 0
    moved = arrays(tmp_path)["displacement_mm"]
    turns = moved[loops.turningPoints(moved, 0.05)]
    wanted = [0, 0.1, -0.1, 0.3, -0.3, 0.3, -0.3, 1, -1, 0]
    assert turns == approx(wanted, abs=0.01)
    made = readRun(tmp_path)
    step = made["time_step_s"] * made["options"]["rate"]  # [mm]
    # rows are ROW_EVERY apart, in whole time steps
    assert np.abs(np.diff(moved)).max() <= 0.0101 + step
    assert moved[-1] == approx(0, abs=0.01)


def test_a_measured_history_with_noise_is_followed_through_its_turns(tmp_path):
    turns = [0.1, -0.05, 0.3, 0.27, 0.5, 0.1, 0.13, -0.4, -0.36, -0.5, 0.02, 0]
    points = [0.0]
    for turn in turns:
        # approached in five stretches, with a step back of 0.002 mm after each of them
        for direction in np.linspace(points[-1], turn, 6)[1:]:
            points += [direction, direction - 0.002 * np.sign(turn - points[-1])]
        points[-1] = turn
    points = np.round(points, 6)
    path = tmp_path / "measured.csv"
    path.write_text("displacement_mm\n" + "".join(f"{p}\n" for p in points))
    assert run(tmp_path, "--no-vtk", "--history", str(path), "--rate", "20") == 0
    data = arrays(tmp_path)
    moved = data["displacement_mm"]
    found = moved[loops.turningPoints(moved, 0.01)]
    assert found == approx([0, *turns], abs=0.005)
    # Every row goes to a point of the file, and the points come in turn.
    assert (data["target_mm"] == points[data["point"].astype(int) - 1]).all()
    assert data["point"][0] == 1 and data["point"][-1] >= len(points) - 1
    assert np.diff(data["point"]).min() == 0 and np.diff(data["point"]).max() < 4
    history = readRun(tmp_path)["history"]
    assert history["points"] == len(points) == 121 and history["turning_points"] > 50
    assert readRun(tmp_path)["options"]["history"] == str(path)


def test_the_velocity_changes_evenly_where_the_drive_turns(tmp_path):
    words = ["--no-vtk", "--history", "1", "--rate", "40"]
    assert run(tmp_path, *words) == 0
    data = arrays(tmp_path)
    speed = np.diff(data["displacement_mm"]) / np.diff(data["time_s"])
    assert np.abs(speed).max() < 40.1
    middle = (data["time_s"][1:] + data["time_s"][:-1]) / 2
    change = np.diff(speed) / np.diff(middle)
    start = data["time_s"][0] + 2e-3  # it begins within a first period, 1.3 ms
    change = change[middle[1:] > start]
    even = 40 / rest.RAMP  # [mm/s²]
    # A row near a turn is a step or two long, so that its speed is known less well than those of
    # others.
    assert np.percentile(np.abs(change), 99) < 1.2 * even
    assert (np.abs(change) < 1.7 * even).all()


def test_a_push_is_the_history_of_one_point(tmp_path):
    for option in ("until", "history"):
        words = ["--no-vtk", f"--{option}", "1", "--rate", "20"]
        assert run(tmp_path / option, *words) == 0
    push, loop = arrays(tmp_path / "until"), arrays(tmp_path / "history")
    # before it is at its full speed, a loop adds the velocity up, a push multiplies: equal but for
    # round-off
    rows = np.flatnonzero(push["displacement_mm"] < 1 - 20 * rest.RAMP / 2)
    assert len(rows) > 80 and set(loop) - set(push) == {"point", "target_mm"}
    for name in ("time_s", "displacement_mm", "base_shear_kN"):
        assert loop[name][rows] == approx(push[name][rows], rel=1e-6, abs=1e-6)


@pytest.fixture(scope="module")
def looped(tmp_path_factory):
    """The small wall, cracked in loops."""
    out = tmp_path_factory.mktemp("looped")
    assert run(out, "--history", "0.1,0.5x2,2", "--rate", "100") == 0
    return out


def test_run_json_tells_the_history_and_the_cycles(looped):
    text, data = readRun(looped), arrays(looped)
    assert not set(text) - set(re.findall(r"``(\w+)``", results.__doc__))
    assert text["history"]["amplitudes_mm"] == [[0.1, 1], [0.5, 2], [2.0, 1]]
    assert text["history"]["path_mm"] == approx(4 * 3.1)
    assert text["options"]["history"] == "0.1,0.5x2,2" and not text["collapsed"]
    shear = data["base_shear_kN"]
    for name, side in (("", 1), ("negative_", -1)):
        both = np.minimum(side * shear, side * data["top_shear_kN"])
        own = side * data["displacement_mm"] >= 0
        peak = side * text[f"{name}peak_at_both_ends_kN"]
        assert peak == approx(both[own].max(), rel=1e-8)
        at = np.flatnonzero(own)[both[own].argmax()]
        assert text[f"{name}peak_base_shear_kN"] == approx(shear[at], rel=1e-8)
    assert text["displacement_at_negative_peak_mm"] < 0
    answers = {one["name"]: one["value"] for one in text["answers"]}
    assert answers["negative_peak"] == text["negative_peak_at_both_ends_kN"]
    cycles = text["cycles"]
    amplitudes, works, losses = (
        [c[n] for c in cycles] for n in ("amplitude_mm", "work_J", "dissipated_J")
    )
    assert amplitudes == approx([0.1, 0.5, 0.5, 2], abs=0.01)
    whole = loops.work(data["displacement_mm"], shear)
    assert sum(works) == approx(whole, rel=0.01)
    parts = [data[f"dissipated_{m}_J"] for m in ("tension", "shear", "compression")]
    lost = sum(np.ptp(part) for part in parts)
    assert sum(losses) == approx(lost, rel=0.01)
    assert lost > 10  # it is cracked, not elastic
    assert text["energy_balance_error"] < 1e-6
    for cycle, one, other in zip(cycles, [0, 6, 9, 12], [3, 9, 12, 15]):
        rows = slice(*cycle["rows"])
        assert cycle["largest_kN"] == approx(shear[rows].max(), rel=1e-3)
        assert cycle["rows"][0] < cycle["rows"][1] < len(shear)


def test_what_the_drive_puts_into_a_cycle_is_lost_or_stored(looped):
    """The loading block of the small wall does not turn, so the drive works over the displacement
    of curve.csv."""
    text, data = readRun(looped), arrays(looped)
    vertical = 0.5e6 * SMALL.area  # [N] that the top course feels
    for cycle in text["cycles"]:
        first, last = cycle["rows"]
        grown = lambda name: data[name][last] - data[name][first]
        stored = sum(grown(n) for n in data if n.startswith("elastic_"))
        lifted = vertical * grown("vertical_mm") * 1e-3 - grown("gravity_J")
        spent = cycle["dissipated_J"] + cycle["damped_J"] + stored + lifted
        spent += grown("kinetic_J")
        assert cycle["top_work_J"] == approx(spent, rel=0.03, abs=0.05)


def test_figures_and_measures_show_both_sides(looped, monkeypatch, capsys):
    shown = []
    monkeypatch.setattr(drawing, "save", lambda figure, *_: shown.append(figure))
    figures.draw(str(looped))
    data = arrays(looped)
    top = shown[0].axes[0]
    for (low, high), name in (
        (top.get_xlim(), "displacement_mm"),
        (top.get_ylim(), "base_shear_kN"),
    ):
        assert low < data[name].min() < 0 < data[name].max() < high
    lines = {line.get_label(): line for line in top.lines}
    assert lines["envelope"].get_linewidth() > lines["supports"].get_linewidth()
    assert len(shown) == 3  # and cracks.png, mechanism.png

    numbers = measure.measure(str(looped))
    assert numbers["cycle_count"] == 4 and numbers["largest_amplitude_mm"] > 1.99
    assert 0 <= numbers["force_drop"] < 1 and 0 <= numbers["force_drop_negative"] < 1
    assert "push_work_J" not in numbers
    for name in ("diagonal_reach", "crushed_volume_cm3"):
        assert np.isfinite(numbers[name + "_mirrored"])
    mirrored = numbers["crushed_volume_cm3_mirrored"]
    assert mirrored == approx(numbers["crushed_volume_cm3"])
    measure.show(str(looped))
    table = capsys.readouterr().out.split(" cycle ")[1].splitlines()
    assert len(table) == 5 and table[4].split()[0] == "4"


def test_frames_stand_at_turning_points_and_zeros(looped):
    data = arrays(looped)
    pvd = open(os.path.join(looped, "joints.pvd")).read()
    times = [float(t) for t in re.findall(r'timestep="([^"]+)"', pvd)]
    at = np.interp(times, data["time_s"], data["displacement_mm"])
    # --vtk-every 1: the swings of 0.1 mm have no frame of their own, those of 2 mm have three a
    # side
    for place, count in ((2, 1), (-2, 1), (0, 2)):
        assert (np.abs(at - place) < 0.012).sum() >= count
    path = np.cumsum(np.abs(np.diff(data["displacement_mm"], prepend=0)))
    between = np.diff(np.interp(times, data["time_s"], path))
    assert between[:-1].min() >= 0.49 and len(times) < 20


def test_the_number_of_frames_is_bounded():
    long = parsed("--history", "10x50", "--vtk-every", "0.1")
    assert pushing.frameSpacing(long) == 2000 / pushing.FRAMES
    assert pushing.frameSpacing(parsed("--until", "1000", "--vtk-every", "0.1")) == 0.1


def test_loops_that_damping_makes_fat_are_a_warning(runScene):
    words = ["--history", "0.5", "--rate", "100", "--no-vtk"]
    process, out = runScene("wall_comp1", *words)
    assert readRun(out)["damped_share"] > 0.5
    assert "damping, not the wall, took" in process.stdout
    assert "1 cycles, peaks" in process.stdout


def test_a_loop_that_unloads_is_no_collapse_and_a_lost_side_is_one():
    at = pushing.Pushing()

    def row(moved, shear, direction):
        at.moved = moved
        # a force that stays for longer than the time over which the mean is found
        for _ in range(3):
            at.now += 1
            mean = at.note(shear, 1)
        return at.hasLost(direction, mean, shear)

    goals = history.targets([5, -5, 8, -8])
    assert not row(5, 100, 1)
    at.passOn(goals)
    assert not row(3, 1, -1) and not row(-2, -60, -1) and not row(-5, -60, -1)
    at.passOn(goals)
    assert not row(4.9, 5, 1)  # less than a fifth, but within what was reached before
    assert row(6.1, 19, 1) and not row(6.1, 21, 1)
    assert not row(5.9, 19, 1)  # not a millimetre beyond the peak
    at.moved = 8
    at.passOn(goals)
    assert not row(-4, -1, -1)
    assert row(-6.1, -11, -1) and not row(-6.1, -13, -1)


@mark.parametrize("side", [1, -1])
def test_a_wave_at_the_base_is_no_collapse(side):
    at = pushing.Pushing(moved=2.0 * side)
    assert not at.hasLost(side, -0.5 * side, -0.1 * side)  # it never carried anything
    at.peaks = (3.0, 3.0)
    # the base of a soft wall lags behind
    assert not at.hasLost(side, -0.5 * side, 1.9 * side)
    assert at.hasLost(side, -0.5 * side, -0.1 * side)


@mark.parametrize("whole, most", [(5.0, 1.0), (50.0, 5.0)])
def test_how_far_a_wall_may_move_against_its_push(whole, most):
    """A tenth of a short path would be a vibration, so it is a millimetre at least."""
    for back, retreats in ((0.98 * most, False), (1.02 * most, True)):
        assert pushing.Pushing(moved=-back).retreats(1, whole) == retreats
        assert pushing.Pushing(moved=back).retreats(-1, whole) == retreats


def test_a_wall_that_loses_its_force_in_a_loop_ends_the_run(tmp_path):
    """Without friction and with brittle bond the small wall slides on a bed joint as soon as the
    bond is gone."""
    bare = ["residualCohesion=0", "friction=0", "residualFriction=0", "tensileStrength=1e4"]
    words = [f"--set={name}.{value}" for name in ("bed", "head") for value in bare]
    words += ["--joints", "brittle", "--no-vtk", "--rate", "40"]
    assert run(tmp_path / "loop", *words, "--history", "0.02x2,3") == 0
    text = readRun(tmp_path / "loop")
    assert text["collapsed"] and text["displacement_end_mm"] < 3
    assert run(tmp_path / "back", *words, "--history", "0.02x2,0.5x3") == 0
    assert not readRun(tmp_path / "back")["collapsed"]


def test_a_finished_history_can_be_extended(tmp_path):
    words, longer = ["--rate", "40", "--no-vtk"], "0.1,0.5x1,0.6"
    assert run(tmp_path / "whole", "--history", "0.1,0.5,0.6", *words) == 0
    assert run(tmp_path / "parts", "--history", "0.1,0.5", *words) == 0
    assert run(tmp_path / "parts", "--history", longer, resume=True) == 0
    # Before 0 mm the drive does not brake for 0.6 mm yet, so that both runs are the same to the
    # last bit.
    assert files(tmp_path / "parts") == files(tmp_path / "whole")
    text = readRun(tmp_path / "parts")
    assert len(text["cycles"]) == 3 and text["options"]["history"] == longer


def test_a_file_can_be_extended_and_need_not_be_there_to_go_on(tmp_path, at):
    path = tmp_path / "h.csv"
    path.write_text("displacement_mm\n0\n0.2\n-0.1\n")
    words = ["--history", str(path), "--rate", "40", "--no-vtk"]
    assert run(tmp_path / "whole", *words) == 0
    at(70, interrupt)
    assert run(tmp_path / "out", *words) == 130
    path.unlink()
    assert run(tmp_path / "out", resume=True) == 0
    assert files(tmp_path / "out") == files(tmp_path / "whole")
    path.write_text("displacement_mm\n0\n0.2\n-0.1\n0.15\n")
    assert run(tmp_path / "out", "--history", str(path), resume=True) == 0
    moved = arrays(tmp_path / "out")["displacement_mm"]
    turns = moved[loops.turningPoints(moved, 0.01)]
    assert turns == approx([0, 0.2, -0.1, 0.15], abs=0.005)


@mark.parametrize(
    "began, words, message",
    [
        (LOOPS, "--history 0.1", "0.1,0.25x2, and another one must begin with"),
        (LOOPS, "--history 0.1,0.3x2", "must begin with all its points"),
        (LOOPS, "--until 2", "--history is 0.1,0.25x2, without --until"),
        (PUSH, "--history 0.3", "--until is 0.3, without --history"),
    ],
)
def test_another_history_is_refused(tmp_path, at, capsys, began, words, message):
    out = tmp_path / "broken"
    at(35, interrupt)
    assert run(out, *began) == 130
    assert refused(out, *words.split()) == 2
    error = capsys.readouterr().err
    assert message in error and len(error.splitlines()) == 1
