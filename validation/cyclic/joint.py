# SPDX-License-Identifier: GPL-2.0-or-later
"""One joint in cycles: tension, shear under three normal stresses, closure. The rows of every path
go to a CSV file.

yade -n -x validation/cyclic/joint.py                        # both laws, into results/
yade -n -x validation/cyclic/joint.py --laws softening       # one of them
yade -n -x validation/cyclic/joint.py --set shearStiffnessLoss=0.5

Two blocks that do not deform share one bed joint of the calcium-silicate walls (table 2 of the
paper). The lower block is fixed, and the upper one is driven without turning, so that all points of
the joint do the same and the curves are those of the law itself. ``figures.py`` draws them.
"""

import argparse
import csv
import os
import sys

from masonry import MasonryJoint, addBlock, bricks, connect, criticalTimeStep, engines, materials
from masonry.errors import Refused
from masonry.materials.settings import applySettings
from yade import O, Vector3
from yade.wrapper import MasonryLoad

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))  # in YADE, __file__ is YADE
RESULTS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "results")
UNIT = (0.220, 0.102, 0.081)  # [m] length, thickness, height of a block
AREA = UNIT[0] * UNIT[1]  # [m²] of the joint
LAWS = ("softening", "cyclic")
STRESSES = (0.0, -0.5e6, -1.0e6)  # [Pa] normal stresses in shear
OPENINGS = (0.02e-3, 0.06e-3, 0.15e-3, 0.3e-3)  # [m] opened to, one after the other
CLOSED = -1e-6  # [m] opening to which a crack is closed between two openings
SLIDES = (0.25e-3, 0.5e-3, 1e-3, 2e-3, 3e-3)  # [m] amplitudes of shear
CLOSURES = (0.2e-3, 0.6e-3, 1.2e-3, 1.8e-3, 2.6e-3)  # [m] closed to
COLUMNS = (
    "opening_mm",
    "slide_mm",
    "normal_stress_MPa",
    "shear_stress_MPa",
)


class Joint:
    """Two rigid blocks with one joint, and the rows that are read of it.

    :param joint: MasonryJoint
    :param steps: time steps for every row
    """

    def __init__(self, joint, steps):
        O.reset()
        self.steps, self.rows = steps, []
        rigid = materials.loadingBlock()
        O.materials.append(rigid)
        length, thickness, height = UNIT
        lower, upper = [
            addBlock(
                bricks.boxCorners((0, 0, z), (length, thickness, z + height)),
                rigid,
                inPlane=True,
            )
            for z in (-height, 0.0)
        ]
        O.bodies[lower].state.blockedDOFs = "xyzXYZ"
        O.bodies[upper].state.blockedDOFs = "yXYZ"
        top = dict(body=upper, point=(length / 2, thickness / 2, height), driven=True)
        self.vertical = MasonryLoad(label="vertical", direction=(0, 0, 1), **top)
        self.lateral = MasonryLoad(label="lateral", direction=(1, 0, 0), **top)
        engines(
            [joint],
            gravity=(0, 0, 0),
            inPlane=True,
            loads=[self.vertical, self.lateral],
        )
        connect()
        self.interaction = O.interactions[lower, upper]
        O.dt = 0.8 * criticalTimeStep()[0]
        self.read()

    def mean(self, values):
        areas = self.interaction.geom.areas
        return sum(a * v for a, v in zip(areas, values)) / sum(areas)

    def read(self):
        """Append a row: means over the joint, in the units of COLUMNS. Returns it.

        The jumps are those that the stresses were calculated from; the loads have moved on by a
        time step.
        """
        phys = self.interaction.phys
        opening = self.mean(phys.opening)
        slide = self.mean(jump[1] for jump in self.interaction.geom.jumps)
        normal, shear = (self.mean(s[i] for s in phys.stress) for i in (0, 1))
        self.rows.append((1e3 * opening, 1e3 * slide, 1e-6 * normal, 1e-6 * shear))
        return self.rows[-1]

    def advance(self, steps):
        for _ in range(steps):
            O.step()

    def drive(self, load, target, rows, until=lambda row: False):
        """Move along the direction of a load to a displacement [m], in so many rows, or until a row
        says so."""
        axis = 2 if load is self.vertical else 0
        distance = target - load.displacement()[axis]
        load.velocity = distance / (rows * self.steps * O.dt)
        for _ in range(rows):
            self.advance(self.steps)
            if until(self.read()):
                break
        load.velocity = 0

    def press(self, stress):
        """Close the joint elastically to a normal stress [Pa], then hold that by the force."""
        if stress:
            # slowly: the block has no damping, and would swing on the joint
            self.drive(self.vertical, stress / self.interaction.phys.normalStiffness, 400)
        self.vertical.driven = False
        self.vertical.force = Vector3(0, 0, stress * AREA)
        self.advance(20 * self.steps)
        self.rows.clear()
        self.read()


