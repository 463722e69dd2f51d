"""Blocks, joints and engines: what any scene of masonry needs. Bad input raises ValueError, with all problems at once."""

import math

from yade import Body, O, Vector3, utils, wrapper
from yade.wrapper import *

from .._masonry import connected, dropFaces, gather, neighbours

#: The functor that makes joints of blocks. Its subclasses do so where a block is one of YADE's own Polyhedra.
_GEOMETRY = Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom

#: The laws that joints can follow, by name, the default one first: see ``MasonryJoint.laws()``.
LAWS = {law["name"]: law for law in MasonryJoint.laws()}

#: What a NewtonIntegrator needs to turn bodies as MasonryIntegrator does. YADE 2025 has several algorithms of rotation
#: and takes another one by default; YADE 2023 has this one only.
ROTATION = {"exactAsphericalRot": True}
if hasattr(NewtonIntegrator, "rotAlgorithm"):
    ROTATION["rotAlgorithm"] = "Fincham1992"

#: A body that is thinner than this share of its length is no block.
THINNEST = 1e-6


def properties(cls):
    """The plugin's description of the properties of one of its classes: a list of dicts.

    Keys are ``name``, ``unit``, ``meaning``, ``source``, the bounds ``low`` and ``high``, and what is usual:
    ``usual_low`` and ``usual_high``. A value beyond these is probably given in ``other_unit``.
    """
    return cls.properties()


def units(cls):
    """Units of the properties of a class of the plugin: a dict of name -> unit, of those that have one."""
    return {p["name"]: p["unit"] for p in properties(cls) if p["unit"]}


def _refuse(problems, hint=None, most=10):
    """Raise ValueError with the first problems of a list, if there are any, and what helps against them."""
    if problems:
        more = [f"and {len(problems) - most} more"] if len(problems) > most else []
        raise ValueError(
            "\n".join([*problems[:most], *more, *([hint] if hint else [])])
        )


def vector(value, what, problems=None):
    """Three finite numbers as a Vector3.

    :param what: begins the sentence that refuses anything else
    :param problems: list to which that sentence is added, and None returned; None: it is raised as ValueError
    """
    try:
        found = Vector3(*value)
        if len(value) == 3 and math.isfinite(found.norm()):
            return found
    except Exception:  # Boost.Python's ArgumentError has no name in Python
        pass
    told = f"{what} must be three finite numbers, got {value}"
    if problems is None:
        raise ValueError(told)
    problems.append(told)


def _extent(points):
    """Longest extent of some points, and how far they reach out of a plane through three of them [m]."""
    first = points[0]
    away = max((p - first for p in points), key=Vector3.norm)
    side = max((away.cross(p - first) for p in points), key=Vector3.norm)
    height = max(abs(side.dot(p - first)) for p in points)
    return away.norm(), height / side.norm() if side.norm() > 0 else 0.0


