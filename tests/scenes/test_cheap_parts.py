# SPDX-License-Identifier: GPL-2.0-or-later
"""A cheap part of each study of validation/ that has no other test, beside what the study has found
before."""

from hosted import *

FOLDER = os.path.join(ROOT, "validation")
BONDS = "+".join(
    f"{side}.{name}" for side in ("bed", "head") for name in ("cohesion", "tensileStrength")
)


def rows(path, **wanted):
    """Rows of a .csv below validation/ with these cells."""
    with open(os.path.join(FOLDER, path), encoding="utf-8") as file:
        found = [row for row in csv.DictReader(file) if wanted.items() <= row.items()]
    assert found, wanted
    return found


def predicted(path, wall, name, key):
    return float(rows(path, **{key: wall})[0][name])


def reference(wall):
    """The peak of the fine and slow run of a wall [kN]."""
    with open(os.path.join(FOLDER, "accuracy", "accuracy.json")) as file:
        found = json.load(file)
    return next(r["reference"] for r in found if (r["wall"], r["quantity"]) == (wall, "peak"))


PEAK = "peak_at_both_ends_kN"
CREST = "largest_displacement_of_crest_y"
#: Program, its options, a number of run.json or an answer, its value, and how near it must be: as
#: near as on other machines; what the preset fast promises; three deviations of a field.
RUNS = {
    "accuracy": (
        "accuracy/walls.py",
        "--shape long-low --masonry granite --preset fast",
        PEAK,
        reference("long-low_granite"),
        0.06,
    ),
    "brick_walls": (
        "brick_walls/wall.py",
        "--wall 37",
        PEAK,
        predicted("brick_walls/predictions.csv", "37", "peak_kN", "N"),
        0.01,
    ),
    "stone_walls": (
        "stone_walls/wall.py",
        "--wall 22",
        PEAK,
        predicted("stone_walls/predictions.csv", "22", "peak_plus_kN", "ID"),
        0.01,
    ),
    "records": ("records/parapet.py", "", CREST, 14.7, 0.02),
    "random_fields": (
        "../scripts/wall_comp4.py",
        f"--preset fast --until 3 --field {BONDS}=lognormal(cov=0.3,length=1,seed=1)",
        PEAK,
        114.4,
        0.13,
    ),
}


@mark.parametrize("study", RUNS)
def test_a_run_of_a_study_finds_what_it_has_found(study, tmp_path):
    program, words, name, value, share = RUNS[study]
    out = ["--lean", "--out", str(tmp_path / "run")]
    runProgram(os.path.join(FOLDER, program), *words.split(), *out)
    run = readRun(str(tmp_path / "run"))
    answers = {answer["name"]: answer["value"] for answer in run["answers"]}
    assert {**run, **answers}[name] == approx(value, rel=share)


@mark.parametrize(
    "program, case",
    [("strips", "no overburden, joints of 3.54 GPa"), ("eccentric_prisms", "rigid, 3 points")],
)
def test_a_row_of_an_open_test_is_that_of_the_readme(program, case):
    said = runProgram(os.path.join(FOLDER, "open_tests", program + ".py"), "--only", case).stdout
    with open(os.path.join(FOLDER, "open_tests", "README.md")) as file:
        lines = [line for text in (file.read(), said) for line in text.splitlines()]
    own, known = (
        [float(c) for c in l.split("|")[2:-2]] for l in lines if l.startswith(f"| {case} |")
    )
    assert own == approx(known, rel=0.02, abs=0.011)
