# SPDX-License-Identifier: GPL-2.0-or-later
"""Bad input of every sort: one clear error each, nothing runs, and what was there stays as it was.

A case is what the scene is, what is done to it, and what the message must say.
"""

import io
import resource
import runpy

from hosted import *
from hosted import bricks as parts, unitMaterial as mat
from masonry.numbers import files as reading
from masonry_view import measure
from masonry.numbers.frames import readFrame
from masonry.run import results
from yade import Body, utils

nan, inf = math.nan, math.inf
ABOVE = (0, 0, UNIT[2])


# -- scenes ----------------------------------------------------------------------------------------


def blocks(*places, size=UNIT):
    """Bricks with their lower corners at these places, the first fixed; two on each other if no
    place is given."""
    unit = mat()
    for place in places or ((0, 0, 0), ABOVE):
        addBlock(box(place, size), unit)
    hold(0)


def laid(*places, size=UNIT, **settings):
    """Bricks as blocks() places them, and the engines, without joints."""
    blocks(*places, size=size)
    engines([MasonryJoint()], **settings)


def joined(steps=3, **settings):
    blocks()
    join(**settings)
    run(steps)


def deformable(steps=3, bodies=(1,)):
    joined(steps, zones=MasonryZones(bodies=list(bodies)))


def zones():
    return O.engines[-1]


def reorder(change):
    joined()
    O.engines = change(O.engines)


def loaded(**settings):
    """Two joined bricks and a load, which is only checked in a step."""
    joined(0, loads=[MasonryLoad(body=1, point=(0.11, 0.051, 0.162))])
    for name, value in settings.items():
        setattr(O.engines[2], name, value)


def state(body, **settings):
    """Two bricks with their engines; the state of one is changed."""
    laid()
    for name, value in settings.items():
        setattr(O.bodies[body].state, name, value)


def foreign(material):
    """A brick that addBlock() made, and on it one that a script made of its shape alone."""
    addBlock(box(), mat())
    shape, centroid, orientation = MasonryBlock.around(box(ABOVE))
    body = Body(shape=shape, material=material)
    body.state.mass = material.density * shape.volume
    body.state.inertia = material.density * shape.inertia
    body.state.pos, body.state.ori = centroid, orientation
    O.bodies.append(body)
    engines([MasonryJoint()])


def turned(degrees):
    addBlock(box(), mat())
    turn = Quaternion(Vector3(0, 1, 0), math.radians(-degrees))
    addBlock([corner + Vector3(*ABOVE) for corner in box(turn=turn)], mat())
    engines([MasonryJoint()])


# -- acts ------------------------------------------------------------------------------------------


def assign(thing, name, value):
    """Set an attribute. If that is refused, the attribute must keep its old value."""
    before = repr(getattr(thing, name))
    try:
        setattr(thing, name, value)
    finally:
        assert repr(getattr(thing, name)) == before


def update(thing, **values):
    before = repr(thing.dict())
    try:
        thing.updateAttrs(values)
    finally:
        assert repr(thing.dict()) == before


def script(name, *words):
    """Run a scene of scripts/ with its options in this process. What it prints before ending with
    status 2 is the error."""
    said, argv = io.StringIO(), sys.argv
    sys.argv = [scenePath(name), *words]
    try:
        with contextlib.redirect_stderr(said):
            runpy.run_path(sys.argv[0])
    except SystemExit as end:
        assert end.code == 2, said.getvalue()
        raise ValueError(said.getvalue()) from None
    finally:
        sys.argv = argv


def said(line):
    """As above, of a line of words."""
    return lambda: script(*line.split())


def wall(act):
    """A wall of two courses, and what is said of it."""
    act(Scene("w", parts.Wall(0.44, 0.162), materials.calciumSilicate(), arguments=[]))


def pressed(stress):
    wall(lambda scene: scene.press(scene.platen("top"), stress))


def topped(**changes):
    wall(lambda scene: scene.platen("top", **changes))


STAGES = [{"load": ["push", "top", ""], "first_row": 0}]
WALL = json.dumps({"energy_balance_error": 0, "wall": {"courses": 2}, "stages": STAGES})
CURVE = "time_s,displacement_mm,base_shear_kN,top_shear_kN\r\n0,0,1,1\r\n1,1,2,2\r\n"


