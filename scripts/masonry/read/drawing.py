# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures by matplotlib without a window, written whole or not at all. This module needs no YADE."""

import os

from ..folders import replaced
from ..packages import needed


def empty(width, height):
    """An empty figure [inch]. It has no window, and pyplot, whose settings YADE changes, has no part in it."""
    needed("matplotlib")
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def style():
    """The settings of matplotlib that all figures are drawn with, whatever the caller has set: a context."""
    needed("matplotlib")
    import matplotlib.style

    return matplotlib.style.context("default")


def save(figure, path, dpi):
    """Write a picture, whole or not at all."""
    kind = os.path.splitext(path)[1][1:]
    with replaced(path, "wb") as file:
        figure.savefig(file, dpi=dpi, format=kind)
