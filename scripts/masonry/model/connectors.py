# SPDX-License-Identifier: GPL-2.0-or-later
"""Engines, forces and news of connectors, as ties and springs."""

from yade import O, Vector3

from .bodies import placeOf


class Connectors:
    """Connectors of blocks. A kind of connector is a class of records, as those in
    :mod:`masonry.scene.ties`, and has one engine.

    - ``engines``: by class of records, in the order of the scene
    """

    def __init__(self, structure):
        self.description, self.ids = structure.description, structure.ids
        self.axes = structure.axes
        self.reported = set()  # events that were news
        self.saidUntil = 0  # step from which events are news
        self.engines = {}
        for kind in dict.fromkeys(map(type, self.description.connectors)):
            records, ends = self.description.connectorsOf(kind), {}
            for side in (0, 1):
                those = [one.ends[side] for one in records]
                ends[f"bodies{side + 1}"] = [end.bodyIn(self.ids) for end in those]
                ends[f"points{side + 1}"] = [end.point for end in those]
            self.engines[kind] = kind.engineOf(records, **ends)
            for number, one in enumerate(records):
                one.engine, one.number = self.engines[kind], number

    def attach(self):
        """Find the bodies of second ends, of which some are placed last."""
        for kind, made in self.engines.items():
            records = self.description.connectorsOf(kind)
            made.bodies2 = [one.ends[1].bodyIn(self.ids) for one in records]

    def grow(self, share):
        for kind, made in self.engines.items():
            kind.grow(self.description.connectorsOf(kind), made, share)

    def onGround(self):
        """Force of ties and springs on the ground, along the axes of the scene [N]."""
        force = self._onGround(lambda one: True)
        return Vector3(*(force[i] if i in self.axes else 0.0 for i in range(3)))

    def onSpringsOf(self, target):
        """Force of a target on the springs on which it stands [N]."""
        stands = lambda one: one.isSupport and one.ends[0].target is target
        return self._onGround(stands)

    def _onGround(self, counts):
        force = Vector3.Zero
        for one in self.description.connectors:
            if one.ends[1].isGround and counts(one):
                force -= one.on(one.ends[0], self)[0]
        return force

    def placeOf(self, end):
        """Where the end of a tie or a spring is now [m]."""
        if end.isGround:
            return Vector3(*end.point)
        return placeOf(end.bodyIn(self.ids), end.point)

    def news(self):
        """Sentences on connectors that have yielded or broken since the last call."""
        since, self.saidUntil = min(self.saidUntil, O.iter), O.iter
        for kind, made in self.engines.items():
            for one, what in kind.events(self.description.connectorsOf(kind), made, since):
                # fibres are named by their layer, once
                subject = one.overlay or one.name
                if (what, subject) not in self.reported:
                    self.reported.add((what, subject))
                    yield f"{subject} {what}: between {one.ends[0].words} and {one.ends[1].words}"
