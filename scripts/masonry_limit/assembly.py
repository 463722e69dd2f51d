# SPDX-License-Identifier: GPL-2.0-or-later
"""Rigid blocks, their joints and loads, and the bounds of what they carry."""

import contextlib
import math
import time
from collections import namedtuple
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from masonry.arguments import Numbers
from masonry.errors import Refused, refuse
from . import slipping
from .bound import Bound
from .programme import FACETS, Programme
from .solver import SolverTimeout, Unsolved

MAX_TURNS = 6  # of the facets of friction
SAME_FACTOR = 1e-3  # relative change of the factor at which turning ends [-]


class UnboundedLoad(Refused):
    """No load is so large that anything gives way."""


@dataclass
class Assembly:
    """Rigid blocks and their joints. Arrays run over blocks (n), joints (m) or points of joints
    (p).

    Loads are arrays (n, 6): force [N] and moment about the centroid [N m] of each block. They can
    be added and scaled.

    :param centres: centroids of the blocks (n, 3) [m]
    :param masses: (n) [kg]
    :param held: whether a block cannot move along x, y, z, or turn about them (n, 6)
    :param pairs: numbers of the two blocks of each joint (m, 2)
    :param normals: unit normals from the first to the second block (m, 3)
    :param joint: number of the joint of each point (p), in ascending order
    :param points: (p, 3) [m]
    :param areas: (p) [m²]
    :param tension: tensile strength (m) [Pa]
    :param cohesion: (m) [Pa]
    :param friction: friction coefficient (m) [-]
    :param crushing: compressive strength (m) [Pa], infinite for joints that cannot crush
    :param elastic: whether a joint never gives way (m)
    :param ids: numbers by which messages name the blocks (n), YADE's
    :param polygons: corners of the joints, a list of arrays (k, 3) [m]
    :param corners: corners of the blocks, a list of arrays (k, 3) [m]
    :param seams: whether a joint is a crack surface in a brick (m); pictures show it where it opens
    :param stood: whether blocks are where they stood when the joints were made
    :param deadline: end of the time that the solver has for all programmes together, as
        time.monotonic() counts [s]
    :param props: points of blocks that cannot move in a direction, whatever force that takes: a
        list of (number of the block, unit vector, point [m])
    :param links: ties and springs: a list of (loads that a unit of the force makes, as a list of
        (number of the block, force and moment about its centroid), least force, largest force [N])
    """

    centres: np.ndarray
    masses: np.ndarray
    held: np.ndarray
    pairs: np.ndarray
    normals: np.ndarray
    joint: np.ndarray
    points: np.ndarray
    areas: np.ndarray
    tension: np.ndarray
    cohesion: np.ndarray
    friction: np.ndarray
    crushing: np.ndarray
    elastic: np.ndarray
    ids: list
    polygons: list
    corners: list
    seams: np.ndarray
    props: list = field(default_factory=list)
    links: list = field(default_factory=list)
    stood: bool = True
    deadline: float = math.inf

    def __post_init__(self):
        free = ~self.held.all(axis=1)
        #: whether no free block leaves the x-z plane
        self.plane = bool(free.any() and self.held[free][:, [1, 3, 5]].all())
        self.tangents = self._tangents()
        bare = (self.tension == 0) & (self.cohesion == 0) & np.isinf(self.crushing)
        #: joints whose forces can be anywhere between the corners: dry ones that cannot crush
        self.dry = bare & ~self.elastic
        self.contacts = self._contacts()
        #: whether some joints close a loop, as in a bond, unlike those of an arch or a stack
        self.bonded = self._bonded(free)

    # -- loads -------------------------------------------------------------------------------------

    def weights(self, acceleration: Numbers) -> np.ndarray:
        """Mass times an acceleration (x, y, z) [m/s²] on every block that is free to follow it, as
        a load."""
        load = np.zeros((len(self.centres), 6))
        load[:, :3] = self.masses[:, None] * np.asarray(acceleration, float)
        return load

    def force(self, block: int, vector: Numbers, point: Numbers | None = None) -> np.ndarray:
        """A force on a block, as a load.

        :param block: its number in the assembly
        :param vector: (x, y, z) [N]
        :param point: on which it acts (x, y, z) [m]; None: the centroid
        """
        load = np.zeros((len(self.centres), 6))
        load[block, :3] = vector
        if point is not None:
            load[block, 3:] = np.cross(np.asarray(point) - self.centres[block], vector)
        return load

    # -- the programme -----------------------------------------------------------------------------

    def largest(self, live: np.ndarray, dead: np.ndarray) -> Bound:
        """The largest factor on a load that the structure carries beside others.

        :param live: load that grows
        :param dead: loads that stay
        :raises Refused: if the structure does not carry the dead loads alone, with the block that
            moves most; if nothing gives way, however large the factor is; or if the numbers of the
            programme are too far apart to be solved
        """
        return self._bound(live, dead, 1)

    def smallest(self, live: np.ndarray, dead: np.ndarray) -> Bound:
        """The smallest factor with which a load keeps the structure at rest, for example the least
        reaction of a support that settles; in its mechanism the structure follows the support.
        Parameters as in :meth:`largest`.
        """
        return self._bound(live, dead, -1)

    def _bound(self, live, dead, sense):
        problems = [
            f"limit analysis: the {name} load has numbers that are not finite"
            for name, load in (("live", live), ("dead", dead))
            if not np.isfinite(load).all()
        ]
        if not problems and not np.abs(live[~self.held]).max(initial=0) > 0:
            problems.append("limit analysis: the live load acts on no free block")
        refuse(problems)
        bound = self.associated(live, dead, sense=sense)
        bound.factor *= sense
        if sense > 0 and bound.rigid and self.bonded:
            other = slipping.loosened(self, live, dead)
            if other and other.factor < bound.factor * (1 - SAME_FACTOR):
                bound.weaker = other.factor
        return bound

    def withoutDilatancy(self, live: np.ndarray, dead: np.ndarray) -> Bound:
        """A collapse of joints that slip without opening, by repeated limit analysis.

        Friction is replaced, joint by joint, by a cohesion that is the friction under the normal
        force of the last round, with hardly any slope, so that joints which slip do not open. When
        normal forces repeat, the forces obey friction and the mechanism does not dilate (the idea
        of Gilbert, Casapulla and Ahmed, "Limit analysis of masonry block structures with
        non-associative frictional joints using linear programming", Computers and Structures 84,
        2006). The same is done without friction in head joints, and with joints that lose their
        friction where nothing presses them, and the smallest result is taken: a collapse of such
        joints, often the least, but no proof that there is none below.

        :returns: a bound whose ``settled`` says whether normal forces came to repeat themselves
        """
        return slipping.withoutDilatancy(self, live, dead)

    def associated(
        self,
        live: np.ndarray,
        dead: np.ndarray,
        fixed: Any = None,
        turns: int = MAX_TURNS,
        sense: int = 1,
    ) -> Bound:
        """The bound of associated flow alone, with facets of friction that turn to where forces
        point.

        :param fixed: and ``sense``: as in :meth:`_solve`
        :param turns: how often the facets are turned at most
        """
        turn = np.zeros(len(self.contacts.at))
        best = self._solve(live, dead, sense, turn, fixed)
        if self.plane:
            return best
        best.facetError = 1 / math.cos(math.pi / FACETS) - 1
        for _ in range(turns):
            turn = best.directions - math.pi / FACETS
            try:
                again = self._solve(live, dead, sense, turn, fixed)
            except Refused:  # time is over
                break
            change = abs(again.value - best.value) / max(abs(best.value), 1e-12)
            if again.value < best.value:
                best = again
            best.facetError = change
            if change < SAME_FACTOR or again is not best:
                break
        return best

    def _solve(self, live, dead, sense, turn, fixed=None, most=None):
        """Solve the programme once.

        :param sense: 1 for the largest factor, -1 for the smallest
        :param turn: angles of the first vertices of the friction polygons [rad]
        :param fixed: normal forces (one a joint or, in space, one a contact) [N], and the share [-]
            of the friction that still grows with them; None: all of it
        :param most: the largest factor to look for
        """
        free = ~self.held
        rows = np.full(self.held.shape, -1)
        rows[free] = np.arange(free.sum())
        arms = self.points - self.centres[self.pairs[self.joint, 0]]
        size = float(np.mean(np.linalg.norm(arms, axis=1))) or 1.0
        force = _force(dead if np.any(dead[free]) else live, free)
        programme = Programme(self, rows, size, force)
        programme.joints(turn, fixed)
        scale = np.array([1, 1, 1, 1 / size, 1 / size, 1 / size]) / force
        growing, still = (live * scale)[free], (dead * scale)[free]
        step = np.abs(growing).max()
        programme.factor(sense * growing / step, most and most * step)
        try:
            left = self.deadline - time.monotonic()
            factor, values, dual = programme.solve(still, left)
            if most is None and factor / step > self._unreachable(live, dead):
                raise Unsolved(
                    "no largest load was found; is a joint so strong that it never fails?"
                )
        except Unsolved as unsolved:
            if most is not None:
                raise
            if isinstance(unsolved, SolverTimeout):
                raise Refused("limit analysis: it was not solved in time") from None
            raise self._why(live, dead, sense, turn, unsolved) from None
        speed = np.zeros(self.held.shape)
        # The dual of equilibrium, with which the live load has the power of its unit.
        speed[free] = -dual / step
        speed *= scale * sense
        return Bound(self, factor / step, speed, live, dead, *programme.read(values))

    def _unreachable(self, live, dead):
        """A factor that no strength explains: a million times all strengths and dead loads over the
        live load."""
        areas = np.bincount(self.joint, self.areas, len(self.pairs))
        finite = np.where(np.isfinite(self.crushing), self.crushing, 0)
        strength = (areas * (self.tension + self.cohesion + finite)).sum()
        return 1e6 * (strength + np.abs(dead).sum()) / np.abs(live).sum()

    def _why(self, live, dead, sense, turn, unsolved):
        """Why the programme could not be solved, as the error to raise."""
        with contextlib.suppress(Unsolved):
            if np.abs(dead[~self.held]).max(initial=0) > 0:
                carried = self._solve(dead, 0 * dead, 1, turn, most=1.0)
                if carried.value < 1 - 1e-6:
                    fast = carried.fastest()
                    at = ", ".join(f"{v:.3g}" for v in self.centres[fast])
                    return Refused(
                        "limit analysis: the structure does not stand under its dead loads alone:"
                        f" body {self.ids[fast]} at ({at}) m moves first"
                    )
            limit = 1e-3 * self._unreachable(live, dead)
            if self._solve(live, dead, sense, turn, most=limit).value > 0.9 * limit:
                return UnboundedLoad(
                    "limit analysis: nothing gives way, however large the load is: the blocks on"
                    " which it acts are locked between others, or joined by joints that never fail"
                )
        return Refused(f"limit analysis: {unsolved}")

    # -- geometry ----------------------------------------------------------------------------------

    def _tangents(self):
        """Two unit vectors in the plane of every joint (m, 2, 3); in the x-z plane the first lies
        in it."""
        first = np.cross(self.normals, [0, 1, 0])
        flat = np.linalg.norm(first, axis=1) < 0.1
        first[flat] = np.cross(self.normals[flat], [1, 0, 0])
        first /= np.linalg.norm(first, axis=1)[:, None]
        return np.stack([first, np.cross(self.normals, first)], axis=1)

    def _bonded(self, free):
        """Whether there are more joints between free blocks than a tree of them would have."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import connected_components

        one, two = self.pairs[free[self.pairs].all(axis=1)].T
        count = len(self.centres)
        graph = coo_matrix((np.ones(len(one)), (one, two)), (count, count))
        parts, _ = connected_components(graph, directed=False)
        return len(one) > count - parts

    def _contacts(self):
        """The points on which forces act: corners of dry joints, else the points of the engine."""
        at, area, joint = [np.zeros((0, 3))], [np.zeros(0)], []
        starts = np.searchsorted(self.joint, np.arange(len(self.pairs) + 1))
        for j in np.flatnonzero(~self.elastic):
            own = slice(*starts[j : j + 2])
            points, areas = self.points[own], self.areas[own]
            if self.dry[j]:
                points = np.asarray(self.polygons[j])
                if self.plane:
                    along = points @ self.tangents[j, 0]
                    points = points[[along.argmin(), along.argmax()]]
                areas = np.full(len(points), areas.sum() / len(points))
            at.append(points)
            area.append(areas)
            joint += [j] * len(points)
        return _Contacts(np.concatenate(at), np.concatenate(area), np.array(joint, int))


#: Points on which forces act: place [m], area [m²] and number of the joint.
_Contacts = namedtuple("_Contacts", "at area joint")


def _force(load, free):
    """The usual size of the forces of a load [N], or of its moments [N m] if there are none; 1 if
    there is nothing."""
    load = np.abs(np.where(free, load, 0))
    for part in (load[:, :3], load[:, 3:]):
        sizes = part.max(axis=1)
        if sizes.any():
            return float(np.median(sizes[sizes > 0]))
    return 1.0
