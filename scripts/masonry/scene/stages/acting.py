# SPDX-License-Identifier: GPL-2.0-or-later
"""What acts on a structure and can be changed by a stage: gravity with an acceleration, and forces."""

import math

from yade import Vector3

from ...basics import GRAVITY


class Acting:
    """What acts. A share of 1 is the whole growth, and its factor is ``most`` [-].

    Its kinds have ``now()``, their present values as a list of numbers, ``put(values)``, and ``at(began, share)``, their values when a
    share of the growth is over, 0 to 1 [-], from those when it began.

    :param name: under which its bound is found
    :param unit: of the factor
    :param towards: direction along which displacements are counted
    """

    target = None  # the platen or brick on which it acts, if it is one

    def __init__(self, name, most, unit, towards=None):
        self.name, self.most, self.unit, self.towards = name, most, unit, towards

    def factor(self, share):
        """The load factor at a share [-]."""
        return share * self.most

    def shareOf(self, factor):
        """The share at which it has a load factor [-]."""
        return factor / self.most


class Acceleration(Acting):
    """Gravity, with a horizontal acceleration that grows beside it.

    :param model: :class:`masonry.assembly.structure.Structure`
    :param most: at its end [g]
    :param towards: unit vector
    """

    def __init__(self, model, most, towards, name, unit="g"):
        super().__init__(name, most, unit, towards)
        self.model = model

    def now(self):
        return list(self.model.scheme.now)

    def put(self, values):
        self.model.scheme.setGravity(Vector3(*values))

    def at(self, began, share):
        down = self.model.description.gravity * Vector3.UnitZ
        whole = self.factor(share) * GRAVITY * self.towards - down
        return list(whole / self.model.args.density_scaling)


class Tilting(Acceleration):
    """Gravity that turns, as on a ground that is tilted. The factor is the horizontal over the vertical part.

    :param angle: at its end [rad]
    """

    def __init__(self, model, angle, towards, name):
        super().__init__(model, math.tan(angle), towards, name, "-")
        self.angle = angle

    def at(self, began, share):
        down, angle = self.model.description.gravity, share * self.angle
        turned = math.sin(angle) * self.towards - math.cos(angle) * Vector3.UnitZ
        return list(down * turned / self.model.args.density_scaling)

    def factor(self, share):
        angle = share * self.angle
        return math.tan(angle) if angle < math.pi / 2 else math.inf

    def shareOf(self, factor):
        return math.atan(factor) / self.angle


class Forces(Acting):
    """Forces of MasonryLoad engines.

    :param loads: the engines
    :param forces: that they have at a factor of 1, a vector for each [N]
    """

    replaces = False  # whether the forces replace those that are there, and are not added to them
    beside = 0, 0, 0  # a force that stays beside those that replace [N]
    dead = False  # whether what was there grows by the factor, too

    def __init__(self, loads, forces, name, unit, most, towards=None):
        super().__init__(name, most, unit, towards)
        self.loads, self.forces = loads, forces

    def pairs(self):
        """The engines and their forces at a factor of 1."""
        pairs = zip(self.loads, self.forces)
        return [(load, force + self.dead * load.force) for load, force in pairs]

    def now(self):
        return [value for load in self.loads for value in load.force]

    def put(self, values):
        for n, load in enumerate(self.loads):
            load.force = Vector3(*values[3 * n : 3 * n + 3])

    def at(self, began, share):
        factor = self.factor(share)
        whole = [factor * value for force in self.forces for value in force]
        if self.replaces:
            return [v + self.beside[n % 3] for n, v in enumerate(whole)]
        return [was * (1 + factor * self.dead) + v for was, v in zip(began, whole)]
