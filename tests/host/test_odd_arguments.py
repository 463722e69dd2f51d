# SPDX-License-Identifier: GPL-2.0-or-later
"""Every word that a script may use, with odd values: each is refused in a sentence, or means
something.

A word is found by looking at the package; one without an example here is a failure. The values of
an argument are drawn with a seed that the message of a failure has; ODD_SEED=number draws others.
"""

import inspect
import io
import operator
from decimal import Decimal
from fractions import Fraction

import masonry
from hosted import *
import masonry_capacity as capacity
from masonry import fields
from masonry import arguments
from masonry.scene import options
from masonry_study.spectrum import spectralAcceleration
from masonry.numbers import frames
from masonry_view import measure, report
from masonry_study import Study, variables

sys.path.insert(1, os.path.join(ROOT, "scripts", "docs"))
import validators

SEED = int(os.environ.get("ODD_SEED", 1))
DRAWN = 4  # values of each argument
LONGEST = 20  # [s] that one word may take

WALL = bricks.Wall(0.44, 0.243)
SCENE_OPTIONS = ["--out", "odd", "--lean", "--quick"]


class Odd:
    pass


def odd():
    """Odd values. Another scene and its targets are among them."""
    other = Scene(
        "other", bricks.stack(2, (0.2, 0.1, 0.1)), materials.dry(0.5), arguments=["--out", "other"]
    )
    numbers = [math.nan, math.inf, -1, 0, 1e300, -1e300, 1e-300, 10**400]
    numbers += [np.float32(0.5), np.int64(1), np.bool_(True), 1 + 2j, Decimal("1"), Fraction(1, 3)]
    texts = ["1", "", "x", "a\x00\n\x1b[31mb", "x" * 100000, "\udc80", b"x"]
    several = [[], {}, (1, 2), (1, 2, 3, 4), (0, 0, 0), (math.nan, 0, 0), ("a", "b", "c"), {1.0}]
    several += [(1e300,) * 3, [[1, 2, 3]], [math.nan], [True], [None], Vector3(1, 0, 0)]
    several += [np.array([1.0, 0, 0]), np.array(1.0), np.ones((3, 3))]
    things = [True, False, None, Odd(), math, ..., other, other.handle(1, name="theirs")]
    return [*numbers, *texts, *several, *things, MasonryJoint(), materials.dry(0.5)]


# -- examples: what stands before a word, and legal arguments of it --------------------------------


def scene(blocks=WALL, stones=None, **settings):
    """A scene that has not begun, with a platen below and one above."""
    made = Scene(
        "odd",
        blocks,
        stones or materials.calciumSilicate(),
        **{"arguments": SCENE_OPTIONS, **settings},
    )
    made.base = made.platen("bottom", name="under")
    made.top = made.platen("top", name="over")
    return made


def bare():
    return Scene("odd", WALL, materials.calciumSilicate(), arguments=SCENE_OPTIONS)


def space():
    made = Scene(
        "odd",
        bricks.stack(3, (0.2, 0.15, 0.1)),
        materials.dry(0.6),
        arguments=SCENE_OPTIONS,
        plane=False,
    )
    made.platen("bottom")
    return made


def settled(make=scene):
    made = make()
    made.settle(longest=0.05)
    return made


def pressing():
    made = scene()
    made.press(made.top, 1e5)
    return settled(lambda: made)


def holding():
    made = scene()
    made.brick, made.grip = made.hold(3), made.handle(5)
    return settled(lambda: made)


def driven():
    blocks = bricks.stack(2, (0.2, 0.1, 0.05))
    made = Scene("odd", blocks, materials.calciumSilicate(), arguments=SCENE_OPTIONS, rate=100)
    made.platen("bottom")
    made.top, made.between = made.platen("top", drive="xz"), made.joint(0, 1)
    return made


class Of:
    """An argument that belongs to the scene of an example: its attribute of this name."""

    def __init__(self, name):
        self.name = name


TOP, LEVEL = Of("top"), (1, 0, 0)
PUSHES = dict(target=TOP, rate=200.0, control=TOP)
TRAIN = dict(axles=[(0.0, 1.0)], spread=0.0, longest=0.05)
WINDS = dict(pressure=10.0, towards=LEVEL)
GROWS = dict(over=0.02, within=0.5)

