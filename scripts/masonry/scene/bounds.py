# SPDX-License-Identifier: GPL-2.0-or-later
"""Bounds beside a run: limit analysis of what the stages of a scene load.

:class:`masonry.scene.scene.Scene` asks for them by itself when a stage pushes or leans the structure. :mod:`masonry.limit` says
what they are.
"""

import contextlib
import math
import os
import sys
import tempfile
import time

import numpy as np
from yade import O, Vector3

from .. import limit
from ..basics import GRAVITY, Interrupted, Refused, say
from ..limit.assembly import Endless
from ..limit.worker import worker
from ..memory import FULL
from ..packages import Missing
from ..folders import replaced
from ..run.beside import Failed, Job

#: Largest number of joints for which ``--preset bound`` and domains also look for a collapse without dilatancy, which takes many
#: solutions of the programme.
SMALL = 500
EVERY = math.inf  # the same limit where the user asks for that collapse: none
JOINTS = (
    3000  # largest number of joints of a run that is bounded unasked: within seconds
)
#: Time that limit analysis may take for a load, if nobody asked for it, if somebody did, and if it is done beside a run that
#: still takes steps [s]. A run that has come to its end, or to a checkpoint, waits until the first of them is over.
UNASKED, ASKED, BESIDE = 10.0, 600.0, 120.0
#: By how much a run may be above its bound [-]: joints of finite stiffness, displacements that are not small, and motion,
#: whose measured share is added.
TOLERANCE = 0.02
#: Of the search for a tilt at which both parts of gravity are those of the tilt: its rounds at most, the difference of two
#: tilts at which it ends, and the largest tilt [rad].
TILTS, SAME_TILT, STEEPEST = 20, 1e-6, math.radians(89.9)
FIGURE = "mechanism.png"
#: The note of a bound that was not found when the run was interrupted. One that goes on in the same stage looks for it again.
GIVEN_UP = (
    "limit analysis: the run was interrupted before its end; scene.bound() finds it"
)
#: The note of one that was not found when the run came to its end, or to a checkpoint.
LATE = "limit analysis: it was not solved in time; scene.bound() takes its time"
SILENT = 0.3  # so long something beside the run is waited for without a word [s]


