"""What a scene is built of: named blocks, joints, loads and interactions, and what can be read off them."""

import subprocess
import sys

from yade import O
from yade.wrapper import MasonryZones

from .._masonry import criticalTimeStep
from ..basics import GRAVITY, Unwritable
from .blocks import connect, engine, engines, units

class Model:
    """Blocks, joints and loads of a scene. A subclass says what they are.

    It is made in two steps, so that what the user asks for can be refused before anything changes: ``__init__`` checks
    the properties and the options, and :meth:`build` builds the scene in YADE. From then on it has

    - ``blocks``: body ids by name; ``bricks``: number of the brick by body id, for all bodies that are bricks or parts
      of bricks
    - ``joints``: MasonryJoint objects by name; ``interactions``: the joints between blocks
    - ``loads``: MasonryLoad engines by label; ``zones``: the engine of deformable units, or None
    - ``energy`` and ``integrator``: these engines
    - ``limit``: the stable limit of the time step [s]; ``subcontacts``: how many points the joints have

    :param args: the options of :func:`masonry.scene.options.parser`
    :param unit: MasonryMat of the bricks
    :param joints: dict of MasonryJoint by name
    """

    title = ""
    columns = []  # of curve.csv: see masonry.assembly.columns

    def __init__(self, args, unit, joints):
        self.args, self.unit, self.joints = args, unit, joints
        self.blocks, self.bricks, self.loads, self.zones = {}, {}, {}, None
        # Heavier blocks that are attracted less weigh the same; waves are slower and the time step is longer.
        self.gravity = GRAVITY / args.density_scaling
        unit.density *= args.density_scaling

    # -- what a subclass gives ------------------------------------------------------------------------------------

    def build(self):
        """Build the scene in YADE: blocks, then :meth:`assemble`."""
        raise NotImplementedError

    def read(self):
        """What the columns are made of, measured now: see :mod:`masonry.assembly.columns`."""
        raise NotImplementedError

    def room(self):
        """Bytes that a run writes at least, and those that it will probably write."""
        return 1e6, 1e6

    def summary(self, column):
        """Entries of run.json that follow from the rows; ``column`` is a function of a name that gives its values."""
        return {}

    def report(self, run):
        """Lines to print at the end, from the entries of run.json."""
        return []

    def leave(self, directory):
        """Write what the model has beside rows and frames, if it has anything."""

    def draw(self, directory):
        """Draw the figures of a run that has ended, in a program of its own. Raises Unwritable if that fails."""
        # -P: nothing of the present folder is run
        command = [sys.executable, "-P", "-m", "masonry.read.figures", directory]
        if subprocess.run(command).returncode:
            raise Unwritable("the figures are not drawn")

    # -- what is the same for all ---------------------------------------------------------------------------------

    def assemble(
        self,
        joints,
        loads,
        damping="local",
        divisions=(1, 1, 1),
        gravity=0.0,
        rule=None,
        functors=False,
        plane=True,
    ):
        """Make engines, joints and the time step, when all blocks are there.

        :param joints: those of ``self.joints`` that pairs of blocks choose from, the first that fits
        :param loads: MasonryLoad engines, labelled
        :param damping: kind of the damping, local or combined
        :param divisions: cells of a deformable brick along its sides
        :param gravity: downwards [m/s²]
        :param rule: as of :func:`masonry.assembly.blocks.connect`
        :param functors: as of :func:`masonry.assembly.blocks.engines`
        :param plane: whether blocks move in the x-z plane only
        """
        args = self.args
        self.loads = {load.label: load for load in loads}
        if args.blocks == "deformable":
            self.zones = MasonryZones(
                bodies=list(self.bricks),
                divisions=list(divisions),
                damping=args.damping,
                dampingKind=damping,
                blocked="y" if plane else "",
                label="zones",
            )
        engines(
            joints,
            damping=args.damping,
            gravity=(0, 0, -gravity),
            subcontacts=args.subcontacts,
            inPlane=plane,
            loads=loads,
            zones=self.zones,
            functors=functors,
            dampingKind="local" if functors else damping,
        )
        self.energy, self.integrator = engine("energy"), engine("integrator")
        self.damp(args.damping, damping)
        self.interactions = connect(rule)
        self.limit = criticalTimeStep()[0]
        O.dt = args.dt_fraction * self.limit
        self.subcontacts = sum(len(i.geom.areas) for i in self.interactions)

    def damp(self, damping, kind):
        """Choose damping [-] and its kind, local or combined, for what moves: deformable units, else rigid ones."""
        if self.zones:
            self.zones.damping, self.zones.dampingKind = damping, kind
        else:
            self.integrator.damping, self.integrator.dampingKind = damping, kind

    def describe(self):
        """Entries of run.json that say what is built."""
        kinds = {}
        for interaction in self.interactions:
            name = interaction.phys.joint.name
            kinds[name] = kinds.get(name, 0) + 1
        joints = {name: joint.dict() for name, joint in self.joints.items()}
        for properties in joints.values():
            properties["direction"] = list(properties["direction"])
        return dict(
            title=self.title,
            joints=joints,
            joint_units=units(type(next(iter(self.joints.values())))),
            unit_material={
                "young_Pa": self.unit.young,
                "poisson": self.unit.poisson,
                "density_kg_per_m3": self.unit.density / self.args.density_scaling,
            },
            time_step_s=O.dt,
            time_step_limit_s=self.limit,
            units=len(self.bricks),
            nodes=len(self.zones.displacements) if self.zones else 0,
            joint_count=len(self.interactions),
            joints_by_kind=kinds,
            subcontacts=self.subcontacts,
        )
