# SPDX-License-Identifier: GPL-2.0-or-later
"""The program beside a run that draws its figures and writes its report:
:mod:`masonry.read.postprocess`."""

import contextlib
import json
import os
import subprocess
import sys

from ..basics import Unwritable
from ..common.background import Failed
from ..read import postprocess


class DrawingProgram:
    """It is started while the run goes on, and begins when it knows the folder."""

    def __init__(self):
        self._program = None
        self._begun = False  # whether it knows the folder

    def draw(self, directory):
        """Wait until the figures of a run that has ended are drawn and its report is written.
        Without matplotlib the program says that the figures are left out.

        :returns: what has failed unexpectedly: pairs of a note and a traceback
        :raises Unwritable: if disk or memory is full
        :raises Failed: if the program has ended before its time
        """
        try:
            self.begin(directory)
            failures, _ = self._program.communicate()
        except OSError as error:
            raise Unwritable(f"the figures are not drawn: {error.strerror}") from None
        finally:
            status, self._begun = self.end(), False
        if status == postprocess.NO_REPORT:
            raise Unwritable("the report is not written")
        if status == postprocess.NO_FIGURES:
            raise Unwritable("the figures are not drawn")
        if status:
            raise Failed(f"the program that draws has ended with status {status}")
        return json.loads(failures)

    def begin(self, directory):
        """Name the folder to the program, which then begins; the report waits until :meth:`draw` is
        called, because figures that the run itself writes stand in it. Raises OSError if there is
        no process."""
        if not self._begun:
            self.start()
            self._program.stdin.write(os.fsencode(directory) + postprocess.END)
            self._program.stdin.flush()
            self._begun = True

    def start(self):
        """Start the program, which loads its libraries while the run goes on. Raises OSError if
        there is no process."""
        if not self._program:
            # -P: nothing of the present folder is run; in a session of its own, since Ctrl-C is for
            # the run
            command = [sys.executable, "-P", "-m", "masonry.read.postprocess"]
            self._program = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
            )

    def end(self):
        """End the program. Returns its exit status, or None if it was not started."""
        program, self._program = self._program, None
        if not program:
            return None
        if program.poll() is None:
            program.kill()
        status = program.wait()
        with contextlib.suppress(OSError):
            program.stdin.close()
        program.stdout.close()
        return status
