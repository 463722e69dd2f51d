# SPDX-License-Identifier: GPL-2.0-or-later
"""curve.csv and run.json of a run, read again; :mod:`masonry.run.results` lists what is in them. This module needs no YADE."""

from __future__ import annotations

import contextlib
import csv
import errno
import math
import os
import stat
import sys
from typing import Any, Callable, Iterator, Sequence

from .. import memory
from ..arguments import FilePath
from ..basics import Refused, say
from ..folders import fromJson


def readWhole(path: FilePath, sizeOf: Callable[[bytes], int] | None = None) -> bytes:
    """The bytes of a file. Raises OSError for what is no file, too: a pipe never ends, and a device has no end.

    :param sizeOf: function of the first 64 bytes that gives how many the file should have; of a longer one, which may be
        an endless hole, one byte more is read. Never more is asked of the memory than the file has
    """
    number = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with open(number, "rb") as f:
        found = os.fstat(number)
        if not stat.S_ISREG(found.st_mode):
            raise OSError(errno.EINVAL, "it is no regular file", path)
        head = f.read(64)
        if not sizeOf:
            return head + f.read()
        return head + f.read(max(0, min(sizeOf(head) + 1, found.st_size) - len(head)))


def _read(path):
    """Text of a file of a run."""
    try:
        return readWhole(path).decode()
    except OSError as error:
        raise Refused(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise Refused(f"cannot read {path}: it is no text") from None


def readCurve(directory: FilePath) -> dict[str, list[float]]:
    """curve.csv of a run as a dict of column name -> list of numbers. Raises Refused if there is none."""
    path = os.path.join(directory, "curve.csv")
    lines = list(csv.reader(_read(path).splitlines()))
    if len(lines) < 2:
        raise Refused(f"{path}: there is no row of numbers")
    columns, rows, problems = lines[0], [], []
    for number, line in enumerate(lines[1:], start=2):
        try:
            rows.append([float(v) for v in line])
        except ValueError as error:
            problems.append(f"{path}, line {number}: {error}")
        else:
            if len(line) != len(columns):
                problems.append(
                    f"{path}, line {number}: {len(line)} numbers in {len(columns)} columns"
                )
            elif not all(map(math.isfinite, rows[-1])):
                problems.append(f"{path}, line {number}: a number is not finite")
    if problems:
        raise Refused("\n".join(problems[:10]))
    return {c: [row[i] for row in rows] for i, c in enumerate(columns)}


def readRun(directory: FilePath) -> dict[str, Any]:
    """run.json of a run as a dict; this module's docstring lists its keys. Raises Refused if there is none."""
    path = os.path.join(directory, "run.json")
    try:
        run = fromJson(_read(path))
    except ValueError as error:
        if isinstance(error, Refused):
            raise
        raise Refused(f"{path}: {error}") from None
    if not isinstance(run, dict):
        raise Refused(f"{path}: is no record of a run")
    return run


@contextlib.contextmanager
def filesOf(directory: FilePath) -> Iterator[None]:
    """Use the files of a run. What they lack, since they are damaged or not of a finished run, becomes Refused."""
    try:
        yield
    except (KeyError, IndexError, AttributeError, TypeError, SyntaxError) as problem:
        raise Refused(
            f"{directory}: these are not the files of a finished run ({type(problem).__name__}: {problem})"
        ) from problem


def onFolder(act: Callable[[str], object], words: Sequence[str]) -> int:
    """Main program of what reads a run: calls ``act`` with the folder that is the only word. Returns the exit status."""
    try:
        if len(words) != 1:
            raise Refused("name one folder of results, for example results/wall_comp4")
        act(words[0])
    except Refused as problem:
        say(problem, sys.stderr)
        return 2
    except OSError as error:
        say(f"cannot write to {words[0]}: {error.strerror}", sys.stderr)
        return 2
    except MemoryError:
        say(memory.FULL, sys.stderr)
        return 1
    return 0
