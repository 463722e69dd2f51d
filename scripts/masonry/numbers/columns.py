# SPDX-License-Identifier: GPL-2.0-or-later
"""The columns of curve.csv: name, unit, meaning and value of each. Those of a target are in
:meth:`masonry.scene.targets.Target.columns`, those of a recorded joint in
:data:`masonry.scene.targets.OF_JOINTS`. ``scene.column`` adds one from a script."""

from dataclasses import dataclass
from typing import Callable

from yade import O

from .quantities import ENERGIES, OF_CONNECTORS, OF_CONTACTS


@dataclass(frozen=True)
class Column:
    """A column of curve.csv.

    :param name: without its unit
    :param unit: ``"-"`` if it has none; None: name and meaning have it already
    :param meaning: one line for run.json, without the unit
    :param value: function of a :class:`Reading`, in that unit
    """

    name: str
    unit: str
    meaning: str
    value: Callable

    @property
    def head(self):
        """As in the first line of curve.csv."""
        return self.name if self.unit in (None, "-") else f"{self.name}_{self.unit}"

    @property
    def explanation(self):
        """As in run.json."""
        return self.meaning if self.unit is None else f"{self.meaning} [{self.unit}]"


class Reading:
    """What all columns of a row are taken from: a structure at one moment, in SI units.

    - ``time`` since the scene was built [s]
    - ``along``, ``up``: displacement of the followed point since the push or load began [m]
    - ``rotation`` of the followed block, about y in a plane, else its angle [rad]
    - ``baseShear``: force of the structure on all that is held, along the push or load;
      ``topShear``: that drives the pushed point [N]
    - ``energy``: the energy balance [J]
    - ``goal``: number, from 1, and displacement [mm] of the point of a history that the drive is
      going to
    - ``forces``: force of the structure by the name of the target, along the axes that are held now
      or that springs hold [N]
    """

    def __init__(self, structure):
        self.structure, self.time = structure, O.time
        self._moved = {}
        self.forces = {}
        held = structure.connectors.onGround()
        for target in structure.supports.held:
            force = structure.supports.supportedBy(target)
            self.forces[target.name] = force + structure.connectors.onSpringsOf(target)
            for i in structure.axes:
                held[i] += force[i]
        self.along = self.up = self.topShear = self.rotation = 0.0
        loading = structure.loading
        if loading.followed:
            moved, self.rotation = self.moved(loading.followed)
            self.along = moved.dot(loading.direction) - loading.origin[0]
            self.up = moved[2] - loading.origin[1]
        if loading.target:
            self.topShear = loading.push.reaction
        along, beside = loading.direction, loading.besideThePush()
        self.baseShear = held.dot(along) - beside.dot(along)
        self.energy = structure.energy.balance()
        self.goal = loading.goal

    def moved(self, target):
        """Displacement [m] of a target's recorded point since the scene was built, and rotation
        [rad]."""
        if id(target) not in self._moved:
            self._moved[id(target)] = self.structure.supports.moved(target)
        return self._moved[id(target)]


def _energies(names):
    for name, (meaning, _) in names.items():
        value = lambda r, name=name: r.energy[name]
        yield Column(name, "J", f"{meaning} since the scene was built", value)


CRACKS = Column(
    "largest_crack",
    "mm",
    "largest opening of a point of any joint, without slide, 0 if none is open; looked for"
    " every 300 steps or more",
    lambda r: r.structure.widest,
)

#: The energy balance of every run, and of ties, springs and testing machines.
BALANCE = [
    *_energies(ENERGIES),
    Column(
        "balance_error",
        "-",
        "error of the energy balance, relative to the largest work done until then",
        lambda r: r.energy["error"],
    ),
]
CONNECTORS = [*_energies(OF_CONNECTORS)]
#: Of a scene whose collapse is followed.
CONTACTS = [
    *_energies(OF_CONTACTS),
    Column(
        "handed_joints",
        "-",
        "joints whose place contacts have taken so far",
        lambda r: r.structure.contacts.handed,
    ),
    Column(
        "fallen_blocks",
        "-",
        "blocks that have fallen so far",
        lambda r: len(r.structure.fallen()),
    ),
]

#: Of a push.
PUSH = [
    Column("time", "s", "time since the scene was built", lambda r: r.time),
    Column(
        "displacement",
        "mm",
        "displacement of the pushed point, or of the push's control, along the push, or of the"
        " watched one along a load that grows, since that began",
        lambda r: 1e3 * r.along,
    ),
    Column(
        "base_shear",
        "kN",
        "force of the structure on all that is held, along the push or load; of a push without dead"
        " weight and dead loads",
        lambda r: 1e-3 * r.baseShear,
    ),
    Column(
        "top_shear",
        "kN",
        "force that drives what is pushed",
        lambda r: 1e-3 * r.topShear,
    ),
    Column(
        "vertical",
        "mm",
        "upward displacement of this point since then",
        lambda r: 1e3 * r.up,
    ),
    Column(
        "rotation",
        "mrad",
        "rotation of its block, about y in a plane, else its angle; 0 of a pattern",
        lambda r: 1e3 * r.rotation,
    ),
]


def _drift(reading):
    loading, supports = reading.structure.loading, reading.structure.supports
    height = loading.followed and supports.heights(loading.followed, loading.direction)[1]
    return 100 * loading.masonryAlong() / height if height else 0.0


#: Of a scene in which a platen moves.
OF_PLATEN = [
    Column(
        "masonry_displacement",
        "mm",
        "displacement of the bricks at the pushed or watched platen along the push or load since"
        " that began; elsewhere of that point",
        lambda r: 1e3 * r.structure.loading.masonryAlong(),
    ),
    Column(
        "drift",
        "percent",
        "this displacement over the height of these bricks' side, or of that point, above the"
        " lowest brick; 0 unless the push or load is horizontal",
        _drift,
    ),
]
#: Of a push that follows a history.
HISTORY = [
    Column(
        "point",
        "-",
        "number of the point of the history that the drive is going to, from 1",
        lambda r: r.goal[0],
    ),
    Column("target", "mm", "displacement of this point", lambda r: r.goal[1]),
]


def heads(columns):
    """The first line of curve.csv."""
    return [column.head for column in columns]


def meanings(columns):
    """The entry ``columns`` of run.json."""
    return {column.head: column.explanation for column in columns}