def addBlock(vertices, material, inPlane=False, color=(0.75, 0.7, 0.65)):
    """Append a convex block to the scene. Returns its body id.

    :param vertices: corners [m], at least four, in global axes; every one a corner of the convex block
    :param material: MasonryMat
    :param inPlane: only x, z and the rotation about y stay free: a wall in the x-z plane
    """
    problems = []
    if not isinstance(material, MasonryMat):
        problems.append(f"block: material must be a MasonryMat, got {material}")
    color = vector(color, "block: color", problems)
    try:
        vertices = list(vertices)
    except TypeError:
        problems.append(f"block: corners must be a list of points, got {vertices}")
        vertices = []
    else:
        if len(vertices) < 4:
            problems.append(f"block: needs at least 4 corners, got {len(vertices)}")
    points = [
        vector(v, f"block: corner {n} [m]", problems) for n, v in enumerate(vertices)
    ]
    if not problems:
        length, thickness = _extent(points)
        if not thickness > THINNEST * length:
            problems.append(
                f"block: its {len(points)} corners span {length:g} m but only {thickness:g} m out of a plane: no volume"
            )
        elif length < 1e-8 * max(map(Vector3.norm, points)):
            problems.append(
                f"block: {length:g} m is too small to be told so far from the origin, corner 0 at {vertices[0]} m"
            )
    _refuse(problems)
    shape, centroid, orientation = MasonryBlock.around(points)
    shape.color = color
    body = Body(shape=shape, material=material)
    body.aspherical = True
    body.state = state = material.newAssocState()  # beside those of the other blocks
    state.mass = material.density * shape.volume
    state.inertia = material.density * shape.inertia
    state.pos, state.ori = centroid, orientation
    hull = shape.v
    for n, p in enumerate(points if len(hull) < len(points) else []):
        if p in points[:n]:
            problems.append(f"block: corner {n} {vertices[n]} m is given twice")
        elif all((state.pos + state.ori * v - p).norm() > 1e-6 * length for v in hull):
            problems.append(
                f"block: corner {n} {vertices[n]} m is no corner of the convex block around all of them"
            )
    if not all(0 < v < math.inf for v in (state.mass, *state.inertia)):
        problems.append(
            f"block: {length:g} m long, its mass of {state.mass:g} kg and inertia are no numbers above 0"
        )
    _refuse(problems)
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
    subcontacts=None,
    rows=None,
    inPlane=False,
    loads=(),
    zones=None,
    functors=False,
    dampingKind=None,
):
    """Fill O.engines for a masonry scene: joints, loads, energy balance and integration. There is no collider.

    The engines have labels, by which ``masonry.engine(label)`` finds them: ``joints`` the MasonryJointLoop, ``energy``
    the MasonryEnergy, ``integrator`` the MasonryIntegrator; loads and zones keep their own.

    :param joints: MasonryJoint objects; a pair of units takes the first that fits
    :param damping: damping constant of rigid units [-], 0 for motion in real time; the paper's eq. (3) has 0.8 (the
        paper: see yade_plugin/law/README.md)
    :param gravity: [m/s²]
    :param subcontacts: how many there are along a joint; None: 3. They are the points of Gauss and Lobatto, so the ends
        of a joint are points, and a block rocks about its edge at the true moment. From three on the elastic rotational
        stiffness is exact; with two it is three times too large; with one, a joint does not resist rotation. More than
        three follow the progress of a crack or of crushing along a joint more finely. A step costs in proportion to
        all subcontacts, that is, subcontacts times rows
    :param rows: rows of subcontacts across a joint, at the points of Gauss and Lobatto, too; None or 0: chosen for every
        joint when it is made. It gets one row, in the middle, if its two blocks can turn about one and the same of the
        global axes only, and if that axis lies in the joint: blocks of a wall in its plane, and fixed bodies. That is
        exact there. Every other joint gets three rows. So block degrees of freedom before ``connect()``, and free none
        later. One row where blocks are free in space would leave a joint without stiffness out of its plane; two rows make
        it three times too stiff there
    :param inPlane: the rows follow each other along y, also where the blocks' freedom does not say so
    :param loads: MasonryLoad engines
    :param zones: MasonryZones of the deformable units, if there are any
    :param functors: YADE's InteractionLoop and NewtonIntegrator, the slow reference, instead of MasonryJointLoop and
        MasonryIntegrator
    :param dampingKind: ``"combined"`` or ``"local"``; None: combined, and local with functors, because NewtonIntegrator
        knows no other. Combined damping takes energy from vibration and hardly brakes a steady motion. Local damping is
        the paper's eq. (3); it holds back what moves steadily, so a mechanism that turns slowly seems stronger than it is
    """
    problems = []
    kinds = ("local",) if functors else ("combined", "local")
    if dampingKind not in (None, *kinds):
        problems.append(
            f"engines: dampingKind must be {' or '.join(kinds)}"
            + (" with functors" if functors else "")
            + f", got {dampingKind!r}"
        )
        dampingKind = None

    def made(make):
        try:
            return make()
        except ValueError as error:
            problems.append(str(error))

    def listed(values, what, kind):
        try:
            values = list(values)
            wrong = [v for v in values if not isinstance(v, kind)]
        except TypeError:
            wrong = [values]
        if wrong:
            problems.append(
                f"engines: {what} must be a list of {kind.__name__}, got {wrong[0]!r}"
            )
        return values

    joints = listed(joints, "joints", MasonryJoint)
    loads = listed(loads, "loads", MasonryLoad)
    if not joints:
        problems.append("engines: joints must not be empty")
    if zones is not None and not isinstance(zones, MasonryZones):
        problems.append(f"engines: zones must be a MasonryZones or None, got {zones!r}")
    integrator = made(
        lambda: MasonryIntegrator(
            damping=damping,
            dampingKind=dampingKind or kinds[0],
            gravity=gravity,
            label="integrator",
        )
    )
    counts = {"subcontacts": subcontacts, "rows": rows}
    geometry = made(
        lambda: Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom(
            **{name: n for name, n in counts.items() if n is not None},
            rowDirection=(0, 1, 0) if inPlane else (0, 0, 0),
        )
    )
    _refuse(problems)
    physics = Ip2_MasonryMat_MasonryMat_MasonryJointPhys(joints=joints)
    if zones:
        zones.gravity = integrator.gravity
        geometry.zones = zones
    if functors:
        loop = _functorLoop(geometry, physics)
        integrator = NewtonIntegrator(
            damping=damping,
            gravity=integrator.gravity,
            label="integrator",
            **ROTATION,
        )
    else:
        loop = MasonryJointLoop(geometry=geometry, physics=physics, label="joints")
    O.engines = [
        ForceResetter(),
        loop,
        *loads,
        MasonryEnergy(label="energy"),
        integrator,
    ] + ([zones] if zones else [])


