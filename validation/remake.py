# SPDX-License-Identifier: GPL-2.0-or-later
"""Keeps all results of this folder of one age: knows what makes each, finds what is stale, and
makes it anew.

/usr/bin/python3 validation/remake.py --list                 # what there is, its age and duration
/usr/bin/python3 validation/remake.py [NAME ...]             # makes what is stale of these or all
/usr/bin/python3 validation/remake.py --minutes 10           # what is stale and takes no longer
/usr/bin/python3 validation/remake.py --force NAME           # makes it although it is not stale
/usr/bin/python3 validation/remake.py --table                # only writes the table of README.md

NAME may be a folder, as trade, or one of its results, as wall_comp4/rigid.

A result is stale if what decides its numbers has changed since it was made: a number of
tests/references by more than TOLERANCE, which a change of the law, the scheme or a default moves
and a change of the structure does not; the usual options; the materials; or its own program, scene
and case, without their comments. made.json records the fingerprint of these, the commit, the date
and the time of each; git has the references of that commit. A result without a record has the date
and the commit of its files.

What is stopped goes on with the same command. Runs that an older state of the code has left in
results/ are removed before a result is made, since studies take what is there. Text that quotes
numbers is not changed: read it when its result is new.
"""

import argparse
import ast
import fnmatch
import glob
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, replace  # noqa: F401

import studies
from masonry.run.option_table import USUAL
from masonry.run.presets import PRESETS
from studies import HERE, RESULTS, ROOT

MADE = os.path.join(HERE, "made.json")
README = os.path.join(HERE, "README.md")
MARKS = "<!-- remake.py: begin -->", "<!-- remake.py: end -->"
PYTHON = sys.executable
YADE = ["yade", "-n", "-x"]

#: Change of a number of a stored reference, over the largest of its quantity at an instant, from
#: which on a result is stale.
TOLERANCE = 1e-3
#: Quantities of a stored reference that are no answer.
NO_ANSWERS = {"fingerprint", "error of the balance [-]"}

#: What decides the numbers of every result, beside its own sources and the usual options; patterns
#: below the root of the repository.
COMMON = ["scripts/masonry/materials/sources.py"]
#: Families of stored references: a result depends on some of them.
RIGID = [
    "tests/references/rigid*.json",
    "tests/references/couplets*.json",
    "tests/references/collapse*.json",
]
DEFORMABLE = ["tests/references/deformable*.json"]
CYCLIC = ["tests/references/cyclic*.json"]
RIG = "results/validation/dry_joint_walls/rig"  # runs with the base that gives way
FLYING = ["tests/references/flying*.json"]
IMPACTS = ["tests/references/impacts.json"]
ALL = RIGID + DEFORMABLE + CYCLIC + FLYING + IMPACTS


@dataclass(frozen=True)
class Result:
    """Numbers, a table or figures of this folder.

    :param name: folder, or folder/part
    :param commands: lists of words, run from the root of the repository, one after another
    :param makes: files that are committed, as patterns below validation/; none if its numbers stand
        in the README alone
    :param sources: patterns below the root of what decides its numbers, beside COMMON
    :param minutes: on one core, about
    :param results: folders below results/ that it uses, and that are of no use when it is stale
    :param needs: names of results that are made before it
    :param limits: whether an exit status of 1 says that a limit is missed, which is a result, too
    """

    name: str
    commands: tuple
    makes: tuple = ()
    sources: tuple = ()
    minutes: float = 1
    results: tuple = ()
    needs: tuple = ()
    limits: bool = False


#: Minutes of the runs of cases, those of other names a third of a minute.
CASE_MINUTES = {
    "wall_comp0a/deformable*": 4,
    "wall_comp1/deformable*": 3,
    "wall_comp4/deformable*": 5,
    "wall_comp6/deformable*": 10,
    "dry_joint_walls/deformable*": 4,
}
#: Cases whose runs are made by programs of their own.
OWN = {"cyclic", "trade", "convergence"}


