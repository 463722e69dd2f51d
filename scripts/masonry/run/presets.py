# SPDX-License-Identifier: GPL-2.0-or-later
"""Presets of options that trade accuracy for time, and what ``fast`` promises; and the fidelities
from which ``--accuracy`` chooses. No YADE is needed."""

from dataclasses import dataclass
from typing import Any

from .option_table import USUAL, asOption

#: Options by preset, the same for all walls. A scene of one's own may take them from here.
PRESETS: dict[str, dict[str, Any]] = {
    "fast": dict(blocks="rigid", divisions=1, rate=100.0),
    "accurate": dict(blocks="deformable", divisions=2, rate=50.0, mass_scaling="auto"),
}
for _preset in PRESETS.values():
    _preset.update(damping=0.8, damping_kind="combined", dt_fraction=0.8)

BOUND = "bound"  # the preset of limit analysis alone, without a run: see masonry_limit

#: What ``fast`` promises of a wall in its :data:`RANGE`: of so many walls of validation/trade and
#: validation/accuracy all but ``missed`` had these errors of peak and work at most, against a fine
#: and slow run [-].
PROMISE = dict(peak_error=0.06, work_error=0.07, walls=44, missed=2)

#: The walls on which ``fast`` was measured, pushed once in their plane: least and largest value of
#: each property of :func:`masonry.scene.summary.properties`.
RANGE: dict[str, tuple[float, float]] = {
    "length over height": (0.27, 3.4),
    "courses": (6, 34),
    "bricks in the length": (3, 18),
    "pressure at the top [MPa]": (0.3, 0.7),
    "tensile strength of bed joints [MPa]": (0, 0.15),
    "cohesion of bed joints [MPa]": (0, 0.165),
    "friction of bed joints": (0.43, 0.65),
}

# -- fidelities: what --accuracy chooses from ------------------------------------------------------


@dataclass(frozen=True)
class Source:
    """A source of error of a fidelity, and the runs that show how large it is: by the difference of
    the last two, or less if of three, each with half the step of the one before, the differences
    shrink as those of a method of an order do (Richardson)."""

    name: str
    runs: tuple  # names in COMPANIONS, from the coarsest to the finest, or MAIN, the run itself
    share: float = 1.0  # what counts of the difference of two [-]
    chance: bool = False  # whether the spread of the runs is chance


@dataclass(frozen=True)
class Fidelity:
    """Options of a run, and their error, from validation/trade and validation/accuracy."""

    name: str  # as the terminal says it
    options: dict  # others of CHOSEN have their defaults
    error: dict  # by quantity, against a fine and slow run, beside the sources [-]
    sources: tuple  # of the errors that companions show


#: The run itself among those of a :class:`Source`. Before it has been made, the source counts as in
#: the fidelity before.
MAIN = "this run"

_ONE, _TWO, _THREE = (
    dict(blocks="deformable", divisions=n, mass_scaling="auto") for n in (1, 2, 3)
)

#: Runs beside a run, by name: their options. They are cheap beside the run that they judge.
COMPANIONS: dict[str, dict[str, Any]] = {
    "rigid, 200 mm/s": {"rate": 200.0},
    "rigid, 100 mm/s": {"rate": 100.0},
    "rigid, 50 mm/s": {"rate": 50.0},
    "rigid, 100 mm/s, time step 0.78": {"rate": 100.0, "dt_fraction": 0.78},
    "rigid, 100 mm/s, time step 0.76": {"rate": 100.0, "dt_fraction": 0.76},
    "rigid, 100 mm/s, 12 points": {"rate": 100.0, "points": "12"},
    "one cell, 100 mm/s": {**_ONE, "rate": 100.0},
    "one cell, 100 mm/s, time step 0.78": {**_ONE, "rate": 100.0, "dt_fraction": 0.78},
    "one cell, 100 mm/s, time step 0.76": {**_ONE, "rate": 100.0, "dt_fraction": 0.76},
    "one cell, 50 mm/s": {**_ONE, "rate": 50.0},
    "two cells, 100 mm/s": {**_TWO, "rate": 100.0},
}

#: A wall that softens is chaotic: runs whose time steps hardly differ give other peaks and works.
_CHANCE = [
    Source("chance", (one, one + ", time step 0.78", one + ", time step 0.76"), chance=True)
    for one in ("rigid, 100 mm/s", "one cell, 100 mm/s")
]
_RATE = Source("rate", ("one cell, 100 mm/s", "one cell, 50 mm/s"))

