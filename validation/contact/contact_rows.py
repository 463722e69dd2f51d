# SPDX-License-Identifier: GPL-2.0-or-later
"""What a case of this folder is: a function that runs the engine and gives rows of measured numbers
with their limits."""

from dataclasses import dataclass

#: All cases by their names, in the order in which their files were read.
CASES = {}


@dataclass
class Row:
    """A measured number beside what is expected, and its limit.

    :param what: what is measured, with its unit
    :param source: of the expected value or of the bound
    :param measured: the number
    :param expected: the value, or the two ends of a range; None: there is a bound alone
    :param limit: largest error as a share of the expected value; without an expected value the
        largest measured number; None: the number is reported only
    :param misses: why the limit is not met, if that is known
    """

    what: str
    source: str
    measured: float
    expected: object = None
    limit: float = None
    misses: str = ""

    @property
    def error(self):
        """As a share of the expected value; None without one."""
        if self.expected is None or isinstance(self.expected, tuple):
            return None
        return self.measured / self.expected - 1

    @property
    def met(self):
        """Whether the limit is kept; None: there is none."""
        if isinstance(self.expected, tuple):
            return self.expected[0] <= self.measured <= self.expected[1]
        if self.limit is None:
            return None
        if self.expected is None:
            return bool(self.measured <= self.limit)
        return bool(abs(self.error) <= self.limit)

    def cells(self):
        """Cells of the table behind the name of the case: what, source, expected, measured, error,
        limit."""
        expected = self.expected
        if isinstance(expected, tuple):
            shown, limit = f"{expected[0]:.5g} … {expected[1]:.5g}", "within"
        else:
            shown = "" if expected is None else f"{expected:.5g}"
            limit = "reported" if self.limit is None else f"≤ {self.limit:g}"
            if self.limit is not None and expected is not None:
                limit = f"± {100 * self.limit:g} %"
        if self.met is False:
            limit += ", **missed**"
        error = "" if self.error is None else f"{100 * self.error:+.2f} %"
        return [self.what, self.source, shown, f"{self.measured:.5g}", error, limit]


def case(run):
    """Make a case of a function of whether the quick variant is asked for, which gives rows. Its
    name is that of the case."""
    CASES[run.__name__.strip("_").replace("_", "-")] = run
    return run
