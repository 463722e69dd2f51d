# SPDX-License-Identifier: GPL-2.0-or-later
"""Brings the documents of the repository into a folder from which Sphinx makes the site. This
module needs no Sphinx.

Nothing is written twice: every Markdown file of the repository is a page, at its own path, and the
README at the top is the first page. Only links are changed: those that lead to a folder lead to its
README, those to a module of the package to the page of that module, and those to any other source
to a page that shows it.
"""

import ast
import os
import posixpath
import re
import shutil

from tree import ROOT, files, read

PACKAGES = "scripts/masonry"  # how the paths of all packages begin
FIRST = "README.md"  # the first page of the site
PICTURES = (".png", ".svg", ".jpg")
SOURCES = {
    ".py": "python",
    ".sh": "bash",
    ".cpp": "c++",
    ".hpp": "c++",
    ".csv": "text",
    ".json": "json",
    ".cff": "yaml",
}

_BLOCKS = re.compile(r"^```.*?^```[^\n]*$|^(?: {4}|\t)[^\n]*$", re.M | re.S)
_CODE = re.compile(r"^```.*?^```[^\n]*$|^(?: {4}|\t)[^\n]*$|(`+)(?!`).*?(?<!`)\1(?!`)", re.M | re.S)
_LINK = re.compile(r"(\]\()([^)\s]+)(\))")
_TO_MODULE = re.compile(r"\[([^\]]+)\]\(([^)\s]+\.py)\)")
_EQUATION = re.compile(r"^( *)```math$", re.M)
_HTML = re.compile(r'(<img src=")([^"]+)(")')


def page(path):
    """The path of a document of the repository among the sources of the site."""
    return "index.md" if path == FIRST else path


def moduleOf(path):
    """The dotted name of a module of the package, or None if a file is none."""
    if not (path.startswith(PACKAGES) and path.endswith(".py")):
        return None
    parts = path.removeprefix("scripts/").removesuffix(".py").split("/")
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def outsideCode(change, text, code=_CODE):
    """A text of Markdown with a change made to all that is no code.

    :param code: what is code; :data:`_BLOCKS` leaves code within a line to the change
    """
    done, found = 0, []
    for block in code.finditer(text):
        found += [change(text[done : block.start()]), block[0]]
        done = block.end()
    return "".join([*found, change(text[done:])])


def titleOfPart(path):
    """The title of a document that has none, since it is a part of the README beside it."""
    folder, name = posixpath.split(path)
    return re.search("^# .*", read(f"{folder}/README.md"), re.M)[0] + f": {name[:-3]}"


