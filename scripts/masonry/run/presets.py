# SPDX-License-Identifier: GPL-2.0-or-later
"""Presets of options that trade accuracy for time, and what each promises. This module needs no YADE."""

#: The options that a preset chooses, as they are without one. A scene may have another rate.
USUAL = {
    "blocks": "rigid",
    "divisions": 1,
    "subcontacts": 3,
    "rate": 20.0,
    "damping": 0.8,
    "damping_kind": "combined",
    "dt_fraction": 0.8,
}

#: Options by preset, the same for all walls. A scene of one's own may take them from here.
PRESETS = {
    "fast": {
        "blocks": "rigid",
        "divisions": 1,
        "subcontacts": 3,
        "rate": 100.0,
    },
    "balanced": {"blocks": "deformable", "divisions": 2, "rate": 100.0},
    "accurate": {"blocks": "deformable", "divisions": 2, "rate": 50.0},
}
for _preset in PRESETS.values():
    _preset.update(damping=0.8, damping_kind="combined", dt_fraction=0.8)

#: The preset of limit analysis alone, without a run: see masonry.limit.
BOUND = "bound"

#: What a preset promises. ``peak_error`` and ``work_error`` are the most that the peak and the work over the push
#: differ from those of a fine and slow run [-]. ``walls`` has how far each wall was pushed for that [mm], and the time
#: that it takes with ``yade -j2`` on two idle server cores [s]. validation/trade measures all of them.
PROMISES = {
    "fast": {
        "peak_error": 0.03,
        "work_error": 0.04,
        "walls": {
            "wall_comp0a": (30, 8),
            "wall_comp1": (30, 8),
            "wall_comp4": (12, 8),
            "wall_comp6": (16, 9),
        },
    },
    "balanced": {
        "peak_error": 0.02,
        "work_error": 0.04,
        "walls": {
            "wall_comp0a": (30, 30),
            "wall_comp1": (30, 30),
            "wall_comp4": (12, 40),
            "wall_comp6": (16, 50),
        },
    },
    "accurate": {
        "peak_error": 0.02,
        "work_error": 0.02,
        "walls": {
            "wall_comp0a": (30, 60),
            "wall_comp1": (30, 60),
            "wall_comp4": (12, 90),
            "wall_comp6": (16, 120),
        },
    },
}

#: Options that leave a preset's promise alone.
HARMLESS = {
    "preset",
    "until",
    "out",
    "vtk_every",
    "no_vtk",
    "checkpoint_every",
    "lean",
}


def asOption(name):
    """The name of an option as the user writes it."""
    return "--" + name.replace("_", "-")


def presetOf(args, scene):
    """What run.json says of the preset: None without one, or a dict.

    ``name`` is the preset's. ``overrides`` are options given beside it. ``promise`` is None if there are any, or if the
    scene is none of those that the promise was measured on. Else it holds ``peak_error`` and ``work_error`` [-],
    ``until_mm`` and ``seconds``.

    :param args: the parsed options
    :param scene: name of the scene
    """
    if not args.preset:
        return None
    known, promise = PROMISES.get(args.preset), None
    if known and not args.overrides and scene in known["walls"]:
        until, seconds = known["walls"][scene]
        promise = {name: known[name] for name in ("peak_error", "work_error")}
        promise.update(until_mm=until, seconds=seconds)
    return {"name": args.preset, "overrides": args.overrides, "promise": promise}


def presetNote(preset, scene):
    """What :func:`presetOf` returned, as a line to read."""
    name, promise = preset["name"], preset["promise"]
    if promise:
        return (
            f"preset {name}: promises the peak within {100 * promise['peak_error']:g} % and the work over "
            f"{promise['until_mm']:g} mm within {100 * promise['work_error']:g} % of a fine and slow run, "
            f"in about {promise['seconds']:g} s"
        )
    if name == BOUND:
        return "preset bound: limit analysis of rigid blocks alone; there is no run"
    reason = f"not measured on {scene}"
    if preset["overrides"]:
        reason = ", ".join(map(asOption, preset["overrides"])) + " beside it"
    return f"preset {name} without its promise: {reason}"
