# SPDX-License-Identifier: GPL-2.0-or-later
"""Properties that vary from place to place, for :meth:`masonry.materials.Masonry.vary`. No YADE is
needed.

Each function returns a function of x, y and z [m] whose value is a factor on a property [-], with
the mean 1::

    cohesion = fields.lognormal(cov=0.2, length=0.5, seed=1)
    masonry = materials.calciumSilicate().vary("bed.cohesion", cohesion)

A random field is the sum of :data:`WAVES` cosines with random directions, lengths and phases. Its
values at two points a distance d apart have the correlation exp(-(d/length)²), before the
exponential of a lognormal field.
"""

import math
import re
from typing import Annotated, Any

import numpy as np

from ..arguments import number, shown, validated, whole
from .settings import Factor

WAVES = 512  # cosines of a field: errors of its moments are some 1/sqrt(WAVES) at most


def _standard(length, seed):
    """A field of mean 0 and variance 1."""
    if length == 0:

        def independent(x, y, z):
            place = [int(round(1e6 * float(v))) & 0xFFFFFFFF for v in (x, y, z)]
            return np.random.default_rng([seed, *place]).standard_normal()

        return independent
    random = np.random.default_rng(seed)
    # the waves of exp(-(d/length)²) are normally distributed
    waves = random.normal(0, math.sqrt(2) / length, (WAVES, 3))
    phases = random.uniform(0, 2 * math.pi, WAVES)
    return lambda x, y, z: math.sqrt(2 / WAVES) * float(
        np.cos(waves @ (float(x), float(y), float(z)) + phases).sum()
    )


Cov = Annotated[float, number("", 0, 100, above=True)]
Correlation = Annotated[float, number("m", 0, 1e6)]
Seed = Annotated[int, whole()]


@validated
def lognormal(cov: Cov, length: Correlation = 0.0, seed: Seed = 0) -> Factor:
    """Factors that are lognormally distributed about the mean 1.

    :param cov: coefficient of variation, standard deviation over mean [-]
    :param length: correlation length [m]; 0: every joint has its own value
    :param seed: the same number gives the same field
    """
    field, spread = _standard(length, seed), math.sqrt(math.log1p(cov * cov))
    return lambda x, y, z: math.exp(spread * field(x, y, z) - spread * spread / 2)


LEAST = 0.05  # factor below which a normal field does not go


@validated
def normal(
    cov: Cov,
    length: Correlation = 0.0,
    seed: Seed = 0,
    least: Annotated[float, number("", 0, 1, above=True, below=True)] = LEAST,
) -> Factor:
    """Factors that are normally distributed about the mean 1, but not below ``least``; see
    :func:`lognormal`."""
    field = _standard(length, seed)
    return lambda x, y, z: max(least, 1 + cov * field(x, y, z))


KINDS: dict[str, Any] = {"lognormal": lognormal, "normal": normal}
_TEXT = re.compile(
    r"(?P<names>[^=]+)=(?P<kind>lognormal|normal)"
    r"\(cov=(?P<cov>[^,]+),length=(?P<length>[^,]+),seed=(?P<seed>\d+)\)"
)


def parts(text: str) -> tuple[Any, ...]:
    """Names, kind, coefficient of variation, length [m] and seed of a field in a text."""
    found = _TEXT.fullmatch(text) if isinstance(text, str) else None
    names = found["names"].split("+") if found else []
    if not found or not all(re.fullmatch(r"[^.\s]+\.\w+", name) for name in names):
        raise ValueError(
            f"{shown(text)} must read JOINT.PROPERTY=KIND(cov=C,length=L,seed=N), KIND lognormal or"
            " normal, L in m"
        )
    try:
        numbers = float(found["cov"]), float(found["length"])
    except ValueError:
        raise ValueError(f"'{text}': cov and length must be numbers") from None
    return names, found["kind"], *numbers, int(found["seed"])


def read(text: str) -> tuple[list[str], Factor]:
    """The names of the properties and the function of a field of ``--field``, as
    ``bed.cohesion+bed.tensileStrength=lognormal(cov=0.3,length=0.5,seed=1)``. Raises ValueError."""
    names, kind, cov, length, seed = parts(text)
    return names, KINDS[kind](cov, length, seed)


def written(kind: str, cov: float, length: float, seed: int) -> str:
    """The text of a field behind the names."""
    return f"{kind}(cov={cov!r},length={length!r},seed={seed})"


def ends(kind: str, cov: float, far: float) -> tuple[float, ...]:
    """Factors of a field [-] where its normal is ``far`` standard deviations off its mean."""
    if kind == "lognormal":
        spread = math.sqrt(math.log1p(cov * cov))
        return tuple(math.exp(s * far * spread - spread**2 / 2) for s in (-1, 1))
    return max(LEAST, 1 - far * cov), 1 + far * cov
