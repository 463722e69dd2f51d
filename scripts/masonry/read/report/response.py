# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of a report on what the structure did: its curve, drifts, bound, energies, cycles and forces at the base. This module
needs no YADE."""

from __future__ import annotations

import re
from typing import Any, Iterator

import numpy as np

from .. import bilinear, loops
from ..curve_figure import energies, limits, unitOf
from ..measure import TABLE
from .charts import Chart, Line, svg

from .pieces import Number, figure, folded, isNumber, joined, note, numbers, share, table, tag, withUnit, written  # fmt: skip
from .record import Record
from .structure import answersOf, nameOf, sought, valueOf

MOST_ANSWERS = 12  # in the table of what stages found; all are in a folded one
NOISE = 1e-6  # of the largest force of a column: what is below is round-off
NO_PUSH = "The run has no push"


def curve(record: Record) -> Iterator[Any]:
    """The curve of the run with its marks and bounds."""
    spec = record.spec
    if spec is None or not len(record.rows):
        why = "; ".join(p for p in record.problems if "curve" in p)
        yield note(f"There is no curve: {why or 'the run has no rows'}.", kind="missing")  # fmt: skip
        return
    x = record.column(spec["x"]["column"])
    data = {name: values[record.rows] for name, values in record.columns.items()}
    lines = []
    drawn = [a for a in spec["y"] if np.isfinite(data[a["column"]]).any()]
    for n, axis in enumerate(drawn):
        kind = ("thin" if spec["looped"] else "line") + str(min(n, 7))
        lines.append(Line(x, data[axis["column"]], str(axis["label"]), kind))
    if spec["looped"]:
        first = lines[0].y
        for rows, label in zip(loops.envelope(x), ("envelope", "")):
            lines.append(Line(x[rows], first[rows], label, "envelope"))
        low = high = None
    else:
        low, high = limits({**spec, "y": drawn}, {n: v[np.isfinite(v)] for n, v in data.items()})  # fmt: skip
    ideal = record.ideals["masonry"]
    if not isinstance(ideal, str):
        dy, du, force = ideal.yieldDisplacement, ideal.ultimateDisplacement, ideal.yieldForce  # fmt: skip
        lines.append(Line([0, dy, du], [0, force, force], "bilinear", "ideal"))
    marks = [
        (m["x"], m["y"], str(m["text"]), bool(m.get("below")) or m["y"] < 0)
        for m in spec["marks"]
        if isNumber(m.get("x")) and isNumber(m.get("y"))
    ]
    levels = [(b["y"], str(b["text"])) for b in spec["bounds"] if isNumber(b.get("y"))]
    chart = Chart(
        title="Curve of the run",
        about=_aboutCurve(spec, x, lines),
        xLabel=str(spec["x"]["label"]),
        yLabel=str(spec["y_label"]),
        lines=lines,
        marks=marks,
        levels=levels,
        low=low,
        high=high,
        frames=_places(record, x, lines[0].y),
        zero=bool(spec["looped"]),
    )
    sources = ", ".join([spec["x"]["column"], *(axis["column"] for axis in spec["y"])])
    text = f"{chart.about} Source: curve.csv: {sources}."
    if record.picture and chart.frames:
        text += " The ring is the frame that the turning picture shows; a click on the curve shows the nearest one there."
    yield figure(svg(chart), text)
    yield from _ideal(record)
    picture = record.image("capacity.png")
    if picture:
        yield figure(tag("img", src=picture, alt="The capacity curve and the demand of a spectrum."), "Capacity and demand, as masonry.capacity drew them. Source: capacity.png.", "image")  # fmt: skip
    pushes = record.pushes
    if len(pushes) > 1:
        numbered = ", ".join(map(str, pushes))
        yield note(f"The run has {len(pushes)} pushes, the stages {numbered}. The curve and the numbers of the push are those of the last one, and of those before it along the same line.")  # fmt: skip


#: Numbers of a bilinear curve, by their names in :mod:`masonry.read.bilinear`.
OF_IDEAL = {
    "bilinear_stiffness_kN_per_mm": "stiffness K", "yield_force_kN": "yield force Vy", "yield_displacement_mm": "yield displacement dy",
    "ultimate_displacement_mm": "ultimate displacement du", "displacement_ductility": "ductility µ = du/dy",
    "peak_force_kN": "peak of this curve", "peak_displacement_mm": "displacement at this peak",
}  # fmt: skip


def _ideal(record):
    """The bilinear idealisation of a push, by every rule."""
    if not record.isPush:
        yield note("The run has no push, so there is no bilinear curve.", kind="missing")  # fmt: skip
        return
    ideals = record.ideals
    if all(isinstance(one, str) for one in ideals.values()):
        yield note(f"There is no bilinear curve: {ideals['masonry']}.", kind="missing")
        return
    known = {
        rule: {n.name: n for n in one.numbers()}
        for rule, one in ideals.items()
        if not isinstance(one, str)
    }
    lines = []
    for name, what in OF_IDEAL.items():
        values = [_idealOf(known.get(rule, {}).get(name)) for rule in ideals]
        meanings = dict.fromkeys(known[rule][name].meaning for rule in known)
        lines.append((what, *values, " Or: ".join(meanings)))
    heads = ("quantity", *(bilinear.RULES[rule] for rule in ideals), "what it is")
    caption = "Bilinear idealisation of the force that both ends carry at once. Source: curve.csv: displacement_mm, base_shear_kN, top_shear_kN"
    yield table(heads, lines, caption, "ideal")
    said = dict.fromkeys(n for one in ideals.values() if not isinstance(one, str) for n in one.notes)  # fmt: skip
    said.update((f"{bilinear.RULES[rule]}: none, because {one}", None) for rule, one in ideals.items() if isinstance(one, str))  # fmt: skip
    for text in said:
        yield note(text[:1].upper() + text[1:], ".")


def _idealOf(number):
    """A number of a bilinear curve; one that ends before the force has fallen is marked."""
    if number is None:
        return "none"
    mark = tag("span", "not reached", class_="badge") if number.note else None
    return joined(withUnit(number.value, number.unit), mark)


def _aboutCurve(spec, x, lines):
    """What the curve shows, in a sentence for those who do not see it."""
    y = lines[0].y
    unit = unitOf({"label": str(spec["y_label"]), "column": spec["y"][0]["column"]})
    label = str(spec["y_label"])
    return (
        f"{label[:1].upper() + label[1:]}, {lines[0].label}, over {spec['x']['label']}: {len(x):,} rows, from {withUnit(float(y.min()), unit)} to "
        f"{withUnit(float(y.max()), unit)}."
    )


def _places(record, x, y):
    """Where the frames of the 3-D picture are on the curve."""
    times = record.column("time_s")
    if times is None or not record.picture:
        return []
    rows = [int(np.nanargmin(np.abs(times - t))) for t in record.frameTimes]
    return [(float(x[n]), float(y[n])) for n in rows]


# -- what the run found -----------------------------------------------------------------------------------------------

#: Numbers of a push: key of run.json, name, unit and definition.
OF_PUSH = (
    ("peak_base_shear_kN", "peak", "kN", "Largest force along the push at all that is held."),
    ("displacement_at_peak_mm", "displacement at the peak", "mm", "Displacement of the recorded point along the push where the supports carried most."),
    ("peak_at_both_ends_kN", "peak at both ends", "kN", "Largest force that the loaded point and the supports carried at once, without waves that pass through."),
    ("negative_peak_base_shear_kN", "peak of the other side", "kN", "Smallest force along the push at all that is held."),
    ("displacement_at_negative_peak_mm", "displacement at the peak of the other side", "mm", "Displacement of the recorded point there."),
    ("base_shear_end_kN", "force at the end", "kN", "Force at the supports in the last row."),
    ("displacement_end_mm", "displacement at the end", "mm", "Displacement in the last row."),
    ("initial_stiffness_kN_per_mm", "initial stiffness", "kN/mm", "Slope of the line through the beginning of the push that fits its first part best, without the inertia of the structure."),
    ("push_work_J", "work of the push", "J", "Area under the curve of the push."),
    ("first_period_s", "first period along the push", "s", "First period of the structure along the push, measured as the push began."),
    ("largest_crack_mm", "widest crack at the end", "mm", "Largest opening of a point of any joint at the end; slide does not count."),
)  # fmt: skip


def found(record: Record) -> Iterator[Any]:
    """Drifts and other numbers of a push, drifts that were recorded, and what the stages were run for."""
    run = record.run
    if record.isPush:
        yield from _states(record)
        rows = [
            Number(what, run[key], unit, meaning, f"run.json: {key}")
            for key, what, unit, meaning in OF_PUSH
            if run.get(key) is not None
        ]
        yield numbers(rows, "Numbers of the push")
    else:
        yield note(f"{NO_PUSH}, so there are no drifts at a peak or at a first crack.", kind="missing")  # fmt: skip
    yield from _drifts(record)
    yield from _answers(run)


def _states(record):
    """First crack, peak, loss of force and collapse: displacement, drift and force."""
    run = record.run
    height, whence = _height(run)
    moved, force = record.column("displacement_mm"), record.column("base_shear_kN")
    fallen, why = _fallen(record)
    firsts, last = run.get("displacement_at_first_crack_mm"), run.get("collapse_displacement_mm")  # fmt: skip
    states = (
        ("first crack", firsts, "First row at which the joints have dissipated in tension and shear more than 1e-5 of the elastic energy.", "run.json: displacement_at_first_crack_mm", "no crack was seen"),
        ("peak", run.get("displacement_at_peak_mm"), "The largest force at the supports.", "run.json: displacement_at_peak_mm", ""),
        ("0.8 of the peak", fallen, "Where the force that both ends carry at once has fallen to 0.8 of its peak, after it; of cycles on the envelope of the supports' force.", "curve.csv: displacement_mm, base_shear_kN, top_shear_kN", why),
        ("collapse", last, "The last row of a push that ended in a collapse.", "run.json: collapse_displacement_mm", "the push did not end in a collapse"),
    )  # fmt: skip
    lines = []
    for what, at, meaning, source, missing in states:
        if not isNumber(at):
            lines.append((what, "none", "none", "none", f"{meaning} Here: {missing or 'not known'}.", source))  # fmt: skip
            continue
        drift = withUnit(at / height, "mrad") if height else written(None)
        carried = _forceAt(moved, force, at, record.isLooped)
        lines.append((what, withUnit(at, "mm"), drift, withUnit(carried, "kN"), meaning, source))  # fmt: skip
    heads = ("state", "displacement", "drift", "force at the supports", "what it is", "source")  # fmt: skip
    yield table(heads, lines, "Drifts of the push", "states")
    if height:
        yield note(f"The drift is the displacement over the height of the recorded point above the lowest brick, {written(height)} m ({whence}); 1 mrad is 0.1 %.")  # fmt: skip
    else:
        yield note("The height of the recorded point is not known, or the push is not horizontal, so there are no drifts.", kind="missing")  # fmt: skip


def _height(run):
    """Height of the recorded point above the lowest brick [m] and where it is from; None if it is not known."""
    high = run.get("recorded_height_m")
    if isNumber(high) and high > 0:
        return high, "run.json: recorded_height_m"
    moved, drift = run.get("displacement_at_first_crack_mm"), run.get("drift_at_first_crack_mrad")  # fmt: skip
    if isNumber(moved) and isNumber(drift) and drift:
        return moved / drift, "run.json: displacement_at_first_crack_mm over drift_at_first_crack_mrad"  # fmt: skip
    return None, ""


def _forceAt(moved, force, at, looped):
    """Force where the displacement is first reached; None if that is not clear."""
    if moved is None or force is None or not len(moved):
        return None
    near = np.flatnonzero(np.abs(moved - at) <= 1e-6 + 1e-6 * abs(at))
    if len(near):
        return float(force[near[0]])
    if looped or at > np.nanmax(moved):
        return None
    after = int(np.argmax(moved >= at))
    if after == 0:
        return float(force[0])
    return float(np.interp(at, moved[after - 1 : after + 1], force[after - 1 : after + 1]))  # fmt: skip


def _fallen(record):
    """Displacement at which the force has fallen to 0.8 of its peak [mm], or None and why. Of cycles it is that of the envelope of
    the positive side."""
    moved, force = record.column("displacement_mm"), record.column("base_shear_kN")
    if moved is None or force is None or not len(force):
        return None, "curve.csv does not have the columns"
    if not record.isLooped:
        ideal = record.ideals["masonry"]
        if isinstance(ideal, str):
            return None, ideal
        if not ideal.reached:
            return None, ideal.notes[0].removeprefix("not reached: ").partition(", so ")[0]  # fmt: skip
        return ideal.ultimateDisplacement, ""
    rows = loops.envelope(moved)[0]
    moved, force = moved[rows], force[rows]
    if not len(force) or np.nanmax(force) <= 0:
        return None, "the force is never positive"
    at = int(np.nanargmax(force))
    below = np.flatnonzero(force[at:] <= 0.8 * force[at])
    if not len(below):
        return (
            None,
            f"the force stays above 0.8 of its peak up to {written(float(np.nanmax(moved)))} mm",
        )
    return float(moved[at + below[0]]), ""


def _drifts(record):
    """Columns of drifts that the script recorded: their extremes."""
    meanings = record.run.get("columns") or {}
    rows = []
    for name, values in record.columns.items():
        if not name.endswith("_mrad") or "over the height between them" not in str(meanings.get(name)):  # fmt: skip
            continue
        values = values[np.isfinite(values)]
        if len(values):
            at = int(np.abs(values).argmax())
            rows.append(Number(f"largest {name.removesuffix('_mrad')}", float(values[at]), "mrad", f"Of all rows the one with the largest size: {_bare(meanings[name])}.", f"curve.csv: {name}"))  # fmt: skip
    if rows:
        yield numbers(rows, "Drifts that were recorded")


def _bare(meaning):
    """The meaning of a column without its unit."""
    return re.sub(r" *\[[^\[\]]+\]$", "", str(meaning))


def _answers(run):
    answers = answersOf(run)
    if not answers:
        yield note("No stage was run for a number. Source: run.json: answers.")
        return
    line = lambda a, what: (f"{a.get('number')}, {a.get('stage')}: {what}", valueOf(a), str(a.get("how", "")))  # fmt: skip
    heads = ("stage and number", "value", "how it was found")
    caption = "What the stages were run for. Source: run.json: answers"
    every = [line(a, nameOf(a)) for a in answers]
    if len(every) <= MOST_ANSWERS:
        yield table(heads, every, caption, "answers")
        return
    found = [line(a, what) for a, what in sought(run)]
    if found:
        yield table(heads, found, caption, "answers")
    yield folded(f"All {len(every)} numbers of the stages", table(heads, every, caption, "answers"))  # fmt: skip


# -- the bound --------------------------------------------------------------------------------------------------------


WHAT_JOINTS_DO = {"opens": "open", "slides": "slide", "crushes": "crush"}


def bound(record: Record) -> Iterator[Any]:
    """The bound by limit analysis."""
    entries = [b for b in record.run.get("bounds") or [] if isinstance(b, dict)]
    if not entries:
        yield note("There is no bound: limit analysis is made where a structure is pushed, leans or tilts, of up to 3,000 joints, and not with --lean. Source: run.json: bounds.", kind="missing")  # fmt: skip
        return
    lines = []
    for one in entries:
        if not isNumber(one.get("factor")):
            lines.append((one.get("load", "?"), "none", "", one.get("note", "not known")))  # fmt: skip
            continue
        unit = one.get("unit") or "-"
        joints = ", ".join(f"{count} {WHAT_JOINTS_DO.get(what, what)}" for what, count in (one.get("joints") or {}).items() if count)  # fmt: skip
        kind = "what rigid blocks carry exactly" if one.get("exact") else "an upper bound: joints that slide are taken to open as friction tells, and no joint loses strength"  # fmt: skip
        further = [
            f"{what}: {withUnit(one[key], unit)}"
            for key, what in (("open_joints_slip", "with open head joints that slip"), ("without_dilatancy", "a collapse in which joints slip without opening"))
            if isNumber(one.get(key))
        ]  # fmt: skip
        lines.append((one.get("load", "?"), withUnit(one["factor"], unit), joints or "–", "; ".join([kind, *further])))  # fmt: skip
    heads = ("load", "factor", "joints of the mechanism", "what it is")
    yield table(heads, lines, "Limit analysis of the same blocks, rigid and with small displacements. Source: run.json: bounds")  # fmt: skip
    pairs = (
        ("peak_base_shear_kN", "bound_base_shear_kN", "peak over bound"),
        ("negative_peak_base_shear_kN", "negative_bound_base_shear_kN", "peak of the other side over its bound"),
    )  # fmt: skip
    run, rows = record.run, []
    for peak, limit, what in pairs:
        if isNumber(run.get(peak)) and isNumber(run.get(limit)) and run[limit]:
            rows.append(Number(what, abs(run[peak] / run[limit]), "-", "Of an upper bound it cannot be much above 1; a run warns where it is.", f"run.json: {peak}, {limit}"))  # fmt: skip
    if rows:
        yield numbers(rows, "The run beside its bound")
    picture = record.image("mechanism.png")
    if picture:
        yield figure(tag("img", src=picture, alt="The mechanism with which the structure gives way in limit analysis."), "How the structure gives way in limit analysis. Source: mechanism.png.", "image")  # fmt: skip


# -- energies ---------------------------------------------------------------------------------------------------------


#: Energies in the legend of the chart, by their names in :func:`masonry.read.curve_figure.energies`.
ENERGIES = {"tension": "dissipated in tension", "shear": "dissipated in shear", "compression": "dissipated in compression", "damping": "taken by damping", "impacts": "taken by impacts", "kinetic": "motion", "friction contacts": "friction of contacts", "damping contacts": "damping of contacts"}  # fmt: skip


def energy(record: Record) -> Iterator[Any]:
    """Where the work went: a table, a bar and a chart."""
    # a figure may show its rows in another order
    rows = np.arange(record.rows.min(), record.rows.max() + 1) if len(record.rows) else record.rows  # fmt: skip
    columns = {n: v[rows] for n, v in record.columns.items() if n.endswith("_J")}
    if not columns or not len(record.rows):
        yield note("There is no energy balance: curve.csv has no rows with energies.", kind="missing")  # fmt: skip
        return
    finite = np.isfinite(list(columns.values())).all(axis=0)
    columns = {n: v[finite] for n, v in columns.items()}
    if finite.sum() < 2:
        yield note("There is no energy balance: less than two rows have all energies.", kind="missing")  # fmt: skip
        return
    stack, work = energies(columns)
    change = lambda name: float(columns[name][-1] - columns[name][0])
    meanings = record.run.get("columns") or {}
    rare = (
        "refining_J",
        "handing_J",
    )  # of joints that get more points, and of those whose place contacts take
    columns = {n: v for n, v in columns.items() if n not in rare or v.any()}
    inputs = [n for n in ("external_J", "gravity_J", *rare) if n in columns]
    elastic = [n for n in columns if n.startswith("elastic_")]
    spent = [n for n in columns if n.startswith("dissipated_") or n in ("friction_contacts_J", "damping_contacts_J", "damping_J", "impacts_J", "kinetic_J")]  # fmt: skip
    total = sum(map(change, inputs))
    part = lambda value: share(value / total) if total > 0 else written(None)
    lines = [
        (_energyOf(meanings, n), withUnit(change(n), "J"), part(change(n)), f"curve.csv: {n}")
        for n in inputs
    ]  # fmt: skip
    lines.append((tag("strong", "all that was put in"), withUnit(total, "J"), part(total), "sum of these"))  # fmt: skip
    stored = sum(map(change, elastic))
    lines.append(("elastic energy of all parts", withUnit(stored, "J"), part(stored), f"curve.csv: {', '.join(elastic)}"))  # fmt: skip
    lines += [
        (_energyOf(meanings, n), withUnit(change(n), "J"), part(change(n)), f"curve.csv: {n}")
        for n in spent
    ]  # fmt: skip
    rest = total - stored - sum(map(change, spent))
    lines.append(("what is missing in the balance", withUnit(rest, "J", 2), part(rest), "difference"))  # fmt: skip
    since = "from the first to the last row that the curve shows"
    yield table(("energy", "change", "share of what was put in", "source"), lines, f"Where the work went, {since}", "energy")  # fmt: skip
    if record.spec and (np.diff(record.rows) > 0).all():
        x, label = record.columns[record.spec["x"]["column"]][rows], str(record.spec["x"]["label"])  # fmt: skip
    else:
        x, label = rows, "number of the row"
    x = x[finite]
    if record.isLooped:
        x = np.append(0, np.cumsum(np.abs(np.diff(x))))
        label = "length of the path there and back [mm]"
    seen = [(name, values) for name, values in stack.items() if values.any()]
    drawn = [
        Line(x, values, ENERGIES.get(name, name), f"line{min(n + 1, 7)}")
        for n, (name, values) in enumerate(seen)
    ]
    if work is not None:
        drawn.insert(0, Line(x, work, "work done", "ideal"))
    about = f"Energies since the first row that the curve shows, up to {withUnit(max(float(line.y.max()) for line in drawn), 'J')}."  # fmt: skip
    yield figure(svg(Chart("Energies", about, label, "energy [J]", drawn)), f"{about} Work done is that of loads and gravity. Source: curve.csv.")  # fmt: skip


def _energyOf(meanings, name):
    """What an energy is."""
    return _bare(meanings.get(name, name)).removesuffix(" since the scene was built")


# -- cycles -----------------------------------------------------------------------------------------------------------


ABOUT_CYCLES = (
    "W is the integral of the base shear over the displacement, K the secant stiffness from peak to peak, A half of the "
    "displacement from peak to peak, and ξ = W/(4π·½·K·A²), the ratio of the viscous damping that takes as much work in a cycle "
    "(Jacobsen, 1930). W is a small difference of large numbers, and inertia and damping of the run are in it: beside it stands "
    "what the joints and the damping of the run took. A negative ξ means that the cycle has no W that can be told from these."
)


def cycles(record: Record) -> Iterator[Any]:
    """Equivalent damping of cycles."""
    entries = record.run.get("cycles")
    if not entries:
        yield note("The run has no whole cycles, so there is no equivalent damping.", kind="missing")  # fmt: skip
        return
    keys = (
        ("largest_mm", "largest displacement [mm]"), ("smallest_mm", "smallest displacement [mm]"),
        ("largest_kN", "largest force [kN]"), ("smallest_kN", "smallest force [kN]"), ("work_J", "work W [J]"),
        ("stiffness_kN_per_mm", "stiffness K [kN/mm]"), ("damping", "equivalent damping ξ [%]"),
        ("dissipated_J", "joints took [J]"), ("damped_J", "damping took [J]"),
    )  # fmt: skip
    known = {key for _, key, _ in TABLE}
    assert all(key in known for key, _ in keys)
    lines = []
    for n, one in enumerate(entries, start=1):
        cells = [100 * one[key] if key == "damping" and isNumber(one.get(key)) else one.get(key) for key, _ in keys]  # fmt: skip
        lines.append((n, *(written(v) for v in cells)))
    yield table(("cycle", *(text for _, text in keys)), lines, "Cycles. Source: run.json: cycles", "cycles")  # fmt: skip
    yield note(ABOUT_CYCLES)
    damped = record.run.get("damped_share")
    if isNumber(damped):
        yield numbers([Number("share of damping", 100 * damped, "%", "Of what joints and the damping of the run took in all, the share of the damping, which a real wall does not have.", "run.json: damped_share")], "Damping of the run")  # fmt: skip


# -- forces at the base -----------------------------------------------------------------------------------------------


def base(record: Record) -> Iterator[Any]:
    """Normal force, shear force and moment: of the sections that were recorded, else forces on what is held."""
    meanings = record.run.get("columns") or {}
    names = [
        n
        for n in record.columns
        if re.search(r"_(N|V_[xy])_kN$|_M_[xy]_kNm$", n)
        and " on the section at " in str(meanings.get(n))
    ]
    if names:
        yield _forces(record, names, "Forces of the sections that were recorded")
        return
    reactions = [
        n
        for n in record.columns
        if re.search(r"_force_[xyz]_kN$", n)
        and str(meanings.get(n)).startswith("force of the structure on")
        and any(n.startswith(f"{held}_force") for held in record.run.get("held") or [])
    ]
    yield note("The moment at the base is not known: no section was recorded. scene.section(z) in the script records the normal force, the shear force and the moment of a horizontal section.", kind="missing")  # fmt: skip
    if not reactions and "base_shear_kN" in record.columns and record.isPush:
        reactions = ["base_shear_kN"]
    if reactions:
        yield _forces(record, reactions, "Forces of the structure on what is held")


def _forces(record, names, caption):
    meanings = record.run.get("columns") or {}
    places = {"first row": 0, "last row": -1}
    if record.isPush and record.column("base_shear_kN") is not None and len(record.rows):  # fmt: skip
        places = {"first row": 0, "at the peak": int(np.nanargmax(record.column("base_shear_kN"))), "last row": -1}  # fmt: skip
    lines = []
    for name in names:
        values = record.column(name)
        unit = name.rpartition("_")[2]
        finite = values[np.isfinite(values)]
        ends = [finite.min(), finite.max()] if len(finite) else [np.nan] * 2
        most = max(map(abs, ends))
        texts = [
            "≈ 0" if abs(v) < NOISE * most else withUnit(float(v), unit)
            for v in [*(values[n] for n in places.values()), *ends]
        ]
        lines.append((name.removesuffix("_" + unit), *texts, _bare(meanings.get(name)), f"curve.csv: {name}"))  # fmt: skip
    heads = ("force", *places, "smallest", "largest", "what it is", "source")
    return table(heads, lines, caption, "forces")
