# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of a report on the pictures, and on how far to trust the numbers."""

from masonry.numbers import quantities

from .pieces import (
    figure,
    isNumber,
    listed,
    missing,
    note,
    numbers,
    table,
    turning,
    withUnit,
    written,
)


def pictures(record):
    """The turning picture, and the cracks at the end."""
    if record.picture:
        yield turning(record.picture)
        shown, count = len(record.frameTimes), record.frameCount
        text = (
            "The sliders are for the frame and for the magnification of displacements; joints are"
            " coloured by what they did, by opening, slide, damage or plastic closure. Source: the"
            " frames for ParaView."
        )
        if shown < count:
            text += (
                f" It has {shown} of the {count} frames of the run, so that this file stays small;"
                " scripts/view.py writes one with all."
            )
        yield note(text)
    else:
        yield missing(f"There is no turning picture: {record.missing}")
    colours = "open joints red, slid joints blue, crushed joints black"
    yield figure("cracks.png", f"Cracks {record.whenCracked}: {colours}. Source: cracks.png.")


def trust(record):
    """How far to trust it: errors that the run knows of itself, promises, warnings, and what is not
    known."""
    run = record.run
    if sentences := run["warnings"] + record.problems:
        yield listed(sentences, "Warnings", "warning")
    else:
        yield note("The run has no warnings. Source: run.json: warnings.")
    yield from _said(run)
    rows = quantities.shown(record.numbers, "every", "cost")
    step, limit = run.get("time_step_s"), run.get("time_step_limit_s")
    if isNumber(step) and isNumber(limit) and limit > 0:
        share, source = written(100 * step / limit, 3), "run.json: time_step_s, time_step_limit_s"
        about = f"{share} % of the largest stable one."
        rows.append(quantities.Number("time step", 1e6 * step, "µs", about, source))
    if rows:
        yield numbers(rows, "What the run knows of its own errors")
    yield from _accuracy(run)
    if run["preset"]:
        yield note(f"The {run['preset_note']}. Source: run.json: preset_note.")
    elif "accuracy" not in run:
        yield note(
            "No preset and no --accuracy was chosen, so no error of peak or work is promised."
            " Source: run.json: preset."
        )
    unknown = [
        "Whether the model fits real masonry of this kind: validation/README.md of the project"
        " compares it with tests and closed forms.",
        "What the scatter of the material does: studies run a scene many times with properties that"
        " vary.",
    ]
    if "accuracy" not in run:
        text = (
            "How far rate, mesh and points of joints change the result: one run does not tell."
            " --accuracy 2 finds it for peak and work of a push."
        )
        unknown.insert(0, text)
    if run["assumed"]:
        unknown.append(
            "What the properties change that were assumed; the table of what was built lists them."
        )
    yield listed(unknown, "What is not known from this run")


def _said(run):
    rows = [
        (one["stage"] or "before the first stage", withUnit(one["time_s"], "s"), one["text"])
        for one in run["notes"]
    ]
    if rows:
        heads = "stage", "time in the scene", "text"
        yield table(heads, rows, "What the run said. Source: run.json: notes", "notes")


def _accuracy(run):
    found = run.get("accuracy")
    if not found:
        return
    lines = [
        (
            q["name"],
            f"{written(q['value'])} ± {written(q['half_width'], 2)} {q['unit']}",
            f"{written(q['half_width_percent'], 2)} %",
            ", ".join(f"{n}: {written(v, 2)} %" for n, v in q["parts_percent"].items()),
        )
        for q in found["quantities"]
    ]
    asked = written(found["asked_percent"])
    heads = "quantity", "value", "half-width", "its parts by their sources"
    caption = (
        f"Accuracy, asked for: {asked} %, by {found['fidelity']} and {len(found['companions'])}"
        " runs beside it. Source: run.json: accuracy"
    )
    yield table(heads, lines, caption)
    if not found["reached"]:
        yield note(f"The {asked} % are not reached: the ± is what was found.", "warning")
    yield note(f"The ± does not cover {found['not_covered']}.")