def ofCases():
    """A result for every run of a case, and one for its figures."""
    cases = sorted(
        os.path.basename(os.path.dirname(p))
        for p in glob.glob(os.path.join(HERE, "*", "case.json"))
    )
    for case in [case for case in cases if case not in OWN]:
        names = []
        for run, chosen in studies.readCase(case).items():
            if run == "quick":
                continue
            name = f"{case}/{run}"
            names.append(name)
            soft = "deformable" in chosen["options"]
            needs = sorted(
                {
                    f"{b}/{run}"
                    for pair in chosen["limits"].values()
                    for b in pair
                    if isinstance(b, str)
                }
            )
            yield Result(
                name,
                ((PYTHON, "validation/validate.py", case, run),),
                sources=(
                    f"validation/{case}/case.json",
                    studies.scenePath(chosen["scene"]),
                    *(DEFORMABLE if soft else RIGID),
                ),
                minutes=next((m for p, m in CASE_MINUTES.items() if fnmatch.fnmatch(name, p)), 0.3),
                results=(f"validation/{case}/{run}",),
                needs=tuple(needs),
                limits=True,
            )
        if case == "dry_joint_walls":
            yield Result(
                f"{case}/envelopes",
                ((PYTHON, f"validation/{case}/compare.py"),),
                (f"{case}/envelopes.png",),
                ("validation/dry_joint_walls/compare.py",),
                0.2,
                needs=tuple(names),
            )
            yield Result(
                f"{case}/figures",
                ((PYTHON, f"validation/{case}/pattern.py"),),
                (f"{case}/cracks.png",),
                (f"validation/{case}/pattern.py", "scripts/gallery/wall_dry.py", *RIGID),
                0.3,
            )
            continue
        figures = (f"{case}/curve*.png", f"{case}/cracks*.png")
        yield Result(
            f"{case}/figures",
            ((PYTHON, "validation/figures.py", case),),
            figures,
            ("validation/figures.py",),
            0.3,
            needs=tuple(names),
        )


#: Folders of the studies of stone walls, and the walls whose crack patterns are drawn.
RUNS_OF_STONE = [f"results/validation/stone_walls/{name}" for name in ("push", "cycles")]
CRACKED = ("5", "13", "22", "50", "120")


