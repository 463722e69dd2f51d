# SPDX-License-Identifier: GPL-2.0-or-later
"""Dry walls in and out of their plane, single blocks and stacks, panels with overburden, piers that
are pushed."""

from cases import between, case
from masonry import addBlock, bricks, connect, engines
import masonry_limit as limit
from structures import (
    DAMPING,
    G,
    bound,
    box,
    dry,
    elastic,
    falls,
    fix,
    leans,
    mat,
    rigidlike,
    sceneOf,
)
from yade import O, Vector3

WALLS, BLOCKS = "Dry walls", "Blocks and stacks"
PANELS, PIERS = "Panels out of their plane", "Piers pushed in their plane"
LIMIT = "limit analysis of these blocks (`masonry_limit`)"
ELEMENTARY = "elementary"


# -- walls in their plane --------------------------------------------------------------------------


def wall(courses, units, friction, stiffness=1e11):
    """A scene of a wall in running bond, units of 0.2 × 0.1 × 0.1 m, on a platen."""
    blocks = bricks.Wall(0.2 * units, 0.1 * courses, unit=(0.2, 0.1, 0.1), halves=False)
    return sceneOf(blocks, rigidlike(friction, stiffness))


def looseHeads():
    """Horizontal acceleration of limit analysis if head joints had no friction [g].

    Associated flow lets a head joint slide only if it opens by the friction coefficient times the
    slide. In the wedge over a stepped crack head joints open by less, and carry nothing, since they
    are open.
    """
    assembly = limit.read()
    assembly.friction[abs(assembly.normals[:, 2]) < 0.5] = 0
    return bound(assembly=assembly).factor


def leaning(courses, units, friction, quick, expected=looseHeads, spread=0.15):
    """Horizontal acceleration of a function that reads the scene, and bracket of the engine [g]."""
    with wall(courses, units, friction) as s:
        s.platen("bottom")
        s.settle()
        value = expected()
        return value, between(leans(s), value, 0.02, quick, spread, within=0.005)


LOOSE = LIMIT + ", head joints without friction"


@case(
    WALLS,
    "horizontal acceleration [g], 6 × 3 units, μ = 0.65",
    LOOSE + "; tipping wedge of the upper five courses, by hand",
    aim=0.02,
    quick=True,
)
def wall_6x3(quick):
    return leaning(6, 3, 0.65, quick)


def wedge(courses):
    """Factor of the wedge over a stepped crack that tips about its lower corner [g], by hand.

    Its n-th course from below has n half units of 0.1 m: its weight is as n, its arm 0.05·n about
    the corner, and its middle 0.1·n − 0.05 above it. All joints of the crack are open, so friction
    takes no part.
    """
    lengths = range(1, courses + 1)
    arms = sum(n * 0.05 * n for n in lengths)
    return arms / sum(n * (0.1 * n - 0.05) for n in lengths)


@case(
    WALLS,
    "horizontal acceleration [g], 6 × 3 units, μ = 2",
    "tipping wedge of the upper five courses, by hand",
    aim=0.02,
)
def wall_6x3_rough(quick):
    return leaning(6, 3, 2.0, quick, lambda: wedge(5))


@case(WALLS, "horizontal acceleration [g], 10 × 5 units, μ = 0.65", LOOSE, aim=0.02)
def wall_10x5(quick):
    return leaning(10, 5, 0.65, quick)


ASSOCIATED = (
    "associated flow forbids the stepped crack, whose head joints open by less than friction times"
    " slide; the engine is right, and the value an upper bound that is not met"
)


@case(WALLS, "the same against associated flow", LIMIT, aim=0.02, misses=ASSOCIATED)
def wall_10x5_associated(quick):
    return leaning(10, 5, 0.65, quick, lambda: bound().factor)


@case(WALLS, "horizontal acceleration [g], 10 × 5 units, μ = 0.40 (slides)", "μ", aim=0.02)
def wall_10x5_slides(quick):
    return leaning(10, 5, 0.40, quick, lambda: 0.4)


