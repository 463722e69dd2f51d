"""Numbers of a curve of force over displacement. This module needs no YADE."""

import math


def dynamicImbalance(top, base):
    """How much of the force of a push does not arrive at its base [-]: 0 if all does, 1 and more if none does.

    It is the root mean square of top less base shear over the largest of either, from half the peak at the base to that
    peak. If this peak is less than half of the largest force, all rows count. Inertia makes the difference swing about
    zero, and damping makes it drag.
    """
    forces = [abs(b) for b in base]
    largest = max([*map(abs, top), *forces], default=0)
    if not largest:
        return 0.0
    peak, rows = max(forces), slice(None)
    if peak >= largest / 2:
        start = next(i for i, f in enumerate(forces) if f >= peak / 2)
        rows = slice(start, forces.index(peak) + 1)
    squares = [(t - b) ** 2 for t, b in zip(top[rows], base[rows])]
    return math.sqrt(sum(squares) / len(squares)) / largest


def initialStiffness(displacement, force):
    """Slope [force/displacement] of the line fitted between 5 % and 25 % of the peak, on the way to it."""
    if not force:
        return 0.0
    peak = max(force)
    points = []
    for d, f in zip(displacement, force):
        if f > 0.25 * peak:
            break
        if f > 0.05 * peak:
            points.append((d, f))
    if len(points) < 2:
        points = list(zip(displacement, force))[:2]
    n = len(points)
    meanD, meanF = sum(p[0] for p in points) / n, sum(p[1] for p in points) / n
    spread = sum((d - meanD) ** 2 for d, _ in points)
    products = sum((d - meanD) * (f - meanF) for d, f in points)
    return products / spread if spread > 0 else 0.0
