# SPDX-License-Identifier: GPL-2.0-or-later
"""The files that a run leaves in its folder, and how to read them again. This module needs no YADE.

``curve.csv`` has a row a reading; :mod:`masonry.numbers.columns` says what is in each column.

``run.json`` has these keys, in every run:

- ``scene``: name of the scene; ``title``: what it is, for figures
- ``options``: all options of the command line; ``option_units``: units of those that have one
- ``preset``: None, or what :func:`masonry.run.presets.presetOf` says; ``preset_note``: what it
  promises, a sentence
- ``columns``: what each column of curve.csv means
- ``joints``: the properties of every kind of joint [SI units]; ``joint_units``: the units by
  property; ``joint_meanings``: what each property means; ``effective_properties``: by
  kind of joint, the numbers among them that have an effect
- ``unit_material``: ``young_Pa``, ``poisson`` and ``density_kg_per_m3`` of the bricks
- ``assumed``: properties of the materials that were not given: a list of dicts with ``name``, as
  ``bed.residualFriction``, ``value``, ``unit`` and ``source``. An entry with the name ``support``
  says that these joints take the bed joint
- ``units``: how many bricks or half bricks there are; ``nodes``: how many nodes of deformable
  units; ``joint_count``: how many joints between blocks; ``joints_by_kind``: how many of each kind;
  ``subcontacts``: how many points of joints when the run began; ``refined_joints``: of rigid units,
  how many joints got more of them
- ``versions``: of ``yade``, ``python`` and ``masonry``; ``commit``: of the plugin; ``threads``: how
  many steps may use; ``host``: its name; ``date``: when the run ended, in UTC, as
  2026-05-31T12:00:00Z
- ``steps_by_threads``: what :func:`masonry.model.threads.used` says, of the process that ended
  the run
- ``stages``: a list with the name of every ``stage``, its ``steps`` and their ``seconds`` of
  wall-clock time, the number ``first_row`` of its first row of curve.csv, from 0, and ``load``: its
  kind, its name, and that of the load back; None if it has none
- ``script``: what the script said, a list of words with their arguments, with those that were not
  given; a long list of numbers is a text
- ``built``, ``held_and_loaded``: what is built, and what is held and loaded before the first stage,
  pairs of texts; not with --lean
- ``warnings``: sentences on what the numbers of the run suffer from
- ``notes``: warnings and notes that the run said while it went on, but for those of ``bounds``: a
  list of dicts with ``text``, the ``stage`` in which it was said and its ``number``, and ``time_s``
  in the scene. Before the first stage these are empty and 0; what the process said before the run
  began stands there, too. Each text stands there once, when it was said first
- ``seconds``: wall-clock time of ``setup``, ``steps``, ``rows`` and ``frames`` [s]
- ``kinds``: names of the kinds of joints, in the order of the numbers in the ParaView files
- ``collapsed``: whether what was built has fallen; ``interrupted``: whether Ctrl-C or SIGTERM ended
  the run
- ``resumed_at_s``: the times in the scene at which the run was taken up from a checkpoint
- ``error``: what ended the run, if an error did
- ``files``: names of the files that the run may have written, with * for a number; the next run in
  this folder replaces these and no others
- ``figure``: what curve.png shows, a dict; only a run that has it can be drawn:

  - ``x`` and ``y``: ``{"column": "displacement_mm", "label": "displacement of the top [mm]"}``, and
    a list of such dicts, the first of which is drawn in bold; columns are those of curve.csv, and x
    can be ``time_s``
  - ``y_label``: of the axis, with the unit in brackets
  - ``looped``: whether x goes there and back, which is drawn with axes through zero and with the
    envelope; else false
  - ``marks``: a list of ``{"x": 2.6, "y": 115.2, "text": "115.2 kN at 2.60 mm"}``, points to show,
    whose text stands below them with ``"below": true``; may be left out
  - ``rows``: numbers of the rows that are shown, from 0; may be left out, and all are shown then
  - ``bounds``: a list of ``{"y": 117.0, "text": "limit analysis, upper bound"}``, horizontal lines;
    may be left out

- ``parts``: a dict of name -> list of body ids, for cracks.png, which has a panel for every part;
  may be left out, and all blocks are one part then
- ``views``: a dict of part -> direction of sight (x, y, z), for parts that shall not be seen as
  :func:`masonry_view.views.viewOf` chooses; may be left out
- ``reference_body``: id of a body whose displacement is taken off all others in cracks.png, as that
  of a ground that is shaken; may be left out

- ``answers``: the numbers that the stages were run for, a list of dicts: ``stage``, its name;
  ``number`` of the stage in the run, from 1; ``name`` of the answer, its ``unit`` and ``value``,
  which is None if it was not found; ``uncertainty``, half the width of the interval that the run
  itself found about it, or None if it has no measure of it; and ``how``, a sentence on how both
  were found
- ``recorded_joints``: names of the joints whose means are recorded; ``recorded_drifts``,
  ``recorded_sections``: columns of curve.csv that have drifts [mrad], and forces and moments of
  sections
- ``ties``: of every tie, and of every bundle of fibres that is no longer elastic, a dict: ``name``,
  ``ends_m``, ``bodies`` (-1: the ground) and ``between`` of its ends, ``stiffness_N_per_m``,
  ``strength_N``, ``prestress_N``, ``slack_m``, ``breaking_strain``, ``compression``, ``state``
  (elastic, yielded or broken), ``force_N`` and ``plastic_elongation_m``; ``springs``: of every
  spring ``name``, ``at_m``, ``between``, ``stiffness_N_per_m``, ``rotational_stiffness_Nm``,
  ``force_N`` and ``moment_Nm`` on its first end; ``overlays``: of every fibre layer ``name``, and
  how many ``bundles`` it has, and have ``yielded`` or ``broken``. Each is there if the scene has
  some
- ``ended``: how the last stage ended: ``at rest``, ``moving``, ``done`` or ``collapsed``; of a
  scene that follows a collapse also ``collapsed and at rest``, or ``collapsed and moving`` if that
  was given up
- ``ground_body``: of such a scene, the id of the ground; ``contact``: the properties of its
  contacts, ``normalStiffness`` [Pa/m], ``tangentialRatio``, ``friction`` and ``restitution`` [-];
  fallen.csv has a row for every block that fell
- ``collapse``: what has fallen, and how far; None if nothing has
- ``held``: names of the platens and bricks that are held; ``targets``: of all platens and bricks
  that are held, loaded or watched, a list of dicts with ``name``, the id of its ``body`` and
  whether it is ``held``

A run that pushes, leans or tilts has these, if limit analysis (:mod:`masonry_limit`) applies:

- ``bounds``: a list with what it found for every load: ``load`` and ``unit``; ``factor``, the
  largest one; ``exact``, whether rigid blocks carry just that, else it is an upper bound;
  ``open_joints_slip``, a lower factor at which a mechanism with open head joints gives way, or
  None; ``dilates``, whether joints that slip open; ``joints``, how many ``opens``, ``slides`` and
  ``crushes``; ``powers``, which share of the mechanism's power each strength takes [-]; ``facets``
  of the friction cones in space, and the ``facet_error`` they leave [-]; or a ``note``, why there
  is none. With --preset bound also ``without_dilatancy``, the factor of a collapse in which joints
  slip without opening, and whether it has ``without_dilatancy_settled``. An entry of
  ``scene.domain`` has ``pressed_kN``, the normal force that was given, and ``normal_kN``, that at
  the supports The process that finds the bound draws its mechanism at its end, so a run that was
  killed and resumed has no picture of it

Every run but one with --preset bound has these, too:

- ``largest_cracks_mm``: the largest opening at the end by kind of joint, and by part of the bricks
- ``largest_crack_at_m``, ``largest_crack_bodies``: the point of the widest crack as it was built
  (x, y, z), and the ids of both bodies of its joint; None if none is open

A run with a push has these, too:

- with --accuracy: ``peak_half_width_kN`` and ``work_half_width_J``, half the widths of the
  intervals of ``peak_at_both_ends_kN`` and of ``push_work_J``; and ``accuracy``: ``asked_percent``;
  ``reached``, whether both are within it; ``fidelity``, what was chosen; ``quantities``, a list
  with ``name``, ``unit``, ``value``, ``half_width``, ``half_width_percent``, ``parts_percent`` by
  the source of the error, and ``how`` it was found; ``not_covered``; and ``companions``, the runs
  beside this one: ``name``, ``options``, ``peak`` [kN], ``work`` [J], ``seconds``, ``collapsed``,
  ``folder``
- ``wall``, of a whole wall in running bond in the x-z plane that a platen pushes: ``corner_m`` (x
  and z of its lower left corner), ``length_m``, ``height_m``, ``thickness_m``, ``courses``,
  ``half_units`` (the length, in half units), ``unit_m`` (length, thickness and height of a unit),
  ``precompression_Pa``, ``load_height_m`` (height of the push above the base, None if the platen
  cannot turn), ``measure_height_m`` (height of the displacement above the base), ``pushed_towards``
  (1 along x, -1 against it) and ``load_line_fixed`` (whether the vertical load keeps its line in
  space)
- ``history``, of one that follows one: ``text``, what the option said; ``points``, how many points
  it has; ``turning_points``, how often it turns; ``path_mm``, the length of the way; ``noise_mm``,
  up to which an excursion is no half cycle; of a list ``amplitudes_mm``, pairs of an amplitude [mm]
  and its number of cycles; of a file its path ``file`` and the fingerprint ``sha256`` of its
  contents. Then also ``cycles``: a list with the numbers of every whole cycle, as
  :func:`masonry.numbers.curves.cycleNumbers` finds them

Numbers, one a line with its source and unit, are those of :mod:`masonry.numbers.quantities`.
"""

