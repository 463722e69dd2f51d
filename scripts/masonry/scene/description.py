"""A structure as a scene describes it: its bricks, what holds and loads them, and what is recorded. Plain records.

:class:`masonry.scene.scene.Scene` has all of these words, :class:`masonry.scene.structure.Structure` makes them in YADE.
"""

import math
from dataclasses import dataclass

from ..bricks import Bricks
from ..basics import Refused, say
from .materials import Masonry
from ..assembly.blocks import vector

PLATEN = 0.2  # [m] height of a platen


@dataclass
class Target:
    """A platen, or a brick that is held, loaded or watched. ``scene.platen`` and its like make it.

    :param name: in the columns of curve.csv
    :param fixed: whether it does not move but by :meth:`masonry.scene.scene.Scene.move`
    """

    name: str
    fixed: bool = False
    point: tuple = None  # [m] on which loads act
    recorded: tuple = None  # [m] whose motion is recorded
    brick: int = None  # index of a brick, None for a platen
    box: tuple = None  # opposite corners of a platen
    freedom: str = ""  # YADE's blockedDOFs
    loaded: bool = True
    drives: str = ""  # axes along which a drive holds it from the beginning
    body: int = None  # YADE's id, when the scene is built
    force: tuple = None  # [N] dead load
    pressed: float = None  # [Pa] on the bricks below
    riding: bool = True  # whether the load moves with the platen


@dataclass
class JointRecord:
    """A joint between two bricks whose means are recorded. ``scene.joint`` makes it; it can be read between stages."""

    name: str
    bricks: tuple  # indices of the two bricks
    interaction: object = None  # YADE's, when the scene is built

    @property
    def area(self):
        """[m²]"""
        return sum(self.interaction.geom.areas)

    @property
    def normalStiffness(self):
        """[Pa/m]"""
        return self.interaction.phys.normalStiffness

    def _mean(self, values):
        areas = self.interaction.geom.areas
        return sum(a * v for a, v in zip(areas, values)) / sum(areas)

    def normalStress(self):
        """Mean over the joint [Pa], positive in tension."""
        return self._mean(s[0] for s in self.interaction.phys.stress)

    def column(self, end):
        """The name of a column."""
        return f"{self.name}_{end}" if self.name else end

    def read(self):
        """Means over the joint by the end of their names in curve.csv."""
        geom, phys = self.interaction.geom, self.interaction.phys
        stress = phys.stress
        return {
            "opening_mm": 1e3 * self._mean(phys.opening),
            "slide_mm": 1e3 * self._mean(j[1] for j in geom.jumps),
            "normal_stress_MPa": 1e-6 * self._mean(s[0] for s in stress),
            "shear_stress_MPa": 1e-6 * self._mean(s[1] for s in stress),
        }


#: What is recorded of a joint: the end of the name of a column, and its meaning.
OF_JOINTS = {
    "opening_mm": "mean opening of {}, negative if it closes [mm]",
    "slide_mm": "mean slide of {}, along its first direction [mm]",
    "normal_stress_MPa": "mean normal stress of {}, positive in tension [MPa]",
    "shear_stress_MPa": "mean shear stress of {}, along the slide [MPa]",
}