def ofStudies():
    """The results of the studies, each with a program of its own."""
    program = lambda path, *words: (PYTHON, f"validation/{path}", *words)
    inYade = lambda path, *words: (*YADE, f"validation/{path}", *words)
    own = lambda folder: (f"validation/{folder}/*.py", f"validation/{folder}/case.json")
    walls = ("scripts/wall_comp*.py",)
    module = lambda *words: (PYTHON, "-m", *words)
    study = lambda path: (
        module("masonry_study", f"validation/{path}.py", "--out", f"results/validation/{path}"),
        module("masonry_study.report", f"results/validation/{path}"),
    )
    loops = [(law, law) for law in ("cyclic", "softening")]
    return [
        Result(
            "closed_forms",
            (inYade("closed_forms/closed_forms.py"),),
            (),
            (*own("closed_forms"), *ALL),
            3,
            limits=True,
        ),
        Result(
            "closed_forms/convergence",
            (inYade("closed_forms/convergence.py"),),
            (),
            (*own("closed_forms"), *RIGID),
            3,
        ),
        Result(
            "contact",
            (inYade("contact/contact.py"),),
            (),
            (*own("contact"), *RIGID, *FLYING),
            5,
            limits=True,
        ),
        Result(
            "statics",
            (inYade("statics/statics.py", "--sample", "500", "--seed", "31"),),
            (),
            (*own("statics"), *ALL),
            10,
        ),
        Result(
            "barrel_vault",
            (program("barrel_vault/barrel_vault.py"),),
            (),
            (*own("barrel_vault"), "scripts/masonry/scene/compas_*.py", *RIGID),
            1,
            limits=True,
        ),
        Result(
            "held_loads",
            (inYade("held_loads/held_loads.py"),),
            (),
            (*own("held_loads"), *RIGID),
            6,
            limits=True,
        ),
        Result(
            "stability/map",
            (inYade("stability/stability.py"),),
            ("stability/map.png",),
            ("validation/stability/stability.py", *ALL),
            9,
            limits=True,
        ),
        Result(
            "stability/onset",
            (inYade("stability/onset.py"),),
            (),
            ("validation/stability/onset.py", *ALL),
            2,
            limits=True,
        ),
        Result(
            "stability/invariance",
            (inYade("stability/invariance.py"),),
            (),
            ("validation/stability/invariance.py", *RIGID),
            0.5,
            limits=True,
        ),
        Result(
            "stability/extremes",
            (
                inYade("stability/extremes.py"),
                inYade("stability/extremes.py", "--falls", "--scenes", "40"),
            ),
            (),
            ("validation/stability/extremes.py", *ALL),
            8,
            limits=True,
        ),
        Result(
            "stability/soak",
            (inYade("stability/soak.py"),),
            (),
            ("validation/stability/soak.py", *RIGID),
            5,
        ),
        *(
            Result(
                f"dry_joint_walls/loops_{law}",
                (program("dry_joint_walls/compare_loops.py", "--joints", joints),),
                (f"dry_joint_walls/loops_{law}*",),
                (
                    "validation/dry_joint_walls/compare_loops.py",
                    "validation/dry_joint_walls/blind.json",
                    "scripts/gallery/wall_dry.py",
                    *RIGID,
                    *CYCLIC,
                ),
                20,
                (f"validation/dry_joint_walls/loops_{law}*",),
            )
            for law, joints in loops
        ),
        Result(
            "dry_joint_walls/rig",
            (
                *(
                    inYade("dry_joint_walls/rig.py", *f"--rig {k} --no-vtk --out {RIG}_{k}".split())
                    for k in ("0", "37")
                ),
                program("dry_joint_walls/reversals.py"),
            ),
            ("dry_joint_walls/reversals.md", "dry_joint_walls/reversals.png"),
            (*own("dry_joint_walls"), "validation/stone_walls/rules.py", *RIGID, *CYCLIC),
            16,
            ("validation/dry_joint_walls/rig_*", "validation/dry_joint_walls/reversals"),
        ),
        Result(
            "dry_joint_walls/plain_wall",
            (program("dry_joint_walls/plain_wall.py"),),
            (),
            ("validation/dry_joint_walls/plain_wall.*",),
            5,
        ),
        Result(
            "cyclic/joint",
            (inYade("cyclic/joint.py"), program("cyclic/figures.py")),
            ("cyclic/joint.png",),
            (*own("cyclic"), *CYCLIC),
            0.5,
            ("validation/cyclic/joint",),
        ),
        Result(
            "cyclic/walls",
            (program("cyclic/walls.py"),),
            ("cyclic/walls.md", "cyclic/loops_*.png", "cyclic/degradation.png"),
            (*own("cyclic"), *walls, *RIGID, *CYCLIC),
            15,
            ("validation/cyclic/comp*",),
        ),
        Result(
            "convergence",
            (program("convergence/converge.py"),),
            ("convergence/curves.png",),
            (*own("convergence"), *walls, *DEFORMABLE),
            60,
            ("validation/convergence",),
        ),
        Result(
            "trade",
            (program("trade/trade.py"),),
            ("trade/*.png", "trade/table.md", "trade/trade.json"),
            (*own("trade"), *walls, *RIGID, *DEFORMABLE),
            300,
            ("trade",),
        ),
        Result(
            "accuracy",
            (program("accuracy/accuracy.py"),),
            ("accuracy/table.md", "accuracy/accuracy.json"),
            (*own("accuracy"), "scripts/masonry/run/accuracy.py", *RIGID, *DEFORMABLE),
            50,
            ("accuracy",),
            ("trade",),
        ),
        Result(
            "sensitivity/tornado",
            (program("sensitivity/tornado.py"),),
            ("sensitivity/tornado.png",),
            (
                "validation/sensitivity/tornado.py",
                *walls,
                *RIGID,
            ),
            45,
            ("validation/sensitivity/COMP-*",),
        ),
        Result(
            "random_fields/one_metre",
            study("random_fields/one_metre"),
            ("random_fields/*_one_metre.png",),
            ("validation/random_fields/*.py", *RIGID),
            20,
            ("validation/random_fields/one_metre",),
        ),
        Result(
            "random_fields/one_brick",
            study("random_fields/one_brick"),
            ("random_fields/*_one_brick.png",),
            ("validation/random_fields/*.py", *RIGID),
            20,
            ("validation/random_fields/one_brick",),
        ),
        Result(
            "open_tests",
            tuple(
                inYade(f"open_tests/{name}.py")
                for name in ("shear_walls", "panels", "strips", "specimens", "eccentric_prisms")
            ),
            (),
            ("validation/open_tests/*.py", *RIGID, *DEFORMABLE),
            40,
        ),
        Result(
            "records",
            (
                *(
                    (
                        PYTHON,
                        "-m",
                        "masonry_study",
                        f"validation/records/ida_{name}.py",
                        "--out",
                        f"results/validation/records/{name}",
                    )
                    for name in ("parapet", "gable", "facade")
                ),
                program("records/results.py", "results/validation/records"),
            ),
            ("records/fragility.xml", "records/fragility.png"),
            ("validation/records/*.py", *RIGID, *IMPACTS),
            20,
            ("validation/records",),
        ),
        Result(
            "stone_walls",
            (
                *(study(f"stone_walls/{name}")[0] for name in ("push", "cycles")),
                *(
                    program(*words, *RUNS_OF_STONE)
                    for words in (("stone_walls/results.py",), ("stone_walls/figures.py", "peaks"))
                ),
            ),
            ("stone_walls/table.md", "stone_walls/peaks.png"),
            (*own("stone_walls"), *RIGID, *CYCLIC),
            70,
            ("validation/stone_walls/push", "validation/stone_walls/cycles"),
        ),
        Result(
            "stone_walls/opened",
            (
                program("stone_walls/results.py", "--opened"),
                program("stone_walls/figures.py", "opened"),
            ),
            ("stone_walls/opened.md", "stone_walls/opened.png"),
            (*own("stone_walls"), "validation/stone_walls/predictions.csv"),
        ),
        Result(
            "stone_walls/cracks",
            (
                *(
                    inYade(
                        "stone_walls/wall.py",
                        "--wall",
                        wall,
                        "--out",
                        f"results/validation/stone_walls/cracks/{wall}",
                    )
                    for wall in CRACKED
                ),
                program(
                    "stone_walls/figures.py",
                    "cracks",
                    *(f"results/validation/stone_walls/cracks/{wall}" for wall in CRACKED),
                ),
            ),
            ("stone_walls/cracks.png",),
            (*own("stone_walls"), *RIGID, *CYCLIC),
            1,
            ("validation/stone_walls/cracks",),
        ),
        Result(
            "calibration",
            (program("calibration/blind.py"),),
            ("calibration/table.md", "calibration/case1.png"),
            (
                *own("calibration"),
                "scripts/gallery/couplet.py",
                "scripts/masonry_study/calibrate.py",
                *RIGID,
            ),
            10,
            ("validation/calibration",),
            limits=True,
        ),
    ]


