"""Limit analysis: the largest load that a structure of rigid blocks can carry, without a run.

The blocks and joints are those of the scene that is built, so this is a second opinion on what a run says::

    from masonry import limit

    assembly = limit.read()                              # the scene as it stands in YADE
    dead = assembly.weights((0, 0, -9.81))               # [m/s²]
    live = assembly.weights((9.81, 0, 0))                # so the factor is in g
    bound = assembly.largest(live, dead)
    print(bound.sentence("horizontal acceleration", "g"))
    bound.save("results"), bound.draw("results/mechanism.png")

Of a :class:`masonry.Scene` ``scene.bound(...)`` does all this.

The static theorem is used: the largest factor for which forces in the joints exist that are in equilibrium with the loads
and nowhere above the strength. It is a linear programme, which HiGHS solves through SciPy. Its dual is the mechanism: how
fast each block moves when the structure gives way (Livesley, "Limit analysis of structures formed from rigid blocks",
International Journal for Numerical Methods in Engineering 12, 1978).

What it takes for granted:

- Blocks are rigid and keep their strength; displacements until the collapse are small.
- Joints are rigid and perfectly plastic, with the strengths that they have before anything softens: tensile strength,
  cohesion, friction, and, where they can crush, the compressive strength. Points of a joint are those of the engine, so
  strength in bending is that of the engine's joint, too. The elliptical end of the cap is left out.
- Joints that slip open as friction tells (associated flow). Real ones do not, and can carry less.

So the factor is an **upper bound** for joints that soften and slip. For dry joints of which none slips in the mechanism it is
what rigid blocks carry, if the joints close no loops, as those of an arch, a stack or a panel. In running bond, head joints
that are open slip freely, and a wall can tip over a stepped crack at a lower factor; where that is found,
:attr:`Bound.weaker` has it. :meth:`Assembly.withoutDilatancy` looks for a collapse of joints that slip without opening,
which lies below.

Friction in space is a polygon around the circle, :data:`FACETS` sides a point. It is turned at every point to where the
force there points, until the factor stands still, so it costs less than :attr:`Bound.facetError`.
"""

import math
import os
from dataclasses import dataclass, field, replace

import numpy as np

from yade import O

from .errors import Refused
from .figures import mechanism

FACETS = 8  # of a friction cone
TURNS = 6  # how often the facets are turned at most
STILL = 1e-3  # change of the factor at which they stand still [-]
SIMPLEX = 1500  # variables from which HiGHS uses its interior-point method
INTERIOR_POINT, NO_PRESOLVE = 4, 1  # as Clp's ClpSolve.hpp counts them
KEPT = 1e-6  # how well equilibrium and strength must be kept, relative to the largest force
SHARE = 12  # entries of the load by which a copy of the factor is multiplied
SLIDES = 1e-4  # share of the power of a mechanism that is friction, from which its joints slide [-]
LOOSENED = 8  # rounds in which joints without pressure lose their friction, at most
MISSED = (
    0.02  # share of the power of a mechanism that the friction of head joints may miss
)
UPRIGHT = 0.5  # cosine to the dead loads below which the normal of a joint is that of a head joint
GIVES = (
    0.02  # of the largest motion between two blocks of the mechanism: less is not told
)

MECHANISM = "mechanism_blocks.vtu", "mechanism_joints.vtu"  # files for ParaView
SHOWN = (
    0.06  # of the size of the structure: how far the fastest corner is drawn to move
)

AXES = "xyzXYZ"


