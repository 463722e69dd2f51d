# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of a report on what was built, and how it was held and loaded."""

from masonry.numbers import quantities

from .pieces import (
    Badged,
    facts,
    figure,
    folded,
    isNumber,
    listed,
    missing,
    note,
    numbers,
    table,
    withUnit,
    written,
)

#: Units in which properties are shown, and the factor from SI units.
SHOWN = {
    "Pa": ("MPa", 1e-6),
    "Pa/m": ("N/mm³", 1e-9),
    "J/m²": ("N/mm", 1e-3),
    "m": ("mm", 1e3),
    "1/m": ("1/mm", 1e-3),
}
#: Counts of a run, by their entries in run.json.
COUNTS = {
    "units": "blocks of the model, bricks or their halves",
    "joint_count": "joints between blocks",
    "subcontacts": "points of joints when the run began",
    "refined_joints": "joints that got more points",
    "nodes": "nodes of deformable units",
}
#: Properties of units: name, entry of run.json, factor, unit that is shown, meaning.
OF_UNITS = (
    (
        "Young's modulus of the units",
        "young_Pa",
        1e-6,
        "MPa",
        "Elastic modulus of the material of the bricks; rigid units have theirs in the stiffness of"
        " their joints.",
    ),
    (
        "Poisson's ratio of the units",
        "poisson",
        1,
        "-",
        "Lateral over longitudinal strain of the material of the bricks.",
    ),
    ("density of the units", "density_kg_per_m3", 1, "kg/m³", "Mass of a brick over its volume."),
)
MAX_COMMANDS = 12  # of a script that are shown at once
MAX_LEADING = 3  # answers at the head of a report


def origin(record):
    """What stands below the title: names, values and their entries in run.json."""
    run = record.run
    ended = run["date"].replace("T", " ").replace("Z", " UTC")
    names = {"masonry": "masonry", "yade": "YADE", "python": "Python"}
    versions = ", ".join(f"{name} {run['versions'][key]}" for key, name in names.items())
    lines = [
        ("scene", run["scene"], "scene"),
        ("run ended", ended, "date"),
        ("versions", versions, "versions"),
        ("commit", run["commit"], "commit"),
    ]
    yield facts(lines)


def head(record):
    """How the run ended, and the numbers that it was run for."""
    run = record.run
    if run.get("error"):
        yield note(run["error"], "warning", "The run ended by an error:")
    elif run.get("interrupted"):
        yield note(
            "All numbers are those up to there; --resume goes on.",
            "warning",
            "The run was interrupted.",
        )
    elif run.get("collapsed"):
        yield note(f"{run.get('collapse') or 'the structure has fallen'}.", "warning", "Collapsed:")
    elif run.get("ended"):
        yield note(f"The last stage ended: {run['ended']}.")
    else:
        yield note("The run has no rows: it took no time steps, or ended before there was one.")
    grows = record.isPush and record.data.stillGrows
    lead = quantities.headline({**run, **record.numbers}, grows=grows)
    lead = lead or "; ".join(f"{what} {valueOf(one)}" for one, what in sought(run))
    answers = [f"{nameOf(a)} {valueOf(a)}" for a in _leading(answersOf(run))]
    if lead := lead or "; ".join(answers):
        yield note(f"{firstUpper(lead)}.", "lead")
    if warnings := run["warnings"] + record.problems:
        more = f", and {len(warnings) - 1} more" if len(warnings) > 1 else ""
        yield note(
            f"{warnings[0]}{more}. The part “How far to trust it” has all.", "warning", "Warning:"
        )


def _leading(answers):
    """The answers at the head: of many displacements the largest one, else the last answers."""
    moved = [one for one in answers if one["name"].startswith("largest_displacement")]
    if len(answers) > MAX_LEADING and moved:
        return [max(moved, key=lambda one: abs(one["value"]))]
    return answers[-MAX_LEADING:]


def firstUpper(text):
    return text[:1].upper() + text[1:]


def answersOf(run):
    return [one for one in run.get("answers") or [] if isNumber(one["value"])]


def nameOf(answer):
    return answer["name"].replace("_", " ")


def valueOf(answer):
    """An answer with its uncertainty and unit."""
    if not isNumber(answer["value"]):
        return "not found"
    text = written(answer["value"])
    if isNumber(answer["uncertainty"]):
        text += f" ± {written(answer['uncertainty'], 2)}"
    return text if answer["unit"] == "-" else f"{text}\u00a0{answer['unit']}"


