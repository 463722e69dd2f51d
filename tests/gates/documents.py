# SPDX-License-Identifier: GPL-2.0-or-later
"""What documents promise: links lead somewhere, commands name files and modules that exist, and so
do paths.

    /usr/bin/python3 tests/gates/documents.py    prints what leads nowhere
"""

import glob
import json
import os
import re
import sys

import tree

#: Files that a reader writes himself, or that a run makes.
OF_THE_READER = {"my_scene.py", "my_wall.py", "scene.py", "script.py"}
MADE = ("results/", "build/", "out/")
MODULES = "scripts"
FOLDERS = ("", "yade_plugin", "scripts", "scripts/masonry", "tests", "validation")

_LINK = re.compile(r"\]\(([^)\s]+)\)")
_COMMANDS = (
    (re.compile(r"\bbash ((?:[\w.-]+/)*[\w.-]+\.sh)"), "script"),
    (re.compile(r"\byade (?:-\S+ )*?-n -x ([\w./-]+\.py)"), "scene"),
    (re.compile(r"\byade ([\w./-]+\.py)"), "scene"),
    (re.compile(r"\bpython3 (?:-[A-Z] )?-m (masonry\w*(?:\.\w+)*)"), "module"),
    (re.compile(r"\bpython3 (?:-[A-Z] )?((?:[\w.-]+/)+[\w.-]+\.py)"), "script"),
)
_PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")
LARGEST_PICTURE = 200_000  # bytes
_MODULE = re.compile(r"`(masonry\w*(?:\.[a-z_]+)+)`")
_PATH = re.compile(r"`((?:[\w.-]+/)+[\w.-]*)`")


def anchors(source):
    found = set()
    for heading in re.findall(r"^#+ +(.*?) *#*$", withoutBlocks(source), re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number = 1
        while slug + (f"-{number}" if slug in found else "") in found:
            number += 1
        found.add(slug if slug not in found else f"{slug}-{number}")
    return found


def withoutBlocks(source):
    """The document without its fenced blocks of code; the lines keep their numbers."""
    lines = lambda block: "\n" * block[0].count("\n")
    return re.sub(r"^```.*?^```", lines, source, flags=re.MULTILINE | re.DOTALL)


def _exists(name, folder, root):
    """Whether a path exists from the document's folder or from a folder of the code, if need be
    with an ending."""
    for base in (folder, *FOLDERS):
        path = os.path.normpath(os.path.join(root, base, name))
        if os.path.exists(path) or glob.glob(glob.escape(path) + ".*"):
            return True
    return False


def _isModule(name, root):
    path = os.path.join(root, MODULES, *name.split("."))
    if os.path.isfile(path + ".py") or os.path.isdir(path):
        return True
    package, member = os.path.split(path)  # a name in a module, `masonry.window.show`
    modules = package + ".py", os.path.join(package, "__init__.py")
    texts = [tree.read(one, root) for one in modules if os.path.isfile(one)]
    return any(re.search(rf"\b{member}\b", text) for text in texts)


def sourceOf(path, root):
    """The text of a document; of a notebook that of its cells of text, one below the other."""
    source = tree.read(path, root)
    if not path.endswith(".ipynb"):
        return source
    cells = json.loads(source)["cells"]
    texts = ["".join(c["source"]) for c in cells if c["cell_type"] == "markdown"]
    return "\n\n".join(texts)


def problems(path, root=tree.ROOT):
    """What leads nowhere in a document, as text."""
    source = sourceOf(path, root)
    plain = withoutBlocks(source)
    folder = os.path.dirname(path)
    found = []

    def at(text, match, problem):
        line = text.count("\n", 0, match.start()) + 1
        found.append(f"{path}:{line}: {problem}")

    for match in _LINK.finditer(plain):
        target, _, anchor = match[1].partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        file = os.path.normpath(os.path.join(root, folder, target)) if target else None
        if file and not os.path.exists(file):
            at(plain, match, f"{match[1]} leads to no file")
        elif anchor and (file or path).endswith(".md"):
            there = tree.read(os.path.relpath(file, root), root) if file else source
            if anchor not in anchors(there):
                at(plain, match, f"{match[1]} leads to no heading")
    for pattern, kind in _COMMANDS:
        for match in pattern.finditer(source):
            name = match[1]
            if kind == "module":
                if not _isModule(name, root):
                    at(source, match, f"no module {name}")
            elif os.path.basename(name) not in OF_THE_READER:
                if not _exists(name, folder, root):
                    at(source, match, f"no {kind} {name}")
    for match in _MODULE.finditer(plain):
        if not _isModule(match[1], root):
            at(plain, match, f"no module {match[1]}")
    for match in _PATH.finditer(plain):
        name = match[1]
        places = [os.path.join(root, base) for base in (folder, *FOLDERS)]
        first = name.split("/")[0]
        ours = any(os.path.isdir(os.path.join(place, first)) for place in places)
        if ours and not name.startswith(MADE) and not _exists(name, folder, root):
            at(plain, match, f"no file {name}")
    return found


def pictures(path, root=tree.ROOT):
    """The paths of the pictures that a document shows."""
    names = _PICTURE.findall(withoutBlocks(tree.read(path, root)))
    return [os.path.normpath(os.path.join(os.path.dirname(path), name)) for name in names]


def largePictures(path, root=tree.ROOT):
    """What a document shows that is missing or too large, as text."""
    found = []
    for picture in pictures(path, root):
        file = os.path.join(root, picture)
        size = os.path.getsize(file) if os.path.isfile(file) else None
        if size is None or size >= LARGEST_PICTURE:
            found.append(f"{path}: {picture} is {'missing' if size is None else 'too large'}")
    return found


def all():
    return [line for path in tree.files((".md", ".ipynb")) for line in problems(path)]


if __name__ == "__main__":
    print("\n".join(all()))
    sys.exit(bool(all()))
