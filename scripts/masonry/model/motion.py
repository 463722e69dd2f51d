# SPDX-License-Identifier: GPL-2.0-or-later
"""How the blocks of a structure move, and whether one of them falls."""

import math

from yade import O, Vector3

from ..units import GRAVITY
from ..errors import Collapsed

#: A block falls when it has moved by this share of its largest side and is as fast as :data:`FAST`.
FALLEN = 0.05
SWUNG = 1.0  # the same share where joints are soft, or a drive let a block go, so that it may swing
#: Velocity of a falling block over √(g·side); of a free fall after half a hundredth of its side.
FAST = 0.1
REST = 5e-3  # difference of loads and forces at supports over the loads, of a structure at rest


class Motion:
    """Displacements of all bricks since the last state at rest, and velocities."""

    def __init__(self, structure):
        self.ids, self.zones = structure.ids, structure.zones
        self.description = structure.description
        self._states = [O.bodies[body].state for body in self.ids]
        self._sizes = [self.description.size(index) for index in range(len(self.ids))]
        #: Velocities of falling blocks [m/s].
        self._falling = [FAST * math.sqrt(GRAVITY * size) for size in self._sizes]
        self.restart()

    def restart(self):
        """Count displacements from now on; a fall begins beyond :attr:`far` over the largest side
        of a block [-]."""
        self.far = FALLEN
        self._places = [Vector3(state.pos) for state in self._states]

    @property
    def places(self):
        """Where displacements begin: three numbers for every block, in one list [m]."""
        return [value for place in self._places for value in place]

    @places.setter
    def places(self, values):
        if len(values) != 3 * len(self._places):
            raise ValueError("has places of other blocks")
        self._places = [Vector3(*values[n : n + 3]) for n in range(0, len(values), 3)]

    def positions(self):
        """Where every block is: three numbers each, in one list [m]."""
        return [value for state in self._states for value in state.pos]

    def baseWeight(self, before, direction, moved):
        """The weight of the base of :func:`masonry.numbers.curves.quasiStatic` [-]; None if the
        blocks have not moved with the push.

        :param before: :meth:`positions` when the push began
        :param moved: displacement of the driven point along it since then [m]
        """
        along = squares = 0.0
        for n, state in enumerate(self._states):
            u = state.pos - Vector3(*before[3 * n : 3 * n + 3])
            along += state.mass * u.dot(direction)
            squares += state.mass * u.squaredNorm()
        if not along * moved > 0:
            return None
        weight = squares / (along * moved)
        return weight if 0 < weight <= 1 else None

    def _speeds(self):
        """Velocity of every block [m/s]; of deformable ones the mean of their nodes."""
        speeds = {i: state.vel.norm() for i, state in zip(self.ids, self._states)}
        if self.zones:
            velocities = self.zones.velocities
            for body in set(self.zones.bodies) & set(self.ids):
                first, end = self.zones.nodesOf(body)
                mean = sum(velocities[first:end], Vector3.Zero) / (end - first)
                speeds[body] = mean.norm()
        return [*speeds.values()]

    def fastest(self, far=0.0):
        """Largest ratio of velocity to that of a falling block, of the blocks that have moved by at
        least ``far`` times their size since the last rest [-]."""
        blocks = zip(self._speeds(), self._falling, self._moved(), self._sizes)
        return max(
            (v / falling for v, falling, moved, size in blocks if moved.norm() >= far * size),
            default=0.0,
        )

    def _moved(self):
        return [state.pos - place for state, place in zip(self._states, self._places)]

    def isFar(self):
        """Whether a block has moved by more than :attr:`far` times its size since the last rest."""
        return any(v.norm() > self.far * size for v, size in zip(self._moved(), self._sizes))

    def checkFall(self, far=None):
        """Raise Collapsed if a block is fast and has moved by more than ``far`` times its size
        since the last rest."""
        far, moved = self.far if far is None else far, self._moved()
        beyond = [n for n, v in enumerate(moved) if v.norm() > far * self._sizes[n]]
        speeds = beyond and self._speeds()
        for index in beyond:
            if speeds[index] >= self._falling[index]:
                at = ", ".join(f"{v:.3g}" for v in self.description.middle(index))
                x, y, z = 1e3 * moved[index]
                raise Collapsed(
                    f"brick {index} at ({at}) m has moved by ({x:.3g}, {y:.3g}, {z:.3g}) mm and"
                    f" falls at {1e3 * speeds[index]:.3g} mm/s"
                )
