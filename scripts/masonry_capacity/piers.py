# SPDX-License-Identifier: GPL-2.0-or-later
"""Strength and drift capacity of piers and spandrels by EN 1998-3:2005 and NTC 2018, beside what a
run found in them::

    /usr/bin/python3 -m masonry_capacity.piers results/WALL --fb 20  # [MPa]; writes piers.csv

``scene.pier()`` and ``scene.spandrel()`` say what they are. Strengths are those of the bed joints
of the run if they are not given: means without safety factors, with a confidence factor of 1.
Clauses are cited from memory.

A spandrel is checked as a pier on its side, whose axial force is the horizontal one of the run (NTC
2018, 7.8.2.2.4; EN 1998-3 has no rule of its own): without compression it has no strength. With the
tensile strength of a lintel, beam or tie NTC has strengths without that force (:func:`coupling`).
How far it turns is not checked.
"""

import argparse
import csv
import glob
import inspect
import math
import os
import re
import sys
from dataclasses import dataclass, replace
from typing import Annotated, Any, Sequence

import numpy as np

from masonry.arguments import FilePath, number, orNone, validated
from masonry.errors import Refused
from masonry.folders import replaced, writing
from masonry.materials.codes import LOCAL_FRICTION, MAX_SHEAR
from masonry.numbers import cracks
from masonry.numbers.files import program
from masonry.numbers.frames import readFrame
from masonry.numbers.run_data import RunData
from masonry.terminal import say

CODE_FRICTION = 0.4  # of a bed joint: EN 1998-3:2005, C.4.3.1; NTC 2018, 7.8.2.2.2
UNIT_TENSION = 0.1  # over the compressive strength of the unit: Circolare 7/2019, C8.7.1.3.1.1
#: Height of a unit over the overlap where it is not known: the one at which the equivalent friction
#: is 0.4, which the Circolare gives for good bond.
GOOD_BOND = 1 / 0.4 - 1 / LOCAL_FRICTION
TABLE = "piers.csv"


@dataclass(frozen=True)
class Prediction:
    """One rule for one pier; None where the rule says nothing.

    ``peak`` [kN] is the strength, ``failure`` is flexure, shear (diagonal cracks or failure of
    units) or sliding (along a bed joint), ``drift`` [%] is the capacity at near collapse (EN) or at
    the ultimate limit state SLC (NTC).
    """

    peak: float | None = None
    failure: str | None = None
    drift: float | None = None


@dataclass(frozen=True)
class Pier:
    """What the rules need of a pier, a wall of its own: lengths [mm], force [N], strengths [MPa].

    ``span`` is the height of zero moment H0, ``force`` acts at the base, ``slope`` is the height of
    a unit over the overlap with the next course, ``unit`` is the compressive strength of the units
    or None.
    """

    height: float
    length: float
    thickness: float
    span: float
    force: float
    strength: float
    unit: float | None
    tau0: float
    fv0: float | None
    slope: float

    @property
    def area(self) -> float:
        return self.length * self.thickness

    @property
    def stress(self) -> float:
        return self.force / self.area

    @property
    def shape(self) -> float:
        """The coefficient b of diagonal cracking, H/L between 1 and 1.5."""
        return min(1.5, max(1.0, self.height / self.length))


def flexure(pier: Pier, block: float) -> float:
    """Strength [N] in flexure without tension, N L/(2 H0) (1 - block sigma0/fm).

    ``block`` is 1.15 in EN 1998-3:2005, C.4.2.1, and 1/0.85 in NTC 2018, 7.8.2.2.1.
    """
    return (
        pier.force
        * pier.length
        / (2 * pier.span)
        * max(0.0, 1 - block * pier.stress / pier.strength)
    )


def alongBed(pier: Pier, cohesion: float, friction: float) -> float:
    """Sliding strength [N] on the compressed part of the base, V = cohesion L' t + friction N.

    L' = 3 (L/2 - V H0/N), at most L, belongs to linear compression without tension (NTC 2018,
    7.8.2.2.2); V, with which it becomes shorter, is solved for.
    """
    whole = cohesion * pier.area + friction * pier.force
    if whole * pier.span <= pier.force * pier.length / 6:
        return whole
    part = 1.5 * cohesion * pier.area + friction * pier.force
    return part / (1 + 3 * cohesion * pier.thickness * pier.span / pier.force)


