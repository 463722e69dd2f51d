# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a checkpoint that has the right form can be that of a run: its numbers must fit each other.

:mod:`masonry.run.place` looks at the form. A checkpoint that somebody has made up can have that, and a sum that fits, and still
end a run with an error when files have been written. What is found here is found before.
"""

import base64
import math

from .checkpoints import alike
from .place import otherVersion

LONGEST = 200  # characters of a reason
#: How data that somebody has made up show themselves.
DAMAGES = (ValueError, TypeError, LookupError, AttributeError, ArithmeticError, MemoryError, RecursionError)  # fmt: skip
#: Answers of a stage that looks for the load that is held: both ends come together.
ENDS = {"factor_held", "factor_not_held"}
FARTHEST = 1e9  # [m], [m/s], [rad/s]


def check(saved, at):
    """Refuse a checkpoint whose parts contradict each other.

    :param saved: :class:`masonry.run.place.Saved`
    :param at: its :class:`masonry.run.place.Place`
    """
    rows = len(saved.rows)
    heads = {
        "seconds": saved.seconds >= 0
        and all(s >= 0 for s in at.seconds.values())
        and (at.seconds["steps"] > 0 or at.steps == 0),
        "the number of the stage": at.number == len(at.stages),
        "the stages": _grow([s[1] for s in at.stages], at.steps)
        and _grow([s[3] for s in at.stages], rows),
        # their times may fall: a trial of a bracket begins at the time of the last state at rest
        "the frames": all(t >= 0 for t in at.frames),
        "where pushes began": all(alike(o, [0.0] * 3) for o in at.origins.values()),
        "the bounds": all(map(_isBound, at.bounds.values())),
        "the swings": all(map(_isNumber, at.swings))
        and all(
            0 <= value < FARTHEST for swing in at.swings.values() for value in swing
        )
        and 0 <= at.memory.get("period", 0.0) < FARTHEST,
        "the loads": all(map(_isNumber, at.loads)),
        "how stages ended": all(map(_isNumber, at.ended)),
        "the answers": all(map(_isAnswer, at.answers.items())),
        "the memory of the stage": all(map(_isMemory, at.memory.items())),
    }
    wrong = [name for name, fine in heads.items() if not fine]
    if wrong:
        raise otherVersion(f"{', '.join(wrong)} cannot be those of a run")


def _grow(numbers, end):
    """Whether numbers do not fall, and are not above an end."""
    whole = [*numbers, end]
    return all(one <= next for one, next in zip(whole, whole[1:]))


def _isNumber(text):
    return text.isascii() and text.isdecimal()


def _isBound(entry):
    """Whether an entry of the bounds is of the form that :mod:`masonry.scene.bounds` gives it."""
    if not isinstance(entry, dict):
        return False
    numbers = ("factor", "without_dilatancy", "facet_error", "pressed_kN", "normal_kN")
    return (
        all(isinstance(entry.get(name), str) for name in ("load", "unit"))
        and all(alike(entry[name], 0.0) for name in numbers if name in entry)
        and ("note" not in entry or isinstance(entry["note"], str))
    )


def _isAnswer(entry):
    """Whether the answers of a stage are those of :class:`masonry.scene.stages.answers.Answer`."""
    number, found = entry
    ends = [one for one in found if one["name"] in ENDS]
    unknown = lambda value: value is None or alike(value, 0.0)
    return (
        _isNumber(number)
        and all(
            all(isinstance(one[name], str) for name in ("stage", "name", "unit", "how"))
            and one["number"] == int(number)
            and unknown(one["value"])
            and unknown(one["uncertainty"])
            for one in found
        )
        and (
            not ends
            or {one["name"] for one in ends} == ENDS
            and len({(one["stage"], one["unit"]) for one in ends}) == 1
        )
    )


#: What the lists of a memory have in each place, as of :class:`masonry.scene.stages.growing.Growing`.
IN_LISTS = {
    "kept": [0.0, ""],
    "rows": [0.0] * 3,
    "trials": [0.0] * 2,
    "marks": 0.0,
    "recent": [0.0] * 2,
    "places": 0.0,
}
#: How long other lists are, if they are not empty.
LONG = {"held": 2, "lost": 4, "origin": 3}


def _isMemory(entry):
    """Whether a value of the memory of a stage is such that the stage can go on with it."""
    name, value = entry
    if name in IN_LISTS and isinstance(value, (list, tuple)):
        return all(alike(one, IN_LISTS[name]) for one in value)
    return name not in LONG or not value or alike(value, [0.0] * LONG[name])


def checkReading(values, reading):
    """Refuse a state of which a column of curve.csv has no finite number.

    :param values: functions of a reading
    :param reading: of the state
    """
    if not all(math.isfinite(value(reading)) for value in values):
        raise otherVersion("its state has left finite numbers")


def checkStates(at, load):
    """Refuse states within a checkpoint that this scene cannot take: the last one at rest, and those of a growth. The scene
    has the last of them then.

    :param at: :class:`masonry.run.place.Place`
    :param load: function that gives the scene the bytes of a state, and raises ValueError
    """
    kept = [text for _, text in at.memory.get("kept", ())]
    kept += [text for name, text in at.memory.items() if name.endswith("State")]
    for text in filter(None, [at.atRest, *kept]):
        try:
            load(base64.b64decode(text, validate=True))
        except (ValueError, TypeError) as error:
            raise otherVersion(f"a state within it {brief(error)}") from None


def checkBodies(bodies):
    """Refuse a state in which a body is farther away, or faster, than any of a structure."""
    for body in bodies:
        s = body.state
        numbers = (*s.pos, *s.vel, *s.angVel)
        if not all(abs(number) < FARTHEST for number in numbers):
            raise otherVersion(f"body {body.id} is beyond {FARTHEST:g} m or m/s")


def brief(error):
    """What an error says, in one line."""
    text = " ".join(f"{type(error).__name__}: {error}".split())
    return text if len(text) < LONGEST else text[:LONGEST] + " ..."
