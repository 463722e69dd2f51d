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
    "columns",
    "loops",
    "curves",
    "history",
    "presets",
    "fields",
    "ground",
    "results",
    "batch",
    "frames",
    "figures",
    "measure",
    "comparison",
    "viewer_scene",
    "viewer",
    "bricks.geometry",
    "bricks.checks",
    "bricks.blocks",
    "bricks.bonds",
    "bricks.openings",
    "bricks.files",
    "bricks.vaults",
    "bricks.walls",
    "bricks.__init__",
    "ports",
    "study.variables",
    "study.designs",
    "study.plan",
    "study.gathering",
    "study.statistics",
    "study.estimate",
    "study.sensitivity",
    "study.pictures",
    "study.records",
    "study.report",
    "study.start",
    "study.row",
    "study.yadebatch",
    "study.local",
    "study.slurm",
    "study.__init__",
    "study.__main__",
]
ORDER = WITHOUT_YADE + [
    "_masonry",  # the plugin
    "scene",
    "limit.programme",
    "limit.bound",
    "limit.slipping",
    "limit.assembly",
    "limit.reading",
    "limit.__init__",
    "window",
    "materials",
    "checkpoints",
    "options",
    "plotting",
    "model",
    "run",
    "loading",
    "described",
    "bounds",
    "structure",
    "probing",
    "stages",
    "__init__",
]
MODULES = [name for name in ORDER if name != "_masonry"]
PACKAGES = ["bricks", "limit", "study"]  # inside the package
SCENES = [n[:-3] for n in os.listdir(os.path.join(ROOT, "scripts")) if n[-3:] == ".py"]


def source(module):
    return os.path.join(PACKAGE, *module.split(".")) + ".py"


def imports(path):
    """Every import of a source: (module, function-level or not), with the whole names of modules."""
    tree = ast.parse(open(path).read())
    top = set(map(id, tree.body))
    if os.path.basename(path) == "__init__.py":  # under `if "yade" in sys.modules`
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
    """The module of the package that an import names, "__init__" for what only a package itself has, or None."""
    package, *rest = name.split(".")
    if package != "masonry":
        return None
    if rest and rest[0] in PACKAGES:
        own = ".".join(rest[:2])
        return own if own in ORDER else rest[0] + ".__init__"
    return rest[0] if rest else "__init__"


def test_the_order_names_all_modules():
    files = [
        (f"{inner}." if inner else "") + name[:-3]
        for inner in ("", *PACKAGES)
        for name in os.listdir(os.path.join(PACKAGE, inner))
        if name.endswith(".py")
    ]
    assert sorted(files) == sorted(MODULES)


@pytest.mark.parametrize("module", MODULES)
def test_a_module_imports_only_those_above_it(module):
    for name, _ in imports(source(module)):
        own = ownModule(name)
        if own:
            assert own in ORDER, f"{module} imports {name} from the package itself"
            assert ORDER.index(own) < ORDER.index(module), f"{module} imports {own}"


def test_no_circle_of_imports():
    """This follows from the order of the modules. It is tested separately, in case the order given here is wrong."""
    graph = {
        module: {ownModule(name) for name, _ in imports(source(module))}
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
    for name, atTop in imports(source(module)):
        assert name not in SCENES
        assert atTop or not ownModule(name), f"{module} imports {name} in a function"


@pytest.mark.parametrize("module", WITHOUT_YADE)
def test_what_reads_results_needs_no_yade(module):
    for name, _ in imports(source(module)):
        assert name.split(".")[0] != "yade"


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_imports_no_scene_and_is_short(scene):
    path = os.path.join(ROOT, "scripts", scene + ".py")
    for name, _ in imports(path):
        assert name not in SCENES
    assert len(open(path).read().splitlines()) <= 60  # with the line of the licence