def sought(run):
    """The largest load that was held and the smallest that was not, as answers, of a run that
    looked for one load: pairs of an answer and what it is. Of a bracket its trials count."""
    loads, names = quantities.loadsOf(run["stages"]), ("factor_held", "factor_not_held")
    ones = [a for a in answersOf(run) if a["name"] in names and a["stage"] != "bracket"]
    if len({(a["stage"], a["unit"], loads.get(a["number"])) for a in ones}) != 1:
        return []
    found = []
    for name, choose, what in (
        ("factor_held", max, "largest load that was held"),
        ("factor_not_held", min, "smallest load that was not held"),
    ):
        alike = [a for a in ones if a["name"] == name]
        if found:  # what was held later counts
            alike = [a for a in alike if a["value"] > found[0][0]["value"]]
        if alike:
            found.append((choose(alike, key=lambda a: a["value"]), what))
    return found


def built(record):
    """What was built: a drawing, counts, and materials with what was assumed."""
    run = record.run
    if record.elevation:
        yield figure(*record.elevation)
    else:
        yield missing(f"There is no drawing of what was built: {record.missing}")
    built = run.get("built") or []  # not with --lean
    rows = [(name, text, "run.json: built") for name, text in built]
    for key, what in COUNTS.items():
        if run.get(key) and not (key == "units" and built):
            rows.append((what, written(run[key]), f"run.json: {key}"))
    if kinds := run.get("joints_by_kind"):
        text = ", ".join(f"{written(count)} {name}" for name, count in kinds.items())
        rows.append(("joints by kind", text, "run.json: joints_by_kind"))
    yield table(("what", "how much", "source"), rows, "Counts and sizes")
    yield from _units(run)
    yield from _joints(run)
    yield from _assumed(run)


def _units(run):
    assumed, found = _badges(run), []
    for what, key, factor, unit, meaning in OF_UNITS:
        value = factor * run["unit_material"][key]
        named = _marked(what, assumed.get(f"unit.{key.partition('_')[0]}"))
        source = f"run.json: unit_material.{key}"
        found.append(quantities.Number(named, value, unit, meaning, source))
    yield numbers(found, "Units")


def _marked(text, badge):
    return Badged(text, badge) if badge else text


def _badges(run):
    """What stands beside properties that were not given, by their names; those of the support are
    those of the bed joint where it takes these."""
    badge = lambda one: "by a code" if one.get("by_code") else "assumed"
    found = {str(one.get("name")): badge(one) for one in run.get("assumed") or []}
    if "support" in found:
        ofBed = {n: text for n, text in found.items() if n.startswith("bed.")}
        found |= {n.replace("bed.", "support.", 1): text for n, text in ofBed.items()}
    return found


def _joints(run):
    joints, effective = run["joints"], run["effective_properties"]
    units, meanings = run["joint_units"], run["joint_meanings"]
    counted = run.get("joints_by_kind") or joints  # kinds without joints do not count
    joints = {kind: found for kind, found in joints.items() if kind in counted}
    assumed, kinds = _badges(run), list(joints)
    shown, others = [], []
    for name in dict.fromkeys(n for p in joints.values() for n in p if n in units):
        meaning = str(meanings.get(name, "")).partition(". ")[0].rstrip(".")
        unit, factor = SHOWN.get(units[name], (units[name], 1))
        having = [kind for kind in kinds if name in effective.get(kind, ())]
        cells = ["–"] * len(kinds)
        for kind in having:
            value = joints[kind].get(name)
            text = written(factor * value if isNumber(value) else None)
            cells[kinds.index(kind)] = _marked(text, assumed.get(f"{kind}.{name}"))
        used = any(joints[kind].get(name) for kind in having)
        (shown if used else others).append((meaning or name, unit, *cells))
    laws = [_lawOf(joints[kind]) for kind in kinds]
    heads = ("property", "unit", *kinds)
    caption = (
        "Joints, by kind. A dash: the property has no effect on this kind. Source: run.json:"
        " joints, effective_properties"
    )
    yield table(heads, [("law", "", *laws), *shown], caption, "joints")
    if others:
        inside = table(heads, others, "Other properties of the joints", "joints")
        yield folded("Properties that are zero, or have no effect here", inside, look="screen")


def _lawOf(joint):
    if joint.get("elastic"):
        return "elastic: no strength is reached"
    return f"{joint.get('law', 'not known')}{'' if joint.get('cap', True) else ', cannot crush'}"


