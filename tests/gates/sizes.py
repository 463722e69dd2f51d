# SPDX-License-Identifier: GPL-2.0-or-later
"""Weight of the repository, part by part, against ``budget.json``.

    /usr/bin/python3 tests/gates/sizes.py           all sizes, beside their budgets
    /usr/bin/python3 tests/gates/sizes.py --write   lowers budgets to the sizes of today

tokens
    In Python those of the tokenizer without line ends and indentation, elsewhere words and symbols.
    A comment counts by its words, and so does a text in triple quotes.
modules
    Files.
arrows
    Pairs of modules of a Python package of which one imports the other, by a statement anywhere in
    it, from room to room. A room is a folder of the package with all below it; the modules beside
    these folders are one more.
inside
    The same within the room with the most.
module, class, function
    Lines of the largest. A class in C++ counts without the functions that stand outside it.
skipped, long
    Of all Python: statements that black leaves as they are, and lines over 100 characters outside
    these statements.

A budget is raised by hand, in a commit that changes nothing else and says what for.
"""

import ast
import collections
import io
import json
import os
import re
import subprocess
import sys
import tokenize

import tree

BUDGET = "tests/gates/budget.json"
SLACK = 1.03  # largest tokens, over their budget
LONGEST_LINE = 100
MAX_COMMITS = 200  # whose budgets are compared
PACKAGES = {
    "core": "masonry",
    "view": "masonry_view",
    "limit": "masonry_limit",
    "capacity": "masonry_capacity",
    "study": "masonry_study",
}
_SCRIPTS = r".*\.(py|js|css|html|sh)"
#: Parts, and what the paths of their files match; a file is of the first part that it matches.
PARTS = {
    **{part: f"scripts/{folder}/{_SCRIPTS}" for part, folder in PACKAGES.items()},
    "scenes": "scripts/" + _SCRIPTS,
    "plugin": r"yade_plugin/.*\.(cpp|hpp|inl|py)",
    "tests": r"tests/.*\.(cpp|hpp|inl|py)",
    "validation": r"validation/.*\.(py|sh)",
    "manual": r"(?!validation/).*\.md",
}
NO_TOKEN = "NL NEWLINE INDENT DEDENT ENCODING ENDMARKER".split()
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_WORDS = re.compile(r"\w+|[^\w\s]")
_SKIP = "# fmt: skip"
_TEMPLATE = re.compile(r"^\s*template\s*<[^{;]*?>\s+(?=\w)")
_CLASS = re.compile(r"\s*(class|struct|union)\s+(\w+)")
_NO_FUNCTION = re.compile(r"\s*(namespace|enum|extern|if|for|while|switch|else|do|try|catch|\{)")
_NAME = re.compile(r"TEST_CASE.*?\"[^\"]*\"|[^\s(]+(?= *\()|\w+ = \[")


def words(comment):
    return len(comment.strip("#:/*! ").split())


def tokens(path, text):
    if path.endswith((".md", ".sh", ".html")):
        return len(_WORDS.findall(text))
    if not path.endswith(".py"):
        comments = sum(words(comment) for comment in _COMMENT.findall(text))
        return comments + len(_WORDS.findall(_COMMENT.sub(" ", text)))
    count = 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if tokenize.tok_name[token.type] not in NO_TOKEN:
            isProse = token.type == tokenize.COMMENT or token.string.endswith(('"""', "'''"))
            count += words(token.string) if isProse else 1
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


def arrows(texts):
    """Pairs of paths of a package, of which the first imports the second; texts by their paths."""
    modules = {re.sub(r"^scripts/|(/__init__)?\.py$", "", path): path for path in texts}
    modules = {name.replace("/", "."): path for name, path in modules.items()}
    pairs = set()
    for path in modules.values():
        folder = path.split("/")[1:-1]
        for node in ast.walk(ast.parse(texts[path])):
            if isinstance(node, ast.Import):
                imported = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                above = folder[: len(folder) + 1 - node.level] if node.level else []
                source = ".".join(above + [node.module] * bool(node.module))
                names = [f"{source}.{alias.name}" for alias in node.names]
                imported = [name if name in modules else source for name in names]
            else:
                continue
            pairs |= {(path, modules[name]) for name in imported if name in modules}
    return {(one, other) for one, other in pairs if one != other}


def room(path):
    return "/".join(path.split("/")[1:-1][:2])


