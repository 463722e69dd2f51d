# SPDX-License-Identifier: GPL-2.0-or-later
"""The linear programme of limit analysis, and its solution."""

import math

import numpy as np

from . import solver
from .solver import Late, Unsolved

FACETS = 8  # of a friction cone
SHARE = 12  # entries of the load by which a copy of the factor is multiplied
KEPT = 1e-6  # how well equilibrium and strength must be kept, relative to the largest force


class Programme:
    """The linear programme: columns are force variables, rows are equilibrium and strength. Forces are in units of a
    typical one, lengths of a typical one."""

    def __init__(self, assembly, rows, size, force):
        self.assembly, self.rows, self.size, self.force = assembly, rows, size, force
        self.columns, self.low, self.high = 0, [], []
        self._equal, self._unequal = [], []
        self.limits = np.zeros(0)

    def factor(self, load, most):
        """The factor on a load. Returns its number.

        A variable that acts on many blocks would couple them all in the solver. So it has one copy for every :data:`SHARE`
        entries of the load, and each copy equals the one before.

        :param load: entries of equilibrium, in units
        :param most: largest value; None: none
        """
        rows = np.flatnonzero(load)
        copies = np.arange(len(rows)) // SHARE
        columns = self._new(copies[-1] + 1, -np.inf, np.inf if most is None else most)
        self._equal.append((rows, columns[copies], load[rows]))
        links = int(self.rows.max()) + 1 + np.arange(copies[-1])
        for column, sign in ((columns[:-1], 1.0), (columns[1:], -1.0)):
            self._equal.append((links, column, np.full(len(links), sign)))
        self.links = len(links)
        return columns[-1]

    def _new(self, count, low, high):
        first = self.columns
        self.columns += count
        self.low = np.append(self.low, np.broadcast_to(low, count))
        self.high = np.append(self.high, np.broadcast_to(high, count))
        return first + np.arange(count)

    def _forces(self, joint, at, direction, columns, moment=None):
        """Let variables act as forces in a direction, or as moments, on both blocks of a joint."""
        centres, pairs = self.assembly.centres, self.assembly.pairs
        for side, sign in ((0, -1), (1, 1)):
            block = pairs[joint, side]
            if moment is None:
                arm = (at - centres[block]) / self.size
                six = np.hstack([direction, np.cross(arm, direction)])
            else:
                six = np.hstack([np.zeros_like(moment), moment])
            rows = self.rows[block]
            kept = (rows >= 0) & (six != 0)
            which = np.broadcast_to(columns[:, None], rows.shape)
            self._equal.append((rows[kept], which[kept], sign * six[kept]))

    def joints(self, turn, fixed):
        """All joints, props, ties and springs. Parameters as in :meth:`Assembly._solve`."""
        a = self.assembly
        self._rigid()
        props = [([(b, a.force(b, *prop)[b])], -np.inf, np.inf) for b, *prop in a.props]
        for loads, least, most in [*props, *a.links]:
            column = self._new(1, least / self.force, most / self.force)
            for block, load in loads:
                load = np.concatenate([load[:3], load[3:] / self.size])
                kept = (self.rows[block] >= 0) & (load != 0)
                rows = self.rows[block][kept]
                self._equal.append((rows, np.repeat(column, len(rows)), load[kept]))
        c = a.contacts
        dry = a.dry[c.joint] & (fixed is None) & (not a.plane)
        self._dry(np.flatnonzero(dry), turn)
        self._strong(np.flatnonzero(~dry), turn, fixed)

    def _rigid(self):
        """Joints that never give way: any force and moment."""
        a = self.assembly
        which = np.flatnonzero(a.elastic)
        if not len(which):
            return
        areas = np.bincount(a.joint, a.areas, len(a.pairs))
        moments = [np.bincount(a.joint, a.areas * x, len(a.pairs)) for x in a.points.T]
        middle = np.column_stack(moments)[which] / areas[which][:, None]
        forces, turns = (np.eye(3)[[0, 2]], np.eye(3)[[1]]) if a.plane else (np.eye(3),) * 2  # fmt: skip
        tiled = lambda axis: np.tile(axis, (len(which), 1))
        for axis in forces:
            columns = self._new(len(which), -np.inf, np.inf)
            self._forces(which, middle, tiled(axis), columns)
        for axis in turns:
            columns = self._new(len(which), -np.inf, np.inf)
            self._forces(which, middle, None, columns, tiled(axis))

    def _dry(self, which, turn):
        """Contacts of dry joints in space: forces within the friction cone, as sums of its edges."""
        a, c = self.assembly, self.assembly.contacts
        self._edges = []
        joint, at = c.joint[which], c.at[which]
        normal, (one, two) = a.normals[joint], a.tangents[joint].swapaxes(0, 1)
        friction = a.friction[joint][:, None]
        sides = _polygon(turn[which], one, two)
        for side in sides:
            columns = self._new(len(which), 0, np.inf)
            self._forces(joint, at, normal + friction * side, columns)
            self._edges.append((which, columns, friction * side))

    def _strong(self, which, turn, fixed):
        """Contacts of the other joints: a normal force within bounds, and forces along the joint below the strength."""
        a, c = self.assembly, self.assembly.contacts
        self._shear, self._normal = [], None
        if not len(which):
            return
        joint, at, area = c.joint[which], c.at[which], c.area[which] / self.force
        one, two = a.tangents[joint].swapaxes(0, 1)
        low, high = -a.tension[joint] * area, a.crushing[joint] * area
        columns = self._new(len(which), low, high)
        self._normal = which, columns
        self._forces(joint, at, a.normals[joint], columns)
        # what shares a shear strength: in the plane all points of a joint, in space a point
        if a.plane:
            groups, first, group = np.unique(joint, return_index=True, return_inverse=True)  # fmt: skip
        else:
            groups, first = joint, np.arange(len(which))
            group = first
        strength = np.bincount(group, a.cohesion[joint] * area)
        slope = a.friction[groups]
        if fixed is not None:
            pressed, share = fixed
            pressed = pressed[groups if a.plane else which] / self.force
            strength = strength + (1 - share) * slope * np.maximum(pressed, 0)
            slope = share * slope
        # the force along the joint is a sum of forces to the corners of a polygon, and their sum is below the strength
        limits = len(self.limits) + np.arange(len(first))
        self.limits = np.append(self.limits, strength)
        self._unequal.append((limits[group], columns, -slope[group]))
        directions = (
            [one[first], -one[first]] if a.plane else _polygon(turn[which], one, two)
        )
        for direction in directions:
            along = self._new(len(first), 0, np.inf)
            self._forces(joint[first], at[first], direction, along)
            self._unequal.append((limits, along, np.ones(len(first))))
            self._shear.append((which[first], along, direction))

    def matrices(self):
        """Matrices of equilibrium and of strength."""
        from scipy.sparse import csc_matrix

        def matrix(entries, count):
            if not entries:
                return csc_matrix((count, self.columns))
            rows, columns, values = (np.concatenate(x) for x in zip(*entries))
            return csc_matrix((values, (rows, columns)), (count, self.columns))

        return (
            matrix(self._equal, int(self.rows.max()) + 1 + self.links),
            matrix(self._unequal, len(self.limits)),
        )

    def read(self, values):
        """Normal force, positive in compression, (one a contact) and force along the joint (contact, 3) [N]."""
        count = len(self.assembly.contacts.at)
        normal, along = np.zeros(count), np.zeros((count, 3))
        for which, columns, side in self._edges:
            force = self.force * values[columns]
            normal[which] += force
            along[which] += force[:, None] * side
        if self._normal:
            which, columns = self._normal
            normal[which] = self.force * values[columns]
        for which, columns, direction in self._shear:
            along[which] += (self.force * values[columns])[:, None] * direction
        return normal, along


