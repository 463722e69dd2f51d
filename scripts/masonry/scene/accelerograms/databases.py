# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of ground accelerations as databases give them.

- **PEER NGA**: a line of the header has the number of samples and the time between them, ``NPTS=
  4000, DT= .0050 SEC`` or ``4000 .0050 NPTS, DT``, and one the unit; then the samples, any number
  of them a line.
- **ESM** and ITACA (DYNA): 64 lines of header, each a key, a colon and a value, among them
  ``SAMPLING_INTERVAL_S``, ``NDATA``, ``UNITS`` (``cm/s^2``) and ``DATA_TYPE``. One sample a line.
- **K-NET** and **KiK-net**: 17 lines of header with ``Sampling Freq(Hz)``, ``Duration Time(s)`` and
  ``Scale Factor``, by which the counts that follow are Gal; their mean is the offset of the
  instrument and is taken away.
- **COSMOS** V1 and V2 (format 1.20): for each series a text, 100 whole numbers, 100 real numbers,
  of which number 62 is the time between samples [ms], comments, and the samples below a line with
  their number, quantity, unit (code in brackets) and format. The older form of **CSMIP** says
  ``points of accel data equally spaced at`` instead.
- **GeoNet** V1A and V2A: three components one after the other, each of 16 lines of text, 4 lines of
  10 whole numbers, 6 lines of 10 real numbers, and accelerations, velocities and displacements in
  mm and s, 10 of 8 characters a line.

