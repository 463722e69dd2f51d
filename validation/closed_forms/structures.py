# SPDX-License-Identifier: GPL-2.0-or-later
"""Small structures in YADE that closed forms speak of, and whether they stand.

Some are built body by body with :mod:`masonry.model`, for single blocks and joints; others are a
:class:`masonry.Scene`.
"""

import contextlib
import tempfile

import numpy as np
from masonry import (
    AT_REST,
    MasonryJoint,
    MasonryMat,
    Scene,
    addBlock,
    bricks,
    connect,
    criticalTimeStep,
    engine,
    engines,
    materials,
)
import masonry_limit as limit
from masonry.bricks import boxCorners as corners
from masonry.errors import Refused
from yade import O, Vector3

G = 9.81  # [m/s²]
DENSITY = 1800.0  # [kg/m³]
DAMPING = 0.3  # local, of :func:`falls`
BALANCED = (
    1e-4  # of the weight of a block: what may be missing in the equilibrium of limit analysis
)


# -- body by body ----------------------------------------------------------------------------------


def dry(stiffness=1e10, friction=0.7, **kw):
    """A joint without any tension. Its stiffness is in Pa/m."""
    return MasonryJoint(
        name="dry",
        tensileStrength=0,
        cohesion=0,
        friction=friction,
        residualFriction=friction,
        cap=False,
        normalStiffness=stiffness,
        shearStiffness=stiffness,
        **kw,
    )


def elastic(stiffness=1e10, **kw):
    """A joint that never gives way. Its stiffness is in Pa/m."""
    return MasonryJoint(elastic=True, normalStiffness=stiffness, shearStiffness=stiffness, **kw)


def mat(**kw):
    """Material of blocks so stiff that joints keep their own stiffness."""
    return MasonryMat(young=1e16, poisson=0.0, density=DENSITY, **kw)


def box(low, size, material, **kw):
    """A box with its lowest corner and its sides [m]; returns its body id."""
    high = [a + b for a, b in zip(low, size)]
    return addBlock(corners(low, high), material, **kw)


def fix(body):
    O.bodies[body].state.blockedDOFs = "xyzXYZ"


def arch(blocks, friction=0.9):
    """An arch in the x-z plane whose last two blocks are fixed, body by body."""
    for n, block in enumerate(blocks):
        body = addBlock(block.corners, mat(), inPlane=True)
        if n >= len(blocks) - 2:
            fix(body)
    engines([dry(2e10, friction)], damping=DAMPING, dampingKind="local")
    connect()


def falls(sideways, beyond, grow=0.5, stay=3.0):
    """Whether a structure falls under vertical gravity and this acceleration to the side [m/s², a
    vector].

    The vertical part comes first. The part to the side grows over a time and then stays for
    another, both smoothly, so that inertia adds nothing. Local damping takes a share of the
    unbalanced force only: it brings a structure to rest and slows the fall of a mechanism, but
    cannot hold one. With 0.8 a stack of four dry blocks took ten seconds to fall; with 0.3 it takes
    half a second, and what stands is at rest as soon.

    :param beyond: displacement of a body [m] that no structure at rest reaches
    :param grow: time over which each part grows [s]
    :param stay: time that a structure has to fall [s]; if it is slower than that, it is said to
        stand
    """
    integrator = engine("integrator")
    O.dt = 0.8 * criticalTimeStep()[0]
    watched = [b for b in O.bodies if b.state.blockedDOFs != "xyzXYZ"]
    away = lambda: max((b.state.pos - b.state.refPos).norm() for b in watched)
    smooth = lambda x: x * x * (3 - 2 * x)
    steps = 0
    while O.time < 2 * grow + stay:
        if steps % 20 == 0:
            down = smooth(min(1.0, O.time / grow))
            side = smooth(min(1.0, max(0.0, O.time / grow - 1)))
            integrator.gravity = Vector3(0, 0, -G * down) + side * sideways
            if away() > beyond:
                return True
        O.step()
        steps += 1
    return False


# -- scenes ----------------------------------------------------------------------------------------


