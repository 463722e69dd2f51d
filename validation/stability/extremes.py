# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes at the extremes, in the words of a script, judged by closed forms and by statics.

yade -n -x validation/stability/extremes.py [--scenes N] [--first N] [--seed S] [--falls N]

A scene is a block, a stack or a wall between platens, with sizes from 1 mm to 10 m, stiffness from
1e6 to 1e14 Pa/m, friction from 0 to 5, strengths from 0 to 1e12 Pa and one or two stages after
``settle``. It must end with numbers that statics and closed forms confirm, with a stated reason, or
with a refusal. Rates and times are drawn in time steps, so that a scene takes seconds; one that
needs more than ``MOST_STEPS`` is counted as too long.

With ``--falls`` the scenes are walls that cannot stand: each must collapse in ``settle`` with an
energy balance that closes, or say why not.
"""

import argparse
import collections
import contextlib
import io
import json
import math
import os
import random
import sys
import tempfile
import traceback

from masonry import AT_REST, COLLAPSED, MOVING, MasonryJoint, MasonryMat, Scene
from masonry import bricks, materials
from masonry.units import GRAVITY
from masonry.errors import Refused
from masonry.run.drawing_program import DrawingProgram
from masonry.stages import growing, rest
from yade import O

SCRIPT = sys.argv[0] if __name__ == "__main__" else __file__  # yade has its own there
HERE = os.path.dirname(os.path.abspath(SCRIPT))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), "statics"), HERE]
from statics import ROUND_OFF, Wrong, checkColumns, checkNewton  # noqa: E402
from stability import SHARE, table  # noqa: E402

MOST_STEPS = 400000  # of a scene
PLATEN = 1800  # kg/m³, of the blocks that load a structure
HELD = 1.01  # largest load that was held over its closed form
PUSHED = 1.02  # largest force of a push over its closed form, beside the imbalance
MISSING = 5e-3  # of the loads at the supports of a structure at rest
STAGES = (
    "push push push cycle lean accelerate tilt growForce growPressure wind load"
    " shake run move settle"
).split()
CALMING = 20000  # steps after which what was in motion has come to rest
#: With one of these a run says that its force is above what statics allows.
DOUBTS = "too fast", "above the upper bound"
CLASSES = "confirmed, warned, not at rest, collapsed, refused, too long, failed"


class TooLong(Exception):
    """A scene needs more steps than there are for one."""


# -- what is drawn ---------------------------------------------------------------------------------


class Dice(random.Random):
    """Random numbers over many powers of ten."""

    def power(self, low, high):
        """A number from 10^low to 10^high [-]."""
        return float(f"{10 ** self.uniform(low, high):.3g}")

    def often(self, share):
        """Whether an event of a probability has come."""
        return self.random() < share


class Case:
    """A structure between platens, with the numbers that its closed forms need.

    :param dice: :class:`Dice`
    """

    def __init__(self, dice):
        self.dice = dice
        self.kind = dice.choice(["block", "stack", "wall"])
        self.courses = 1 if self.kind == "block" else dice.randint(2, 4)
        side = dice.power(-3, 1)
        self.height = min(10.0, max(1e-3, side * dice.power(-0.7, 0.7)))
        self.thick = min(10.0, max(1e-3, side * dice.power(-0.5, 0.3)))
        units = dice.randint(2, 3) if self.kind == "wall" else 1
        self.unit = (side, self.thick, self.height)
        self.length = units * side
        self.area, self.top = self.length * self.thick, self.courses * self.height
        self.deformable = dice.often(0.12)
        self.masonry = self._materials()
        bed = self.masonry.joints["bed"]
        self.kn, self.ks = bed.normalStiffness, bed.shearStiffness
        self.friction = max(bed.friction, bed.residualFriction)
        self.cohesion, self.tension = bed.cohesion, bed.tensileStrength
        self.weight = self.masonry.unit.density * self.area * self.height * GRAVITY
        self.rotation = dice.choice(["held", "free", None])  # None: no platen on it
        self.platen = 0.3 * self.height
        self.own = PLATEN * self.area * self.platen * GRAVITY if self.rotation else 0.0
        pressed = self.rotation and dice.often(0.6)
        self.stress = self._stress() if pressed else 0.0
        self.down = 0.0  # dead load on the handle [N]
        if not self.rotation and not self.deformable and dice.often(0.4):
            self.down = self.weight * dice.power(-1, 2)
        self.above = self.stress * self.area - self.own if pressed else self.down

    def _stress(self):
        usual = self.weight / self.area * self.courses
        dice = self.dice
        stress = usual * dice.power(-0.5, 2) if dice.often(0.8) else dice.power(0, 9)
        return float(f"{stress:.3g}")

    def _materials(self):
        dice = self.dice
        density, kn = dice.power(2.5, 3.7), dice.power(6, 14)
        friction = 0.0 if dice.often(0.1) else round(dice.uniform(0, 5), 3)
        if dice.often(0.5):
            return materials.dry(friction, kn, None, density)
        if dice.often(0.2):
            return self._byTests(density, friction)
        return self._byJoints(density, friction, kn)

    def _byTests(self, density, friction):
        dice = self.dice
        fm, fv0 = dice.power(5.5, 8), min(self._strength(), 1e8)
        mortar = min(0.05 * self.unit[0], 0.1, 0.5 * self.height)
        E = fm * dice.power(2, 3.5)
        return materials.masonry(
            E=E,
            unit_E=E / dice.uniform(0.1, 0.95),
            fc=fm,
            Gc=min(max(fm * fm / E * self.height * dice.power(0.5, 2), 10), 1e7),
            fv0=fv0,
            friction=friction,
            ft=fv0 / max(friction, 1) * dice.uniform(0, 1),
            unit=(self.unit[0] - mortar, self.unit[1], self.height - mortar),
            joint=mortar,
            density=density,
        )

    def _strength(self):
        return 0.0 if self.dice.often(0.2) else self.dice.power(0, 12)

    def _byJoints(self, density, friction, kn):
        dice, ks, young = self.dice, kn * self.dice.uniform(0.1, 1), self.dice.power(7, 12)
        lumped = 0.0 if self.deformable else max(self.unit) / young  # [m/Pa]
        cohesion, tension = self._strength(), self._strength()
        if friction and dice.often(0.9):  # else it may be refused
            tension = min(tension, 0.99 * cohesion / friction)
        enough = lambda: dice.power(0.1 if dice.often(0.9) else -1, 2)
        energy = lambda f, k, soft: enough() * materials.leastEnergy(f, k, soft)
        values = dict(cap=False)
        if dice.often(0.4):
            fc, ratio = dice.power(4, 12), dice.uniform(2, 60)
            values = dict(
                compressiveStrength=fc,
                peakRatio=ratio,
                compressiveFractureEnergy=fc * fc * (ratio / kn + lumped) * enough() * 2,
            )
        if tension:
            values["modeIFractureEnergy"] = energy(tension, kn, lumped)
        if cohesion:
            values["modeIIFractureEnergy"] = energy(cohesion, ks, 2.4 * lumped)
        joint = MasonryJoint(
            normalStiffness=kn,
            shearStiffness=ks,
            tensileStrength=tension,
            cohesion=cohesion,
            friction=friction,
            residualFriction=friction,
            **values,
        )
        unit = MasonryMat(density=density, young=young, poisson=0.2)
        return materials.Masonry(unit, {"bed": joint})

    # -- closed forms ------------------------------------------------------------------------------
    # Interface n is the bed below course n; the last one is that of the platen on top. Each is an
    # upper bound: what is above an interface slides on it, or turns about its edge, and nothing
    # else resists but bond, all of it at once.

    def levels(self, loaded):
        """Numbers of the interfaces below a load.

        :param loaded: number of the course that it acts on, or ``courses`` for the platen
        """
        return range(loaded + 1)

    def bricksAbove(self, n):
        """Weight of the courses above an interface [N]."""
        return (self.courses - n) * self.weight

    def press(self, n, cos=1.0):
        """Normal force of an interface, when gravity has turned by an angle of this cosine [N]."""
        return cos * (self.bricksAbove(n) + self.own) + self.above

    def slides(self, n, cos=1.0):
        """Largest shear of an interface [N]."""
        return self.friction * max(0.0, self.press(n, cos)) + self.cohesion * self.area

    def turns(self, n, cos=1.0, moved=0.0):
        """Largest moment of what stands on an interface about its edge [N m].

        :param moved: displacement of what is above, against the direction in which it turns [m]
        """
        arm = self.length / 2 + moved
        bond = self.tension * self.area * self.length / 2
        own = max(0.0, self.press(n, cos)) * arm + bond
        holds = self.rotation == "held" and n < self.courses
        return own + (self.turns(self.courses, cos, moved) if holds else 0.0)

    def lever(self, height, n):
        """Height over an interface, less what joints and units between have shortened by [m]."""
        soft = 1 / self.kn
        if self.deformable:
            soft += self.height / self.masonry.unit.young
        closed = soft * sum(self.press(k) for k in range(n, self.courses)) / self.area
        return height - n * self.height - closed

    def mostPush(self, loaded, height, moved=0.0):
        """Largest horizontal force on a course or platen at a height [N]."""
        held = self.rotation == "held" and loaded == self.courses
        height = self.top if held else height
        found = []
        for n in self.levels(loaded):
            found.append(self.slides(n))
            arm = self.lever(height, n)
            if arm > 0:
                found.append(self.turns(n, moved=moved) / arm)
        return min(found)

    def mostAcceleration(self, tilts):
        """Largest horizontal over vertical acceleration [-]."""
        numbers = range(self.courses + bool(self.rotation))
        cosine = lambda f: 1 / math.hypot(1, f) if tilts else 1.0
        carried = lambda f: all(self._carries(n, f, cosine(f)) for n in numbers)
        low, high = 0.0, 1e6
        for _ in range(100):
            middle = math.sqrt(max(low, 1e-9) * high)
            low, high = (middle, high) if carried(middle) else (low, middle)
        return high if high > 2e-9 else 0.0

    def _carries(self, n, f, cos):
        force, moment = f * cos * self.own, 0.0
        arm = self.platen / 2 if self.rotation != "held" else 0.0
        moment = force * max(0.0, self.lever(self.top + arm, n))
        for k in range(n, self.courses):
            force += f * cos * self.weight
            middle = (k + 0.5) * self.height
            moment += f * cos * self.weight * max(0.0, self.lever(middle, n))
        return force <= self.slides(n, cos) and moment <= self.turns(n, cos)

    def mostWind(self):
        """Largest pressure on the end of the structure [Pa]."""
        found = []
        for n in range(self.courses):
            high = self.top - n * self.height
            found.append(self.slides(n) / (self.thick * high))
            arm = self.lever(self.top - high / 2, n)
            if arm > 0:
                found.append(self.turns(n) / (self.thick * high * arm))
        return min(found)

    def carried(self):
        """What the lower platen carries at rest [N]."""
        return self.press(0)


# -- scenes ----------------------------------------------------------------------------------------


class Play:
    """A scene of a case: it is built and taken through its stages.

    :param case: :class:`Case`
    :param folder: of its results
    """

    def __init__(self, case, folder):
        self.case, self.dice = case, case.dice
        dice, self.found = case.dice, []
        self.said, self.stages, self.steps = io.StringIO(), [], 0
        #: Whether nothing but gravity and the first loads acts, and whether a push holds its
        #: target.
        self.clean, self.driven, self.moved = True, False, 0.0
        words = ["--no-vtk", "--checkpoint-every", "0", "--out", folder]
        words += ["--joints", dice.choice(["softening"] * 3 + ["cyclic", "brittle"])]
        if case.deformable:
            words += ["--blocks", "deformable"]
        if dice.often(0.3):
            words += ["--damping-kind", "local"]
        if dice.often(0.15):
            words += ["--damping", repr(round(dice.uniform(0, 0.95), 2))]
        if dice.often(0.15):
            words += ["--density-scaling", repr(dice.power(0, 3))]
        plane = False if not case.deformable and dice.often(0.15) else None
        built = self._bricks()
        self.scene = Scene("extreme", built, case.masonry, plane=plane, arguments=words)
        self.base = self.scene.platen("bottom")
        self.target, self.loaded = self._target()

    def _bricks(self):
        case = self.case
        if case.kind == "wall":
            return bricks.Wall(case.length, case.top, case.unit, halves=False)
        return bricks.stack(case.courses, case.unit)

    def _target(self):
        """The target that is loaded, and the number of its course."""
        case, scene = self.case, self.scene
        if case.rotation:
            self.drive = "x" if self.dice.often(0.15) else ""
            self.driven = bool(self.drive)
            top = scene.platen("top", rotation=case.rotation, height=case.platen, drive=self.drive)
            if case.stress:
                scene.press(top, case.stress)
            self.height = case.top + case.platen
            return top, case.courses
        if case.deformable:
            return scene.watch(-1), case.courses - 1
        handle = scene.handle(-1)
        if case.down:
            scene.load(handle, (0, 0, -case.down))
        self.height = case.top - case.height / 2
        return handle, case.courses - 1

    def play(self):
        """Take the scene through its stages, and check what it says."""
        scene, dice = self.scene, self.dice
        scene.begin()
        self._count()
        ramp = rest.rampTime(scene.args) * max(1.0, self.case.top / 3)
        if 1.5 * ramp / O.dt > MOST_STEPS:
            raise TooLong(f"loads grow within {ramp / O.dt:.3g} steps")
        self.longest = max(1.5 * ramp, dice.power(3.5, 4.8) * O.dt)
        growing.TRIAL = max(3 * ramp, 2e4 * O.dt) / scene.args.density_scaling**0.5
        self.stages.append("settle")
        longest = self.longest if dice.often(0.8) else None
        ended = scene.settle(longest=min(longest or 86400, 86400))
        if ended == AT_REST:
            self._checkSupports()
        if ended == MOVING:
            self.clean = False
        for _ in range(dice.randint(1, 2)):
            if ended == COLLAPSED:
                break
            ended = self._stage()
        if not scene.collapsed:
            self._checkStatics()
            checkColumns(scene)

    def _checkStatics(self):
        """Newton's laws now, or, if moments are off by what moves in a step, when that has come to
        rest."""
        scene = self.scene
        try:
            checkNewton(scene)
        except Wrong as wrong:
            if "moments" not in str(wrong):
                raise
            scene.model.scheme.damp(0.8, "local")
            O.run(CALMING, True)
            checkNewton(scene)
            self.inMotion = f"not at rest: statics holds when it is: {wrong}"

    def _count(self):
        """Let every advance count its steps."""
        advance = self.scene.running.advance

        def counted(steps):
            self.steps += steps
            if self.steps > MOST_STEPS:
                raise TooLong(f"{self.steps} steps in {', '.join(self.stages)}")
            advance(steps)

        self.scene.running.advance = counted

    def _checkSupports(self):
        """What the lower platen carries, by the loads and the volumes that were drawn."""
        found = abs(1e3 * self.scene.results.column("base_force_z_kN")[-1])
        need = self.case.carried()
        size = need if abs(need) > 1e-6 * self.case.own else self.case.own
        if not abs(found - need) <= MISSING * abs(size):
            raise Wrong(f"the support carries {found} N, weights and loads are {need} N")
        self.found.append(f"supports {found / need:.4f}")

    def _stage(self):
        names = STAGES + (["press", "growStress"] if self.case.rotation else [])
        names = names + ["drive"] * 4 if self.drive else names
        name = self.dice.choice(names + ["release"] * self.driven)
        self.stages.append(name)
        return getattr(self, "_" + name)()

    def _towards(self):
        return self.dice.choice([(1, 0, 0), (-1, 0, 0)])

    def _duration(self):
        return self.dice.power(2.3, 4.2) * O.dt

    # Each stage draws its numbers about those of its closed form, so that some scenes stand and
    # some fall.

    def _about(self, most):
        return (
            float(f"{most * self.dice.power(-0.7, 0.5):.4g}")
            if most > 0
            else self.dice.power(-3, 0)
        )

    def _path(self, least=1e-5):
        """How far a push goes [mm], and its rate [mm/s].

        :param least: least that it goes [mm]
        """
        case = self.case
        most = case.mostPush(self.loaded, self.height) if self.height else 0.0
        bends = 3 * self.height**2 / case.length**2 * case.ks / case.kn
        slides = most / (case.ks * case.area) * case.courses * (1 + bends)
        until = 1e3 * min(slides * self.dice.power(-0.5, 1.5), 0.3 * case.length)
        until = min(max(until, least), 900.0)
        rate = until / (self.dice.power(2.5, 4.2) * O.dt)
        return until, min(max(rate, 1e-3), 1e3)

    def _push(self):
        until, rate = self._path()
        return self._pushed("push", until, until, rate)

    def _cycle(self):
        until, rate = self._path(0.02)  # the least amplitude
        return self._pushed("cycle", [until], until, rate)

    def _drive(self):
        until, self.scene.args.rate = self._path()
        self.clean = False
        return self.scene.drive(self.target, x=until)

    def _pushed(self, name, aim, until, rate):
        act, first = getattr(self.scene, name), len(self.scene.results.rows)
        ended = act(self.target, aim, direction=self._towards(), rate=rate)
        if self.clean:
            self._checkPush(name, first)
        self.driven, self.moved = True, self.moved + 1e-3 * until
        return ended

    def _checkPush(self, name, first):
        case, scene = self.case, self.scene
        base = scene.results.column("base_shear_kN")[first:]
        moved = self.moved
        if name == "cycle":
            moved += 1e-3 * max(map(abs, scene.results.column("displacement_mm")[first:]))
        most = case.mostPush(self.loaded, self.height, moved)
        peak = 1e3 * max(map(abs, base), default=0.0)
        self.found.append(("push", peak, most))

    def _factor(self, most, act):
        """Carry out a stage that finds a held load, and compare that with its closed form."""
        scene, known = self.scene, len(self.scene.answers)
        ended = act()
        held = [a["value"] for a in scene.answers[known:] if a["name"] == "factor_held"]
        held = [value for value in held if value is not None]
        if held and self.clean and not self.driven:
            self.found.append(("held", held[-1], most))
        self.clean = False
        return ended

    def _lean(self):
        most = self.case.mostAcceleration(False)
        factor = min(self._about(most), 1e3)
        return self._factor(
            most, lambda: self.scene.lean(factor, self._towards(), longest=self.longest)
        )

    def _accelerate(self):
        most = self.case.mostAcceleration(False)
        aim = min(2 * self._about(most), 1e3)
        rate = min(max(aim / self._duration(), 1e-6), 1e6)
        return self._factor(
            most, lambda: self.scene.accelerate(aim, self._towards(), rate=rate, within=0.05)
        )

    def _tilt(self):
        most = self.case.mostAcceleration(True)
        degrees = min(89.0, math.degrees(math.atan(2 * self._about(most))))
        rate = min(max(degrees / self._duration(), 1e-6), 1e6)
        return self._factor(
            most, lambda: self.scene.tilt(degrees, self._towards(), rate=rate, within=0.05)
        )

    def _force(self):
        """The closed form of a horizontal load [N], and one about as large; there is none on what
        is only watched."""
        most = self.case.mostPush(self.loaded, self.height) if self.height else 0.0
        size = min(self._about(most), 1e14)
        return most, tuple(size * v for v in self._towards())

    def _growForce(self):
        most, force = self._force()
        over = min(self._duration(), 86400)
        return self._factor(
            1e-3 * most, lambda: self.scene.grow({self.target: force}, over=over, within=0.05)
        )

    def _load(self):
        """Another dead load, which replaces the one that was there."""
        most, force = self._force()
        if self.case.down:
            self.clean = False
        return self._factor(
            1e-3 * most, lambda: self.scene.load(self.target, force, longest=self.longest)
        )

    def _growPressure(self):
        most = self.case.mostWind()
        pressure, over = min(self._about(most), 1e8), min(self._duration(), 86400)
        return self._factor(
            1e-3 * most,
            lambda: self.scene.grow(
                {}, pressure=pressure, towards=self._towards(), over=over, within=0.05
            ),
        )

    def _wind(self):
        most = self.case.mostWind()
        pressure = min(self._about(most), 1e8)
        return self._factor(
            1e-3 * most, lambda: self.scene.wind(pressure, self._towards(), longest=self.longest)
        )

    def _press(self):
        stress = self.case._stress()
        return self._factor(
            math.inf, lambda: self.scene.press(self.target, stress, longest=self.longest)
        )

    def _growStress(self):
        stress, over = self.case._stress(), min(self._duration(), 86400)
        return self._factor(
            math.inf, lambda: self.scene.grow({self.target: stress}, over=over, within=0.05)
        )

    def _shake(self):
        dice = self.dice
        most = min(self.case.mostAcceleration(False), 100) * GRAVITY
        wave = [0.0, *(round(most * dice.uniform(-2, 2), 6) for _ in range(6)), 0.0]
        return self.scene.shake(
            wave, every=self._duration() / 4, damping=dice.choice([0, 0.2]), unit="m/s²"
        )

    def _run(self):
        return self.scene.run(min(self._duration(), 86400))

    def _move(self):
        far = 1e3 * self.case.length * self.dice.power(-5, -1.5)
        path = {self.dice.choice("xz"): float(f"{min(far, 1000):.3g}")}
        rate = min(max(far / self._duration(), 1e-3), 1e3)
        return self.scene.move(self.base, rate=rate, **path)

    def _settle(self):
        ended = self.scene.settle(longest=self.longest)
        if ended == AT_REST and self.clean:
            self._checkSupports()
        return ended

    def _release(self):
        self.driven = False
        return self.scene.release(self.target, "x")

    inMotion = ""  # what statics says of a scene that moves
    height, drive = 0.0, ""  # of the load [m], and axes of the platen's own drive


# -- verdicts --------------------------------------------------------------------------------------


def judge(play, said, run):
    """Compare what a run found with its closed forms. Returns what it says of itself. Raises Wrong.

    :param said: everything on the terminal
    :param run: entries of run.json
    """
    for row in play.scene.results.rows:
        if not all(map(math.isfinite, row)):
            raise Wrong(f"a row is not finite: {row}")
    if not _isFinite(run):
        raise Wrong("run.json has a number that is not finite")
    doubts = [text for text in DOUBTS if text in said]
    for kind, reached, most in (f for f in play.found if isinstance(f, tuple)):
        allowed = HELD if kind == "held" else PUSHED + run.get("dynamic_imbalance", 0)
        if reached > allowed * most and reached > ROUND_OFF and not doubts:
            raise Wrong(f"{kind}: {reached:.6g} is above its closed form, {most:.6g}")
    reasons = list(doubts)
    for key, text in (
        ("energy_balance_error", "energy balance is off"),
        ("energy_made", "within a step made"),
    ):
        if run.get(key, 0) > SHARE:
            if text not in said:
                raise Wrong(f"{key} {run[key]:.3g}, and no warning")
            reasons.append(f"{key} {run[key]:.2g}")
    return reasons


def _isFinite(value):
    if isinstance(value, dict):
        return all(map(_isFinite, value.values()))
    if isinstance(value, list):
        return all(map(_isFinite, value))
    return not isinstance(value, float) or math.isfinite(value)


def carryOut(make):
    """Carry out a scene. Returns a dict: its class, why, and what was compared.

    :param make: function of a folder that gives a :class:`Play`
    """
    play, said, trial = None, io.StringIO(), growing.TRIAL
    drawn, DrawingProgram.draw = DrawingProgram.draw, lambda outcome, folder: None
    found = {"class": "failed", "why": ""}
    with tempfile.TemporaryDirectory() as folder:
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                play = make(os.path.join(folder, "run"))
                with contextlib.suppress(SystemExit), play.scene:
                    play.play()
            found.update(verdict(play, said.getvalue(), os.path.join(folder, "run")))
        except (Refused, ValueError) as refused:
            found.update({"class": "refused", "why": str(refused)})
        except TooLong as long:
            found.update({"class": "too long", "why": str(long)})
        except Exception as error:
            found["why"] = f"{type(error).__name__}: {error}"
            if not isinstance(error, Wrong):
                found["why"] += "\n" + traceback.format_exc()
        finally:
            DrawingProgram.draw, growing.TRIAL = drawn, trial
            if play:
                play.scene.finished = True
                play.scene.running.release()
    if play:
        found.update(stages=play.stages, compared=play.found, steps=play.steps)
        found["balance"] = balanceOf(play.scene)
    found["said"] = said.getvalue()
    return found


def balanceOf(scene):
    """The largest error of the energy balance [-]: what the run found, and that of its last row,
    which may be younger."""
    if not scene.model:
        return 0.0
    rows = scene.results.rows if scene.results else []
    last = scene.results.column("balance_error")[-1] if rows else 0.0
    return max(scene.model.energy.largestError, abs(last))


def verdict(play, said, folder):
    """How a scene ended that was finished: its class, and why. Raises Wrong."""
    scene = play.scene
    if scene.status == 2:
        return {"class": "refused", "why": said.strip().splitlines()[-1]}
    if "Traceback" in said:
        raise Wrong("a traceback was printed")
    with open(os.path.join(folder, "run.json")) as f:
        run = json.load(f)
    reasons = judge(play, said, run)
    if scene.collapsed:
        return {"class": "collapsed", "why": f"{run['collapse']} {reasons or ''}"}
    if "is not at rest" in said or play.inMotion:
        reasons.insert(0, play.inMotion or "not at rest")
    moves = reasons and reasons[0].startswith("not at rest")
    kind = "not at rest" if moves else "warned"
    return {"class": kind if reasons else "confirmed", "why": "; ".join(reasons)}


# -- walls that fall -------------------------------------------------------------------------------


class Falling(Play):
    """A structure that cannot stand, which settles and nothing else."""

    def __init__(self, dice, folder):
        self.found, self.stages, self.steps = [], ["settle"], 0
        self.dice, self.how = dice, dice.choice(
            ["overhangs", "is blown over", "is pushed over", "is crushed", "has soft joints"]
        )
        long, high = dice.power(-1.5, 0.3), dice.power(-1.5, 0)
        unit, courses = (long, long / 2, high), dice.randint(2, 5)
        kn = dice.power(5, 7) if self.how == "has soft joints" else dice.power(8, 11)
        density, friction = dice.power(3, 3.6), round(dice.uniform(0.2, 1.5), 2)
        stone = materials.dry(friction, kn, None, density)
        if self.how == "is crushed":
            stone.joints["bed"].set(
                cap=True,
                compressiveStrength=1e5,
                peakRatio=10,
                compressiveFractureEnergy=1e10 / kn * 30,
            )
            stone = materials.Masonry(stone.unit, {"bed": stone.joints["bed"]})
        structure = bricks.stack(courses, unit)
        if self.how == "overhangs":
            shift = long * dice.uniform(0.51, 0.9)
            box = lambda n: bricks.block(
                (n * shift, 0, n * high), (n * shift + long, long / 2, (n + 1) * high), part=f"b{n}"
            )
            structure = box(0) + box(1)
        elif dice.often(0.5):
            structure = bricks.Wall(2 * long, courses * high, unit, halves=False)
        words = ["--no-vtk", "--checkpoint-every", "0", "--out", folder]
        words += ["--damping-kind", dice.choice(["local", "combined"])]
        self.scene = scene = Scene("falls", structure, stone, arguments=words)
        self.base = scene.platen("bottom")
        weight = density * GRAVITY * high
        if self.how == "is blown over":
            side = dice.power(0.3, 1.5) * courses * weight * (1 + friction) * (1 + 2 * long / high)
            scene.wind(min(side, 1e8), (1, 0, 0))
        elif self.how == "is pushed over":
            size = dice.power(0.3, 1.5) * courses * weight * long * long * (1 + friction)
            scene.load(scene.handle(-1), (size, 0, 0))
        elif self.how == "is crushed":
            scene.press(
                scene.platen("top", rotation="free", height=high), 1e5 * dice.power(0.1, 1.5)
            )
        elif self.how == "has soft joints":
            stress = kn * high * dice.power(-0.2, 0.5)
            scene.press(scene.platen("top", rotation="free", height=high), stress)

    def play(self):
        self.scene.begin()
        self._count()
        self.scene.settle(longest=3.0)


def describe(number, found):
    """A line on a scene."""
    compared = [
        (
            one
            if isinstance(one, str)
            else f"{one[0]} {one[1] / one[2]:.4f}"
            if one[2]
            else f"{one[0]} {one[1]:.3g}/0"
        )
        for one in found.get("compared", [])
    ]
    return (
        f"{number:4} {found['class']:12} {found.get('steps', 0):7} steps, balance"
        f" {found.get('balance', 0):.1e}, {' '.join(found.get('stages', []))}:"
        f" {', '.join(compared)} {found['why']}"
    )


def runAll(count, first=0, seed=1, falls=False):
    """Run scenes, a line each. Returns how they ended: dicts as of :func:`carryOut`."""
    results = []
    for number in range(first, first + count):
        dice = Dice(f"{seed} {number}")
        make = lambda folder: Play(Case(dice), folder)
        if falls:
            make = lambda folder: Falling(dice, folder)
        results.append(carryOut(make))
        print(describe(number, results[-1]), flush=True)
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--falls", action="store_true", help="walls that cannot stand")
    parser.add_argument("--said", action="store_true", help="what failed scenes print")
    args = parser.parse_args()
    results = runAll(args.scenes, args.first, args.seed, args.falls)
    for found in results:
        if args.said:
            print(found["said"])
    counts = collections.Counter(found["class"] for found in results)
    names = CLASSES.split(", ")
    print(table(["scenes", *names], [[len(results), *(counts[name] for name in names)]]))
    raise SystemExit(1 if counts["failed"] else 0)


if __name__ == "__main__":
    main()
