# SPDX-License-Identifier: GPL-2.0-or-later
"""Type hints of what users call: they are there, mypy finds no error in them, and finds those of a
user."""

import ast
import os
import re
import subprocess
import sys

import pytest
import tree

SCRIPTS = os.path.join(tree.ROOT, "scripts")
#: What users call: all public functions, methods and classes of these modules.
PUBLIC = """
    masonry.model.bodies masonry.model.connecting masonry.model.engines masonry.model.window
    masonry.bricks.beams masonry.bricks.blocks masonry.bricks.block_files masonry.bricks.vaults
    masonry.bricks.walls
    masonry.numbers.cracks masonry.numbers.curves masonry.numbers.files masonry.numbers.frames
    masonry.numbers.loops
    masonry.materials.assumptions masonry.materials.codes masonry.materials.fields
    masonry.materials.formulas masonry.materials.kinds masonry.materials.sources
    masonry.scene.accelerograms.__init__ masonry.scene.connections masonry.scene.ground
    masonry.scene.loads
    masonry.scene.platens masonry.scene.records masonry.scene.scene masonry.scene.targets
    masonry_capacity.bilinear_curve masonry_capacity.domains masonry_capacity.figure
    masonry_capacity.n2 masonry_capacity.piers masonry_capacity.report masonry_capacity.spectra
    masonry_limit.assembly masonry_limit.bound masonry_limit.reading
    masonry_study.calibrate masonry_study.incremental masonry_study.plan masonry_study.spectrum
    masonry_study.variables
    masonry_view.comparison masonry_view.curve_figure masonry_view.figures masonry_view.measure
    masonry_view.viewer
""".split()
#: Modules that hold more than what users call, which is checked as a stage or a command there.
MIXED = [f"masonry.stages.{n}" for n in "rest push supports gravity forces shake".split()]
MIXED.append("masonry.run.checkpoints")
PACKAGES = "masonry masonry_view masonry_limit masonry_capacity masonry_study".split()
MYPY = [sys.executable, "-m", "mypy", "--config-file", os.path.join(tree.ROOT, "pyproject.toml")]
needsMypy = pytest.mark.skipif(
    subprocess.run([*MYPY[:3], "--version"], capture_output=True).returncode != 0,
    reason="mypy is not installed",
)


def functions(path):
    """The public functions and methods of a source: pairs of a name and a node."""
    with open(path, encoding="utf-8") as file:
        parsed = ast.parse(file.read())
    for node in parsed.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef):
                    if not inner.name.startswith("_") or inner.name == "__init__":
                        yield f"{node.name}.{inner.name}", inner


def withoutHint(node):
    """What of a function has no hint: names of its arguments, and ``return``."""
    of = node.args
    every = [*of.posonlyargs, *of.args, *of.kwonlyargs, of.vararg, of.kwarg]
    missing = [a.arg for a in every if a and a.annotation is None]
    missing = [name for name in missing if name not in ("self", "cls")]
    return missing + ["return"] * (node.returns is None)


def test_a_missing_hint_is_found():
    node = ast.parse("def f(a, b: int, *c, d=1): pass").body[0]
    assert withoutHint(node) == ["a", "d", "c", "return"]


@pytest.mark.parametrize("module", [*PUBLIC, *MIXED])
def test_what_users_call_has_hints(module):
    isStage = lambda node: any(
        re.match(r"validated|stage\(", ast.unparse(d)) for d in node.decorator_list
    )
    every = functions(os.path.join(SCRIPTS, *module.split(".")) + ".py")
    every = [(n, node) for n, node in every if module in PUBLIC or isStage(node)]
    found = {name: withoutHint(node) for name, node in every}
    assert found
    assert {name: missing for name, missing in found.items() if missing} == {}


