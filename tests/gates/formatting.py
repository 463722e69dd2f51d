# SPDX-License-Identifier: GPL-2.0-or-later
"""How the sources are formatted, and imports that nobody uses.

    /usr/bin/python3 tests/gates/formatting.py          prints what is wrong
    /usr/bin/python3 tests/gates/formatting.py --write  formats the tree and takes unused imports out

C++ is formatted by clang-format 14 after ``.clang-format``, Python by black 23 after ``pyproject.toml``. Other versions
break other lines, so the gate takes these alone, which are those of Debian 12. Unused imports are those that pyflakes
finds. An import that is there for what it does, or that gives a name on, says so with ``# noqa: F401`` and the reason.
The ``__init__.py`` of a package gives names on, and is left out.
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


def version(program):
    """The first number of a program's version, None if it is not installed."""
    if not shutil.which(program):
        return None
    said = subprocess.run([program, "--version"], capture_output=True, text=True)
    return re.search(r"(\d+)\.\d+", said.stdout).group(1)


def clangFormat():
    """The program clang-format 14, None if there is none."""
    for program in ("clang-format-14", "clang-format"):
        if version(program) == CLANG_FORMAT:
            return program


def _quiet(folder):
    return dict(cwd=folder, capture_output=True, text=True)


def unformattedCpp(paths, root=tree.ROOT):
    """Files and lines that clang-format would change, as ``path:line``."""
    if not paths:
        return []
    run = subprocess.run([clangFormat(), "--dry-run", *paths], **_quiet(root))
    found = re.findall(r"^(\S+?:\d+):\d+: (?:warning|error)", run.stderr, re.MULTILINE)
    return list(dict.fromkeys(found))


def unformattedPython(paths, root=tree.ROOT):
    """Files that black would change."""
    if not paths:
        return []
    config = os.path.join(tree.ROOT, "pyproject.toml")
    command = ["black", "--check", "--config", config, *paths]
    run = subprocess.run(command, **_quiet(root))
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
    imports = [
        n for n in ast.walk(parsed) if isinstance(n, (ast.Import, ast.ImportFrom))
    ]
    said = lambda node: "\n".join(lines[node.lineno - 1 : node.end_lineno])
    kept = {node.lineno for node in imports if re.search("# noqa:.*F401", said(node))}
    unused = [
        m
        for m in checker.Checker(parsed, path).messages
        if isinstance(m, messages.UnusedImport)
    ]
    return sorted((m.lineno, m.message_args[0]) for m in unused if m.lineno not in kept)


def withoutUnused(source, unused):
    """The source of a module without the imports that :func:`unusedImports` found in it."""
    lines = source.splitlines(keepends=True)
    names = {}
    for line, name in unused:
        names.setdefault(line, set()).add(name.split(" as ")[0])
    nodes = [n for n in ast.walk(ast.parse(source)) if getattr(n, "lineno", 0) in names]
    for node in sorted(nodes, key=lambda n: -n.lineno):
        if not isinstance(node, (ast.Import, ast.ImportFrom)):
            continue
        prefix = ""
        if isinstance(node, ast.ImportFrom):
            prefix = "." * node.level + (node.module or "")
            prefix += "." if node.module else ""
        unused = names[node.lineno]
        node.names = [a for a in node.names if prefix + a.name not in unused]
        new = [" " * node.col_offset + ast.unparse(node) + "\n"] if node.names else []
        lines[node.lineno - 1 : node.end_lineno] = new
    return "".join(lines)


def problems():
    """Everything that is wrong in the tree, a line for each."""
    found = [f"{line}: clang-format" for line in unformattedCpp(tree.files(tree.CPP))]
    found += [f"{path}: black" for path in unformattedPython(tree.files((".py",)))]
    for path in tree.files((".py",)):
        found += [f"{path}:{n}: {name} is not used" for n, name in unusedImports(path)]
    return found


def write():
    """Format the tree."""
    for path in tree.files((".py",)):
        unused = unusedImports(path)
        if unused:
            source = withoutUnused(tree.read(path), unused)
            with open(os.path.join(tree.ROOT, path), "w", encoding="utf-8") as file:
                file.write(source)
    python = tree.files((".py",))
    subprocess.run(["black", "--quiet", *python], cwd=tree.ROOT, check=True)
    cpp = tree.files(tree.CPP)
    subprocess.run([clangFormat(), "-i", *cpp], cwd=tree.ROOT, check=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        write()
    print("\n".join(problems()))
    sys.exit(bool(problems()))
