# SPDX-License-Identifier: GPL-2.0-or-later
"""What comes out of a scene: entries of run.json, also of its figure, and the lines at the end."""

import collections
import functools
import math
import sys

from yade import O
from yade.wrapper import MasonryVtkRecorder

from ..arguments import isNumber
from ..model import bodies
from ..numbers import columns
from ..materials.assumptions import effective
from ..terminal import say
from ..memory import withoutCollector
from ..memory import FULL
from ..numbers import cracks, curves, quantities
from ..numbers.frames import asFrame
from ..numbers.quantities import IMBALANCE
from ..numbers.run_data import BASE, DRIFT, MOVED, TOP, RunData
from ..run import accuracy
from ..run.option_table import UNITS
from . import history, summary
from ..run.drawing_program import DrawingProgram
from ..stages import pushing
from ..stages.answers import answersText

FRAMES = 20  # for ParaView in a stage that is no push
REPORT = 2e6  # [bytes] of report.html, of which three.js takes nearly half
MAX_NUMBERS = 24  # of a list that the script said, as run.json has it


class ResultSummary:
    """What comes out of a :class:`masonry.scene.scene.Scene` that stands in YADE."""

    def __init__(self, scene):
        self.scene, self.model = scene, scene.model
        self.description, self.args = scene.description, scene.args
        self.results = scene.running.results
        self.drawing = DrawingProgram()
        self._summary = {}  # entries of run.json on what is built and held before the first stage
        if not self.args.lean:
            of = {"built": summary.sizes, "held_and_loaded": summary.held}
            self._summary = {n: [*map(list, f(self.description))] for n, f in of.items()}

    @property
    def pushed(self):
        return self.scene.pushed

    @property
    def loads(self):
        """What stages loaded, in their order: pairs of a number of a stage and an entry of
        ``RunState.loads``."""
        loads = self.scene.running.state.loads
        return [(number, loads[str(number)]) for number in sorted(map(int, loads))]

    @property
    def pushes(self):
        pushes = [load[1:] for _, load in self.loads if load[0] == "push"]
        return pushes[-1] if pushes else []

    def _freeVibration(self):
        """The first period [s], the weight of the base in the shear force [-], and when the drive
        had its velocity [s], of the first push that counts."""
        state, rows = self.scene.running.state, self.data.rows
        for number in sorted(map(int, state.freeVibrations)):
            if rows and state.stages[number - 1]["first_row"] >= rows[0]:
                return state.freeVibrations[str(number)]
        return 0.0, 0.0, 0.0

    def space(self):
        """Bytes that a run writes at least, and probably."""
        model, args, frames, rows = self.model, self.args, FRAMES, 0
        frame = 50 * model.subcontacts + 150 * len(O.bodies) + 100 * self._nodes
        if args.history or args.until:
            frames = pushing.pathOf(args) / pushing.frameSpacing(args) + 2
            rows = pushing.rowCount(args)
        frames *= not (args.no_vtk or args.lean)
        least = (50e3 if args.lean else 400e3) + frame * min(frames, 2)  # first and last
        return least, least + REPORT * (not args.lean) + frame * frames + 250 * rows

    @property
    def _nodes(self):
        zones = self.model.zones
        return len(zones.displacements) if zones else 0

    # -- run.json ----------------------------------------------------------------------------------

    def describe(self):
        """Entries of run.json that say what is built, and how it is held and drawn."""
        model, scene, description = self.model, self.scene, self.description
        kinds = collections.Counter(i.phys.joint.name for i in model.interactions)
        joints = {name: joint.dict() for name, joint in model.joints.items()}
        for properties in joints.values():
            properties["direction"] = list(properties["direction"])
        known = bodies.properties(type(next(iter(model.joints.values()))))
        targets = description.targets.values()
        entries = dict(
            title=description.title,
            option_units=UNITS,
            joints=joints,
            joint_units={p["name"]: p["unit"] for p in known if p["unit"]},
            joint_meanings={p["name"]: p["meaning"] for p in known},
            effective_properties={name: effective(joint) for name, joint in model.joints.items()},
            unit_material={
                "young_Pa": model.unit.young,
                "poisson": model.unit.poisson,
                "density_kg_per_m3": model.unit.density / self.args.density_scaling,
            },
            assumed=scene.assumed,
            time_step_s=O.dt,
            time_step_limit_s=model.scheme.presentLimit,
            added_inertia=model.scheme.addedInertia,
            units=len(model.bricks),
            nodes=self._nodes,
            joint_count=len(model.interactions),
            joints_by_kind=dict(kinds),
            subcontacts=model.subcontacts,
            parts=model.parts,
            **self._figure(),
            held=sorted(t.name for t in targets if t.fixed),
            targets=[{"name": t.name, "body": t.body, "held": t.fixed} for t in targets],
            **self._ground(),
            recorded_joints=[joint.name for joint in description.joints],
            recorded_drifts=self._columnsOf(description.drifts, "mrad"),
            recorded_sections=self._columnsOf(description.sections, "kN", "kNm"),
            **({"piers": description.piers} if description.piers else {}),
            **self._connections(),
            script=shortened(scene.script.commands),
            **self._summary,
            **dict(scene.bounds.inRunJson(self.pushes)),
        )
        views = {"views": description.views} if description.views else {}
        return {**entries, **views, **self._wall()}

    def _figure(self):
        with self.scene.running.auxiliary("what curve.png shows"):
            return {"figure": figureOf(self)}
        return {}

    def _wall(self):
        wall = self.pushed and summary.wallOf(self.description, self.model.loading)
        return {"wall": wall} if wall else {}

    def _columnsOf(self, records, *units):
        """The columns of curve.csv that some records have, of these units."""
        heads = (
            c.head
            for one in records
            for c in one.columns(self.description.plane)
            if c.unit in units
        )
        return [head for head in heads if head in self.results.columns]

    def _ground(self):
        ground, engine = self.description.ground(), self.model.contacts
        if not (ground and engine):
            return {}
        names = self.description.contact.known
        return {"ground_body": ground.body, "contact": {n: getattr(engine, n) for n in names}}

    @property
    def data(self):
        state, results = self.scene.running.state, self.results
        column = functools.cache(
            lambda name: results.column(name) if name in results.columns else None
        )
        return RunData({"stages": state.listed(), **results.run}, column)

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
        if not scene.limitAnalysisOnly:
            run.update(self._cracks())
        data = self.data
        if self.pushed:
            run.update(self._ofPush())
            if self.args.lean and "wall" in run:
                with withoutCollector():
                    data.joints = asFrame(MasonryVtkRecorder().joints(), cracks.NEEDED)
            data.run = run
        run.update(quantities.found(data))
        if self.pushed and data.isLooped:
            run["cycles"] = data.cycles
        if self.pushed and scene.accuracy and not scene.running.interrupted:
            # an unfinished push cannot be compared with the auxiliary runs
            with scene.running.auxiliary("--accuracy"):
                self._addAccuracy(run)
        run["answers"] = scene.answers

    def _ofPush(self):
        """Entries from which the numbers of a push are found."""
        model = self.model
        period, weight, grown = self._freeVibration()
        loading = model.loading
        recorded, drift = model.supports.heights(loading.control, loading.push.direction)
        past = self.pushed.history
        return {
            "first_period_s": period / self.args.density_scaling**0.5 or None,
            "base_weight": weight or curves.SHEAR,
            "velocity_grown_at_s": grown,
            "recorded_height_m": recorded,
            "drift_height_m": drift,
            **({"history": history.describe(past)} if past else {}),
        }

    def _cracks(self):
        parts = {body: f"part {b.part}" for body, b in zip(self.model.ids, self.description.bricks)}
        groups = lambda i: {i.phys.joint.name, *(parts[b] for b in (i.id1, i.id2) if b in parts)}
        width, point, bodies, found = cracks.widest(
            ((i.id1, i.id2), groups(i), i.phys.opening, i.geom.centres)
            for i in self.model.interactions
        )
        return {
            "largest_crack_mm": 1e3 * width,
            "largest_crack_at_m": point and [round(v, 9) + 0.0 for v in point],
            "largest_crack_bodies": bodies and list(bodies),
            "largest_cracks_mm": {name: 1e3 * found[name] for name in sorted(found)},
        }

    def _connections(self):
        description = self.description
        kinds = collections.defaultdict(list, overlays=description.overlays)
        for one in description.connectors:
            if one.isListed:
                kinds[one.PLURAL].append(one)
        return {
            name: [one.entry() for one in records] for name, records in kinds.items() if records
        }

    def _addAccuracy(self, run):
        """Add the entries of --accuracy, and their half-widths to the answers of the last push."""
        state, asked = self.scene.running.state, self.scene.accuracy
        run.update(asked.report(run))
        number = str([n for n, load in self.loads if load[0] == "push"][-1])
        own = accuracy.answers(run["accuracy"])
        names = {one["name"] for one in own}
        stage = {"stage": "push", "number": int(number)}
        others = [a for a in state.answers.get(number, []) if a["name"] not in names]
        state.answers = {**state.answers, number: [*({**stage, **one} for one in own), *others]}
        asked.onRunEnded()

    # -- files and terminal ------------------------------------------------------------------------

    def figure(self):
        return {"title": self.description.title, **self._figure(), **self._wall()}

    def write(self, directory, wait=True):
        """Write the mechanism of limit analysis; ``wait``: for files that are made beside the
        run."""
        with self.scene.running.auxiliary("the mechanism of limit analysis"):
            try:
                self.scene.bounds.write(directory, wait)
            except (OSError, MemoryError, ImportError) as error:
                why = getattr(error, "strerror", None) or FULL
                say(f"the mechanism is not written to {directory}: {why}", sys.stderr)

    def report(self, run):
        name = self.scene.name
        for joint in self.description.joints:
            found = quantities.ofJoint(self.results.column, joint.prefixed, brief=True)
            yield from (f"{key:32} {value:.4f}" for key, value in found.items())
        yield from answersText(run["answers"], run.get("stages") or ())
        if "accuracy" in run:
            yield from accuracy.lines(run["accuracy"])
        grows = bool(self.pushed) and self.data.stillGrows
        yield f"{name}: {quantities.headline(run, True, grows) or run['ended']}"

    def warnings(self, run):
        yield from self.scene.bounds.over(run)
        if not self.pushed:
            return
        yield from self._ofEarlierPushes(run["stages"])
        if run.get("too_fast"):
            yield pushing.tooFast(self.pushed, run["dynamic_imbalance"])
        if run.get("damped_share", 0) > pushing.DAMPED:
            yield pushing.tooDamped(self.pushed, run["damped_share"])
        if run.get("sudden_loss", 0) > pushing.SUDDEN:
            yield pushing.tooSudden(self.pushed, run["sudden_loss"], run["sudden_loss_at_mm"])

    def _ofEarlierPushes(self, stages):
        """Warnings of the pushes before those whose numbers run.json has; ``stages``: its entry."""
        paths = self.scene.running.state.paths
        for number, (one, after) in enumerate(zip(stages, stages[1:]), 1):
            rows, path = slice(one["first_row"], after["first_row"]), paths.get(str(number))
            if not path or rows.start in self.data.rows or rows.start == rows.stop:
                continue
            moved, top, base = (self.data.whole(name)[rows] for name in (MOVED, TOP, BASE))
            name, isLooped = f"{one['stage']} (stage {number})", path[1]
            imbalance = curves.dynamicImbalance(top, base)
            if imbalance > IMBALANCE:
                yield pushing.tooFast(self.pushed, imbalance, name)
            sudden = (0.0, 0.0) if isLooped else curves.suddenLoss(moved, top, base)
            if sudden[0] > pushing.SUDDEN:
                yield f"{name}: {pushing.tooSudden(self.pushed, *sudden)}"