def _polygon(turn, one, two):
    """Corners of a polygon around the unit circle between two directions (k, 3): a list of :data:`FACETS` arrays (k, 3).

    :param turn: angle of the first corner from ``one`` (k) [rad]
    """
    radius = 1 / math.cos(math.pi / FACETS)
    angles = turn + 2 * math.pi / FACETS * np.arange(FACETS)[:, None]
    cos, sin = np.cos(angles)[..., None], np.sin(angles)[..., None]
    return [radius * (x * one + y * two) for x, y in zip(cos, sin)]


def solve(programme, cost, loads, left):
    """Solve a programme.

    :param programme: :class:`Programme`
    :param cost: of each variable
    :param loads: right-hand side of equilibrium
    :param left: time that the solver may take [s]
    :returns: the variables, and the multipliers of equilibrium
    :raises Unsolved:
    """
    from scipy.sparse import vstack

    if left <= 0:
        raise Late
    equal, unequal = programme.matrices()
    if not (np.isfinite(equal.data).all() and np.isfinite(loads).all()):
        raise Unsolved("the programme has numbers that are not finite")
    whole = vstack([equal, unequal], "csc")
    sides = np.append(loads, programme.limits)
    values, dual = solver.solve(
        whole, len(loads), programme.low, programme.high, cost, sides, left
    )
    off = np.abs(equal @ values - loads).max()
    over = (unequal @ values - programme.limits).max(initial=0)
    if max(off, over) > KEPT * max(1, np.abs(values).max()):
        raise Unsolved(
            f"its solution misses equilibrium by {off:.1g} and strength by {over:.1g} of a block's usual load"
        )
    return values, dual