@case(
    WALLS,
    "tan of the tilt at which 10 × 5 units, μ = 0.65, leave rest",
    LOOSE,
    aim=0.02,
)
def wall_10x5_tilt(quick):
    with wall(10, 5, 0.65) as s:
        s.platen("bottom")
        s.settle()
        expected = looseHeads()
        s.tilt(32, rate=4 if quick else 2)
        return expected, s.factor


@case(WALLS, "horizontal acceleration [g], 20 × 10 units, μ = 0.65", LOOSE, aim=0.02)
def wall_20x10(quick):
    return leaning(20, 10, 0.65, quick, spread=0.08)


@case(
    WALLS,
    "acceleration out of plane [g], 4 courses of bricks 0.1 m thick",
    "t/h",
    aim=0.02,
    quick=True,
)
def wall_out_of_plane(quick):
    thickness, courses = 0.1, 4
    blocks = bricks.Wall(0.4, 0.1 * courses, unit=(0.2, thickness, 0.1), halves=False)
    with sceneOf(blocks, rigidlike(), plane=False) as s:
        s.platen("bottom")
        s.settle()
        expected = thickness / (0.1 * courses)
        carries = leans(s, (0, 1, 0))
        return expected, between(carries, expected, 0.02, quick, within=0.005)


# -- blocks ----------------------------------------------------------------------------------------

WIDTH, HEIGHT, DEPTH = 0.25, 1.0, 0.4


def stack(blocks, axis=0, mortar=False, inPlane=False, stiffness=1e10, points=None):
    """A stack of 0.25 × 1 m on a fixed block. ``mortar``: its own joints never give way."""
    size = [DEPTH, DEPTH, HEIGHT / blocks]
    size[axis] = WIDTH
    ground = mat(jointSet="ground")
    fix(box((0, 0, -0.2), (size[0], size[1], 0.2), ground))
    for n in range(blocks):
        box((0, 0, n * size[2]), size, mat(), inPlane=inPlane)
    bed = elastic(stiffness, name="bed") if mortar else dry(stiffness)
    engines(
        [dry(stiffness, jointSet="ground"), bed],
        damping=DAMPING,
        dampingKind="local",
        subcontacts=points,
    )
    connect()


def tips(share, blocks=1, axis=0, mortar=False, inPlane=False, **kw):
    """Whether a stack falls under this share of the acceleration g·b/h at which it tips."""
    stack(blocks, axis, mortar, inPlane, **kw)
    return falls(share * G * WIDTH / HEIGHT * Vector3.Unit(axis), beyond=0.005)


def tipping(quick, **kw):
    """Acceleration b/h at which a stack tips, and bracket of the engine [g]."""

    def stands(factor):
        O.reset()
        return not tips(factor * HEIGHT / WIDTH, **kw)

    expected = WIDTH / HEIGHT
    return expected, between(stands, expected, 0.01, quick, 0.05, 0.005)


@case(
    BLOCKS,
    "acceleration [g] at which a block tips in the plane",
    "b/h",
    aim=0.01,
    quick=True,
)
def block_tips(quick):
    return tipping(quick, inPlane=True)


@case(
    BLOCKS,
    "acceleration [g] at which a stack of four tips as one, in space",
    "b/h",
    aim=0.01,
)
def stack_tips(quick):
    return tipping(quick, blocks=4, axis=1)


def tiltedUntilRest(blocks, friction, degrees, quick, stiffness=1e11, words=()):
    """tan of the tilt at which blocks on a platen leave rest."""
    with sceneOf(blocks, rigidlike(friction, stiffness), words) as s:
        s.platen("bottom")
        s.settle()
        s.tilt(degrees, rate=4 if quick else 2)
        return s.factor


@case(
    BLOCKS,
    "tan of the tilt at which a block of 0.25 × 0.5 m tips",
    "b/h",
    aim=0.02,
    quick=True,
)
def block_tilts(quick):
    block = bricks.stack(1, (0.25, 0.25, 0.5))
    return 0.5, tiltedUntilRest(block, 5, 40, quick)


