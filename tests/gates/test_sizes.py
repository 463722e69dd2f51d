# SPDX-License-Identifier: GPL-2.0-or-later
"""No part of the repository grows past its budget, and what does is measured rightly."""

import sys

import pytest
import sizes


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="it counts more tokens in f-strings")
@pytest.mark.parametrize("part", sizes.PARTS)
def test_no_part_grows_past_its_budget(part):
    assert list(sizes.over(part, *sizes.weigh(part), sizes.budget()[part])) == []


def test_what_is_over_its_budget_is_told_with_what_to_do():
    found = {"lines": 12, "tokens": 99, "function": 61}
    places = {"function": "push of scripts/a.py"}
    allowed = {"lines": 12, "tokens": 90, "function": 60}
    tokens, function = sizes.over("package", found, places, allowed)
    assert tokens.startswith("package: 99 tokens are 9 more than its budget. Take out")
    assert function.startswith(
        "push of scripts/a.py has 61 lines, and no function of the package may have more than 60"
    )


PYTHON = '''"""One sentence of six words here."""


class Wall:  # a comment is no token
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
    # a docstring of six words; class Wall : def height ( self ) : return 2.5
    assert sizes.tokens("a.py", PYTHON) == 6 + 3 + 6 + 2
    assert sizes.tokens("a.js", "let a=1; // two") == 5
    assert list(sizes.ofPython(PYTHON)) == [("class", "Wall", 3), ("function", "height", 2)]
    assert list(sizes.ofCpp(CPP)) == [
        ("class", "Joint", 10),
        ("function", "Joint", 7),
        ("function", "walk", 3),
    ]