def sliding(pier: Pier, cohesion: float, friction: float, bound: float) -> dict:
    """Strengths [N] of a bed joint and, as shear, of its units; their bound [MPa] is ``bound``
    times the unit strength.

    In slender walls of strong units the bound acts just below rocking, because the compressed part
    then is short.
    """
    found = {"sliding": alongBed(pier, cohesion, friction)}
    if pier.unit is not None:
        found["shear"] = alongBed(pier, bound * pier.unit, 0.0)
    return found


def diagonal(pier: Pier, tension: float) -> float:
    """Strength [N] by Turnšek and Čačovič, L t ft/b sqrt(1 + sigma0/ft): Circolare 7/2019,
    C8.7.1.16."""
    return pier.area * tension / pier.shape * math.sqrt(1 + pier.stress / tension)


def stepped(pier: Pier, cohesion: float) -> float:
    """Strength [N] of a crack in steps, at most that of the units: Circolare 7/2019, C8.7.1.17 and
    C8.7.1.18."""
    joints = (cohesion + LOCAL_FRICTION * pier.stress) / (1 + LOCAL_FRICTION * pier.slope)
    found = pier.area / pier.shape * joints
    return (
        found if pier.unit is None else min(found, diagonal(pier, UNIT_TENSION * pier.unit) / 2.3)
    )


def coupling(spandrel: Pier, tie: float) -> dict:
    """Strengths [N] of a spandrel whose tension a lintel, beam or tie takes, up to ``tie`` [N]: NTC
    2018, (7.8.4) to (7.8.6). Its ``length`` is its depth, its ``height`` the way between piers."""
    whole = spandrel.strength * spandrel.area
    push = min(tie, 0.4 * whole)
    moment = push * spandrel.length / 2 * (1 - push / (0.85 * whole))
    cohesion = spandrel.tau0 if spandrel.fv0 is None else spandrel.fv0
    return {"shear": spandrel.area * cohesion, "flexure": 2 * moment / spandrel.height}


def smallest(strengths: dict, drifts: dict) -> Prediction:
    """The prediction of the smallest strength [N], with the drift capacity [-] of its failure."""
    failure = min(strengths, key=strengths.__getitem__)
    return Prediction(strengths[failure] / 1e3, failure, 100 * drifts[failure])


def eurocode(pier: Pier) -> Prediction:
    """EN 1998-3:2005, Annex C, C.4.2 and C.4.3 (from memory).

    Drift capacities of near collapse are 4/3 of 0.008 H0/L in flexure and of 0.004 in shear.
    """
    cohesion = pier.tau0 if pier.fv0 is None else pier.fv0
    strengths = {"flexure": flexure(pier, 1.15)} | sliding(pier, cohesion, CODE_FRICTION, MAX_SHEAR)
    shear = 4 / 3 * 0.004
    drifts = {
        "flexure": 4 / 3 * 0.008 * pier.span / pier.length,
        "shear": shear,
        "sliding": shear,
    }
    return smallest(strengths, drifts)


def italian(pier: Pier) -> Prediction:
    """NTC 2018, 7.8.2.2, and Circolare 7/2019, C8.7.1.3.1.1, with mean values as for nonlinear
    static analysis.

    The bound of the unit strength is 0.065 fb/0.7 (C8.7.1.14). Drift capacities at SLC: 0.010 in
    flexure, 0.005 else.
    """
    strengths = {"flexure": flexure(pier, 1 / 0.85)}
    if pier.fv0 is None:
        strengths["shear"] = diagonal(pier, 1.5 * pier.tau0)
    else:
        strengths |= sliding(pier, pier.fv0, CODE_FRICTION, MAX_SHEAR / 0.7)
        strengths["shear"] = min(strengths.get("shear", math.inf), stepped(pier, pier.fv0))
    return smallest(strengths, {"flexure": 0.010, "shear": 0.005, "sliding": 0.005})


EN, NTC = "EN 1998-3:2005", "NTC 2018"
CODES = {EN: eurocode, NTC: italian}
CLAUSES = {
    (EN, "flexure"): "EN 1998-3 C.4.2.1",
    (EN, "sliding"): "EN 1998-3 C.4.3.1",
    (EN, "shear"): "EN 1998-3 C.4.3.1",
    (NTC, "flexure"): "NTC 7.8.2.2.1",
    (NTC, "sliding"): "NTC 7.8.2.2.2",
    (NTC, "shear"): "Circolare 7/2019 C8.7.1.3.1.1",
}
#: The failure of a code that a ``failure_mode`` of a run is.
ALIKE = {
    "rocking": "flexure",
    "toe crushing": "flexure",
    "bed sliding": "sliding",
    "diagonal cracking": "shear",
}
CRUSHED_SHARE = 0.1  # of a section, past the peak of compression where it is crushed
LEANS = 0.7  # cosine of a normal that is along an axis
Strength = Annotated[float | None, orNone(number("MPa", 0, 1e3, above=True))]


