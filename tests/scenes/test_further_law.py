# SPDX-License-Identifier: GPL-2.0-or-later
"""A law that is no part of the plugin: its folder (tests/law/coulomb_friction) and an entry in the
list are all it takes.

The build makes a second module that holds it, which is used here in the place of the installed one.
"""

from hosted import *
import glob
import masonry
from masonry.numbers.frames import readFrame
from test_checkpoints import files

WALL = os.path.join(ROOT, "tests", "study", "small.py")
STUDY = f"""
from masonry_study import Study
vary = {{"joints": ["softening", "coulomb"]}}
study = Study({WALL!r}, design="grid", options={{"rate": 20, "until": 0.3}}, vary=vary)
"""
FUNCTORS = """
from yade import *
import masonry
from masonry import *
law = next(law for law in MasonryJoint.laws() if law["name"] == "coulomb")
assert law["properties"] == ["tensileStrength", "friction"]
def pair():
    brick = lambda z: [(x, y, z + h) for x in (0, 0.22) for y in (0, 0.102) for h in (0, 0.081)]
    mat = MasonryMat(young=4.8e9, poisson=0.16, density=1800)
    low, high = (addBlock(brick(z), mat, inPlane=True) for z in (0, 0.081))
    O.bodies[low].state.blockedDOFs = "xyzXYZ"
    load = MasonryLoad(body=high, point=(0.11, 0.051, 0.162), force=(0, 0, -2e3),
        direction=(1, 0, 0), driven=True, velocity=0.01)
    kinds = [MasonryJoint(law="coulomb", friction=0.5, tensileStrength=0)]
    engines(kinds, loads=[load], functors=functors, damping=0.3)
    connect()
    O.dt = 0.5 * criticalTimeStep()[0]
    O.run(2000, True)
    joint = O.interactions.all()[0].phys
    dispatchers = [e.lawDispatcher for e in O.engines if hasattr(e, "lawDispatcher")]
    names = [type(f).__name__ for dispatcher in dispatchers for f in dispatcher.functors]
    return joint.stress, joint.slip, names
for functors in (False, True):
    O.reset()
    found = pair()
    print(found)
    assert min(found[1]) > 0
    for normal, a, b in found[0]:
        assert normal <= 0 and abs(a) <= -0.5 * normal * (1 + 1e-9), found
    assert found[2] == ([law["functor"]] if functors else [])
print("DONE")
"""
FALLING = """
from yade import *
import masonry
from masonry import *
ground, pier = (3, 3, 0.4), (0.25, 0.25, 0.5)
def block(low, size):
    return addBlock(masonry.bricks.boxCorners(low, [a + b for a, b in zip(low, size)]), mat)
mat = MasonryMat(young=1e12, poisson=0.16, density=1800)
O.bodies[block((-1, -1, -0.4), ground)].state.blockedDOFs = "xyzXYZ"
for course in range(2):
    block((0, 0, 0.5 * course), pier)
stiff = dict(normalStiffness=1e10, shearStiffness=5e9)
joint = MasonryJoint(law="coulomb", friction=0.7, tensileStrength=5e3, **stiff)
engines([joint], gravity=(0.45 * 9.81, 0, -9.81), damping=0)
contacts = MasonryContacts(normalStiffness=1e10, friction=0.7, takesJoints=True)
loop = next(n for n, e in enumerate(O.engines) if isinstance(e, MasonryJointLoop))
O.engines = [*O.engines[: loop + 1], contacts, *O.engines[loop + 1 :]]
connect()
O.dt = 0.5 * criticalTimeStep()[0]
bed = next(i for i in O.interactions if 0 in (i.id1, i.id2))
assert len(bed.phys.slip) == 9
while not O.engines[loop].refinedJoints:
    O.step()
assert len(bed.phys.slip) == 25
while not contacts.handed:
    O.step()
# of the foot, about which the pier turns as one
assert all(d[0] == 1 for d, jump in zip(bed.phys.damage, bed.geom.jumps) if jump[0] > 0)
assert all(s[1] == s[2] == 0 and s[0] <= 0 for s in bed.phys.stress)
stress, slip, jumps = bed.phys.stress, bed.phys.slip, bed.geom.jumps
O.run(int(0.8 / O.dt), True)
assert O.bodies[2].state.pos[2] < 0.5 and contacts.touching() > 0
assert (bed.phys.stress, bed.phys.slip, bed.geom.jumps) == (stress, slip, jumps)
balance = engine("energy").balance()
assert balance["dissipated_tension"] > 0 and abs(balance["error"]) < 0.02, balance
print("DONE")
"""


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """The core and its wings, with the module that holds one law more."""
    folder = tmp_path_factory.mktemp("packages")
    package = os.path.dirname(masonry.__file__)
    for path in glob.glob(glob.escape(package) + "*"):
        shutil.copytree(path, folder / os.path.basename(path))
    shutil.copy(os.path.join(BUILD, "coulomb", "_masonry.so"), folder / "masonry")
    return {**os.environ, "PYTHONPATH": str(folder)}


