# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scripts of stages, and runs of them that are stopped at a step and resumed.

A run that was stopped and resumed must leave what an unbroken one leaves, byte for byte: rows, frames, the checkpoint at the
end, and the numbers of run.json but for times.
"""

import contextlib
import io
import json
import math
import os
import random
import shutil
import signal
import sys

from kept import records
from yade import O

from masonry import basics
from masonry.read.files import readRun
from masonry.run import checkpoints
from masonry.run.run import Run
from masonry.scene import Scene
from masonry.scene.drawing_program import DrawingProgram
from masonry.scene.stages import growing

BEGIN = """\
from masonry import AT_REST, Scene, bricks, materials
"""
TRY = "try:\n    {}\nexcept ValueError as error:\n    print(error)"
#: Entries of run.json that may differ between an unbroken run and a resumed one.
TIMES = "date wall_clock_s seconds microseconds_per_step nanoseconds_per_subcontact_step resumed_at_s host directory options stages started".split()


class Stopped(BaseException):
    """The process is killed here, or given up."""


# -- scripts -----------------------------------------------------------------------------------------------------------


class Writer:
    """A random script.

    :param seed: of its dice
    """

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.lines = []
        self.pushed = []  # how targets were pushed already

    def write(self):
        """The text of the script."""
        self._describe()
        stages = self.dice.choices(self._stages(), k=self.dice.randint(2, 6))
        describing = [
            self._bound,
            self._press,
            self._load,
            self._wind,
            self._bracket,
            self._result,
            self._hold,
            self._stepBack,
        ]
        if self.loaded or stages[0] in describing or self.dice.random() < 0.7:
            stages.insert(0, self._settle)
        self.lines += [one() for one in stages]
        self.lines.append("scene.finish()")
        return BEGIN + "\n".join(self.lines) + "\n"

    def _number(self, low, high):
        return float(f"{self.dice.uniform(low, high):.3g}")

    def _describe(self):
        dice = self.dice
        self.deformable = dice.random() < 0.25
        self.drives = dice.choice([None, None, "x", "xz"])
        self.platen = dice.random() < 0.7
        space = not self.deformable and dice.random() < 0.2
        length, courses = 0.22 * dice.choice([1.5, 2, 2.5]), dice.choice([2, 3])
        options = dict(
            rate=dice.choice([100, 400]),
            blocks="deformable" if self.deformable else "rigid",
            joints=dice.choice(["softening", "softening", "cyclic", "brittle"]),
            damping_kind=dice.choice(["local", "combined"]),
            plane=False if space else None,
        )
        if self.deformable:
            options["divisions"] = 1
        kind = dice.choice(
            [
                "calciumSilicate()",
                "dry(friction=0.6, normalStiffness=2e9, density=1800)",
            ]
        )
        said = ", ".join(f"{name}={value!r}" for name, value in options.items())
        self.lines += [
            f"wall = bricks.Wall(length={length:g}, height={0.081 * courses:g})",
            f'scene = Scene("s", wall, materials.{kind}, {said})',
            'base = scene.platen("bottom")',
        ]
        self.loaded = False
        if self.platen:
            drive = f", drive={self.drives!r}" if self.drives else ""
            rotation = dice.choice(["held", "free"])
            self.lines.append(
                f'top = scene.platen("top", rotation="{rotation}"{drive})'
            )
            if self.drives != "xz" and dice.random() < 0.8:
                self.lines.append(f"scene.press(top, {self._number(5e4, 4e5)})")
                self.loaded = True
        else:
            word = "watch" if self.deformable else "handle"
            self.lines.append(f"top = scene.{word}(-1)")
            if word == "handle" and dice.random() < 0.5:
                self.lines.append(f"scene.load(top, {self._force()})")
                self.loaded = True
        if not self.deformable and dice.random() < 0.3:
            self.lines.append(f"scene.wind({self._number(100, 900)}, (1, 0, 0))")
            self.loaded = True
        if dice.random() < 0.3:
            self.lines.append("scene.section(0.081)")
        if dice.random() < 0.4:
            self._connect(length, 0.081 * courses)

    def _connect(self, length, height):
        """Ties that yield and break, and springs."""
        dice = self.dice
        for _ in range(dice.randint(1, 3)):
            point = lambda: f"({self._number(0, length)}, 0.05, {self._number(0.5, 1) * height:.3g})"  # fmt: skip
            far = f"anchor=({self._number(-1, 2)}, 0.05, {self._number(-1, 1)})"
            more = dice.choice([f"prestress={self._number(10, 300)}", "slack=1e-5", "compression=True", f"breaking={self._number(1e-6, 1e-4)}"])  # fmt: skip
            strength = f"strength={self._number(301, 900)}"
            self.lines.append(f"scene.tie({point()}, {far}, stiffness=1e7, {strength}, {more})")  # fmt: skip
        if dice.random() < 0.5:
            self.lines.append(f"scene.spring({point()}, stiffness=(1e6, 0, 1e6), rotation=(0, 1e4, 0))")  # fmt: skip

    def _force(self):
        return tuple(self._number(-100, 100) * free for free in (1, 0, 1))

    def _stages(self):
        stages = [self._settle, self._lean, self._accelerate, self._tilt, self._bracket]
        stages += [self._shake, self._run, self._stepBack, self._move, self._result]
        stages += [self._bound]
        stages += [] if self.deformable else [self._wind, self._growWind]
        if self.platen or not self.deformable:
            stages += [self._push, self._push, self._cycle, self._follow, self._load]
            stages += [self._release, self._growLoad]
        if self.platen:
            stages += [self._press, self._growPress]
        else:
            stages += [] if self.deformable else [self._hold]
        if self.platen and self.drives:
            stages += [self._drive, self._drive]
        return stages

    def _longest(self):
        return f"longest={self._number(0.01, 0.08)}"

    def _towards(self):
        return self.dice.choice(["(1, 0, 0)", "(-1, 0, 0)"])

    def _settle(self):
        damping = self.dice.choice(["", ", damping='combined'", ", damping='local'"])
        return f"scene.settle({self._longest()}{damping})"

    def _lean(self):
        return f"scene.lean({self._number(0.01, 0.6)}, {self._towards()}, {self._longest()})"

    def _accelerate(self):
        most = self._number(0.1, 1.5)
        return f"scene.accelerate({most}, {self._towards()}, rate={30 * most:.3g}, within=0.3)"

    def _tilt(self):
        most = self._number(5, 50)
        return (
            f"scene.tilt({most}, {self._towards()}, rate={30 * most:.3g}, within=0.3)"
        )

    def _bracket(self):
        loads = ["lean(f", "wind(1e3 * f, (1, 0, 0)"][: 2 - self.deformable]
        load = f"scene.{self.dice.choice(loads)}, longest=0.02)"
        return TRY.format(
            f"print(scene.bracket(lambda f: {load} == AT_REST, 0.01, {self._number(0.3, 3)}, within=0.3))"
        )

    def _stepBack(self):
        return TRY.format("scene.stepBack()")

    def _result(self):
        return 'scene.result("time", scene.results.rows[-1][0] if scene.results.rows else 0.0, "s")'

    def _bound(self):
        return f"print(scene.bound(towards={self._towards()})['load'])"

    def _shake(self):
        values = [self._number(-3, 3) for _ in range(5)]
        more = self.dice.choice(
            ["", ", damping=0.2", ", massDamping=5.0", ", stiffnessDamping=1e-5"]
        )
        return f"scene.shake({[0.0, *values, 0.0]}, every={self._number(1e-3, 3e-3)}{more})"

    def _run(self):
        more = self.dice.choice(["", ", damping=0.3", ", damping=0.0"])
        return f"scene.run({self._number(1e-3, 2e-2)}{more})"

    def _move(self):
        return (
            f"scene.move(base, {self.dice.choice('xz')}={self._number(-0.05, -0.01)})"
        )

    def _wind(self):
        return f"scene.wind({self._number(100, 900)}, {self._towards()}, {self._longest()})"

    def _growWind(self):
        return f"scene.growWind({self._number(300, 3000)}, {self._towards()}, over=0.03, within=0.3)"

    def _pushed(self, kind):
        direction = self.dice.choice(["(1, 0, 0)", "(1, 0, 0)", "(-1, 0, 0)"])
        more = (
            ", continued=True"
            if direction in self.pushed and self.dice.random() < 0.5
            else ""
        )
        self.pushed.append(direction)
        return f"direction={direction}{more}"

    def _push(self):
        much = self._number(0.05, 0.4)
        return f"scene.push(top, {much}, {self._pushed('push')})"

    def _cycle(self):
        much = [self._number(0.02, 0.1) for _ in range(self.dice.randint(1, 2))]
        return f"scene.cycle(top, {much}, {self._pushed('cycle')})"

    def _follow(self):
        return f"scene.follow(top, 'path.csv', {self._pushed('follow')})"

    def _load(self):
        return f"scene.load(top, {self._force()}, {self._longest()})"

    def _growLoad(self):
        return f"scene.growLoad(top, {self._force()}, over=0.03, within=0.3)"

    def _press(self):
        return f"scene.press(top, {self._number(5e4, 4e5)}, {self._longest()})"

    def _growPress(self):
        return f"scene.growPress(top, {self._number(1e5, 4e6)}, over=0.03, within=0.3)"

    def _release(self):
        return TRY.format(f"scene.release(top, '{self.dice.choice(['x', 'z', 'xz'])}')")

    def _hold(self):
        return f"scene.hold(top, '{self.dice.choice(['x', 'xz', 'xyzXYZ'])}')"

    def _drive(self):
        axis = self.dice.choice(self.drives)
        return f"scene.drive(top, {axis}={self._number(0.005, 0.05)})"


# -- runs --------------------------------------------------------------------------------------------------------------


def carryOut(script, *words, stop=None, most=math.inf):
    """Run a script in this process. Returns its exit status, and how many steps were taken.

    :param words: of the command line
    :param most: steps after which it is given up
    :param stop: function of the run and the number of steps that were taken, which is called after each of them
    """
    folder, before, take = os.getcwd(), sys.argv, Run._take
    forget = lambda text: None  # notes of scenes that were refused before
    basics.listen(forget)
    basics.stopListening(forget)
    taken = [0]

    def counted(run, steps, one):
        step = one or (lambda number: O.step())

        def act(number):
            step(number)
            taken[0] += 1
            if stop:
                stop(run, taken[0])
            if taken[0] >= most:
                raise Stopped()

        take(run, steps, act)

    draw, DrawingProgram.draw = DrawingProgram.draw, lambda outcome, folder: None
    trial, growing.TRIAL = growing.TRIAL, 0.05  # [s], so that searches are short
    sys.argv, Run._take, status = ["s.py", *words], counted, 0
    output = io.StringIO()
    try:
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            exec(compile(script, "s.py", "exec"), {"__name__": "__main__"})
    except SystemExit as end:
        status = end.code or 0
    except Stopped:
        status = -signal.SIGKILL
    except ValueError as error:  # a script that is not allowed
        status = 2
        print(error, file=output)
    finally:
        sys.argv, Run._take, DrawingProgram.draw = before, take, draw
        growing.TRIAL = trial
        scene = Scene.present
        if scene is not None:
            scene.finished = True
            scene.running.release()
            Scene.present = None
        os.chdir(folder)
    return status, taken[0], output.getvalue()


def signalled(number, step):
    """What happens when the process gets a signal after a step that it can obey."""
    return lambda run, taken: taken == step and os.kill(os.getpid(), number)


def killed(folder, step):
    """What happens when a checkpoint is made after a step, and the process is killed at a later one: the files stay as they
    are on the disk at that moment."""

    def act(run, taken):
        if taken == step:
            run.checkpoints.since = -math.inf
        elif taken > step and os.path.exists(
            os.path.join(run.results.directory, checkpoints.NAME)
        ):
            shutil.copytree(run.results.directory, folder)
            raise Stopped()

    return act


# -- what they leave ---------------------------------------------------------------------------------------------------


def left(folder):
    """What a run leaves, by name: contents of files, and the numbers of run.json and of the checkpoint but times."""
    found = {}
    for name in sorted(os.listdir(folder)):
        # another process may have found the mechanism of limit analysis, and was killed before it wrote it
        if name.endswith((".csv", ".vtu", ".vtp", ".pvd")) and "mechanism" not in name:
            with open(os.path.join(folder, name), "rb") as f:
                found[name] = f.read()
    entries = readRun(folder)
    for name, value in entries.items():
        if name not in TIMES:
            found[f"run.json: {name}"] = value
    if not os.path.exists(os.path.join(folder, checkpoints.NAME)):
        return found  # what fell within a step has no state that can be kept
    data, kept = checkpoints.readState(folder)
    for name in ("resumed", "seconds"):
        kept["at"].pop(name)
    kept["at"]["stages"] = [(n, s, r) for n, s, _, r in kept["at"]["stages"]]
    for name in ("scene", "at", "rows", "script"):
        found[f"checkpoint: {name}"] = json.dumps(kept[name])
    for name, value in records(data).items():
        if name != "extra":
            found[f"checkpoint: state: {name}"] = value
    return found


def differences(whole, resumed):
    """Names of what two runs have left that is not alike. A resumed run has the checkpoint from which it went on, if the
    unbroken one has none."""
    kept = any(name.startswith("checkpoint") for name in whole)
    names = {*whole, *(n for n in resumed if kept or not n.startswith("checkpoint"))}
    return sorted(n for n in names if whole.get(n) != resumed.get(n))