@dataclass
class Assembly:
    """Rigid blocks and their joints. Arrays run over blocks (n), joints (m) or points of joints (p).

    Loads are arrays (n, 6): force [N] and moment about the centroid [N m] of each block. They can be added and scaled.

    :param centres: centroids of the blocks (n, 3) [m]
    :param masses: (n) [kg]
    :param held: (n, 6) whether a block cannot move along x, y, z, or turn about them
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
    :param props: points of blocks that cannot move in a direction, whatever force that takes: a list of (number of the
        block, unit vector, point [m])
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
    props: list = field(default_factory=list)

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

    # -- loads ----------------------------------------------------------------------------------------------------

    def weights(self, acceleration):
        """Mass times an acceleration (x, y, z) [m/s²] on every block that is free to follow it, as a load."""
        load = np.zeros((len(self.centres), 6))
        load[:, :3] = self.masses[:, None] * np.asarray(acceleration, float)
        return load

    def force(self, block, vector, point=None):
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

    # -- the programme --------------------------------------------------------------------------------------------

    def largest(self, live, dead):
        """The largest factor on a load that the structure carries beside others.

        :param live: load that grows
        :param dead: loads that stay
        :returns: :class:`Bound`
        :raises Refused: if the structure does not carry the dead loads alone, with the block that moves most; if nothing
            gives way, however large the factor is; or if the numbers of the programme are too far apart to be solved
        """
        return self._bound(live, dead, 1)

    def smallest(self, live, dead):
        """The smallest factor with which a load keeps the structure at rest, for example the least reaction of a support
        that settles. Its mechanism is that in which the structure follows the support. Parameters as of :meth:`largest`.
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
        if problems:
            raise Refused("\n".join(problems))
        bound = self._turned(lambda turn: self._solve(live, dead, sense, turn))
        bound.factor *= sense
        if sense > 0 and bound.rigid and self.bonded:
            other = self._loosened(live, dead)
            if other and other.factor < bound.factor * (1 - STILL):
                bound.weaker = other.factor
        return bound

    def _smooth(self, dead):
        """The same structure without friction in its head joints, which the dead loads do not press together; None if it
        has none.

        When a part of a wall tips over a stepped crack, nearly all of its head joints are open, and slip along their faces
        without anything to resist. Associated flow does not allow that, since joints that slip would have to open more.
        """
        down = np.where(self.held[:, :3], 0, dead[:, :3]).sum(axis=0)
        if not np.linalg.norm(down) > 0:
            return None
        head = np.abs(self.normals @ (down / np.linalg.norm(down))) < UPRIGHT
        return replace(self, friction=np.where(head, 0, self.friction)) if head.any() else None  # fmt: skip

    def _belongs(self, bound):
        """Whether the mechanism of a structure without friction in head joints is one of this structure, too: whether hardly
        any friction is missing in it (MISSED)."""
        c = self.contacts
        speed = np.linalg.norm(bound.jumps(c.joint, c.at)[1], axis=1)
        friction = (self.friction - bound.assembly.friction)[c.joint]
        missing = (friction * np.maximum(bound.normal, 0) * speed).sum()
        return missing <= MISSED * bound.powers["loads"]

    def _loosened(self, live, dead):
        """The weakest mechanism that is found when joints without pressure lose their friction, or None.

        It begins with the head joints. Then other joints that carry nothing lose their friction, too, and so on. What
        misses friction where joints are pressed does not count.
        """
        smooth, least = self._smooth(dead), None
        for _ in range(LOOSENED):
            if smooth is None:
                break
            try:
                bound = smooth._turned(lambda turn: smooth._solve(live, dead, 1, turn))
            except Refused:  # without that friction it does not stand
                break
            if self._belongs(bound) and (least is None or bound.factor < least.factor):
                least = bound
            pressed = np.bincount(self.contacts.joint, bound.normal, len(self.pairs))
            friction = np.where(pressed < 1e-6 * pressed.max(), 0, smooth.friction)
            if (friction == smooth.friction).all():
                break
            smooth = replace(self, friction=friction)
        return least

    def withoutDilatancy(self, live, dead, most=60, within=1e-3):
        """A collapse of joints that slip without opening, by repeated limit analysis.

        Friction is replaced, joint by joint, by a cohesion that is the friction under the normal force of the last round,
        with hardly any slope, so that joints which slip do not open. When normal forces repeat, the forces obey friction
        and the mechanism does not dilate (the idea of Gilbert, Casapulla and Ahmed, "Limit analysis of masonry block
        structures with non-associative frictional joints using linear programming", Computers and Structures 84, 2006).
        The same is done without friction in head joints, and with joints that lose their friction where nothing presses
        them, and the smallest result is taken. It is a collapse of such
        joints, and often the least, but no proof that there is none below.

        :param most: rounds
        :param within: change of the factor at which it ends [-]
        :returns: :class:`Bound`; ``settled`` says whether normal forces came to repeat themselves
        """
        found = self._repeated(live, dead, most, within)
        smooth = self._smooth(dead)
        if smooth:
            try:
                other = smooth._repeated(live, dead, most, within)
                if other.factor < found.factor and self._belongs(other):
                    found = other
            except Refused:
                pass  # without that friction it does not stand
        loose = self._loosened(live, dead)
        if loose and loose.factor < found.factor:
            found, loose.settled = loose, True
        found.assembly = self
        found.dilates = False
        return found

    def _repeated(self, live, dead, most, within):
        """The rounds of :meth:`withoutDilatancy`."""
        bound = self._turned(lambda turn: self._solve(live, dead, 1, turn))
        pressed, factor, slope = bound.compressed, bound.factor, 0.3
        for _ in range(most):
            slope = max(1e-3, slope * 0.7)
            try:
                following = self._turned(
                    lambda turn: self._solve(live, dead, 1, turn, (pressed, slope)), 2
                )
            except Refused:
                break
            change = abs(following.factor - factor) / max(abs(factor), 1e-12)
            pressed = 0.5 * pressed + 0.5 * following.compressed
            bound, factor = following, following.factor
            if change < within and slope < 2e-3 and bound.overstressed < 0.01:
                bound.settled = True
                break
        return bound

    def _turned(self, solve, turns=TURNS):
        """Solve with facets of friction that turn to where forces point."""
        turn = np.zeros(len(self.contacts.at))
        best = solve(turn)
        if self.plane:
            return best
        for _ in range(turns):
            turn = best.directions - math.pi / FACETS
            again = solve(turn)
            change = abs(again.value - best.value) / max(abs(best.value), 1e-12)
            if again.value < best.value:
                best = again
            best.facetError = change
            if change < STILL:
                break
        return best

    def _solve(self, live, dead, sense, turn, fixed=None, most=None):
        """Solve the programme once.

        :param sense: 1 for the largest factor, -1 for the smallest
        :param turn: angles of the first vertices of the friction polygons [rad]
        :param fixed: normal forces (one a joint or, in space, one a contact) [N], and the share [-] of the friction that
            still grows with them; None: all of it
        :param most: the largest factor to look for
        """
        free = ~self.held
        rows = np.full(self.held.shape, -1)
        rows[free] = np.arange(free.sum())
        size = _typical(self.points - self.centres[self.pairs[self.joint, 0]])
        force = _force(dead if np.any(dead[free]) else live, free)
        programme = _Programme(self, rows, size, force)
        programme.joints(turn, fixed)
        scale = np.array([1, 1, 1, 1 / size, 1 / size, 1 / size]) / force
        growing, still = (live * scale)[free], (dead * scale)[free]
        step = np.abs(growing).max()
        last = programme.factor(sense * growing / step, most and most * step)
        cost = np.zeros(programme.columns)
        cost[last] = -1
        try:
            loads = np.append(-still, np.zeros(programme.links))
            values, dual = solve(programme, cost, loads)
            if most is None and values[last] / step > self._endless(live, dead):
                raise Unsolved("it has no end")
        except Unsolved as unsolved:
            if most is not None:
                raise
            raise self._why(live, dead, sense, turn, unsolved) from None
        speed = np.zeros(self.held.shape)
        # The dual of equilibrium, with which the live load has the power of its unit.
        speed[free] = -dual[: len(still)] / step
        speed *= scale * sense
        told = programme.read(values)
        return Bound(self, values[last] / step, speed, live, dead, *told)

    def _endless(self, live, dead):
        """A factor that no strength explains: a million times all strengths and loads over the live load."""
        areas = np.bincount(self.joint, self.areas, len(self.pairs))
        finite = np.where(np.isfinite(self.crushing), self.crushing, 0)
        strength = (areas * (self.tension + self.cohesion + finite)).sum()
        return 1e6 * (strength + np.abs(dead).sum()) / np.abs(live).sum()

    def _why(self, live, dead, sense, turn, unsolved):
        """Why the programme could not be solved, as the error to raise."""
        nothing = np.zeros_like(dead)
        told = "limit analysis: "
        try:
            if np.abs(dead[~self.held]).max(initial=0) > 0:
                carried = self._solve(dead, nothing, 1, turn, most=1.0)
                if carried.value < 1 - 1e-6:
                    fast = carried.fastest()
                    at = ", ".join(f"{v:.3g}" for v in self.centres[fast])
                    return Refused(
                        f"{told}the structure does not stand under its dead loads alone: body {self.ids[fast]} at ({at}) m "
                        "moves first"
                    )
            endless = 1e-3 * self._endless(live, dead)
            if self._solve(live, dead, sense, turn, most=endless).value > 0.9 * endless:
                return Refused(
                    f"{told}nothing gives way, however large the load is: the blocks on which it acts are locked between "
                    "others, or joined by joints that never fail"
                )
        except Unsolved:
            pass
        return Refused(f"{told}{unsolved}")

    # -- geometry -------------------------------------------------------------------------------------------------

    def _tangents(self):
        """Two unit vectors in the plane of every joint (m, 2, 3); in the x-z plane the first lies in it."""
        first = np.cross(self.normals, [0, 1, 0])
        length = np.linalg.norm(first, axis=1)
        flat = length < 0.1
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
        at, area, joint = [], [], []
        starts = np.searchsorted(self.joint, np.arange(len(self.pairs) + 1))
        for j in range(len(self.pairs)):
            if self.elastic[j]:
                continue
            points = self.points[starts[j] : starts[j + 1]]
            areas = self.areas[starts[j] : starts[j + 1]]
            if self.dry[j]:
                points = np.asarray(self.polygons[j])
                if self.plane:
                    along = points @ self.tangents[j, 0]
                    points = points[[along.argmin(), along.argmax()]]
                areas = np.full(len(points), areas.sum() / len(points))
            at.append(points)
            area.append(areas)
            joint += [j] * len(points)
        if not at:
            return _Contacts(np.zeros((0, 3)), np.zeros(0), np.zeros(0, int))
        return _Contacts(np.concatenate(at), np.concatenate(area), np.array(joint))


