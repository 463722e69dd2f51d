# SPDX-License-Identifier: GPL-2.0-or-later
"""What curve.png shows of a scene: the entry ``figure`` of run.json."""

from ..assembly import columns
from . import bound_texts


def figureOf(outcome):
    """The entry ``figure`` of run.json.

    :param outcome: :class:`masonry.scene.outcome.Outcome`
    """
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
    target, data = outcome.model.loading.target, outcome.data
    height = f"{target.recorded[2] - outcome.description.low[2]:.3g} m above the base"
    bounds, looped, marks = outcome.scene.bounds, bool(outcome.pushed.history), []
    if data.rows:
        moved, sides = data["displacement_mm"], (1, -1) if looped else (1,)
        ends = [(moved[data.peak(side)], data.peakForce(side)) for side in sides]
        marks = [{"x": x, "y": y, "text": f"{y:.1f} kN at {x:.2f} mm"} for x, y in ends]
    return _entry(
        "displacement_mm",
        f"displacement of {target.name}, {height} [mm]",
        {"base_shear_kN": "supports", "top_shear_kN": "loaded point"},
        "force along the push [kN]",
        marks,
        looped,
        bounds=[*bound_texts.linesOfPush(bounds.entries, outcome.pushes)],
        **_rowsOf(outcome, data.rows),
    )


def _rowsOf(outcome, rows):
    """The entry of the figure that says which rows it shows, if these are not all in their order."""
    every = list(range(len(outcome.results.rows)))
    return {} if list(rows) == every else {"rows": list(rows)}


def _ofLoad(outcome, number, load):
    """What is drawn of a load that grew, or that was put on step by step: its factor over the displacement of what is
    watched."""
    kind, name, _ = load
    at, entry = outcome.scene.running.at, outcome.scene.bounds.entries.get(name, {})
    rows = range(at.stages[number - 1][3], len(outcome.results.rows))
    if kind == "lean":
        rows = restsUnder(outcome, name)
    found = {a["name"]: a["value"] for a in at.answers.get(str(number), [])}
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
        bounds=[*bound_texts.linesOfGrowth(entry)],
        **_rowsOf(outcome, rows),
    )


def restsUnder(outcome, name):
    """Rows at the ends of the stages that put on a load and came to rest, by its factor, after the row before them."""
    at, results = outcome.scene.running.at, outcome.results
    ends = [stage[3] - 1 for stage in at.stages[1:]] + [len(results.rows) - 1]
    numbers = [n for n, load in outcome.loads if load[:2] == ["lean", name]]
    answers = {n: at.answers.get(str(n), []) for n in numbers}
    held = {ends[n - 1] for n in numbers if any(a["value"] is not None for a in answers[n])}  # fmt: skip
    before = at.stages[numbers[0] - 1][3] - 1
    factors = results.column("load_factor")
    return [before] * (before >= 0) + sorted(held, key=lambda row: factors[row])


def _ofJoint(outcome, joint):
    """What is drawn of a joint that is recorded: the stress along which it moved farther, and the other one."""
    column = lambda head: outcome.results.column(joint.prefixed(head))
    reach = lambda head: max(map(abs, column(head)), default=0)
    what = "slide" if reach("slide_mm") > reach("opening_mm") else "opening"
    stresses = {
        joint.prefixed("normal_stress_MPa"): "normal, positive in tension",
        joint.prefixed("shear_stress_MPa"): "shear",
    }
    if what == "slide":
        stresses = dict(reversed(stresses.items()))
    x, label = joint.prefixed(f"{what}_mm"), f"mean {what} of the joint [mm]"
    return _entry(x, label, stresses, "mean stress [MPa]")
