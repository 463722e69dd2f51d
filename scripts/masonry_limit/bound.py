# SPDX-License-Identifier: GPL-2.0-or-later
"""What limit analysis found: the factor, forces, and the mechanism with its files."""

import json
import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from masonry.arguments import FilePath
from masonry.folders import replaced
from masonry.packages import needed
from .programme import FACETS

SLIDING_POWER = 1e-4  # share of friction in the power from which joints of a mechanism slide [-]
# less than this share of the largest motion between two blocks of the mechanism is not listed [-]
MIN_MOTION_RATIO = 0.02

LOST = "cohesion", "tension", "crushing"  # strengths that a joint can lose
FILE = "mechanism.json"  # of which a figure is drawn
MECHANISM = "mechanism_blocks.vtu", "mechanism_joints.vtu"  # files for ParaView
SHOWN = 0.06  # how far the fastest corner is drawn to move, over the size of the structure [-]


@dataclass
class Bound:
    """What limit analysis found: a load factor, and the mechanism at which the structure gives way.

    Velocities are those with which the live load has a power of 1, so only their ratios mean
    something.
    """

    assembly: Any  #: :class:`Assembly`
    #: factor that was maximised [-]; :attr:`factor` has its sign
    value: float
    velocities: np.ndarray  #: of blocks (n, 6): of the centroid, and of the rotation
    live: np.ndarray
    dead: np.ndarray
    normal: np.ndarray  #: force on each contact, positive in compression [N]
    along: np.ndarray  #: force along the joint on each contact (c, 3) [N]
    #: change of the factor when the facets of friction were turned last [-]; 0 in the plane, where
    #: there are none; how far their corners are outside the cone where turning takes too long
    facetError: float = 0.0
    dilates: bool = True  #: whether joints that slip open as friction tells
    settled: bool = False  #: of :meth:`Assembly.withoutDilatancy`
    #: factor of a mechanism in which open joints slip, if that is lower, else None [-]
    weaker: float | None = None
    factor: float = field(init=False)  #: on the live load [-]

    def __post_init__(self):
        self.factor = self.value

    # -- forces ------------------------------------------------------------------------------------

    @property
    def compressed(self) -> np.ndarray:
        """Normal forces by which friction is judged [N]: one a joint in the plane, one a contact in
        space."""
        a = self.assembly
        if a.plane:
            return np.bincount(a.contacts.joint, self.normal, len(a.pairs))
        return self.normal

    @property
    def directions(self) -> np.ndarray:
        """Angle of the force along the joint on each contact, from the joint's first tangent
        [rad]."""
        one, two = self.assembly.tangents[self.assembly.contacts.joint].swapaxes(0, 1)
        return np.arctan2((self.along * two).sum(1), (self.along * one).sum(1))

    @property
    def overstressed(self) -> float:
        """How far forces along the joints are above friction and cohesion, as a share of all of
        them [-]."""
        a, c = self.assembly, self.assembly.contacts
        strength = a.cohesion[c.joint] * c.area + a.friction[c.joint] * self.normal
        along = np.linalg.norm(self.along, axis=1)
        if a.plane:  # one force along each joint
            one = (self.along * a.tangents[c.joint, 0]).sum(axis=1)
            along = np.abs(np.bincount(c.joint, one))
            strength = np.bincount(c.joint, strength)
        return float(np.maximum(along - strength, 0).sum() / max(along.sum(), 1e-300))

    # -- the mechanism -----------------------------------------------------------------------------

    def motion(self, block: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Velocities of points of blocks. ``block`` are numbers, ``at`` their points (k, 3) [m]."""
        u = self.velocities[block]
        return u[:, :3] + np.cross(u[:, 3:], at - self.assembly.centres[block])

    def jumps(self, joint: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Opening (k) and slide (k, 3) of points (k, 3) of joints."""
        one, two = self.assembly.pairs[joint].T
        jump = self.motion(two, at) - self.motion(one, at)
        normal = self.assembly.normals[joint]
        opening = (jump * normal).sum(axis=1)
        return opening, jump - opening[:, None] * normal

    def fastest(self) -> int:
        """Number of the block with the fastest centroid."""
        return int(np.linalg.norm(self.velocities[:, :3], axis=1).argmax())

    @property
    def powers(self) -> dict[str, float]:
        """Power of the mechanism by what takes it: ``friction``, ``cohesion``, ``tension``,
        ``crushing``, and ``loads``, what the live load at its factor and the dead loads do, all
        counted positive.
        """
        a, c = self.assembly, self.assembly.contacts
        opening, slide = self.jumps(c.joint, c.at)
        cohesive = a.cohesion[c.joint] * c.area * np.linalg.norm(slide, axis=1)
        cohesion, shear = float(cohesive.sum()), self.along * slide
        # in the plane the force along a joint stands at one of its points
        shear = np.abs(shear.sum(axis=1)).sum() if a.plane else abs(shear.sum())
        closing = np.where(np.isfinite(a.crushing[c.joint]), np.maximum(-opening, 0), 0)
        tension = a.tension[c.joint] * c.area * np.maximum(opening, 0)
        live = abs((self.factor * self.live * self.velocities).sum())
        dead = np.abs((self.dead * self.velocities).sum(axis=1)).sum()
        return {
            "friction": max(0.0, shear - cohesion),
            "cohesion": cohesion,
            "tension": float(tension.sum()),
            "crushing": float((np.maximum(self.normal, 0) * closing).sum()),
            "loads": float(live + dead),
        }

    def _takes(self, *kinds):
        """Whether strengths together take power of the mechanism."""
        powers = self.powers
        return sum(powers[kind] for kind in kinds) > SLIDING_POWER * powers["loads"]

    @property
    def slides(self) -> bool:
        """Whether friction takes part in the mechanism."""
        return self._takes("friction")

    @property
    def rigid(self) -> bool:
        """Whether no joint slides in the mechanism, and none has a strength there that it could
        lose."""
        return not self.slides and not self._takes(*LOST)

    @property
    def exact(self) -> bool:
        """Whether the factor is what rigid blocks with dry joints carry: no joint slides or loses
        strength in the mechanism, and no joints close a loop, so that none can slip while others
        keep it open.
        """
        return self.rigid and not self.assembly.bonded

    def joints(self) -> np.ndarray:
        """What joints do in the mechanism: an array of ``"rests"``, ``"opens"``, ``"slides"`` or
        ``"crushes"`` (m)."""
        a, c = self.assembly, self.assembly.contacts
        states = np.full(len(a.pairs), "rests", dtype="<U7")
        opening, slide = self.jumps(c.joint, c.at)
        speed = np.linalg.norm(slide, axis=1)
        least = MIN_MOTION_RATIO * max(np.abs(opening).max(initial=0), speed.max(initial=0))
        states[c.joint[(-opening > least) & np.isfinite(a.crushing[c.joint])]] = "crushes"
        states[c.joint[speed > least]] = "slides"
        # what slides as friction tells opens by the friction coefficient of it
        ofSlide = 1.001 * a.friction[c.joint] * speed + 1e-9 * least
        states[c.joint[(opening > least) & (opening > ofSlide)]] = "opens"
        return states

    def sentence(self, load: str, unit: str) -> str:
        """What was found, as a sentence.

        :param load: name of the live load
        :param unit: of the factor
        """
        verbs = {"opens": "open", "slides": "slide", "crushes": "crush"}
        counts = ", ".join(f"{n} {verbs[k]}" for k, n in self._counts().items() if n)
        if self.dilates and self.exact:
            what = "no joint slides, so this is what rigid blocks carry"
        elif self.dilates:
            what = "an upper bound, since " + self._reason()
        else:
            what = "joints that slip do not open"
            if not self.settled:
                what += f"; {100 * self.overstressed:.1g} % of the forces are above friction"
        joints = counts or "none moves"
        return f"limit analysis: {load} {self.factor:.4g} {unit} ({what}); joints: {joints}"

    def _counts(self):
        """How many joints do what in the mechanism."""
        states = [*self.joints()]
        return {kind: states.count(kind) for kind in ("opens", "slides", "crushes")}

    def _reason(self):
        reasons = []
        if self.weaker is not None:
            reasons.append(f"open joints slip at {self.weaker:.4g} already")
        if self.slides:
            reasons.append("joints slide")
        if self._takes(*LOST):
            reasons.append("joints lose strength")
        return " and ".join(reasons) or "joints that are open may slip"

    def describe(self) -> dict[str, Any]:
        """The entries of run.json: a dict."""
        powers = self.powers
        return {
            "factor": self.factor,
            "exact": self.exact,
            "open_joints_slip": self.weaker,
            "dilates": self.dilates,
            "joints": self._counts(),
            "powers": {k: v / (powers["loads"] or 1) for k, v in powers.items()},
            "facets": 0 if self.assembly.plane else FACETS,
            "facet_error": self.facetError,
        }

    # -- files -------------------------------------------------------------------------------------

    def frames(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """The mechanism as frames of blocks and joints, as :func:`masonry.numbers.frames.readFrame`
        gives those of a run, scaled so that the corner that moves most moves by :data:`SHOWN` of
        the structure's size."""
        a = self.assembly
        sizes = [len(c) for c in a.corners]
        numbers, points = np.repeat(np.arange(len(sizes)), sizes), np.concatenate(a.corners)
        moved = self.motion(numbers, points)
        far = np.linalg.norm(moved, axis=1).max() or 1.0
        scale = SHOWN * np.ptp(points, axis=0).max() / far
        blocks = {
            "points": points,
            "displacement": scale * moved,
            "body": np.array(a.ids),
            "cells": np.split(np.arange(len(points)), np.cumsum(sizes)[:-1]),
        }
        states, count = self.joints(), len(a.pairs)
        opening, slide = self.jumps(a.contacts.joint, a.contacts.at)
        widest, closest, along = np.zeros(count), np.zeros(count), np.zeros((count, 3))
        np.maximum.at(widest, a.contacts.joint, opening)
        np.maximum.at(closest, a.contacts.joint, -opening)
        order = np.argsort(np.linalg.norm(slide, axis=1))
        # the last of a joint stays, and that is its fastest point
        along[a.contacts.joint[order]] = slide[order]
        sizes = [len(p) for p in a.polygons]
        corners, which = np.concatenate(a.polygons), np.repeat(np.arange(count), sizes)
        one, two = a.pairs[which].T
        opens, slides = states == "opens", states == "slides"
        joints = {
            "points": corners,
            "displacement": scale * self.motion(one, corners),
            "second_displacement": scale * self.motion(two, corners),
            "cells": np.split(np.arange(len(corners)), np.cumsum(sizes)[:-1]),
            "bodies": np.array(a.ids)[a.pairs],
            "kind": a.seams.astype(int),
            "normal": a.normals,
            "area": np.bincount(a.joint, a.areas, count),
            "opening": np.where(opens, scale * widest, 0),
            "slide": np.where(slides[:, None], scale * along, 0),
            "crushing": np.where(states == "crushes", scale * closest, 0),
            "damage_tension": opens.astype(float),
            "damage_shear": slides.astype(float),
        }
        return blocks, joints

    def save(
        self,
        directory: FilePath,
        title: str = "",
        parts: dict[str, Any] | None = None,
        views: dict[str, Any] | None = None,
    ) -> None:
        """Write the mechanism: ``mechanism.json``, of which ``/usr/bin/python3 -m
        masonry_view.figures`` draws mechanism.png, and ``mechanism_blocks.vtu`` and
        ``mechanism_joints.vtu`` for ParaView.

        :param title: of the figure
        :param parts: dict of name -> ids of bodies, a panel each; None: all in one
        :param views: directions of sight by part, as in run.json
        :raises Missing: if the files for ParaView cannot be written
        """
        blocks, joints = self.frames()
        entries = dict(title=title, parts=parts or {}, views=views or {})
        entries.update(blocks=blocks, joints=joints)
        with replaced(os.path.join(directory, FILE), "w") as file:
            json.dump(entries, file, default=np.ndarray.tolist)
        self._saveForParaView(directory, blocks, joints)

    def _saveForParaView(self, directory, blocks, joints):
        Mesh = needed("meshio").Mesh
        from scipy.spatial import ConvexHull

        faces, body = [], []
        for number, nodes in zip(blocks["body"], blocks["cells"]):
            hull = ConvexHull(blocks["points"][nodes])
            faces += nodes[hull.simplices].tolist()
            body += [number] * len(hull.simplices)
        fans, owner = [], []
        for number, (first, *others) in enumerate(joints["cells"]):
            fans += [(first, *two) for two in zip(others, others[1:])]
            owner += [number] * (len(others) - 1)
        names = "opening slide crushing normal damage_tension damage_shear".split()
        values = {"body": [np.array(body)]}, {n: [joints[n][owner]] for n in names}
        found = zip(MECHANISM, (blocks, joints), (faces, fans), values)
        for name, frame, triangles, ofCells in found:
            moves = {n: v for n, v in frame.items() if n.endswith("displacement")}
            mesh = Mesh(frame["points"], [("triangle", np.array(triangles))], moves, ofCells)
            mesh.write(os.path.join(directory, name))
