# SPDX-License-Identifier: GPL-2.0-or-later
"""Makes the site and its PDF; ``scripts/docs.sh`` calls this.

    /usr/bin/python3 scripts/docs/build.py [--out build/docs] [--no-pdf]

Needs Debian's python3-sphinx, python3-myst-parser, furo and libjs-mathjax, for the PDF chromium,
and the plugin, which is imported. Nothing is fetched from a network.
"""

import argparse
import glob
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
# the gates list the files of the repository
sys.path[:0] = [HERE, os.path.join(ROOT, "tests", "gates")]
YADE = "/usr/lib/x86_64-linux-gnu/yade-double/py"
JAVASCRIPT = "/usr/share/javascript"  # of Debian
MATHJAX = os.path.join(JAVASCRIPT, "mathjax")
#: What equations as SVG need of MathJax, which has thirty times as much.
PARTS = [
    "MathJax.js",
    "config/TeX-AMS_SVG-full.js",
    "extensions",
    "jax/element",
    "jax/input/TeX",
    "jax/output/SVG/config.js",
    "jax/output/SVG/jax.js",
    "jax/output/SVG/autoload",
    "jax/output/SVG/fonts/TeX",
    "localization/en",
]

#: The pages of the site by their sections. What stands in a folder of ``validation`` comes below
#: its README.
FIRST = "First steps"  # the notebooks of the tutorial come before its other pages
SECTIONS = {
    FIRST: ["scripts/TASKS", "scripts/WALL", "scripts/EXAMPLES", "gallery"],
    "Manual": (
        "scripts/README commands options scripts/WORDS scripts/FILES scripts/CHECKPOINTS"
        " scripts/SHARING scripts/RUNNING scripts/STUDIES yade_plugin/FOR_YADE_USERS"
    ).split(),
    "Packages": (
        "scripts/masonry/README scripts/masonry_view/README scripts/masonry_limit/README"
        " scripts/masonry_capacity/README scripts/masonry_study/README"
    ).split(),
    "Laws": (
        "yade_plugin/law/README yade_plugin/law/cyclic_softening/README"
        " yade_plugin/contact/README"
    ).split(),
    "Validation": ["validation/README"],
    "Reference": ["api/masonry", "classes"],
    "Project": (
        "yade_plugin/README yade_plugin/host/README scripts/OTHER_PROGRAMS CONTRIBUTING CHANGELOG"
        " cite"
    ).split(),
}
#: Pages that :func:`stage` makes; all others are Markdown files of the repository.
GENERATED = {"gallery", "commands", "options", "api/masonry", "classes", "cite"}


def toctree(pages, caption=""):
    """A table of contents, in Markdown, which the page itself does not show."""
    head = f":caption: {caption}\n" if caption else ""
    return f"\n```{{toctree}}\n:hidden:\n{head}\n" + "\n".join(pages) + "\n```\n"


def tutorial(made, out, runs):
    """Bring the notebooks of the tutorial in. Returns their pages.

    :param runs: whether they are run, and shown with what comes out
    """
    import masonry
    import notebooks

    pages = []
    for path in sorted(glob.glob(os.path.join(HERE, "tutorial", "*.ipynb"))):
        name = os.path.splitext(os.path.basename(path))[0]
        found = notebooks.load(path)
        if runs:
            version = f"{masonry.__version__} {masonry.commit}"
            found = notebooks.run(path, os.path.join(out, "notebooks"), version)
        target = os.path.relpath(os.path.dirname(path), ROOT)

        def write(file, data):
            made.write(f"{target}/{file}", data)

        text = notebooks.markdown(found, name, write)
        made.document(f"{target}/{name}.md", text)
        pages.append(f"{target}/{name}")
    return pages


def contents(documents, first=()):
    """The tables of contents of the documents that have one: dict from a document to Markdown.

    :param documents: those of the repository. Each must be in some table
    :param first: pages that come first of all
    """
    named = {page for pages in SECTIONS.values() for page in pages}
    rest = [d.removesuffix(".md") for d in documents if d != "README.md"]
    cases = [d for d in rest if d.startswith("validation/") and d not in named]
    others = sorted({*rest} - {*cases} - named)
    if others:
        raise ValueError(f"no section of build.py has {', '.join(others)}")
    gone = sorted(p for p in named - GENERATED if p + ".md" not in documents)
    if gone:
        raise ValueError(f"build.py names {', '.join(gone)}, which the repository does not have")
    sections = {t: [*first, *p] if t == FIRST else p for t, p in SECTIONS.items()}
    return {
        "README.md": "".join(toctree(p, title) for title, p in sections.items()),
        "validation/README.md": toctree([c.removeprefix("validation/") for c in cases]),
    }


