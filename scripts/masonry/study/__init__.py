"""Studies: one scene, run many times with values that vary. This package needs no YADE.

A study is a small Python file::

    from masonry.study import Study, lognormal

    study = Study(
        "wall_comp4",
        options={"preset": "fast", "until": 6},
        runs=200,
        seed=1,
        vary={"bed.cohesion": lognormal(mean=0.11e6, cov=0.2), "bed.friction": lognormal(mean=0.43, cov=0.05)},
    )

``/usr/bin/python3 -m masonry.study FILE --out DIR`` runs it, goes on with it, and gathers what came out in ``DIR/study.csv``.
``scripts/STUDIES.md`` is its manual. Distributions, correlation and designs are those of OpenTURNS (Debian's
python3-openturns); a grid of numbers and choices needs no more than Python.
"""

from .plan import Study
from .variables import Distribution, Field, choice, field, lognormal, normal, uniform

__all__ = "Study Distribution Field choice field lognormal normal uniform".split()
