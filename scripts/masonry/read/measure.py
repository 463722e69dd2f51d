# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a run, measured from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry.read.measure results/wall_comp4`` prints them, with units in the names. Walls are pushed to the
right: the compressed corners are the toe at the bottom right and the top left, and a diagonal crack falls to the right.
Of a wall that follows a history the numbers of cracks and crushing are those of the way to the right, and once more, with
``_mirrored`` at the end of the name, those of the way to the left. It has a table of its cycles, too.
This module needs no YADE.
"""

from __future__ import annotations

import glob
import os
import sys
import xml.etree.ElementTree as ElementTree
from typing import Any, Iterator

import numpy as np

from ..arguments import FilePath, Numbers
from ..basics import say
from . import loops
from .cracks import (
    crushing,
    diagonal,
    failureMode,
    layOut,
    mirrored,
    patternNumbers,
)
from .curves import stillGrows
from .files import filesOf, onFolder, readCurve, readRun
from .frames import readFrame

LOST = 0.05  # of the peak force: a larger loss is a drop, a smaller one may be the scatter by single bricks at the toe


def force(displacement: Numbers, shear: Numbers) -> dict[str, float]:
    """Numbers of a force-displacement curve after its peak, from displacements [mm] and forces.

    - force_drop [-]: share of the peak that is lost at the end
    - drop_at_mm: first displacement after the peak with less than 0.95 of it; infinite if there is none
    """
    at = int(np.argmax(shear))
    after = np.flatnonzero(np.asarray(shear[at:]) < (1 - LOST) * shear[at])
    return {
        "force_drop": 1 - shear[-1] / shear[at],
        "drop_at_mm": displacement[at + after[0]] if len(after) else float("inf"),
    }


def pushNumbers(displacement: Numbers, shear: Numbers) -> dict[str, float]:
    """Numbers of a push: its work, and those of :func:`force`. Parameters are displacements [mm] and forces [kN]."""
    work = float(np.trapz(shear, displacement))
    return {"push_work_J": work, **force(displacement, shear)}


def frameAt(directory: FilePath, time: float) -> int:
    """Number of the joints' frame nearest to a time [s]."""
    sets = ElementTree.parse(os.path.join(directory, "joints.pvd")).iter("DataSet")
    return int(np.argmin([abs(float(s.get("timestep")) - time) for s in sets]))


def wallNumbers(directory: FilePath) -> dict[str, Any]:
    """All numbers of a wall's run. Those of the crack pattern are left out if there are no ParaView files."""
    run, curve = readRun(directory), readCurve(directory)
    shear, moved = curve["base_shear_kN"], curve["displacement_mm"]
    at = int(np.argmax(shear))
    numbers = {"top_less_base_shear_kN": curve["top_shear_kN"][at] - shear[at]}
    if "history" in run:
        numbers.update(loopNumbers(run, moved, shear))
    else:
        numbers.update(pushNumbers(moved, shear))
    if glob.glob(os.path.join(directory, "joints_*.vtp")):
        grid = lambda number: layOut(
            readFrame(directory, "joints", number), run["wall"]
        )
        bed, upright = grid(-1)
        numbers.update(patternNumbers(bed, upright))
        if "history" in run:
            bed, upright = mirrored(bed), mirrored(upright)
            other = {**diagonal(bed, upright), **crushing(bed)}
            numbers.update((name + "_mirrored", v) for name, v in other.items())
        atPeak = diagonal(*grid(frameAt(directory, curve["time_s"][at])))
        numbers["diagonal_reach_at_peak"] = atPeak["diagonal_reach"]
    return numbers


def loopNumbers(
    run: dict[str, Any], displacement: Numbers, shear: Numbers
) -> dict[str, Any]:
    """Numbers of loops, from run.json and from displacements [mm] and forces [kN].

    - cycle_count: whole cycles; cycle_work_J: work of all of them; loop_work_J: work of the whole curve
    - largest_amplitude_mm: of a cycle; largest_damping, smallest_damping [-]: the ratio of equivalent viscous damping
    - force_drop, drop_at_mm: as of a push, along the envelope of the positive side; force_drop_negative,
      drop_at_negative_mm: along that of the negative side, as positive numbers
    """
    cycles = run["cycles"]
    numbers = {
        "cycle_count": len(cycles),
        "cycle_work_J": sum(cycle["work_J"] for cycle in cycles),
        "loop_work_J": loops.work(displacement, shear),
    }
    damping = [c["damping"] for c in cycles if c["damping"] is not None]
    if damping:
        numbers["largest_amplitude_mm"] = max(c["amplitude_mm"] for c in cycles)
        numbers["largest_damping"] = max(damping)
        numbers["smallest_damping"] = min(damping)
    moved, forces = np.array(displacement), np.array(shear)
    sides = (("", 1), ("_negative", -1))
    for rows, (name, side) in zip(loops.envelope(displacement), sides):
        if len(rows) and (side * forces[rows]).max() > 0:
            found = force(side * moved[rows], side * forces[rows])
            numbers["force_drop" + name] = found["force_drop"]
            numbers[f"drop_at{name}_mm"] = found["drop_at_mm"]
    return numbers