def engine(label):
    """The engine of O.engines with this label. Raises ValueError, with the labels that there are."""
    found = {e.label: e for e in O.engines if e.label}
    if label not in found:
        raise ValueError(
            f"no engine has the label {label!r}; there are {', '.join(found) or 'none'}"
        )
    return found[label]


def advance(steps):
    """Take time steps, in this thread, as fast as the engines go. Ctrl-C stops between two steps.

    YADE's ``O.run(steps, True)`` waits for another thread and looks every 40 ms whether it has finished, so short runs
    are mostly waiting, and Ctrl-C waits for its end.

    :param steps: how many, a whole number from 0 on
    """
    if isinstance(steps, bool) or not isinstance(steps, int) or steps < 0:
        raise ValueError(
            f"advance: steps must be a whole number from 0 on, got {steps!r}"
        )
    step = O.step
    for _ in range(steps):
        step()


def connect(rule=None, tolerance=1e-4, allowGaps=False):
    """Make the joints between all blocks that share a face. The present state is the reference. Returns the interactions.

    Blocks that lie in each other are refused, and those that miss a shared face by less than a quarter of their
    thickness; the message has the gap. A scene without any joint is refused, too, and one that has its joints already.
    Nothing changes then. Values that look like those of another unit, blocks without joints, and properties
    without effect under the law of their joint are printed as warnings.

    :param rule: function (body1, body2, geom) that returns a MasonryJoint, or None to leave the choice to direction and
        joint set
    :param tolerance: largest gap or overlap of coincident faces, relative to the smaller block's size, at most 0.01
    :param allowGaps: whether blocks that nearly share a face stand apart on purpose
    """
    engines = list(O.engines)
    loop = next(
        (e for e in engines if isinstance(e, (MasonryJointLoop, InteractionLoop))), None
    )
    if loop is None:
        raise ValueError(
            "connect() needs the joints' engine in O.engines: call masonry.engines() first"
        )
    if rule is not None and not callable(rule):
        raise ValueError(
            f"rule must be a function (body1, body2, geom) or None, got {rule!r}"
        )
    if isinstance(loop, InteractionLoop):
        geometry, physics = (
            d.functors[0] if d.functors else None
            for d in (loop.geomDispatcher, loop.physDispatcher)
        )
        functors = loop.geomDispatcher.functors
    else:
        geometry, physics = loop.geometry, loop.physics
        functors = [geometry]
    if geometry is None or physics is None:
        raise ValueError(
            f"{type(loop).__name__} has no geometry or no physics: call masonry.engines()"
        )
    before, pairs = geometry.tolerance, []
    try:
        for functor in functors:
            functor.tolerance = tolerance
        pairs, sizes = _pairs(tolerance, allowGaps)
        if not isinstance(loop, InteractionLoop):
            # YADE makes interactions with the functors of an InteractionLoop: one stands in for a moment
            O.engines = [_functorLoop(geometry, physics)]
        made, joints = _connect(pairs, physics, rule)
    except ValueError:
        if pairs:  # a value in another unit may be the reason
            _warn(pairs, physics.joints, sizes, engines)
        raise
    finally:
        dropFaces()
        O.engines = engines
        for functor in functors:
            functor.tolerance = before
    connected()
    _warn(pairs, joints, sizes, engines)
    return made


