# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes in plain Python, in a notebook, and with YADE's own importer."""

import os
import subprocess
import sys

import yade

HOST = os.path.dirname(os.path.dirname(os.path.abspath(yade.__file__)))
SCENE = """
from masonry import Scene, bricks, materials
scene = Scene("plain", bricks.stack(2, (0.3, 0.3, 0.2)), materials.dry(friction=0.6))
scene.platen("bottom"); scene.settle(); scene.finish()
"""


def played(tmp_path, begin, *words, **more):
    """Run a scene in plain Python after some lines, without the variable that says how many threads there are."""
    env = {k: v for k, v in os.environ.items() if k != "OMP_NUM_THREADS"}
    script = tmp_path / "plain.py"
    script.write_text(begin + SCENE + more.pop("end", ""))
    return subprocess.run(
        [sys.executable, str(script), *words], capture_output=True, text=True, cwd=tmp_path, env=env
    )  # fmt: skip


def test_plain_python_has_one_thread(tmp_path):
    begin = f"import sys; sys.path.insert(0, {HOST!r}); import yade\n"
    end = "import ctypes; print('threads', ctypes.CDLL(None).omp_get_max_threads())"
    run = played(tmp_path, begin, end=end)
    assert run.returncode == 0, run.stderr
    assert "threads 1" in run.stdout and "plain: at rest" in run.stdout


def test_words_of_a_notebook_are_not_those_of_the_scene(tmp_path):
    begin = f"import sys; sys.path.insert(0, {HOST!r}); sys.argv = ['ipykernel_launcher.py', '-f', 'x.json']; import yade\n"  # fmt: skip
    run = played(tmp_path, begin)
    assert run.returncode == 0, run.stderr


def test_the_importer_of_yade_works(tmp_path):
    (tmp_path / "yadeimport.py").symlink_to("/usr/bin/yade")
    run = played(tmp_path, "import sys; sys.path.insert(0, '.'); import yadeimport\n")
    assert run.returncode == 0, run.stderr
    assert "plain: at rest" in run.stdout
