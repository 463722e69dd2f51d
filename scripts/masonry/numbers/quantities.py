# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers that a run answers with: one list, which run.json and its documentation, the
terminal, the report, notebooks, studies and capacity read.

The function of a :class:`Quantity` finds it from a :class:`RunData`, which a run has at its end and
its folder has later, so both give the same number. A *push* below is the last one of the run, with
those before it with whose curve it goes on (``continued``). Forces along it are at its two ends:
those of all supports (``base_shear_kN``) and that of the drive (``top_shear_kN``).
"""

import math
from dataclasses import dataclass
from typing import Any, Callable, NamedTuple

from ..arguments import isNumber
from . import cracks, curves, loops
from .run_data import BASE, FALL, MASONRY, MOVED, TOP, RunData

#: A push with a larger dynamic imbalance is too fast: its peak is off by 1 to 5 % and more [-].
IMBALANCE = 0.1

#: Energies of the balance by their names in curve.csv, without the unit: what each is, and whether
#: it is put in, stored or spent.
ENERGIES = {
    "external": ("work of the loads", "in"),
    "gravity": ("work of gravity", "in"),
    "refining": ("elastic energy that joints got when they were given more points", "in"),
    "kinetic": ("energy of motion", "spent"),
    "damping": ("energy taken by damping", "spent"),
    "impacts": ("energy taken by impacts of joints that close", "spent"),
    "elastic_units": ("elastic energy in deformable units", "stored"),
    "elastic_tension": ("elastic energy in joints, from tension", "stored"),
    "elastic_shear": ("elastic energy in joints, from shear", "stored"),
    "elastic_compression": ("elastic energy in joints, from compression", "stored"),
    "dissipated_tension": ("energy that joints dissipated in tension", "spent"),
    "dissipated_shear": ("energy that joints dissipated in shear", "spent"),
    "dissipated_compression": ("energy that joints dissipated in compression", "spent"),
}
#: Energies of ties, springs and testing machines, and of contacts, in scenes that have some.
OF_CONNECTORS = {
    "elastic_connectors": ("elastic energy in ties, springs and testing machines", "stored"),
    "dissipated_connectors": ("energy that ties and testing machines dissipated", "spent"),
}
OF_CONTACTS = {
    "handing": ("energy that the change from joints to contacts gave", "in"),
    "elastic_contacts": ("elastic energy in contacts", "stored"),
    "friction_contacts": ("energy that friction of contacts took", "spent"),
    "damping_contacts": ("energy that damping of contacts took", "spent"),
}


class Number(NamedTuple):
    """A number that is shown."""

    name: str  #: a name in words, or that of an entry
    value: Any  #: None if there is none; ``note`` says why
    unit: str  #: ``"-"`` if it has none
    meaning: str  #: one sentence
    source: str  #: equation, or file and entry
    note: str = ""  #: what the number does not say, or why there is none

    def entry(self) -> dict[str, Any]:
        return self._asdict()


UNITS = "kN/mm J/m² cm² cm³ mrad MPa kN mm J s m".split()


@dataclass(frozen=True)
class Quantity:
    """A number of a run."""

    key: str  #: its entry in run.json, which ends with its unit, as ``_J_per_m2``
    name: str  #: in words; empty: only run.json has it
    meaning: str  #: a sentence
    source: str  #: columns of curve.csv, an equation or a function
    #: function of :class:`RunData`, or of a function that gives the columns of a joint; None: the
    #: run itself writes it
    of: Callable[[Any], Any] | None = None
    group: str = "push"  #: one of :data:`GROUPS`, which says in which runs it is
    #: whether it is among the few that a notebook shows, and that stand first in study.csv
    brief: bool = False
    share: bool = False  #: whether it is shown in per cent
    ownUnit: str = ""  #: where the key does not end with the unit

    @property
    def unit(self) -> str:
        ends = lambda unit: unit.replace("/", "_per_").replace("²", "2").replace("³", "3")
        found = (unit for unit in UNITS if self.key.endswith(f"_{ends(unit)}"))
        return self.ownUnit or next(found, "-")

    def shown(self, value):
        unit = "%" if self.share else self.unit
        value = 100 * value if self.share else value
        return Number(self.name, value, unit, self.meaning, f"run.json: {self.key}")


class State(NamedTuple):
    """A state of a push that is looked for in its rows."""

    name: str
    displacement: str  #: entry of run.json
    drift: str  #: entry of run.json
    find: Callable[[RunData], float | None]  #: gives a row number with a fraction
    meaning: str
    missing: str = ""  #: why there may be none
    share: bool = False  #: whether it is a fall to :data:`FALL` of the peak


STATES = (
    State(
        "first crack",
        "displacement_at_first_crack_mm",
        "drift_at_first_crack_mrad",
        lambda d: d.firstCrack,
        "The first row at which the joints have dissipated, in tension and shear since the push"
        " began, more than 1e-5 of the elastic energy; of dry joints it is where slip begins to"
        " count.",
        "no crack was seen in the push",
    ),
    State(
        "peak",
        "displacement_at_peak_mm",
        "drift_at_peak_mrad",
        lambda d: d.peak(),
        "The largest force that both ends carry at once.",
    ),
    State(
        "0.8 of the peak",
        "displacement_at_fall_mm",
        "drift_at_fall_mrad",
        lambda d: d.fallenTo(FALL),
        "Where the force that both ends carry at once has fallen to 0.8 of its peak, after it,"
        " for longer than a first period; of cycles on the envelope.",
        "the force never falls to 0.8 of its peak",
        True,
    ),
    State(
        "collapse",
        "collapse_displacement_mm",
        "drift_at_collapse_mrad",
        lambda d: d.collapse,
        "The last row of a push that ended in a collapse.",
        "the push did not end in a collapse",
    ),
)


_AT_POINT, _AT_BASE, _AT_ENDS = (f"curve.csv: {c}" for c in (MOVED, BASE, f"{BASE}, {TOP}"))
_OF_SHEAR = "curve.csv: shear_stress_MPa, in space with shear_stress_across_MPa"
_OF_DRIFT = f"curve.csv: {MASONRY}, or {MOVED}, over drift_height_m"


def _ofStates():
    for state in STATES:
        moved = lambda d, state=state: d.at(d[MOVED], d.place(state.find))
        drift = lambda d, state=state: d.drift(d.place(state.find))
        where = f"at the {'state: ' * (state.name == 'collapse')}{state.name}"
        yield Quantity(
            state.displacement,
            f"displacement {where}",
            f"Displacement of the pushed point. {state.meaning}",
            _AT_POINT,
            moved,
            group="state",
            brief=state.name in ("first crack", "peak"),
        )
        yield Quantity(
            state.drift,
            f"drift {where}",
            f"Drift of the masonry. {state.meaning}",
            _OF_DRIFT,
            drift,
            group="state",
        )


#: In which runs a quantity is: what they are called, and whether a run is one of them.
GROUPS: dict[str, tuple[str, Callable[[RunData], bool]]] = {
    "every": ("Every run has these", lambda d: True),
    "cost": ("and these, which are no measures of the structure", lambda d: True),
    "push": ("A run with a push has these, too", lambda d: d.isPush),
    "state": (
        "and these, which are None where the state is not reached or the push is not horizontal",
        lambda d: d.isPush,
    ),
    "one way": ("A push in one direction has these, too", lambda d: d.isPush and not d.isLooped),
    "loops": ("A push that follows a history has these, too", lambda d: d.isPush and d.isLooped),
    "wall": (
        "A whole wall in running bond that a platen pushes has these with ``--lean``, which leaves"
        " no frames; masonry_view.measure finds them from frames",
        lambda d: d.isPush and d.joints is not None and "wall" in d.run,
    ),
    "joint": (
        "A run that records the means of a joint has these, with its name before them if it"
        " has one",
        lambda d: False,
    ),
    "bound": (
        "A run that pushes, leans or tilts has these, if limit analysis (masonry_limit) applies",
        lambda d: False,
    ),
}


def shearOf(column: Callable[[str], Any]) -> list[float]:
    """The amount of the mean shear stress of a joint in all rows [MPa].

    :param column: gives the values of a column of the joint by its name; of one that is missing
        nothing or an error
    """
    along = column("shear_stress_MPa")
    try:
        across = column("shear_stress_across_MPa")
    except (LookupError, ValueError):
        across = None
    return [*map(math.hypot, along, across or [0.0] * len(along))]


def _ofPattern(key):
    return lambda data: data.pattern[key]


Q = Quantity
QUANTITIES: tuple[Quantity, ...] = (
    Q(
        "peak_at_both_ends_kN",
        "peak",
        "Largest force along the push that the loaded point and the supports carry at once, so"
        " without waves that pass through; of loops where the displacement is positive.",
        _AT_ENDS,
        lambda d: d.peakForce(),
        brief=True,
    ),
    Q(
        "peak_base_shear_kN",
        "force at the supports at the peak",
        "Force along the push at all that is held, at the peak.",
        _AT_BASE,
        lambda d: d[BASE][d.peak()],
        brief=True,
    ),
    *_ofStates(),
    Q(
        "drift_height_m",
        "height of drifts",
        "Height above the lowest brick of the points whose displacement is the drift of the"
        " masonry; None if the push is not horizontal.",
        "the bricks at the pushed platen, or the pushed point",
        group="state",
    ),
    Q(
        "recorded_height_m",
        "height of the pushed point",
        "Height above the lowest brick of the point whose displacement is recorded; None if"
        " the push is not horizontal.",
        "the platen or brick",
        group="state",
    ),
    Q(
        "negative_peak_at_both_ends_kN",
        "peak of the other side",
        "Largest force on the way back that the loaded point and the supports carry at once,"
        " where the displacement is negative.",
        _AT_ENDS,
        lambda d: d.peakForce(-1),
        group="loops",
    ),
    Q(
        "negative_peak_base_shear_kN",
        "force at the supports at the peak of the other side",
        "Force along the push at all that is held, at that peak.",
        _AT_BASE,
        lambda d: d[BASE][d.peak(-1)],
        group="loops",
    ),
    Q(
        "displacement_at_negative_peak_mm",
        "displacement at the peak of the other side",
        "Displacement of the pushed point there.",
        _AT_POINT,
        lambda d: d[MOVED][d.peak(-1)],
        group="loops",
    ),
    Q(
        "drift_at_negative_peak_mrad",
        "drift at the peak of the other side",
        "Drift of the masonry there.",
        _OF_DRIFT,
        lambda d: d.drift(d.peak(-1)),
        group="loops",
    ),
    Q(
        "base_shear_end_kN",
        "force at the end",
        "Force at the supports in the last row.",
        _AT_BASE,
        lambda d: d[BASE][-1],
        brief=True,
    ),
    Q(
        "displacement_end_mm",
        "displacement at the end",
        "Displacement of the pushed point in the last row.",
        _AT_POINT,
        lambda d: d[MOVED][-1],
        brief=True,
    ),
    Q(
        "initial_stiffness_kN_per_mm",
        "initial stiffness",
        "Slope of the line through the beginning of the push that fits its first part best,"
        " without the inertia of the structure.",
        "masonry.numbers.curves.stiffness",
        lambda d: d.stiffness,
        brief=True,
    ),
    Q(
        "push_work_J",
        "work of the push",
        "Area under the curve of the push; none if its displacement is that of a control, on which"
        " the force does no work.",
        f"{_AT_BASE}, {MOVED}",
        lambda d: d.work(lambda moved, base: loops.area(base, moved)),
        group="one way",
        brief=True,
    ),
    Q(
        "first_period_s",
        "first period along the push while the drive holds",
        "First period of the structure along the push, measured as it began, while the drive held"
        " the pushed point, or of the free structure if the push was a pattern; None if none was"
        " found. period() measures that of the free structure.",
        "masonry.model.period",
    ),
    Q(
        "base_weight",
        "",
        "w of the shear force V_s = (1 - w) top + w base, which leaves out the inertia of the"
        " structure's own mass; from the shape in which the structure moved as the push began,"
        " else 2/3.",
        "masonry.numbers.curves.quasiStatic",
    ),
    Q(
        "velocity_grown_at_s",
        "",
        "Time at which the velocity of the drive had grown in the first of these pushes; 0 if"
        " no first period was found.",
        "the drive",
    ),
    Q(
        "dynamic_imbalance",
        "dynamic imbalance",
        "RMS of (applied - base shear) over the largest force: the larger of the values before"
        " and after the peak. Near 0 in a quasi-static test.",
        "masonry.numbers.curves.dynamicImbalance",
        lambda d: curves.dynamicImbalance(d[TOP], d[BASE]),
        brief=True,
        share=True,
    ),
    Q(
        "too_fast",
        "",
        "Whether the dynamic imbalance is more than a push may have, 0.1.",
        "dynamic_imbalance",
        lambda d: curves.dynamicImbalance(d[TOP], d[BASE]) > IMBALANCE,
    ),
    Q(
        "largest_crack_mm",
        "widest crack at the end",
        "Largest opening of a point of any joint at the end of the run, also of those to"
        " platens; slide does not count; 0 if none is open.",
        "the joints at the end",
        group="every",
        brief=True,
    ),
    Q(
        "damage_class",
        "damage class of the widest crack",
        "Of the widest crack at the end, by the table of Burland, Broms and De Mello (1977)"
        " and BRE Digest 251: 0 negligible, up to 0.1 mm; 1 very slight, 1 mm; 2 slight, 5 mm;"
        " 3 moderate, 15 mm; 4 severe, 25 mm; 5 very severe.",
        "largest_crack_mm",
        lambda d: cracks.damageClass(d.run["largest_crack_mm"]),
        group="every",
    ),
    Q(
        "sudden_loss",
        "sudden loss of force",
        "Largest fall of the force within a tenth of a millimetre, over its peak; above 0.1"
        " the answer can depend on chance.",
        "masonry.numbers.curves.suddenLoss",
        lambda d: d.sudden[0],
        group="one way",
        share=True,
    ),
    Q(
        "sudden_loss_at_mm",
        "displacement at the sudden loss",
        "Displacement at which the sudden loss begins.",
        "masonry.numbers.curves.suddenLoss",
        lambda d: d.sudden[1],
        group="one way",
    ),
    Q(
        "force_drop",
        "force lost at the end",
        "Share of the peak that is lost at the end; of loops along the envelope of the"
        " positive side.",
        _AT_ENDS,
        lambda d: d.dropped()[0],
        share=True,
    ),
    Q(
        "drop_at_mm",
        "displacement at the drop of force",
        "First displacement after the peak with less than 0.95 of it; None if there is none.",
        _AT_ENDS,
        lambda d: d.dropped()[1],
    ),
    Q(
        "force_drop_negative",
        "force lost at the end of the other side",
        "Share of the peak of the negative side that is lost at the end, along its envelope.",
        _AT_ENDS,
        lambda d: d.dropped(-1)[0],
        group="loops",
        share=True,
    ),
    Q(
        "drop_at_negative_mm",
        "displacement at the drop of force of the other side",
        "First displacement after the peak of the negative side with less than 0.95 of it, as"
        " a positive number; None if there is none.",
        _AT_ENDS,
        lambda d: d.dropped(-1)[1],
        group="loops",
    ),
    Q(
        "damped_share",
        "share of damping",
        "Of what the joints and the damping of the run took in all, the share of the damping,"
        " which a real wall does not have.",
        "masonry.numbers.curves.dampedShare",
        lambda d: curves.dampedShare(d.grown),
        group="loops",
        share=True,
    ),
    Q(
        "cycle_count",
        "whole cycles",
        "How many cycles are whole.",
        "cycles",
        lambda d: len(d.cycles),
        group="loops",
    ),
    Q(
        "cycle_work_J",
        "work of all cycles",
        "Sum of their works at the base.",
        "cycles",
        lambda d: d.work(lambda *_: sum((one["work_J"] for one in d.cycles))),
        group="loops",
    ),
    Q(
        "loop_work_J",
        "work of the whole curve",
        "Integral of the base shear over the displacement.",
        f"{_AT_BASE}, {MOVED}",
        lambda d: d.work(loops.work),
        group="loops",
    ),
    Q(
        "largest_amplitude_mm",
        "largest amplitude",
        "Largest amplitude of a cycle.",
        "cycles",
        lambda d: max((one["amplitude_mm"] for one in d.cycles)),
        group="loops",
    ),
    Q(
        "largest_damping",
        "largest equivalent damping",
        "Largest ratio of equivalent viscous damping of a cycle.",
        "masonry.numbers.loops.equivalentDamping",
        lambda d: max(_damping(d)),
        group="loops",
        share=True,
    ),
    Q(
        "smallest_damping",
        "smallest equivalent damping",
        "Smallest ratio of equivalent viscous damping of a cycle.",
        "masonry.numbers.loops.equivalentDamping",
        lambda d: min(_damping(d)),
        group="loops",
        share=True,
    ),
    Q(
        "bound_base_shear_kN",
        "limit analysis of the push",
        "Bound of the force of the first push.",
        "masonry_limit",
        group="bound",
        brief=True,
    ),
    Q(
        "negative_bound_base_shear_kN",
        "limit analysis of the way back",
        "Bound of the force of the first push back.",
        "masonry_limit",
        group="bound",
    ),
    Q(
        "bound_acceleration",
        "limit analysis of the acceleration",
        "Bound of the first lean or tilt, horizontal over vertical.",
        "masonry_limit",
        group="bound",
        ownUnit="g",
        brief=True,
    ),
    *(
        Q(
            key,
            "",
            f"See {where}.",
            where,
            _ofPattern(key),
            group="wall",
        )
        for (key, where) in cracks.MEASURED.items()
    ),
    Q(
        "peak_normal_stress_MPa",
        "largest normal stress",
        "Largest mean normal stress of the joint, positive in tension.",
        "curve.csv: normal_stress_MPa",
        lambda c: max(c("normal_stress_MPa")),
        group="joint",
        brief=True,
    ),
    Q(
        "peak_compressive_stress_MPa",
        "largest compression",
        "Largest mean compression of the joint, as a positive number.",
        "curve.csv: normal_stress_MPa",
        lambda c: -min(c("normal_stress_MPa")),
        group="joint",
        brief=True,
    ),
    Q(
        "peak_shear_stress_MPa",
        "largest shear stress",
        "Largest mean shear stress of the joint, in whichever direction.",
        _OF_SHEAR,
        lambda c: max(shearOf(c)),
        group="joint",
        brief=True,
    ),
    Q(
        "end_normal_stress_MPa",
        "normal stress at the end",
        "Mean normal stress of the joint in the last row.",
        "curve.csv: normal_stress_MPa",
        lambda c: c("normal_stress_MPa")[-1],
        group="joint",
    ),
    Q(
        "end_shear_stress_MPa",
        "shear stress at the end",
        "Mean shear stress of the joint in the last row, in whichever direction.",
        _OF_SHEAR,
        lambda c: shearOf(c)[-1],
        group="joint",
        brief=True,
    ),
    *(
        Q(
            f"dissipated_{mode}_J_per_m2",
            "",
            f"Energy that the joint dissipated in {mode}, over its area.",
            "the joint",
            group="joint",
        )
        for mode in ("tension", "shear", "compression")
    ),
    Q(
        "factor",
        "",
        "Largest load factor under which the structure came to rest, in the last stage that"
        " found one.",
        "answers",
        group="every",
    ),
    Q(
        "energy_balance_error",
        "largest error of the energy balance",
        "Largest error of the balance in all rows, relative to the largest work done until"
        " then. It shows errors of the scheme, as a time step that is too long, and not those"
        " of mesh or law.",
        "curve.csv: balance_error",
        group="every",
        brief=True,
        share=True,
    ),
    Q(
        "energy_made",
        "energy that joints made",
        "Most energy that joints made by opening or closing within a step, relative to the"
        " largest work done until then.",
        "the energy balance",
        group="every",
        share=True,
    ),
    Q(
        "time_step_s",
        "",
        "The time step.",
        "the run",
        group="cost",
    ),
    Q(
        "time_step_limit_s",
        "",
        "The limit of the time step with the present damping.",
        "the run",
        group="cost",
    ),
    Q(
        "added_inertia",
        "added inertia",
        "Share of the inertia of all blocks that was added to those that set the time step, in all"
        " stages but those in real time (--added-inertia).",
        "the run",
        group="cost",
        share=True,
    ),
    Q(
        "steps",
        "time steps",
        "How many were taken.",
        "the run",
        group="cost",
        brief=True,
    ),
    Q(
        "microseconds_per_step",
        "time of a step",
        "Mean on the clock of the machine.",
        "the run",
        group="cost",
        ownUnit="µs",
        brief=True,
    ),
    Q(
        "nanoseconds_per_subcontact_step",
        "time of a step and a point of a joint",
        "Mean on the clock of the machine.",
        "the run",
        group="cost",
        ownUnit="ns",
    ),
    Q(
        "wall_clock_s",
        "time of the run",
        "On the clock of the machine, with set-up and files.",
        "the run",
        group="cost",
        brief=True,
    ),
)
#: Numbers of a cycle: key in ``cycles`` of run.json, name, unit, digits behind the point on the
#: terminal, and whether the report has it.
OF_CYCLES = (
    ("smallest_mm", "smallest displacement", "mm", 3, True),
    ("largest_mm", "largest displacement", "mm", 3, True),
    ("smallest_kN", "smallest force", "kN", 2, True),
    ("largest_kN", "largest force", "kN", 2, True),
    ("work_J", "work W", "J", 2, True),
    ("stiffness_kN_per_mm", "stiffness K", "kN/mm", 2, True),
    ("damping", "equivalent damping ξ", "-", 3, True),
    ("residual_positive_mm", "left after +", "mm", 3, False),
    ("residual_negative_mm", "left after -", "mm", 3, False),
    ("dissipated_J", "joints took", "J", 2, True),
    ("damped_J", "damping took", "J", 2, True),
)
BY_KEY = {one.key: one for one in QUANTITIES}


def _damping(data):
    return [one["damping"] for one in data.cycles if one["damping"] is not None]


def found(data):
    """All numbers that a run has, by their entries in run.json. What needs a missing column of
    curve.csv, or a cycle of a run without one, is left out."""
    entries = {}
    for one in QUANTITIES:
        if one.of and GROUPS[one.group][1](data):
            try:
                entries[one.key] = one.of(data)
            except (LookupError, ValueError):
                continue
    return entries


def ofJoint(column, prefixed, brief=False):
    """Numbers of a joint whose means are recorded, by their entries in run.json.

    :param column: gives the values of a column of curve.csv by its name
    :param prefixed: gives a name with that of the joint before it
    :param brief: whether only those are wanted that the terminal shows
    """
    own = lambda head: column(prefixed(head))
    ones = [q for q in QUANTITIES if q.group == "joint" and q.brief >= brief]
    return {prefixed(one.key): one.of(own) for one in ones if one.of}


def known(data):
    """All numbers of a run: those of run.json, and those that can be found beside them."""
    return {**found(data), **{k: v for k, v in data.run.items() if k in BY_KEY}}


def shown(entries, *groups, brief=False):
    """Numbers of some groups, or of all, that have a name and a value, as they are shown.

    :param entries: of :func:`known`, or of run.json
    :param brief: whether only those are wanted that a notebook shows
    """
    fine = lambda v: isNumber(v) and math.isfinite(v)
    named = (q for q in QUANTITIES if q.name and q.brief >= brief)
    wanted = (q for q in named if not groups or q.group in groups)
    return [q.shown(entries[q.key]) for q in wanted if fine(entries.get(q.key))]


def measures(run):
    """Entries of run.json for a row of study.csv: how the run ended, and the numbers that measure
    the structure, those first that a notebook shows."""
    names = ["failure_mode", "collapsed", "ended"]
    for one in sorted(QUANTITIES, key=lambda one: not one.brief):
        if one.group == "joint":
            joints = run.get("recorded_joints") or []
            names += [f"{joint}_{one.key}" if joint else one.key for joint in joints]
        elif one.group != "cost":
            names.append(one.key)
    return {name: run[name] for name in names if name in run}


def headline(run, end=False, grows=False):
    """Peak and bound of a push in a line, from the entries of run.json; empty without a push.

    :param end: whether the force at the end is in it, not the bound
    :param grows: whether it has no peak, because it still grows there
    """
    at = lambda force, moved: f"{run[force]:.4g} kN at {run[moved]:.4g} mm"
    keys = ("peak_at_both_ends_kN", "displacement_at_peak_mm")
    if run.get(keys[0]) is None or run.get(keys[1]) is None:
        return ""
    text = f"{'no peak: the force grows to' if grows else 'peak'} {at(*keys)}"
    if run.get("negative_peak_at_both_ends_kN") is not None:
        other = at("negative_peak_at_both_ends_kN", "displacement_at_negative_peak_mm")
        text = f"{len(run['cycles'])} cycles, peaks {at(*keys)} and {other}"
    if end:
        text += f", {at('base_shear_end_kN', 'displacement_end_mm')}"
    elif run.get("bound_base_shear_kN") is not None:
        bounds = [b for b in run.get("bounds") or [] if isinstance(b, dict)]
        most = "" if bounds and all(b.get("exact") for b in bounds) else "at most "
        text += f"; limit analysis: {most}{run['bound_base_shear_kN']:.4g} kN"
    return text


def described():
    """The numbers in run.json as reStructuredText: a list for every group."""
    text = ""
    for group, (title, _) in GROUPS.items():
        lines = (
            f"- ``{q.key}``: {q.meaning} Source: {q.source} [{q.unit}]"
            for q in QUANTITIES
            if q.group == group
        )
        text += "\n".join(["", f"{title}:", "", *lines, ""])
    return text


def loadsOf(stages):
    """Names of loads by the number of their stage, from the entries ``stages`` of run.json."""
    return {n: one["load"][1] for n, one in enumerate(stages, 1) if one.get("load")}
