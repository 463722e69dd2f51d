# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene records beside its targets, and how its figures look: words that describe a scene."""

from ..assembly.blocks import vector
from ..assembly.columns import Column
from .targets import Drift, JointRecord, Target
from .words import describes


@describes
def drift(description, lower, upper, name=None):
    """Record how far a target moves horizontally against a lower one, for example two floors.

    The columns of curve.csv are the difference [mm] and that over the height between both points [mrad].

    :param lower: a target, as :meth:`platen` or :meth:`watch` give it; ``upper``: one above it
    :param name: of the columns; None: that of ``upper`` with ``_drift``
    """
    if not isinstance(lower, Target) or not isinstance(upper, Target):
        raise ValueError("drift: needs two targets, such as platens or watch()")
    if not upper.recorded[2] - lower.recorded[2] > 0:
        raise ValueError(
            f"drift: {upper.name} at z = {upper.recorded[2]:g} m must be above {lower.name} at "
            f"{lower.recorded[2]:g} m"
        )
    name = name or f"{upper.name}_drift"
    if not (isinstance(name, str) and name.isidentifier()):
        raise ValueError(
            f"drift: a name must be letters, digits and underscores, got {name!r}"
        )
    description.drifts.append(Drift(name, lower, upper))


@describes
def column(description, name, meaning, value):
    """Record something of one's own: a column of curve.csv.

    :param name: with its unit at the end, for example ``drift_mm``
    :param meaning: one line for run.json
    :param value: function without arguments that gives a number
    """
    if not callable(value):
        raise ValueError(f"column {name}: value must be a function, got {value!r}")
    if not (isinstance(name, str) and name.isidentifier()):
        raise ValueError(
            f"column: a name must be letters, digits and underscores, got {name!r}"
        )
    description.extra.append(
        Column(name, None, meaning, lambda reading: float(value()))
    )


@describes
def joint(description, one, two, name=None):
    """Record the means of a joint: opening, slide, normal and shear stress, as columns of curve.csv.

    :param one: a brick, as for :meth:`hold`; ``two``: the other one
    :param name: before the names of the columns; None: ``joint`` and a number; an empty text: nothing before them
    :returns: a :class:`JointRecord`, which can be read between stages, too
    """
    pair = tuple(description.find(where)[0] for where in (one, two))
    if pair[0] == pair[1]:
        raise ValueError(f"joint: both are brick {pair[0]}")
    name = f"joint{len(description.joints)}" if name is None else name
    if name and not (isinstance(name, str) and name.isidentifier()):
        raise ValueError(
            f"joint: a name must be letters, digits and underscores, got {name!r}"
        )
    description.joints.append(JointRecord(name, pair))
    return description.joints[-1]


@describes
def view(description, direction, part=None):
    """From where the crack figure sees the structure: the direction of sight, for example (1, 0, 0) for a panel that
    bows out of its plane.

    :param part: name of a part of the bricks; None: all
    """
    sight = vector(direction, "view: direction")
    names = {block.part for block in description.bricks}
    if not sight.norm() or part not in (None, *names):
        raise ValueError(
            f"view: no direction {direction!r} of part {part!r}; there are {', '.join(sorted(names))}"
        )
    for name in [part] if part else names:
        description.views[name] = [float(v) for v in sight]