#: What stands before a word of a scene, and its arguments but for those that have a default. A word
#: that describes, and is a stage later, has two examples.
WORDS = {
    "platen": (bare, dict(where="top")),
    "hold": (bare, dict(where=0)),
    "watch": (bare, dict(where=0)),
    "handle": (bare, dict(where=0)),
    "press": (scene, dict(platen=TOP, stress=1e5)),
    "load": (scene, dict(target=TOP, force=(0, 0, -1e3))),
    "wind": (space, WINDS),
    "pressure": (space, dict(value=10.0, towards=LEVEL, friction=5.0)),
    "drift": (scene, dict(lower=Of("base"), upper=TOP)),
    "column": (scene, dict(name="own_mm", meaning="mine", value=lambda: 1.0)),
    "joint": (scene, dict(one=0, two=1)),
    "section": (scene, dict(z=0.1)),
    "pier": (scene, dict(low=(-9, -9, -9), high=(9, 9, 9))),
    "spandrel": (scene, dict(low=(-9, -9, -9), high=(9, 9, 9))),
    "tie": (scene, dict(one=2, other=TOP, stiffness=1e6, strength=1e3)),
    "overlay": (space, dict(side=(0, 1, 0), stiffness=1e7, strength=1e4, gauge=0.1)),
    "ground": (lambda: scene(collapse="follow"), dict(level=-5.0)),
    "spring": (scene, dict(one=2, stiffness=(1e6, 0, 0))),
    "view": (scene, dict(direction=(0, 1, 0))),
    "settle": (scene, dict(longest=0.05)),
    "push": (settled, dict(until=0.2, **PUSHES)),
    "cycle": (settled, dict(amplitudes=[0.3], **PUSHES)),
    "follow": (settled, dict(path="path.csv", **PUSHES)),
    "drive": (driven, dict(target=TOP, z=0.01)),
    "pressJoint": (driven, dict(target=TOP, joint=Of("between"), stress=-1e5)),
    "release": (holding, dict(target=Of("brick"), axes="xz")),
    "move": (settled, dict(target=Of("base"), z=-0.05, rate=20.0)),
    "tilt": (settled, dict(degrees=0.5, rate=20.0, within=0.5)),
    "accelerate": (settled, dict(most=0.02, rate=1.0, within=0.5)),
    "lean": (settled, dict(factor=0.01, longest=0.05)),
    "shake": (settled, dict(accelerations=[0.0, 2.0, 0.0], every=0.002, damping=0.1)),
    "period": (settled, {}),
    "shakeAgain": (settled, dict(records=[[0.0, 2.0, 0.0]], every=0.002, longest=0.05)),
    "run": (settled, dict(seconds=0.01)),
    "grow": (lambda: settled(space), dict(loads={}, most=2.0, dead=True, pressure=10.0, **GROWS)),
    "travel": (lambda: settled(space), dict(force=100.0, along=[(0.1, 0.1, 1.0)], **TRAIN)),
    "bracket": (settled, dict(carries=lambda f: f < 0.5, low=0.0, high=1.0, within=0.3)),
    "result": (settled, dict(name="mine", value=1.0, how="by hand")),
    "bound": (settled, dict(target=TOP)),
    "domain": (pressing, dict(target=TOP, normal=[20.0, 40.0])),
    "load, a stage": (settled, dict(target=TOP, force=(100.0, 0, 0), longest=0.05)),
    "wind, a stage": (lambda: settled(space), dict(**WINDS, longest=0.05)),
    "pressure, a stage": (lambda: settled(space), dict(value=10.0, towards=LEVEL, longest=0.05)),
    "press, a stage": (settled, dict(platen=TOP, stress=1e4, longest=0.05)),
    "hold, a stage": (holding, dict(target=Of("grip"), axes="xz")),
}
#: Methods of a scene that scripts do not call with arguments of their own: other parts of the
#: package do.
INTERNAL = {"checkOpen", "failed", "findBound", "keepState", "noted", "probe"}

CUBE = bricks.boxCorners((0, 0, 0), (1, 1, 1))
RING = dict(thickness=0.3, stones=9, radius=2.0, angle=90)
FIELD = dict(cov=0.2)
ABOUT = dict(mean=1.0, cov=0.1, low=0.5, high=2.0)
CLAY = dict(
    E=4e9,
    unit_E=9e9,
    fc=12e6,
    fv0=0.2e6,
    friction=0.6,
    unit=(0.25, 0.12, 0.065),
    joint=0.01,
    density=1800,
    bond_wrench=0.3e6,
)


