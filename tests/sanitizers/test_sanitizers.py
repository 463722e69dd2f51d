"""Law, geometry and files under AddressSanitizer and UBSan; the threaded engines in YADE under ThreadSanitizer."""

import os
import subprocess

import pytest
from conftest import BUILD, ROOT

HERE = os.path.dirname(__file__)
ARCHER = "/usr/lib/llvm-14/lib/libarcher.so"  # of libomp-14-dev


def build(sanitizers, name, target):
    folder = os.path.join(BUILD, name)
    options = [
        "-DCMAKE_BUILD_TYPE=Debug",
        "-DMASONRY_SANITIZE=" + sanitizers,
        "-DMASONRY_PACKAGES=" + os.path.join(folder, "packages"),
    ]
    for command in (
        ["cmake", "-S", ROOT, "-B", folder, *options],
        ["cmake", "--build", folder, "--target", target, "--parallel", "2"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def programs():
    return build("address,undefined,float-cast-overflow", "address", "rings")


@pytest.mark.parametrize("ring", ["law", "blocks", "files"])
def test_memory_and_arithmetic_are_sound_in(programs, ring):
    program = os.path.join(programs, "test_" + ring)
    run = subprocess.run([program], capture_output=True, text=True)
    assert run.returncode == 0, (run.stdout + run.stderr)[-4000:]


def test_no_two_threads_race(tmp_path):
    """The panels of test_joint_loop.py on two threads. GCC's OpenMP runtime hides from ThreadSanitizer what waits for
    what, and every loop would be reported. Clang's runtime, which has the same entry points, takes its place, and its
    tool Archer tells. The host's own code is not instrumented, so only races in which ours has a part can be seen.
    """
    if not os.path.exists(ARCHER):
        pytest.skip(ARCHER + " is missing (apt-get install libomp-14-dev)")
    folder = build("thread", "thread", "masonry_module_fit")
    subprocess.run(["cmake", "--install", folder], check=True, capture_output=True)
    script = tmp_path / "run.py"
    script.write_text(
        "import masonry\n"
        "from test_joint_loop import *\n"
        "for case, options in CASES.items():\n"
        "    interactions = panel(False, **options, size=12, damping=0.8)\n"
        "    for _ in range(100):\n        O.step()\n"
        "    hurt = state(interactions)['damage'].max(axis=0).min() > 0\n"
        "    print('ran', case, 'threads', O.numThreads, 'damaged', hurt)\n"
        "print('module', masonry._masonry.__file__)\n"
    )
    suppressions = os.path.join(HERE, "suppressions.txt")
    env = dict(
        os.environ,
        PYTHONPATH=os.path.join(folder, "packages")
        + os.pathsep
        + os.path.join(ROOT, "tests", "host"),
        LD_PRELOAD="libtsan.so.2 libomp.so.5",
        OMP_TOOL_LIBRARIES=ARCHER,
        ARCHER_OPTIONS="verbose=1",
        TSAN_OPTIONS=f"history_size=7 exitcode=66 suppressions={suppressions}",
    )
    run = subprocess.run(
        ["yade", "-j2", "-n", "-x", str(script)],
        env=env,
        capture_output=True,
        text=True,
        timeout=300,
    )
    told = run.stdout + run.stderr
    assert run.returncode == 0, told[-6000:]
    assert "Archer detected OpenMP application with TSan" in told
    assert told.count(" threads 2 damaged True") == 5, told
    assert "module " + folder in told
