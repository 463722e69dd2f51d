# SPDX-License-Identifier: GPL-2.0-or-later
"""Records one after the other on one structure: ``shakeAgain``, and what is left after each: ``period``."""

from __future__ import annotations

import csv
from types import SimpleNamespace
from typing import Annotated, Any, Sequence

import numpy as np

from ...common.arguments import Level, listOf, number, validated
from ...assembly.period import firstPeriod
from ...basics import Unwritable, say
from ...common.folders import replaced
from ..ground import readRecord, record
from .answers import COLLAPSED, DONE, Answer
from .gravity import sideways
from .rest import settle
from .shake import shake
from .stage import stage
from .timed import Duration

TABLE = "shakes.csv"
LONGEST = 4.0  # [s]: the longest first period that is looked for


def remains(scene, rows):
    """The first period, what has moved since the scene was built, and the widest crack."""
    looked = f"free vibration after a small push, at most {LONGEST:g} s"
    yield Answer("first_period", "s", scene.running.memory.period or None, looked)
    for target in scene.description.targets.values():
        moved = scene.model.supports.moved(target)[0]
        for i, axis in enumerate("xyz" if not target.fixed else ""):
            how = "at rest, since the scene was built"
            yield Answer(f"residual_{target.name}_{axis}", "mm", 1e3 * moved[i], how)
    width = scene.model.widestCrack()
    yield Answer("largest_crack", "mm", width, "of all joints, at rest")


@stage(answers=remains)
@validated
def period(scene: Any, direction: Level = (1, 0, 0)) -> str:
    """Measure the first period of the structure, which is at rest, by its free vibration after a small push (0.05 g), and what has
    moved since it was built. The scene stays as it is.

    :param direction: horizontal
    """
    along = sideways(scene, direction, "period")
    at = scene.running.stage("period", SimpleNamespace(period=0.0))  # [s]; 0: none
    with scene.running.clock("setup"), scene.running.breakable():
        at.period = firstPeriod(scene.model, along, LONGEST) or 0.0
    return DONE


@validated
def shakeAgain(
    scene: Any,
    records: Annotated[Sequence[Any], listOf(record)],
    every: Duration | None = None,
    direction: Level = (1, 0, 0),
    scales: Annotated[Sequence[float], listOf(number("", -1e6, 1e6))] | None = None,
    longest: Duration = 4.0,
    **how: Any,
) -> list[str]:
    """Shake a structure by one record after the other, as it was left by those before. After each it comes to rest, and its period
    and what remains are measured: stages :meth:`shake`, :meth:`settle` and :meth:`period`. ``shakes.csv`` has a row for every
    record. ``--resume`` goes on within a record as it does in :meth:`shake`.

    :param records: of each what :meth:`shake` takes
    :param every: time between two samples [s], and ``direction``: as in :meth:`shake`
    :param scales: a factor for each record [-]; None: 1
    :param longest: time after a record in which it comes to rest at most [s]
    :param how: other arguments of :meth:`shake`, as ``unit`` and ``damping``
    :returns: how each shake ended; a collapse ends the sequence
    :raises ValueError: if there are not as many scales as records
    """
    if scene.args.record is not None or scene.args.scale != 1:
        raise ValueError("shakeAgain: --record and --scale are for the one record of shake(); give records and scales here")  # fmt: skip
    scales = [1.0] * len(records) if scales is None else scales
    if len(scales) != len(records):
        raise ValueError(f"shakeAgain: {len(scales)} scales for {len(records)} records")
    ends, rows = [], []
    for number, (one, scale) in enumerate(zip(records, scales), 1):
        ends.append(shake(scene, one, every, direction, scale, **how))
        stages = [scene.running.entered]
        if ends[-1] != COLLAPSED and settle(scene, longest=longest) != COLLAPSED:
            period(scene, direction)
            stages.append(scene.running.entered)
        values, _ = readRecord(one, every, scale, how.get("unit"))
        peak = abs(scale) * float(np.abs(values).max())
        row = {"shake": number, "peak_m_per_s2": peak}
        for answer in scene.answers:
            if answer["number"] in stages:
                unit = "" if answer["unit"] == "-" else f"_{answer['unit']}"
                row[answer["name"] + unit] = answer["value"]
        rows.append({**row, "ended": scene.ended})
        _write(scene, rows)
        if scene.collapsed:
            say(f"shakeAgain: the structure fell in record {number} of {len(records)}")
            break
    return ends


def _write(scene, rows):
    heads = dict.fromkeys(head for row in rows for head in row if head != "ended")
    path = scene.results.path(TABLE)
    try:
        with replaced(path, "w", newline="") as file:
            writer = csv.DictWriter(file, [*heads, "ended"])
            writer.writeheader()
            writer.writerows(rows)
    except OSError as error:
        raise Unwritable(f"{path} cannot be written: {error.strerror}") from None
