"""Two bricks and one joint between two loading blocks: the closed forms of law.md §6 through the whole of the host."""

from dataclasses import dataclass

from yade import O, Vector3
from yade.wrapper import MasonryLoad, MasonryZones

from . import brickwork, commit, criticalTimeStep, materials
from .checkpoints import Place, Resumable
from .options import Refused, check
from .results import ENERGIES, conduct, say
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


@dataclass
class CoupletPlace(Place):
    """How far a couplet's test has come."""

    move: int = 0  # number of the present move
    length: int = 0  # its steps in all
    done: int = 0  # and so far


class Couplet(Resumable):
    """Two bricks, one bed joint, a fixed block below and a driven one above that does not turn.

    The blocks are rigid and hold the bricks by elastic joints. ``args`` are the options of ``couplet.py``.
    """

    stages = ("run",)

    def __init__(self, args):
        joints = materials.calciumSilicateJoints(brittle=args.joints == "brittle")
        check(args, joints)
        bed, stress = joints["bed"], -1e6 * args.normal_stress
        crushes = bed.cap and not bed.elastic and stress >= bed.compressiveStrength
        if args.path == "shear" and crushes:
            raise Refused(
                f"--normal-stress {args.normal_stress:g} MPa crushes the bed joint, whose compressive strength is "
                f"{1e-6 * bed.compressiveStrength:g} MPa"
            )
        super().__init__("couplet", args, CURVE, CoupletPlace())
        O.reset()
        brick, rigid = materials.calciumSilicateUnit(), materials.loadingBlock()
        brick.density *= args.density_scaling
        rigid.density *= args.density_scaling
        O.materials.append([brick, rigid])
        length, thickness, height = UNIT
        self.base, lower, upper, self.top = [
            addBlock(
                brickwork.corners(
                    (0, 0, level * height), (length, thickness, (level + 1) * height)
                ),
                material,
                inPlane=True,
            )
            for level, material in enumerate([rigid, brick, brick, rigid], start=-1)
        ]
        O.bodies[self.base].state.blockedDOFs = "xyzXYZ"
        O.bodies[self.top].state.blockedDOFs = "yXYZ"
        self.area = length * thickness
        self.vertical, self.lateral = [
            MasonryLoad(
                body=self.top,
                point=(length / 2, thickness / 2, 2 * height),
                direction=direction,
                label=label,
                driven=True,
            )
            for label, direction in (("vertical", (0, 0, 1)), ("lateral", (1, 0, 0)))
        ]
        self.zones = None
        if args.blocks == "deformable":
            self.zones = MasonryZones(
                bodies=[lower, upper],
                divisions=[2 * args.divisions, 1, args.divisions],
                damping=args.damping,
                dampingKind=args.damping_kind,
                blocked="y",
            )
        engines(
            [joints["support"], joints["bed"]],
            damping=args.damping,
            gravity=(0, 0, 0),
            subcontacts=args.subcontacts,
            inPlane=True,
            loads=[self.vertical, self.lateral],
            zones=self.zones,
        )
        self.energy, integrator = [
            e for e in O.engines if e.label in ("energy", "integrator")
        ]
        if not self.zones:
            integrator.dampingKind = args.damping_kind
        self.joint = next(i for i in connect() if {i.id1, i.id2} == {lower, upper})
        O.dt = args.dt_fraction * criticalTimeStep()[0]
        self.results.checkRoom(1e6, 1e6)
        self.moves = 0
        self._begin()

    def _move(self, load, distance, stage):
        """Drive ``load`` over a distance [m]; the other direction keeps what it does. Rows crowd where peaks are: early."""
        at = self.at
        self.moves += 1
        if self.moves < at.move:  # before the run was resumed
            return
        if self.moves > at.move:
            speed = self.args.rate * 1e-3
            at.length = max(ROWS, int(abs(distance) / (speed * O.dt)))
            at.move, at.done = self.moves, 0
            load.velocity = distance / (at.length * O.dt)
        for mark in sorted(
            {round(at.length * (i / ROWS) ** 2) for i in range(1, ROWS + 1)}
        ):
            if mark <= at.done:
                continue
            self._advance(mark - at.done)
            at.done = mark
            self._record()
            self.progress.show(
                stage,
                at.done / at.length,
                f"{self.results.rows[-1][1]:9.4f} mm {self.results.rows[-1][2]:9.4f} mm",
                self._rate(),
            )
        load.velocity = 0

    def _mean(self, values):
        """Mean over the bed joint of a number of every subcontact."""
        areas = self.joint.geom.areas
        return sum(a * v for a, v in zip(areas, values)) / self.area

    def _normalStress(self):
        return self._mean(s[0] for s in self.joint.phys.stress)

    def _record(self):
        phys, geom, mean = self.joint.phys, self.joint.geom, self._mean
        e = self.energy.balance()
        force = O.forces.f(self.base, True)
        values = {
            "time_s": O.time,
            "opening_mm": 1e3 * mean(phys.opening),
            "slide_mm": 1e3 * mean(j[1] for j in geom.jumps),
            "normal_stress_MPa": 1e-6 * self._normalStress(),
            "shear_stress_MPa": 1e-6 * mean(s[1] for s in phys.stress),
            "normal_force_kN": 1e-3 * force[2],
            "shear_force_kN": 1e-3 * force[0],
            "balance_error": e["error"],
        }
        values.update({name + "_J": e[name] for name in ENERGIES})
        self.results.row(values)

    def _close(self, stress):
        """Close the joint elastically to a normal stress [Pa], then hold that by the force: nothing swings."""
        distance = stress / self.joint.phys.normalStiffness
        self._move(self.vertical, distance, "closure")
        # the blocks' joints, and units that are deformable, have taken their part
        if stress:
            distance *= stress / self._normalStress() - 1
            self._move(self.vertical, distance, "closure")
        self.vertical.driven = False
        self.vertical.force = Vector3(0, 0, stress * self.area)

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
            self._close(args.normal_stress * 1e6)
            self._move(self.lateral, distance, "shear")

    def _describe(self):
        results = self.results
        if results.rows:
            results.run.update(
                scene="couplet",
                options=dict(vars(self.args)),
                commit=commit,
                time_step_s=O.dt,
                steps=self.at.steps,
                resumed_at_s=self.at.resumed,
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

    def _report(self):
        for key in (
            "peak_normal_stress_MPa",
            "peak_compressive_stress_MPa",
            "peak_shear_stress_MPa",
            "end_shear_stress_MPa",
        ):
            if key in self.results.run:
                say(f"{key:32} {self.results.run[key]:.4f}")


def test(args):
    """Run the couplet; the exit status of the scene."""
    return conduct(lambda: Couplet(args))