def everything():
    """All results by their names, each after those that it needs; what needs nothing stands in the
    order of its time."""
    found = {r.name: r for r in [*ofCases(), *ofStudies()]}
    ordered = {}

    def add(result, above=()):
        if result.name in above:
            raise ValueError(f"{result.name} needs itself")
        for name in result.needs:
            add(found[name], (*above, result.name))
        ordered[result.name] = result

    for result in sorted(found.values(), key=lambda r: r.minutes):
        add(result)
    return ordered


# -- how old a result is ---------------------------------------------------------------------------


def sourcesOf(result, every):
    """Paths below ROOT of what decides the numbers of a result and of those that it needs."""
    found = {}
    for pattern in [*COMMON, *result.sources]:
        paths = sorted(glob.glob(os.path.join(ROOT, pattern)))
        found.update(dict.fromkeys(os.path.relpath(path, ROOT) for path in paths))
    for name in result.needs:
        found.update(dict.fromkeys(sourcesOf(every[name], every)))
    return list(found)


def isReference(path):
    return path.startswith(os.path.join("tests", "references", ""))


def fingerprint(result, every=None):
    """What decides the numbers of a result beside the references, as a text."""
    digest = hashlib.sha256(json.dumps([USUAL, PRESETS], sort_keys=True).encode())
    for path in sourcesOf(result, every or everything()):
        if not isReference(path):
            digest.update(path.encode())
            digest.update(_meaning(os.path.join(ROOT, path)))
    return digest.hexdigest()[:16]


