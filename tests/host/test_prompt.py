# SPDX-License-Identifier: GPL-2.0-or-later
"""What a user does at the prompt while a scene runs, or after it has ended, gives an answer or an
error, never a crash.

Most of it runs in a YADE of its own, so that a crash is a failed test and not the end of pytest.
"""

from hosted import *
from masonry import classes
from yade import wrapper

HERE = os.path.dirname(__file__)

BEGIN = """
import sys
sys.path.insert(1, "/usr/lib/x86_64-linux-gnu/yade-double/py")
import yade
import gc, hashlib, os, threading, time
from hosted import *
from hosted import balance as energy
from test_joint_loop import state
from test_joint_loop import panel as made

def panel(*how, **more):
    found = made(*how, **more)
    # the runs go on after bricks have been pushed through each other
    ofKind(MasonryEnergy).watch = False
    return found

def bits(interactions):
    '''A fingerprint of all that a run can be told by.'''
    values = [np.array([O.iter, O.time, *energy().values()])]
    values += list(state(interactions).values())
    return hashlib.sha256(b"".join(v.tobytes() for v in values)).hexdigest()
"""


def inYade(code, threads=1, timeout=120):
    """Run a program in a YADE of its own and return what it printed. Fails if the process crashes
    or does not end."""
    folders = [HERE, os.path.join(HERE, "..", "references"), os.path.join(HERE, "..")]
    env = dict(os.environ, OMP_NUM_THREADS=str(threads), PYTHONFAULTHANDLER="1")
    path = os.pathsep.join([os.environ.get("PYTHONPATH", ""), *folders])
    env.update(MASONRY_THREADS="always", PYTHONPATH=path)
    command = [sys.executable, "-c", BEGIN + code + "\nprint('ENDED')\n"]
    run = ran(command, env=env, timeout=timeout)
    message = (run.stdout + run.stderr)[-3000:]
    assert run.returncode == 0, f"ended with {run.returncode}:\n{message}"
    assert run.stdout.rstrip().endswith("ENDED"), message
    return run.stdout


# -- beside a run in the background ----------------------------------------------------------------

READER = """
STEPS = {steps}

def look(interactions):
    '''Read all that there is to read, once.'''
    for i in interactions:
        i.phys.stress, i.phys.damage, i.phys.regime, i.phys.dissipated, i.geom.jumps
    energy()
    for e in O.engines:
        if isinstance(e, MasonryZones):
            e.displacements, e.velocities
        if isinstance(e, MasonryLoad):
            e.displacement(), e.reaction, e.work
        if isinstance(e, MasonryIntegrator):
            e.kinetic, e.damped

def write(interactions):
    for joint in {{id(i.phys.joint): i.phys.joint for i in interactions}}.values():
        joint.cohesion = joint.cohesion

def end(beside=None):
    '''The state after a run in the background, while another thread repeats something.'''
    interactions = panel(False, {blocks!r}, damping=0.3)
    done, goes = [0], [True]
    def again():
        while goes[0]:
            beside(interactions)
            done[0] += 1
    thread = threading.Thread(target=again)
    if beside:
        thread.start()
    try:
        O.run(STEPS)
        O.wait()
    finally:
        goes[0] = False
    if beside:
        thread.join()
        assert done[0] > 3, done
    assert O.iter == STEPS, (O.iter, STEPS)
    return bits(interactions)
"""
LOOK = READER.split("def end")[0].format(steps=0)
STEPS = {"rigid": 9000, "deformable": 1500}
KINDS = mark.parametrize("blocks", STEPS)
THREADS = mark.parametrize("threads", [1, 2])


def reader(blocks):
    return READER.format(steps=STEPS[blocks], blocks=blocks)


@mark.slow
@THREADS
@KINDS
def test_reading_beside_a_run_changes_nothing_of_it(blocks, threads):
    inYade(reader(blocks) + "assert end(look) == end()", threads)


@mark.slow
@KINDS
def test_a_checkpoint_saved_beside_a_run_is_of_a_whole_step(blocks, tmp_path):
    code = f"""
import itertools, random
number, saved, refused = itertools.count(), [], []
def save(interactions):
    path = os.path.join({str(tmp_path)!r}, str(next(number)))
    try:
        saveCheckpoint(path)
        saved.append(path)
    except (ValueError, RuntimeError) as error:
        assert len(str(error)) > 20 and "\\n" not in str(error), error
        refused.append(path)
    time.sleep(0.002)
plain = end()
assert end(save) == plain, "saving changed the run"
print("saved", len(saved), "refused", len(refused))
for path in random.Random(1).sample(saved, min(8, len(saved))):
    interactions = panel(False, {blocks!r}, damping=0.3)
    loadCheckpoint(path)
    left = STEPS - O.iter
    assert 0 <= left <= STEPS, left
    if left:
        O.run(left, True)
    assert bits(interactions) == plain, f"from step {{STEPS - left}} the end is another"
"""
    inYade(reader(blocks) + code)


