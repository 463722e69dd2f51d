"""What a scene is in YADE: its bodies, joints and loads, and what can be read off them.

:class:`masonry.scene.scene.Scene` says what is to be built, and runs it.
"""

import math
import sys
import tempfile

from yade import O, Vector3
from yade.wrapper import MasonryJoint, MasonryLoad, MasonryVtkRecorder

from ..assembly import columns
from ..read import measure
from . import history, loading, options
from .._masonry import criticalTimeStep
from .bounds import Bounds
from ..bricks import boxCorners
from ..assembly.columns import Column
from ..read.curves import (
    cycleNumbers,
    dampedShare,
    dynamicImbalance,
    initialStiffness,
    peakAtBothEnds,
)
from .description import OF_JOINTS
from ..basics import Collapsed, GRAVITY, Refused, Unwritable, say
from ..read.frames import readFrame
from .materials import loadingBlock
from ..assembly.model import Model
from ..assembly.blocks import addBlock, engine

FRAMES = 20  # for ParaView in a stage that is no push
FALLEN = 0.05  # of the largest side of a block: one that moves so far, and fast, falls
FAST = 0.1  # of √(g·side): the velocity of a block that has fallen by half a hundredth of its side
FILLED = 1e-9  # of a platen's side: what may be free of bricks if it is said to be full


