# SPDX-License-Identifier: GPL-2.0-or-later
"""The search for the largest factor of one load on a scene that stands in YADE."""

import math
import time
from dataclasses import dataclass, field
from typing import Any, Callable

from masonry.errors import Refused
from masonry.memory import FULL

from . import loads
from .assembly import UnboundedLoad
from .reading import read

#: Of the search for a tilt: its rounds at most, the difference of two tilts at which it ends, and
#: the largest tilt [rad].
TILTS, SAME_TILT, STEEPEST = 20, 1e-6, math.radians(89.9)


@dataclass(frozen=True)
class Load:
    """A load whose largest factor is looked for.

    :param name: under which its bound is found, and ``unit`` of its factor
    :param live: function of a :class:`masonry_limit.assembly.Assembly` that gives the forces at a
        factor of 1 [N]
    :param tilts: whether gravity turns with it
    :param pushed: target and direction of a push, whose own drive is no prop, or None
    :param gravity: acceleration that acts beside it [m/s²]; None: that of the scene
    :param pressed: target and normal force [kN] that replaces its press, or None
    :param forces: what tells it from others of its name: its forces, as data
    """

    name: str
    unit: str
    live: Callable
    tilts: bool = False
    pushed: tuple | None = None
    gravity: tuple | None = None
    pressed: tuple | None = None
    forces: tuple = ()


@dataclass
class Found:
    """What was found of a load."""

    entry: dict[str, Any] = field(default_factory=dict)  #: what its entry of run.json gets
    lines: list[str] = field(default_factory=list)  #: to say
    endless: bool = False  #: whether nothing gives way
    bound: Any = None  #: :class:`masonry_limit.Bound`


def search(model, load, lowerUpTo, seconds):
    """Find the bound of a :class:`Load`, within some seconds: :class:`Found`.

    :param lowerUpTo: up to so many joints a collapse without dilatancy is looked for, too, if the
        bound is not exact
    """
    found = Found()
    try:
        assembly = read()
        assembly.deadline = time.monotonic() + seconds
        down = assembly.weights(load.gravity or model.scheme.now)
        forces = loads.forces(model, assembly, load.pushed, load.pressed)
        if load.pressed:
            found.entry["normal_kN"] = loads.carriedBy(assembly, down + forces)
        live = load.live(assembly)

        def largest(find, first):
            at = lambda cos: find(cos * live, cos * down + forces)
            return _tilted(at, first) if load.tilts else at(1.0)

        bound = largest(assembly.largest, 0.0)
        found.entry.update(bound.describe())
        found.lines.append(bound.sentence(load.name, load.unit))
        if not bound.exact and len(model.interactions) <= lowerUpTo:
            least = largest(assembly.withoutDilatancy, math.atan(bound.factor))
            found.entry["without_dilatancy"] = least.factor
            found.entry["without_dilatancy_settled"] = least.settled
            found.lines.append(least.sentence(load.name, load.unit))
        found.bound = bound
    except Refused as refused:
        found.endless = isinstance(refused, UnboundedLoad)
        found.entry["note"] = str(refused)
    except (MemoryError, ImportError):  # a library cannot be loaded either
        found.entry["note"] = f"limit analysis: {FULL}"
    if "note" in found.entry:
        found.lines.append(f"note: {found.entry['note']}")
    return found


def _tilted(find, first):
    """The bound of a tilt, at which weights have turned as far as its factor says, while other
    loads have not: secants find it. Raises UnboundedLoad if there is no such tilt below
    :data:`STEEPEST`.

    :param find: function of the cosine of the tilt that gives the bound with weights of that share
    :param first: tilt with which the search begins [rad]
    """
    bound = find(math.cos(first))
    angle = math.atan(bound.factor)
    last, off = first, angle - first
    for _ in range(TILTS):
        angle = min(max(angle, 0.0), STEEPEST)
        if abs(angle - last) < SAME_TILT:
            break
        bound = find(math.cos(angle))
        more = math.atan(bound.factor) - angle
        slope = (more - off) / (angle - last)
        last, off = angle, more
        angle = last - off / slope if slope < 0 else last + off
    if last == STEEPEST and off > 0:
        raise UnboundedLoad("limit analysis: no tilt below 90 degrees moves the structure")
    return bound
