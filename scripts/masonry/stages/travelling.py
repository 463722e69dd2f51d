# SPDX-License-Identifier: GPL-2.0-or-later
"""``travel``: a load that goes over a structure, and stands at one place after the other."""

import zlib
from dataclasses import dataclass
from statistics import fmean
from typing import Annotated, Any, Sequence

from yade import Vector3

from ..arguments import listOf, number
from ..arguments import vector as point
from ..model.loading import smooth
from ..scene.pressures import placesBelow
from .bounds import findBound
from .answers import AT_REST, DONE, Answer
from .rest import Resting, waitForRest
from .stage import Duration, stage


TRAVELS = "load that travels, at "  # how the names of its bounds begin


@dataclass
class Travelling(Resting):
    """What the stage remembers."""

    place: int = 0  # at which the load arrives, from 0; behind the last place it leaves
    began: Sequence = ()  # vertical displacements of all places when the load came [mm]
    moved: Sequence = ()  # displacements since then of each place where it stood [mm]
    after: float = 0.0  # largest amount of them when it has left [mm]


def standings(scene, rows):
    """How many places held a load that travelled, where the structure gave way most, and the least
    bound."""
    at = scene.running.memory
    if not isinstance(at, Travelling):
        return
    how = (
        "the load stood at so many of its places, one after the other, and the structure came to"
        " rest"
    )
    yield Answer("places_held", "-", len(at.moved), how)
    if at.moved:
        least = min(at.moved)
        where = (
            "of the loaded point, upwards, since the load came, at place"
            f" {at.moved.index(least) + 1} of {len(at.began)}"
        )
        yield Answer("largest_displacement", "mm", least, where)
    if at.place > len(at.began):
        last = (
            "largest amount of the vertical displacement of a place since the load came, when it"
            " has left"
        )
        yield Answer("displacement_after", "mm", at.after, last)
    scene.bounds.take(True)
    entries = scene.bounds.entries.values()
    bounds = {
        e["load"]: e["factor"] for e in entries if e["load"].startswith(TRAVELS) and "factor" in e
    }
    if bounds:
        name, least = min(bounds.items(), key=lambda one: one[1])
        why = "limit analysis: the least load, at which an upper bound is found"
        yield Answer("least_bound", "kN", least, f"{why}: {name}")


def placed(scene, along):
    """The engines of a load that travels along some points: of each place a list, in equal parts.
    Raises ValueError."""
    places = placesBelow(scene.description, along)
    label = f"travel_{zlib.crc32(repr(places).encode())}"
    loaded = [(brick, point) for bricks, point in places for brick in bricks]
    engines = iter(scene.model.loading.onBricks(label, loaded))
    return [[next(engines) for _ in bricks] for bricks, _ in places]


@stage(bounded=True, answers=standings)
def travel(
    scene: Any,
    force: Annotated[float, number("N", 0, 1e15, above=True)],
    along: Annotated[Sequence[Any], listOf(point("m", 1e6))],
    longest: Duration | None = None,
) -> str:
    """Let a vertical load go over the structure, as an axle goes over an arch bridge: it stands at
    one place after the other until the structure is at rest, and leaves behind the last one.

    The load grows on a place as it leaves the one before. Every place has a row of curve.csv, in
    which ``load_factor`` is its number; the last row is without the load. Of up to 500 joints, and
    with ``--preset bound``, limit analysis finds the largest load at each place [kN].

    :param force: downwards [N]
    :param along: points (x, y, z) [m]: the load stands on the highest face of a rigid brick below
        each of them; where that is on a joint, the bricks there have equal parts of it
    :param longest: as in :meth:`load`, at each place
    :returns: ``DONE``; ``MOVING`` if the structure did not come to rest with the load at a place,
        where the stage ends then; ``COLLAPSED``
    """
    stands, loading = placed(scene, along), scene.model.loading
    down = Vector3(0, 0, -force)
    if scene.limitAnalysisOnly or len(scene.model.interactions) <= scene.bounds.SMALL:
        for engines in stands:  # before the load comes
            where = ", ".join(f"{v:.4g}" for v in engines[0].point)
            live = [(engine, Vector3(0, 0, -1e3 / len(engines))) for engine in engines]
            findBound(scene, "forces", f"{TRAVELS}({where}) m", "kN", live)
    if scene.limitAnalysisOnly:
        return DONE
    at = scene.running.stage("travel", Travelling())
    places = lambda: [1e3 * fmean(one.displacement()[2] for one in engines) for engines in stands]

    def put(engines, share):
        for engine in engines:
            engine.force = share / len(engines) * down

    at.began = at.began or places()
    while at.place <= len(stands):
        place = at.place

        def arriving(x):
            share, loading.loadFactor = smooth(x), 0.0
            if place < len(stands):
                put(stands[place], share)
                loading.loadFactor = place + share
            if place:
                put(stands[place - 1], 1 - share)

        ended = waitForRest(scene, at, longest, arriving)
        if ended != AT_REST:
            return ended
        moved = [now - was for now, was in zip(places(), at.began)]
        at.moved = [*at.moved, *moved[place : place + 1]]
        at.after = max(abs(one) for one in moved)
        at.place, at.done, at.quiet, at.level = place + 1, 0, 0, None
    return DONE