@dataclass
class _Contacts:
    """Points on which forces act: place [m], area [m²] and number of the joint."""

    at: np.ndarray
    area: np.ndarray
    joint: np.ndarray


def _typical(lengths):
    """A typical length of many vectors."""
    return float(np.mean(np.linalg.norm(lengths, axis=1))) or 1.0


def _force(load, free):
    """The usual size of the forces of a load [N], or of its moments [N m] if there are none; 1 if there is nothing."""
    load = np.abs(np.where(free, load, 0))
    for part in (load[:, :3], load[:, 3:]):
        sizes = part.max(axis=1)
        if (sizes > 0).any():
            return float(np.median(sizes[sizes > 0]))
    return 1.0


class _Programme:
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
        """All joints and props. Parameters as of :meth:`Assembly._solve`."""
        a = self.assembly
        self._rigid()
        for block, direction, point in a.props:
            load = a.force(block, direction, point)[block]
            load[3:] /= self.size
            kept = (self.rows[block] >= 0) & (load != 0)
            column, rows = self._new(1, -np.inf, np.inf), self.rows[block][kept]
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
        middle = np.column_stack(
            [np.bincount(a.joint, a.areas * x, len(a.pairs)) for x in a.points.T]
        )[which]
        middle /= areas[which][:, None]
        axes = np.eye(3)[[0, 2]] if a.plane else np.eye(3)
        for axis in axes:
            columns = self._new(len(which), -np.inf, np.inf)
            self._forces(which, middle, np.tile(axis, (len(which), 1)), columns)
        for axis in np.eye(3)[[1]] if a.plane else np.eye(3):
            columns = self._new(len(which), -np.inf, np.inf)
            self._forces(which, middle, None, columns, np.tile(axis, (len(which), 1)))

    def _dry(self, which, turn):
        """Contacts of dry joints in space: forces within the friction cone, as sums of its edges."""
        a, c = self.assembly, self.assembly.contacts
        self._edges = []
        joint, at = c.joint[which], c.at[which]
        normal, (one, two) = a.normals[joint], a.tangents[joint].swapaxes(0, 1)
        friction = a.friction[joint][:, None]
        radius = 1 / math.cos(math.pi / FACETS)
        angles = turn[which] + 2 * math.pi / FACETS * np.arange(FACETS)[:, None]
        cos, sin = np.cos(angles)[..., None], np.sin(angles)[..., None]
        sides = [radius * (x * one + y * two) for x, y in zip(cos, sin)]
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
        along = [self._new(len(first), -np.inf, np.inf)]
        self._forces(joint[first], at[first], one[first], along[0])
        self._shear.append((which[first], along[0], one[first]))
        if not a.plane:
            along.append(self._new(len(first), -np.inf, np.inf))
            self._forces(joint, at, two, along[1])
            self._shear.append((which, along[1], two))
        count = 2 if a.plane else FACETS
        for facet in range(count):
            rows = len(self.limits) + np.arange(len(first))
            if a.plane:
                parts = [(along[0], np.full(len(first), 1.0 - 2 * facet))]
            else:  # the normal of a side stands between two vertices
                angle = turn[which] + (2 * facet + 1) * math.pi / FACETS
                parts = [(along[0], np.cos(angle)), (along[1], np.sin(angle))]
            for column, value in parts:
                self._unequal.append((rows, column, value))
            self._unequal.append((rows[group], columns, -slope[group]))
            self.limits = np.append(self.limits, strength)

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


