# SPDX-License-Identifier: GPL-2.0-or-later
"""The bonds of straight walls: where the head joints of a course stand, in quarter units."""


def layout(bond, wythes, quarters, course):
    """Bricks of a course: both ends in quarter units, and first and last wythe."""
    if bond in ("running", "stack"):
        for w in range(wythes):
            shift = 2 if bond == "running" and (course + w) % 2 else 0
            yield from _laid([0, *range(shift or 4, quarters, 4), quarters], (w, w + 1))
        return
    joints = dict(header=_headerBond, english=_englishBond, flemish=_flemishBond)[bond]
    ends = [0, *joints(quarters, course % 2), quarters]
    for k0, k1 in zip(ends, ends[1:]):
        if k1 - k0 <= 2 and not (bond == "english" and course % 2 == 0):
            yield k0, k1, 0, 2  # a header or a closer, through the wall
        else:
            yield k0, k1, 0, 1
            yield k0, k1, 1, 2


def _laid(ends, rows):
    return ((k0, k1, *rows) for k0, k1 in zip(ends, ends[1:]))


def _headerBond(n, odd):
    """Head joints in quarter units. Odd courses start and end with three-quarter bats."""
    return range(3, n - 2, 2) if odd else range(2, n, 2)


def _englishBond(n, odd):
    """Head joints. Odd courses are headers, with a queen closer next to each outer one."""
    if odd:
        return [2, *range(3, n - 2, 2), n - 2] if n > 6 else range(2, n, 2)
    if n == 6:
        return [3]
    if n % 4 == 0:
        return range(4, n, 4)
    # a half bat stands near the middle of a course that is no whole number of units long
    half = max(4 * (n // 8), 4)
    return [*range(4, half + 1, 4), *range(half + 2, n, 4)]


def _flemishBond(n, odd):
    """Head joints. Odd courses start with a header and a queen closer, so that headers stand over
    the middle of stretchers, and end so, or with a three-quarter bat."""
    if not odd:
        return [k for k in range(4, n, 2) if k % 6 != 2]
    if n == 4:
        return [2]
    end = {4: [n - 3, n - 2], 0: [n - 3], 2: [n - 3]}[n % 6]
    # the last joint behind a header or closer
    last = {4: n - 7, 0: n - 3, 2: n - 5}[n % 6]
    inner = [k for k in range(3, last + 1) if k % 6 in (1, 3)]
    return sorted({2, *inner, *end})
