# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages of the site that are made from the code: the commands of a scene, the options, the plugin's
classes, all modules."""

import argparse
import contextlib
import functools
import importlib
import inspect
import os
import pkgutil
import re
import subprocess
import sys

import masonry
import yaml
from masonry.scene import connections, loads, options, records, platens
from masonry.scene.scene import Scene
from masonry.stages import LATER, STAGES

from tree import ROOT, read

#: Programs with options of their own, as Python is asked for them. Others take a folder alone.
PROGRAMS = (
    "scripts/plot.py",
    "scripts/view.py",
    "-m masonry_view.report",
    "-m masonry_capacity",
    "-m masonry_capacity.piers",
    "-m masonry_study",
    "-m masonry_study.report",
    "-m masonry_study.row",
)


def heading(text, line="="):
    """A heading of reStructuredText."""
    return f"{text}\n{line * len(text)}\n\n"


def table(rows, widths):
    """A table of reStructuredText, whose first row is its head; cells are reStructuredText of one
    paragraph."""
    text = f".. list-table::\n   :header-rows: 1\n   :widths: {widths}\n\n"
    for row in rows:
        first, *others = (" ".join(cell.split()) or "\\ " for cell in row)
        text += f"   * - {first}\n" + "".join(f"     - {cell}\n" for cell in others)
    return text + "\n"


def escaped(text):
    """A plain text as reStructuredText shows it, with the names of options as code: two hyphens
    would become a dash."""
    text = re.sub(r"([*`|_\\<>])", r"\\\1", text)
    return re.sub(r"--[a-z-]+", r"``\g<0>``", text)


def summary(thing):
    """What a docstring says up to the first colon or the end of its first sentence."""
    return " ".join(re.split(r"[.:](?:\s|$)", inspect.getdoc(thing))[0].split())


#: Methods of a scene that its stages call, and no script.
FOR_STAGES = {"begin", "checkOpen", "failed", "masonry", "present", "probe"}


def _commands():
    """The commands of a scene by what they are for: dict of a title to their names."""
    modules = {
        platens: "What holds it",
        connections: "What connects it",
        loads: "What loads it",
        records: "What is recorded",
    }
    described = {title: [] for title in modules.values()}
    for name, thing in vars(Scene).items():
        module = sys.modules.get(getattr(_inner(thing), "__module__", None))
        if module in modules and inspect.getdoc(_inner(thing)):
            described[modules[module]].append(name)
    stages = {}
    for stage in (*STAGES, *LATER):
        family = sys.modules[_inner(stage).__module__]
        stages.setdefault(summary(family), []).append(stage.__name__)
    said = {name for names in (*described.values(), *stages.values()) for name in names}
    documented = [n for n, f in vars(Scene).items() if inspect.getdoc(_inner(f))]
    own = [n for n in documented if n not in said | FOR_STAGES and n[0] != "_"]
    return described, stages, own


def _inner(thing):
    """The function or property that a decorator has wrapped."""
    thing = getattr(thing, "fget", None) or getattr(thing, "func", thing)
    return inspect.unwrap(thing) if callable(thing) else thing


def commands():
    """The page of the commands of a scene."""
    described, stages, own = _commands()
    text = ".. currentmodule:: masonry\n\n" + heading("Commands of a scene")
    text += (
        "A scene is described, then it goes through its stages, then it is finished. Every command"
        " checks all that it is given before it does anything; what it takes, with unit and bounds,"
        " is what the check has.\n\n.. autoclass:: masonry.Scene\n   :no-members:\n\n"
    )
    once = set()

    def methods(names, title):
        names = [n for n in names if not (n in once or once.add(n))]
        if not names:
            return ""
        found = heading(title, "-")
        for name in names:
            of = (
                "property"
                if isinstance(
                    inspect.getattr_static(Scene, name), (property, functools.cached_property)
                )
                else "method"
            )
            found += f".. auto{of}:: masonry.Scene.{name}\n\n"
        return found

    for title, names in (*described.items(), *stages.items()):
        text += methods(names, title)
    return text + methods(own, "How it goes, and what it says")


def _usage(action):
    value = (
        ""
        if action.nargs == 0
        else " "
        + (action.metavar or "|".join(map(str, action.choices or ())) or action.dest.upper())
    )
    return ", ".join(f"``{name}{value}``" for name in action.option_strings)


def optionsOfScenes():
    """The page of the options that all scenes share, and those of the other programs."""
    parser = options.parser("", None)
    rows = [["option", "default", "meaning"]]
    for action in parser._actions:
        if action.help == argparse.SUPPRESS or not action.option_strings:
            continue
        usual = action.default if action.default not in (None, False, [], argparse.SUPPRESS) else ""
        text = (action.help or "").replace("%%", "%")
        rows.append([_usage(action), escaped(str(usual)), escaped(text)])
    text = heading("Options of the command line")
    text += (
        "``yade -n -x SCENE.py --help`` explains these options, which all scenes share, and those"
        " of the scene.\n\n"
    )
    text += table(rows, "30 12 58") + heading("Programs", "-")
    around = dict(cwd=ROOT, env={**os.environ, "COLUMNS": "100"})
    for program in PROGRAMS:
        name = f"/usr/bin/python3 {program}"
        words = [*name.split(), "--help"]
        run = subprocess.run(words, capture_output=True, text=True, **around)
        if run.returncode:
            raise RuntimeError(f"{name} --help: {run.stdout}{run.stderr}")
        shown = "\n".join("   " + line for line in run.stdout.rstrip().splitlines())
        text += heading(f"``{name}``", "~") + f".. code-block:: text\n\n{shown}\n\n"
    return text


_PROPERTY = re.compile(r"^(?P<meaning>.*?)(?: :ydefault:`(?P<usual>.*?)`)?$", re.S)


def _attributes(cls):
    """The attributes of a registered class, as rows of name, default and meaning."""
    for name, thing in vars(cls).items():
        if name.startswith("_") or not isinstance(thing, property):
            continue
        about = _PROPERTY.match(" ".join((thing.__doc__ or "").split()))
        usual = about["usual"] or ""
        with contextlib.suppress(ValueError):
            usual = f"{float(usual):g}".replace("e+", "e")
        yield f"``{name}``", escaped(usual), escaped(about["meaning"])


def classes():
    """The page of the classes that the plugin registers in YADE."""
    text = heading("Classes of the plugin")
    text += (
        "The classes that the plugin registers in YADE, as ``help(masonry.MasonryJoint)`` has them."
        " Values are in SI units. Attributes of YADE's own classes from which they derive are left"
        " out.\n\n"
    )
    for name in masonry.classes:
        cls = getattr(masonry, name)
        text += (
            f".. py:class:: masonry.{name}\n\n  "
            f" {escaped(' '.join((cls.__doc__ or '').split()))}\n\n"
        )
        rows = list(_attributes(cls))
        if rows:
            shown = table([["attribute", "default", "meaning"], *rows], "26 16 58")
            text += "".join(f"   {line}\n" if line else "\n" for line in shown.split("\n"))
    text += heading("Functions of the plugin", "-")
    about = masonry.criticalTimeStep.__doc__.split("C++ signature")[0].split()[3:]
    text += ".. py:function:: masonry.criticalTimeStep() -> tuple\n\n   "
    return text + escaped(" ".join(about)) + "\n"


#: Packages with a page of their own beside those directly in ``masonry``: their modules are many.
LARGE = ("masonry.materials", "masonry.stages")
PACKAGES = "masonry masonry_view masonry_limit masonry_capacity masonry_study".split()


def modules():
    """The names of all modules of the packages, packages before what is in them."""
    found = []
    for package in PACKAGES:
        found.append(package)
        path = importlib.import_module(package).__path__
        for one in pkgutil.walk_packages(path, package + "."):
            name = one.name.rpartition(".")[2]
            # ParaView alone imports its macro, in its own Python
            if not name.startswith("_") and name != "paraview_macro":
                found.append(one.name)
    return found


def pageOf(module):
    """The name of the page on which a module is documented: a package and its modules share one."""
    for large in LARGE:
        if module == large or module.startswith(large + "."):
            return large
    package, *inner = module.split(".")
    return ".".join([package, *inner[:1]]) if package == "masonry" else package


def api():
    """Pages of all modules: pairs of a path and a text."""
    pages = {}
    for name in modules():
        pages.setdefault(pageOf(name), []).append(name)
    for page, names in pages.items():
        text = heading(f"``{page}``")
        public = getattr(importlib.import_module(page), "__all__", ())
        for name in names:
            if name != page:
                text += heading(f"``{name}``", "-")
            text += f".. automodule:: {name}\n"
            if name not in PACKAGES:
                text += "   :members:\n"
            if name != page and public:  # they stand at the top of the page
                text += f"   :exclude-members: {', '.join(public)}\n"
            if name == Scene.__module__:  # it is the page of the commands
                text += "   :exclude-members: Scene\n"
            text += "\n"
        if page == "masonry":
            text += ".. toctree::\n   :maxdepth: 1\n\n" + "".join(
                f"   {n}\n" for n in pages if n != page
            )
        yield f"api/{page}.rst", text


def cite():
    """The page on how to cite the software and its papers, from CITATION.cff."""
    known = yaml.safe_load(read("CITATION.cff"))
    text = f"# How to cite\n\n{known['message']}\n\n"
    people = lambda work: ", ".join(
        a.get("name") or f"{a['given-names']} {a['family-names']}" for a in work["authors"]
    )
    text += (
        f"> {people(known)}: *{known['title']}*, version {known['version']}."
        f" {known['license']}.\n\n"
    )
    for paper in known.get("references", []):
        text += f"{paper['scope']}:\n\n> {people(paper)}: *{paper['title']}*"
        text += f", {paper['notes']}" if "notes" in paper else ""
        text += f", doi [{paper['doi']}](https://doi.org/{paper['doi']})" if "doi" in paper else ""
        text += ".\n\n"
    return (
        text
        + "The file CITATION.cff, which reference managers read:\n\n```yaml\n"
        + read("CITATION.cff")
        + "```\n"
    )
