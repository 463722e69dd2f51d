# SPDX-License-Identifier: GPL-2.0-or-later
"""How a run ends: in order, whatever ended it, with what was computed kept."""

import contextlib
import datetime
import os
import socket
import sys

import yade.config

from .._masonry import commit, version
from ..model import threads
from ..numbers.columns import meanings
from ..background import refuseScript, reportRefusal
from ..errors import Collapsed, Interrupted, Refused, Unwritable
from ..terminal import say
from ..memory import FULL
from .checkpoints import NAME
from .presets import presetNote

OFF = 0.01  # of the work done: a larger error of the energy balance is a warning
DATE = "%Y-%m-%dT%H:%M:%SZ"  # of the end of a run, in run.json


def end(run, scene, error):
    """Finish a run in order after an error, or after None. Returns whether the error is dealt with;
    another one is for the caller when the results are finished.

    ``run.status`` is then the exit status of the scene: 0 at the end; 1 if a file cannot be
    written, the memory is too small, or the structure has fallen while its dead loads grew; 2 for
    refused input; 130 after Ctrl-C or SIGTERM.
    """
    try:
        return _end(run, scene, error)
    finally:
        if scene.outcome:
            scene.outcome.drawing.end()
            scene.bounds.drop()
        run.release()


def _end(run, scene, error):
    if not run.results and not isinstance(error, Refused):
        return False
    try:
        if not error and not run.advanced:
            run.beginWriting()
    except Refused as refused:
        error = refused
    if isinstance(error, Refused) and not run.advanced:
        reportRefusal(error)
    if isinstance(error, MemoryError):
        error = Unwritable(FULL)
    if isinstance(error, Interrupted) and scene.limitAnalysisOnly and scene.bounds.entries:
        run.beginWriting()  # the bounds that were found are what was computed
    if not run.advanced:
        return _beforeSteps(run, error)
    if error and not isinstance(error, Collapsed) and run.results.earlier:
        return _keepEarlier(run, error)
    stopped = []
    try:
        with _noting(stopped):
            run.flush()
    except FloatingPointError as broken:
        error = error or broken
    if isinstance(error, Interrupted):
        say("\ninterrupted: what was computed is kept")
    elif isinstance(error, Unwritable):
        stopped.append(error)
    elif isinstance(error, Collapsed):
        run.fall(str(error))
    elif error:
        run.results.run["error"] = str(error)
        try:
            run.checkpoints.write()
            _finish(run, scene)
        except (Unwritable, MemoryError) as other:
            say(f"{other or FULL}; what was written before is kept", sys.stderr)
        raise refuseScript(error) if isinstance(error, Refused) else error
    if stopped:
        run.results.run["error"] = str(stopped[0])
    over = run.args.lean and not stopped and not run.interrupted
    kept = False
    with _noting(stopped):
        kept = not over and run.checkpoints.write()
        run.kept = kept and run.interrupted
    with _noting(stopped):
        _finish(run, scene)
        if over:
            with contextlib.suppress(OSError):
                os.remove(run.results.path(NAME))
    for text in dict.fromkeys(map(str, stopped)):
        say(f"{text}; what was written before is kept", sys.stderr)
    if kept and (stopped or run.interrupted):
        say(f"--resume {run.results.directory} goes on from here")
    fell = run.collapsed and run.context.loadsGrow
    run.status = 1 if stopped or fell else 130 if run.interrupted else 0
    return True


@contextlib.contextmanager
def _noting(stopped):
    """Let Unwritable or a full memory end a block, and add it to a list."""
    try:
        yield
    except Unwritable as unwritable:
        stopped.append(unwritable)
    except MemoryError:
        stopped.append(FULL)


def _beforeSteps(run, error):
    """End a run that has taken no step. Returns whether the error is dealt with."""
    if isinstance(error, Refused):
        run.status = 2
    elif isinstance(error, Interrupted):
        run.status = 130
        error = "interrupted before the first step: there are no new results"
    elif isinstance(error, Unwritable):
        run.status = 1
    if run.status:
        say(error, sys.stderr)
    return bool(run.status)


def _keepEarlier(run, error):
    """End without results: those of an earlier run stay. Returns as :func:`_beforeSteps`."""
    run.status = 130 if isinstance(error, Interrupted) else 1
    say(
        f"note: {'interrupted' if run.status == 130 else 'ended'} before there was a row: nothing"
        f" of this run is kept, and {run.results.directory} still has the results of an earlier one"
    )
    if isinstance(error, Unwritable):
        say(str(error), sys.stderr)
    return isinstance(error, (Interrupted, Unwritable))


