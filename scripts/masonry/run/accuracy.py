# SPDX-License-Identifier: GPL-2.0-or-later
"""``--accuracy P``: a push whose peak and work are known within P percent, by the cheapest runs
that show it.

Cheaper runs of the same scene, its companions, show how much its numbers depend on rate, mesh,
points, block model and chance. Those of the cheapest fidelity of
:data:`masonry.run.presets.FIDELITIES` are run first, in processes of their own, on all cores. Their
differences, and what validation/accuracy has measured of that fidelity, add up to a half-width. If
it is too large, the next fidelity follows. The scene then goes on with the options of the one that
was chosen.

Companions are in the folder ``accuracy`` of the results. A run that was interrupted and is started
again with the same words takes those that are over. No YADE is needed.
"""

import contextlib
import functools
import hashlib
import json
import os
import pathlib
import shutil
from .. import background, host
from ..errors import NotAccurate, Refused
from ..terminal import say
from ..auxiliary import Auxiliary, addToLog
from ..folders import check, inside, replaced
from ..numbers.files import readRun
from . import batch
from .option_table import asOption
from .presets import CHOSEN, COMPANIONS, FIDELITIES, MAIN, fidelityOf

FOLDER = "accuracy"  # of the companions, in that of the results
PLAN = "plan.json"  # there: what was run, while it goes on
_isCompanion = False  # whether this process is a companion of another run
#: Half the width of a 95 % interval over the range of three runs, for the difference from another
#: run: Student's t with two degrees of freedom, 4.30, times sqrt(1 + 1/3), over 1.69, the mean
#: range of three in standard deviations.
BY_CHANCE = 2.9
#: Ratio of two differences, each at half the step of the one before, that speaks for an order of
#: 0.6 to 2.6.
BEHAVES = 1.5, 6.0

#: The quantities: name, entry of run.json, and unit. The peak is that of supports and loaded point
#: at once: a pulse in the supports alone, when a crack tears, grows with the rate.
QUANTITIES = (("peak", "peak_at_both_ends_kN", "kN"), ("work", "push_work_J", "J"))
#: What an interval does not say, in every report.
NOT_COVERED = (
    "the crack pattern, the force at the end of the curve, the material's own uncertainty, and how"
    " far this model of a wall is from real walls"
)
#: Stages that a scene with --accuracy may have.
STAGES = ("settle", "push", "hold", "release", "move")


# -- what runs say ---------------------------------------------------------------------------------


def shown(source, values, scale):
    """What a source of error changes, over a scale [-]; None if a run of it is missing.

    :param values: of the runs that are there, by name
    """
    if any(name not in values for name in source.runs):
        return None
    found = [values[name] / scale for name in source.runs]
    if source.chance:
        return BY_CHANCE * (max(found) - min(found))
    *before, last = (b - a for a, b in zip(found, found[1:]))
    ratio = before[-1] / last if before and last else 0.0
    if BEHAVES[0] < ratio < BEHAVES[1]:
        return abs(last) / (ratio - 1)
    return source.share * abs(last)


def halfWidth(number, quantity, values, scale):
    """Half the width of the interval of a quantity, over a scale [-], and its parts by their names.

    :param number: of the fidelity in :data:`masonry.run.presets.FIDELITIES`
    :param values: of the runs that are there by name, the run itself as
        :data:`masonry.run.presets.MAIN`
    """
    fidelity = FIDELITIES[number]
    parts = {"not shown by companions": fidelity.error[quantity]}
    for source in fidelity.sources:
        part = shown(source, values, scale)
        if part is None and number:
            earlier = [s for s in FIDELITIES[number - 1].sources if s.name == source.name]
            part = shown(earlier[0], values, scale) if earlier else None
        if part is not None:
            parts[source.name] = part
    return sum(parts.values()), parts