def predicted(code: str, one: Pier, isPier: bool, tie: float | None) -> tuple[Prediction, str]:
    """What a code says of a pier or spandrel, and its clause; ``tie`` as of :func:`check`."""
    if not isPier and code == NTC and tie is not None:
        strengths = coupling(one, 1e3 * tie)
        found = smallest(strengths, dict.fromkeys(strengths, 0.0))
        clause = {"shear": "NTC (7.8.4)", "flexure": "NTC (7.8.6)"}[found.failure]
    else:
        found = CODES[code](one) if one.force > 0 else Prediction(0.0, "flexure")
        clause = CLAUSES[code, found.failure]
        if not isPier:
            clause += {EN: " as a pier", NTC: " by 7.8.2.2.4"}[code]
    return found if isPier else replace(found, drift=None), clause


def failureOf(frame: dict, low: np.ndarray, high: np.ndarray, axis: int) -> str:
    """How a pier (axis 2) or spandrel (0 or 1) gives way, by the joints in its box: a
    ``failure_mode``, or "none" where no joint is open or slid by more than 0.05 mm.

    The widest of three decides: joints across the axis that open, joints along it that open, and
    the smallest slide along a whole bed of a pier.
    """
    _, first, joint = np.unique(frame["bodies"], axis=0, return_index=True, return_inverse=True)
    area = frame["area"]
    whole = np.bincount(joint, area)
    mean = lambda values: np.bincount(joint, area * values) / whole
    centres = cracks.centresOf(frame["points"], frame["cells"])
    middles = np.transpose([mean(centres[:, i]) for i in range(3)])
    slid = mean(np.linalg.norm(frame["slide"], axis=1))
    opened = mean(frame["opening"])
    inside = np.all((middles > low - 1e-6) & (middles < high + 1e-6), axis=1)
    across = inside & (np.abs(frame["normal"][first, axis]) > LEANS)
    widths = {
        "rocking": opened[across].max(initial=0.0),
        "diagonal cracking": opened[inside & ~across].max(initial=0.0),
    }
    if axis == 2:
        levels = middles[:, 2].round(4)
        beds = (slid[across & (levels == z)].min() for z in np.unique(levels[across]))
        widths["bed sliding"] = max(beds, default=0.0)
    mode = max(widths, key=widths.__getitem__)
    cracked = widths[mode] > cracks.CRACK
    if cracked and mode != "rocking":
        return mode
    size = high - low
    past = mean(frame["damage_compression"] > 0)[across] @ whole[across]
    if past > CRUSHED_SHARE * np.prod(size) / size[axis]:
        return "toe crushing"
    return mode if cracked else "none"


