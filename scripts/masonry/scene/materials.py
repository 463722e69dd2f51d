# SPDX-License-Identifier: GPL-2.0-or-later
"""Published parameter sets. Each function names its source, and what is assumed.

The paper: see yade_plugin/law/README.md.
"""

import math
from dataclasses import dataclass, field

from yade import Vector3
from yade.wrapper import MasonryJoint, MasonryMat

from . import fields
from ..assembly.engines import LAWS
from ..basics import Refused

#: A joint whose normal is steeper than this is a bed joint: 45 degrees.
STEEP = math.cos(math.radians(45))


def withResidual(names, joints):
    """Names of properties that change alike, and with them the residual friction of joints that have one value of friction.

    :param names: as ``"bed.friction"``
    :param joints: dict of MasonryJoint by name
    """
    one = [n.partition(".")[0] for n in names if n.endswith(".friction")]
    one = [
        n
        for n in one
        if n in joints and joints[n].friction == joints[n].residualFriction
    ]
    return [*dict.fromkeys([*names, *(n + ".residualFriction" for n in one)])]


@dataclass
class Masonry:
    """Bricks and joints of a structure, and which joint a pair of blocks gets.

    A pair of blocks gets the joint ``support`` if one of them is a platen, ``crack`` if they are pieces of one brick, else
    ``bed`` or ``head``. It is a bed joint if its normal is less than 45 degrees off the vertical. Joints between two parts
    of a structure, such as the wythes of a wall, get ``collar`` if there is one. Without ``head`` all are bed joints.

    :param unit: MasonryMat of the bricks
    :param joints: dict of MasonryJoint by these names; ``bed`` must be there, ``support`` is made if it is missing, linear
        elastic with the stiffness of the bed joint
    :param units: dict of MasonryMat by the ``kind`` of a block, for example ``{"lintel": concrete}``; other kinds are of
        the unit
    :param softer: function without arguments that gives the same with ``--joint-stiffness masonry``
    :param choose: function (block1, block2, geom) of your own, of the records of two bricks or None for a platen; it
        returns the name of a joint, or None for the rule above
    """

    unit: MasonryMat
    joints: dict
    units: dict = field(default_factory=dict)
    softer: object = None
    choose: object = None
    #: What :meth:`vary` was given: joint, property, function and step.
    varied: list = field(default_factory=list)

    def __post_init__(self):
        problems = []
        if not isinstance(self.unit, MasonryMat):
            problems.append(f"masonry: unit must be a MasonryMat, got {self.unit!r}")
        for kind, mat in self.units.items():
            if not isinstance(mat, MasonryMat):
                problems.append(
                    f"masonry: unit {kind!r} must be a MasonryMat, got {mat!r}"
                )
        wrong = [
            name
            for name, joint in self.joints.items()
            if not isinstance(joint, MasonryJoint)
        ]
        if wrong:
            problems.append(f"masonry: joints must be MasonryJoint, not {wrong}")
        elif "bed" not in self.joints:
            problems.append("masonry: there must be a joint 'bed'")
        if problems:
            raise ValueError("\n".join(problems))
        if "support" not in self.joints:
            bed = self.joints["bed"]
            self.joints["support"] = MasonryJoint(
                name="support",
                elastic=True,
                normalStiffness=bed.normalStiffness,
                shearStiffness=bed.shearStiffness,
            )

    def vary(self, name, value, step=0.01):
        """Let a property change from place to place. Returns the same masonry.

        Values are rounded to steps of a share, so that many joints are of one kind and cost no more than uniform ones.

        :param name: joint and property, for example ``"bed.cohesion"``, or a list of these that change alike. Strengths are
            tied to each other: the tensile strength must be at most cohesion over friction
        :param value: function of the x, y and z [m] of a joint's middle that gives a factor on the property [-];
            :mod:`masonry.scene.fields` has random ones
        :param step: width of the steps, relative to the value; at most half of it is the error of rounding
        """
        for one in [name] if isinstance(name, str) else name:
            joint, dot, attribute = one.partition(".")
            if joint not in self.joints or not hasattr(self.joints[joint], attribute):
                raise ValueError(
                    f"vary: no property {one!r}; joints are {', '.join(self.joints)}, help(MasonryJoint) lists properties"
                )
            if not callable(value):
                raise ValueError(
                    f"vary {one}: value must be a function of x, y, z, got {value!r}"
                )
            if not 0 < step < 1:
                raise ValueError(f"vary {one}: step {step} must be above 0, below 1")
            self.varied.append((joint, attribute, value, step))
        return self

    def variant(self, args):
        """A copy for the options ``--joints`` and ``--joint-stiffness``; this one stays as it is."""
        source = self
        if args.joint_stiffness != "joint":
            if not self.softer:
                raise Refused(
                    f"--joint-stiffness {args.joint_stiffness}: the joints of this masonry have no such variant"
                )
            source = self.softer()
        copies = {name: _copied(joint) for name, joint in source.joints.items()}
        if args.joints == "brittle":
            copies = _byName([*copies.values()], True)
        elif args.joints != next(iter(LAWS)):
            for joint in copies.values():
                joint.law = args.joints
        units = {kind: _copied(mat) for kind, mat in source.units.items()}
        own = Masonry(
            _copied(source.unit), copies, units, None, self.choose, [*self.varied]
        )
        for text in args.field:
            names, function = fields.read(text)
            names = withResidual(names, copies)
            try:
                own.vary(names, function)
            except ValueError as error:
                raise Refused(f"--field {text}: {error}") from None
        return own

    def rule(self, blocks):
        """The rule of :func:`masonry.assembly.connecting.connect`.

        :param blocks: records of the bricks by body id
        """

        def rule(one, two, geom):
            first, second = blocks.get(one.id), blocks.get(two.id)
            name = self.choose and self.choose(first, second, geom)
            if name and name not in self.joints:
                raise ValueError(
                    f"choose gave {name!r} for bodies {one.id} and {two.id}; there are {', '.join(self.joints)}"
                )
            name = name or self._kind(first, second, geom.normal)
            joint = self.joints[name]
            return self._at(name, joint, geom) if self.varied else joint

        return rule

    def _kind(self, first, second, normal):
        if first is None or second is None:
            return "support"
        if first.brick == second.brick and "crack" in self.joints:
            return "crack"
        if first.part != second.part and "collar" in self.joints:
            return "collar"
        steep = abs(normal[2]) > STEEP or "head" not in self.joints
        return "bed" if steep else "head"

    def _at(self, name, joint, geom):
        """The joint of a kind with the properties that it has at a place."""
        changes, centres = {}, geom.centres
        centre = [sum(c[i] for c in centres) / len(centres) for i in range(3)]
        for kind, attribute, value, step in self.varied:
            if kind == name:
                factor = float(value(*centre))
                if not 0 < factor < math.inf:
                    raise ValueError(
                        f"vary {kind}.{attribute}: the factor at {centre} m must be above 0, got {factor}"
                    )
                wide = math.log1p(step)
                changes[attribute] = round(math.log(factor) / wide)
        if not any(changes.values()):
            return joint
        key = name, tuple(sorted(changes.items()))
        if key not in self._made:
            steps = {a: s for k, a, _, s in self.varied if k == name}
            own = _copied(joint)
            values = {
                a: getattr(joint, a) * (1 + steps[a]) ** n for a, n in changes.items()
            }
            try:
                own.updateAttrs(values)
            except ValueError as error:
                place = ", ".join(f"{v:.3g}" for v in centre)
                raise ValueError(f"vary: at ({place}) m: {error}") from None
            self._made[key] = own
        return self._made[key]

    _made = property(lambda self: self.__dict__.setdefault("_kept", {}))


