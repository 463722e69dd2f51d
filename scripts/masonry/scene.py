"""Bodies, joints and engines: what any scene of masonry blocks needs."""

from yade import O, Vector3, polyhedra_utils, utils
from yade.wrapper import *

from ._masonry import touchingPairs


def addBlock(vertices, material, inPlane=False, color=(0.75, 0.7, 0.65)):
    """Append a convex block to the scene and return its body id.

    :param vertices: corners [m], at least four, in global axes
    :param material: MasonryMat
    :param inPlane: only x, z and the rotation about y stay free: a wall in the x-z plane
    """
    body = polyhedra_utils.polyhedra(
        material, v=[Vector3(*v) for v in vertices], color=color
    )
    body.state.refPos, body.state.refOri = body.state.pos, body.state.ori
    body.bounded = False  # no collider runs
    if inPlane:
        # with blocked rotations the integrator takes `inertia` in global axes
        axes = body.state.ori.toRotationMatrix()
        own = body.state.inertia
        body.state.inertia = Vector3(
            *(sum(axes[i, k] ** 2 * own[k] for k in range(3)) for i in range(3))
        )
        body.state.blockedDOFs = "yXZ"
    return O.bodies.append(body)


def engines(
    joints,
    damping=0.8,
    gravity=(0, 0, -9.81),
    subcontacts=4,
    rows=1,
    inPlane=False,
    loads=(),
    zones=None,
    functors=False,
):
    """Fill O.engines for a masonry scene: joints, loads, energy balance, integration. No collider.

    :param joints: MasonryJoint objects; the first that fits a pair of units is taken
    :param damping: Cundall's local damping of rigid units [-] (paper eq. (3): 0.8)
    :param gravity: [m/s²]
    :param subcontacts: per joint, along it
    :param rows: rows of subcontacts across a joint; 1 is enough in the plane
    :param loads: MasonryLoad engines
    :param zones: MasonryZones of the deformable units, if there are any
    :param functors: YADE's InteractionLoop and NewtonIntegrator, the slow reference, instead of MasonryJointLoop and
        MasonryIntegrator
    """
    if zones:
        zones.gravity = Vector3(*gravity)
    across = Vector3(0, 1, 0) if inPlane else Vector3(0, 0, 0)
    geometry = Ig2_Polyhedra_Polyhedra_MasonryJointGeom(
        subcontacts=subcontacts,
        rows=rows,
        rowDirection=across,
        **({"zones": zones} if zones else {}),
    )
    physics = Ip2_MasonryMat_MasonryMat_MasonryJointPhys(joints=list(joints))
    O.engines = [
        ForceResetter(),
        (
            _functorLoop(geometry, physics)
            if functors
            else MasonryJointLoop(geometry=geometry, physics=physics, label="joints")
        ),
        *loads,
        MasonryEnergy(label="energy"),
        (
            NewtonIntegrator(
                damping=damping,
                gravity=Vector3(*gravity),
                exactAsphericalRot=True,
                label="integrator",
            )
            if functors
            else MasonryIntegrator(
                damping=damping, gravity=Vector3(*gravity), label="integrator"
            )
        ),
    ] + ([zones] if zones else [])


def connect(rule=None, tolerance=1e-4):
    """Make the joints between all blocks that share a face in the present, reference state. Returns the interactions.

    :param rule: function (body1, body2, geom) -> MasonryJoint, or None to leave the choice to direction and joint set
    :param tolerance: largest gap or overlap of coincident faces, relative to the smaller block's size
    """
    engines = list(O.engines)
    loop = next(
        (e for e in engines if isinstance(e, (MasonryJointLoop, InteractionLoop))), None
    )
    if loop is None:
        raise ValueError(
            "connect() needs the joints' engine in O.engines: call masonry.engines() first"
        )
    if isinstance(loop, InteractionLoop):
        return _connect(loop.physDispatcher.functors[0], rule, tolerance)
    # YADE makes interactions with the functors of an InteractionLoop: one stands in for a moment
    O.engines = [_functorLoop(loop.geometry, loop.physics)]
    try:
        return _connect(loop.physics, rule, tolerance)
    finally:
        O.engines = engines


def _functorLoop(geometry, physics):
    return InteractionLoop(
        [geometry],
        [physics],
        [Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening()],
        label="joints",
    )


def _connect(physics, rule, tolerance):
    made = []
    for id1, id2 in touchingPairs(tolerance):
        interaction = utils.createInteraction(id1, id2)
        joint = (
            rule(O.bodies[interaction.id1], O.bodies[interaction.id2], interaction.geom)
            if rule
            else None
        )
        if joint is not None:
            physics.assign(interaction, joint)
        made.append(interaction)
    return made
