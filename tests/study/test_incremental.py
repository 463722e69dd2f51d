# SPDX-License-Identifier: GPL-2.0-or-later
"""Incremental dynamic analysis: which rows are run, what they find beside closed forms, and what is
said of them."""

from commands import *
import hashlib
import itertools
import pathlib
from xml.etree import ElementTree
from masonry_study import Sa, Study, report, uniform
from masonry_study.demands import Demands, _between, _quantile, _usual
from masonry_study.gathering import Folder
from masonry_study.incremental import Chains
from masonry_study.records import Record
from masonry_study.spectrum import spectralAcceleration
from masonry.scene.ground import readRecord

ROCKING = os.path.join(HERE, "rocking.py")
inf = math.inf
LEVELS = [0.2, 0.36, 0.6, 0.9]  # [g]
PLAN = dict(design="ida", records=["*.txt"], levels=LEVELS)
MOVED = "shake_2_largest_displacement_of_corner_x_mm"
PULSES = {"long": 0.4, "middle": 0.2, "short": 0.1}  # [s]


def pulse(path, seconds):
    """A file of a rectangular pulse of 0.5 g with a rise and a fall of a millisecond."""
    values = ["0", *["0.5"] * round(seconds / 1e-3), "0", "0", ""]
    path.write_text("# unit: g\n# every: 0.001 s\n" + "\n".join(values))


def records(folder):
    for name, seconds in PULSES.items():
        pulse(folder / f"{name}.txt", seconds)


def write(folder, **changes):
    """The file of a study of the rocking block, and its records."""
    records(folder)
    said = {**PLAN, "options": {"checkpoint_every": 0.002}, **changes}
    path = folder / "study.py"
    path.write_text(f"from masonry_study import *\nstudy = Study({ROCKING!r}, **{said})\n")
    return path


# -- the whole, beside Housner ---------------------------------------------------------------------


