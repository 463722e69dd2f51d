# SPDX-License-Identifier: GPL-2.0-or-later
"""Incremental dynamic analysis: a scene is shaken by records that grow in strength. Here is what is
run; what is found is in :mod:`masonry_study.demands`.

Rows are in the order of the records, those of a record with growing levels. Those above the level
at which the structure falls are not run but ``above collapse``. The rows that are done tell which
these are, so it does not matter who ran which row, nor in which order.
"""

import glob
import hashlib
import itertools
import math
import os
import re
from dataclasses import dataclass
from typing import Any, Iterable, Sequence

from masonry import arguments
from masonry.arguments import FilePath, listOf, number, shown, validated
from masonry.units import GRAVITY
from masonry.errors import Refused, refuse
from masonry.scene import accelerograms
from masonry.scene.ground import UNITS, isThree, readRecord, record
from .spectrum import DAMPING, LONGEST, Period, Ratio, SHORTEST
from .spectrum import spectralAcceleration

FOLDER = "records"  # in the folder of a study: the records as it read them
MAX_RECORDS = 1000
LEVEL = number("", 0, 1000, above=True)


@dataclass(frozen=True)
class Measure:
    """A measure of the intensity of a record: the peak ground acceleration, or a spectral
    acceleration, both in g.

    :param period: of the oscillator [s]; None: peak ground acceleration
    :param damping: of the oscillator, a share of critical damping [-]
    """

    period: float | None = None
    damping: float = DAMPING

    @property
    def name(self) -> str:
        if self.period is None:
            return "PGA_g"
        ratio = "" if self.damping == DAMPING else f"_{100 * self.damping:g}%"
        return f"Sa_{self.period:g}s{ratio}_g"

    def of(self, values: Sequence[Any], every: float) -> float:
        """The measure of a record [g]; of three components the geometric mean of both horizontal
        ones."""
        parts = accelerograms.components(values).tolist()
        if len(parts) == 3:
            return math.sqrt(self.of(parts[0], every) * self.of(parts[1], every))
        if self.period is None:
            return max(abs(a) for a in values) / GRAVITY
        found = spectralAcceleration(values, every, self.period, self.damping) / GRAVITY
        # the exponential function of another machine may differ in its last digit, and rows must
        # not
        return float(f"{found:.12g}")


@validated
def Sa(period: Period, damping: Ratio = DAMPING) -> Measure:
    """Spectral acceleration as the measure of intensity. Parameters and errors as in
    :func:`masonry_study.spectrum.spectralAcceleration`."""
    return Measure(float(period), float(damping))


@dataclass(frozen=True)
class Motion:
    """A record that a study has read.

    :param name: its name in the study
    :param values: samples [m/s²]; ``every``: the time between two of them [s]
    :param intensity: the measure of the study [g]
    """

    name: str
    values: list[Any]
    every: float
    intensity: float

    @property
    def text(self) -> str:
        return accelerograms.written(self.values, self.every, self.name)

    @property
    def entry(self) -> dict[str, Any]:
        digest = hashlib.sha256(self.text.encode()).hexdigest()
        return {"name": self.name, "sha256": digest, "intensity": self.intensity}


