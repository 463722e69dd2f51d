# SPDX-License-Identifier: GPL-2.0-or-later
"""Keeps all results of this folder of one age: knows what makes each, finds what is stale, and
makes it anew.

/usr/bin/python3 validation/remake.py --list                 # what there is, its age and duration
/usr/bin/python3 validation/remake.py [NAME ...] [--jobs N]  # makes what is stale of these or all
/usr/bin/python3 validation/remake.py --minutes 10           # what is stale and takes no longer
/usr/bin/python3 validation/remake.py --force NAME           # makes it although it is not stale
/usr/bin/python3 validation/remake.py --table                # only writes the table of README.md

NAME may be a folder, as trade, or one of its results, as wall_comp4/rigid.

A result is stale if what decides its numbers has changed since it was made: a number of
tests/references by more than TOLERANCE, which a change of the law, the scheme or a default moves
and a change of the structure does not; the usual options; the materials; or the programs, scene and
case of its folder, without their comments. made.json records the fingerprint of these, the commit,
the date and the time of a core of each; git has the references of that commit.

Each result takes one core; the longest begin first. What fails or is stopped goes on with the same
command, and the others are made meanwhile. results/remake/NAME.log has what a result printed; its
tables replace those between the marks <!-- NAME: begin --> and <!-- NAME: end --> of the README of
its folder, one after another, if they are there. Other text that quotes numbers is checked by
tests/package/test_quoted.py. Runs that an older state of the code has left in results/ are removed
before a result is made, since studies take what is there.
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
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass

import studies
from masonry.run.option_table import USUAL
from masonry.run.presets import PRESETS
from studies import HERE, RESULTS, ROOT

MADE = os.path.join(HERE, "made.json")
README = "README.md"
OWN_MARK = "remake.py"  # of the table of ages
PYTHON = sys.executable
ONE_CORE = {**os.environ, "OMP_NUM_THREADS": "1"}

#: Change of a number of a stored reference, over the largest of its quantity at an instant, from
#: which on a result is stale.
TOLERANCE = 1e-3
#: Quantities of a stored reference that are no answer. How fast blocks still turn, and how many
#: subcontacts just yield, hang on the last digits: other round-off moves them by 1 per cent where
#: forces change by 3e-5 and displacements by 1e-9.
NO_ANSWERS = {
    "fingerprint",
    "error of the balance [-]",
    "spin [rad/s]",
    "subcontacts in a regime",
}

#: What decides the numbers of every result, beside its own sources and the usual options; patterns
#: below the root of the repository.
COMMON = ["scripts/masonry/materials/sources.py"]
#: Families of stored references by a letter: a result depends on some of them.
FAMILIES = {
    "r": ("rigid*", "couplets*", "collapse*"),
    "d": ("deformable*",),
    "c": ("cyclic*",),
    "f": ("flying*",),
    "i": ("impacts",),
}
ALL = "".join(FAMILIES)


@dataclass(frozen=True)
class Result:
    """Numbers, a table or figures of this folder.

    :param name: folder, or folder/part
    :param commands: lists of words, run from the root of the repository, one after another
    :param minutes: of one core, about
    :param makes: files that are committed, as patterns below validation/
    :param sources: patterns below the root of what decides its numbers, beside COMMON
    :param results: folders below results/ that it uses, and that are of no use when it is stale
    :param needs: names of results that are made before it
    :param given: what decides its numbers beside files, as a text
    """

    name: str
    commands: tuple
    minutes: float
    makes: tuple = ()
    sources: tuple = ()
    results: tuple = ()
    needs: tuple = ()
    given: str = ""


def references(letters):
    """Patterns of the stored references of the :data:`FAMILIES` of some letters."""
    return [f"tests/references/{name}.json" for one in letters for name in FAMILIES[one]]


#: Minutes of the runs of cases, those of other names a third of a minute.
CASE_MINUTES = {
    "wall_comp0a/deformable*": 0.8,
    "wall_comp1/deformable*": 0.8,
    "wall_comp4/deformable*": 0.9,
    "wall_comp6/deformable*": 1.9,
    "dry_joint_walls/deformable*": 2,
}
#: Cases whose runs are made by programs of their own.
OWN = {"cyclic", "trade"}


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
            family = "d" if "deformable" in chosen["options"] else "r"
            bounds = [bound for pair in chosen["limits"].values() for bound in pair]
            yield Result(
                name,
                (words("validate.py", case, run),),
                next((m for p, m in CASE_MINUTES.items() if fnmatch.fnmatch(name, p)), 0.3),
                sources=(studies.scenePath(chosen["scene"]), *references(family)),
                results=(f"validation/{case}/{run}",),
                needs=tuple(sorted({f"{b}/{run}" for b in bounds if isinstance(b, str)})),
                given=json.dumps(chosen),
            )
        dry = case == "dry_joint_walls"
        yield Result(
            f"{case}/figures",
            (words(f"{case}/compare.py") if dry else words("figures.py", case),),
            0.2,
            (f"{case}/envelopes.png",) if dry else (f"{case}/curve*.png", f"{case}/cracks_*.png"),
            (f"validation/{case}/compare.py" if dry else "validation/figures.py",),
            needs=tuple(names),
        )


def words(program, *more):
    """A command that runs a program of this folder without YADE."""
    return (PYTHON, f"validation/{program}", *more)


def command(text):
    """A command from a line: ``yade PROGRAM ...``, ``study FILE`` or ``report FILE`` of
    masonry_study, or ``PROGRAM ...`` without YADE."""
    first, *more = text.split()
    if first == "yade":
        return ("yade", "-n", "-x", f"validation/{more[0]}", *more[1:])
    if first in ("study", "report"):
        out = f"results/validation/{more[0]}"
        if first == "report":
            return (PYTHON, "-m", "masonry_study.report", out)
        file = f"validation/{more[0]}.py"
        return (PYTHON, "-m", "masonry_study", file, "--out", out, "--jobs", "1")
    return words(first, *more)


#: Studies of random fields.
FIELDS = "one_metre", "one_brick"
#: Walls of stone whose crack patterns are drawn.
CRACKED = "5 13 22 50 120".split()
_CRACKS = "results/validation/stone_walls/cracks/"
_STONE = "results/validation/stone_walls/push"
_BRICK = "results/validation/brick_walls/"
_RIG = "--no-vtk --out results/validation/dry_joint_walls/rig"

#: Results of programs of their own: name, commands, minutes, letters of references, files that are
#: made, and further sources.
STUDIES = (
    (
        "closed_forms",
        ["yade closed_forms/closed_forms.py", "yade closed_forms/convergence.py"],
        3,
        ALL,
    ),
    ("contact", ["yade contact/contact.py"], 4, "rf"),
    ("statics", ["yade statics/statics.py --sample 500 --seed 31"], 2, ALL),
    (
        "barrel_vault",
        ["barrel_vault/barrel_vault.py"],
        1,
        "r",
        "",
        "scripts/masonry/scene/compas_*.py",
    ),
    ("held_loads", ["yade held_loads/held_loads.py"], 4, "r"),
    ("stability/map", ["yade stability/stability.py"], 7, ALL, "stability/map.png"),
    ("stability/onset", ["yade stability/onset.py"], 2, ALL),
    ("stability/invariance", ["yade stability/invariance.py"], 2, ALL),
    (
        "stability/extremes",
        ["yade stability/extremes.py", "yade stability/extremes.py --falls --scenes 40"],
        3,
        ALL,
    ),
    ("stability/soak", ["yade stability/soak.py"], 2, "rd"),
    *(
        (
            f"dry_joint_walls/loops_{law}",
            [f"dry_joint_walls/compare_loops.py --joints {law}"],
            minutes,
            "rc",
            f"dry_joint_walls/loops_{law}*",
            "scripts/gallery/wall_dry.py",
        )
        for law, minutes in (("cyclic", 12), ("softening", 6))
    ),
    (
        "dry_joint_walls/rig",
        [
            f"yade dry_joint_walls/rig.py --rig 0 {_RIG}_0",
            f"yade dry_joint_walls/rig.py --rig 37 {_RIG}_37",
        ],
        2,
        "r",
    ),
    (
        "dry_joint_walls/reversals",
        ["dry_joint_walls/reversals.py"],
        6,
        "rc",
        "dry_joint_walls/reversals.*",
        "validation/stone_walls/rules.py",
    ),
    (
        "dry_joint_walls/pattern",
        ["dry_joint_walls/pattern.py"],
        0.3,
        "r",
        "dry_joint_walls/cracks.png",
        "scripts/gallery/wall_dry.py",
    ),
    ("dry_joint_walls/plain_wall", ["dry_joint_walls/plain_wall.py"], 5, ""),
    ("cyclic/joint", ["yade cyclic/joint.py", "cyclic/figures.py"], 0.5, "c", "cyclic/joint.png"),
    (
        "cyclic/walls",
        ["cyclic/walls.py"],
        6,
        "rc",
        "cyclic/walls.md cyclic/loops_*.png cyclic/degradation.png",
        "scripts/wall_comp*.py",
    ),
    (
        "trade",
        ["trade/trade.py"],
        15,
        "rd",
        "trade/all_walls.png trade/table.md",
        "scripts/wall_comp*.py",
    ),
    (
        "accuracy",
        ["accuracy/accuracy.py --jobs 1"],
        45,
        "rd",
        "accuracy/table.md accuracy/accuracy.json",
        "scripts/masonry/run/accuracy.py",
    ),
    (
        "sensitivity",
        ["sensitivity/tornado.py"],
        10,
        "r",
        "sensitivity/tornado.png",
        "scripts/wall_comp*.py",
    ),
    (
        "random_fields",
        [
            *(f"{kind} random_fields/{name}" for name in FIELDS for kind in ("study", "report")),
            "random_fields/results.py",
        ],
        8,
        "r",
        "random_fields/*.png",
        "scripts/wall_comp4.py",
    ),
    *(
        (f"open_tests/{name}", [f"yade open_tests/{name}.py"], minutes, "rd")
        for name, minutes in (
            ("shear_walls", 5),
            ("panels", 20),
            ("strips", 0.3),
            ("specimens", 1),
            ("eccentric_prisms", 1),
        )
    ),
    (
        "records",
        [
            *(f"study records/ida_{name}" for name in ("parapet", "gable", "facade")),
            "records/results.py results/validation/records",
        ],
        9,
        "ri",
        "records/fragility.xml records/fragility.png",
    ),
    (
        "stone_walls",
        [
            "study stone_walls/push",
            f"stone_walls/results.py {_STONE}",
            f"stone_walls/figures.py peaks {_STONE}",
        ],
        10,
        "rc",
        "stone_walls/table.md stone_walls/peaks.png",
    ),
    (
        "stone_walls/opened",
        ["stone_walls/results.py --opened", "stone_walls/figures.py opened"],
        0.3,
        "",
        "stone_walls/opened.md stone_walls/opened.png",
        "validation/stone_walls/predictions.csv",
    ),
    (
        "stone_walls/cracks",
        [
            *(f"yade stone_walls/wall.py --wall {w} --out {_CRACKS}{w}" for w in CRACKED),
            "stone_walls/figures.py cracks " + " ".join(_CRACKS + w for w in CRACKED),
        ],
        1,
        "rc",
        "stone_walls/cracks.png",
    ),
    (
        "brick_walls",
        [
            "study brick_walls/choose",
            "study brick_walls/push",
            f"brick_walls/compare.py choose {_BRICK}choose",
            f"brick_walls/compare.py predict {_BRICK}push",
        ],
        12,
        "r",
        "",
        "validation/brick_walls/walls.csv validation/stone_walls/*.py",
    ),
    (
        "calibration",
        ["calibration/blind.py --jobs 1"],
        10,
        "r",
        "calibration/table.md calibration/case1.png",
        "scripts/gallery/couplet.py scripts/masonry_study/calibrate.py",
    ),
)


def ofStudy(name, lines, minutes, letters, makes="", more=""):
    """The :class:`Result` of a row of :data:`STUDIES`."""
    folder = name.split("/")[0]
    own = [f"validation/{folder}/*.{end}" for end in ("py", "cpp")]
    own += [f"validation/{folder}/{file}" for file in ("case.json", "blind.json")]
    return Result(
        name,
        tuple(map(command, lines)),
        minutes,
        tuple(makes.split()),
        (*own, *more.split(), *references(letters)),
        tuple(f"validation/{folder}/{part}" for part in RUNS.get(name, ())),
    )


#: Folders of results/validation/FOLDER that a study uses, by its name.
RUNS = {
    "dry_joint_walls/loops_cyclic": ["loops_cyclic*"],
    "dry_joint_walls/loops_softening": ["loops_softening*"],
    "dry_joint_walls/rig": ["rig_*"],
    "dry_joint_walls/reversals": ["reversals"],
    "cyclic/joint": ["joint"],
    "cyclic/walls": ["comp*"],
    "trade": [""],
    "accuracy": [""],
    "sensitivity": ["COMP-*"],
    "random_fields": [""],
    "records": [""],
    "stone_walls": ["push"],
    "stone_walls/cracks": ["cracks"],
    "brick_walls": [""],
    "calibration": [""],
}


def everything():
    """All results by their names, each after those that it needs; what needs nothing stands in the
    order of its time, the longest first."""
    found = {r.name: r for r in [*ofCases(), *(ofStudy(*row) for row in STUDIES)]}
    ordered = {}

    def add(result, above=()):
        if result.name in above:
            raise ValueError(f"{result.name} needs itself")
        for name in result.needs:
            add(found[name], (*above, result.name))
        ordered[result.name] = result

    for result in sorted(found.values(), key=lambda r: -r.minutes):
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
    given = [USUAL, PRESETS, result.given]
    digest = hashlib.sha256(json.dumps(given, sort_keys=True).encode())
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


def stateOf(result, made, every):
    """How old a result is: ``fresh``, ``stale`` or ``unrecorded``, with the commit and the date of
    its making."""
    known = made.get(result.name)
    if not known:
        return "unrecorded", "-", "-"
    same = known["fingerprint"] == fingerprint(result, every)
    fresh = same and not movedReferences(result, known["commit"], every)
    return "fresh" if fresh else "stale", known["commit"], known["date"]


def minutesOf(result, made):
    """Minutes of a core, as they were when a result was made or about."""
    return made.get(result.name, {}).get("minutes", result.minutes)


# -- making ----------------------------------------------------------------------------------------


def make(result, now):
    """Run the commands of a result. Returns its record for made.json without commit and date, or a
    sentence that says what has failed.

    Runs of an older fingerprint are removed before; those of this one, of an attempt that was
    stopped, are taken.
    """
    log = os.path.join(RESULTS, "remake", result.name.replace("/", "_") + ".log")
    under = log.removesuffix("log") + "json"
    os.makedirs(os.path.dirname(log), exist_ok=True)
    begun = {"fingerprint": now, "seconds": 0.0}
    if os.path.exists(under):
        with open(under) as file:
            before = json.load(file)
        begun = before if before["fingerprint"] == now else begun
    if not begun["seconds"]:
        for pattern in result.results:
            for path in glob.glob(os.path.join(RESULTS, pattern)):
                shutil.rmtree(path, ignore_errors=True)
    missed = 0
    with open(log, "w") as said:
        for line in result.commands:
            status, seconds = studies.timed(
                line, cwd=ROOT, env=ONE_CORE, stdout=said, stderr=subprocess.STDOUT
            )
            begun["seconds"] += seconds
            with open(under, "w") as file:
                json.dump(begun, file)
            allowed = (0,) if "-m" in line else (0, 1)
            if status not in allowed or status and _raised(log):
                return f"exit status {status} of {' '.join(line)}: {log}"
            missed += status
    os.remove(under)
    found = {"fingerprint": now, "minutes": round(begun["seconds"] / 60, 1)}
    return {**found, "limits missed": True} if missed else found


def _raised(log):
    """Whether a program has ended with an error rather than with a missed limit."""
    with open(log) as file:
        return re.search(r"^(Traceback|\w+: error: )", file.read(), re.MULTILINE)


def makeAll(due, every, jobs, built):
    """Make results, ``jobs`` at a time, each after those that it needs. Returns those that were not
    made, with the reason."""
    due, running, failed = {r.name: r for r in due}, {}, {}
    with ThreadPoolExecutor(jobs) as pool:
        while due or running:
            for name, result in list(due.items()):
                if lost := [n for n in result.needs if n in failed]:
                    failed[name] = f"needs {', '.join(lost)}"
                    del due[name]
                elif len(running) < jobs and not any(
                    n in due or n in running.values() for n in result.needs
                ):
                    print(f"{time.strftime('%H:%M')} {name} begins", flush=True)
                    running[pool.submit(make, result, fingerprint(result, every))] = name
                    del due[name]
            for one in wait(running, return_when=FIRST_COMPLETED).done:
                name, found = running.pop(one), one.result()
                if isinstance(found, str):
                    failed[name] = found
                    print(f"{name}: {found}", flush=True)
                    continue
                record(every[name], found, built)
                writeTables(name)
                writeAges(every)
                note = ", a limit is missed" if "limits missed" in found else ""
                print(f"{name}: {found['minutes']:g} min of a core{note}", flush=True)
    return failed


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


def record(result, found, built):
    """Write down in made.json that a result was made, by the plugin of a commit."""
    entry = {"commit": built, "date": time.strftime("%Y-%m-%d"), **found}
    made = {**readMade(), result.name: entry}
    with open(MADE + ".new", "w") as file:
        json.dump(made, file, indent=1, sort_keys=True)
        file.write("\n")
    os.replace(MADE + ".new", MADE)


# -- tables ----------------------------------------------------------------------------------------


def ages(every):
    """The table of validation/README.md: results of a folder in one line if they are of one state,
    commit and date."""
    made, rows = readMade(), {}
    for result in every.values():
        state, commit, date = stateOf(result, made, every)
        folder, _, part = result.name.partition("/")
        parts, minutes = rows.get((folder, state, commit, date), ([], 0))
        rows[folder, state, commit, date] = [*parts, part or "all"], minutes + minutesOf(
            result, made
        )
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
    total = sum(minutes for _, minutes in rows.values())
    heads = ["folder", "results", "state", "commit", "date", "minutes of a core"]
    return studies.table(heads, [*cells, ["all", "", "", "", "", f"{total:.0f}"]])


def put(text, name, tables):
    """A document with other tables between the marks of a name: one between each pair of marks,
    between the last pair all that are left."""
    begin, end = (re.escape(f"<!-- {name}: {word} -->") for word in ("begin", "end"))
    marks = re.compile(f"(?<={begin}\n).*?(?={end})", re.DOTALL)
    left, places = list(tables), len(marks.findall(text))

    def one(found):
        nonlocal places
        places -= 1
        mine = [left.pop(0)] if places else left
        return "\n".join(mine)

    return marks.sub(one, text)


def _write(path, name, tables):
    with open(path) as file:
        text = file.read()
    new = put(text, name, tables)
    if new != text:
        with open(path, "w") as file:
            file.write(new)


def writeAges(every):
    """Write the table of ages into validation/README.md."""
    _write(os.path.join(HERE, README), OWN_MARK, [ages(every) + "\n"])


def tablesOf(text):
    """The tables of what a program has printed, also where it says something between two rows."""
    lines = [line for line in text.splitlines(keepends=True) if line.startswith("|")]
    tables = []
    for line, after in zip(lines, [*lines[1:], "."]):
        if set(after.strip()) <= set("|- ") or not tables:
            tables.append("")
        tables[-1] += line
    return tables


def writeTables(name):
    """Write the tables that a result has printed into the README of its folder."""
    with open(os.path.join(RESULTS, "remake", name.replace("/", "_") + ".log")) as file:
        tables = tablesOf(file.read())
    path = os.path.join(HERE, name.split("/")[0], README)
    if tables and os.path.exists(path):
        _write(path, name, tables)


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
    cores = len(os.sched_getaffinity(0))
    parser.add_argument("--jobs", type=int, default=cores, help="results at a time (%(default)s)")
    parser.add_argument(
        "--built",
        metavar="COMMIT",
        help="commit of the plugin that is used, if it cannot be found out",
    )
    args = parser.parse_args(words)
    every, made = everything(), readMade()
    of = lambda result, names: any(result == n or result.startswith(n + "/") for n in names)
    if unknown := [n for n in args.names if not any(of(r, [n]) for r in every)]:
        parser.error(f"no result {', '.join(unknown)}; there are {', '.join(every)}")
    wanted = [r for r in every.values() if not args.names or of(r.name, args.names)]
    if args.table:
        writeAges(every)
        return 0
    if args.list:
        for result in wanted:
            state, commit, date = stateOf(result, made, every)
            print(
                f"{result.name:32} {state:10} {commit:10} {date:10}"
                f" {minutesOf(result, made):6.1f} min "
                f" {' && '.join(' '.join(c) for c in result.commands)}"
            )
        return 0
    due = [
        r
        for r in wanted
        if (args.force or stateOf(r, made, every)[0] != "fresh")
        and minutesOf(r, made) <= args.minutes
    ]
    began = time.perf_counter()
    failed = makeAll(due, every, args.jobs, due and (args.built or builtFrom()))
    for name, why in failed.items():
        print(f"not made: {name}, {why}")
    minutes = (time.perf_counter() - began) / 60
    print(f"made {len(due) - len(failed)} of {len(due)} results in {minutes:.0f} min")
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("\ninterrupted: the same command goes on")
        sys.exit(130)
