# SPDX-License-Identifier: GPL-2.0-or-later
"""What comes out of a scene: entries of run.json, what curve.png shows, and the lines at the end on the terminal."""

import collections
import contextlib
import math
import os
import subprocess
import sys

from yade import O
from yade.wrapper import MasonryVtkRecorder

from ..assembly import blocks, columns
from ..assembly.blocks import units
from ..basics import Unwritable, say, withoutCollector
from ..memory import FULL
from ..packages import Missing
from ..read import cracks, crew, measure
from ..read.curves import (
    cycleNumbers,
    dampedShare,
    dynamicImbalance,
    firstCrack,
    SHEAR,
    peakAtBothEnds,
    quasiStatic,
    stiffness,
    suddenLoss,
    stillGrows,
)
from ..read.frames import asFrame
from ..run import accuracy
from . import facts, history
from .parsing import UNITS
from .stages import pushing
from .stages.answers import answersText
from .wall import wallOf

FRAMES = 20  # for ParaView in a stage that is no push
REPORT = 2e6  # [bytes] of report.html, of which three.js takes nearly half
MOST_NUMBERS = 24  # of a list that the script said, as run.json has it


class Outcome:
    """What comes out of a scene that stands in YADE.

    :param scene: :class:`masonry.scene.scene.Scene`
    """

    def __init__(self, scene):
        self.scene, self.model = scene, scene.model
        self.description, self.args = scene.description, scene.args
        self.results = scene.running.results
        self._drawing = None  # the program that draws the figures and writes the report
        self._begun = False  # whether it knows the folder
        self._facts = self._inWords()

    def _inWords(self):
        """Entries of run.json that say in words what is built and held, as it is before the first stage."""
        if self.args.lean:
            return {}
        built, held = facts.sizes(self.description), facts.held(self.description)
        return {"built": [*map(list, built)], "held_and_loaded": [*map(list, held)]}

    @property
    def pushed(self):
        """The options of the last push, or None if there was none."""
        return self.scene.pushed

    def _loads(self):
        """What stages loaded, in their order: pairs of the number of the stage and what :class:`Place` keeps of it."""
        loads = self.scene.running.at.loads
        return [(number, loads[str(number)]) for number in sorted(map(int, loads))]

    def _pushes(self):
        """Names of the last push, there and back."""
        pushes = [load[1:] for _, load in self._loads() if load[0] == "push"]
        return pushes[-1] if pushes else []

    def _pushRows(self):
        """The rows of curve.csv that numbers of the push are of: those of the last push, and of those along its line."""
        loads, stages = self._loads(), self.scene.running.at.stages
        pushes = [(number, load[1:]) for number, load in loads if load[0] == "push"]
        if len(pushes) == len(loads) and all(p[1] == pushes[0][1] for p in pushes):
            return list(range(len(self.results.rows)))
        others = [number for number, names in pushes if names != pushes[-1][1]]
        ends = [stage[3] for stage in stages[1:]] + [len(self.results.rows)]
        return [
            row
            for number, names in pushes
            if number > max(others, default=0)
            for row in range(stages[number - 1][3], ends[number - 1])
        ]

    def _swing(self):
        """Of the push whose rows come first: its first period, the weight of the base in its shear force, and when its velocity
        had grown, as of :class:`masonry.run.place.Place`."""
        rows, stages = self._pushRows(), self.scene.running.at.stages
        swings = self.scene.running.at.swings
        for number in sorted(map(int, swings)):
            if rows and stages[number - 1][3] >= rows[0]:
                period, weight, end = swings[str(number)]
                return period, weight or SHEAR, end
        return 0.0, SHEAR, 0.0

    def space(self):
        """Bytes that a run writes at least, and those that it will probably write."""
        model, args, frames, rows = self.model, self.args, FRAMES, 0
        nodes = len(model.zones.displacements) if model.zones else 0
        frame = 50 * model.subcontacts + 150 * len(O.bodies) + 100 * nodes
        if args.history or args.until:
            frames = pushing.pathOf(args) / pushing.frameSpacing(args) + 2
            rows = pushing.rowCount(args)
        frames = 0 if args.no_vtk or args.lean else frames
        figures = 50e3 if args.lean else 400e3
        least = figures + frame * min(frames, 2)  # and the first and last frame
        report = 0 if args.lean else REPORT
        return least, least + report + frame * frames + 250 * rows

    # -- run.json -------------------------------------------------------------------------------------------------

    def describe(self):
        """Entries of run.json that say what is built, and how it is held and drawn."""
        model, scene = self.model, self.scene
        kinds = {}
        for interaction in model.interactions:
            name = interaction.phys.joint.name
            kinds[name] = kinds.get(name, 0) + 1
        joints = {name: joint.dict() for name, joint in model.joints.items()}
        for properties in joints.values():
            properties["direction"] = list(properties["direction"])
        entries = dict(
            title=self.description.title,
            option_units=UNITS,
            joints=joints,
            joint_units=units(type(next(iter(model.joints.values())))),
            joint_meanings=_meanings(type(next(iter(model.joints.values())))),
            unit_material={
                "young_Pa": model.unit.young,
                "poisson": model.unit.poisson,
                "density_kg_per_m3": model.unit.density / self.args.density_scaling,
            },
            assumed=scene.assumed,
            time_step_s=O.dt,
            time_step_limit_s=model.scheme.limit,
            units=len(model.bricks),
            nodes=len(model.zones.displacements) if model.zones else 0,
            joint_count=len(model.interactions),
            joints_by_kind=kinds,
            subcontacts=model.subcontacts,
            parts=model.parts,
            figure=self._figure(),
            held=sorted(t.name for t in self.description.targets.values() if t.fixed),
            targets=[
                {"name": t.name, "body": t.body, "held": t.fixed}
                for t in self.description.targets.values()
            ],
            **self._ground(),
            recorded_joints=[joint.name for joint in self.description.joints],
            **self._connections(),
            script=shortened(scene.script.words),
            **self._facts,
            **scene.bounds.describe(self._pushes()),
        )
        if self.description.views:
            entries["views"] = self.description.views
        wall = wallOf(self.description, model.loading.target) if self.pushed else None
        if wall:
            entries["wall"] = wall
        return entries

    def _ground(self):
        """Entries for the ground on which blocks fall and for their contact, if a collapse is followed."""
        ground, engine = self.description.ground(), self.model.contacts
        if not (ground and engine):
            return {}
        names = self.description.contact.known()
        return {"ground_body": ground.body, "contact": {n: getattr(engine, n) for n in names}}  # fmt: skip

    def summary(self):
        """Entries of run.json that follow from the rows."""
        scene, column = self.scene, self.results.column
        found = dict(collapse=self.results.run.get("collapse"), ended=scene.ended)
        found.update(self._ofJoints(column))
        if math.isfinite(scene.factor):
            found["factor"] = scene.factor
        if self.pushed:
            rows = self._pushRows()

            def ofPush(head):
                values = column(head)  # a list that is made anew every time
                return [values[n] for n in rows]

            found.update(self._ofPush(ofPush))
            found.update(self._ofCracks(column))
            if scene.accuracy and not scene.running.interrupted:
                # a push that is not over is shorter than those of its companions
                found.update(self._ofAccuracy(found, column))
        found.update(self._connections())
        found["answers"] = scene.answers
        return found

    def _connections(self):
        """Entries for ties and springs, if there are any."""
        description = self.description
        kinds = collections.defaultdict(list, overlays=description.overlays)
        for one in description.connectors:
            if one.isListed:
                kinds[one.PLURAL].append(one)
        return {name: [one.entry() for one in records] for name, records in kinds.items() if records}  # fmt: skip

    def _ofAccuracy(self, found, column):
        """Entries for --accuracy, whose half-widths the answers of the last push get, too."""
        at, rows = self.scene.running.at, self._pushRows()
        whole = column("base_shear_kN"), column("displacement_mm")
        shear, moved = ([values[n] for n in rows] for values in whole)
        work = measure.pushNumbers(moved, shear)["push_work_J"]
        asked = self.scene.accuracy
        entries = {"push_work_J": work, **asked.report({**found, "push_work_J": work})}
        number = str([n for n, load in self._loads() if load[0] == "push"][-1])
        own = accuracy.answers(entries["accuracy"])
        names = {one["name"] for one in own}
        stage = {"stage": "push", "number": int(number)}
        others = [a for a in at.answers.get(number, []) if a["name"] not in names]
        at.answers = {**at.answers, number: [*({**stage, **one} for one in own), *others]}  # fmt: skip
        asked.companions.over()
        return entries

    def _ofCracks(self, column):
        """Entries for the cracks of the last push, and of those before along its line, and for its collapse."""
        model, stages = self.model, self.scene.running.at.stages
        own = ["push", *self._pushes()]
        pushes = [number for number, load in self._loads() if list(load) == own]
        ends = [*(stage[3] for stage in stages[1:]), None]
        rows = (slice(stages[n - 1][3], ends[n - 1]) for n in pushes)
        row = next(
            (r for r in (firstCrack(column, s) for s in rows) if r is not None), None
        )
        moved = column("displacement_mm")
        first = None if row is None else moved[row]
        height = model.loading.target.recorded[2] - self.description.low[2]
        sways = height > 0 and abs(model.loading.direction[2]) < 1e-9
        joints = (
            ((i.id1, i.id2), i.phys.opening, i.geom.centres) for i in model.interactions
        )
        width, point, bodies = cracks.widest(joints)
        fell = self.scene.collapsed and len(stages) in pushes
        return dict(
            displacement_at_first_crack_mm=first,
            drift_at_first_crack_mrad=first / height
            if sways and first is not None
            else None,
            recorded_height_m=height if sways else None,
            collapse_displacement_mm=moved[-1] if fell else None,
            largest_crack_mm=1e3 * width,
            largest_crack_at_m=None
            if point is None
            else [round(v, 9) + 0.0 for v in point],
            largest_crack_bodies=None if bodies is None else list(bodies),
        )

    def _ofPush(self, column):
        shear, moved = column("base_shear_kN"), column("displacement_mm")
        top = column("top_shear_kN")
        at = max(range(len(shear)), key=shear.__getitem__)
        imbalance = dynamicImbalance(top, shear)
        period, weight, end = self._swing()
        times = column("time_s")
        ramp = next((n for n, time in enumerate(times) if time >= end), 0)
        still = quasiStatic(top, shear, weight)
        found = dict(
            peak_base_shear_kN=shear[at],
            displacement_at_peak_mm=moved[at],
            peak_at_both_ends_kN=peakAtBothEnds(top, shear),
            base_shear_end_kN=shear[-1],
            displacement_end_mm=moved[-1],
            first_period_s=period or None,
            base_weight=weight,
            initial_stiffness_kN_per_mm=stiffness(moved, still, ramp),
            dynamic_imbalance=imbalance,
            too_fast=imbalance > pushing.IMBALANCE,
        )
        if not self.pushed.history:
            share, begun = suddenLoss(moved, top, shear)
            found.update(sudden_loss=share, sudden_loss_at_mm=begun)
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

    def _ofJoints(self, column):
        """Entries for the joints whose means are recorded."""
        for joint in self.description.joints:
            normal, shear = (
                column(joint.prefixed(f"{what}_stress_MPa"))
                for what in ("normal", "shear")
            )
            modes = "tension", "shear", "compression"
            lost = zip(modes, joint.interaction.phys.dissipated)
            found = {
                "peak_normal_stress_MPa": max(normal),
                "peak_compressive_stress_MPa": -min(normal),
                "peak_shear_stress_MPa": max(shear),
                "end_normal_stress_MPa": normal[-1],
                "end_shear_stress_MPa": shear[-1],
                **{f"dissipated_{mode}_J_per_m2": j / joint.area for mode, j in lost},
            }
            yield from ((joint.prefixed(end), value) for end, value in found.items())

    @withoutCollector()
    def _measured(self, moved, shear):
        """The numbers that masonry.read.measure finds of a wall, and its failure mode: what leaves no frames has them at
        once."""
        found, wall = {}, wallOf(self.description, self.model.loading.target)
        if not self.pushed.history:
            found = measure.pushNumbers(moved, shear)
            if not math.isfinite(found["drop_at_mm"]):
                found["drop_at_mm"] = None
        if wall:
            joints = asFrame(MasonryVtkRecorder().joints(), cracks.NEEDED)
            found.update(cracks.pattern(joints, wall))
            found["failure_mode"] = cracks.failureMode(
                found, wall, not self.pushed.history and stillGrows(moved, shear)
            )
        return found

    # -- curve.png ------------------------------------------------------------------------------------------------

    def figure(self):
        """The entries of run.json by which curve.png is drawn."""
        found = dict(title=self.description.title, figure=self._figure())
        wall = (
            wallOf(self.description, self.model.loading.target) if self.pushed else None
        )
        return {**found, "wall": wall} if wall else found

    def _figure(self):
        """The entry ``figure`` of run.json."""
        loads = self._loads()
        if loads and loads[-1][1][0] != "push" and self.model.loading.followed:
            return self._figureOfLoad(*loads[-1])
        if self.pushed:
            return self._figureOfPush()
        if self.description.joints:
            return self._figureOfJoint(self.description.joints[0])
        heads = columns.heads(self.scene.columns)
        targets = self.description.targets.values()
        moving = [t.name for t in targets if not t.fixed]
        y = [f"{n}_{a}_mm" for n in moving for a in "xyz" if f"{n}_{a}_mm" in heads]
        y = y or [n for n in heads if n.endswith("_kN") and "force" in n][:3]
        return {
            "x": {"column": "time_s", "label": "time [s]"},
            "y": [{"column": n, "label": n.rsplit("_", 1)[0]} for n in y],
            "y_label": "displacement [mm]" if moving else "force [kN]",
            "looped": False,
            "marks": [],
        }

    def _figureOfPush(self):
        target = self.model.loading.target
        height = f"{target.recorded[2]:.3g} m above the base"
        return {
            "x": {
                "column": "displacement_mm",
                "label": f"displacement of {target.name}, {height} [mm]",
            },
            "y": [
                {"column": "base_shear_kN", "label": "supports"},
                {"column": "top_shear_kN", "label": "loaded point"},
            ],
            "y_label": "force along the push [kN]",
            "looped": bool(self.pushed.history),
            "marks": self._marks(),
            "bounds": list(self.scene.bounds.lines(self._pushes())),
            **self._rowsOf(self._pushRows()),
        }

    def _rowsOf(self, rows):
        """The entry of the figure that says which rows it shows, if these are not all in their order."""
        every = list(range(len(self.results.rows)))
        return {} if list(rows) == every else {"rows": list(rows)}

    def _figureOfLoad(self, number, load):
        """What is drawn of a load that grew, or that was put on step by step: its factor over the displacement of what is
        watched."""
        kind, name, _ = load
        at, followed = self.scene.running.at, self.model.loading.followed
        first, factors = at.stages[number - 1][3], self.results.column("load_factor")
        rows = range(first, len(factors))
        if kind == "lean":
            rows = self._restsUnder(name)
        found = {a["name"]: a["value"] for a in at.answers.get(str(number), [])}
        marks = [
            {
                "x": found[f"displacement_{end}"],
                "y": found[f"factor_{end}"],
                "text": f"{what} at {found[f'factor_{end}']:.4g}",
                "below": end == "held",
            }
            for end, what in (("held", "held"), ("not_held", "not held"))
            if found.get(f"displacement_{end}") is not None
        ]
        return {
            "x": {
                "column": "displacement_mm",
                "label": f"displacement of {followed.name} along the load [mm]",
            },
            "y": [{"column": "load_factor", "label": "load"}],
            "y_label": f"load{' while it grows' * (kind == 'growth')} [{self._unitOf(name)}]",
            "looped": False,
            "marks": marks,
            "bounds": list(self.scene.bounds.linesOf(name)),
            **self._rowsOf(rows),
        }

    def _unitOf(self, name):
        return self.scene.bounds.entries.get(name, {}).get("unit") or "-"

    def _restsUnder(self, name):
        """Rows at the ends of the stages that put on a load and came to rest, by its factor, after the row before them."""
        at = self.scene.running.at
        ends = [stage[3] - 1 for stage in at.stages[1:]] + [len(self.results.rows) - 1]
        numbers = [n for n, load in self._loads() if load[:2] == ["lean", name]]
        factors = self.results.column("load_factor")
        held = [
            ends[n - 1]
            for n in numbers
            if any(a["value"] is not None for a in at.answers.get(str(n), []))
        ]
        before = at.stages[numbers[0] - 1][3] - 1
        rows = sorted(set(held), key=lambda row: factors[row])
        return [before] * (before >= 0) + rows

    def _figureOfJoint(self, joint):
        """What is drawn of a joint that is recorded: the stress along which it moved farther, and the other one."""
        column = lambda head: self.results.column(joint.prefixed(head))
        reach = lambda head: max(map(abs, column(head)), default=0)
        slides = reach("slide_mm") > reach("opening_mm")
        moved, what = ("slide_mm", "slide") if slides else ("opening_mm", "opening")
        stresses = [
            {
                "column": joint.prefixed("normal_stress_MPa"),
                "label": "normal, positive in tension",
            },
            {"column": joint.prefixed("shear_stress_MPa"), "label": "shear"},
        ]
        return {
            "x": {
                "column": joint.prefixed(moved),
                "label": f"mean {what} of the joint [mm]",
            },
            "y": stresses[::-1] if slides else stresses,
            "y_label": "mean stress [MPa]",
            "looped": False,
        }

    def _marks(self):
        """Peaks of the push, for the figure."""
        column, rows = self.results.column, self._pushRows()
        whole = column("base_shear_kN"), column("displacement_mm")
        force, moved = ([values[n] for n in rows] for values in whole)
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

    # -- files and terminal ---------------------------------------------------------------------------------------

    def draw(self, directory):
        """Wait until the figures of a run that has ended are drawn and its report is written, in a program of their own. Raises
        Unwritable if one of them fails. Without matplotlib a note says that the figures are left out.
        """
        try:
            self.beginDrawing(directory)
            self._drawing.communicate()
        except OSError as error:
            raise Unwritable(f"the figures are not drawn: {error.strerror}") from None
        finally:
            status, self._begun = self.end(), False
        if status == crew.NO_REPORT:
            raise Unwritable("the report is not written")
        if status:
            raise Unwritable("the figures are not drawn")

    def beginDrawing(self, directory):
        """Name the folder to that program, which then begins; the report waits until :meth:`draw` is called, because figures
        that the run itself writes stand in it. Raises OSError if there is no process.
        """
        if not self._begun:
            self.prepare()
            self._drawing.stdin.write(os.fsencode(directory) + crew.END)
            self._drawing.stdin.flush()
            self._begun = True

    def prepare(self):
        """Start the program that draws the figures and writes the report, which loads its libraries while the run goes on, and
        then waits. Raises OSError if there is no process."""
        if not self._drawing:
            # -P: nothing of the present folder is run; in a session of its own, since Ctrl-C is for the run
            command = [sys.executable, "-P", "-m", "masonry.read.crew"]
            self._drawing = subprocess.Popen(
                command, stdin=subprocess.PIPE, start_new_session=True
            )

    def end(self):
        """End that program. Returns its exit status, or None if it was not started."""
        program, self._drawing = self._drawing, None
        if not program:
            return None
        if program.poll() is None:
            program.kill()
        status = program.wait()
        with contextlib.suppress(OSError):
            program.stdin.close()
        return status

    def write(self, directory, draws=True):
        """Write what the scene has beside rows and frames: the mechanism of limit analysis, with its picture if it is to be
        drawn."""
        description = self.description
        try:
            self.scene.bounds.write(
                directory,
                description.title,
                self.model.parts,
                description.views,
                draws,
            )
        except Missing as missing:
            say(f"mechanism.png is left out: {missing}", sys.stderr)
        except (OSError, MemoryError, ImportError) as error:
            why = getattr(error, "strerror", None) or FULL
            say(f"the mechanism is not written to {directory}: {why}", sys.stderr)

    def report(self, run):
        """Lines to print at the end, from the entries of run.json."""
        name = self.scene.name
        for joint in self.description.joints:
            for end in ("peak_normal", "peak_compressive", "peak_shear", "end_shear"):
                key = joint.prefixed(f"{end}_stress_MPa")
                yield f"{key:32} {run[key]:.4f}"
        yield from self.scene.bounds.over(run)
        yield from answersText(run["answers"])
        if not self.pushed:
            yield f"{name}: {run['ended']}"
            return
        if run["too_fast"]:
            yield pushing.tooFast(self.pushed, run["dynamic_imbalance"])
        if run.get("damped_share", 0) > pushing.DAMPED:
            yield pushing.tooDamped(self.pushed, run["damped_share"])
        if run.get("sudden_loss", 0) > pushing.SUDDEN:
            yield pushing.tooSudden(self.pushed, run)
        at = lambda force, moved: f"{run[force]:.1f} kN at {run[moved]:.2f} mm"
        if "accuracy" in run:
            yield from accuracy.lines(run["accuracy"])
        peak = at("peak_base_shear_kN", "displacement_at_peak_mm")
        end = at("base_shear_end_kN", "displacement_end_mm")
        if "negative_peak_base_shear_kN" not in run:
            yield f"{name}: peak {peak}, {end}"
            return
        other = at("negative_peak_base_shear_kN", "displacement_at_negative_peak_mm")
        yield f"{name}: {len(run['cycles'])} cycles, peaks {peak} and {other}, {end}"

    def warnings(self, run):
        """Sentences on what the numbers of a run suffer from, from the entries of run.json."""
        yield from self.scene.bounds.over(run)
        if self.pushed and run["too_fast"]:
            yield pushing.tooFast(self.pushed, run["dynamic_imbalance"])
        if self.pushed and run.get("damped_share", 0) > pushing.DAMPED:
            yield pushing.tooDamped(self.pushed, run["damped_share"])
        if self.pushed and run.get("sudden_loss", 0) > pushing.SUDDEN:
            yield pushing.tooSudden(self.pushed, run)


def _meanings(cls):
    """What the properties of a class of the plugin mean, by their names."""
    return {p["name"]: p["meaning"] for p in blocks.properties(cls)}


def shortened(said):
    """What a script said, with long lists, as a record of an earthquake, as a text that says how long they are."""
    if isinstance(said, dict):
        return {name: shortened(value) for name, value in said.items()}
    if isinstance(said, (list, tuple)):
        if len(said) > MOST_NUMBERS and all(isinstance(v, (int, float)) for v in said):
            return f"{len(said):,} numbers from {min(said):.6g} to {max(said):.6g}"
        return [shortened(value) for value in said]
    return said
