# SPDX-License-Identifier: GPL-2.0-or-later
"""Other processes: a :class:`Task` that a copy of this one carries out, and programs, several at a
time (:func:`carryOut`). All end when this process does."""

import contextlib
import ctypes
import math
import os
import pickle
import signal
import subprocess
import sys
import time
import traceback
from multiprocessing.connection import Pipe
from typing import Any, Callable, Iterable

from . import notebook
from .errors import Interrupted, Refused, ScriptRefused
from .terminal import say

LONGEST_POLL = 60.0  # [s]
LOOK_EVERY = 0.05  # [s] between looks at programs
PARENT_ENDS = 1  # PR_SET_PDEATHSIG of prctl
#: Variable of a :class:`Program`: number of the open file that takes why it refuses its input.
REFUSAL = "MASONRY_REFUSAL"
_refusal = int(os.environ.pop(REFUSAL, -1))  # programs that it starts have their own


class Failed(Exception):
    """A task has failed; the text says why."""


class Task:
    """Work in a copy of this process, which sees the scene as it is at that moment, takes no steps
    and ends without any clean-up. Where the system gives no process the work is done at once.

    :param work: a function without arguments that gives the ``parts`` results in turn
    """

    def __init__(self, work: Callable[[], Iterable[Any]], parts: int = 1) -> None:
        self._results: list[Any] = []
        self._parts, self._process = parts, 0
        sys.stdout.flush(), sys.stderr.flush()
        old = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
        try:
            self._reads, writes = Pipe(duplex=False)
            self._process = os.fork()
            if not self._process:
                _carryOut(work, parts, writes)
            writes.close()
        except OSError:  # no process or no file is to be had
            pass
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, old)
        if not self._process:
            self._results = [*work()]

    def ready(self, part: int = 0, seconds: float = 0.0) -> bool:
        """Whether a result is there, or will never be, after some time at most [s]."""
        until = time.monotonic() + seconds
        while len(self._results) <= part and self._process:
            rest = max(0.0, until - time.monotonic())
            if not self._reads.poll(min(rest, LONGEST_POLL)):
                if rest > LONGEST_POLL:
                    continue
                return False
            try:
                self._results.append(self._reads.recv())
            except (EOFError, OSError):
                self.end()
            if len(self._results) == self._parts:
                self.end()
        return True

    def result(self, part: int = 0) -> Any:
        """Wait for a result. Raises what the work raised, or Failed if its process has ended."""
        self.ready(part, math.inf)
        results = self._results[: part + 1]
        if results and isinstance(results[-1], BaseException):
            raise results[-1]
        if len(results) <= part:
            raise Failed("its process has ended before its time")
        return self._results[part]

    def end(self) -> None:
        """End the process, if it is there."""
        process, self._process = self._process, 0
        if process:
            self._reads.close()
            if len(self._results) < self._parts:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):
                os.waitpid(process, 0)


def _carryOut(work, parts, writes):
    try:
        os.setsid()  # Ctrl-C is for the run
        _endWithParent(signal.SIGKILL)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        try:
            for _, value in zip(range(parts), work()):
                writes.send(value)
        except BaseException as error:
            trace = traceback.format_exc()
            try:
                pickle.loads(pickle.dumps(error))
            except Exception:  # a class that cannot be sent
                error = Failed(traceback.format_exception_only(error)[-1].strip())
            if not isinstance(error, Refused):
                error.add_note(f"in a copy of the process:\n{trace}")
            writes.send(error)
    finally:
        os._exit(0)


def _endWithParent(number):
    """Let this process get a signal when the one that started it ends in any way."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PARENT_ENDS, number, 0, 0, 0)


class Program(subprocess.Popen[bytes]):
    """A program, which gets SIGTERM when this process ends or is killed. Ctrl-C is for this process
    alone, which ends the program in order. Raises OSError.

    :param log: file that takes what it says
    """

    def __init__(
        self, command: list[str], log: Any, env: dict[str, str], cwd: str | None = None
    ) -> None:
        self._refusal = open(os.memfd_create("refusal"), "rb")
        number = self._refusal.fileno()
        super().__init__(
            command,
            env={**env, REFUSAL: str(number)},
            cwd=cwd,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            start_new_session=True,
            preexec_fn=lambda: _endWithParent(signal.SIGTERM),
            pass_fds=[number],
        )

    def refusal(self) -> tuple[str, str]:
        """The class and the text of what the program has refused, or two empty texts."""
        self._refusal.seek(0)
        kind, _, reason = self._refusal.read().decode().partition("\n")
        return kind, reason


def refuseScript(refused: Refused) -> Refused:
    """Say what is refused, to the terminal and by :func:`reportRefusal`. Returns the error that
    ends a script; a cell of a notebook shows the error itself."""
    if isinstance(refused, ScriptRefused) or notebook.isHere():
        return refused
    reportRefusal(refused)
    say(refused, sys.stderr)
    return ScriptRefused(str(refused))


def reportRefusal(refused: Refused) -> None:
    """Tell the process that has started this one as a :class:`Program` what is refused."""
    if _refusal >= 0:
        with contextlib.suppress(OSError):  # a limit on the size of files
            os.pwrite(_refusal, f"{type(refused).__name__}\n{refused}".encode(), 0)


def carryOut(
    names: Iterable[Any],
    begin: Callable[[Any], Program],
    ended: Callable[[Any, Program], None],
    most: int,
    look: Callable[[], None] = lambda: None,
) -> None:
    """Run programs beside each other. An error that a function raises stops all of them.

    :param begin: starts the program of a name
    :param ended: gets the name and the program, which is over
    :param most: programs at a time
    :param look: is called about twenty times a second
    :raises Interrupted: after Ctrl-C and SIGTERM, when all programs have ended
    """
    due, running = [*names], {}
    stopped: list[int] = []
    handlers = {
        n: signal.signal(n, lambda number, frame: stopped.append(number))
        for n in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        while (due or running) and not stopped:
            while due and len(running) < most:
                name = due.pop(0)
                running[name] = begin(name)
            time.sleep(LOOK_EVERY)
            for name, process in list(running.items()):
                if process.poll() is not None:
                    del running[name]
                    ended(name, process)
            look()
        if stopped:
            raise Interrupted()
    finally:
        for process in running.values():
            with contextlib.suppress(ProcessLookupError):
                process.terminate()
        for process in running.values():
            process.wait()
        for number, handler in handlers.items():
            signal.signal(number, handler)
