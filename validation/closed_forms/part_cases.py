# SPDX-License-Identifier: GPL-2.0-or-later
"""What a building has besides bricks: ties, springs, beams, floors and fibre layers."""

import numpy as np
from cases import case
from masonry import bricks, materials
from masonry.units import GRAVITY
from structures import rigidlike, sceneOf
from yade import O

PARTS = "Ties, springs, beams, floors and fibre layers"
STATICS, BEAM = "statics", "beam with shear deformation"
WIDTH, DEPTH, HEIGHT = 0.4, 0.3, 1.6  # of a block [m]
WEIGHT = WIDTH * DEPTH * HEIGHT * 2600 * GRAVITY  # [N]


def tall():
    """A scene of a tall block that cannot slide."""
    return sceneOf(bricks.stack(1, (WIDTH, DEPTH, HEIGHT)), rigidlike(5.0))


def at(height, x=WIDTH / 2):
    return (x, DEPTH / 2, height)


@case(
    PARTS,
    "horizontal acceleration [g] of a tall block with a tie that yields at 500 N",
    STATICS + ": a W h / 2 = W b / 2 + T t",
    aim=0.01,
    quick=True,
)
def tie_rocking_block(quick):
    force, level = 500.0, 1.2
    with tall() as s:
        s.platen("bottom")
        s.handle(0, "top")
        s.tie(at(level), anchor=at(level, -3.0), stiffness=1e7, strength=force)
        s.settle()
        s.accelerate(2.0, towards=(1, 0, 0))
        return (WEIGHT * WIDTH / 2 + force * level) / (WEIGHT * HEIGHT / 2), s.factor


@case(
    PARTS,
    "tie force [N] that holds an arch of 40 voussoirs on a support that can slide, t/R = 0.109",
    (
        "Cocchetti and Rizzi 2020: 0.621772 weight per length × R at the least thickness, many"
        " voussoirs"
    ),
    aim=0.01,
    quick=True,
)
def tie_of_an_arch(quick):
    thick, stones = 0.109, 40
    radius = 1 - thick / 2
    arch = bricks.Arch(thick, 0.3, stones, radius=radius)
    for x in (-thick, 2 * radius):
        arch += bricks.block((x, 0, -0.2), (x + thick, 0.3, 0), part="foot")
    with sceneOf(arch, rigidlike(0.9)) as s:
        s.hold(stones, name="left")
        s.hold(stones + 1, name="right", axes="zY")
        tie = s.tie(stones, stones + 1, stiffness=1e6)
        s.settle(longest=20)
        weight = 2600 * GRAVITY * thick * 0.3
        return 0.621772 * weight, tie.force


@case(
    PARTS,
    "stiffness [N/m] at 1.5 m of a block on a platen on springs along x and about y",
    STATICS + ": springs in series, less what weight that leans takes",
    aim=0.01,
    quick=True,
)
def springs_below_a_block(quick):
    along, about, level, below = 2e6, 3e6, 1.5, 0.2
    with tall() as s:
        base = s.platen("bottom", springs={"x": along, "Y": about}, height=below)
        top = s.handle(at(level), "top")
        s.load(top, (200.0, 0, 0))
        s.settle(longest=20)
        steel = O.bodies[base.body].state.mass * GRAVITY
        leaning = WEIGHT * (HEIGHT / 2 + below) + steel * below / 2
        flexible = 1 / along + (level + below) ** 2 / (about - leaning)
        measured = 200.0 / s.model.supports.moved(top)[0][0]
        # the block itself turns on its joint
        (joint,) = s.model.interactions
        turning = joint.phys.normalStiffness * DEPTH * WIDTH**3 / 12
        shearing = joint.phys.shearStiffness * WIDTH * DEPTH
        return 1 / (flexible + level**2 / turning + 1 / shearing), measured


LENGTH, YOUNG = 2.0, 10e9
WIDE, HIGH = 0.1, 0.2  # section of the beams [m]
INERTIA, AREA, SHEAR = WIDE * HIGH**3 / 12, WIDE * HIGH, YOUNG / 2.4


