# SPDX-License-Identifier: GPL-2.0-or-later
"""Law, geometry and files under AddressSanitizer and UBSan; the threaded engines in YADE under
ThreadSanitizer."""

import os
import subprocess

import pytest
from conftest import BUILD, ROOT


pytestmark = pytest.mark.long
TESTS = os.path.join(ROOT, "tests"), os.path.join(ROOT, "tests", "host")


def build(sanitizers, name, *targets):
    folder = os.path.join(BUILD, name)
    options = [
        "-DCMAKE_BUILD_TYPE=Debug",
        "-DMASONRY_SANITIZE=" + sanitizers,
        "-DMASONRY_PACKAGES=" + os.path.join(folder, "packages"),
    ]
    for command in (
        ["cmake", "-S", ROOT, "-B", folder, *options],
        ["cmake", "--build", folder, "--target", *targets, "--parallel", "2"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder


#: What the threads of the engines do at the same time, and what a thread of Python reads beside
#: them.
THREADED = """
import threading
import masonry
from test_joint_loop import *

def look(interactions):
    for i in interactions:
        i.phys.stress, i.phys.damage, i.geom.jumps
    energy()
    for e in O.engines:
        if isinstance(e, MasonryZones):
            e.displacements, e.velocities

for case, options in CASES.items():
    interactions = panel(False, **options, size=12, damping=0.8)
    for _ in range(100):
        O.step()
    hurt = state(interactions)['damage'].max(axis=0).min() > 0
    print('ran', case, 'threads', O.numThreads, 'damaged', hurt)
    looks, goes = [0], [True]
    def again():
        while goes[0]:
            look(interactions)
            looks[0] += 1
    reader = threading.Thread(target=again)
    reader.start()
    O.run(100)
    O.wait()
    goes[0] = False
    reader.join()
    print('read', case, 'beside the run', looks[0] > 0, 'to its end', O.iter == 200)
print('module', masonry._masonry.__file__)
"""


RINGS = ["law", "blocks", "contact", "files"]


@pytest.fixture(scope="module")
def programs():
    targets = ["test_" + ring for ring in RINGS]
    return build("address,undefined,float-cast-overflow", "address", *targets)


@pytest.mark.xdist_group("address")  # one build for all of them
@pytest.mark.parametrize("ring", RINGS)
def test_memory_and_arithmetic_are_sound_in(programs, ring):
    program = os.path.join(programs, "test_" + ring)
    run = subprocess.run([program], capture_output=True, text=True)
    assert run.returncode == 0, (run.stdout + run.stderr)[-4000:]


def test_no_two_threads_race(tmp_path):
    """The panels of test_joint_loop.py on two threads; then a Python thread reads joints, energies
    and nodes while a run works in the background.

    The host's own code is not instrumented, so only races in which code of this plugin has a part
    are found.
    """
    folder = build("thread", "thread", "masonry_module_fit")
    subprocess.run(["cmake", "--install", folder], check=True, capture_output=True)
    script = tmp_path / "run.py"
    script.write_text(THREADED)
    env = dict(
        os.environ,
        PYTHONPATH=os.pathsep.join([os.path.join(folder, "packages"), *TESTS]),
        LD_PRELOAD="libtsan.so.2",
        MASONRY_THREADS="always",
        TSAN_OPTIONS="history_size=7 exitcode=66",
    )
    run = subprocess.run(
        ["yade", "-j2", "-n", "-x", str(script)],
        env=env,
        capture_output=True,
        text=True,
        timeout=600,
    )
    message = run.stdout + run.stderr
    assert run.returncode == 0, message[-6000:]
    assert message.count(" threads 2 damaged True") == 7, message
    assert message.count("beside the run True to its end True") == 7, message
    assert "module " + folder in message
