# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact of blocks that have lost their joints, and the ground on which they fall."""

import itertools
from typing import Annotated, Any

from ..arguments import Name, number, validated
from .platens import Coordinate
from ..errors import Refused
from ..materials.settings import Property, Settable
from .targets import Target
from .script import describes

RESTITUTION = 0.5  # [-] as in MasonryContacts
FRICTION = 0.6  # [-] of masonry blocks with elastic joints
#: Thickness of the ground, its reach beyond the structure, and the gap above it, over the height of
#: what is built [-]. What comes down from there slides no farther if friction is 0.05.
THICKNESS, REACH, GAP = 0.5, 20.0, 1e-3


class Contact(Settable):
    """Contact of blocks that have lost their joints. Properties that are None are those of the bed
    joint.

    - ``normalStiffness``: of two faces per area [Pa/m]
    - ``tangentialRatio``: stiffness along the face over that along the normal [-]
    - ``friction``: its coefficient [-]; of the bed joint the residual one
    - ``restitution``: speed after over before a central impact of two faces [-]
    """

    WORD = name = "contact"
    normalStiffness = tangentialRatio = friction = None
    restitution = RESTITUTION
    known = {
        "normalStiffness": Property("Pa/m", 0, 1e18, True),
        "tangentialRatio": Property("-", 0, 1, True),
        "friction": Property("-", 0, 10),
        "restitution": Property("-", 0.1, 1),
    }

    def scatter(self, name, factor):
        raise ValueError(
            f"contact: {name} is the same all over; --set contact.{name}=... changes it"
        )

    def of(self, bed):
        """The attributes of MasonryContacts; ``bed``: the bed joint."""
        defaults = {
            "normalStiffness": bed.normalStiffness,
            "tangentialRatio": min(1.0, bed.shearStiffness / bed.normalStiffness),
            "friction": FRICTION if bed.elastic else bed.residualFriction,
        }
        return {n: defaults.get(n) if v is None else v for n, v in self.values().items()}


def problems(description, args):
    if args.points and description.functors:
        yield (
            f"--points {args.points}: with functors joints keep three points; leave functors=False"
        )
    if not description.contact:
        return
    if description.functors:
        yield (
            "collapse='follow': the functors go on with joints whose blocks have come apart; leave"
            " functors=False"
        )
    if args.blocks == "deformable":
        yield (
            "collapse='follow': deformable bricks have no contacts; choose --blocks rigid, or a"
            " preset with it, or collapse='end'"
        )
    if args.density_scaling != 1:
        yield (
            f"--density-scaling {args.density_scaling:g}: with collapse='follow' blocks fall in"
            " real time, with true masses"
        )


@describes
@validated
def ground(
    description: Any,
    level: Coordinate,
    name: Name | None = None,
    reach: Annotated[float, number("m", 0, 1e4, above=True)] | None = None,
) -> Target:
    """The ground on which blocks fall in a scene with ``collapse="follow"``: a wide block that is
    held, without joints. Without this command it lies just below everything else. A block that
    leaves it is stopped there, and counted apart.

    :param level: z of its upper side [m], at or below everything else
    :param name: in curve.csv; None: ground
    :param reach: beyond the box around what is built, to all sides [m]; None: 20 times the height
    """
    if not description.contact:
        raise Refused("ground: only a scene with collapse='follow' has a ground")
    if description.ground():
        raise Refused("ground: the scene has its ground already")
    return addGround(description, level, name or "ground", reach)


def addGround(description, level=None, name=None, reach=None):
    """Add the ground on which blocks fall.

    :param level: as in :func:`ground`, as is ``reach``; None: just below everything else
    :param name: None: ground, or another one if a target has that name
    """
    targets = description.targets
    names = itertools.chain(["ground"], (f"ground{k}" for k in itertools.count(2)))
    boxes = [target.box for target in targets.values() if target.box]
    lowest = min([description.low[2], *(box[0][2] for box in boxes)])
    height = description.high[2] - description.low[2]
    top = lowest - GAP * height if level is None else level
    if not top <= lowest:
        raise Refused(
            f"ground: level {top:g} m must be at most {lowest:g} m, where the lowest of what is"
            " built ends"
        )
    reach = reach or REACH * (description.high[2] - top)
    low = [v - reach for v in description.low[:2]]
    high = [v + reach for v in description.high[:2]]
    middle = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), top)
    return description.add(
        Target(
            name or next(one for one in names if one not in targets),
            fixed=True,
            point=middle,
            recorded=middle,
            box=((*low, top - THICKNESS * height), (*high, top)),
            freedom="xyzXYZ",
            loaded=False,
            joined=False,
        )
    )
