# SPDX-License-Identifier: GPL-2.0-or-later
"""What beams and floors of a masonry are made of: commands of :class:`masonry.scene.materials.Masonry`."""

from __future__ import annotations

import math
from typing import Annotated, Any

from yade.wrapper import MasonryJoint, MasonryMat

from ...common.arguments import number, shown, validated
from ...basics import refuse
from ...bricks import Bricks
from ..settings import Property, Settable, such
from .assumptions import state


_fits = lambda value: isinstance(value, Bricks) and len(value)
_pieces = such(_fits, "what bricks.Beam or bricks.Floor gives")


def _bearing(value, first=None):
    """The kind of what is between a beam or a floor and the masonry below."""
    if isinstance(value, str) and value != "fixed":
        raise ValueError(f"{shown(value)} must be 'fixed', a friction [-] or None")
    if value is None or isinstance(value, str):
        return value
    return number("", 0, 5)(value)


Modulus = Annotated[float, number("Pa", 0, 1e15, above=True)]
Density = Annotated[float, number("kg/m³", 0, 1e6, above=True)]
Poisson = Annotated[float, number("", -1, 0.5, above=True, below=True)]
InPlane = Annotated[float, number("N/m", 0, 1e15, above=True)]  # a stiffness of a floor
STIFFER = 1e4  # how much stiffer than the pieces of a beam the joints are that stand for nothing else [-]
RIGID = 1e14  # Young's modulus of a piece that does not deform [Pa]


@validated
def withBeam(
    masonry: Any,
    beam: Annotated[Any, _pieces],
    young: Modulus,
    density: Density,
    poisson: Poisson = 0.2,
    bearing: Annotated[float | str | None, _bearing] = None,
) -> Any:
    """Say what a beam of :func:`masonry.bricks.Beam` is made of. It is elastic. Returns the same masonry.

    Its pieces are joined by the joint of its name, with the bending stiffness E I and the shear stiffness 5/6 G A of the
    beam. Torsion has G (Iy + Iz), which is too stiff for flat sections.

    :param beam: its pieces
    :param young: [Pa]; ``poisson``: [-]
    :param density: [kg/m³]
    :param bearing: what is between it and masonry: None: a bed joint; a number: a dry joint of this friction [-];
        ``"fixed"``: an elastic joint. The joint is called NAME_bearing
    """
    name, pitch = _newKind(masonry, "withBeam", beam)
    shear = young / (2 * (1 + poisson))
    # in series with the pieces, whose elasticity is lumped into their joints: E / l, and 5/6 G / l
    glue = MasonryJoint(name=name, elastic=True, normalStiffness=STIFFER * young / pitch, shearStiffness=5 * shear / pitch)  # fmt: skip
    unit = MasonryMat(label=name, young=young, poisson=poisson, density=density)
    return _take(masonry, name, unit, glue, bearing)


@validated
def withFloor(
    masonry: Any,
    floor: Annotated[Any, _pieces],
    shear: InPlane,
    mass: Annotated[float, number("kg/m²", 0, 1e6, above=True)],
    across: InPlane | None = None,
    bearing: Annotated[float | str | None, _bearing] = 0.5,
) -> Any:
    """Say what a floor of :func:`masonry.bricks.Floor` is. It shears elastically in its plane. Returns the same masonry.

    :param floor: its strips
    :param shear: shear stiffness G t of its plane [N/m]: a square floor of which one edge is held moves by V / (G t) when a
        force V acts along the other one
    :param mass: with what lies on it [kg/m²]
    :param across: stiffness E t across the strips [N/m]; None: ten times ``shear``, which is assumed
    :param bearing: as in :meth:`withBeam`; the default, a friction of 0.5, is of joists that lie on masonry
    """
    name, pitch = _newKind(masonry, "withFloor", floor)
    low, high = floor[0].low, floor[0].high
    height = high[2] - low[2]
    # strips are nearly rigid, so their joints have all of the stiffness: forces are G t / pitch times the slip
    area = pitch * height
    stiff = dict(normalStiffness=(across or 10 * shear) / area, shearStiffness=shear / area)  # fmt: skip
    glue = MasonryJoint(name=name, elastic=True, **stiff)
    if across is None:
        state(glue, normalStiffness="assumed by withFloor(): across its strips a floor is ten times as stiff as in shear")  # fmt: skip
    unit = MasonryMat(label=name, young=RIGID, poisson=0.0, density=mass / height)
    return _take(masonry, name, unit, glue, bearing)


def _newKind(masonry, word, pieces):
    """The kind of the pieces of a beam or a floor, and the distance of their middles [m]. Raises Refused."""
    kinds, problems = sorted({block.kind for block in pieces}), []
    name = kinds[0]
    if len(kinds) > 1:
        problems.append(f"the pieces are of the kinds {', '.join(kinds)}: give those of one beam or floor")  # fmt: skip
    if name in masonry.units or name in masonry.joints:
        problems.append(f"this masonry has {name!r} already; give the beam or floor another name")  # fmt: skip
    if len(pieces) < 2:
        problems.append(f"{name} is one piece, which is rigid: bricks.Beam(..., pieces=8) bends")  # fmt: skip
    refuse([f"{word}: {one}" for one in problems])
    return name, math.dist(pieces[0].middle, pieces[1].middle)


def _take(masonry, name, unit, glue, bearing):
    masonry.units[name], masonry.joints[name] = unit, glue
    masonry.stiff = masonry.stiff | {name}
    if bearing is not None:
        bed, name = masonry.joints["bed"], f"{name}_bearing"
        own = {"elastic": True} if bearing == "fixed" else slipping(bearing)
        joint = masonry.joints[name] = MasonryJoint(name=name, **own)
        joint.set(normalStiffness=bed.normalStiffness, shearStiffness=bed.shearStiffness)  # fmt: skip
    return masonry


def slipping(friction: float) -> dict[str, Any]:
    """Properties of a joint that has friction alone."""
    return dict(tensileStrength=0, cohesion=0, friction=friction, residualFriction=friction, cap=False)  # fmt: skip


def isBeam(masonry: Any, name: str) -> bool:
    """Whether a name is that of a beam: pieces of a floor do not deform."""
    return name in masonry.stiff and masonry.units[name].young < RIGID


class OfBeam(Settable):
    """What ``--set`` changes of a beam: its material. The stiffness of its joints follows."""

    WORD = "beam"
    known = {
        "young": Property("Pa", 0, RIGID, True),
        "density": Property("kg/m³", 0, 1e6, True),
    }

    def __init__(self, name, masonry):
        self.name = name
        self.unit, self.joint = masonry.units[name], masonry.joints[name]

    def values(self):
        return {name: getattr(self.unit, name) for name in self.known}

    def take(self, values):
        share = values.get("young", self.unit.young) / self.unit.young
        names = ("normalStiffness", "shearStiffness")
        self.joint.updateAttrs({n: share * getattr(self.joint, n) for n in names})
        self.unit.updateAttrs(values)
