# SPDX-License-Identifier: GPL-2.0-or-later
"""Studies: one scene, run many times with values that vary. This package needs no YADE.

A study is a small Python file::

    from masonry_study import Study, lognormal

    study = Study(
        "wall_comp4",
        options={"preset": "fast", "until": 6},
        runs=200,
        seed=1,
        vary={
            "bed.cohesion": lognormal(mean=0.11e6, cov=0.2),
            "bed.friction": lognormal(mean=0.43, cov=0.05),
        },
    )

A study with ``design="ida"`` shakes its scene by records that grow until it falls, and gives its
fragility.

``/usr/bin/python3 -m masonry_study FILE --out DIR`` runs it, goes on with it, and gathers what came
out in ``DIR/study.csv``. ``scripts/STUDIES.md`` is its manual. Distributions, correlation and
designs are those of OpenTURNS (Debian's python3-openturns); a grid of numbers and choices needs no
more than Python.
"""

from masonry.wings import folderOf

__path__ = folderOf(__name__)

import importlib
from typing import TYPE_CHECKING

_VARIABLES = "Distribution", "Field", "choice", "field", "lognormal", "normal", "uniform"
#: Public names with the module that has them. They are loaded when they are used first, because a
#: row needs none of them.
_NAMES = {
    "Study": "plan",
    "Sa": "incremental",
    "Calibration": "calibrate",
    "Specimen": "calibrate",
    **dict.fromkeys(_VARIABLES, "variables"),
}
__all__ = [*_NAMES]


if TYPE_CHECKING:
    from .calibrate import Calibration, Specimen
    from .incremental import Sa
    from .plan import Study
    from .variables import Distribution, Field, choice, field
    from .variables import lognormal, normal, uniform
else:

    def __getattr__(name):
        if name not in _NAMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f"{__name__}.{_NAMES[name]}"), name)


def __dir__():
    return sorted({*globals(), *__all__})
