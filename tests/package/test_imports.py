# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may import whom in the Python package and in the scenes, by what their sources say."""

from usual import *
import ast
import glob
import graphlib

PACKAGE = os.path.join(ROOT, "scripts", "masonry")

#: The rooms of the package. Each imports only those above it, and itself.
LAYERS = [
    "basics",
    "common",
    "bricks",
    "read",
    "capacity",
    "assembly",
    "run",
    "limit",
    "scene",
    "study",
]
#: Rooms and modules that work where YADE is not installed, with all that they import.
WITHOUT_YADE = LAYERS[: LAYERS.index("assembly")] + ["study"]
WITHOUT_YADE += "run.accuracy run.batch run.presets run.progress run.lock".split()
WITHOUT_YADE += ["run.results", "scene.fields", "scene.history"]
PACKAGES = [name for name in LAYERS if os.path.isdir(os.path.join(PACKAGE, name))]
MODULES = [
    path.removesuffix(".py").replace(os.sep, ".")
    for path in sorted(glob.glob("**/*.py", root_dir=PACKAGE, recursive=True))
]
SCENES = glob.glob("*.py", root_dir=os.path.join(ROOT, "scripts"))
SCENES = [n.removesuffix(".py") for n in SCENES if n != "check_host.py"]


def source(module):
    return os.path.join(PACKAGE, *module.split(".")) + ".py"


def imports(path):
    """Every import of a source: (module, function-level or not), with the whole names of
    modules."""
    tree = ast.parse(open(path).read())
    top = set(map(id, tree.body))
    if os.path.basename(path) == "__init__.py":  # they start YADE, or hand names on
        top = set(map(id, ast.walk(tree)))
    folder = os.path.relpath(os.path.dirname(path), os.path.dirname(PACKAGE))
    here = folder.split(os.sep)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = here[: len(here) + 1 - node.level] if node.level else []
            parts += [node.module] if node.module else []
            whole = ".".join(parts)
            names = [whole]
            if whole in ("masonry", *("masonry." + inner for inner in PACKAGES)):
                names = [f"{whole}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            yield name, id(node) in top


def ownModule(name):
    """The module of the package that an import names, or None. A package that is imported is its
    ``__init__``."""
    package, *rest = name.split(".")
    if package != "masonry" or rest[:1] == ["_masonry"]:  # the plugin
        return None
    while rest:
        for own in (".".join(rest), ".".join([*rest, "__init__"])):
            if own in MODULES:
                return own
        rest.pop()
    return "__init__"


def layer(module):
    folder = module.split(".")[0]
    return LAYERS.index(folder) if folder in LAYERS else len(LAYERS)


GRAPH = {m: {ownModule(name) for name, _ in imports(source(m))} for m in MODULES}
GRAPH = {module: owns - {None, module} for module, owns in GRAPH.items()}


def test_every_module_has_its_room():
    assert len(MODULES) > 60
    for module in MODULES:
        assert module == "__init__" or module.split(".")[0] in LAYERS


@mark.parametrize("module", MODULES)
def test_a_module_imports_only_its_own_room_and_those_above_it(module):
    for own in GRAPH[module] - {"__init__"}:
        assert layer(own) <= layer(module), f"{module} imports {own}"
    allowed = {"__init__"} if module == "__init__" else set()
    assert "__init__" not in GRAPH[module] - allowed, f"{module} imports the package"


def test_no_circle_of_imports():
    graphlib.TopologicalSorter(GRAPH).prepare()  # raises an error that names one


@mark.parametrize("module", MODULES)
def test_a_module_imports_no_scene_and_breaks_no_circle_in_a_function(module):
    for name, atTop in imports(source(module)):
        assert name not in SCENES
        assert atTop or not ownModule(name), f"{module} imports {name} in a function"


def needed(module, found=None):
    """All modules that a module imports, and those that they import."""
    found = set() if found is None else found
    for other in GRAPH[module] - found:
        found.add(other)
        needed(other, found)
    return found


@mark.parametrize("folder", WITHOUT_YADE)
def test_what_reads_results_needs_no_yade(folder):
    modules = [m for m in MODULES if m == folder or m.startswith(folder + ".")]
    assert modules
    for module in modules:
        for one in {module, *needed(module)}:
            for name, _ in imports(source(one)):
                host = name.startswith(("yade", "masonry._masonry"))
                assert not host, f"{module} needs {one}, which imports {name}"


@mark.parametrize("scene", SCENES)
def test_a_scene_imports_no_scene_and_is_short(scene):
    path = os.path.join(ROOT, "scripts", scene + ".py")
    for name, _ in imports(path):
        assert name not in SCENES
    assert len(open(path).read().splitlines()) <= 60  # with the line of the licence
