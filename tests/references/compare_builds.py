# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the same work with two installed builds, and compares every file that comes out, byte for
byte.

    /usr/bin/python3 tests/references/compare_builds.py SITE SITE   # two folders with masonry/
    ... --only "scene arch" study           # only works with one of these texts in their names
    ... --scripts OLD/scripts NEW/scripts   # scenes and references of two trees

The works are every scene of ``scripts`` and ``scripts/gallery`` with ``--quick``; all runs of
references.py, of which every number is compared; a push that is resumed after its end and one that
is resumed after Ctrl-C; and a study of three rows. Each is a line: equal, differs (with the file
and its first line that differs) or failed. The exit status is 1 if a work differs or fails.

These differences are allowed:

- files that say when and where something ran, and pages (``LEFT_OUT``): the figures of a page are
  compared as .png files, and its data as curve.csv, frames and run.json
- in JSON files the entries ``ALLOWED``, the folders of builds, scenes and results, and names of
  modules
- in checkpoints names, and what the run notes beside its rows: compared are the bits of all numbers
  of the state, and the rows

Nothing else is normalised. Images are equal only if both builds use the same matplotlib.
"""

import argparse
import glob
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fnmatch import fnmatch
from itertools import zip_longest
from typing import Callable

import kept

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TIMEOUT = 3600  # of a process [s]
LEFT_OUT = "*.html *.log *.py run.lock times.csv".split()
ALLOWED = set(
    "commit date host made\x20by masonry seconds wall_clock_s microseconds_per_step"
    " nanoseconds_per_subcontact_step steps_by_threads resumed_at_s scene_sha256".split(" ")
)
MODULE = re.compile(r"\bmasonry(_\w+)?(\.\w+)+")

#: Writes a file for every run of references.py.
REFERENCES = """\
import sys
import masonry
site, folder = {site!r}, {folder!r}
assert masonry.__file__.startswith(site), f"{{masonry.__file__}} is imported, not {{site}}"
sys.path.insert(0, folder)
import references
references.pathOf = "{{}}.json".format
for name in references.RUNS:
    references.write(name, references.go(name))
"""
STUDY = """\
from {package} import Study
study = Study({scene!r}, runs=3, seed=1, options=dict(until=0.4),
    vary={{"bed.friction": [0.4, 0.5, 0.6], "joints": ["softening", "cyclic"]}})
"""
PUSHED = "wall_comp0a"  # the scene that is resumed and studied
ROWS = 4  # lines of curve.csv after which a run is interrupted


@dataclass(frozen=True)
class Build:
    """An installed build, and the folder of the scenes that it runs."""

    site: str
    scripts: str

    def scenes(self):
        """Paths of the scenes by their names."""
        paths = [p for f in ("", "gallery") for p in glob.glob(f"{self.scripts}/{f}/*.py")]
        return {os.path.basename(p)[:-3]: p for p in paths if "Scene(" in open(p).read()}


@dataclass(frozen=True)
class Attempt:
    """A work of one build, in a folder of its own, into which it leaves its files."""

    build: Build
    folder: str

    def run(self, *command, interrupted=False):
        """Run a program in the folder, or raise RuntimeError."""
        env = {**os.environ, "PYTHONPATH": self.build.site, "OMP_NUM_THREADS": "1"}
        with open(os.path.join(self.folder, "process.log"), "a+") as log:
            process = subprocess.Popen(
                command, cwd=self.folder, env=env, stdout=log, stderr=subprocess.STDOUT
            )
            try:
                if interrupted:
                    self._interrupt(process)
                status = process.wait(TIMEOUT)
            finally:
                process.kill()
            log.seek(0)
            last = (log.read().split("\n\n")[-1].strip().splitlines() or [""])[-1]
        if status != (130 if interrupted else 0):
            raise RuntimeError(f"{self.build.site}: exit status {status}: {last}")

    def runScene(self, name, *options, **how):
        scene = self.build.scenes().get(name)
        if not scene:
            raise RuntimeError(f"{self.build.scripts} has no scene {name}")
        self.run("yade", "-n", "-x", scene, *options, **how)

    def _interrupt(self, process):
        """Send SIGINT once there are some rows."""
        curve = os.path.join(self.folder, "results", "curve.csv")
        end = time.monotonic() + TIMEOUT
        while process.poll() is None and time.monotonic() < end:
            if os.path.exists(curve) and len(open(curve).readlines()) > ROWS:
                process.send_signal(signal.SIGINT)
                return
            time.sleep(0.01)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)


# -- works -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Work:
    name: str
    carryOut: Callable  # takes an Attempt and the words
    words: tuple = ()


def quickly(attempt, name):
    attempt.runScene(name, "--quick", "--out", "results")


def references(attempt):
    folder = os.path.join(os.path.dirname(attempt.build.scripts), "tests", "references")
    attempt.write("go.py", REFERENCES.format(site=attempt.build.site, folder=folder))
    attempt.run("yade", "-n", "-x", "go.py")


def resumedAfterItsEnd(attempt):
    attempt.runScene(PUSHED, "--until", "0.4", "--out", "results")
    attempt.runScene(PUSHED, "--resume", "results", "--until", "0.8")


def resumedAfterCtrlC(attempt):
    attempt.runScene(PUSHED, "--until", "1", "--out", "results", interrupted=True)
    attempt.runScene(PUSHED, "--resume", "results")


def study(attempt):
    own = os.path.isdir(os.path.join(attempt.build.site, "masonry_study"))
    package = "masonry_study" if own else "masonry.study"
    scene = attempt.build.scenes()[PUSHED]
    attempt.write("study.py", STUDY.format(package=package, scene=scene))
    command = "/usr/bin/python3", "-P", "-m", package, "study.py"
    attempt.run(*command, "--out", "results", "--jobs", "1")


def works(builds):
    scenes = sorted({name for build in builds for name in build.scenes()})
    return [
        Work("references", references),
        Work("study", study),
        Work("resumed after its end", resumedAfterItsEnd),
        Work("resumed after Ctrl-C", resumedAfterCtrlC),
        *(Work(f"scene {name}", quickly, (name,)) for name in scenes),
    ]


# -- comparison ------------------------------------------------------------------------------------


def withoutAllowed(value):
    """A value of JSON without the entries that may differ."""
    if isinstance(value, dict):
        return {k: withoutAllowed(v) for k, v in value.items() if k not in ALLOWED}
    return [*map(withoutAllowed, value)] if isinstance(value, list) else value


def linesOf(path, places):
    """The lines of a file that are compared.

    :param places: folders by what is written for them
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
    text = json.dumps(withoutAllowed(json.loads(data)), indent=1, ensure_ascii=False)
    for name, place in places.items():
        text = text.replace(place, name)
    return MODULE.sub("MODULE", text).split("\n")


