# SPDX-License-Identifier: GPL-2.0-or-later
"""No part of the repository grows past its budget, and what does is measured rightly."""

import json
import subprocess
import sys

import pytest
import sizes


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="it counts more tokens in f-strings")
def test_no_part_grows_past_its_budget():
    allowed = sizes.budgets()
    weighed = sizes.weigh().items()
    assert [x for part, one in weighed for x in sizes.over(part, *one, allowed.get(part, {}))] == []


def test_a_commit_that_raises_a_budget_changes_nothing_else():
    found = sizes.raisedBeside()
    if found is None:
        pytest.skip("not in a clone")
    assert found == []


# -- the gates see what they are for ---------------------------------------------------------------


def test_what_is_over_its_budget_is_told_with_what_to_do():
    found = {"modules": 12, "tokens": 104, "arrows": 4, "function": 61, "long": 1}
    places = {"function": "push of scripts/a.py"}
    allowed = {"modules": 12, "tokens": 100, "arrows": 3, "function": 60}
    tokens, arrows, function, new = sizes.over("core", found, places, allowed)
    assert tokens.startswith("core: 104 tokens are 4 more than its budget. Take out")
    assert arrows.startswith("core: 4 arrows are 1 more")
    assert function.startswith(
        "push of scripts/a.py has 61 lines, and no function of the core may have more than 60"
    )
    assert new == "core has no budget of its long: sizes.py --write notes it"
    assert not list(sizes.over("core", {"tokens": 103}, {}, allowed))


def test_a_raised_budget_beside_other_changes_is_found(tmp_path):
    git = lambda *words: subprocess.run(["git", "-C", tmp_path, *words], check=True)
    assert sizes.raisedBeside(tmp_path) is None
    git("init", "-q")
    file = tmp_path / sizes.BUDGET
    file.parent.mkdir(parents=True)

    def commit(title, other, **budgets):
        file.write_text(json.dumps(budgets))
        (tmp_path / "other").write_text(other)
        git("add", ".")
        git("-c", "user.name=a", "-c", "user.email=a@example.org", "commit", "-qm", title)

    commit("first", "1", tests={"lines": 5})
    commit("of lines", "2", tests={"lines": 6}, core={"tokens": 5})
    commit("lowered", "3", core={"tokens": 4})
    commit("alone", "3", core={"tokens": 5})
    commit("of a new part", "4", core={"tokens": 5}, view={"tokens": 2})
    assert sizes.raisedBeside(tmp_path) == []
    commit("beside", "5", core={"tokens": 6}, view={"tokens": 2})
    assert [title.split(maxsplit=1)[1] for title in sizes.raisedBeside(tmp_path)] == ["beside"]


PYTHON = '''"""One sentence of six words here."""


class Wall:  # a comment of five words
    def height(self):
        return 2.5
'''
CPP = """namespace masonry {
template <class Law> struct Joint : Base {
    Joint(int first, // a comment within it
          int second)
        : first(first), second(second) {
        for (int i = 0; i < first; ++i) {
            use(i);
        }
    }
    int one() const { return 1; }
};

void walk(const char* name) {
    use(name);
}
} // namespace masonry
"""


def test_tokens_classes_and_functions_are_counted():
    # a docstring of six words; class Wall : a comment; def height ( self ) : return 2.5
    assert sizes.tokens("a.py", PYTHON) == 6 + 3 + 5 + 6 + 2
    assert sizes.tokens("a.js", "let a=1; // two") == 5 + 1
    assert sizes.tokens("a.cpp", "/* of two\n * words */ int a;") == 4 + 3
    assert list(sizes.ofPython(PYTHON)) == [("class", "Wall", 3), ("function", "height", 2)]
    assert list(sizes.ofCpp(CPP)) == [
        ("class", "Joint", 10),
        ("function", "Joint", 7),
        ("function", "walk", 3),
    ]


def test_imports_between_rooms_and_within_them_are_arrows():
    texts = {
        "scripts/wall/__init__.py": "from .read import files",
        "scripts/wall/one.py": "import os, wall.read.files\nfrom wall import two",
        "scripts/wall/two.py": "from .read.files import name\nfrom . import two",
        "scripts/wall/read/__init__.py": "",
        "scripts/wall/read/files.py": "def f():\n    from .. import one\n    from . import name",
        "scripts/wall/read/page/parts.py": "from .. import files",
    }
    found = sizes.arrows(texts)
    short = {tuple(p[len("scripts/wall/") : -3] for p in pair) for pair in found}
    assert short == {
        ("__init__", "read/files"),
        ("one", "two"),
        ("one", "read/files"),
        ("two", "read/files"),
        ("read/files", "one"),
        ("read/files", "read/__init__"),
        ("read/page/parts", "read/files"),
    }
    found, places = sizes.weighPart("core", texts)
    assert (found["arrows"], found["inside"], places["inside"]) == (4, 2, "wall/read")


def test_long_lines_count_but_in_what_black_leaves():
    long = "x = " + "1 + " * 30 + "1"
    table = f"def f():\n    t = [\n        {long[4:]}\n    ]  # fmt: skip\n"
    assert sizes.longLines(table) == 0
    assert sizes.longLines(table + long) == 1
    assert sizes.longLines("é" * 100) == 0