@mark.slow
@THREADS
@KINDS
def test_random_tries_beside_a_run_do_no_harm(blocks, threads, tmp_path):
    """Whatever is read, set, saved or loaded beside O.run() works, or is refused in a sentence.
    ``BESIDE_TRIES`` says how often."""
    count = int(os.environ.get("BESIDE_TRIES", 400))
    code = f"""
import random
interactions = panel(False, {blocks!r}, damping=0.3)
whole, path, dice = O.dt, os.path.join({str(tmp_path)!r}, "beside"), random.Random(1)
saveCheckpoint(path)
joints = [i.phys.joint for i in interactions]
own = [e for e in O.engines if type(e).__name__.startswith("Masonry")]
one = lambda things: dice.choice(things)
moves = next(e for e in O.engines if isinstance(e, (MasonryZones, MasonryIntegrator)))
tries = [
    lambda: look([one(interactions)]),
    lambda: write([one(interactions)]),
    lambda: one(own).dict(),
    lambda: one(O.bodies).state.dict(),
    lambda: setattr(one(joints), "friction", dice.uniform(0.5, 0.9)),
    lambda: setattr(moves, "damping", dice.uniform(0.1, 0.8)),
    lambda: energy(),
    lambda: criticalTimeStep(),
    lambda: ofKind(MasonryEnergy).given(),
    lambda: MasonryVtkRecorder().joints(),
    lambda: saveCheckpoint(path),
    lambda: loadCheckpoint(path),
    lambda: (O.pause(), O.run()),
    lambda: setattr(O, "engines", list(O.engines)),
]
refused = 0
O.run()
for n in range({count}):
    try:
        one(tries)()
    except ValueError as error:
        assert "O.pause()" in str(error), error
        refused += 1
    assert O.running, n
O.pause()
O.wait()
O.step()
assert O.iter > 10 and 0 < refused < 0.3 * {count}, (O.iter, refused)
"""
    inYade(LOOK + code, threads, timeout=300)


@THREADS
@KINDS
def test_a_step_right_after_a_pause_ends(blocks, threads):
    """O.pause() does not wait for the end of the step that is under way, so two threads make steps
    for a moment."""
    code = f"""
panel(False, {blocks!r}, size=8, damping=0.3)
for n in range(60):
    O.run()
    time.sleep(0.002)
    O.pause()
    O.step()
"""
    inYade(LOOK + code, threads, timeout=60)


@THREADS
@mark.parametrize("beside", [False, True])
def test_a_forked_process_goes_on(threads, beside):
    """It has none of the other threads, neither of a run in the background nor those of the
    loops."""
    code = f"""
import random
interactions = panel(False, "rigid", damping=0.3)
for n in range(8):
    if {beside}:
        O.run()
        time.sleep(random.uniform(0, 5e-3))
    else:
        [O.step() for _ in range(5)]
    child = os.fork()
    if not child:
        energy()
        interactions[0].phys.stress
        {beside} or [O.step() for _ in range(5)]
        os._exit(7)
    ends = time.monotonic() + 20
    while not (done := os.waitpid(child, os.WNOHANG))[0] and time.monotonic() < ends:
        time.sleep(1e-3)
    assert done[0] and os.waitstatus_to_exitcode(done[1]) == 7, (n, done)
O.pause()
O.step()
"""
    inYade(LOOK + code, threads)


@mark.slow
def test_pausing_and_going_on_changes_nothing():
    code = """
plain = end()
interactions = panel(False, 'rigid', damping=0.3)
O.run(STEPS)
while O.iter < STEPS and O.running:
    O.pause()
    look(interactions)
    if O.iter < STEPS:
        O.run(STEPS - O.iter)
    time.sleep(0.003)
O.wait()
assert O.iter == STEPS and bits(interactions) == plain
"""
    inYade(reader("rigid") + code)


# -- what outlives its scene -----------------------------------------------------------------------

#: What is read -> whether it is state of a scene, and so an error once the scene is gone.
STATE = """phys.stress phys.damage phys.slip phys.regime phys.dissipated geom.jumps
zones.displacements zones.velocities zones.nodesOf(2)""".split()
OTHER = """zones.masses zones.dict() phys.dict() geom.areas geom.centres
energy.balance() load.displacement() load.reaction loop.dict() integrator.kinetic joint.cohesion
joint.updateAttrs(dict(cohesion=2e4,tensileStrength=1e4))
zones.setVelocity(0,Vector3(0,0,1))""".split()
READ = {**dict.fromkeys(STATE, True), **dict.fromkeys(OTHER, False)}
GONE = {
    "reset": "O.reset()",
    "loaded": "O.loadTmp()",
    "another scene": "panel(False, 'deformable')",
    "another scene that has run": "panel(False, 'deformable')\nO.run(5, True)",
    "without engines": "O.engines = []\nO.reset()\ngc.collect()",
}


