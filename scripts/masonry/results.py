"""The files that a run leaves in its folder, and how to read them again. This module needs no YADE.

``curve.csv`` has a row a reading; :mod:`masonry.columns` says what is in each column.

``run.json`` has these keys, in every run:

- ``scene``: name of the scene; ``title``: what it is, for figures
- ``options``: all options of the command line; ``option_units``: units of those that have one
- ``preset``: None, or what :func:`masonry.presets.presetOf` says
- ``columns``: what each column of curve.csv means
- ``joints``: the properties of every kind of joint [SI units]; ``joint_units``: the units by property
- ``unit_material``: ``young_Pa``, ``poisson`` and ``density_kg_per_m3`` of the bricks
- ``units``: how many bricks or half bricks there are; ``nodes``: how many nodes of deformable units; ``joint_count``: how
  many joints between blocks; ``joints_by_kind``: how many of each kind; ``subcontacts``: how many points of joints
- ``versions``: of ``yade``, ``python`` and ``masonry``; ``commit``: of the plugin; ``threads``: how many
- ``time_step_s``, ``time_step_limit_s``: the time step and its stable limit
- ``steps``: how many were taken; ``microseconds_per_step``, ``nanoseconds_per_subcontact_step``: their mean cost
- ``stages``: a list with the name of every ``stage``, its ``steps`` and their ``seconds`` of wall-clock time
- ``seconds``: wall-clock time of ``setup``, ``steps``, ``rows`` and ``frames`` [s]; ``wall_clock_s``: of all
- ``energy_balance_error``: largest error of the energy balance, relative to the work done [-]
- ``energy_made``: most energy that joints made by opening or closing within a step, relative to the work done [-]
- ``kinds``: names of the kinds of joints, in the order of the numbers in the ParaView files
- ``collapsed``: whether what was built has fallen; ``interrupted``: whether Ctrl-C or SIGTERM ended the run
- ``resumed_at_s``: the times in the scene at which the run was taken up from a checkpoint
- ``error``: what ended the run, if an error did

A wall has these, too:

- ``wall``: ``length_m``, ``height_m``, ``thickness_m``, ``courses``, ``half_units`` (the length, in half units),
  ``unit_m`` (length, thickness and height of a unit), ``precompression_Pa``, ``load_height_m`` (height of the push
  above the base, None if the loading block cannot turn), ``measure_height_m`` (height of the displacement above the
  base) and ``load_line_fixed`` (whether the vertical load keeps its line in space)
- ``peak_base_shear_kN``, ``displacement_at_peak_mm``: the largest force at the base, and where it is reached
- ``base_shear_end_kN``, ``displacement_end_mm``: the last row
- ``initial_stiffness_kN_per_mm``: as :func:`masonry.curves.initialStiffness` fits it
- ``dynamic_imbalance``: as of :func:`masonry.curves.dynamicImbalance` [-]; ``too_fast``: whether it is more than a push
  may have

A wall that follows a history has these, too:

- ``history``: ``text``, what the option said; ``points``, how many points it has; ``turning_points``, how often it turns;
  ``path_mm``, the length of the way; of a list ``amplitudes_mm``, pairs of an amplitude [mm] and its number of cycles;
  of a file its path ``file`` and the fingerprint ``sha256`` of its contents
- ``negative_peak_base_shear_kN``, ``displacement_at_negative_peak_mm``: the smallest force, which is the peak of the
  other side
- ``cycles``: a list with the numbers of every whole cycle, as :func:`masonry.curves.cycleNumbers` finds them
- ``damped_share``: as of :func:`masonry.curves.dampedShare` [-]

A couplet has these, too:

- ``peak_normal_stress_MPa``, ``peak_compressive_stress_MPa``, ``peak_shear_stress_MPa``: largest means over the joint
- ``end_normal_stress_MPa``, ``end_shear_stress_MPa``: the last row
- ``dissipated_tension_J_per_m2``, ``dissipated_shear_J_per_m2``, ``dissipated_compression_J_per_m2``: energy that the
  bed joint dissipated, over its area
"""

import contextlib
import csv
import json
import math
import os
import re
import shutil
import sys
import time

from .errors import Refused, Unwritable
from .progress import say