class Described:
    """Bricks, materials and everything that a scene says before its first stage; :class:`masonry.scene.scene.Scene`."""

    model = None  # the structure in YADE, when it is built

    def describe(self, name, bricks, materials, title, plane, gravity, choice):
        """Take the parameters of a scene. Raises Refused, with all problems."""
        problems = []
        try:
            self.bricks = list(bricks)
            self.bricks[0].corners[0][2]
        except Exception:
            problems.append(
                f"scene {name}: bricks must be a list of blocks, as masonry.bricks makes them, got {bricks!r}"
            )
        if not isinstance(materials, Masonry):
            problems.append(
                f"scene {name}: materials must be a masonry.scene.materials.Masonry, got {materials!r}"
            )
        if not (isinstance(gravity, (int, float)) and 0 <= gravity < math.inf):
            problems.append(
                f"scene {name}: gravity {gravity!r} must be at least 0 m/s², downwards"
            )
        if problems:
            raise Refused("\n".join(problems))
        self.title, self.materials, self.gravity = title or name, materials, gravity
        points = [p for block in self.bricks for p in block.corners]
        self.low, self.high = (
            [f(p[i] for p in points) for i in range(3)] for f in (min, max)
        )
        self.plane = self._inPlane() if plane is None else plane
        self.choice = choice  # of columns, None: all
        self.targets = {}
        self.joints = []  # whose means are recorded
        self.drifts = []  # name, lower and upper target
        self.winds = []  # brick, force [N] and point [m]
        self.views = {}  # direction of sight by part
        self.script = []  # what the script has said so far
        self.extra = []  # columns of the user's

    @property
    def halves(self):
        """Whether some of the bricks are in pieces."""
        return len({b.brick for b in self.bricks}) < len(self.bricks)

    def _inPlane(self):
        sides = {
            tuple(round(f(p[1] for p in b.corners), 9) for f in (min, max))
            for b in self.bricks
        }
        return len(sides) == 1

    # -- what holds it --------------------------------------------------------------------------------------------

    def _describing(self, what):
        if self.model:
            raise ValueError(
                f"{what} must come before the first stage: the scene is built already"
            )

    def _add(self, target):
        self._say("target", [repr(vars(target))], {})
        if not (isinstance(target.name, str) and target.name.isidentifier()):
            raise ValueError(
                f"the name of a target must be letters, digits and underscores, got {target.name!r}"
            )
        if target.name in self.targets:
            raise ValueError(
                f"there are two targets of the name {target.name!r}; give one of them another name"
            )
        self.targets[target.name] = target
        return target

    def platen(
        self,
        where,
        rotation=None,
        height=PLATEN,
        name=None,
        point=None,
        guided="",
        part=None,
        upTo=None,
        recorded=None,
        drive="",
    ):
        """A stiff block over the whole lower or upper side of the structure.

        The one at the bottom is fixed. The one at the top moves; loads act on it, and ``rotation`` says whether it can
        turn. Its joint to the bricks is the ``support`` joint of the materials.

        :param where: ``"bottom"`` or ``"top"``
        :param rotation: ``"free"`` or ``"held"``, of the platen at the top; None: held
        :param height: [m]
        :param name: in curve.csv; None: base and top
        :param point: (x, y, z) [m] on which loads act; None: the middle of the platen's outer side
        :param guided: axes along which the one at the top cannot move: ``"x"``, ``"y"`` or ``"xy"``; its top support then
            carries horizontal force
        :param part: name of a part of the bricks; the platen is over this part alone. None: over all
        :param upTo: z of its outer side [m], in place of ``height``: where a testing machine pushes
        :param recorded: z of the point whose displacement is recorded [m], on the line through ``point``; None: that of
            ``point``
        :param drive: axes along which a drive holds the one at the top from the beginning: ``"x"``, or ``"xz"``; None of
            them: it is free until it is pushed
        """
        self._describing("platen()")
        if where not in ("bottom", "top"):
            raise ValueError(f"platen: where must be 'bottom' or 'top', got {where!r}")
        if where == "bottom" and rotation not in (None, "held"):
            raise ValueError("platen: the one at the bottom is fixed and cannot turn")
        if rotation not in (None, "held", "free"):
            raise ValueError(
                f"platen: rotation must be 'held' or 'free', got {rotation!r}"
            )
        if guided not in ("", "x", "y", "xy") or guided and where == "bottom":
            raise ValueError(
                f"platen: guided must be 'x', 'y' or 'xy', of the one at the top, got {guided!r}"
            )
        if not 0 < height < math.inf:
            raise ValueError(f"platen: height {height} m must be above 0")
        bottom = where == "bottom"
        level = self.low[2] if bottom else self.high[2]
        side = "below" if bottom else "above"
        if upTo is not None and not 0 < (level - upTo if bottom else upTo - level):
            raise ValueError(
                f"platen: upTo {upTo} m must be {side} the bricks, which end at {level:g} m"
            )
        if set(drive) - set("xz" if self.plane else "xyz") or drive and bottom:
            raise ValueError(
                f"platen: drive must be some of 'x', 'y' and 'z', of the one at the top, got {drive!r}"
            )
        self._ofPart(part, "platen")
        touching = [
            p
            for block in self.bricks
            for p in block.corners
            if part in (None, block.part)
            and abs(p[2] - level) < 1e-6 * (1 + abs(level))
        ]
        if not touching:
            raise ValueError(
                f"platen: part {part!r} does not reach the {where}, z = {level:g} m"
            )
        low = [min(p[i] for p in touching) for i in range(2)]
        high = [max(p[i] for p in touching) for i in range(2)]
        if any(a == b for a, b in zip(low, high)):
            raise ValueError(
                f"platen: no horizontal side of a brick lies at the {where}, z = {level:g} m"
            )
        outer = level - height if bottom else level + height
        outer = outer if upTo is None else upTo
        box = ((*low, min(level, outer)), (*high, max(level, outer)))
        middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, outer)
        freedom = (
            "xyzXYZ"
            if bottom
            else ("yXYZ" if self.plane else "XYZ")
            if rotation != "free"
            else ("yXZ" if self.plane else "")
        )
        freedom += "".join(axis for axis in guided if axis not in freedom)
        point = tuple(vector(point or middle, "platen: point [m]"))
        if recorded is not None and not isinstance(recorded, (int, float)):
            raise ValueError(f"platen: recorded must be a z in m, got {recorded!r}")
        if recorded is not None and not min(level, outer) <= recorded * (1 + 1e-12):
            raise ValueError(
                f"platen: recorded {recorded:g} m is not on the platen, which begins at {min(level, outer):g} m"
            )
        return self._add(
            Target(
                name or ("base" if bottom else "top"),
                fixed=bottom,
                point=point,
                recorded=point if recorded is None else (*point[:2], recorded),
                box=box,
                freedom=freedom,
                loaded=not bottom,
                drives=drive,
            )
        )

    def hold(self, where, name=None, axes="xyzXYZ"):
        """Hold a brick, so that it neither moves nor turns but by :meth:`move`.

        :param where: a point [m] in it or near it, its index in the bricks, or the block itself
        :param name: in curve.csv; None: ``brick`` and its index
        :param axes: along which it is held, xyz, and about which it cannot turn, XYZ; a prop against a wall that leans is
            ``"y"``
        """
        if not axes or set(axes) - set("xyzXYZ"):
            raise ValueError(f"hold: axes must be some of 'xyzXYZ', got {axes!r}")
        if self.plane and not set(axes) - set("yXZ"):
            raise ValueError(
                f"hold: in the x-z plane no block moves along {axes} anyway; Scene(..., plane=False) is in space"
            )
        target = self._brick(where, name, fixed=True)
        target.freedom = "".join(axes) if not self.plane else "".join({*axes, *"yXZ"})
        return target

    def watch(self, where, name=None):
        """Record the motion of a brick. Parameters as of :meth:`hold`; a point is the one that is recorded."""
        return self._brick(where, name, fixed=False, loaded=False)

    def handle(self, where, name=None):
        """A brick that loads act on, at its centre or at the point that is given. Parameters as of :meth:`hold`."""
        return self._brick(where, name, fixed=False)

    def _brick(self, where, name, fixed, loaded=None):
        self._describing("hold(), watch() and handle()")
        index, point = self._find(where)
        return self._add(
            Target(
                name or f"brick{index}",
                fixed=fixed,
                point=point or self.middle(index),
                recorded=point or self.middle(index),
                brick=index,
                freedom="xyzXYZ" if fixed else None,
                loaded=not fixed if loaded is None else loaded,
            )
        )

    def _find(self, where):
        """Index of a brick, and the point by which it is named, or None."""
        count, point = len(self.bricks), None
        if isinstance(where, int) and not isinstance(where, bool):
            if not -count <= where < count:
                raise ValueError(f"brick {where}: there are {count} bricks, from 0")
            index = where % count
        elif any(where is block for block in self.bricks):
            index = next(i for i, block in enumerate(self.bricks) if block is where)
        else:
            try:
                point = tuple(float(v) for v in where)
                if len(point) != 3 or not all(map(math.isfinite, point)):
                    raise TypeError
            except (TypeError, ValueError):
                raise ValueError(
                    f"a brick is named by its index, by a point (x, y, z) in m, or by itself, got {where!r}"
                ) from None
            index = min(range(count), key=lambda i: self._distance(i, point))
            away, size = self._distance(index, point), self.size(index)
            if away > size:
                raise ValueError(
                    f"no brick is near {point} m: the nearest is {away:g} m away"
                )
        return index, point

    def middle(self, index):
        """Mean of the corners of a brick [m]."""
        corners = self.bricks[index].corners
        return tuple(sum(p[i] for p in corners) / len(corners) for i in range(3))

    def size(self, index):
        """Longest side of the box around a brick [m]."""
        corners = self.bricks[index].corners
        return max(
            max(p[i] for p in corners) - min(p[i] for p in corners) for i in range(3)
        )

    def _distance(self, index, point):
        """How far a point is from the box around a brick, with a little of the way to its middle to break ties [m]."""
        corners = self.bricks[index].corners
        away = 0.0
        for i in range(3):
            low, high = min(p[i] for p in corners), max(p[i] for p in corners)
            away = max(away, low - point[i], point[i] - high)
        return away + 1e-6 * math.dist(self.middle(index), point)

    # -- what loads it --------------------------------------------------------------------------------------------

    def press(self, platen, stress, riding=True):
        """Press a platen on the bricks below it. The load grows in :meth:`settle`, and stays.

        :param stress: mean vertical stress that the bricks feel [Pa]; the weight of the platen is part of it
        :param riding: whether the load moves with the platen; else it keeps its line in space, as over rollers
        """
        self._describing("press()")
        if not isinstance(platen, Target) or not platen.box or platen.fixed:
            raise ValueError("press: only a platen that moves can be pressed")
        if not (isinstance(stress, (int, float)) and 0 <= stress < math.inf):
            raise ValueError(f"press: stress {stress!r} must be at least 0 Pa")
        if 0 < stress < 1e3:
            say(f"warning: press: {stress:g} Pa: is it in Pa, not MPa?")
        self._say("press", [platen, stress, riding], {})
        platen.pressed, platen.riding = float(stress), bool(riding)

    def load(self, target, force):
        """A dead load on a target. It grows in :meth:`settle`, and stays; loads on one target add up.

        :param force: three numbers [N]
        """
        self._describing("load()")
        if not isinstance(target, Target) or not target.loaded:
            raise ValueError(
                "load: only a platen that moves or a handle() can be loaded"
            )
        force = vector(force, "load: force [N]")
        if self.plane and force[1]:
            raise ValueError(
                "load: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        self._say("load", [target, tuple(force)], {})
        before = target.force or (0.0, 0.0, 0.0)
        target.force = tuple(a + b for a, b in zip(force, before))

    def wind(self, pressure, towards, part=None):
        """A pressure on the faces that look against a horizontal direction. It grows in :meth:`settle`, and stays.

        Loaded are the faces of rigid bricks within 45 degrees of the direction, each along its normal, on the part that no
        joint covers. Those that stand behind others are among them. Suction is a negative pressure.

        :param pressure: [Pa]
        :param towards: direction in which the wind blows, horizontal
        :param part: name of a part of the bricks; None: all
        """
        self._describing("wind()")
        towards = vector(towards, "wind: direction")
        if not isinstance(pressure, (int, float)) or not 0 < abs(pressure) < math.inf:
            raise ValueError(f"wind: pressure {pressure!r} Pa must be other than 0")
        if abs(pressure) > 1e5:
            say(
                f"warning: wind: {pressure:g} Pa: is it in Pa? A storm has about 1000 Pa"
            )
        if towards[2] or not towards.norm():
            raise ValueError(f"wind: the direction must be horizontal, got {towards}")
        if self.plane and towards[1]:
            raise ValueError(
                "wind: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        self._ofPart(part, "wind")
        if self.args.blocks == "deformable":
            raise Refused("wind: it loads rigid bricks; choose --blocks rigid")
        faces = [
            face
            for face in Bricks(self.bricks).freeFaces(-towards)
            if part in (None, self.bricks[face[0]].part)
        ]
        if not faces:
            raise ValueError(f"wind: no free face looks against {tuple(towards)}")
        self._say("wind", [pressure, tuple(towards), part], {})
        for brick, normal, area, middle in faces:
            self.winds.append((brick, [-pressure * area * n for n in normal], middle))
        return sum(area for _, _, area, _ in faces)

    def _ofPart(self, part, what):
        parts = sorted({block.part for block in self.bricks})
        if part is not None and part not in parts:
            raise ValueError(f"{what}: no part {part!r}; there are {', '.join(parts)}")

    def drift(self, lower, upper, name=None):
        """Record how far a target moves horizontally against a lower one, for example two floors.

        The columns of curve.csv are the difference [mm] and that over the height between both points [mrad].

        :param lower: a target, as :meth:`platen` or :meth:`watch` give it; ``upper``: one above it
        :param name: of the columns; None: that of ``upper`` with ``_drift``
        """
        self._describing("drift()")
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
        self._say("drift", [lower, upper, name], {})
        self.drifts.append((name, lower, upper))

    def column(self, name, meaning, value):
        """Record something of one's own: a column of curve.csv.

        :param name: with its unit at the end, for example ``drift_mm``
        :param meaning: one line for run.json
        :param value: function without arguments that gives a number
        """
        self._describing("column()")
        if not callable(value):
            raise ValueError(f"column {name}: value must be a function, got {value!r}")
        if not (isinstance(name, str) and name.isidentifier()):
            raise ValueError(
                f"column: a name must be letters, digits and underscores, got {name!r}"
            )
        self.extra.append((name, meaning, value))

    def joint(self, one, two, name=None):
        """Record the means of a joint: opening, slide, normal and shear stress, as columns of curve.csv.

        :param one: a brick, as for :meth:`hold`; ``two``: the other one
        :param name: before the names of the columns; None: ``joint`` and a number; an empty text: nothing before them
        :returns: a :class:`JointRecord`, which can be read between stages, too
        """
        self._describing("joint()")
        pair = tuple(self._find(where)[0] for where in (one, two))
        if pair[0] == pair[1]:
            raise ValueError(f"joint: both are brick {pair[0]}")
        name = f"joint{len(self.joints)}" if name is None else name
        if name and not (isinstance(name, str) and name.isidentifier()):
            raise ValueError(
                f"joint: a name must be letters, digits and underscores, got {name!r}"
            )
        self._say("joint", [pair, name], {})
        self.joints.append(JointRecord(name, pair))
        return self.joints[-1]

    def view(self, direction, part=None):
        """From where the crack figure sees the structure: the direction of sight, for example (1, 0, 0) for a panel that
        bows out of its plane.

        :param part: name of a part of the bricks; None: all
        """
        self._describing("view()")
        sight = vector(direction, "view: direction")
        names = {block.part for block in self.bricks}
        if not sight.norm() or part not in (None, *names):
            raise ValueError(
                f"view: no direction {direction!r} of part {part!r}; there are {', '.join(sorted(names))}"
            )
        for name in [part] if part else names:
            self.views[name] = [float(v) for v in sight]
