# SPDX-License-Identifier: GPL-2.0-or-later
"""What is in a checkpoint."""


def records(data):
    """The records of a checkpoint by name, as bytes."""
    at, end, found = data.index(b"\n") + 9, len(data) - 8, {}
    while at < end:
        sizes = [int.from_bytes(data[at + i : at + i + 8], "little") for i in (1, 9)]
        first = at + 17
        name = data[first : first + sizes[0]].decode()
        at = first + sum(sizes)
        found[name] = data[first + sizes[0] : at]
    return found