def opening(**values):
    return bricks.Wall(0.88, 0.486, openings=[bricks.Opening(**values)])


def lintel(**values):
    over = bricks.Lintel(**values)
    return bricks.Wall(1.32, 0.486, openings=[bricks.Opening(0.44, 0.081, 0.22, 0.162, over)])


def laid():
    pile()
    engines([MasonryJoint()])


def joined():
    pile()
    join()


def sceneOptions():
    """The options that a scene takes as keywords, with values that they may have."""
    aside = {"resume", "preset", "history", "out", "lean", "quick", "no_vtk", "ratios"}
    found = {n: [] if o.several else o.default for n, o in options.OPTIONS.items()}
    return {n: value for n, value in found.items() if n not in aside}


#: The curve of a push [mm, kN], and what capacity makes of it.
CURVE = dict(displacement=[0.0, 1.0, 2.0, 4.0, 6.0], force=[0.0, 8.0, 10.0, 9.0, 7.0])
BILINEAR, SYSTEM = capacity.bilinear(**CURVE), capacity.equivalent(3e4, 1.0)
SPECTRUM = capacity.elastic(0.1, "g", 1, "B")
DEMAND = dict(system=SYSTEM, spectrum=SPECTRUM)
MASSES = [
    dict(name="equivalent_mass", value=3e4, unit="kg"),
    dict(name="participation_factor", value=1.0, unit="-"),
]
STUDY = dict(scene="wall_comp4", options={"rate": 50}, runs=3, vary={"bed.friction": [0.5, 0.6]})


def iterated(push=None, **settings):
    """The target displacement of a push; by default that of the folder of the examples."""
    return capacity.iterated(capacity.pushover("run") if push is None else push, **settings)


