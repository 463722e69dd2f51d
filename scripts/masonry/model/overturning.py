# SPDX-License-Identifier: GPL-2.0-or-later
"""How near what stands is to overturning."""

import numpy as np
from yade import O

#: Share of the way to overturning from which on an end is near the edge of a fall [-]. The scene
#: pulsed_wall of the gallery ends at 0.73.
NEAR = 2 / 3
CLOSE = 1e-6  # difference of levels that are the same, over the height [-]


class Overturning:
    """What stands above the beds of a structure, against the edges of these beds.

    A bed is a level at which blocks of a part begin, or the lower side of a stone that carries
    none. What of the part is above, or this stone, overturns in a direction when its centroid has
    passed the edge of the blocks that begin there, or of those that end there. What has fallen is
    left out, and so is a bed beyond whose edge the centroid was as built.
    """

    def __init__(self, structure):
        self._structure = structure
        blocks, bodies = structure.description.bricks, map(O.bodies.__getitem__, structure.ids)
        self._states = [body.state for body in bodies]
        built = [np.array(block.corners) for block in blocks]
        self._arms = [c - np.array(s.refPos) for c, s in zip(built, self._states)]
        low, high = (np.array([f(c[:, 2]) for c in built]) for f in (min, max))
        near = CLOSE * (high.max() - low.min())
        angles = np.linspace(0, np.pi, 2 if structure.description.plane else 37)
        angles = np.append(angles, -angles[1:-1])
        self._towards = np.array([np.cos(angles), np.sin(angles)])
        self._beds = []  # of each: what is above, and which corners lie in it from above and below

        def add(level, above, below):
            edges = above & (abs(low - level) < near), below & (abs(high - level) < near)
            corners = [
                [(n, abs(built[n][:, 2] - level) < 2 * near) for n in np.flatnonzero(edge)]
                for edge in edges
            ]
            self._beds.append([np.flatnonzero(above), [c for c in corners if c]])

        everywhere = np.full(len(blocks), True)
        for part in {block.part for block in blocks}:
            own = np.array([block.part == part for block in blocks])
            for level in {round(z / near): z for z in low[own]}.values():
                add(level, own & (low > level - near), everywhere)
        boxes = [[f(c[:, i]) for c in built] for f in (np.min, np.max) for i in (0, 1)]
        left, front, right, back = map(np.array, boxes)
        for n in range(len(blocks)):  # stones that carry none
            beside = (left < right[n] - near) & (right > left[n] + near)
            beside &= (front < back[n] - near) & (back > front[n] + near)
            if not (beside & (abs(low - high[n]) < near)).any():
                add(low[n], np.arange(len(blocks)) == n, beside)
        self._built = [self._distances(built, *bed) for bed in self._beds]

    def _distances(self, places, above, edges, fallen=()):
        """How far the edges of a bed are from the centroid of what is above, along each direction
        [m], by the corners of all blocks; None if nothing is."""
        above = [n for n in above if n not in fallen]
        if not above:
            return None
        masses = np.array([self._states[n].mass for n in above])
        middle = masses @ np.array([self._states[n].pos for n in above]) / masses.sum()
        found = []
        for corners in edges:
            points = np.vstack([places[n][which] for n, which in corners])
            found.append(((points - middle)[:, :2] @ self._towards).max(axis=0))
        return np.min(found, axis=0)

    def _places(self):
        """Where the corners of all blocks are [m]."""
        for arms, state in zip(self._arms, self._states):
            turn = np.array((state.ori * state.refOri.conjugate()).toRotationMatrix())
            yield arms @ turn.T + np.array(state.pos)

    def share(self):
        """The largest share of the way to overturning that anything has gone since the scene was
        built [-]: 0 as built, or while no joint has become a contact, 1 on the verge."""
        if not self._structure.contacts.handed:
            return 0.0
        fallen, places, most = self._structure.fallen(), [*self._places()], 0.0
        for bed, built in zip(self._beds, self._built):
            now = self._distances(places, *bed, fallen)
            if now is not None and (built > 0).all():
                most = max(most, float((1 - now / built).max()))
        return most