def shortened(entry):
    """What a script said, without the numbers of long lists, as of a record of an earthquake."""
    if isinstance(entry, dict):
        return {name: shortened(value) for name, value in entry.items()}
    if isinstance(entry, (list, tuple)):
        if len(entry) > MAX_NUMBERS and all(map(isNumber, entry)):
            return f"{len(entry):,} numbers from {min(entry):.6g} to {max(entry):.6g}"
        return [shortened(value) for value in entry]
    return entry


# -- curve.png -------------------------------------------------------------------------------------


def figureOf(outcome):
    """The entry ``figure`` of run.json, by which curve.png is drawn."""
    scene, model, loads = outcome.scene, outcome.model, outcome.loads
    if loads and loads[-1][1][0] != "push" and model.loading.followed:
        return _ofLoad(outcome, *loads[-1])
    if outcome.pushed:
        return _ofPush(outcome)
    if outcome.description.joints:
        return _ofJoint(outcome, outcome.description.joints[0])
    heads = columns.heads(scene.columns)
    moving = [t.name for t in outcome.description.targets.values() if not t.fixed]
    y = [f"{n}_{a}_mm" for n in moving for a in "xyz" if f"{n}_{a}_mm" in heads]
    y = y or [n for n in heads if n.endswith("_kN") and "force" in n][:3]
    what = "displacement [mm]" if moving else "force [kN]"
    return _entry("time_s", "time [s]", {n: n.rsplit("_", 1)[0] for n in y}, what)


