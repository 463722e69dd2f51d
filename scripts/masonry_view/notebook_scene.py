# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in a notebook, and its curve as arrays."""

import tempfile

import numpy as np
from masonry.bricks import Bricks, boxCorners
from masonry.errors import Refused
from masonry.model.bodies import units
from masonry.numbers import columns
from masonry.numbers.frames import readFrame
from masonry.scene import summary
from yade.wrapper import MasonryVtkRecorder

from .elevation import Structure, cracksOf, figureOf
from .notebook import RunFolder, curveOf, folded, picture, resultsOf, table, titled

MAX_COUNTED = 20_000  # blocks whose joints are counted before the scene is built
#: Properties of joints and units that the table shows.
OF_JOINTS = (
    "normalStiffness shearStiffness tensileStrength cohesion friction compressiveStrength".split()
)
OF_UNITS = "density", "young", "poisson"


def curve(scene):
    """The columns of curve.csv so far. Raises ValueError before the first stage."""
    if not scene.model:
        raise ValueError(f"curve: scene {scene.name} has no rows before its first stage")
    results = scene.results
    run = results.run
    if not scene.finished:
        scene.running.flush()
        run = {"columns": columns.meanings(scene.columns)}
        if results.rows:
            run.update(scene.outcome.figure())
    values = {head: results.column(head) for head in results.columns}
    return curveOf(values, run, results.directory)


def asHtml(scene):
    """A scene as HTML: what is built, or what has come out of it."""
    if not scene.model:
        return _built(scene)
    if scene.finished and scene.results.begun and not scene.running.interrupted:
        return RunFolder(scene.results.directory)._repr_html_()
    if not (scene.finished or scene.isGone):
        return _standing(scene)
    parts = [curve(scene)._repr_html_()] if scene.results.rows else []
    return titled(f"{scene.description.title}: {_state(scene)}", *parts)


def _state(scene):
    if scene.running.interrupted and scene.finished:
        return f"interrupted; its results so far are in {scene.results.directory}"
    return scene.ended or "no stage has ended"


def _standing(scene):
    title, state = scene.description.title, scene.running.state
    with tempfile.TemporaryDirectory() as folder:
        recorder = MasonryVtkRecorder(directory=folder)
        recorder()
        blocks, joints = (readFrame(folder, kind) for kind in ("blocks", "joints"))
    run = scene.outcome.describe() | {"kinds": recorder.kinds, "answers": scene.answers}
    when = f"after {state.stage}" if state.stage else "as built"
    return titled(
        f"{title}: {_state(scene)}",
        picture(lambda: cracksOf(run, blocks, joints, when, scene.name)),
        curve(scene).picture(),
        table(resultsOf(run) + [("so far", _state(scene), "")]),
    )


def _built(scene):
    description = scene.description
    draws = lambda: figureOf(_structure(description), description.title, 0)
    return titled(
        f"{description.title}: before its first stage",
        picture(draws),
        table([*_counted(description), *summary.held(description)]),
        folded("materials", _materials(scene)),
    )


def _structure(description):
    """Whole bricks of every part, with blocks that are held, loaded or watched in their shades."""
    targets, bricks = description.targets.values(), Bricks(description.bricks)
    parts, shades, corners = {}, {}, []

    def add(block, shade=None):
        if shade:
            shades[len(corners)] = shade
        corners.append(np.array(list(map(tuple, block)), float))
        return len(corners) - 1

    for block in bricks.whole() if description.halves else bricks:
        parts.setdefault(block.part, []).append(add(block.corners))
    for target in targets:
        if target.brick is not None:
            block = bricks[target.brick]
            parts[block.part].append(add(block.corners, _shade(target)))
        elif target.box:
            add(boxCorners(*target.box), _shade(target))
    points = np.concatenate(corners)
    cells = np.split(np.arange(len(points)), np.cumsum(list(map(len, corners)))[:-1])
    blocks = {
        "points": points,
        "displacement": 0 * points,
        "body": range(len(corners)),
        "cells": cells,
    }
    return Structure(blocks, None, parts, shades, viewDirections=description.views)


def _shade(target):
    return "held" if target.fixed else "loaded" if target.loaded else "watched"


def _counted(description):
    yield from summary.sizes(description)
    bricks = Bricks(description.bricks)
    if len(bricks) <= MAX_COUNTED:
        platens = any(target.box for target in description.targets.values())
        count = f"{len(bricks.joints()):,} between blocks"
        yield "joints", count + "; platens are not counted" * platens


def _materials(scene):
    connectors = scene.description.settable(copies=True)
    masonry = scene.description.materials.variant(scene.args, [*connectors])
    try:
        masonry.apply(scene.args.set, connectors)
    except Refused as refused:
        return table([("refused", str(refused))])
    joints, blocks = masonry.joints, {"brick": masonry.unit, **masonry.units}
    return _properties("joint", joints, OF_JOINTS) + _properties("unit", blocks, OF_UNITS)


def _properties(what, things, names):
    """A table of properties: a row each, with its unit, and a column for every thing."""
    known = {"density": "kg/m³", **units(type(next(iter(things.values()))))}
    rows = [
        (name, known.get(name, "-"), *(f"{getattr(t, name):.4g}" for t in things.values()))
        for name in names
    ]
    return table(rows, (what, "unit", *things))
