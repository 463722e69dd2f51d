# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines of progress and the end of a run in a notebook. Nothing of Jupyter is loaded: the kernel
has loaded it."""

import html
import sys


def isHere():
    """Whether this process is the kernel of a notebook."""
    shells = sys.modules.get("IPython.core.getipython")
    shell = shells.get_ipython() if shells else None
    return getattr(shell, "kernel", None) is not None


class Line:
    """A line in the output of a cell that is kept up to date."""

    def __init__(self):
        self._handle = None

    def show(self, text, fraction):
        """Write the line, with a bar for the fraction that is done, 0 to 1 [-]."""
        from IPython.display import display

        done = min(max(fraction, 0.0), 1.0)
        bar = f'<progress max="1" value="{done:.3f}"></progress> {html.escape(text)}'
        page = f'<div style="font-family:monospace;white-space:pre-wrap">{bar}</div>'
        data = {"text/plain": text, "text/html": page}
        if self._handle:
            self._handle.update(data, raw=True)
        else:
            self._handle = display(data, raw=True, display_id=True)


class Stopped(KeyboardInterrupt):
    """The kernel was interrupted, and a run ended in order. The cells that follow do not run."""

    def _render_traceback_(self):
        return [str(self)]


class RunFailed(Exception):
    """A run ended before its time. The cells that follow do not run."""

    _render_traceback_ = Stopped._render_traceback_


def ended(name, status, folder, error):
    """The error with which a run ends a cell.

    :param status: exit status that a script would have
    :param folder: of the results, or None
    :param error: what ended it, or None
    """
    if status == 130:
        kept = (
            f"; scene = scene.resume() goes on, and its results so far are in {folder}"
            if folder
            else ""
        )
        return Stopped(f"{name}: interrupted{kept}")
    why = f": {error}" if error else ", as was said above"
    return RunFailed(f"{name}: the run ended before its time{why}")
