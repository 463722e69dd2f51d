# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines of a masonry scene, and its steps."""

from typing import Annotated, Any, Sequence

from yade import O, wrapper
from yade.wrapper import ForceResetter, Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom
from yade.wrapper import InteractionLoop, MasonryContacts
from yade.wrapper import Ip2_MasonryMat_MasonryMat_MasonryJointPhys, MasonryEnergy
from yade.wrapper import MasonryIntegrator, MasonryJoint, MasonryJointLoop, MasonryLoad
from yade.wrapper import MasonrySprings, MasonryTies, MasonryZones, NewtonIntegrator

from ..arguments import Numbers, isA, listOf, number, oneOf, shown, validated, vector, whole

MAX_STEPS = 10**15

#: The functor that makes joints of blocks; its subclasses take YADE's own Polyhedra.
_GEOMETRY = Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom

#: Laws of joints by name, the default one first: see ``MasonryJoint.laws()``.
LAWS = {law["name"]: law for law in MasonryJoint.laws()}

#: Settings with which a NewtonIntegrator turns bodies as MasonryIntegrator does. YADE 2025 has
#: several algorithms of rotation, YADE 2023 this one only.
ROTATION: dict[str, Any] = {"exactAsphericalRot": True}
if hasattr(NewtonIntegrator, "rotAlgorithm"):
    ROTATION["rotAlgorithm"] = "Fincham1992"


Damping = Annotated[float, number("", 0, 0.99)]
Connectors = Annotated[Sequence[Any], listOf(isA((MasonryTies, MasonrySprings)), 0)]


@validated
def engines(
    joints: Annotated[Sequence[Any], listOf(isA(MasonryJoint))],
    damping: Damping = 0.8,
    gravity: Annotated[Numbers, vector("m/s²")] = (0, 0, -9.81),
    points: Annotated[int, whole(0, 100)] | None = None,
    subcontacts: Annotated[int, whole(1, 1000)] | None = None,
    rows: Annotated[int, whole(0, 1000)] | None = None,
    inPlane: bool = False,
    loads: Annotated[Sequence[Any], listOf(isA(MasonryLoad), 0)] = (),
    zones: Annotated[Any, isA(MasonryZones)] | None = None,
    functors: bool = False,
    dampingKind: Annotated[str, oneOf("combined", "local")] | None = None,
    connectors: Connectors = (),
    contacts: Annotated[Any, isA(MasonryContacts)] | None = None,
) -> None:
    """Fill O.engines for a masonry scene: joints, loads, energy balance and integration, no
    collider.

    ``masonry.engine(label)`` finds them: ``joints`` the MasonryJointLoop, ``energy`` the
    MasonryEnergy, ``integrator`` the MasonryIntegrator; loads and zones keep their own labels.

    :param joints: a pair of units takes the first that fits
    :param damping: damping constant of rigid units [-], 0 for motion in real time; 0.8 in eq. (3)
        of the paper (yade_plugin/law/README.md)
    :param gravity: [m/s²]
    :param points: points along a side of a joint between rigid blocks that is about to yield:
        ``MasonryJointLoop.points``. None: 8 where blocks move in a plane, 5 in space, 14 where a
        dry or cracked joint on a compliant bed opens. Functors keep those of the next two
    :param subcontacts: points along a joint until then, at right angles to its rows; None: 3. The
        ends of a joint are points, so a block rocks about its edge at the true moment
    :param rows: rows of subcontacts across a joint; None or 0: one where its blocks can only turn
        about an axis in the joint when it is made, else three. So block degrees of freedom before
        ``connect()``, and free none later. Two rows make a joint in space three times too stiff out
        of its plane
    :param inPlane: whether rows follow each other along y, whatever the freedom of the blocks
    :param zones: of the deformable units
    :param functors: YADE's InteractionLoop and NewtonIntegrator, the slow reference, instead of
        MasonryJointLoop and MasonryIntegrator
    :param dampingKind: ``"combined"`` or ``"local"``; None: combined, with functors local, the only
        one of NewtonIntegrator. Combined damping takes energy from vibration and hardly brakes a
        steady motion. Local damping, eq. (3) of the paper, brakes steady motion, so a mechanism
        that turns slowly seems stronger than it is
    :param contacts: of the blocks that no joint connects
    """
    if functors and dampingKind == "combined":
        raise ValueError("engines: dampingKind must be local with functors")
    geometry = _GEOMETRY(subcontacts=subcontacts or 3, rows=rows or 0, rowDirection=(0, inPlane, 0))
    physics = Ip2_MasonryMat_MasonryMat_MasonryJointPhys(joints=joints)
    moving = dict(damping=damping, gravity=gravity, label="integrator")
    if zones:
        zones.gravity = gravity
        geometry.zones = zones
    if functors:
        loop = functorLoop(geometry, physics)
        integrator = NewtonIntegrator(**moving, **ROTATION)
    else:
        loop = MasonryJointLoop(
            geometry=geometry, physics=physics, points=points or 0, label="joints"
        )
        integrator = MasonryIntegrator(**moving, dampingKind=dampingKind or "combined")
    forces = loop, contacts, *connectors, *loads
    made = ForceResetter(), *forces, MasonryEnergy(label="energy"), integrator, zones
    O.engines = [one for one in made if one is not None]


@validated
def engine(label: str) -> Any:
    """The engine of O.engines with this label. Raises ValueError."""
    found = {e.label: e for e in O.engines if e.label}
    if label not in found:
        raise ValueError(
            f"no engine has the label {shown(label)}; there are {', '.join(found) or 'none'}"
        )
    return found[label]


@validated
def advance(steps: Annotated[int, whole(0, MAX_STEPS)]) -> None:
    """Take time steps in this thread. Ctrl-C stops between two steps.

    YADE's ``O.run(steps, True)`` looks every 40 ms whether another thread has finished, so short
    runs are mostly waiting, and Ctrl-C waits for the end.
    """
    step = O.step
    for _ in range(steps):
        step()


def functorLoop(geometry: Any, physics: Any) -> Any:
    """An InteractionLoop with functors that make joints of all pairs of blocks."""
    laws = [joint.law for joint in physics.joints if not joint.elastic]
    law = LAWS[laws[0] if laws else next(iter(LAWS))]  # one functor takes all joints
    functor = getattr(wrapper, law["functor"])()
    same = {p["name"]: getattr(geometry, p["name"]) for p in _GEOMETRY.properties()}
    # pairs with Polyhedra, where this YADE has them
    kinds = _GEOMETRY, *_GEOMETRY.__subclasses__()
    others = [kind(**same) for kind in kinds if kind is not type(geometry)]
    return InteractionLoop([geometry, *others], [physics], [functor], label="joints")