def stage(folder, out, runs):
    """Write all pages of the site to a folder; other parameters as of :func:`tutorial`."""
    import generated
    import staging
    from tree import read

    made = staging.Stage(folder)
    documents = staging.documents()
    for path in documents:
        made.document(path)
    lessons = tutorial(made, out, runs)
    for path, table in contents(documents, lessons).items():
        made.document(path, read(path) + table)
    made.sources()
    made.write("gallery.md", staging.galleryPage())
    made.write("commands.rst", generated.commands())
    made.write("options.rst", generated.optionsOfScenes())
    made.write("classes.rst", generated.classes())
    made.write("cite.md", generated.cite())
    for path, text in generated.api():
        made.write(path, text)


def mathjax(folder):
    """Copy what the pages need of Debian's MathJax."""
    for part in PARTS:
        source, target = os.path.join(MATHJAX, part), os.path.join(folder, "mathjax", part)
        if os.path.isdir(source):
            shutil.copytree(source, target, dirs_exist_ok=True)
        else:
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copyfile(source, target)


def sphinx(out, builder, target, *more):
    """Run Sphinx on the staged pages; warnings are errors."""
    from sphinx.cmd.build import main

    words = [
        "-b",
        builder,
        "-c",
        HERE,
        "-d",
        os.path.join(out, "doctrees-" + builder),
        "-W",
        "--keep-going",
        "-q",
        *more,
    ]
    if main([*words, os.path.join(out, "source"), target]):
        raise SystemExit(f"Sphinx failed ({builder}): see above")


def bundle(static):
    """Make one script and one style sheet of those of the theme, which Debian leaves in parts that
    a web server would put together: browsers load neither modules nor ``/javascript`` from files.
    """
    scripts = os.path.join(static, "scripts")
    for path, first, folder in (
        (
            os.path.join(static, "styles", "furo.css"),
            r"@import url\(/javascript/([\w./-]+)\);",
            JAVASCRIPT,
        ),
        (os.path.join(scripts, "furo.js"), r'import Gumshoe from "\./([\w-]+\.js)";\n', scripts),
    ):
        text = pathlib.Path(path).read_text(encoding="utf-8")
        if part := re.match(first, text):
            begin = pathlib.Path(folder, part[1]).read_text(encoding="utf-8")
            pathlib.Path(path).write_text(begin + text[part.end() :], encoding="utf-8")


def unlinked(page):
    """Take the links off a page for print that lead to files beside it, or to pages that it leaves
    out."""
    file = pathlib.Path(page)
    text = file.read_text(encoding="utf-8")
    known = set(re.findall(r'\bid="([^"]+)"', text))

    def kept(link):
        leads = re.match("[a-z]+:", link[1]) or link[1].rpartition("#")[2] in known
        return link[0] if leads else link[2]

    link = r'<a [^>]*?href="([^"]*)"[^>]*>(.*?)</a>'
    file.write_text(re.sub(link, kept, text, flags=re.S), encoding="utf-8")


def pdf(page, target):
    """Print a page to a PDF with chromium, without a display and without a network."""
    words = """
        chromium --headless=new --no-sandbox --disable-gpu --disable-background-networking
        --virtual-time-budget=300000 --generate-pdf-document-outline --no-pdf-header-footer
    """.split()
    words += ["--host-resolver-rules=MAP * ~NOTFOUND", f"--print-to-pdf={target}"]
    words.append("file://" + os.path.abspath(page))
    subprocess.run(words, check=True, capture_output=True, timeout=600)


def main(words=None):
    parser = argparse.ArgumentParser(description="Make the site of the documentation and its PDF.")
    parser.add_argument(
        "--out", metavar="DIR", default=os.path.join(ROOT, "build", "docs"), help="where it goes"
    )
    parser.add_argument("--no-pdf", action="store_true", help="the site alone")
    parser.add_argument(
        "--no-run", action="store_true", help="show the notebooks without what comes out of them"
    )
    args = parser.parse_args(words)
    out = os.path.abspath(args.out)
    began = time.monotonic()
    said = lambda path: print(f"{path}: {time.monotonic() - began:.0f} s")
    if os.path.isdir(YADE):
        sys.path.insert(1, YADE)
    import yade.config  # noqa: F401, before masonry, so that it registers its classes

    stage(os.path.join(out, "source"), out, not args.no_run)
    static = os.path.join(out, "static")
    mathjax(static)
    os.environ["MASONRY_DOCS_STATIC"] = static
    sphinx(out, "html", os.path.join(out, "html"))
    bundle(os.path.join(out, "html", "_static"))
    said(os.path.join(out, "html", "index.html"))
    if not args.no_pdf:
        sphinx(out, "singlehtml", os.path.join(out, "paper"), "-t", "paper")
        page = os.path.join(out, "paper", "index.html")
        unlinked(page)
        pdf(page, os.path.join(out, "masonry.pdf"))
        said(os.path.join(out, "masonry.pdf"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
