# SPDX-License-Identifier: GPL-2.0-or-later
"""A small wall pushed to and fro for two million steps: memory must stay flat, and the energy
balance closed.

yade -n -x validation/stability/soak.py [STEPS]

Prints, twenty times: steps, memory of the process, error of the balance, base shear and energy lost
in the joints.
"""

import os
import resource
import sys
import tempfile

from yade import O

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
from observed import BLOCKS, Observed, Point  # noqa: E402
from studies import head, line  # noqa: E402

AMPLITUDE, RATE = 1.0, 50.0  # [mm], [mm/s]
REPORTS = 20


def memory():
    """Resident memory of this process [MB]."""
    with open("/proc/self/statm") as f:
        return int(f.read().split()[1]) * resource.getpagesize() / 1e6


def soak(blocks, steps):
    """Rows of steps, memory [MB], largest error of the balance [-], base shear [kN] and energy lost
    in the joints [J]."""
    with tempfile.TemporaryDirectory() as folder:
        m = Observed(Point(0), blocks, folder)
        m.rest()
        model = m.model
        quarter = int(AMPLITUDE / RATE / O.dt)
        rows, done, direction, leg = [], 0, 1, quarter
        for report in range(1, REPORTS + 1):
            while done < report * steps // REPORTS:
                model.loading.push.velocity = direction * RATE * 1e-3
                O.run(leg, True)
                done, direction, leg = done + leg, -direction, 2 * quarter
            e = model.energy.balance()
            m.look()
            lost = sum(v for k, v in e.items() if k.startswith("dissipated"))
            shear = 1e-3 * O.forces.f(m.targets["base"].body, True)[0]
            rows.append((done, memory(), model.energy.largestError, shear, lost))
    return rows


def main(steps=2_000_000):
    print(head("units, steps, memory MB, balance error, base shear kN, lost J".split(", ")))
    fine = True
    for blocks in BLOCKS:
        rows = soak(blocks, steps)
        for done, used, error, shear, lost in rows:
            numbers = f"{used:.1f}", f"{error:.0e}", f"{shear:.2f}", f"{lost:.1f}"
            print(line([blocks, done, *numbers]))
        fine = fine and rows[-1][1] - rows[1][1] < 1 and rows[-1][2] < 0.01
    return fine


if __name__ == "__main__":
    raise SystemExit(not main(*map(int, sys.argv[1:])))
