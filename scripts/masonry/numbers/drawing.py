# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures by matplotlib without a window, written whole or not at all."""

import contextlib
import io
import os
import warnings

from ..folders import replaced
from ..packages import needed


def empty(width, height):
    """An empty figure [inch], without pyplot, whose settings YADE changes."""
    needed("matplotlib")
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


@contextlib.contextmanager
def style(settings=()):
    """A context with the settings of matplotlib of all figures, and more of them in a dict. Its
    warnings, of glyphs that a font lacks and of labels that find no room, are for developers."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        needed("matplotlib")
        import matplotlib.style

        with matplotlib.style.context(["default", dict(settings)]):
            yield


@contextlib.contextmanager
def picture(path, width, height, dpi, settings=()):
    """A figure [inch] that is written at the end of its block; ``settings`` as in
    :func:`style`."""
    with style(settings):
        figure = empty(width, height)
        yield figure
        figure.tight_layout()
        save(figure, path, dpi)


def finish(axes, x, y, **legend):
    """Add labels, a legend with these settings, and a grid to a diagram."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.legend(**legend)
    axes.grid(alpha=0.3)


def save(figure, path, dpi):
    kind = os.path.splitext(path)[1][1:]
    with replaced(path, "wb") as file:
        figure.savefig(file, dpi=dpi, format=kind)


def svg(figure, name):
    """A figure as an element ``svg`` of a page, with a name of its own there."""
    from markupsafe import Markup
    from matplotlib import rc_context

    text = io.StringIO()
    with rc_context({"svg.hashsalt": name, "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", dpi=150, metadata={"Date": None})
    found = text.getvalue()
    return Markup(found[found.index("<svg") :])


def placesOn(figure, points):
    """Points of the first axes of a figure in the units of its :func:`svg`: a text "x,y x,y"."""
    if not points:
        return ""
    axes = figure.axes[0]
    share = figure.transFigure.inverted().transform(axes.transData.transform(points))
    wide, high = 72 * figure.get_size_inches()
    return " ".join(f"{wide * x:.1f},{high * (1 - y):.1f}" for x, y in share)
