"""A small wall for the tests, and how it is tested in this process."""

import os
import runpy
import sys

from conftest import ROOT
from masonry import options
from masonry.loading import push, settle
from masonry.run import Run
from masonry.walls import Wall, WallModel

SMALL = Wall(
    name="small", title="a small wall", halfUnits=6, precompression=0.5e6, courses=6
)


def parsed(*words):
    return options.parser("", until=1).parse_args(list(words))


def carryOut(wall, args):
    """Settle and push a wall as the scenes do. Returns the exit status."""
    with Run(wall.name, args) as run:
        model = run.build(WallModel(wall, args))
        settle(run, model)
        push(run, model)
    return run.status


def settled(folder, *words, wall=SMALL):
    """A wall at rest, and its run, without ParaView files."""
    args = parsed("--no-vtk", "--out", str(folder), *words)
    run = Run(wall.name, args)
    model = run.build(WallModel(wall, args))
    settle(run, model)
    return run, model


def scene(name, *words):
    """Run a program of scripts/ in this process. Returns its exit status."""
    path, before = os.path.join(ROOT, "scripts", name + ".py"), sys.argv
    sys.argv = [path, *words]
    try:
        runpy.run_path(path)
    except SystemExit as end:
        return end.code
    finally:
        sys.argv = before
