# SPDX-License-Identifier: GPL-2.0-or-later
"""How stages end, and what they answer."""

import itertools
import math
from dataclasses import dataclass
from typing import Annotated, Any

from ..arguments import Name, number, validated
from ..errors import Refused
from ..numbers import quantities
from ..scene.resuming import saidBefore
from ..scene.script import RESULT, Call

#: How a stage ends.
AT_REST, MOVING, DONE, COLLAPSED = "at rest", "moving", "done", "collapsed"
#: How a collapse ends that is followed.
FALLEN_AT_REST, FALLEN_MOVING = f"{COLLAPSED} and at rest", f"{COLLAPSED} and moving"
FALLEN = {COLLAPSED, FALLEN_AT_REST, FALLEN_MOVING}  # ends of what has fallen
OWN = "0"  # the stage of the results of the script, which all stages follow
FALL = "fall"  # the stage in which a collapse is followed: masonry.stages.falling


@dataclass(frozen=True)
class Answer:
    """A number that a stage was run for.

    :param name: what it is, in one word or several joined by underscores
    :param unit: ``"-"`` if it has none
    :param value: None if the stage did not find it
    :param uncertainty: half the width of the interval that the run itself found about the value, in
        its unit; None if the run has no measure of it
    :param how: how the value and its uncertainty were found, a sentence
    """

    name: str
    unit: str
    value: float | None
    how: str
    uncertainty: float | None = None


def keep(scene, key, stage, number, answers):
    """Keep the answers of a stage, in place of those that had its key: its number, and perhaps a
    word after it."""
    kept = [{"stage": stage, "number": number, **vars(one)} for one in answers]
    scene.running.state.answers = {**scene.running.state.answers, key: kept}


def answerText(answer, what=None):
    """An entry of ``answers`` of run.json as a line; ``what``: what it is of, if not its stage."""
    head = f"{what or answer['stage']}: {answer['name'].replace('_', ' ')}"
    if answer["value"] is None:
        return f"{head}: not found: {answer['how']}"
    unit = "" if answer["unit"] == "-" else " " + answer["unit"]
    known = answer["uncertainty"] is not None
    about = f" ± {answer['uncertainty']:.2g}" if known else ""
    return f"{head} {answer['value']:.4g}{about}{unit}"


def answersText(answers, stages=()):
    """Entries of ``answers`` of run.json as lines. Stages of one kind that follow each other and
    look for the load that is held, as the trials of a bracket, have a line for each load.

    :param stages: entries of ``stages`` of run.json, which say what the loads are
    """
    loads = quantities.loadsOf(stages)

    def alike(one):
        if one["name"] not in ("factor_held", "factor_not_held"):
            return None
        trials = one["stage"] in ("lean", "load", "wind", "press", "pressure")
        return one["stage"], trials or one["number"], one["unit"]

    hidden = "displacement_held", "displacement_not_held"
    shown = [a for a in answers if not a["name"].startswith(hidden)]
    for kind, group in itertools.groupby(shown, alike):
        if kind is None:
            yield from map(answerText, group)
            continue
        parts = {}
        for one in group:
            parts.setdefault(loads.get(one["number"]), []).append(one)
        for load, ones in parts.items():
            yield _searchText(ones, load if len(parts) > 1 else None)


def _searchText(answers, what):
    """The line of stages that looked for one load. What was not held and is held in a later one, in
    a smaller step, does not count."""
    texts, held = [], -math.inf
    for name, choose in (("factor_held", max), ("factor_not_held", min)):
        found = [one for one in answers if one["name"] == name]
        known = [one for one in found if one["value"] is not None and one["value"] > held]
        unknown = [one for one in found if one["value"] is None] or found
        one = choose(known, key=lambda one: one["value"]) if known else unknown[-1]
        held = one["value"] if known else held
        texts.append(answerText(one, what))
    count = len({one["number"] for one in answers})
    stages = f" ({count} stages)" if count > 1 else ""
    return f"{texts[0]}{stages}; {texts[1].partition(': ')[2]}"


def finding(value: Any, first: Any = None) -> Any:
    """The kind of a number, or of None or NaN if it was not found."""
    missing = value is None or isinstance(value, float) and math.isnan(value)
    return None if missing else float(number()(value))


@validated
def result(
    scene: Any,
    name: Name,
    value: Annotated[float | None, finding],
    unit: str = "-",
    how: str = "the script found it",
) -> None:
    """Keep a number with the answers of the stages: in run.json, on the terminal and in study.csv.

    :param name: letters, digits and underscores; another result of this name is replaced
    :param value: a number; None, or what is not a number, if it was not found
    :param unit: ``"-"`` if it has none
    :param how: how it was found, a sentence
    :raises ValueError: with all problems
    """
    if not scene.model:
        raise Refused(f"result {name}: it comes after the first stage")
    scene.calls.append(Call(result, (name, value, unit, how), {}))
    state, before = scene.running.state, scene.running.scriptBefore
    later = [word for word, _ in before[len(scene.script.commands) + 1 :]]
    if saidBefore(scene, RESULT, name=name) and any(w != RESULT for w in later):
        return  # it was found in the state of that time
    kept = [one for one in state.answers.get(OWN, []) if one["name"] != name]
    own = {"stage": "script", "number": 0, **vars(Answer(name, unit, value, how))}
    state.answers = {**state.answers, OWN: [*kept, own]}
