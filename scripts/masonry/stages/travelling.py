# SPDX-License-Identifier: GPL-2.0-or-later
"""A load that goes over a structure and stands at one place after the other: ``travel``."""

import csv
import zlib
from dataclasses import dataclass
from typing import Annotated, Any, Sequence

import numpy as np
from yade import Vector3

from ..arguments import listOf, number, require
from ..arguments import vector as point
from ..folders import replaced, writing
from ..model.loading import smooth
from ..scene.pressures import placesBelow
from .bounds import findBound
from .answers import AT_REST, DONE, Answer
from .rest import Resting, waitForRest
from .stage import Duration, stage


TRAVELS = "load that travels, at "  # how the names of its bounds begin
TABLE = "travel.csv"
HEADS = "place x_m y_m z_m bound_kN factor displacement_mm".split()
STRIPS = 20  # equal parts of an axle that is spread


def axle(value, context=None):
    """Validator of an axle: its distance ahead of the place [m] and its share of the force [-]."""
    fine = isinstance(value, (tuple, list)) and len(value) == 2
    require(value, fine, "two numbers: a distance [m] and a share of the force [-]")
    return number("m", -1e3, 1e3)(value[0]), number("", 0, 1e3, above=True)(value[1])


Axles = Annotated[Sequence[Any], listOf(axle)]
Spread = Annotated[float, number("", 0, 10)]


@dataclass
class Travelling(Resting):
    """What the stage remembers."""

    place: int = 0  # at which the load arrives, from 0; behind the last place it leaves
    began: Sequence = ()  # vertical displacements of all places when the load came [mm]
    moved: Sequence = ()  # displacements since then of each place where it stood [mm]
    after: float = 0.0  # largest amount of them when it has left [mm]
    along: Sequence = ()  # its places [m]
    force: float = 0.0  # [N]


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
    bounds = influence(scene, at.along, at.force, at.moved)
    if bounds:
        name, least = min(bounds.items(), key=lambda one: one[1])
        why = "limit analysis: the least load, at which an upper bound is found"
        yield Answer("least_bound", "kN", least, f"{why}: {name}")
        held = f"limit analysis: at most so many times the load is held at all places: {name}"
        yield Answer("largest_factor", "-", 1e3 * least / at.force, held)


def nameOf(place):
    """The name of the bound of a place."""
    return f"{TRAVELS}({', '.join(f'{v:.4g}' for v in place)}) m"


def influence(scene, along, force, moved=()):
    """Write the line of influence, travel.csv. Returns the bounds [kN] by their names."""
    entries, path = scene.bounds.entries, scene.results.path(TABLE)
    found = [entries.get(nameOf(place), {}).get("factor") for place in along]
    with writing(path), replaced(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(HEADS)
        for n, (place, bound) in enumerate(zip(along, found)):
            factor = bound and 1e3 * bound / force
            row = [*place, bound, factor, *(moved[n : n + 1] or [None])]
            table.writerow([n + 1, *("" if v is None else f"{v:.6g}" for v in row)])
    return {nameOf(place): bound for place, bound in zip(along, found) if bound is not None}


def sharesOf(description, along, axles, spread):
    """The forces of a train at each of its places, on each brick one: its number, its point [m] and
    its share of the force. Raises ValueError where no axle stands on the structure."""
    ahead = np.subtract(along[-1], along[0]) * (1, 1, 0)
    ahead = ahead / np.linalg.norm(ahead) if ahead.any() else np.array([1.0, 0, 0])
    middles = [np.add(place, distance * ahead) for place in along for distance, _ in axles]
    places, count = placesBelow(description, middles), STRIPS if spread else 1
    parts = []
    for middle, (_, (_, _, level)) in zip(middles, places):
        half = spread * (middle[2] - level) * ahead
        parts += [middle + (2 * k + 1 - count) / count * half for k in range(count)]
    strips, sums = iter(placesBelow(description, parts) if spread else places), []
    for place in along:
        on: dict[int, list] = {}
        for _, share in axles:
            for _ in range(count):
                bricks, middle = next(strips)
                for brick in bricks:
                    on.setdefault(brick, []).append((share / count / len(bricks), middle))
        if not on:
            where = ", ".join(f"{v:g}" for v in place)
            raise ValueError(f"travel: no face that looks up is below ({where}) m")
        sums.append([])
        for brick, forces in on.items():
            shares, points = map(np.array, zip(*forces))
            middle = points[0] + shares @ (points - points[0]) / shares.sum()
            sums[-1].append((brick, tuple(middle.tolist()), float(shares.sum())))
    return sums


def placed(scene, along, axles, spread):
    """The engines of a load that travels along some points: of each place pairs of an engine and
    its share of the force. Raises ValueError."""
    places = sharesOf(scene.description, along, axles, spread)
    label = f"travel_{zlib.crc32(repr(places).encode())}"
    loaded = [(brick, middle) for place in places for brick, middle, _ in place]
    engines = iter(scene.model.loading.onBricks(label, loaded))
    return [[(next(engines), share) for *_, share in place] for place in places]


@stage(bounded=True, answers=standings)
def travel(
    scene: Any,
    force: Annotated[float, number("N", 0, 1e15, above=True)],
    along: Annotated[Sequence[Any], listOf(point("m", 1e6))],
    axles: Axles = ((0.0, 1.0),),
    spread: Spread = 0.0,
    longest: Duration | None = None,
) -> str:
    """Let a vertical load go over the structure, as an axle or a train of them goes over an arch
    bridge: it stands at one place after the other until the structure is at rest, and leaves behind
    the last one.

    The load grows on a place as it leaves the one before. Every place has a row of curve.csv, in
    which ``load_factor`` is its number; the last row is without the load. Of up to 500 joints, and
    with ``--preset bound``, limit analysis finds the largest load at each place [kN]. travel.csv is
    the line of influence: of each place that bound, its factor on ``force``, and the displacement.

    :param force: downwards [N]
    :param along: points (x, y, z) [m]: the load stands on the highest face of a rigid brick below
        each of them; where that is on a joint, the bricks there have equal parts of it
    :param axles: pairs of a distance [m] ahead of the place, from the first towards the last of
        ``along`` (of one place along x), and a share of ``force``; axles beside the structure do
        not load it
    :param spread: of each axle along the path to both sides, over the depth from its point, which
        is then on the road, down to the face [-]: 0.5 for 1 : 2
    :param longest: as in :meth:`load`, at each place
    :returns: ``DONE``; ``MOVING`` if the structure did not come to rest with the load at a place,
        where the stage ends then; ``COLLAPSED``
    """
    stands, loading = placed(scene, along, axles, spread), scene.model.loading
    down = Vector3(0, 0, -force)
    if scene.limitAnalysisOnly or len(scene.model.interactions) <= scene.bounds.SMALL:
        for place, engines in zip(along, stands):  # before the load comes
            live = [(engine, Vector3(0, 0, -1e3 * share)) for engine, share in engines]
            findBound(scene, "forces", nameOf(place), "kN", live)
    if scene.limitAnalysisOnly:
        influence(scene, along, force)
        return DONE
    at = scene.running.stage("travel", Travelling())
    at.along, at.force = [[*map(float, place)] for place in along], force
    mean = lambda one: np.average(
        [e.displacement()[2] for e, _ in one], weights=[s for _, s in one]
    )
    places = lambda: [1e3 * float(mean(engines)) for engines in stands]

    def put(engines, part):
        for engine, share in engines:
            engine.force = part * share * down

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
