"""Walls under precompression and a lateral push: paper §4, validation.md §1."""

import os
import subprocess
import sys
from dataclasses import dataclass, field
from math import inf
from numbers import Real
from typing import Callable

import yade.config
from yade import O, Vector3
from yade.wrapper import MasonryJoint, MasonryLoad, MasonryMat, MasonryZones

from . import brickwork, commit, criticalTimeStep, materials, options
from .checkpoints import Place, Resumable
from .options import Refused
from .results import ENERGIES, Unwritable, conduct, haste, initialStiffness, say
from .scene import addBlock, connect, engines

CURVE = [
    "time_s",
    "displacement_mm",
    "base_shear_kN",
    "top_shear_kN",
    "vertical_mm",
    "rotation_mrad",
]
CURVE += [name + "_J" for name in ENERGIES] + ["balance_error"]

BLOCK_HEIGHT = 0.2  # [m] of the support, and of the loading block of a clamped wall
RAMP = 0.02  # [s] in which precompression and velocity grow: some ten periods of a wave through the height
SETTLING = 0.5  # local damping of zones until the push: with more they creep to rest, with less they swing
REST = 5e-3  # of the vertical load: what may be missing at the base before the push
ROW_EVERY = 0.01  # [mm] between rows of curve.csv
HASTE = 0.1  # a push with more is too fast: its peak is off by 1 to 5 % and more, validation/trade


@dataclass
class Wall:
    """A running-bond wall and its test, in SI units.

    ``loadHeight`` is h0 of a cantilever: the height above the base at which the loading block is pushed and free to
    turn; None is double clamped. ``halfUnits`` is the length in half units. ``measureHeight`` is the height above the
    base of the displacement in curve.csv; None is the top of the masonry. ``loadLineFixed``: the vertical load
    keeps its line in space, as over rollers, instead of riding on the loading block. ``unitMaterial`` and ``joints``
    make the unit's MasonryMat and the dict of MasonryJoint (of whether they are brittle).
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


@dataclass
class WallPlace(Place):
    """How far a wall's test has come."""

    done: int = 0  # steps towards rest
    quiet: int = 0  # times in a row that it was at rest
    origin: list = field(default_factory=list)  # of the push: displacement [m]
    began: float = 0.0  # and time [s]
    moved: float = 0.0  # [mm]
    peak: float = 0.0  # [kN]
    peakAt: float = 0.0  # [mm]
    nextFrame: float = 0.0  # [mm]


