"""The law, the geometry and the files under AddressSanitizer and UBSan."""

import os
import subprocess

import pytest
from conftest import BUILD, ROOT

SANITIZERS = "address,undefined,float-cast-overflow"


def build(sanitizers, folder, target):
    options = ["-DCMAKE_BUILD_TYPE=Debug", "-DMASONRY_SANITIZE=" + sanitizers]
    for command in (
        ["cmake", "-S", ROOT, "-B", folder, *options],
        ["cmake", "--build", folder, "--target", target, "--parallel", "2"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def programs():
    return build(SANITIZERS, os.path.join(BUILD, "address"), "tests_without_host")


@pytest.mark.parametrize("ring", ["law", "blocks", "files"])
def test_a_ring_passes_under_address_and_undefined_behaviour_sanitizers(programs, ring):
    program = os.path.join(programs, "test_" + ring)
    run = subprocess.run([program], capture_output=True, text=True)
    assert run.returncode == 0, (run.stdout + run.stderr)[-4000:]