def needed(number):
    """Names of the companions of a fidelity, by its number, without those of the ones before."""
    of = lambda fidelity: [n for s in fidelity.sources for n in s.runs if n != MAIN]
    before = {name for fidelity in FIDELITIES[:number] for name in of(fidelity)}
    return [n for n in dict.fromkeys(of(FIDELITIES[number])) if n not in before]


# -- companions ------------------------------------------------------------------------------------


class AuxiliaryRuns:
    """The companions of a run.

    :param folder: of the results of the run
    :param script: of the scene; ``words``: the options of the user
    """

    def __init__(self, folder, script="", words=()):
        self.folder = os.path.join(folder, FOLDER)
        self.script, self.words = script, words
        self.numbers = {}  # of the runs that are over
        self.failed = False  # whether a run was not refused, but failed
        self.percent = self.fidelity = None  # what was asked for [%], what was chosen

    def folderOf(self, name):
        plain = "".join(c if c.isalnum() or c == "." else "_" for c in name)
        return os.path.join(self.folder, plain.replace("__", "_"))

    def begin(self, key):
        """Make the folder, or take what an interrupted run with this key left there. Raises
        Refused."""
        try:
            check(os.path.dirname(self.folder), self.folder)
        except OSError as error:
            raise Refused(f"--out: cannot read {error.filename}: {error.strerror}") from None
        path = os.path.join(self.folder, PLAN)
        with contextlib.suppress(OSError, ValueError):
            with open(path) as file:
                if json.load(file).get("key") == key:
                    self.read()
        if self.numbers:
            say(
                f"note: --accuracy: {len(self.numbers)} runs of an interrupted start are taken from"
                f" {self.folder}"
            )
            return
        if os.path.exists(path) or not os.path.exists(self.folder):
            shutil.rmtree(self.folder, ignore_errors=True)
        try:
            os.makedirs(self.folder, exist_ok=True)
            for name in COMPANIONS:
                shutil.rmtree(self.folderOf(name), ignore_errors=True)
            with replaced(path) as file:
                json.dump({"key": key}, file)
        except OSError as error:
            raise Refused(f"--out: cannot write to {self.folder}: {error.strerror}") from None

    def clear(self):
        """Remove the folder, unless it has the numbers or the log of a companion."""
        if self.numbers or self.failed:
            return
        shutil.rmtree(self.folder, ignore_errors=True)
        with contextlib.suppress(OSError):
            os.rmdir(os.path.dirname(self.folder))

    def onRunEnded(self):
        """Let the next run make its companions anew."""
        with contextlib.suppress(OSError):
            os.remove(os.path.join(self.folder, PLAN))

    def read(self):
        for name in COMPANIONS:
            self._take(name)

    def _take(self, name):
        """Read the numbers of a companion. Returns whether it is over."""
        run = batch.ended(self.folderOf(name))
        if run is None:
            return False
        if not all(run.get(key) for _, key, _ in QUANTITIES):
            raise Refused(
                "--accuracy: it is about the peak and the work of a push, and this scene has no"
                " push of one target that takes force"
            )
        found = {what: run[key] for what, key, _ in QUANTITIES}
        costs = dict(seconds=run["wall_clock_s"], collapsed=run["collapsed"])
        self.numbers[name] = {**found, **costs}
        return True

    def valuesOf(self, quantity):
        return {name: numbers[quantity] for name, numbers in self.numbers.items()}

    def fail(self, note, trace):
        """Keep why companions are of no use, as a run does."""
        say(f"note: {note}")
        addToLog(self.folder, f"{note}\n{trace}\n")

    def run(self, names):
        """Run companions that are not over yet, as many at a time as there are cores. Raises
        Refused with what a companion said."""
        due = [name for name in names if name not in self.numbers]
        background.carryOut(due, self._start, self._ended, len(os.sched_getaffinity(0)))

    def _start(self, name):
        options = {**CHOSEN, **COMPANIONS[name]}
        words = [
            f"{asOption(option)}={value}" for option, value in options.items() if value is not None
        ]
        folder = self.folderOf(name)
        words = [*self.words, *words, "--lean", "--checkpoint-every=0", f"--out={folder}"]
        act = functools.partial(_runCompanion, self.script, words)
        env = {batch.VARIABLE: None, batch.PROBE: None}
        try:
            with open(folder + ".log", "wb", opener=inside) as log:
                return background.Program(act, log, env)
        except OSError as error:
            raise Refused(f"--accuracy: cannot run {self.script}: {error.strerror}") from None

    def _ended(self, name, program):
        if program.returncode not in (0, 1) or not self._take(name):
            kind, reason = program.refusal()
            if kind == NotAccurate.__name__:
                raise Refused(reason)
            self.failed = True
            log, last = (
                self.folderOf(name) + ".log",
                f"exit status {program.returncode}",
            )
            with contextlib.suppress(OSError), open(log, errors="replace") as file:
                last = [line.strip() for line in [last, *file] if line.strip()][-1]
            failed = f"the run {name} did not come to its end: {last}; see {log}"
            raise Refused(f"--accuracy: {failed}") if kind else background.Failed(failed)
        found = self.numbers[name]
        fell = ", collapsed" if found["collapsed"] else ""
        say(
            f"accuracy: {name}: peak {found['peak']:.4g} kN, work {found['work']:.4g} J,"
            f" {found['seconds']:.0f} s{fell}"
        )

    def choose(self, percent):
        """Run companions until a fidelity has a half-width [%], or there is no better one."""
        for number, fidelity in enumerate(FIDELITIES):
            self.percent, self.fidelity = percent, fidelity
            self.run(needed(number))
            widths = {}
            for quantity, _, _ in QUANTITIES:
                values = self.valuesOf(quantity)
                scale = max(map(abs, values.values()))
                widths[quantity] = 100 * halfWidth(number, quantity, values, scale)[0]
            enough, last = max(widths.values()) <= percent, fidelity is FIDELITIES[-1]
            about = ", ".join(f"{name} ± {width:.2g} %" for name, width in widths.items())
            verdict = "chosen" if enough else "the finest there is" if last else "not enough"
            say(f"accuracy: {fidelity.name}: {about} expected: {verdict}")
            if enough:
                break

    def report(self, run):
        """The entry ``accuracy`` of run.json for the numbers of a run, and the half-widths beside
        the values."""
        number = FIDELITIES.index(self.fidelity)
        found, entries = [], {}
        for quantity, key, unit in QUANTITIES:
            value = run[key]
            values = {**self.valuesOf(quantity), MAIN: value}
            share, parts = halfWidth(number, quantity, values, abs(value) or 1.0)
            parts = {name: 100 * part for name, part in parts.items()}
            how = ", ".join(f"{name} {part:.2g} %" for name, part in parts.items())
            how = (
                "the sum of what companions of this run differ by and of what they do not show:"
                f" {how}"
            )
            entries[f"{quantity}_half_width_{unit}"] = share * abs(value)
            one = dict(name=quantity, unit=unit, value=value, parts_percent=parts, how=how)
            one.update(half_width=share * abs(value), half_width_percent=100 * share)
            found.append(one)
        entries["accuracy"] = {
            "asked_percent": self.percent,
            "reached": max(f["half_width_percent"] for f in found) <= self.percent,
            "fidelity": self.fidelity.name,
            "quantities": found,
            "not_covered": NOT_COVERED,
            "companions": [
                {"name": n, "options": COMPANIONS[n], **numbers, "folder": self.folderOf(n)}
                for n, numbers in self.numbers.items()
            ],
        }
        return entries