@mark.parametrize("gone", GONE)
def test_what_outlives_its_scene_raises_an_error_when_read(gone):
    code = f"""
interactions = panel(False, 'deformable', halves=False)
O.run(20, True)
O.saveTmp()
one = next(i for i in interactions if i.phys.joint.name == "weak")
phys, geom, joint = one.phys, one.geom, one.phys.joint
zones, energy_, load = ofKind(MasonryZones), ofKind(MasonryEnergy), ofKind(MasonryLoad)
loop, integrator = ofKind(MasonryJointLoop), ofKind(MasonryIntegrator)
names = dict(phys=phys, geom=geom, joint=joint, zones=zones, energy=energy_, load=load, loop=loop,
             integrator=integrator, Vector3=Vector3)
{GONE[gone]}
silent = []
for text, state in {READ!r}.items():
    try:
        eval(text, dict(names))
        if state:
            silent.append(text)
    except Exception as error:
        print(text, "raises", type(error).__name__, error)
del phys, geom, zones, loop, one, interactions, names
gc.collect()
panel(False, 'deformable', halves=False)
O.run(20, True)  # the scenes after it are sound
assert not silent, "read without an error: " + ", ".join(silent)
"""
    inYade(code)


@mark.slow
@mark.parametrize("blocks", ["rigid", "deformable"])
def test_a_joint_read_after_its_engine_is_gone_shows_its_last_state(blocks):
    code = f"""
interactions = panel(False, {blocks!r})
O.run(200, True)
before = state(interactions)
engines = O.engines
O.engines = []
del engines
gc.collect()
after = state(interactions)
assert all((before[name] == after[name]).all() for name in before)
"""
    inYade(code)


# -- blocks that come and go -----------------------------------------------------------------------


@mark.parametrize("steps", [0, 1, 150], ids=lambda n: f"after {n} steps")
@mark.parametrize("deformable", [False, True], ids=["rigid", "deformable"])
def test_a_block_added_after_connect_is_named(deformable, steps):
    pile(3)
    join(zones=MasonryZones(bodies=[1, 2]) if deformable else None)
    run(steps)
    late = addBlock(box((0, 0, 3 * UNIT[2])), unitMaterial())
    with raises(ValueError, match=rf"body {late} was added after connect\(\)"):
        O.step()


#: A deformable block without a joint and with one, a rigid block, and the base.
ERASED = [3, 2, 1, 0]


@mark.parametrize("steps", [0, 30], ids=lambda n: f"after {n} steps")
@mark.parametrize("erased", ERASED)
def test_a_block_that_is_erased_is_an_error_or_left_out(erased, steps):
    code = f"""
pile(3)
addBlock(box((1, 0, 0)), unitMaterial())
interactions = join(zones=MasonryZones(bodies=[2, 3]))
O.run({steps}, True) if {steps} else None
O.bodies.erase({erased})
for act in (
    lambda: O.step(), lambda: O.step(), lambda: [O.step() for _ in range(200)], lambda: energy(),
    lambda: criticalTimeStep(), lambda: saveCheckpoint("/dev/null/x"),
    lambda: [i.phys.stress for i in interactions],
    lambda: MasonryVtkRecorder(directory="/dev/null")(),
):
    try:
        act()
    except (ValueError, RuntimeError, OSError, TypeError) as error:
        print(type(error).__name__, error)
panel(False)
O.run(20, True)
"""
    inYade(code)


# -- misspelt names --------------------------------------------------------------------------------


def ownProperties(cls):
    return [k for k, v in vars(cls).items() if isinstance(v, property)]


def misspelt(name):
    """The name with two neighbouring letters in the other order."""
    places = [k for k in range(1, len(name) - 1) if name[k] != name[k + 1]]
    k = places[len(places) // 2] if places else 0
    return name[:k] + name[k + 1] + name[k] + name[k + 2 :]


@mark.parametrize("name", classes)
def test_a_misspelt_property_is_an_error_that_names_the_right_one(name):
    cls = getattr(wrapper, name)
    instance = cls()
    made = lambda one, name, value: cls(**{name: value})
    updated = lambda one, name, value: one.updateAttrs({name: value})
    for right in ownProperties(cls):
        if len(right) == 1:  # there are no two letters to swap
            continue
        wrong = misspelt(right)
        assert wrong != right and not hasattr(instance, wrong)
        for act in (setattr, made, updated):
            with raises(AttributeError, match=f"{wrong}.*{right}"):
                act(instance, wrong, 0)


@mark.slow
def test_every_property_of_an_object_of_no_scene_can_be_read_and_set_to_what_it_is():
    code = """
import masonry
for cls in masonry.classes:
    instance = globals()[cls]()
    for name, own in vars(type(instance)).items():
        if not isinstance(own, property):
            continue
        print(cls, name, flush=True)
        try:
            value = getattr(instance, name)
            setattr(instance, name, value)
            assert type(getattr(instance, name)) is type(value), name
        except (AttributeError, ValueError) as error:  # read-only; or not without a scene
            print(type(error).__name__, error)
    repr(instance.dict())
"""
    inYade(code)