def housner(seconds, level):
    """Largest rotation over the slope of a slender block under a rectangular pulse, and whether it
    falls: G. W. Housner, "The behavior of inverted pendulum structures during earthquakes",
    Bulletin of the Seismological Society of America 53 (1963), where cosh(pt) = 1 + 1/(2 r (r - 1))
    with r = a/(gα) is the limit.
    """
    p = math.sqrt(3 * 9.81 / (4 * math.hypot(0.125, 0.5)))
    beyond = level / 0.25 - 1
    if beyond <= 0:
        return 0.0, False
    rise, sinh = math.cosh(p * seconds) - 1, math.sinh(p * seconds)
    rest = (1 - beyond * rise) ** 2 - (beyond * sinh) ** 2
    falls = 2 * beyond * (beyond + 1) * rise >= 1
    return (inf if falls else 1 - math.sqrt(rest)), falls


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study that was not disturbed: its folder, and what it said."""
    folder = tmp_path_factory.mktemp("whole")
    return folder / "out", done(write(folder), "--out", folder / "out", "--jobs", 2)


def test_a_block_falls_at_the_levels_of_housner_and_no_row_above_is_run(whole):
    out, said = whole
    assert "3 above collapse, 9 ended" in said
    found = table(out)
    assert [row["record"] for row in found] == [n for n in PULSES for _ in LEVELS]
    fallen = False
    for row, level in zip(found, LEVELS * 3):
        fallen = fallen and level != LEVELS[0]
        assert row["status"] == ("above collapse" if fallen else "ended")
        assert float(row["PGA_g"]) == level
        assert float(row["scale"]) == approx(level / 0.5)
        if fallen:
            assert row["collapsed"] == row[MOVED] == ""
            assert not (out / "rows" / row["run"]).exists()
        else:
            fallen = housner(PULSES[row["record"]], level)[1]
            assert row["collapsed"] == str(fallen)
    assert len(ended(out)) == 9


def test_rotations_are_those_of_housner(whole):
    """His equations are for small slopes; that of this block is 0.25, whose square is 6 %. Joints
    add about a millimetre."""
    compared = 0
    for row, level in zip(table(whole[0]), LEVELS * 3):
        share, falls = housner(PULSES[row["record"]], level)
        if row["status"] == "ended" and not falls:
            # about a millimetre is of the joint
            near = approx(0.25 * share, rel=0.06, abs=1.5e-3 if share else 1e-3)
            assert 1e-3 * abs(float(row[MOVED])) == near
            compared += share > 0
    assert compared == 3


def test_the_report_has_curves_and_a_fragility(whole, capsys):
    out, _ = whole
    assert report.main([str(out), "--demand", "0.5"]) == 0
    said = capsys.readouterr().out
    assert "incremental dynamic analysis of 3 records; the intensity is PGA [g]" in said
    assert "where the structure falls, and above, it is infinite" in said
    assert "of 3 of 3 records" in said and "median [g]" in said
    assert "rows that have not ended: 3 above collapse" in said
    for name in ("ida.png", "fragility.png"):
        assert (out / name).stat().st_size > 20_000
    fit = Demands(Record(out)).fragility()
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    [function] = ElementTree.parse(out / "fragility.xml").iter(f"{space}fragilityFunction")
    imls, params = function
    assert (function.get("id"), imls.get("imt"), params.get("ls")) == ("out", "PGA", "collapse")
    assert fit.probability(float(imls.get("maxIML"))).value == approx(0.9999, abs=1e-5)
    mean, deviation = (float(params.get(name)) for name in ("mean", "stddev"))
    assert math.log1p((deviation / mean) ** 2) == approx(fit.dispersion.value**2, rel=1e-3)
    assert mean**2 / math.hypot(mean, deviation) == approx(fit.median.value, rel=1e-3)
    assert report.main([str(out), "--limit", "30", "--no-pictures"]) == 0
    said = capsys.readouterr().out
    assert "shake 2 largest displacement of corner x [mm] reaches 30" in said
    for words in (["--limit", "-1"], ["--limit", "1,2"], ["--demand", "0"]):
        assert report.main([str(out), *words]) == 2
    assert report.main([str(out), "--measure", "height_m"]) == 2


def test_a_study_that_is_done_runs_nothing_and_compares_its_records(whole, tmp_path):
    out, _ = whole
    before = read(out)
    done(out.parent / "study.py", "--out", out)
    assert read(out) == before and len(ended(out)) == 9
    copy = shutil.copytree(out, tmp_path / "out")
    record = copy / "records" / "long.txt"
    record.write_text(record.read_text() + "0.0\n")
    words = out.parent / "study.py", "--out", copy
    said = study(*words).stderr
    assert "long.txt is not the record that the study reads; remove it" in said
    os.remove(record)
    done(*words)
    assert record.read_bytes() == (out / "records" / "long.txt").read_bytes()
    pulse(tmp_path / "other.txt", 0.3)
    other = write(tmp_path, records=["long.txt", "middle.txt", "other.txt"])
    process = study(other, "--out", copy)
    assert process.returncode == 2 and "holds another study" in process.stderr


def test_interruptions_and_the_order_of_rows_change_no_number(whole, tmp_path):
    """A row above a collapse is run first, by hand; then the study is killed, and interrupted, and
    goes on."""
    path, out = write(tmp_path), tmp_path / "out"
    done(path, "--out", out, "--prepare")
    run(*ROW, "--scene", ROCKING, out, 4, check=True)
    assert (out / "rows" / "0004" / "run.json").exists()
    folder = Folder(out)
    for number in (signal.SIGKILL, signal.SIGINT):
        while any(map(folder.isHeld, range(1, 13))):
            time.sleep(0.05)  # rows of a study that was killed are asked to stop
        process = start(path, "--out", out)
        seen = len([*out.glob("rows/*/curve.csv")])
        while process.poll() is None and len([*out.glob("rows/*/curve.csv")]) == seen:
            time.sleep(0.02)
        process.send_signal(number)
        process.communicate(timeout=60)
        assert process.returncode in (-9, 130, 0)
    done(path, "--out", out)
    assert read(out) == read(whole[0])


def test_a_task_of_slurm_runs_the_levels_of_a_record(whole, slurm, tmp_path):
    path, out = write(tmp_path), tmp_path / "out"
    done(path, "--out", out, "--slurm", "--partition=walls", env=slurm)
    script = (out / "slurm.sh").read_text()
    assert "#SBATCH --array=0-2" in script and "rows=(1 5 9)" in script
    wait(lambda: not run("squeue", "--noheader", env=slurm).stdout, 300)
    done("--out", out, "--gather", env=slurm)
    assert read(out) == read(whole[0]) and len(ended(out)) == 9


# -- what is planned -------------------------------------------------------------------------------


def planned(tmp_path, **changes):
    records(tmp_path)
    made = Study("any", **{**PLAN, **changes})
    made.read(tmp_path)
    return made


def test_levels_scale_every_record_and_scales_leave_them(tmp_path):
    found = planned(tmp_path).rows()
    assert [(r["record"], r["scale"]) for r in found[:5]] == [
        *(("records/long.txt", approx(level / 0.5)) for level in LEVELS),
        ("records/middle.txt", approx(0.4)),
    ]
    found = planned(tmp_path, levels=None, scales=[1, 2.5]).rows()
    assert [r["scale"] for r in found] == [1.0, 2.5] * 3


def test_the_intensity_of_a_row_is_that_of_its_record_as_it_is_scaled(tmp_path):
    for own in (dict(levels=None, scales=[1, 2.5]), {}):
        made = planned(tmp_path, **own)
        chains = Chains(made.describe())
        for n, (motion, scale) in enumerate(made.ida.rows(), 1):
            peak = max(abs(scale * a) for a in motion.values) / 9.81
            assert chains.intensity(n) == approx(peak, rel=1e-3)


def test_a_spectral_acceleration_is_reached_by_every_record(tmp_path):
    made = planned(tmp_path, measure=Sa(0.5))
    for (motion, scale), level in zip(made.ida.rows(), LEVELS * 3):
        scaled = [scale * a for a in motion.values]
        assert spectralAcceleration(scaled, motion.every, 0.5) == approx(9.81 * level)
    assert made.describe()["ida"]["measure"] == "Sa_0.5s_g"
    assert Sa(0.5, 0.02).name == "Sa_0.5s_2%_g"


def test_what_varies_beside_is_drawn_once_for_every_record(tmp_path):
    pytest.importorskip("openturns", reason="python3-openturns is not installed")
    drawn = lambda: planned(tmp_path, vary={"bed.friction": uniform(0.4, 0.8)}, seed=3).rows()
    found = drawn()
    values = [row["bed.friction"] for row in found]
    assert len(set(values)) == 3
    assert all(len(set(values[n : n + 4])) == 1 for n in (0, 4, 8))
    assert drawn() == found


def test_three_components_are_one_record(tmp_path):
    for name, peak in (("n", 0.4), ("e", 0.9), ("z", 2.0)):
        (tmp_path / f"quake_{name}.txt").write_text(f"0\n{peak}\n0\n")
    triple = [f"quake_{name}.txt" for name in "nez"]
    made = planned(tmp_path, records=[triple, "long.txt"], unit="g", every=0.01)
    first, second = made.ida.read("")
    assert (first.name, second.name, second.every) == ("quake", "long", 0.001)
    assert first.intensity == approx(math.sqrt(0.4 * 0.9))
    assert len(made.ida.doubts()) == 4  # none of the components ends at rest
    path = tmp_path / "kept.txt"
    path.write_text(first.text)
    assert readRecord(str(path), None) == (first.values, 0.01)
    assert first.values[1] == approx([3.924, 8.829, 19.62])


def test_records_of_one_name_are_named_apart(tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        pulse(tmp_path / folder / "el centro.txt", 0.1)
    made = planned(tmp_path, records=["a/el centro.txt", "b/el centro.txt"])
    assert [m.name for m in made.ida.read("")] == ["el_centro", "el_centro_2"]


@mark.parametrize(
    "changes, message",
    [
        (dict(levels=None), "give either levels, in g of the measure, or scales"),
        (dict(scales=[1]), "give either levels, in g of the measure, or scales"),
        (dict(levels=[0.2, 0.2]), r"levels: \[0.2, 0.2\] must grow"),
        (dict(levels=[0.0, 0.2]), r"levels: .* 0.0 must be above 0"),
        (dict(records=[3]), "records: 3 must be the name of a file"),
        (dict(measure="PGV"), "measure 'PGV' must be \"PGA\" or Sa"),
        (dict(unit="furlong"), "unit 'furlong' must be one of m/s², g, cm/s²"),
        (dict(runs=12), "runs 12: there are as many as records times levels"),
        (dict(options={"record": "x"}), "record: it is what an incremental analysis varies"),
        (
            dict(design="random", vary={"rate": [1]}, runs=1),
            'levels: only a study with design="ida" has it',
        ),
        (dict(records=["none*.AT2"]), "records: no file .*none"),
        (dict(records=["none.AT2"]), "cannot read .*none.AT2: No such file"),
        (dict(records=["long.txt", "long.txt"]), "long.txt is given twice"),
        (dict(records=["flat.dat"]), "flat.dat: its PGA_g is 0, it must be above 0"),
        (dict(records=["weak.dat"]), "the peak of the record is 0.4, .* is it in g"),
        (
            dict(records=["odd.dat", "flat.dat"]),
            "(?s)odd.dat, line 2: 'x' is not a number.*flat.dat",
        ),
    ],
)
def test_a_plan_that_cannot_be_is_refused(tmp_path, changes, message):
    (tmp_path / "flat.dat").write_text("# unit: g\n0 0\n0.01 0\n")
    (tmp_path / "weak.dat").write_text("0 0\n0.01 0.4\n")
    (tmp_path / "odd.dat").write_text("0 0\n0.01 x\n")
    with raises(Refused, match=message):
        planned(tmp_path, **changes)


def test_the_unit_of_a_study_is_for_files_that_do_not_say_theirs(tmp_path):
    (tmp_path / "weak.dat").write_text("0 0\n0.01 0.4\n")
    made = planned(tmp_path, records=["weak.dat", "long.txt"], unit="g")
    assert [m.intensity for m in made.ida.read("")] == approx([0.4, 0.5])


def test_rows_of_one_record_follow_each_other():
    plan = {"levels": [1, 2, 3], "scales": None, "records": [{}, {}], "measure": "PGA_g"}
    chains = Chains({"runs": 6, "ida": plan})
    assert [*chains.lower(6)] == [4, 5] and [*chains.higher(4)] == [5, 6]
    assert [*chains.lower(4)] == [*chains.higher(3)] == []
    assert chains.lowest({2, 3, 5, 6}) == {2, 5}
    alone = Chains({"runs": 6})
    assert alone.lowest({2, 3, 5}) == {2, 3, 5} and [*alone.higher(2)] == []


def test_a_scene_that_is_not_shaken_gives_no_data(tmp_path):
    """A run that ended without a shake is no row of an analysis: it is counted as failed, with the
    reason."""
    folder = Folder(fake(tmp_path, [0.3, 0.6], ["a"], {}))
    os.makedirs(folder.row(1))
    with open(os.path.join(folder.row(1), "run.json"), "w") as file:
        ended = {"interrupted": False, "collapsed": True, "stages": [{"stage": "settle"}]}
        json.dump(ended, file)
    assert [folder.status(n) for n in (1, 2)] == ["failed", "missing"]


def test_a_row_refuses_a_record_that_was_cut_off(tmp_path):
    out = pathlib.Path(fake(tmp_path, [0.3, 0.6], ["a"], {}))
    (out / "table.txt").write_text("description lean\n0001 True\n0002 True\n")
    (out / "records").mkdir()
    (out / "records" / "a.txt").write_text("# unit: g\n# every: 0.01 s\n0\n0.5\n")
    scene = tmp_path / "x.py"
    scene.write_text("raise SystemExit(3)\n")
    record = json.loads(read(out, "study.json"))
    record["scene_sha256"] = hashlib.sha256(scene.read_bytes()).hexdigest()
    (out / "study.json").write_text(json.dumps(record))
    process = run(*ROW, "--scene", scene, out, 1)
    assert process.returncode == 2
    assert "a.txt is not the record with which the study began" in process.stderr


# -- what is found ---------------------------------------------------------------------------------


def fake(tmp_path, levels, names, found):
    """A folder of a study as rows leave it.

    :param found: dict of the number of a row -> demand; infinite: it fell; None: it failed
    """
    out = tmp_path / "fake"
    (out / "rows").mkdir(parents=True)
    records = [{"name": n, "sha256": "", "intensity": 0.5} for n in names]
    plan = dict(records=records, measure="PGA_g", levels=levels, scales=None)
    runs = len(levels) * len(names)
    record = {"options": {}, "vary": {}, "runs": runs, "design": "ida", "ida": plan}
    (out / "study.json").write_text(json.dumps({"study": record, "script": "x.py"}))
    lines = ["run,record,scale,PGA_g,status,collapsed,shake_2_largest_displacement_of_top_x_mm"]
    number = 0
    for name in names:
        fell = False
        for level in levels:
            number += 1
            value = found.get(number)
            end = "failed,," if value is None else f"ended,{value == inf},{-min(value, 1e4)}"
            end = "above collapse,," if fell else end
            fell = fell or value == inf
            lines.append(f"{number:04d},{name},1.0,{level},{end}")
    (out / "study.csv").write_text("\n".join([*lines, ""]))
    return str(out)


@pytest.fixture
def three(tmp_path):
    """A study of three records and levels, of which the first falls at 0.9 g, the second at 0.6 g
    and the third never."""
    found = {1: 1.0, 2: 4.0, 3: inf, 4: 2.0, 5: inf, 7: 3.0, 8: 6.0, 9: 12.0}
    return fake(tmp_path, [0.3, 0.6, 0.9], ["a", "b", "c"], found)


def test_collapse_counts_as_an_infinite_demand(three):
    demands = Demands(Record(three))
    assert demands.quantiles(0.3) == approx([1.32, 2.0, 2.68])
    assert demands.quantiles(0.6) == [approx(4.64), 6.0, inf]
    assert demands.quantiles(0.9) == [inf, inf, inf]  # 12, infinite, infinite
    assert demands.quantiles(0.9, [0.0]) == [12.0]
    low, high = demands.intervals()
    assert low.tolist() == [0.6, 0.3, 0.9] and high.tolist() == [0.9, 0.6, inf]
    assert demands.counts() == [(0.3, 0, 3), (0.6, 1, 3), (0.9, 2, 3)]
    low, high = demands.intervals(limit=3.0)
    assert low.tolist() == [0.3, 0.3, 0.0] and high.tolist() == [0.6, 0.6, 0.3]
    assert demands.fell == [0.9, 0.6, inf]


def test_rows_that_failed_make_intervals_wider(tmp_path):
    found = {1: 1.0, 3: inf, 5: 2.0, 6: 5.0, 7: 1.0, 8: 2.0, 9: inf}
    out = fake(tmp_path, [0.3, 0.6, 0.9], ["a", "b", "c", "d"], found)
    demands = Demands(Record(out))
    low, high = demands.intervals()
    assert low.tolist() == [0.3, 0.9, 0.6] and high.tolist() == [0.9, inf, 0.9]
    assert demands.counts() == [(0.3, 0, 3), (0.6, 0, 2), (0.9, 2, 3)]
    assert math.isnan(demands.quantiles(0.3)[1])  # two records are known
    assert report.main([out, "--no-pictures"]) == 0


@mark.parametrize(
    "found, message",
    [
        ({n: 1.0 for n in range(1, 10)}, "at none of the 3 records is the limit reach"),
        ({1: 1.0, 2: 2.0, 4: 1.0, 5: inf}, "needs 3 records or more, there are 2"),
        ({}, "needs 3 records or more, there are 0"),
    ],
)
def test_a_report_says_what_it_cannot_find(tmp_path, capsys, found, message):
    out = fake(tmp_path, [0.3, 0.6, 0.9], ["a", "b", "c"], found)
    assert report.main([out]) == 0
    said = capsys.readouterr().out
    assert message in said and "median" not in said
    assert "no fragility.png: " in said


def test_quantiles_and_the_fitted_fragility_are_drawn(three, drawn):
    assert report.main([three]) == 0
    axis = drawn["ida.png"].axes[0]
    lines = {line.get_label(): line for line in axis.lines}
    assert lines["50 %"].get_xdata() == approx([0, 2, 6])
    assert lines["50 %"].get_ydata() == approx([0, 0.3, 0.6])
    assert lines["84 %"].get_xdata() == approx([0, 2.68])
    assert axis.get_xlabel() == "shake 2 largest displacement of top x [mm]"
    assert axis.get_ylabel() == "PGA [g]"
    lines = {line.get_label(): line for line in drawn["fragility.png"].axes[0].lines}
    assert lines["share of 3 records"].get_ydata() == approx([0, 1 / 3, 2 / 3])
    curve = next(line for label, line in lines.items() if label.startswith("lognormal"))
    median = Demands(Record(three)).fragility().median.value
    assert np.interp(median, *curve.get_data()) == approx(0.5, abs=0.01)


@given(
    values=some.lists(some.one_of(some.floats(0, 1e6), some.just(inf)), min_size=1, max_size=9),
    share=some.floats(0, 1),
)
@settings(max_examples=100)
def test_quantiles_are_those_of_numpy_where_all_is_finite(values, share):
    values = np.sort(values)
    found = _quantile(values, share)
    finite = values[np.isfinite(values)]
    if len(finite) == len(values):
        assert found == approx(np.quantile(values, share), rel=1e-9, abs=1e-9)
    elif share * (len(values) - 1) <= len(finite) - 1:
        assert found == approx(np.interp(share * (len(values) - 1), range(len(finite)), finite))
    else:
        assert found == inf


def test_between_levels_a_demand_changes_evenly_and_above_the_last_it_is_unknown():
    at = lambda x: _between([0.2, 0.6, 1.0], [1.0, 5.0, inf], x)
    assert [at(0.1), at(0.2), at(0.4), at(0.6)] == approx([0.5, 1, 3, 5])
    assert at(0.7) == at(1.0) == at(2.0) == inf
    assert math.isnan(_between([0.2, 0.6], [1.0, 5.0], 0.7))
    # what has fallen stays so, also if a higher level was run
    rows = [([0.2, 0.6, 1.0], [1.0, inf, 1.0])]
    made = SimpleNamespace(rows=rows, stood=[[0.2, 1.0]])
    assert Demands.intervals(made) == Demands.intervals(made, 2.0) == ([0.2], [0.6])
    assert _between([0.2, 0.6, 1.0], [inf, 1.0, 5.0], 0.8) == inf


def test_the_usual_demand_is_that_of_the_largest_amount():
    values = {"shake_2_largest_x_mm": [-5.0, 1.0], "shake_2_largest_y_mm": [2.0, 3.0]}
    record = SimpleNamespace(measures=values, numbers=lambda name: np.array(values[name]))
    assert _usual(record) == "shake_2_largest_x_mm"


# -- what is damaged already -----------------------------------------------------------------------


def test_a_slab_that_has_slid_reaches_a_slide_earlier_and_each_class_has_its_fragility(tmp_path):
    """Newmark's sliding block under rectangular pulses, after a main shock that moves half of them
    by 17 mm."""
    braked, main, limit = 0.3 * 9.81, 4.96, 27.0
    slip = lambda a, seconds: 1e3 * 0.5 * (a - braked) * seconds**2 * a / braked
    accelerations, lasting = [4, 5, 6, 7, 8], {"070": 0.07, "100": 0.1, "135": 0.135}
    for name, seconds in itertools.product(lasting, "ab"):
        values = ["0"] * 5 + ["1"] * round(lasting[name] / 0.002) + ["0"] * 75
        head = ["# unit: m/s²", "# every: 0.002 s"]
        (tmp_path / f"{seconds}{name}.txt").write_text("\n".join([*head, *values, ""]))
    plan = dict(design="ida", records=["*.txt"], levels=[a / 9.81 for a in accelerations])
    plan["vary"] = {"main": [0.0, main]}
    path, out = tmp_path / "study.py", tmp_path / "out"
    slab = os.path.join(HERE, "slab.py")
    path.write_text(f"from masonry_study import *\nstudy = Study({slab!r}, **{plan})\n")
    done(path, "--out", out, "--jobs", 2)
    column = "shake_5_displacement_of_slab_x_at_the_end_mm"
    groups = Demands(Record(out), column).apart(Record(out), "damage")
    assert [len(one.names) for one in groups.values()] == [3, 3]
    for one, moved in zip(groups.values(), (0, slip(main, 0.1))):
        low, high = one.intervals(limit)
        for name, below, at in zip(one.names, low, high):
            reached = [moved + slip(a, lasting[name[1:]]) >= limit for a in accelerations]
            first = reached.index(True)
            assert at == approx(accelerations[first] / 9.81)
            assert below == approx(accelerations[first - 1] / 9.81 if first else 0)
    whole, cracked = (one.fragility(limit).median.value for one in groups.values())
    assert cracked < 0.9 * whole
    words = [str(out), "--measure", column, "--limit", str(limit)]
    assert report.main([*words, "--by", "damage"]) == 0
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    made = ElementTree.parse(out / "fragility.xml").iter(f"{space}fragilityFunction")
    assert [one.get("id") for one in made] == [f"out_damage_{name}" for name in ("0_0", "1_0")]
    assert report.main([*words, "--by", "scale"]) == 2
