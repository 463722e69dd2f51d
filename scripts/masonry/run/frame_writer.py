# SPDX-License-Identifier: GPL-2.0-or-later
"""The ParaView frames of a run."""

import time

from yade import O
from yade.wrapper import MasonryVtkRecorder

from ..background import Task
from ..errors import Unwritable

#: A frame that takes longer is written beside the run [s]; the copy of the process that does it
#: takes some milliseconds.
SLOW_FRAME = 0.02


class Frames:
    """Writes frames into the folder of a run: beside the run if the last one was slow.

    :param at: :class:`masonry.run.run_state.RunState`, whose ``frames`` are the times of the frames
        that are whole or being written
    """

    def __init__(self, directory, at):
        self._at = at
        self._recorder = MasonryVtkRecorder(directory=directory)
        self._task = None  # that writes a frame beside the run
        self._took = 0.0  # the last one that the run has written itself [s]

    @property
    def kinds(self):
        """Names of the joints, by the number that frames have for them."""
        return self._recorder.kinds

    def collect(self):
        """Write the lists of frames anew. Raises RuntimeError."""
        if self._at.frames:
            self._recorder.times = self._at.frames
            self._recorder.collect()

    def add(self, final):
        """Write a frame of the scene as it stands, after :meth:`wait`; the ``final`` one is whole
        when this returns. Raises Unwritable."""
        self._recorder.times = self._at.frames
        if self._took > SLOW_FRAME and not final:
            self._task = Task(lambda: [self._write()])
            self._at.frames = [*self._at.frames, O.time]
        else:
            began = time.perf_counter()
            self._write()
            self._took = time.perf_counter() - began
            self._at.frames = list(self._recorder.times)

    def _write(self):
        try:
            self._recorder()
        except RuntimeError as error:
            raise Unwritable(str(error)) from None

    def wait(self):
        """Wait until the frame is whole that is written beside the run. Raises what has gone wrong,
        as Unwritable: then the run has gone on, and the frame is none of its frames."""
        task, self._task = self._task, None
        try:
            if task:
                task.result()
        except Exception as failed:
            *self._at.frames, lost = self._at.frames
            if not isinstance(failed, Unwritable):
                raise
            raise Unwritable(f"the frame at {lost:.6g} s is lost: {failed}") from None

    def end(self):
        """Leave the frame that is written beside the run."""
        if self._task:
            self._task.end()
