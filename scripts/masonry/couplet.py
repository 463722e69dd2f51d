"""Two bricks and one joint, against the closed forms of law.md §6 through the whole of the host."""

import os
import time

from yade import O, Vector3
from yade.wrapper import MasonryLoad, MasonryVtkRecorder

from . import brickwork, commit, criticalTimeStep, materials
from .options import applySettings, checkBlocks
from .results import ENERGIES, Progress, Results, conduct
from .scene import addBlock, connect, engines

PATHS = ["opening", "shear", "closure", "closure-shear"]
CURVE = [
    "time_s",
    "opening_mm",
    "slide_mm",
    "normal_stress_MPa",
    "shear_stress_MPa",
    "normal_force_kN",
    "shear_force_kN",
]
CURVE += [name + "_J" for name in ENERGIES] + ["balance_error"]
UNIT = (0.220, 0.102, 0.081)
ROWS = 2000


class Couplet:
    """Two bricks, one bed joint. ``args`` are the options of ``couplet.py``."""

    def __init__(self, args):
        checkBlocks(args, deformable=False)
        joints = materials.calciumSilicateJoints(brittle=args.joints == "brittle")
        applySettings(joints, args.set)
        self.args, self.results = args, Results(
            args.out or os.path.join("results", "couplet"), CURVE
        )
        O.reset()
        brick = materials.calciumSilicateUnit()
        O.materials.append(brick)
        length, thickness, height = UNIT
        lower = addBlock(brickwork.corners((0, 0, 0), UNIT), brick, inPlane=True)
        self.upper = addBlock(
            brickwork.corners((0, 0, height), (length, thickness, 2 * height)),
            brick,
            inPlane=True,
        )
        O.bodies[lower].state.blockedDOFs = "xyzXYZ"
        self.area = length * thickness
        normal, shear = Vector3(0, 0, 1), Vector3(1, 0, 0)
        middle = Vector3(length / 2, thickness / 2, height)
        self.vertical = MasonryLoad(
            body=self.upper,
            point=middle,
            direction=normal,
            label="vertical",
            driven=True,
        )
        self.lateral = MasonryLoad(
            body=self.upper, point=middle, direction=shear, label="lateral", driven=True
        )
        O.bodies[self.upper].state.blockedDOFs = "yXYZ"
        engines(
            [joints["bed"]],
            damping=args.damping,
            gravity=(0, 0, 0),
            subcontacts=args.subcontacts,
            inPlane=True,
            loads=[self.vertical, self.lateral],
        )
        self.energy = next(e for e in O.engines if e.label == "energy")
        (self.joint,) = connect()
        O.dt = args.dt_fraction * criticalTimeStep()[0]
        self.steps, self.progress = 0, Progress()
        self.vtk = (
            None
            if args.no_vtk
            else MasonryVtkRecorder(directory=self.results.directory)
        )

    def _move(self, load, distance, stage):
        """Drive ``load`` over a distance [m], rows on the way; the other direction keeps what it does."""
        speed = self.args.rate * 1e-3
        steps = max(ROWS, int(abs(distance) / (speed * O.dt)))
        load.velocity = distance / (steps * O.dt)
        every = max(1, steps // ROWS)
        for done in range(0, steps, every):
            self.results.checkInterrupt()
            for _ in range(min(every, steps - done)):
                O.step()
                self.steps += 1
            self._record()
            self.progress.show(
                stage,
                done / steps,
                f"{self.results.rows[-1][1]:9.4f} mm {self.results.rows[-1][2]:9.4f} mm",
                self.steps / (time.perf_counter() - self.results.started),
            )
        load.velocity = 0

    def _record(self):
        phys, geom = self.joint.phys, self.joint.geom
        mean = lambda values: sum(a * v for a, v in zip(geom.areas, values)) / self.area
        e = self.energy.balance()
        values = {
            "time_s": O.time,
            "opening_mm": 1e3 * mean(phys.opening),
            "slide_mm": 1e3 * mean(j[1] for j in geom.jumps),
            "normal_stress_MPa": 1e-6 * mean(s[0] for s in phys.stress),
            "shear_stress_MPa": 1e-6 * mean(s[1] for s in phys.stress),
            "normal_force_kN": 1e-3 * O.forces.f(0, True)[2],
            "shear_force_kN": 1e-3 * O.forces.f(0, True)[0],
            "balance_error": e["error"],
        }
        values.update({name + "_J": e[name] for name in ENERGIES})
        self.results.row(values)

    def run(self):
        args, distance = self.args, self.args.until * 1e-3
        if args.path == "opening":
            self._move(self.vertical, distance, "opening")
        elif args.path == "closure":
            self._move(self.vertical, -distance, "closure")
        elif args.path == "closure-shear":
            self._move(self.vertical, -args.closure * 1e-3, "closure")
            self._move(self.lateral, distance, "shear")
        else:
            # closed by just the elastic amount, then held by the force: nothing swings
            self._move(
                self.vertical,
                args.normal_stress * 1e6 / self.joint.phys.normalStiffness,
                "closure",
            )
            O.step()
            self.vertical.driven, self.vertical.force = False, Vector3(
                0, 0, args.normal_stress * 1e6 * self.area
            )
            self._move(self.lateral, distance, "shear")

    def finish(self):
        results = self.results
        if results.rows:
            if self.vtk:
                self.vtk()
            results.run.update(
                scene="couplet",
                options=dict(vars(self.args)),
                commit=commit,
                time_step_s=O.dt,
                steps=self.steps,
                peak_normal_stress_MPa=max(results.column("normal_stress_MPa")),
                peak_compressive_stress_MPa=-min(results.column("normal_stress_MPa")),
                peak_shear_stress_MPa=max(results.column("shear_stress_MPa")),
                end_normal_stress_MPa=results.column("normal_stress_MPa")[-1],
                end_shear_stress_MPa=results.column("shear_stress_MPa")[-1],
                energy_balance_error=self.energy.largestError,
                **{
                    f"dissipated_{mode}_J_per_m2": results.column(
                        f"dissipated_{mode}_J"
                    )[-1]
                    / self.area
                    for mode in ("tension", "shear", "compression")
                },
            )
        results.close()
        for key in (
            "peak_normal_stress_MPa",
            "peak_compressive_stress_MPa",
            "peak_shear_stress_MPa",
            "end_shear_stress_MPa",
        ):
            if key in results.run:
                print(f"{key:32} {results.run[key]:.4f}")


def test(args):
    """Run the couplet; the exit status of the scene."""
    return conduct(lambda: Couplet(args), "run")
