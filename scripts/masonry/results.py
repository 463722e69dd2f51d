"""What a run leaves behind: curve.csv, run.json, progress on the terminal; and how to read it again."""

import contextlib
import csv
import json
import math
import os
import re
import shutil
import signal
import sys
import time

from .options import Refused

ENERGIES = [
    "external",
    "gravity",
    "kinetic",
    "damping",
    "elastic_units",
    "elastic_tension",
    "elastic_shear",
    "elastic_compression",
    "dissipated_tension",
    "dissipated_shear",
    "dissipated_compression",
]


OURS = re.compile(
    r"((blocks|joints)(_\d+\.vt[up]|\.pvd)|curve\.(csv|png)|cracks\.png|run\.(json|checkpoint))(\.new)?"
)


class Interrupted(Exception):
    """Ctrl-C or SIGTERM: the run ends in order and keeps what is there."""


class Unwritable(Exception):
    """A file of the results cannot be written: the run ends in order and keeps what is there."""


def say(text, stream=None):
    """Print, unless the terminal or the log is gone or full: no reason to stop a run."""
    with contextlib.suppress(OSError):
        print(text, file=stream, flush=True)


class Results:
    """Folder of one run. Unwritable folders are reported when it is made, not after an hour.

    :param directory: folder, made if missing
    :param columns: columns of curve.csv, units in the names
    :param resumed: leave everything as it is, until :meth:`takeUp`
    """

    def __init__(self, directory, columns, resumed=False):
        self.directory = os.path.abspath(directory)
        try:
            os.makedirs(self.directory, exist_ok=True)
            for name in [] if resumed else os.listdir(self.directory):
                if OURS.fullmatch(name):  # an earlier run's would be taken for ours
                    os.remove(os.path.join(self.directory, name))
            self._file = open(self.path("curve.csv"), "ab", buffering=0)
            if not resumed:
                self._write(columns)
                os.fsync(self._file.fileno())
        except OSError as error:
            raise Refused(
                f"--out: cannot write to {self.directory}: {error.strerror}"
            ) from None
        self.columns, self.rows, self.run = columns, [], {}
        self.started = time.perf_counter()
        self.interrupted = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._interrupt)

    def path(self, name):
        return os.path.join(self.directory, name)

    def takeUp(self, rows, frames, seconds):
        """Go on after the rows, ParaView frames and wall-clock seconds of a run that is resumed; what came later goes."""
        if any(len(row) != len(self.columns) for row in rows):
            raise ValueError(f"its rows are not of {len(self.columns)} columns")
        for name in os.listdir(self.directory):
            number = re.fullmatch(r"(?:blocks|joints)_(\d+)\.vt[up]", name)
            if number and int(number[1]) >= frames:
                os.remove(self.path(name))
        self._file.truncate(0)
        self._write(self.columns)
        for row in rows:
            self.row(dict(zip(self.columns, row)))
        self.started -= seconds

    def _interrupt(self, number, frame):
        self.interrupted = True

    def checkInterrupt(self):
        if self.interrupted:
            raise Interrupted()

    def row(self, values):
        """Append a row of curve.csv; ``values`` has a number for every column."""
        row = [values[c] for c in self.columns]
        if not all(math.isfinite(v) for v in row):
            broken = [c for c, v in zip(self.columns, row) if not math.isfinite(v)]
            raise FloatingPointError(
                f"the run has left finite numbers in {', '.join(broken)}; see curve.csv up to here"
            )
        try:
            self._write([f"{v:.9g}" for v in row])
        except OSError as error:
            raise Unwritable(
                f"cannot write {self.path('curve.csv')}: {error.strerror}"
            ) from None
        self.rows.append(row)

    def _write(self, cells):
        """A line of curve.csv, whole or not at all."""
        line = (",".join(cells) + "\r\n").encode()
        start = self._file.seek(0, os.SEEK_END)
        try:
            while line:
                line = line[self._file.write(line) :]
        except OSError:
            with contextlib.suppress(OSError):
                self._file.truncate(start)
            raise

    def checkRoom(self, least, likely):
        """Refuse a folder without room for ``least`` bytes, and warn of one without room for ``likely`` bytes."""
        free = shutil.disk_usage(self.directory).free
        told = f"{self.directory} has {1e-6 * free:.1f} MB free, this run writes"
        if free < least:
            raise Refused(f"--out: {told} at least {1e-6 * least:.1f} MB")
        if free < likely:
            say(f"warning: {told} some {1e-6 * likely:.1f} MB")

    def column(self, name):
        i = self.columns.index(name)
        return [row[i] for row in self.rows]

    def seconds(self):
        """Wall-clock time of the run so far [s]."""
        return time.perf_counter() - self.started

    def close(self):
        """Close curve.csv and write run.json, whole or not at all."""
        self.run["wall_clock_s"] = round(self.seconds(), 3)
        self._file.close()
        path = self.path("run.json")
        try:
            with open(path + ".new", "w") as f:
                json.dump(self.run, f, indent=2)
                f.write("\n")
            os.replace(path + ".new", path)
        except OSError as error:
            with contextlib.suppress(OSError):
                os.remove(path + ".new")
            raise Unwritable(f"cannot write {path}: {error.strerror}") from None


