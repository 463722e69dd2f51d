# SPDX-License-Identifier: GPL-2.0-or-later
"""What a folder of a study must be before the study goes on in it: its table and its rows are those of the study.

The folder may have been on other machines, and anybody may have written in it. So nothing in it is believed that can be
compared: the table must be what the study draws, to the last digit; a row that has ended must have been run with the values
that the table gives it; a row that goes on from a checkpoint is refused by the scene itself if the checkpoint has other values,
and begins again. What a row has found cannot be compared with anything: whoever wants to be sure runs it again.
"""

from itertools import zip_longest

from ..basics import Refused, firstOf, refuse
from ..read.files import readText
from ..run import batch, presets
from .gathering import TABLE

SHOWN = 5  # differences that are named

#: Options of which run.json has the value that the table gives.
COMPARED = {*presets.USUAL, "until", "preset", "joints", "crack_surfaces"}
COMPARED |= {"density_scaling", "quick", "record", "scale"}


def compareTable(folder, drawn):
    """Refuse a table that is not what the study draws.

    :param folder: :class:`masonry.study.gathering.Folder`
    :param drawn: the text of the table
    """
    path = folder.of(TABLE)
    text = readText(path)
    if text == drawn:
        return
    lines = zip_longest(text.split("\n"), drawn.split("\n"), fillvalue="nothing")
    number, was, now = next((n, *two) for n, two in enumerate(lines, 1) if two[0] != two[1])  # fmt: skip
    raise Refused(
        f"--out: {path} is not what the study draws; remove it, and it is drawn again. Line {number} is\n  {was}\n"
        f"and the study draws\n  {now}"
    )


def rowsOf(folder):
    """The rows of the table of a study, in turn, as dicts of texts: as many as it has runs, with its columns and names.

    :raises Refused: if the table is another one
    """
    study, path = folder.description()["study"], folder.of(TABLE)
    rows = [*batch.readTable(path).values()]
    needed = {"description", "lean", *study["options"], *study["vary"]}
    needed |= {"record", "scale"} if study.get("ida") else set()
    fields = [name for name in study["vary"] if name.startswith(batch.FIELD)]
    known = needed | {name[len(batch.FIELD) :] for name in fields}
    known = {n for n in known if n in ("description", "lean") or batch.isColumn(n)}
    heads = [*rows[0]] if rows else []
    foreign = [name for name in [*heads, *needed] if name not in known]
    problems = [f"column {name} is not of the study" for name in foreign]
    problems += [f"column {name} is missing" for name in needed.difference(heads)]
    if len(rows) != study["runs"]:
        problems.append(f"it has {len(rows)} rows, and the study {study['runs']}")
    problems += [
        f"row {batch.named(number)} is called {row['description']}"
        for number, row in enumerate(rows, 1)
        if row.get("description", "") != batch.named(number)
    ]
    refuse(problems[:SHOWN], f"{path} is not the table of its study:\n  ", "\n  ")
    return rows


def checkRows(folder, rows):
    """Refuse rows that have ended with other values than the table gives them, as far as run.json tells.

    :param rows: as in :func:`rowsOf`
    """
    problems = []
    for number, row in enumerate(rows, 1):
        run = batch.ended(folder.row(number))
        if run is not None:
            problems += [
                f"row {batch.named(number)} was run with {was}, and the table has {now}"
                for was, now in _otherOptions(row, run.get("options"))
            ]
    if problems:
        raise Refused(
            f"{folder.of(batch.ROWS)}: remove the folders of these rows, and they are run again:\n  "
            + "\n  ".join(firstOf(problems, SHOWN))
        )


def _otherOptions(row, options):
    """What a row was run with and what the table says, pairs of texts, where they differ.

    :param options: of run.json
    """
    if not isinstance(options, dict):
        return [("options that run.json does not name", "its own")]
    words = batch.optionWords(row)
    pairs = []
    for name, was in (("set", _settings(options)), ("field", options.get("field"))):
        mark = f"--{name}="
        now = [word[len(mark) :] for word in words if word.startswith(mark)]
        if was != now:
            pairs.append((f"{mark}{was}", now))
    for name in COMPARED.intersection(row):
        was, now = options.get(name), batch.value(row[name])
        if now is not None and now is not False and now != "*" and not _same(was, now):
            pairs.append((f"{name} {was}", now))
    return pairs


def _settings(options):
    """``--set`` of run.json as the command line has it."""
    try:
        return [f"{joint}.{name}={value}" for joint, name, value in options["set"]]
    except (KeyError, TypeError, ValueError):
        return None


def _same(was, now):
    if isinstance(was, bool) or isinstance(now, bool) or isinstance(was, str):
        return str(was) == str(now)
    try:
        return float(was) == float(now)
    except (TypeError, ValueError):
        return False
