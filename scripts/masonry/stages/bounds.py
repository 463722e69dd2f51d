# SPDX-License-Identifier: GPL-2.0-or-later
"""What stages and a run ask of ``scene.bounds``, the limit analysis of the wing masonry_limit;
without it there are no bounds."""

import contextlib
import time

from .. import wings

SOON = 1.0  # [s] in which a run that is interrupted waits for its bound


def boundsOf(scene):
    """The bounds of a scene. Raises NotInstalled if a run of limit analysis alone has no wing."""
    if scene.limitAnalysisOnly or wings.isInstalled("--preset bound"):
        bounds, running = wings.find("--preset bound"), scene.running
        return bounds(scene.model, running.state, running.auxiliary)
    return wings.Absent()


def findBy(scene, kind, *load, **how):
    """Find a bound by a method of ``scene.bounds``, which Ctrl-C and SIGTERM end at once."""
    with scene.running.breakable():
        return getattr(scene.bounds, kind)(*load, **how)


def takeFound(scene, wait):
    """Take the bound that is found beside the run; a run that is interrupted hardly waits."""
    began, running = time.monotonic(), scene.running
    late = lambda: running.interrupted and time.monotonic() - began > SOON
    scene.bounds.take(wait, late)
    if not (running.interrupted or scene.args.lean):
        with contextlib.suppress(OSError):  # it is said when figures are drawn
            scene.outcome.drawing.start()


def findBound(scene, kind, *load):
    """Find the bound of a stage, which pushes or leans."""
    bounds = scene.bounds
    resumed = scene.running.resumedHere and scene.running.isResumed
    if scene.args.lean and not scene.limitAnalysisOnly or resumed and not bounds.isGivenUp():
        return  # in a stage that goes on it was found when that began
    lowerUpTo = bounds.SMALL * scene.limitAnalysisOnly
    with scene.running.auxiliary("limit analysis"):
        findBy(scene, kind, *load, lowerUpTo=lowerUpTo, background=not scene.limitAnalysisOnly)