class Structure(Model):
    """What a :class:`Scene` is in YADE, and what can be read off it."""

    def __init__(self, scene):
        args, masonry = scene.args, scene.materials.variant(scene.args)
        self.scene, self.title = scene, scene.title
        self.units = masonry.units
        kinds = {b.kind for b in scene.bricks} - set(self.units)
        problems = []
        if scene.halves and "crack" not in masonry.joints:
            problems.append(
                "--crack-surfaces on: the bricks are in pieces, and these materials have no joint 'crack' between them; "
                "make whole bricks with halves=False, or choose --crack-surfaces off"
            )
        options.check(args, masonry.joints, problems)
        super().__init__(args, masonry.unit, masonry.joints)
        for kind in set(self.units):
            if self.units[kind] is not masonry.unit:
                self.units[kind].density *= args.density_scaling
        self.units.update({kind: masonry.unit for kind in kinds})
        self.masonry = masonry
        self.gravity = scene.gravity / args.density_scaling
        self.pushed = None
        self.origin = (
            0,
            0,
        )  # displacement of the pushed point when the push began, along it and up [m]
        #: Point of the history that the drive is going to: its number, from 1, and its displacement [mm].
        self.aim = 0, 0.0
        self.way = Vector3.UnitX  # of the present push
        #: What is pushed; from the beginning the target that a drive holds.
        self.target = next((t for t in scene.targets.values() if t.drives), None)
        self.columns = self._columns()
        self.bounds = Bounds(self)

    # -- columns --------------------------------------------------------------------------------------------------

    def _columns(self):
        """The columns of curve.csv: those of the scene's choice, or all."""
        found = [*columns.PUSH, *self._ofTargets(), *columns.BALANCE]
        if self.args.history:
            found += columns.HISTORY
        names = columns.names(found)
        twice = sorted({n for n in names if names.count(n) > 1})
        if twice:
            raise Refused(f"two columns have the name {', '.join(twice)}")
        chosen = self.scene.choice
        if chosen is None:
            return found
        unknown = [n for n in chosen if n not in names]
        if unknown:
            raise Refused(
                f"no column {', '.join(unknown)}; there are {', '.join(names)}"
            )
        always = columns.names(columns.BALANCE + columns.HISTORY)
        chosen = [n for n in chosen if n not in always]
        return [found[names.index(n)] for n in chosen] + [
            c for c in found if c.name in always
        ]

    def _ofTargets(self):
        """Columns of accelerations, of every target and joint, and of the user's own."""
        found, scene = [], self.scene
        add = lambda name, meaning: found.append(
            Column(name, meaning, lambda r: r.values[name])
        )
        axes = "xz" if scene.plane else "xyz"
        for axis in axes[:-1]:
            add(
                f"acceleration_{axis}_g",
                f"horizontal acceleration along {axis} that acts on the blocks [g]",
            )
        for target in scene.targets.values():
            for axis in axes:
                add(
                    f"{target.name}_{axis}_mm",
                    f"displacement of {target.name} along {axis} [mm]",
                )
                if target.fixed or axis in (target.freedom or ""):
                    add(
                        f"{target.name}_force_{axis}_kN",
                        f"force of the structure on {target.name} along {axis} [kN]",
                    )
            if not target.fixed:
                about = " about y" if scene.plane else ", its angle"
                add(
                    f"{target.name}_rotation_mrad",
                    f"rotation of {target.name}{about} [mrad]",
                )
        for name, lower, upper in scene.drifts:
            for axis in axes[:-1]:
                what = f"displacement of {upper.name} along {axis} less that of {lower.name}"
                add(f"{name}_{axis}_mm", f"{what} [mm]")
                add(
                    f"{name}_{axis}_mrad",
                    f"{what}, over the height between them [mrad]",
                )
        for joint in scene.joints:
            between = "the joint between bricks {} and {}".format(*joint.bricks)
            for end, meaning in OF_JOINTS.items():
                add(joint.column(end), meaning.format(between))
        for name, meaning, _ in scene.extra:
            add(name, meaning)
        return found

    # -- building -------------------------------------------------------------------------------------------------

    def build(self):
        O.reset()
        scene, rigid = self.scene, loadingBlock()
        rigid.density *= self.args.density_scaling
        mats = {id(m): m for m in (*self.units.values(), self.unit, rigid)}
        O.materials.append(list(mats.values()))
        self.parts, self.ids = {}, []
        for target in scene.targets.values():
            if target.box and target.fixed:
                self._addPlaten(target, rigid)
        for block in scene.bricks:
            body = addBlock(block.corners, self.units[block.kind], inPlane=scene.plane)
            self.ids.append(body)
            self.bricks[body] = block.brick
            self.parts.setdefault(block.part, []).append(body)
        for target in scene.targets.values():
            if target.box and not target.fixed:
                self._addPlaten(target, rigid)
            elif not target.box:
                target.body = self.ids[target.brick]
                if target.fixed:
                    O.bodies[target.body].state.blockedDOFs = target.freedom
            self.blocks[target.name] = target.body
        if not any(t.fixed for t in scene.targets.values()):
            raise Refused(
                "nothing is held: a scene needs a platen at the bottom, or hold()"
            )
        if self.args.blocks == "deformable":
            for target in scene.targets.values():
                if target.freedom:
                    self.bricks.pop(target.body, None)
        n = self.args.divisions
        # the rule chooses; YADE wants a joint that fits any pair before it asks
        any_ = MasonryJoint(name="any", elastic=True)
        self.assemble(
            [any_],
            self._loads(),
            damping=self.args.damping_kind,
            # cells of a half brick along its length; a whole one has twice as many
            divisions=[n if scene.halves else 2 * n, 1, n],
            gravity=self.gravity,
            rule=self.masonry.rule(self),
            plane=scene.plane,
            functors=scene.functors,
        )
        #: The load that drives the pushed target.
        self.loads["push"] = None
        if self.target:
            self.loads["push"] = self.driveOf(self.target, self.target.drives[0])
        self._joinRecords()
        self._whole = (
            {}
        )  # presses, dead loads and wind when they have grown, by label [N]
        self._lines = {}  # points of the presses, as they were built [m]
        for target in scene.targets.values():
            if target.pressed is None and target.force is None:
                continue
            force = Vector3(*(target.force or (0, 0, 0)))
            if target.pressed is not None:
                own = O.bodies[target.body].state.mass * self.gravity
                area, middle = self._contact(target)
                force = force - (target.pressed * area - own) * Vector3.UnitZ
                # the resultant goes through the middle of what the platen presses
                load = self.loads[f"{target.name}_force"]
                load.point = (middle[0], middle[1], target.point[2])
                self._lines[target.name] = Vector3(*load.point)
            self._whole[f"{target.name}_force"] = force
        for n, (_, force, _) in enumerate(scene.winds):
            self._whole[f"wind_{n}"] = Vector3(*force)
        # Rows are read at every few steps: what does not change is kept.
        self._states = {t.name: self._placed(t) for t in scene.targets.values()}
        self._held = [t for t in scene.targets.values() if t.freedom]
        listed = set(columns.names(self.columns))
        self._read = [
            t
            for t in scene.targets.values()
            if any(name.startswith(t.name + "_") for name in listed)
        ]
        self._forces = O.forces
        self._sizes = [scene.size(index) for index in range(len(self.ids))]
        #: Velocity of a block that has fallen by half a hundredth of its side [m/s].
        self._falling = [FAST * math.sqrt(GRAVITY * size) for size in self._sizes]
        held = {t.body for t in self._held}
        self._freeMass = sum(b.state.mass for b in O.bodies if b.id not in held)
        self._moving = [O.bodies[body].state for body in self.ids]
        self.keepPlaces()

    def _addPlaten(self, target, material):
        corners = boxCorners(*target.box)
        target.body = addBlock(corners, material, inPlane=self.scene.plane)
        O.bodies[target.body].state.blockedDOFs = target.freedom

    def _loads(self):
        """A dead load for every target that has one, and a drive for every one that can be pushed."""
        loads = []
        for target in self.scene.targets.values():
            if not target.loaded:
                continue
            on = dict(body=target.body, point=target.point)
            if target.pressed is not None or target.force is not None:
                loads.append(MasonryLoad(label=f"{target.name}_force", **on))
            for axis in target.drives:
                direction = Vector3(*(float(axis == a) for a in "xyz"))
                label = f"{target.name}_drive_{axis}"
                loads.append(
                    MasonryLoad(label=label, direction=direction, driven=True, **on)
                )
            if not target.drives:
                loads.append(MasonryLoad(label=f"{target.name}_drive", **on))
        for n, (brick, _, point) in enumerate(self.scene.winds):
            on = dict(body=self.ids[brick], point=point)
            loads.append(MasonryLoad(label=f"wind_{n}", damped=True, **on))
        return loads

    def _joinRecords(self):
        """Find the joints whose means are recorded."""
        pairs = {frozenset((i.id1, i.id2)): i for i in self.interactions}
        for joint in self.scene.joints:
            joint.interaction = pairs.get(frozenset(self.ids[b] for b in joint.bricks))
            if joint.interaction is None:
                raise Refused(
                    "joint: bricks {} and {} share no face".format(*joint.bricks)
                )

    def _placed(self, target):
        """What the motion of a target's recorded point is told from."""
        state = O.bodies[target.body].state
        arm = Vector3(*target.recorded) - state.refPos
        upright = state.refOri.conjugate()
        return state, state.refPos, arm, upright * arm, upright

    # -- loads ----------------------------------------------------------------------------------------------------

    def grow(self, x):
        """Let presses and dead loads grow smoothly: 0 to 1 is from nothing to their whole."""
        for label, force in self._whole.items():
            self.loads[label].force = force * x * x * (3 - 2 * x)

    def deadLoads(self):
        """Loads of the scene, each with its force when presses, dead loads and wind have grown: pairs of MasonryLoad and
        force [N]."""
        for label, load in self.loads.items():
            if load and label != "push":
                yield load, self._whole.get(label, load.force)

    def _contact(self, target):
        """Area of a platen's joints [m²], and their middle [m]."""
        area, middle = 0.0, Vector3.Zero
        for interaction in self.interactions:
            if target.body in (interaction.id1, interaction.id2):
                geom = interaction.geom
                for a, c in zip(geom.areas, geom.centres):
                    area += a
                    middle += a * c
        low, high = target.box
        side = (high[0] - low[0]) * (high[1] - low[1])
        if abs(area - side) < FILLED * side:
            return side, [(a + b) / 2 for a, b in zip(low, high)]
        return area, middle / area

    def rearm(self):
        """What follows from the state after it has been taken back."""
        self.keepPlaces()

    def dampJoints(self, stiffnessDamping):
        """Viscous damping of the joints from now on [s], with the time step that it allows."""
        engine("joints").stiffnessDamping = stiffnessDamping
        self.limit = criticalTimeStep()[0]
        O.dt = self.args.dt_fraction * self.limit

    def setGravity(self, gravity):
        """Gravity from now on [m/s²]; deformable units follow."""
        self.integrator.gravity = gravity

    @property
    def now(self):
        """Present gravity [m/s²]."""
        return self.integrator.gravity

    def factor(self):
        """Horizontal over vertical acceleration that acts on the blocks [-]."""
        down = abs(self.now[2]) or GRAVITY / self.args.density_scaling
        return math.hypot(self.now[0], self.now[1]) / down

    def driveOf(self, target, axis):
        """The load that drives a target along an axis, or None."""
        return self.loads.get(f"{target.name}_drive_{axis}")

    def pushTo(self, target, way, name="push"):
        """From now on ``push`` moves this target along this way. The other drives hold what they hold."""
        if self.scene.plane and way[1]:
            raise ValueError(
                f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        load = self.loads.get(f"{target.name}_drive")
        if target.drives:
            along = [a for a, v in zip("xyz", way) if abs(v) > 1 - 1e-12]
            load = self.driveOf(target, along[0]) if along else None
            if load is None:
                raise ValueError(
                    f"{name}: {target.name} has drives along {', '.join(target.drives)} alone, not along {tuple(way)}"
                )
        elif load.driven and load.direction.cross(way).norm() > 1e-12:
            raise ValueError(
                f"{name}: the drive of {target.name} holds it along {tuple(load.direction)}, and would let go of it to push "
                f"along {tuple(way)}; drive='xz' and the like give it a drive for every axis"
            )
        for label, other in self.loads.items():
            if "_drive" in label:
                other.velocity = 0
        load.direction, load.driven = way, True
        self.target, self.way, self.loads["push"] = target, way, load
        self.origin = (0, 0)

    def keepLoadLine(self):
        """Move the points of vertical loads that keep their line in space back to it."""
        for target in self.scene.targets.values():
            if target.pressed is None or target.riding:
                continue
            load = self.loads[f"{target.name}_force"]
            drive = self.loads["push"] if target is self.target else load
            along = drive.displacement()
            away = (along[0], 0 if self.scene.plane else along[1], 0)
            load.point = self._lines[target.name] - Vector3(*away)

    # -- what is measured -----------------------------------------------------------------------------------------

    def moved(self, target):
        """Displacement of a target's recorded point since the scene was built [m], and its rotation."""
        state, place, arm, ownArm, upright = self._states[target.name]
        turn = state.ori
        return state.pos + turn * ownArm - place - arm, turn * upright

    def topDisplacement(self):
        """Displacement of the pushed point along the push and upwards since the scene was built [m]."""
        moved = self.moved(self.target)[0]
        return moved.dot(self.way), moved[2]

    def hasSunk(self, down=None):
        """Whether the pushed platen has come down by half the height of a brick.

        :param down: its displacement downwards [m], if that is known
        """
        down = -self.topDisplacement()[1] if down is None else down
        block = self.scene.bricks[-1].corners
        return down > 0.5 * (max(p[2] for p in block) - min(p[2] for p in block))

    def read(self):
        values, held = {}, Vector3(0, 0, 0)
        plane = self.scene.plane
        axes = (0, 2) if plane else (0, 1, 2)
        for target in self._held:
            on = self._forces.f(target.body, True)
            for i in axes:
                values[f"{target.name}_force_{'xyz'[i]}_kN"] = 1e-3 * on[i]
                if "xyz"[i] in target.freedom:
                    held[i] += on[i]
        for target in self._read:
            moved, turn = self.moved(target)
            for i in axes:
                values[f"{target.name}_{'xyz'[i]}_mm"] = 1e3 * moved[i]
            values[f"{target.name}_rotation_mrad"] = 1e3 * _angle(turn, plane)
        for i, axis in enumerate("xy"):
            values[f"acceleration_{axis}_g"] = (
                self.now[i] * self.args.density_scaling / GRAVITY
            )
        for name, lower, upper in self.scene.drifts:
            away = self.moved(upper)[0] - self.moved(lower)[0]
            height = upper.recorded[2] - lower.recorded[2]
            for i in axes[:-1]:
                values[f"{name}_{'xyz'[i]}_mm"] = 1e3 * away[i]
                values[f"{name}_{'xyz'[i]}_mrad"] = 1e3 * away[i] / height
        for joint in self.scene.joints:
            for end, value in joint.read().items():
                values[joint.column(end)] = value
        for name, _, read in self.scene.extra:
            values[name] = float(read())
        along = up = drive = 0.0
        turn = Vector3.Zero
        if self.target:
            moved, turn = self.moved(self.target)
            along, up = moved.dot(self.way), moved[2]
            drive = self.loads["push"].reaction
        return columns.Reading(
            O.time,
            along - self.origin[0],
            up - self.origin[1],
            held.dot(self.way),
            drive,
            self.energy.balance(),
            _angle(turn, plane) if self.target else 0.0,
            -up,
            *self.aim,
            values,
        )

    def keepPlaces(self):
        """From now on :meth:`tellFall` counts displacements."""
        self._places = {body: Vector3(O.bodies[body].state.pos) for body in self.ids}

    def _speeds(self):
        """Velocity of every block [m/s]: of its centre, or, of deformable ones, the mean of their nodes."""
        speeds = [state.vel.norm() for state in self._moving]
        if self.zones:
            velocities = self.zones.velocities
            deformable = set(self.zones.bodies)
            for index, body in enumerate(self.ids):
                if body in deformable:
                    first, end = self.zones.nodesOf(body)
                    mean = sum(velocities[first:end], Vector3.Zero) / (end - first)
                    speeds[index] = mean.norm()
        return speeds

    def haste(self):
        """Velocity of the fastest block over that of one that has fallen [-]."""
        return max(v / speed for v, speed in zip(self._speeds(), self._falling))

    def tellFall(self):
        """Raise Collapsed if a block has moved far since the last state at rest, and is fast."""
        speeds = None
        for index, body in enumerate(self.ids):
            way = self._moving[index].pos - self._places[body]
            if way.norm() <= FALLEN * self._sizes[index]:
                continue
            speeds = speeds or self._speeds()
            if speeds[index] >= self._falling[index]:
                at = ", ".join(f"{v:.3g}" for v in self.scene.middle(index))
                way, speed = 1e3 * way, 1e3 * speeds[index]
                raise Collapsed(
                    f"brick {index} at ({at}) m has moved by ({way[0]:.3g}, {way[1]:.3g}, {way[2]:.3g}) mm and falls at "
                    f"{speed:.3g} mm/s"
                )

    def unrest(self):
        """What of the loads is missing at the supports, and kinetic over elastic energy [-]."""
        energy = self.energy.balance()
        elastic = sum(
            energy[f"elastic_{m}"] for m in ("compression", "shear", "tension", "units")
        )
        # what acts in all, and what is held against it: supports by their force, drives by theirs
        applied, carried = self._freeMass * self.now, Vector3(0, 0, 0)
        for target in self._held:
            state = O.bodies[target.body].state
            weight, on = state.mass * self.now, self._forces.f(target.body, True)
            for i, axis in enumerate("xyz"):
                if axis in state.blockedDOFs:
                    carried[i] -= on[i]
                else:
                    applied[i] += weight[i]
        for label, load in self.loads.items():
            if label != "push":
                applied += load.force
                carried += load.reaction * load.direction.normalized()
        if self.scene.plane:
            applied[1] = carried[1] = 0
        missing = (applied + carried).norm() / (applied.norm() or 1.0)
        moving = abs(energy["kinetic"])
        return missing, moving / elastic if elastic else math.inf

    # -- what comes out -------------------------------------------------------------------------------------------

    def room(self):
        nodes = len(self.zones.displacements) if self.zones else 0
        frame = 50 * self.subcontacts + 150 * len(O.bodies) + 100 * nodes
        args, frames, rows = self.args, FRAMES, 0
        if args.history or args.until:
            frames = loading.wayLength(args) / loading.frameSpacing(args) + 2
            rows = loading.rowCount(args)
        frames = 0 if args.no_vtk or args.lean else frames
        figures = 50e3 if args.lean else 400e3
        least = figures + frame * min(frames, 2)  # and the first and last frame
        return least, least + frame * frames + 250 * rows

    def describe(self):
        told = dict(super().describe(), parts=self.parts, option_units=options.UNITS)
        told["figure"] = self._figure()
        if self.scene.views:
            told["views"] = self.scene.views
        told["held"] = sorted(t.name for t in self.scene.targets.values() if t.fixed)
        told.update(self.bounds.describe())
        wall = self._wall() if self.pushed else None
        if wall:
            told["wall"] = wall
        return told

    def leave(self, directory):
        try:
            self.bounds.leave(directory, self.title, self.parts, self.scene.views)
        except OSError as error:
            say(
                f"the mechanism is not written to {directory}: {error.strerror}",
                sys.stderr,
            )

    def _wall(self):
        """The entry ``wall`` of run.json, or None if this is no whole wall in running bond in the x-z plane."""
        scene, target = self.scene, self.target
        low, high = scene.low, scene.high
        sides = [
            [f(p[i] for p in b.corners) for i in range(3)]
            for b in scene.bricks
            for f in (min, max)
        ]
        sizes = [
            [b - a for a, b in zip(*pair)] for pair in zip(sides[::2], sides[1::2])
        ]
        height, half = sizes[0][2], min(size[0] for size in sizes)
        length, courses = high[0] - low[0], round((high[2] - low[2]) / height)
        columns_ = round(length / half)
        steps = [round(size[0] / half) for size in sizes]
        odd = [
            n
            for s, n in zip(sizes, steps)
            if abs(s[0] - n * half) > 1e-6 * half or n > 2
        ]
        if (
            not scene.plane
            or not (scene.halves or {1, 2} == set(steps))
            or target.brick is not None
            or odd
            or any(abs(s[2] - height) > 1e-6 * height for s in sizes)
            or sum(steps) != courses * columns_
            or any(len(b.corners) != 8 for b in scene.bricks)
        ):
            return None
        return {
            "length_m": length,
            "height_m": high[2] - low[2],
            "thickness_m": high[1] - low[1],
            "courses": courses,
            "half_units": columns_,
            "unit_m": [2 * half, high[1] - low[1], height],
            "precompression_Pa": target.pressed or 0.0,
            "load_height_m": None if "Y" in target.freedom else target.point[2],
            "measure_height_m": target.recorded[2],
            "load_line_fixed": not target.riding,
        }

    def _figure(self):
        scene, names = self.scene, columns.names(self.columns)
        if self.pushed:
            height = f"{self.target.recorded[2]:.3g} m above the base"
            return {
                "x": {
                    "column": "displacement_mm",
                    "label": f"displacement of {self.target.name}, {height} [mm]",
                },
                "y": [
                    {"column": "base_shear_kN", "label": "base"},
                    {"column": "top_shear_kN", "label": "loaded point"},
                ],
                "y_label": "force along the push [kN]",
                "looped": bool(self.pushed.history),
                "marks": self._marks(),
                "bounds": list(self.bounds.lines()),
            }
        if scene.joints:
            return self._figureOfJoint(scene.joints[0])
        moving = [t.name for t in scene.targets.values() if not t.fixed]
        y = [f"{n}_{a}_mm" for n in moving for a in "xyz" if f"{n}_{a}_mm" in names]
        y = y or [n for n in names if n.endswith("_kN") and "force" in n][:3]
        return {
            "x": {"column": "time_s", "label": "time [s]"},
            "y": [{"column": n, "label": n.rsplit("_", 1)[0]} for n in y],
            "y_label": "displacement [mm]" if moving else "force [kN]",
            "looped": False,
            "marks": [],
        }

    def _figureOfJoint(self, joint):
        """What curve.png shows of a joint that is recorded: the stress along which it moved farther, and the other one."""
        reach = lambda end: max(map(abs, self.scene.results.column(joint.column(end))), default=0)  # fmt: skip
        slides = reach("slide_mm") > reach("opening_mm")
        moved, what = ("slide_mm", "slide") if slides else ("opening_mm", "opening")
        stresses = [
            {
                "column": joint.column("normal_stress_MPa"),
                "label": "normal, positive in tension",
            },  # fmt: skip
            {"column": joint.column("shear_stress_MPa"), "label": "shear"},
        ]
        return {
            "x": {"column": joint.column(moved), "label": f"mean {what} of the joint [mm]"},  # fmt: skip
            "y": stresses[::-1] if slides else stresses,
            "y_label": "mean stress [MPa]",
            "looped": False,
        }

    def _ofJoints(self, column):
        """Entries of run.json for the joints whose means are recorded."""
        for joint in self.scene.joints:
            normal, shear = (
                column(joint.column(f"{what}_stress_MPa"))
                for what in ("normal", "shear")
            )
            lost = zip(("tension", "shear", "compression"), joint.interaction.phys.dissipated)  # fmt: skip
            found = {
                "peak_normal_stress_MPa": max(normal),
                "peak_compressive_stress_MPa": -min(normal),
                "peak_shear_stress_MPa": max(shear),
                "end_normal_stress_MPa": normal[-1],
                "end_shear_stress_MPa": shear[-1],
                **{f"dissipated_{mode}_J_per_m2": j / joint.area for mode, j in lost},
            }
            yield from ((joint.column(end), value) for end, value in found.items())

    def _marks(self):
        column = self.scene.results.column
        force, moved = column("base_shear_kN"), column("displacement_mm")
        if not force:
            return []
        ends = [max(range(len(force)), key=force.__getitem__)]
        if self.pushed.history:
            ends.append(min(range(len(force)), key=force.__getitem__))
        return [
            {
                "x": moved[i],
                "y": force[i],
                "text": f"{force[i]:.1f} kN at {moved[i]:.2f} mm",
            }
            for i in ends
        ]

    def summary(self, column):
        found = dict(collapse=self.scene.results.run.get("collapse"))
        found["ended"] = self.scene.ended
        found.update(self._ofJoints(column))
        if self.scene.factor:
            found["factor"] = self.scene.factor
        if self.scene.stood:
            found["stood"] = self.scene.stood
        if not self.pushed:
            return found
        shear, moved = column("base_shear_kN"), column("displacement_mm")
        at = max(range(len(shear)), key=shear.__getitem__)
        imbalance = dynamicImbalance(column("top_shear_kN"), shear)
        found.update(
            peak_base_shear_kN=shear[at],
            displacement_at_peak_mm=moved[at],
            peak_at_both_ends_kN=peakAtBothEnds(column("top_shear_kN"), shear),
            base_shear_end_kN=shear[-1],
            displacement_end_mm=moved[-1],
            initial_stiffness_kN_per_mm=initialStiffness(moved, shear),
            dynamic_imbalance=imbalance,
            too_fast=imbalance > loading.IMBALANCE,
        )
        if self.pushed.history:
            low = min(range(len(shear)), key=shear.__getitem__)
            found.update(
                history=history.describe(self.pushed.history),
                negative_peak_base_shear_kN=shear[low],
                displacement_at_negative_peak_mm=moved[low],
                damped_share=dampedShare(column),
                cycles=cycleNumbers(column, history.noise(self.pushed.history)),
            )
        if self.args.lean:
            found.update(self._measured(moved, shear))
        return found

    def _measured(self, moved, shear):
        """The numbers that masonry.read.measure finds of a wall, and its failure mode: what leaves no frames has them at once."""
        found, wall = {}, self._wall()
        if not self.pushed.history:
            found = measure.pushNumbers(moved, shear)
            if not math.isfinite(found["drop_at_mm"]):
                found["drop_at_mm"] = None
        if wall:
            with tempfile.TemporaryDirectory() as folder:
                try:
                    MasonryVtkRecorder(directory=folder)()
                except RuntimeError as error:
                    raise Unwritable(str(error)) from None
                frame = readFrame(folder, "joints")
            found.update(measure.pattern(frame, wall))
            found["failure_mode"] = measure.failureMode(found, wall)
        return found

    def report(self, run):
        name = self.scene.name
        for joint in self.scene.joints:
            for end in ("peak_normal", "peak_compressive", "peak_shear", "end_shear"):
                key = joint.column(f"{end}_stress_MPa")
                yield f"{key:32} {run[key]:.4f}"
        yield from self.bounds.over(run, self.scene.stood)
        if not self.pushed:
            yield f"{name}: {run['ended']}"
            return
        if run["too_fast"]:
            yield loading.tooFast(self.pushed, run["dynamic_imbalance"])
        if run.get("damped_share", 0) > loading.DAMPED:
            yield loading.tooDamped(self.pushed, run["damped_share"])
        peak = f"{run['peak_base_shear_kN']:.1f} kN at {run['displacement_at_peak_mm']:.2f} mm"
        end = (
            f"{run['base_shear_end_kN']:.1f} kN at {run['displacement_end_mm']:.2f} mm"
        )
        if "negative_peak_base_shear_kN" not in run:
            yield f"{name}: peak {peak}, {end}"
            return
        other = (
            f"{run['negative_peak_base_shear_kN']:.1f} kN at "
            f"{run['displacement_at_negative_peak_mm']:.2f} mm"
        )
        yield f"{name}: {len(run['cycles'])} cycles, peaks {peak} and {other}, {end}"


def _angle(turn, plane):
    """Angle of a rotation [rad], in a plane about y."""
    axis, angle = turn.toAxisAngle()
    return angle * axis[1] if plane else angle
