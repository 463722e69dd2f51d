# SPDX-License-Identifier: GPL-2.0-or-later
"""What stages and a run ask of limit analysis, the object ``scene.bounds``, which the wing
masonry_limit gives; without it there are no bounds."""

import contextlib
import time

from .. import wings

SOON = 1.0  # [s] in which a run that is interrupted waits for its bound


def boundsOf(scene):
    """The bounds of a scene. Raises NotInstalled if the run is limit analysis alone, and the wing
    is missing."""
    if scene.limitAnalysisOnly or wings.isInstalled("--preset bound"):
        bounds, running = wings.find("--preset bound"), scene.running
        return bounds(scene.model, running.at, running.auxiliary)
    return wings.Absent()


def findBy(scene, kind, *load, **how):
    """Find a bound by a method of ``scene.bounds``, which Ctrl-C and SIGTERM end at once."""
    with scene.running.breakable():
        return getattr(scene.bounds, kind)(*load, **how)


def takeFound(scene, wait):
    """Take the bound that is found beside the run; a run that is interrupted does not wait long for
    it."""
    began, running = time.monotonic(), scene.running
    late = lambda: running.interrupted and time.monotonic() - began > SOON
    scene.bounds.take(wait, late)
    if not (running.interrupted or scene.args.lean):
        with contextlib.suppress(OSError):  # it is said when figures are drawn
            scene.outcome.drawing.start()


def findBound(scene, kind, *load):
    """Find the bound of a stage, which pushes or leans."""
    bounds = scene.bounds
    resumed = scene.running.redoes and scene.running.takesUp
    if scene.args.lean and not scene.limitAnalysisOnly or resumed and not bounds.isGivenUp():
        return  # in a stage that goes on it was found when that began
    lowerUpTo = bounds.SMALL * scene.limitAnalysisOnly
    with scene.running.auxiliary("limit analysis"):
        findBy(scene, kind, *load, lowerUpTo=lowerUpTo, background=not scene.limitAnalysisOnly)
