# SPDX-License-Identifier: GPL-2.0-or-later
"""The scene in YADE's own 3-D view, while it runs.

    from masonry import window

    window.show(joints="damage", blocks="displacement", scale=50)

The script must run in a YADE with its graphical interface (``yade my_scene.py``, without ``-n``),
on a display, or under ``xvfb-run`` with :func:`picture`.
"""

import threading
import time
from typing import Any

from yade import O, Vector3
from yade.wrapper import Gl1_MasonryBlock, Gl1_MasonryJointPhys, GlExtra_MasonryLegend
from yade.wrapper import PyRunner

from ..arguments import FilePath

#: Label of the engine that keeps the view alive.
_LABEL = "masonryWindow"

_drawingTime = 0.0


def show(
    blocks: str = "displacement",
    joints: str = "damage",
    scale: float = 1.0,
    edges: bool = True,
) -> Any:
    """Open YADE's 3-D view with blocks, joints and a legend, and draw it at most ten times a second
    while the script takes steps. Call it when the scene has its engines. Deformable units are drawn
    undeformed.

    :param blocks: colours of blocks by ``"displacement"``, ``"velocity"``, ``"material"``, or their
        ``"own"``
    :param joints: colours of joints by ``"damage"`` (the largest of tension, shear and
        compression), ``"opening"``, ``"regime"``, or None for no joints
    :param scale: factor of displacements and rotations [-]
    :param edges: whether the edges of blocks are drawn
    :raises ValueError: for an unknown choice, or without the graphical interface
    """
    qt = _qt()
    Gl1_MasonryBlock(colours=blocks, edges=edges)
    drawn = Gl1_MasonryJointPhys(scale=scale)
    if joints is not None:
        drawn.colours = joints
    view = qt.views()[0] if qt.views() else qt.View()
    renderer = qt.Renderer()
    renderer.dispScale, renderer.rotScale = (scale,) * 3, scale
    renderer.intrPhys = joints is not None
    renderer.bgColor = (1, 1, 1)
    renderer.extraDrawers = [GlExtra_MasonryLegend()]
    if not any(e.label == _LABEL for e in O.engines):
        command = "import masonry; masonry.model.window.refresh()"
        O.engines += [PyRunner(command=command, realPeriod=0.1, label=_LABEL)]
    _look(view, scale)
    refresh()
    return view


def _look(view, scale):
    """Turn the view to all blocks of a wall in the x-z plane, a little from above."""
    corners = [
        b.state.pos + (scale - 1) * b.state.displ() + b.state.ori * v
        for b in O.bodies
        for v in getattr(b.shape, "v", ())
    ]
    if corners:
        low, high = (Vector3(*map(pick, zip(*corners))) for pick in (min, max))
        view.sceneRadius = (high - low).norm()
        view.viewDir, view.upVector = (0.25, 0.95, -0.2), (0, 0, 1)
        view.fitAABB(low, high)


def refresh() -> None:
    """Let the view draw and answer the mouse now, unless the run is in the background."""
    global _drawingTime
    if threading.current_thread() is threading.main_thread():
        start = time.process_time()
        _application().processEvents()
        _drawingTime += time.process_time() - start


def drawingTime() -> float:
    """Processor time of the view so far in this thread [s]."""
    return _drawingTime


def picture(path: FilePath, wait: float = 2.0) -> None:
    """Save what the view shows, after :func:`show`.

    :param path: with an ending that Qt knows, as ``.png``
    :param wait: how long the view may take to draw [s]
    """
    end = time.monotonic() + wait
    while time.monotonic() < end:
        refresh()
        time.sleep(0.02)
    widgets = [w for w in _application().allWidgets() if w.inherits("QOpenGLWidget")]
    if not widgets:
        raise ValueError("window.picture: there is no view; window.show() opens one")
    if not widgets[0].grabFramebuffer().save(str(path)):
        raise OSError(f"window.picture: cannot write {path}")


def _application():
    from PyQt5.QtWidgets import QApplication

    return QApplication.instance()


def _qt():
    try:
        from yade import qt

        if _application() is None:
            raise ImportError("no application")
    except ImportError as error:
        raise ValueError(
            "window.show needs YADE's graphical interface: start yade without -n, on a display or"
            f" under xvfb-run ({error})"
        ) from None
    return qt
