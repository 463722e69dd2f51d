"""What a run leaves behind: curve.csv, run.json, progress on the terminal; and how to read it again."""

import csv
import json
import math
import os
import re
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
    r"(blocks|joints)(_\d+\.vt[up]|\.pvd)|curve\.(csv|png)|cracks\.png|run\.(json|checkpoint(\.new)?)"
)


class Interrupted(Exception):
    """Ctrl-C or SIGTERM: the run ends in order and keeps what is there."""


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
            self._file = open(
                self.path("curve.csv"), "a", newline="", buffering=1
            )  # a row at a time
        except OSError as error:
            raise Refused(
                f"--out: cannot write to {self.directory}: {error.strerror}"
            ) from None
        self.columns, self.rows, self.run = columns, [], {}
        self._writer = csv.writer(self._file)
        if not resumed:
            self._writer.writerow(columns)
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
        self._writer.writerow(self.columns)
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
        self.rows.append(row)
        self._writer.writerow([f"{v:.9g}" for v in row])

    def column(self, name):
        i = self.columns.index(name)
        return [row[i] for row in self.rows]

    def seconds(self):
        """Wall-clock time of the run so far [s]."""
        return time.perf_counter() - self.started

    def close(self):
        """Write run.json and close curve.csv."""
        self.run["wall_clock_s"] = round(self.seconds(), 3)
        self._file.close()
        with open(self.path("run.json"), "w") as f:
            json.dump(self.run, f, indent=2)
            f.write("\n")


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
            self.stream.write(f"\r[{bar:<24}] {text}\x1b[K" + ("\n" if final else ""))
        else:
            self.stream.write(text + "\n")
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
    try:
        for model.at.stage in model.stages[model.stages.index(model.at.stage) :]:
            getattr(model, model.at.stage)()
    except Interrupted:
        print("\ninterrupted: what was computed is kept")
    except Exception:
        model.checkpoint()
        model.finish()  # keeps what was computed
        raise
    kept = model.checkpoint()
    model.finish()
    if model.results.interrupted and kept:
        print(f"--resume {model.results.directory} goes on from here")
    return 130 if model.results.interrupted else 0


def readCurve(directory):
    """curve.csv of a run as a dict of column name -> list of numbers."""
    with open(os.path.join(directory, "curve.csv"), newline="") as f:
        reader = csv.reader(f)
        columns = next(reader)
        rows = [[float(v) for v in row] for row in reader]
    return {c: [row[i] for row in rows] for i, c in enumerate(columns)}


def readRun(directory):
    """run.json of a run as a dict."""
    with open(os.path.join(directory, "run.json")) as f:
        return json.load(f)


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
