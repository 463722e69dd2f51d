# SPDX-License-Identifier: GPL-2.0-or-later
"""How a script goes on that was interrupted. It is read from its beginning again: commands that it
gave before the checkpoint are left out, and stages as :mod:`masonry.stages.stage` says."""

import contextlib
from typing import Any


def saidBefore(scene, word, **arguments):
    """Note a command that is no stage. Returns whether the script of a run that is resumed said it
    before the checkpoint."""
    scene.script.add(word, arguments)
    if not scene.running.isResumed:
        return False
    scene.script.compare(scene.running.scriptBefore)
    return len(scene.script.words) <= len(scene.running.scriptBefore)


def resume(scene: Any) -> str:
    """Go on with a run that was interrupted, as from a following cell of a notebook: the stage that
    was interrupted is carried out to its end, from the checkpoint that the interruption left.

    Every word of the scene is said again, as ``--resume`` of a script does it, so the result is the
    same to the last bit. Of a search that the script makes by itself or by :meth:`bracket`, this is
    the step that was interrupted.

    :returns: how that stage ended
    :raises ValueError: if the scene was not interrupted, or left no checkpoint
    """
    if not (scene.finished and scene.running.kept):
        raise ValueError(
            f"resume: scene {scene.name} has no run that was interrupted and left a checkpoint"
        )
    folder, calls, given = scene.results.directory, scene.calls, scene.args
    (name, *made), settings = scene._made
    arguments = given.parser.parse_args(["--resume", folder])
    vars(scene).clear()
    scene.__init__(name, *made, arguments, **settings)  # type: ignore[misc]
    ended = None
    for call in calls:
        with contextlib.suppress(*[ValueError] * call.refused):
            ended = call.word(scene, *call.args, **call.settings)
        if call.found is not None:  # the script knows the record that it gave before
            scene.description.replace(ended, call.found)
    return ended