class Unsolved(Exception):
    """The programme has no solution, or none was found; the text says what the solver says."""


def solve(programme, cost, loads):
    """Solve a programme, with Clp's interior-point method if its library is there, else with HiGHS.

    On the many contacts of a wall in which forces can be shared in many ways, Clp's method takes a twentieth of the time
    of HiGHS's.

    :param programme: :class:`_Programme`
    :param cost: of each variable
    :param loads: right-hand side of equilibrium
    :returns: the variables, and the multipliers of equilibrium
    :raises Unsolved:
    """
    equal, unequal = programme.matrices()
    if not (np.isfinite(equal.data).all() and np.isfinite(loads).all()):
        raise Unsolved("the programme has numbers that are not finite")
    try:
        values, dual = _clp(programme, cost, loads, equal, unequal)
    except OSError:
        values, dual = _highs(programme, cost, loads, equal, unequal)
    off = np.abs(equal @ values - loads).max()
    over = (unequal @ values - programme.limits).max(initial=0)
    if max(off, over) > KEPT * max(1, np.abs(values).max()):
        raise Unsolved(
            f"its solution misses equilibrium by {off:.1g} and strength by {over:.1g} of a block's usual load"
        )
    return values, dual


def _highs(programme, cost, loads, equal, unequal):
    from scipy.optimize import linprog

    found = linprog(
        cost,
        A_eq=equal,
        b_eq=loads,
        A_ub=unequal if unequal.shape[0] else None,
        b_ub=programme.limits if unequal.shape[0] else None,
        bounds=np.column_stack([programme.low, programme.high]),
        method="highs-ds" if programme.columns < SIMPLEX else "highs-ipm",
    )
    if found.status:
        raise Unsolved(found.message.strip())
    return found.x, found.eqlin.marginals