def start(environment, *words):
    command = ["yade", "-n", "-x", WALL, *words]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)


def test_a_wall_of_the_law_goes_on_from_a_checkpoint(environment, tmp_path):
    words = "--joints coulomb --until 0.3 --rate 4 --vtk-every 0.1".split()
    kinds = ("support", "bed", "head", "crack")
    words += [f"--set={kind}.tensileStrength=0" for kind in kinds]
    whole, broken = str(tmp_path / "whole"), str(tmp_path / "broken")
    assert start(environment, *words, "--out", whole).wait() == 0
    process = start(environment, *words, "--out", broken, "--checkpoint-every", "0.001")
    while not os.path.exists(os.path.join(broken, "run.checkpoint")):
        assert process.poll() is None
        time.sleep(0.01)
    process.kill()
    process.wait()
    assert start(environment, "--resume", broken).wait() == 0
    assert len(readRun(broken)["resumed_at_s"]) == 1
    assert files(broken) == files(whole)

    joints = readFrame(whole, "joints")
    mobilised, normal = joints["mobilised_friction"], joints["normal_stress"]
    assert mobilised.max() == approx(1, abs=1e-9)
    assert joints["slip"][mobilised > 1 - 1e-9].max() > 0
    crack = joints["kind"] == readRun(whole)["kinds"].index("crack")
    friction = np.where(crack, 0.75, 0.43)[mobilised > 0]  # of masonry.materials
    shear = (-normal * mobilised)[mobilised > 0] * friction
    assert shear == approx(joints["shear_stress"][mobilised > 0], rel=2**-22)  # as in a file
    assert joints["damage_tension"].max() == 0  # there is no bond


def test_the_law_runs_in_a_study(environment, tmp_path):
    (tmp_path / "study.py").write_text(STUDY)
    command = [sys.executable, "-m", "masonry_study", "study.py", "--out", "study"]
    settings = dict(cwd=tmp_path, env=environment, capture_output=True, text=True)
    run = subprocess.run(command, **settings)
    assert run.returncode == 0, run.stdout + run.stderr
    table = (tmp_path / "study" / "study.csv").read_text()
    assert "coulomb" in table and "softening" in table


@mark.parametrize("script", [FUNCTORS, FALLING], ids=["functor", "collapse"])
def test_the_law_has_a_functor_and_falls(environment, tmp_path, script):
    (tmp_path / "script.py").write_text(script)
    run = runProgram(str(tmp_path / "script.py"), env=environment, check=False)
    assert "DONE" in run.stdout, run.stdout + run.stderr


def test_the_option_offers_the_laws_of_the_plugin(environment):
    run = runProgram(WALL, "--help", env=environment)
    assert "--joints {softening,cyclic,coulomb,brittle}" in run.stdout
