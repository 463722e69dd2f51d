# SPDX-License-Identifier: GPL-2.0-or-later
"""help(masonry) leads to every module: it names the rooms, and each of them names its modules."""

from usual import *
import ast
import inspect

SCRIPTS = os.path.join(ROOT, "scripts")
#: Packages of many modules. Those of bricks, limit and study are named by what users call,
#: not by their modules.
ROOMS = "masonry.model masonry.numbers masonry.run masonry.scene masonry.stages".split()
ROOMS += ["masonry_capacity", "masonry_view"]
#: Packages of the ground floor, beside the rooms.
GROUND = (
    "arguments auxiliary background errors folders host memory moved notebook packages terminal"
    " texts units"
).split()


def folderOf(package):
    return os.path.join(SCRIPTS, *package.split("."))


def helpOf(package):
    source = open(os.path.join(folderOf(package), "__init__.py")).read()
    return ast.get_docstring(ast.parse(source))


def unnamed(package, text):
    """Modules and packages of a package that a text does not name."""
    names = (n.removesuffix(".py") for n in os.listdir(folderOf(package)))
    names = {n for n in names if n.isidentifier() and not n.startswith("_")}
    return {n for n in names if f"`{package}.{n}`" not in text}


def test_help_names_every_room_and_every_wing():
    text = helpOf("masonry")
    assert unnamed("masonry", text) == set(GROUND) - {"host"}
    wings = [name for name in os.listdir(SCRIPTS) if name.startswith("masonry_")]
    assert len(wings) == 4 and [name for name in wings if f"`{name}`" not in text] == []


@mark.parametrize("package", ROOMS)
def test_a_room_names_each_of_its_modules(package):
    assert unnamed(package, helpOf(package)) == set()


@mark.parametrize("package", ["masonry", *ROOMS])
def test_what_a_room_names_is_there(package):
    named = re.findall(r":mod:`(masonry[\w.]+)`", helpOf(package))
    assert named
    for name in named:
        path = folderOf(name)
        assert os.path.isdir(path) or os.path.isfile(path + ".py"), name


def test_a_module_that_is_not_named_is_seen():
    assert unnamed("masonry.run", helpOf("masonry.run").replace("masonry.run.batch", "")) == {
        "batch"
    }


def test_help_shows_the_types_of_arguments_without_their_kinds():
    from masonry import Scene, bricks, materials

    for thing in (Scene, Scene.push, Scene.shake, Scene.press, bricks.Wall, materials.masonry):
        shown = str(inspect.signature(thing))
        assert "Annotated" not in shown and "<function" not in shown, shown
    shown = str(inspect.signature(Scene.push))
    assert re.search(r"until: (Optional\[float\]|float \| None) = None", shown)