def _clp(programme, cost, loads, equal, unequal):
    import ctypes

    from scipy.sparse import vstack

    clp = ctypes.CDLL("libClp.so.1")
    numbers = ctypes.POINTER(ctypes.c_double)
    clp.Clp_newModel.restype = clp.ClpSolve_new.restype = ctypes.c_void_p
    for name in ("Clp_primalColumnSolution", "Clp_dualRowSolution"):
        getattr(clp, name).restype = numbers
    whole = vstack([equal, unequal], format="csc")
    rows, columns = whole.shape
    double = lambda values: np.ascontiguousarray(values, np.float64)
    low = double(np.append(loads, np.full(len(programme.limits), -np.inf)))
    high = double(np.append(loads, programme.limits))
    arrays = [
        np.ascontiguousarray(whole.indptr, np.int32),
        np.ascontiguousarray(whole.indices, np.int32),
        *map(double, (whole.data, programme.low, programme.high, cost, low, high)),
    ]
    model = ctypes.c_void_p(clp.Clp_newModel())
    try:
        clp.Clp_setLogLevel(model, 0)
        places = [ctypes.c_void_p(array.ctypes.data) for array in arrays]
        clp.Clp_loadProblem(model, columns, rows, *places)
        how = ctypes.c_void_p(clp.ClpSolve_new())
        clp.ClpSolve_setSolveType(how, INTERIOR_POINT, -1)
        clp.ClpSolve_setPresolveType(how, NO_PRESOLVE, -1)
        clp.Clp_initialSolveWithOptions(model, how)
        clp.ClpSolve_delete(how)
        status = clp.Clp_status(model)
        if status:
            said = {1: "it has no solution", 2: "it has no end"}
            raise Unsolved(said.get(status, f"Clp ended with status {status}"))
        values = np.array(clp.Clp_primalColumnSolution(model)[:columns])
        return values, np.array(clp.Clp_dualRowSolution(model)[: equal.shape[0]])
    finally:
        clp.Clp_deleteModel(model)


