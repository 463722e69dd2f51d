# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of a report on what the structure did: its curve, drifts, bound, energies, cycles and
forces at the base."""

import csv
import os

import numpy as np

from masonry.errors import Refused
from masonry_capacity import bilinear_curve
from .. import curve_figure
from masonry.numbers import drawing, quantities
from masonry.numbers.files import readText
from masonry.numbers.run_data import DRIFT
from ..curve_figure import bare, energies, unitOf

from .pieces import (
    Badged,
    figure,
    folded,
    isNumber,
    missing,
    note,
    numbers,
    table,
    withUnit,
    written,
)
from .structure import firstUpper, nameOf, sought, valueOf

MAX_ANSWERS = 12  # in the table of what stages found; all are in a folded one
NOISE = 1e-6  # of the largest force of a column: what is below is round-off


def curve(record):
    spec = record.spec
    if spec is None or not len(record.rows):
        why = "; ".join(p for p in record.problems if "curve" in p)
        raise Refused(f"There is no curve: {why or 'the run has no rows'}.")
    data = {name: values[record.rows] for name, values in record.columns.items()}
    x, y = data[spec["x"]["column"]], data[spec["y"][0]["column"]]
    ideal, line = record.ideals["masonry"], None
    if not isinstance(ideal, str):
        dy, du, force = ideal.yieldDisplacement, ideal.ultimateDisplacement, ideal.yieldForce
        percent = 0.1 / record.run["drift_height_m"] if spec["x"]["column"] == DRIFT else 1.0
        line = [0, percent * dy, percent * du], [0, force, force]
    with drawing.style():
        drawn = curve_figure.panelOf(spec, data, line)
        frames = drawing.placesOn(drawn, _places(record, data, x, y))
        svg = drawing.svg(drawn, "curve")
    about = _aboutCurve(spec, y)
    sources = ", ".join([spec["x"]["column"], *(axis["column"] for axis in spec["y"])])
    text = f"{about} Source: curve.csv: {sources}."
    if record.picture and frames:
        text += (
            " The ring is the frame that the turning picture shows; a click on the curve shows the"
            " nearest one there."
        )
    yield figure(svg, text, about, frames)
    yield from _ideal(record)
    yield figure(
        "capacity.png",
        (
            "Capacity curve and demand of a spectrum, as masonry_capacity drew them. Source:"
            " capacity.png."
        ),
    )
    loads = [stage.get("load") or [""] for stage in record.run["stages"]]
    pushes = [number for number, load in enumerate(loads, 1) if load[0] == "push"]
    if len(pushes) > 1:
        numbered = ", ".join(map(str, pushes))
        yield note(
            f"The run has {len(pushes)} pushes, the stages {numbered}. The curve and the numbers of"
            " the push are those of the last one, and of those before it with whose curve it goes"
            " on (continued)."
        )


#: Numbers of a bilinear curve, by their names in :mod:`masonry_capacity.bilinear_curve`.
OF_IDEAL = {
    "bilinear_stiffness_kN_per_mm": "stiffness K",
    "yield_force_kN": "yield force Vy",
    "yield_displacement_mm": "yield displacement dy",
    "ultimate_displacement_mm": "ultimate displacement du",
    "displacement_ductility": "ductility µ = du/dy",
    "peak_force_kN": "peak of this curve",
    "peak_displacement_mm": "displacement at this peak",
}


def _ideal(record):
    if not record.isPush:
        yield missing("The run has no push, so there is no bilinear curve.")
        return
    ideals = record.ideals
    if all(isinstance(one, str) for one in ideals.values()):
        yield missing(f"There is no bilinear curve: {ideals['masonry']}.")
        return
    good = {rule: one for rule, one in ideals.items() if not isinstance(one, str)}
    known = {rule: {n.name: n for n in one.numbers()} for rule, one in good.items()}
    lines = []
    for name, what in OF_IDEAL.items():
        values, meanings = dict.fromkeys(ideals, "none"), {}
        for rule, numbersOfRule in known.items():
            one = numbersOfRule[name]
            value = withUnit(one.value, one.unit)
            # its curve ends before the force has fallen
            values[rule] = Badged(value, "not reached") if one.note else value
            meanings[one.meaning] = None
        lines.append((what, *values.values(), " Or: ".join(meanings)))
    heads = ("quantity", *(bilinear_curve.RULES[rule] for rule in ideals), "what it is")
    caption = (
        "Bilinear idealisation of the force that both ends carry at once. Source: curve.csv:"
        " displacement_mm, base_shear_kN, top_shear_kN"
    )
    yield table(heads, lines, caption, "ideal")
    every = (n for one in good.values() for n in one.notes)
    notes = [n for n in every if not n.startswith(bilinear_curve.WARNED)]  # they are at the head
    failed = {rule: why for rule, why in ideals.items() if rule not in good}
    notes += [f"{bilinear_curve.RULES[rule]}: none, because {why}" for rule, why in failed.items()]
    for text in dict.fromkeys(notes):
        yield note(f"{firstUpper(text)}.")


def _aboutCurve(spec, y):
    label, first = spec["y_label"], spec["y"][0]
    unit = unitOf({"label": label, "column": first["column"]})
    return (
        f"{firstUpper(label)}, {first['label']}, over {spec['x']['label']}: {len(y):,} rows,"
        f" from {withUnit(float(y.min()), unit)} to {withUnit(float(y.max()), unit)}."
    )


def _places(record, data, x, y):
    if "time_s" not in data or not record.picture:
        return []
    rows = [int(np.nanargmin(np.abs(data["time_s"] - t))) for t in record.frameTimes]
    return [(float(x[n]), float(y[n])) for n in rows]


def found(record):
    """Drifts and other numbers of a push, drifts that were recorded, and what the stages were run
    for."""
    if record.isPush:
        yield from _states(record)
        shown = quantities.shown(record.numbers, "push", "loops", "one way")
        yield numbers(shown, "Numbers of the push")
    else:
        yield missing("The run has no push, so there are no drifts at a peak or at a first crack.")
    yield from _drifts(record)
    yield from _piers(record)
    yield from _answers(record.run)


def _states(record):
    """First crack, peak, loss of force and collapse: displacement, drift and force."""
    data, entries, lines = record.data, record.numbers, []
    for state in quantities.STATES:
        moved, meaning = entries.get(state.displacement), state.meaning
        if isNumber(moved):
            drift = withUnit(entries.get(state.drift), "mrad")
            carried = data.at(data.carried(), data.place(state.find))
            found = withUnit(moved, "mm"), drift, withUnit(carried, "kN")
        else:
            found = ["none"] * 3
            meaning += f" Here: {state.missing}."
        lines.append((state.name, *found, meaning, f"run.json: {state.displacement}"))
    heads = ("state", "displacement", "drift", "force at both ends", "what it is", "source")
    yield table(heads, lines, "Drifts of the push", "states")
    if data.height:
        yield note(
            "The drift is the displacement of the masonry, without what a platen slips on it, over"
            f" its height above the lowest brick, {written(data.height)} m; 1 mrad is 0.1 %. The"
            " displacement is that of the pushed point."
        )
    else:
        yield missing(
            "The height of the recorded point is not known, or the push is not horizontal, so there"
            " are no drifts."
        )


def _drifts(record):
    rows = []
    for name in record.run["recorded_drifts"]:
        values = record.columns.get(name, np.zeros(0))
        values = values[np.isfinite(values)]
        if len(values):
            largest, what = float(max(values, key=abs)), bare(record.run["columns"][name])
            meaning = f"Of all rows the one with the largest size: {what}."
            head, source = f"largest {name.removesuffix('_mrad')}", f"curve.csv: {name}"
            rows.append(quantities.Number(head, largest, "mrad", meaning, source))
    if rows:
        yield numbers(rows, "Drifts that were recorded")


def _piers(record):
    """Checks of piers by codes, if masonry_capacity.piers has written them."""
    path = os.path.join(record.directory, "piers.csv")
    if os.path.exists(path):
        heads, *lines = csv.reader(readText(path).splitlines())
        caption = "Piers and spandrels by codes, beside what the run found. Source: piers.csv"
        yield table([head.replace("_", " ") for head in heads], lines, caption)


def _answers(run):
    if not run.get("answers"):
        yield note("No stage was run for a number. Source: run.json: answers.")
        return
    line = lambda a, what: (f"{a['number']}, {a['stage']}: {what}", valueOf(a), a["how"])
    heads = ("stage and number", "value", "how it was found")
    caption = "What the stages were run for. Source: run.json: answers"
    every = [line(a, nameOf(a)) for a in run["answers"]]
    whole = table(heads, every, caption, "answers")
    if len(every) <= MAX_ANSWERS:
        yield whole
        return
    found = [line(a, what) for a, what in sought(run)]
    if found:
        yield table(heads, found, caption, "answers")
    yield folded(f"All {len(every)} numbers of the stages", whole)


WHAT_JOINTS_DO = {"opens": "open", "slides": "slide", "crushes": "crush"}
EXACT = "what rigid blocks carry exactly"
UPPER = (
    "an upper bound: joints that slide are taken to open as friction tells, and no joint loses"
    " strength"
)
#: Further factors of a bound, by their entries.
FURTHER = {
    "open_joints_slip": "with open head joints that slip",
    "without_dilatancy": "a collapse in which joints slip without opening",
}


def bound(record):
    if not record.run.get("bounds"):
        raise Refused(
            "There is no bound: limit analysis is made where a structure is pushed, leans or tilts,"
            " of up to 3,000 joints, and not with --lean. Source: run.json: bounds."
        )
    heads = ("load", "factor", "joints of the mechanism", "what it is")
    caption = "Limit analysis of the same blocks, rigid and with small displacements."
    lines = [_boundLine(one) for one in record.run["bounds"]]
    yield table(heads, lines, f"{caption} Source: run.json: bounds")
    run, rows = record.numbers, []
    for side, what in (
        ("", "peak over bound"),
        ("negative_", "peak of the other side over its bound"),
    ):
        peak, limit = f"{side}peak_at_both_ends_kN", f"{side}bound_base_shear_kN"
        if isNumber(run.get(peak)) and isNumber(run.get(limit)) and run[limit]:
            ratio, source = abs(run[peak] / run[limit]), f"run.json: {peak}, {limit}"
            meaning = "Of an upper bound it cannot be much above 1; a run warns where it is."
            rows.append(quantities.Number(what, ratio, "-", meaning, source))
    if rows:
        yield numbers(rows, "The run beside its bound")
    yield figure(
        "mechanism.png", "How the structure gives way in limit analysis. Source: mechanism.png."
    )


def _boundLine(one):
    if not isNumber(one.get("factor")):
        return one["load"], "none", "", one["note"]
    unit = one["unit"] or "-"
    joints = [f"{count} {WHAT_JOINTS_DO[what]}" for what, count in one["joints"].items() if count]
    about = [EXACT if one["exact"] else UPPER]
    about += [f"{w}: {withUnit(one[k], unit)}" for k, w in FURTHER.items() if isNumber(one.get(k))]
    return one["load"], withUnit(one["factor"], unit), ", ".join(joints) or "–", "; ".join(about)


def energy(record):
    # a figure may show its rows in another order
    rows = np.arange(record.rows.min(), record.rows.max() + 1) if len(record.rows) else record.rows
    columns = {n: v[rows] for n, v in record.columns.items() if n.endswith("_J")}
    if not columns or not len(record.rows):
        raise Refused("There is no energy balance: curve.csv has no rows with energies.")
    finite = np.isfinite(list(columns.values())).all(axis=0)
    columns = {n: v[finite] for n, v in columns.items()}
    if finite.sum() < 2:
        raise Refused("There is no energy balance: less than two rows have all energies.")
    stack, work = energies(columns)
    change = lambda name: float(columns[name][-1] - columns[name][0])
    known = {**quantities.ENERGIES, **quantities.OF_CONNECTORS, **quantities.OF_CONTACTS}
    rare = ("refining_J", "handing_J")  # where joints get points, or turn into contacts
    columns = {n: v for n, v in columns.items() if n not in rare or v.any()}
    of = lambda role: [f"{n}_J" for n in known if f"{n}_J" in columns and known[n][1] == role]
    inputs, elastic, spent = of("in"), of("stored"), of("spent")
    total = sum(map(change, inputs))
    part = lambda value: withUnit(100 * value / total if total > 0 else None, "%", 2)
    line = lambda what, value, source: (what, withUnit(value, "J"), part(value), source)
    own = lambda n: line(known[n[:-2]][0], change(n), f"curve.csv: {n}")
    stored = sum(map(change, elastic))
    lines = [
        *map(own, inputs),
        line("all that was put in", total, "sum of these"),
        line("elastic energy of all parts", stored, f"curve.csv: {', '.join(elastic)}"),
        *map(own, spent),
    ]
    rest = total - stored - sum(map(change, spent))
    missed = "what is missing in the balance", withUnit(rest, "J", 2), part(rest), "difference"
    heads = ("energy", "change", "share of what was put in", "source")
    caption = "Where the work went, from the first to the last row that the curve shows"
    yield table(heads, [*lines, missed], caption, "energy")
    if record.spec and (np.diff(record.rows) > 0).all():
        x, label = record.columns[record.spec["x"]["column"]][rows], record.spec["x"]["label"]
    else:
        x, label = rows, "number of the row"
    x = x[finite]
    if record.isLooped:
        x = np.append(0, np.cumsum(np.abs(np.diff(x))))
        label = "length of the path there and back [mm]"
    with drawing.style():
        svg = drawing.svg(curve_figure.energiesOf(x, label, stack, work), "energies")
    about = (
        "Energies since the first row that the curve shows. Work done is that of loads and gravity."
    )
    yield figure(svg, f"{about} Source: curve.csv.")


ABOUT_CYCLES = (
    "W is the integral of the base shear over the displacement, K the secant stiffness from peak to"
    " peak, A half of the displacement from peak to peak, and ξ = W/(4π·½·K·A²), the ratio of the"
    " viscous damping that takes as much work in a cycle (Jacobsen, 1930). W is a small difference"
    " of large numbers, and inertia and damping of the run are in it: beside it stands what the"
    " joints and the damping of the run took. A negative ξ means that the cycle has no W that can"
    " be told from these."
)


def cycles(record):
    entries = record.run.get("cycles")
    if not entries:
        raise Refused("The run has no whole cycles, so there is no equivalent damping.")
    columns = [one for one in quantities.OF_CYCLES if one[-1]]
    heads = [f"{name} [{'%' if key == 'damping' else unit}]" for key, name, unit, *_ in columns]
    lines = []
    for n, one in enumerate(entries, start=1):
        one = {**one, "damping": one["damping"] and 100 * one["damping"]}
        lines.append((n, *(written(one[key]) for key, *_ in columns)))
    yield table(("cycle", *heads), lines, "Cycles. Source: run.json: cycles", "cycles")
    yield note(ABOUT_CYCLES)


def base(record):
    """Normal force, shear force and moment: of the sections that were recorded, else forces on what
    is held."""
    names = [n for n in record.run["recorded_sections"] if n in record.columns]
    if names:
        yield _forces(record, names, "Forces of the sections that were recorded")
        return
    reactions = [f"{one}_force_{axis}_kN" for one in record.run["held"] for axis in "xyz"]
    reactions = [name for name in reactions if name in record.columns]
    yield missing(
        "The moment at the base is not known: no section was recorded. scene.section(z) in the"
        " script records the normal force, the shear force and the moment of a horizontal section."
    )
    if not reactions and "base_shear_kN" in record.columns and record.isPush:
        reactions = ["base_shear_kN"]
    if reactions:
        yield _forces(record, reactions, "Forces of the structure on what is held")


def _forces(record, names, caption):
    places = {"first row": record.rows[0]}
    if record.isPush and record.data.rows:
        places["at the peak"] = record.data.rows[record.data.peak()]
    places["last row"] = record.rows[-1]
    lines = []
    for name in names:
        values, unit = record.columns[name], name.rpartition("_")[2]
        shown = values[record.rows]
        finite = shown[np.isfinite(shown)]
        ends = [finite.min(), finite.max()] if len(finite) else [np.nan] * 2
        least = NOISE * max(map(abs, ends))
        every = [*values[list(places.values())], *ends]
        texts = ["≈ 0" if abs(v) < least else withUnit(float(v), unit) for v in every]
        meaning = bare(record.run["columns"][name])
        lines.append((name.removesuffix("_" + unit), *texts, meaning, f"curve.csv: {name}"))
    heads = ("force", *places, "smallest", "largest", "what it is", "source")
    return table(heads, lines, caption, "forces")
