# SPDX-License-Identifier: GPL-2.0-or-later
"""Text files of other programs: encoding, line ends, comments, heads, columns and numbers. Every
reader of such a file begins here:

- UTF-8 and UTF-16 with a byte order mark, UTF-8 without one, else Latin-1;
- lines end with a line feed, a carriage return or both, and are counted as an editor counts them;
- a line that begins with #, % or // is a comment;
- columns are apart by semicolons, tabs, commas or blanks. A decimal comma is understood where
  commas do not part the columns, and refused where both would be possible;
- numbers may be Fortran's: ``.1D-01``, ``.41-103``, and columns that touch.
"""

import csv
import os
import re
import stat
import struct
from dataclasses import dataclass, field
from typing import Any, Callable

from .arguments import FilePath, shown
from .errors import Refused

MAX_BYTES = 500_000_000
COMMENT = re.compile(r"\s*(?:#|%|//)\s?")
_DECIMAL = r"[+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+)"
#: A number: an exponent has a letter, or three digits behind its sign, as Fortran writes them.
_NUMBER = re.compile(rf"(?:{_DECIMAL}|[+-]?[0-9]+)(?:[EeDd][+-]?[0-9]{{1,4}})?")
_NO_LETTER = re.compile(rf"({_DECIMAL})([+-][0-9]{{3}})")
#: Numbers of fixed columns, which may touch; each has a point.
_TOUCHING = re.compile(rf"(?:{_DECIMAL}(?:[EeDd][+-]?[0-9]{{1,3}})?){{2,}}")
_ONE_TOUCHING = re.compile(rf"{_DECIMAL}(?:[EeDd][+-]?[0-9]{{1,3}})?")
#: A decimal comma that is no mark between columns: digits on both sides.
_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[EeDd][+-]?[0-9]+)?")

#: Errors of damaged files.
MISREAD = (
    *(OSError, SyntaxError, ValueError, LookupError, TypeError, AttributeError),
    *(RecursionError, struct.error, OverflowError),
)


@dataclass(frozen=True)
class Row:
    """A line of a table: its number and its cells."""

    line: int
    cells: list[str]


@dataclass
class Table:
    """A text in columns.

    :ivar comments: comments, without their signs
    :ivar heads: lines before the first one with a number
    :ivar rows: the lines from it on
    """

    comments: list[Row] = field(default_factory=list)
    heads: list[Row] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)


def isNumber(word: str) -> bool:
    """Whether a word is a number, finite or not."""
    return bool(
        _NUMBER.fullmatch(word)
        or _NO_LETTER.fullmatch(word)
        or re.fullmatch(r"[+-]?(?:nan|inf(?:inity)?)", word, re.I)
    )


