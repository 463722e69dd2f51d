# SPDX-License-Identifier: GPL-2.0-or-later
"""The ParaView frames of a run."""

import time

from yade import O
from yade.wrapper import MasonryVtkRecorder

from ..background import Task
from ..errors import Unwritable

SLOW_FRAME = 0.02  # [s] after which the next frame is written beside the run


class Frames:
    """Writes frames into the folder of a run: beside the run if the last one was slow.

    :param state: :class:`masonry.run.run_state.RunState`, which has the times of the frames that
        are whole or being written
    """

    def __init__(self, directory, state):
        self._state = state
        self._recorder = MasonryVtkRecorder(directory=directory)
        self._task = None  # that writes a frame beside the run
        self._took = 0.0  # the last one that the run has written itself [s]

    @property
    def kinds(self):
        """Names of the joints, by the number that frames have for them."""
        return self._recorder.kinds

    def collect(self):
        """Write the lists of frames anew. Raises RuntimeError."""
        if self._state.frames:
            self._recorder.times = self._state.frames
            self._recorder.collect()

    def add(self, final):
        """Write a frame, after :meth:`wait`; the ``final`` one is whole when this returns. Raises
        Unwritable."""
        self._recorder.times = self._state.frames
        if self._took > SLOW_FRAME and not final:
            self._task = Task(lambda: [self._write()])
            self._state.frames = [*self._state.frames, O.time]
        else:
            began = time.perf_counter()
            self._write()
            self._took = time.perf_counter() - began
            self._state.frames = list(self._recorder.times)

    def _write(self):
        try:
            self._recorder()
        except RuntimeError as error:
            raise Unwritable(str(error)) from None

    def wait(self):
        """Wait until the frame that is written beside the run is whole. Raises Unwritable: then it
        is lost."""
        task, self._task = self._task, None
        try:
            if task:
                task.result()
        except Exception as failed:
            *self._state.frames, lost = self._state.frames
            if not isinstance(failed, Unwritable):
                raise
            raise Unwritable(f"the frame at {lost:.6g} s is lost: {failed}") from None

    def end(self):
        """Leave the frame that is written beside the run."""
        if self._task:
            self._task.end()
