# SPDX-License-Identifier: GPL-2.0-or-later
"""The scheme in time of a structure: damping, masses, time step and gravity."""

from yade import O

from .._masonry import timeStepLimit
from ..terminal import say
from .engines import engine

MAX_SCALING = 50.0  # of masses that is chosen by itself: more gained nothing in any wall


class Scheme:
    """Damping, masses, time step and gravity.

    - ``limit``: the stable limit of the time step under the present damping [s]
    - ``massScaling``: selective scaling of masses by the options [-]
    """

    def __init__(self, args, zones, contacts):
        self.args, self.zones, self.contacts = args, zones, contacts
        self.integrator, self.joints = engine("integrator"), engine("joints")
        self.damp(args.damping, args.damping_kind)

    def begin(self):
        """Choose masses and time step, when all joints are there.

        ``--mass-scaling auto`` compares the limit of the time step with true masses with that of
        rigid motions alone. Waves through a brick get slower by the root of 1 + massScaling, so the
        least that brings their limit to the second one is known.
        """
        self.massScaling = self.args.mass_scaling if self.zones else 0.0
        if self.massScaling == "auto":
            limits = []
            for scaling in (0.0, 1e8):
                self.scaleMasses(scaling)
                limits.append(timeStepLimit())
            least = round((limits[1] / limits[0]) ** 2 - 1, 1)
            self.massScaling = min(MAX_SCALING, max(0.0, least))
        self.scaleMasses(self.massScaling)
        self._usualLimit = self.chooseTimeStep()

    def damp(self, damping, kind, massDamping=0.0, stiffnessDamping=0.0):
        """Choose the damping from now on; :meth:`chooseTimeStep` follows it.

        :param damping: numerical damping constant of rigid and deformable units [-]
        :param massDamping: viscous, of the motion [1/s]; ``stiffnessDamping``: of the joints [s]
        """
        for one in filter(None, (self.integrator, self.zones)):
            one.damping, one.dampingKind = damping, kind
        self.integrator.massDamping = massDamping
        self.joints.stiffnessDamping = stiffnessDamping

    def scaleMasses(self, scaling):
        """Choose the selective scaling of the masses of deformable units [-];
        :meth:`chooseTimeStep` follows it."""
        if self.zones and self.zones.massScaling != scaling:
            self.zones.massScaling = scaling

    def trueMasses(self, stage):
        """Have true masses for a stage in real time; :meth:`chooseTimeStep` follows it."""
        if self.zones and self.massScaling:
            say(
                f"note: {stage} runs in real time with true masses, without --mass-scaling"
                f" {self.massScaling:g}"
            )
            self.scaleMasses(0.0)

    def dampByOptions(self):
        """Choose damping and masses of the options, and the time step if a stage has chosen another
        one. A time step that the script sets stays."""
        self.damp(self.args.damping, self.args.damping_kind)
        self.scaleMasses(self.massScaling)
        if self.limit != self._usualLimit:
            self.chooseTimeStep(self._usualLimit)

    def chooseTimeStep(self, limit=None, fraction=None):
        """Choose the time step for the present damping. Returns the stable limit.

        :param limit: if known [s]; that of blocks that have moved differs in its third digit
        :param fraction: time step over limit [-]; None: that of the options
        """
        self.limit = limit or timeStepLimit()
        O.dt = self.limit * (fraction or self.args.dt_fraction)
        return self.limit

    def followStep(self, fraction=None):
        """In a scene whose joints become contacts: let the time step follow what the present state
        allows, until :meth:`keepStep`.

        :param fraction: as in :meth:`chooseTimeStep`
        """
        if self.contacts:
            self.contacts.follow(fraction or self.args.dt_fraction)

    def keepStep(self):
        """Let the time step stay what it is; :meth:`chooseTimeStep` follows it."""
        if self.contacts.following:
            self.contacts.follow(0.0)
            self.chooseTimeStep()

    def keepStable(self):
        """Shorten the time step where moved blocks or new contacts have a smaller limit."""
        limit = timeStepLimit()
        if limit < self.limit:
            self.chooseTimeStep(limit)

    @property
    def presentLimit(self):
        """The stable limit of the time step, at least, where it follows the state [s]."""
        following = self.contacts.following if self.contacts else 0.0
        return O.dt / following if following else self.limit

    def setGravity(self, gravity):
        """[m/s²]; deformable units follow."""
        self.integrator.gravity = gravity

    def shake(self, motions, axes, every, scale):
        """Shake the ground, beside the present gravity, until the next call: samples along each
        axis, which are ``every`` [s] apart, times ``scale`` [m/s²]. Without motions it ends."""
        self.integrator.shake([a for motion in motions for a in motion], axes, every, scale)

    @property
    def now(self):
        """Present gravity [m/s²]."""
        return self.integrator.gravity