@case(
    BLOCKS,
    "tan of the tilt at which a block slides, μ = 0.4",
    "μ",
    aim=0.01,
    absolute=True,
    quick=True,
)
def block_slides(quick):
    block = bricks.stack(1, (0.4, 0.3, 0.2))
    return 0.4, tiltedUntilRest(block, 0.4, 35, quick)


@case(
    BLOCKS,
    "tan of the tilt at which a block slides, μ = 0.7",
    "μ",
    aim=0.01,
    absolute=True,
)
def rough_block_slides(quick):
    block = bricks.stack(1, (0.5, 0.3, 0.2))
    return 0.7, tiltedUntilRest(block, 0.7, 50, quick)


@case(
    BLOCKS,
    "the same as for μ = 0.4, deformable block",
    "μ",
    aim=0.01,
    absolute=True,
    quick=True,
)
def deformable_block_slides(quick):
    block = bricks.stack(1, (0.4, 0.3, 0.2))
    words = ["--blocks", "deformable", "--divisions", "1"]
    return 0.4, tiltedUntilRest(block, 0.4, 35, quick, 1e10, words)


@case(
    BLOCKS,
    "tan of the tilt at which a deformable block of 0.25 × 0.5 m tips",
    "b/h",
    aim=0.02,
)
def deformable_block_tilts(quick):
    block = bricks.stack(1, (0.25, 0.25, 0.5))
    words = ["--blocks", "deformable", "--divisions", "1"]
    return 0.5, tiltedUntilRest(block, 5, 40, quick, 1e10, words)


PRISM = 0.3, 0.6  # side and height of a prism on a triangle [m]


def prismTips(share):
    """Whether a prism on an equilateral triangle falls under this share of the acceleration at
    which it tips."""
    side, height = PRISM
    tall = side * 3**0.5 / 2
    plan = [(0, 0), (side, 0), (side / 2, tall)]
    prism = lambda z0, z1: [(x, y, z) for x, y in plan for z in (z0, z1)]
    fix(addBlock(prism(-0.2, 0), mat()))
    addBlock(prism(0, height), mat())
    engines([dry()], damping=DAMPING, dampingKind="local")
    connect()
    return falls(Vector3(0, -share * G * prismLimit(), 0), beyond=0.005)


def prismLimit():
    """Its centre stands over that of the triangle, a third of its height away from the edge [g]."""
    side, height = PRISM
    return (side * 3**0.5 / 6) / (height / 2)


@case(
    BLOCKS,
    "acceleration [g] at which a prism on a triangle tips about its edge",
    ELEMENTARY,
    aim=0.02,
)
def prism_tips(quick):
    def stands(factor):
        O.reset()
        return not prismTips(factor / prismLimit())

    return prismLimit(), between(stands, prismLimit(), 0.02, quick, 0.05, 0.005)


# -- panels ----------------------------------------------------------------------------------------

SLENDER, COURSES = (0.1, 0.5, 0.2), 12  # a block of a strip [m], and their number
#: The closed form is of rigid blocks that turn about their edges: with 14 points where they open, a
#: strip on 2e11 Pa/m holds 8 to 11 % less.
EDGES = ["--points", "3"]


PLATEN = 0.02  # height of the platen on a strip [m]


def panelFactor(over, arm, guide):
    """Factor of a strip held at foot and top that cracks at the best of its bed joints [g], by
    virtual work.

    The lower part, a share x of the height h, turns by 1 about its foot. The upper one turns by φ
    the other way, so that the guide at the top stays where it is. The middle of the lower part
    rises by t/2, the crack by t, that of the upper part by t/2·φ more, and the load by ``arm``·t·φ
    more than the crack. With a guide at the top this is (t/h)/x·(2 + 2·(O/W)·(1 + arm·x/(1 - x))).

    :param over: load on the top over weight [-]
    :param arm: distance of the load from the edge about which the top turns, over the thickness:
        0.5 in the middle, 1 at the far edge [-]
    :param guide: its height above the top [m]
    """
    t, h = SLENDER[0], COURSES * SLENDER[2]
    factors = []
    for x in (n / COURSES for n in range(1, COURSES)):
        upper = (1 - x) * h
        turned = x * h / (upper + guide)
        lifted = x * t / 2 + (1 - x) * (t + t / 2 * turned) + over * t * (1 + arm * turned)
        moved = x * x * h / 2 + (1 - x) * (x * h - turned * upper / 2)
        factors.append(lifted / moved)
    return min(factors)


