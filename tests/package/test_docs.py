# SPDX-License-Identifier: GPL-2.0-or-later
"""The site of the documentation: it is made without a warning, needs no network, and has what it
promises."""

from usual import *
import glob
import importlib.util
import pathlib
import urllib.parse

DOCS = os.path.join(ROOT, "scripts", "docs")
sys.path[:0] = [DOCS, os.path.join(ROOT, "tests", "gates")]

import browser
import validators
import notebooks
import staging
import tree
from masonry import arguments
from pages import Page
from yade import wrapper

NEEDS = dict(sphinx="python3-sphinx", furo="furo", yaml="python3-yaml")
NEEDS["myst_parser"] = "python3-myst-parser"
MISSING = [p for m, p in NEEDS.items() if importlib.util.find_spec(m) is None]
if not os.path.isdir("/usr/share/javascript/mathjax"):
    MISSING.append("libjs-mathjax")
needsSite = mark.skipif(MISSING != [], reason=f"not installed: {MISSING}")
needsBrowser = mark.skipif(bool(browser.MISSING), reason=browser.MISSING)


class SitePage(Page):
    def __init__(self, path):
        super().__init__(pathlib.Path(path).read_text(encoding="utf-8"))
        known = [attributes for _, attributes, _ in self.elements]
        links = [attributes for tag, attributes, _ in self.elements if tag == "a"]
        self.links = [attributes["href"] for attributes in links if "href" in attributes]
        self.anchors = {a.get(name) for a in known for name in ("id", "name")}
        self.text = "".join(self.data)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, made with warnings as errors; notebooks are shown as they are stored.

    MASONRY_SITE names one that ``scripts/docs.sh`` has made, which is then not made again.
    """
    if "MASONRY_SITE" in os.environ:
        return pathlib.Path(os.environ["MASONRY_SITE"])
    out = tmp_path_factory.mktemp("docs")
    program = ["/usr/bin/python3", os.path.join(DOCS, "build.py")]
    command = [*program, "--out", str(out), "--no-run", *["--no-pdf"] * bool(browser.MISSING)]
    run = ran(command, timeout=900)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "WARNING" not in run.stdout + run.stderr
    return out / "html"


@pytest.fixture(scope="module")
def pages(site):
    found = glob.glob(str(site / "**" / "*.html"), recursive=True)
    return {os.path.relpath(path, site): SitePage(path) for path in found}


@needsSite
def test_every_document_is_a_page(site, pages):
    for path in staging.documents():
        page = staging.page(path).removesuffix(".md") + ".html"
        heading = re.search("^# (.+)$", tree.read(path), re.M)
        assert page in pages, path
        if heading and not re.search(r"[`*\[]", heading[1]):
            assert heading[1] in pages[page].text, path
    for path in glob.glob(os.path.join(DOCS, "tutorial", "*.ipynb")):
        assert os.path.relpath(path, ROOT).removesuffix(".ipynb") + ".html" in pages
    assert {"gallery.html", "commands.html", "options.html", "classes.html", "cite.html"} < set(
        pages
    )


@needsSite
def test_a_page_loads_nothing_from_a_network(site, pages):
    count = 0
    for name, page in pages.items():
        for target in page.loads():
            count += 1
            assert not re.match(r"(?:[a-z]+:)?//", target), (name, target)
            path = urllib.parse.unquote(target.partition("?")[0].partition("#")[0])
            if not path.startswith("data:"):
                assert (site / name).parent.joinpath(path).exists(), (name, target)
    assert count > 500
    for path in glob.glob(str(site / "_static" / "**" / "*.css"), recursive=True):
        with open(path, encoding="utf-8") as file:
            assert not re.search(r"url\(['\"]?(?:https?:)?/|@import", file.read()), path


@needsSite
def test_every_link_within_the_site_leads_somewhere(site, pages):
    lost, count = [], 0
    for name, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            there = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            count += 1
            if there in pages:
                if anchor and anchor not in pages[there].anchors:
                    lost.append((name, link))
            elif not (site / there).exists():
                lost.append((name, link))
    assert count > 3000 and lost == []


@needsSite
def test_the_page_of_commands_has_every_command_with_unit_and_bounds(pages):
    from masonry.stages import LATER, STAGES

    page = pages["commands.html"]
    for stage in (*STAGES, *LATER):
        assert f"masonry.Scene.{stage.__name__}" in page.anchors
    described = (
        "platen hold watch handle press load wind tie spring overlay ground drift column joint"
        " section view"
    )
    own = "bracket bound domain result stepBack resume curve factor finish"
    for word in f"{described} {own}".split():
        assert f"masonry.Scene.{word}" in page.anchors
    text = " ".join(page.text.split())
    assert "stress (a number at least 0 and at most 1e+12 Pa)" in text
    tilt = text.index("degrees (float) – a number above 0 and below 90 degrees")
    # in the order of the arguments
    assert tilt < text.index("horizontal direction in which the structure leans")
    headings = re.findall(r"(.+)[#¶]\n", page.text)
    assert "Loads after the first stage" in headings
    assert all(len(heading) < 90 or "(" in heading for heading in headings)


@needsSite
def test_no_page_shows_functions_where_types_and_values_stand(pages):
    found = [name for name, page in pages.items() if re.search("<function|<locals>", page.text)]
    assert found == []
    assert "Annotated" not in pages["commands.html"].text


@needsSite
@needsBrowser
@mark.parametrize(
    "words", ["infill", "buckling", "arch bridge", "earthquake", "retaining wall", "fragility"]
)
def test_the_search_finds_the_table_of_tasks_among_the_first(site, chromium, words):
    chromium.open(f"{site}/search.html")
    chromium.value(f"new Promise(done => {{ Search.performSearch({json.dumps(words)}); done(0) }})")
    found = "[...document.querySelectorAll('#search-results li a')].map(link => link.innerText)"
    ends = time.monotonic() + browser.PATIENCE
    while "Which command for which task" not in chromium.value(found)[:4]:
        assert time.monotonic() < ends, chromium.value(found)
        time.sleep(0.1)


@needsSite
def test_classes_options_and_gallery_are_those_of_the_code(pages):
    import masonry
    from masonry.scene import options

    for name in masonry.classes:
        assert f"masonry.{name}" in pages["classes.html"].anchors
    assert "Tensile strength ft" in pages["classes.html"].text
    for action in options.parser("", None)._actions:
        for option in action.option_strings:
            assert option in pages["options.html"].text
    assert not re.search("–[a-z]", pages["options.html"].text)
    for name in staging.gallery():
        assert f"{staging.sceneOf(name)}.html" in pages["gallery.html"].links
        shown = " ".join(pages[f"{staging.sceneOf(name)}.html"].text.split())
        assert "import" in shown and "It takes about" in shown.partition("import")[0]


@needsSite
def test_laws_have_their_equations_as_mathematics(pages):
    paper = pages["yade_plugin/law/README.html"]
    assert paper.text.count(r"\[") >= 14 and r"F_2 = |\tau|" in paper.text
    assert any("MathJax.js" in one for one in paper.loads())
    cyclic = pages["yade_plugin/law/cyclic_softening/README.html"]
    assert cyclic.text.count(r"\[") >= 6


@needsSite
@needsBrowser
def test_the_pdf_has_its_equations_and_nothing_wider_than_its_paper(site, chromium):
    """What is wider makes Chromium print all pages smaller."""
    assert (site.parent / "masonry.pdf").stat().st_size > 1e6
    chromium.open(site.parent / "paper" / "index.html", width=658)  # 174 mm
    chromium.call("Emulation.setEmulatedMedia", media="print")
    chromium.value("new Promise(done => MathJax.Hub.Queue(() => done(0)))")
    assert chromium.value("document.querySelectorAll('.MathJax_SVG').length") > 20
    wide = chromium.value("document.documentElement.scrollWidth")
    chromium.call("Emulation.setEmulatedMedia", media="")
    assert wide <= 662


@needsSite
@needsBrowser
def test_links_of_the_pdf_lead_somewhere_for_whoever_has_the_pdf_alone(site):
    page = SitePage(site.parent / "paper" / "index.html")
    lost = [link for link in page.links if not re.match("https?:", link)]
    lost = [link for link in lost if link.partition("#")[2] not in page.anchors]
    assert len(page.links) > 1000 and lost == []


FLAGS = arguments.listOf(arguments.flag)


@mark.parametrize(
    ("validator", "text"),
    [
        (arguments.number("Pa", 0), "a number at least 0 Pa"),
        (arguments.orNone(arguments.number("s", 0)), "a number at least 0 s, or None"),
        (arguments.oneOf("held", "free"), "one of held, free"),
        (arguments.vector("m"), "three finite numbers"),
        (arguments.whole(1, 10), "a whole number from 1 to 10"),
        (arguments.flag, "True or False"),
        (FLAGS, "a list with at least 1 value; each is True or False"),
        (arguments.orFunction(arguments.flag), "True or False, or a function"),
    ],
)
def test_what_a_word_takes_is_what_its_check_says(validator, text):
    assert validators.meaning(validator) == text


def test_links_lead_to_pages(tmp_path):
    stage = staging.Stage(str(tmp_path / "source"))
    text = (
        "[a](scripts/README.md#gallery) [b](https://yade-dem.org) [c](validation/)"
        " [d](scripts/masonry_limit/__init__.py) [`e`](scripts/masonry_study/statistics.py)"
        " [f](scripts/arch.py) [g](#start) `[h](scripts/README.md)`\n\n```math\nx\n```\n\n   "
        " [i](scripts/README.md)\n"
    )
    stage.document("README.md", "# Title\n\n" + text)
    written = (tmp_path / "source" / "index.md").read_text()
    assert (
        "[a](scripts/README.md#gallery) [b](https://yade-dem.org) [c](validation/README.md)"
        in written
    )
    assert "{py:mod}`d <masonry_limit>` {py:mod}`e <masonry_study.statistics>`" in written
    assert "[f](scripts/arch.py.md) [g](#start) `[h](scripts/README.md)`" in written
    assert "```{math}\nx\n```" in written and "    [i](scripts/README.md)\n" in written
    assert stage.shown == {"scripts/arch.py"}
    stage.document("CONTRIBUTING.md", "# Title\n\n[up](README.md)\n")
    assert "[up](index.md)" in (tmp_path / "source" / "CONTRIBUTING.md").read_text()


def test_a_notebook_becomes_a_page():
    outputs = [
        {
            "output_type": "stream",
            "name": "stdout",
            "text": ["10 %\r20 %\n", "\x1b[1mdone\x1b[0m\n"],
        },
        {"output_type": "display_data", "data": {"image/png": "AAAA", "text/plain": ["x"]}},
        {
            "output_type": "execute_result",
            "data": {"text/html": ["<b>```</b>"], "text/plain": ["x"]},
        },
    ]
    code = {"cell_type": "code", "source": ["print(1)"], "outputs": outputs}
    title = {"cell_type": "markdown", "source": ["# Title\n", "text"]}
    notebook, kept = {"cells": [title, code]}, {}
    text = notebooks.markdown(notebook, "one", kept.__setitem__)
    assert "```python\nprint(1)\n```" in text and "```text\n20 %\ndone\n```" in text
    assert "![](one_1.png)" in text and kept == {"one_1.png": b"\0\0\0"}
    assert "````{raw} html\n<b>```</b>\n````" in text
    outputs[:] = [{"output_type": "error", "ename": "ValueError", "evalue": "bad"}]
    with raises(ValueError, match="one: ValueError: bad"):
        notebooks.markdown(notebook, "one", kept.__setitem__)


#: A documentation of classes as YADE makes its own: its roles, and autodoc of classes in
#: yade.wrapper.
LIKE_YADES = """
import sys
sys.path[:0] = {path!r}
import yade.config, masonry
from docutils import nodes

extensions = ["sphinx.ext.autodoc"]


def shown(name, raw, text, line, inliner, options=None, content=()):
    return [nodes.literal(raw, text)], []


def setup(app):
    for name in ("yref", "ysrc", "ydefault", "yattrtype", "yattrflags"):
        app.add_role(name, shown)
"""


@needsSite
@mark.long
def test_yades_documentation_takes_the_classes_of_the_plugin(tmp_path):
    names = [name for name in dir(wrapper) if "Masonry" in name]
    assert len(names) > 15
    (tmp_path / "conf.py").write_text(LIKE_YADES.format(path=sys.path))
    pages = [f".. autoclass:: yade.wrapper.{name}\n   :members:\n" for name in names]
    (tmp_path / "index.rst").write_text("\n".join(["Classes", "=======", "", *pages]))
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-b", "text", ".", "out"]
    made = ran(command, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    text = (tmp_path / "out" / "index.txt").read_text()
    assert "friction" in text and "Peak friction coefficient tan(phi_p)" in text