#: Functions and classes by their names: what is called, its arguments but for those that have a
#: default, and what stands before.
CALLS = {
    "Scene": (
        Scene,
        dict(
            name="odd",
            bricks=WALL,
            materials=materials.calciumSilicate(),
            arguments=SCENE_OPTIONS,
            **sceneOptions(),
        ),
    ),
    "materials.dry": (materials.dry, {}),
    "materials.masonry": (materials.masonry, CLAY),
    "materials.en1996": (materials.en1996, dict(unit="clay", fb=15e6, mortar="M5")),
    "materials.ntc2018": (materials.ntc2018, dict(masonry="rubble", knowledge="LC1")),
    "materials.Masonry": (
        materials.Masonry,
        dict(unit=MasonryMat(), joints={"bed": MasonryJoint()}),
    ),
    "materials.calciumSilicateJoints": (materials.calciumSilicateJoints, {}),
    "materials.dryGranite": (materials.dryGranite, dict(level=100, height=0.15)),
    "materials.dryGraniteJoints": (materials.dryGraniteJoints, dict(level=100, height=0.15)),
    "materials.compressiveFractureEnergy": (materials.compressiveFractureEnergy, dict(fc=1e7)),
    "materials.leastEnergy": (materials.leastEnergy, dict(strength=1e5, stiffness=1e10)),
    "materials.linesOf": (materials.linesOf, dict(entries=[], brief=False)),
    "materials.withResidual": (
        materials.withResidual,
        dict(names=["bed.friction"], joints=materials.calciumSilicateJoints()),
    ),
    "Masonry.vary": (
        materials.calciumSilicate().vary,
        dict(name="bed.cohesion", value=lambda x, y, z: 1.0),
    ),
    "fields.lognormal": (fields.lognormal, FIELD),
    "fields.normal": (fields.normal, FIELD),
    "study.lognormal": (variables.lognormal, ABOUT),
    "study.normal": (variables.normal, ABOUT),
    "study.uniform": (variables.uniform, dict(low=0.5, high=2.0)),
    "study.field": (variables.field, dict(length=0.5, cov=0.1)),
    "study.choice": (
        lambda value, weights: variables.choice(value, "other", weights=weights),
        dict(value=1, weights=[1, 2]),
    ),
    "bricks.Wall": (bricks.Wall, dict(length=0.88, height=0.243)),
    "bricks.Corner": (bricks.Corner, dict(length=0.88, length2=0.88, height=0.243)),
    "bricks.Tee": (bricks.Tee, dict(length=1.1, length2=0.88, at=0.55, height=0.243)),
    "bricks.Room": (getattr(bricks, "Room"), dict(length=0.88, width=0.88, height=0.243)),
    "bricks.Arch": (bricks.Arch, dict(depth=0.5, skewback=0.3, **RING)),
    "bricks.BarrelVault": (bricks.BarrelVault, dict(length=1.0, rows=2, **RING)),
    "bricks.CrossVault": (
        bricks.CrossVault,
        dict(span=3.0, thickness=0.2, stones=6, rows=2, length=2.0, pier=0.3),
    ),
    "bricks.Dome": (
        bricks.Dome,
        dict(radius=2.0, thickness=0.3, courses=3, stones=6, oculus=0.5, angle=120.0),
    ),
    "bricks.stack": (bricks.stack, dict(count=3, size=(0.2, 0.1, 0.1))),
    "bricks.Beam": (bricks.Beam, dict(start=(0, 0, 0), length=2.0, width=0.1, height=0.2)),
    "bricks.Floor": (bricks.Floor, dict(start=(0, 0, 0), length=2.0, width=1.0, height=0.2)),
    "bricks.block": (bricks.block, dict(low=(0, 0, 0), high=(1, 1, 1))),
    "bricks.Block": (bricks.Block, dict(corners=CUBE, brick=0)),
    "bricks.Bricks": (bricks.Bricks, dict(blocks=list(WALL))),
    "bricks.StoneWall": (bricks.StoneWall, dict(length=0.88, height=0.6, unit=(0.2, 0.1, 0.15))),
    "bricks.leastTrace": (bricks.leastTrace, dict(bricks=WALL)),
    "bricks.boxCorners": (bricks.boxCorners, dict(low=(0, 0, 0), high=(1, 1, 1))),
    "bricks.summary": (bricks.summary, dict(bricks=WALL)),
    "bricks.fromFile": (bricks.fromFile, dict(path="cube.obj")),
    "bricks.readCompas": (bricks.readCompas, dict(path="cube.json")),
    "bricks.fromOutlines": (
        bricks.fromOutlines,
        dict(path="stones.csv", thickness=0.2, mortar=0.02),
    ),
    "bricks.Storey": (bricks.Storey, dict(height=0.81)),
    "bricks.House": (
        bricks.House,
        dict(length=0.88, width=0.88, storeys=[bricks.Storey(0.81)], thickness=0.1),
    ),
    "bricks.Opening": (opening, dict(x=0.22, z=0.081, width=0.22, height=0.162, lintel=None)),
    "bricks.Lintel": (lintel, dict(bearing=0.11, height=0.081)),
    "Bricks.moved": (WALL.moved, {}),
    "Bricks.turned": (WALL.turned, dict(degrees=30.0)),
    "Bricks.named": (WALL.named, dict(part="p")),
    "Bricks.ofKind": (WALL.ofKind, dict(kind="k")),
    "Bricks.where": (WALL.where, dict(function=lambda block: True)),
    "Bricks.within": (WALL.within, dict(low=(0, 0, 0), high=(1, 1, 1))),
    "Bricks.cut": (WALL.cut, dict(point=(0.1, 0, 0), normal=LEVEL)),
    "Bricks.alongLine": (WALL.alongLine, dict(begin=(0, 0, 0), end=(0, 0, 0.2))),
    "Bricks.freeFaces": (WALL.freeFaces, dict(direction=(0, 1, 0))),
    "capacity.assess": (
        capacity.assess,
        dict(directory="run", rule="masonry", height=1.0, spectrum=SPECTRUM, system=SYSTEM),
    ),
    "capacity.assessDomain": (capacity.assessDomain, dict(directory="run")),
    "capacity.bilinear": (capacity.bilinear, CURVE),
    "capacity.bilinearOf": (capacity.bilinearOf, dict(directory="run")),
    "capacity.demand": (capacity.demand, dict(curve=BILINEAR, **DEMAND)),
    "capacity.domain": (capacity.domain, dict(directory="run")),
    "capacity.drifts": (capacity.drifts, dict(directory="run", height=1.0)),
    "capacity.elastic": (capacity.elastic, dict(ag=0.1, unit="g", type=1, ground="B")),
    "capacity.equivalent": (capacity.equivalent, dict(mass=3e4, gamma=1.0)),
    "capacity.iterated": (iterated, dict(limited=False, **DEMAND)),
    "capacity.ofMasses": (capacity.ofMasses, dict(masses=[1e3, 2e3], shape=[0.5, 1.0])),
    "capacity.ofRun": (capacity.ofRun, dict(run=dict(answers=MASSES))),
    "capacity.panelPressure": (
        capacity.panelPressure,
        dict(length=4, height=3, unit=(0.24, 0.11, 0.086), flexural=0.2e6, rupture=0.8e6),
    ),
    "capacity.pushover": (capacity.pushover, dict(directory="run")),
    "capacity.readSpectrum": (
        capacity.readSpectrum,
        dict(path="spectrum.csv", unit="g", corner=0.5),
    ),
    "capacity.runPoint": (capacity.runPoint, dict(directory="run")),
    "spectralAcceleration": (spectralAcceleration, dict(values=[1.0, 2.0], every=0.01, period=1.0)),
    "measure.measure": (measure.measure, dict(directory="run")),
    "report.read": (report.read, dict(directory="run")),
    "frames.frameTimes": (frames.frameTimes, dict(directory="run")),
    "frames.readFrame": (frames.readFrame, dict(directory="run", kind="blocks")),
    "study.Study": (Study, STUDY),
    "rayleigh": (masonry.rayleigh, dict(ratio=0.05, low=1.0, high=10.0)),
    "addBlock": (addBlock, dict(vertices=CUBE, material=MasonryMat(density=1800))),
    "engines": (engines, dict(joints=[MasonryJoint()]), pile),
    "connect": (connect, {}, laid),
    "touchingPairs": (masonry.touchingPairs, {}, laid),
    "advance": (masonry.advance, dict(steps=2), joined),
    "engine": (masonry.engine, dict(label="joints"), joined),
    "saveCheckpoint": (masonry.saveCheckpoint, dict(path="saved"), joined),
    "loadCheckpoint": (masonry.loadCheckpoint, dict(path="kept"), joined),
    "readCheckpoint": (masonry.readCheckpoint, dict(path="kept"), joined),
}

