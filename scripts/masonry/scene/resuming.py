# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run that is resumed finds in place of the stages that were over.

A script is read from its beginning again. Commands that it gave before the checkpoint are left out:
a stage that was over returns what it returned then. The stage in which the checkpoint was made
begins with the state of the scene in Python at its beginning, and takes its first steps from the
state of the checkpoint: see :mod:`masonry.run.run`. YADE keeps the rest of the state:
:func:`masonry.saveCheckpoint`.
"""

import base64
import contextlib
from types import SimpleNamespace
from typing import Any

from ..run.checkpoints import alike
from ..run.run_state import otherVersion
from .script import PUSHES, asData


def stateOf(scene):
    """What stages have set of a scene, beside what YADE keeps, as JSON can hold it."""
    of = ("until", "history", "rate") if scene.pushed else ()
    return {
        "model": scene.model.state(),
        "grown": scene.grown,
        "loadUnit": scene.loadUnit,
        "pushed": {name: getattr(scene.pushed, name) for name in of},
    }


def putState(scene, state):
    """Give a scene a state of :func:`stateOf`. Raises Refused if it has other entries."""
    like = stateOf(scene)
    like["model"]["said"] = []  # any number of events of ties
    if not (_alike(state, like) and _alike(state["model"], like["model"])):
        raise otherVersion("the state of the scene")
    scene.model.putState(state["model"])
    scene.grown, scene.loadUnit = state["grown"], state["loadUnit"]
    pushed = state["pushed"]
    scene.pushed = SimpleNamespace(**{**vars(scene.args), **pushed}) if pushed else None


def _alike(state, like):
    return state.keys() == like.keys() and all(alike(state[n], like[n]) for n in like)


class State:
    """What a checkpoint keeps of a scene that is built, beside its state in YADE."""

    def __init__(self, scene):
        self._scene, self._model = scene, scene.model
        self._rest = None, ""  # the last state at rest, and its text
        self.restored = False  # the scene has the state of a checkpoint again

    def kept(self):
        """Entries of :class:`masonry.run.run_state.RunState`."""
        atRest, motion = self._model.atRest, self._model.motion
        if atRest is not self._rest[0]:
            self._rest = atRest, base64.b64encode(atRest).decode()
        of = {"places": motion.places, "far": motion.far}
        return {"now": stateOf(self._scene), "atRest": self._rest[1], **of}

    def put(self, state):
        """Give the scene the state of a checkpoint."""
        putState(self._scene, state)
        self.restored = True

    def takeRest(self, at):
        """Take the last state at rest from a :class:`masonry.run.run_state.RunState`."""
        if at.atRest:
            self._model.atRest = base64.b64decode(at.atRest)
        self._model.motion.places, self._model.motion.far = at.places, at.far


def enter(scene, number, farther):
    """Begin a stage. Returns how it ended if it was over before the run was resumed and is left
    out, else None.

    :param number: of the stage
    :param farther: whether the script lets it go farther now, so that the last stage continues
    """
    running, at = scene.running, scene.running.at
    if running.takesUp and not running.redoes:
        ended, last = at.ended.get(str(number), (None, 0))
        farther = number == at.begun and (farther or _optionsDiffer(scene))
        if ended and not farther:
            running.entered = last
            running.continueFrom(last + 1, False)
            return ended
        redoes = number == at.begun
        running.continueFrom(number, redoes)
        if not running.state.restored:
            running.state.put(at.before if redoes else at.now)
    at.begun, at.before = number, stateOf(scene)
    return None


def _optionsDiffer(scene):
    """Whether the command line gives another end to the push of the checkpoint."""
    was, now = scene.running.saved.options, asData(vars(scene.args))
    differs = any(was.get(name) != now[name] for name in ("until", "history"))
    return differs and scene.script.isFirst(PUSHES)


def saidBefore(scene, word, **arguments):
    """Note a command that is no stage. Returns whether the run that is resumed had it before its
    checkpoint."""
    scene.script.add(word, arguments)
    if not scene.running.takesUp:
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

    :returns: a new scene, which goes on with the folder and the targets of this one; its ``ended``
        says how that stage ended
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
