# SPDX-License-Identifier: GPL-2.0-or-later
"""Builds a scene for a study and writes what it knows; there is no run."""

import json
import math
import os
import re
import sys

from yade.wrapper import MasonryJoint

from masonry.folders import replaced
from masonry.run import batch
from masonry.materials import fields
from masonry.errors import Refused, firstOf
from masonry.terminal import say
from masonry.materials import withResidual
from masonry.scene.options import check
from masonry.scene.parsing import Parser
from masonry.materials.settings import valuesOf
from masonry.model.bodies import properties

#: Standard deviations of its normal up to which a random field is looked at: one joint in a million
#: lies beyond.
FIELD_LIMIT_SIGMAS = 4.75
MAX_PROBLEMS = 20  # that are named of rows
WRITTEN = bool, int, float, str  # types of values of properties that JSON gets


def probe(scene, stage, traits, arguments):
    """Write what a scene that is built knows, as JSON, and end when the first stage begins after
    the loads have grown. Keys:

    - ``heard``: whether the scene takes its options from the command line
    - ``options``: names of its options, without those that say where results go
    - ``unused``: options that the scene does not use, with the reason; ``doubtful``: those that it
      may not use
    - ``joints``: properties of every kind of joint; ``counts``: how many joints there are of each
    - ``bounds``: ``low``, ``high`` and ``unit`` of the properties of a joint; ``connectors``: the
      same of every tie, spring and fibre layer
    - ``room``: bytes that a run will probably write
    - ``problems``: sentences on rows of the table that cannot be run

    :param stage: name of the stage that begins, or ``finish``
    :param traits: its :class:`masonry.stages.stage.Traits`, or None
    :param arguments: what the script says to it, by name
    """
    if traits and traits.grows:
        return "at rest"
    used = set(traits.options) if traits else set()
    parser, found = Parser.last
    joints, heard = scene.model.joints, scene.args is found
    options = {action.dest for action in parser._actions} if heard else set()
    counts = scene.outcome.describe()["joints_by_kind"]
    doubtful = {"record", "scale"} - used
    if not {"until", "history"} & used:
        doubtful |= {"rate", "until", "history"} - used
    entries = {
        "scene": scene.name,
        "heard": heard,
        "options": sorted(options - {"help", "out", "resume", "set", "field"}),
        "unused": {},
        "doubtful": dict.fromkeys(doubtful, f"its first stage is {stage}()"),
        "joints": {
            name: {n: v for n, v in joint.dict().items() if isinstance(v, WRITTEN)}
            for name, joint in joints.items()
        },
        "counts": {kind: counts.get(one.name, 0) for kind, one in joints.items()},
        "bounds": {p["name"]: _bounds(**p) for p in properties(MasonryJoint)},
        "connectors": {
            name: {n: _bounds(**p._asdict()) for n, p in one.known.items()}
            for name, one in scene.description.settable().items()
        },
        "problems": _rows(scene, parser) if heard else [],
        "room": scene.outcome.space()[1],
    }
    if "rate" in used and arguments.get("rate") is not None:
        entries["unused"]["rate"] = f"{stage}() has a rate of its own"
    path = os.environ[batch.PROBE]
    scene.finished = True
    scene.results.release()
    try:
        with replaced(path, "w") as f:
            json.dump(entries, f)
    except OSError as error:
        say(f"cannot write {path}: {error.strerror}", sys.stderr)
        raise SystemExit(batch.UNWRITTEN) from None
    raise SystemExit(0)


def _bounds(low, high, unit, **more):
    """The bounds of a property; what JSON has no number for is None."""
    finite = lambda v: v if v is not None and math.isfinite(v) else None
    return {"low": finite(low), "high": finite(high), "unit": unit}


def _rows(scene, parser):
    path, _ = batch.place(os.environ[batch.VARIABLE])
    problems = {}
    known = {action.dest for action in parser._actions}
    for line, row in batch.readTable(path).items():
        # others are no options, which is said once, and not of every row
        row = {n: v for n, v in row.items() if "." in n or n in known | {"description"}}
        for sentence in _refused(scene, parser, batch.optionWords(row)):
            alike = re.sub(r"\d[\d.e+-]*", "#", sentence)  # but for its numbers
            name = row.get("description", line)
            problems.setdefault(alike, []).append((name, sentence))
    sentences = []
    for (name, sentence), *others in problems.values():
        more = f" and {len(others)} more" if others else ""
        sentences.append(f"row {name}{more}: {sentence}")
    return firstOf(sentences, MAX_PROBLEMS)


def _refused(scene, parser, words):
    args, refusals = parser.refusals(words)
    if refusals:
        return refusals
    try:
        connectors = scene.description.settable(copies=True)
        masonry = scene.description.materials.variant(args, [*connectors])
        check(args, masonry, connectors)
        for text in args.field:
            _refuseFarValues(text, masonry.joints, connectors)
    except ValueError as refused:
        return str(refused).splitlines()
    return []


def _refuseFarValues(text, joints, connectors):
    """Refuse a field whose joints refuse its values far from the mean."""
    names, kind, cov, *_ = fields.parts(text)
    of = {}
    for name in withResidual(names, joints):
        thing, _, attribute = name.partition(".")
        of.setdefault(thing, []).append(attribute)
    for factor in fields.ends(kind, cov, FIELD_LIMIT_SIGMAS):
        for name, attributes in of.items():
            thing = {**joints, **connectors}[name]
            before = {a: valuesOf(thing)[a] for a in attributes}
            try:
                thing.updateAttrs({a: factor * v for a, v in before.items()})
            except ValueError as error:
                raise Refused(
                    f"--field {text}: where the field is {factor:.3g} of the mean: {error}"
                ) from None
            thing.updateAttrs(before)
