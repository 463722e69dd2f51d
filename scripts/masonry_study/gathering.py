# SPDX-License-Identifier: GPL-2.0-or-later
"""The folder of a study: which of its rows are done, and the table of their numbers.

``study.csv`` has a row a run: ``run``, what varies (of a field its seed), ``status``, and the
numbers of run.json. The file is the same to the last digit whoever ran the rows. ``times.csv`` has
what depends on the machine: host, seconds, what a failed row said.
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
from masonry.errors import Refused
from masonry.numbers.files import filesOf, readWhole
from masonry.numbers.quantities import measures
from masonry.run.lock import isLocked
from .incremental import FOLDER, Chains, fell, shaken

TABLE, STUDY, CSV, TIMES = "table.txt", "study.json", "study.csv", "times.csv"

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
        """study.json. Raises Refused."""
        try:
            record = json.loads(readWhole(self.of(STUDY)))
            record["script"], record["study"]["runs"], record["study"]["vary"]
        except OSError:
            raise Refused(f"{self.path} is no folder of a study: it has no {STUDY}") from None
        except (ValueError, KeyError, TypeError):
            raise Refused(f"{self.of(STUDY)} is damaged: it describes no study") from None
        return record

    def lastJob(self, number):
        """How the last attempt at a row ended: a dict with ``host``, ``status``, ``seconds``,
        ``told``; or an empty one."""
        try:
            return json.loads(readWhole(self.job(number)))
        except (OSError, ValueError):
            return {}

    def isEnded(self, number):
        return batch.ended(self.row(number)) is not None

    def isHeld(self, number):
        return isLocked(self.row(number))

    @functools.cached_property
    def chains(self):
        return Chains(self.description()["study"])

    def hasFallen(self, number):
        run = None if number in self._fell else batch.ended(self.row(number))
        if run is not None:
            self._fell[number] = fell(run)
        return self._fell.get(number, False)

    def isAboveCollapse(self, number):
        """Whether the structure fell at a lower level of the record of a row."""
        return any(map(self.hasFallen, self.chains.lower(number)))

    def isDone(self, number):
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


def written(path, text):
    """Write a file, whole or not at all. Raises Unwritable."""
    with folders.writing(path), folders.replaced(path, newline="") as f:
        f.write(text)


_USAGE = re.compile(r"^usage: .*?: error: ", re.DOTALL | re.MULTILINE)  # of argparse
_ERROR = re.compile(r"[\w.]*(Error|Exception|Exit|Interrupt)\b")


def reason(log):
    """What a scene said at last before it failed, by the text of its log: sentences."""
    lines = [line.strip() for line in _USAGE.split(log, 1)[-1].splitlines()]
    lines = [line for line in lines if line and not line.startswith("note: ")]
    if "Traceback (most recent call last):" in log:
        lines = [line for line in lines if _ERROR.match(line)][-1:] or lines[-1:]
    return lines


def rowsOf(folder):
    """The rows of the table of a study, in turn, as dicts of texts. Raises Refused if the table is
    another one."""
    study, path = folder.description()["study"], folder.of(TABLE)
    rows = [*batch.readTable(path).values()]
    expected = [batch.named(number) for number in range(1, study["runs"] + 1)]
    columns = {*study["options"], *study["vary"]}
    if [row.get("description") for row in rows] != expected or not columns <= {*rows[0]}:
        raise Refused(
            f"{path} is not the table of its study, which has the rows {expected[0]} to"
            f" {expected[-1]} and the columns {', '.join(sorted(columns))}"
        )
    return rows


def gather(folder):
    """Write study.csv and times.csv. Returns how many rows have each status. Raises as
    :func:`rowsOf`."""
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
        of = job.get("host", run.get("host", "")), run.get("wall_clock_s"), job.get("seconds")
        times.append([batch.named(number), status, *of, run.get("commit"), why])
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
    own = not answer["number"]
    name = answer["name"] if own else f"{answer['stage']}_{answer['number']}_{answer['name']}"
    return name if answer["unit"] == "-" else f"{name}_{answer['unit']}"


def _varied(name, text):
    value, isField = batch.value(text), name.startswith(batch.FIELD)
    return re.search(r"seed=(\d+)", value)[1] if isField else value