@dataclass
class Bound:
    """What limit analysis found: a load factor, and the mechanism at which the structure gives way.

    Velocities are those with which the live load has a power of 1, so only their ratios mean something.
    """

    assembly: Assembly
    #: factor that was maximised [-]; :attr:`factor` has its sign
    value: float
    velocities: np.ndarray  #: of blocks (n, 6): of the centroid, and of the rotation
    live: np.ndarray
    dead: np.ndarray
    normal: np.ndarray  #: force on each contact, positive in compression [N]
    along: np.ndarray  #: force along the joint on each contact (c, 3) [N]
    #: change of the factor when the facets of friction were turned last [-]; 0 in the plane, where there are none
    facetError: float = 0.0
    dilates: bool = True  #: whether joints that slip open as friction tells
    settled: bool = False  #: of :meth:`Assembly.withoutDilatancy`
    weaker: float = (
        None  #: factor of a mechanism in which open joints slip, if that is lower
    )
    factor: float = field(init=False)  #: on the live load [-]

    def __post_init__(self):
        self.factor = self.value

    # -- forces ---------------------------------------------------------------------------------------------------

    @property
    def compressed(self):
        """Normal forces by which friction is judged [N]: one a joint in the plane, one a contact in space."""
        a = self.assembly
        if a.plane:
            return np.bincount(a.contacts.joint, self.normal, len(a.pairs))
        return self.normal

    @property
    def directions(self):
        """Angle of the force along the joint on each contact, from the joint's first tangent [rad]."""
        one, two = self.assembly.tangents[self.assembly.contacts.joint].swapaxes(0, 1)
        return np.arctan2((self.along * two).sum(1), (self.along * one).sum(1))

    @property
    def overstressed(self):
        """How far forces along the joints are above friction and cohesion, as a share of all of them [-]."""
        a, c = self.assembly, self.assembly.contacts
        joint = c.joint
        strength = a.cohesion[joint] * c.area + a.friction[joint] * self.normal
        along = np.linalg.norm(self.along, axis=1)
        if a.plane:  # one force along each joint
            one = (self.along * a.tangents[joint, 0]).sum(axis=1)
            count = len(a.pairs)
            along = np.abs(np.bincount(joint, one, count))
            strength = np.bincount(joint, strength, count)
        return float(np.maximum(along - strength, 0).sum() / max(along.sum(), 1e-300))

    # -- the mechanism --------------------------------------------------------------------------------------------

    def motion(self, block, at):
        """Velocities of points of blocks. ``block`` are numbers, ``at`` their points (k, 3) [m]."""
        u = self.velocities[block]
        return u[:, :3] + np.cross(u[:, 3:], at - self.assembly.centres[block])

    def jumps(self, joint, at):
        """Opening (k) and slide (k, 3) of points (k, 3) of joints."""
        one, two = self.assembly.pairs[joint].T
        jump = self.motion(two, at) - self.motion(one, at)
        normal = self.assembly.normals[joint]
        opening = (jump * normal).sum(axis=1)
        return opening, jump - opening[:, None] * normal

    def fastest(self):
        """Number of the block with the fastest centroid."""
        return int(np.linalg.norm(self.velocities[:, :3], axis=1).argmax())

    @property
    def powers(self):
        """Power of the mechanism by what takes it, with the live load at its factor and the dead loads, as a dict:
        ``friction``, ``cohesion``, ``tension``, ``crushing`` and ``loads``; the first four add up to the last.
        """
        a, c = self.assembly, self.assembly.contacts
        opening, slide = self.jumps(c.joint, c.at)
        speed = np.linalg.norm(slide, axis=1)
        pressed = np.maximum(self.normal, 0)
        cohesion = (a.cohesion[c.joint] * c.area * speed).sum()
        shear = -(self.along * slide).sum()
        if a.plane:  # the force along the joint stands at one of its points
            shear = np.abs((self.along * slide).sum(axis=1)).sum()
        shear = abs(shear)
        closing = np.where(np.isfinite(a.crushing[c.joint]), np.maximum(-opening, 0), 0)
        return {
            "friction": max(0.0, shear - cohesion),
            "cohesion": float(cohesion),
            "tension": float(
                (a.tension[c.joint] * c.area * np.maximum(opening, 0)).sum()
            ),
            "crushing": float((pressed * closing).sum()),
            "loads": float(
                abs((self.factor * self.live * self.velocities).sum())
                + np.abs((self.dead * self.velocities).sum(axis=1)).sum()
            ),
        }

    @property
    def slides(self):
        """Whether friction takes part in the mechanism."""
        powers = self.powers
        return powers["friction"] > SLIDES * powers["loads"]

    @property
    def rigid(self):
        """Whether no joint slides in the mechanism, and none has a strength there that it could lose."""
        powers = self.powers
        lost = sum(powers[kind] for kind in ("cohesion", "tension", "crushing"))
        return not self.slides and lost <= SLIDES * powers["loads"]

    @property
    def exact(self):
        """Whether the factor is what rigid blocks with dry joints carry: no joint slides or loses strength in the mechanism,
        and no joints close a loop, so that none can slip while others keep it open."""
        return self.rigid and not self.assembly.bonded

    def joints(self):
        """What joints do in the mechanism: an array of ``"rests"``, ``"opens"``, ``"slides"`` or ``"crushes"`` (m)."""
        a, c = self.assembly, self.assembly.contacts
        told = np.full(len(a.pairs), "rests", dtype="<U7")
        opening, slide = self.jumps(c.joint, c.at)
        speed = np.linalg.norm(slide, axis=1)
        least = GIVES * max(np.abs(opening).max(initial=0), speed.max(initial=0))
        for kind, size in (("crushes", -opening), ("slides", speed), ("opens", opening)):  # fmt: skip
            if kind == "crushes":
                size = np.where(np.isinf(a.crushing[c.joint]), 0, size)
            # what slides as friction tells opens by the friction coefficient of it
            over = size > least
            if kind == "opens":
                over &= opening > 1.001 * a.friction[c.joint] * speed + 1e-9 * least
            told[c.joint[over]] = kind
        return told

    def sentence(self, load, unit, digits=4):
        """What was found, as a sentence.

        :param load: name of the live load
        :param unit: of the factor
        """
        told = self.joints()
        counts = ", ".join(
            f"{(told == kind).sum()} {kind[:-1] if kind != 'crushes' else 'crush'}"
            for kind in ("opens", "slides", "crushes")
            if (told == kind).any()
        )
        what = (
            "no joint slides, so this is what rigid blocks carry"
            if self.exact
            else "an upper bound, since " + self._reason()
        )
        if not self.dilates:
            what = "joints that slip do not open" + (
                ""
                if self.settled
                else f"; {100 * self.overstressed:.1g} % of the forces are above friction"
            )
        return f"limit analysis: {load} {self.factor:.{digits}g} {unit} ({what}); joints: {counts or 'none moves'}"

    def _reason(self):
        powers = self.powers
        whole = powers["loads"]
        reasons = []
        if self.weaker is not None:
            reasons.append(f"open joints slip at {self.weaker:.4g} already")
        if powers["friction"] > SLIDES * whole:
            reasons.append("joints slide")
        if any(
            powers[kind] > SLIDES * whole
            for kind in ("cohesion", "tension", "crushing")
        ):
            reasons.append("joints lose strength")
        return " and ".join(reasons) or "joints that are open may slip"

    def describe(self):
        """The entries of run.json: a dict."""
        told = self.joints()
        return {
            "factor": self.factor,
            "exact": self.exact,
            "open_joints_slip": self.weaker,
            "dilates": self.dilates,
            "joints": {
                kind: int((told == kind).sum())
                for kind in ("opens", "slides", "crushes")
            },
            "powers": {
                k: v / (self.powers["loads"] or 1) for k, v in self.powers.items()
            },
            "facets": 0 if self.assembly.plane else FACETS,
            "facet_error": self.facetError,
        }

    # -- files ----------------------------------------------------------------------------------------------------

    def frames(self):
        """The mechanism as frames of blocks and joints, as :func:`masonry.frames.readFrame` gives those of a run.

        It is scaled so that the corner that moves most moves by :data:`SHOWN` of the structure's size.
        """
        a = self.assembly
        sizes = [len(c) for c in a.corners]
        numbers, points = np.repeat(np.arange(len(sizes)), sizes), np.concatenate(a.corners)  # fmt: skip
        moved = self.motion(numbers, points)
        far = np.linalg.norm(moved, axis=1).max() or 1.0
        scale = SHOWN * np.ptp(points, axis=0).max() / far
        blocks = {
            "points": points,
            "displacement": scale * moved,
            "body": np.array(a.ids),
            "cells": np.split(np.arange(len(points)), np.cumsum(sizes)[:-1]),
        }
        told, count = self.joints(), len(a.pairs)
        opening, slide = self.jumps(a.contacts.joint, a.contacts.at)
        widest, closest, along = np.zeros(count), np.zeros(count), np.zeros((count, 3))
        np.maximum.at(widest, a.contacts.joint, opening)
        np.maximum.at(closest, a.contacts.joint, -opening)
        order = np.argsort(np.linalg.norm(slide, axis=1))
        along[a.contacts.joint[order]] = slide[
            order
        ]  # the fastest of a joint is the last
        sizes = [len(p) for p in a.polygons]
        corners, which = np.concatenate(a.polygons), np.repeat(np.arange(count), sizes)
        one, two = a.pairs[which].T
        middle = 0.5 * (self.motion(one, corners) + self.motion(two, corners))
        opens, slides = told == "opens", told == "slides"
        joints = {
            "points": corners,
            "displacement": scale * middle,
            "cells": np.split(np.arange(len(corners)), np.cumsum(sizes)[:-1]),
            "bodies": np.array(a.ids)[a.pairs],
            "normal": a.normals,
            "area": np.bincount(a.joint, a.areas, count),
            "opening": np.where(opens, scale * widest, 0),
            "slide": np.where(slides[:, None], scale * along, 0),
            "crushing": np.where(told == "crushes", scale * closest, 0),
            "damage_tension": opens.astype(float),
            "damage_shear": slides.astype(float),
        }
        return blocks, joints

    def save(self, directory):
        """Write the mechanism for ParaView: ``mechanism_blocks.vtu`` and ``mechanism_joints.vtu``."""
        from meshio import Mesh
        from scipy.spatial import ConvexHull

        blocks, joints = self.frames()
        faces, body = [], []
        for number, nodes in zip(blocks["body"], blocks["cells"]):
            hull = ConvexHull(blocks["points"][nodes])
            faces.append(nodes[hull.simplices])
            body += [number] * len(hull.simplices)
        Mesh(
            blocks["points"],
            [("triangle", np.concatenate(faces))],
            point_data={"displacement": blocks["displacement"]},
            cell_data={"body": [np.array(body)]},
        ).write(os.path.join(directory, MECHANISM[0]))
        fans, owner = [], []
        for number, nodes in enumerate(joints["cells"]):
            for second, third in zip(nodes[1:], nodes[2:]):
                fans.append((nodes[0], second, third))
                owner.append(number)
        told = ("opening", "slide", "crushing", "normal", "damage_tension", "damage_shear")  # fmt: skip
        Mesh(
            joints["points"],
            [("triangle", np.array(fans))],
            point_data={"displacement": joints["displacement"]},
            cell_data={name: [joints[name][owner]] for name in told},
        ).write(os.path.join(directory, MECHANISM[1]))

    def draw(self, path, title="", parts=None, views=None):
        """Draw the mechanism in the style of the crack figure.

        :param path: of the picture
        :param title: above it
        :param parts: dict of name -> ids of bodies, a panel each; None: all in one
        :param views: directions of sight by part, as of run.json
        """
        mechanism(path, *self.frames(), title, parts, views)