class TextFile:
    """The lines of a text file.

    :ivar content: its bytes
    :raises Refused: for what is no text, is larger than :data:`MAX_BYTES`, or cannot be read
    """

    def __init__(self, path: FilePath) -> None:
        self.path = os.fspath(path)
        self.content = self._read()
        self.lines = re.split(r"\r\n|\n|\r", self._decoded(self.content))
        if self.lines[-1] == "":
            del self.lines[-1]

    def _read(self):
        try:
            about = os.stat(self.path)
            if not stat.S_ISREG(about.st_mode) and not stat.S_ISDIR(about.st_mode):
                raise Refused(f"{self.path}: it is no file but a pipe or a device")
            if about.st_size > MAX_BYTES:
                raise Refused(
                    f"{self.path}: {about.st_size / 1e6:.0f} MB, and a text may have"
                    f" {MAX_BYTES / 1e6:.0f} MB"
                )
            with open(self.path, "rb") as file:
                return file.read()
        except OSError as error:
            raise Refused(f"cannot read {self.path}: {error.strerror}") from None

    def _decoded(self, content):
        try:
            if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
                return content.decode("utf-16")
            if b"\0" in content:
                raise Refused(f"{self.path}: it is no text, it has bytes of zero")
            return content.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            if error.encoding != "utf-8":
                raise Refused(f"{self.path}: it is no text in UTF-16") from None
            return content.decode("latin-1")

    def refused(self, text: str, line: int | None = None) -> Refused:
        return Refused(f"{self.path}{f', line {line}' if line else ''}: {text}")

    def read(self, function: Callable[[str], Any], text: str, line: int) -> Any:
        """What a function makes of a text of a line. Its ValueError is one of this line."""
        try:
            return function(text)
        except ValueError as error:
            raise self.refused(str(error), line) from None

    def number(self, word: str, line: int) -> float:
        """The finite number that a word of a line stands for. Raises Refused."""
        return self.read(finite, word, line)

    def numbers(self, text: str, line: int) -> list[float]:
        """The finite numbers of a line in columns that blanks part, or that touch."""
        words = text.replace(",", " ").split()
        found = []
        for word in words:
            touching = _TOUCHING.fullmatch(word) and not isNumber(word)
            found += _ONE_TOUCHING.findall(word) if touching else [word]
        return [self.number(word, line) for word in found]

    def table(self, columns: int | None = None) -> Table:
        """The text as a table. Raises Refused if its commas are ambiguous.

        :param columns: how many it must have, by which the meaning of commas is known; None: any
        """
        found, body = Table(), []
        for line, text in enumerate(self.lines, 1):
            if comment := COMMENT.match(text):
                found.comments.append(Row(line, [text[comment.end() :].strip()]))
            elif text.strip():
                body.append((line, text))
        mark, decimalComma = self._columns([text for _, text in body[len(body) // 2 :]])
        for line, text in body:
            cells = self._cells(text.strip(), mark, line)
            if decimalComma:
                cells = [c.replace(",", ".") if _COMMA.fullmatch(c) else c for c in cells]
            isHead = not found.rows and not any(map(isNumber, cells))
            (found.heads if isHead else found.rows).append(Row(line, cells))
        if mark == "," and found.rows and self._areDecimals(found, columns):
            for row in found.rows:
                row.cells[:] = [".".join(row.cells)]
        return found

    def _columns(self, lines):
        """The mark between columns, None for blanks, and whether commas are decimal."""
        for mark in ";\t":
            if sum(mark in line for line in lines) * 2 > len(lines):
                return mark, True
        if not any("," in line for line in lines):
            return None, False
        words = [word for line in lines for word in line.split()]
        areNumbers = all(_COMMA.fullmatch(word) or isNumber(word) for word in words)
        inColumns = any(len(line.split()) > 1 for line in lines)
        return (None, True) if areNumbers and inColumns else (",", False)

    def _cells(self, text, mark, line):
        if mark is None:
            return text.split()
        try:
            [cells] = csv.reader([text], delimiter=mark, strict=True)
        except csv.Error as error:
            raise self.refused(f"{error}", line) from None
        return [cell.strip() for cell in cells]

    def _areDecimals(self, table, columns):
        """Whether the only comma of every line stands for a decimal point: 0,25 is two whole
        numbers or one. One head says one column, two say two; a zero behind the comma, and as many
        digits behind it in all lines, say a decimal."""
        pairs = [row.cells for row in table.rows]
        if not all(len(p) == 2 and p[0].strip("+-").isdigit() and p[1].isdigit() for p in pairs):
            return False
        if columns or table.heads:
            return (columns or len(table.heads[-1].cells)) == 1
        digits = {len(second) for _, second in pairs}
        if len(digits) == 1 and digits != {1} and any(p[1][0] == "0" for p in pairs):
            return True
        first, line = pairs[0], table.rows[0].line
        raise self.refused(
            f"is {','.join(first)} one number or two? Write decimals with a point, or part columns"
            " by semicolons or blanks",
            line,
        )


def printable(text: object) -> str:
    """A text of a file as a message may have it: what cannot be printed is written out."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))


def finite(word: str) -> float:
    """The finite number that a word stands for. Raises ValueError."""
    if not isNumber(word):
        raise ValueError(f"{shown(word)} is not a number")
    found = float(re.sub("[Dd]", "e", _NO_LETTER.sub(r"\1e\2", word)))
    if not abs(found) < float("inf"):
        raise ValueError(f"{shown(word)} is not a finite number")
    return found
