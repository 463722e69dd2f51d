# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic response spectra: those of EN 1998-1:2004, and any that a file has."""

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from masonry.arguments import FilePath, Numbers, listOf, number, oneOf, validated, whole
from masonry.units import ACCELERATION_UNITS, GRAVITY
from masonry.errors import Refused
from masonry.texts import TextFile

#: Units of accelerations in m/s², those with a raised 2 also as a keyboard writes them.
UNITS = {
    **ACCELERATION_UNITS,
    "m/s2": ACCELERATION_UNITS["m/s²"],
    "cm/s2": ACCELERATION_UNITS["cm/s²"],
}
#: EN 1998-1:2004, tables 3.2 (type 1) and 3.3 (type 2): S [-], TB, TC and TD [s] by the ground
#: type. These are the recommended values; a National Annex may have others.
PARAMETERS: dict[int, dict[str, tuple[float, float, float, float]]] = {
    1: {
        "A": (1.0, 0.15, 0.4, 2.0),
        "B": (1.2, 0.15, 0.5, 2.0),
        "C": (1.15, 0.20, 0.6, 2.0),
        "D": (1.35, 0.20, 0.8, 2.0),
        "E": (1.4, 0.15, 0.5, 2.0),
    },
    2: {
        "A": (1.0, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.5, 0.10, 0.25, 1.2),
        "D": (1.8, 0.10, 0.30, 1.2),
        "E": (1.6, 0.05, 0.25, 1.2),
    },
}
#: The longest period of the spectrum of EN 1998-1:2004, 3.2.2.2 [s], and the least damping
#: correction, equation (3.6) [-].
LONGEST, LEAST_CORRECTION = 4.0, 0.55


@dataclass(frozen=True)
class Spectrum:
    """An elastic response spectrum of a horizontal acceleration."""

    name: str  #: for figures and reports
    source: str  #: where it comes from
    periods: np.ndarray  #: [s], corners and enough points between them, for figures
    accelerations: np.ndarray  #: at these periods [m/s²]
    corner: float  #: TC, upper limit of the periods with constant acceleration [s]
    longest: float  #: longest period [s]
    #: function of a period that gives the acceleration; None: lines between the points
    formula: Any = None

    def acceleration(self, period: float) -> float:
        """Se at a period [m/s²].

        :param period: [s]
        :raises Refused: if the spectrum does not have this period
        """
        first = float(self.periods[0])
        if not first <= period <= self.longest:
            raise Refused(
                f"the spectrum ({self.name}) has no period of {period:.4g} s: it goes from"
                f" {first:g} to {self.longest:g} s"
            )
        if self.formula:
            return float(self.formula(period))
        return float(np.interp(period, self.periods, self.accelerations))

    def displacement(self, period: float) -> float:
        """Se (T/2π)² at a period [mm], EN 1998-1:2004, equation (3.7). Parameters as in
        :meth:`acceleration`."""
        return 1e3 * self.acceleration(period) * (period / (2 * math.pi)) ** 2