# -- the scene in YADE ------------------------------------------------------------------------------------------------


def read():
    """The blocks and joints of the scene in YADE, as they stand now: an :class:`Assembly`.

    Joints that have opened are taken as closed, so after supports have moved far the answer is one for other joints.

    :raises Refused: if there are no joints
    """
    blocks = list(O.bodies)
    numbers = {body.id: number for number, body in enumerate(blocks)}
    joints = [i for i in O.interactions if type(i.geom).__name__ == "MasonryJointGeom"]
    if not joints:
        raise Refused("limit analysis: the scene has no joints; connect() makes them")
    joints.sort(key=lambda i: (i.id1, i.id2))
    geoms = [i.geom for i in joints]
    pairs = np.array([[numbers[i.id1], numbers[i.id2]] for i in joints])
    points = [_rows(g.centres) for g in geoms]
    polygons = [_rows(g.polygon) for g in geoms]
    areas = [a for g in geoms for a in g.areas]
    place = _Placement(blocks)
    joint = np.repeat(np.arange(len(joints)), [len(p) for p in points])
    corner = np.repeat(np.arange(len(joints)), [len(p) for p in polygons])
    normals = place.turned(pairs, np.array(_rows([g.normal for g in geoms])))
    moved = place.moved(pairs[corner], np.concatenate(polygons))
    strengths = np.array([_strengths(i.phys.joint) for i in joints], float).T
    return Assembly(
        centres=place.now,
        masses=np.array([b.state.mass for b in blocks], float),
        held=_held(blocks),
        pairs=pairs,
        normals=normals / np.linalg.norm(normals, axis=1)[:, None],
        joint=joint,
        points=place.moved(pairs[joint], np.concatenate(points)),
        areas=np.array(areas, float),
        tension=strengths[0],
        cohesion=strengths[1],
        friction=strengths[2],
        crushing=strengths[3],
        elastic=strengths[4] > 0,
        ids=[b.id for b in blocks],
        polygons=np.split(moved, np.cumsum([len(p) for p in polygons])[:-1]),
        corners=[_corners(b) for b in blocks],
    )


