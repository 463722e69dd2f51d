"""Two bricks and one bed joint between a fixed block and a driven one.

The closed forms for its paths are in yade_plugin/law/README.md (yield surfaces, softening tables, compression).
"""

from yade import O, Vector3
from yade.wrapper import MasonryLoad

from . import brickwork, columns, materials
from .errors import Refused
from .loading import drive
from .model import Model
from .scene import addBlock

PATHS = ["opening", "shear", "closure", "closure-shear"]
UNIT = (0.220, 0.102, 0.081)  # [m] length, thickness, height of a brick
AREA = UNIT[0] * UNIT[1]  # [m²] of the bed joint


class CoupletModel(Model):
    """Two bricks on each other, and the loads ``vertical`` and ``lateral`` on the block that drives the upper one.

    The fixed and the driven block are rigid and hold the bricks by elastic joints. The driven block cannot turn.

    :param args: the options of ``couplet.py``
    """

    title = "couplet"
    columns = columns.COUPLET

    def __init__(self, args):
        joints = materials.calciumSilicateJoints(brittle=args.joints == "brittle")
        if args.joints == "cyclic":
            materials.makeCyclic(joints)
        super().__init__(args, materials.calciumSilicateUnit(), joints)
        bed, stress = joints["bed"], -1e6 * args.normal_stress
        crushes = bed.cap and not bed.elastic and stress >= bed.compressiveStrength
        if args.path == "shear" and crushes:
            raise Refused(
                f"--normal-stress {args.normal_stress:g} MPa crushes the bed joint, whose compressive strength is "
                f"{1e-6 * bed.compressiveStrength:g} MPa"
            )

    def build(self):
        O.reset()
        args, rigid = self.args, materials.loadingBlock()
        rigid.density *= args.density_scaling
        O.materials.append([self.unit, rigid])
        length, thickness, height = UNIT
        base, lower, upper, top = [
            addBlock(
                brickwork.corners(
                    (0, 0, level * height), (length, thickness, (level + 1) * height)
                ),
                material,
                inPlane=True,
            )
            for level, material in enumerate(
                [rigid, self.unit, self.unit, rigid], start=-1
            )
        ]
        O.bodies[base].state.blockedDOFs = "xyzXYZ"
        O.bodies[top].state.blockedDOFs = "yXYZ"
        self.blocks = {"base": base, "lower": lower, "upper": upper, "top": top}
        self.bricks = {lower: 0, upper: 1}
        driven = dict(
            body=top, point=(length / 2, thickness / 2, 2 * height), driven=True
        )
        self.assemble(
            [self.joints["support"], self.joints["bed"]],
            [
                MasonryLoad(label="vertical", direction=(0, 0, 1), **driven),
                MasonryLoad(label="lateral", direction=(1, 0, 0), **driven),
            ],
            damping=args.damping_kind,
            divisions=[2 * args.divisions, 1, args.divisions],
        )
        between = {lower, upper}
        self.bed = next(i for i in self.interactions if {i.id1, i.id2} == between)

    def mean(self, values):
        """Mean over the bed joint of a number of every subcontact."""
        areas = self.bed.geom.areas
        return sum(a * v for a, v in zip(areas, values)) / AREA

    def normalStress(self):
        """Mean normal stress of the bed joint [Pa], positive in tension."""
        return self.mean(s[0] for s in self.bed.phys.stress)

    def read(self):
        phys, geom = self.bed.phys, self.bed.geom
        force = O.forces.f(self.blocks["base"], True)
        stress = phys.stress
        return columns.CoupletReading(
            time=O.time,
            opening=self.mean(phys.opening),
            slide=self.mean(j[1] for j in geom.jumps),
            normalStress=self.mean(s[0] for s in stress),
            shearStress=self.mean(s[1] for s in stress),
            normalForce=force[2],
            shearForce=force[0],
            energy=self.energy.balance(),
        )

    def brief(self, reading):
        """A reading in few words."""
        return f"{1e3 * reading.opening:9.4f} mm {1e3 * reading.slide:9.4f} mm"

    def summary(self, column):
        normal, shear = column("normal_stress_MPa"), column("shear_stress_MPa")
        dissipated = {
            f"dissipated_{mode}_J_per_m2": column(f"dissipated_{mode}_J")[-1] / AREA
            for mode in ("tension", "shear", "compression")
        }
        return dict(
            peak_normal_stress_MPa=max(normal),
            peak_compressive_stress_MPa=-min(normal),
            peak_shear_stress_MPa=max(shear),
            end_normal_stress_MPa=normal[-1],
            end_shear_stress_MPa=shear[-1],
            **dissipated,
        )

    def report(self, run):
        for key in (
            "peak_normal_stress_MPa",
            "peak_compressive_stress_MPa",
            "peak_shear_stress_MPa",
            "end_shear_stress_MPa",
        ):
            yield f"{key:32} {run[key]:.4f}"


def press(run, model, stress):
    """Close the bed joint elastically to a normal stress [Pa], then hold that by the force: nothing swings."""
    distance = stress / model.bed.phys.normalStiffness
    drive(run, model, "vertical", distance)
    # the joints of the blocks, and bricks that are deformable, have taken their part of the way
    if stress:
        distance *= stress / model.normalStress() - 1
        drive(run, model, "vertical", distance)
    vertical = model.loads["vertical"]
    vertical.driven = False
    vertical.force = Vector3(0, 0, stress * AREA)
