# SPDX-License-Identifier: GPL-2.0-or-later
"""Processor seconds and steps of whole runs, of one build or of several side by side.

    /usr/bin/python3 validation/benchmark/table.py                 # the plugin that is installed
    /usr/bin/python3 validation/benchmark/table.py NEW OLD OLDER   # checkouts with their plugin
    /usr/bin/python3 validation/benchmark/table.py NEW OLD --rows house "fast COMP-4"

The builds take turns, and of each the best of ``--repeat`` runs counts. Seconds are those of the
processor, of a run and all its child processes. The columns after the first build are what it takes
over each other build. Each build runs scenes of its own checkout. A row whose run fails, for
example because an older build does not know one of its options, has a dash.
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
YADE = ["yade", "-j1", "-n", "-x"]
PYTHON = ["/usr/bin/python3"]
BENCHMARK = "validation/benchmark/"
ROWS_OF_A_STUDY = """\
from {package} import Study, uniform
vary = {{"{name}": uniform(0.6, 0.8)}}
study = Study("{scene}", options={options}, runs={runs}, seed=1, vary=vary)
"""


def ofRun(folder, seconds, said):
    return seconds, "s"


def ofSteps(folder, seconds, said):
    with open(os.path.join(folder, "run.json")) as file:
        return json.load(file)["steps"], "steps"


def ofEachStep(folder, seconds, said):
    with open(os.path.join(folder, "run.json")) as file:
        return json.load(file)["microseconds_per_step"], "µs a step"


def ofEachSubcontact(folder, seconds, said):
    step, count = re.search(r"([\d.]+) µs a step, (\d+) subcontacts", said).groups()
    return 1000 * float(step) / float(count), "ns a subcontact and step"


@dataclass
class Row:
    """A run: its words, where {scene} names a scene of the checkout, and what counts of it."""

    words: list
    numberOf: object = ofRun
    #: of a study: its number of rows, and the options and the varied property of its scene
    study: tuple = ()


def scene(name, *options, numberOf=ofRun):
    return Row([*YADE, "{" + name + "}", *options], numberOf)


def study(name, runs, options, varied):
    return Row([*PYTHON, "-m", "{study}", "--jobs", "1"], ofRun, (name, runs, options, varied))


SHAKEN = [*YADE, BENCHMARK + "shaken_facade.py", "--lean", "--preset", "fast", "--seconds", "4"]
ROWS = {
    "20 rows of arch": study("arch", 20, {}, "bed.friction"),
    "20 rows of parapet": study("parapet", 20, {}, "bed.friction"),
    "8 rows of COMP-4 fast": study("wall_comp4", 8, {"preset": "fast"}, "bed.friction"),
    "falling_gable": scene("falling_gable", "--lean"),
    "spreading_arch": scene("spreading_arch", "--lean"),
    "house": scene("house", "--lean"),
    "tower on soil": Row([*YADE, ROOT + "/" + BENCHMARK + "tower_on_soil.py", "--lean"]),
    "drawn_wall": scene("drawn_wall", "--lean", numberOf=ofSteps),
    "storeys": scene("storeys", "--lean", numberOf=ofSteps),
    "panel": scene("panel", "--lean", numberOf=ofSteps),
    "accurate COMP-4": scene("wall_comp4", "--preset", "accurate"),
    "facade": scene("facade", "--lean"),
    "shaken facade, 0.2 g": Row([*SHAKEN, "--peak", "0.2"]),
    "shaken facade, 0.9 g": Row([*SHAKEN, "--peak", "0.9"]),
    "shaken wall of 100 bricks": Row([*YADE, ROOT + "/" + BENCHMARK + "shaken_wall.py", "--lean"]),
    "fast COMP-4": scene("wall_comp4", "--preset", "fast"),
    "rigid": scene("wall_comp4", "--until", "3", "--rate", "20", "--lean", numberOf=ofEachStep),
    "deformable": scene(
        "wall_comp4", *"--preset accurate --until 1 --lean".split(), numberOf=ofEachStep
    ),
    "1,224 half bricks": Row(
        [*YADE, BENCHMARK + "benchmark.py", "--wide", "34", "36"], ofEachSubcontact
    ),
    "16,000 half bricks": Row(
        [*YADE, BENCHMARK + "benchmark.py", "--wide", "126", "127"], ofEachSubcontact
    ),
}


def pathOf(name, tree):
    """The file of a scene in a checkout."""
    for folder in ("scripts", os.path.join("scripts", "gallery")):
        path = os.path.join(tree, folder, name + ".py")
        if os.path.exists(path):
            return path
    raise FileNotFoundError(f"{tree} has no scene {name}")


def wordsOf(row, tree, folder):
    """The command of a row in a checkout.

    :param folder: where its results go
    """
    package = "masonry_study"
    if not os.path.isdir(os.path.join(tree, "scripts", package)):
        package = "masonry.study"  # before the packages were parted
    words = [
        pathOf(word[1:-1], tree) if word[0] == "{" and word != "{study}" else word
        for word in row.words
    ]
    words = [package if word == "{study}" else word for word in words]
    if row.study:
        name, runs, options, varied = row.study
        file = os.path.join(folder, "rows.py")
        with open(file, "w") as out:
            out.write(
                ROWS_OF_A_STUDY.format(
                    package=package,
                    scene=pathOf(name, tree),
                    options=options,
                    runs=runs,
                    name=varied,
                )
            )
        words.append(file)
    return words if "--wide" in words else [*words, "--out", os.path.join(folder, "results")]


def measured(row, tree):
    """The number of a row and its unit; None if the run fails.

    :param tree: a checkout, or None: this one with the installed package
    """
    paths = {"PYTHONPATH": os.path.join(os.path.abspath(tree), "scripts")} if tree else {}
    tree = os.path.abspath(tree or ROOT)
    with tempfile.TemporaryDirectory() as folder:
        words = wordsOf(row, tree, folder)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run = subprocess.run(
            words, cwd=tree, env={**os.environ, **paths}, capture_output=True, text=True
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if run.returncode:
            return None
        return row.numberOf(os.path.join(folder, "results"), seconds, run.stdout)


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("tree", nargs="*", help="checkout with the plugin beside its sources")
    p.add_argument("--rows", nargs="+", choices=list(ROWS), default=list(ROWS))
    p.add_argument("--repeat", type=int, default=2)
    args = p.parse_args()
    builds = args.tree or [None]
    heads = [builds[0] or "installed", *(f"over {one}" for one in builds[1:])]
    print("| run |", " | ".join(heads), "|")
    print("|---" * (1 + len(builds)) + "|")
    for row in args.rows:
        runs = [[measured(ROWS[row], tree) for tree in builds] for _ in range(args.repeat)]
        best = [min(filter(None, one), default=None) for one in zip(*runs)]
        first = best[0]
        cells = [f"{first[0]:.4g} {first[1]}" if first else "-"]
        cells += [f"{first[0] / one[0]:.2f}" if first and one else "-" for one in best[1:]]
        print(f"| {row} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    sys.exit(main())