def _finish(run, scene):
    """Write the last frame and run.json, also if there is no room for the frame, and report."""
    try:
        try:
            run.takeFound(True)
            if run.results.rows:
                run.frame(final=True)
        finally:
            _describe(run, scene)
            run.results.close()
    finally:
        if run.interrupted:
            scene.outcome.write(run.results.directory, wait=False)
        else:
            _unlessInterrupted(run, scene.outcome.write, "the mechanism is left out")
    if not (run.args.lean or run.interrupted):
        with contextlib.suppress(OSError):  # it is said when they are waited for
            scene.outcome.drawing.begin(run.results.directory)
    _report(run, scene)


def _unlessInterrupted(run, draw, lacking):
    """Return what ``draw`` does, unless the user interrupts it: then a sentence says what is
    lacking."""
    try:
        with run.breakable():
            return draw(run.results.directory)
    except Interrupted:
        say(f"interrupted: {lacking}")


def _describe(run, scene):
    """Fill run.json; the docstring of :mod:`masonry.run.results` lists its keys."""
    state, entries = run.state, run.results.run
    entries.update(
        scene=run.name,
        options=_options(run),
        preset=run.preset,
        preset_note=presetNote(run.preset) if run.preset else None,
        columns=meanings(scene.columns),
        versions={
            "yade": yade.config.version,
            "python": sys.version.split()[0],
            "masonry": version,
        },
        commit=commit,
        date=datetime.datetime.now(datetime.timezone.utc).strftime(DATE),
        threads=threads.allowed(),
        steps_by_threads=threads.used(),
        host=socket.gethostname(),
        **scene.outcome.describe(),
        collapsed=run.collapsed,
        interrupted=run.interrupted,
        resumed_at_s=state.resumed,
        steps=state.steps,
        stages=state.listed(),
        kinds=run.frames.kinds if run.frames else [],
        seconds={part: round(s, 3) for part, s in state.seconds.items()},
    )
    if run.results.rows:
        energy = scene.model.energy
        entries["energy_balance_error"] = energy.largestError
        entries["energy_made"] = energy.largestMade
        scene.outcome.summarise()
    if run.args.blocks == "rigid" and not scene.description.functors:
        entries["refined_joints"] = scene.model.scheme.joints.refinedJoints
    if state.steps:
        perStep = state.seconds["steps"] / state.steps
        ofOne = 1e9 * perStep / scene.model.subcontacts
        entries["microseconds_per_step"] = 1e6 * perStep
        entries["nanoseconds_per_subcontact_step"] = ofOne
    entries.update(notes=state.notes, warnings=list(_warnings(run, scene)))


def _options(run):
    options = {name: v for name, v in vars(run.args).items() if name != "saved"}
    if options.get("history"):
        options["history"] = options["history"]["text"]
    return options


def _warnings(run, scene):
    entries = run.results.run
    shares = {
        "energy_balance_error": "the energy balance is off by",
        "energy_made": "joints that open or close within a step made",
    }
    found = [(what, entries.get(name, 0)) for name, what in shares.items()]
    wrong = [f"{what} {100 * n:.1f} % of the work done" for what, n in found if n > OFF]
    if wrong:
        yield f"{', and '.join(wrong)}: a smaller --dt-fraction or --rate or more --damping helps"
    if run.results.rows:
        yield from scene.outcome.warnings(entries)


def _report(run, scene):
    entries, directory = run.results.run, run.results.directory
    if not run.args.lean and (run.results.rows or not run.interrupted):
        lacking = (
            f"the figures are not drawn; /usr/bin/python3 -m masonry_view.figures {directory} draws"
            f" them, and /usr/bin/python3 -m masonry_view.report {directory} writes the report"
        )
        with run.auxiliary("figures and report"):
            for failure in _unlessInterrupted(run, scene.outcome.drawing.draw, lacking) or ():
                run.fail(*failure)
    for sentence in entries["warnings"]:
        say(f"warning: {sentence}")
    if run.results.rows:
        for line in scene.outcome.report(entries):
            say(line)
        say(
            f"{entries['steps']:,} steps, each computed in"
            f" {entries.get('microseconds_per_step', 0):.0f} µs; the run took"
            f" {entries['wall_clock_s']:.1f} s; see {directory}"
        )
    if remark := threads.remark():
        say(remark)
    if run.preset:
        say(presetNote(run.preset))
