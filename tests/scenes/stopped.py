# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scripts of stages, and runs of them that are stopped at a step and resumed.

A run that was stopped and resumed must leave what an unbroken one leaves, byte for byte: rows,
frames, the checkpoint at the end, and the numbers of run.json but for times.
"""

from hosted import *
import io
from kept import records
from masonry import terminal
from masonry.run import checkpoints
from masonry.run import run as running
from masonry.run.run import Run
from masonry.run.drawing_program import DrawingProgram
from masonry.stages import growing

BEGIN = """\
from masonry import AT_REST, Scene, bricks, materials
"""
#: Entries of run.json that may differ between an unbroken run and a resumed one.
TIMES = (
    "date wall_clock_s seconds microseconds_per_step nanoseconds_per_subcontact_step resumed_at_s"
    " host directory options stages started".split()
)


class Stopped(BaseException):
    """The process is killed here, or given up."""


TOWARDS = "<(1, 0, 0)|(-1, 0, 0)>"
LONGEST = "longest=<0.01~0.08>"
DAMPED = "<|, damping=0.2|, massDamping=5.0|, stiffnessDamping=1e-5>"
GROWS = "over=0.03, within=0.3"
FORCE = "(<-100~100>, 0, <-100~100>)"
POINT = "(<0~0.35>, 0.05, <0.05~0.15>)"
TRY = "try:\n    {}\nexcept ValueError as error:\n    print(error)"


def bracket(load):
    rests = f"lambda f: scene.{load}, longest=0.02) == AT_REST"
    return TRY.format(f"scene.bracket({rests}, 0.01, <0.3~3>, within=0.3)")


#: Stages by when they can be said: always, of rigid bricks, of a target that moves, of a platen, of
#: a handle, of a drive. <a~b> is a random number, <x|y> one of several texts; DIRECTION and AXIS
#: are chosen by :class:`Writer`.
STAGES = {
    "always": {
        "settle": f"scene.settle({LONGEST}<|, damping='combined'|, damping='local'>)",
        "lean": f"scene.lean(<0.01~0.6>, {TOWARDS}, {LONGEST})",
        "accelerate": f"scene.accelerate(m := <0.1~1.5>, {TOWARDS}, rate=30 * m, within=0.3)",
        "tilt": f"scene.tilt(m := <5~50>, {TOWARDS}, rate=30 * m, within=0.3)",
        "bracket": bracket("lean(f"),
        "shake": f"scene.shake([0.0, <-3~3>, <-3~3>, <-3~3>, 0.0], every=<0.001~0.003>{DAMPED})",
        "run": "scene.run(<0.001~0.02><|, damping=0.3|, damping=0.0>)",
        "stepBack": TRY.format("scene.stepBack()"),
        "move": "scene.move(base, <x|z>=<-0.05~-0.01>)",
        "result": (
            'scene.result("time", scene.results.rows[-1][0] if scene.results.rows else 0.0, "s")'
        ),
        "bound": f"print(scene.bound(towards={TOWARDS})['load'])",
    },
    "rigid": {
        "pattern": (
            f"scene.push(<'masses'|'mode'|lambda x, y, z: z>, <0.05~0.2>, {TOWARDS}, control=top)"
        ),
        "wind": f"scene.wind(<100~900>, {TOWARDS}, {LONGEST})",
        "growWind": f"scene.grow({{}}, pressure=<300~3000>, towards={TOWARDS}, {GROWS})",
        "bracketWind": bracket("wind(1e3 * f, (1, 0, 0)"),
    },
    "moves": {
        "push": "scene.push(top, <0.05~0.4>, DIRECTION)",
        "cycle": "scene.cycle(top, <[<0.02~0.1>]|[<0.02~0.1>, <0.02~0.1>]>, DIRECTION)",
        "follow": "scene.follow(top, 'path.csv', DIRECTION)",
        "load": f"scene.load(top, {FORCE}, {LONGEST})",
        "growLoad": f"scene.grow({{top: {FORCE}}}, {GROWS})",
        "release": TRY.format("scene.release(top, '<x|z|xz>')"),
    },
    "platen": {
        "press": f"scene.press(top, <5e4~4e5>, {LONGEST})",
        "growPress": f"scene.grow({{top: <1e5~4e6>}}, {GROWS})",
    },
    "handle": {"hold": "scene.hold(top, '<x|xz|xyzXYZ>')"},
    "drive": {"drive": "scene.drive(top, AXIS=<0.005~0.05>)"},
}
#: Before the first of these a scene settles.
LATER = "bound bracket bracketWind growWind hold load press result stepBack wind".split()
SPECIAL = "prestress=<10~300>|slack=1e-5|compression=True|breaking=<1e-6~1e-4>"
TIE = (
    f"scene.tie({POINT}, anchor=(<-1~2>, 0.05, <-1~1>), stiffness=1e7, strength=<301~900>,"
    f" <{SPECIAL}>)"
)
LAYER = (
    "scene.overlay((0, <-1|1>, 0), stiffness=1e7, strength=<300~9000>, gauge=0.1<|, strain=0.01>)"
)
SPRING = f"scene.spring({POINT}, stiffness=(1e6, 0, 1e6), rotation=(0, 1e4, 0))"


class Writer:
    """A random script.

    :param seed: of its dice
    """

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.lines = []
        self.pushed = []  # how the target was pushed already

    def write(self):
        """The text of the script."""
        can = self._describe()
        stages = {n: t for kind in can for n, t in STAGES[kind].items()}
        names = self.dice.choices([*stages, "push", "drive"], k=self.dice.randint(2, 6))
        names = [n for n in names if n in stages]
        settles = self.loaded or not names or names[0] in LATER
        if settles or self._often(0.7):
            names.insert(0, "settle")
        for name in names:
            self._say(stages[name])
        return BEGIN + "\n".join([*self.lines, "scene.finish()"]) + "\n"

    def _often(self, share):
        return self.dice.random() < share

    def _say(self, text):
        """Add a line, with everything chosen that it leaves open."""

        def chosen(found):
            ends = re.fullmatch(r"(-?[\d.e-]+)~(-?[\d.e-]+)", found[1])
            if ends:
                return f"{self.dice.uniform(*map(float, ends.groups())):.3g}"
            return self.dice.choice(found[1].split("|"))

        while re.search("<[^<>]*>", text):
            text = re.sub("<([^<>]*)>", chosen, text)
        if "DIRECTION" in text:
            towards = self.dice.choice(["(1, 0, 0)", "(1, 0, 0)", "(-1, 0, 0)"])
            more = ", continued=True" * (towards in self.pushed and self._often(0.5))
            self.pushed.append(towards)
            text = text.replace("DIRECTION", f"direction={towards}{more}")
        if "AXIS" in text:
            text = text.replace("AXIS", self.dice.choice(self.drives))
        self.lines.append(text)

    def _describe(self):
        """The lines before the first stage. Returns the kinds of stages that can follow."""
        deformable, platen = self._often(0.25), self._often(0.7)
        self.drives = self.dice.choice([None, None, "x", "xz"])
        layer = not deformable and self._often(0.2)
        courses, self.loaded = self.dice.choice([2, 3]), False
        space = layer or (not deformable and self._often(0.2))
        length, height = self.dice.choice([0.33, 0.44, 0.55]), round(0.081 * courses, 3)
        dry = self._often(0.5)
        stones = "materials.calciumSilicate()"
        if dry:
            stones = "materials.dry(friction=0.6, normalStiffness=2e9, density=1800)"
        wall = f"length={length}, height={height}, halves={not dry}"
        self._say(f"wall = bricks.Wall({wall})")
        beam = not deformable and self._often(0.2)
        if beam:
            pieces = f"{length}, 0.1, 0.06, pieces={self.dice.choice([2, 4])}"
            self._say(f"beam = bricks.Beam((0, 0, {height}), {pieces})")
            stones += ".withBeam(beam, young=1e10, density=500)"
        falls = ", collapse='follow'" * (not deformable and self._often(0.25))
        blocks = "'deformable', divisions=1" if deformable else "'rigid'"
        self._say(
            f"scene = Scene('s', wall{' + beam' * beam}, {stones}{falls}, "
            f"rate=<100|400>, blocks={blocks}, joints='<softening|softening|cyclic|brittle>', "
            f"damping_kind='<local|combined>', plane={False if space else None})"
        )
        self._say('base = scene.platen("bottom")')
        if platen:
            drive = f", drive={self.drives!r}" * bool(self.drives)
            self._say(f'top = scene.platen("top", rotation="<held|free>"{drive})')
            self._perhaps(0.8 * (self.drives != "xz"), "scene.press(top, <5e4~4e5>)")
        else:
            self._say(f"top = scene.{'watch' if deformable else 'handle'}(-1)")
            self._perhaps(0.5 * (not deformable), f"scene.load(top, {FORCE})")
        self._perhaps(0.3 * (not deformable), "scene.wind(<100~900>, (1, 0, 0))")
        if self._often(0.3):
            self._say("scene.section(0.081)")
        if self._often(0.4):
            for _ in range(self.dice.randint(1, 3)):
                self._say(TIE)
            if self._often(0.5):
                self._say(SPRING)
        if layer:
            self._say(LAYER)
        can = {
            "rigid": not deformable,
            "moves": platen or not deformable,
            "platen": platen,
            "handle": not platen and not deformable,
            "drive": platen and self.drives,
        }
        return ["always", *(kind for kind, so in can.items() if so)]

    def _perhaps(self, share, load):
        """Say a load that grows in the first stage, with a probability."""
        if self._often(share):
            self._say(load)
            self.loaded = True


def carryOut(script, *words, stop=None, most=math.inf):
    """Run a script in this process. Returns its exit status, and how many steps were taken.

    :param words: of the command line
    :param most: steps after which it is given up
    :param stop: function of the run and the number of steps that were taken, which is called after
        each of them
    """
    folder, before, take = os.getcwd(), sys.argv, Run._take
    forget = lambda text: None  # notes of scenes that were refused before
    terminal.listen(forget)
    terminal.stopListening(forget)
    taken = [0]

    class Stepping:  # YADE as a run sees it
        __getattr__ = lambda self, name: getattr(O, name)

    def counted(run, steps):
        def act():
            O.step()
            taken[0] += 1
            if stop:
                stop(run, taken[0])
            if taken[0] >= most:
                raise Stopped()

        running.O = Stepping()
        running.O.step = act
        try:
            take(run, steps)
        finally:
            running.O = O

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
        letGo()
        os.chdir(folder)
    return status, taken[0], output.getvalue()


def signalled(number, step):
    """What happens when the process gets a signal after a step that it can obey."""
    return lambda run, taken: taken == step and os.kill(os.getpid(), number)


def killed(folder, step):
    """What happens when a checkpoint is made after a step, and the process is killed at a later
    one: the files stay as they are on the disk at that moment."""

    def act(run, taken):
        if taken == step:
            run.checkpoints.since = -math.inf
        elif taken > step and os.path.exists(os.path.join(run.results.directory, checkpoints.NAME)):
            shutil.copytree(run.results.directory, folder)
            raise Stopped()

    return act


def left(folder):
    """What a run leaves, by name: contents of files, and the numbers of run.json and of the
    checkpoint but times."""
    found = {}
    for name in sorted(os.listdir(folder)):
        # another process may have found the mechanism of limit analysis, and was killed before it
        # wrote it
        if name.endswith((".csv", ".vtu", ".vtp", ".pvd")) and "mechanism" not in name:
            with open(os.path.join(folder, name), "rb") as f:
                found[name] = f.read()
    entries = readRun(folder)
    for name, value in entries.items():
        if name not in TIMES:
            found[f"run.json: {name}"] = value
    if not os.path.exists(os.path.join(folder, checkpoints.NAME)):
        return found  # what fell within a step has no state that can be kept
    data, kept = checkpoints.readState(os.path.join(folder, checkpoints.NAME))
    for name in ("resumed", "seconds"):
        kept["state"].pop(name)
    for stage in kept["state"]["stages"]:
        stage.pop("seconds")
    for name in ("scene", "state", "rows", "script"):
        found[f"checkpoint: {name}"] = json.dumps(kept[name])
    for name, value in records(data).items():
        if name != "extra":
            found[f"checkpoint: state: {name}"] = value
    return found


def differences(whole, resumed):
    """Names of what two runs have left that is not alike. A resumed run has the checkpoint from
    which it went on, if the unbroken one has none."""
    kept = any(name.startswith("checkpoint") for name in whole)
    names = {*whole, *(n for n in resumed if kept or not n.startswith("checkpoint"))}
    return sorted(n for n in names if whole.get(n) != resumed.get(n))
