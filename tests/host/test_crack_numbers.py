# SPDX-License-Identifier: GPL-2.0-or-later
"""What comes out of a run: its cracks, the first and the widest, its collapse, and the rows of a
figure."""

from hosted import *
from masonry.numbers import cracks, curves, quantities
from masonry.numbers.run_data import RunData
from masonry.scene.outcome import restsUnder

WIDTH, HEIGHT, COURSE = 0.4, 0.6, 0.2  # [m] of a pile of three blocks


def pile(folder, masonry, push, direction=(1, 0, 0), press=1e5, rate=20, foot=0):
    """A pile on a foot at a height [m], whose uppermost block is pushed at its centre; run.json and
    curve.csv."""
    blocks = bricks.stack(3, (WIDTH, 0.3, COURSE)).moved(0, 0, foot)
    scene = standing(folder, blocks, masonry)
    top = scene.platen("top", rotation="free", height=0.1)
    scene.press(top, press)
    scene.settle()
    scene.push(top, push, direction=direction, rate=rate)
    joints = [(i.phys.opening, i.geom.centres, i.id1, i.id2) for i in scene.model.interactions]
    scene.finish()
    return readRun(folder), readCurve(folder), joints


def test_the_first_crack_is_the_first_row_with_a_loss(tmp_path):
    run, curve, joints = pile(tmp_path, materials.calciumSilicate(), 1.0)
    tension, shear = (curve[f"dissipated_{m}_J"] for m in ("tension", "shear"))
    assert tension[0] == shear[0] == 0
    began = next(i for i, lost in enumerate(map(sum, zip(tension, shear))) if lost > 0)
    moved = run["displacement_at_first_crack_mm"]
    assert 0.01 < curve["displacement_mm"][began] <= moved * (1 + 1e-6)
    assert moved <= curve["displacement_mm"][began + 3]
    # the platen at the top may slip on the pile, which is no drift
    own = curve["masonry_displacement_mm"][curve["displacement_mm"].index(approx(moved))]
    assert run["drift_at_first_crack_mrad"] == approx(own / HEIGHT)
    assert run["collapse_displacement_mm"] is None and not run["collapsed"]
    widest = max(joints, key=lambda joint: max(joint[0]))
    at = max(range(len(widest[0])), key=lambda n: widest[0][n])
    assert 0.05 < run["largest_crack_mm"] == approx(1e3 * widest[0][at])
    assert run["largest_crack_at_m"] == approx(list(widest[1][at]))
    assert run["largest_crack_bodies"] == list(widest[2:])
    # pushed to the right, it opens on the left
    assert run["largest_crack_at_m"][0] == approx(0)


def test_the_drift_is_over_the_height_above_the_foot_wherever_that_is(tmp_path):
    runs = []
    for foot in (0, 3):
        O.reset()
        run, _, _ = pile(tmp_path / str(foot), materials.calciumSilicate(), 0.2, foot=foot)
        runs.append(run)
    assert runs[1]["drift_height_m"] == approx(HEIGHT)
    assert runs[1]["recorded_height_m"] == approx(HEIGHT + 0.1)
    drifts = [run["drift_at_first_crack_mrad"] for run in runs]
    assert drifts[1] == approx(drifts[0], rel=0.05)  # a row or two


def test_a_push_that_cracks_nothing_has_no_first_crack(tmp_path):
    masonry = materials.calciumSilicate()
    run, _, _ = pile(tmp_path, masonry, 0.01, press=1e6)
    for entry in ("displacement_at_first_crack_mm", "drift_at_first_crack_mrad"):
        assert run[entry] is None
    assert run["largest_crack_mm"] == 0
    assert run["largest_crack_at_m"] is run["largest_crack_bodies"] is None


def test_a_push_upwards_has_no_drift(tmp_path):
    up = dict(direction=(0, 0, 1), press=1e3)
    run, _, _ = pile(tmp_path, materials.calciumSilicate(), 0.5, **up)
    assert run["displacement_at_first_crack_mm"] > 0
    assert run["drift_at_first_crack_mrad"] is None
    assert run["largest_crack_mm"] == approx(0.5, abs=0.05)


def test_a_push_that_ends_in_a_collapse_says_where(tmp_path):
    masonry = materials.dry(normalStiffness=1e11)
    run, curve, _ = pile(tmp_path, masonry, 500, press=1e3, rate=500)
    assert run["collapsed"]
    last = approx(curve["displacement_mm"][-1], rel=1e-6)
    assert run["collapse_displacement_mm"] == last
    # it tips about its edge with the push at its top, or slides off
    assert 1 < run["collapse_displacement_mm"] < 1e3 * WIDTH + 20


