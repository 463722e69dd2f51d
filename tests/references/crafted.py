# SPDX-License-Identifier: GPL-2.0-or-later
"""Checkpoints that somebody has made up: damaged at random, below a checksum that fits or not."""

import copy
import json
import random
import struct

TITLE = b"masonry checkpoint, format 3\n"

#: What stands in place of a number, a text, a list or a dict of the JSON text.
ODD = (
    [None, True, False, -1, 0, 3, 10**30, 10**400, 2**63, 1e308, -1e308, 5e-324]
    + [float("nan"), float("inf"), "", "text", "\x1b[2J\x1b]0;x\x07", "\ud800", "a\0b"]
    + ["../../x", "x" * 5000, [], {}, [[]], [1, "a"], {"a": 1}, [None], [{}], ["", {}]]
    + [["settle", {}], [[1e308] * 3], {"1": []}, {"1": [{}]}, {"\x1b": {"\x1b": 1}}]
)
#: What stands in place of a size.
SIZES = [
    0,
    1,
    7,
    8,
    9,
    2**31,
    2**32,
    2**62,
    2**63 - 1,
    2**63,
    2**64 - 8,
    2**64 - 1,
]


def records(data):
    """The records of a checkpoint: lists of kind, name and value."""
    found, at, end = [], len(TITLE) + 8, len(data) - 8
    while at < end:
        kind = data[at : at + 1]
        name, value = struct.unpack("<QQ", data[at + 1 : at + 17])
        at += 17
        found.append([kind, data[at : at + name], data[at + name : at + name + value]])
        at += name + value
    return found


def packed(parts):
    """The bytes of records."""
    return b"".join(
        kind + struct.pack("<QQ", len(name), len(value)) + name + value
        for kind, name, value in parts
    )


def sealed(body, seal):
    """A checkpoint of the bytes of records; ``seal`` is the package's own checksum, a function of bytes."""
    data = TITLE + struct.pack("<Q", len(body) + 8) + body
    return data + struct.pack("<Q", seal(data))


def checksum(data):
    """FNV-1a, 64 bits."""
    found = 0xCBF29CE484222325
    for byte in data:
        found = (found ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return found


def paths(value, path=()):
    """Ways to all values within a JSON value, tuples of keys."""
    inner = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value[:3])  # the first ones stand for all
        if isinstance(value, list)
        else ()
    )
    for key, one in inner:
        yield (*path, key)
        yield from paths(one, (*path, key))


class Crafted:
    """Makes damaged checkpoints of one that is whole, the same for the same seed.

    :param data: the bytes of the whole one
    """

    def __init__(self, data, seed):
        self.data, self.dice = data, random.Random(seed)
        self.parts = records(data)
        self.extra = json.loads(next(v for _, n, v in self.parts if n == b"extra"))
        self.paths = [*paths(self.extra)]

    def __iter__(self):
        acts = [self._bytes, self._head, self._sizes, self._records, self._numbers]
        acts += [self._text, self._text, *[self._value] * 8]
        while True:
            act = self.dice.choice(acts)
            yield act.__name__[1:], act()

    # -- without a checksum that fits

    def _bytes(self):
        data, dice = bytearray(self.data), self.dice
        for _ in range(dice.choice([1, 1, 3, 50])):
            data[dice.randrange(len(data))] = dice.randrange(256)
        return bytes(data[: dice.choice([len(data), dice.randrange(len(data))])])

    def _head(self):
        head = self.dice.choice([TITLE, TITLE[:9], TITLE.replace(b"2", b"\xff"), b""])
        size = struct.pack("<Q", self.dice.choice(SIZES))
        return head + size + self.data[len(TITLE) + 8 :][: self.dice.choice([0, 8, -1])]

    # -- below a checksum that fits

    def _sealed(self, body):
        return sealed(body, checksum)

    def _sizes(self):
        body = bytearray(packed(self.parts))
        count = self.dice.randrange(len(self.parts))
        at = len(packed(self.parts[:count])) + self.dice.choice([1, 9])
        body[at : at + 8] = struct.pack("<Q", self.dice.choice(SIZES))
        return self._sealed(bytes(body))

    def _records(self):
        parts, dice = [list(p) for p in self.parts], self.dice
        one = dice.choice(parts)
        act = dice.randrange(5)
        if act == 0:
            parts.remove(one)
        elif act == 1:
            parts.append(one)
        elif act == 2:
            one[0] = dice.choice([b"n", b"t", b"\0", b"\xff"])
        elif act == 3:
            one[1] = dice.choice([b"", b"\xff\xfe", b"\x1b[2J", one[1] + b"x"])
        else:
            one[2] = dice.choice([b"", one[2] * 2, one[2][:-8], b"\xff" * 16])
        return self._sealed(packed(parts))

    def _numbers(self):
        parts, dice = [list(p) for p in self.parts], self.dice
        one = dice.choice([p for p in parts if p[0] == b"n" and p[2]])
        at = 8 * dice.randrange(len(one[2]) // 8)
        odd = dice.choice([float("nan"), float("inf"), -1.0, 1e300, 2.0**63, 0.5])
        one[2] = one[2][:at] + struct.pack("<d", odd) + one[2][at + 8 :]
        return self._sealed(packed(parts))

    def withText(self, text):
        """The checkpoint with another ``extra``, as bytes."""
        parts = [[k, n, text if n == b"extra" else v] for k, n, v in self.parts]
        return self._sealed(packed(parts))

    def _text(self):
        text, dice = json.dumps(self.extra).encode(), self.dice
        at = dice.randrange(len(text))
        quotes = [i for i, byte in enumerate(text) if byte == 34]
        quote = dice.choice(quotes)
        whole = [
            text[:quote] + text[quote + 1 :],
            text[:at] + b"9" * 5000 + text[at:],
            text[:at] + b"[" * 200_000 + text[at:],
            b'{"a":' * 200_000,
            text[:at] + bytes([dice.randrange(256)]) + text[at + 1 :],
            text[:at],
            b"null",
            b'{"scene": NaN}',
            b"\xff\xfe",
        ]
        return self.withText(dice.choice(whole))

    def _value(self):
        extra, dice = copy.deepcopy(self.extra), self.dice
        for _ in range(dice.choice([1, 1, 1, 2])):
            *path, last = dice.choice(self.paths)
            try:
                inner = extra
                for key in path:
                    inner = inner[key]
                if dice.random() < 0.15:
                    del inner[last]
                else:
                    inner[last] = dice.choice(ODD)
            except (KeyError, IndexError, TypeError):
                pass  # the first change has taken that away
        return self.withText(json.dumps(extra).encode())