def _rows(vectors):
    """Vectors of YADE as a list of (x, y, z)."""
    return [(v[0], v[1], v[2]) for v in vectors]


def _held(blocks):
    """Whether each block cannot move along x, y, z or turn about them (n, 6). The nodes of deformable units are held in their
    engine, not in the States of their bodies."""
    blocked = [b.state.blockedDOFs for b in blocks]
    numbers = {body.id: number for number, body in enumerate(blocks)}
    for engine in O.engines:
        if type(engine).__name__ == "MasonryZones":
            along = engine.blocked
            about = "".join(axis.upper() for axis in "xyz" if set(along) - {axis})
            for body in engine.bodies:
                blocked[numbers[body]] = along + about
    return np.array([[axis in axes for axis in AXES] for axes in blocked])


class _Placement:
    """Where blocks are now, and how they have turned since the reference state."""

    def __init__(self, blocks):
        states = [b.state for b in blocks]
        self.was = np.array(_rows([s.refPos for s in states]))
        self.now = np.array(_rows([s.pos for s in states]))
        self.turns = np.array(
            [_matrix(s.ori * s.refOri.conjugate()) for s in states], float
        )

    def turned(self, pairs, vectors):
        """The mean of directions fixed to both blocks of pairs (k, 2), from the reference state (k, 3)."""
        turn = lambda side: np.einsum("kij,kj->ki", self.turns[pairs[:, side]], vectors)
        return 0.5 * (turn(0) + turn(1))

    def moved(self, pairs, points):
        """The mean of points fixed to both blocks of pairs (k, 2), from the reference state (k, 3)."""
        ways = []
        for block in pairs.T:
            arms = points - self.was[block]
            ways.append(np.einsum("kij,kj->ki", self.turns[block], arms) + self.now[block])  # fmt: skip
        return 0.5 * (ways[0] + ways[1])


def _matrix(turn):
    """The rotation matrix (3, 3) of a quaternion of YADE."""
    w, x, y, z = turn[3], turn[0], turn[1], turn[2]
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _strengths(p):
    """Tensile strength, cohesion, friction, compressive strength, and whether a joint never gives way."""
    values = (
        p.tensileStrength,
        max(p.cohesion, p.residualCohesion),
        max(p.friction, p.residualFriction),
    )
    if p.elastic or not p.cap:
        return *values, math.inf, p.elastic
    # of eq. (8c) without shear: Cnn σ² - Cn σ = fc²
    half = p.capLinear / (2 * p.capNormal)
    crushing = half + math.sqrt(half * half + p.compressiveStrength**2 / p.capNormal)
    return *values, crushing, p.elastic


def _corners(body):
    """Corners of a block as it stands now (k, 3) [m]."""
    turn = _matrix(body.state.ori)
    return np.array(_rows(body.shape.v)) @ turn.T + np.array(body.state.pos)
