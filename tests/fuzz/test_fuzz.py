# SPDX-License-Identifier: GPL-2.0-or-later
"""The readers of checkpoints and of joints' numbers under libFuzzer, AddressSanitizer and UBSan: a
few seconds each.

For longer: build/fuzz/fuzz_checkpoint -max_total_time=600
"""

import os
import re
import shutil
import subprocess

import pytest
from conftest import BUILD, ROOT

FUZZ = os.path.join(BUILD, "fuzz")


@pytest.fixture(scope="module")
def targets():
    if not shutil.which("clang++"):
        pytest.skip("clang++ is not installed (apt-get install clang libclang-rt-dev)")
    compiler = ["-DCMAKE_CXX_COMPILER=clang++", "-DCMAKE_C_COMPILER=clang"]
    for command in (
        ["cmake", "-S", ROOT, "-B", FUZZ, "-DMASONRY_FUZZ=ON", *compiler],
        ["cmake", "--build", FUZZ],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("target", ["checkpoint", "joint"])
def test_no_bytes_break_a_reader(targets, target, tmp_path):
    run = subprocess.run(
        [
            os.path.join(FUZZ, "fuzz_" + target),
            "-max_total_time=4",
            "-timeout=10",
            "-max_len=512",
            # A program inherits the largest memory of the one that starts it, so the limit is on
            # single allocations.
            "-rss_limit_mb=0",
            "-malloc_limit_mb=1024",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr[-4000:]
    assert int(re.search(r"Done (\d+) runs", run.stderr)[1]) > 1000
