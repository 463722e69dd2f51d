# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures by matplotlib without a window, written whole or not at all. This module needs no YADE."""

import os


def empty(width, height):
    """An empty figure [inch]. It has no window, and pyplot, whose settings YADE changes, has no part in it."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def style():
    """The settings of matplotlib that all figures are drawn with, whatever the caller has set: a context."""
    import matplotlib.style

    return matplotlib.style.context("default")


def save(figure, path, dpi):
    """Write a picture, whole or not at all."""
    try:
        figure.savefig(path, dpi=dpi)
    except OSError:
        if os.path.exists(path):
            os.remove(path)
        raise