def sag(pieces, held, loaded):
    """Sag [m] of a piece of a beam under a force of 1 kN, and the distance of the middles of the
    outer pieces [m]."""
    beam = bricks.Beam((0, 0, 0), LENGTH, WIDE, HIGH, pieces=pieces)
    stones = materials.dry(0.6).withBeam(beam, young=YOUNG, density=500)
    with sceneOf(beam, stones, gravity=0.0) as s:
        for piece, axes in held:
            s.hold(piece, name=f"end{piece}", axes=axes)
        piece = s.handle(loaded, "loaded")
        s.load(piece, (0, 0, -1e3))
        s.settle()
        return -s.model.supports.moved(piece)[0][2], LENGTH * (1 - 1 / pieces)


def bent(span, bending, shearing):
    """F l³ / (bending E I) + F l / (shearing 5/6 G A) for a force of 1 kN [m]."""
    return 1e3 * (
        span**3 / (bending * YOUNG * INERTIA) + span / (shearing * 5 / 6 * SHEAR * AREA)
    )


@case(PARTS, "sag [m] of a cantilever, Beam of 33 pieces", BEAM, aim=0.01, quick=True)
def beam_cantilever(quick):
    found, span = sag(33, [(0, "xyzXYZ")], 32)
    return bent(span, 3, 1), found


@case(PARTS, "sag [m] of a simply supported beam, 33 pieces", BEAM, aim=0.01, quick=True)
def beam_supported(quick):
    found, span = sag(33, [(0, "xz"), (32, "z")], 16)
    return bent(span, 48, 4), found


@case(PARTS, "the same of 9 pieces", BEAM, aim=0.02, quick=True)
def beam_supported_9(quick):
    found, span = sag(9, [(0, "xz"), (8, "z")], 4)
    return bent(span, 48, 4), found


@case(PARTS, "sag [m] of a beam with fixed ends, 33 pieces", BEAM, aim=0.01, quick=True)
def beam_fixed(quick):
    found, span = sag(33, [(0, "xyzXYZ"), (32, "xyzXYZ")], 16)
    return bent(span, 192, 4), found


@case(
    PARTS,
    (
        "share of the stiffer of two shear walls of 3 and 1 MN/m, floor with G t = 2 MN/m, force at"
        " a third"
    ),
    STATICS + ": springs in series and side by side",
    aim=0.01,
    quick=True,
)
def floor_shares(quick):
    strips, length, pitch, shear, one, two = 9, 4.0, 0.5, 2e6, 3e6, 1e6
    floor = bricks.Floor((0, 0, 3), length, strips * pitch, 0.2, strips=strips)
    stones = materials.dry(0.6).withFloor(floor, shear=shear, mass=100)
    with sceneOf(floor, stones, plane=False, gravity=0.0) as s:
        for n in range(strips):
            s.hold(n, name=f"strip{n}", axes="zyXYZ")
        first = s.spring(0, stiffness=(one, 0, 0), name="one")
        s.spring(strips - 1, stiffness=(two, 0, 0), name="two")
        s.load(s.handle(3, "pushed"), (1e3, 0, 0))
        s.settle(longest=20)
        panel = lambda n: shear * length / (n * pitch)
        to1, to2 = 1 / (1 / one + 1 / panel(3)), 1 / (1 / two + 1 / panel(5))
        return to1 / (to1 + to2), -1e-3 * first.force[0]


@case(
    PARTS,
    "horizontal acceleration [g] at which joists slip, μ = 0.3",
    STATICS,
    aim=0.01,
    quick=True,
)
def floor_slips(quick):
    friction = 0.3
    floor = bricks.Floor((0, 0, 0.5), 2.0, 1.0, 0.2, strips=4)
    walls = bricks.block((0, 0, 0), (0.2, 1.0, 0.5)) + bricks.block((1.8, 0, 0), (2.0, 1.0, 0.5))
    stones = materials.dry(5.0).withFloor(floor, 1e7, mass=200, bearing=friction)
    with sceneOf(walls + floor, stones, plane=False) as s:
        for n in (0, 1):
            s.hold(n, name=f"wall{n}")
        s.watch(3, name="joist")
        s.settle()
        s.accelerate(0.6, towards=(1, 0, 0))
        return friction, s.factor


