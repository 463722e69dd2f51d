# SPDX-License-Identifier: GPL-2.0-or-later
"""The packages beside the core, its wings. The core imports none of them: what it needs of one is
loaded when it is used."""

import importlib
import os

from .errors import Refused

#: What needs a wing (a command of a scene, a part of a run, an option) -> module and name in it.
WINGS = {
    "bound": "masonry_limit.beside_run Bounds",
    "domain": "masonry_limit.beside_run Bounds",
    "--preset bound": "masonry_limit.beside_run Bounds",
    "curve": "masonry_view.notebook_scene curve",
    "_repr_html_": "masonry_view.notebook_scene asHtml",
    "figures and report": "masonry_view.postprocess main",
    "probe": "masonry_study.probing probe",
}

PUBLIC = """
    arguments auxiliary background bricks bricks.blocks bricks.geometry errors folders host
    materials materials.codes materials.fields materials.settings memory model.arrays model.bodies
    model.load_names numbers.columns numbers.cracks numbers.curves numbers.drawing numbers.files
    numbers.frames numbers.loops numbers.quantities numbers.run_data packages run.batch
    run.drawing_program run.lock run.progress scene.accelerograms scene.ground scene.options
    scene.parsing scene.summary terminal texts units wings
""".split()


#: The folder in which the core and the wings lie beside each other.
FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class NotInstalled(Refused, ImportError):
    """A wing is not installed."""


class Absent:
    """Limit analysis of a scene where its wing is not installed: no bounds."""

    entries, endless = {}, frozenset()
    SMALL = EVERY = 0

    def __getattr__(self, name):
        return lambda *given, **named: ()


def folderOf(wing):
    """The ``__path__`` of a wing beside the core that runs, which may be another than where the
    wing was found. Raises NotInstalled."""
    folder = os.path.join(FOLDER, wing)
    if not os.path.isdir(folder):
        raise NotInstalled(f"{wing} is not installed in {FOLDER}")
    return [folder]


def isInstalled(what):
    """Whether the wing of a key of :data:`WINGS` is there."""
    package = WINGS[what].partition(".")[0]
    return os.path.isdir(os.path.join(FOLDER, package))


def programOf(what):
    """The module that ``python3 -m`` runs for a key of :data:`WINGS`."""
    return WINGS[what].split()[0]


def find(what):
    """The class or function of a key of :data:`WINGS`. Raises NotInstalled."""
    module, name = WINGS[what].split()
    if not isInstalled(what):
        package = module.partition(".")[0]
        raise NotInstalled(f"{what} needs the package {package}, which is not installed")
    return getattr(importlib.import_module(module), name)
