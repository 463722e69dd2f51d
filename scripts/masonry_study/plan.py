# SPDX-License-Identifier: GPL-2.0-or-later
"""The description of a study, and the table of its rows."""

import hashlib
import math
import os
import pathlib
import re
from typing import Annotated, Any, Sequence

import numpy as np

from masonry.arguments import FilePath, isA, oneOf, validated, whole
from masonry.run import batch
from masonry.errors import Refused, refuse
from . import designs, incremental
from .variables import Choice, Distribution, Field, choice

MAX_ROWS = 100_000  # of a study


class Study:
    """A scene, what varies in it, and how many runs there are.

    :param scene: name of a scene that stands beside the study's file, in the present folder or in a
        folder ``scripts`` of either or above it, or the path of a scene of your own
    :param options: options of the scene by their names, with underscores for dashes, the same in
        all rows; also properties of joints, ``"bed.friction": 0.5``
    :param runs: how many rows; of a grid None, or the number of its points
    :param seed: the same number gives the same rows
    :param vary: dict of a name -> what it is in the rows. A name is an option, for example
        ``"rate"``, or a property of a kind of joints, ``"bed.cohesion"``; a tuple of properties
        have the same value or field. What it is, is a number or a text, a list of these,
        :func:`choice`, :func:`lognormal`, :func:`normal`, :func:`uniform` or :func:`field`
    :param design: ``"random"``, ``"latin"`` (hypercube), ``"sobol"`` (Sobol's sequence),
        ``"grid"``: all combinations of the lists, or ``"ida"``, incremental dynamic analysis: the
        scene is shaken by records that grow in strength until it falls. What varies beside that is
        drawn once for every record
    :param correlation: dict of pairs of names -> rank correlation of two distributions [-]; of a
        tuple of properties its key, or one of them
    :param records: of an ``"ida"``, like those below: files as in
        :mod:`masonry.scene.accelerograms`, with paths from the study's file on, or patterns such as
        ``"records/*.AT2"``, or triples of files, of three components that act at once
    :param levels: growing values of the measure of intensity [g] to which all records are scaled;
        or ``scales``: growing factors on the records as they are [-]
    :param measure: of intensity: ``"PGA"``, the peak ground acceleration (None means that, too), or
        :func:`masonry_study.Sa`, a spectral acceleration
    :param unit: of those records whose files do not say theirs: ``"m/s²"``, ``"g"`` or ``"cm/s²"``;
        None: m/s², and a record whose peak looks like another unit is refused
    :param every: time between the samples of those whose files do not say it [s]
    :raises Refused: with all problems at once
    """

    @validated
    def __init__(
        self,
        scene: FilePath,
        options: Annotated[dict[str, Any], isA(dict)] | None = None,
        runs: Annotated[int, whole(1, MAX_ROWS)] | None = None,
        seed: Annotated[int, whole(0, 2**31 - 1)] = 0,
        vary: Annotated[dict[Any, Any], isA(dict)] | None = None,
        design: Annotated[str, oneOf(*designs.DESIGNS)] = "random",
        correlation: Annotated[dict[tuple[Any, Any], float], isA(dict)] | None = None,
        records: FilePath | Sequence[FilePath | Sequence[FilePath]] | None = None,
        levels: Sequence[float] | None = None,
        scales: Sequence[float] | None = None,
        measure: str | incremental.Measure | None = None,
        unit: str | None = None,
        every: float | None = None,
    ) -> None:
        problems = []
        self.scene, self.seed, self.design = str(scene), seed, design
        self.options, self.runs = dict(options or {}), runs
        self.vary, self.correlation = {}, {}
        for name, value in self.options.items():
            problems += _wrongOption(name, value)
        for key, what in dict(vary or {}).items():
            self._take(key, what, problems)
        #: the records and their strengths of an incremental dynamic analysis, else None
        self.ida = None
        own = dict(
            records=records, levels=levels, scales=scales, measure=measure, unit=unit, every=every
        )
        if design == "ida":
            self.ida = incremental.Incremental(**own, problems=problems)
            for name in {"record", "scale"} & {*self.options, *self.vary}:
                problems.append(f"{name}: it is what an incremental analysis varies")
        else:
            given = [name for name, value in own.items() if value is not None]
            problems += [f'{name}: only a study with design="ida" has it' for name in given]
            if not self.vary:
                problems.append("vary: nothing varies")
        problems += self._count()
        problems += self._correlate(dict(correlation or {}))
        refuse(problems, "study: ", "\n  ")

    def _take(self, key, what, problems):
        names = (key,) if isinstance(key, str) else key
        if not isinstance(names, tuple) or not names or not all(isinstance(n, str) for n in names):
            problems.append(f"vary: {key!r} must be a name or a tuple of names")
            return
        what = [what] if isinstance(what, (bool, int, float, str)) else what
        try:
            what = choice(*what) if isinstance(what, (list, tuple)) else what
            if not isinstance(what, (Choice, Distribution, Field)):
                raise Refused(f"{what!r} is no number, list, distribution or field")
        except Refused as refused:
            problems.append(f"vary {key!r}: {refused}")
            return
        isField = isinstance(what, Field)
        problems += [f"vary {key!r}: {why}" for why in _unfit(what, names)]
        values = what.values if isinstance(what, Choice) else [0]
        problems += [p for n in names for v in values for p in _wrongOption(n, v)]
        alike = [c for c, w in self.vary.items() if isinstance(w, Field) == isField]
        given = {*self.options, *(n for column in alike for n in namesOf(column))}
        if twice := ", ".join(n for n in names if n in given):
            problems.append(f"{twice}: given twice")
        self.vary[batch.FIELD * isField + "+".join(names)] = what

    def _count(self):
        """Find how many rows there are. Yields what is wrong with the number."""
        if self.ida:
            if self.runs is not None:
                yield f"runs {self.runs!r}: there are as many as records times levels; leave it out"
            return
        if self.design == "grid":
            odd = [c for c, w in self.vary.items() if isinstance(w, Distribution)]
            if odd:
                yield f"design 'grid': {', '.join(odd)} must be a list of values"
            choices = (w for w in self.vary.values() if isinstance(w, Choice))
            size = math.prod(len(w.values) for w in choices)
            if self.runs not in (None, size):
                yield f"runs {self.runs}: the grid has {size} points"
            self.runs = size
        if self.runs is None or self.runs > MAX_ROWS:
            yield f"runs {self.runs} must be a whole number from 1 to {MAX_ROWS}"

    def _correlate(self, correlation):
        """Take correlations. Yields what is wrong with them."""
        for pair, value in correlation.items():
            if not isinstance(pair, tuple) or len(pair) != 2:
                yield f"correlation {pair!r}: must be of two names"
                continue
            one, two = map(self._columnOf, pair)
            wrong = [reason for n in (one, two) if (reason := self._uncorrelated(n))]
            if one == two:
                wrong.append("the two names are the same")
            if not isinstance(value, (int, float)) or not -1 < value < 1:
                wrong.append("it must be above -1 and below 1")
            if {(one, two), (two, one)} & {*self.correlation}:
                wrong.append("given twice")
            yield from (f"correlation {pair!r} = {value!r}: {why}" for why in wrong)
            if not wrong:
                self.correlation[one, two] = float(value)

    def _uncorrelated(self, name):
        if name not in self.vary:
            return f"{name} does not vary"
        what = self.vary[name]
        if isinstance(what, Distribution):
            return ""
        form = type(what).__name__.lower()
        return f"{name} varies as a {form}; only distributions have a correlation"

    def _columnOf(self, key):
        """The column of ``vary`` that a key of it, or one of its names, stands for."""
        names = namesOf(key) if isinstance(key, str) else key
        fits = [column for column in self.vary if {*names} <= {*namesOf(column)}]
        isField = lambda column: isinstance(self.vary[column], Field)
        return min(fits, key=isField, default="+".join(map(str, names)))

    # -- what follows ------------------------------------------------------------------------------

    def describe(self) -> dict[str, Any]:
        return {
            "scene": self.scene,
            "options": self.options,
            "runs": self.runs,
            "seed": self.seed,
            "design": self.design,
            "vary": {name: what.describe() for name, what in self.vary.items()},
            "correlation": [[*pair, v] for pair, v in self.correlation.items()],
            **({"ida": self.ida.describe()} if self.ida else {}),
        }

    def read(self, near: FilePath) -> None:
        """Read the records of an incremental analysis, which say how many rows there are. Raises
        Refused.

        :param near: folder of the study's file; without this call, the present folder
        """
        if self.ida:
            self.runs = len(self.ida.read(near)) * self.ida.steps
            if self.runs > MAX_ROWS:
                raise Refused(f"study: {self.runs} rows, there must be at most {MAX_ROWS}")

    def rows(self) -> list[dict[str, Any]]:
        """The values of every row, with the options that all have. Raises Refused."""
        if not self.ida:
            return self._drawn(self.design, self.runs)
        shaken, rows = self.ida.rows(), []
        drawn = self._drawn("random", len(shaken) // self.ida.steps)
        for n, (motion, scale) in enumerate(shaken):
            record = f"{incremental.FOLDER}/{motion.name}.txt"
            rows.append({**drawn[n // self.ida.steps], "record": record, "scale": scale})
        return rows

    def _drawn(self, design, count):
        fields = {n: w for n, w in self.vary.items() if isinstance(w, Field)}
        drawn = {n: w for n, w in self.vary.items() if n not in fields}
        rows = designs.values(design, count, self.seed, drawn, self.correlation)
        means = {n[len(batch.FIELD) :]: w.mean for n, w in fields.items() if w.mean is not None}
        rows = [{"lean": True, **self.options, **means, **values} for values in rows]
        for number, row in enumerate(rows, 1):
            for k, (name, what) in enumerate(fields.items()):
                sequence = np.random.SeedSequence([self.seed, k, number])
                row[name] = what.written(int(sequence.generate_state(1)[0]))
        return rows

    def table(self) -> str:
        rows = self.rows()
        lines = [["description", *rows[0]]]
        for number, row in enumerate(rows, 1):
            lines.append([batch.named(number), *map(repr, row.values())])
        return "".join(" ".join(words) + "\n" for words in lines)

    def script(self, near: FilePath) -> tuple[str, str]:
        """Path of the scene's file, and the fingerprint of its contents. Raises Refused.

        :param near: folder of the study's file
        """
        here = pathlib.Path(near)
        if self.scene.endswith(".py"):
            places = [here / self.scene]
        else:
            scripts = [f / "scripts" for f in (here, *here.parents, pathlib.Path.cwd())]
            gallery = [folder / "gallery" for folder in scripts]
            folders = [here, pathlib.Path.cwd(), *scripts, *gallery]
            places = [folder / (self.scene + ".py") for folder in folders]
        path = next((os.path.abspath(p) for p in places if p.is_file()), None)
        if path is None:
            looked = dict.fromkeys(os.path.dirname(os.path.abspath(p)) for p in places)
            raise Refused(f"study: no scene {self.scene}; looked in {', '.join(looked)}")
        return path, hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


def _unfit(what, names):
    isField, several = isinstance(what, Field), len(names) > 1
    properties = all("." in name for name in names)
    if isField and not properties:
        yield "only a property of joints can be a field"
    if isField and what.mean is not None and several:
        yield "a field of several properties is about their own values: field(cov=..., length=...)"
    if several and not (isField or properties):
        yield "only properties of joints can be tied in a tuple"


def namesOf(column: str) -> list[str]:
    """The names that a column stands for."""
    return column.removeprefix(batch.FIELD).split("+")


def _wrongOption(name, value):
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z_]\w*(\.\w+)?", name):
        yield f"{name!r} must be an option, with underscores for dashes, or JOINT.PROPERTY"
    elif name in batch.OWN:
        yield f"option {name!r} is the study's own"
    elif value is not None and not isinstance(value, (bool, int, float, str)):
        yield f"{name}: {value!r} must be a number, a text, or True or False"
    elif isinstance(value, str) and re.search(r"[\s#]|^[=*]?$", value):
        yield f"{name}: {value!r} cannot stand in a table of YADE: it is empty or has a blank or #"
