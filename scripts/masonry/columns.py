"""The columns of curve.csv: their names with units, what they mean, and how they follow from a reading of the model.

A reading holds what a model measures of itself once a row, in SI units. Adding a column is adding a line here, and a
value to the reading of the model if it has none that fits.
"""

from collections import namedtuple

#: ``name`` has the unit at its end. ``value`` is a function of a reading that gives the number in that unit.
Column = namedtuple("Column", "name meaning value")


class WallReading(
    namedtuple(
        "WallReading",
        "time along up baseShear topShear energy orientation reference sunk point target",
    )
):
    """What a wall reads, for a row.

    - ``time`` since it was built [s]
    - ``along`` and ``up``: displacement of the loading block since the push began, along the push and upwards [m]
    - ``baseShear``: force of the wall on the fixed block, along the push [N]
    - ``topShear``: force that drives the loading block [N]
    - ``energy``: the energy balance [J]
    - ``orientation`` of the loading block, and ``reference``, the inverse of that in which it was built: quaternions
    - ``sunk``: displacement of the loading block downwards since the wall was built [m]
    - ``point``: number of the point of a history that the drive is going to, from 1; ``target``: its displacement [mm]
    """

    __slots__ = ()

    @property
    def rotation(self):
        """Rotation of the loading block about the axis across the wall [rad]."""
        axis, angle = (self.orientation * self.reference).toAxisAngle()
        return angle * axis[1]


#: What a couplet reads: time since it was built [s]; means over its bed joint of opening and slide [m] and of normal and
#: shear stress [Pa]; force of the couplet on the fixed block, upwards and along the slide [N]; the energy balance [J].
CoupletReading = namedtuple(
    "CoupletReading",
    "time opening slide normalStress shearStress normalForce shearForce energy",
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

WALL = [
    Column("time_s", "time since the wall was built [s]", lambda r: r.time),
    Column(
        "displacement_mm",
        "displacement along the push since the push began, at the measure height above the base [mm]",
        lambda r: 1e3 * r.along,
    ),
    Column(
        "base_shear_kN",
        "force of the wall on the fixed block below it, along the push [kN]",
        lambda r: 1e-3 * r.baseShear,
    ),
    Column(
        "top_shear_kN",
        "force that drives the loading block [kN]",
        lambda r: 1e-3 * r.topShear,
    ),
    Column(
        "vertical_mm",
        "upward displacement at the measure height since the push began [mm]",
        lambda r: 1e3 * r.up,
    ),
    Column(
        "rotation_mrad",
        "rotation of the loading block about the axis across the wall [mrad]",
        lambda r: 1e3 * r.rotation,
    ),
    *BALANCE,
]

#: Of a wall that follows a history.
WALL_LOOPS = [
    *WALL,
    Column(
        "point",
        "number of the point of the history that the drive is going to, from 1 [-]",
        lambda r: r.point,
    ),
    Column("target_mm", "displacement of this point [mm]", lambda r: r.target),
]

COUPLET = [
    Column("time_s", "time since the couplet was built [s]", lambda r: r.time),
    Column(
        "opening_mm",
        "mean opening of the bed joint, negative if it closes [mm]",
        lambda r: 1e3 * r.opening,
    ),
    Column("slide_mm", "mean slide of the bed joint [mm]", lambda r: 1e3 * r.slide),
    Column(
        "normal_stress_MPa",
        "mean normal stress of the bed joint, positive in tension [MPa]",
        lambda r: 1e-6 * r.normalStress,
    ),
    Column(
        "shear_stress_MPa",
        "mean shear stress of the bed joint, along the slide [MPa]",
        lambda r: 1e-6 * r.shearStress,
    ),
    Column(
        "normal_force_kN",
        "force of the couplet on the fixed block below it, upwards [kN]",
        lambda r: 1e-3 * r.normalForce,
    ),
    Column(
        "shear_force_kN",
        "force of the couplet on the fixed block, along the slide [kN]",
        lambda r: 1e-3 * r.shearForce,
    ),
    *BALANCE,
]


def names(columns):
    """The heads of curve.csv."""
    return [column.name for column in columns]


def meanings(columns):
    """What each column means, by its name: the entry ``columns`` of run.json."""
    return {column.name: column.meaning for column in columns}
