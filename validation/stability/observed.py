# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls whose state is looked at all the time: what the studies of this folder share. It needs
YADE."""

from dataclasses import dataclass, field

import numpy as np
from masonry import Scene, bricks, materials
from masonry.numbers import columns
from yade import O

BLOCKS = ["rigid", "deformable"]
UNIT = (0.220, 0.102, 0.081)  # [m]
STEPS = 4000  # of the push, where an axis does not ask for another rate
SMALL = dict(halfUnits=4, courses=4, precompression=0.5e6, unit=UNIT, loadHeight=None)


@dataclass
class Point:
    """A run: a value on an axis, and what is different from a small wall of calcium silicate."""

    value: object
    words: str = ""  # options
    wall: dict = field(default_factory=dict)  # what is other than in SMALL
    #: Properties in SI units by the name of the joint; "all" stands for bed, head and crack.
    joints: dict = field(default_factory=dict)
    until: float = 1.0  # [mm]; None: the words have a history
    rate: float = None  # [mm/s]; None: what takes STEPS steps
    dt: float = None  # of the push, over the limit [-]
    gravity: bool = True
    whole: bool = False  # whether it is COMP-4 and not the small wall

    def masonry(self):
        """Calcium silicate with the changes of this point."""
        joints = materials.calciumSilicateJoints()
        if "--joints brittle" in self.words:
            joints = {n: j if j.elastic else j.brittleCoulomb() for n, j in joints.items()}
        for name, values in self.joints.items():
            for joint in ["bed", "head", "crack"] if name == "all" else [name]:
                joints[joint].updateAttrs(values)
        return materials.Masonry(materials.calciumSilicateUnit(), joints)


class Observed(Scene):
    """A run of a point, with ``model``. Every step or so, numbers that are not finite raise
    AssertionError.

    ``worst`` has the largest value of a yield function over its size, and the most that any memory
    of a joint fell.

    :param folder: of the results
    """

    def __init__(self, point, blocks, folder):
        words = f"--no-vtk --out {folder} --blocks {blocks} {point.words}"
        if point.until:
            words += f" --until {point.until!r}"
        if point.rate:
            words += f" --rate {point.rate!r}"
        whole = dict(halfUnits=36, courses=34) if point.whole else {}
        wall = {**SMALL, **whole, **point.wall}
        long, _, high = unit = wall["unit"]
        self.point, self.before, self.looked = point, None, 0
        self.worst = dict.fromkeys(["yield", "healed"], 0.0)
        super().__init__(
            "w",
            bricks.Wall(wall["halfUnits"] * long / 2, wall["courses"] * high, unit),
            point.masonry(),
            columns=columns.heads(columns.PUSH),
            arguments=words.split(),
            gravity=9.81 if point.gravity else 0,
            until=1,
        )
        self.platen("bottom")
        self.top = self.platen(
            "top",
            rotation="free" if wall["loadHeight"] else "held",
            upTo=wall["loadHeight"],
            recorded=wall["courses"] * high,
            drive="x",
        )
        self.press(self.top, wall["precompression"])
        self.__enter__()  # errors are the caller's
        self.running.show = lambda *args, **more: None  # a study has thousands of runs
        advance = self.running.advance

        def advanceAndLook(steps):
            advance(steps)
            self.looked += 1
            if len(self.model.interactions) < 500 or self.looked % 20 == 0:
                self.look()

        self.running.advance = advanceAndLook
        self.begin()

    def look(self):
        memories = lambda phys: (phys.damage, phys.largest, [[s] for s in phys.slip])
        every = lambda what: np.array([[*v] for i in self.model.interactions for v in what(i)])
        memory = [
            np.column_stack([np.array([[*v] for v in values]) for values in memories(i.phys)])
            for i in self.model.interactions
        ]
        energies = list(self.model.energy.balance().values())
        bodies = np.array([[*b.state.pos, *b.state.vel, *b.state.ori] for b in O.bodies])
        stresses = every(lambda i: i.phys.stress)
        jumps = every(lambda i: i.geom.jumps)
        yields = every(lambda i: i.phys.yielding)
        for numbers in (np.vstack(memory), energies, bodies, stresses, jumps, yields):
            if not np.isfinite(numbers).all():
                raise AssertionError(f"numbers are not finite after {O.iter} steps")
        self._note("yield", yields.max())
        if self.before is not None:
            for was, now in zip(self.before, memory):
                if was.shape == now.shape:  # else the joint has got points, and begins anew
                    self._note("healed", (was - now).max())
        self.before = memory

    def _note(self, what, value):
        self.worst[what] = max(self.worst[what], float(value))

    def rest(self):
        return self.settle(damping="local", record=False)

    def pushOn(self):
        point, args = self.point, self.args
        if point.dt:
            O.dt = point.dt * self.model.scheme.limit
        if point.rate is None:
            args.rate = args.until / (STEPS * O.dt)
        return self.push(self.top)
