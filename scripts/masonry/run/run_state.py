# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a run has come, and what a checkpoint on disk tells of it."""

import os
from dataclasses import dataclass, field, fields

from .._masonry import loadScene
from ..errors import NotResumed
from ..terminal import say
from .checkpoints import NAME, alike, readState

MOST_NOTES = 1000  # that a run keeps
PARTS = "setup", "steps", "rows", "frames"  # of a run's time


def _holding(kind, example):
    """A field that is a list or a dict, whose values are like an example: see
    :func:`masonry.run.checkpoints.alike`."""
    return field(default_factory=kind, metadata={"example": example})


@dataclass
class RunState:
    """How far a run has come, beside the state of the scene."""

    #: What the scene is at the beginning of the present stage and at the checkpoint, beside its
    #: state in YADE, as :func:`masonry.scene.resuming.stateOf` gives it.
    before: dict = field(default_factory=dict)
    now: dict = field(default_factory=dict)
    begun: int = 0  # number of the stage whose beginning ``before`` is
    number: int = 0  # of the present stage, from 1
    stage: str = ""  # its name
    memory: dict = field(default_factory=dict)  # what the stage must know to go on
    steps: int = 0  # taken so far
    left: int = 0  # of the present advance that are not taken yet
    rows: int = 0  # of curve.csv when the memory was as it is here
    frameCount: int = 0  # ParaView frames then
    #: Of every stage so far: its name, and the steps, their seconds of wall-clock time and the rows
    #: before it.
    stages: list = _holding(list, ["", 0, 0.0, 0])
    seconds: dict = _holding(lambda: dict.fromkeys(PARTS, 0.0), 0.0)
    frames: list = _holding(list, 0.0)  # times of the ParaView frames [s]
    origins: dict = _holding(dict, None)  # where pushes began, by their name
    #: Of the pushes, by the numbers of their stages: the first period when it began [s], the weight
    #: of the base in its shear force [-], and the time at which its velocity had grown [s]; 0 where
    #: that was not found.
    freeVibrations: dict = _holding(dict, [0.0] * 3)
    bounds: dict = _holding(dict, {})  # what limit analysis found, by the load
    #: Load factors under which the structure came to rest, by the names of their bounds.
    held: dict = _holding(dict, 0.0)
    #: What stages pushed or put on, by their numbers: the kind, "push", "lean" or "growth", the
    #: name of the load and that of the opposite one; and the target whose displacement is counted,
    #: where it is not what is pushed.
    loads: dict = _holding(dict, [])
    #: How stages ended, by their numbers, and the number of the last stage then: a stage may
    #: consist of several.
    ended: dict = _holding(dict, ["", 0])
    fall: str = ""  # what has fallen, as in Run.fall
    #: What acted beside a load and held the structure when its bound was found, by the load.
    beside: dict = field(default_factory=dict)
    atRest: str = ""  # the last state at rest, as text, for stepBack()
    places: list = _holding(list, 0.0)  # of masonry.model.motion.Motion
    far: float = 0.0  # likewise
    answers: dict = _holding(dict, [])  # of the stages, by their number
    notes: list = _holding(list, {})  # what the run said, as in run.json
    supportsMoved: bool = False  # whether a stage has moved supports
    #: When the widest crack was looked for last, and its width: number of the time step, and [mm].
    widest: list = _holding(list, 0.0)
    resumed: list = _holding(list, 0.0)  # times at which it was taken up [s]

    def hear(self, text, number, time_s):
        """Keep what the run said in the stage of a number, unless it has said it before."""
        stage = self.stages[number - 1][0] if 0 < number <= len(self.stages) else ""
        note = dict(stage=stage, number=number, time_s=time_s, text=text)
        known = {one["text"] for one in self.notes}
        if text not in known and len(self.notes) < MOST_NOTES:
            self.notes = [*self.notes, note]

    def listed(self):
        """The entry ``stages`` of run.json."""
        listed, ends = [], [
            *self.stages[1:],
            ["", self.steps, self.seconds["steps"], 0],
        ]
        for (name, steps, seconds, row), (_, after, secondsAfter, _) in zip(self.stages, ends):
            entry = dict(stage=name, steps=after - steps, seconds=secondsAfter - seconds)
            load = self.loads.get(str(len(listed) + 1))
            listed.append({**entry, "first_row": row, "load": load})
        return listed


def otherVersion(why):
    """The refusal of a checkpoint that this version of the plugin does not leave."""
    return NotResumed(f"--resume: of another version of the plugin: {why}")


def restored(example, values):
    """A dataclass object with the values of a checkpoint. Raises Refused if these are not of the
    kind of the example's."""
    before = vars(example)
    fits = lambda name: name in before and alike(values[name], before[name])
    _refuseUnlike(name for name in values if not fits(name))
    return type(example)(**{**before, **values})


def _refuseUnlike(names):
    if wrong := ", ".join(names):
        raise otherVersion(f"its {wrong}")


class Saved:
    """A checkpoint that a run left, read from the disk once.

    - ``scene``: name of the scene; ``options``: those of the run; ``script``: what its script said,
      as data
    - ``at``: how far the run had come, as in :class:`RunState`; ``rows`` of curve.csv
    - ``seconds`` of wall-clock time; ``host``: what it was made with, as in
      :func:`masonry.run.keeping.hostNow`

    :raises Refused: if no run can be taken up there
    """

    def __init__(self, directory):
        self.directory = directory
        try:
            self._data, saved = readState(os.path.join(directory, NAME))
        except FileNotFoundError:
            raise NotResumed(
                f"--resume: {directory} has no {NAME}, which a run leaves unless it is --lean and"
                " has come to its end"
            ) from None
        except (OSError, ValueError) as error:
            raise NotResumed(f"--resume: {error}") from None
        like = dict(scene="", options={}, at={}, rows=[], script=[], host={})
        like["seconds"] = 0.0
        if (
            not isinstance(saved, dict)
            or not all(alike(saved.get(key), value) for key, value in like.items())
            or not all(alike(row, [0.0] * len(row)) for row in saved["rows"])
            or not all(alike(word, ["", {}]) for word in saved["script"])
        ):
            raise NotResumed(f"--resume: {directory}/{NAME} was not left by a run in stages")
        vars(self).update({key: saved[key] for key in like})

    def place(self):
        """How far the run had come: a :class:`RunState`. Raises Refused."""
        at = restored(RunState(), self.at)
        values = lambda held: held.values() if isinstance(held, dict) else held
        _refuseUnlike(
            one.name
            for one in fields(at)
            for example in one.metadata.values()
            if not all(alike(v, example) for v in values(getattr(at, one.name)))
        )
        return at

    def load(self):
        """Give the scene, built by the same script, the state of the checkpoint. Raises Refused."""
        try:
            loadScene(self._data)
        except (ValueError, TypeError) as error:
            raise NotResumed(f"--resume: {self.directory}/{NAME} {error}") from None

    def compareHost(self, now):
        """Say what of the host is not as it was."""
        for what, value in now.items():
            if self.host.get(what) != value:
                say(
                    f"note: the checkpoint was made with {what} {self.host.get(what)}, this run has"
                    f" {value}: it may differ in last digits from one without a break"
                )