class Bounds:
    """The bounds of a scene that is built in YADE.

    :param model: :class:`masonry.assembly.structure.Structure`
    :param place: :class:`masonry.run.place.Place`: what was found is kept there, and so in checkpoints
    """

    def __init__(self, model, place):
        self.model, self.place = model, place
        #: what was found last, in this process: limit.Bound and its entry
        self.last = None
        self._job = (
            None  # beside the run: finds a bound, then the files of its mechanism
        )
        self._looksFor = ""  # name of the load whose bound it has not found yet
        self._since = 0.0  # since when it looks [s]
        self.endless = set()  # names of loads under which nothing gives way

    def prepare(self):
        """Start the process of the solver, which is ready then when the first load needs it."""
        with contextlib.suppress(Refused):  # it is said when there is a load
            worker.start()

    @property
    def entries(self):
        """What was found, by the load: entries of run.json. A checkpoint keeps them."""
        return self.place.bounds

    def push(self, target, direction, both=False, lowerUpTo=0, beside=False):
        """Find the bound of a push [kN], without what acts beside it. Returns its entry of run.json, the last one if there are two.

        :param target: what is pushed
        :param direction: unit vector of the push
        :param both: whether it goes there and back
        :param lowerUpTo: up to so many joints a collapse without dilatancy is looked for, too, if the bound is not exact
        :param beside: whether it is found beside the run, and the entry gets its numbers by :meth:`take`
        """
        for sign in (1, -1) if both else (1,):
            what = nameOfPush(target, sign * direction)
            live = lambda a: self._pushed(a, target, sign * direction)
            entry = self._find(
                what, "kN", live, lowerUpTo, beside, pushed=(target, direction)
            )
        return entry

    def _pushed(self, assembly, target, direction):
        """The live load of a push: 1 kN along a direction."""
        load = next(
            x for x in self.model.loading.loads.values() if x and x.body == target.body
        )
        away = load.displacement() if not assembly.stood else np.zeros(3)
        point = np.array(target.point) + np.array(away)
        block = assembly.ids.index(target.body)
        return assembly.force(block, 1e3 * np.array(direction), point)

    def domain(self, target, normals, direction, lowerUpTo=0, beside=False):
        """Find the bounds of a push under several normal forces. Returns their entries of run.json.

        :param target: a platen with a press, whose vertical force is replaced
        :param normals: with which it presses on what is below, its weight included [kN]
        :param direction: unit vector of the push, horizontal
        :param lowerUpTo: and ``beside``: as of :meth:`push`
        """
        live = lambda a: self._pushed(a, target, direction)
        found = []
        for normal in normals:
            what = nameInDomain(target, direction, normal)
            found.append(
                self._find(
                    what,
                    "kN",
                    live,
                    lowerUpTo,
                    beside,
                    pushed=(target, direction),
                    pressed=(target, normal),
                )
            )
        return found

    def lean(self, towards, tilts=False, lowerUpTo=0, beside=False):
        """Find the bound of a horizontal acceleration [g]. Returns its entry of run.json.

        :param towards: unit vector
        :param tilts: whether gravity turns, and does not grow; the factor is then the horizontal over the vertical part
        :param lowerUpTo: and ``beside``: as of :meth:`push`
        """
        scaled = GRAVITY / self.model.args.density_scaling
        what = nameOfLean(towards, tilts)
        live = lambda a: a.weights(scaled * np.array(towards))
        down = (0, 0, -self.model.gravity)  # it replaces another acceleration
        if not tilts:
            return self._find(what, "g", live, lowerUpTo, beside, gravity=down)
        share = self.model.gravity / scaled
        turned = lambda a: share * live(a)
        return self._find(what, "", turned, lowerUpTo, beside, tilts=True, gravity=down)

    def forces(self, what, unit, loads, lowerUpTo=0, beside=False):
        """Find the bound of forces that grow together. Returns its entry of run.json.

        :param what: name of the load
        :param unit: of its factor
        :param loads: pairs of a MasonryLoad and its force at a factor of 1 [N]
        :param lowerUpTo: and ``beside``: as of :meth:`push`
        """

        def live(assembly):
            found = np.zeros_like(assembly.held, float)
            for load, force in loads:
                block = assembly.ids.index(load.body)
                found += assembly.force(block, np.array(force), _pointOf(load, assembly))  # fmt: skip
            return found

        return self._find(what, unit, live, lowerUpTo, beside)

    def _find(
        self,
        what,
        unit,
        load,
        lowerUpTo,
        beside,
        tilts=False,
        pushed=None,
        gravity=None,
        pressed=None,
    ):
        self.take(True)
        known, model = self.entries.get(what), self.model
        acting = self._acting(gravity or model.scheme.now)
        same = self.place.beside.get(what, acting) == acting
        self.place.beside = {**self.place.beside, what: acting}
        if known and same and not lowerUpTo and known.get("note") != GIVEN_UP:
            return known
        if not same:  # what was held before was held beside other loads
            self.place.held = {k: v for k, v in self.place.held.items() if k != what}
        entry = self.entries[what] = {"load": what, "unit": unit}
        if pressed:
            entry["pressed_kN"] = pressed[1]
        self.endless.discard(what)
        if self.place.supportsMoved:
            reason = (
                "supports have moved, and joints that are open would be taken as closed"
            )
            entry["note"] = f"no limit analysis: {reason}"
            return entry
        count = len(model.interactions)
        if count > JOINTS and not lowerUpTo:
            entry["note"] = f"no limit analysis: {count} joints are more than {JOINTS}"
            say(
                f"note: {entry['note']}; scene.bound() and --preset bound take their time"
            )
            return entry
        seconds = ASKED if lowerUpTo else BESIDE if beside else UNASKED
        work = lambda: self._found(what, unit, load, tilts, pushed, gravity, lowerUpTo, seconds, pressed)  # fmt: skip
        if beside:
            self.drop()  # of two mechanisms the last one is kept
            self._job = Job(lambda: self._withFiles(what, work), parts=2)
            self._looksFor, self._since = what, time.monotonic()
            return entry
        try:
            self._note(what, *work())
        except Interrupted:
            del self.entries[what]
            if known:
                self.entries[what] = known
            raise
        return entry

    def _found(self, what, unit, load, tilts, pushed, gravity, lowerUpTo, seconds, pressed=None):  # fmt: skip
        """Find a bound. Returns what its entry gets, lines to say, whether nothing gives way, and the :class:`limit.Bound`."""
        entry, lines = {}, []
        try:
            assembly = limit.read()
            assembly.deadline = time.monotonic() + seconds
            down = assembly.weights(gravity or self.model.scheme.now)
            forces = self._forces(assembly, pushed, pressed)
            if pressed:
                entry["normal_kN"] = _carriedBy(assembly, down + forces)
            live = load(assembly)

            def found(find, first):
                at = lambda cos: find(cos * live, cos * down + forces)
                return _tilted(at, first) if tilts else at(1.0)

            bound = found(assembly.largest, 0.0)
            entry.update(bound.describe())
            lines.append(bound.sentence(what, unit))
            if not bound.exact and len(self.model.interactions) <= lowerUpTo:
                least = found(assembly.withoutDilatancy, math.atan(bound.factor))
                entry["without_dilatancy"] = least.factor
                entry["without_dilatancy_settled"] = least.settled
                lines.append(least.sentence(what, unit))
            return entry, lines, False, bound
        except Refused as refused:
            note, endless = str(refused), isinstance(refused, Endless)
        except (MemoryError, ImportError):  # a library cannot be loaded either
            note, endless = f"limit analysis: {FULL}", False
        return {**entry, "note": note}, [*lines, f"note: {note}"], endless, None

    def _note(self, what, found, lines, endless, bound):
        """Keep what :meth:`_found` returned."""
        self.entries[what].update(found)
        for line in lines:
            # no notes: the entry has them, and when they are found depends on the machine
            say(line, noted=False)
        if endless:
            self.endless.add(what)
        if bound:
            self.last = bound, self.entries[what]

    # -- beside the run -------------------------------------------------------------------------------------------

    def _withFiles(self, what, work):
        """In a copy of the process: what was found without the mechanism, then the files of the mechanism by their names."""
        *found, bound = work()
        yield (*found, None)
        worker.end()
        files, model = {}, self.model
        self._note(what, found[0], [], False, bound)
        with tempfile.TemporaryDirectory() as folder:
            views = model.description.views
            try:
                self.write(folder, model.description.title, model.parts, views)
            except Missing as missing:
                say(f"{FIGURE} is left out: {missing}", sys.stderr)
            for name in os.listdir(folder):
                with open(os.path.join(folder, name), "rb") as file:
                    files[name] = file.read()
        yield files

    def take(self, wait, givesUp=lambda: False):
        """Take the bound that is found beside the run, if it is there.

        :param wait: whether to wait for it
        :param givesUp: function that says while it is waited for whether to do without it
        """
        job, what = self._job, self._looksFor
        if not what or not (wait or job.ready()):
            return
        if not job.ready(0, SILENT) and time.monotonic() - self._since < UNASKED:
            say("waiting for limit analysis")
        while not job.ready(0, SILENT):
            late = time.monotonic() - self._since > UNASKED
            if late or givesUp():
                note = LATE if late else GIVEN_UP
                self._note(what, {"note": note}, [f"note: {note}"], False, None)
                self.drop()
                return
        try:
            self._note(what, *job.result())
        except Failed as failed:
            note = f"limit analysis: {failed}"
            self._note(what, {"note": note}, [f"note: {note}"], False, None)
        self._looksFor = ""
        if "factor" in self.entries[what]:
            self.last = None
        else:
            self.drop()

    def drop(self):
        """Leave what is done beside the run."""
        job, self._job, self._looksFor = self._job, None, ""
        if job:
            job.end()

    def _acting(self, gravity):
        """What acts beside a load and what holds the structure now: data that can be compared."""
        loads = [[load.body, *force, load.driven] for load, force in self.model.loading.deadLoads()]  # fmt: skip
        held = [
            O.bodies[target.body].state.blockedDOFs
            for target in self.model.supports.held
        ]
        return [list(gravity), loads, held]

    def _forces(self, assembly, pushed, pressed=None):
        """Presses, dead loads and wind with their whole, and props at the points that drives hold.

        :param pushed: target and direction of a push, whose own drive is no prop, or None
        :param pressed: target and normal force [kN] that replaces its press, or None
        """
        loads = np.zeros_like(assembly.held, float)
        for load, force in self.model.loading.deadLoads():
            block, point = assembly.ids.index(load.body), _pointOf(load, assembly)
            if pressed and load.label == f"{pressed[0].name}_force":
                own = self.model.supports.weightOf(pressed[0])
                force = Vector3(force[0], force[1], own - 1e3 * pressed[1])
            if force.norm():
                loads += assembly.force(block, np.array(force), point)
            along = np.array(load.direction.normalized())
            own = pushed and pushed[0].body == load.body
            if load.driven and not (own and abs(along @ pushed[1]) > 1 - 1e-9):
                assembly.props.append((block, along, point))
        return loads

    # -- what is said ---------------------------------------------------------------------------------------------

    def describe(self, pushes=()):
        """Entries of run.json.

        :param pushes: names of the pushes that its numbers are of: there, and back
        """
        if not self.entries:
            return {}
        entries = {"bounds": list(self.entries.values())}
        known = {what: e for what, e in self.entries.items() if "factor" in e}
        signs = (1, "bound_base_shear_kN"), (-1, "negative_bound_base_shear_kN")
        for what, (sign, key) in zip(pushes, signs):
            if what in known:
                entries[key] = sign * known[what]["factor"]
        leans = [e["factor"] for e in known.values() if e["unit"] in ("g", "")]
        if leans:
            entries["bound_acceleration"] = leans[0]
        return entries

    def lines(self, pushes):
        """Horizontal lines of curve.png, for a push. Parameters as of :meth:`describe`."""
        entries = self.describe(pushes)
        for key in ("bound_base_shear_kN", "negative_bound_base_shear_kN"):
            if key in entries:
                yield {
                    "y": entries[key],
                    "text": f"limit analysis: {abs(entries[key]):.1f} kN at most",
                }

    def linesOf(self, name):
        """Horizontal lines of curve.png, for a load that grows, by the name of its bound."""
        entry = self.entries.get(name, {})
        for key, text in (
            ("factor", "at most"),
            ("without_dilatancy", "without dilatancy"),
        ):
            if key in entry:
                what = f"limit analysis: {entry[key]:.4g} {entry['unit']} {text}"
                yield {"y": entry[key], "text": " ".join(what.split())}

    def over(self, run):
        """Sentences about what is above its bound.

        :param run: the entries of run.json
        """
        allowed = 1 + TOLERANCE
        pairs = [
            (abs(run[reached]), abs(run[bound]), "kN", "the largest force of the push")
            for reached, bound in (
                ("peak_base_shear_kN", "bound_base_shear_kN"),
                ("negative_peak_base_shear_kN", "negative_bound_base_shear_kN"),
            )
            if reached in run and bound in run
        ]
        held = self.place.held
        pairs += [
            (factor, self.entries[what]["factor"], self.entries[what]["unit"], f"{what}: the load that was held")
            for what, factor in held.items()
            if "factor" in self.entries.get(what, {})
        ]  # fmt: skip
        for reached, bound, unit, what in pairs:
            most = allowed + (run.get("dynamic_imbalance", 0.0) if unit == "kN" else 0)
            if reached > most * bound:
                yield (
                    f"{what}, {reached:.4g} {unit}, is more than {100 * (most - 1):.1f} % above the upper bound "
                    f"of limit analysis, {bound:.4g} {unit}: is the run too fast, or does the structure move far?"
                )

    def hold(self, what, factor):
        """Note a load factor under which the structure came to rest, by the name of its bound."""
        held = self.place.held
        if what in self.entries and factor > held.get(what, 0.0):
            self.place.held = {**held, what: factor}

    def write(self, directory, title, parts, views, draws=True):
        """Write the mechanism that was found last: two files for ParaView and, if it is to be drawn, mechanism.png."""
        if self._job:
            self._writeFound(directory, draws)
        elif self.last:
            bound, entry = self.last
            heading = f"{title}\nlimit analysis, {entry['load']}: {entry['factor']:.4g} {entry['unit']}".rstrip()
            try:
                bound.save(directory)
            except Missing as missing:
                say(f"the mechanism for ParaView is left out: {missing}", sys.stderr)
            if draws:
                bound.draw(os.path.join(directory, FIGURE), heading, parts, views)

    def _writeFound(self, directory, draws):
        """Write the files that were made beside the run; if they are not to be drawn, those that are there."""
        if not draws and not self._job.ready(1):
            self.drop()
            return
        if not self._job.ready(1, SILENT):
            say("waiting for the mechanism")
        try:
            files = self._job.result(1)
        except Failed as failed:
            say(f"the mechanism is left out: {failed}", sys.stderr)
            return
        for name, data in files.items():
            if draws or name != FIGURE:
                with replaced(os.path.join(directory, name), "wb") as file:
                    file.write(data)


def _tilted(find, first):
    """The bound of a tilt, at which weights have turned as far as its factor says, while other loads have not: secants find it.

    :param find: function of the cosine of the tilt that gives the bound with weights of that share
    :param first: tilt with which the search begins [rad]
    :raises Endless: if there is no such tilt below :data:`STEEPEST`
    """
    bound = find(math.cos(first))
    last, off = first, math.atan(bound.factor) - first
    angle = math.atan(bound.factor)
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


def _pointOf(load, assembly):
    """Where a MasonryLoad acts, on blocks as the assembly has them [m]."""
    return load.point if assembly.stood else load.point + load.displacement()


def _carriedBy(assembly, dead):
    """Vertical force of dead loads on all blocks that are free to move down, compression is positive [kN]: the supports carry
    it."""
    return -1e-3 * float(dead[~assembly.held[:, 2], 2].sum())


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