def _runCompanion(script, words):
    global _isCompanion
    _isCompanion = True
    return host.runScript(script, words)


# -- what is reported and asked --------------------------------------------------------------------


def answers(entry):
    """The entry ``accuracy`` of run.json as answers of the push."""
    lacks = f". It does not cover {entry['not_covered']}"
    return [
        {n: q[n] for n in ("name", "unit", "value")}
        | {"how": q["how"] + lacks, "uncertainty": q["half_width"]}
        for q in entry["quantities"]
    ]


def lines(entry):
    """The entry ``accuracy`` of run.json as lines to read."""
    values = ", ".join(
        f"{q['name']} {q['value']:.4g} ±"
        f" {q['half_width']:.2g} {q['unit']} ({q['half_width_percent']:.2g} %)"
        for q in entry["quantities"]
    )
    yield (
        f"accuracy: {values}, by {entry['fidelity']} and {len(entry['companions'])} runs beside it"
    )
    fell = [one["name"] for one in entry["companions"] if one["collapsed"]]
    if fell:
        yield f"accuracy: collapsed: {'; '.join(fell)}; the work of a run that collapses ends there"
    if not entry["reached"]:
        finest = entry["fidelity"] == FIDELITIES[-1].name
        which = "finest fidelity there is" if finest else "fidelity that was chosen"
        yield (
            f"accuracy: {entry['asked_percent']:g} % is not reached by the {which}: the ± is what"
            " was found"
        )
    yield f"accuracy: the ± does not cover {entry['not_covered']}"