def longLines(text):
    """Number of lines that are too long, outside statements that black leaves as they are."""
    lines = text.split("\n")
    found = {n for n, line in enumerate(lines, 1) if len(line) > LONGEST_LINE}
    for node in ast.walk(ast.parse(text)) if found and _SKIP in text else ():
        if isinstance(node, ast.stmt) and not hasattr(node, "body"):
            if lines[node.end_lineno - 1].endswith(_SKIP):
                found -= set(range(node.lineno, node.end_lineno + 1))
    return len(found)


def weighPart(part, texts):
    """Sizes of a part, and where the largest of each kind stands; texts by their paths."""
    sizes, places = {"tokens": sum(tokens(*item) for item in texts.items())}, {}
    if part == "manual":
        return sizes, places
    sizes["modules"] = len(texts)
    found = []
    if part in PACKAGES:
        pairs = arrows({path: text for path, text in texts.items() if path.endswith(".py")})
        inside = collections.Counter(room(a) for a, b in pairs if room(a) == room(b))
        sizes["arrows"] = len(pairs) - inside.total()
        found = [("inside", *item) for item in inside.items()]
    for path, text in texts.items():
        found.append(("module", path, len(text.splitlines())))
        if path.endswith((".py", *tree.CPP)):
            blocks = ofPython(text) if path.endswith(".py") else ofCpp(text)
            found += [(kind, f"{name} of {path}", n) for kind, name, n in blocks]
    for kind, place, size in found:
        if size > sizes.get(kind, 0):
            sizes[kind], places[kind] = size, place
    return sizes, places


def weigh():
    """Sizes and places of all parts that have files, and of all Python."""
    parts, python = {}, {"skipped": 0, "long": 0}
    for path in tree.files(""):
        part = next((name for name, paths in PARTS.items() if re.fullmatch(paths, path)), None)
        if part:
            parts.setdefault(part, {})[path] = text = tree.read(path)
            if path.endswith(".py"):
                python["skipped"] += sum(line.endswith(_SKIP) for line in text.split("\n"))
                python["long"] += longLines(text)
    weighed = {part: weighPart(part, parts[part]) for part in PARTS if part in parts}
    return {**weighed, "python": (python, {})}


def budgets():
    return json.loads(tree.read(BUDGET))


REDUCE = (
    "Take out as much elsewhere: what is written twice, defends against what nobody meets, or no"
    f" longer has a user. If what came is worth it, raise the number in {BUDGET}, in a commit of"
    " its own that says what for."
)


def over(part, sizes, places, allowed):
    """A sentence for each size above its budget."""
    for kind, size in sizes.items():
        if kind not in allowed:
            yield f"{part} has no budget of its {kind}: sizes.py --write notes it"
        elif size <= allowed[kind] * (SLACK if kind == "tokens" else 1):
            continue
        elif kind in ("module", "class", "function"):
            yield (
                f"{places[kind]} has {size} lines, and no {kind} of the {part} may have more than"
                f" {allowed[kind]}: split it by what its parts are for."
            )
        else:
            yield f"{part}: {size} {kind} are {size - allowed[kind]} more than its budget. {REDUCE}"


def raisedBeside(root=tree.ROOT):
    """Commits that raise a budget and change other files too; None outside a clone."""
    git = lambda *words: subprocess.run(["git", "-C", root, *words], capture_output=True, text=True)
    shown = "--no-merges", "--full-diff", "--name-only", "--format=%x00%h %s"
    log = git("log", f"-{MAX_COMMITS}", *shown, "--", BUDGET)
    if log.returncode:
        return None
    found = []
    for entry in log.stdout.split("\0")[1:]:
        title, *names = [line for line in entry.split("\n") if line]
        commit = title.split()[0]
        both = [git("show", f"{name}:./{BUDGET}").stdout for name in (commit + "~", commit)]
        if names == [BUDGET] or not all(both):  # where a shallow clone begins, there is no parent
            continue
        before, after = map(json.loads, both)
        sizes = [(part, *item) for part, of in after.items() for item in of.items()]
        isRaised = any(size > before.get(part, {}).get(kind, size) for part, kind, size in sizes)
        if isRaised and "core" in before:  # older budgets counted lines
            found.append(title)
    return found


def main(arguments):
    allowed, lower = budgets(), {}
    for part, (sizes, places) in weigh().items():
        for kind, size in sizes.items():
            budget = allowed.get(part, {}).get(kind, size)
            lower.setdefault(part, {})[kind] = min(size, budget)
            print(f"{part:10} {kind:9}{size:8,} of {budget:8,}  {places.get(kind, '')}")
    if "--write" in arguments:
        with open(os.path.join(tree.ROOT, BUDGET), "w", encoding="utf-8") as file:
            json.dump(lower, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main(sys.argv[1:])
