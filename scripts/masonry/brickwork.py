"""Bricks of a wall as plain records, before anything is made in YADE. This module needs no YADE."""

import math
import numbers
from collections import namedtuple

#: One block of a wall: a brick or a piece of one. ``brick`` is the number of the brick that it belongs to, ``course`` and
#: ``column`` are its place in half units, ``low`` and ``high`` are opposite corners [m].
Block = namedtuple("Block", "brick course column low high")


def problems(courses, halfUnits, unit):
    """What is wrong with the parameters of :func:`runningBond`: a list of sentences."""
    found = []
    whole = all(isinstance(n, numbers.Integral) for n in (courses, halfUnits))
    if not whole or courses < 1 or halfUnits < 2 or halfUnits % 2:
        found.append(
            "running bond needs at least 1 course and an even number of half units >= 2, "
            f"got {courses} and {halfUnits}"
        )
    try:
        fine = len(unit) == 3 and all(0 < side < math.inf for side in unit)
    except TypeError:
        fine = False
    if not fine:
        found.append(
            f"unit must be a length, thickness and height above 0 m, got {unit}"
        )
    return found


def runningBond(courses, halfUnits, unit=(0.220, 0.102, 0.081), halves=True):
    """Blocks of a running-bond wall in the x-z plane, its lower left front corner at the origin.

    Even courses start with a whole unit, odd ones with a half.

    :param courses: number of courses
    :param halfUnits: length of the wall in half units; even
    :param unit: length, thickness and height of a unit, joints included [m]
    :param halves: whether every unit is two half bricks that may crack apart; else units are whole
    """
    wrong = problems(courses, halfUnits, unit)
    if wrong:
        raise ValueError("; ".join(wrong))
    half, thickness, height = unit[0] / 2, unit[1], unit[2]
    blocks, brick = [], -1
    for course in range(courses):
        starts = [c for c in range(halfUnits) if c == 0 or c % 2 == course % 2] + [
            halfUnits
        ]
        for first, beyond in zip(starts, starts[1:]):
            brick += 1
            pieces = (
                [(c, c + 1) for c in range(first, beyond)]
                if halves
                else [(first, beyond)]
            )
            for a, b in pieces:
                low = (a * half, 0.0, course * height)
                high = (b * half, thickness, (course + 1) * height)
                blocks.append(Block(brick, course, a, low, high))
    return blocks


def corners(low, high):
    """The eight corners of an axis-parallel box."""
    return [
        (x, y, z)
        for x in (low[0], high[0])
        for y in (low[1], high[1])
        for z in (low[2], high[2])
    ]
