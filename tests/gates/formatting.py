# SPDX-License-Identifier: GPL-2.0-or-later
"""How the sources are formatted, and imports that nobody uses.

    /usr/bin/python3 tests/gates/formatting.py          prints what is wrong
    /usr/bin/python3 tests/gates/formatting.py --write  formats

C++ is formatted by clang-format 14 after ``.clang-format``, Python by black 23 after
``pyproject.toml``. Other versions break other lines, so the gate takes these alone, which are those
of Debian 12. Unused imports are those that pyflakes finds. An import that is there for what it
does, or that gives a name on, says so with ``# noqa: F401`` and the reason. The ``__init__.py`` of
a package gives names on, and is left out.
"""

import ast
import os
import re
import shutil
import subprocess
import sys

import tree

CLANG_FORMAT = "14"
BLACK = "23"
IMPORTS = ast.Import, ast.ImportFrom


def version(program):
    """The first number of a program's version, None if it is not installed."""
    if not shutil.which(program):
        return None
    said = subprocess.run([program, "--version"], capture_output=True, text=True)
    return re.search(r"(\d+)\.\d+", said.stdout).group(1)


def clangFormat():
    """The program clang-format 14, None if there is none."""
    programs = "clang-format-14", "clang-format"
    return next((p for p in programs if version(p) == CLANG_FORMAT), None)


def unformattedCpp(paths, root=tree.ROOT):
    """Files and lines that clang-format would change, as ``path:line``."""
    if not paths:
        return []
    command = [clangFormat(), "--dry-run", *paths]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True)
    found = re.findall(r"^(\S+?:\d+):\d+: (?:warning|error)", run.stderr, re.MULTILINE)
    return list(dict.fromkeys(found))


def unformattedPython(paths, root=tree.ROOT):
    if not paths:
        return []
    config = os.path.join(tree.ROOT, "pyproject.toml")
    command = ["black", "--check", "--config", config, *paths]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True)
    wrong = [x for x in run.stderr.splitlines() if x.startswith(("would ", "error"))]
    if run.returncode and not wrong:
        wrong = [run.stderr.strip()]
    return [re.sub(r"^would reformat (.*)", r"\1", line) for line in wrong]


def unusedImports(path, root=tree.ROOT):
    """``(line, name)`` of the imports in a file that nothing uses."""
    from pyflakes import checker, messages

    if os.path.basename(path) == "__init__.py":
        return []
    source = tree.read(path, root)
    lines = source.splitlines()
    parsed = ast.parse(source)
    said = lambda node: "\n".join(lines[node.lineno - 1 : node.end_lineno])
    imports = [node for node in ast.walk(parsed) if isinstance(node, IMPORTS)]
    kept = {node.lineno for node in imports if re.search("# noqa:.*F401", said(node))}
    found = checker.Checker(parsed, path).messages
    unused = [m for m in found if isinstance(m, messages.UnusedImport)]
    return sorted((m.lineno, m.message_args[0]) for m in unused if m.lineno not in kept)


def problems():
    """Everything that is wrong in the tree, a line for each."""
    found = [f"{line}: clang-format" for line in unformattedCpp(tree.files(tree.CPP))]
    found += [f"{path}: black" for path in unformattedPython(tree.files((".py",)))]
    for path in tree.files((".py",)):
        found += [f"{path}:{n}: {name} is not used" for n, name in unusedImports(path)]
    return found


def write():
    python = tree.files((".py",))
    subprocess.run(["black", "--quiet", *python], cwd=tree.ROOT, check=True)
    cpp = tree.files(tree.CPP)
    subprocess.run([clangFormat(), "-i", *cpp], cwd=tree.ROOT, check=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        write()
    print("\n".join(problems()))
    sys.exit(bool(problems()))
