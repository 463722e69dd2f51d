# SPDX-License-Identifier: GPL-2.0-or-later
"""The scheme in time of a structure: damping, masses, time step and gravity."""

from yade import O

from .._masonry import timeStepLimit
from ..terminal import say
from .engines import engine

MOST_SCALED = 50.0  # largest massScaling that is chosen by itself: more gained nothing in any wall


class Scheme:
    """Damping, masses, time step and gravity of a structure that is built.

    - ``limit``: the stable limit of the time step under the present damping [s]
    - ``massScaling``: selective scaling of masses that the options say [-]; ``joints``: the engine
      of the joints
    """

    def __init__(self, args, zones):
        self.args, self.zones = args, zones
        self.integrator, self.joints = engine("integrator"), engine("joints")
        self.damp(args.damping, args.damping_kind)

    def begin(self):
        """Choose masses and time step, when all joints are there.

        With ``--mass-scaling auto`` there are two limits of the time step: with true masses, and
        with deformation so slow that only the rigid motions of bricks are left. Waves through a
        brick get slower by the root of 1 + massScaling, so the least that brings their limit to the
        second one is known.
        """
        self.massScaling = self.args.mass_scaling if self.zones else 0.0
        if self.massScaling == "auto":
            limits = []
            for scaling in (0.0, 1e8):
                self.scaleMasses(scaling)
                limits.append(timeStepLimit())
            least = round((limits[1] / limits[0]) ** 2 - 1, 1)
            self.massScaling = min(MOST_SCALED, max(0.0, least))
        self.scaleMasses(self.massScaling)
        self._usualLimit = self.chooseTimeStep()

    def damp(self, damping, kind, massDamping=0.0, stiffnessDamping=0.0):
        """Choose the damping from now on; :meth:`chooseTimeStep` follows it.

        :param damping: numerical damping constant of deformable units, else of rigid ones [-]
        :param massDamping: viscous, of the motion [1/s]; ``stiffnessDamping``: of the joints [s]
        """
        damped = self.zones or self.integrator
        damped.damping, damped.dampingKind = damping, kind
        self.integrator.massDamping = massDamping
        self.joints.stiffnessDamping = stiffnessDamping

    def scaleMasses(self, scaling):
        """Choose the selective scaling of the masses of deformable units from now on [-];
        :meth:`chooseTimeStep` follows it."""
        if self.zones and self.zones.massScaling != scaling:
            self.zones.massScaling = scaling

    def trueMasses(self, stage):
        """Have true masses from now on, because a stage runs in real time, and say so if the
        options say otherwise;
        :meth:`chooseTimeStep` follows it."""
        if self.zones and self.massScaling:
            say(
                f"note: {stage} runs in real time with true masses, without --mass-scaling"
                f" {self.massScaling:g}"
            )
            self.scaleMasses(0.0)

    def dampByOptions(self):
        """Choose the damping and the masses that the options say, for a stage that says nothing
        else, and its time step if a stage has chosen another one. A time step that the script sets
        stays."""
        self.damp(self.args.damping, self.args.damping_kind)
        self.scaleMasses(self.massScaling)
        if self.limit != self._usualLimit:
            self.chooseTimeStep(self._usualLimit)

    def chooseTimeStep(self, limit=None):
        """Choose the time step that the present damping allows. Returns the stable limit.

        :param limit: the stable limit if it is known [s]: that of blocks that have moved differs in
            its third digit
        """
        self.limit = limit or timeStepLimit()
        O.dt = self.args.dt_fraction * self.limit
        return self.limit

    def keepStable(self):
        """Shorten the time step where blocks that have moved, or joints that have become contacts,
        have a smaller limit."""
        limit = timeStepLimit()
        if limit < self.limit:
            self.chooseTimeStep(limit)

    def setGravity(self, gravity):
        """Gravity from now on [m/s²]; deformable units follow."""
        self.integrator.gravity = gravity

    @property
    def now(self):
        """Present gravity [m/s²]."""
        return self.integrator.gravity
