"""Who may import whom in the Python package and in the scenes, by what their sources say."""

import ast
import os

import pytest
from conftest import ROOT

PACKAGE = os.path.join(ROOT, "scripts", "masonry")

#: The modules of the package. Each imports only those above it; those without YADE come first.
WITHOUT_YADE = [
    "errors",
    "progress",
    "brickwork",
    "columns",
    "loops",
    "curves",
    "history",
    "presets",
    "results",
    "figures",
    "measure",
]
ORDER = WITHOUT_YADE + [
    "_masonry",  # the plugin
    "scene",
    "materials",
    "checkpoints",
    "options",
    "model",
    "run",
    "loading",
    "walls",
    "couplet",
    "__init__",
]
MODULES = [name for name in ORDER if name != "_masonry"]
SCENES = [n[:-3] for n in os.listdir(os.path.join(ROOT, "scripts")) if n[-3:] == ".py"]


def imports(path):
    """Every import of a source: (module, function-level or not), modules of the package by their bare names."""
    tree = ast.parse(open(path).read())
    top = set(map(id, tree.body))
    if os.path.basename(path) == "__init__.py":  # under `if "yade" in sys.modules`
        top = set(map(id, ast.walk(tree)))
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [node.module]
            if node.module == "masonry":
                names = [f"masonry.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f"masonry.{node.module}"]
        elif isinstance(node, ast.ImportFrom):
            names = [f"masonry.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            yield name, id(node) in top


def ownModule(name):
    """The module of the package that an import names, "__init__" for what only the package itself has, or None."""
    if name.split(".")[0] != "masonry":
        return None
    return (name.split(".") + ["__init__"])[1] if name != "masonry" else "__init__"


def test_the_order_names_all_modules():
    files = [name[:-3] for name in os.listdir(PACKAGE) if name.endswith(".py")]
    assert sorted(files) == sorted(MODULES)


@pytest.mark.parametrize("module", MODULES)
def test_a_module_imports_only_those_above_it(module):
    for name, _ in imports(os.path.join(PACKAGE, module + ".py")):
        own = ownModule(name)
        if own:
            assert own in ORDER, f"{module} imports {name} from the package itself"
            assert ORDER.index(own) < ORDER.index(module), f"{module} imports {own}"


def test_no_circle_of_imports():
    """This follows from the order of the modules. It is tested separately, in case the order given here is wrong."""
    graph = {
        module: {
            ownModule(name)
            for name, _ in imports(os.path.join(PACKAGE, module + ".py"))
        }
        for module in MODULES
    }

    def visit(module, path):
        assert module not in path, " -> ".join([*path, module])
        for other in graph.get(module, ()):
            visit(other, [*path, module])

    for module in graph:
        visit(module, [])


@pytest.mark.parametrize("module", MODULES)
def test_a_module_imports_no_scene_and_breaks_no_circle_in_a_function(module):
    for name, atTop in imports(os.path.join(PACKAGE, module + ".py")):
        assert name not in SCENES
        assert atTop or not ownModule(name), f"{module} imports {name} in a function"


@pytest.mark.parametrize("module", WITHOUT_YADE)
def test_what_reads_results_needs_no_yade(module):
    for name, _ in imports(os.path.join(PACKAGE, module + ".py")):
        assert name.split(".")[0] != "yade"


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_imports_no_scene_and_is_short(scene):
    path = os.path.join(ROOT, "scripts", scene + ".py")
    for name, _ in imports(path):
        assert name not in SCENES
    assert len(open(path).read().splitlines()) < 60
