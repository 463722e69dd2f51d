# SPDX-License-Identifier: GPL-2.0-or-later
"""Where modules of version 2 are now."""

import sys

from .terminal import say

MODULES = {
    "masonry.batch": "masonry.run.batch",
    "masonry.checkpoints": "masonry.run.checkpoints",
    "masonry.columns": "masonry.numbers.columns",
    "masonry.comparison": "masonry_view.comparison",
    "masonry.curves": "masonry.numbers.curves",
    "masonry.described": "masonry.scene.targets",
    "masonry.fields": "masonry.materials.fields",
    "masonry.figures": "masonry_view.figures",
    "masonry.frames": "masonry.numbers.frames",
    "masonry.ground": "masonry.scene.ground",
    "masonry.history": "masonry.scene.history",
    "masonry.limit": "masonry_limit",
    "masonry.loops": "masonry.numbers.loops",
    "masonry.measure": "masonry_view.measure",
    "masonry.options": "masonry.scene.options",
    "masonry.presets": "masonry.run.presets",
    "masonry.results": "masonry.numbers.files",
    "masonry.study": "masonry_study",
    "masonry.viewer": "masonry_view.viewer",
    "masonry.window": "masonry.model.window",
}


class Finder:
    """The last finder of ``sys.meta_path``."""

    def find_spec(self, name, path=None, target=None):
        """Raise ModuleNotFoundError with the new name of a module that has moved; ``python3 -m`` of
        it ends with status 2."""
        if name not in MODULES:
            return None
        if sys.argv[:1] == ["-m"]:
            program = sys.orig_argv[sys.orig_argv.index("-m") + 1]
            if program.startswith(name):
                new = MODULES[name] + program.removeprefix(name)
                say(f"{program} has moved: /usr/bin/python3 -m {new}", sys.stderr)
                raise SystemExit(2)
        raise ModuleNotFoundError(f"{name} has moved: it is {MODULES[name]} now", name=name)


def install():
    """Add the finder."""
    if not any(isinstance(finder, Finder) for finder in sys.meta_path):
        sys.meta_path.append(Finder())
