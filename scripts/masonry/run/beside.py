# SPDX-License-Identifier: GPL-2.0-or-later
"""Work beside a run: a copy of the process does it while the run takes its next steps.

The copy begins with the scene as it is at that moment, so nothing need be packed for it, and what the run does then does not
change what the copy sees. It takes no steps, ends without any clean-up, and ends when the process of the run does.
Where the system gives no process the work is done at once instead.
"""

import contextlib
import ctypes
import math
import os
import pickle
import select
import signal
import sys
import time
import traceback

from .results import Lock

LONGEST = 60.0  # [s] that is waited for at once
PARENT_ENDS = 1  # PR_SET_PDEATHSIG of prctl


class Failed(Exception):
    """A work beside the run has failed; the text says why."""


class Job:
    """A work beside a run. It is a generator without arguments: what it yields can be had from :meth:`result`, one after the other.

    :param work: a function that gives such a generator
    :param parts: how often it yields
    """

    def __init__(self, work, parts=1):
        self._found, self._process = [], None
        self._files = [os.memfd_create("beside", os.MFD_CLOEXEC) for _ in range(parts)]
        self._reads, writes = os.pipe2(os.O_CLOEXEC)
        sys.stdout.flush(), sys.stderr.flush()
        old = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
        try:
            self._process = os.fork()
            if not self._process:
                _carryOut(work, self._files, self._reads, writes)
        except OSError:  # no process is to be had
            self._found = [*work()]
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, old)
            os.close(writes)
        if not self._process:
            self.end()

    def ready(self, part=0, seconds=0.0):
        """Whether a result is there, or will never be, within some time [s]."""
        until = time.monotonic() + seconds
        while len(self._found) <= part and self._process:
            poll = select.poll()
            poll.register(self._reads, select.POLLIN)
            rest = max(0.0, until - time.monotonic())
            if not poll.poll(1e3 * min(rest, LONGEST)):
                if rest > LONGEST:
                    continue
                return False
            if os.read(self._reads, 1):
                with open(self._files[len(self._found)], "rb", closefd=False) as file:
                    file.seek(0)
                    self._found.append(pickle.load(file))
                if len(self._found) == len(self._files):
                    self.end()
            else:
                self.end()
        return True

    def result(self, part=0):
        """A result; it is waited for. Raises what the work raised, or Failed if its process has ended without it."""
        self.ready(part, math.inf)
        found = self._found[-1] if self._found else None
        if isinstance(found, BaseException):
            raise found
        if len(self._found) <= part:
            raise Failed("its process has ended before its time")
        return self._found[part]

    def end(self):
        """End the process, if it is there."""
        process, self._process = self._process, None
        if process:
            if len(self._found) < len(self._files):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):
                os.waitpid(process, 0)
        for number in [self._reads, *self._files] if self._files else []:
            os.close(number)
        self._files, self._reads = [], None


def _carryOut(work, files, reads, writes):
    """Do the work in the copy of the process, which ends here."""
    try:
        os.setsid()  # Ctrl-C is for the run
        with contextlib.suppress(AttributeError, OSError):
            ctypes.CDLL(None).prctl(PARENT_ENDS, signal.SIGKILL)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        os.close(reads)
        Lock.forget()  # others may have the folder when the run ends
        results = work()
        for number in files:
            try:
                found = next(results)
                data = pickle.dumps(found)
            except BaseException as error:
                found = error
                try:
                    data = pickle.dumps(error)
                except Exception:
                    data = pickle.dumps(Failed(traceback.format_exception_only(error)[-1].strip()))  # fmt: skip
            _writeAll(number, data)
            os.write(writes, b"1")
            if isinstance(found, BaseException):
                break
    finally:
        os._exit(0)


def _writeAll(number, data):
    """Write bytes to a file, however many they are."""
    data = memoryview(data)
    while data:
        data = data[os.write(number, data) :]
