# SPDX-License-Identifier: GPL-2.0-or-later
"""Copies of this process: a :class:`Task` that one carries out beside a run, and programs, several
at a time (:func:`carryOut`). All end when this process does."""

import atexit
import contextlib
import ctypes
import functools
import math
import os
import pickle
import signal
import sys
import time
import traceback
from multiprocessing.connection import Pipe
from typing import Any, Callable, Iterable, Mapping

from . import notebook
from .errors import Interrupted, Refused, ScriptRefused
from .terminal import forgetNotes, say

LONGEST_POLL = 60.0  # [s]
LOOK_EVERY = 0.05  # [s] between looks at programs
PARENT_ENDS = 1  # PR_SET_PDEATHSIG of prctl
ENDING = {signal.SIGINT, signal.SIGTERM, signal.SIGUSR1}  # signals that end a process in order
_refusal: Any = None  # open file that takes why this :class:`Program` refuses its input


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
        try:
            self._reads, writes = Pipe(duplex=False)
            act = functools.partial(_carryOut, work, parts, writes)
            self._process = _copy(act, signal.SIGKILL)
            writes.close()
        except OSError:  # no process or no file is to be had
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


def _copy(act, number):
    """Let a copy of this process carry out a function, and end without any clean-up with the exit
    status that it returns. Returns the id of the copy, to which Ctrl-C does not go, and which gets
    the signal ``number`` when this process ends in any way. Raises OSError."""
    sys.stdout.flush(), sys.stderr.flush()
    old = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        process, status = os.fork(), 1
        if process:
            return process
        try:
            os.setsid()
            endWithParent(number)
            for one in ENDING:
                signal.signal(one, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_SETMASK, ())
            status = act()
        finally:
            os._exit(status)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, old)


def _carryOut(work, parts, writes):
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
    return 0


def endWithParent(number: int = signal.SIGTERM) -> None:
    """Let this process get a signal when the one that started it ends in any way."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PARENT_ENDS, number, 0, 0, 0)


class Program:
    """A program in a copy of this process, which has loaded what the program needs. It gets SIGTERM
    when this process ends or is killed; Ctrl-C is for this process alone, which ends the program in
    order. Other threads of this process are not copied. Raises OSError.

    :param act: what it does; returns its exit status, or ends as a script does
    :param log: file that takes what it says
    :param env: variables of its environment that are others than here; None: it does not have it
    :param cwd: its present folder
    """

    def __init__(
        self,
        act: Callable[[], int],
        log: Any,
        env: Mapping[str, str | None] = {},
        cwd: str | None = None,
    ) -> None:
        self._refusal = open(os.memfd_create("refusal"), "r+b")
        #: exit status, or the negative number of the signal that has ended it
        self.returncode: int | None = None
        run = functools.partial(_runProgram, act, log.fileno(), env, cwd, self._refusal)
        self.pid = _copy(run, signal.SIGTERM)

    def poll(self) -> int | None:
        """``returncode``, which is None while it goes on."""
        return self.wait(os.WNOHANG)

    def wait(self, how: int = 0) -> int | None:
        if self.returncode is None:
            process, status = os.waitpid(self.pid, how)
            if process:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.returncode is None:
            os.kill(self.pid, number)

    def refusal(self) -> tuple[str, str]:
        """The class and the text of what the program has refused, or two empty texts."""
        self._refusal.seek(0)
        kind, _, reason = self._refusal.read().decode().partition("\n")
        return kind, reason


def _runProgram(act, log, env, cwd, refusal):
    """Carry out a function as a program that has just started. Returns its exit status."""
    global _refusal
    _refusal = refusal
    for number, file in enumerate((os.open(os.devnull, os.O_RDONLY), log, log)):
        os.dup2(file, number)
    how = dict(buffering=1, errors="backslashreplace", closefd=False)
    sys.stdout, sys.stderr = (open(number, "w", **how) for number in (1, 2))
    atexit._clear()
    forgetNotes()
    for name, value in env.items():
        os.environ.pop(name, None)
        if value is not None:
            os.environ[name] = value
    try:
        if cwd:
            os.chdir(cwd)
        status = act()
    except SystemExit as end:
        status = end.code or 0
        if not isinstance(status, int):
            say(status, sys.stderr)
            status = 1
    except BaseException:
        traceback.print_exc()
        status = 1
    atexit._run_exitfuncs()
    return status


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
    if _refusal:
        with contextlib.suppress(OSError):  # a limit on the size of files
            text = f"{type(refused).__name__}\n{refused}"
            os.pwrite(_refusal.fileno(), text.encode(), 0)


def carryOut(
    names: Iterable[Any],
    begin: Callable[[Any], Any],
    ended: Callable[[Any, Any], None],
    most: int,
    look: Callable[[], None] = lambda: None,
) -> None:
    """Run programs beside each other. An error that a function raises stops all of them.

    :param begin: starts the program of a name: a :class:`Program`, or one of ``subprocess``
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
            process.send_signal(signal.SIGTERM)
        for process in running.values():
            process.wait()
        for number, handler in handlers.items():
            signal.signal(number, handler)
