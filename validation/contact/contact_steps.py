# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step: blocks of all sizes, densities, stiffnesses and speeds at shares of the critical
time step, and above it."""

import itertools
import math

import numpy as np
from contact_motion import heap
from contact_rows import Row, case
from contact_scenes import balance, box, prepare
from yade import O, Quaternion, Vector3

#: Shares of the critical time step below it, and above it.
BELOW, ABOVE = (0.3, 0.6, 0.95), (1.5, 3.0)
#: How two blocks meet: the turn of the second.
MEETINGS = {
    "faces": Quaternion.Identity,
    "edge": Quaternion(Vector3(0, 1, 0), math.pi / 4),
    "corner": Quaternion(Vector3(0, 1, 0), math.atan(math.sqrt(0.5)))
    * Quaternion(Vector3(0, 0, 1), math.pi / 4),
}
#: Axes of the map of two blocks: sides of both [m], densities [kg/m³], stiffnesses [Pa/m], speeds
#: [m/s].
SIZES = ((0.01, 0.01), (0.01, 10), (10, 0.01), (0.1, 1), (1, 0.1), (10, 10))
DENSITIES, STIFFNESSES, SPEEDS = (200, 2700), (1e9, 1e10, 1e12), (0.01, 1, 10)


def collide(step, meeting, sizes, density, stiffness, speed, restitution, phase):
    """Two cubes without gravity, of which the first comes with a speed [m/s] and meets the second
    off its middle.

    :param step: over the critical time step
    :param sizes: sides of both [m]
    :param phase: share of a step at which they meet
    :returns: energy over that before, when they have parted, or after 20000 steps: a small block
        may cling to a large one
    :raises RuntimeError: if the engine refuses the time step
    """
    O.reset()
    one = O.bodies[box((sizes[0],) * 3, density=density)].state
    reach = 0.5 * (
        sizes[0] + sizes[1] * {"faces": 1, "edge": math.sqrt(2), "corner": math.sqrt(3)}[meeting]
    )
    off = 0.1 * min(sizes)
    box((sizes[1],) * 3, (reach, off, 0.5 * off), MEETINGS[meeting], density=density)
    contacts = prepare(step, gravity=(0, 0, 0), normalStiffness=stiffness, restitution=restitution)
    one.pos -= Vector3((2 + phase) * speed * O.dt, 0, 0)
    one.vel = Vector3(speed, 0, 0)
    met, before = False, energy()
    for _ in range(20000):
        O.step()
        touching = contacts.touching() > 0
        met = met or touching
        if met and not touching:
            break
    assert met
    return (energy() + balance()["elastic_contacts"]) / before


def energy():
    """Kinetic energy of all bodies [J]."""
    total = 0.0
    for b in O.bodies:
        s = b.state
        spin = s.ori.conjugate() * s.angVel
        total += 0.5 * s.mass * s.vel.squaredNorm()
        total += 0.5 * sum(i * w * w for i, w in zip(s.inertia, spin))
    return total


@case
def two_blocks(quick):
    """Collisions of two blocks over the whole map, at shares of the critical time step."""
    rows, dice = [], np.random.default_rng(1)
    points = list(itertools.product(SIZES, DENSITIES, STIFFNESSES, SPEEDS))
    if quick:
        points = points[:: len(points) // 8]
    for meeting, restitution in itertools.product(MEETINGS, (1, 0.5)):
        for step in BELOW:
            kept = [collide(step, meeting, *point, restitution, dice.uniform()) for point in points]
            missed = ""
            if meeting == "faces":
                missed = (
                    "all of both faces meets within one step; a spring that sets in within a step"
                    " makes or takes up to (ω·Δt)²/4 of the energy"
                )
            what = (
                f"{len(points)} meetings, {meeting}, restitution {restitution}, at {step} of the"
                " limit: largest energy after over before, less 1 [-]"
            )
            rows.append(Row(what, "0 or less", max(kept) - 1, limit=1e-3, misses=missed))
    refused = 0
    for step in ABOVE:
        for point in points:
            try:
                collide(step, "faces", *point, 1, 0.5)
            except RuntimeError as stopped:
                refused += "the time step is" in str(stopped)
    of = len(ABOVE) * len(points)
    rows.append(
        Row(
            (
                f"share of {of} meetings at {ABOVE[0]} and {ABOVE[1]} of the limit that the engine"
                " refuses [-]"
            ),
            "all",
            refused / of,
            1.0,
            0.0,
        )
    )
    return rows


@case
def twelve_blocks(quick):
    """Heaps of twelve blocks of three sizes at shares of the critical time step."""
    rows = []
    for scale, density in ((1, 1800),) if quick else ((0.1, 1800), (1, 200), (1, 1800), (90, 2700)):
        size = tuple(scale * side for side in (0.11, 0.102, 0.081))
        for step in BELOW[-1:] if quick else BELOW:
            O.reset()
            heap(12, abreast=1, size=size, density=density)
            prepare(step, normalStiffness=1e9, restitution=0.3)
            end, lost, back = 2.1 * math.sqrt(scale), 0.0, 0.0
            while O.time < end:
                for _ in range(100):
                    O.step()
                now = balance()
                gone = now["gravity"] - now["kinetic"] - now["elastic_contacts"]
                back, lost = max(back, lost - gone), max(lost, gone)
            of = f"bricks {1e3 * size[0]:g} mm long, {density} kg/m³, at {step} of the limit"
            rows += [
                Row(
                    f"{of}: kinetic energy at the end over the work of gravity [-]",
                    "0: at rest",
                    now["kinetic"] / now["gravity"],
                    limit=1e-5,
                ),
                Row(
                    f"{of}: largest growth of the mechanical energy over the work of gravity [-]",
                    "0",
                    back / now["gravity"],
                    limit=1e-3,
                ),
                Row(f"{of}: error of the energy balance [-]", "0", abs(now["error"])),
            ]
    return rows
