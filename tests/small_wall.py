# SPDX-License-Identifier: GPL-2.0-or-later
"""A small wall for the tests, and how it is tested in this process."""

import runpy
from dataclasses import dataclass
from typing import Callable

from hosted import *
from masonry.numbers import columns
from masonry.scene import options


@dataclass
class Wall:
    """A wall that is tested as those of the paper: pressed, and pushed by a block that can turn or
    not."""

    name: str = "small"
    length: float = 0.66  # [m]
    courses: int = 6
    unit: tuple = bricks.walls.UNIT
    precompression: float = 0.5e6  # [Pa]
    loadHeight: float = None  # [m]; None: the block cannot turn
    riding: bool = True
    masonry: Callable = materials.calciumSilicate

    @property
    def area(self):
        return self.length * self.unit[1]

    def scene(self, args, **settings):
        """The wall before its first stage, and its loading block."""
        height = self.courses * self.unit[2]
        scene = Scene(
            self.name,
            bricks.Wall(self.length, height, self.unit),
            self.masonry(),
            columns=columns.heads(columns.PUSH),
            arguments=args,
            **settings,
        )
        scene.platen("bottom")
        top = scene.platen(
            "top",
            rotation="free" if self.loadHeight else "held",
            upTo=self.loadHeight,
            recorded=height,
            drive="x",
        )
        scene.press(top, self.precompression, riding=self.riding)
        return scene, top


SMALL = Wall()


def parsed(*words):
    return options.parser("", until=1).parse_args(list(words))


def carryOut(wall, args):
    """Settle and push a wall as the scenes do. Returns the exit status."""
    try:
        scene, top = wall.scene(args)
        scene.settle(damping="local", record=False)
        scene.push(top)
        scene.finish()
    except SystemExit as end:
        return end.code
    return scene.status


def settled(folder, *words, wall=SMALL):
    """A wall at rest, without ParaView files: the scene, what it is in YADE, and its loading
    block."""
    scene, top = wall.scene(parsed("--no-vtk", "--out", str(folder), *words))
    scene.settle(damping="local", record=False)
    return scene, scene.model, top


def scene(name, *words):
    """Run a program of scripts/ in this process. Returns its exit status."""
    path, before = scenePath(name), sys.argv
    sys.argv = [path, *words]
    try:
        runpy.run_path(path)
    except SystemExit as end:
        return end.code
    finally:
        sys.argv = before
    return 0