def jointNumbers(directory: FilePath, name: str) -> dict[str, Any]:
    """Areas under the curves of a joint whose means are recorded: its fracture energies, if it was torn, sheared or crushed.

    :param name: of the joint, which stands before the names of its columns and of these numbers; it may be empty

    - opening_work_J_per_m2, closure_work_J_per_m2: under tension over the opening, and under compression over the closure
    - softening_work_J_per_m2: under the shear stress over the slide, above the shear stress at the end
    """
    curve, prefix = readCurve(directory), name + "_" if name else ""
    opening, slide, normal, shear = (
        np.array(curve[prefix + end])
        for end in ("opening_mm", "slide_mm", "normal_stress_MPa", "shear_stress_MPa")
    )
    area = lambda stress, mm: 1e3 * np.trapz(np.maximum(stress, 0), mm)
    found = {
        "opening_work_J_per_m2": area(normal, opening),
        "closure_work_J_per_m2": area(-normal, -opening),
        "softening_work_J_per_m2": area(shear - shear[-1], slide),
    }
    return {prefix + end: value for end, value in found.items()}


def measure(directory: FilePath) -> dict[str, Any]:
    """Numbers of a run as a dict by name: those at the top level of run.json, and those measured here.

    ``balance_error`` is the ``energy_balance_error`` of run.json.
    """
    run = readRun(directory)
    numbers = {
        name: value
        for name, value in run.items()
        if isinstance(value, (int, float)) and not isinstance(value, bool)
    }
    with filesOf(directory):
        numbers["balance_error"] = numbers.pop("energy_balance_error")
        if "wall" in run:
            numbers.update(wallNumbers(directory))
        for joint in run.get("recorded_joints", []):
            numbers.update(jointNumbers(directory, joint))
    return numbers


#: Columns of the table of cycles: the head, the key in run.json, and the format of the numbers.
TABLE = (
    ("from mm", "smallest_mm", ".3f"),
    ("to mm", "largest_mm", ".3f"),
    ("from kN", "smallest_kN", ".2f"),
    ("to kN", "largest_kN", ".2f"),
    ("work J", "work_J", ".2f"),
    ("kN/mm", "stiffness_kN_per_mm", ".2f"),
    ("damping", "damping", ".3f"),
    ("left + mm", "residual_positive_mm", ".3f"),
    ("left - mm", "residual_negative_mm", ".3f"),
    ("joints J", "dissipated_J", ".2f"),
    ("damped J", "damped_J", ".2f"),
)


def cycleTable(cycles: list[dict[str, Any]]) -> Iterator[str]:
    """The cycles of run.json as lines of a table: displacement and base shear from and to, work at the base, secant
    stiffness, equivalent damping, residual displacements, and what joints and damping took.
    """
    yield " cycle" + "".join(f"{head:>11}" for head, _, _ in TABLE)
    for n, cycle in enumerate(cycles, 1):
        texts = (
            "-" if cycle[key] is None else format(cycle[key], kind)
            for _, key, kind in TABLE
        )
        yield f"{n:6}" + "".join(f"{text:>11}" for text in texts)


def show(directory: FilePath) -> None:
    """Print all numbers of a run, and a table of its cycles if there are any."""
    numbers, wall = measure(directory), readRun(directory).get("wall")
    for name, value in numbers.items():
        say(f"{name:34} {value:.6g}")
    if wall and "slid_share" in numbers:
        looped, curve = readRun(directory).get("history"), readCurve(directory)
        grows = not looped and stillGrows(curve["displacement_mm"], curve["base_shear_kN"])  # fmt: skip
        say(f"{'failure_mode':34} {failureMode(numbers, wall, grows)}")
    cycles = readRun(directory).get("cycles")
    if cycles:
        with filesOf(directory):
            say("\n".join(["", *cycleTable(cycles)]))


if __name__ == "__main__":
    sys.exit(onFolder(show, sys.argv[1:]))
