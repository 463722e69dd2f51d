# SPDX-License-Identifier: GPL-2.0-or-later
"""What varies in a study: distributions, choices, and random fields over the joints."""

import bisect
import itertools
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Sequence

from masonry.arguments import LONGEST, SHORTEST
from masonry.arguments import isA, isNumber, listOf, number, require, shown, validated, text
from masonry.materials import fields
from masonry.errors import Refused
from masonry.packages import needed

LEAST_COV = 1e-6  # coefficient of variation below which nothing varies [-]
NEVER = 1e-9  # probability beyond the bounds of a property that does not matter [-]
Finite = Annotated[float, number()]


@dataclass(frozen=True)
class Distribution:
    """A distribution of one number: :func:`lognormal`, :func:`normal`, :func:`uniform`.

    :param kind: its name
    :param parameters: pairs of a name and a number
    """

    kind: str
    parameters: tuple

    def law(self) -> Any:
        ot, p = needed("openturns"), dict(self.parameters)
        if self.kind == "uniform":
            return ot.Uniform(p["low"], p["high"])
        mean, deviation = p["mean"], p["mean"] * p["cov"]
        if self.kind == "lognormal":
            made = ot.LogNormalMuSigma(mean, deviation, 0.0).getDistribution()
        else:
            made = ot.Normal(mean, abs(deviation))
        if not {"low", "high"} & {*p}:
            return made
        return ot.TruncatedDistribution(made, _interval(p.get("low"), p.get("high")))

    def valuesAt(self, probabilities: Sequence[float]) -> list[float]:
        """The values that are not exceeded with these probabilities."""
        law = self.law()
        return [float(law.computeQuantile(u)[0]) for u in probabilities]

    def beyond(self, low: float | None, high: float | None) -> float:
        """Probability of a value below ``low`` or above ``high``; None is no bound [-]."""
        law = self.law()
        below = 0.0 if low is None else law.computeCDF(low)
        return below + (0.0 if high is None else law.computeComplementaryCDF(high))

    def describe(self) -> dict[str, Any]:
        return {"kind": self.kind, **dict(self.parameters)}

    def __str__(self):
        return f"{self.kind}({', '.join(f'{n}={v:g}' for n, v in self.parameters)})"


def _interval(low, high):
    """The numbers between two ends, as OpenTURNS has them; None is no end."""
    ot = needed("openturns")
    most = ot.SpecFunc.MaxScalar  # it compares the numbers of open ends, too
    ends = [-most if low is None else low], [most if high is None else high]
    return ot.Interval(*ends, [low is not None], [high is not None])


def _aboutMean(kind, mean, cov, low, high):
    ends = {n: v for n, v in (("low", low), ("high", high)) if v is not None}
    whole = Distribution(kind, (("mean", mean), ("cov", cov)))
    if not cov >= LEAST_COV:
        raise Refused(
            f"{kind}: coefficient of variation {cov} must be above 0, and at least {LEAST_COV:g}"
        )
    if not SHORTEST <= (mean if kind == "lognormal" else abs(mean)) <= LONGEST:
        raise Refused(f"{kind}: mean {mean:g} must be above 0, from {SHORTEST:g} to {LONGEST:g}")
    if low is not None and high is not None and not low < high:
        raise Refused(f"{kind}: low {low:g} must be below high {high:g}")
    made = Distribution(kind, (*whole.parameters, *ends.items()))
    kept = whole.law().computeProbability(_interval(low, high)) if ends else 1
    if not kept > NEVER:
        raise Refused(
            f"{made}: its ends leave {kept:.3g} of the distribution, they must leave more than"
            f" {NEVER:g}"
        )
    return made


@validated
def lognormal(
    mean: Finite, cov: Finite, low: Finite | None = None, high: Finite | None = None
) -> Distribution:
    """A lognormal distribution. Raises Refused if nearly nothing is between its two ends.

    :param mean: in the unit of what varies
    :param cov: coefficient of variation, standard deviation over mean [-]
    :param low: cuts it off below, ``high`` above; mean and cov are those before
    """
    return _aboutMean("lognormal", mean, cov, low, high)


@validated
def normal(
    mean: Finite, cov: Finite, low: Finite | None = None, high: Finite | None = None
) -> Distribution:
    """A normal distribution. Parameters are those of :func:`lognormal`. Most properties need a
    ``low`` end."""
    return _aboutMean("normal", mean, cov, low, high)


@validated
def uniform(low: Finite, high: Finite) -> Distribution:
    """All values between two ends alike."""
    if not low < high:
        raise Refused(f"uniform: low {low:g} must be below high {high:g}")
    return Distribution("uniform", (("low", low), ("high", high)))


@dataclass(frozen=True)
class Choice:
    """One of some values; ``weights`` are probabilities."""

    values: tuple
    weights: tuple

    def valuesAt(self, probabilities: Sequence[float]) -> list[Any]:
        ends = [*itertools.accumulate(self.weights)][:-1]
        return [self.values[bisect.bisect_right(ends, u)] for u in probabilities]

    def describe(self) -> dict[str, Any]:
        return {"kind": "choice", **asdict(self)}


def _chosen(value, first=None):
    if isinstance(value, str):
        return text(value)
    if isNumber(value):
        return number()(value)
    return require(value, isinstance(value, bool), "a number, a text, or True or False")


@validated
def choice(
    *values: Annotated[Any, _chosen],
    weights: Annotated[Sequence[float], listOf(number("", 0, 1e9, above=True))] | None = None,
) -> Choice:
    """One of some values, for example ``choice("softening", "brittle")``. A list in ``vary`` means
    the same.

    :param weights: how often each comes, relative to the others; None: all alike. A grid leaves
        them alone
    """
    if not values:
        raise Refused("choice: needs at least one value")
    if len(set(values)) != len(values):
        raise Refused(f"choice: {list(values)} has a value twice")
    weights = [1] * len(values) if weights is None else list(weights)
    if len(weights) != len(values):
        raise Refused(f"choice: {len(values)} values need as many weights above 0")
    return Choice(values, tuple(w / sum(weights) for w in weights))


@dataclass(frozen=True)
class Field:
    """A random field over the joints: :func:`field`."""

    kind: str
    mean: object
    cov: float
    length: float

    def describe(self) -> dict[str, Any]:
        entries = asdict(self)
        return {"kind": "field", "of": entries.pop("kind"), **entries}

    def written(self, seed: int) -> str:
        return fields.written(self.kind, self.cov, self.length, seed)


@validated
def field(
    distribution: Annotated[Distribution, isA(Distribution)] | None = None,
    length: fields.Correlation = 0.0,
    cov: fields.Cov | None = None,
) -> Field:
    """A property that varies from joint to joint, with another field in every row.

    :param distribution: :func:`lognormal` or :func:`normal` of the values; None: lognormal about
        the value that the scene has, with ``cov``
    :param length: correlation length [m], see :mod:`masonry.materials.fields`; 0: joints are
        independent
    :param cov: coefficient of variation [-], where there is no distribution
    """
    if distribution is None:
        if cov is None:
            raise Refused("field: cov must be given, where there is no distribution")
        return Field("lognormal", None, float(cov), float(length))
    if cov is not None:
        raise Refused("field: cov goes with no distribution, which has its own")
    if distribution.kind not in fields.KINDS:
        raise Refused(f"field: {shown(distribution)} must be lognormal or normal")
    p = dict(distribution.parameters)
    if "low" in p or "high" in p:
        raise Refused("field: its distribution cannot be cut off")
    return Field(distribution.kind, float(p["mean"]), float(p["cov"]), float(length))
