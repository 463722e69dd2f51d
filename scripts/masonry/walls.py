"""Walls in running bond on a fixed block, with a loading block on top.

The walls of the paper (see yade_plugin/law/README.md) are tested like this, in its section 4.
"""

import os
from dataclasses import dataclass
from inspect import signature
from math import inf
from numbers import Real
from typing import Callable

from yade import O, Vector3
from yade.wrapper import MasonryJoint, MasonryLoad, MasonryMat

from . import brickwork, columns, history, materials
from .curves import cycleNumbers, dampedShare, dynamicImbalance, initialStiffness
from .errors import Refused
from .loading import (
    DAMPED,
    IMBALANCE,
    frameSpacing,
    rowCount,
    tooDamped,
    tooFast,
    wayLength,
)
from .model import Model, drawFigures
from .scene import addBlock

BLOCK_HEIGHT = 0.2  # [m] of the fixed block, and of the loading block of a clamped wall


@dataclass
class Wall:
    """A wall in running bond, and how it is held and loaded. Impossible ones raise ValueError, with all problems.

    The wall stands on a fixed block, and carries a loading block that is pressed down and pushed sideways.

    :param name: of its folder of results
    :param title: of its figures
    :param halfUnits: length of the wall in half units, an even number
    :param precompression: mean vertical stress that the top course feels [Pa], 0 or above
    :param loadHeight: height above the base at which the loading block is pushed [m]; the block is free to turn then,
        and the wall is a cantilever. None: the block is pushed as a whole and cannot turn, and the wall is double
        clamped
    :param courses: number of courses
    :param unit: length, thickness and height of a unit, with its joints [m]
    :param measureHeight: height above the base of the displacement in curve.csv [m]; None: the top of the masonry
    :param loadLineFixed: whether the vertical load keeps its line in space, as over rollers; else it rides on the
        loading block
    :param unitMaterial: function that makes the MasonryMat of the units
    :param joints: function that makes the dict of MasonryJoint by name: ``support`` for the joints of the fixed and of
        the loading block, ``bed``, ``head``, and ``crack`` if units can crack in half. It is called with
        ``brittle=True`` or ``brittle=False``, and with ``stiffness="masonry"`` if --joint-stiffness asks for that, which
        is refused if the function has no such argument
    """

    name: str
    title: str
    halfUnits: int
    precompression: float
    loadHeight: float = None
    courses: int = 34
    unit: tuple = (0.220, 0.102, 0.081)
    measureHeight: float = None
    loadLineFixed: bool = False
    unitMaterial: Callable = materials.calciumSilicateUnit
    joints: Callable = materials.calciumSilicateJoints

    def __post_init__(self):
        problems = brickwork.problems(self.courses, self.halfUnits, self.unit)
        shown = lambda value: f"{value:g}" if isinstance(value, Real) else value
        number = lambda value, least: isinstance(value, Real) and least < value < inf
        if not problems:
            top = self.height
            if self.measureHeight is None:
                self.measureHeight = top
            if self.loadHeight is not None and not number(self.loadHeight, top):
                problems.append(
                    f"load height {shown(self.loadHeight)} m must be above the wall's top at {top:g} m"
                )
            if not number(self.measureHeight, top * (1 - 1e-12)):
                problems.append(
                    f"measure height {shown(self.measureHeight)} m must be at least the wall's top at {top:g} m"
                )
        if self.precompression != 0 and not number(self.precompression, 0):
            problems.append(
                f"precompression {shown(self.precompression)} Pa must be at least 0"
            )
        elif 0 < self.precompression < 1e3:
            print(
                f"warning: wall {self.name}: precompression {self.precompression:g} Pa: is it in Pa, not MPa?"
            )
        name = self.name if isinstance(self.name, str) else ""
        if not name.strip(".") or os.path.basename(name) != name:
            problems.append("name must be a text that can name a folder")
        for what in ("unitMaterial", "joints"):
            if not callable(getattr(self, what)):
                problems.append(f"{what} must be a function")
        if problems:
            raise ValueError(f"wall {self.name}: " + "; ".join(problems))

    @property
    def length(self):
        return self.halfUnits * self.unit[0] / 2

    @property
    def height(self):
        return self.courses * self.unit[2]

    @property
    def area(self):
        return self.length * self.unit[1]


