# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may import whom in the Python packages and in the scenes, by what their sources say."""

import ast
import glob
import graphlib
import os
from dataclasses import dataclass

import pytest
import tree

SCRIPTS = os.path.join(tree.ROOT, "scripts")
CORE = "masonry"
#: The wings, each with those that it may import beside the core.
WINGS = {
    "masonry_capacity": set(),
    "masonry_limit": set(),
    "masonry_view": {"masonry_capacity.bilinear_curve"},
    "masonry_study": {"masonry_view.comparison"},
}
#: The floors of the core, each of one or several rooms or modules. What stands on one imports only
#: its own floor and those above it.
FLOORS = [
    (
        "arguments auxiliary background earth errors folders host memory moved notebook packages"
        " terminal texts units wings"
    ).split(),
    ["bricks"],
    ["numbers"],
    ["model"],
    ["materials"],
    ["run"],
    ["scene", "stages"],
]
#: Rooms and modules that work where YADE is not installed, with all that they import.
WITHOUT_YADE = [f"masonry.{name}" for name in (*FLOORS[0], "bricks", "numbers")]
WITHOUT_YADE += [f"masonry.run.{n}" for n in "accuracy batch presets progress lock results".split()]
WITHOUT_YADE += ["masonry.materials.fields", "masonry.scene.history", "masonry_capacity"]
#: What starts YADE, or shows a scene that stands in it.
WITH_YADE = {"masonry.numbers.columns", "masonry_study.probing", "masonry_view.notebook_scene"}


def modules():
    """The names of all modules, with their paths; a package is named as its ``__init__``."""
    for package in (CORE, *WINGS):
        for path in glob.glob(f"{package}/**/*.py", root_dir=SCRIPTS, recursive=True):
            yield path.removesuffix(".py").replace(os.sep, "."), os.path.join(SCRIPTS, path)


MODULES = dict(sorted(modules()))
SCENES = {
    os.path.basename(path).removesuffix(".py"): path
    for folder in ("", "gallery")
    for path in glob.glob(os.path.join(SCRIPTS, folder, "*.py"))
    if not path.endswith("check_host.py")
}


@dataclass
class Import:
    """An import of a source: the whole name, and whether it is carried out with the module."""

    name: str
    atTop: bool


def imports(path):
    """Every import of a source."""
    parsed = ast.parse(tree.read(path, ""))
    top = set(map(id, parsed.body))
    if os.path.basename(path) == "__init__.py":  # they start YADE, or hand names on
        top = set(map(id, ast.walk(parsed)))
    here = os.path.relpath(os.path.dirname(path), SCRIPTS).split(os.sep)
    for node in ast.walk(parsed):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = here[: len(here) + 1 - node.level] if node.level else []
            whole = ".".join(parts + ([node.module] if node.module else []))
            isPackage = whole + ".__init__" in MODULES
            names = [f"{whole}.{alias.name}" for alias in node.names] if isPackage else [whole]
        for name in names:
            yield Import(name, id(node) in top)


def ownModule(name):
    """The module of our packages that an import names, or None."""
    if name.split(".")[0] not in (CORE, *WINGS) or name.startswith("masonry._masonry"):
        return None  # the plugin is no module of Python
    parts = name.split(".")
    while parts:
        for own in (".".join(parts), ".".join([*parts, "__init__"])):
            if own in MODULES:
                return own
        parts.pop()
    return None


GRAPH = {m: {ownModule(one.name) for one in imports(path)} for m, path in MODULES.items()}
GRAPH = {module: owns - {None, module} for module, owns in GRAPH.items()}


def nameOf(module):
    """The name by which a module is imported."""
    return module.removesuffix(".__init__")


def packageOf(module):
    return module.split(".")[0]


def floor(module):
    """The floor of a module of the core; what hands on all of it stands below all floors."""
    room = module.split(".")[1]
    return next((n for n, rooms in enumerate(FLOORS) if room in rooms), len(FLOORS))


def test_every_module_of_the_core_has_its_room():
    assert len(MODULES) > 150
    own = [m for m in MODULES if packageOf(m) == CORE and m != "masonry.__init__"]
    assert [m for m in own if floor(m) == len(FLOORS)] == []


@pytest.mark.parametrize("module", MODULES)
def test_a_module_imports_its_own_floor_and_those_above_it(module):
    for other in GRAPH[module]:
        if packageOf(module) == CORE:
            assert packageOf(other) == CORE, f"{module} imports the wing {other}"
            assert floor(other) <= floor(module) or other == "masonry.__init__", other
        if other == "masonry.__init__":
            assert module == "masonry.__init__", f"{module} imports the package"


def public():
    """What wings may import of the core, as the core says it."""
    for node in ast.parse(tree.read("scripts/masonry/wings.py")).body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "PUBLIC":
            text = ast.literal_eval(node.value.func.value)
            return {f"masonry.{name}" for name in text.split()}


@pytest.mark.parametrize("wing", WINGS)
def test_a_wing_imports_what_is_public_and_no_other_wing(wing):
    allowed = public() | WINGS[wing]
    for module in (m for m in MODULES if packageOf(m) == wing):
        others = {nameOf(other) for other in GRAPH[module] if packageOf(other) != wing}
        assert others <= allowed, f"{module} imports {others - allowed}"


def test_what_is_public_is_used():
    used = {nameOf(o) for m in MODULES if packageOf(m) != CORE for o in GRAPH[m]}
    assert public() - used == set()


def test_no_circle_of_imports():
    graphlib.TopologicalSorter(GRAPH).prepare()  # raises an error that names one


def test_no_two_modules_of_the_core_have_one_name():
    names = [nameOf(m).split(".")[-1] for m in MODULES if packageOf(m) == CORE]
    assert {name for name in names if names.count(name) > 1} <= {
        "run",
        "scene",
    }  # rooms and their class


@pytest.mark.parametrize("module", MODULES)
def test_a_module_imports_no_scene_and_breaks_no_circle_in_a_function(module):
    for one in imports(MODULES[module]):
        assert one.name not in SCENES
        assert one.atTop or not ownModule(one.name), f"{module} imports {one.name} in a function"


def needed(module, found=None):
    """All modules that a module imports, and those that they import."""
    found = set() if found is None else found
    for other in GRAPH[module] - found:
        found.add(other)
        needed(other, found)
    return found


@pytest.mark.parametrize("room", [*WITHOUT_YADE, "masonry_view", "masonry_study"])
def test_what_reads_results_needs_no_yade(room):
    of = [m for m in MODULES if nameOf(m) == room or m.startswith(room + ".")]
    assert of
    for module in set(of) - WITH_YADE:
        for one in {module, *needed(module)} - {"masonry.__init__"}:
            for found in imports(MODULES[one]):
                host = found.name.startswith(("yade", "masonry._masonry"))
                assert not host, f"{module} needs {one}, which imports {found.name}"


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_imports_no_scene_and_is_short(scene):
    for one in imports(SCENES[scene]):
        assert one.name not in SCENES
    assert len(tree.read(SCENES[scene], "").splitlines()) <= 60  # with the line of the licence
