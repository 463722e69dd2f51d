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
    return {
        "x": {"column": "time_s", "label": "time [s]"},
        "y": [{"column": n, "label": n.rsplit("_", 1)[0]} for n in y],
        "y_label": "displacement [mm]" if moving else "force [kN]",
        "looped": False,
        "marks": [],
    }


def _ofPush(outcome):
    target, data = outcome.model.loading.target, outcome.data
    height = f"{target.recorded[2] - outcome.description.low[2]:.3g} m above the base"
    marks, bounds = [], outcome.scene.bounds
    if data.rows:
        moved = data["displacement_mm"]
        sides = (1, -1) if outcome.pushed.history else (1,)
        ends = [(moved[data.peak(side)], data.peakForce(side)) for side in sides]
        marks = [{"x": x, "y": y, "text": f"{y:.1f} kN at {x:.2f} mm"} for x, y in ends]
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
        "looped": bool(outcome.pushed.history),
        "marks": marks,
        "bounds": [*bound_texts.linesOfPush(bounds.entries, outcome.pushes)],
        **_rowsOf(outcome, data.rows),
    }


def _rowsOf(outcome, rows):
    """The entry of the figure that says which rows it shows, if these are not all in their order."""
    every = list(range(len(outcome.results.rows)))
    return {} if list(rows) == every else {"rows": list(rows)}


def _ofLoad(outcome, number, load):
    """What is drawn of a load that grew, or that was put on step by step: its factor over the displacement of what is
    watched."""
    kind, name, _ = load
    bounds, at = outcome.scene.bounds, outcome.scene.running.at
    first, factors = at.stages[number - 1][3], outcome.results.column("load_factor")
    rows = range(first, len(factors))
    if kind == "lean":
        rows = restsUnder(outcome, name)
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
    entry = bounds.entries.get(name, {})
    unit = entry.get("unit") or "-"
    return {
        "x": {
            "column": "displacement_mm",
            "label": f"displacement of {outcome.model.loading.followed.name} along the load [mm]",
        },
        "y": [{"column": "load_factor", "label": "load"}],
        "y_label": f"load{' while it grows' * (kind == 'growth')} [{unit}]",
        "looped": False,
        "marks": marks,
        "bounds": list(bound_texts.linesOfGrowth(entry)),
        **_rowsOf(outcome, rows),
    }


def restsUnder(outcome, name):
    """Rows at the ends of the stages that put on a load and came to rest, by its factor, after the row before them."""
    at, results = outcome.scene.running.at, outcome.results
    ends = [stage[3] - 1 for stage in at.stages[1:]] + [len(results.rows) - 1]
    numbers = [n for n, load in outcome.loads if load[:2] == ["lean", name]]
    factors = results.column("load_factor")
    held = [
        ends[n - 1]
        for n in numbers
        if any(a["value"] is not None for a in at.answers.get(str(n), []))
    ]
    before = at.stages[numbers[0] - 1][3] - 1
    rows = sorted(set(held), key=lambda row: factors[row])
    return [before] * (before >= 0) + rows


def _ofJoint(outcome, joint):
    """What is drawn of a joint that is recorded: the stress along which it moved farther, and the other one."""
    column = lambda head: outcome.results.column(joint.prefixed(head))
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