def files(run="{}", curve="time_s,base_shear_kN\r\n0,1\r\n1,2\r\n", **others):
    """A folder with the files of a run; None leaves one out."""
    for name, text in {"run.json": run, "curve.csv": curve, **others}.items():
        if text is not None:
            with open(name, "wb") as f:
                f.write(text if isinstance(text, bytes) else text.encode())


def read(act, *words, **content):
    """Run a program that reads results on a folder with these files. What it prints before status 2
    is the error."""
    if content:
        files(**content)
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        status = reading.onFolder(act, words or (".",))
    assert status == 2
    raise ValueError(said.getvalue())


def shown(*words, **content):
    """The same of the program that measures; run.json is of a wall unless it is given."""
    files = {"run": WALL, **content} if content else {}
    return lambda: read(measure.show, *words, **files)


def recorder(directory):
    MasonryVtkRecorder(directory=directory)()


def brokenRule(*_):
    raise ValueError("my rule is broken")


cube = list(corners((0, 0, 0), UNIT))
tetrahedron = [(0, 0, 0), (0.2, 0, 0), (0, 0.2, 0), (0, 0, 0.2)]
nothing = lambda: None
step = O.step

#: (scene, act, message), by subject.

CASES = {
    "block": [
        (
            nothing,
            lambda: addBlock(cube[:4], mat()),
            "4 corners span 0.13025 m but only 0 m out of a plane: no volume",
        ),
        (
            nothing,
            lambda: addBlock(5, None),
            [
                "vertices 5 must be a list with at least 4 values",
                "material None must be a MasonryMat",
            ],
        ),
        (
            nothing,
            lambda: addBlock(cube[:7] + cube[:1], mat()),
            "corner 7 (0, 0, 0) m is given twice",
        ),
        (
            nothing,
            lambda: addBlock(cube + [(0.1, 0.05, 0.04)], mat()),
            "corner 8 (0.1, 0.05, 0.04) m is no corner of the convex block",
        ),
        (
            nothing,
            lambda: addBlock(box((1e12, 0, 0)), mat()),
            "0.255641 m is too small to be told so far from the origin",
        ),
        (
            nothing,
            lambda: addBlock(cube, mat(density=5e-324)),
            "its mass of 0 kg and inertia are no numbers above 0",
        ),
    ],
    "material": [
        (
            nothing,
            lambda: MasonryMat(label="b", young=0, poisson=1, density=nan),
            ['MasonryMat "b": young 0', "poisson 1 must", "density nan"],
        ),
        (
            nothing,
            lambda: update(mat(), poisson=0.3, jointSet=None),
            "jointSet: expected a text, got None",
        ),
    ],
    "joint": [
        (
            nothing,
            lambda: MasonryJoint(name="b", cohesion=-1, friction=nan, peakRatio=0),
            ["cohesion -1", "friction nan", "peak ratio 0"],
        ),
        (nothing, lambda: assign(MasonryJoint(), "friction", -1), "friction -1 must be at least 0"),
        (
            nothing,
            lambda: update(MasonryJoint(), cohesion=2e5, friction=-1),
            "friction -1 must be at least 0",
        ),
        (
            nothing,
            lambda: MasonryJoint().compressionCurve([0, nan]),
            "closure nan m must be a finite number",
        ),
        (
            nothing,
            lambda: assign(MasonryJoint(), "tensionTable", None),
            "expected a list of (ratio, damage) rows, got None",
        ),
        (
            nothing,
            lambda: MasonryJoint(tensionTable=[(2, 0), (1, 2), (0, 1)]),
            ["row 1: must be", "row 2: damage 2", "row 2: ratio 1", "row 3: ratio 0"],
        ),
    ],
    "engines": [
        (
            joined,
            lambda: engines([], loads=5, zones="x", damping=2, subcontacts=0),
            [
                "joints [] must be a list with at least 1 value",
                "loads 5 must be",
                "zones 'x' must be",
                "damping 2",
                "subcontacts 0 must",
            ],
        ),
        (
            lambda: reorder(lambda e: e[:3]),
            step,
            "O.engines: there is no MasonryIntegrator (masonry.engines() puts them in order)",
        ),
        (
            lambda: (joined(), setattr(O.engines[-1], "dead", True)),
            step,
            "O.engines: there is no MasonryIntegrator",
        ),
        (
            lambda: reorder(lambda e: e[-1:] + e[:-1]),
            step,
            (
                "MasonryIntegrator must stand after the joints' loop; MasonryEnergy must stand"
                " before MasonryIntegrator"
            ),
        ),
        (lambda: reorder(lambda e: e[:1] + e[2:]), step, "O.engines: there is no MasonryJointLoop"),
        (
            lambda: reorder(lambda e: e + e[-1:]),
            step,
            'MasonryIntegrator "integrator" stands there twice',
        ),
        (
            lambda: reorder(lambda e: e + [NewtonIntegrator()]),
            step,
            "NewtonIntegrator stands beside MasonryIntegrator",
        ),
        (
            lambda: reorder(lambda e: e[:2] + [MasonryJointLoop()] + e[2:]),
            step,
            "MasonryJointLoop stands beside MasonryJointLoop",
        ),
        (
            lambda: reorder(lambda e: [MasonryLoad(body=1)] + e),
            step,
            "MasonryLoad must stand after the joints' loop",
        ),
        (
            lambda: reorder(lambda e: e + [MasonryLoad(body=1)]),
            step,
            "MasonryLoad must stand before MasonryIntegrator",
        ),
        (
            lambda: (deformable(), setattr(O, "engines", O.engines[:1] + O.engines[2:])),
            step,
            "O.engines: there is no MasonryJointLoop",
        ),
        (
            lambda: (deformable(), setattr(O, "engines", O.engines[-1:] + O.engines[:-1])),
            step,
            "MasonryZones must stand after the joints' loop",
        ),
        (
            lambda: reorder(lambda e: e + [MasonryZones(bodies=[1])]),
            step,
            "was made before MasonryZones had body 1: give the zones to masonry.engines()",
        ),
        (
            lambda: (joined(), setattr(O, "dt", nan)),
            step,
            "O.dt nan s must be a finite number above 0",
        ),
        (
            lambda: (joined(0, functors=True), setattr(O, "dt", inf)),
            step,
            "O.dt inf s must be a finite number above 0",
        ),
        (
            lambda: (deformable(), setattr(O, "dt", nan)),
            step,
            "O.dt nan s must be a finite number above 0",
        ),
        (laid, step, "no joints: call masonry.connect() before the first step"),
        (
            lambda: laid(functors=True),
            step,
            "no joints: call masonry.connect() before the first step",
        ),
        (
            lambda: (joined(), setattr(O.interactions[0, 1], "phys", MasonryJointPhys())),
            step,
            "bodies 0 and 1 is not one that connect() made",
        ),
        (
            lambda: (
                joined(0, functors=True),
                setattr(O.interactions[0, 1], "phys", MasonryJointPhys()),
            ),
            step,
            "is not one that connect() made",
        ),
        (
            lambda: (joined(), setattr(O.interactions[0, 1], "geom", MasonryJointGeom())),
            step,
            "is not one that connect() made",
        ),
        (
            nothing,
            lambda: MasonryIntegrator(damping=1, dampingKind="viscous", gravity=(0, nan, 0)),
            [
                "damping 1 must be 0 to 0.99",
                "dampingKind 'viscous' must be 'combined' or 'local'",
                "gravity must be finite numbers",
            ],
        ),
    ],
    "connect": [
        (blocks, connect, "needs the joints' engine in O.engines: call masonry.engines() first"),
        (lambda: engines([MasonryJoint()]), connect, "none of 0 bodies shares a face"),
        (
            lambda: (blocks(), setattr(O, "engines", [MasonryJointLoop()])),
            connect,
            "MasonryJointLoop has no geometry or no physics",
        ),
        (laid, lambda: connect(5), "connect: rule 5 must be a function"),
        (
            laid,
            lambda: connect(lambda *_: "bed"),
            "rule must return a MasonryJoint or None, got 'bed' for bodies 0 and 1",
        ),
        (laid, lambda: connect(brokenRule), "my rule is broken"),
        (joined, connect, "bodies 0 and 1 have a joint: connect() is called once"),
        (
            lambda: (blocks(), engines([MasonryJoint(name="head", direction=(1, 0, 0))])),
            connect,
            (
                'no joint fits bodies 0 and 1: joint sets "brick" and "brick", normal (0, 0, 1);'
                " offered: head"
            ),
        ),
        (
            lambda: (
                blocks(),
                engines([MasonryJoint(name="steel", jointSet="plate")], functors=True),
            ),
            connect,
            "offered: steel",
        ),
        (
            laid,
            lambda: Ip2_MasonryMat_MasonryMat_MasonryJointPhys().assign(None, None),
            "needs an interaction and a MasonryJoint, got None",
        ),
        (
            nothing,
            lambda: Ip2_MasonryMat_MasonryMat_MasonryJointPhys().assign(
                Interaction(), MasonryJoint()
            ),
            "body 0 does not exist",
        ),
        (
            nothing,
            lambda: Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom(
                subcontacts=0, rows=1001, tolerance=0, rowDirection=(nan, 0, 0)
            ),
            [
                "subcontacts 0 must be 1 to 1000",
                "rows 1001 must be",
                "tolerance 0 must be",
                "rowDirection must be finite numbers",
            ],
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 5), functors=True),
            lambda: utils.createInteraction(0, 1),
            "bodies 0 and 1 share no face: no joint can be made",
        ),
    ],
    "geometry": [
        (
            lambda: laid((0, 0, 0), (0, 0, 0.082)),
            connect,
            "bodies 0 and 1 nearly share a face, with a gap of 1 mm; the tolerance is 0.0256 mm",
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.0811)),
            lambda: connect(tolerance=2e-4),
            "a gap of 0.1 mm; the tolerance is 0.0511 mm",
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.081), (0, 0, 0.1621)),
            connect,
            "bodies 1 and 2 nearly share a face, with a gap of 0.1 mm",
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.080)),
            connect,
            "bodies 0 and 1 overlap by 1 mm; the tolerance is 0.0256 mm",
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.080)),
            lambda: connect(allowGaps=True),
            "bodies 0 and 1 overlap by 1 mm",
        ),
        (
            lambda: laid((0, 0, 0), (0.01, 0, 0.0405)),
            connect,
            "bodies 0 and 1 overlap by 40.5 mm",
        ),
        (
            lambda: laid(*[(0, 0, 0.082 * i) for i in range(15)]),
            connect,
            ["bodies 9 and 10 nearly share", "and 4 more", "help(masonry.connect)"],
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.080), (0.221, 0, 0)),
            connect,
            ["bodies 0 and 1 overlap by 1 mm", "bodies 0 and 2 nearly share"],
        ),
        (
            lambda: turned(1),
            connect,
            "bodies 0 and 1 nearly share a face, with a gap of 3.83894 mm",
        ),
        (lambda: turned(30), connect, "none of 2 bodies shares a face with another"),
        (
            lambda: laid((0, 0, 0), (0.22, 0, 0.081)),
            connect,
            "none of 2 bodies shares a face with another (tolerance 0.0001",
        ),
        (
            lambda: laid((0, 0, 0), (0, 0, 0.082)),
            lambda: connect(allowGaps=True),
            "none of 2 bodies shares a face with another",
        ),
        (
            lambda: foreign(FrictMat(density=1000)),
            connect,
            "body 1 has FrictMat, must have a MasonryMat",
        ),
        (
            lambda: foreign(mat()),
            connect,
            "body 1 lies 171.649 mm from its reference place state.refPos, which addBlock() sets",
        ),
        (
            lambda: (laid(), setattr(O.bodies[1], "material", None)),
            connect,
            "body 1 has no material, must have a MasonryMat",
        ),
        (
            lambda: state(1, pos=Vector3(nan, 0, 0)),
            connect,
            "body 1 has a place or velocity that is no finite number",
        ),
        (lambda: state(1, inertia=Vector3(0, 1, 1)), connect, "body 1 has an inertia of 0 kg m²"),
        (
            lambda: state(1, mass=nan, inertia=Vector3(nan, 1, 1)),
            connect,
            ["mass of nan kg", "inertia of nan kg m²"],
        ),
        (
            lambda: (joined(), setattr(O.bodies[1].state, "mass", 0)),
            lambda: criticalTimeStep(),
            "body 1 has a mass of 0 kg",
        ),
    ],
    "load": [
        (
            nothing,
            lambda: MasonryLoad(
                point=(nan, 0, 0), force=(inf, 0, 0), velocity=nan, direction=(0, 0, 0)
            ),
            [
                "point must be finite numbers [m]",
                "force must be finite numbers [N]",
                "velocity nan m/s",
                "direction must not be zero",
            ],
        ),
        (lambda: loaded(body=77), step, "MasonryLoad.body 77 does not exist"),
        (lambda: loaded(body=0, driven=True), step, "body 0 is blocked in the driven direction"),
        (lambda: (loaded(), O.bodies.erase(1)), step, "MasonryLoad.body 1 does not exist"),
        (
            lambda: (
                deformable(0),
                setattr(O, "engines", O.engines[:2] + [MasonryLoad(body=1)] + O.engines[2:]),
            ),
            step,
            "MasonryLoad.body 1 is a deformable unit",
        ),
    ],
    "zones": [
        (blocks, lambda: MasonryZones(bodies=[1, 1]), "body 1 stands twice in bodies"),
        (blocks, lambda: MasonryZones(bodies=[-1]), "body -1 does not exist"),
        (
            blocks,
            lambda: MasonryZones(bodies=[1, 8, 9]).nodesOf(1),
            ["body 8 does not exist", "body 9 does not exist"],
        ),
        (
            lambda: O.bodies.append(utils.sphere((0, 0, 0), 1)),
            lambda: MasonryZones(bodies=[0]).nodesOf(0),
            "body 0 is no block of MasonryMat",
        ),
        (
            nothing,
            lambda: MasonryZones(divisions=[0, 1, 101]),
            ["divisions 0 must be 1 to 100", "divisions 101 must be 1 to 100"],
        ),
        (
            nothing,
            lambda: MasonryZones(damping=nan, dampingKind="x", blocked="q", gravity=(0, 0, nan)),
            [
                "damping nan must be a finite number, 0 to 0.99",
                "dampingKind 'x' must be",
                "blocked 'q' must be made of x, y and z",
                "gravity must be finite numbers",
            ],
        ),
        (
            lambda: addBlock(box(size=(1, 1, 1e-4)), mat()),
            lambda: MasonryZones(bodies=[0]).nodesOf(0),
            "cannot be divided: block has a sliver zone",
        ),
        (deformable, lambda: zones().nodesOf(0), "body 0 is no deformable unit"),
        (deformable, lambda: zones().referencePoint(1, 99), "body 1 has no node 99"),
        (
            deformable,
            lambda: zones().setVelocity(0, (nan, 0, 0)),
            "velocity of a node must be finite numbers [m/s]",
        ),
        (
            deformable,
            lambda: assign(zones(), "bodies", [0]),
            "bodies and divisions cannot change once joints or a run know their nodes",
        ),
        (
            lambda: laid(zones=MasonryZones(bodies=[1, 8])),
            connect,
            "MasonryZones: body 8 does not exist",
        ),
        (lambda: (deformable(), O.bodies.erase(1)), step, "MasonryZones: body 1 does not exist"),
    ],
    "recorder": [
        (
            nothing,
            lambda: MasonryVtkRecorder(directory="", stepPeriod=-1),
            ["directory must not be empty", "stepPeriod -1 must be at least 0"],
        ),
        (
            joined,
            lambda: recorder("nowhere"),
            "cannot write nowhere/blocks_0000.vtu: No such file or directory",
        ),
        (
            joined,
            lambda: recorder("/dev/full"),
            "cannot write /dev/full/blocks_0000.vtu: Not a directory",
        ),
        (
            joined,
            lambda: recorder("/proc"),
            "cannot write /proc/blocks_0000.vtu: No such file or directory",
        ),
        (
            lambda: (joined(), os.symlink("/dev/full", "blocks_0000.vtu")),
            lambda: recorder("."),
            "cannot write ./blocks_0000.vtu: No space left on device",
        ),
        (
            lambda: (joined(), os.symlink("/dev/full", "joints_0000.vtp")),
            lambda: recorder("."),
            "cannot write ./joints_0000.vtp: No space left on device",
        ),
        (
            lambda: (joined(), os.symlink("/dev/full", "blocks.pvd.new")),
            lambda: recorder("."),
            "cannot write ./blocks.pvd.new: No space left on device",
        ),
    ],
    "wall": [
        (
            nothing,
            lambda: topped(upTo=0.1),
            "platen: upTo 0.1 m must be above the bricks, which end at 0.162 m",
        ),
        (
            nothing,
            lambda: topped(recorded=0.1),
            "platen: recorded 0.1 m is not on the platen, which begins at 0.162 m",
        ),
        (nothing, lambda: materials.Masonry(mat(), {}), "Masonry: joints {} must have 'bed'"),
    ],
    "option": [
        (joined, said("wall_comp4 --divisions 2"), "--divisions: rigid units are not divided"),
        (joined, said("wall_comp4 --unti 5"), "unrecognized arguments: --unti 5"),
        (
            joined,
            said("wall_comp4 --until x --rate 0 --blocks soft --nonsense"),
            [
                "--until: 'x' must be a number",
                "--rate: 0.0 mm/s must",
                "--blocks: invalid choice",
                "unrecognized arguments: --nonsense",
            ],
        ),
        (
            joined,
            said("wall_comp4 --resume nowhere"),
            "--resume: nowhere has no run.checkpoint, which a run leaves unless",
        ),
        (joined, said("wall_comp4 --set bed"), "'bed' must read JOINT.PROPERTY=VALUE"),
        (
            joined,
            said("wall_comp4 --set bed.tensionTable=1:0,1:1"),
            "row 2: ratio 1 must be above 1 of the row before",
        ),
        (
            joined,
            said("wall_comp4 --divisions 3 --set bed.friction=-1 --set x.y=1"),
            ["rigid units are not divided", "friction -1 must be at least 0", "no joint 'x'"],
        ),
        (
            joined,
            said("wall_dry --crack-surfaces on --set bed.cohesion=-1"),
            [
                "--crack-surfaces on: the bricks are in pieces, and these materials have no joint",
                "cohesion -1 Pa must be at least 0",
            ],
        ),
        (
            joined,
            said("couplet --normal-stress -8"),
            "pressJoint: -8 MPa crushes the bed joint, whose compressive strength is 7.55 MPa",
        ),
    ],
    "output": [
        (joined, lambda: script("wall_comp4", "--out", ""), "argument --out: must not be empty"),
        (
            lambda: (joined(), open("file", "w").close()),
            said("wall_comp4 --out file"),
            "/file: File exists",
        ),
        (
            lambda: (joined(), open("file", "w").close()),
            said("couplet --out file/below"),
            "/file/below: Not a directory",
        ),
        (joined, said("wall_comp1 --out /proc"), "/proc holds"),
        (
            lambda: (joined(), os.makedirs("r/curve.csv")),
            said("couplet --out r"),
            "r holds curve.csv, which no run has left there",
        ),
        (
            nothing,
            lambda: results.Results("r", ["a"]).checkSpace(1e18, 1e18),
            "free, this run writes at least 1000000000000.0 MB",
        ),
    ],
    "files": [
        (nothing, shown("a", "b"), "name one folder of results, for example results/wall_comp4"),
        (nothing, shown("nowhere"), "cannot read nowhere/run.json: No such file or directory"),
        (nothing, shown(run=""), "run.json: Expecting value: line 1 column 1"),
        (
            nothing,
            shown(run="{}"),
            "not the files of a finished run (KeyError: 'energy_balance_error')",
        ),
        (nothing, shown(curve=None), "cannot read ./curve.csv: No such file or directory"),
        (nothing, shown(curve=""), "curve.csv: there is no row of numbers"),
        (nothing, shown(curve="a,b\r\n1,2\r\n3\r\n"), "curve.csv, line 3: 1 numbers in 2 columns"),
        (
            nothing,
            shown(curve="a,b\r\n1,x\r\n3,\r\n"),
            ["line 2: could not convert string to float: 'x'", "line 3: could not"],
        ),
        (nothing, shown(curve="a,b\r\n1,nan\r\n"), "curve.csv, line 2: a number is not finite"),
        (nothing, shown(curve="a,b\r\n1,2\r\n"), "nothing was pushed in this run"),
        (
            nothing,
            shown(curve=CURVE, **{"joints_0000.vtp": "<VTKFile"}),
            "cannot read ./joints_0000.vtp: it holds no frame",
        ),
        (nothing, lambda: readFrame(".", "joints"), "no file joints_*.vt? in ."),
    ],
}


