# SPDX-License-Identifier: GPL-2.0-or-later
"""What comes out of a scene: entries of run.json, and the lines at the end on the terminal."""

import collections
import functools
import math
import sys

from yade import O
from yade.wrapper import MasonryVtkRecorder

from ..common.arguments import isNumber
from ..assembly import blocks
from ..assembly.blocks import units
from ..assembly.engines import LAWS
from ..basics import say, withoutCollector
from ..common.memory import FULL
from ..common.packages import Missing
from ..read import cracks, curves, quantities
from ..read.frames import asFrame
from ..read.run_data import RunData
from ..run import accuracy
from . import bound_texts, facts, history
from .drawing_program import DrawingProgram
from .figure import figureOf
from ..run.options import UNITS
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
        self.drawing = DrawingProgram()
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

    @property
    def loads(self):
        """What stages loaded, in their order: pairs of the number of the stage and what :class:`RunState` keeps of it."""
        loads = self.scene.running.at.loads
        return [(number, loads[str(number)]) for number in sorted(map(int, loads))]

    @property
    def pushes(self):
        """Names of the last push, there and back."""
        pushes = [load[1:] for _, load in self.loads if load[0] == "push"]
        return pushes[-1] if pushes else []

    def _freeVibration(self):
        """Of the first of the pushes that count, as in :class:`masonry.run.run_state.RunState`: the first period, the weight of the base in
        the shear force, and when the velocity of the drive had grown."""
        at = self.scene.running.at
        first = self.data.rows[0] if self.data.rows else math.inf
        for number in sorted(map(int, at.freeVibrations)):
            if at.stages[number - 1][3] >= first:
                return at.freeVibrations[str(number)]
        return 0.0, 0.0, 0.0

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
            properties_of_laws={
                name: sorted(law["properties"]) for name, law in LAWS.items()
            },  # fmt: skip
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
            figure=figureOf(self),
            held=sorted(t.name for t in self.description.targets.values() if t.fixed),
            targets=[
                {"name": t.name, "body": t.body, "held": t.fixed}
                for t in self.description.targets.values()
            ],
            **self._ground(),
            recorded_joints=[joint.name for joint in self.description.joints],
            recorded_drifts=self._columnsOf(self.description.drifts, "mrad"),
            recorded_sections=self._columnsOf(self.description.sections, "kN", "kNm"),
            **self._connections(),
            script=shortened(scene.script.words),
            **self._facts,
            **bound_texts.describe(scene.bounds.entries, self.pushes),
        )
        if self.description.views:
            entries["views"] = self.description.views
        return {**entries, **self._wall()}

    def _wall(self):
        """The entry ``wall``, if a whole wall in running bond is pushed."""
        wall = self.pushed and wallOf(self.description, self.model.loading)
        return {"wall": wall} if wall else {}

    def _columnsOf(self, records, *units):
        """The columns of curve.csv that some records have, of these units."""
        heads = (c.head for one in records for c in one.columns(self.description.plane) if c.unit in units)  # fmt: skip
        return [head for head in heads if head in self.results.columns]

    def _ground(self):
        """Entries for the ground on which blocks fall and for their contact, if a collapse is followed."""
        ground, engine = self.description.ground(), self.model.contacts
        if not (ground and engine):
            return {}
        names = self.description.contact.known()
        return {"ground_body": ground.body, "contact": {n: getattr(engine, n) for n in names}}  # fmt: skip

    @property
    def data(self):
        """What the numbers of the run are found from, as it stands now."""
        at, results = self.scene.running.at, self.results
        column = functools.cache(lambda name: results.column(name) if name in results.columns else None)  # fmt: skip
        return RunData({"stages": at.listed(), **results.run}, column)

    def summarise(self):
        """Add to the entries of run.json what follows from the rows."""
        scene, run = self.scene, self.results.run
        run.update(collapse=run.get("collapse"), ended=scene.ended)
        for joint in self.description.joints:
            run.update(quantities.ofJoint(self.results.column, joint.prefixed))
            run.update(joint.dissipated())
        if math.isfinite(scene.factor):
            run["factor"] = scene.factor
        run.update(self._connections())
        if not scene.only:
            run.update(self._cracks())
        data = self.data
        if not self.pushed:
            run.update(quantities.found(data))
        else:
            run.update(self._ofPush(data))
            if self.args.lean and "wall" in run:
                with withoutCollector():
                    data.joints = asFrame(MasonryVtkRecorder().joints(), cracks.NEEDED)
            data.run = run
            run.update(quantities.found(data))
            if data.isLooped:
                run["cycles"] = data.cycles
            if scene.accuracy and not scene.running.interrupted:
                # a push that is not over is shorter than those of its companions
                self._addAccuracy(run)
        run["answers"] = scene.answers

    def _ofPush(self, data):
        """Entries that the numbers of a push are found from, and what the joints say."""
        model = self.model
        period, weight, grown = self._freeVibration()
        target, sways = model.loading.target, abs(model.loading.direction[2]) < 1e-9
        heights = target.recorded[2], model.supports.driftHeight(target)
        recorded, drift = (z - self.description.low[2] for z in heights)
        past = self.pushed.history
        return {
            "first_period_s": period or None,
            "base_weight": weight or curves.SHEAR,
            "velocity_grown_at_s": grown,
            "recorded_height_m": recorded if sways and recorded > 0 else None,
            "drift_height_m": drift if sways and drift > 0 else None,
            **({"history": history.describe(past)} if past else {}),
        }

    def _cracks(self):
        """Entries for the widest cracks, of all joints and by kind of joint and part."""
        bricks = self.description.bricks
        parts = {body: f"part {b.part}" for body, b in zip(self.model.ids, bricks)}
        groups = lambda i: {i.phys.joint.name, *(parts[b] for b in (i.id1, i.id2) if b in parts)}  # fmt: skip
        width, point, bodies, found = cracks.widest(
            ((i.id1, i.id2), groups(i), i.phys.opening, i.geom.centres)
            for i in self.model.interactions
        )
        return {
            "largest_crack_mm": 1e3 * width,
            "largest_crack_at_m": None if point is None else [round(v, 9) + 0.0 for v in point],
            "largest_crack_bodies": None if bodies is None else list(bodies),
            "largest_cracks_mm": {name: 1e3 * found[name] for name in sorted(found)},
        }  # fmt: skip

    def _connections(self):
        """Entries for ties and springs, if there are any."""
        description = self.description
        kinds = collections.defaultdict(list, overlays=description.overlays)
        for one in description.connectors:
            if one.isListed:
                kinds[one.PLURAL].append(one)
        return {name: [one.entry() for one in records] for name, records in kinds.items() if records}  # fmt: skip

    def _addAccuracy(self, run):
        """Add the entries for --accuracy, whose half-widths the answers of the last push get, too."""
        at, asked = self.scene.running.at, self.scene.accuracy
        run.update(asked.report(run))
        number = str([n for n, load in self.loads if load[0] == "push"][-1])
        own = accuracy.answers(run["accuracy"])
        names = {one["name"] for one in own}
        stage = {"stage": "push", "number": int(number)}
        others = [a for a in at.answers.get(number, []) if a["name"] not in names]
        at.answers = {**at.answers, number: [*({**stage, **one} for one in own), *others]}  # fmt: skip
        asked.over()

    # -- files and terminal ---------------------------------------------------------------------------------------

    def figure(self):
        """The entries of run.json by which curve.png is drawn."""
        found = dict(title=self.description.title, figure=figureOf(self))
        return {**found, **self._wall()}

    def write(self, directory, draws=True):
        """Write what the scene has beside rows and frames: the mechanism of limit analysis, with its picture if it is to be
        drawn."""
        description = self.description
        try:
            self.scene.bounds.write(
                directory, description.title, self.model.parts, description.views, draws
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
            found = quantities.ofJoint(self.results.column, joint.prefixed, brief=True)
            yield from (f"{key:32} {value:.4f}" for key, value in found.items())
        yield from answersText(run["answers"], run.get("stages") or ())
        if "accuracy" in run:
            yield from accuracy.lines(run["accuracy"])
        yield f"{name}: {quantities.headline(run, end=True) or run['ended']}"

    def warnings(self, run):
        """Sentences on what the numbers of a run suffer from, from the entries of run.json."""
        bounds = self.scene.bounds
        yield from bound_texts.over(bounds.entries, bounds.place.held, run)
        if not self.pushed:
            return
        if run.get("too_fast"):
            yield pushing.tooFast(self.pushed, run["dynamic_imbalance"])
        if run.get("damped_share", 0) > pushing.DAMPED:
            yield pushing.tooDamped(self.pushed, run["damped_share"])
        if run.get("sudden_loss", 0) > pushing.SUDDEN:
            yield pushing.tooSudden(self.pushed, run)


def _meanings(cls):
    return {p["name"]: p["meaning"] for p in blocks.properties(cls)}


def shortened(entry):
    """What a script said, with long lists, as a record of an earthquake, as a text that says how long they are."""
    if isinstance(entry, dict):
        return {name: shortened(value) for name, value in entry.items()}
    if isinstance(entry, (list, tuple)):
        if len(entry) > MOST_NUMBERS and all(map(isNumber, entry)):
            return f"{len(entry):,} numbers from {min(entry):.6g} to {max(entry):.6g}"
        return [shortened(value) for value in entry]
    return entry
