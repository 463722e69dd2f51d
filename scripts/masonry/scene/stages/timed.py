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
    running = scene.running
    length = max(1, round(duration / O.dt))
    stretch = each or max(1, min(20, length // ROWS))
    perRow = max(stretch, length // ROWS // stretch * stretch)
    perFrame = max(1, length // FRAMES)
    while at.done < length:
        goal = min(length, (at.done // perRow + 1) * perRow)
        if stretch == 1:
            before(at.done, at.done + 1)
            _stepping(running, at, goal, before)
        else:
            beyond = min(goal, at.done + stretch)
            before(at.done, beyond)
            running.advance(beyond - at.done)
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
    scene.ended = DONE


def _stepping(running, at, goal, before):
    """Steps up to a goal, with ``before`` ahead of each of them."""
    step, first = O.step, at.done

    def one(number):
        before(first + number, first + number + 1)
        step()

    running.advance(goal - first, one)
    at.done = goal
