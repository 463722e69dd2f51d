# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a run, measured from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry_view.measure results/wall_comp4`` prints them, with units in the
names. Walls are pushed to the right: the compressed corners are the toe at the bottom right and the
top left, and a diagonal crack falls to the right. Of a wall that follows a history the numbers of
cracks and crushing are those of the way to the right, and once more, with ``_mirrored`` at the end
of the name, those of the way to the left. It has a table of its cycles, too.
"""

import glob
import os
import sys
from typing import Annotated, Any, Iterator

import numpy as np

from masonry.arguments import FilePath, isNumber, label, validated
from masonry.errors import Refused
from masonry.terminal import say
from masonry.numbers import cracks, loops, quantities
from masonry.numbers.files import filesOf, onFolder, readCurve, readRun
from masonry.numbers.frames import frameAt, readFrame
from masonry.numbers.run_data import BASE, TOP, RunData


@validated
def wallNumbers(directory: FilePath) -> dict[str, Any]:
    """All numbers of a wall's run. Those of the crack pattern are left out if there are no ParaView
    files."""
    data = RunData.read(directory)
    if not data.isPush:
        raise Refused(f"{directory}: nothing was pushed in this run")
    at = data.peak()
    top, base, times = (data[n] for n in (TOP, BASE, "time_s"))
    more = {"top_less_base_shear_kN": top[at] - base[at]}
    if glob.glob(os.path.join(directory, "joints_*.vtp")):
        data.joints = readFrame(directory, "joints")
        peak = readFrame(directory, "joints", frameAt(directory, times[at]))
        found = cracks.diagonal(*cracks.layOut(peak, data.run["wall"]))
        more.update(diagonal_reach_at_peak=found["diagonal_reach"], **data.pattern)
    return {**quantities.known(data), **more}


@validated
def jointNumbers(directory: FilePath, name: Annotated[str, label]) -> dict[str, Any]:
    """Areas under the curves of a joint whose means are recorded: its fracture energies, if it was
    torn, sheared or crushed.

    :param name: of the joint, which stands before the names of its columns and of these numbers; it
        may be empty

    - opening_work_J_per_m2, closure_work_J_per_m2: under tension over the opening, and under
      compression over the closure
    - softening_work_J_per_m2: under the shear stress over the slide, above the shear stress at the
      end, both along the slide at the end
    """
    curve, prefix = readCurve(directory), name + "_" if name else ""
    opening, normal = (np.array(curve[prefix + n]) for n in ("opening_mm", "normal_stress_MPa"))
    both = lambda *names: np.array([curve[prefix + n] for n in names if prefix + n in curve])
    slides = both("slide_mm", "slide_across_mm")
    along = slides[:, -1] / (np.linalg.norm(slides[:, -1]) or 1.0)
    slide, shear = along @ slides, along @ both("shear_stress_MPa", "shear_stress_across_MPa")
    area = lambda stress, mm: 1e3 * loops.area(np.maximum(stress, 0), mm)
    return {
        f"{prefix}opening_work_J_per_m2": area(normal, opening),
        f"{prefix}closure_work_J_per_m2": area(-normal, -opening),
        f"{prefix}softening_work_J_per_m2": area(shear - shear[-1], slide),
    }


@validated
def measure(directory: FilePath) -> dict[str, Any]:
    """Numbers of a run by name: those at the top level of run.json, and those measured here.
    ``balance_error`` is its ``energy_balance_error``."""
    numbers = readRun(directory)
    with filesOf(directory):
        numbers["balance_error"] = numbers.pop("energy_balance_error")
        if "wall" in numbers:
            numbers.update(wallNumbers(directory))
        for joint in numbers.get("recorded_joints", []):
            numbers.update(jointNumbers(directory, joint))
    return {n: v for n, v in numbers.items() if isNumber(v) or n == "failure_mode"}


def cycleTable(cycles: list[dict[str, Any]]) -> Iterator[str]:
    """The cycles of run.json as lines of a table, with the numbers of
    :data:`masonry.numbers.quantities.OF_CYCLES`."""
    columns = quantities.OF_CYCLES
    heads = [name if unit == "-" else f"{name} [{unit}]" for _, name, unit, *_ in columns]
    line = lambda texts: "".join(f"{t:>{max(len(h), 9) + 2}}" for t, h in zip(texts, heads))
    yield " cycle" + line(heads)
    for n, cycle in enumerate(cycles, 1):
        values = [(cycle[key], digits) for key, _, _, digits, _ in columns]
        yield f"{n:6}" + line("-" if v is None else f"{v:.{d}f}" for v, d in values)


def show(directory: FilePath) -> None:
    for name, value in measure(directory).items():
        say(f"{name:34} {value if isinstance(value, str) else f'{value:.6g}'}")
    cycles = readRun(directory).get("cycles")
    if cycles:
        with filesOf(directory):
            say("\n".join(["", *cycleTable(cycles)]))


if __name__ == "__main__":
    sys.exit(onFolder(show, sys.argv[1:]))