def _copied(thing):
    """Another material or joint with the same attributes."""
    return type(thing)(**{k: v for k, v in thing.dict().items() if k != "id"})


def calciumSilicate(stiffness="joint"):
    """Calcium-silicate masonry of the TUD-COMP walls, for :class:`masonry.scene.scene.Scene`.

    :param stiffness: as of :func:`calciumSilicateJoints`
    """
    return Masonry(
        calciumSilicateUnit(),
        calciumSilicateJoints(stiffness=stiffness),
        softer=lambda: calciumSilicate("masonry"),
    )


def dryGranite(level, height):
    """Granite blocks with dry joints, for :class:`masonry.scene.scene.Scene`. Parameters as of :func:`dryGraniteJoints`."""
    return Masonry(graniteUnit(), dryGraniteJoints(level, height))


def dry(
    friction=0.7,
    normalStiffness=5e9,
    shearStiffness=None,
    density=2600,
    young=20e9,
    poisson=0.2,
):
    """Stones with dry joints that do not crush: no tension, no cohesion, Coulomb friction without dilatancy.

    :param friction: [-]; 0.7 is usual for rough stone
    :param normalStiffness: of the joints [Pa/m]; shear stiffness None: 0.4 of it
    :param density: of the stones [kg/m³]; ``young`` [Pa] and ``poisson`` [-] count for deformable stones. Rigid ones have
        them lumped into the joints
    """
    ks = 0.4 * normalStiffness if shearStiffness is None else shearStiffness
    joints = [
        MasonryJoint(
            name=name,
            normalStiffness=normalStiffness,
            shearStiffness=ks,
            tensileStrength=0,
            cohesion=0,
            friction=friction,
            residualFriction=friction,
            cap=False,
        )
        for name in ("bed", "support")
    ]
    unit = MasonryMat(label="stone", young=young, poisson=poisson, density=density)
    return Masonry(unit, _byName(joints, brittle=False))


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


