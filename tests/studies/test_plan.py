# SPDX-License-Identifier: GPL-2.0-or-later
"""What a study says: its table as YADE reads it, and what is refused before anything runs."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT

from masonry import fields
from masonry.run import batch
from masonry.basics import Refused
from masonry.study import Study, choice, field, lognormal, normal, uniform

GRID = {
    "rate": [20, 40.5],
    "bed.cohesion+bed.tensileStrength": [1],
    "joints": ["softening"],
}


def table(tmp_path):
    study = Study(
        "any",
        options={"quick": True, "preset": None},
        vary={
            "rate": [20, 40.5],
            "joints": ["softening"],
            ("bed.friction", "head.friction"): [0.1, 0.43],
        },
        design="grid",
    )
    path = tmp_path / "table.txt"
    path.write_text(study.table())
    return path


def test_yade_reads_the_table(tmp_path):
    from yade import utils

    path = table(tmp_path)
    rows = utils.TableParamReader(str(path)).paramDict()
    assert rows == batch.readTable(str(path))
    assert [row["description"] for row in rows.values()] == [
        "0001",
        "0002",
        "0003",
        "0004",
    ]
    assert utils.readParamsFromTable(f"{path}:4", unknownOk=True) == 6
    from yade.params import table as read

    assert (read.rate, read.joints, read.quick, read.preset) == (
        40.5,
        "softening",
        True,
        None,
    )
    assert getattr(read, "bed.friction+head.friction") == 0.1


def test_a_row_is_the_words_of_a_command_line(tmp_path):
    rows = batch.readTable(str(table(tmp_path)))
    assert batch.optionWords(rows[5]) == [
        "--lean",
        "--quick",
        "--rate=40.5",
        "--joints=softening",
        "--set=bed.friction=0.43",
        "--set=head.friction=0.43",
    ]


def test_a_table_of_the_users_own(tmp_path):
    path = tmp_path / "t"
    path.write_text("# mine\nrate! until # both in mm\n\n20 1\n= 2\n40 *\n")
    rows = batch.readTable(str(path))
    assert {n: batch.optionWords(r) for n, r in rows.items()} == {
        4: ["--rate=20", "--until=1"],
        5: ["--rate=20", "--until=2"],
        6: ["--rate=40"],
    }
    path.write_text("rate until\n20\n")
    with pytest.raises(Refused, match="line 2: 1 values in 2 columns"):
        batch.readTable(str(path))
    path.write_text("description rate\nslow 20\nslow 40\n")
    with pytest.raises(Refused, match="description slow names several rows"):
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
        with pytest.raises(ValueError, match="bed"):
            fields.read(wrong)


WRONG = {
    "nothing varies": dict(runs=3, vary={}),
    "runs 0 must be a whole number": dict(runs=0, vary={"rate": [1]}),
    "runs None must be a whole number": dict(vary={"rate": [1]}),
    "the grid has 2 points": dict(runs=3, vary={"rate": [1, 2]}, design="grid"),
    "must be a list of values": dict(vary={"rate": uniform(1, 2)}, design="grid"),
    "design 'best' must be one of random": dict(
        runs=1, vary={"rate": [1]}, design="best"
    ),
    "seed -1 must be": dict(runs=1, vary={"rate": [1]}, seed=-1),
    "option 'out' is the study's own": dict(
        runs=1, vary={"rate": [1]}, options={"out": "x"}
    ),
    "rate: given twice": dict(runs=1, vary={"rate": [1]}, options={"rate": 2}),
    "only a property of joints can be a field": dict(
        runs=1, vary={"rate": field(cov=0.1)}
    ),
    "has a blank or #": dict(runs=1, vary={"joints": ["soft ening"]}),
    "is no number, list, distribution": dict(runs=1, vary={"rate": {}}),
    "rate is a choice; .* until does not vary": dict(
        runs=1, vary={"rate": [1]}, correlation={("rate", "until"): 0.5}
    ),
    r"bed.friction varies with others: name it by its key in vary, \('bed.friction', 'bed.residualFriction'\)": dict(
        runs=1,
        vary={
            ("bed.friction", "bed.residualFriction"): uniform(0.4, 0.5),
            "bed.cohesion": uniform(1, 2),
        },
        correlation={("bed.cohesion", "bed.friction"): -0.5},
    ),
    "must be an option, with underscores": dict(runs=1, vary={"no-vtk": [True]}),
}


@pytest.mark.parametrize("message", WRONG)
def test_a_wrong_study_is_refused(message):
    with pytest.raises(Refused, match=f"(?s){message}"):
        Study("any", **WRONG[message])


@pytest.mark.parametrize(
    "wrong, messages",
    [
        (dict(runs=0, seed=-1, design="best"), ("design", "seed", "runs")),
        (dict(options={"out": "x"}, vary={}), ("'out'", "nothing varies", "runs")),
    ],
)
def test_all_problems_are_reported_at_once(wrong, messages):
    with pytest.raises(Refused) as refused:
        Study("any", **wrong)
    for message in messages:
        assert message in str(refused.value)


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: lognormal(-1.0, 0.2), "mean -1 must be above 0"),
        (lambda: normal(1.0, 0.0), "variation 0.0 must be above 0"),
        (lambda: uniform(2, 1), "low 2 must be below high 1"),
        (lambda: normal(1.0, 0.1, low=3, high=2), "low 3 must be below high 2"),
        (
            lambda: normal(1.0, 0.1, low=2),
            r"normal\(mean=1, cov=0.1, low=2\): its ends leave 7.62e-24 of the distribution, they must leave more than 1e-09",
        ),
        (lambda: lognormal(1.0, 0.1, high=-1), "its ends leave 0 of the distribution"),
        (
            lambda: lognormal(1.0, 0.1, low=2, high=3),
            "its ends leave 1.29e-12 of the distribution",
        ),
        (lambda: normal(-1.0, 0.1, high=-1.7), "its ends leave 1.28e-12 of the"),
        (lambda: choice(), "at least one value"),
        (lambda: choice(1, 1), "has a value twice"),
        (lambda: choice(1, 2, weights=(1,)), "as many weights"),
        (lambda: field(uniform(1, 2)), "must be lognormal or normal"),
    ],
)
def test_wrong_variables_are_refused(make, message):
    with pytest.raises(Refused, match=message):
        make()


def test_without_openturns_one_sentence_names_the_package(tmp_path):
    (tmp_path / "openturns.py").write_text(
        "raise ModuleNotFoundError('none', name='openturns')"
    )
    code = "from masonry.study import *; Study('any', runs=2, vary={'rate': uniform(1, 2)}).rows()"
    paths = os.pathsep.join([str(tmp_path), *filter(None, sys.path)])
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].endswith(
        "apt-get install --no-install-recommends python3-openturns"
    )
    # a grid of numbers needs none
    grid = code.replace(
        "runs=2, vary={'rate': uniform(1, 2)}", "design='grid', vary={'rate': [1, 2]}"
    )
    subprocess.run(
        [sys.executable, "-c", grid],
        env={**os.environ, "PYTHONPATH": paths},
        check=True,
    )


def test_scenes_are_found_by_their_name():
    study = Study("wall_comp4", runs=1, vary={"rate": [20]})
    near = os.path.join(ROOT, "validation", "sensitivity")
    assert study.script(near)[0] == os.path.join(ROOT, "scripts", "wall_comp4.py")
    with pytest.raises(Refused, match="no scene wall_comp44; looked in "):
        Study("wall_comp44", runs=1, vary={"rate": [20]}).script(near)