#: What ``--accuracy`` chooses from, the cheapest first.
FIDELITIES = (
    Fidelity(
        "rigid units, 50 mm/s",
        {"rate": 50.0},
        {"peak": 0.005, "work": 0.005},
        (
            _CHANCE[0],
            Source("rate", ("rigid, 200 mm/s", "rigid, 100 mm/s", "rigid, 50 mm/s")),
            Source("points", ("rigid, 100 mm/s", "rigid, 100 mm/s, 12 points"), 0.5),
            Source("block model", ("one cell, 100 mm/s", "rigid, 50 mm/s")),
        ),
    ),
    Fidelity(
        "deformable units of one cell, 50 mm/s",
        {**_ONE, "rate": 50.0},
        {"peak": 0.006, "work": 0.006},
        (
            _CHANCE[1],
            _RATE,
            # rigid units are too soft and one cell is too stiff, so the result lies between them
            Source("block model", ("rigid, 50 mm/s", "one cell, 100 mm/s"), 0.5),
        ),
    ),
    Fidelity(
        "deformable units of two by two cells, 50 mm/s",
        {**_TWO, "rate": 50.0},
        {"peak": 0.005, "work": 0.005},
        (
            _CHANCE[1],
            _RATE,
            Source("mesh", ("one cell, 100 mm/s", "two cells, 100 mm/s"), 0.5),
        ),
    ),
    Fidelity(
        "deformable units of three by three cells, 50 mm/s",
        {**_THREE, "rate": 50.0},
        {"peak": 0.004, "work": 0.004},
        (_CHANCE[1], _RATE, Source("mesh", ("two cells, 100 mm/s", MAIN), 0.5)),
    ),
)

CHOSEN = USUAL  # options that --accuracy chooses, as they are without any


def fidelityOf(args):
    """The :class:`Fidelity` with the options of a run, or None."""
    chosen = {name: getattr(args, name) for name in CHOSEN}
    return next((f for f in FIDELITIES if {**CHOSEN, **f.options} == chosen), None)


def outsideOf(properties):
    """Sentences on properties in which a scene is unlike the walls on which ``fast`` was measured.

    :param properties: :func:`masonry.scene.summary.properties`; None: it moves in space
    """
    if properties is None:
        return ["it moves in space, and they were pushed in their plane"]
    sentences = []
    for name, (least, most) in RANGE.items():
        value = properties[name]
        if not least - 0.005 * most <= value <= 1.005 * most:
            what, _, unit = name.partition(" [")
            unit = unit and " " + unit.rstrip("]")
            sentences.append(f"{what} {value:.3g}{unit}, theirs {least:g} to {most:g}{unit}")
    return sentences


def presetOf(args, properties):
    """What run.json says of the preset: None without one, or a dict with its ``name``; the
    ``overrides``, options given beside it; ``outside``, sentences on what was not measured; and
    ``promise``, :data:`PROMISE`, or None if there are any of both."""
    if not args.preset:
        return None
    outside = []
    if args.preset == "fast":
        outside = outsideOf(properties)
    elif args.preset != BOUND:
        outside = [
            "its errors were measured on the four walls of validation/trade; --accuracy 2 finds"
            " those of this run"
        ]
    promised = args.preset == "fast" and not args.overrides and not outside
    return {
        "name": args.preset,
        "overrides": args.overrides,
        "outside": outside,
        "promise": PROMISE if promised else None,
    }


def presetNote(preset):
    """What :func:`presetOf` returned, as a line to read."""
    name, promise = preset["name"], preset["promise"]
    if promise:
        return (
            f"preset {name}: of {promise['walls']} walls whose properties are like these, pushed"
            f" once, all but {promise['missed']} had their peak within"
            f" {100 * promise['peak_error']:g} % and their work within"
            f" {100 * promise['work_error']:g} % of a fine and slow run"
        )
    if name == BOUND:
        return "preset bound: limit analysis of rigid blocks alone; there is no run"
    reason = "; ".join(preset["outside"])
    if preset["overrides"]:
        reason = ", ".join(map(asOption, preset["overrides"])) + " beside it"
    elif name == "fast":
        reason = f"unlike the {PROMISE['walls']} walls on which it was measured: {reason}"
    return f"preset {name} without a promise: {reason}"
