# SPDX-License-Identifier: GPL-2.0-or-later
"""How a script goes on that was interrupted. It is read from its beginning again: commands that it
gave before the checkpoint are left out, and stages as :mod:`masonry.stages.stage` says."""

import contextlib
from typing import Any


def saidBefore(scene, word, **arguments):
    """Note a command that is no stage. Returns whether the run that is resumed had it before its
    checkpoint."""
    scene.script.add(word, arguments)
    if not scene.running.isResumed:
        return False
    scene.script.compare(scene.running.scriptBefore)
    return len(scene.script.commands) <= len(scene.running.scriptBefore)


def resume(scene: Any) -> Any:
    """Go on with a run that was interrupted, as from a following cell of a notebook: ``scene =
    scene.resume()``. The stage that was interrupted is carried out to its end, from the checkpoint
    that the interruption left.

    Every command of the scene is given again, as ``--resume`` of a script does it, so the result is
    the same to the last bit. Of a search that the script makes by itself or by :meth:`bracket`,
    this is the step that was interrupted.

    :returns: a new scene, with the folder and the targets of this one; its ``ended`` says how that
        stage ended
    :raises ValueError: if the scene was not interrupted, or left no checkpoint
    """
    if not (scene.finished and scene.running.kept):
        raise ValueError(
            f"resume: scene {scene.name} has no run that was interrupted and left a checkpoint"
        )
    arguments = scene.args.parser.parse_args(["--resume", scene.results.directory])
    resumed = type(scene)(*scene._made, arguments, **scene._settings)
    for call in scene.calls:
        with contextlib.suppress(*[ValueError] * call.refused):
            record = call.command(resumed, *call.args, **call.settings)
        if call.record is not None:  # the script knows the one that it was given before
            resumed.description.replace(record, call.record)
            resumed.calls[-1].record = call.record
    return resumed
