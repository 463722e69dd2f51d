# SPDX-License-Identifier: GPL-2.0-or-later
"""The joints of a scene: made of all pairs of blocks that share a face. Bad input raises
ValueError, with all problems at once."""

from typing import Annotated, Any, Callable

from yade import O
from yade.wrapper import InteractionLoop, MasonryIntegrator, MasonryJoint
from yade.wrapper import MasonryJointGeom, MasonryJointLoop, MasonryLoad, MasonryZones
from yade.wrapper import NewtonIntegrator

from .. import _masonry
from .._masonry import connected, dropFaces, neighbours, timeStepLimit
from ..arguments import number, validated
from ..errors import Refused
from ..terminal import say
from .bodies import properties, refuse
from .engines import LAWS


#: The largest gap or overlap of faces that coincide, over the size of the smaller block [-].
Tolerance = Annotated[float, number("", 0, 0.01, above=True)]
#: The time step that YADE begins with [s]: a thousandth of what a wall needs, or less.
YADES_TIME_STEP = 1e-8


@validated
def touchingPairs(tolerance: Tolerance = 1e-4) -> list[tuple[int, int]]:
    """Pairs of ids of the blocks that share a face, smaller id first. Parameters as in
    :func:`connect`."""
    return _masonry.touchingPairs(tolerance)


@validated
def connect(
    rule: Callable[..., Any] | None = None,
    tolerance: Tolerance = 1e-4,
    allowGaps: bool = False,
) -> list[Any]:
    """Make the joints between all blocks that share a face. The present state is the reference.
    Returns the interactions.

    Blocks that lie in each other are refused, and those that miss a shared face by less than a
    quarter of their thickness; the message has the gap. A scene without any joint is refused, too,
    and one that has its joints already. Nothing changes then. Values that look like those of
    another unit, blocks without joints, and properties without effect under the law of their joint
    are printed as warnings.

    If ``O.dt`` is still the 1e-8 s that YADE begins with, it becomes half of the stable limit; see
    ``criticalTimeStep()``.

    :param rule: function (body1, body2, geom) that returns a MasonryJoint, or None to leave the
        choice to direction and joint set
    :param tolerance: largest gap or overlap of coincident faces over the smaller block's size [-]
    :param allowGaps: whether blocks that nearly share a face stand apart on purpose
    """
    made = makeJoints(rule, tolerance, allowGaps)
    if O.dt == YADES_TIME_STEP:
        O.dt = 0.5 * timeStepLimit()
    return made


def makeJoints(
    rule: Callable[..., Any] | None, tolerance: float = 1e-4, allowGaps: bool = False
) -> list[Any]:
    """:func:`connect` without its time step, for who chooses it by other rules."""
    loops = [e for e in O.engines if isinstance(e, (MasonryJointLoop, InteractionLoop))]
    if not loops:
        raise Refused(
            "connect() needs the joints' engine in O.engines: call masonry.engines() first"
        )
    loop = loops[0]
    if isinstance(loop, InteractionLoop):
        functors, ofPhysics = loop.geomDispatcher.functors, loop.physDispatcher.functors
    else:
        functors, ofPhysics = [loop.geometry], [loop.physics]
    geometry, physics = [*functors, None][0], [*ofPhysics, None][0]
    if geometry is None or physics is None:
        raise Refused(
            f"{type(loop).__name__} has no geometry or no physics: call masonry.engines()"
        )
    before, pairs = geometry.tolerance, []
    try:
        for functor in functors:
            functor.tolerance = tolerance
        pairs, sizes = _pairs(tolerance, allowGaps)
        made, used, problems = _masonry.connect(pairs, geometry, physics, rule)
        refuse([*dict.fromkeys(problems)])  # joints of a kind are refused alike
    except ValueError:
        if pairs:  # a value in another unit may be the reason
            _warn(pairs, physics.joints, sizes)
        raise
    finally:
        dropFaces()
        for functor in functors:
            functor.tolerance = before
    connected()
    _warn(pairs, used if rule else physics.joints, sizes)
    return made


