# SPDX-License-Identifier: GPL-2.0-or-later
"""Bounds beside a run: limit analysis of what the stages of a scene load.

:class:`masonry.scene.scene.Scene` asks for them by itself when a stage pushes or leans the structure. :mod:`masonry.limit` says
what they are.
"""

import math
import os
import time

import numpy as np

from .. import limit
from ..basics import GRAVITY, Refused, say

#: Up to so many joints a collapse without dilatancy, which takes many rounds, is looked for with --preset bound.
SMALL = 500
EVERY = math.inf  # it is looked for however many joints there are
JOINTS = 3000  # up to so many joints every run has its bounds; limit analysis of more takes longer than seconds
#: Time that limit analysis may take for a load, if nobody asked for it, and if somebody did [s]
UNASKED, ASKED = 10.0, 600.0
#: By how much a run may be above its bound [-]: joints of finite stiffness, displacements that are not small, and motion,
#: whose measured share is added.
TOLERANCE = 0.02
FIGURE = "mechanism.png"


class Bounds:
    """The bounds of a scene that is built in YADE.

    :param model: :class:`masonry.assembly.structure.Structure`
    :param place: :class:`masonry.run.place.Place`: what was found is kept there, and so in checkpoints
    """

    def __init__(self, model, place):
        self.model, self.place = model, place
        self.last = None  # what was found last: limit.Bound and its entry

    @property
    def entries(self):
        """What was found, by the load: entries of run.json. A checkpoint keeps them."""
        return self.place.bounds

    def push(self, direction, both, lowerUpTo=0):
        """Find the bound of a push of what the model pushes now. Returns its entry of run.json, the last one if there are two.

        :param direction: unit vector of the push
        :param both: whether it goes there and back
        :param lowerUpTo: up to so many joints a collapse without dilatancy is looked for, too, if the bound is not exact
        """
        target = self.model.target
        for sign in (1, -1) if both else (1,):
            what = f"{target.name} along {nameOf(sign * direction)}"
            live = lambda a, dead: self._pushed(a, dead, sign * direction)
            entry = self._find(what, "kN", live, lowerUpTo)
        return entry

    def _pushed(self, assembly, dead, direction):
        """Live load, and what is added to its factor to give the base shear [kN]."""
        load = self.model.loads["push"]
        block = assembly.ids.index(load.body)
        point = _pointOf(load, assembly)
        free = ~assembly.held[:, :3]
        return (
            assembly.force(block, 1e3 * direction, point),
            1e-3 * (np.where(free, dead[:, :3], 0) @ np.array(direction)).sum(),
        )

    def lean(self, towards, tilts=False, lowerUpTo=0):
        """Find the bound of a horizontal acceleration [g]. Returns its entry of run.json.

        :param towards: unit vector
        :param tilts: whether gravity turns, and does not grow; the factor is then the horizontal over the vertical part
        :param lowerUpTo: as of :meth:`push`
        """
        scaled = GRAVITY / self.model.args.density_scaling
        what = f"{'tilt' if tilts else 'acceleration'} towards {nameOf(towards)}"
        live = lambda a, dead: (a.weights(scaled * np.array(towards)), 0.0)
        if not tilts:
            return self._find(what, "g", live, lowerUpTo)
        share = self.model.gravity / scaled
        turned = lambda a, dead: (share * live(a, dead)[0], 0.0)
        return self._find(what, "", turned, lowerUpTo, tilts=True)

    def _find(self, what, unit, load, lowerUpTo, tilts=False):
        known = self.entries.get(what)
        if known and not lowerUpTo:
            return known
        model = self.model
        entry = self.entries[what] = {"load": what, "unit": unit}
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
        try:
            assembly = limit.read()
            seconds = ASKED if lowerUpTo else UNASKED
            assembly.deadline = time.monotonic() + seconds
            down = assembly.weights(model.now)
            forces = self._forces(assembly)
            live, beside = load(assembly, down + forces)
            bound = assembly.largest(live, down + forces)
            for _ in range(5 if tilts else 0):  # both parts of gravity shrink
                cos = 1 / np.hypot(1, bound.factor)
                bound = assembly.largest(cos * live, cos * down + forces)
            entry.update(bound.describe())
            entry["factor"] += beside
            say(bound.sentence(what, unit))
            if not bound.exact and count <= lowerUpTo:
                least = assembly.withoutDilatancy(live, down + forces)
                entry["without_dilatancy"] = least.factor + beside
                entry["without_dilatancy_settled"] = least.settled
                say(least.sentence(what, unit))
            self.last = bound, entry
        except Refused as refused:
            entry["note"] = str(refused)
            say(f"note: {refused}")
        return entry

    def _forces(self, assembly):
        """Presses, dead loads and wind with their whole, and props at the points that other drives hold."""
        loads = np.zeros_like(assembly.held, float)
        for load, force in self.model.deadLoads():
            block, point = assembly.ids.index(load.body), _pointOf(load, assembly)
            if force.norm():
                loads += assembly.force(block, np.array(force), point)
            if load.driven and load is not self.model.loads["push"]:
                prop = block, np.array(load.direction.normalized()), point
                assembly.props.append(prop)
        return loads

    # -- what is said ---------------------------------------------------------------------------------------------

    def describe(self):
        """Entries of run.json."""
        if not self.entries:
            return {}
        entries = {"bounds": list(self.entries.values())}
        known = [e for e in self.entries.values() if "factor" in e]
        pushes = [e["factor"] for e in known if e["unit"] == "kN"]
        leans = [e["factor"] for e in known if e["unit"] != "kN"]
        if pushes:
            entries["bound_base_shear_kN"] = pushes[0]
        if pushes[1:]:
            entries["negative_bound_base_shear_kN"] = -pushes[1]
        if leans:
            entries["bound_acceleration"] = leans[0]
        return entries

    def lines(self):
        """Horizontal lines of curve.png, for a push."""
        entries = self.describe()
        for key in ("bound_base_shear_kN", "negative_bound_base_shear_kN"):
            if key in entries:
                yield {
                    "y": entries[key],
                    "text": f"limit analysis: {abs(entries[key]):.1f} kN at most",
                }

    def over(self, run, factor=0.0):
        """Sentences about what is above its bound.

        :param run: the entries of run.json
        :param factor: of a structure that stood under a horizontal acceleration [-]
        """
        allowed = 1 + TOLERANCE + run.get("dynamic_imbalance", 0.0)
        entries = self.describe()
        pairs = [
            (abs(run[reached]), abs(entries[bound]), "kN", "the largest base shear")
            for reached, bound in (
                ("peak_base_shear_kN", "bound_base_shear_kN"),
                ("negative_peak_base_shear_kN", "negative_bound_base_shear_kN"),
            )
            if reached in run and bound in entries
        ]
        if "bound_acceleration" in entries:
            pairs.append(
                (
                    factor,
                    entries["bound_acceleration"],
                    "of gravity",
                    "the acceleration",
                )
            )
        for reached, bound, unit, what in pairs:
            if reached > allowed * bound:
                yield (
                    f"warning: {what}, {reached:.4g} {unit}, is more than {100 * (allowed - 1):.1f} % above the upper bound "
                    f"of limit analysis, {bound:.4g} {unit}: is the run too fast, or does the structure move far?"
                )

    def write(self, directory, title, parts, views):
        """Write the mechanism that was found last: mechanism.png, and two files for ParaView."""
        if self.last:
            bound, entry = self.last
            heading = f"{title}\nlimit analysis, {entry['load']}: {entry['factor']:.4g} {entry['unit']}".rstrip()
            bound.save(directory)
            bound.draw(os.path.join(directory, FIGURE), heading, parts, views)


def _pointOf(load, assembly):
    """Where a MasonryLoad acts, on blocks as the assembly has them [m]."""
    return load.point if assembly.stood else load.point + load.displacement()


def nameOf(direction):
    """A direction as text."""
    for axis, value in zip("xyz", direction):
        if abs(value) > 1 - 1e-9:
            return ("-" if value < 0 else "") + axis
    return "(" + ", ".join(f"{v:.3g}" for v in direction) + ")"
