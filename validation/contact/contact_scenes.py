# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks that meet without joints, body by body: what the cases of this folder share."""

import math

from masonry import MasonryMat, addBlock, criticalTimeStep, engine
from yade import O, Quaternion, Vector3
from yade.wrapper import *

G = 9.81  # [m/s²]
BRICK = (0.22, 0.102, 0.081)  # [m]


def box(size, middle=(0, 0, 0), turn=Quaternion.Identity, held=False, density=1800.0):
    """A box of a size [m] around a place, turned about it; returns its body id."""
    ends = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    corners = [
        Vector3(*middle) + turn * Vector3(*[a * b for a, b in zip(size, end)]) for end in ends
    ]
    body = addBlock(corners, MasonryMat(density=density, young=4.8e9, poisson=0.16))
    if held:
        O.bodies[body].state.blockedDOFs = "xyzXYZ"
    return body


def ground(turn=Quaternion.Identity, size=(4, 2, 0.4)):
    """A slab that is held, whose upper face goes through the origin; returns its body id."""
    return box(size, turn * Vector3(0, 0, -size[2] / 2), turn, held=True)


def prepare(step=0.5, gravity=(0, 0, -G), **properties):
    """Engines of contacts alone, without numerical damping; returns that of the contacts.

    :param step: time step over the critical one [-]
    :param properties: of ``MasonryContacts``
    """
    usual = dict(normalStiffness=1e10, friction=0.5, restitution=0.5)
    contacts = MasonryContacts(**{**usual, **properties})
    energy = MasonryEnergy(label="energy")
    O.engines = [ForceResetter(), contacts, energy, MasonryIntegrator(damping=0, gravity=gravity)]
    O.dt = step * criticalTimeStep()[0]
    return contacts


def balance():
    """The energy balance, a dict by the names of its parts [J]."""
    return engine("energy").balance()


def until(time):
    """Take steps up to a time [s], at least one."""
    O.run(max(1, math.ceil((time - O.time) / O.dt)), True)


def lean(body):
    """Rotation of a body about y since it was built [rad]."""
    s = O.bodies[body].state
    return math.asin((s.ori * s.refOri.conjugate() * Vector3(0, 0, 1))[0])