@validated
def check(
    directory: FilePath,
    fm: Strength = None,
    fv0: Strength = None,
    tau0: Strength = None,
    fb: Strength = None,
    fh: Strength = None,
    slope: Annotated[float, number("", 0.1, 100)] = GOOD_BOND,
    tie: Annotated[float | None, orNone(number("kN", 0, 1e6, above=True))] = None,
) -> list[dict[str, Any]]:
    """Check the piers and spandrels of a run by both codes, each where its shear force is largest.

    The span H0 = M/V + h/2 is that of the larger moment at both ends, from the moment M at the
    middle; ν = N/(A fm); D' = 3 (L/2 - H0 V/N), at most L, is the compressed part under the forces
    of the run, all without signs. Of a spandrel h is its length and L its depth.

    :param directory: folder of results
    :param fm: compressive strength [MPa]; None: that of the joint "bed" of the run
    :param fv0: cohesion of the bed joint [MPa]; None: that of the run
    :param tau0: for masonry without regular bond in place of ``fv0`` [MPa]
    :param fb: compressive strength of the units, which bounds shear [MPa]; None: no bound
    :param fh: horizontal compressive strength of spandrels [MPa]; None: half of ``fm``
    :param slope: height of a unit over its overlap [-]
    :param tie: tensile strength of a lintel, beam or tie at spandrels, for NTC [kN]; None: none
    :returns: a dict for each one and code: the columns of piers.csv. ``run`` is how it gives way in
        the run at its end: the ``failure_mode`` of a wall without openings, else
        :func:`failureOf`; nothing if the run left no joints. ``otherwise`` is a mark where the code
        says another way
    :raises Refused: if the run has no piers and no spandrels
    """
    data = RunData.read(directory)
    run, rows = data.run, []
    if not run.get("piers"):
        raise Refused(f"{directory}: its scene names no piers: scene.pier() does")
    bed = run["joints"].get("bed", {})
    if fm is None and not bed.get("cap", True):
        raise Refused(f"{directory}: its bed joints do not crush: give fm [MPa]")
    fm = 1e-6 * bed["compressiveStrength"] if fm is None else fm
    fh = fm / 2 if fh is None else fh
    fv0 = 1e-6 * bed["cohesion"] if fv0 is None and tau0 is None else fv0
    written = glob.glob(os.path.join(glob.escape(str(directory)), "joints_*.vtp"))
    frame = readFrame(directory, "joints") if written else None
    mode = run.get("failure_mode")
    if "wall" in run and frame:
        data.joints = frame
        mode = data.pattern["failure_mode"]
    values = data.__getitem__ if data.isPush else data.column
    for one in run["piers"]:
        low, high = np.array(one["low_m"]), np.array(one["high_m"])
        size = 1e3 * (high - low)
        along, isPier = int(size[1] > size[0]), one["kind"] == "pier"
        length, height = (size[along], size[2]) if isPier else (size[2], size[along])
        normal, shear, moment = (np.array(values(one[name])) for name in "NVM")
        at = int(np.argmax(np.abs(shear)))
        force, pushed = -float(normal[at]), abs(float(shear[at]))
        if isPier and force <= 0 or not pushed:
            raise Refused(f"{directory}: pier {one['name']} has no compression, or no shear force")
        span = 1e3 * abs(float(moment[at])) / pushed + height / 2
        strength, thickness = fm if isPier else fh, size[1 - along]
        of = (height, length, thickness, span, 1e3 * force, strength, fb, tau0 or 0.0, fv0, slope)
        pier = Pier(*of)
        part = 3 * (length / 2 - span * pushed / force) if force > 0 else 0.0
        moved = 0.1 * float(np.max(np.abs(values(one["drift"])))) if isPier else 0.0
        own = mode
        if frame and not (isPier and mode):
            own = failureOf(frame, low, high, 2 if isPier else along)
        for code in CODES:
            found, clause = predicted(code, pier, isPier, tie)
            says = found.failure
            if not isPier and says == "sliding":  # along no bed
                says = "shear"
            share = "" if found.drift is None else moved / found.drift if found.drift else math.inf
            rows.append(
                {
                    "name": one["name"],
                    "kind": one["kind"],
                    "code": code,
                    "N_kN": force,
                    "V_kN": pushed,
                    "H0_m": 1e-3 * span,
                    "nu": pier.stress / strength,
                    "D_m": 1e-3 * min(length, max(0.0, part)),
                    "failure": found.failure,
                    "clause": clause,
                    "capacity_kN": found.peak,
                    "demand_over_capacity": pushed / found.peak if found.peak else math.inf,
                    "drift_percent": moved if isPier else "",
                    "drift_capacity_percent": "" if found.drift is None else found.drift,
                    "drift_over_capacity": share,
                    "run": own or "",
                    "otherwise": "*" * (ALIKE.get(own, says) != says),
                }
            )
    return rows


@program
def main(words: Sequence[str] | None = None) -> None:
    """The program. Returns its exit status."""
    about, *fields = re.split(r"\n:\w+ ?", inspect.getdoc(check))
    texts = dict(" ".join(field.replace("``", "").split()).split(": ", 1) for field in fields)
    p = argparse.ArgumentParser(prog="python3 -m masonry_capacity.piers", description=about)
    p.add_argument("result", metavar="FOLDER", help=texts["directory"])
    for name in ("fm", "fv0", "tau0", "fb", "fh"):
        p.add_argument(f"--{name}", type=float, metavar="MPA", help=texts[name])
    p.add_argument("--slope", type=float, default=GOOD_BOND, help=texts["slope"])
    p.add_argument("--tie", type=float, metavar="KN", help=texts["tie"])
    args = vars(p.parse_args(words))
    folder = args.pop("result")
    rows, path = check(folder, **args), os.path.join(folder, TABLE)
    text = lambda v: f"{v:.4g}" if isinstance(v, float) else v
    with writing(path), replaced(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(rows[0])
        table.writerows([text(v) for v in row.values()] for row in rows)
    for row in rows:
        say(", ".join(f"{name} {text(v)}" for name, v in row.items() if v != ""))
    say(f"written: {path}")


if __name__ == "__main__":
    sys.exit(main())
