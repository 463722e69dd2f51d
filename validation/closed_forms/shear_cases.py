# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic walls, arches and vaults of rigid units, which carry their elasticity in their joints,
against the same solid.

Rigid units are solved with the stiffness that the engine has: every block is moved and turned alone
by a little, and the forces on all blocks are read after a step. The solid is divided into bricks
with incompatible modes (Taylor, Beresford and Wilson 1976), which are exact in bending. Mortar is
nearly rigid.
"""

import math

import numpy as np
from cases import case
from masonry import MasonryMat, addBlock, bricks, connect, engines
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import eigsh, splu
from structures import elastic, mat, semicircle
from yade import O, Quaternion, Vector3
from scipy.integrate import trapezoid

UNIT = LENGTH, THICKNESS, COURSE = 0.22, 0.10, 0.081  # [m]
E, NU, RHO = 5e9, 0.16, 1800.0
G = E / (2 + 2 * NU)
SIDES = dict(bottom=(2, 0), top=(2, 1), left=(0, 0), right=(0, 1))  # axis, which end
SMALL = 1e-7  # [m, rad]
CORNERS = 2 * np.array(list(np.ndindex(2, 2, 2))) - 1


class Structure:
    """Stiffness ``K`` and masses ``M`` of points that have ``step`` degrees of freedom each, the
    first three of which are displacements; ``sides`` has the degrees of freedom on each side that
    is held."""

    def free(self, sides):
        free = np.ones(len(self.M), bool)
        for side in sides:
            free[self.sides[side]] = False
        return free

    def solved(self, free, force, moved=0.0):
        """Displacements under forces, while others are moved."""
        u = np.zeros(len(free)) + moved
        rest = (force - self.K @ u)[free]
        u[free] += splu(self.K[free][:, free].tocsc()).solve(rest)
        return u

    def shear(self):
        """Force that moves the top along x without turning it, over the way [N/m]."""
        moved, top = np.zeros(len(self.M)), self.sides["top"]
        moved[top[top % self.step == 0]] = 1
        u = self.solved(self.free(["bottom", "top"]), 0.0, moved)
        return u @ self.K @ u

    def frequency(self, sides, axis=1):
        """First frequency of motion along an axis [Hz]."""
        free = self.free(sides)
        root = diags(1 / np.sqrt(self.M[free]))
        squares, modes = eigsh(root @ self.K[free][:, free] @ root, k=4, sigma=0)
        along = self.M[free] * (np.flatnonzero(free) % self.step == axis)
        shares = np.abs((root @ modes).T @ along)
        return math.sqrt(min(squares[shares > 0.3 * max(shares)])) / (2 * math.pi)

    def twist(self, length, height):
        """Stiffness under forces across at the corners, two to and two fro [N/m]."""
        force = np.zeros(len(self.M))
        for x, z in np.ndindex(2, 2):
            place = x * length, THICKNESS / 2, z * height
            force += (-1) ** (x + z) * self.forceAt(place, (0, 1, 0))
        self.K = self.K + diags(1e-3 * self.M)  # nothing else holds it
        return 1 / (force @ self.solved(self.free([]), force))


class Units(Structure):
    """Rigid units in YADE. The sides are platens and units of kind "block", which are as stiff."""

    step = 6

    def __init__(self, blocks, sides=()):
        O.reset()
        unit, hard = MasonryMat(young=E, poisson=NU, density=RHO), mat()
        feet = [n for n, b in enumerate(blocks) if b.kind == "block"]
        bodies = [addBlock(b.corners, hard if b.kind == "block" else unit) for b in blocks]
        own = lambda n: 6 * n + np.arange(6)
        self.blocks, self.sides = blocks, {"feet": np.ravel([own(n) for n in feet])}
        for side in sides:
            axis, end = SIDES[side]
            low, high = np.array(blocks.low), np.array(blocks.high)
            at = (low, high)[end][axis]
            low[axis], high[axis] = at - 0.1 * (1 - end), at + 0.1 * end
            self.sides[side] = own(len(bodies))
            bodies.append(addBlock(bricks.boxCorners(low, high), hard))
        engines([elastic(1e14)], gravity=(0, 0, 0))
        connect()
        O.dt, rows, masses = 1e-12, [], []  # nothing moves in steps that read forces
        axes = Vector3.UnitX, Vector3.UnitY, Vector3.UnitZ
        for state in (O.bodies[b].state for b in bodies):
            for axis in axes:
                state.pos = state.refPos + SMALL * axis
                rows.append(_forces(bodies) / -SMALL)
            state.pos = state.refPos
            for axis in axes:
                state.ori = Quaternion(axis, SMALL) * state.refOri
                rows.append(_forces(bodies) / -SMALL)
            state.ori = state.refOri
            turn = np.array(state.ori.toRotationMatrix()).reshape(3, 3)
            masses += [state.mass] * 3 + list(turn**2 @ state.inertia)
        self.K, self.M = csr_matrix(np.array(rows)), np.array(masses)

    def forceAt(self, place, force):
        found, middles = np.zeros(len(self.M)), [np.mean(b.corners, 0) for b in self.blocks]
        n = int(np.argmin(np.abs(middles - np.array(place)).sum(1)))
        arm = np.subtract(place, O.bodies[n].state.pos)
        found[6 * n : 6 * n + 6] = [*force, *np.cross(arm, force)]
        return found


def _forces(bodies):
    O.step()
    return np.ravel([[*O.forces.f(b), *O.forces.t(b)] for b in bodies])


class Solid(Structure):
    """The same boxes without joints, in elements of about half a quarter of a brick by half a
    course."""

    step = 3

    def __init__(self, blocks, element=(LENGTH / 8, THICKNESS, COURSE / 2)):
        nodes, cells, parts = {}, [], {}
        for block in blocks:
            low, high = np.min(block.corners, 0), np.max(block.corners, 0)
            count = np.maximum(np.round((high - low) / element), 1).astype(int)
            size = (high - low) / count
            part = parts.setdefault(tuple(np.round(size, 9)), _element(size))
            for at in np.ndindex(*count):
                keys = np.round((low + (at + (CORNERS + 1) // 2) * size) * 1e6)
                numbers = np.array([nodes.setdefault(tuple(k), len(nodes)) for k in keys])
                own = (3 * numbers[:, None] + np.arange(3)).ravel()
                cells.append((own, part, math.prod(size)))
        self.points, self.M = 1e-6 * np.array(list(nodes)), np.zeros(3 * len(nodes))
        for own, _, volume in cells:
            self.M[own] += RHO * volume / 8
        rows = np.concatenate([np.repeat(own, 24) for own, *_ in cells])
        columns = np.concatenate([np.tile(own, 24) for own, *_ in cells])
        values = np.concatenate([part.ravel() for _, part, _ in cells])
        self.K = coo_matrix((values, (rows, columns)), [len(self.M)] * 2).tocsr()
        self.sides = {}
        for side, (axis, end) in SIDES.items():
            at = (blocks.low, blocks.high)[end][axis]
            on = np.flatnonzero(np.abs(self.points[:, axis] - at) < 2e-6)
            self.sides[side] = (3 * on[:, None] + np.arange(3)).ravel()

    def forceAt(self, place, force):
        n, found = np.argmin(np.abs(self.points - place).sum(1)), np.zeros(len(self.M))
        found[3 * n : 3 * n + 3] = force
        return found


def _element(size):
    """Stiffness of a brick with incompatible modes."""
    lame = E * NU / ((1 + NU) * (1 - 2 * NU))
    C = np.diag([lame + 2 * G] * 3 + [G] * 3)
    C[:3, :3] += lame * (1 - np.eye(3))
    K = np.zeros((33, 33))
    for at in CORNERS / math.sqrt(3):
        f, B = 0.5 * (1 + CORNERS * at), np.zeros((6, 11, 3))
        for a, b, c in (0, 1, 2), (1, 2, 0), (2, 0, 1):
            slopes = np.append(CORNERS[:, a] * f[:, b] * f[:, c], np.zeros(3)) / size[a]
            slopes[8 + a] = -4 * at[a] / size[a]
            B[a, :, a] = B[3 + a, :, b] = B[3 + c, :, c] = slopes
        B = B.reshape(6, 33)
        K += B.T @ C @ B * math.prod(size) / 8
    outer, inner = slice(24), slice(24, 33)
    return K[outer, outer] - K[outer, inner] @ np.linalg.solve(K[inner, inner], K[inner, outer])


# -- cases -----------------------------------------------------------------------------------------

PLANE = "Elastic walls, arches and vaults of rigid units"
SPACE = "Elastic walls of rigid units out of their plane"
SOLID = "the same solid by finite elements"


def add(name, group, what, source, aim, measure, misses=""):
    made = lambda quick: measure()
    made.__name__ = name
    case(group, what, source, aim=aim, misses=misses, quick=True)(made)


def wall(units, courses, **kw):
    """A wall that is so many units long, in running bond of whole bricks unless it is said
    otherwise."""
    kw = {"halves": False, "unit": UNIT, **kw}
    return bricks.Wall(units * LENGTH, courses * COURSE, **kw)


def shear(blocks):
    return Solid(blocks).shear(), Units(blocks, ["bottom", "top"]).shear()


def frequency(blocks, sides, axis=1):
    solid = Solid(blocks, (LENGTH / 4, THICKNESS / 2, COURSE))
    return solid.frequency(sides, axis), Units(blocks, sides).frequency(sides, axis)


def crown(blocks, thickness, width):
    """Stiffness of a semicircle of radius 1 m under a force at its crown [N/m]: of a curved beam,
    and of its units."""
    a = np.linspace(0, math.pi / 2, 2001)
    c, s, none = np.cos(a), np.sin(a), 0 * a
    # moment, normal and shear force at an angle from the crown: of the moment, the thrust and half
    # of the force there
    forces = np.array([[none + 1, 1 - c, -s], [none, -c, -s], [none, s, -c]])
    area = thickness * width
    soft = 1 / np.array([E * area * thickness**2 / 12, E * area, G * area / 1.2])
    C = trapezoid(np.einsum("iaf,i,ibf->abf", forces, soft, forces), a)
    half = C[2, 2] - C[2, :2] @ np.linalg.solve(C[:2, :2], C[:2, 2])
    units, force = Units(blocks), 0
    middles = [np.mean(b.corners, 0) for b in blocks]
    for block, middle in zip(blocks, middles):
        if middle[2] > max(m[2] for m in middles) - 1e-6:
            share = np.ptp(block.corners, 0)[1] / width
            force = force + units.forceAt(middle, (0, 0, -share))
    return 2 / half, 1 / (force @ units.solved(units.free(["feet"]), force))


def vault():
    found = bricks.BarrelVault(0.15, 1.2, 27, rows=4, radius=0.925)
    for x in (-0.15, 1.85):
        found += bricks.block((x, 0, -0.2), (x + 0.15, 1.2, 0))
    return crown(found, 0.15, 1.2)


def twist(halves):
    """Stiffness in twist over that of the solid [-]: of rigid blocks in a large plate, and of
    these."""
    blocks, size = wall(5, 12, halves=halves), (5 * LENGTH, 12 * COURSE)
    solid = Solid(blocks, (LENGTH / 4, THICKNESS / 2, COURSE)).twist(*size)
    b, s = LENGTH / 2, 0.5 if halves else 0.82
    expected = (2 + (b**2 + COURSE**2) / THICKNESS**2) / (4 * s)
    if not halves:
        expected += E / G * (b / COURSE) ** 2 / 4
    return expected, Units(blocks).twist(*size) / solid


HOLE = bricks.Opening(2 * LENGTH, 3 * COURSE, 2 * LENGTH, 7 * COURSE)
WYTHES = dict(unit=(LENGTH, 0.102, COURSE), wythes=2)
FLEMISH, ENGLISH = dict(bond="flemish", **WYTHES), dict(bond="english", **WYTHES)
HALVES, STACK = dict(halves=True), dict(bond="stack")
for name, what, aim, made in (
    ("whole", "4 × 10 whole bricks", 0.04, wall(4, 10)),
    ("halves", "the same in halves", 0.04, wall(4, 10, **HALVES)),
    ("slender", "1 × 20 whole bricks", 0.04, wall(1, 20)),
    ("stack", "stack of 10", 0.04, wall(1, 10, **STACK)),
    ("unbonded", "two stacks of 20 side by side", 0.04, wall(2, 20, **STACK)),
    ("opening", "6 × 14 whole bricks, an opening", 0.1, wall(6, 14, openings=[HOLE])),
    ("flemish", "3 × 8 whole bricks in Flemish bond", 0.04, wall(3, 8, **FLEMISH)),
    ("flemish_halves", "the same in halves", 0.04, wall(3, 8, **HALVES, **FLEMISH)),
    ("english", "3 × 8 whole bricks in English bond", 0.04, wall(3, 8, **ENGLISH)),
):
    what = f"force over way of the top, which does not turn, {what} [N/m]"
    add(f"shear_{name}", PLANE, what, SOLID, aim, lambda w=made: shear(w))

what = "first frequency in the plane, 4 × 10 whole bricks, free at the top [Hz]"
measure = lambda: frequency(wall(4, 10), ["bottom"], 0)
add("frequency_plane", PLANE, what, SOLID, 0.04, measure)
what, curved = "force over sag of the crown, t/R = 0.15,", "curved beam that shears"
measure = lambda: crown(semicircle(27, 0.15), 0.15, 0.3)
add("crown_arch", PLANE, f"{what} semicircle of 27 [N/m]", curved, 0.04, measure)
what += " vault of 27 staggered courses [N/m]"
add("crown_vault", PLANE, what, curved, 0.04, vault)

TURNED = "units that overlap can bend along the courses only if they turn on each other's beds"
for name, what, aim, made, sides, misses in (
    ("up", "3 × 12 whole bricks, free at the top", 0.04, wall(3, 12), ["bottom"], ""),
    (
        "along",
        "6 × 8 in halves, held at an end",
        0.04,
        wall(6, 8, **HALVES),
        ["left"],
        "",
    ),
    ("along_whole", "the same of whole bricks", 0.04, wall(6, 8), ["left"], TURNED),
    (
        "panel",
        "6 × 12 in halves, four sides held",
        0.1,
        wall(6, 12, **HALVES),
        SIDES,
        "",
    ),
    ("panel_whole", "the same of whole bricks", 0.1, wall(6, 12), SIDES, ""),
    (
        "panel_flemish",
        "the same in Flemish bond",
        0.1,
        wall(6, 12, **FLEMISH),
        SIDES,
        "",
    ),
):
    what, measure = f"first frequency, {what} [Hz]", lambda w=made, s=sides: frequency(w, s)
    add(f"frequency_{name}", SPACE, what, SOLID, aim, measure, misses)

what = "stiffness in twist over that of the solid, 5 × 12"
slips = "(2 + (b² + h²)/t²)/4s, b = l/2"
measure = lambda: twist(True)
add("twist_halves", SPACE, f"{what} in halves [-]", f"{slips}, s = 1/2", 0.04, measure)
beds = f"{slips}, s = 0.82, and (E/G)(b/h)²/4"
measure = lambda: twist(False)
add("twist_whole", SPACE, f"{what} whole bricks [-]", beds, 0.04, measure)