class Progress:
    """One line that keeps itself up to date on a terminal; a plain line now and then elsewhere."""

    def __init__(self, stream=None):
        self.stream = stream or sys.stdout
        self.terminal = self.stream.isatty()
        self.last = self.stage = None
        self.began = self.first = self.lastTenth = 0

    def show(self, stage, fraction, detail, stepsPerSecond, final=False):
        now = time.perf_counter()
        if stage != self.stage:
            self.stage, self.began, self.first = stage, now, fraction
            self.lastTenth, self.last = -1, 0
        tenth = int(10 * fraction)
        if not final and (
            now - self.last < 0.2 if self.terminal else tenth == self.lastTenth
        ):
            return
        self.last, self.lastTenth = now, tenth
        done = fraction - self.first
        left = (now - self.began) * (1 - fraction) / done if done > 0.01 else None
        text = f"{stage:<12} {detail}  {stepsPerSecond:,.0f} steps/s"
        if left is not None and not final:
            text += f"  {int(left) // 60}:{int(left) % 60:02d} left"
        if self.terminal:
            bar = "#" * int(24 * fraction)
            text = f"\r[{bar:<24}] {text}\x1b[K" + ("\n" if final else "")
        else:
            text += "\n"
        with contextlib.suppress(OSError):  # as in say()
            self.stream.write(text)
            self.stream.flush()


def conduct(make):
    """Make a model, run its stages and finish it in every case; returns the exit status of the scene.

    ``make`` raises Refused for input that cannot be run, and gives a :class:`masonry.checkpoints.Resumable` with a
    method ``finish()``.
    """
    try:
        model = make()
    except Refused as refused:
        print(refused, file=sys.stderr)
        return 2
    stopped = []
    try:
        for model.at.stage in model.stages[model.stages.index(model.at.stage) :]:
            getattr(model, model.at.stage)()
    except Interrupted:
        say("\ninterrupted: what was computed is kept")
    except Unwritable as error:
        stopped.append(error)
    except Exception as error:
        model.results.run["error"] = str(error)
        model.checkpoint()
        model.finish()  # keeps what was computed
        raise
    kept = model.checkpoint()
    try:
        model.finish()
    except Unwritable as error:
        stopped.append(error)
    for error in dict.fromkeys(map(str, stopped)):
        say(f"{error}; what was written before is kept", sys.stderr)
    if kept and (stopped or model.results.interrupted):
        say(f"--resume {model.results.directory} goes on from here")
    return 1 if stopped else 130 if model.results.interrupted else 0


def _read(path):
    """Text of a file of a run."""
    try:
        with open(path, newline="") as f:
            return f.read()
    except OSError as error:
        raise Refused(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise Refused(f"cannot read {path}: it is no text") from None


def readCurve(directory):
    """curve.csv of a run as a dict of column name -> list of numbers; Refused if it is none."""
    path = os.path.join(directory, "curve.csv")
    lines = list(csv.reader(_read(path).splitlines()))
    if len(lines) < 2:
        raise Refused(f"{path}: there is no row of numbers")
    columns, rows, problems = lines[0], [], []
    for number, line in enumerate(lines[1:], start=2):
        try:
            rows.append([float(v) for v in line])
        except ValueError as error:
            problems.append(f"{path}, line {number}: {error}")
        else:
            if len(line) != len(columns):
                problems.append(
                    f"{path}, line {number}: {len(line)} numbers in {len(columns)} columns"
                )
            elif not all(map(math.isfinite, rows[-1])):
                problems.append(f"{path}, line {number}: a number is not finite")
    if problems:
        raise Refused("\n".join(problems[:10]))
    return {c: [row[i] for row in rows] for i, c in enumerate(columns)}


def readRun(directory):
    """run.json of a run as a dict; Refused if it is none."""
    path = os.path.join(directory, "run.json")
    try:
        run = json.loads(_read(path))
    except json.JSONDecodeError as error:
        raise Refused(f"{path}: {error}") from None
    if not isinstance(run, dict):
        raise Refused(f"{path}: is no record of a run")
    return run


@contextlib.contextmanager
def filesOf(directory):
    """Where files of a run are used: what they lack, since they are damaged or another's, becomes Refused."""
    try:
        yield
    except (KeyError, IndexError, AttributeError, TypeError, SyntaxError) as problem:
        raise Refused(
            f"{directory}: these are not the files of a finished run ({type(problem).__name__}: {problem})"
        ) from problem


def onFolder(act, words):
    """Main program of what reads a run: calls ``act`` with the folder that is the only word; the exit status."""
    try:
        if len(words) != 1:
            raise Refused("name one folder of results, for example results/wall_comp4")
        act(words[0])
    except Refused as problem:
        print(problem, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"cannot write to {words[0]}: {error.strerror}", file=sys.stderr)
        return 2
    return 0


def haste(top, base):
    """How much of the force of a push does not arrive at its base [-]: 0 if all does, 1 and more if none does.

    Root mean square of top less base shear over the largest of either, from half the peak at the base to that peak; all
    the way if this peak is less than half of the largest. Inertia swings about it, damping drags.
    """
    forces = [abs(b) for b in base]
    largest = max([*map(abs, top), *forces], default=0)
    if not largest:
        return 0.0
    peak, rows = max(forces), slice(None)
    if peak >= largest / 2:
        start = next(i for i, f in enumerate(forces) if f >= peak / 2)
        rows = slice(start, forces.index(peak) + 1)
    squares = [(t - b) ** 2 for t, b in zip(top[rows], base[rows])]
    return math.sqrt(sum(squares) / len(squares)) / largest


def initialStiffness(displacement, force):
    """Slope [force/displacement] of the line fitted between 5 % and 25 % of the peak, on the way to it."""
    if not force:
        return 0.0
    peak = max(force)
    points = []
    for d, f in zip(displacement, force):
        if f > 0.25 * peak:
            break
        if f > 0.05 * peak:
            points.append((d, f))
    if len(points) < 2:
        points = [(d, f) for d, f in zip(displacement, force)][:2]
    n = len(points)
    md, mf = sum(p[0] for p in points) / n, sum(p[1] for p in points) / n
    spread = sum((d - md) ** 2 for d, _ in points)
    return sum((d - md) * (f - mf) for d, f in points) / spread if spread > 0 else 0.0
