# SPDX-License-Identifier: GPL-2.0-or-later
"""curve.csv and run.json of a run, read again; :mod:`masonry.run.results` lists what is in them."""

import contextlib
import csv
import functools
import json
import math
import os
import sys
from typing import Any, Callable, Iterator, Sequence

from .. import memory
from ..arguments import FilePath
from ..errors import Refused, refuse
from ..terminal import say


def readWhole(path: FilePath) -> bytes:
    with open(path, "rb") as file:
        return file.read()


def readText(path: FilePath) -> str:
    """The text of a file. Raises Refused."""
    try:
        return readWhole(path).decode()
    except OSError as error:
        raise Refused(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise Refused(f"cannot read {path}: it is no text") from None


def readCurve(directory: FilePath) -> dict[str, list[float]]:
    """curve.csv of a run: lists of numbers by the name of the column. Raises Refused."""
    path = os.path.join(directory, "curve.csv")
    lines = list(csv.reader(readText(path).splitlines()))
    if len(lines) < 2:
        raise Refused(f"{path}: there is no row of numbers")
    columns, rows, problems = lines[0], [], []
    for number, line in enumerate(lines[1:], start=2):
        try:
            rows.append(list(map(float, line)))
            if len(line) != len(columns):
                raise ValueError(f"{len(line)} numbers in {len(columns)} columns")
            if not all(map(math.isfinite, rows[-1])):
                raise ValueError("a number is not finite")
        except ValueError as error:
            problems.append(f"{path}, line {number}: {error}")
    refuse(problems[:10])
    return {c: [row[i] for row in rows] for i, c in enumerate(columns)}


def readRun(directory: FilePath) -> dict[str, Any]:
    """run.json of a run, whose keys :mod:`masonry.run.results` lists. Raises Refused."""
    path = os.path.join(directory, "run.json")
    text = readText(path)
    try:
        run = json.loads(text)
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    if not isinstance(run, dict):
        raise Refused(f"{path}: is no record of a run")
    if "\\ud" in text.lower():  # halves of a character alone, which no file can have
        run = json.loads(json.dumps(run, ensure_ascii=False).encode(errors="replace"))
    return run


@contextlib.contextmanager
def filesOf(directory: FilePath) -> Iterator[None]:
    """Turn what damaged files, or those of an unfinished run, lead to in a block into Refused."""
    try:
        yield
    except Refused:
        raise
    except (LookupError, AttributeError, TypeError, ValueError, SyntaxError) as problem:
        raise Refused(
            f"{directory}: these are not the files of a finished run ({type(problem).__name__}:"
            f" {problem})"
        ) from problem


def program(act: Callable[..., int | None]) -> Callable[..., int]:
    """Let a main program return its exit status, and print what ends it."""

    @functools.wraps(act)
    def main(*words):
        try:
            return act(*words) or 0
        except (Refused, OSError) as problem:
            say(problem, sys.stderr)
            return 2
        except MemoryError:
            say(memory.FULL, sys.stderr)
            return 1

    return main


@program
def onFolder(act: Callable[[str], object], words: Sequence[str]) -> None:
    """Main program of what reads a run: calls a function with the folder, the only word."""
    if len(words) != 1 or words[0].startswith("-"):
        raise Refused("name one folder of results, for example results/wall_comp4")
    try:
        act(words[0])
    except OSError as error:
        raise Refused(f"cannot write to {words[0]}: {error.strerror}") from None