def test_the_first_crack_is_counted_from_the_first_row_of_the_push():
    """What was lost before does not count, nor does what is small beside the elastic energy."""
    rows = {f"elastic_{part}_J": [0.0] * 6 for part in ("shear", "compression", "units")}
    rows["elastic_tension_J"] = [0.0, 10.0, 10.0, 10.0, 10.0, 10.0]
    rows["dissipated_tension_J"] = [0.0, 5.0, 5.0, 5.0 + 1e-5, 5.0 + 2e-4, 6.0]
    rows["dissipated_shear_J"] = [0.0] * 6
    assert curves.firstCrack(rows.get, slice(1, None)) == 4
    assert curves.firstCrack(rows.get, slice(1, 4)) is None
    assert curves.firstCrack(rows.get) == 1
    assert curves.firstCrack(rows.get, slice(6, None)) is None


def numbers(loads, columns, **run):
    """Numbers of a run of which each stage has two rows.

    :param loads: of the stages in their order: the kind and the name of what each loaded; a push
        goes on with the curve of the one before
    """
    zero = [0.0] * 2 * len(loads)
    of = lambda n, load: {"load": [*load, ""], "first_row": 2 * n, "continued": n > 0}
    stages = [of(n, load) for n, load in enumerate(loads)]
    column = lambda head: columns.get(head, zero)
    run = {"stages": stages, "drift_height_m": 2.0, **run}
    return quantities.found(RunData(run, column))


def test_what_is_lost_between_two_pushes_is_no_crack_of_theirs():
    loads = [("push", "a"), ("lean", "b"), ("push", "a")]
    for lost, at in (
        ([0, 0, 5, 5, 5, 5], None),
        ([0, 0, 5, 5, 5, 7], 0.6),
        ([0, 1, 5, 5, 5, 7], 0.2),
    ):
        moved = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        own = [value - 0.05 for value in moved]  # the platen slips by 0.05 mm
        found = numbers(
            loads,
            {"dissipated_shear_J": lost, "displacement_mm": moved, "masonry_displacement_mm": own},
        )
        assert found["displacement_at_first_crack_mm"] == at
        drift = None if at is None else approx((at - 0.05) / 2.0)
        assert found["drift_at_first_crack_mrad"] == drift


@mark.parametrize("last, collapse", [("push", 0.4), ("lean", None)])
def test_a_collapse_after_a_push_is_not_its_own(last, collapse):
    moved = {"displacement_mm": [0.1, 0.2, 0.3, 0.4]}
    found = numbers([("push", "a"), (last, "a")], moved, collapsed=True)
    assert found["collapse_displacement_mm"] == collapse


def test_a_peak_is_on_its_side_of_the_loop_and_is_felt_at_both_ends():
    """A wave that only the supports feel is no peak, nor is friction on the way back."""
    columns = {
        "displacement_mm": [0.0, 1.0, 0.9, -0.1, -1.0, -0.9],
        "base_shear_kN": [0.0, 8.0, -9.0, -3.0, -6.0, -1.0],
        "top_shear_kN": [0.0, 7.0, -9.0, -20.0, -5.0, -1.0],
    }
    history = {"noise_mm": 0.05}
    found = numbers([("push", "a")] * 3, columns, history=history)
    assert (found["peak_at_both_ends_kN"], found["peak_base_shear_kN"]) == (7, 8)
    keys = (
        "negative_peak_at_both_ends_kN",
        "negative_peak_base_shear_kN",
        "displacement_at_negative_peak_mm",
    )
    assert [found[key] for key in keys] == [-5, -6, -1]


def test_the_line_of_loads_that_were_put_on_goes_from_rest_up_to_the_largest():
    loads = [("push", "a"), ("lean", "b"), ("lean", "b"), ("lean", "c"), ("lean", "b")]
    factors = [0, 0, 0.1, 0.3, 0.2, 0.2, 0.7, 0.7, 0.9, 0.9]
    at = SimpleNamespace(
        stages=[{"first_row": 2 * n} for n in range(len(loads))],
        answers={str(n): [{"value": v}] for n, v in enumerate([1, 0.3, 0.2, 0.7, None], 1)},
    )
    results = SimpleNamespace(column=lambda head: factors, rows=factors)
    numbered = [(n, [*load, ""]) for n, load in enumerate(loads, 1)]
    scene = SimpleNamespace(running=SimpleNamespace(state=at))
    outcome = SimpleNamespace(scene=scene, results=results, loads=numbered)
    # the end of the push, then those of what was held, by the load
    assert restsUnder(outcome, "b") == [1, 5, 3]


def test_the_widest_crack_is_the_largest_opening():
    joints = [
        ("a", {"bed", "wall"}, [-1.0, 2.0], ["p", "q"]),
        ("b", {"head"}, [3.0, 2.0], ["r", "s"]),
        ("c", {"bed"}, [1.0], ["t"]),
    ]
    groups = {"bed": 2.0, "wall": 2.0, "head": 3.0}
    assert cracks.widest(joints) == (3.0, "r", "b", groups)
    closed = [("a", {"bed"}, [-1.0, -2.0], ["p", "q"])]
    assert cracks.widest(closed) == (0.0, None, None, {"bed": 0.0})


def test_damage_classes_are_those_of_the_table():
    widths = [0, 0.1, 0.11, 1, 1.1, 5, 5.1, 15, 16, 25, 26]
    assert [*map(cracks.damageClass, widths)] == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5]