def filesIn(folder):
    found = {
        os.path.relpath(os.path.join(at, name), folder)
        for at, _, names in os.walk(folder)
        for name in names
    }
    return {f for f in found if not any(fnmatch(os.path.basename(f), p) for p in LEFT_OUT)}


def shown(one, two):
    """Two lines from shortly before the place where they differ."""
    alike = len(os.path.commonprefix([one, two]))
    return " | ".join(repr(line[max(0, alike - 30) : alike + 30]) for line in (one, two))


def differences(attempts):
    """For every file that differs, its name and its first line that does."""
    one, two = (filesIn(attempt.folder) for attempt in attempts)
    for name in sorted(one | two):
        if name not in one & two:
            yield f"{name}: only of build {1 if name in one else 2}"
            continue
        lines = (
            linesOf(
                os.path.join(a.folder, name),
                {"RESULTS": a.folder, "SITE": a.build.site, "SCRIPTS": a.build.scripts},
            )
            for a in attempts
        )
        for number, (first, second) in enumerate(zip_longest(*lines, fillvalue=""), 1):
            if first != second:
                yield f"{name}: line {number}: {shown(first, second)}"
                break


def compare(work, builds, folder):
    """Carry out a work with both builds, one after the other, and print how they compare. Returns
    whether they are equal."""
    attempts, seconds, failures = [], [], []
    for number, build in enumerate(builds, 1):
        attempts.append(Attempt(build, os.path.join(folder, str(number), work.name)))
        os.makedirs(attempts[-1].folder)
        began = time.monotonic()
        try:
            work.carryOut(attempts[-1], *work.words)
        except (RuntimeError, OSError, subprocess.TimeoutExpired) as error:
            failures.append(f"build {number}: {error}")
        seconds.append(f"{time.monotonic() - began:.0f} s")
    found = failures or [*differences(attempts)]
    count = len(filesIn(attempts[0].folder))
    if not failures and not count:
        failures = found = ["no file"]
    state = "failed" if failures else "differs" if found else "equal"
    lines = [f"{state}: {work.name} ({count} files, {', '.join(seconds)})", *found]
    print("\n    ".join(lines), flush=True)
    return not found


def main(words):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("sites", metavar="SITE", nargs=2, help="folder with a package masonry")
    parser.add_argument(
        "--scripts",
        metavar="DIR",
        nargs=2,
        default=[os.path.join(TREE, "scripts")] * 2,
        help="folders of the scenes",
    )
    parser.add_argument(
        "--only", metavar="PATTERN", nargs="+", default=[""], help="texts in names of works"
    )
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=int,
        default=len(os.sched_getaffinity(0)),
        help="works at a time",
    )
    parser.add_argument("--out", metavar="DIR", help="a new folder that keeps all files")
    args = parser.parse_args(words)
    builds = [Build(*map(os.path.abspath, pair)) for pair in zip(args.sites, args.scripts)]
    for build in builds:
        if not os.path.isdir(os.path.join(build.site, "masonry")):
            parser.error(f"{build.site} has no package masonry")
    wanted = [w for w in works(builds) if any(text in w.name for text in args.only)]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(args.jobs) as pool:
        began, folder = time.monotonic(), os.path.abspath(args.out or folder)
        equal = [*pool.map(lambda work: compare(work, builds, folder), wanted)]
    print(f"{sum(equal)} of {len(equal)} works are equal, in {time.monotonic() - began:.0f} s")
    return 0 if equal and all(equal) else 1


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