class WallModel(Model):
    """A :class:`Wall` in YADE: the blocks ``base`` and ``top``, and the loads ``vertical`` and ``push`` on the top one.

    :param wall: the wall
    :param args: the options of :func:`masonry.options.parser`
    :param functors: as of :func:`masonry.scene.engines`
    """

    columns = columns.WALL

    def __init__(self, wall, args, functors=False):
        self.wall, self.title, self.functors = wall, wall.title, functors
        if args.history:
            self.columns = columns.WALL_LOOPS
        unit = wall.unitMaterial()
        variant = dict(brittle=args.joints == "brittle")
        if args.joint_stiffness != "joint":
            if "stiffness" not in signature(wall.joints).parameters:
                raise Refused(
                    f"--joint-stiffness {args.joint_stiffness}: the joints of this wall have no such variant"
                )
            variant.update(stiffness=args.joint_stiffness)
        joints = wall.joints(**variant)
        if not isinstance(unit, MasonryMat):
            raise ValueError(f"wall {wall.name}: unitMaterial() gave {unit!r}")
        if not isinstance(joints, dict) or not all(
            isinstance(joint, MasonryJoint) for joint in joints.values()
        ):
            raise ValueError(
                f"wall {wall.name}: joints() must give a dict of MasonryJoint by name, gave {joints!r}"
            )
        if args.joints == "cyclic":
            materials.makeCyclic(joints)
        self.halves = args.crack_surfaces == "on"
        problems = []
        if self.halves and "crack" not in joints:
            problems.append("--crack-surfaces on: the units of this wall have none")
        super().__init__(args, unit, joints, problems)
        self.origin = (
            0,
            0,
        )  # displacement of the top when the push began, along it and up [m]
        #: Point of the history that the drive is going to: its number, from 1, and its displacement [mm].
        self.aim = 0, 0.0

    # -- what is built --------------------------------------------------------------------------------------------

    def build(self):
        O.reset()
        self._lay()
        wall, n = self.wall, self.args.divisions
        point = (wall.length / 2, wall.unit[1] / 2, self.loadHeight)
        top = dict(body=self.blocks["top"], point=point)
        self.assemble(
            [joint for name, joint in self.joints.items() if name != "crack"],
            [
                MasonryLoad(label="vertical", **top),
                MasonryLoad(label="push", driven=True, **top),
            ],
            # cells of a half brick along its length; a whole one has twice as many
            divisions=[n if self.halves else 2 * n, 1, n],
            gravity=self.gravity,
            rule=self._rule,
            functors=self.functors,
        )

    def _lay(self):
        """The fixed block, the bricks, and the loading block."""
        wall, rigid = self.wall, materials.loadingBlock()
        rigid.density *= self.args.density_scaling
        O.materials.append([self.unit, rigid])
        length, thickness, height = wall.length, wall.unit[1], wall.height
        self.loadHeight = wall.loadHeight or height + BLOCK_HEIGHT
        base = _box((0, 0, -BLOCK_HEIGHT), (length, thickness, 0), rigid)
        O.bodies[base].state.blockedDOFs = "xyzXYZ"
        for block in brickwork.runningBond(
            wall.courses, wall.halfUnits, wall.unit, self.halves
        ):
            self.bricks[_box(block.low, block.high, self.unit)] = block.brick
        top = _box((0, 0, height), (length, thickness, self.loadHeight), rigid)
        state = self._state = O.bodies[top].state
        if wall.loadHeight is None:
            state.blockedDOFs = "yXYZ"
        self.blocks = {"base": base, "top": top}
        # Rows are read at every few steps: what does not change is kept as plain numbers.
        measured = Vector3(length / 2, thickness / 2, wall.measureHeight)
        arm, self._upright = measured - state.refPos, state.refOri.conjugate()
        self._ownArm = self._upright * arm  # in the axes of the block
        self._arm, self._start = (arm[0], arm[2]), (state.refPos[0], state.refPos[2])
        self._forces = O.forces

    def _rule(self, body1, body2, geom):
        """Halves of one brick share a crack; all other joints are chosen by their direction and joint set."""
        brick = self.bricks.get(body1.id, -1)
        return self.joints["crack"] if brick == self.bricks.get(body2.id) else None

    # -- how it is loaded -----------------------------------------------------------------------------------------

    def weight(self):
        """Weight of all blocks but the fixed one [N]."""
        base = self.blocks["base"]
        return self.gravity * sum(b.state.mass for b in O.bodies if b.id != base)

    def verticalForce(self):
        """Force on the loading block from which, with its weight, the top course feels the precompression [N]."""
        own = self._state.mass * self.gravity
        return self.wall.precompression * self.wall.area - own

    def keepLoadLine(self):
        """Move the point of the vertical load back to its line in space, if that is fixed."""
        if self.wall.loadLineFixed:
            load = self.loads["push"]
            along = load.displacement()[0]
            self.loads["vertical"].point = load.point - Vector3(along, 0, 0)

    # -- what is measured -----------------------------------------------------------------------------------------

    def topDisplacement(self):
        """Displacement of the loading block at the measure height since the wall was built, along the push and up [m]."""
        return self._moved(self._state.ori)

    def _moved(self, orientation):
        now, turned = self._state.pos, orientation * self._ownArm
        along = now[0] + turned[0] - self._start[0] - self._arm[0]
        up = now[2] + turned[2] - self._start[1] - self._arm[1]
        return along, up

    def hasSunk(self, down=None):
        """Whether the loading block has come down by half a course.

        :param down: its displacement downwards [m], if that is known
        """
        down = -self.topDisplacement()[1] if down is None else down
        return down > 0.5 * self.wall.unit[2]

    def read(self):
        orientation = self._state.ori
        along, up = self._moved(orientation)
        return columns.WallReading(
            O.time,
            along - self.origin[0],
            up - self.origin[1],
            self._forces.f(self.blocks["base"], True)[0],
            self.loads["push"].reaction,
            self.energy.balance(),
            orientation,
            self._upright,
            -up,
            *self.aim,
        )

    # -- what comes out -------------------------------------------------------------------------------------------

    def room(self):
        args = self.args
        nodes = len(self.zones.displacements) if self.zones else 0
        frame = 50 * self.subcontacts + 150 * len(O.bodies) + 100 * nodes
        frames = 0 if args.no_vtk else wayLength(args) / frameSpacing(args) + 2
        least = 400e3 + frame * min(frames, 2)  # figures, first and last frame
        return least, least + frame * frames + 250 * rowCount(args)

    def describe(self):
        wall = self.wall
        measures = {
            "length_m": wall.length,
            "height_m": wall.height,
            "thickness_m": wall.unit[1],
            "courses": wall.courses,
            "half_units": wall.halfUnits,
            "unit_m": wall.unit,
            "precompression_Pa": wall.precompression,
            "load_height_m": wall.loadHeight,
            "measure_height_m": wall.measureHeight,
            "load_line_fixed": wall.loadLineFixed,
        }
        told = dict(super().describe(), wall=measures)
        if self.args.history:
            told["history"] = history.describe(self.args.history)
        return told

    def summary(self, column):
        shear, moved = column("base_shear_kN"), column("displacement_mm")
        at = max(range(len(shear)), key=shear.__getitem__)
        imbalance = dynamicImbalance(column("top_shear_kN"), shear)
        found = self._loops(column) if self.args.history else {}
        return dict(
            peak_base_shear_kN=shear[at],
            displacement_at_peak_mm=moved[at],
            base_shear_end_kN=shear[-1],
            displacement_end_mm=moved[-1],
            initial_stiffness_kN_per_mm=initialStiffness(moved, shear),
            dynamic_imbalance=imbalance,
            too_fast=imbalance > IMBALANCE,
            **found,
        )

    def _loops(self, column):
        """What the summary of a wall that follows a history has, too."""
        shear, moved = column("base_shear_kN"), column("displacement_mm")
        at = min(range(len(shear)), key=shear.__getitem__)
        return dict(
            negative_peak_base_shear_kN=shear[at],
            displacement_at_negative_peak_mm=moved[at],
            damped_share=dampedShare(column),
            cycles=cycleNumbers(column, history.noise(self.args.history)),
        )

    def report(self, run):
        if run["too_fast"]:
            yield tooFast(self.args, run["dynamic_imbalance"])
        peak = f"{run['peak_base_shear_kN']:.1f} kN at {run['displacement_at_peak_mm']:.2f} mm"
        end = (
            f"{run['base_shear_end_kN']:.1f} kN at {run['displacement_end_mm']:.2f} mm"
        )
        if not self.args.history:
            yield f"{self.wall.name}: peak {peak}, {end}"
            return
        if run["damped_share"] > DAMPED:
            yield tooDamped(self.args, run["damped_share"])
        other = (
            f"{run['negative_peak_base_shear_kN']:.1f} kN at "
            f"{run['displacement_at_negative_peak_mm']:.2f} mm"
        )
        yield (
            f"{self.wall.name}: {len(run['cycles'])} cycles, peaks {peak} and {other}, {end}"
        )

    def draw(self, directory):
        drawFigures(directory)


def _box(low, high, material):
    """A block with these opposite corners, which stays in the plane of the wall; its body id."""
    return addBlock(brickwork.corners(low, high), material, inPlane=True)