class WallModel(Resumable):
    """The wall in YADE, and the stages of its test. ``args`` are the options of :func:`masonry.options.parser`."""

    stages = ("settle", "push")

    def __init__(self, wall, args):
        self.wall = wall
        self.brick = wall.unitMaterial()
        self.joints = wall.joints(brittle=args.joints == "brittle")
        if not isinstance(self.brick, MasonryMat):
            raise ValueError(f"wall {wall.name}: unitMaterial() gave {self.brick!r}")
        if not isinstance(self.joints, dict) or not all(
            isinstance(joint, MasonryJoint) for joint in self.joints.values()
        ):
            raise ValueError(
                f"wall {wall.name}: joints() must give a dict of MasonryJoint by name, gave {self.joints!r}"
            )
        lacking = args.crack_surfaces == "on" and "crack" not in self.joints
        options.check(
            args,
            self.joints,
            ["--crack-surfaces on: the units of this wall have none"] * lacking,
        )
        super().__init__(wall.name, args, CURVE, WallPlace())
        if not args.until > self.at.moved:
            raise Refused(
                f"--until {args.until:g}: the run is at {self.at.moved:.2f} mm already"
            )
        self.preset = options.presetOf(args, wall.name)
        if self.preset:
            say(options.presetNote(self.preset, wall.name))
        self.collapsed = False
        with self._timed("setup"):
            self._build()
        self._begin()

    def _build(self):
        O.reset()
        wall = self.wall
        brick, rigid = self.brick, materials.loadingBlock()
        # heavier and less attracted: the same weights, slower waves, and a longer time step
        scaling = self.args.density_scaling
        for material in (brick, rigid):
            material.density *= scaling
        self.gravity, self.ramp = 9.81 / scaling, RAMP * scaling**0.5
        O.materials.append([brick, rigid])
        length, thickness, height = wall.length, wall.unit[1], wall.height
        top = wall.loadHeight or height + BLOCK_HEIGHT
        self.base = addBlock(
            brickwork.corners((0, 0, -BLOCK_HEIGHT), (length, thickness, 0)),
            rigid,
            inPlane=True,
        )
        O.bodies[self.base].state.blockedDOFs = "xyzXYZ"
        self.brickOf = {}
        for block in brickwork.runningBond(
            wall.courses,
            wall.halfUnits,
            wall.unit,
            halves=self.args.crack_surfaces == "on",
        ):
            self.brickOf[
                addBlock(brickwork.corners(block.low, block.high), brick, inPlane=True)
            ] = block.brick
        self.top = addBlock(
            brickwork.corners((0, 0, height), (length, thickness, top)),
            rigid,
            inPlane=True,
        )
        topState = O.bodies[self.top].state
        if wall.loadHeight is None:
            topState.blockedDOFs = "yXYZ"

        point = (length / 2, thickness / 2, top)
        self.vertical = MasonryLoad(body=self.top, point=point, label="vertical")
        self.load = MasonryLoad(body=self.top, point=point, driven=True, label="load")
        found = [joint for name, joint in self.joints.items() if name != "crack"]
        self.zones = None
        if self.args.blocks == "deformable":
            n = self.args.divisions
            along = n if self.args.crack_surfaces == "on" else 2 * n
            self.zones = MasonryZones(
                bodies=list(self.brickOf),
                divisions=[along, 1, n],
                damping=self.args.damping,
                dampingKind="local",  # brings a wall to rest; the push has its own
                blocked="y",
                label="zones",
            )
        engines(
            found,
            damping=self.args.damping,
            gravity=(0, 0, -self.gravity),
            subcontacts=self.args.subcontacts,
            inPlane=True,
            loads=[self.vertical, self.load],
            zones=self.zones,
        )
        self.energy, self.integrator = [
            e for e in O.engines if e.label in ("energy", "integrator")
        ]
        crack = self.joints.get("crack")
        sameBrick = lambda b1, b2: b1.id in self.brickOf and self.brickOf[
            b1.id
        ] == self.brickOf.get(b2.id)
        self.interactions = connect(
            lambda b1, b2, geom: crack if sameBrick(b1, b2) else None
        )
        self.limit = criticalTimeStep()[0]
        O.dt = self.args.dt_fraction * self.limit
        self.subcontacts = sum(len(i.geom.areas) for i in self.interactions)
        nodes = len(self.zones.displacements) if self.zones else 0
        self._checkRoom(50 * self.subcontacts + 150 * len(O.bodies) + 100 * nodes)
        kinds = {}
        for i in self.interactions:
            kinds[i.phys.joint.name] = kinds.get(i.phys.joint.name, 0) + 1
        self.results.run.update(
            scene=wall.name,
            title=wall.title,
            wall={
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
            },
            options=dict(vars(self.args)),
            preset=self.preset,
            option_units={
                "until": "mm",
                "rate": "mm/s",
                "vtk_every": "mm",
                "checkpoint_every": "min",
            },
            joints={name: joint.dict() for name, joint in self.joints.items()},
            joint_units=options.units(materials.MasonryJoint),
            unit_material={
                "young_Pa": brick.young,
                "poisson": brick.poisson,
                "density_kg_per_m3": brick.density / scaling,
            },
            versions={
                "yade": yade.config.version,
                "python": sys.version.split()[0],
                "masonry": commit,
            },
            commit=commit,
            threads=O.numThreads,
            time_step_s=O.dt,
            time_step_limit_s=self.limit,
            units=len(self.brickOf),
            nodes=nodes,
            joint_count=len(self.interactions),
            joints_by_kind=kinds,
            subcontacts=self.subcontacts,
        )
        for joint in self.results.run["joints"].values():
            joint["direction"] = list(joint["direction"])

    def _checkRoom(self, frame):
        """Whether the folder has room for the run; ``frame`` is what ParaView's files of a frame take at least [bytes]."""
        until = self.args.until
        frames = 0 if self.args.no_vtk else until / self.args.vtk_every + 2
        least = 400e3 + frame * min(frames, 2)  # figures, first and last frame
        self.results.checkRoom(least, least + frame * frames + 250 * until / ROW_EVERY)

    # -- stages ---------------------------------------------------------------------------------------------------

    def settle(self):
        """Gravity, and precompression on the loading block that grows smoothly, to rest.

        The precompression is what the top course feels: the block's weight is part of it. At rest the base carries what
        is above it but for the share REST, and hardly anything moves; the damping of the push takes what is left.
        """
        weight = self.gravity * sum(b.state.mass for b in O.bodies if b.id != self.base)
        force = (
            self.wall.precompression * self.wall.area
            - O.bodies[self.top].state.mass * self.gravity
        )
        if self.zones:
            self.zones.damping = min(SETTLING, self.args.damping)
        at, ramp, most = self.at, int(self.ramp / O.dt), int(10 * self.ramp / O.dt)
        while at.done < most and at.quiet < 3:
            x = min(1, (at.done + 100) / ramp)
            self.vertical.force = Vector3(0, 0, -force * x * x * (3 - 2 * x))
            self._advance(100)
            at.done += 100
            e = self.energy.balance()
            elastic = (
                e["elastic_compression"]
                + e["elastic_shear"]
                + e["elastic_tension"]
                + e["elastic_units"]
            )
            missing = 1 + O.forces.f(self.base, True)[2] / (
                weight - self.vertical.force[2]
            )
            rests = abs(missing) < REST and abs(e["kinetic"]) < 1e-5 * elastic
            at.quiet = at.quiet + 1 if rests and x == 1 else 0
            self.progress.show(
                "settle",
                at.done / most,
                f"unbalanced {100 * missing:+.2f} %, kinetic/elastic {abs(e['kinetic']) / elastic:.1e}",
                self._rate(),
                at.quiet == 3,
            )
            if self._sunk():
                self.collapsed = True
                say("the wall has collapsed before the push")
                return
        if at.quiet < 3:
            say(f"note: the wall is not quite at rest after {at.steps} steps")

    def push(self):
        """Lateral velocity at the loaded point, to ``--until`` or to collapse."""
        args, at = self.args, self.at
        if self.collapsed:
            return
        every = max(1, int(ROW_EVERY / (args.rate * O.dt)))
        if not self.advanced:
            at.origin, at.began = list(self._topDisplacement()), O.time
            at.moved = self._record()["displacement_mm"]
        if self.zones:
            self.zones.damping = args.damping
            self.zones.dampingKind = args.damping_kind
        else:
            self.integrator.dampingKind = args.damping_kind
        while at.moved < args.until:
            if at.moved >= at.nextFrame:
                self._frame()
                at.nextFrame += args.vtk_every
            self.load.velocity = (
                args.rate
                * 1e-3
                * min(1.0, (O.time - at.began + every * O.dt) / self.ramp)
            )
            if self.wall.loadLineFixed:
                along = self.load.displacement()[0]
                self.vertical.point = self.load.point - Vector3(along, 0, 0)
            self._advance(every)
            with self._timed("rows"):
                values = self._record()
            shear, at.moved = values["base_shear_kN"], values["displacement_mm"]
            if shear > at.peak:
                at.peak, at.peakAt = shear, at.moved
            detail = f"{at.moved:6.2f} of {args.until:g} mm  {shear:7.2f} kN"
            self.progress.show(
                "push", max(0, at.moved / args.until), detail, self._rate()
            )
            if self._sunk() or (at.moved > at.peakAt + 1 and shear < 0.2 * at.peak):
                self.collapsed = True
                break
        self.progress.show("push", 1, detail, self._rate(), final=True)
        if self.collapsed:
            say(f"the wall has collapsed at {at.moved:.2f} mm")

    def _sunk(self):
        """Whether the loading block has come down by half a course."""
        return self._topDisplacement()[2] < -0.5 * self.wall.unit[2]

    def _topDisplacement(self):
        """Displacement of the loading block at the height of measurement [m]."""
        s, wall = O.bodies[self.top].state, self.wall
        arm = Vector3(wall.length / 2, wall.unit[1] / 2, wall.measureHeight) - s.refPos
        return s.pos + s.ori * (s.refOri.conjugate() * arm) - s.refPos - arm

    def _record(self):
        moved = self._topDisplacement() - Vector3(*self.at.origin)
        e = self.energy.balance()
        s = O.bodies[self.top].state
        axis, angle = (s.ori * s.refOri.conjugate()).toAxisAngle()
        values = {
            "time_s": O.time,
            "displacement_mm": 1e3 * moved[0],
            "base_shear_kN": 1e-3 * O.forces.f(self.base, True)[0],
            "top_shear_kN": 1e-3 * self.load.reaction,
            "vertical_mm": 1e3 * moved[2],
            "rotation_mrad": 1e3 * angle * axis[1],
            "balance_error": e["error"],
        }
        values.update({name + "_J": e[name] for name in ENERGIES})
        self.results.row(values)
        return values

    def _describe(self):
        results, run, done = self.results, self.results.run, self.at
        if results.rows:
            shear, moved = results.column("base_shear_kN"), results.column(
                "displacement_mm"
            )
            at = max(range(len(shear)), key=shear.__getitem__)
            run.update(
                peak_base_shear_kN=shear[at],
                displacement_at_peak_mm=moved[at],
                base_shear_end_kN=shear[-1],
                displacement_end_mm=moved[-1],
                initial_stiffness_kN_per_mm=initialStiffness(moved, shear),
                energy_balance_error=self.energy.largestError,
                energy_made=self.energy.largestMade,
                haste=haste(results.column("top_shear_kN"), shear),
            )
        run.update(
            collapsed=self.collapsed,
            too_fast=run.get("haste", 0) > HASTE,
            interrupted=results.interrupted,
            resumed_at_s=done.resumed,
            steps=done.steps,
            kinds=self.vtk.kinds if self.vtk else [],
            seconds={part: round(s, 3) for part, s in done.seconds.items()},
        )
        if done.steps:
            perStep = done.seconds["steps"] / done.steps
            run["microseconds_per_step"] = 1e6 * perStep
            run["nanoseconds_per_subcontact_step"] = 1e9 * perStep / self.subcontacts

    def _report(self):
        results, run = self.results, self.results.run
        if results.rows:
            drawing = [sys.executable, "-m", "masonry.figures", results.directory]
            if subprocess.run(drawing).returncode:
                raise Unwritable("the figures are not drawn")
        off, made = run.get("energy_balance_error", 0), run.get("energy_made", 0)
        if max(off, made) > 0.01:
            say(
                f"warning: the energy balance is off by {100 * off:.1f} % of the work done, and joints that open or close "
                f"within a step made {100 * made:.1f} % of it: a smaller --dt-fraction or --rate or more --damping helps"
            )
        if run.get("haste", 0) > HASTE:
            say(self._tooFast(run["haste"]))
        if results.rows:
            say(
                f"{self.wall.name}: peak {run['peak_base_shear_kN']:.1f} kN at {run['displacement_at_peak_mm']:.2f} mm, "
                f"{run['base_shear_end_kN']:.1f} kN at {run['displacement_end_mm']:.2f} mm; {run['steps']} steps of "
                f"{run['microseconds_per_step']:.0f} µs, {run['wall_clock_s']:.1f} s in all; see {results.directory}"
            )
        if self.preset:
            say(options.presetNote(self.preset, self.wall.name))

    def _tooFast(self, haste):
        """The warning of a push that is too fast, with what would do: what is missing grows with the rate at least."""
        args = self.args
        slower = f"--rate {float(f'{args.rate * HASTE / haste:.2g}'):g}"
        return (
            f"warning: the push is too fast: {100 * haste:.0f} % of the force does not reach the base, "
            f"more than {100 * HASTE:.0f} % spoil the peak; "
            + ("--damping-kind combined" if args.damping_kind == "local" else slower)
            + " would do"
        )


def test(wall, args):
    """Gravity, precompression, push and results of a wall; the exit status of the scene."""
    return conduct(lambda: WallModel(wall, args))
