# SPDX-License-Identifier: GPL-2.0-or-later
"""The scheme in time of a structure: damping, masses, time step and gravity."""

from yade import O

from .._masonry import bodyEigenvalues, timeStepLimit
from ..terminal import say
from .engines import engine

MAX_SCALING = 50.0  # of masses that is chosen by itself: more gained nothing in any wall
LEAST_GAIN = 1.3  # of the time step by added inertia, else none is added; in bonds below 1.25 [-]


class Scheme:
    """Damping, masses, time step and gravity.

    - ``limit``: the stable limit of the time step under the present damping [s]
    - ``massScaling``: selective scaling of masses by the options [-]
    - ``addedInertia``: share of the inertia that stages at rest add [-]
    """

    def __init__(self, args, zones, contacts):
        self.args, self.zones, self.contacts = args, zones, contacts
        self.integrator, self.joints = engine("integrator"), engine("joints")
        self.damp(args.damping, args.damping_kind)

    def begin(self, addsInertia):
        """Choose masses and time step, when all joints are there. ``addsInertia``: whether the
        scene's engines can.

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
        limit = self.chooseTimeStep()
        #: stable limits without and with added inertia [s]
        self._limits, self._factors, self.addedInertia = (limit, limit), [], 0.0
        if addsInertia:
            self._addInertia(self.args.added_inertia)

    def _addInertia(self, share):
        """Choose factors on the inertia of the bodies that set the time step.

        All bodies get the same bound of their eigenvalues while the others are held, half of which
        bounds that of the scene, as low as the share of the added mass in the whole allows.
        """
        alone = {b: value for b, value in bodyEigenvalues().items() if value > 0}
        mass = {b: O.bodies[b].state.mass for b in alone}
        stiff = sorted(alone, key=alone.get, reverse=True)
        whole, scaled, product = sum(mass.values()), 0.0, 0.0
        for body, following in zip(stiff, [*stiff[1:], None]):
            scaled += mass[body]
            product += mass[body] * alone[body]
            bound = product / (scaled + share * whole)
            if following is None or bound >= alone[following]:
                break
        else:
            return
        factors = [max(1.0, alone.get(b, 0.0) / bound) for b in range(len(O.bodies))]
        self.integrator.inertiaFactors = factors
        longer = timeStepLimit()
        if longer < LEAST_GAIN * self.limit:
            self.integrator.inertiaFactors = []
            return
        added = sum((factors[b] - 1) * m for b, m in mass.items())
        self._limits, self._factors = (self.limit, longer), factors
        self.addedInertia = round(added / whole, 6)
        self.chooseTimeStep(longer)

    def useTrueInertia(self):
        """Have no added inertia, and the time step that this allows, until the state of before is
        loaded again. Returns whether there was any."""
        if not (self._factors and self.integrator.inertiaFactors):
            return False
        self.integrator.inertiaFactors = []
        O.dt *= self._limits[0] / self._limits[1]
        return True

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

    def dampByOptions(self, inRealTime=False):
        """Choose damping and masses of the options, and the time step if a stage has chosen another
        one. A time step that the script sets stays. No inertia is added to what is
        ``inRealTime``."""
        self.damp(self.args.damping, self.args.damping_kind)
        self.scaleMasses(self.massScaling)
        if self._factors:
            self.integrator.inertiaFactors = [] if inRealTime else self._factors
        limit = self._limits[not inRealTime]
        if self.limit != limit:
            self.chooseTimeStep(limit)

    def chooseTimeStep(self, limit=None):
        """Choose the time step for the present damping. Returns the stable limit.

        :param limit: if known [s]; that of blocks that have moved differs in its third digit
        """
        self.limit = limit or timeStepLimit()
        O.dt = self.args.dt_fraction * self.limit
        return self.limit

    def followStep(self):
        """In a scene whose joints become contacts: let the time step follow what the present state
        allows, until :meth:`keepStep`."""
        if self.contacts:
            self.contacts.follow(self.args.dt_fraction)

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
