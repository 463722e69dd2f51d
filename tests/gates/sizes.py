# SPDX-License-Identifier: GPL-2.0-or-later
"""Weight of the repository: lines, tokens, and the largest module, class and function, against
``budget.json``.

    /usr/bin/python3 tests/gates/sizes.py           all sizes, beside their budgets
    /usr/bin/python3 tests/gates/sizes.py --write   lowers the budgets to the sizes of today

Tokens keep a text from getting shorter by longer lines. In Python they are those of the tokenizer
without comments, line ends and indentation; a docstring counts by its words, since as a string it
would be one. Elsewhere each word and each symbol outside comments is one. A module is a file. A
class in C++ counts without the functions that stand outside it.
"""

import ast
import io
import json
import os
import re
import sys
import tokenize

import tree

BUDGET = os.path.join(os.path.dirname(os.path.abspath(__file__)), "budget.json")
#: What is weighed: names of parts, and how the paths of their files begin and end.
PARTS = {
    "package": (("scripts/",), (".py", ".js", ".css", ".html", ".sh")),
    "plugin": (("yade_plugin/",), tree.CPP + (".py",)),
    "tests": (("tests/",), tree.CPP + (".py",)),
    "manual": ((), (".md",)),
}
NOT_MANUAL = "validation/"
NO_TOKEN = "COMMENT NL NEWLINE INDENT DEDENT ENCODING ENDMARKER".split()
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_WORDS = re.compile(r"\w+|[^\w\s]")
_TEMPLATE = re.compile(r"^\s*template\s*<[^{;]*?>\s+(?=\w)")
_CLASS = re.compile(r"\s*(class|struct|union)\s+(\w+)")
_NO_FUNCTION = re.compile(r"\s*(namespace|enum|extern|if|for|while|switch|else|do|try|catch|\{)")
_NAME = re.compile(r"TEST_CASE.*?\"[^\"]*\"|[^\s(]+(?= *\()|\w+ = \[")


def filesOf(part):
    begins, endings = PARTS[part]
    paths = [path for path in tree.files(endings) if path.startswith(begins or "")]
    return [path for path in paths if begins or not path.startswith(NOT_MANUAL)]


def tokens(path, text):
    if not path.endswith(".py"):
        isProse = path.endswith((".md", ".sh"))
        return len(_WORDS.findall(text if isProse else _COMMENT.sub("", text)))
    count = 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if tokenize.tok_name[token.type] not in NO_TOKEN:
            isDocstring = token.string.endswith('"""')
            count += len(token.string.split()) if isDocstring else 1
    return count


def ofPython(text):
    """Classes and functions of a source: triples of a kind, a name and a number of lines."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            kind = "class" if isinstance(node, ast.ClassDef) else "function"
            yield kind, node.name, node.end_lineno - node.lineno + 1


def ofCpp(text):
    """The same of a source that clang-format has formatted: a block ends where a brace stands below
    its beginning."""
    lines = text.splitlines()
    first = 0  # line in which the present declaration begins
    for number, line in enumerate(lines):
        isEnd = not line.strip() or line.lstrip().startswith(("//", "#", "}"))
        if line.endswith("{") and not isEnd:
            declaration = _TEMPLATE.sub("", " ".join(lines[first : number + 1]))
            margin = re.match(r"\s*", lines[first]).group()
            rest = lines[number + 1 :]
            end = next((i for i, l in enumerate(rest) if l.startswith(margin + "}")), 0)
            size = number + 1 + end - first + 1
            if found := _CLASS.match(declaration):
                yield "class", found.group(2), size
            elif not _NO_FUNCTION.match(declaration) and "(" in declaration:
                yield "function", _NAME.search(declaration)[0], size
        if isEnd or line.endswith(("{", ";", "}", ":")):
            first = number + 1


def weigh(part):
    """Sizes of a part, and where the largest of each kind stands."""
    sizes, places = {"lines": 0, "tokens": 0}, {}
    for path in filesOf(part):
        text = tree.read(path)
        count = len(text.splitlines())
        sizes["lines"] += count
        sizes["tokens"] += tokens(path, text)
        if part == "manual":
            continue
        found = [("module", path, count)]
        if path.endswith((".py", *tree.CPP)):
            inside = ofPython(text) if path.endswith(".py") else ofCpp(text)
            found += [(kind, f"{name} of {path}", n) for kind, name, n in inside]
        for kind, place, size in found:
            if size > sizes.get(kind, 0):
                sizes[kind], places[kind] = size, place
    return sizes, places


def budget():
    with open(BUDGET, encoding="utf-8") as file:
        return json.load(file)


SPLIT = "split it by what its parts are for."
REDUCE = (
    "Take out as much elsewhere: what is written twice, defends against what nobody meets, or no longer"
    " has a user. If what came is worth it, raise the number in tests/gates/budget.json, and give the"
    " reason in the commit."
)


def over(part, sizes, places, allowed):
    """A sentence for each size above its budget."""
    for kind, size in sizes.items():
        if size <= allowed[kind]:
            continue
        if kind in places:
            yield (
                f"{places[kind]} has {size} lines, and no {kind} of the {part} may have more than"
                f" {allowed[kind]}: {SPLIT}"
            )
        else:
            yield f"{part}: {size} {kind} are {size - allowed[kind]} more than its budget. {REDUCE}"


def main(arguments):
    weighed = {part: weigh(part) for part in PARTS}
    allowed = budget()
    for part, (sizes, places) in weighed.items():
        for kind, size in sizes.items():
            print(f"{part:8} {kind:9}{size:8,} of {allowed[part][kind]:8,}  {places.get(kind, '')}")
    if "--write" in arguments:
        lower = {
            part: {kind: min(size, allowed[part][kind]) for kind, size in sizes.items()}
            for part, (sizes, _) in weighed.items()
        }
        with open(BUDGET, "w", encoding="utf-8") as file:
            json.dump(lower, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main(sys.argv[1:])
