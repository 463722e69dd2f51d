# SPDX-License-Identifier: GPL-2.0-or-later
"""The program beside a run that draws its figures and writes its report
(:mod:`masonry_view.postprocess`), if the wing masonry_view is there."""

import contextlib
import json
import os
import subprocess
import sys

from .. import wings
from ..background import Failed
from ..errors import Unwritable

END = b"\0"  # of the name of the folder that the program is given
#: Exit statuses of the program if figures or report cannot be written: disk or memory is full.
NO_FIGURES, NO_REPORT = 3, 4


class DrawingProgram:
    """It is started while the run goes on, and begins when it knows the folder."""

    def __init__(self):
        self._program = None
        self._begun = False  # whether it knows the folder

    def draw(self, directory):
        """Wait until the figures of a run that has ended are drawn and its report is written.
        Returns what has failed unexpectedly: pairs of a note and a traceback.

        :raises Unwritable: if disk or memory is full
        :raises masonry.background.Failed: if the program has ended before its time
        """
        try:
            self.begin(directory)
            failures = self._program.communicate()[0] if self._program else "[]"
        except OSError as error:
            raise Unwritable(f"the figures are not drawn: {error.strerror}") from None
        finally:
            status, self._begun = self.end(), False
        if status == NO_REPORT:
            raise Unwritable("the report is not written")
        if status == NO_FIGURES:
            raise Unwritable("the figures are not drawn")
        if status:
            raise Failed(f"the program that draws has ended with status {status}")
        return json.loads(failures)

    def begin(self, directory):
        """Name the folder of a run that has ended to the program, which then begins. Raises
        OSError."""
        self.start()
        if self._program and not self._begun:
            self._program.stdin.write(os.fsencode(directory) + END)
            self._program.stdin.flush()
            self._begun = True

    def start(self):
        """Start the program, which loads its libraries while the run goes on. Raises OSError."""
        if not self._program and wings.isInstalled("figures and report"):
            # -P: nothing of the present folder is run; Ctrl-C is for the run alone
            command = [sys.executable, "-P", "-m", wings.programOf("figures and report")]
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
