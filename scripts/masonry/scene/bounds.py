# SPDX-License-Identifier: GPL-2.0-or-later
"""Bounds beside a run: limit analysis of what the stages of a scene load.

:class:`masonry.scene.scene.Scene` asks for them by itself when a stage pushes or leans the
structure. :mod:`masonry.limit` says what they are.
"""

import contextlib
import math
import os
import sys
import tempfile
import time
from dataclasses import dataclass
from typing import Callable

import numpy as np

from .. import limit
from ..common.background import Task
from ..basics import GRAVITY, Interrupted, Refused, say
from ..limit.assembly import Endless
from ..common.memory import FULL
from ..common.packages import Missing
from ..common.folders import replaced
from . import limit_loads

#: Largest number of joints for which ``--preset bound`` and domains also look for a collapse
#: without dilatancy, which takes many solutions of the programme.
SMALL = 500
EVERY = math.inf  # the same limit where the user asks for that collapse: none
#: Largest number of joints of a run that is bounded unasked: within seconds.
JOINTS = 3000
#: Time that limit analysis may take for a load, if nobody asked for it, if somebody did, and if it
#: is done beside a run that still takes steps [s]. A run that has come to its end, or to a
#: checkpoint, waits until the first of them is over.
UNASKED, ASKED, IN_BACKGROUND = 10.0, 600.0, 120.0
#: Of the search for a tilt at which both parts of gravity are those of the tilt: its rounds at
#: most, the difference of two tilts at which it ends, and the largest tilt [rad].
TILTS, SAME_TILT, STEEPEST = 20, 1e-6, math.radians(89.9)
FIGURE = "mechanism.png"
#: The note of a bound that was not found when the run was interrupted. One that goes on in the same
#: stage looks for it again.
GIVEN_UP = "limit analysis: the run was interrupted before its end; scene.bound() finds it"
#: The note of one that was not found when the run came to its end, or to a checkpoint.
LATE = "limit analysis: it was not solved in time; scene.bound() takes its time"
#: By how much a run may be above its bound [-]: joints of finite stiffness, and displacements that
#: are not small.
TOLERANCE = 0.02
SILENT = 0.3  # so long something beside the run is waited for without a word [s]
SOON = 1.0  # [s] in which a run that is interrupted waits for its bound


@dataclass(frozen=True)
class Load:
    """A load whose largest factor is looked for.

    :param name: under which its bound is found, and ``unit`` of its factor
    :param live: function of a :class:`masonry.limit.assembly.Assembly` that gives the forces at a
        factor of 1 [N]
    :param tilts: whether gravity turns with it
    :param pushed: target and direction of a push, whose own drive is no prop, or None
    :param gravity: acceleration that acts beside it [m/s²]; None: that of the scene
    :param pressed: target and normal force [kN] that replaces its press, or None
    """

    name: str
    unit: str
    live: Callable
    tilts: bool = False
    pushed: tuple | None = None
    gravity: tuple | None = None
    pressed: tuple | None = None