class Incremental:
    """The records of a study, and how strong they are. Parameters are those of
    :class:`masonry_study.plan.Study`; problems are appended to a list."""

    def __init__(
        self,
        records: Any,
        levels: Any,
        scales: Any,
        measure: Any,
        unit: Any,
        every: Any,
        problems: list[str],
    ) -> None:
        self.levels, self.scales = levels, scales
        self.measure = Measure() if measure in (None, "PGA") else measure
        self.unit, self.every = unit, every
        self._motions: list[Motion] | None = None
        problems += self._take(records)

    def _take(self, records):
        """Take the files and their strengths. Yields what is wrong with all of it."""
        if isinstance(records, (str, os.PathLike)):
            records = [records]
        if not isinstance(records, (list, tuple)) or not records:
            yield "records: must be a list of files"
            records = []
        try:
            self.files = [record(one) if isThree(one) else arguments.path(one) for one in records]
        except ValueError as error:
            yield f"records: {error}"
        if not isinstance(self.measure, Measure):
            yield (
                f'measure {shown(self.measure)} must be "PGA" or Sa(period), a spectral'
                f" acceleration, with a period from {SHORTEST:g} to {LONGEST:g} s"
            )
        if self.unit not in (None, *UNITS):
            yield f"unit {shown(self.unit)} must be one of {', '.join(UNITS)}"
        if (self.levels is None) == (self.scales is None):
            yield "give either levels, in g of the measure, or scales, factors on the records"
            return
        name = "levels" if self.scales is None else "scales"
        try:
            strengths = listOf(LEVEL)(getattr(self, name))
        except ValueError as error:
            yield f"{name}: {error}"
            return
        if any(b <= a for a, b in zip(strengths, strengths[1:])):
            yield f"{name}: {shown(list(strengths))} must grow"
        setattr(self, name, [float(s) for s in strengths])

    @property
    def steps(self) -> int:
        return len(self.levels if self.scales is None else self.scales)

    def read(self, near: FilePath) -> list[Motion]:
        """The records, read by the first call. Raises Refused with all problems.

        :param near: folder from which paths that are not absolute begin
        """
        if self._motions is None:
            problems: list[str] = []
            motions: list[Motion] = []
            for path in self._paths(near, problems):
                try:
                    motions.append(self._motion(path, motions))
                except Refused as refused:
                    problems.append(str(refused))
            if len(motions) > MAX_RECORDS:
                problems.append(f"records: {len(motions)}, there must be at most {MAX_RECORDS}")
            refuse(problems, "study: ", "\n  ")
            self._motions = motions
        return self._motions

    def _paths(self, near, problems):
        found = []
        for pattern in self.files:
            if isThree(pattern):
                found.append(tuple(os.path.join(near, one) for one in pattern))
                continue
            path = os.path.join(near, pattern)
            isOne = os.path.exists(path) or not glob.has_magic(pattern)
            several = [path] if isOne else sorted(glob.glob(path))
            if not several:
                problems.append(f"records: no file {path}")
            found += several
        twice = sorted({p for p in found if found.count(p) > 1})
        if twice:
            problems.append(f"records: {', '.join(map(str, twice))} is given twice")
        return found

    def _motion(self, path, before):
        # what a file says itself counts
        files = [path] if isinstance(path, str) else path
        said = accelerograms.read(files[0])
        unit, every = None if said.unit else self.unit, None if said.every else self.every
        values, every = readRecord(path, every, 1.0, unit)
        stems = [os.path.splitext(os.path.basename(one))[0] for one in files]
        stem = os.path.commonprefix(stems).rstrip("_-. ") or stems[0]
        stem = re.sub(r"[^A-Za-z0-9_-]+", "_", stem)[:60] or "record"
        known = {motion.name.lower() for motion in before}
        names = itertools.chain([stem], (f"{stem}_{n}" for n in itertools.count(2)))
        name = next(name for name in names if name.lower() not in known)
        intensity = self.measure.of(values, every)
        if not (intensity > 0 and math.isfinite(intensity)):
            raise Refused(f"{path}: its {self.measure.name} is {intensity:g}, it must be above 0")
        return Motion(name, values, every, intensity)

    def rows(self) -> list[tuple[Motion, float]]:
        """What every row is shaken by, in turn: a record and the factor on it [-]."""
        motions = self.read("")
        if self.scales is not None:
            return [(motion, s) for motion in motions for s in self.scales]
        return [(m, level / m.intensity) for m in motions for level in self.levels]

    def describe(self) -> dict[str, Any]:
        return {
            "records": [motion.entry for motion in self.read("")],
            "measure": self.measure.name,
            "levels": self.levels,
            "scales": self.scales,
        }

    def doubts(self) -> list[str]:
        return [
            f"note: the record {motion.name} drifts: {doubt}"
            for motion in self.read("")
            for part in accelerograms.components(motion.values).tolist()
            if (doubt := accelerograms.drift(part, motion.every).sentence())
        ]


class Chains:
    """Which rows of a study go on from each other: those of one record, with growing levels.

    :param study: the description of a study, of study.json. Without records every row stands alone
    """

    def __init__(self, study: dict[str, Any]) -> None:
        self.plan, self.runs = study.get("ida"), study["runs"]
        self.each = len(self.plan["levels"] or self.plan["scales"]) if self.plan else 1

    def record(self, number: int) -> int:
        return (number - 1) // self.each

    def lower(self, number: int) -> range:
        """The rows of the same record below a row, the lowest first, as ``higher`` those above
        it."""
        return range(self.record(number) * self.each + 1, number)

    def higher(self, number: int) -> range:
        return range(number + 1, (self.record(number) + 1) * self.each + 1)

    def lowest(self, numbers: Iterable[int]) -> set[int]:
        """The lowest of some rows, of every record."""
        return set({self.record(n): n for n in sorted(numbers, reverse=True)}.values())

    def intensity(self, number: int) -> float:
        """The measure of a row [g]."""
        record, level = divmod(number - 1, self.each)
        if self.plan["levels"]:
            return float(self.plan["levels"][level])
        return float(self.plan["scales"][level] * self.plan["records"][record]["intensity"])


def shaken(run: dict[str, Any]) -> bool:
    """Whether a run came to a shake: what falls under its own weight before does not."""
    return any(stage["stage"] == "shake" for stage in run.get("stages", []))


def fell(run: dict[str, Any]) -> bool:
    """Whether a structure fell when it was shaken, or after it."""
    return bool(run.get("collapsed") and shaken(run))