#: Names of the files that a run leaves.
OURS = re.compile(
    r"((blocks|joints)(_\d+\.vt[up]|\.pvd)|curve\.(csv|png)|cracks\.png|run\.(json|checkpoint))(\.new)?"
)


class Results:
    """The folder of a run, while it is written. A folder that cannot be written is refused at once.

    :param directory: folder, made if it is missing
    :param columns: names of the columns of curve.csv
    :param resumed: whether to leave everything as it is, until :meth:`takeUp`
    """

    def __init__(self, directory, columns, resumed=False):
        self.directory = os.path.abspath(directory)
        self.columns, self.rows, self.run = list(columns), [], {}
        self._line = ",".join(["%.9g"] * len(self.columns)) + "\r\n"
        self.started = time.perf_counter()
        try:
            os.makedirs(self.directory, exist_ok=True)
            # files of an earlier run would be taken for those of this one
            for name in [] if resumed else os.listdir(self.directory):
                if OURS.fullmatch(name):
                    os.remove(os.path.join(self.directory, name))
            self._file = open(self.path("curve.csv"), "ab", buffering=0)
            if not resumed:
                self._write(self._head())
                os.fsync(self._file.fileno())
        except OSError as error:
            raise Refused(
                f"--out: cannot write to {self.directory}: {error.strerror}"
            ) from None

    def path(self, name):
        return os.path.join(self.directory, name)

    def _head(self):
        return ",".join(self.columns) + "\r\n"

    def takeUp(self, rows, frames, seconds):
        """Go on after these rows, so many ParaView frames and seconds of wall-clock time. What came later is removed."""
        for name in os.listdir(self.directory):
            number = re.fullmatch(r"(?:blocks|joints)_(\d+)\.vt[up]", name)
            if number and int(number[1]) >= frames:
                os.remove(self.path(name))
        self._file.truncate(0)
        self._write(self._head())
        self.append(rows)
        self.started -= seconds

    def append(self, rows):
        """Write rows to curve.csv.

        :param rows: lists with a number for every column
        :raises FloatingPointError: if a number is not finite; its row and those after it are left out
        :raises Unwritable: if the disk refuses; what fits is kept, in whole lines, and ``rows`` has all of them
        """
        fine = 0
        while fine < len(rows) and all(map(math.isfinite, rows[fine])):
            fine += 1
        self.rows += rows[:fine]
        try:
            self._write("".join(self._line % tuple(row) for row in rows[:fine]))
        except OSError as error:
            raise Unwritable(
                f"cannot write {self.path('curve.csv')}: {error.strerror}"
            ) from None
        if fine < len(rows):
            numbers = zip(self.columns, rows[fine])
            broken = [name for name, number in numbers if not math.isfinite(number)]
            raise FloatingPointError(
                f"the run has left finite numbers in {', '.join(broken)}; see curve.csv up to here"
            )

    def _write(self, text):
        """Add lines to curve.csv. If the disk is full, those that fit stay, each of them whole."""
        data, written = text.encode(), 0
        start = self._file.seek(0, os.SEEK_END)
        try:
            while written < len(data):
                written += self._file.write(data[written:])
        except OSError:
            with contextlib.suppress(OSError):
                self._file.truncate(start + data.rfind(b"\n", 0, written) + 1)
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
        """All values of a column so far."""
        i = self.columns.index(name)
        return [row[i] for row in self.rows]

    def seconds(self):
        """Wall-clock time of the run so far [s]."""
        return time.perf_counter() - self.started

    def close(self):
        """Close curve.csv and write run.json, whole or not at all. Raises Unwritable if the disk refuses."""
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
    """curve.csv of a run as a dict of column name -> list of numbers. Raises Refused if there is none."""
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
    """run.json of a run as a dict; this module's docstring lists its keys. Raises Refused if there is none."""
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
    """Use the files of a run. What they lack, since they are damaged or not of a finished run, becomes Refused."""
    try:
        yield
    except (KeyError, IndexError, AttributeError, TypeError, SyntaxError) as problem:
        raise Refused(
            f"{directory}: these are not the files of a finished run ({type(problem).__name__}: {problem})"
        ) from problem


def onFolder(act, words):
    """Main program of what reads a run: calls ``act`` with the folder that is the only word. Returns the exit status."""
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
