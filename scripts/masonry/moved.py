# SPDX-License-Identifier: GPL-2.0-or-later
"""Where modules of version 2 are now."""

import sys

from .terminal import say

MODULES = {
    "masonry.assembly": "masonry.model",
    "masonry.basics": "masonry.errors, masonry.terminal and masonry.units",
    "masonry.capacity": "masonry_capacity",
    "masonry.common": "masonry",
    "masonry.limit": "masonry_limit",
    "masonry.read": "masonry_view, and masonry.numbers for numbers and files of a run",
    "masonry.scene.fields": "masonry.materials.fields",
    "masonry.scene.materials": "masonry.materials",
    "masonry.scene.stages": "masonry.stages",
    "masonry.study": "masonry_study",
}
#: Beginnings of names of programs; the first that fits counts.
PROGRAMS = {
    "masonry.read.bilinear": "masonry_capacity.bilinear_curve",
    "masonry.read": "masonry_view",
    "masonry.capacity": "masonry_capacity",
    "masonry.study": "masonry_study",
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
            for old, new in PROGRAMS.items():
                if program.startswith(old):
                    new += program.removeprefix(old)
                    say(f"{program} has moved: /usr/bin/python3 -m {new}", sys.stderr)
                    raise SystemExit(2)
        raise ModuleNotFoundError(f"{name} has moved: it is {MODULES[name]} now", name=name)


def install():
    """Add the finder."""
    if not any(isinstance(finder, Finder) for finder in sys.meta_path):
        sys.meta_path.append(Finder())