class Stage:
    """The folder with the sources of the site.

    :param folder: it is made anew
    """

    def __init__(self, folder):
        self.folder = folder
        self.shown = set()  # sources that a page shows
        shutil.rmtree(folder, ignore_errors=True)

    def write(self, path, text):
        """Write a page, a text, or another file, bytes, below the folder."""
        target = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with open(target, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())

    def copy(self, path):
        """Copy a file of the repository to its own path."""
        with open(os.path.join(ROOT, path), "rb") as file:
            self.write(path, file.read())

    def destination(self, path, target):
        """Where a link of a document leads on the site, relative to the document.

        :param path: of the document; ``target``: what its link says
        """
        name, _, anchor = target.partition("#")
        if not name or re.match(r"[a-z]+:", name):
            return target
        folder = posixpath.dirname(path)
        there = posixpath.normpath(posixpath.join(folder, name))
        whole = os.path.join(ROOT, there)
        if os.path.isdir(whole):
            if not os.path.isfile(os.path.join(whole, "README.md")):
                raise ValueError(f"{path}: {target} leads to a folder without a README")
            there = posixpath.normpath(posixpath.join(there, "README.md"))
        if moduleOf(there) or not os.path.exists(whole):  # Sphinx finds it, or says so
            return target
        stem, ending = os.path.splitext(there)
        found = page(there)
        if ending == ".ipynb":
            found = stem + ".md"
        elif ending in SOURCES:
            self.shown.add(there)
            found = there + ".md"
        elif ending != ".md":
            self.copy(there)
        return posixpath.relpath(found, folder or ".") + (anchor and "#" + anchor)

    def toModule(self, path, link):
        """A link to a module of the package as one to the place where the site documents it; any
        other link as it is."""
        there = posixpath.normpath(posixpath.join(posixpath.dirname(path), link[2]))
        name = moduleOf(there)
        return f"{{py:mod}}`{link[1].replace('`', '')} <{name}>`" if name else link[0]

    def document(self, path, text=None):
        """Bring a document in, with the pictures that it shows.

        :param text: what it says; None: what the file says
        """
        folder = posixpath.dirname(path)

        def change(text):
            for found in (*_LINK.finditer(text), *_HTML.finditer(text)):
                there = posixpath.normpath(posixpath.join(folder, found[2]))
                if there.endswith(PICTURES) and os.path.isfile(os.path.join(ROOT, there)):
                    self.copy(there)
            return _LINK.sub(lambda m: m[1] + self.destination(path, m[2]) + m[3], text)

        def toModules(text):
            return _TO_MODULE.sub(lambda m: self.toModule(path, m), text)

        text = outsideCode(change, read(path) if text is None else text)
        text = outsideCode(toModules, text, _BLOCKS)
        text = _EQUATION.sub(r"\1```{math}", text)  # GitHub has another word for it
        if not re.search("^# ", text, re.M):
            text = f"{titleOfPart(path)}\n\n{text}"
        self.write(page(path), text)

    def sources(self):
        """Make a page of each source to which a document leads, and of each scene of the
        gallery."""
        scenes = {sceneOf(name): name for name in gallery()}
        for path in sorted(self.shown | set(scenes)):
            file = posixpath.basename(path)
            language = SOURCES[os.path.splitext(path)[1]]
            # no table of contents has it
            head = f"---\norphan: true\n---\n\n# {path}\n\n"
            if path in scenes:
                name = scenes[path]
                self.copy(f"scripts/gallery/{name}.png")
                picture = posixpath.relpath(f"scripts/gallery/{name}.png", posixpath.dirname(path))
                head = (
                    f"# {name}\n\n{aboutScene(name)}\n\n![{name}]({picture})\n\n    yade"
                    f" -n -x {path}\n\n"
                )
            self.copy(path)
            self.write(
                path + ".md", f"{head}```{{literalinclude}} {file}\n:language: {language}\n```\n"
            )


def documents():
    """The paths of all Markdown files of the repository that are pages."""
    return [path for path in files((".md",)) if not path.startswith("scripts/docs/")]


def gallery():
    """The names of the scenes of the gallery, those that have a picture there."""
    return [
        posixpath.basename(path)[:-4]
        for path in files((".png",))
        if path.startswith("scripts/gallery/")
    ]


def sceneOf(name):
    """The path of a scene."""
    path = f"scripts/{name}.py"
    return path if os.path.exists(os.path.join(ROOT, path)) else f"scripts/gallery/{name}.py"


def aboutScene(name):
    """What the docstring of a scene says, in Markdown."""
    return ast.get_docstring(ast.parse(read(sceneOf(name)))).replace("``", "`")


def galleryPage():
    """The page of all scenes with their pictures, in Markdown."""
    cards = []
    for name in gallery():
        about, page = aboutScene(name), f"{sceneOf(name)}.md"
        picture = f"[![{name}](scripts/gallery/{name}.png)]({page})"
        first = about.partition("\n\n")[0]
        text = f"{picture}\n\n[{name}]({page})\n\n{first}"
        cards.append(f"::::{{container}} card\n{text}\n::::\n")
    head = (
        "# Gallery\n\nA picture leads to the scene that made it. Times are those of one"
        " core.\n\n:::::{container} gallery\n"
    )
    scenes = "\n".join(map(sceneOf, gallery()))
    return f"{head}{chr(10).join(cards)}:::::\n\n```{{toctree}}\n:hidden:\n\n{scenes}\n```\n"
