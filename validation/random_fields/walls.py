# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls whose bond strengths vary from joint to joint. The studies beside this file differ in their
correlation length."""

from masonry_study import Study, field

#: Cohesion and tensile strength of bed and head joints, which are strong and weak together.
BONDS = (
    "bed.cohesion",
    "bed.tensileStrength",
    "head.cohesion",
    "head.tensileStrength",
)


def walls(length):
    """100 walls COMP-4 with a lognormal field of bond strengths about those of the scene.

    :param length: correlation length [m]
    """
    return Study(
        "wall_comp4",
        options={"preset": "fast", "until": 6},
        runs=100,
        seed=1,
        vary={BONDS: field(cov=0.3, length=length)},
    )