def mypy(tmp_path_factory, *words):
    cache = tmp_path_factory.getbasetemp() / "mypy"  # shared by the tests of this run
    around = dict(cwd=os.path.join(tree.ROOT, "scripts"), timeout=300)
    command = [*MYPY, "--cache-dir", str(cache), *words]
    run = subprocess.run(command, capture_output=True, text=True, **around)
    return run.stdout + run.stderr


@needsMypy
@pytest.mark.slow
def test_mypy_finds_no_error_in_the_packages(tmp_path_factory):
    words = [word for package in PACKAGES for word in ("-p", package)]
    said = mypy(tmp_path_factory, *words)
    assert "Success: no issues found" in said, said


@needsMypy
@pytest.mark.slow
def test_mypy_finds_no_error_in_a_scene_or_a_snippet(tmp_path_factory, tmp_path):
    paths = [
        os.path.join(tree.ROOT, p)
        for p in tree.files((".py",))
        if re.fullmatch(r"scripts/(gallery/)?\w+\.py", p)
    ]
    for document in tree.files((".md",)):
        for n, code in enumerate(
            re.findall(r"^```python\n(.*?)^```", tree.read(document), re.M | re.S)
        ):
            name = tmp_path / f"{re.sub(r'[^a-zA-Z]', '_', document)}{n}.py"
            name.write_text(code)
            paths.append(str(name))
    assert len(paths) > 20
    said = mypy(tmp_path_factory, "--scripts-are-modules", *paths)
    assert "Success: no issues found" in said, said


BEGIN = """
from masonry import Scene, bricks, materials

scene = Scene("wall", bricks.Wall(length=2.2, height=2.106), materials.calciumSilicate(), rate=50)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
"""
#: Lines of a script, and what mypy must say to them.
WRONG = {
    'scene.push(top, "5")': 'has incompatible type "str"',
    "scene.push(5.0)": 'has incompatible type "float"; expected',
    "scene.press(top)": "No overload variant",
    'scene.press(top, 0.3e6, riding="x")': "No overload variant",
    'scene.platen("top", hight=0.2)': 'did you mean "height"?',
    "scene.pusch(top)": 'maybe "push"?',
    "ended: int = scene.settle()": "Incompatible types in assignment",
    "bricks.Wall(lenght=2.2)": 'did you mean "length"?',
    'bricks.stack("4", (0.4, 0.3, 0.3))': 'has incompatible type "str"; expected "int"',
    'materials.dry(friction="0.6")': 'has incompatible type "str"',
    "scene.watch((0.2, 0.15, 1.2)).fixd": 'has no attribute "fixd"',
    "from masonry import Arch": 'has no attribute "Arch"',
    'import masonry_study as study; study.Study("s", runs="200")': 'has incompatible type "str"',
    "import masonry_limit as limit; limit.read().largest()": "Missing positional arguments",
    "from masonry import addBlock; addBlock()": "Missing positional arguments",
}
RIGHT = """
scene.press(top, 0.3e6, riding=False)
scene.settle()
scene.press(top, 0.4e6, longest=3.0)
scene.hold(3)
scene.hold(top, axes="x")
scene.cycle(top, [1, 2, 4], repeats=2)
factor: float = scene.factor
"""


@needsMypy
@pytest.mark.slow
def test_mypy_finds_what_a_user_does_wrong_and_nothing_else(tmp_path_factory, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(BEGIN + RIGHT + "\n".join(WRONG) + "\n")
    said = mypy(tmp_path_factory, str(script))
    first = (BEGIN + RIGHT).count("\n") + 1
    for number, (line, expected) in enumerate(WRONG.items(), start=first):
        found = [one for one in said.splitlines() if f"script.py:{number}: error:" in one]
        assert len(found) == 1 and expected in found[0], (line, found)
    assert said.count(": error:") == len(WRONG), said


def test_the_package_says_that_it_has_hints():
    for package in PACKAGES:
        assert os.path.isfile(os.path.join(SCRIPTS, package, "py.typed"))
    assert 'PATTERN "py.typed"' in tree.read("CMakeLists.txt")
