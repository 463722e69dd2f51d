# SPDX-License-Identifier: GPL-2.0-or-later
"""The linear programme of limit analysis, and its solution."""

import math

import numpy as np

from . import solver
from .solver import SolverTimeout, Unsolved

FACETS = 8  # of a friction cone
ENTRIES_PER_COPY = 12  # of the load that a copy of the factor multiplies
MAX_RESIDUAL = 1e-6  # of equilibrium and strength, relative to the largest force [-]


class Programme:
    """The linear programme: columns are force variables, rows are equilibrium and strength. Forces
    and lengths are in units of typical ones."""

    def __init__(self, assembly, rows, size, force):
        self.assembly, self.rows, self.size, self.force = assembly, rows, size, force
        self.columns, self.low, self.high = 0, [], []
        self._equal, self._unequal = [], []
        #: forces on contacts: which, columns, share that is normal, direction along the joint
        self._parts = []
        self.limits = np.zeros(0)

    def factor(self, load, most):
        """The factor on a load. A variable that acts on many blocks would couple them all in the
        solver, so there is one copy for every :data:`ENTRIES_PER_COPY` entries of the load, and
        each copy equals the one before.

        :param load: entries of equilibrium, in units
        :param most: largest value; None: none
        """
        rows = np.flatnonzero(load)
        copies = np.arange(len(rows)) // ENTRIES_PER_COPY
        columns = self._new(copies[-1] + 1, -np.inf, np.inf if most is None else most)
        self._equal.append((rows, columns[copies], load[rows]))
        links = int(self.rows.max()) + 1 + np.arange(copies[-1])
        ones = np.ones(len(links))
        self._equal += [(links, columns[:-1], ones), (links, columns[1:], -ones)]
        self._links, self._last = len(links), columns[-1]

    def _new(self, count, low=-np.inf, high=np.inf):
        first = self.columns
        self.columns += count
        self.low = np.append(self.low, np.broadcast_to(low, count))
        self.high = np.append(self.high, np.broadcast_to(high, count))
        return first + np.arange(count)

    def _forces(self, joint, at, direction, columns, turns=False):
        """Let variables act as forces in a direction, or as moments about it, on both blocks of a
        joint."""
        for side, sign in ((0, -1), (1, 1)):
            block = self.assembly.pairs[joint, side]
            moment = np.cross((at - self.assembly.centres[block]) / self.size, direction)
            six = np.hstack([0 * direction, direction] if turns else [direction, moment])
            rows = self.rows[block]
            kept = (rows >= 0) & (six != 0)
            which = np.broadcast_to(columns[:, None], rows.shape)
            self._equal.append((rows[kept], which[kept], sign * six[kept]))

    def joints(self, turn, fixed):
        """All joints, props, ties and springs. Parameters as in :meth:`Assembly._solve`."""
        a, c = self.assembly, self.assembly.contacts
        self._rigid()
        props = [([(b, a.force(b, *prop)[b])], -np.inf, np.inf) for b, *prop in a.props]
        for loads, least, most in [*props, *a.links]:
            column = self._new(1, least / self.force, most / self.force)
            for block, load in loads:
                load = np.concatenate([load[:3], load[3:] / self.size])
                kept = (self.rows[block] >= 0) & (load != 0)
                rows = self.rows[block][kept]
                self._equal.append((rows, np.repeat(column, len(rows)), load[kept]))
        dry = a.dry[c.joint] & (fixed is None) & (not a.plane)
        self._dry(np.flatnonzero(dry), turn)
        if not dry.all():
            self._strong(np.flatnonzero(~dry), turn, fixed)

    def _rigid(self):
        """Joints that never give way: any force and moment."""
        a = self.assembly
        which = np.flatnonzero(a.elastic)
        areas = np.bincount(a.joint, a.areas, len(a.pairs))
        moments = [np.bincount(a.joint, a.areas * x, len(a.pairs)) for x in a.points.T]
        middle = np.column_stack(moments)[which] / areas[which][:, None]
        free = ([0, 2], [1]) if a.plane else ([0, 1, 2], [0, 1, 2])  # along and about which axes
        for turns, axes in enumerate(free):
            for axis in np.eye(3)[axes]:
                along = np.tile(axis, (len(which), 1))
                self._forces(which, middle, along, self._new(len(which)), turns)

    def _dry(self, which, turn):
        """Contacts of dry joints in space: forces within the friction cone, as sums of its
        edges."""
        a, c = self.assembly, self.assembly.contacts
        joint, at = c.joint[which], c.at[which]
        one, two = a.tangents[joint].swapaxes(0, 1)
        for side in _polygon(turn[which], one, two):
            columns = self._new(len(which), 0)
            along = a.friction[joint][:, None] * side
            self._forces(joint, at, a.normals[joint] + along, columns)
            self._parts.append((which, columns, 1, along))

    def _strong(self, which, turn, fixed):
        """Contacts of the other joints: a normal force within bounds, and forces along the joint
        below the strength."""
        a, c = self.assembly, self.assembly.contacts
        joint, at, area = c.joint[which], c.at[which], c.area[which] / self.force
        one, two = a.tangents[joint].swapaxes(0, 1)
        columns = self._new(len(which), -a.tension[joint] * area, a.crushing[joint] * area)
        self._parts.append((which, columns, 1, 0))
        self._forces(joint, at, a.normals[joint], columns)
        # in the plane all points of a joint share a shear strength
        shared = joint if a.plane else which
        groups, first, group = np.unique(shared, return_index=True, return_inverse=True)
        strength = np.bincount(group, a.cohesion[joint] * area)
        slope = a.friction[joint[first]]
        if fixed is not None:
            pressed, share = fixed
            pressed = np.maximum(pressed[groups] / self.force, 0)
            strength, slope = strength + (1 - share) * slope * pressed, share * slope
        # the force along the joint is made of forces to corners of a polygon, with a sum below the
        # strength
        limits = len(self.limits) + np.arange(len(first))
        self.limits = np.append(self.limits, strength)
        self._unequal.append((limits[group], columns, -slope[group]))
        directions = [one[first], -one[first]] if a.plane else _polygon(turn[which], one, two)
        for direction in directions:
            along = self._new(len(first), 0)
            self._forces(joint[first], at[first], direction, along)
            self._unequal.append((limits, along, np.ones(len(first))))
            self._parts.append((which[first], along, 0, direction))

    def solve(self, still, seconds):
        """The largest factor, the values of all variables, and the multipliers of equilibrium.

        :param still: what stays, entries of equilibrium
        :raises Unsolved:
        """
        from scipy.sparse import csc_matrix

        if seconds <= 0:
            raise SolverTimeout
        loads = np.append(-still, np.zeros(self._links))
        count, sides = len(loads), np.append(loads, self.limits)
        entries = self._equal + [(count + r, *others) for r, *others in self._unequal]
        rows, columns, parts = (np.concatenate(x) for x in zip(*entries))
        if not (np.isfinite(parts).all() and np.isfinite(loads).all()):
            raise Unsolved("the programme has numbers that are not finite")
        whole = csc_matrix((parts, (rows, columns)), (len(sides), self.columns))
        cost = np.zeros(self.columns)
        cost[self._last] = -1
        least = np.append(loads, np.full(len(self.limits), -np.inf))
        limits = self.low, self.high, cost, least, sides
        values, dual = solver.solve(whole, limits, seconds)
        over = whole @ values - sides
        off, over = np.abs(over[:count]).max(), over[count:].max(initial=0)
        if max(off, over) > MAX_RESIDUAL * max(1, np.abs(values).max()):
            raise Unsolved(
                f"its solution misses equilibrium by {off:.1g} and strength by {over:.1g} of a"
                " block's usual load"
            )
        return values[self._last], values, dual[: len(still)]

    def read(self, values):
        """Normal force, positive in compression, (one a contact) and force along the joint
        (contact, 3) [N]."""
        count = len(self.assembly.contacts.at)
        normal, along = np.zeros(count), np.zeros((count, 3))
        for which, columns, share, direction in self._parts:
            force = self.force * values[columns]
            normal[which] += share * force
            along[which] += force[:, None] * direction
        return normal, along


def _polygon(turn, one, two):
    """Corners of a polygon around the unit circle between two directions (k, 3): a list of
    :data:`FACETS` arrays (k, 3).

    :param turn: angle of the first corner from ``one`` (k) [rad]
    """
    radius = 1 / math.cos(math.pi / FACETS)
    angles = turn + 2 * math.pi / FACETS * np.arange(FACETS)[:, None]
    cos, sin = np.cos(angles)[..., None], np.sin(angles)[..., None]
    return [radius * (x * one + y * two) for x, y in zip(cos, sin)]
