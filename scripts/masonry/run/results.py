# SPDX-License-Identifier: GPL-2.0-or-later
"""The files that a run leaves in its folder, and how to read them again. No YADE is needed.

``curve.csv`` has a row a reading. ``run.json`` has these entries, with SI units where a name has
none; what does not apply is left out or None:

- ``scene``: its name; ``title``: of figures
- ``options``: those of the command line; ``option_units``
- ``preset``: :func:`masonry.run.presets.presetOf`; ``preset_note``: it as a sentence
- ``columns``: what each column of curve.csv means
- ``joints``: the properties of every kind of joint; ``joint_units``, ``joint_meanings``: by
  property; ``effective_properties``: by kind of joint, the numbers among them that have an effect
- ``unit_material``: ``young_Pa``, ``poisson`` and ``density_kg_per_m3`` of the bricks
- ``assumed``: properties that were not given: ``name``, as ``bed.residualFriction``, ``value``,
  ``unit``, ``source`` and ``by_code``; of the name ``support``: these joints take the bed joint
- ``units``: number of bricks or half bricks; ``nodes``: of deformable units; ``joint_count``,
  ``joints_by_kind``; ``subcontacts``: points of joints at the beginning; ``refined_joints``: joints
  of rigid units that got more points
- ``versions``, ``commit`` of the plugin, ``host``, ``date``: in UTC, when the run ended;
  ``threads``: how many steps may use; ``steps_by_threads``: :func:`masonry.model.threads.used`, of
  the process that ended the run
- ``stages``: of every ``stage`` its ``steps``, their ``seconds`` of wall-clock time, the number
  ``first_row`` of its first row of curve.csv, from 0, ``load``: its kind, its name, that of the
  load back, and the control of a push if it is not what is pushed, and ``continued``: whether it is
  a push that goes on with the curve of the one before; of the first ``settle`` also ``solved``:
  whether it began with the elastic solution
- ``script``: the commands with their arguments, also those that were left out; a long list of
  numbers is a text
- ``built``, ``held_and_loaded``: pairs of texts on the structure before the first stage; not with
  --lean
- ``warnings``: sentences on what the numbers suffer from; ``notes``: warnings and notes that were
  said, each once, with ``text``, ``stage``, its ``number`` and ``time_s``, empty and 0 before the
  first stage
- ``seconds``: wall-clock time of ``setup``, with first periods; of ``steps``, with those that look
  for buckling; of ``rows`` and ``frames``
- ``kinds``: names of the kinds of joints by their numbers in the ParaView files
- ``collapsed``; ``collapse``: what has fallen, and how far; ``ended``: how the last stage ended
  (:mod:`masonry.stages.answers`)
- ``interrupted``: by Ctrl-C or SIGTERM; ``error``: what ended the run; ``resumed_at_s``: times in
  the scene at which it was resumed
- ``files``: names that the run may have written, with * for a number; the next run in this folder
  replaces these and no others
- ``figure``: what curve.png shows; without it nothing is drawn:

  - ``x``, ``y``: ``{"column": "displacement_mm", "label": "displacement of the top [mm]"}``, and a
    list of such dicts, the first of which is drawn in bold
  - ``y_label``: of the axis, with the unit in brackets
  - ``looped``: whether x goes there and back, which is drawn with axes through zero and envelope
  - ``marks``: points, as ``{"x": 2.6, "y": 115.2, "text": "115.2 kN at 2.60 mm"}``, with ``"below":
    true`` for a text below
  - ``rows``: pairs of the first row that is shown, from 0, and the one behind the last; else all
  - ``bounds``: horizontal lines, as ``{"y": 117.0, "text": "limit analysis, upper bound"}``

- ``parts``: lists of body ids by name, each a panel of cracks.png; ``views``: direction of sight by
  part, if not that of :func:`masonry_view.views.viewOf`; ``reference_body``: id of the body whose
  displacement is taken off all others there
- ``answers``: :class:`masonry.stages.answers.Answer` of the stages, with ``stage`` and ``number``
- ``recorded_joints``, ``recorded_drifts``, ``recorded_sections``: joints whose means are recorded;
  columns of drifts [mrad], and of forces and moments of sections
- ``ties``, ``springs``, ``overlays``: ``entry()`` of each in :mod:`masonry.scene.ties`; ties
  include the bundles of fibres that are no longer elastic; ``bodies`` has -1 for the ground
- ``ground_body``, ``contact``: if a collapse is followed, the id of the ground, and the properties
  of contacts; fallen.csv has a row for every block that fell
- ``held``: names of platens and bricks that are held; ``targets``: all that are held, loaded or
  watched, with ``name``, ``body`` and ``held``
- ``bounds``: what limit analysis (:mod:`masonry_limit`) found for every load that pushed, leant or
  tilted: ``load``, ``unit``; ``factor``, the largest one; ``exact``: rigid blocks carry just that,
  else it is an upper bound; ``open_joints_slip``, a lower factor at which a mechanism with open
  head joints gives way; ``dilates``: joints that slip open; ``joints``, how many ``opens``,
  ``slides`` and ``crushes``; ``powers``, the share of each strength in the mechanism's power [-];
  ``facets`` of the friction cones in space, and their ``facet_error`` [-]; or a ``note``, why there
  is none. With --preset bound ``without_dilatancy``, the factor if joints slip without opening, and
  ``without_dilatancy_settled``, whether its iteration has settled. Of ``scene.domain``
  ``pressed_kN``, the normal force that was given, and ``normal_kN``, that at the supports
- ``largest_cracks_mm``: the largest opening at the end by kind of joint and by part;
  ``largest_crack_at_m``, ``largest_crack_bodies``: its point as built, and the ids of both bodies
- ``accuracy``, ``peak_half_width_kN``, ``work_half_width_J``:
  :meth:`masonry.run.accuracy.AuxiliaryRuns.report`
- ``wall``: :func:`masonry.scene.summary.wallOf`: ``corner_m``, x and z of its lower left corner;
  ``unit_m``, length, thickness and height of a unit; heights are above the base, and
  ``load_height_m`` is None if the platen cannot turn
- ``history``: of a push that follows one: ``text`` of the option; ``points``, ``turning_points``:
  how many; ``path_mm``: length of the way; ``noise_mm``: up to which an excursion is no half cycle;
  ``amplitudes_mm``: pairs of an amplitude and its number of cycles, or ``file`` and ``sha256``;
  ``cycles``: :func:`masonry.numbers.curves.cycleNumbers`; both of the last such stage alone

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
from .lock import DRAWN, FILES, OUR_FILES, Lock, recorded

__doc__ = f"{__doc__}{quantities.described()}"


class Results:
    """The folder of a run, while it is written. A folder that cannot be written is refused at once,
    and so is one with files of these names that no run has left. Files of an earlier run stay until
    :meth:`begin`.

    :param directory: folder, made if it is missing
    :param resumed: whether to leave everything as it is, until :meth:`resume`
    :param scene: its name, for others that want the folder
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
        names = sorted(n for n in os.listdir(self.directory) if OUR_FILES.fullmatch(n))
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
        return self._file is not None

    def begin(self):
        """Write files from now on, and remove those of an earlier run. Raises Unwritable."""
        if self.begun:
            return
        self._lock.ours = True
        with folders.writing(f"to {self.directory}"):
            # run.json says whose the others are, and goes last
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
        return open(self.path("curve.csv"), "ab", buffering=0, opener=folders.inside)

    def resume(self, rows, frames, seconds):
        """Go on after these rows, number of ParaView frames and seconds of wall-clock time; later
        ones are removed."""
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
        """Add lines to curve.csv; on a full disk the whole lines that fit stay."""
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
        """Refuse a disk without room for ``least`` bytes, and warn without ``likely`` bytes."""
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
        """All values of a column so far. Raises Refused if there is no such column."""
        if name not in self.columns:
            raise Refused(f"no column {name!r}; there are {', '.join(self.columns)}")
        i = self.columns.index(name)
        return [row[i] for row in self.rows]

    def seconds(self):
        """Wall-clock time of the run so far [s]."""
        return time.perf_counter() - self.started

    def close(self):
        """Close curve.csv and write run.json, whole or not at all. Raises Unwritable."""
        self.begin()
        self.run.update(wall_clock_s=round(self.seconds(), 3), files=FILES)
        self._file.close()
        self._writeRecord()

    def _writeRecord(self):
        path = self.path("run.json")
        with folders.writing(path), folders.replaced(path) as f:
            json.dump(self.run, f, indent=2)
            f.write("\n")
