# SPDX-License-Identifier: GPL-2.0-or-later
"""How Sphinx makes the site and the PDF; ``build.py`` calls it."""

import inspect
import itertools
import os
import re
import sys
from typing import Annotated, get_args, get_origin

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import validators
import masonry
from docutils import nodes
from masonry.stages import LATER
from sphinx.ext.autodoc import DataDocumenter, GenericAliasMixin
from sphinx.util.typing import restify

#: How what a word is after the first stage begins in its docstring.
AFTER = "After the first stage:"

project = "Masonry for YADE"
author = "The maintainers of Masonry for YADE"
copyright = "the maintainers of Masonry for YADE, GPL-2.0-or-later"
version = release = masonry.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath", "html_image", "colon_fence"]
myst_heading_anchors = 4
root_doc = "index"
suppress_warnings = ["myst.header"]  # a page may be included below another one
highlight_language = "default"
nitpicky = False

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented_params"
autodoc_typehints_format = "short"

# MathJax of Debian draws equations as SVG: it needs no font and no request, not even where a
# browser opens files.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG-full"
mathjax2_config = {
    "showMathMenu": False,
    "messageStyle": "none",
    "tex2jax": {"processClass": "math"},
}
myst_update_mathjax = False

html_static_path = [
    os.path.join(HERE, "static"),
    os.environ["MASONRY_DOCS_STATIC"],
]
html_title = f"Masonry for YADE {release}"
html_show_sourcelink = False
html_copy_source = False
html_search_scorer = os.path.join(HERE, "scorer.js")
if tags.has("paper"):  # noqa: F821, Sphinx knows it
    html_theme = "basic"
    html_css_files = ["print.css"]
    html_sidebars = {}
else:
    html_theme = "furo"
    html_css_files = ["site.css"]


def _validatorsOf(command):
    """The validators of the arguments of a command, also under its decorators."""
    while command and not hasattr(command, "validators"):
        command = getattr(command, "__wrapped__", None)
    return command.validators() if command else {}


def _withTypes(lines, checks):
    """A docstring with the type, unit and bounds of each argument, as its check has them."""
    isField = lambda line: line.startswith((":param", ":return", ":raise"))
    first = next((n for n, line in enumerate(lines) if isField(line)), len(lines))
    fields, types, place = [], [], 0
    for line in lines[first:]:
        if isField(line):
            fields.append([])
        fields[-1].append(line)
    for one, validator in checks.items():
        said = validators.meaning(validator)
        known = [n for n, field in enumerate(fields) if field[0].startswith(f":param {one}:")]
        if known:
            place = known[0]
            types += [f":type {one}: {said}"] if said else []
        else:  # in the order of the arguments
            fields.insert(place, [f":param {one}: {said}"])
        place += 1
    return [*lines[:first], "", *types, *itertools.chain(*fields), ""]


def typesFromChecks(app, what, name, thing, options, lines):
    """Give each argument of a word the type, unit and bounds that its check has."""
    if what not in ("class", "function", "method"):
        return
    function = thing.__init__ if inspect.isclass(thing) else thing
    at = next((n for n, line in enumerate(lines) if line.startswith(AFTER)), len(lines))
    later = {stage.__name__: stage for stage in LATER}.get(name.rpartition(".")[2])
    found = _withTypes(lines[:at], _validatorsOf(function))
    if at < len(lines):
        found += ["", *_withTypes(lines[at:], _validatorsOf(later))]
    lines[:] = found


class ConstantDocumenter(DataDocumenter):
    """A constant without its value where that holds functions, and a type with its validator in
    words."""

    def should_suppress_value_header(self):
        hasFunctions = "<function" in repr(self.object)
        return hasFunctions or super().should_suppress_value_header()

    def update_content(self, more_content):
        if get_origin(self.object) is not Annotated:
            return super().update_content(more_content)
        hint, validator = get_args(self.object)[:2]
        more_content.append(f"{restify(hint)}: {validators.meaning(validator)}", "")
        super(GenericAliasMixin, self).update_content(more_content)


def functionsByName(app, what, name, thing, options, signature, returns):
    """A signature whose defaults name functions as a source does."""
    plain = re.sub(r"<function (?:[^<> ]*\.)?(\w+|<lambda>)>", r"\1", signature or "")
    return plain.replace("<lambda>", "lambda"), returns


def withoutValidators(app, domain, kind, content):
    """Types of arguments without their validators, which Sphinx 8 names."""
    innermost = re.compile(r"Annotated\[((?:(?!Annotated)[^<>])*), <function \S+ at 0x[0-9a-f]+>\]")
    for text in list(content.findall(nodes.Text)):
        plain, count = text.astext(), 1
        while count:
            plain, count = innermost.subn(r"\1", plain)
        text.parent.replace(text, nodes.Text(plain))


def withoutFieldsOfTuples(app, what, name, thing, skip, options):
    """Leave out what Python itself says of the fields of a named tuple: their numbers."""
    return skip or type(thing).__name__ == "_tuplegetter"


def literally(name, raw, text, line, inliner, options=None, content=()):
    """The role of YADE's documentation in which the default of an attribute stands."""
    return [nodes.literal(raw, text)], []


def setup(app):
    if tags.has("paper"):  # noqa: F821, Sphinx knows it
        app.set_html_assets_policy("always")  # the one page has the equations of all others
    app.add_role("ydefault", literally)
    app.add_autodocumenter(ConstantDocumenter, override=True)
    app.connect("autodoc-process-docstring", typesFromChecks)
    app.connect("autodoc-skip-member", withoutFieldsOfTuples)
    app.connect("autodoc-process-signature", functionsByName)
    # autodoc adds the types at priority 500
    app.connect("object-description-transform", withoutValidators, priority=600)