class Bounds:
    """The bounds of a scene that is built in YADE.

    :param model: :class:`masonry.assembly.structure.Structure`
    :param place: :class:`masonry.run.run_state.RunState`: what was found is kept there, and so in
        checkpoints
    :param auxiliary: :meth:`masonry.run.run.Run.auxiliary`
    """

    def __init__(self, model, place, auxiliary):
        self.model, self.place, self.auxiliary = model, place, auxiliary
        #: what was found last, in this process: limit.Bound and its entry
        self.last = None
        # beside the run: finds a bound, then the files of its mechanism
        self._task = None
        self._looksFor, self._since = (
            "",
            0.0,
        )  # the load whose bound it finds, since [s]
        self.endless = set()  # names of loads under which nothing gives way

    @property
    def entries(self):
        """What was found, by the load: entries of run.json. A checkpoint keeps them."""
        return self.place.bounds

    def push(self, target, direction, both=False, **how):
        """Find the bound of a push [kN], without what acts beside it. Returns its entry of
        run.json, the last one if there are two.

        :param target: what is pushed, or a :class:`masonry.assembly.loading.Pattern`
        :param direction: unit vector of the push; ``both``: whether it goes back, too
        :param how: as in :meth:`find`
        """
        for along in (direction, -1 * direction) if both else (direction,):
            load = Load(
                nameOfPush(target, along), "kN", _pushOf(target, along), pushed=(target, direction)
            )
            entry = self.find(load, **how)
        return entry

    def domain(self, target, normals, direction, **how):
        """Find the bounds of a push under several normal forces. Returns their entries of run.json.

        :param target: a platen with a press, whose vertical force is replaced
        :param normals: with which it presses on what is below, its weight included [kN]
        :param direction: unit vector of the push, horizontal
        :param how: as in :meth:`find`
        """
        names = [nameInDomain(target, direction, normal) for normal in normals]
        live = _pushOf(target, direction)
        of = dict(unit="kN", live=live, pushed=(target, direction))
        loads = [Load(n, pressed=(target, k), **of) for n, k in zip(names, normals)]
        return [self.find(load, **how) for load in loads]

    def lean(self, towards, tilts=False, **how):
        """Find the bound of a horizontal acceleration [g]. Returns its entry of run.json.

        :param towards: unit vector
        :param tilts: whether gravity turns, and does not grow; the factor is then the horizontal
            over the vertical part
        :param how: as in :meth:`find`
        """
        scaled = GRAVITY / self.model.args.density_scaling
        # of a tilt, the weight is that of the scene at every angle
        share = self.model.gravity / scaled if tilts else 1.0
        live = lambda a: share * a.weights(scaled * np.array(towards))
        down = (0, 0, -self.model.gravity)  # it replaces another acceleration
        name, unit = nameOfLean(towards, tilts), "" if tilts else "g"
        return self.find(Load(name, unit, live, tilts, gravity=down), **how)

    def forces(self, what, unit, loads, **how):
        """Find the bound of forces that grow together. Returns its entry of run.json.

        :param what: name of the load
        :param unit: of its factor
        :param loads: pairs of a MasonryLoad and its force at a factor of 1 [N]
        :param how: as in :meth:`find`
        """
        acting = [(load.body, load.point, force) for load, force in loads]
        live = lambda a: limit_loads.sumOf(a, acting)
        return self.find(Load(what, unit, live), **how)

    def find(self, load, lowerUpTo=0, background=False):
        """Find the bound of a :class:`Load`. Returns its entry of run.json.

        :param lowerUpTo: up to so many joints a collapse without dilatancy is looked for, too, if
            the bound is not exact
        :param background: whether it is found beside the run, and the entry gets its numbers by
            :meth:`take`
        """
        self.take(True)
        what, model, place = load.name, self.model, self.place
        known = self.entries.get(what)
        acting = limit_loads.beside(model, load.gravity or model.scheme.now)
        same = place.beside.get(what, acting) == acting
        place.beside = {**place.beside, what: acting}
        if known and same and not lowerUpTo and known.get("note") != GIVEN_UP:
            return known
        if not same:  # what was held before was held beside other loads
            place.held = {k: v for k, v in place.held.items() if k != what}
        entry = self.entries[what] = {"load": what, "unit": load.unit}
        if load.pressed:
            entry["pressed_kN"] = load.pressed[1]
        self.endless.discard(what)
        if place.supportsMoved:
            entry["note"] = (
                "no limit analysis: supports have moved, and joints that are open would be taken as"
                " closed"
            )
            return entry
        count = len(model.interactions)
        if count > JOINTS and not lowerUpTo:
            entry["note"] = f"no limit analysis: {count} joints are more than {JOINTS}"
            say(f"note: {entry['note']}; scene.bound() and --preset bound take their time")
            return entry
        seconds = ASKED if lowerUpTo else IN_BACKGROUND if background else UNASKED
        work = lambda: self._found(load, lowerUpTo, seconds)
        if background:
            self.drop()  # of two mechanisms the last one is kept
            self._attempt(what, lambda: self._begin(what, work))
            return entry
        try:
            self._attempt(what, lambda: self._note(what, *work()))
        except Interrupted:
            del self.entries[what]
            if known:
                self.entries[what] = known
            raise
        return entry

    def _found(self, load, lowerUpTo, seconds):
        """Find a bound. Returns what its entry gets, lines to say, whether nothing gives way, and
        the :class:`limit.Bound`."""
        entry, lines = {}, []
        try:
            assembly = limit.read()
            assembly.deadline = time.monotonic() + seconds
            down = assembly.weights(load.gravity or self.model.scheme.now)
            forces = limit_loads.forces(self.model, assembly, load.pushed, load.pressed)
            if load.pressed:
                entry["normal_kN"] = limit_loads.carriedBy(assembly, down + forces)
            live = load.live(assembly)

            def found(find, first):
                at = lambda cos: find(cos * live, cos * down + forces)
                return _tilted(at, first) if load.tilts else at(1.0)

            bound = found(assembly.largest, 0.0)
            entry.update(bound.describe())
            lines.append(bound.sentence(load.name, load.unit))
            if not bound.exact and len(self.model.interactions) <= lowerUpTo:
                least = found(assembly.withoutDilatancy, math.atan(bound.factor))
                entry["without_dilatancy"] = least.factor
                entry["without_dilatancy_settled"] = least.settled
                lines.append(least.sentence(load.name, load.unit))
            return entry, lines, False, bound
        except Refused as refused:
            note, endless = str(refused), isinstance(refused, Endless)
        except (MemoryError, ImportError):  # a library cannot be loaded either
            note, endless = f"limit analysis: {FULL}", False
        return {**entry, "note": note}, [*lines, f"note: {note}"], endless, None

    def _attempt(self, what, act):
        """Do a part of the work for a bound; an unexpected error is the note of its entry."""
        with self.auxiliary(f"limit analysis of {what}") as attempt:
            act()
        if attempt.note:
            self._note(what, {"note": attempt.note}, [])

    def _note(self, what, found, lines, endless=False, bound=None):
        self.entries[what].update(found)
        for line in lines:
            # no notes: the entry has them, and when they are found depends on the machine
            say(line, noted=False)
        if endless:
            self.endless.add(what)
        if bound:
            self.last = bound, self.entries[what]

    # -- beside the run ----------------------------------------------------------------------------

    def _begin(self, what, work):
        self._task = Task(lambda: self._withFiles(what, work), parts=2)
        self._looksFor, self._since = what, time.monotonic()

    def _withFiles(self, what, work):
        """In a copy of the process: what was found without the mechanism, then the files of the
        mechanism by their names."""
        *found, bound = work()
        yield (*found, None)
        files, model = {}, self.model
        self._note(what, found[0], [], bound=bound)
        views = model.description.views
        try:
            with tempfile.TemporaryDirectory() as folder:
                try:
                    self.write(folder, model.description.title, model.parts, views)
                except Missing as missing:
                    say(f"{FIGURE} is left out: {missing}", sys.stderr)
                for name in os.listdir(folder):
                    with open(os.path.join(folder, name), "rb") as file:
                        files[name] = file.read()
        except OSError as error:
            say(f"the mechanism is left out: {error.strerror}", sys.stderr)
        yield files

    def take(self, wait, givesUp=lambda: False):
        """Take the bound that is found beside the run, if it is there; ``wait`` says whether to
        wait for it, and ``givesUp`` while it is waited for whether to do without it."""
        task, what = self._task, self._looksFor
        if not what or not (wait or task.ready()):
            return
        since, note = lambda: time.monotonic() - self._since, ""
        if not task.ready(0, SILENT) and since() < UNASKED:
            say("waiting for limit analysis")
        while not note and not task.ready(0, SILENT):
            note = LATE if since() > UNASKED else GIVEN_UP if givesUp() else ""
        if note:
            self._note(what, {"note": note}, [f"note: {note}"])
        else:
            self._attempt(what, lambda: self._note(what, *task.result()))
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

    def hold(self, what, factor):
        """Note a load factor under which the structure came to rest, by the name of its bound."""
        held = self.place.held
        if what in self.entries and factor > held.get(what, 0.0):
            self.place.held = {**held, what: factor}

    def write(self, directory, title, parts, views, draws=True):
        """Write the mechanism that was found last: two files for ParaView and, if it is to be
        drawn, mechanism.png."""
        if self._task:
            self._writeFound(directory, draws)
        elif self.last:
            bound, entry = self.last
            factor = f"{entry['factor']:.4g} {entry['unit']}".rstrip()
            heading = f"{title}\nlimit analysis, {entry['load']}: {factor}"
            try:
                bound.save(directory)
            except Missing as missing:
                say(f"the mechanism for ParaView is left out: {missing}", sys.stderr)
            if draws:
                bound.draw(os.path.join(directory, FIGURE), heading, parts, views)

    def _writeFound(self, directory, draws):
        """Write the files that were made beside the run; if they are not to be drawn, those that
        are there."""
        if not self._task.ready(1, SILENT * draws):
            if not draws:
                return self.drop()
            say("waiting for the mechanism")
        for name, data in self._task.result(1).items():
            if draws or name != FIGURE:
                with replaced(os.path.join(directory, name), "wb") as file:
                    file.write(data)


