# SPDX-License-Identifier: GPL-2.0-or-later
"""Records one after the other on one structure: what remains after each, by hand, and a run that is
stopped within one."""

from hosted import *
import stopped

FRICTION, STIFFNESS, DENSITY = 0.3, 1e9, 2000.0  # [-], [Pa/m] along the joint, [kg/m³]
SIDE, HIGH = 1.0, 0.2  # [m]
PULSE, LAST = 6.0, 0.1  # [m/s²], [s]
EVERY = 0.002


def pulse():
    """A ground acceleration that begins and ends at once, before and after which nothing moves."""
    return [0.0] * 5 + [PULSE] * round(LAST / EVERY) + [0.0] * 75


def slip(a):
    """How far a block slides on its base [mm]: v = (a - μ g) T, which μ g brakes."""
    braked = FRICTION * G
    return 1e3 * 0.5 * (a - braked) * LAST**2 * a / braked


SCRIPT = f"""
stone = materials.dry(friction={FRICTION}, normalStiffness=1e11, shearStiffness={STIFFNESS},
    density={DENSITY})
scene = Scene("slab", bricks.block((0, 0, 0), ({SIDE}, {SIDE}, {HIGH})), stone)
scene.platen("bottom")
scene.watch(0, name="slab")
scene.settle()
scene.shakeAgain([{pulse()}, {pulse()}, {pulse()}], every={EVERY}, scales=[1, 0.5, -1])
scene.finish()
"""


def table(folder):
    """Columns of shakes.csv."""
    rows = [*csv.DictReader(open(os.path.join(folder, "shakes.csv")))]
    return {name: [row[name] for row in rows] for name in rows[0]}


def test_a_slab_slides_with_every_pulse_and_keeps_its_period(tmp_path, monkeypatch):
    """Newmark's sliding block. The second pulse, of half the acceleration, is 3 m/s² and just
    stronger than friction. The last pulse moves the slab back: then friction and joint set it
    rocking."""
    monkeypatch.chdir(tmp_path)
    status, steps, said = stopped.carryOut(stopped.BEGIN + SCRIPT, "--out", "whole")
    assert status == 0, said
    rows = table("whole")
    numbers = lambda name: np.array(rows[name], float)
    x = numbers("residual_slab_x_mm")
    slips = np.cumsum([slip(PULSE), slip(PULSE / 2), -slip(PULSE)])
    assert x == approx(-slips, abs=0.03 * slip(PULSE))
    assert x[1] - x[0] == approx(-slip(PULSE / 2), rel=0.5)
    # sways on its joint; it hardly turns
    swings = 2 * math.pi * math.sqrt(DENSITY * HIGH / STIFFNESS)
    assert numbers("first_period_s") == approx(swings, rel=0.05)
    assert [*numbers("peak_m_per_s2")] == [PULSE, PULSE / 2, PULSE]
    assert {*rows["ended"]} == {AT_REST}
    # stopped within the second record, the run goes on and leaves the same
    stop = stopped.signalled(signal.SIGTERM, round(0.5 * steps))
    assert stopped.carryOut(stopped.BEGIN + SCRIPT, "--out", "stopped", stop=stop)[0] == 130
    assert stopped.carryOut(stopped.BEGIN + SCRIPT, "--resume", "stopped")[0] == 0
    assert stopped.differences(stopped.left("whole"), stopped.left("stopped")) == []
    assert table("stopped") == rows


def test_a_sequence_ends_with_the_record_in_which_the_structure_falls(tmp_path):
    stone = materials.dry(friction=0.7, normalStiffness=1e10, density=DENSITY)
    scene = standing(tmp_path, bricks.stack(2, (0.1, 0.1, 0.4)), stone)
    scene.watch(1, name="top")
    scene.settle()
    records = [pulse(), pulse(), pulse()]
    settings = dict(every=EVERY, after=2.0, unit="m/s²")
    ends = scene.shakeAgain(records, scales=[0.1, 3, 1], **settings)
    assert ends == [DONE, COLLAPSED] and table(tmp_path)["ended"] == [AT_REST, COLLAPSED]
    with raises(ValueError, match="2 scales for 3 records"):
        scene.shakeAgain(records, scales=[1, 2])


def test_what_still_moves_after_a_record_is_no_structure_at_rest(tmp_path):
    scene = standing(tmp_path, bricks.stack(2, (0.1, 0.1, 0.4)), materials.dry(density=DENSITY))
    scene.settle()
    scene.shakeAgain([pulse()], every=EVERY, scales=[0.3], unit="m/s²", longest=0.01)
    assert table(tmp_path)["ended"] == [MOVING]


@mark.parametrize(
    "wrong, said",
    [
        (["{folder}/none.txt"], "cannot read"),
        (["{folder}/short.AT2"], "NPTS is 3, and the file has 2 values"),
        ([[0.1, 0.2]], "every None s, the time between samples, must be above 0"),
    ],
)
def test_a_record_that_cannot_be_read_ends_a_script_in_a_sentence(tmp_path, wrong, said):
    """All records are read before the first one shakes."""
    (tmp_path / "short.AT2").write_text(
        "A\nB\nACCELERATION IN UNITS OF G\nNPTS= 3, DT= .005 SEC\n.1 .2\n"
    )
    (tmp_path / "fine.txt").write_text("# unit: g\n# every: 0.01 s\n0.1\n0.1\n")
    records = ["{folder}/fine.txt", *wrong]
    script = (
        stopped.BEGIN
        + f"""
scene = Scene("refused", bricks.stack(2, (0.4, 0.2, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom")
scene.settle()
scene.shakeAgain({records!r})
"""
    )
    file = tmp_path / "scene.py"
    file.write_text(script.replace("{folder}", str(tmp_path)))
    done = runProgram(str(file), "--out", str(tmp_path / "out"), "--lean", check=False)
    assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr
    # before the first step, but a file may be made on the way
    missing = said == "cannot read"
    assert ("no such file yet" in done.stdout) == ("steps/s" in done.stdout) == missing


def test_a_history_that_cannot_be_read_is_refused_before_the_first_step(tmp_path):
    (tmp_path / "path.csv").write_text("displacement_mm\n1\nnan\n")
    script = (
        stopped.BEGIN
        + """
scene = Scene("refused", bricks.stack(2, (0.4, 0.2, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom")
top, path = scene.platen("top"), "path.csv"
scene.settle()
scene.follow(top, path)
"""
    )
    (tmp_path / "scene.py").write_text(script)
    done = runProgram(str(tmp_path / "scene.py"), "--out", "out", check=False, cwd=tmp_path)
    assert done.returncode == 2 and "line 7: follow: " in done.stderr, done.stderr
    assert "steps/s" not in done.stdout and "Traceback" not in done.stderr


def test_options_of_the_command_line_are_for_the_shake_that_follows(tmp_path, capsys):
    stone = materials.dry(
        friction=FRICTION, normalStiffness=1e11, shearStiffness=STIFFNESS, density=DENSITY
    )
    scene = standing(tmp_path, bricks.stack(1, (SIDE, SIDE, HIGH)), stone, "--scale", "0.8")
    scene.watch(0, name="slab")
    scene.settle()
    scene.shakeAgain([pulse()], every=EVERY, unit="m/s²")
    assert "are for a shake() that follows" in capsys.readouterr().out
    scene.shake(pulse(), EVERY, unit="m/s²")
    ends = [a["value"] for a in scene.answers if a["name"] == "displacement_of_slab_x_at_the_end"]
    slips = np.cumsum([slip(PULSE), slip(0.8 * PULSE)])
    assert ends == approx(-slips, rel=0.05)
