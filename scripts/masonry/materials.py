"""Published parameter sets. Each function names its source, and what is assumed."""

import math

from yade import Vector3

from . import MasonryJoint, MasonryMat

BED_DIRECTION, HEAD_DIRECTION = Vector3(0, 0, 1), Vector3(1, 0, 0)


def calciumSilicateUnit():
    """Calcium-silicate brick of the TUD-COMP walls: paper table 2."""
    return MasonryMat(
        label="calcium silicate",
        young=4.8e9,
        poisson=0.16,
        density=1800,
        jointSet="brick",
    )


def calciumSilicateJoints(brittle=False):
    """Support, bed, head and crack joints of the calcium-silicate walls, as a dict by name.

    Pairs of units get the first of support, bed and head that fits; the crack joint is for the halves of one brick.

    Strengths, friction, Gc and peak ratio: paper table 2. Stiffnesses: paper eq. (26) with tm = 10 mm. Assumed, since
    the paper gives no value (law.md §1 and §8, [decided]): residual cohesion 0, one friction value, no dilatancy,
    fcr = 0.2 fcp, GfI = 16 and GfII = 160 J/m², cap 1, 9, 0, and all of the brick's crack surface. The crack surface is
    ten times as stiff as a bed joint; between rigid half bricks, in series with them, that leaves 0.99 E/L.

    :param brittle: the brittle Coulomb slip set instead (law.md §9), for comparison
    """
    bed = MasonryJoint(name="bed", jointSet="brick", direction=BED_DIRECTION)
    head = MasonryJoint(
        name="head",
        jointSet="brick",
        direction=HEAD_DIRECTION,
        compressiveStrength=5.93e6,
        compressiveFractureEnergy=31500,
    )
    crack = MasonryJoint(
        name="crack",
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
    support = MasonryJoint(
        name="support",
        jointSet="support",
        elastic=True,
        normalStiffness=bed.normalStiffness,
        shearStiffness=bed.shearStiffness,
    )
    return _byName([support, bed, head, crack], brittle)


def _byName(joints, brittle):
    """Joints as a dict by name; ``brittle``: those that are not elastic as brittle Coulomb slip joints (law.md §9)."""
    if brittle:
        joints = [
            joint if joint.elastic else joint.brittleCoulomb() for joint in joints
        ]
    return {joint.name: joint for joint in joints}


#: Young's modulus [Pa] of dry granite masonry at each vertical load [kN] of the tests (Vanin et al. 2017).
DRY_GRANITE_MASONRY = {100: 3.287e9, 175: 4.068e9, 250: 4.722e9}


def graniteUnit():
    """Sawn granite block of the dry-joint walls of Vasconcelos and Lourenço (2009).

    Young's modulus: the data of Vanin et al. (2017), doi 10.1007/s10518-017-0188-5. Assumed, not in the data: Poisson's
    ratio 0.2 and density 2600 kg/m³ (granite's usual values).
    """
    return MasonryMat(
        label="granite", young=20.2e9, poisson=0.2, density=2600, jointSet="granite"
    )


def dryGraniteJoints(level, height, brittle=False):
    """Support, bed and head joints of the dry-joint granite walls, as a dict by name.

    No tension, no cohesion. The normal stiffness is what is missing between block and masonry, one joint a course:
    1/kn = height (1/Em - 1/E), with Em of the load level and E of the block, both from the data of Vanin et al. (2017).
    Assumed, not in the data: friction 0.65, shear stiffness 0.4 kn, no dilatancy, head joints and the joints to support
    and loading block like bed joints. Not modelled: crushing (masonry strength 73 MPa) and cracks in the blocks.

    :param level: vertical load of the test [kN], a key of DRY_GRANITE_MASONRY
    :param height: of a course [m]
    :param brittle: brittle Coulomb slip joints instead; the same here, where nothing softens
    """
    problems = []
    if level not in DRY_GRANITE_MASONRY:
        problems.append(
            f"level {level} kN was not tested, there are {', '.join(map(str, DRY_GRANITE_MASONRY))}"
        )
    if not 0 < height < math.inf:
        problems.append(f"height of a course {height} m must be above 0")
    if problems:
        raise ValueError("dry granite joints: " + "; ".join(problems))
    young = graniteUnit().young
    stiffness = 1 / (height * (1 / DRY_GRANITE_MASONRY[level] - 1 / young))
    dry = dict(
        normalStiffness=stiffness,
        shearStiffness=0.4 * stiffness,
        tensileStrength=0,
        cohesion=0,
        friction=0.65,
        residualFriction=0.65,
        cap=False,
    )
    support = MasonryJoint(name="support", jointSet="support", **dry)
    bed = MasonryJoint(name="bed", direction=BED_DIRECTION, **dry)
    head = MasonryJoint(name="head", direction=HEAD_DIRECTION, **dry)
    return _byName([support, bed, head], brittle)


def loadingBlock():
    """Stiff block that loads or supports a wall (paper §4.1): so stiff that it adds nothing to its elastic joint."""
    return MasonryMat(
        label="loading block", young=1e16, poisson=0.0, density=1800, jointSet="support"
    )