Velocities and displacements are passed over. Three components are two horizontal ones in the order
of the file, then the vertical one.
"""

import re
from dataclasses import dataclass
from typing import Any

from ...arguments import shown
from ...texts import TextFile
from .text_columns import interval
from .unit_words import unitNamed, unitSaid

_NUMBER = r"((?:\d+\.?\d*|\.\d+)(?:[ED][+-]?\d+)?)"
#: COSMOS, table 2: units of accelerations by their codes, with the factor on the samples.
_COSMOS_UNITS = {2: ("g", 1.0), 4: ("cm/s²", 1.0), 10: ("cm/s²", 1.0), 11: ("g", 1e-3)}
_UP = 400, 401, 402  # COSMOS, table 13: orientations that are vertical


def _counted(file, values, expected, key, line):
    """Values, if there are as many as the file says, and enough."""
    if len(values) != expected:
        raise file.refused(
            f"{key} is {expected}, and the file has {len(values)} values: is it cut off, or were"
            " lines added?",
            line,
        )
    if len(values) < 2:
        raise file.refused(
            "it must have two lines of samples at least, of one or two numbers each, and has"
            f" {len(values)}"
        )
    return values


def _samples(file, first):
    """All numbers from a line on, counted from 1."""
    lines = enumerate(file.lines[first - 1 :], first)
    return [number for line, text in lines for number in file.numbers(text, line)]


def peer(file: TextFile, at: int):
    unit, head = None, file.lines[at - 1]
    for line, text in enumerate(file.lines[:at], 1):
        isAcceleration = re.search(r"\bACC", text, re.I)
        if not isAcceleration and not re.search(r"\bUNITS\s+OF\b", text, re.I):
            continue
        if not isAcceleration:
            raise file.refused(f"it must hold accelerations, and says {shown(text.strip())}", line)
        unit = file.read(unitSaid, text, line) or unit
    count = re.search(r"\bNPTS\s*=\s*(\d+)", head, re.I)
    every = re.search(rf"\bDT\s*=\s*{_NUMBER}", head, re.I)
    if both := re.match(rf"\s*(\d+)\s*,?\s+{_NUMBER}\s*,?\s+NPTS\s*,\s*DT\b", head, re.I):
        expected, step = both.groups()
    elif count and every:
        expected, step = count[1], every[1]
    else:
        raise file.refused(
            "the line must have NPTS and DT, as in NPTS= 4000, DT= .0050 SEC, and is"
            f" {shown(head.strip())}",
            at,
        )
    samples = _counted(file, _samples(file, at + 1), int(expected), "NPTS", at)
    return samples, interval(file, step, at), unit


def esm(file: TextFile, at: int):
    known, values, begins = {}, [], None
    for line, text in enumerate(file.lines, 1):
        key, colon, value = text.partition(":")
        if begins is None and colon and key[:1].isalpha():
            known.setdefault(key, (value.strip(), line))
        elif text.split():
            begins = begins or line
            numbers = file.numbers(text, line)
            if len(numbers) != 1:
                raise file.refused(f"{len(numbers)} numbers, there must be one a line", line)
            values += numbers
    needed = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS", "DATA_TYPE")
    missing = [key for key in needed if not known.get(key, ("", 0))[0]]
    if missing:
        raise file.refused(
            f"its header must have {', '.join(missing)}, and ends with line"
            f" {(begins or len(file.lines) + 1) - 1}"
        )
    kind, line = known["DATA_TYPE"]
    if kind.upper() != "ACCELERATION":
        raise file.refused(f"DATA_TYPE must be ACCELERATION, got {shown(kind)}", line)
    unit = file.read(unitNamed, *known["UNITS"])
    every = interval(file, *known["SAMPLING_INTERVAL_S"])
    count, line = known["NDATA"]
    if not count.isdecimal():
        raise file.refused(f"NDATA {shown(count)} must be a whole number", line)
    return _counted(file, values, int(count), "NDATA", line), every, unit


def knet(file: TextFile, at: int):
    known, begins = {}, None
    for line, text in enumerate(file.lines, 1):
        key, value = text[:18].strip(), text[18:].strip()
        known[key] = value, line
        if key.startswith("Memo"):
            begins = line + 1
            break
    keys = "Sampling Freq(Hz)", "Scale Factor"
    missing = [key for key in keys if not known.get(key, ("", 0))[0]]
    if missing or begins is None:
        raise file.refused(f"its header must have {', '.join(missing or ['Memo.'])}")
    (rate, rateLine), (scale, scaleLine) = (known[key] for key in keys)
    factor = re.fullmatch(rf"{_NUMBER}\s*\(gal\)\s*/\s*{_NUMBER}", scale, re.I)
    frequency = file.number(re.sub(r"\s*Hz$", "", rate, flags=re.I), rateLine)
    if not factor or not float(factor[2]) > 0:
        raise file.refused(f"Scale Factor {shown(scale)} must be as 3920(gal)/6182761", scaleLine)
    if not frequency > 0:
        raise file.refused(f"Sampling Freq(Hz) {shown(rate)} must be above 0", rateLine)
    counts = _samples(file, begins)
    duration, line = known.get("Duration Time(s)", ("", 0))
    expected = round(file.number(duration, line) * frequency) if duration else len(counts)
    _counted(file, counts, expected, "duration × rate", line)
    offset = sum(counts) / len(counts)
    gal = float(factor[1]) / float(factor[2])
    return [(count - offset) * gal for count in counts], 1 / frequency, "cm/s²"


def _fixed(file, first, count, width):
    """So many numbers of columns of one width, from a line on; and the line behind them."""
    found, line = [], first
    while len(found) < count and line <= len(file.lines):
        text = file.lines[line - 1].rstrip()
        cells = [text[k : k + width].strip() for k in range(0, len(text), width)]
        found += [file.number(cell, line) for cell in cells if cell]
        line += 1
    return _counted(file, found, count, "number of points", first - 1), line


@dataclass
class _Series:
    """The accelerations of one component, every so many seconds."""

    samples: list[float]
    every: float
    unit: str
    isUp: bool


def _together(file, series):
    """The samples of one component, or of three of which the vertical one is last, the time between
    them and their unit."""
    if not series:
        raise file.refused("no series of accelerations was found in it")
    alike = {(one.every, one.unit) for one in series}
    if len(alike) > 1:
        raise file.refused("its components differ in unit or in the time between samples")
    level, ups = ([one.samples for one in series if one.isUp is up] for up in (False, True))
    samples = series[0].samples
    if len(series) > 1:
        if len(series) != 3 or len(ups) != 1 or len({*map(len, level + ups)}) != 1:
            raise file.refused(
                f"{len(series)} accelerations, {len(ups)} of them vertical: there must be one, or"
                " three of one length with one vertical"
            )
        samples = [list(sample) for sample in zip(*level, *ups)]
    return samples, *alike.pop()


def cosmos(file: TextFile, at: int):
    series, isUp, every = [], False, None
    line = 1
    while line <= len(file.lines):
        text = file.lines[line - 1]
        headed = re.match(
            r"\s*(\d+)\s+(integer|real)-header values follow .*\(\d+[IFE](\d+)", text, re.I
        )
        data = re.match(
            r"\s*(\d+)\s+(.*?)pts.*units\s*=\s*(\S+)\s*\((\d+)\).*\(\d+[IFE](\d+)", text, re.I
        )
        if headed:
            numbers, line = _fixed(file, line + 1, int(headed[1]), int(headed[3]))
            if headed[2].lower() == "integer":
                isUp = len(numbers) > 53 and int(numbers[53]) in _UP
            else:
                every = numbers[61] / 1000 if len(numbers) > 61 else None
        elif data:
            here = line
            if int(data[4]) not in _COSMOS_UNITS and "acc" in data[2].lower():
                raise file.refused(
                    f"units {data[3]} ({data[4]}) are no accelerations: a file of raw counts (V0)"
                    " must be made one of V1 or V2 first",
                    here,
                )
            numbers, line = _fixed(file, line + 1, int(data[1]), int(data[5]))
            if "acc" in data[2].lower():
                unit, factor = _COSMOS_UNITS[int(data[4])]
                if not every or not every > 0:
                    raise file.refused(
                        "real-header value 62, the time between samples, is not there", here
                    )
                samples = [factor * number for number in numbers]
                series.append(_Series(samples, every, unit, isUp))
        else:
            line += 1
    return _together(file, series)


def csmip(file: TextFile, at: int):
    series = []
    pattern = (
        rf"\s*(\d+)\s+points of accel data equally spaced at\s*{_NUMBER}\s*sec,"
        r"\s*in\s+(.*?)\.?\s*\(\d+[FE](\d+)"
    )
    for line, text in enumerate(file.lines, 1):
        if not (found := re.match(pattern, text, re.I)):
            continue
        unit, every = file.read(unitNamed, found[3], line), interval(file, found[2], line)
        samples, _ = _fixed(file, line + 1, int(found[1]), int(found[4]))
        before = " ".join(file.lines[max(0, line - 60) : line])
        chan = re.findall(r"Chan\s+\d+:\s*(\S+)", before, re.I)
        isUp = bool(chan) and chan[-1].lower().startswith(("up", "down", "vert"))
        series.append(_Series(samples, every, unit, isUp))
    return _together(file, series)


def geonet(file: TextFile, at: int):
    series, line = [], 1
    while line + 25 <= len(file.lines) and re.search("accelerogram", file.lines[line - 1], re.I):
        corrected = not re.match(r"\s*uncorrected", file.lines[line - 1], re.I)
        component = (file.lines[line + 11].split() + ["", ""])[1]
        whole, after = _fixed(file, line + 16, 40, 8)
        real, after = _fixed(file, after, 60, 8)
        counts = whole[33:36] if corrected else whole[30:31]
        every = real[25] if corrected else 1 / real[0] if real[0] else 0
        if not every > 0:
            raise file.refused(f"the time between samples, {every:g} s, must be above 0", line + 20)
        samples, line = _fixed(file, after, int(counts[0]), 8)
        for count in counts[1:]:  # velocities, displacements
            line = _fixed(file, line, int(count), 8)[1] if count else line
        samples = [0.1 * sample for sample in samples]
        series.append(_Series(samples, every, "cm/s²", component.lower() == "up"))
    return _together(file, series)


#: By its name: what a line of a format's header has, among how many first lines, and its reader, of
#: the file and that line.
READERS: dict[str, tuple[str, int, Any]] = {
    "COSMOS": (r"acceleration.*\(format v", 1, cosmos),
    "CSMIP": (r"points of accel data equally spaced", 100, csmip),
    "GeoNet": (r"corrected accelerogram.*GNS Science", 1, geonet),
    "K-NET": (r"^Origin Time\s", 1, knet),
    "PEER": (r"\bNPTS\b", 12, peer),
    "ESM": (r"^[A-Z][A-Z0-9_^/]*:", 1, esm),
}
