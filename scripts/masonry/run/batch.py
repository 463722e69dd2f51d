# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows of a table in YADE's batch format: options of a scene for ``yade-batch``. No YADE is needed.

``yade-batch table.txt scene.py`` runs a scene once for every row. A row has the options of the
scene by their names, with underscores for dashes, and properties of joints. Values are written as
in Python, without blanks::

    description preset until bed.cohesion field:bed.tensileStrength
    0001        'fast' 6     110000.0     'lognormal(cov=0.3,length=0.5,seed=7)'

- an option: its value, or True for one that has none; ``*`` is the default, ``=`` the value of the
  row before
- ``record``: a path that is not absolute begins at the folder of the table
- ``JOINT.PROPERTY``: as ``--set``, and ``field:JOINT.PROPERTY``: as ``--field``; those that have
  one value, or vary alike, are joined by ``+``
- ``description``: of the results, in the folder ``rows/DESCRIPTION`` beside the table

A row that was run to its end is not run again. One that was stopped goes on from its checkpoint,
and is refused if that has other values than the table: these need another description.
"""

import ast
import collections
import os
import re

from ..errors import Refused
from ..numbers.files import readRun, readText
from .option_table import OPTIONS, asOption, optionsWith

#: Options that a study itself gives, or that a row of it cannot have.
OWN = {"help", *OPTIONS} - optionsWith("ofStudy")
VARIABLE = "YADE_BATCH"  # of the environment: path of the table and number of the line
ROWS = "rows"  # folder of the results, beside the table
FIELD = "field:"  # begins the name of a column
#: Variable of the environment: a file to which a scene that is built writes what it knows, without
#: a run. The line of the heads then stands for a scene without options.
PROBE = "MASONRY_PROBE"
UNWRITTEN = os.EX_IOERR  # exit status if that file cannot be written


def readTable(path):
    """The rows of a table by the number of their line, from 1: dicts of texts. Raises Refused."""
    lines = (re.sub(r"\s*#.*", "", line).split() for line in readText(path).split("\n"))
    used = [(number, words) for number, words in enumerate(lines, 1) if words]
    if not used:
        raise Refused(f"{path}: there is no row")
    heads = [head.removesuffix("!") for head in used[0][1]]
    rows, before = {}, {}
    for number, words in used[1:]:
        if len(words) != len(heads):
            raise Refused(f"{path}, line {number}: {len(words)} values in {len(heads)} columns")
        row = {h: before.get(h, w) if w == "=" else w for h, w in zip(heads, words)}
        rows[number] = before = row
    odd = [name for row in rows.values() if not (name := nameOf(row, "row")).strip(".")]
    if odd:
        raise Refused(f"{path}: description {odd[0]!r} cannot name a folder")
    names = collections.Counter(folder(path, row, line) for line, row in rows.items())
    twice = [os.path.basename(name) for name, count in names.items() if count > 1]
    if twice:
        raise Refused(f"{path}: description {', '.join(twice)} names several rows")
    return rows


def value(text):
    """The value of a text of a table, or the text itself."""
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
        return text


def optionWords(row):
    """The words of the command line that a row stands for, without the folder of its results."""
    words = []
    for name, text in row.items():
        if name == "description" or name.startswith("!") or text == "*":
            continue
        found = value(text)
        if name.startswith(FIELD):
            words.append(f"--field={name[len(FIELD):]}={found}")
        elif "." in name:
            words += [f"--set={one}={found}" for one in name.split("+")]
        elif found is True:
            words.append(asOption(name))
        elif found is not False and found is not None:
            words.append(f"{asOption(name)}={found}")
    return words


def place(text):
    """Path of the table and number of the line of :data:`VARIABLE`. Raises Refused."""
    path, _, line = text.rpartition(":")
    if not path or not line.isdecimal():
        raise Refused(f"{VARIABLE}={text}: must read TABLE:LINE")
    return path, int(line)


def beside(path):
    """The path of a file that a row names: beside its table, if it is not absolute."""
    text = os.environ.get(VARIABLE)
    if not text or os.path.isabs(path):
        return path
    return os.path.join(os.path.dirname(os.path.abspath(place(text)[0])), path)


def named(number):
    return f"{number:04d}"


def folder(path, row, line):
    name = nameOf(row, f"line_{line}")
    return os.path.join(os.path.dirname(os.path.abspath(path)), ROWS, name)


def nameOf(row, default):
    """The name of a row, which is that of a folder."""
    return row.get("description", default).replace("/", "_").strip("'\"")


def ended(directory):
    """run.json of a run that came to its end, however its structure ended; else None."""
    try:
        run = readRun(directory)
    except Refused:
        return None
    return None if run.get("interrupted", True) or run.get("error") else run


def present():
    """The words of the command line of the row that ``yade-batch`` runs in this process, or None.
    Raises Refused, or Done if the row was run to its end."""
    text = os.environ.get(VARIABLE)
    if not text:
        return None
    path, line = place(text)
    rows = readTable(path)
    words = optionWords(rows.get(line, {}))
    if PROBE in os.environ:
        return words
    if line not in rows:
        raise Refused(f"{path} has no row in line {line}")
    out = folder(path, rows[line], line)
    if ended(out):
        raise Done(out)
    # the values of the table are compared with those of the checkpoint
    resumes = os.path.exists(os.path.join(out, "run.checkpoint"))
    return [*words, f"--resume={out}" if resumes else f"--out={out}"]


class Done(Exception):
    """The row was run before. The message is the folder of its results."""
