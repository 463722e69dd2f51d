# SPDX-License-Identifier: GPL-2.0-or-later
"""help(masonry) leads to every module: it names the rooms, and each room names its modules."""

from usual import *
import ast

PACKAGE = os.path.join(ROOT, "scripts", "masonry")
#: Rooms of many modules. Those of bricks, limit and study are named by what users call, not by
#: their modules.
ROOMS = ["assembly", "capacity", "read", "run", "scene", "scene/stages"]


def helpOf(folder):
    source = open(os.path.join(PACKAGE, folder, "__init__.py")).read()
    return ast.get_docstring(ast.parse(source))


def unnamed(folder, text):
    """Modules and packages of a folder that a text does not name."""
    names = (n.removesuffix(".py") for n in os.listdir(os.path.join(PACKAGE, folder)))
    names = {n for n in names if n.isidentifier() and not n.startswith("_")}
    dotted = ".".join(["masonry", *filter(None, folder.split("/"))])
    return {n for n in names if f"`{dotted}.{n}`" not in text}


def test_help_names_every_room():
    assert unnamed("", helpOf("")) == set()


@mark.parametrize("package", ROOMS)
def test_a_room_names_each_of_its_modules(package):
    assert unnamed(package, helpOf(package)) == set()


@mark.parametrize("package", ["", *ROOMS])
def test_what_a_room_names_is_there(package):
    named = re.findall(r":mod:`masonry\.([\w.]+)`", helpOf(package))
    assert named
    for name in named:
        path = os.path.join(PACKAGE, *name.split("."))
        assert os.path.isdir(path) or os.path.isfile(path + ".py"), name


def test_a_module_that_is_not_named_is_seen():
    assert unnamed("run", helpOf("run").replace("masonry.run.batch", "")) == {"batch"}
