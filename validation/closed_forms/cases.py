# SPDX-License-Identifier: GPL-2.0-or-later
"""What a case of this folder is: a closed form, and a function that measures the same with the
engine."""

import math
import os
import time
from dataclasses import dataclass

#: All cases in the order in which their files were read: a list of :class:`Case`.
CASES = []


@dataclass
class Case:
    """A closed form and how it is measured.

    :param name: by which it is called
    :param group: heading in the table
    :param what: what is compared, with its unit
    :param source: of the expected value
    :param measure: function of whether the quick variant is asked for; it gives the expected value
        and the measured one, a number, or the two ends between which it lies
    :param aim: largest error; None: the value is reported only
    :param absolute: whether the aim is in the unit of the value, not a share of the expected value
    :param misses: why the aim is not met, if that is known
    :param quick: whether the tests run it
    """

    name: str
    group: str
    what: str
    source: str
    measure: object
    aim: float = None
    absolute: bool = False
    misses: str = ""
    quick: bool = False

    def run(self, quick=False):
        """Measure. Returns a :class:`Result`; what the case raises is raised."""
        began = _seconds()
        expected, measured = self.measure(quick)
        return Result(self, expected, measured, _seconds() - began)


@dataclass
class Result:
    """What a case gave: expected value, measured one (a number or two ends), and seconds of
    processor time."""

    case: Case
    expected: float
    measured: object
    seconds: float

    @property
    def middle(self):
        if isinstance(self.measured, tuple):
            return 0.5 * sum(self.measured)
        return self.measured

    @property
    def error(self):
        """Of the measured value, or of the middle of its bracket: in its unit if the aim is, else
        as a share."""
        away = self.middle - self.expected
        return away if self.case.absolute else away / self.expected

    @property
    def met(self):
        """Whether the error is within the aim; None: there is no aim."""
        if self.case.aim is None:
            return None
        return bool(abs(self.error) <= self.case.aim)


def case(group, what, source, **settings):
    """Make a case of a function, whose name becomes that of the case. Parameters as of
    :class:`Case`."""

    def made(measure):
        name = measure.__name__.strip("_").replace("_", "-")
        CASES.append(Case(name, group, what, source, measure, **settings))
        return measure

    return made


def between(below, expected, aim, quick, spread=0.15, within=0.002):
    """The two ends of a bracket around a limit.

    The quick variant asks at two places only, the aim below and the aim above the expected value.
    The other one halves.

    :param below: function of a value that tells whether it lies below the limit, for example
        whether a structure stands under that load
    :param aim: of the quick variant, as a share of the expected value
    :param spread: where halving begins, around the expected value [-]
    :param within: width of the bracket at the end, as a share of the expected value
    :returns: low and high end. If the limit lies outside of what was asked for, one end is 0 or
        infinite
    """
    share = aim if quick else spread
    low, high = (1 - share) * expected, (1 + share) * expected
    if not below(low):
        return 0.0, low
    if below(high):
        return high, math.inf
    while not quick and high - low > within * expected:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if below(middle) else (low, middle)
    return low, high


def _seconds():
    """Processor time of this process and of the programs that it has waited for [s]."""
    return time.process_time() + sum(os.times()[2:4])
