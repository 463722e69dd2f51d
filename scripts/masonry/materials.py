"""Published parameter sets. Each function names its source, and what is assumed."""

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
    joints = [support, bed, head, crack]
    if brittle:
        joints = [
            joint if joint.elastic else joint.brittleCoulomb() for joint in joints
        ]
    return {joint.name: joint for joint in joints}


def loadingBlock():
    """Stiff block that loads or supports a wall (paper §4.1): so stiff that it adds nothing to its elastic joint."""
    return MasonryMat(
        label="loading block", young=1e16, poisson=0.0, density=1800, jointSet="support"
    )
