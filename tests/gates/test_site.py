# SPDX-License-Identifier: GPL-2.0-or-later
"""The list of pages in scripts/docs/build.py holds every document and nothing else. Needs neither
Sphinx nor YADE."""

import ast
import os
import re
import sys

import pytest
import tree

DOCS = os.path.join(tree.ROOT, "scripts", "docs")
sys.path.insert(0, DOCS)

import build
import staging

DOCUMENTS = staging.documents()


def test_every_document_has_its_section_and_every_page_its_source():
    tables = build.contents(DOCUMENTS)
    assert "yade_plugin/contact/README\n" in tables["README.md"]
    assert "wall_comp4/README\n" in tables["validation/README.md"]


def test_a_document_without_section_and_a_page_without_source_are_found():
    with pytest.raises(ValueError, match="no section of build.py has scripts/NEW$"):
        build.contents([*DOCUMENTS, "scripts/NEW.md"])
    with pytest.raises(
        ValueError, match="build.py names CONTRIBUTING, which the repository does not have"
    ):
        build.contents([d for d in DOCUMENTS if d != "CONTRIBUTING.md"])


def sourceOf(module):
    """The text of a module or package; None if there is none."""
    path = os.path.join(tree.ROOT, "scripts", *module.split("."))
    for file in (path + ".py", os.path.join(path, "__init__.py")):
        if os.path.isfile(file):
            return tree.read(file)
    return None


def test_the_site_imports_modules_and_names_that_the_package_has():
    count = 0
    for path in tree.files((".py",), DOCS):
        for node in ast.walk(ast.parse(tree.read(path, DOCS))):
            if isinstance(node, ast.ImportFrom) and node.module.startswith("masonry"):
                text = sourceOf(node.module)
                assert text is not None, (path, node.module)
                for name in (one.name for one in node.names):
                    count += 1
                    assert sourceOf(f"{node.module}.{name}") or re.search(rf"\b{name}\b", text), (
                        path,
                        node.module,
                        name,
                    )
    assert count > 5


def test_the_programs_whose_options_the_site_shows_are_there():
    programs = re.findall(r'^    "(-m )?([\w./]+)",$', tree.read("generated.py", DOCS), re.M)
    assert len(programs) >= 5
    for module, name in programs:
        if module:
            assert sourceOf(name + ".__main__") or sourceOf(name), name
        else:
            assert os.path.isfile(os.path.join(tree.ROOT, name)), name
