# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a curve of force over displacement."""

import math
from typing import Any, Callable

import numpy as np

from ..arguments import Numbers
from . import loops

#: Energy that joints dissipate before it counts as a crack, over the elastic energy [-]. Bonded
#: mortar dissipates nothing before the first crack; dry joints slip a little from the first row on.
CRACKED = 1e-5
SUDDEN = 0.1  # stretch of the push for :func:`suddenLoss` [mm]
#: Of a measured force, before a wall carries more than its vertical load can give [-].
TOLERANCE = 0.02
SHEAR = 2 / 3  # weight of the base of a bar in shear for :func:`quasiStatic` [-]


def dynamicImbalance(top: Numbers, base: Numbers) -> float:
    """RMS of (top - base shear) over the largest of either [-]: the larger of the values from half
    the peak at the base to that peak, and from there to the end; of all rows if this peak is less
    than half of the largest force. Near 0 in a quasi-static test. Inertia makes the difference
    swing about zero, and damping makes it drag."""
    differences, forces = np.subtract(top, base), np.abs(base)
    largest = max(np.abs(top).max(initial=0), forces.max(initial=0))
    if not largest:
        return 0.0
    peak, parts = int(forces.argmax()), [differences]
    if forces[peak] >= largest / 2:
        start = int((forces >= forces[peak] / 2).argmax())
        parts = [differences[start : peak + 1], differences[peak:]]
    return float(max(np.sqrt(np.mean(part**2)) for part in parts) / largest)


def quasiStatic(top: Numbers, base: Numbers, weight: float = SHEAR) -> list[float]:
    """The shear force V_s of a push in every row, without the first-order inertia of the structure.

    Masses m that follow the displacement u of the driven point by the static shape φ, which is 1
    there, hold back Σ m φ² ü at the driven point, and Σ m φ ü in all. So top - V_s = Σ m φ² ü,
    top - base = Σ m φ ü, and V_s = (1 - w) top + w base with w = Σ m φ² / Σ m φ.

    :param weight: w [-]. That of a bar in shear is 2/3, which gives (top + 2 base)/3; of a bar that
        bends 0.63 if it is free to turn at its driven end, and 0.74 if it is not
    """
    return [(1 - weight) * t + weight * b for t, b in zip(top, base)]


def stiffness(
    displacement: Numbers, force: Numbers, ramp: int = 0, turn: int | None = None
) -> float:
    """Initial stiffness of a push [force/displacement]: the line through its beginning that fits
    its first part best.

    The first part begins where the velocity of the drive has grown, because before that a wave
    passes through the structure. It ends at the first row with a quarter of the largest force and
    twice the displacement of its beginning, because weaker waves go on; in a structure that cracks
    early at the first row with a third of the largest force and 1.1 times that displacement.

    :param force: of :func:`quasiStatic`; its first value is subtracted if it is more than a
        hundredth of the peak, as of a drive that held a weight before
    :param ramp: number of the row at which the velocity of the drive has grown
    :param turn: number of the row at which the drive turns first, where the first part ends at the
        latest; None: it does not
    """
    if not force:
        return 0.0
    before = force[0] if abs(force[0]) > 0.01 * max(force) else 0.0
    ramp = min(max(ramp, 1), len(force) - 1)
    peak, grown = max(force) - before, displacement[ramp] - displacement[0]
    work = squares = 0.0
    end = None if turn is None else max(turn, ramp) + 1
    for u, f in zip(displacement[ramp:end], force[ramp:end]):
        u, f = u - displacement[0], f - before
        work, squares = work + u * f, squares + u * u
        if (f > 0.25 * peak and u >= 2 * grown) or (f > peak / 3 and u >= 1.1 * grown):
            break
    return work / squares if squares else 0.0


def suddenLoss(displacement: Numbers, top: Numbers, base: Numbers) -> tuple[float, float]:
    """The largest fall of the force of a push within :data:`SUDDEN`, over its peak [-], and the
    displacement at which it begins. The force is the mean of both ends, which leaves out waves that
    pass through."""
    force = [0.5 * (t + b) for t, b in zip(top, base)]
    peak, beyond, found = max(force, default=0.0), 0, (0.0, 0.0)
    for n, moved in enumerate(displacement):
        while beyond + 1 < len(force) and displacement[beyond + 1] <= moved + SUDDEN:
            beyond += 1
        if beyond > n and peak > 0:
            found = max(found, ((force[n] - force[beyond]) / peak, moved))
    return found


def fallen(displacement: Any, force: Any, at: int, level: float, pulse: float) -> float | None:
    """Where the force falls below a level after the row ``at`` and stays below for longer than a
    pulse, a displacement: a row number with a fraction, or None. A fall within a pulse before the
    end may be a wave and does not count. Without pulses the first fall counts.

    :param displacement: that does not go back, and ``force``: arrays
    """
    below = (np.arange(len(force)) >= at) & (force < level)
    changes = np.flatnonzero(np.diff(below, prepend=False, append=False))
    for first, back in changes.reshape(-1, 2):
        last, place = min(back, len(force) - 1), float(first)
        if first and force[first] != force[first - 1]:
            place += (level - force[first]) / (force[first] - force[first - 1])
        down = np.interp(place, np.arange(len(force)), displacement)
        if pulse == 0 or displacement[last] - down > pulse:
            return float(place)
    return None


