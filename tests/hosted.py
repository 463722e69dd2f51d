# SPDX-License-Identifier: GPL-2.0-or-later
"""What tests of scenes in YADE begin with, for ``from hosted import *``: names that nearly all of
them use, and small helpers."""

import errno

from usual import *
from yade.wrapper import *  # first: its Scene is not ours
from masonry import *
from masonry import addBlock, engine  # noqa: F401
from masonry._masonry import allowThreads  # noqa: F401
from masonry.bricks import boxCorners as corners
from masonry.numbers.files import readCurve, readRun  # noqa: F401
from yade import O, Quaternion, Vector3


def letGo():
    """Let go of a scene that was not finished."""
    if Scene.present and not Scene.present.finished:
        Scene.present.finished = True
        Scene.present.running.release()
        Scene.present = None


@pytest.fixture(autouse=True)
def emptyScene(scene):
    """Every test of a file that begins with hosted.py has an empty scene, and need not finish one
    of its own."""
    yield
    letGo()


G = 9.81  # [m/s²]
#: The brick of the calcium-silicate walls, with its mortar [m].
UNIT = (0.22, 0.102, 0.081)
#: Both ways to run the joints.
FUNCTORS = mark.parametrize("functors", [False, True], ids=["loop", "functors"])
BLOCKS = mark.parametrize("blocks", ["rigid", "deformable"])
PLANES = mark.parametrize("plane", [True, False], ids=["plane", "space"])
#: Turns a scene out of its plane.
IN_SPACE = Quaternion(Vector3(1, 2, 0.5).normalized(), 0.7)


def unitMaterial(**other):
    """The material of calcium-silicate bricks."""
    return MasonryMat(**{**dict(density=1800, young=4.8e9, poisson=0.16), **other})


def dry(friction=0.7, **other):
    """A joint without bond that cannot crush, if nothing else is said."""
    bond = dict(tensileStrength=0, cohesion=0, residualCohesion=0, cap=False)
    rubs = dict(friction=friction, residualFriction=friction)
    stiff = dict(normalStiffness=1e10, shearStiffness=5e9)
    return MasonryJoint(**{"name": "dry", **bond, **rubs, **stiff, **other})


def box(low=(0, 0, 0), size=UNIT, turn=Quaternion.Identity):
    """Corners of a box with this lowest corner and these sides [m], turned about the origin."""
    high = [a + b for a, b in zip(low, size)]
    return [turn * Vector3(*corner) for corner in corners(low, high)]


def lean(folder, blocks, masonry=None, /, *words, **settings):
    """A scene that leaves its rows and run.json alone, in this folder."""
    words = ["--lean", "--checkpoint-every", "0", "--out", str(folder), *words]
    return Scene("lean", blocks, masonry or materials.dry(), arguments=words, **settings)


def standing(*words, **settings):
    """Such a scene on a platen."""
    scene = lean(*words, **settings)
    scene.platen("bottom")
    return scene


def arrays(folder):
    """Columns of curve.csv by their names."""
    return {name: np.array(values) for name, values in readCurve(folder).items()}


def hold(*bodies):
    for body in bodies:
        O.bodies[body].state.blockedDOFs = "xyzXYZ"


def pile(count=2, x=0.0, size=UNIT, turn=Quaternion.Identity, material=None, **how):
    """Bricks on each other, of which the lowest is held; their ids."""
    unit = material or unitMaterial()
    places = [(x, 0, k * size[2]) for k in range(count)]
    ids = [addBlock(box(place, size, turn), unit, **how) for place in places]
    hold(ids[0])
    return ids


def join(joints=None, share=0.5, **around):
    """The engines and the joints of the blocks, and this share of the largest time step."""
    engines(joints if isinstance(joints, list) else [joints or MasonryJoint()], **around)
    made = connect()
    O.dt = share * criticalTimeStep()[0]
    return made


def insert(load):
    """Put an engine behind the loop of the joints."""
    O.engines = [*O.engines[:2], load, *O.engines[2:]]
    return load


def alone(kind=MasonryIntegrator, energy=False, **around):
    """The engines of bodies that have no joints; returns the one that moves them."""
    integrator = kind(**{"gravity": (0, 0, 0), **around})
    O.engines = [ForceResetter(), *[MasonryEnergy()] * energy, integrator]
    return integrator


def spin(state, velocity):
    """Let a body turn with this angular velocity, also where its rotations are free."""
    state.angVel = velocity
    own = state.ori.conjugate() * velocity
    state.angMom = state.ori * Vector3(*(i * w for i, w in zip(state.inertia, own)))


def saveAndLoad(through, path, build):
    """Through YADE's own file, or a checkpoint into the scene that is built anew."""
    if through == "file":
        O.save(path + ".yade.gz")
        O.load(path + ".yade.gz")
    else:
        saveCheckpoint(path)
        build()
        loadCheckpoint(path)


def run(steps=1):
    """Take steps one by one: O.run(steps, True) may end before it waits, and then only prints an
    error."""
    for _ in range(steps):
        O.step()


def until(time):
    """Run to a time of the scene [s]."""
    O.run(max(1, math.ceil((time - O.time) / O.dt)), True)


def ofKind(kind):
    """The first engine of a class, or None."""
    return next((e for e in O.engines if isinstance(e, kind)), None)


def energy():
    return ofKind(MasonryEnergy)


def loop():
    return ofKind(MasonryJointLoop)


def balance():
    return energy().balance()


def imbalance():
    """The error of the balance, over the work that was done."""
    return abs(balance()["error"])


def bits():
    """All numbers of the bodies and of the balance, as bytes."""
    motion = lambda s: (*s.pos, *s.ori, *s.vel, *s.angVel)
    values = [value for b in O.bodies for value in motion(b.state)]
    return np.array([*values, *balance().values()]).tobytes()


def noSpace(file):
    """What fails as on a full disk."""
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