def _entry(x, label, y, what, marks=(), looped=False, **more):
    """An entry of one column over another.

    :param y: labels of the columns by their names; ``what``: label of their axis
    """
    return {
        "x": {"column": x, "label": label},
        "y": [{"column": column, "label": text} for column, text in y.items()],
        "y_label": what,
        "looped": looped,
        "marks": [*marks],
        **more,
    }


def _ofPush(outcome):
    control, data = outcome.model.loading.control, outcome.data
    mean = "mean " * (control.box is None and control.brick is None)  # of a pattern
    height = f"{control.recorded[2] - outcome.description.low[2]:.3g} m above the base"
    looped, marks, more = bool(outcome.pushed.history), [], _rowsOf(outcome, data.rows)
    x, label, unit = MOVED, f"{mean}displacement of {control.name}, {height} [mm]", "mm"
    if outcome.args.ratios and data.rows and data.column(DRIFT) is not None:
        x, label, unit = DRIFT, "drift [%]", "%"
        more["weight_kN"] = -data["base_N_kN"][0]
    if data.rows:
        moved, sides = data[x], (1, -1) if looped else (1,)
        ends = [(moved[data.peak(side)], data.peakForce(side)) for side in sides]
        marks = [{"x": x, "y": y, "text": f"{y:.1f} kN at {x:.2f} {unit}"} for x, y in ends]
    return _entry(
        x,
        label,
        {"base_shear_kN": "supports", "top_shear_kN": "loaded point"},
        "force along the push [kN]",
        marks,
        looped,
        bounds=[*outcome.scene.bounds.linesOfPush(outcome.pushes)],
        **more,
    )