def rocking(normal: float, length: float, arm: float) -> float:
    """The largest shear force of a wall without tension, N L/(2 H0), in the unit of N.

    :param normal: vertical force N on its base
    :param length: L [m]
    :param arm: height H0 of zero moment above the base [m]
    """
    return normal * length / (2 * arm)


def stillGrows(displacement: Numbers, force: Numbers) -> bool:
    """Whether the force of a push is largest at its end, and grows over the last tenth of the
    displacement with more than a twentieth of its initial stiffness: nothing has given way yet."""
    if len(force) < 10 or max(force) > max(force[-3:]) + 1e-3 * abs(max(force)):
        return False
    start = displacement[-1] - 0.1 * (displacement[-1] - displacement[0])
    at = next(n for n, d in enumerate(displacement) if d >= start)
    path = displacement[-1] - displacement[at]
    slope = (force[-1] - force[at]) / path if path > 0 else 0.0
    return slope > 0.05 * initialStiffness(displacement, force)


def initialStiffness(displacement: Numbers, force: Numbers) -> float:
    """Slope [force/displacement] of the line fitted between 5 % and 25 % of the peak, on the way to
    it; a first force of more than a hundredth of the peak is subtracted, as in :func:`stiffness`.
    """
    moved, forces = np.asarray(displacement, float), np.asarray(force, float)
    if not len(forces):
        return 0.0
    if abs(forces[0]) > 0.01 * forces.max():
        forces = forces - forces[0]
    end = int(np.argmax(np.append(forces > 0.25 * forces.max(), True)))
    rows = np.flatnonzero(forces[:end] > 0.05 * forces.max())
    if len(rows) < 2:  # to the first row with another displacement
        rows = np.append(0, np.flatnonzero(moved != moved[0])[:1])
    away = moved[rows] - moved[rows].mean()
    spread = away @ away
    return float(away @ forces[rows] / spread) if spread > 0 else 0.0


def firstCrack(column: Callable[[str], Numbers], rows: slice = slice(None)) -> int | None:
    """The row of the first crack of a push, or None: the first at which the joints have dissipated,
    in tension and shear since its first row, more than CRACKED of the elastic energy of joints and
    units. Of dry joints it is the first slip that counts.

    :param column: gives the values of a column of curve.csv by its name
    :param rows: of the push
    """
    of = lambda *names: np.array([column(f"{n}_J")[rows] for n in names]).sum(axis=0)
    lost = of("dissipated_tension", "dissipated_shear")
    parts = "tension", "shear", "compression", "units"
    elastic = of(*(f"elastic_{part}" for part in parts))
    cracked = np.flatnonzero(lost - lost[:1] > CRACKED * elastic)
    return int(cracked[0]) + (rows.start or 0) if len(cracked) else None


def cycleNumbers(column: Callable[[str], Numbers], threshold: float) -> list[dict[str, Any]]:
    """Numbers of every cycle of a wall that follows a history: a list of dicts, for run.json.

    They are those of :class:`masonry.numbers.loops.Cycle` with the base shear as the force, None in
    place of NaN, and ``rows``, the first and the last row of curve.csv from 0, in place of
    ``start`` and ``end``. Beside them there are, of the same stretch [J]: ``top_work_J``, the work
    of the drive; ``dissipated_J``, by joints; and ``damped_J``, by damping.

    :param column: gives the values of a column of curve.csv by its name
    :param threshold: as in :mod:`masonry.numbers.loops` [mm]
    """
    moved, base = column("displacement_mm"), column("base_shear_kN")
    if not moved:
        return []
    top, damping = column("top_shear_kN"), column("damping_J")
    modes = (column(f"dissipated_{m}_J") for m in ("tension", "shear", "compression"))
    dissipated = [sum(values) for values in zip(*modes)]
    found = []
    for cycle in loops.cycles(moved, base, threshold):
        start, end = cycle.start, cycle.end
        ends = lambda values: loops.stretch(values, start, end)[[0, -1]]
        one: dict[str, Any] = {"rows": [math.ceil(start), math.floor(end)]}
        for name, value in zip(cycle._fields[2:], cycle[2:]):
            one[name] = None if math.isnan(value) else value
        one["top_work_J"] = loops.work(moved, top, start, end)
        one["dissipated_J"] = float(ends(dissipated) @ [-1, 1])
        one["damped_J"] = float(ends(damping) @ [-1, 1])
        found.append(one)
    return found


def dampedShare(grown: Callable[[str], float]) -> float:
    """Share of damping in what joints and damping have taken [-].

    :param grown: gives how much a column of curve.csv has grown by its name
    """
    damped = max(0.0, grown("damping_J"))
    lost = sum(grown(f"dissipated_{m}_J") for m in ("tension", "shear", "compression"))
    return damped / (damped + lost) if damped + lost > 0 else 0.0
