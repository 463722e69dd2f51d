# SPDX-License-Identifier: GPL-2.0-or-later
"""The N-V domain of a pier: the shear force that it carries under every normal force, from limit
analysis, and runs as points.

A scene says ``scene.domain(top, normal=[50, 100, 200])`` after its presses are described; with
``--preset bound`` that takes no run. Limit analysis of the scene is then in run.json, for each of
these normal forces, and :func:`domain` reads it, with the peaks of other runs beside it.
"""

import os
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Sequence

import numpy as np

from masonry.arguments import FilePath, listOf, path, validated
from masonry.units import GRAVITY
from masonry.errors import Refused
from .bilinear_curve import pushover
from masonry.numbers.files import filesOf, readRun

#: Entries of run.json in which a run and a domain of the same pier agree, and what they are.
ALIKE = {"units": "bricks", "joint_count": "joints", "joints": "properties of joints"}
#: Names in a JSON file of attributes that have a unit.
ENTRIES = {
    "normal": "normal_kN",
    "largest": "largest_kN",
    "withoutDilatancy": "without_dilatancy_kN",
    "shear": "peak_kN",
    "displacement": "displacement_mm",
}


@dataclass(frozen=True)
class BoundPoint:
    """What limit analysis found under one normal force."""

    normal: float  #: at the supports, compression is positive [kN]
    largest: float  #: upper bound of the shear force, joints that slip open [kN]
    #: of one collapse in which joints slip without opening [kN], where that was looked for
    withoutDilatancy: float | None
    exact: bool  #: whether rigid blocks carry just ``largest``


@dataclass(frozen=True)
class RunPoint:
    """The peak of a run."""

    name: str  #: of its folder
    normal: float  #: at the supports when the force was largest, compression is positive [kN]
    shear: float  #: that supports and loaded point carried at once [kN]
    displacement: float  #: at the peak [mm]
    source: str  #: of the normal force, a sentence


@dataclass(frozen=True)
class Domain:
    """An N-V domain: what :func:`domain` found."""

    bounds: list[BoundPoint]  #: by their normal forces
    runs: list[RunPoint]
    #: sentences: normal forces without a bound, and why; runs that seem to be of another pier
    notes: list[str]

    def shear(self, normal: float) -> float:
        """The bound of the shear force under a normal force [kN], interpolated between two of the
        domain. A domain is convex, so limit analysis for this normal force itself would give as
        much or more.

        :param normal: [kN]
        :raises Refused: if the domain does not reach so far
        """
        forces = [one.normal for one in self.bounds]
        if not forces[0] <= normal <= forces[-1]:
            raise Refused(
                f"the domain has no normal force of {normal:.4g} kN: it goes from {forces[0]:.4g}"
                f" to {forces[-1]:.4g} kN"
            )
        return float(np.interp(normal, forces, [one.largest for one in self.bounds]))

    def entries(self) -> dict[str, Any]:
        """The domain as an entry of a JSON file, with units in the names."""
        named = lambda ones: [
            {ENTRIES.get(n, n): v for n, v in asdict(one).items()} for one in ones
        ]
        return dict(bounds=named(self.bounds), runs=named(self.runs), notes=self.notes)


@validated
def runPoint(directory: FilePath) -> RunPoint:
    """Normal force and shear force at the peak of the push of a run.

    The normal force is the sum of the vertical forces on all that is held, at the row of the peak.
    A wall in running bond whose curve.csv does not have them, pressed by a platen that moves freely
    up and down, has that of its precompression and weight.

    :param directory: folder of results
    :raises Refused: if the run has no whole push, or if its normal force is not known
    """
    push = pushover(directory)
    at = push.data.peak()
    normal, source = _normal(push, at)
    name = os.path.basename(os.path.normpath(push.directory))
    return RunPoint(name, normal, float(push.force[at]), float(push.displacement[at]), source)


def _normal(push, at):
    """Normal force at the supports at a row of the push [kN], and where it comes from."""
    run = push.run
    with filesOf(push.directory):
        heads = [f"{name}_force_z_kN" for name in run.get("held", [])]
        missing = [head for head in heads if push.data.column(head) is None]
        if heads and not missing:
            total = -sum(push.data[head][at] for head in heads)
            return float(total), f"curve.csv: {', '.join(heads)}"
        wall, material = run.get("wall"), run.get("unit_material")
        if not (wall and material):
            raise Refused(
                f"{push.directory}: the normal force at the peak is not known: curve.csv has no"
                f" column {', '.join(missing) or 'of a vertical force'}; run the scene with all"
                " columns"
            )
        area = wall["length_m"] * wall["thickness_m"]
        weight = material["density_kg_per_m3"] * GRAVITY * area * wall["height_m"]
        source = "precompression and weight in run.json, with a top that moves freely up and down"
        return 1e-3 * (wall["precompression_Pa"] * area + weight), source


@validated
def domain(
    directory: FilePath, runs: Annotated[Sequence[FilePath], listOf(path, 0)] = ()
) -> Domain:
    """The N-V domain of a scene, with runs as points.

    :param directory: folder of results of a scene that says ``scene.domain(...)``
    :param runs: folders of runs that push the same pier
    :raises Refused: if the run has no domain, or if a run has no whole push
    """
    run, bounds, notes = readRun(directory), [], []
    with filesOf(directory):
        for entry in run.get("bounds", []):
            if "pressed_kN" not in entry:
                continue
            if "factor" not in entry:
                notes.append(f"{entry['load']}: {entry['note']}")
                continue
            found = entry["normal_kN"], entry["factor"], entry.get("without_dilatancy")
            bounds.append(BoundPoint(*found, entry["exact"]))
    if not bounds:
        none = (
            f"{directory}: run.json has no domain: say scene.domain(top, normal=[...]) in the"
            " scene, after its presses, and run it, for limit analysis alone with --preset bound"
        )
        raise Refused("\n".join(notes or [none]))
    points = []
    for one in runs:
        points.append(runPoint(one))
        other = readRun(one)
        both = ALIKE.keys() & run.keys() & other.keys()
        unlike = [what for key, what in ALIKE.items() if key in both and run[key] != other[key]]
        if unlike:
            notes.append(
                f"{points[-1].name}: its {' and its '.join(unlike)} are not those of"
                " the domain: is it the same pier?"
            )
    return Domain(sorted(bounds, key=lambda one: one.normal), points, notes)