#: Height and length of a calcium-silicate unit, mortar included: the distances between two bed joints and between two
#: head joints [m].
BED_SPACING, HEAD_SPACING = 0.081, 0.220

#: "Modulus of elasticity Eu" [Pa] in the paper's table 2, by joint. The table has it among the properties of the
#: interface, but eq. (26) does not use it: it is the modulus of the masonry, across its bed and its head joints.
CALCIUM_SILICATE_MASONRY = {"bed": 3174e6, "head": 2212e6}


def calciumSilicateJoints(brittle=False, stiffness="joint"):
    """Support, bed, head and crack joints of the calcium-silicate walls, as a dict by name.

    Pairs of units get the first of support, bed and head that fits. The crack joint is for the halves of one brick, and
    no pair of units gets it by itself: its joint set is one that no unit has, so it needs a rule of :func:`connect`.

    Strengths, friction, compressive fracture energy and peak ratio are those of the paper's table 2. Stiffnesses follow
    from its eq. (26) with a mortar 10 mm thick.

    The paper gives no value for these, and yade_plugin/law/README.md (parameters; crack surfaces) says why they were
    chosen: residual cohesion 0, one value of friction, no dilatancy, a residual compressive strength of 0.2 of the peak,
    fracture energies of 16 J/m² in mode I and 160 J/m² in mode II, the shape of the cap, and all of the brick's crack
    surface. The crack surface is ten times as stiff as a bed joint. In series with rigid half bricks, whose Young's
    modulus is E and whose length is L, that leaves 0.99 E/L.

    With eq. (26) the masonry is stiffer than the moduli of table 2, CALCIUM_SILICATE_MASONRY, say: 4079 MPa across its
    bed joints and 4507 MPa across its head joints, not 3174 and 2212 MPa. ``stiffness="masonry"`` is the variant that
    has these: 1/kn = spacing (1/Eu - 1/E), which is 116 N/mm³ for the bed and 18.6 N/mm³ for the head joint, and
    ks = kn/(2(1 + nu)). The closure at the compressive strength ucp = n fcp/kn stays as it is, 1.54 mm for the bed joint
    and 1.21 mm for the head joint, so n becomes smaller as kn does. Table 2's n is the ratio to an elastic closure with
    the kn of eq. (26); with the same n a softer kn would put the peak at 4.5 mm and 22 mm, and Gc would be too small
    for it. Support joints follow the bed joint. Crack joints stay: they are brick, and table 2 says nothing of them.

    :param brittle: whether to give the brittle Coulomb slip joints instead, for comparison
    :param stiffness: ``"joint"`` for the stiffnesses of eq. (26), ``"masonry"`` for those that give the masonry the
        moduli of table 2
    :raises ValueError: if ``stiffness`` is neither
    """
    if stiffness not in ("joint", "masonry"):
        raise ValueError(f"stiffness {stiffness!r} must be 'joint' or 'masonry'")
    bed = MasonryJoint(name="bed", jointSet="brick", direction=BED_DIRECTION)
    head = MasonryJoint(
        name="head",
        jointSet="brick",
        direction=HEAD_DIRECTION,
        compressiveStrength=5.93e6,
        compressiveFractureEnergy=31500,
    )
    # before kn of the bed joint changes
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
    if stiffness == "masonry":
        for joint, spacing in ((bed, BED_SPACING), (head, HEAD_SPACING)):
            _softenTo(joint, CALCIUM_SILICATE_MASONRY[joint.name], spacing)
    support = MasonryJoint(
        name="support",
        jointSet="support",
        elastic=True,
        normalStiffness=bed.normalStiffness,
        shearStiffness=bed.shearStiffness,
    )
    return _byName([support, bed, head, crack], brittle)


def _softenTo(joint, masonry, spacing):
    """Give a joint the stiffness with which masonry of calcium-silicate units has this modulus [Pa] across joints with
    this spacing [m]; the closure at its compressive strength stays."""
    unit = calciumSilicateUnit()
    kn = 1 / (spacing * (1 / masonry - 1 / unit.young))
    joint.updateAttrs(
        {
            "peakRatio": joint.peakRatio * kn / joint.normalStiffness,
            "normalStiffness": kn,
            "shearStiffness": kn / (2 * (1 + unit.poisson)),
        }
    )


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