def _pushOf(target, direction):
    """The live load of a push of a target, or in a pattern: 1 kN along a direction."""
    along = np.array(direction)
    acting = [(body, at, 1e3 * share * along) for body, at, share in target.parts]
    return lambda assembly: limit_loads.sumOf(assembly, acting)


def _tilted(find, first):
    """The bound of a tilt, at which weights have turned as far as its factor says, while other
    loads have not: secants find it.

    :param find: function of the cosine of the tilt that gives the bound with weights of that share
    :param first: tilt with which the search begins [rad]
    :raises Endless: if there is no such tilt below :data:`STEEPEST`
    """
    bound = find(math.cos(first))
    angle = math.atan(bound.factor)
    last, off = first, angle - first
    for _ in range(TILTS):
        angle = min(max(angle, 0.0), STEEPEST)
        if abs(angle - last) < SAME_TILT:
            break
        bound = find(math.cos(angle))
        more = math.atan(bound.factor) - angle
        slope = (more - off) / (angle - last)
        last, off = angle, more
        angle = last - off / slope if slope < 0 else last + off
    if last == STEEPEST and off > 0:
        raise Endless("limit analysis: no tilt below 90 degrees moves the structure")
    return bound


def findBy(scene, kind, *load, **how):
    """Find a bound by a method of :class:`Bounds`, which Ctrl-C and SIGTERM end at once."""
    with scene.running.breakable():
        return getattr(scene.bounds, kind)(*load, **how)