def _functorLoop(geometry, physics):
    laws = [joint.law for joint in physics.joints if not joint.elastic]
    law = LAWS[laws[0] if laws else next(iter(LAWS))]  # one functor takes all joints
    functor = getattr(wrapper, law["functor"])()
    return InteractionLoop(
        [geometry, *_forPolyhedra(geometry)], [physics], [functor], label="joints"
    )


def _forPolyhedra(geometry):
    """Functors for the pairs of shapes that a geometry functor does not take, where this YADE has Polyhedra."""
    same = {p["name"]: getattr(geometry, p["name"]) for p in _GEOMETRY.properties()}
    return [
        cls(**same)
        for cls in (_GEOMETRY, *_GEOMETRY.__subclasses__())
        if cls is not type(geometry)
    ]


def _pairs(tolerance, allowGaps):
    """Pairs of blocks to join, and the thinnest and the largest block."""
    pairs, misfits, sizes = neighbours(tolerance, keepFaces=True)
    known = next(
        (i for i in O.interactions.all() if isinstance(i.geom, MasonryJointGeom)), None
    )
    if known:
        raise ValueError(
            f"bodies {known.id1} and {known.id2} have a joint: connect() is called once, when all blocks are there"
        )
    problems = []
    for one, two, gap, bound in misfits:
        if gap < 0:
            problems.append(
                f"bodies {one} and {two} lie {-1e3 * gap:g} mm deep in each other"
            )
        elif not allowGaps:
            problems.append(
                f"bodies {one} and {two} nearly share a face, with a gap of {1e3 * gap:g} mm"
            )
        else:
            continue
        problems[-1] += f"; the tolerance is {1e3 * bound:.3g} mm"
    _refuse(
        problems,
        "move them, or see help(masonry.connect) for its tolerance and allowGaps",
    )
    if not pairs:
        raise ValueError(
            f"no joint can be made: none of {len(O.bodies)} bodies shares a face with another (tolerance "
            f"{tolerance:g} of the smaller block's size)"
        )
    return pairs, sizes


def _connect(pairs, physics, rule):
    """Make the joints of all pairs, or none of them. Returns the interactions and the MasonryJoint objects."""
    made, problems, joints = [], [], {id(j): j for j in physics.joints}
    due = 256
    try:
        for id1, id2 in pairs:
            try:
                interaction = utils.createInteraction(id1, id2)
            except ValueError as error:
                if str(error) not in problems:  # joints of a kind are refused alike
                    problems.append(str(error))
                continue
            made.append(interaction)
            if (
                len(made) == due
            ):  # what joints leave when they move into columns is free for the next ones
                gather()
                due += 256 + due // 4
            if rule:
                bodies = O.bodies[interaction.id1], O.bodies[interaction.id2]
                joint = rule(*bodies, interaction.geom)
                if isinstance(joint, MasonryJoint):
                    physics.assign(interaction, joint)
                    joints[id(joint)] = joint
                elif joint is not None:
                    problems.append(
                        f"rule must return a MasonryJoint or None, got {joint!r} for bodies {id1} and {id2}"
                    )
        _refuse(problems)
    except BaseException:
        for interaction in made:
            O.interactions.erase(interaction.id1, interaction.id2)
        O.interactions.eraseNonReal()
        raise
    return made, list(joints.values())


