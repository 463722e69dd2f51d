# SPDX-License-Identifier: GPL-2.0-or-later
"""Begins a study: checks all of it before anything runs, and makes its folder."""

import json
import os
import shutil
import subprocess
import sys
import tempfile

from masonry.run import batch
from masonry.errors import Refused, Unwritable, refuse
from masonry.terminal import say
from masonry.numbers.files import readWhole
from .gathering import STUDY, TABLE, Folder, reason, written
from .incremental import FOLDER
from .interrupts import watched
from .plan import namesOf
from .variables import NEVER, Distribution, Field

NOTHING = "interrupted: nothing was run"  # while a study is looked at
VERSION = 1  # of study.json
SPARE = 20e6  # bytes that a study leaves free on the disk
#: Program that builds a scene as rows do.
PROBE = "import sys; from masonry import host; host.load(); host.runScript(sys.argv[1], [])"
PROBING = 600  # [s] after which a scene that should only be built is given up


def begin(study, path, near):
    """The folder of a study: made if it is not there, else checked to be of the same study.

    :param near: folder of the study's file, where its scene is looked for
    :raises Refused: with all problems at once
    """
    folder, known = Folder(path), None
    folder.check()
    study.read(near)
    script, fingerprint = study.script(near)
    now = {"version": VERSION, "study": study.describe(), "scene_sha256": fingerprint}
    now = json.loads(json.dumps({**now, "script": script}))
    with watched(NOTHING):
        table = study.table()
    if os.path.lexists(folder.of(STUDY)):
        known = folder.description()
        _compare(folder, known, now)
    else:
        _checkEmpty(folder)
        problems, needed = _look(study, script, table)
        problems += _checkSpace(folder, study.runs * needed)
        refuse(problems, "study: ", "\n  ")
        try:
            os.makedirs(folder.path, exist_ok=True)
        except OSError as error:
            raise Refused(f"--out: cannot write to {path}: {error.strerror}") from None
    if known != now:
        written(folder.of(STUDY), json.dumps(now, indent=2) + "\n")
    os.makedirs(folder.of(batch.ROWS), exist_ok=True)
    _putFiles(folder, study, table)
    return folder


def _putFiles(folder, study, table):
    """Write the table and the records of a study into its folder. Those that are there must be
    these."""
    files = {TABLE: (table, "what the study draws")}
    for motion in study.ida.read("") if study.ida else ():
        os.makedirs(folder.of(FOLDER), exist_ok=True)
        files[f"{FOLDER}/{motion.name}.txt"] = motion.text, "the record that the study reads"
    for name, (text, what) in files.items():
        path = folder.of(name)
        if not os.path.lexists(path):
            written(path, text)
        elif readWhole(path) != text.encode():
            raise Refused(f"--out: {path} is not {what}; remove it, and it is written again")


def _compare(folder, known, now):
    was, given = known["study"], now["study"]
    other = [
        f"{n} is {json.dumps(was.get(n))}, not {json.dumps(given.get(n))}"
        for n in {**was, **given}
        if was.get(n) != given.get(n)
    ]
    if not other and known.get("scene_sha256") != now["scene_sha256"]:
        other = [f"the file of its scene {given['scene']} was another one"]
    if other or known.get("version") != VERSION:
        raise Refused(
            f"--out: {folder.path} holds another study; name another folder. There\n  "
            + "\n  ".join(other or ["it is of another version"])
        )


def _checkEmpty(folder):
    try:
        names = sorted({*os.listdir(folder.path)} - {STUDY + ".new"})  # of a study that was killed
    except FileNotFoundError:
        return
    except OSError as error:
        raise Refused(f"--out: {folder.path}: {error.strerror}") from None
    if names:
        raise Refused(
            f"--out: {folder.path} is not empty ({', '.join(names[:3])}) and holds no study: name"
            " another folder"
        )


def _checkSpace(folder, needed):
    at = folder.path
    while not os.path.isdir(at):
        at = os.path.dirname(at)
    free = shutil.disk_usage(at).free
    if not os.access(at, os.W_OK):
        yield f"--out: {at} cannot be written"
    elif free < needed + SPARE:
        yield (
            f"--out: {at} has {1e-6 * free:.0f} MB free, the study writes some"
            f" {1e-6 * needed:.0f} MB and keeps {1e-6 * SPARE:.0f} MB free"
        )


