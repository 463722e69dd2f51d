# SPDX-License-Identifier: GPL-2.0-or-later
"""Published parameter sets. Each function names its source, and what is assumed.

The paper: see yade_plugin/law/README.md.
"""

from typing import Annotated, Any

from yade import Vector3
from yade.wrapper import MasonryJoint, MasonryMat

from ..arguments import isNumber, number, shown, validated
from .assumptions import state
from .kinds import Masonry, Poisson, slipping


def calciumSilicate() -> Masonry:
    """Calcium-silicate masonry of the TUD-COMP walls, for :class:`masonry.scene.scene.Scene`."""
    return Masonry(calciumSilicateUnit(), calciumSilicateJoints(), brief=True)


#: Young's modulus [Pa] of dry granite masonry at each vertical load [kN] of the tests (Vanin et al.
#: 2017).
DRY_GRANITE_MASONRY = {100: 3.287e9, 175: 4.068e9, 250: 4.722e9}


def tested(value: Any, context: Any = None) -> Any:
    if not isNumber(value) or value not in DRY_GRANITE_MASONRY:
        levels = ", ".join(map(str, DRY_GRANITE_MASONRY))
        raise ValueError(f"{shown(value)} kN was not tested, there are {levels}")
    return value


Level = Annotated[int, tested]
Course = Annotated[float, number("m", 1e-3, 10)]


@validated
def dryGranite(level: Level, height: Course) -> Masonry:
    """Granite blocks with dry joints, for :class:`masonry.scene.scene.Scene`. Parameters as in
    :func:`dryGraniteJoints`."""
    return Masonry(graniteUnit(), dryGraniteJoints(level, height), brief=True)


MAX_FRICTION = 5.0  # [-] of a joint: a larger one is an angle
Stiffness = Annotated[float, number("Pa/m", 0, 1e20, above=True)]
#: What stones with dry joints have if nothing else is said.
DRY = dict(friction=0.7, normalStiffness=5e9, density=2600.0, young=20e9, poisson=0.2)


@validated
def dry(
    friction: Annotated[float, number("", 0, MAX_FRICTION)] | None = None,
    normalStiffness: Stiffness | None = None,
    shearStiffness: Stiffness | None = None,
    density: Annotated[float, number("kg/m³", 0, above=True)] | None = None,
    young: Annotated[float, number("Pa", 0, above=True)] | None = None,
    poisson: Poisson | None = None,
) -> Masonry:
    """Stones with dry joints that do not crush: no tension, no cohesion, Coulomb friction without
    dilatancy. Pieces of one stone hold together, by elastic joints as stiff. A scene says what is
    assumed.

    :param friction: [-]; default 0.7, usual for rough stone
    :param normalStiffness: of the joints [Pa/m], default 5e9; ``shearStiffness`` [Pa/m]: default
        0.4 of it
    :param density: of the stones [kg/m³], default 2600; ``young`` [Pa], default 20e9, and
        ``poisson`` [-], default 0.2, which rigid stones have lumped into the joints
    """
    ofStone = dict(density=density, young=young, poisson=poisson)
    given = dict(ofStone, friction=friction, normalStiffness=normalStiffness)
    sources = {n: f"default of dry(): {DRY[n]:g}" for n, v in given.items() if v is None}
    found = {n: DRY[n] if v is None else v for n, v in given.items()}
    stiffness = dict(normalStiffness=found["normalStiffness"], shearStiffness=shearStiffness)
    if shearStiffness is None:
        sources["shearStiffness"] = "default of dry(): 0.4 of the normal stiffness"
        stiffness["shearStiffness"] = 0.4 * found["normalStiffness"]
    joints = {}
    for name in ("bed", "support"):
        joint = MasonryJoint(name=name, **stiffness, **slipping(found["friction"]))
        said = {n: why for n, why in sources.items() if n not in ofStone}
        joints[name] = state(joint, **said)
    joints["crack"] = MasonryJoint(name="crack", elastic=True, **stiffness)
    unit = MasonryMat(label="stone", **{n: found[n] for n in ofStone})
    said = {n: why for n, why in sources.items() if n in ofStone}
    return Masonry(state(unit, **said), joints)


BED_DIRECTION, HEAD_DIRECTION = Vector3(0, 0, 1), Vector3(1, 0, 0)


def calciumSilicateUnit() -> MasonryMat:
    """Calcium-silicate brick of the TUD-COMP walls: the paper's table 2."""
    return state(
        MasonryMat(
            label="calcium silicate", young=4.8e9, poisson=0.16, density=1800, jointSet="brick"
        )
    )


DECIDED = "assumed by calciumSilicateJoints(); the paper gives no value"

#: Properties that the paper does not give, of bed and head joints and of crack joints.
CALCIUM_SILICATE_ASSUMED = (
    "residualCohesion residualFriction dilatancy residualStrengthRatio "
    "modeIFractureEnergy modeIIFractureEnergy capNormal capShear capLinear"
).split()
CRACK_ASSUMED = (
    "normalStiffness shearStiffness tensileStrength modeIFractureEnergy cohesion "
    "residualCohesion modeIIFractureEnergy friction residualFriction dilatancy"
).split()


