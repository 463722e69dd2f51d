# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the same work with two installed builds, and compares every file that comes out, byte for
byte.

    /usr/bin/python3 tests/references/compare_builds.py SITE SITE    # two folders with masonry/
    ... --only study "scene wall"           # only works whose names have one of these texts
    ... --scripts OLD/scripts NEW/scripts   # each build runs scenes and references of its own tree

The works are every scene of ``scripts`` and ``scripts/gallery`` with ``--quick``; all runs of
references.py, with every number that it reads; a push that is continued after its end, and a run
that is resumed after Ctrl-C; and a study of three rows. A line a work says whether it is equal,
differs (in which files, and the first line of each that does) or failed. The exit status is 1 if a
work differs or failed.

These differences are allowed:

- files that say when and where something ran, and pages and the mechanism, whose figures are
  compared as .png files and whose numbers as curve.csv, frames and run.json: ``EXCLUDED_FILES``
- in JSON files the entries ``EXCLUDED_ENTRIES``, the folders of builds, scenes and results, and
  names of modules
- in checkpoints all names, and what a run notes beside its rows; compared are the bits of all
  numbers of the state, in any order, and the rows

Nothing else is normalised. PNG files are compared as they are, so both builds need the same
matplotlib.
"""

import argparse
import glob
import json
import os
import re
import signal
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fnmatch import fnmatch
from itertools import zip_longest
from typing import Callable

import kept

SCRIPTS = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
EXCLUDED_FILES = "*.html *.log *.py mechanism.json run.lock times.csv".split()
EXCLUDED_ENTRIES = {"made by"} | set(
    "commit date effective_properties files host masonry microseconds_per_step"
    " nanoseconds_per_subcontact_step properties_of_laws resumed_at_s"
    " scene_sha256 seconds steps_by_threads wall_clock_s".split()
)
MODULE = re.compile(r"\bmasonry(_\w+)?(\.\w+)+")

#: Writes a file for every run of references.py.
REFERENCES = """\
import masonry
import references
assert masonry.__file__.startswith({site!r}), masonry.__file__ + " is another build"
references.pathOf = "{{}}.json".format
for name in references.RUNS:
    references.write(name, references.go(name))
"""
STUDY = """\
from {package} import Study
study = Study({scene!r}, runs=3, seed=1, options=dict(until=0.4),
    vary={{"bed.friction": [0.4, 0.5, 0.6], "joints": ["softening", "cyclic"]}})
