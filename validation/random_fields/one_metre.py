"""COMP-4 with bond strengths that vary over a metre: 1,000 walls."""

from masonry.study import Study, field

study = Study(
    "wall_comp4",
    options={"preset": "fast", "until": 6},
    runs=1000,
    seed=1,
    vary={
        (
            "bed.cohesion",
            "bed.tensileStrength",
            "head.cohesion",
            "head.tensileStrength",
        ): field(cov=0.3, length=1.0)
    },
)
