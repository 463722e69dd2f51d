# SPDX-License-Identifier: GPL-2.0-or-later
"""Which properties of a masonry have an effect, which were assumed because they were not given, and
which cannot be assumed.

A MasonryJoint and a MasonryMat note which of their properties were never given (``assumed``), when
made, as an attribute, or with ``set`` or ``updateAttrs``. ``brittleCoulomb`` and :func:`copied`
keep the note. An object that YADE has loaded from a file has none: everything counts as given.
"""

from typing import Annotated, Any

from yade.wrapper import MasonryJoint, MasonryMat

from ..arguments import isA, listOf, validated
from ..model.bodies import properties
from ..model.engines import LAWS

#: Descriptions of properties by class and name.
DESCRIBED = {cls: {p["name"]: p for p in properties(cls)} for cls in (MasonryJoint, MasonryMat)}

#: Sources of defaults by class and name; the paper: see yade_plugin/law/README.md.
DEFAULTS = {cls: cls().assumed() for cls in DESCRIBED}

#: Properties without a default that fits any masonry.
NEEDED = {
    MasonryMat: ["density"],
    MasonryJoint: ["tensileStrength", "cohesion", "friction", "compressiveStrength"],
}

#: How the source of a property begins whose value a code gives.
BY_CODE = "by a code: "

#: Source of every property of a joint ``support`` that takes the bed joint.
AS_BED = "as of the bed joint"

#: Source of such a joint in ``assumed``.
SUPPORT = (
    "no joint 'support' was given: joints to platens take the bed joint, with its strength and"
    " friction"
)

#: What a property needs to have an effect: another one that is on, or above zero.
CONDITIONS = {
    **dict.fromkeys(
        """compressiveStrength elasticLimitRatio residualStrengthRatio peakRatio
        compressiveFractureEnergy capNormal capShear capLinear compressionStiffnessLoss
        bondLossByCrushing""".split(),
        "cap",
    ),
    "modeIFractureEnergy": "tensileStrength",
    "modeIIFractureEnergy": "cohesion",
    "residualCohesion": "cohesion",
    "residualFriction": "friction",
    "dilatancyDecay": "dilatancy",
}

#: Properties that a softening table replaces.
TABLES = {"modeIFractureEnergy": "tensionTable", "modeIIFractureEnergy": "shearTable"}


def state(thing: Any, **sources: str) -> Any:
    """Note that these properties of an object are assumed, with their sources, and all others
    given. Returns the object."""
    thing.assume(sources)
    return thing


def copied(thing: Any) -> Any:
    made = type(thing)(**{k: v for k, v in thing.dict().items() if k != "id"})
    return state(made, **thing.assumed())


def isDefault(thing: Any, name: str) -> bool:
    """Whether a property has the default of its class."""
    return thing.assumed().get(name) == DEFAULTS[type(thing)][name]


def effective(thing: Any) -> list[str]:
    """Names of the properties that have an effect: of a joint numbers alone, of a unit all."""
    if not isinstance(thing, MasonryJoint):
        return [*DESCRIBED[type(thing)]]
    read = () if thing.elastic else LAWS[thing.law]["properties"]
    values = thing.dict()
    found = ["normalStiffness", "shearStiffness"]
    for name in filter(read.__contains__, values):
        holds = name not in CONDITIONS or values[CONDITIONS[name]]
        replaced = name in TABLES and values[TABLES[name]]
        if isinstance(values[name], float) and holds and not replaced:
            found.append(name)
    return found


def _things(masonry):
    yield from masonry.joints.items()
    yield "unit", masonry.unit
    yield from masonry.units.items()


def entriesOf(masonry: Any) -> list[dict[str, Any]]:
    """The entry ``assumed`` of run.json, of properties that have an effect."""
    found = []
    for name, thing in _things(masonry):
        sources, counted = thing.assumed(), effective(thing)
        if AS_BED in sources.values():
            entry = {"name": name, "value": "bed", "unit": ""}
            found.append({**entry, "source": SUPPORT, "by_code": False})
        for one, p in DESCRIBED[type(thing)].items():
            source, value = sources.get(one, AS_BED), getattr(thing, one)
            if source == AS_BED or isinstance(value, str):
                continue
            switched = isinstance(value, bool) and not isDefault(thing, one)
            if switched or one in counted:
                entry = {"name": f"{name}.{one}", "value": value, "unit": p["unit"]}
                found.append({**entry, "source": source, "by_code": source.startswith(BY_CODE)})
    return found


def missing(masonry: Any) -> list[str]:
    """Sentences on properties that must be given."""
    problems = []
    for name, thing in _things(masonry):
        kind, joint = type(thing), isinstance(thing, MasonryJoint)
        counted = effective(thing)
        lacks = [n for n in NEEDED[kind] if isDefault(thing, n) and n in counted]
        if not lacks:
            continue
        what = f"{'joint' if joint else 'unit'} {name!r}"
        names = ", ".join(f"{n} [{DESCRIBED[kind][n]['unit']}]" for n in lacks)
        hint = (
            "; elastic=True makes a joint that never gives way, cap=False one that does not crush"
        )
        problems.append(
            f"masonry: {what}: {names} must be given, since no value fits any masonry"
            + hint * joint
        )
    return problems


@validated
def linesOf(
    entries: Annotated[list[dict[str, Any]], listOf(isA(dict), 0)], brief: bool
) -> list[str]:
    """What a scene prints of its entries ``assumed``; ``brief``: their number alone."""
    if not entries:
        return []
    byCode = [entry for entry in entries if entry["by_code"]]
    if brief:
        others = f", and {len(byCode)} given by a code" if byCode else ""
        return [
            f"note: {len(entries) - len(byCode)} properties of the materials are assumed{others};"
            " run.json lists them (assumed)"
        ]
    assumed = [entry for entry in entries if not entry["by_code"]]
    titles = {"given by a code": byCode, "assumed, because it was not given": assumed}
    lines = []
    for title, entries in titles.items():
        lines += [f"{title} (run.json: assumed):"] * bool(entries)
        kinds = {}
        for entry in entries:
            kind, _, what = entry["name"].rpartition(".")
            if kind:
                value, unit = entry["value"], entry["unit"].strip("-")
                text = f"{value:.4g}" if isinstance(value, float) else str(value)
                what = f"{what} {text} {unit}".rstrip()
            kinds.setdefault((what, entry["source"]), []).append(kind)
        for (what, source), joints in kinds.items():
            of = f"{', '.join(joints)}: " if joints != [""] else ""
            lines.append(f"  {of}{what}  ({source.removeprefix(BY_CODE)})")
    return lines
