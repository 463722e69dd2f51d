# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers and figures of the walls in cycles, from curves whose answers are known."""

from usual import *

sys.path.insert(0, os.path.join(ROOT, "validation", "cyclic"))
import figures  # noqa: E402
import walls  # noqa: E402

from masonry.numbers.run_data import RunData  # noqa: E402

STIFFNESS, STRENGTH = 10.0, 20.0  # [kN/mm], [kN]
MONOTONIC = np.array([[0.0, 2.0, 50.0], [0.0, 20.0, 20.0]])


def slider(amplitudes, repeats=2, negative=1.0):
    """Loops of a spring and a slider in series; in the negative direction the slider has another
    strength."""
    corners = [0.0]
    for a in amplitudes:
        corners += repeats * [a, -a, 0.0]
    moved = np.concatenate(
        [np.linspace(a, b, 2001)[:-1] for a, b in zip(corners, corners[1:])] + [[0.0]]
    )
    force, slip = [], 0.0
    for x in moved:
        trial = STIFFNESS * (x - slip)
        f = min(max(trial, -negative * STRENGTH), STRENGTH)
        slip = x - f / STIFFNESS
        force.append(f)
    return moved, np.array(force)


def test_an_ideal_slider_has_the_stiffness_of_its_strength_over_its_amplitude():
    found = walls.numbers(*slider([1, 4, 10]), MONOTONIC)
    assert [n.repeat for n in found] == [0, 1, 0, 1, 0, 1]
    assert [n.stiffness for n in found] == approx([1, 1, 0.5, 0.5, 0.2, 0.2], rel=1e-6)
    assert [n.positive for n in found] == approx(6 * [1], abs=1e-9)
    assert [n.negative for n in found] == approx(6 * [1], abs=1e-9)


def test_what_one_direction_lost_is_seen_in_the_other():
    found = walls.numbers(*slider([10], negative=0.7), MONOTONIC)
    assert found[0].positive == approx(1)
    assert found[0].negative == approx(0.7)
    assert walls.tableRows("comp4", "cyclic", found)[0][7] == "0.70"


def test_beyond_the_monotonic_curve_there_is_no_number():
    found = walls.numbers(*slider([60], repeats=1), MONOTONIC)
    assert np.isnan(found[0].positive)


def test_figures_are_drawn(tmp_path):
    curves = {"softening": slider([1, 4]), "cyclic": slider([1, 4], negative=0.8)}
    walls.drawLoops("comp4", MONOTONIC, curves, tmp_path / "loops.png")
    found = {"comp4": {k: walls.numbers(*c, MONOTONIC) for k, c in curves.items()}}
    walls.drawDegradation(found, tmp_path / "degradation.png")
    for name in ("loops.png", "degradation.png"):
        assert (tmp_path / name).stat().st_size > 5000


def test_a_figure_of_no_path_is_refused(tmp_path):
    with raises(FileNotFoundError, match="no path of joint.py"):
        figures.draw(tmp_path, tmp_path / "joint.png")


@mark.parametrize("last, grown, collapse", [("push", 3, 3), ("lean", 1, None)])
def test_numbers_of_pushes_are_without_what_comes_between_and_behind(last, grown, collapse):
    stages = [("push", 0, False), (None, 2, False), (last, 3, True)]
    run = {
        "collapsed": True,
        "stages": [
            {"load": load and [load, "top"], "first_row": row, "continued": continued}
            for load, row, continued in stages
        ],
    }
    columns = {"displacement_mm": [0, 1, 1, 1, 2], "damping_J": [0, 1, 5, 5, 7]}
    data = RunData(run, columns.get)
    assert data.grown("damping_J") == grown and data.collapse == collapse


def test_a_push_that_goes_on_from_behind_has_lost_nothing_there():
    stages = [("push", 0, False), ("push", 3, True)]
    run = {"stages": [dict(load=["push"], first_row=n, continued=more) for _, n, more in stages]}
    force = [0, 5, 10, 0, 4, 9.9]
    moved = [0, 1, 2, 0.5, 1, 2.1]
    columns = dict(displacement_mm=moved, base_shear_kN=force, top_shear_kN=force)
    assert RunData(run, columns.get).dropped() == (approx(0.01), None)


def test_a_push_carries_what_both_ends_carry_at_once():
    run = {"stages": [dict(load=["push"], first_row=0)]}
    columns = dict(displacement_mm=[0, 1, 2], base_shear_kN=[0, 10, 2], top_shear_kN=[0, 3, 8])
    assert RunData(run, columns.get).peakForce() == 3