def _meaning(path):
    """What a file says, a program without comments and docstrings."""
    with open(path, "rb") as file:
        text = file.read()
    if path.endswith(".py"):
        tree = ast.parse(text)
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list):
                node.body = [one for one in body if not _isText(one)]
        text = ast.dump(tree).encode()
    return text


def movedReferences(result, commit, every):
    """Those of the references of a result that have moved since a commit by more than TOLERANCE."""
    moved = []
    for path in filter(isReference, sourcesOf(result, every)):
        with open(os.path.join(ROOT, path)) as file:
            now = _instants(file.read())
        if not _agree(_instants(git("show", f"{commit.rstrip('+')}:{path}")), now):
            moved.append(path)
    return moved


def _instants(text):
    """Numbers of a stored reference by instant and quantity; none of an empty text."""
    found = {}
    for instant, quantities in json.loads(text or "{}").get("instants", {}).items():
        for quantity, values in quantities.items():
            if quantity not in NO_ANSWERS:
                found[instant, quantity] = [float.fromhex(value) for value in values.split()]
    return found


def _agree(old, new):
    if {key: len(values) for key, values in old.items()} != {k: len(v) for k, v in new.items()}:
        return False
    return all(
        abs(a - b) <= TOLERANCE * max(map(abs, values))
        for key, values in old.items()
        for a, b in zip(values, new[key])
    )