def _rowsOf(outcome, rows):
    """The entry of the figure with the rows that it shows, if these are not all in order."""
    if [*rows] == [*range(len(outcome.results.rows))]:
        return {}
    spans: list[list[int]] = []
    for row in rows:
        if not spans or spans[-1][1] != row:
            spans.append([row, row])
        spans[-1][1] += 1
    return {"rows": spans}


def _ofLoad(outcome, number, load):
    """The factor of a load that grew, or was put on step by step, over the displacement of what is
    watched."""
    kind, name, _ = load
    state, entry = outcome.scene.running.state, outcome.scene.bounds.entries.get(name, {})
    rows = range(state.stages[number - 1]["first_row"], len(outcome.results.rows))
    if kind == "lean":
        rows = restsUnder(outcome, name)
    found = {a["name"]: a["value"] for a in state.answers.get(str(number), [])}
    marks = []
    for end in ("held", "not_held"):
        x, y = (found.get(f"{of}_{end}") for of in ("displacement", "factor"))
        if x is not None:
            text = f"{end.replace('_', ' ')} at {y:.4g}"
            marks.append({"x": x, "y": y, "text": text, "below": end == "held"})
    return _entry(
        "displacement_mm",
        f"displacement of {outcome.model.loading.followed.name} along the load [mm]",
        {"load_factor": "load"},
        f"load{' while it grows' * (kind == 'growth')} [{entry.get('unit') or '-'}]",
        marks,
        bounds=[*outcome.scene.bounds.linesOfGrowth(name)],
        **_rowsOf(outcome, rows),
    )


def restsUnder(outcome, name):
    """The row before a load was put on, and those at the ends of its stages that came to rest, by
    its factor."""
    state, results = outcome.scene.running.state, outcome.results
    ends = [stage["first_row"] - 1 for stage in state.stages[1:]] + [len(results.rows) - 1]
    numbers = [n for n, load in outcome.loads if load[:2] == ["lean", name]]
    answers = {n: state.answers.get(str(n), []) for n in numbers}
    held = {ends[n - 1] for n in numbers if any(a["value"] is not None for a in answers[n])}
    before = state.stages[numbers[0] - 1]["first_row"] - 1
    factors = results.column("load_factor")
    return [before] * (before >= 0) + sorted(held, key=lambda row: factors[row])


def _ofJoint(outcome, joint):
    column = lambda head: outcome.results.column(joint.prefixed(head))
    reach = lambda what: max(map(abs, column(f"{what}_mm")), default=0)
    isHere = lambda what: joint.prefixed(f"{what}_mm") in outcome.results.columns
    what = max(filter(isHere, ("opening", "slide", "slide_across")), key=reach)
    stresses = {
        joint.prefixed("normal_stress_MPa"): "normal, positive in tension",
        joint.prefixed(
            f"shear_stress{what.removeprefix('slide') * (what != 'opening')}_MPa"
        ): "shear",
    }
    if what != "opening":
        stresses = dict(reversed(stresses.items()))
    x, label = joint.prefixed(f"{what}_mm"), f"mean {what.replace('_', ' ')} of the joint [mm]"
    return _entry(x, label, stresses, "mean stress [MPa]")
