# SPDX-License-Identifier: GPL-2.0-or-later
"""Bounds beside a run: limit analysis of what the stages of a scene load.

A scene asks for them by itself when a stage pushes or leans the structure. :mod:`masonry_limit`
says what they are.
"""

import math
import os
import sys
import tempfile
import time

import numpy as np
from masonry.background import Task
from masonry.errors import Interrupted
from masonry.folders import replaced
from masonry.model import arrays
from masonry.model.load_names import nameInDomain, nameOfLean, nameOfPush
from masonry.packages import Missing
from masonry.terminal import say
from masonry.units import GRAVITY

from . import loads
from .answers import Answers
from .search import Load, search

#: Up to this many joints the bound is computed without being asked for; it takes seconds.
MAX_JOINTS = 3000
#: Time that limit analysis may take for a load, if nobody asked for it, if somebody did, and beside
#: a run that still takes steps [s]. At the end of a run, or at a checkpoint, the first of them
#: counts.
TIME_LIMIT_AUTOMATIC, TIME_LIMIT_REQUESTED, TIME_LIMIT_BACKGROUND = 10.0, 600.0, 120.0
MESSAGE_DELAY = 0.3  # waits for a background task longer than this are reported [s]
#: Note of a bound that was not found when the run was interrupted. One that goes on in the same
#: stage looks for it again.
NOTE_INTERRUPTED = "limit analysis: the run was interrupted before its end; scene.bound() finds it"
#: Note of a bound that was not found when the run came to its end, or to a checkpoint.
NOTE_TIMED_OUT = "limit analysis: it was not solved in time; scene.bound() takes its time"