def _isText(statement):
    """Whether a statement is a text alone, as a docstring."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def readMade():
    """made.json: a dict by the names of results; empty if there is none."""
    if not os.path.exists(MADE):
        return {}
    with open(MADE) as file:
        return json.load(file)


def git(*words):
    """What git says, without the end of its line; empty where it says nothing."""
    done = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True)
    return done.stdout.strip()


def commitOf(result):
    """Commit and date of the files of a result, as git has them, or of its README."""
    paths = [f"validation/{p}" for p in result.makes] or [
        f"validation/{result.name.split('/')[0]}/README.md"
    ]
    return git("log", "-1", "--format=%h %cs", "--", *paths).split() or ["-", "-"]


def stateOf(result, made, every):
    """How old a result is: ``fresh``, ``stale`` or ``unrecorded``, with the commit and the date of
    its making."""
    known = made.get(result.name)
    if not known:
        return ("unrecorded", *commitOf(result))
    same = known["fingerprint"] == fingerprint(result, every)
    fresh = same and not movedReferences(result, known["commit"], every)
    return "fresh" if fresh else "stale", known["commit"], known["date"]


# -- making ----------------------------------------------------------------------------------------


def make(result, now):
    """Run the commands of a result. Returns whether they came to their end.

    Runs of an older fingerprint are removed before; those of this one, of an attempt that was
    stopped, are taken.
    """
    under = os.path.join(RESULTS, "remake", result.name.replace("/", "_") + ".txt")
    os.makedirs(os.path.dirname(under), exist_ok=True)
    before = open(under).read() if os.path.exists(under) else None
    if before != now:
        for pattern in result.results:
            for path in glob.glob(os.path.join(RESULTS, pattern)):
                shutil.rmtree(path, ignore_errors=True)
        with open(under, "w") as file:
            file.write(now)
    for command in result.commands:
        print("$", " ".join(command), flush=True)
        status = subprocess.run(command, cwd=ROOT).returncode
        if status not in ((0, 1) if result.limits else (0,)):
            print(f"{result.name}: exit status {status}; the same command goes on", flush=True)
            return False
        if status:
            print(f"{result.name}: a limit is missed", flush=True)
    os.remove(under)
    return True


def builtFrom():
    """The commit of the plugin that runs use. Raises SystemExit if that is none of the state of the
    sources here."""
    done = subprocess.run(
        [PYTHON, "-c", "import masonry; print(masonry.commit)"], capture_output=True, text=True
    )
    built = done.stdout.strip()
    commit = built.split("-")[0].rstrip("+")
    known = commit and git("rev-parse", "--verify", "--quiet", commit + "^{commit}")
    if not known:
        raise SystemExit(
            f"the plugin that is installed is of commit {built or '-'}, which is not known here:"
            " bash scripts/setup.sh"
        )
    changed = git("diff", "--name-only", commit, "--", "yade_plugin", "scripts/masonry")
    if changed:
        some = ", ".join(changed.splitlines()[:3])
        raise SystemExit(
            f"the plugin that is installed is of commit {built}, and {some} have changed since:"
            " bash scripts/setup.sh"
        )
    return built


def record(result, now, seconds, built):
    """Write down in made.json that a result was made, by the plugin of a commit."""
    entry = {
        "commit": built,
        "date": time.strftime("%Y-%m-%d"),
        "fingerprint": now,
        "minutes": round(seconds / 60, 1),
    }
    made = {**readMade(), result.name: entry}
    with open(MADE + ".new", "w") as file:
        json.dump(made, file, indent=1, sort_keys=True)
        file.write("\n")
    os.replace(MADE + ".new", MADE)


def table(every):
    """The table of validation/README.md: results of a folder in one line if they are of one state,
    commit and date."""
    made, rows = readMade(), {}
    for result in every.values():
        state, commit, date = stateOf(result, made, every)
        folder, _, part = result.name.partition("/")
        key = folder, state, commit, date
        parts, minutes = rows.get(key, ([], 0))
        taken = made.get(result.name, {}).get("minutes", result.minutes)
        rows[key] = [*parts, part or "all"], minutes + taken
    cells = [
        [
            f"[{folder}]({folder}/README.md)",
            ", ".join(sorted(parts)),
            state,
            commit,
            date,
            f"{minutes:.0f}" if minutes >= 1 else "< 1",
        ]
        for (folder, state, commit, date), (parts, minutes) in sorted(rows.items())
    ]
    return studies.table(
        ["folder", "results", "state", "commit", "date", "minutes of a core"], cells
    )


def writeTable(every):
    """Write the table into validation/README.md."""
    with open(README) as file:
        text = file.read()
    begin, end = map(re.escape, MARKS)
    new, count = re.subn(
        f"(?<={begin}\n).*?(?={end})", lambda _: table(every) + "\n", text, flags=re.DOTALL
    )
    if count != 1:
        raise SystemExit(f"{README}: the marks {' and '.join(MARKS)} must be there once")
    if new != text:
        with open(README, "w") as file:
            file.write(new)


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="results or folders (default: all)"
    )
    parser.add_argument("--list", action="store_true", help="only say what there is")
    parser.add_argument("--table", action="store_true", help="only write the table of README.md")
    parser.add_argument("--force", action="store_true", help="make also what is not stale")
    parser.add_argument(
        "--minutes", type=float, default=float("inf"), help="leave out what takes longer"
    )
    parser.add_argument(
        "--built",
        metavar="COMMIT",
        help="commit of the plugin that is used, if it cannot be found out",
    )
    args = parser.parse_args(words)
    every, made = everything(), readMade()
    unknown = [n for n in args.names if not any(r == n or r.startswith(n + "/") for r in every)]
    if unknown:
        parser.error(f"no result {', '.join(unknown)}; there are {', '.join(every)}")
    wanted = [
        r
        for r in every.values()
        if not args.names or any(r.name == n or r.name.startswith(n + "/") for n in args.names)
    ]
    if args.table:
        writeTable(every)
        return 0
    if args.list:
        for result in wanted:
            state, commit, date = stateOf(result, made, every)
            minutes = made.get(result.name, {}).get("minutes", result.minutes)
            print(
                f"{result.name:32} {state:10} {commit:10} {date:10} {minutes:6.1f} min "
                f" {' && '.join(' '.join(c) for c in result.commands)}"
            )
        return 0
    failed, built = [], args.built or builtFrom()
    for result in wanted:
        fresh = stateOf(result, made, every)[0] == "fresh"
        if fresh and not args.force or result.minutes > args.minutes:
            continue
        print(f"-- {result.name}: some {result.minutes:g} min", flush=True)
        now, began = fingerprint(result, every), time.perf_counter()
        if make(result, now):
            record(result, now, time.perf_counter() - began, built)
            writeTable(every)
        else:
            failed.append(result.name)
    if failed:
        print("not made:", ", ".join(failed))
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("\ninterrupted: the same command goes on")
        sys.exit(130)