import contextlib
import itertools
import json
import math
import os
import re
import shutil
import time

from .. import folders
from ..auxiliary import addToLog
from ..errors import Refused
from ..terminal import say
from ..numbers import quantities
from ..numbers.files import readWhole
from .lock import DRAWN, FILES, OURS, Lock, recorded

__doc__ = f"{__doc__}{quantities.described()}"


class Results:
    """The folder of a run, while it is written. A folder that cannot be written is refused at once.

    Files of an earlier run stay until this one has something in their place: :meth:`begin` removes
    them. Files of these names that no run has left are refused.

    :param directory: folder, made if it is missing
    :param resumed: whether to leave everything as it is, until :meth:`takeUp`
    :param scene: name of the scene, for others that want the folder
    """

    def __init__(self, directory, columns, resumed=False, scene=""):
        try:
            self.directory = os.path.abspath(directory)
        except OSError as error:  # the present folder was removed
            raise Refused(f"--out: no folder {directory}: {error.strerror}") from None
        self.columns, self.rows, self.run = list(columns), [], {}
        self._head = ",".join(self.columns) + "\r\n"
        self._line = ",".join(["%.9g"] * len(self.columns)) + "\r\n"
        self._file = None  # curve.csv
        self._log = ""  # what errors.log gets when files are written
        self.started = time.perf_counter()
        self._lock, self._made = None, False
        try:
            self.directory.encode()
            self._made = not resumed and not os.path.isdir(self.directory)
            if self._made:
                os.makedirs(self.directory)
            folders.check(self.directory)
            self._lock = Lock(self.directory, scene)
            #: names of the files of an earlier run, which are still there
            self.earlier = [] if resumed else self._earlier()
        except (OSError, ValueError) as error:
            self.release()
            if isinstance(error, Refused):
                raise
            if isinstance(error, UnicodeEncodeError):
                why = "its name is not UTF-8"
            else:
                why = getattr(error, "strerror", None) or error
            raise Refused(f"--out: cannot write to {self.directory}: {why}") from None

    def _earlier(self):
        names = sorted(n for n in os.listdir(self.directory) if OURS.fullmatch(n))
        if not names or self._lock.ours:
            return names
        record, strange = recorded(self.directory), names
        if record:
            head = ",".join(record["columns"]).encode()
            strange = [n for n in names if n == "curve.csv" and not self._begins(head)]
        if strange:
            raise Refused(
                f"--out: {self.directory} holds"
                f" {', '.join(strange[:5])}{' and more' * (len(strange) > 5)}, which no run has"
                " left there: move that away, or name another folder"
            )
        return names

    def _begins(self, head):
        try:
            return readWhole(self.path("curve.csv")).splitlines()[:1] == [head]
        except OSError:
            return False

    @property
    def begun(self):
        """Whether files are written."""
        return self._file is not None

    def begin(self):
        """From now on files are written. Those of an earlier run go. Raises Unwritable if the disk
        refuses."""
        if self.begun:
            return
        self._lock.ours = True
        with folders.writing(f"to {self.directory}"):
            # files of an earlier run would be taken for those of this one; run.json says whose they
            # are, and goes last
            for name in sorted(self.earlier, key="run.json".__eq__):
                with contextlib.suppress(FileNotFoundError):
                    os.remove(self.path(name))
            self.earlier = []
            self._file = self._curve()
            self._write(self._head)
            os.fsync(self._file.fileno())
        self.log("")

    def release(self):
        """Let other runs have the folder; one that was made for nothing goes."""
        if self._lock:
            self._lock.release()
        if self._made and not self.begun:
            with contextlib.suppress(OSError, ValueError):
                os.rmdir(self.directory)

    def log(self, text):
        """Add a text to errors.log, now or when files are written."""
        self._log += text
        if self._log and self.begun:
            addToLog(self.directory, self._log)
            self._log = ""

    def amend(self, **entries):
        """Write run.json again, with other entries, if it was written before."""
        if self._file and self._file.closed:
            self.run.update(entries)
            self._writeRecord()

    def path(self, name):
        return os.path.join(self.directory, name)

    def _curve(self):
        """curve.csv, open to add to it."""
        return open(self.path("curve.csv"), "ab", buffering=0, opener=folders.inside)

    def takeUp(self, rows, frames, seconds):
        """Go on after these rows, so many ParaView frames and seconds of wall-clock time. What came
        later is removed."""
        # what is wrong with the rows or the file comes before anything is changed
        "".join(self._line % tuple(row) for row in rows)
        curve = self._curve()
        for name in os.listdir(self.directory):
            number = re.fullmatch(r"(?:blocks|joints)_(\d+)\.vt[up]", name)
            if name in DRAWN or number and int(number[1]) >= frames:
                os.remove(self.path(name))
        self._lock.ours = True
        self._file = curve
        self.log("")
        self._file.truncate(0)
        self._write(self._head)
        self.rows.clear()
        self.append(rows)
        self.started -= seconds

    def append(self, rows):
        """Write rows to curve.csv.

        :param rows: lists with a number for every column
        :raises FloatingPointError: if a number is not finite; its row and those after it are left
            out
        :raises Unwritable: if the disk refuses; what fits is kept, in whole lines, and ``rows`` has
            all of them
        """
        if not rows:
            return
        self.begin()
        isFine = lambda row: all(map(math.isfinite, row))
        fine = [*itertools.takewhile(isFine, rows)]
        self.rows += fine
        with folders.writing(self.path("curve.csv")):
            self._write("".join(self._line % tuple(row) for row in fine))
        if len(fine) < len(rows):
            numbers = zip(self.columns, rows[len(fine)])
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

    def checkSpace(self, least, likely):
        """Refuse a folder without room for ``least`` bytes, and warn of one without room for
        ``likely`` bytes."""
        free = shutil.disk_usage(self.directory).free
        for name in self.earlier:  # these make room
            with contextlib.suppress(OSError):
                free += os.lstat(self.path(name)).st_size
        text = f"{self.directory} has {1e-6 * free:.1f} MB free, this run writes"
        if free < least:
            raise Refused(f"--out: {text} at least {1e-6 * least:.1f} MB")
        if free < likely:
            say(f"warning: {text} some {1e-6 * likely:.1f} MB")

    def column(self, name):
        """All values of a column so far."""
        i = self.columns.index(name)
        return [row[i] for row in self.rows]

    def seconds(self):
        """Wall-clock time of the run so far [s]."""
        return time.perf_counter() - self.started

    def close(self):
        """Close curve.csv and write run.json, whole or not at all. Raises Unwritable if the disk
        refuses."""
        self.begin()
        self.run.update(wall_clock_s=round(self.seconds(), 3), files=FILES)
        self._file.close()
        self._writeRecord()

    def _writeRecord(self):
        path = self.path("run.json")
        with folders.writing(path), folders.replaced(path) as f:
            json.dump(self.run, f, indent=2)
            f.write("\n")
