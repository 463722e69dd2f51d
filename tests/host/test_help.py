"""``help(masonry)`` leads to every module of the package, step by step, and each says what it is."""

import importlib
import os
import pydoc
import re

import masonry
import pytest

PACKAGE = os.path.dirname(os.path.abspath(masonry.__file__))


def modules():
    """Names of all modules by their files, whether or not Python finds them."""
    for folder, folders, names in os.walk(PACKAGE):
        folders[:] = sorted(f for f in folders if f != "__pycache__")
        inner = os.path.relpath(folder, PACKAGE)
        parts = ["masonry"] + ([] if inner == "." else inner.split(os.sep))
        for name in sorted(names):
            if name.endswith(".py") and name != "__main__.py":
                yield ".".join(parts + [name[:-3]] * (name != "__init__.py"))


MODULES = [name for name in modules() if name != "masonry"]


def test_there_are_modules_to_look_at():
    assert len(MODULES) > 30


@pytest.mark.parametrize("name", MODULES)
def test_help_leads_to_every_module(name):
    """The help of a package lists what is in it; of a folder without ``__init__.py`` it would not know."""
    package, _, last = name.rpartition(".")
    shown = pydoc.render_doc(importlib.import_module(package), renderer=pydoc.plaintext)
    contents = shown.split("PACKAGE CONTENTS")[1].split("\n\n")[0].split()
    assert last in contents
    assert importlib.import_module(name).__doc__, "says nothing of itself"


def test_modules_that_the_help_of_the_package_names_exist():
    named = re.findall(r":mod:`([\w.]+)`", masonry.__doc__)
    assert len(named) > 10
    assert set(named) <= set(MODULES)