def ask(name, args, script, words):
    """Carry out ``--accuracy``: run companions, and give the options the values of the fidelity
    that was chosen.

    :param args: the options of the run, which are changed
    :param script: path of the script of the scene, or None if it has other options than the command
        line
    :returns: :class:`AuxiliaryRuns`, or None if there are no companions or they have failed
    :raises Refused: if it means nothing here
    """
    if not args.accuracy or _isCompanion or batch.PROBE in os.environ:
        return None
    given = getattr(args, "given", None) or {}
    chosen = [n for n in CHOSEN if n in given]
    if args.preset or chosen:
        unwanted = ["--preset"] * bool(args.preset) + [*map(asOption, chosen)]
        raise Refused(
            "--accuracy: it chooses block model, mesh, rate, points, damping and time step itself:"
            f" leave {' and '.join(unwanted)} away"
        )
    if args.history:
        raise Refused(
            "--accuracy: it is about a push in one direction, not about the loops of --history"
        )
    if args.resume:
        return _resumed(args)
    if script is None:
        raise Refused(
            f"--accuracy: scene {name} must be a script that takes its options from the command"
            " line, since it is run several times"
        )
    folder = args.out or os.path.join("results", name)
    companions = AuxiliaryRuns(folder, script, words)
    command = json.dumps([os.path.abspath(script), words, sorted(COMPANIONS)])
    text = pathlib.Path(script).read_bytes() + command.encode()
    companions.begin(hashlib.sha256(text).hexdigest())
    with Auxiliary("--accuracy: there will be no ±", companions.fail) as attempt:
        try:
            companions.choose(args.accuracy)
        except Refused:
            companions.clear()
            raise
    vars(args).update({**CHOSEN, **companions.fidelity.options})
    return None if attempt.note else companions


def _resumed(args):
    """:func:`ask` of a resumed run, which has the companions of its beginning."""
    companions, fidelity = AuxiliaryRuns(args.resume), fidelityOf(args)
    companions.percent, companions.fidelity = args.accuracy, fidelity
    companions.read()
    number = FIDELITIES.index(fidelity) if fidelity else 0
    due = [name for k in range(number + 1) for name in needed(k)]
    if not fidelity or set(due) - set(companions.numbers):
        say(
            f"note: --accuracy: {companions.folder} does not have the runs beside this one any"
            " more: there will be no ±"
        )
        return None
    if any(readRun(companions.folderOf(n))["options"]["until"] != args.until for n in due):
        say(
            "note: --accuracy: the run goes on to a longer push than its companions: there will be"
            " no ±"
        )
        return None
    return companions
