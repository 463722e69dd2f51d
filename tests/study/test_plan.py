# SPDX-License-Identifier: GPL-2.0-or-later
"""What a study says: its table as YADE reads it, and what is refused before anything runs."""

from usual import *
from masonry import fields
from masonry.run import batch
from masonry_study import Study, choice, field, lognormal, normal, uniform


@pytest.fixture
def table(tmp_path):
    """The path of the table of a grid."""
    friction = ("bed.friction", "head.friction")
    vary = {"rate": [20, 40.5], "joints": ["softening"], friction: [0.1, 0.43]}
    options = {"quick": True, "preset": None}
    study = Study("any", options=options, vary=vary, design="grid")
    (tmp_path / "table.txt").write_text(study.table())
    return str(tmp_path / "table.txt")


def test_yade_reads_the_table(table):
    from yade import utils

    rows = utils.TableParamReader(table).paramDict()
    assert rows == batch.readTable(table)
    assert [r["description"] for r in rows.values()] == "0001 0002 0003 0004".split()
    assert utils.readParamsFromTable(f"{table}:4", unknownOk=True) == 6
    from yade.params import table as read

    assert (read.rate, read.joints) == (40.5, "softening")
    assert read.quick is True and read.preset is None
    assert getattr(read, "bed.friction+head.friction") == 0.1


def test_a_row_is_the_words_of_a_command_line(table):
    words = "--lean --quick --rate=40.5 --joints=softening"
    words += " --set=bed.friction=0.43 --set=head.friction=0.43"
    assert batch.optionWords(batch.readTable(table)[5]) == words.split()


def test_a_table_of_the_users_own(tmp_path):
    path = tmp_path / "t"
    path.write_text("# mine\nrate! until # both in mm\n\n20 1\n= 2\n40 *\n")
    rows = batch.readTable(str(path))
    found = {n: " ".join(batch.optionWords(r)) for n, r in rows.items()}
    assert found == {4: "--rate=20 --until=1", 5: "--rate=20 --until=2", 6: "--rate=40"}
    for text, message in (
        ("rate until\n20\n", "line 2: 1 values in 2 columns"),
        ("description rate\nslow 20\nslow 40\n", "slow names several rows"),
    ):
        path.write_text(text)
        with raises(Refused, match=message):
            batch.readTable(str(path))


def test_a_field_is_read_as_it_is_written():
    made = field(lognormal(2.0, 0.3), length=0.5)
    text = f"bed.cohesion+head.cohesion={made.written(7)}"
    names, function = fields.read(text)
    assert names == ["bed.cohesion", "head.cohesion"]
    same = fields.lognormal(0.3, 0.5, 7)
    assert function(1, 0, 0.5) == same(1, 0, 0.5) != 1
    for wrong in (
        "bed.cohesion=lognormal(0.3)",
        "bed=lognormal(cov=0.3,length=0,seed=1)",
        "bed.cohesion=lognormal(cov=x,length=0,seed=1)",
    ):
        with raises(ValueError, match="bed"):
            fields.read(wrong)


ONE = {"rate": [1]}
BOTH = ("bed.friction", "bed.residualFriction")
TIED = {BOTH: uniform(1, 2), "bed.cohesion": uniform(1, 2)}
PAIR = {("bed.cohesion", "bed.friction"): -0.5}
FIELD = {BOTH: uniform(1, 2), "bed.cohesion": field(cov=0.3)}


@mark.parametrize(
    "wrong, message",
    [
        (dict(runs=3, vary={}), "nothing varies"),
        (dict(vary=ONE), "runs None must be a whole number"),
        (dict(runs=3, vary={"rate": [1, 2]}, design="grid"), "the grid has 2 points"),
        (dict(vary={"rate": uniform(1, 2)}, design="grid"), "must be a list of values"),
        (dict(runs=1, vary=ONE, design="best"), "'best' must be one of random"),
        (dict(runs=1, vary=ONE, options={"out": "x"}), "'out' is the study's own"),
        (dict(runs=1, vary=ONE, options={"rate": 2}), "rate: given twice"),
        (dict(runs=1, vary={"rate": field(cov=0.1)}), "of joints can be a field"),
        (dict(runs=1, vary={"joints": ["soft ening"]}), "has a blank or #"),
        (dict(runs=1, vary={"rate": {}}), "is no number, list, distribution"),
        (dict(runs=1, vary={"no-vtk": [True]}), "must be an option, with underscores"),
        (dict(runs=1, vary=ONE, correlation={("rate", "x"): 0.5}), "x does not vary"),
        (dict(runs=1, vary=FIELD, correlation=PAIR), "bed.cohesion varies as a field; only"),
        (
            dict(runs=1, vary=TIED, correlation={**PAIR, ("bed.cohesion", BOTH): 0.5}),
            "given twice",
        ),
    ],
)
def test_a_wrong_study_is_refused(wrong, message):
    with raises(Refused, match=message):
        Study("any", **wrong)


@mark.parametrize("key", ["bed.friction", "bed.residualFriction", BOTH, "+".join(BOTH)])
def test_a_correlation_names_a_tuple_or_one_of_it(key):
    study = Study("any", runs=1, vary=TIED, correlation={("bed.cohesion", key): -0.5})
    assert study.correlation == {("bed.cohesion", "+".join(BOTH)): -0.5}


@mark.parametrize(
    "wrong, messages",
    [
        (dict(runs=0, seed=-1, design="best"), ("design", "seed -1", "runs 0 must be")),
        (dict(options={"out": "x"}, vary={}), ("'out'", "nothing varies", "runs")),
    ],
)
def test_all_problems_are_reported_at_once(wrong, messages):
    with raises(Refused) as refused:
        Study("any", **wrong)
    assert all(message in str(refused.value) for message in messages)


@mark.parametrize(
    "make, message",
    [
        (lambda: uniform(2, 1), "low 2 must be below high 1"),
        (lambda: normal(1.0, 0.1, low=3, high=2), "low 3 must be below high 2"),
        (lambda: normal(1.0, 0.1, low=2), "low=2.: its ends leave 7.62e-24 of the"),
        (lambda: lognormal(1.0, 0.1, high=-1), "its ends leave 0 of the distribution"),
        (lambda: normal(-1.0, 0.1, high=-1.7), "its ends leave 1.28e-12 of the"),
        (choice, "at least one value"),
        (lambda: choice(1, 1), "has a value twice"),
        (lambda: choice(1, 2, weights=(1,)), "as many weights"),
        (lambda: field(uniform(1, 2)), "must be lognormal or normal"),
    ],
)
def test_wrong_variables_are_refused(make, message):
    with raises(Refused, match=message):
        make()


def test_a_grid_of_numbers_needs_no_openturns(monkeypatch):
    monkeypatch.setitem(sys.modules, "openturns", None)
    assert len(Study("any", design="grid", vary={"rate": [1, 2]}).rows()) == 2


def test_scenes_are_found_by_their_name():
    study = Study("wall_comp4", runs=1, vary={"rate": [20]})
    near = os.path.join(ROOT, "validation", "sensitivity")
    assert study.script(near)[0] == os.path.join(ROOT, "scripts", "wall_comp4.py")
    with raises(Refused, match="no scene wall_comp44; looked in "):
        Study("wall_comp44", runs=1, vary={"rate": [20]}).script(near)