def calciumSilicateJoints() -> dict[str, MasonryJoint]:
    """Support, bed, head and crack joints of the calcium-silicate walls, as a dict by name.

    Pairs of units get the first of support, bed and head that fits. The crack joint, of the halves
    of one brick, has a joint set that no unit has, so it needs a rule of :func:`connect`.

    Strengths, friction, compressive fracture energy and peak ratio are those of the paper's table
    2. Stiffnesses follow from its eq. (26) with a mortar 10 mm thick.

    The paper gives no value for these, and yade_plugin/law/README.md (parameters; crack surfaces)
    says why they were chosen: residual cohesion 0, one value of friction, no dilatancy, a residual
    compressive strength of 0.2 of the peak, fracture energies of 16 J/m² in mode I and 160 J/m² in
    mode II, the shape of the cap, and the brick's crack surface, ten times as stiff as a bed joint:
    in series with rigid half bricks of modulus E and length L, that leaves 0.99 E/L.

    With eq. (26) the masonry is stiffer than in table 2: 4079 MPa across its bed joints and 4507
    MPa across its head joints, not 3174 and 2212 MPa. The closure at the compressive strength is
    1.54 mm for the bed joint and 1.21 mm for the head joint.
    """
    bed = MasonryJoint(name="bed", jointSet="brick", direction=BED_DIRECTION)
    head = MasonryJoint(name="head", jointSet="brick", direction=HEAD_DIRECTION)
    head.set(compressiveStrength=5.93e6, compressiveFractureEnergy=31500)
    crack = MasonryJoint(
        name="crack",
        jointSet="within one brick",
        normalStiffness=10 * bed.normalStiffness,
        shearStiffness=10 * bed.shearStiffness,
        tensileStrength=1.5e6,
        modeIFractureEnergy=60,
        cohesion=3e6,
        modeIIFractureEnergy=500,
        friction=0.75,
        residualFriction=0.75,
        cap=False,
    )
    support = MasonryJoint(name="support", jointSet="support", elastic=True)
    support.set(normalStiffness=bed.normalStiffness, shearStiffness=bed.shearStiffness)
    for joint in (bed, head):
        state(joint, **dict.fromkeys(CALCIUM_SILICATE_ASSUMED, DECIDED))
    state(crack, **dict.fromkeys(CRACK_ASSUMED, DECIDED))
    return {joint.name: joint for joint in (state(support), bed, head, crack)}


def graniteUnit() -> MasonryMat:
    """Sawn granite block of the dry-joint walls of Vasconcelos and Lourenço (2009).

    Young's modulus is that of the data of Vanin et al. (2017), doi 10.1007/s10518-017-0188-5.
    Poisson's ratio 0.2 and density 2600 kg/m³ are assumed, as usual for granite.
    """
    unit = MasonryMat(label="granite", young=20.2e9, poisson=0.2, density=2600)
    unit.jointSet = "granite"
    assumption = "assumed by graniteUnit(), usual for granite; not in the data"
    return state(unit, poisson=assumption, density=assumption)


@validated
def dryGraniteJoints(level: Level, height: Course) -> dict[str, MasonryJoint]:
    """Support, bed and head joints of the dry-joint granite walls, as a dict by name.

    The joints have no tensile strength and no cohesion. With one joint a course, their normal
    stiffness is 1/kn = height (1/Em - 1/E), with the modulus Em of the masonry at the load level
    and E of the block in the data of Vanin et al. (2017). Assumed are friction 0.65, shear
    stiffness 0.4 kn, no dilatancy, and head joints and joints to platens like bed joints. Crushing
    (the masonry's strength is 73 MPa) and cracks in the blocks are not modelled.

    :param level: vertical load of the test [kN], a key of DRY_GRANITE_MASONRY
    :param height: of a course [m]
    """
    young = graniteUnit().young
    stiffness = 1 / (height * (1 / DRY_GRANITE_MASONRY[level] - 1 / young))
    stiffnesses = dict(normalStiffness=stiffness, shearStiffness=0.4 * stiffness)
    dry = {**stiffnesses, **slipping(0.65)}
    support = MasonryJoint(name="support", jointSet="support", **dry)
    bed = MasonryJoint(name="bed", direction=BED_DIRECTION, **dry)
    head = MasonryJoint(name="head", direction=HEAD_DIRECTION, **dry)
    why = "assumed by dryGraniteJoints(); not in the data"
    names = ["shearStiffness", "friction", "residualFriction", "dilatancy"]
    state(bed, **dict.fromkeys(names, why))
    for joint in (head, support):
        state(joint, **dict.fromkeys(["normalStiffness", *names], f"{why}, like bed"))
    return {joint.name: joint for joint in (support, bed, head)}


def loadingBlock() -> MasonryMat:
    """A platen, section 4.1 of the paper: so stiff that only its joint gives way."""
    return state(
        MasonryMat(label="loading block", young=1e16, poisson=0.0, density=1800, jointSet="support")
    )