def takeFound(scene, wait):
    """Take the bound that is found beside the run; a run that is interrupted does not wait long for
    it."""
    began, running = time.monotonic(), scene.running
    late = lambda: running.interrupted and time.monotonic() - began > SOON
    scene.bounds.take(wait, late)
    if not (running.interrupted or scene.args.lean):
        with contextlib.suppress(OSError):  # it is said when figures are drawn
            scene.outcome.drawing.start()


def findBound(scene, kind, *load):
    """Find the bound of a stage, which pushes or leans."""
    resumed = scene.running.redoes and scene.running.takesUp
    missing = any(e.get("note") == GIVEN_UP for e in scene.bounds.entries.values())
    if scene.args.lean and not scene.only or resumed and not missing:
        return  # in a stage that goes on it was found when that began
    with scene.running.auxiliary("limit analysis"):
        findBy(scene, kind, *load, lowerUpTo=SMALL * scene.only, background=not scene.only)


def nameInDomain(target, direction, normal):
    """Under which the bound of a push is found that is one of a domain."""
    return f"{nameOfPush(target, direction)} under {normal:g} kN"


def nameOfPush(target, direction):
    """Under which the bound of a push is found."""
    return f"{target.name} along {nameOf(direction)}"


def nameOfLean(towards, tilts=False):
    """Under which the bound of an acceleration or a tilt is found."""
    return f"{'tilt' if tilts else 'acceleration'} towards {nameOf(towards)}"


def nameOf(direction):
    """A direction as text."""
    for axis, value in zip("xyz", direction):
        if abs(value) > 1 - 1e-9:
            return ("-" if value < 0 else "") + axis
    return "(" + ", ".join(f"{v:.3g}" for v in direction) + ")"


# -- what a run says of its bounds -----------------------------------------------------------------


def inRunJson(entries, pushes=()):
    """Entries of run.json, from those of :class:`Bounds`.

    :param pushes: names of the pushes that its numbers are of: there, and back
    """
    if not entries:
        return {}
    found = {"bounds": list(entries.values())}
    known = {what: e for what, e in entries.items() if "factor" in e}
    signs = (1, "bound_base_shear_kN"), (-1, "negative_bound_base_shear_kN")
    for what, (sign, key) in zip(pushes, signs):
        if what in known:
            found[key] = sign * known[what]["factor"]
    leans = [e["factor"] for e in known.values() if e["unit"] in ("g", "")]
    if leans:
        found["bound_acceleration"] = leans[0]
    return found


def linesOfPush(entries, pushes):
    """Horizontal lines of curve.png, for a push. Parameters as in :func:`inRunJson`."""
    found = inRunJson(entries, pushes)
    for key in ("bound_base_shear_kN", "negative_bound_base_shear_kN"):
        if key in found:
            text = f"limit analysis: {abs(found[key]):.1f} kN at most"
            yield {"y": found[key], "text": text}


def linesOfGrowth(entry):
    """Horizontal lines of curve.png, for a load that grows, from the entry of its bound."""
    words = {"factor": "at most", "without_dilatancy": "without dilatancy"}
    for key, text in words.items():
        if key in entry:
            what = f"limit analysis: {entry[key]:.4g} {entry['unit']} {text}"
            yield {"y": entry[key], "text": " ".join(what.split())}


def over(entries, held, run):
    """Sentences about what is above its bound.

    :param held: load factors under which the structure came to rest, by the name of the load
    :param run: the entries of run.json
    """
    found = []
    for side in ("", "negative_"):
        pair = [run.get(f"{side}{of}_base_shear_kN") for of in ("peak", "bound")]
        if None not in pair:
            found.append((*map(abs, pair), "kN", "the largest force of the push"))
    for what, factor in held.items():
        entry = entries.get(what, {})
        if "factor" in entry:
            name = f"{what}: the load that was held"
            found.append((factor, entry["factor"], entry["unit"], name))
    for reached, bound, unit, what in found:
        if reached > (1 + TOLERANCE) * bound:
            yield (
                f"{what}, {reached:.4g} {unit}, is {100 * (reached / bound - 1):.1f} % above the"
                f" upper bound of limit analysis, {bound:.4g} {unit}: is the run too fast, or does"
                " the structure move far?"
            )
