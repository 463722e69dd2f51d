# SPDX-License-Identifier: GPL-2.0-or-later
"""What is said and left out where a package that only a part of the project needs is not
installed."""

from usual import *
from masonry import packages

#: Modules named in MISSING cannot be imported, as if they were not installed.
HIDES = """
import os, sys
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] == os.environ["MISSING"]:
            raise ModuleNotFoundError(f"No module named '{name}'", name=name)
sys.meta_path.insert(0, Hidden())
"""


def without(module, tmp_path, *command):
    (tmp_path / "sitecustomize.py").write_text(HIDES)
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    env = dict(os.environ, PYTHONPATH=path, MISSING=module, OMP_NUM_THREADS="1")
    return ran(command, cwd=tmp_path, env=env, timeout=120)


def sentence(module):
    package, what = packages.NEEDED_FOR[module]
    return (
        f"{what} the Python module {module}, which is not installed: apt-get install"
        f" --no-install-recommends {package}"
    )


@mark.parametrize(
    "module, use",
    [
        (
            "ezdxf",
            (
                "open('a.dxf', 'w').write(''); from masonry import bricks;"
                " bricks.fromOutlines('a.dxf', 1, 0.1)"
            ),
        ),
        ("jinja2", "from masonry_view import pages; pages.rendered('page/page.html')"),
        ("matplotlib", "from masonry.numbers import drawing; drawing.empty(1, 1)"),
        (
            "svgelements",
            (
                "open('a.svg', 'w').write('<svg/>'); from masonry import bricks;"
                " bricks.fromOutlines('a.svg', 1, 0.1)"
            ),
        ),
        ("openturns", "from masonry_study import lognormal; lognormal(1, 0.1).law()"),
        ("scipy", "from masonry import bricks"),
    ],
)
def test_a_missing_module_is_one_sentence_with_the_command_that_installs_it(tmp_path, module, use):
    done = without(module, tmp_path, sys.executable, "-c", use)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].endswith(sentence(module)), done.stderr


@mark.parametrize(
    "module, parts, absent",
    [
        (
            "matplotlib",
            ("the figures are left out",),
            ("curve.png", "mechanism.png"),
        ),
        ("meshio", ("the mechanism for ParaView is left out",), ("mechanism_blocks.vtu",)),
    ],
)
def test_a_run_leaves_out_what_a_missing_module_draws_and_ends_in_order(
    tmp_path, module, parts, absent
):
    scene = os.path.join(ROOT, "scripts", "wall_comp4.py")
    words = f"yade -n -x {scene} --until 0.02 --quick --no-vtk --out run".split()
    done = without(module, tmp_path, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    lines = (done.stdout + done.stderr).splitlines()
    for part in parts:
        assert f"{part}: {sentence(module)}" in lines
    assert "Traceback" not in done.stderr
    there = os.listdir(tmp_path / "run")
    drawn = {"curve.png", "mechanism.png", "mechanism_blocks.vtu"}
    assert drawn & set(there) == drawn - set(absent)


def test_the_setup_of_a_run_and_of_tests_installs_every_package_that_is_named():
    setup = open(os.path.join(ROOT, "scripts", "setup.sh")).read()
    run, tests = setup.split("    --tests)\n")
    for package, _ in packages.NEEDED_FOR.values():
        listed = tests if package == "python3-openturns" else run
        assert re.search(rf"\b{package}\b", listed), package