def _look(study, script, table):
    """Problems of the study that its scene tells when it is built, and the bytes that a row
    writes."""
    with tempfile.TemporaryDirectory() as place:
        place = Folder(place)
        _putFiles(place, study, table)
        found = _probed(script, place)
        if isinstance(found, str):  # the first row may be to blame
            found = _probed(script, place, line=1) or found
    if isinstance(found, str):
        return [f"its scene cannot be built: {found}"], 0
    with watched(NOTHING):
        problems = [*_names(study, found), *_ranges(study, found), *found["problems"]]
    for name, why in found["doubtful"].items():
        if name in study.vary or study.ida and name == "record":
            say(f"warning: {name} varies, and the scene may not use it: {why}")
    for doubt in study.ida.doubts() if study.ida else ():
        say(doubt)
    return problems, found["room"]


def _probed(script, place, line=2):
    """What :mod:`masonry_study.probing` writes, or why there is none.

    :param line: of the table: the options with which the scene is built; 1: without options
    """
    path = place.of("probe.json")
    row = {batch.VARIABLE: f"{place.of(TABLE)}:{line}", batch.PROBE: path}
    env = {**os.environ, **row, "OMP_NUM_THREADS": "1"}
    where = dict(cwd=os.path.dirname(script), env=env, stdin=subprocess.DEVNULL)
    said = dict(capture_output=True, text=True, errors="replace")
    command = [sys.executable, "-P", "-c", PROBE, script]
    try:
        done = subprocess.run(command, **where, **said, timeout=PROBING)
    except subprocess.TimeoutExpired:
        return f"it is not built after {PROBING} s"
    try:
        with open(path) as f:
            return json.load(f)
    except (OSError, ValueError):
        lines = reason(done.stderr)
        if done.returncode == batch.UNWRITTEN:
            raise Unwritable(lines[-1]) from None  # it is no fault of the scene
        lines = lines or [f"no masonry.Scene began a stage in {script}"]
        return "\n  ".join(lines[:10])


def _names(study, found):
    if not found["heard"]:
        yield (
            "its scene takes no options from the command line (arguments=...), and would ignore all"
            " that varies"
        )
        return
    columns = [*study.options, *study.vary] + ["record", "scale"] * bool(study.ida)
    for name in (name for column in columns for name in namesOf(column)):
        if why := _ignored(found, name):
            yield f"{name}: {why}"


def _ignored(found, name):
    """Why the scene ignores an option or a property; wrong names of properties are for the rows to
    tell."""
    kind, dot, attribute = name.partition(".")
    if not dot:
        if name not in found["options"]:
            return "the scene has no such option"
        why = found["unused"].get(name)
        return why and f"the scene ignores it: {why}"
    joint = found["joints"].get(kind)
    if joint is None or attribute not in found["bounds"]:
        return None
    if not found["counts"][kind]:
        return f"the scene has no {kind} joint and would ignore it"
    if joint.get("elastic") and "Stiffness" not in attribute:
        return f"{kind} joints of the scene are linear elastic and ignore it"
    if joint.get("cap") is False and attribute.startswith(("compressive", "peakRatio")):
        return f"{kind} joints of the scene do not crush and ignore it"
    return None


def _ranges(study, found):
    for column, what in study.vary.items():
        if isinstance(what, Field) and what.kind == "normal" and (what.mean or 0) < 0:
            yield f"{column}: mean {what.mean:g} must be above 0"
        for name in namesOf(column) if isinstance(what, Distribution) else ():
            of, _, attribute = name.partition(".")
            bounds = found["connectors"].get(of, found["bounds"]).get(attribute)
            if not bounds:
                continue
            low, high, unit = (bounds[entry] for entry in ("low", "high", "unit"))
            share = what.beyond(low, high)
            if share > NEVER:
                ends = ("at least", low), ("at most", high)
                ends = [f"{word} {end:g}" for word, end in ends if end is not None]
                unit = f" {unit}" if unit not in ("", "-") else ""
                yield (
                    f"{name}: {what} gives impossible values in {100 * share:.2g} % of all rows: it"
                    f" must be {' and '.join(ends)}{unit}; low=... or high=... cuts it off"
                )