@contextlib.contextmanager
def sceneOf(blocks, masonry, words=(), **settings):
    """A :class:`masonry.Scene` whose results go to a folder that is deleted when it ends."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["--no-vtk", "--out", folder, *words]
        scene = Scene("case", blocks, masonry, arguments=words, **settings)
        scene.build = lambda model: _withoutFigures(Scene.build(scene, model))
        try:
            yield scene
        finally:
            # a fall in settle() ends a run with a status; here it is an answer
            with contextlib.suppress(SystemExit):
                scene.finish()


def _withoutFigures(model):
    model.draw = lambda directory: None  # nobody looks at them
    return model


def semicircle(stones, thickness, depth=0.3, foot=0.2):
    """A semicircular arch of equal flat voussoirs on two blocks, of mean radius 1 m: a
    :class:`masonry.bricks.Bricks`.

    The last two of its bricks are the blocks under its springings.

    :param thickness: over mean radius, along the radial joints [-]
    """
    radius = 1 - thickness / 2
    arch = bricks.Arch(thickness, depth, stones, radius=radius)
    for x in (-thickness, 2 * radius):
        arch += bricks.block((x, 0, -foot), (x + thickness, depth, 0), part="foot")
    return arch


def holdFeet(scene):
    """Hold the last two bricks of an arch; returns both targets."""
    count = len(scene.description.bricks)
    return scene.hold(count - 2, name="left"), scene.hold(count - 1, name="right")


def leans(scene, towards=(1, 0, 0)):
    """A function that tells whether a scene carries a horizontal acceleration [g]; after a fall it
    steps back."""

    def carries(factor):
        if scene.lean(factor, towards=towards) == AT_REST:
            return True
        scene.stepBack()
        return False

    return carries


# -- limit analysis of what stands in YADE ---------------------------------------------------------


def bound(towards=(1, 0, 0), assembly=None):
    """:class:`masonry_limit.Bound` of the scene under a horizontal acceleration; its factor is in
        g.

    :raises Refused: if the blocks do not stand under their weight, or if the forces that were found
        are not in equilibrium
    """
    assembly = assembly or limit.read()
    live = assembly.weights(G * Vector3(*towards))
    found = assembly.largest(live, assembly.weights((0, 0, -G)))
    rest = unbalanced(found)
    if rest > BALANCED:
        raise Refused(
            f"limit analysis: no equilibrium: {100 * rest:.3g} % of the weight of a block is"
            " missing"
        )
    return found


def unbalanced(found):
    """Largest force or moment that is missing on a free block at the factor of a bound.

    The forces of its contacts are added up here once more, so that nothing depends on what the
    solver says of itself. Joints that never give way are left out, so there must be none.

    :returns: over the mean weight of a block, or over that times a metre [-]
    """
    a, c = found.assembly, found.assembly.contacts
    force = found.normal[:, None] * a.normals[c.joint] + found.along
    total = found.factor * found.live + found.dead
    for side, sign in ((0, -1), (1, 1)):
        block = a.pairs[c.joint, side]
        moment = np.cross(c.at - a.centres[block], force)
        np.add.at(total, block, sign * np.hstack([force, moment]))
    return float(np.abs(total[~a.held]).max() / (G * a.masses[~a.held[:, 0]].mean()))


def rests(assembly):
    """Whether limit analysis finds that blocks stand under their weight."""
    try:
        bound(assembly=assembly)
    except Refused as refused:
        if "does not stand" in str(refused) or "no equilibrium" in str(refused):
            return False
        raise
    return True


def leastFriction(assembly, low=0.05, high=1.5, within=1e-4):
    """The least friction [-] with which blocks stand under their weight by limit analysis, by
    halving."""
    return _least(lambda mu: rests(_withFriction(assembly, mu)), low, high, within)


def _withFriction(assembly, friction):
    assembly.friction[:] = friction
    return assembly


def leastThickness(stones, friction=0.9, low=0.05, high=0.4, within=1e-5):
    """The least thickness over mean radius [-] with which :func:`semicircle` stands by limit
    analysis, by halving."""

    def stands(thickness):
        O.reset()
        arch(semicircle(stones, thickness), friction)
        return rests(limit.read())

    return _least(stands, low, high, within)


def _least(stands, low, high, within):
    while high - low > within:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands(middle) else (middle, high)
    return high


def rigidlike(friction=0.7, stiffness=1e11):
    """Dry stones whose joints are so stiff that their deformation hardly matters. Stiffness in
    Pa/m."""
    return materials.dry(friction=friction, normalStiffness=stiffness)