"""
PUSHED = "wall_comp0a"  # the scene that is continued and studied
INTERRUPTED = "pulsed_wall"  # one without limit analysis, whose files depend on when it is stopped


@dataclass(frozen=True)
class Build:
    """An installed build, and the folder of the scenes that it runs."""

    site: str
    scripts: str

    def scenes(self):
        """Paths of the scenes by their names, without compas.py, which needs a file."""
        paths = [p for f in ("", "gallery") for p in glob.glob(f"{self.scripts}/{f}/*.py")]
        found = {os.path.basename(p)[:-3]: p for p in paths if "Scene(" in open(p).read()}
        return {name: path for name, path in found.items() if name != "compas"}


@dataclass(frozen=True)
class Attempt:
    """A work of one build, and the folder in which its processes run and leave their files."""

    build: Build
    folder: str

    def run(self, *command, interrupted=False):
        """Run a program. Raises RuntimeError if its exit status is not the one that is expected.

        :param interrupted: whether it gets SIGINT once it has a few rows
        """
        references = os.path.join(self.build.scripts, "..", "tests", "references")
        env = {**os.environ, "OMP_NUM_THREADS": "1"}
        env["PYTHONPATH"] = f"{self.build.site}:{references}"
        output, curve = self.path("process.log"), self.path("results/curve.csv")
        with open(output, "a") as log:
            process = subprocess.Popen(command, cwd=self.folder, env=env, stdout=log, stderr=log)
        hasRows = lambda: os.path.exists(curve) and len(open(curve).readlines()) > 3
        while interrupted and process.poll() is None and not hasRows():
            time.sleep(0.01)
        if interrupted:
            process.send_signal(signal.SIGINT)
        if (status := process.wait()) != (130 if interrupted else 0):
            end = open(output).read().strip()[-300:]
            raise RuntimeError(f"{self.build.site}: exit status {status}: ...{end}")

    def runScene(self, name, *options, **how):
        scene = self.build.scenes().get(name, f"{self.build.scripts}/{name}.py")
        self.run("yade", "-n", "-x", scene, *options, **how)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, text):
        with open(self.path("program.py"), "w") as file:
            file.write(text)


# -- works -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Work:
    name: str
    carryOut: Callable  # takes an Attempt


def runQuickly(name):
    return Work(f"scene {name}", lambda a: a.runScene(name, "--quick", "--out", "results"))


def runReferences(attempt):
    attempt.write(REFERENCES.format(site=attempt.build.site + "/"))
    attempt.run("yade", "-n", "-x", "program.py")


def runStudy(attempt):
    isSeparate = os.path.isdir(os.path.join(attempt.build.site, "masonry_study"))
    package = "masonry_study" if isSeparate else "masonry.study"
    attempt.write(STUDY.format(package=package, scene=attempt.build.scenes()[PUSHED]))
    command = "/usr/bin/python3", "-P", "-m", package, "program.py"
    attempt.run(*command, "--out", "results", "--jobs", "1")


def resumeFinished(attempt):
    attempt.runScene(PUSHED, "--until", "0.4", "--out", "results")
    attempt.runScene(PUSHED, "--resume", "results", "--until", "0.8")


def resumeInterrupted(attempt):
    attempt.runScene(INTERRUPTED, "--quick", "--out", "results", interrupted=True)
    attempt.runScene(INTERRUPTED, "--resume", "results")


def works(builds):
    return [
        Work("references", runReferences),
        Work("study", runStudy),
        Work("resumed after its end", resumeFinished),
        Work("resumed after Ctrl-C", resumeInterrupted),
        *map(runQuickly, sorted({name for build in builds for name in build.scenes()})),
    ]


# -- comparison ------------------------------------------------------------------------------------


def withoutExcluded(value):
    """A value of JSON without the entries that may differ."""
    if isinstance(value, dict):
        return {k: withoutExcluded(v) for k, v in value.items() if k not in EXCLUDED_ENTRIES}
    return [*map(withoutExcluded, value)] if isinstance(value, list) else value


def linesOf(path, places):
    """The lines of a file that are compared.

    :param places: folders whose names may differ
    """
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".checkpoint"):
        found = kept.records(data)
        rows = json.loads(found.pop("extra"))["rows"]
        found.pop("engines")  # their names
        return [*map(repr, rows), *sorted(numbers.hex() for numbers in found.values())]
    if not path.endswith((".json", ".job")):
        return data.decode("utf-8", "surrogateescape").split("\n")
    text = json.dumps(withoutExcluded(json.loads(data)), indent=1, ensure_ascii=False)
    for place in places:
        text = text.replace(place, "FOLDER")
    return MODULE.sub("MODULE", text).split("\n")


def filesIn(folder):
    """Names of the files that are compared."""
    paths = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]
    isExcluded = lambda path: any(fnmatch(os.path.basename(path), p) for p in EXCLUDED_FILES)
    return {os.path.relpath(path, folder) for path in paths if not isExcluded(path)}


def firstDifference(name, attempts):
    """A sentence on the first line of a file that differs, or None."""
    lines = []
    for a in attempts:
        if not os.path.exists(a.path(name)):
            return f"{name}: not of {a.build.site}"
        scripts = a.build.scripts
        places = a.folder, a.build.site, os.path.join(scripts, "gallery"), scripts
        lines.append(linesOf(a.path(name), places))
    for number, pair in enumerate(zip_longest(*lines, fillvalue=""), 1):
        if pair[0] != pair[1]:
            begin = max(0, len(os.path.commonprefix(pair)) - 30)
            texts = [repr(line[begin : begin + 60]) for line in pair]
            return f"{name}: line {number}: {' | '.join(texts)}"


def compare(work, builds, folder):
    """Carry out a work with both builds, one after the other, and print how they compare. Returns
    whether they are equal."""
    places = [os.path.join(folder, str(number), work.name) for number in (1, 2)]
    attempts = [*map(Attempt, builds, places)]
    began, names, found, state = time.monotonic(), [], [], "differs"
    try:
        for attempt in attempts:
            os.makedirs(attempt.folder)
            work.carryOut(attempt)
        names = sorted(filesIn(places[0]) | filesIn(places[1]))
        found = [d for name in names if (d := firstDifference(name, attempts))]
        state = "differs" if found or not names else "equal"
    except (RuntimeError, OSError, LookupError, ValueError) as error:
        found, state = [repr(error)], "failed"
    seconds = time.monotonic() - began
    first = f"{state}: {work.name} ({len(names)} files, {seconds:.0f} s)"
    print("\n    ".join([first, *found]), flush=True)
    return state == "equal"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    add, cores = parser.add_argument, len(os.sched_getaffinity(0))
    add("sites", metavar="SITE", nargs=2, help="folder of an installed build")
    add("--scripts", metavar="DIR", nargs=2, default=[SCRIPTS] * 2, help="scenes of each build")
    add("--only", metavar="TEXT", nargs="+", default=[""], help="texts in the names of works")
    add("--jobs", metavar="N", type=int, default=cores, help="works at a time")
    add("--out", metavar="DIR", help="new folder in which all files are kept")
    args, began = parser.parse_args(), time.monotonic()
    builds = [Build(*map(os.path.abspath, pair)) for pair in zip(args.sites, args.scripts)]
    wanted = [w for w in works(builds) if any(text in w.name for text in args.only)]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(args.jobs) as pool:
        folder = os.path.abspath(args.out or folder)
        equal = [*pool.map(lambda work: compare(work, builds, folder), wanted)]
    print(f"{sum(equal)} of {len(equal)} works are equal, after {time.monotonic() - began:.0f} s")
    return 0 if equal and all(equal) else 1


if __name__ == "__main__":
    raise SystemExit(main())
