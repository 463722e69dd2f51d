# SPDX-License-Identifier: GPL-2.0-or-later
"""Stages that last for a given time: steps, rows and frames evenly in time."""

from dataclasses import dataclass
from typing import Annotated

from yade import O

from ...common.arguments import number
from .answers import DONE

ROWS = 500  # of curve.csv in such a stage
FRAMES = 20  # for ParaView in such a stage


@dataclass
class Timed:
    """What such a stage remembers."""

    done: int = 0  # steps so far
    nextFrame: int = 0  # number of the step after which a frame is due


#: Kinds of arguments: a time that is not longer than a day, and one above 0 [s].
Time = Annotated[float, number("s", 0, 86400)]
Duration = Annotated[float, number("s", 0, 86400, above=True)]


def timed(scene, at, duration, before, after=None, each=None):
    """Steps for a duration [s], with rows and frames evenly in time.

    :param at: :class:`Timed`
    :param before: function of the number of steps so far and after the next stretch, called before each stretch
    :param after: called after each row
    :param each: steps of a stretch; None: 20, or fewer
    """
    running, step = scene.running, O.step
    length = max(1, round(duration / O.dt))
    stretch = each or max(1, min(20, length // ROWS))
    perRow = max(stretch, length // ROWS // stretch * stretch)
    perFrame = max(1, length // FRAMES)

    def alone(number):  # a step with its own ``before``
        before(at.done + number, at.done + number + 1)
        step()

    while at.done < length:
        goal = min(length, (at.done // perRow + 1) * perRow)
        beyond = min(goal, at.done + stretch)
        before(at.done, beyond)
        beyond = goal if stretch == 1 else beyond
        running.advance(beyond - at.done, alone if stretch == 1 else None)
        at.done = beyond
        if at.done < goal:
            continue
        running.record()
        text = lambda: f"{at.done * O.dt:.3f} of {duration:.3f} s"
        running.show(at.done / length, text)
        if at.done >= at.nextFrame:
            running.frame()
            at.nextFrame += perFrame
        if after:
            after()
    running.show(1, lambda: f"{duration:.3f} s", final=True)
    running.flush()
    return DONE