CUBE_FILE = (
    "".join("v {} {} {}\n".format(*c) for c in CUBE)
    + "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
)


@pytest.fixture(scope="module")
def pushed(tmp_path_factory):
    """The folder of a short push."""
    out = tmp_path_factory.mktemp("pushed") / "run"
    O.reset()
    blocks = bricks.stack(3, (0.4, 0.3, 0.2))
    words = ["--out", str(out), "--vtk-every", "1"]
    made = Scene("pile", blocks, materials.calciumSilicate(), arguments=words, rate=50)
    made.platen("bottom")
    top = made.platen("top", rotation="free")
    made.press(top, 1e5)
    made.domain(top, [20])
    made.settle()
    made.push(top, 2.0)
    made.finish()
    return out


@pytest.fixture
def folder(tmp_path, monkeypatch, pushed):
    """A folder with the files of the examples."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "path.csv").write_text("displacement_mm\n0.05\n-0.05\n0\n")
    (tmp_path / "cube.obj").write_text(CUBE_FILE)
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    vertices = {str(n): dict(zip("xyz", corner)) for n, corner in enumerate(corners)}
    faces = dict(zip("abcd", [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]))
    (tmp_path / "cube.json").write_text(json.dumps(dict(vertex=vertices, face=faces)))
    (tmp_path / "stones.csv").write_text("a,0,0\na,1,0\na,1,1\na,0,1\n")
    (tmp_path / "spectrum.csv").write_text("0 0.1\n0.1 0.3\n0.5 0.3\n4 0.04\n")
    shutil.copytree(pushed, tmp_path / "run")
    joined()
    masonry.saveCheckpoint("kept", 1)
    return tmp_path


# -- what comes of a word --------------------------------------------------------------------------


@contextlib.contextmanager
def shortly():
    """A word that takes too long is a failure."""

    def stop(*_):
        raise AssertionError(f"it takes longer than {LONGEST} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(LONGEST)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def said(name, change):
    """What is said when an example is called with other arguments, or None if they are taken."""
    O.reset()
    printed, made = io.StringIO(), None
    quietly = contextlib.redirect_stdout(io.StringIO())
    with shortly(), contextlib.redirect_stderr(printed), quietly:
        if name in WORDS:
            before, example = WORDS[name]
            made = before()
            act = getattr(made, name.partition(",")[0])
        else:
            act, example, *before = CALLS[name]
            for make in before:
                make()
        example = {n: getattr(made, v.name) if isinstance(v, Of) else v for n, v in example.items()}
        try:
            act(**{**example, **change})
            return None
        except ValueError as refused:
            assert type(refused) in (ValueError, Refused, ScriptRefused), repr(refused)
            return str(refused)
        except FileNotFoundError as missing:
            assert name in ("loadCheckpoint", "readCheckpoint")  # as they promise
            return f"{name}: {missing}"
        except SystemExit as end:
            assert end.code == 2
            return printed.getvalue()
        finally:
            if made:
                made.finished = True
                if made.results:
                    made.results.release()


def argumentsOf(act):
    try:
        named = inspect.signature(act).parameters.values()
    except ValueError:  # classes of the plugin
        return set()
    of = {p.name for p in named if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)}
    return of - {"self", "scene", "description"}  # which a script does not give


def legalOf(name):
    """Names of all arguments of a word."""
    if name in CALLS:
        return argumentsOf(CALLS[name][0]) | set(CALLS[name][1])
    isStage = name.endswith(", a stage")
    others = set() if isStage else argumentsOf(getattr(Scene, name))
    return others | set(WORDS[name][1])


#: Sentences of Python and of its libraries, which name nothing that a script has said.
NOT_OURS = (
    "truth value|could not be broadcast|codec can't|JSON compliant|unpack|invalid literal|NoneType"
)
#: By what else a message may name an argument: a property in words, points as corners, what a
#: lintel lies on, or the end of a file's name.
OTHERWISE = {
    "readCompas": "cannot read",
    "addBlock": "corner",
    "bricks.Lintel": "openings",
    "bricks.from": "must end with",
    "readFrame": "no file",
    "readSpectrum": "cannot read",
    "assess": "mass",
}


def isNamed(name, argument, message):
    """Whether a message names an argument, one value of it, the word or what stands for it."""
    word = name.partition(",")[0].rpartition(".")[2]
    one = argument.rstrip("2").removesuffix("s")
    found = [f for n, f in OTHERWISE.items() if n in name] + [one, word]
    return any(text.lower() in message.lower() for text in found)


#: Words that take steps, some tenths of a second each time.
STEPS = {
    "accelerate",
    "bound",
    "cycle",
    "domain",
    "follow",
    "grow",
    "load, a stage",
    "move",
    "pressJoint",
    "push",
    "result",
    "shake",
    "shakeAgain",
    "tilt",
    "travel",
}


@mark.parametrize(
    "name", [pytest.param(n, marks=[mark.slow] * (n in STEPS)) for n in (*WORDS, *CALLS)]
)
def test_odd_values_are_refused_in_a_sentence_or_mean_something(folder, name):
    values = odd()
    assert said(name, {}) is None
    for argument in sorted(legalOf(name)):
        drawn = random.Random(f"{SEED} {name} {argument}")
        for value in drawn.sample(values, DRAWN):
            where = f"{name}({argument}={value!r:.60}), ODD_SEED={SEED}"
            try:
                message = said(name, {argument: value})
            except Exception as error:
                raise AssertionError(f"{where}: {error!r}") from error
            if message is not None:
                assert not re.search(NOT_OURS, message), f"{where}: {message}"
                assert isNamed(name, argument, message), f"{where}: {message}"


# -- every word is here ----------------------------------------------------------------------------


def test_every_word_of_a_scene_has_an_example_and_validators_of_all_its_arguments():
    members = inspect.getmembers(Scene, lambda t: callable(t) and argumentsOf(t))
    words = {n for n, _ in members if not n.startswith("_")} - INTERNAL
    examples = {name.partition(",")[0] for name in WORDS}
    assert words == examples
    for name in examples:
        act = inspect.unwrap(getattr(Scene, name), stop=lambda f: hasattr(f, "validators"))
        assert set(act.validators()) == legalOf(name), name


def test_every_function_that_scripts_call_has_an_example():
    ours = {n: getattr(masonry, n) for n in dir(masonry) if not n.startswith("_")}
    names = {n for n, t in ours.items() if inspect.isfunction(t) and argumentsOf(t)}
    for module in (materials, bricks, capacity):
        short = re.split("[._]", module.__name__)[-1]
        members = {n: getattr(module, n) for n in module.__all__}
        names |= {f"{short}.{n}" for n, t in members.items() if callable(t) and argumentsOf(t)}
    names |= {
        f"Bricks.{n}"
        for n, t in inspect.getmembers(bricks.Bricks, inspect.isfunction)
        if n[0] != "_" and argumentsOf(t)
    }
    # a result, and classes
    results = [
        "Bilinear",
        "BoundPoint",
        "Demand",
        "Domain",
        "Equivalent",
        "Number",
        "Pushover",
        "RunPoint",
        "Spectrum",
    ]
    names -= {
        "bricks.Joint",
        "materials.MasonryJoint",
        "materials.MasonryMat",
        *(f"capacity.{n}" for n in results),
    }
    assert names <= set(CALLS), names - set(CALLS)


# -- bounds ----------------------------------------------------------------------------------------


def commandsWithValidators():
    """Commands of a scene and functions of the package: tuples of name, argument and validator."""
    commands = {n.partition(",")[0]: getattr(Scene, n.partition(",")[0]) for n in WORDS}
    commands.update({name: act for name, (act, *_) in CALLS.items()})
    for name, act in commands.items():
        act = vars(act)["__init__"] if isinstance(act, type) and "__init__" in vars(act) else act
        act = inspect.unwrap(act, stop=lambda f: hasattr(f, "validators"))
        for argument, validator in act.validators().items() if hasattr(act, "validators") else ():
            yield name, argument, validator
    for name, option in options.OPTIONS.items():
        if hasattr(option.validator, "of"):
            yield "option", name, option.validator


def boundsOf(meant):
    """Ends of what the manual says of a number, such as ``{"above": 0.0, "at most": 1.0}``."""
    ends = re.findall(r"(at least|at most|above|below) ([^\s,]+)", meant)
    both = re.search(r"from (\S+) to ([^\s,]+)", meant)
    if both:
        ends += [("at least", both[1]), ("at most", both[2])]
    return {what: float(end) for what, end in ends}


#: Numbers with bounds, each validator once: what takes it, what the manual says of it, its bounds.
BOUNDED = {
    meant: (f"{name} {argument}", validator, boundsOf(meant))
    for name, argument, validator in commandsWithValidators()
    if re.search("number.*(at |above|below|from)", meant := validators.meaning(validator))
    and not re.search("list|three|free|dict", meant)
}
LIES = {"at least": operator.ge, "above": operator.gt, "at most": operator.le, "below": operator.lt}


def takenWithinBounds(value, meant):
    """A value that lies within its bounds is taken; any other is refused with value and bound."""
    where, validator, ends = BOUNDED[meant]
    whole = "whole number" in meant
    number = isinstance(value, int) or isinstance(value, float) and not whole
    number = number and not isinstance(value, bool) and math.isfinite(value)
    if number and all(LIES[what](value, end) for what, end in ends.items()):
        assert validator(value) == value, where
        return
    with raises(ValueError) as refused:
        validator(value)
    said = str(refused.value)
    assert arguments.shown(value) in said and " must be " in said, where
    for end in ends.values():
        assert {f"{end:g}", f"{end:.0f}"} & {*said.split()}, where


def test_numbers_at_their_bounds_are_taken_and_those_beyond_are_refused():
    assert len(BOUNDED) > 50
    for meant, (_, _, ends) in BOUNDED.items():
        for end in ends.values():
            near = [end, math.nextafter(end, -math.inf), math.nextafter(end, math.inf)]
            for value in (*near, *(int(v) + k for v in near for k in (-1, 0, 1))):
                takenWithinBounds(value, meant)


@settings(max_examples=200)
@given(some.floats() | some.integers() | some.booleans() | some.text(max_size=9))
def test_what_lies_outside_of_its_bounds_is_refused_with_value_and_bound(value):
    for meant in BOUNDED:
        takenWithinBounds(value, meant)


@mark.parametrize("name", masonry.classes)
def test_no_property_of_a_class_passes_outside_its_bounds(name):
    cls = getattr(masonry, name)
    for p in cls.properties():
        known = getattr(cls(), p["name"])
        if (
            not isinstance(known, (float, int))
            or isinstance(known, bool)
            or _isReadOnly(cls, p["name"])
        ):
            continue
        whole = isinstance(known, int)
        wrong = [None, "x", True, *((2.5, 10**12) if whole else (math.nan, math.inf))]
        if math.isfinite(p["low"]):
            wrong.append(int(p["low"]) - 1 if whole else p["low"] - 1.0)
        if math.isfinite(p["high"]):
            wrong.append(int(p["high"]) + 1 if whole else p["high"] + 1.0)
        for value in wrong:
            with raises(ValueError) as refused:
                cls(**{p["name"]: value})
            said = str(refused.value)
            assert p["name"].lower() in said.lower().replace(" ", ""), said
            assert f"{value:g}" in said if isinstance(value, float) else str(value) in said, said


def _isReadOnly(cls, name):
    return "Read-only." in vars(cls)[name].__doc__ if name in vars(cls) else True


# -- what is refused, in which words ---------------------------------------------------------------


@mark.parametrize(
    "name, change, message",
    [
        ("push", {"untill": 3}, "push: no argument 'untill', did you mean 'until'?"),
        (
            "push",
            {"until": "3", "rate": 1e300, "continued": 1},
            (
                "push: until '3' must be a number above 0 and at most 1000 mm\npush: rate 1e+300"
                " mm/s must be at least 0.001 and at most 1000\npush: continued 1 must be True or"
                " False"
            ),
        ),
        (
            "push",
            {"direction": (0, 0, 0)},
            "push: direction (0, 0, 0) must be a direction, whose length is not zero",
        ),
        (
            "cycle",
            {"amplitudes": [2, math.nan]},
            "cycle: amplitudes (value 1 of the list) nan mm or % must be a finite number",
        ),
        (
            "settle",
            {"longest": 1e-6},
            "longest 1e-06 s, after which the wait for rest ends, must be above the time step",
        ),
        (
            "settle",
            {"damping": "locl"},
            "settle: damping 'locl' must be one of local, combined, did you mean 'local'?",
        ),
        ("drive", {"z": lambda: "far"}, "drive: z 'far' must be a number"),
        (
            "release",
            {"axes": ["xz", 3]},
            "release: axes ['xz', 3] must be some of the axes 'xyzXYZ', each once",
        ),
        (
            "platen",
            {"name": ""},
            "platen: name '' must be a name of letters, digits and underscores",
        ),
        (
            "section",
            {"part": "wal"},
            "section: part 'wal' must be one of wall, did you mean 'wall'?",
        ),
        (
            "result",
            {"unit": "a\x00"},
            "result: unit 'a\\x00' must be a text of characters that can be printed",
        ),
        ("Scene", {"gravty": 9}, "no option gravty; did you mean gravity?"),
        (
            "Scene",
            {"plane": 1, "columns": "x", "allowGaps": None},
            (
                "Scene: plane 1 must be True or False\nScene: columns 'x' must be a list with at"
                " least 1 value\nScene: allowGaps None must be True or False"
            ),
        ),
        ("Scene", {"arguments": [1]}, "scene odd: arguments must be a list of words, got 1"),
        (
            "materials.Masonry",
            {"joints": 5, "brief": None},
            "Masonry: joints 5 must be a dict by name\nMasonry: brief None must be True or False",
        ),
        ("Masonry.vary", {"name": "bed.cohesoin"}, "vary: no property 'bed.cohesoin'"),
        (
            "study.choice",
            {"value": math.inf},
            "choice: values (value 0 of the list) inf must be a finite number",
        ),
        (
            "bricks.Wall",
            {"unit": (1, 2), "bond": "flemsh"},
            (
                "Wall: unit (1, 2) must be a length, thickness and height above 0 and at most 1e+06"
                " m\nWall: bond 'flemsh' must be one of running, stack, header, english, flemish,"
                " did you mean 'flemish'?"
            ),
        ),
        ("bricks.Opening", {"widht": 1}, "Opening: no argument 'widht', did you mean 'width'?"),
        ("saveCheckpoint", {"path": 1}, "saveCheckpoint: path 1 must be the name of a file"),
    ],
)
def test_what_is_refused_is_named_with_its_bound(folder, name, change, message):
    assert message in said(name, change)


def test_a_target_of_another_scene_is_refused(folder):
    (theirs,) = (one for one in odd() if getattr(one, "name", "") == "theirs")
    for name, argument in (("load", "target"), ("press", "platen"), ("drift", "lower")):
        message = said(name, {argument: theirs})
        assert f"{name}: {argument} 'theirs', which is of another scene" in message


def test_numbers_of_other_kinds_are_as_good_as_those_of_python(folder):
    for number in (np.float32(0.5), np.float64(0.5), Fraction(1, 2)):
        made = scene()
        made.press(made.top, 100000 * number)
        assert made.top.pressed == 5e4 and type(made.top.pressed) is float
    assert materials.dry(Fraction(1, 2)).joints["bed"].friction == 0.5