def panel(over, quick, rotation, stiffness=2e11):
    """Factor of the closed form, and bracket of the engine [g], of a strip in the x-z plane."""
    blocks = bricks.stack(COURSES, SLENDER)
    with sceneOf(blocks, rigidlike(2, stiffness), EDGES) as s:
        s.platen("bottom")
        top = s.platen("top", rotation=rotation, guided="x", height=PLATEN)
        s.press(top, over * 2600 * G * COURSES * SLENDER[2])
        s.settle()
        # a platen that can turn is guided at its middle; one that cannot touches the strip at its
        # edge
        turns = rotation == "free"
        expected = panelFactor(over, *((0.5, PLATEN / 2) if turns else (1, 0)))
        return expected, between(leans(s), expected, 0.02, quick, within=0.005)


@case(
    PANELS,
    "acceleration [g], strip of 12 blocks, load in the middle, O = W",
    "virtual work, least over the bed joints",
    aim=0.02,
)
def panel_centre(quick):
    return panel(1.0, quick, "free")


@case(
    PANELS,
    "acceleration [g], strip of 12 blocks, load in the middle, O = 0.25 W",
    "virtual work, least over the bed joints",
    aim=0.02,
)
def panel_centre_light(quick):
    return panel(0.25, quick, "free")


@case(
    PANELS,
    "acceleration [g], strip of 12 blocks, load at the far edge, O = W",
    "virtual work, least over the bed joints",
    aim=0.02,
)
def panel_far_edge(quick):
    return panel(1.0, quick, "held")


@case(
    PANELS,
    "acceleration [g], strip of 12 blocks, free at the top",
    "t/h",
    aim=0.02,
    quick=True,
)
def panel_free(quick):
    with sceneOf(bricks.stack(COURSES, SLENDER), rigidlike(2, 2e11), EDGES) as s:
        s.platen("bottom")
        s.settle()
        expected = SLENDER[0] / (COURSES * SLENDER[2])
        return expected, between(leans(s), expected, 0.02, quick, within=0.005)


# -- piers -----------------------------------------------------------------------------------------


HIGH = 1.3  # of the push above the base: three blocks and the platen [m]


def pier(friction, rate, stress=2e5, until=3.0):
    """Mean shear force of a pier of three blocks in the second half of a push [N], and the mean
    displacement there [m].

    The blocks are 0.6 m long, 0.2 m thick and 0.4 m high. The platen on them can turn, and its load
    moves with it. The first peak of a push is one of inertia: the pier is so stiff that it begins
    to move at once.
    """
    with sceneOf(bricks.stack(3, (0.6, 0.2, 0.4)), rigidlike(friction), rate=rate) as s:
        s.platen("bottom")
        top = s.platen("top", rotation="free", height=HIGH - 1.2)
        s.press(top, stress)
        s.settle()
        s.push(top, until)
        rows = zip(s.results.column("displacement_mm"), s.results.column("base_shear_kN"))
        late = [row for row in rows if row[0] > until / 2]
        moved, shear = (sum(values) / len(late) for values in zip(*late))
        return 1e3 * shear, 1e-3 * moved


@case(
    PIERS,
    "shear force [N] at which a pressed pier rocks, at 2.3 mm",
    "N·(b/2 − u)/h, of the load and of the weight",
    aim=0.01,
    quick=True,
)
def pier_rocks(quick):
    normal, weight = 2e5 * 0.12, 2600 * G * 0.12 * 1.2
    shear, moved = pier(5, 20)
    moments = normal * (0.3 - moved) + weight * (0.3 - moved * 0.6 / HIGH)
    return moments / HIGH, shear


@case(
    PIERS,
    "shear force [N] at which the platen slides on a pressed pier, μ = 0.2",
    "μ·N",
    aim=0.01,
)
def pier_slides(quick):
    return 0.2 * 2e5 * 0.12, pier(0.2, 20)[0]
