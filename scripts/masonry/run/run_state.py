# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a run has come, as plain data."""

from dataclasses import dataclass, field

MAX_NOTES = 1000  # that a run keeps
PARTS = "setup", "steps", "rows", "frames"  # of a run's time


@dataclass
class RunState:
    """How far a run has come, beside the state of the scene."""

    #: The state of the scene in Python at the beginning of the present stage and at the checkpoint:
    #: :func:`masonry.run.checkpoints.stateOf`.
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
    #: Of every stage so far: ``stage``, its name, ``steps`` and ``seconds`` that were taken before
    #: it, and the number ``first_row`` of its first row.
    stages: list = field(default_factory=list)
    seconds: dict = field(default_factory=lambda: dict.fromkeys(PARTS, 0.0))
    frames: list = field(default_factory=list)  # times of the ParaView frames [s]
    origins: dict = field(default_factory=dict)  # where pushes began, by their name
    #: Of the pushes, by the numbers of their stages: the first period when it began [s], the weight
    #: of the base in its shear force [-], and the time at which its velocity had grown [s]; 0 where
    #: that was not found.
    freeVibrations: dict = field(default_factory=dict)
    bounds: dict = field(default_factory=dict)  # what limit analysis found, by the load
    #: Load factors under which the structure came to rest, by the names of their bounds.
    held: dict = field(default_factory=dict)
    #: What stages pushed or put on, by their numbers: the kind, "push", "lean" or "growth", the
    #: name of the load and that of the opposite one; and the target whose displacement is counted,
    #: where it is not what is pushed.
    loads: dict = field(default_factory=dict)
    #: Of the pushes, by their numbers: whether displacements count on from the one before, and
    #: whether it follows a history.
    paths: dict = field(default_factory=dict)
    #: How stages ended, by their numbers, and the number of the last stage then: a stage may
    #: consist of several.
    ended: dict = field(default_factory=dict)
    fall: str = ""  # what has fallen, as in Run.fall
    #: What acted in addition to a load, and held the structure when its bound was found, by the
    #: load.
    auxiliary: dict = field(default_factory=dict)
    atRest: str = ""  # the last state at rest, as text, for stepBack()
    places: list = field(default_factory=list)  # masonry.model.motion.Motion.places
    far: float = 0.0  # masonry.model.motion.Motion.far
    answers: dict = field(default_factory=dict)  # by the keys of masonry.stages.answers.keep
    notes: list = field(default_factory=list)  # what the run said, as in run.json
    overestimate: float = 0.0  # by joints with three points, as a note has said it last [-]
    supportsMoved: bool = False  # whether a stage has moved supports
    #: When the widest crack was looked for last, and its width: number of the time step, and [mm].
    widest: list = field(default_factory=list)
    resumed: list = field(
        default_factory=list
    )  # times in the scene at which the run was resumed [s]

    def recordNote(self, text, number, time_s):
        """Keep what the run said in the stage of a number, unless it has said it before."""
        stage = self.stages[number - 1]["stage"] if 0 < number <= len(self.stages) else ""
        note = dict(stage=stage, number=number, time_s=time_s, text=text)
        known = {one["text"] for one in self.notes}
        if text not in known and len(self.notes) < MAX_NOTES:
            self.notes = [*self.notes, note]

    def listed(self):
        listed, end = [], dict(steps=self.steps, seconds=self.seconds["steps"])
        for number, (one, after) in enumerate(zip(self.stages, [*self.stages[1:], end]), 1):
            taken = {key: after[key] - one[key] for key in ("steps", "seconds")}
            load, continued = self.loads.get(str(number)), self._continues(number)
            listed.append({**one, **taken, "load": load, "continued": continued})
        return listed

    def _continues(self, number):
        """Whether a push goes on with the curve of the one before: both follow a history, or none
        of them."""
        before = max((n for n in map(int, self.paths) if n < number), default=0)
        continued, looped = self.paths.get(str(number), (False, False))
        return bool(continued and before and looped == self.paths[str(before)][1])


@dataclass
class StageContext:
    """What a run knows of the stage that is carried out."""

    endsAtFall: bool = False  # the run ends when a block has fallen, though a collapse is followed
    loadsGrow: bool = False  # dead loads grow: the test has not begun
