# SPDX-License-Identifier: GPL-2.0-or-later
"""The folder of a study: which of its rows are done, whether they are those of the study, and the
table of their numbers.

``study.csv`` has a row a run: ``run``, what varies (of a field its seed), ``status``, and the
numbers of run.json. It is the same to the last digit whoever ran the rows. ``times.csv`` has what
is not: host, seconds, what a failed row said.

A study that goes on compares the table with what it draws. A row that goes on from a checkpoint
begins again if the scene refuses that, because it has other values.
"""

import collections
import csv
import functools
import io
import json
import os
import re

from masonry.run import batch
from masonry import folders
from masonry.errors import Refused, refuse
from masonry.numbers.files import filesOf, readWhole
from masonry.numbers.quantities import measures
from masonry.run.lock import isLocked
from .incremental import FOLDER, Chains, fell, isPlan, shaken

TABLE, STUDY, CSV, TIMES = "table.txt", "study.json", "study.csv", "times.csv"
SHOWN = 5  # differences that are named

#: Why a run that has ended is no row of an incremental dynamic analysis.
UNSHAKEN = "it was not shaken: the scene has no shake(), or fell before it"


class Folder:
    """A folder of a study."""

    def __init__(self, path):
        self.path = os.path.abspath(path)
        #: whether the structure fell, by the numbers of rows that have ended
        self._fell = {}

    def of(self, *names):
        return os.path.join(self.path, *names)

    def row(self, number):
        """The folder of the results of a row."""
        return self.of(batch.ROWS, batch.named(number))

    def checkpoint(self, number):
        return os.path.join(self.row(number), "run.checkpoint")

    def job(self, number):
        """The file that says how the last attempt at a row ended."""
        return self.row(number) + ".job"

    def check(self):
        """Refuse a folder, or one of rows, that holds symbolic links; a row looks at its own."""
        try:
            folders.check(self.path, self.of(batch.ROWS), self.of(FOLDER))
        except OSError as error:
            raise Refused(f"cannot read {error.filename}: {error.strerror}") from None

    def description(self):
        """study.json. Raises Refused if there is none, or if it is no description of a study."""
        try:
            record = json.loads(readWhole(self.of(STUDY)))
        except (OSError, ValueError):
            raise Refused(f"{self.path} is no folder of a study: it has no {STUDY}") from None
        if not _isStudy(record):
            raise Refused(f"{self.of(STUDY)} is damaged: it describes no study")
        return record

    def lastJob(self, number):
        """How the last attempt at a row ended: a dict with ``host``, ``status``, ``seconds``,
        ``told``; or an empty one."""
        try:
            record = json.loads(readWhole(self.job(number)))
        except (OSError, ValueError):
            return {}
        return record if _isJob(record) else {}

    def isEnded(self, number):
        return batch.ended(self.row(number)) is not None

    def isHeld(self, number):
        return isLocked(self.row(number))

    @functools.cached_property
    def chains(self):
        """:class:`masonry_study.incremental.Chains` of the study."""
        return Chains(self.description()["study"])

    def hasFallen(self, number):
        """Whether a row has ended with a structure that fell when it was shaken."""
        run = None if number in self._fell else batch.ended(self.row(number))
        if run is not None:
            self._fell[number] = fell(run)
        return self._fell.get(number, False)

    def isAboveCollapse(self, number):
        """Whether the structure fell at a lower level of the record of a row."""
        return any(map(self.hasFallen, self.chains.lower(number)))

    def isDone(self, number):
        """Whether there is nothing to run for a row."""
        return self.isEnded(number) or self.isAboveCollapse(number)

    def status(self, number):
        """``ended``, ``above collapse``, ``running``, ``failed`` or ``missing``."""
        if self.isAboveCollapse(number):
            return "above collapse"
        run = batch.ended(self.row(number))
        if run is not None:
            return "failed" if self.chains.plan and not shaken(run) else "ended"
        if self.isHeld(number):
            return "running"
        stopped = self.lastJob(number).get("status", 0) in (0, 130)
        return "missing" if stopped else "failed"


def _isStudy(record):
    """Whether study.json is of the form that :meth:`masonry_study.plan.Study.describe` gives it."""
    study = record.get("study") if isinstance(record, dict) else None
    return (
        isinstance(study, dict)
        and isinstance(study.get("runs"), int)
        and all(isinstance(study.get(name), dict) for name in ("options", "vary"))
        and all(isinstance(what, dict) for what in study["vary"].values())
        and isinstance(record.get("script"), str)
        and ("ida" not in study or isPlan(study["ida"], study["runs"]))
    )


def _isJob(record):
    """Whether a record of an attempt is of the form that :mod:`masonry_study.row` gives it."""
    kinds = {"host": str, "status": int, "seconds": (int, float), "told": str}
    fits = lambda name: isinstance(record.get(name), kinds[name])
    return isinstance(record, dict) and all(map(fits, kinds))