@validated
def elastic(
    ag: Annotated[float, number("", 0, 10000, above=True)],
    unit: Annotated[str, oneOf(*UNITS)],
    type: Annotated[int, whole(1, 2)],
    ground: Annotated[str, oneOf(*"ABCDE")],
    importance: Annotated[float, number("-", 0.1, 10)] = 1.0,
    damping: Annotated[float, number("%", 0, 100, above=True)] = 5.0,
    parameters: Annotated[Numbers, listOf(number())] | None = None,
) -> Spectrum:
    """The horizontal elastic response spectrum of EN 1998-1:2004, 3.2.2.2, equations (3.2) to
    (3.5).

    :param ag: agR, the reference peak ground acceleration on ground of type A, in ``unit``
    :param unit: ``"g"``, ``"m/s²"`` or ``"cm/s²"``
    :param type: 1, or 2 where earthquakes of a surface-wave magnitude above 5.5 do not count,
        3.2.2.2(2)
    :param ground: ground type ``"A"`` to ``"E"``, table 3.1
    :param importance: importance factor by which agR is multiplied, 4.2.5; 1.0 is that of ordinary
        buildings, class II [-]
    :param damping: viscous damping, of which equation (3.6) makes the correction η [%]; 5 % is that
        of the spectrum itself
    :param parameters: S [-], TB, TC and TD [s] of a National Annex; None: the recommended values of
        tables 3.2 and 3.3
    :raises Refused: if something is out of its bounds
    """
    four = PARAMETERS[type][ground] if parameters is None else tuple(parameters)
    if len(four) != 4 or not (0 < four[0] < 10 and 0 < four[1] <= four[2] <= four[3] <= LONGEST):
        raise Refused(
            f"elastic: parameters {four} must be S [-], TB, TC and TD [s], with 0 < S < 10 and 0 <"
            f" TB <= TC <= TD <= {LONGEST:g} s"
        )
    soil, tb, tc, td = four
    correction = max(math.sqrt(10 / (5 + damping)), LEAST_CORRECTION)
    peak = ag * UNITS[unit] * importance
    if peak > 3 * GRAVITY:
        raise Refused(
            f"elastic: a ground acceleration of {peak:.4g} m/s² is more than 3 g: is ag"
            f" {ag:g} {unit} in another unit?"
        )
    plateau = 2.5 * correction

    def formula(period):
        if period <= tb:
            return peak * soil * (1 + period / tb * (plateau - 1))
        if period <= tc:
            return peak * soil * plateau
        if period <= td:
            return peak * soil * plateau * tc / period
        return peak * soil * plateau * tc * td / period**2

    periods = np.unique([0.0, tb, tc, td, *np.linspace(0, LONGEST, 801)])
    where = "recommended values" if parameters is None else "given values"
    return Spectrum(
        name=(
            f"EN 1998-1 type {type}, ground {ground}, agR {ag:g} {unit}, importance {importance:g},"
            f" damping {damping:g} %"
        ),
        source=f"EN 1998-1:2004, 3.2.2.2, {where} of S, TB, TC and TD",
        periods=periods,
        accelerations=np.array([formula(period) for period in periods]),
        corner=tc,
        longest=LONGEST,
        formula=formula,
    )


@validated
def readSpectrum(
    path: FilePath,
    unit: Annotated[str, oneOf(*UNITS)],
    corner: Annotated[float, number("s", 0, 1000, above=True)] | None = None,
) -> Spectrum:
    """A spectrum from a file of two columns, period [s] and acceleration, between whose rows it is
    interpolated.

    Columns, comments and heads are as in :mod:`masonry.texts`.

    :param unit: of the accelerations: ``"g"``, ``"m/s²"`` or ``"cm/s²"``
    :param corner: TC, the upper limit of the periods with constant acceleration, which the target
        displacement needs [s]
    :raises Refused: if the file cannot be read, is no such table, or if the corner is missing
    """
    file = TextFile(path)
    rows: list[list[float]] = []
    for row in file.table(columns=2).rows:
        cells = [cell for cell in row.cells if cell]
        found = [file.number(cell, row.line) for cell in cells]
        if len(found) != 2 or min(found) < 0:
            raise file.refused(
                "it must have a period [s] and an acceleration, neither below zero, has"
                f" {' '.join(cells)[:60]!r}",
                row.line,
            )
        if rows and found[0] <= rows[-1][0]:
            raise file.refused(
                f"periods must grow, {found[0]:g} s comes after {rows[-1][0]:g} s", row.line
            )
        rows.append(found)
    if len(rows) < 2:
        raise Refused(f"{path}: there must be two rows at least")
    periods, accelerations = np.array(rows).T * [[1], [UNITS[unit]]]
    if not 0 < accelerations.max() < 100 * GRAVITY:
        raise Refused(
            f"{path}: the largest acceleration is {accelerations.max():.4g} m/s², which must be"
            f" above 0 and below 100 g: is the unit {unit!r}?"
        )
    if corner is None:
        raise Refused(
            f"{path}: a file does not say where the constant accelerations end: give TC in s,"
            " corner= in Python or --corner"
        )
    if not periods[0] < corner <= periods[-1]:
        raise Refused(
            f"{path}: the corner, {corner:g} s, must be within the periods, {periods[0]:g} to"
            f" {periods[-1]:g} s"
        )
    return Spectrum(
        name=str(path),
        source=f"the file {path}, accelerations in {unit}",
        periods=periods,
        accelerations=accelerations,
        corner=corner,
        longest=float(periods[-1]),
    )
