# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows, force, peak, drift and states of a push, from which the numbers of a run are found."""

import functools
import math
from typing import Any, Callable, Sequence

import numpy as np

from ..arguments import FilePath
from ..errors import Refused
from . import cracks, curves, loops
from .files import readCurve, readRun

LOST = 0.05  # of the peak: a smaller loss may be the scatter by single bricks at the toe
FALL = 0.8  # of the peak: the force at the ultimate displacement of a wall
MOVED, BASE, TOP = "displacement_mm", "base_shear_kN", "top_shear_kN"
MASONRY = "masonry_displacement_mm"  # of the bricks at the pushed platen
DRIFT = "drift_percent"  # this over their height


class RunData:
    """A run from which its numbers are found.

    :param run: entries of run.json, at least those that are none of these numbers
    :param column: gives the values of a column of curve.csv by its name, None if there is none
    :param joints: frame of the joints at the end, as in :mod:`masonry.numbers.cracks`; None: crack
        patterns are not measured
    :param height: of the recorded point above the base [m], in place of what run.json says
    """

    def __init__(self, run, column, joints=None, height=None):
        self.run, self.column, self.joints, self._height = run, column, joints, height

    @classmethod
    def read(cls, directory: FilePath, moved: str | None = None) -> "RunData":
        """The run of a folder of results. Raises Refused.

        :param moved: column of curve.csv whose displacements are those of the push, from where it
            began; None: those of the pushed point
        """
        curve = readCurve(directory)
        data = cls(readRun(directory), curve.get)
        if moved is None or not data.isPush:
            return data
        pushed = data._pushed[-1][0][1]
        upright = "vertical_mm", *(("_z_mm",) if not pushed.endswith("z") else ())
        fits = lambda name: name.endswith("_mm") and not name.endswith(upright)
        if moved not in curve or not fits(moved):
            names = ", ".join(filter(fits, curve))
            raise Refused(
                f"{directory}: column {moved!r} must be a displacement of curve.csv along the push:"
                f" {names}"
            )
        values, usual = (
            np.array(curve[name]) - curve[name][data.rows[0]] for name in (moved, MOVED)
        )
        along = math.copysign(1, values[data.rows] @ usual[data.rows])
        unknown = {"drift_height_m": None, "recorded_height_m": None}  # of that point
        columns: dict[str, Any] = {**curve, MOVED: along * values, MASONRY: None}
        return cls({**data.run, **unknown}, columns.get)

    @functools.cached_property
    def _stages(self):
        """The load of every stage, its first row and the row after its last, and whether it is a
        push that goes on with the curve of the one before."""
        found = self.run.get("stages") or []
        columns = (self.column(name) for name in (MOVED, "time_s"))
        count = len(next((values for values in columns if values is not None), ()))
        ends = [*(one["first_row"] for one in found[1:]), count]
        of = lambda one, end: (one.get("load"), one["first_row"], end, one.get("continued"))
        return [*map(of, found, ends)]

    @functools.cached_property
    def pushes(self) -> list[tuple[int, int]]:
        """The first row and the row after the last of the last push, and of those before it with
        whose curve it goes on."""
        found: list[tuple[int, int]] = []
        for load, first, end, continued in reversed(self._pushed):
            if found and load != self._pushed[-1][0]:
                break
            found.insert(0, (first, end))
            if not continued:
                break
        return found

    @functools.cached_property
    def _pushed(self):
        """The stages that are pushes, as in ``_stages``."""
        return [one for one in self._stages if one[0] and one[0][0] == "push"]

    @functools.cached_property
    def rows(self) -> list[int]:
        """Numbers of the rows of :attr:`pushes`, from 0."""
        return [n for push in self.pushes for n in range(*push)]

    @property
    def parts(self) -> list[list[int]]:
        """The rows of each of :attr:`pushes`, as places in :attr:`rows`."""
        places = range(len(self.rows))
        parts = ([n for n in places if a <= self.rows[n] < b] for a, b in self.pushes)
        return [part for part in parts if part]

    def ofParts(self, *names: str) -> list[list[np.ndarray]]:
        """Columns in the rows of each of :attr:`pushes`. Raises KeyError as ``data[name]``."""
        columns = [np.array(self[name]) for name in names]
        return [[values[part] for values in columns] for part in self.parts]

    def grown(self, name: str) -> float:
        """How much a column has grown in :attr:`pushes`."""
        return sum(float(values[-1] - values[0]) for values, in self.ofParts(name))

    def whole(self, name: str) -> Any:
        """A column in all rows. Raises KeyError if curve.csv does not have it."""
        values = self.column(name)
        if values is None:
            raise KeyError(name)
        return values

    def __getitem__(self, name: str) -> list[float]:
        """A column in the rows of the push. Raises KeyError if curve.csv does not have it."""
        values = self.whole(name)
        return [values[n] for n in self.rows]

    @property
    def isPush(self) -> bool:
        """Whether the run has a push with rows."""
        return bool(self.rows)

    @property
    def isLooped(self) -> bool:
        """Whether the push goes there and back."""
        return "history" in self.run

    def carried(self, side: int = 1) -> np.ndarray:
        """The force of the push that both ends carry at once [kN], in every row the smaller one
        along the side. A wave that passes through is felt at one end.

        :param side: 1, or -1 for the way back
        """
        return side * np.minimum(side * np.array(self[BASE]), side * np.array(self[TOP]))

    def peak(self, side: int = 1) -> int:
        """The row of the push where this force is largest; in loops on its side of the
        displacement."""
        towards = side * self.carried(side)
        if self.isLooped:
            towards = np.where(side * np.array(self[MOVED]) >= 0, towards, -math.inf)
        return int(towards.argmax())

    def peakForce(self, side: int = 1) -> float:
        """[kN]"""
        return float(self.carried(side)[self.peak(side)])

    @property
    def pulse(self) -> float:
        """Displacement of the drive within the first period [mm]; 0 if that is not known."""
        period, times = self.run.get("first_period_s"), self.column("time_s")
        if not period or times is None or len(self.rows) < 2:
            return 0.0
        parts = self.ofParts(MOVED, "time_s")
        moved, lasted = (sum(map(np.ptp, values)) for values in zip(*parts))
        slower = self.run.get("options", {}).get("density_scaling", 1) ** 0.5  # in the scene
        return float(slower * period * moved / lasted) if lasted > 0 else 0.0

    @property
    def height(self) -> float | None:
        """Height over which displacements of the push are drifts [m]; None if it is unknown or the
        push not horizontal."""
        known = [self._height, self.run.get("drift_height_m"), self.run.get("recorded_height_m")]
        return next((h for h in known if isinstance(h, (int, float)) and 0 < h < math.inf), None)

    @functools.cached_property
    def ofDrift(self) -> list[float]:
        """The displacements that are drifts over :attr:`height` [mm]: of the masonry at the platen,
        without the slip of that; of the pushed point without a platen, or with another height."""
        own = self.column(MASONRY)
        return self[MOVED] if own is None or self._height else self[MASONRY]

    def at(self, values: Sequence[float], place: float | None) -> float | None:
        """A value between rows, linear; ``place``: a row number with a fraction, or None."""
        rows = np.arange(len(values))
        return None if place is None else float(np.interp(place, rows, values))

    def place(self, find: Callable[..., float | None]) -> float | None:
        """Where a function finds a state in the rows of the push; None if the state is not reached
        or curve.csv does not have its columns."""
        try:
            return find(self) if self.rows else None
        except LookupError:
            return None

    def drift(self, place: float | None) -> float | None:
        """The drift at a place in the rows of the push [mrad]."""
        moved = self.at(self.ofDrift, place)
        return moved / self.height if moved is not None and self.height else None

    @functools.cached_property
    def firstCrack(self) -> int | None:
        """Where the first crack of the push is seen."""
        found = (curves.firstCrack(self.whole, slice(*push)) for push in self.pushes)
        return next((self.rows.index(row) for row in found if row is not None), None)

    def fallenTo(self, share: float) -> float | None:
        """Where the force has fallen to a share of its peak; in loops on the envelope of the
        positive side."""
        moved, force = np.array(self[MOVED]), self.carried(1)
        rows = self._outwards(1)
        if not len(rows) or force[rows].max() <= 0:
            return None
        force, at = force[rows], int(force[rows].argmax())
        pulse = 0.0 if self.isLooped else self.pulse
        place = curves.fallen(
            np.maximum.accumulate(moved[rows]), force, at, share * force[at], pulse
        )
        return None if place is None else float(np.interp(place, np.arange(len(rows)), rows))

    def _outwards(self, side):
        """The rows of the envelope of a side; of one push in one direction all."""
        moved = np.array(self[MOVED])
        if self.isLooped:
            return loops.envelope(moved)[0 if side > 0 else 1]
        farther = moved >= np.maximum.accumulate(moved)
        return np.flatnonzero(farther) if len(self.parts) > 1 else np.arange(len(moved))

    @functools.cached_property
    def collapse(self) -> int | None:
        """The last row, if the push ended in a collapse."""
        load = self._stages[-1][0] if self._stages else None
        fell = self.run.get("collapsed") and load and load[0] == "push"
        return len(self.rows) - 1 if fell else None

    @functools.cached_property
    def sudden(self) -> tuple[float, float]:
        """The largest sudden loss of the pushes (:func:`masonry.numbers.curves.suddenLoss`)."""
        return max(curves.suddenLoss(*columns) for columns in self.ofParts(MOVED, TOP, BASE))

    @property
    def isOfControl(self) -> bool:
        """Whether the recorded displacement is that of a control, on which the force does no
        work."""
        return bool(self._pushed) and len(self._pushed[-1][0]) > 3

    def work(self, workOf: Callable[[Any, Any], float]) -> float:
        """A work of the base shear over the displacements of the pushes, in sum [J]. Raises
        LookupError if these are of a control.

        :param workOf: function of displacements [mm] and forces [kN] of a push
        """
        if self.isOfControl:
            raise LookupError("the force of the push works on other displacements")
        return sum(workOf(*columns) for columns in self.ofParts(MOVED, BASE))

    @functools.cached_property
    def stillGrows(self) -> bool:
        """Whether nothing has given way at the end of the push."""
        return not self.isLooped and curves.stillGrows(self[MOVED], self[BASE])

    @functools.cached_property
    def stiffness(self) -> float:
        """Initial stiffness (:func:`masonry.numbers.curves.stiffness`) of the force without the
        inertia of the structure."""
        grown = self.run.get("velocity_grown_at_s") or 0.0
        ramp = next((n for n, time in enumerate(self["time_s"]) if time >= grown), 0)
        weight = self.run.get("base_weight") or curves.SHEAR
        force, turn = curves.quasiStatic(self[TOP], self[BASE], weight), None
        if self.isLooped:
            turns = loops.turningPoints(self[MOVED], self.run["history"]["noise_mm"])
            turn = next((int(row) for row in turns if row), None)
        return curves.stiffness(self[MOVED], force, ramp, turn)

    def dropped(self, side: int = 1) -> tuple[float, float | None]:
        """Share of the peak that is lost at the end, and the first displacement after the peak with
        less than 0.95 of it [mm] or None; in loops along the envelope of a side, positive
        outwards."""
        rows = self._outwards(side)
        moved, force = side * np.array(self[MOVED])[rows], side * self.carried(side)[rows]
        if not len(force) or not force.max() > 0:
            raise LookupError("the force is never to this side")
        at = int(force.argmax())
        after = np.flatnonzero(force[at:] < (1 - LOST) * force[at])
        return 1 - float(force[-1] / force[at]), float(moved[at + after[0]]) if len(after) else None

    @functools.cached_property
    def cycles(self) -> list[dict[str, Any]]:
        """See :func:`masonry.numbers.curves.cycleNumbers`; with rows of curve.csv."""
        found = curves.cycleNumbers(self.__getitem__, self.run["history"]["noise_mm"])
        for one in found:
            one["rows"] = [self.rows[n] for n in one["rows"]]
            if self.isOfControl:
                one.update(work_J=None, top_work_J=None, damping=None)
        return found

    @functools.cached_property
    def pattern(self) -> dict[str, Any]:
        """Numbers of the crack pattern of a wall, and how it failed."""
        found = cracks.pattern(self.joints, self.run["wall"], self.isLooped)
        lost = self.dropped()[0] > LOST
        mode = cracks.failureMode(found, self.run["wall"], self.stillGrows, lost)
        return {**found, "failure_mode": mode}
