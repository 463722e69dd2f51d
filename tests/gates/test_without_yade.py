# SPDX-License-Identifier: GPL-2.0-or-later
"""What needs no YADE runs where there is none, and what needs it is skipped with that reason."""

import os
import subprocess
import sys

import pytest
from conftest import WITHOUT_YADE
from tree import ROOT

TESTS = os.path.join(ROOT, "tests")


def withoutYade(*words):
    program = os.path.join(TESTS, "gates", "without_yade.py")
    command = [sys.executable, program, *words]
    run = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    return run.returncode, run.stdout + run.stderr


@pytest.mark.slow
def test_all_that_needs_no_yade_is_found_without_it():
    paths = [os.path.join(TESTS, name) for name in WITHOUT_YADE]
    status, output = withoutYade("--collect-only", *paths)
    assert status == 0, output
    assert "YADE is not installed" not in output
    for name in WITHOUT_YADE:
        assert f"tests/{name}" in output, name


@pytest.mark.slow
def test_tests_of_bricks_and_of_checkpoint_files_pass_without_yade():
    parts = [os.path.join(TESTS, n) for n in ("package/test_bricks_vaults.py", "files")]
    status, output = withoutYade(*parts)
    assert status == 0 and " passed" in output, output


def test_tests_that_need_yade_are_skipped_and_say_why():
    _, output = withoutYade(os.path.join(TESTS, "host", "test_points.py"))
    assert "NOT RUN: 1 test: YADE is not installed" in output