def _assumed(run):
    entries = run["assumed"]
    if not entries:
        yield note(
            "Nothing was assumed: every property of the materials was given. Source: run.json:"
            " assumed."
        )
        return
    groups = {}
    for one in entries:
        kind, _, name = one["name"].partition(".")
        found, value = groups.setdefault((kind, one["source"]), []), one.get("value")
        if isNumber(value):
            unit, factor = SHOWN.get(one["unit"], (one["unit"], 1))
            found.append(f"{name}\u00a0{withUnit(factor * value, unit)}")
        else:
            found.append(" ".join(filter(None, (name, str(value or "")))))
    lines = [(kind, ", ".join(found), source) for (kind, source), found in groups.items()]
    yield table(
        ("of", "property and value", "where it is from"),
        lines,
        "What was not given, and is BY A CODE or ASSUMED. Source: run.json: assumed",
    )


def loaded(record):
    """How it was held and loaded: targets, stages, the commands of the script, and the options."""
    run = record.run
    if pairs := run.get("held_and_loaded"):
        heads = "what", "how it is held and loaded before the first stage"
        yield table(heads, pairs, "Supports and dead loads. Source: run.json: held_and_loaded")
    else:
        yield note(f"Held: {', '.join(run['held']) or 'nothing'}. Source: run.json: held.")
    yield from _connections(run)
    lines, loads = [], quantities.loadsOf(run["stages"])
    for number, stage in enumerate(run["stages"], start=1):
        found = [f"{nameOf(a)} {valueOf(a)}" for a in answersOf(run) if a["number"] == number]
        load, steps = loads.get(number) or "–", written(stage["steps"])
        lines.append((number, stage["stage"], load, steps, "; ".join(found) or "–"))
    if lines:
        heads = "number", "stage", "load", "time steps", "what it found"
        caption = "Stages in their order. Source: run.json: stages, answers"
        yield table(heads, lines, caption, "stages")
    script = [spoken(*command) for command in run["script"]]
    about = note(
        "Stresses are in Pa, forces in N, lengths in m, and displacements of pushes and supports in"
        " mm; help(masonry.Scene) describes the commands. Source: run.json: script."
    )
    title, few = "The commands of the script, in their order", len(script) <= MAX_COMMANDS
    yield folded(title, listed(script, look="script"), about, opened=few)
    options = [
        f"{name.replace('_', ' ')}: {_said(value)} {run['option_units'].get(name, '')}".strip()
        for name, value in run["options"].items()
    ]
    about = note(f"{'; '.join(options)}. Source: run.json: options.")
    yield folded("All options of the run", about)


#: Units at the end of names in entries of ties and springs, the longest first.
ENDINGS = (("_N_per_m", "N/m"), ("_Nm", "N m"), ("_N", "N"), ("_m", "m"))


def _connections(run):
    for key in ("ties", "springs", "overlays"):
        lines = [
            (one["name"], "; ".join(_named(n, v) for n, v in one.items() if n != "name"))
            for one in run.get(key) or []
        ]
        if lines:
            heads = "name", "what it is, and its state at the end"
            yield table(heads, lines, f"{key.capitalize()}. Source: run.json: {key}")


def _named(name, value):
    ends = ((ending, unit) for ending, unit in ENDINGS if name.endswith(ending))
    ending, unit = next(ends, ("", ""))
    words = name.removesuffix(ending).replace("_", " ")
    return f"{words} {_values(value)} {unit}".strip()


def _values(value):
    """An entry of a tie or a spring; a list is a vector."""
    if isinstance(value, list):
        return f"({', '.join(map(_values, value))})"
    return _said(value)


def _said(value):
    """A value in words, without the brackets and quotation marks of Python."""
    if value in (None, [], ""):
        return "–"
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_said, value))
    if isinstance(value, dict):
        return ", ".join(f"{name} {_said(one)}" for name, one in value.items())
    if isinstance(value, bool):
        return "yes" if value else "no"
    return written(value, 6) if isNumber(value) else str(value)


def spoken(word, arguments):
    """A command of a script as it was given, without the arguments that are nothing."""
    given = {n: v for n, v in arguments.items() if v not in (None, False, "", [], {})}
    return f"{word}({', '.join(f'{n}={_short(v)}' for n, v in given.items())})"


def _short(value):
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_short, value)) + "]"
    return repr(value) if isinstance(value, str) else str(value)
