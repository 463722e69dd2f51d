# SPDX-License-Identifier: GPL-2.0-or-later
"""The process that solves the linear programmes of limit analysis.

A solver cannot be interrupted from Python while it works. In a process of its own it can be ended at any moment: by
Ctrl-C or SIGTERM, when its time is over, and when it fails. It is started once, and solves all programmes of a run.
"""

import atexit
import contextlib
import os
import select
import subprocess
import sys
import time

import numpy as np

from .. import memory
from ..basics import Refused
from . import solver

LIBRARY = "libClp.so.1"
GRACE = 1.0  # so much later than the solver itself its process is ended [s]
PIECE = 1 << 16  # bytes that are read or written at once


class Ended(Exception):
    """The time of the process was over, and it was ended."""


class Worker:
    """The process, which is started when it is first needed."""

    def __init__(self):
        self._process = self._owner = None

    def start(self):
        """Start the process, if it does not run. Raises Refused with the reason if it cannot be started."""
        if self._process and self._owner == os.getpid():
            if self._process.poll() is None:
                return
            self.end()
        # -I: nothing of the present folder is run; -S: it starts sooner
        command = [sys.executable, "-I", "-S", solver.__file__]
        command += [LIBRARY, str(memory.BUFFER)]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                bufsize=0,
                start_new_session=True,  # Ctrl-C is for the run
            )
        except (OSError, subprocess.SubprocessError, MemoryError) as error:
            self._process = None
            why = getattr(error, "strerror", None) or error or "too little memory"
            raise Refused(
                f"limit analysis: the process of its solver cannot be started: {why}"
            ) from None
        self._owner = os.getpid()
        for stream in (self._process.stdin, self._process.stdout):
            os.set_blocking(stream.fileno(), False)

    def end(self):
        """End the process, if it runs."""
        process, self._process = self._process, None
        if process and self._owner == os.getpid():
            process.kill()
            process.wait()
            for stream in (process.stdin, process.stdout):
                with contextlib.suppress(OSError):
                    stream.close()

    def solve(self, head, arrays):
        """Let it solve a programme.

        :param head: numbers by the names of :data:`masonry.limit.solver.HEAD`
        :param arrays: as :func:`masonry.limit.solver.sizes` lists them
        :returns: the word of the answer, its text and its bytes
        :raises Ended: if its time is over
        :raises Refused: if the process cannot be started, or has failed
        """
        self.start()
        line = " ".join(str(head[name]) for name in solver.HEAD) + "\n"
        ask = [line.encode(), *(memoryview(a).cast("B") for a in arrays)]
        try:
            found = self._exchange(ask, time.monotonic() + head["seconds"] + GRACE)
        except BaseException:  # whatever ends it: its answer would be for another one
            self.end()
            raise
        if found[0] == "failed":
            raise Refused(f"limit analysis: {found[1]}")
        return found

    def _exchange(self, ask, until):
        """Write a programme, and read the answer, until some moment of time.monotonic()."""
        for piece in ask:
            while piece:
                self._until(until, self._process.stdin, writes=True)
                try:
                    piece = piece[os.write(self._process.stdin.fileno(), piece[:PIECE]) :]  # fmt: skip
                except BrokenPipeError:
                    raise self._failed() from None
        data = b""
        while b"\n" not in data:
            data += self._read(until)
        line, _, data = data.partition(b"\n")
        word, size, text = line.decode().split(" ", 2)
        parts, missing = [data], int(size) - len(data)
        while missing > 0:
            parts.append(self._read(until))
            missing -= len(parts[-1])
        return word, text, b"".join(parts)

    def _read(self, until):
        self._until(until, self._process.stdout)
        data = os.read(self._process.stdout.fileno(), PIECE)
        if not data:
            raise self._failed()
        return data

    def _until(self, until, stream, writes=False):
        """Look until a stream can be read or written. Raises Ended."""
        seconds = max(0.0, until - time.monotonic())
        poll = select.poll()
        poll.register(stream, select.POLLOUT if writes else select.POLLIN)
        if not poll.poll(1e3 * min(seconds, solver.FOREVER / 1e3)):
            raise Ended

    def _failed(self):
        status = self._process.wait()
        why = f"signal {-status}" if status < 0 else f"status {status}"
        return Refused(f"limit analysis: the process of its solver ended with {why}")


worker = Worker()
atexit.register(worker.end)


def solve(whole, equations, low, high, cost, rows, seconds):
    """Solve a linear programme in the process.

    :param whole: its matrix, whose first rows are equations and whose others are limits (csc)
    :param equations: how many rows are equations
    :param low: least value of each variable; ``high``: largest; ``cost``: what is made as small as possible
    :param rows: right-hand sides
    :param seconds: time that it may take
    :returns: the word of the answer, its text, the variables, and the multipliers of the equations
    """
    double = lambda values: np.ascontiguousarray(values, np.float64)
    least = double(rows).copy()
    least[equations:] = -np.inf
    integers = [np.ascontiguousarray(a, np.int32) for a in (whole.indptr, whole.indices)]  # fmt: skip
    arrays = [*integers, *map(double, (whole.data, low, high, cost, least, rows))]
    counts = (whole.shape[0], equations, whole.shape[1], whole.nnz)
    head = dict(zip(solver.HEAD, (*counts, min(seconds, solver.FOREVER))))
    word, text, data = worker.solve(head, arrays)
    return word, text, *np.split(np.frombuffer(data), [whole.shape[1] * bool(data)])