def tension(joint, steps, rows):
    path = Joint(joint, steps)
    for opening in OPENINGS:
        path.drive(path.vertical, opening, rows)
        path.drive(path.vertical, CLOSED, rows)
    path.drive(path.vertical, OPENINGS[-1] * 1.5, rows)
    return path.rows


def shear(joint, steps, rows, stress):
    path = Joint(joint, steps)
    path.press(stress)
    for slide in SLIDES:
        path.drive(path.lateral, slide, rows)
        path.drive(path.lateral, -slide, rows)
    path.drive(path.lateral, 0.0, rows)
    return path.rows


def closure(joint, steps, rows):
    path = Joint(joint, steps)
    for closed in CLOSURES:
        path.drive(path.vertical, -closed, rows)
        # back until nothing presses any more, at the latest where the joint was at the beginning
        path.drive(path.vertical, 0.0, rows, until=lambda row: row[2] >= -1e-9)
    path.drive(path.vertical, -1.3 * CLOSURES[-1], rows)
    return path.rows


def paths():
    """Every path by name: a function of a joint, the steps for a row and the rows for a way."""
    found = {"tension": tension, "closure": closure}
    for stress in STRESSES:
        found[f"shear_{abs(stress) / 1e6:g}"] = lambda joint, steps, rows, stress=stress: shear(
            joint, steps, rows, stress
        )
    return found


def bedJoint(law, settings=()):
    """A bed joint of the calcium-silicate walls under a law, with other properties if the user
    wants them.

    The block's own jointSet does not matter, as there is no other joint.
    """
    joint = MasonryJoint(name="bed", law=law)
    applySettings({"bed": joint}, settings)
    return joint


def setting(text):
    name, equals, value = text.partition("=")
    if not (equals and name and value):
        raise argparse.ArgumentTypeError(f"'{text}' must read PROPERTY=VALUE")
    return "bed", name, value


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--laws", nargs="+", choices=LAWS, default=LAWS)
    parser.add_argument(
        "--set",
        metavar="PROPERTY=VALUE",
        type=setting,
        action="append",
        default=[],
        help="change a property of the joint, in SI units; repeatable",
    )
    parser.add_argument("--rows", type=int, default=400, help="for every way")
    parser.add_argument("--steps", type=int, default=50, help="for every row")
    parser.add_argument("--out", default=os.path.join(RESULTS, "validation", "cyclic", "joint"))
    args = parser.parse_args()
    for law in args.laws:
        folder = os.path.join(args.out, law)
        os.makedirs(folder, exist_ok=True)
        for name, path in paths().items():
            try:
                rows = path(bedJoint(law, args.set), args.steps, args.rows)
            except Refused as refused:
                raise SystemExit(str(refused)) from None
            with open(os.path.join(folder, f"{name}.csv"), "w", newline="") as f:
                writer = csv.writer(f)
                writer.writerow(COLUMNS)
                writer.writerows([[f"{x:.9g}" for x in row] for row in rows])
            print(f"{law} {name}: {len(rows)} rows", flush=True)


main()