class Bounds(Answers):
    """The bounds of a scene that is built in YADE. Methods for one kind of load return its entry of
    run.json, and pass ``how`` to :meth:`find`.

    :param model: :class:`masonry.model.structure.Structure`
    :param state: :class:`masonry.run.run_state.RunState`
    :param auxiliary: :meth:`masonry.run.run.Run.auxiliary`
    """

    #: Largest number of joints for which ``--preset bound`` and domains also look for a collapse
    #: without dilatancy, which takes many solutions of the programme.
    SMALL = 500
    EVERY = math.inf  # no limit on the number of joints, if the user asked for this bound

    def __init__(self, model, state, auxiliary):
        super().__init__(state)
        self.model, self.auxiliary = model, auxiliary
        #: what was found last, in this process: limit.Bound and its entry
        self.last = None
        # the task beside the run, which finds a bound and the files of its mechanism; the load, and
        # since when [s]
        self._task, self._looksFor, self._since = None, "", 0.0
        self.endless = set()  # names of loads under which nothing gives way

    def push(self, target, direction, both=False, **how):
        """Find the bound of a push [kN], without what acts beside it; of two the last entry is
        returned.

        :param target: what is pushed, or a :class:`masonry.model.loading.Pattern`
        :param direction: unit vector of the push; ``both``: whether it goes back, too
        """
        for along in (direction, -1 * direction) if both else (direction,):
            name, live = nameOfPush(target, along), _pushOf(target, along)
            entry = self.find(Load(name, "kN", live, pushed=(target, direction)), **how)
        return entry

    def domain(self, target, normals, direction, **how):
        """Find the bounds of a push under several normal forces: a list of entries.

        :param target: a platen with a press, whose vertical force is replaced
        :param normals: with which it presses on what is below, its weight included [kN]
        :param direction: unit vector of the push, horizontal
        """
        of = dict(unit="kN", live=_pushOf(target, direction), pushed=(target, direction))
        entries = []
        for normal in normals:
            name = nameInDomain(target, direction, normal)
            entries.append(self.find(Load(name, pressed=(target, normal), **of), **how))
        return entries

    def lean(self, towards, tilts=False, **how):
        """Find the bound of a horizontal acceleration [g].

        :param towards: unit vector
        :param tilts: whether gravity turns, and does not grow; the factor is then the horizontal
            over the vertical part
        """
        scaled = GRAVITY / self.model.args.density_scaling
        # of a tilt, the weight is that of the scene at every angle
        share = self.model.gravity / scaled if tilts else 1.0
        live = lambda a: share * a.weights(scaled * np.array(towards))
        down = (0, 0, -self.model.gravity)  # it replaces another acceleration
        name, unit = nameOfLean(towards, tilts), "" if tilts else "g"
        return self.find(Load(name, unit, live, tilts, gravity=down), **how)

    def forces(self, what, unit, forces, **how):
        """Find the bound of forces that grow together.

        :param what: name of the load
        :param unit: of its factor
        :param forces: pairs of a MasonryLoad and its force at a factor of 1 [N]
        """
        acting = [(load.body, load.point, force) for load, force in forces]
        live = lambda a: loads.sumOf(a, acting)
        return self.find(Load(what, unit, live), **how)

    def find(self, load, lowerUpTo=0, background=False):
        """Find the bound of a :class:`Load`. Returns its entry of run.json.

        :param lowerUpTo: as in :func:`masonry_limit.search.search`
        :param background: whether it is found beside the run, and the entry gets its numbers by
            :meth:`take`
        """
        self.take(True)
        what, model, state = load.name, self.model, self.state
        known = self.entries.get(what)
        acting = arrays.beside(model, load.gravity or model.scheme.now)
        same = state.auxiliary.get(what, acting) == acting
        state.auxiliary = {**state.auxiliary, what: acting}
        if known and same and not lowerUpTo and known.get("note") != NOTE_INTERRUPTED:
            return known
        if not same:  # the factor that was held before was found with other loads: forget it
            state.held = {k: v for k, v in state.held.items() if k != what}
        entry = self.entries[what] = {"load": what, "unit": load.unit}
        if load.pressed:
            entry["pressed_kN"] = load.pressed[1]
        self.endless.discard(what)
        if state.supportsMoved:
            why = "supports have moved, and joints that are open would be taken as closed"
            entry["note"] = f"no limit analysis: {why}"
            return entry
        count = len(model.interactions)
        if count > MAX_JOINTS and not lowerUpTo:
            entry["note"] = f"no limit analysis: {count} joints are more than {MAX_JOINTS}"
            say(f"note: {entry['note']}; scene.bound() and --preset bound take their time")
            return entry
        seconds = TIME_LIMIT_BACKGROUND if background else TIME_LIMIT_AUTOMATIC
        if lowerUpTo:
            seconds = TIME_LIMIT_REQUESTED
        work = lambda: search(model, load, lowerUpTo, seconds)
        if background:
            self.drop()  # only one task runs at a time: a new one replaces the old
            self._attempt(what, lambda: self._begin(what, work))
            return entry
        try:
            self._attempt(what, lambda: self._note(what, work()))
        except Interrupted:
            del self.entries[what]
            if known:
                self.entries[what] = known
            raise
        return entry

    def isGivenUp(self):
        """Whether a bound is missing because the run was interrupted before it was found."""
        return any(entry.get("note") == NOTE_INTERRUPTED for entry in self.entries.values())

    def _attempt(self, what, act):
        """Do a part of the work for a bound; an unexpected error is the note of its entry."""
        with self.auxiliary(f"limit analysis of {what}") as attempt:
            act()
        if attempt.note:
            self.entries[what]["note"] = attempt.note

    def _note(self, what, found):
        self.entries[what].update(found.entry)
        for line in found.lines:
            # Not recorded as notes: the entry has them, and their order would depend on the
            # machine's speed.
            say(line, noted=False)
        if found.endless:
            self.endless.add(what)
        if found.bound:
            self.last = found.bound, self.entries[what]

    # -- beside the run ----------------------------------------------------------------------------

    def _begin(self, what, work):
        self._task = Task(lambda: self._withFiles(what, work), parts=2)
        self._looksFor, self._since = what, time.monotonic()

    def _withFiles(self, what, work):
        """In a copy of the process: what was found without the mechanism, then the files of the
        mechanism by their names."""
        found = work()
        bound, found.bound = found.bound, None
        yield found
        files, found.bound, found.lines = {}, bound, []
        self._note(what, found)
        try:
            with tempfile.TemporaryDirectory() as folder:
                self.write(folder)
                for name in os.listdir(folder):
                    with open(os.path.join(folder, name), "rb") as file:
                        files[name] = file.read()
        except OSError as error:
            say(f"the mechanism is left out: {error.strerror}", sys.stderr)
        yield files

    def take(self, wait, givesUp=lambda: False):
        """Take the bound that is found beside the run, if it is there. ``wait`` says whether to
        wait for it, and ``givesUp``, meanwhile, whether to do without it."""
        task, what = self._task, self._looksFor
        if not what or not (wait or task.ready()):
            return
        since, note = lambda: time.monotonic() - self._since, ""
        if not task.ready(0, MESSAGE_DELAY) and since() < TIME_LIMIT_AUTOMATIC:
            say("waiting for limit analysis")
        while not note and not task.ready(0, MESSAGE_DELAY):
            if since() > TIME_LIMIT_AUTOMATIC:
                note = NOTE_TIMED_OUT
            elif givesUp():
                note = NOTE_INTERRUPTED
        if note:
            self.entries[what]["note"] = note
            say(f"note: {note}", noted=False)
        else:
            self._attempt(what, lambda: self._note(what, task.result()))
        self._looksFor = ""
        if "factor" in self.entries[what]:
            self.last = None
        else:
            self.drop()

    def drop(self):
        """Leave what is done beside the run."""
        task, self._task, self._looksFor = self._task, None, ""
        if task:
            task.end()

    # -- files -------------------------------------------------------------------------------------

    def write(self, directory, wait=True):
        """Write the files of the mechanism that was found last. ``wait`` says whether to wait for
        those that are made beside the run."""
        if self._task:
            self._writeMade(directory, wait)
        elif self.last:
            bound, entry = self.last
            description, model = self.model.description, self.model
            load = f"{entry['load']}: {entry['factor']:.4g} {entry['unit']}"
            title = f"{description.title}\nlimit analysis, {load}".rstrip()
            try:
                bound.save(directory, title, model.parts, description.views)
            except Missing as missing:
                say(f"the mechanism for ParaView is left out: {missing}", sys.stderr)

    def _writeMade(self, directory, wait):
        """Write the files that were made beside the run."""
        if not self._task.ready(1, MESSAGE_DELAY * wait):
            if not wait:
                return self.drop()
            say("waiting for limit analysis to write the collapse mechanism")
        for name, data in self._task.result(1).items():
            with replaced(os.path.join(directory, name), "wb") as file:
                file.write(data)


def _pushOf(target, direction):
    """The live load of a push of a target, or in a pattern: 1 kN along a direction."""
    along = np.array(direction)
    acting = [(body, at, 1e3 * share * along) for body, at, share in target.parts]
    return lambda assembly: loads.sumOf(assembly, acting)