def _isBlock(body):
    return type(body.shape).__name__ in ("MasonryBlock", "Polyhedra")


def _warn(pairs, joints, sizes, engines):
    """Print warnings of what looks like a mistake: other units, blocks without joints, properties without effect."""
    (thin, thickness), (large, size) = sizes
    hints = []
    if thickness < 1e-3:
        hints.append(f"body {thin} is {thickness:g} m thick: are corners in m?")
    if size > 50:
        hints.append(f"body {large} is {size:g} m long: are corners in m, not mm?")
    bodies = {b.id: b for b in O.bodies if _isBlock(b)}
    mats = {(b.mat.label, b.mat.young, b.mat.density): b.mat for b in bodies.values()}
    for thing in (*mats.values(), *joints):
        name = thing.name if isinstance(thing, MasonryJoint) else thing.label
        for p in properties(type(thing)):
            value = getattr(thing, p["name"]) if p["other_unit"] else 0
            if value > 0 and not p["usual_low"] <= value <= p["usual_high"]:
                hints.append(
                    f'{type(thing).__name__} "{name}": {p["name"]} {value:g} {p["unit"]}: is it in {p["unit"]}, '
                    f'not {p["other_unit"]}?'
                )
    usual, read = MasonryJoint(), [law["properties"] for law in LAWS.values()]
    for joint in joints:
        own = LAWS[joint.law]["properties"]
        #: of an elastic joint those that one law alone reads, else those that others read and this one does not
        idle = [
            p["name"]
            for p in properties(MasonryJoint)
            if getattr(joint, p["name"]) != getattr(usual, p["name"])
            and any(p["name"] in names for names in read)
            and (
                sum(p["name"] in names for names in read) == 1
                if joint.elastic
                else p["name"] not in own
            )
        ]
        if idle:
            why = "is elastic" if joint.elastic else f'follows the law "{joint.law}"'
            hints.append(
                f'MasonryJoint "{joint.name}" {why}: no effect of {", ".join(idle)}'
            )
    integrator = next(
        (e for e in engines if isinstance(e, (MasonryIntegrator, NewtonIntegrator))),
        None,
    )
    gravity = integrator.gravity.norm() if integrator else 0
    for label, _, density in mats:  # density scaling keeps the weight
        if gravity and not 1e3 <= density * gravity <= 1e5:
            hints.append(
                f'MasonryMat "{label}": density {density:g} kg/m³ weighs {density * gravity:g} N/m³: is it in kg/m³?'
            )
    alone = sorted(set(bodies).difference(*zip(*pairs)))
    if alone:
        hints.append(
            f"no joint holds bodies {alone[:10]}" + (" and more" * (len(alone) > 10))
        )
    for engine in engines:
        if isinstance(engine, MasonryLoad) and engine.body in bodies:
            body = bodies[engine.body]
            away = (engine.point - body.state.refPos).norm()
            if away > 20 * max(v.norm() for v in body.shape.v):
                hints.append(
                    f"MasonryLoad: its point lies {away:g} m from body {body.id}: is it in m?"
                )
        if isinstance(engine, MasonryZones):
            count = {i: len(range(*engine.nodesOf(i))) for i in engine.bodies}
            stars = [i for i in count if count[i] == len(bodies[i].shape.v) + 1]
            if not count:
                hints.append("MasonryZones has no bodies")
            if stars and engine.divisions != [1, 1, 1]:
                hints.append(
                    f"MasonryZones: divisions do not apply to bodies {stars[:10]}, which are no hexahedra"
                )
    for hint in hints:
        print("warning: " + hint)
