"""Published parameter sets. Each function names its source, and what is assumed.

The paper: see yade_plugin/law/README.md.
"""

import math

from yade import Vector3
from yade.wrapper import MasonryJoint, MasonryMat

BED_DIRECTION, HEAD_DIRECTION = Vector3(0, 0, 1), Vector3(1, 0, 0)


def calciumSilicateUnit():
    """Calcium-silicate brick of the TUD-COMP walls: the paper's table 2."""
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

    Strengths, friction, compressive fracture energy and peak ratio are those of the paper's table 2. Stiffnesses follow
    from its eq. (26) with a mortar 10 mm thick.

    The paper gives no value for these, and yade_plugin/law/README.md (parameters; crack surfaces) says why they were
    chosen: residual cohesion 0, one value of friction, no dilatancy, a residual compressive strength of 0.2 of the peak,
    fracture energies of 16 J/m² in mode I and 160 J/m² in mode II, the shape of the cap, and all of the brick's crack
    surface. The crack surface is ten times as stiff as a bed joint. In series with rigid half bricks, whose Young's
    modulus is E and whose length is L, that leaves 0.99 E/L.

    :param brittle: whether to give the brittle Coulomb slip joints instead, for comparison
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


def makeCyclic(joints):
    """Let all joints of a dict follow the cyclic law."""
    for joint in joints.values():
        joint.cyclic = True


def _byName(joints, brittle):
    """Joints as a dict by name. If ``brittle``, those that are not elastic become brittle Coulomb slip joints."""
    if brittle:
        joints = [
            joint if joint.elastic else joint.brittleCoulomb() for joint in joints
        ]
    return {joint.name: joint for joint in joints}


#: Young's modulus [Pa] of dry granite masonry at each vertical load [kN] of the tests (Vanin et al. 2017).
DRY_GRANITE_MASONRY = {100: 3.287e9, 175: 4.068e9, 250: 4.722e9}


def graniteUnit():
    """Sawn granite block of the dry-joint walls of Vasconcelos and Lourenço (2009).

    Young's modulus is that of the data of Vanin et al. (2017), doi 10.1007/s10518-017-0188-5. Poisson's ratio 0.2 and
    density 2600 kg/m³ are not in the data; they are assumed, as usual for granite.
    """
    return MasonryMat(
        label="granite", young=20.2e9, poisson=0.2, density=2600, jointSet="granite"
    )


def dryGraniteJoints(level, height, brittle=False):
    """Support, bed and head joints of the dry-joint granite walls, as a dict by name.

    The joints have no tensile strength and no cohesion. Their normal stiffness kn is what is missing between block and
    masonry, with one joint a course: 1/kn = height (1/Em - 1/E). The modulus Em of the masonry at the load level and E
    of the block are from the data of Vanin et al. (2017). These are assumed, since they are not in the data: friction
    0.65, shear stiffness 0.4 kn, no dilatancy, and head joints and joints to the support and to the loading block like
    bed joints. Crushing (the masonry's strength is 73 MPa) and cracks in the blocks are not modelled.

    :param level: vertical load of the test [kN], a key of DRY_GRANITE_MASONRY
    :param height: of a course [m]
    :param brittle: whether to give brittle Coulomb slip joints instead; they are the same here, where nothing softens
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
    """A block that supports or loads a wall, section 4.1 of the paper: so stiff that only its joint gives way."""
    return MasonryMat(
        label="loading block", young=1e16, poisson=0.0, density=1800, jointSet="support"
    )
