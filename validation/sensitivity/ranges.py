# SPDX-License-Identifier: GPL-2.0-or-later
"""The values of the joint law that the paper leaves open, each with its range and the reason for
it.

Every name is that of a property of joints, or several that have the same value. All ranges hold
together: any value of one goes with any value of the others. So some ends are closer than those
that ``tornado.py`` gives to one value alone.
"""

from masonry.study import uniform

BONDS = lambda name: (f"bed.{name}", f"head.{name}")

#: Property -> its range, and why.
RANGES = {
    # what the paper leaves open: yade_plugin/law/README.md, parameters
    BONDS("modeIFractureEnergy"): (
        uniform(8, 32),
        "half (the authors' other rule) and double",
    ),
    BONDS("modeIIFractureEnergy"): (
        uniform(80, 320),
        "half (the authors' other rule) and double",
    ),
    BONDS("residualFriction"): (
        uniform(0.30, 0.387),
        "0.7 of the peak value; at most the least friction here",
    ),
    BONDS("residualCohesion"): (
        uniform(0, 0.033e6),
        "0 at least; 0.3 of the peak value",
    ),
    BONDS("dilatancy"): (
        uniform(0, 0.1),
        "0 at least; a joint that climbs 0.1 mm a mm of slip",
    ),
    BONDS("residualStrengthRatio"): (uniform(0.1, 0.4), "half and double"),
    BONDS("elasticLimitRatio"): (
        uniform(0.2, 0.4),
        "the paper says 30 to 40 %; 20 % to the other side",
    ),
    BONDS("capShear"): (
        uniform(4, 16),
        "largest shear stress of the cap fc/2 and fc/4, not fc/3",
    ),
    BONDS("capNormal"): (
        uniform(0.8, 1.25),
        "uniaxial strength 12 % higher and 11 % lower",
    ),
    BONDS("capLinear"): (
        uniform(-0.75e6, 0.75e6),
        "a tenth of fc to either side; positive widens",
    ),
    BONDS("shearStiffness"): (
        uniform(0.7225e11, 2.89e11),
        "eq. (26) has the unit's ν for mortar: half and double",
    ),
    "support.normalStiffness": (
        uniform(1.117e11, 1.006e12),
        "the paper says stiff and elastic, no more: a third and three times",
    ),
    "support.shearStiffness": (uniform(0.4817e11, 4.335e11), "the same"),
    # brick crack surfaces: yade_plugin/law/README.md, crack surfaces
    "crack.tensileStrength": (
        uniform(0.75e6, 1.5e6),
        "half; with more and less energy, softening snaps back between rigid halves",
    ),
    "crack.modeIFractureEnergy": (
        uniform(60, 120),
        "with less softening snaps back between rigid halves; double",
    ),
    "crack.cohesion": (
        uniform(1.5e6, 3e6),
        "half; with more and less energy, softening snaps back between rigid halves",
    ),
    "crack.modeIIFractureEnergy": (
        uniform(500, 1000),
        "with less softening snaps back between rigid halves; double",
    ),
    ("crack.friction", "crack.residualFriction"): (uniform(0.6, 1), "31° to 45°"),
    # measured values, the paper's table 2, beside them for scale
    BONDS("friction"): (
        uniform(0.387, 0.473),
        "measured: scatter of a triplet test, 10 %",
    ),
    BONDS("cohesion"): (
        uniform(0.088e6, 0.132e6),
        "measured: scatter of a triplet test, 20 %",
    ),
    BONDS("tensileStrength"): (
        uniform(0.08e6, 0.12e6),
        "measured: scatter of a bond test, 20 %",
    ),
}

#: For :class:`masonry.study.Study`.
VARY = {name: found for name, (found, _) in RANGES.items()}
