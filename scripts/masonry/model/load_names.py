# SPDX-License-Identifier: GPL-2.0-or-later
"""Names of loads, under which bounds and factors are kept."""


def nameInDomain(target, direction, normal):
    """The name of a push of an N-V domain."""
    return f"{nameOfPush(target, direction)} under {normal:g} kN"


def nameOfPush(target, direction):
    return f"{target.name} along {nameOf(direction)}"


def nameOfLean(towards, tilts=False):
    """The name of an acceleration or a tilt."""
    return f"{'tilt' if tilts else 'acceleration'} towards {nameOf(towards)}"


def nameOf(direction):
    """A direction as text."""
    for axis, value in zip("xyz", direction):
        if abs(value) > 1 - 1e-9:
            return ("-" if value < 0 else "") + axis
    return "(" + ", ".join(f"{v:.3g}" for v in direction) + ")"