def _pairs(tolerance, allowGaps):
    pairs, misfits, sizes = neighbours(tolerance, keepFaces=True)
    for one in O.interactions.all():
        if isinstance(one.geom, MasonryJointGeom):
            raise Refused(
                f"bodies {one.id1} and {one.id2} have a joint: connect() is called once, when all"
                " blocks are there"
            )
    problems = []
    for one, two, gap, bound in misfits:
        how = f"nearly share a face, with a gap of {1e3 * gap:g} mm"
        if gap < 0:
            how = f"overlap by {-1e3 * gap:g} mm"
        if gap < 0 or not allowGaps:
            how += f"; the tolerance is {1e3 * bound:.3g} mm"
            problems.append(f"bodies {one} and {two} {how}")
    refuse(
        problems,
        (
            "move them, or allow gaps on purpose with allowGaps=True, of Scene or of connect; see"
            " help(masonry.connect) for its tolerance"
        ),
    )
    if not pairs:
        raise Refused(
            f"no joint can be made: none of {len(O.bodies)} bodies shares a face with another"
            f" (tolerance {tolerance:g} of the smaller block's size)"
        )
    return pairs, sizes


def _warn(pairs, joints, sizes):
    (thin, thickness), (large, size) = sizes
    if thickness < 1e-3:
        say(f"warning: body {thin} is {thickness:g} m thick: are corners in m?")
    if size > 50:
        say(f"warning: body {large} is {size:g} m long: are corners in m, not mm?")
    kinds = "MasonryBlock", "Polyhedra"
    bodies = {b.id: b for b in O.bodies if type(b.shape).__name__ in kinds}
    mats = {(b.mat.label, b.mat.young, b.mat.density): b.mat for b in bodies.values()}
    _warnOfUnits([*mats.values(), *joints])
    _warnOfIdle(joints)
    kinds = MasonryIntegrator, NewtonIntegrator
    gravity = next((e.gravity.norm() for e in O.engines if isinstance(e, kinds)), 0)
    for label, _, density in mats:  # density scaling keeps the weight
        if gravity and not 1e3 <= density * gravity <= 1e5:
            say(
                f'warning: MasonryMat "{label}": density {density:g} kg/m³ weighs'
                f" {density * gravity:g} N/m³: is it in kg/m³?"
            )
    alone = sorted(set(bodies).difference(*zip(*pairs)))
    if alone:
        more = " and more" * (len(alone) > 10)
        say(f"warning: no joint holds bodies {alone[:10]}{more}")
    for engine in O.engines:
        if isinstance(engine, MasonryLoad) and engine.body in bodies:
            body = bodies[engine.body]
            away = (engine.point - body.state.refPos).norm()
            if away > 20 * max(v.norm() for v in body.shape.v):
                say(
                    f"warning: MasonryLoad: its point lies {away:g} m from body {body.id}: is it"
                    " in m?"
                )
        if isinstance(engine, MasonryZones):
            _warnOfZones(engine, bodies)


def _warnOfUnits(things):
    for thing in things:
        name = thing.name if isinstance(thing, MasonryJoint) else thing.label
        for p in properties(type(thing)):
            value = getattr(thing, p["name"]) if p["other_unit"] else 0
            if value > 0 and not p["usual_low"] <= value <= p["usual_high"]:
                unit, other = p["unit"], p["other_unit"]
                what = f"{value:g}: is it a tangent, not an angle in {other}?"
                if unit != "-":
                    what = f"{value:g} {unit}: is it in {unit}, not {other}?"
                say(f'warning: {type(thing).__name__} "{name}": {p["name"]} {what}')


def _warnOfIdle(joints):
    """Warn of properties that were given and that the law of their joint does not read; of an
    elastic joint, of those that one law alone reads."""
    default, read = MasonryJoint(), [law["properties"] for law in LAWS.values()]
    readers = {
        p["name"]: sum(p["name"] in names for names in read) for p in properties(MasonryJoint)
    }
    for joint in joints:
        own, idle = LAWS[joint.law]["properties"], []
        for name, count in readers.items():
            unread = count == 1 if joint.elastic else count and name not in own
            if unread and getattr(joint, name) != getattr(default, name):
                idle.append(name)
        if idle:
            why = "is elastic" if joint.elastic else f'follows the law "{joint.law}"'
            what = f"no effect of {', '.join(idle)}"
            say(f'warning: MasonryJoint "{joint.name}" {why}: {what}')


def _warnOfZones(zones, bodies):
    if not zones.bodies:
        say("warning: MasonryZones has no bodies")
    # of a plane unit that is no hexahedron the nodes are the corners of its base and one in the
    # middle
    stars = []
    for i in zones.bodies:
        n, nodes = len(bodies[i].shape.v), len(range(*zones.nodesOf(i)))
        if nodes == n + 1 or n != 8 and nodes == n // 2 + 1:
            stars.append(i)
    if stars and zones.divisions != [1, 1, 1]:
        say(
            f"warning: MasonryZones: divisions do not apply to bodies {stars[:10]}, which are no"
            " hexahedra"
        )
