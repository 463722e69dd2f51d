# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run imports: its start is short because it loads nothing that it does not need."""

from usual import *

#: What only pictures, limit analysis, studies and files of bricks need: each takes a tenth of a
#: second or more.
NOT_NEEDED = [
    "matplotlib",
    "meshio",
    "openturns",
    "pandas",
    "scipy",
    "masonry_study",
    "numpy.testing",
]
SCRIPT = """
import json, sys
before = set(sys.modules)
try:
    exec(compile(open({scene!r}).read(), {scene!r}, "exec"), globals())
except SystemExit as end:
    assert not end.code, end.code
json.dump(sorted(set(sys.modules) - before), open("modules.json", "w"))
"""


@mark.parametrize("scene", ["wall_comp4", "parapet"])
def test_a_lean_run_loads_no_library_that_it_does_not_need(tmp_path, scene):
    path = scenePath(scene)
    (tmp_path / "counted.py").write_text(SCRIPT.format(scene=path))
    words = ["--until", "0.02"] if scene == "wall_comp4" else []
    runProgram("counted.py", "--quick", "--lean", "--out", "run", *words, cwd=tmp_path)
    assert os.path.exists(tmp_path / "run" / "run.json")
    loaded = json.loads((tmp_path / "modules.json").read_text())
    assert "masonry.scene.scene" in loaded  # they were counted
    for name in NOT_NEEDED:
        found = [one for one in loaded if one == name or one.startswith(name + ".")]
        assert not found, f"{name} is loaded: {found[:5]}"


def test_what_makes_bricks_loads_no_library_that_looks_at_hulls(tmp_path):
    script = (
        "import sys; from masonry import bricks; wall = bricks.Wall(1.1, 0.81); print(len(wall),"
        " 'scipy.spatial' in sys.modules); print(round(wall.volume, 9), 'scipy.spatial' in"
        " sys.modules)"
    )
    done = ran(["/usr/bin/python3", "-c", script], cwd=tmp_path)
    assert done.stdout.splitlines() == ["100 False", f"{1.1 * 0.81 * 0.102:.9g} True"], done.stderr


def test_yade_starts_in_plain_python_without_the_shell_of_which_it_wants_the_version(tmp_path):
    script = (
        "import sys, masonry; masonry.classes; import yade.runtime; print('IPython' in"
        " sys.modules); import IPython; print(yade.runtime.ipython_version == 100 *"
        " IPython.version_info[0] + IPython.version_info[1])"
    )
    done = ran(["/usr/bin/python3", "-c", script], cwd=tmp_path)
    assert done.stdout.split() == ["False", "True"], done.stderr