def snapshot():
    """All numbers that a refused input must leave as they were."""
    kinds = [(type(e).__name__, e.label) for e in O.engines]
    motion = lambda s: (s.pos, s.ori, s.vel, s.mass, s.blockedDOFs)
    made = lambda i: (i.id1, i.id2, i.geom.jumps, i.phys.stress, i.phys.dissipated)
    bodies = [motion(b.state) for b in O.bodies]
    joints = [made(i) for i in O.interactions]
    return repr((O.iter, O.time, O.dt, kinds, bodies, joints))


EVERY = {}
for subject, cases in CASES.items():
    EVERY |= {f"{subject}-{number}": case for number, case in enumerate(cases)}


@mark.parametrize("case", EVERY)
def test_bad_input_is_refused_and_nothing_is_lost(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given, act, message = EVERY[case]
    given()
    before = snapshot()
    with raises((ValueError, RuntimeError)) as refused:
        act()
    said = str(refused.value)
    for part in [message] if isinstance(message, str) else message:
        assert part in said
    assert snapshot() == before


# -- what is unusual, and what is accepted ---------------------------------------------------------


def joint(**changes):
    blocks()
    engines([MasonryJoint(**changes)])
    connect()


def unit(**changes):
    pile(material=mat(**changes))
    engines([MasonryJoint()])
    connect()


def bricks(size, *more):
    laid((0, 0, 0), (0, 0, size[2]), *more, size=size)
    connect()


def wedge():
    """A brick, and on it a deformable block that is no hexahedron."""
    addBlock(box(), mat())
    addBlock([(x, y, z + UNIT[2]) for x, y, z in tetrahedron], mat())
    zones = MasonryZones(bodies=[1], divisions=[2, 1, 2])
    engines([MasonryJoint()], zones=zones)
    connect()


def loads(**settings):
    laid(loads=[MasonryLoad(body=1, **settings)])
    connect()


HINTS = [
    (lambda: bricks((220, 102, 81)), "body 0 is 255.666 m long: are corners in m, not mm?"),
    (lambda: bricks((2.2e-4, 1.02e-4, 8.1e-5)), "body 0 is 8.1e-05 m thick: are corners in m?"),
    (lambda: bricks(UNIT, (5, 0, 0), (6, 0, 0)), "no joint holds bodies [2, 3]"),
    (
        lambda: unit(young=4800, label="brick"),
        'MasonryMat "brick": young 4800 Pa: is it in Pa, not MPa?',
    ),
    (lambda: unit(density=1.8), "density 1.8 kg/m³ weighs 17.658 N/m³: is it in kg/m³?"),
    (
        lambda: joint(tensileStrength=0.1, cohesion=0.11),
        ["tensileStrength 0.1 Pa: is it in Pa, not MPa?", "cohesion 0.11 Pa: is it"],
    ),
    (
        lambda: joint(friction=30, residualFriction=30, tensileStrength=0),
        'MasonryJoint "bed": friction 30: is it a tangent, not an angle in degrees?',
    ),
    (
        lambda: joint(cohesion=1e12, tensileStrength=1e12),
        "cohesion 1e+12 Pa: is it in Pa, not MPa?",
    ),
    (
        lambda: joint(normalStiffness=335, shearStiffness=144, cap=False),
        ["normalStiffness 335 Pa/m: is it in Pa/m, not N/mm³?", "shearStiffness 144"],
    ),
    (lambda: joint(modeIIFractureEnergy=1.6e8), "modeIIFractureEnergy 1.6e+08 J/m²: is it in J/m²"),
    (
        lambda: joint(shearStiffnessLoss=0.5),
        'MasonryJoint "bed" follows the law "softening": no effect of shearStiffnessLoss',
    ),
    (
        lambda: joint(
            initialClosingStiffness=1e10,
            closureLimit=1e-4,
            tensileStrength=0,
            compressionStiffnessLoss=0,
        ),
        "no effect of compressionStiffnessLoss, initialClosingStiffness, closureLimit",
    ),
    (
        lambda: joint(law="cyclic", elastic=True, bondLossByCrushing=0),
        'MasonryJoint "bed" is elastic: no effect of bondLossByCrushing',
    ),
    (
        lambda: loads(point=(110, 51, 162)),
        "MasonryLoad: its point lies 202.179 m from body 1: is it in m?",
    ),
    (lambda: (laid(zones=MasonryZones()), connect()), "MasonryZones has no bodies"),
    (wedge, "MasonryZones: divisions do not apply to bodies [1], which are no hexahedra"),
    (lambda: pressed(0.5), "press: 0.5 Pa: is it in Pa, not MPa?"),
    (
        lambda: results.Results("r", ["a"]).checkSpace(1, 1e18),
        "free, this run writes some 1000000000000.0 MB",
    ),
]


@mark.parametrize("act, hints", HINTS)
def test_what_may_be_a_slip_is_reported(act, hints, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        act()
    except ValueError as error:  # what does not fit the size of the units is refused
        assert "snap back" in str(error)
    said = capsys.readouterr().out
    warnings = [line for line in said.splitlines() if line.startswith("warning: ")]
    for hint in [hints] if isinstance(hints, str) else hints:
        assert any(hint in line for line in warnings), said


def test_gaps_that_are_meant_are_left_and_a_tolerance_of_the_users_makes_the_joint():
    laid((0, 0, 0), (0, 0, 0.081), (0.222, 0, 0))
    assert len(connect(allowGaps=True)) == 1
    O.reset()
    laid((0, 0, 0), (0, 0, 0.082))
    assert len(connect(tolerance=0.005)) == 1


# -- as a user meets it ----------------------------------------------------------------------------


WRONG = {"--rate=0": "--rate: 0.0 mm/s must", "--normal-stress=-8": "crushes the bed"}


@mark.slow
@mark.parametrize("word", WRONG)
def test_the_command_line_ends_with_status_2_and_leaves_files(tmp_path, word):
    before = tmp_path / "results" / "couplet" / "curve.csv"
    before.parent.mkdir(parents=True)
    before.write_text("of another run")
    run = runProgram("couplet", word, cwd=tmp_path, check=False)
    assert run.returncode == 2
    assert WRONG[word] in run.stderr and "Traceback" not in run.stderr
    assert before.read_text() == "of another run"


@mark.slow
@mark.parametrize(
    "name, words, most, lost",
    [
        ("couplet", ["--no-vtk"], 100e3, "curve.csv"),  # in the middle of the run
        ("wall_comp0a", ["--until", "0.1"], 215e3, "joints_0001.vtp"),
        ("wall_comp0a", ["--until", "0.05", "--no-vtk"], 60e3, "curve.png"),
    ],
)
def test_a_disk_that_fills_ends_the_run_in_order(tmp_path, name, words, most, lost):
    limit = (int(most), int(most))
    env = {**os.environ, "IPYTHONDIR": str(tmp_path)}  # YADE's shell keeps a history
    # files that may not grow fail as on a full disk do, with another reason
    small = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    around = dict(check=False, cwd=tmp_path, env=env, preexec_fn=small)
    run = runProgram(name, *words, "--out", "results", **around)
    assert run.returncode == 1, run.stdout + run.stderr
    assert "Traceback" not in run.stderr
    said = f"{lost}: File too large; what was written before is kept"
    if lost == "curve.png":
        said = "the figures are not drawn; what was written before is"
    assert said in run.stderr
    out = tmp_path / "results"
    curve = readCurve(out)  # whole lines only
    assert all(len(column) == len(curve["time_s"]) for column in curve.values())
    assert readRun(out)["steps"] > 0
    assert not (out / lost).exists() or lost == "curve.csv"
    if "--no-vtk" not in words:
        assert len([*out.glob("blocks_*")]) == len([*out.glob("joints_*")]) == 1
        assert len(readFrame(out, "joints")["cells"]) > 100