@case(
    PARTS,
    "moment [N m] of a dry section with a fibre layer that yields at 4 kN/m",
    STATICS + ": W d / 2 + f b d, the section pressed at its edge",
    aim=0.01,
    quick=True,
)
def overlay_moment(quick):
    width, depth, height, strength = 0.5, 0.2, 0.8, 4e3
    blocks = bricks.stack(2, (width, depth, height))
    with sceneOf(blocks, rigidlike(5.0, 1e12), plane=False, rate=5) as s:
        s.platen("bottom")
        s.hold(0, name="foot")
        s.overlay((0, -1, 0), stiffness=1e7, strength=strength, gauge=0.2)
        top = s.handle((width / 2, depth / 2, 2 * height), "top")
        s.settle()
        s.push(top, 3.0, direction=(0, 1, 0))
        weight = width * depth * height * 2600 * GRAVITY
        moved = np.array(s.results.column("displacement_mm"))
        force = np.array(s.results.column("top_shear_kN"))
        swings = force[moved > 1]  # about its mean
        return weight * depth / 2 + strength * width * depth, 1e3 * swings.mean() * height


@case(
    PARTS,
    "stiffness [N/m] of a portal of beams that is fixed at its feet",
    "slope deflection: 24 E I / h³ (6 k + 1) / (6 k + 4), k = h / L",
    aim=0.01,
    quick=True,
)
def portal(quick):
    span, height, deep, pieces = 3.0, 2.0, 0.05, 16
    column = bricks.Beam((0, 0, 0), height, WIDE, deep, pieces=pieces, name="frame").turned(
        -90, "y"
    )
    beam = bricks.Beam((-deep, 0, height), span + deep, WIDE, deep, pieces=61, name="frame")
    frame = column + column.moved(dx=span) + beam
    stones = materials.dry(0.6).withBeam(frame, young=YOUNG, density=500)
    with sceneOf(frame, stones, gravity=0.0) as s:
        s.hold(0, name="left")
        s.hold(pieces, name="right")
        pushed = s.handle(2 * pieces + 30, "pushed")
        s.load(pushed, (10.0, 0, 0))
        s.settle(longest=20)
        # from the middle of the piece that is held to the axis of the beam
        clear = height - height / pieces / 2 + deep / 2
        k, rigidity = clear / span, YOUNG * WIDE * deep**3 / 12
        expected = 24 * rigidity / clear**3 * (6 * k + 1) / (6 * k + 4)
        return expected, 10.0 / s.model.supports.moved(pushed)[0][0]


@case(
    PARTS,
    "stiffness [N/m] of a hinged frame with an infill that touches it without bond, μ = 0",
    STATICS
    + ": t h / 12 · k1 k2 L³ / (k1 h³ + k2 L³), infill against columns (k1) and beams (k2) over"
    " half a side each",
    aim=0.01,
    quick=True,
)
def infill(quick):
    length, height, thick, bar, force = 2.0, 1.5, 0.2, 0.2, 1e3
    block = lambda low, high: bricks.block((low[0], 0, low[1]), (high[0], thick, high[1]))
    panel = block((0, 0), (length, height))
    beams = block((0, -bar), (length, 0)) + block((0, height), (length, height + bar))
    columns = block((-bar, 0), (0, height)) + block((length, 0), (length + bar, height))
    with sceneOf(panel + beams + columns, rigidlike(0.0, 1e9), gravity=0.0) as s:
        s.hold(1, name="foot")
        for x in (0, length):
            for z, beam in ((0, 1), (height, 2)):  # a hinge of a column and a beam
                s.spring((x, thick / 2, z), beam, stiffness=(1e12, 0, 1e12))
        top = s.handle(2, "top")
        s.load(top, (force, 0, 0))
        s.settle(longest=20)
        found = {}
        for one in s.model.interactions:
            found[
                sum(body in s.model.ids[1:3] for body in (one.id1, one.id2))
            ] = one.phys.normalStiffness
        k1, k2 = found[0], found[1]
        expected = (
            thick * height / 12 * k1 * k2 * length**3 / (k1 * height**3 + k2 * length**3)
        )
        return expected, force / s.model.supports.moved(top)[0][0]
