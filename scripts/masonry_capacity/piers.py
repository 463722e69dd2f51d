# SPDX-License-Identifier: GPL-2.0-or-later
"""Strength and drift capacity of piers by EN 1998-3:2005 and NTC 2018, beside what a run found in
them.

    /usr/bin/python3 -m masonry_capacity.piers results/WALL --fb 20  # [MPa]; writes piers.csv

``scene.pier()`` says what the piers are. Strengths are those of the bed joints of the run if
they are not given: means without safety factors, with a confidence factor of 1. Clauses are cited
from memory.
"""

import argparse
import csv
import glob
import math
import os
import sys
from dataclasses import dataclass
from typing import Annotated, Any, Sequence

import numpy as np

from masonry.arguments import FilePath, number, orNone, validated
from masonry.errors import Refused
from masonry.folders import replaced, writing
from masonry.materials.codes import LOCAL_FRICTION, MAX_SHEAR
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
Strength = Annotated[float | None, orNone(number("MPa", 0, 1e3, above=True))]


@validated
def check(
    directory: FilePath,
    fm: Strength = None,
    fv0: Strength = None,
    tau0: Strength = None,
    fb: Strength = None,
    slope: Annotated[float, number("", 0.1, 100)] = GOOD_BOND,
) -> list[dict[str, Any]]:
    """Check the piers of a run by both codes, each where its shear force is largest.

    The span H0 = M/V + h/2 is that of the larger moment at foot and head, from the moment M at
    mid-height; ν = N/(A fm); D' = 3 (L/2 - H0 V/N), at most L, is the compressed part under the
    forces of the run, all without signs.

    :param directory: folder of results
    :param fm: compressive strength, and ``fv0``: cohesion of the bed joint [MPa]; None: those of
        the joint "bed" of the run
    :param tau0: for masonry without regular bond in place of ``fv0`` [MPa]
    :param fb: compressive strength of the units, which bounds shear [MPa]; None: no bound
    :param slope: height of a unit over its overlap [-]
    :returns: a dict for each pier and code: the columns of piers.csv. ``otherwise`` is a mark where
        the run fails in another way than the code says, by the ``failure_mode`` of its wall, which
        a wall with openings does not have
    :raises Refused: if the run has no piers
    """
    data = RunData.read(directory)
    run, rows = data.run, []
    if not run.get("piers"):
        raise Refused(f"{directory}: its scene names no piers: scene.pier() does")
    bed = run["joints"].get("bed", {})
    if fm is None and not bed.get("cap", True):
        raise Refused(f"{directory}: its bed joints do not crush: give fm [MPa]")
    fm = 1e-6 * bed["compressiveStrength"] if fm is None else fm
    fv0 = 1e-6 * bed["cohesion"] if fv0 is None and tau0 is None else fv0
    mode = run.get("failure_mode")
    if "wall" in run and glob.glob(os.path.join(glob.escape(str(directory)), "joints_*.vtp")):
        data.joints = readFrame(directory, "joints")
        mode = data.pattern["failure_mode"]
    values = data.__getitem__ if data.isPush else data.column
    for one in run["piers"]:
        length, thickness, height = (1e3 * one[n] for n in ("length_m", "thickness_m", "height_m"))
        normal, shear, moment, drift = (np.array(values(one[n])) for n in ("N", "V", "M", "drift"))
        at = int(np.argmax(np.abs(shear)))
        force, pushed = -float(normal[at]), abs(float(shear[at]))
        if force <= 0 or not pushed:
            raise Refused(f"{directory}: pier {one['name']} has no compression, or no shear force")
        span = 1e3 * abs(float(moment[at])) / pushed + height / 2
        of = (height, length, thickness, span, 1e3 * force, fm, fb, tau0 or 0.0, fv0, slope)
        pier = Pier(*of)
        part = min(length, max(0.0, 3 * (length / 2 - span * pushed / force)))
        moved = 0.1 * float(np.max(np.abs(drift)))
        for code, rule in CODES.items():
            found = rule(pier)
            other = mode in ALIKE and ALIKE[mode] != found.failure
            rows.append(
                {
                    "pier": one["name"],
                    "code": code,
                    "N_kN": force,
                    "V_kN": pushed,
                    "H0_m": 1e-3 * span,
                    "nu": pier.stress / fm,
                    "D_m": 1e-3 * part,
                    "failure": found.failure,
                    "clause": CLAUSES[code, found.failure],
                    "capacity_kN": found.peak,
                    "demand_over_capacity": pushed / found.peak if found.peak else math.inf,
                    "drift_percent": moved,
                    "drift_capacity_percent": found.drift,
                    "drift_over_capacity": moved / found.drift if found.drift else math.inf,
                    "run": mode or "",
                    "otherwise": "*" * bool(other),
                }
            )
    return rows


@program
def main(words: Sequence[str] | None = None) -> None:
    """The program. Returns its exit status."""
    p = argparse.ArgumentParser(prog="python3 -m masonry_capacity.piers", description=check.__doc__)
    p.add_argument("result", metavar="FOLDER", help="folder of results")
    for name in ("fm", "fv0", "tau0", "fb"):
        p.add_argument(f"--{name}", type=float, metavar="MPA", help="strength [MPa]")
    p.add_argument("--slope", type=float, default=GOOD_BOND, help="height over overlap of a unit")
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
