# SPDX-License-Identifier: GPL-2.0-or-later
"""The tree is formatted and imports nothing in vain; and a file that is not, is seen."""

import importlib.util

import formatting
import pytest
import tree

needsClangFormat = pytest.mark.skipif(
    not formatting.clangFormat(),
    reason="clang-format 14 is not installed; another version breaks other lines",
)
needsBlack = pytest.mark.skipif(
    formatting.version("black") != formatting.BLACK,
    reason="black 23 is not installed; another version breaks other lines",
)
needsPyflakes = pytest.mark.skipif(
    not importlib.util.find_spec("pyflakes"), reason="pyflakes is not installed"
)


@needsClangFormat
def test_cpp_is_formatted_by_clang_format():
    paths = tree.files(tree.CPP)
    assert len(paths) > 100  # it looks at the tree, not at an empty folder
    assert formatting.unformattedCpp(paths) == []


@pytest.mark.slow
@needsBlack
def test_python_is_formatted_by_black():
    paths = tree.files((".py",))
    assert len(paths) > 150
    assert formatting.unformattedPython(paths) == []


@pytest.mark.slow
@needsPyflakes
def test_no_import_is_unused():
    found = {path: formatting.unusedImports(path) for path in tree.files((".py",))}
    assert {path: unused for path, unused in found.items() if unused} == {}


# -- the gates see what they are for ---------------------------------------------------------------


@needsClangFormat
def test_a_line_that_clang_format_would_change_is_found(tmp_path):
    (tmp_path / ".clang-format").write_text(tree.read(".clang-format"))
    (tmp_path / "good.cpp").write_text("int one() { return 1; }\n")
    bad = "int one() { return 1; }\nint  two(){return 2;}\n"
    (tmp_path / "bad.cpp").write_text(bad)
    names = ["good.cpp", "bad.cpp"]
    assert formatting.unformattedCpp(names, tmp_path) == ["bad.cpp:2"]


@needsBlack
def test_a_file_that_black_would_change_is_found(tmp_path):
    (tmp_path / "good.py").write_text('one = "1"\n')
    (tmp_path / "bad.py").write_text("one = '1'\n")
    (tmp_path / "broken.py").write_text("one = (\n")
    found = formatting.unformattedPython(["good.py", "bad.py", "broken.py"], tmp_path)
    assert len(found) == 2 and any("bad.py" in line for line in found)


UNUSED = '''"""An example."""
import os
import math, sys
from json import dumps, loads as parse
from . import neighbour
import signal  # noqa: F401: it is imported for what it does


def one():
    import re, string

    return math.pi, dumps, string
'''


@needsPyflakes
def test_unused_imports_are_found(tmp_path):
    (tmp_path / "example.py").write_text(UNUSED)
    found = formatting.unusedImports("example.py", tmp_path)
    assert found[:2] == [(2, "os"), (3, "sys")]
    assert found[2:] == [(4, "json.loads as parse"), (5, ".neighbour"), (10, "re")]
    (tmp_path / "__init__.py").write_text("from .example import one\n")
    assert formatting.unusedImports("__init__.py", tmp_path) == []
