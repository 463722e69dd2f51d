"""The columns of curve.csv: their names with units, what they mean, and how they follow from a reading of the model.

A reading holds what a model measures of itself once a row, in SI units. Adding a column is adding a line here, and a
value to the reading of the model if it has none that fits.
"""

from collections import namedtuple

#: ``name`` has the unit at its end. ``value`` is a function of a reading that gives the number in that unit.
Column = namedtuple("Column", "name meaning value")


#: What a structure reads, for a row.
#:
#: - ``time`` since it was built [s]
#: - ``along`` and ``up``: displacement of the pushed point since the push began, along the push and upwards [m]
#: - ``baseShear``: force of the structure on what is held, along the push [N]
#: - ``topShear``: force that drives the pushed point [N]
#: - ``energy``: the energy balance [J]
#: - ``rotation`` of the pushed block [rad]
#: - ``sunk``: displacement of the pushed point downwards since the structure was built [m]
#: - ``point``: number of the point of a history that the drive is going to, from 1; ``target``: its displacement [mm]
#: - ``values``: numbers of every other column by its name
Reading = namedtuple(
    "Reading",
    "time along up baseShear topShear energy rotation sunk point target values",
)

#: Energies by their name in the balance, and what each is.
ENERGIES = {
    "external": "work of the loads",
    "gravity": "work of gravity",
    "kinetic": "energy of motion",
    "damping": "energy taken by damping",
    "elastic_units": "elastic energy in deformable units",
    "elastic_tension": "elastic energy in joints, from tension",
    "elastic_shear": "elastic energy in joints, from shear",
    "elastic_compression": "elastic energy in joints, from compression",
    "dissipated_tension": "energy that joints dissipated in tension",
    "dissipated_shear": "energy that joints dissipated in shear",
    "dissipated_compression": "energy that joints dissipated in compression",
}


def _energy(name):
    return lambda reading: reading.energy[name]


BALANCE = [
    Column(f"{name}_J", f"{meaning} since the model was built [J]", _energy(name))
    for name, meaning in ENERGIES.items()
]
BALANCE += [
    Column(
        "balance_error",
        "error of the energy balance, relative to the work done [-]",
        _energy("error"),
    )
]

#: Of a push.
PUSH = [
    Column("time_s", "time since the scene was built [s]", lambda r: r.time),
    Column(
        "displacement_mm",
        "displacement of the pushed point along the push, since that began [mm]",
        lambda r: 1e3 * r.along,
    ),
    Column(
        "base_shear_kN",
        "force of the structure on all that is held, along the push [kN]",
        lambda r: 1e-3 * r.baseShear,
    ),
    Column(
        "top_shear_kN",
        "force that drives the pushed point [kN]",
        lambda r: 1e-3 * r.topShear,
    ),
    Column(
        "vertical_mm",
        "upward displacement of the pushed point since the push began [mm]",
        lambda r: 1e3 * r.up,
    ),
    Column(
        "rotation_mrad",
        "rotation of the pushed block, about y in a plane, else its angle [mrad]",
        lambda r: 1e3 * r.rotation,
    ),
]

#: Of a push that follows a history.
HISTORY = [
    Column(
        "point",
        "number of the point of the history that the drive is going to, from 1 [-]",
        lambda r: r.point,
    ),
    Column("target_mm", "displacement of this point [mm]", lambda r: r.target),
]


def names(columns):
    """The heads of curve.csv."""
    return [column.name for column in columns]


def meanings(columns):
    """What each column means, by its name: the entry ``columns`` of run.json."""
    return {column.name: column.meaning for column in columns}