def written(path, text):
    """Write a file, whole or not at all. Raises Unwritable."""
    with folders.writing(path), folders.replaced(path, newline="") as f:
        f.write(text)


#: How lines begin that are no reason of a failure.
_CHATTER = (
    "Yade: ",
    "Running script",
    "XMLRPC",
    "TCP python",
    "Welcome to",
    "Using python",
    "note: ",
)
_USAGE = re.compile(r"^usage: .*?: error: ", re.DOTALL | re.MULTILINE)  # of argparse
_ERROR = re.compile(r"[\w.]*(Error|Exception|Exit|Interrupt)\b")


def reason(log):
    """What a scene said at last before it failed, of the text of its log: sentences, or an empty
    list."""
    lines = [line.strip() for line in _USAGE.split(log, 1)[-1].splitlines()]
    lines = [line for line in lines if line and not line.startswith(_CHATTER)]
    if "Traceback (most recent call last):" in log:
        lines = [line for line in lines if _ERROR.match(line)][-1:] or lines[-1:]
    return lines


def rowsOf(folder):
    """The rows of the table of a study, in turn, as dicts of texts: as many as it has runs, with
    its columns and names.

    :raises Refused: if the table is another one
    """
    study, path = folder.description()["study"], folder.of(TABLE)
    rows = [*batch.readTable(path).values()]
    needed = {"description", "lean", *study["options"], *study["vary"]}
    needed |= {"record", "scale"} if study.get("ida") else set()
    fields = [name for name in study["vary"] if name.startswith(batch.FIELD)]
    known = needed | {name[len(batch.FIELD) :] for name in fields}
    known = {n for n in known if n in ("description", "lean") or batch.isColumn(n)}
    heads = [*rows[0]] if rows else []
    foreign = [name for name in [*heads, *needed] if name not in known]
    problems = [f"column {name} is not of the study" for name in foreign]
    problems += [f"column {name} is missing" for name in needed.difference(heads)]
    if len(rows) != study["runs"]:
        problems.append(f"it has {len(rows)} rows, and the study {study['runs']}")
    problems += [
        f"row {batch.named(number)} is called {row['description']}"
        for number, row in enumerate(rows, 1)
        if row.get("description", "") != batch.named(number)
    ]
    refuse(problems[:SHOWN], f"{path} is not the table of its study:\n  ", "\n  ")
    return rows


def gather(folder):
    """Write study.csv and times.csv. Returns how many rows have each status. Refuses what
    :func:`rowsOf` refuses."""
    record, chains = folder.description()["study"], folder.chains
    names, found, times, counts = list(record["vary"]), [], [], collections.Counter()
    strengths = ["record", "scale", chains.plan["measure"]] if chains.plan else []
    for number, row in enumerate(rowsOf(folder), 1):
        run, status = batch.ended(folder.row(number)) or {}, folder.status(number)
        counts[status] += 1
        if status == "above collapse":
            run = {}  # somebody may have run it before the rows below
        strength = []
        if chains.plan:
            one = chains.plan["records"][chains.record(number)]["name"]
            strength = [one, row["scale"], chains.intensity(number)]
        with filesOf(folder.row(number)):
            numbers = measures(run)
            answers = {_answerName(a): a["value"] for a in run.get("answers", [])}
        begin = [batch.named(number), *(_varied(n, row[n]) for n in names), *strength, status]
        found.append((begin, {**numbers, **answers}))
        job = folder.lastJob(number)
        why = (UNSHAKEN if run else job.get("told", "")) if status == "failed" else ""
        host, cost = job.get("host", run.get("host", "")), run.get("wall_clock_s")
        times.append(
            [batch.named(number), status, host, cost, job.get("seconds"), run.get("commit"), why]
        )
    heads = list(dict.fromkeys(name for _, numbers in found for name in numbers))
    lines = [[*begin, *map(numbers.get, heads)] for begin, numbers in found]
    heads = ["run", *names, *strengths, "status", *heads]
    head = "run status host run_seconds job_seconds commit told".split()
    for name, table in ((CSV, [heads, *lines]), (TIMES, [head, *times])):
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(table)  # all digits
        written(folder.of(name), out.getvalue())
    return counts


def _answerName(answer):
    """The column of an answer: the stage and its number in the run, if a stage found it, what it
    is, and its unit."""
    own = not answer["number"]
    name = answer["name"] if own else f"{answer['stage']}_{answer['number']}_{answer['name']}"
    return name if answer["unit"] == "-" else f"{name}_{answer['unit']}"


def _varied(name, text):
    """What a row has of something that varies, for study.csv; of a field its seed."""
    value, isField = batch.value(text), name.startswith(batch.FIELD)
    return re.search(r"seed=(\d+)", value)[1] if isField else value
