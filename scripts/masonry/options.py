"""Options of the command line that all scenes share."""

import argparse
import math
import os
import re
import sys

from . import batch, fields, history
from ._masonry import commit, version
from .checkpoints import alike, readProgress
from .errors import Refused
from .presets import BOUND, HARMLESS, PRESETS, USUAL, asOption
from .scene import properties

#: Units of the options that have one.
UNITS = {
    "until": "mm",
    "rate": "mm/s",
    "vtk_every": "mm",
    "checkpoint_every": "min",
}

#: Options that can be changed when a run is resumed.
FREE = {"until", "history", "checkpoint_every", "vtk_every", "no_vtk", "lean"}


def number(text, low=-math.inf, high=math.inf, above=False):
    """The number that a text stands for.

    :param above: whether it must be above ``low``, not at least
    :raises argparse.ArgumentTypeError: if it is none, or out of its bounds
    """
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None
    if (
        not math.isfinite(value)
        or value < low
        or value > high
        or (above and value == low)
    ):
        bound = f"above {low:g}" if above else f"at least {low:g}"
        raise argparse.ArgumentTypeError(
            f"{text} must be {bound}"
            + (f" and at most {high:g}" if high < math.inf else "")
        )
    return value


def _count(text, high):
    if not text.isdecimal() or not 1 <= int(text) <= high:
        raise argparse.ArgumentTypeError(
            f"'{text}' must be a whole number from 1 to {high}"
        )
    return int(text)


def _setting(text):
    target, equals, value = text.partition("=")
    joint, dot, attribute = target.partition(".")
    if not (equals and dot and joint and attribute):
        raise argparse.ArgumentTypeError(
            f"'{text}' must read JOINT.PROPERTY=VALUE, for example bed.tensileStrength=2e5"
        )
    return joint, attribute, value


def _field(text):
    try:
        fields.read(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def _history(text):
    try:
        return history.parse(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _folder(text):
    if not text.strip():
        raise argparse.ArgumentTypeError("must not be empty")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise argparse.ArgumentTypeError(f"{text!r} is not UTF-8") from None
    return text


class Parser(argparse.ArgumentParser):
    """A parser that tells all wrong options at once, and takes no part of a name for the whole.

    Options that are not given are those of ``--preset``, or those of the run that is resumed. Options that would change
    a resumed run are refused, but for those in ``free``. ``overrides`` of the parsed options lists those that were given
    beside a preset and differ from it, or from the default.
    """

    #: The parser that read the command line last, and what it found.
    last = None, None

    def __init__(self, **settings):
        super().__init__(allow_abbrev=False, **settings)
        self.problems = []
        self.free = set(FREE)
        # argparse knows no exponents and no lists: -5e-1 and -1,2x3 would be options
        self._negative_number_matcher = re.compile(
            r"-(\d+\.?\d*|\.\d+)(e[+-]?\d+)?([x,].*)?$|-(inf|nan)$", re.IGNORECASE
        )

    def parse_known_args(self, args=None, namespace=None):
        self.problems = []
        result = super().parse_known_args(args, namespace)
        if self.problems and not result[1]:
            self.error(self.problems.pop())
        return result

    def _get_values(self, action, strings):
        try:
            return super()._get_values(action, strings)
        except argparse.ArgumentError as error:
            self.problems.append(str(error))
            return action.default

    def error(self, message):
        super().error("\n  ".join([*self.problems, message]))

    def parse_args(self, args=None, namespace=None):
        """The options of the command line, or, in a run of ``yade-batch``, those of a row of its table: masonry.batch."""
        whole = args is None
        if whole:
            try:
                args = batch.present()
            except batch.Done as done:
                self.exit(0, f"{done} has the results of this row\n")
            except Refused as refused:
                self.exit(2, f"{refused}\n")
        found = self._parsed(args, namespace)
        if whole:
            Parser.last = self, found
        return found

    def _parsed(self, args, namespace):
        found = super().parse_args(args, namespace)
        if found.resume is not None:
            return self._resumed(args, found.resume)
        nothing = argparse.Namespace(**{action.dest: None for action in self._actions})
        given = vars(super().parse_args(args, nothing))
        given = {name: value for name, value in given.items() if value is not None}
        usual = {**vars(super().parse_args([])), **PRESETS.get(found.preset, {})}
        vars(found).update(usual, **given)
        if found.history:
            found.until = None
        found.overrides = [
            name
            for name, value in given.items()
            if name not in HARMLESS and value != usual[name]
        ]
        return found

    def _checkKnown(self, known, folder):
        """Refuse options of a checkpoint that this scene could not have had."""
        names = {action.dest for action in self._actions} | set(self._defaults)
        wrong = [asOption(name) for name in known if name not in names | {"overrides"}]
        beside = known.get("overrides")
        if not (isinstance(beside, list) and all(isinstance(n, str) for n in beside)):
            wrong.append("what stands beside a preset")
        for action in self._actions:
            name, value = action.dest, known.get(action.dest)
            if name in ("help", "out", "resume"):
                continue
            if name not in known:
                wrong.append(f"no {asOption(name)}")
            elif not self._couldBe(action, value):
                wrong.append(f"{asOption(name)} {value!r}")
        if wrong:
            raise Refused(
                f"--resume: {folder} was left by another scene or version: {', '.join(wrong)}"
            )

    def _couldBe(self, action, value):
        if value is None:
            return action.dest == "until" or action.default is None
        if action.choices:
            return value in action.choices
        if action.nargs == 0:
            return isinstance(value, bool)
        if action.dest == "set":
            return isinstance(value, list) and all(
                alike(setting, ["", "", ""]) for setting in value
            )
        if action.dest == "field":
            return isinstance(value, list) and all(isinstance(v, str) for v in value)
        if action.dest == "history":
            points = value.get("points_mm") if isinstance(value, dict) else None
            return bool(points) and alike(points, None) and alike(value.get("text"), "")
        try:
            return not isinstance(value, (list, dict, bool)) and (
                action.type is None or action.type(str(value)) == value
            )
        except argparse.ArgumentTypeError:
            return False

    def _resumed(self, args, folder):
        try:
            known = readProgress(folder)["options"]
            self._checkKnown(known, folder)
        except Refused as refused:
            self.exit(2, f"{refused}\n")
        known["set"] = [tuple(setting) for setting in known["set"]]
        known["out"] = folder
        start = argparse.Namespace(**{**known, "set": []})
        given = super().parse_args(args, start)
        given.set = given.set or known["set"]
        fixed = [
            f"{asOption(name)} is {value}"
            for name, value in known.items()
            if name not in self.free and getattr(given, name) != value
        ]
        old = known.get("history")
        if old and given.until is not None:
            fixed.append(f"--history is {old['text']}, without --until")
        elif given.history and not old:
            fixed.append(f"--until is {known['until']}, without --history")
        elif old and not history.extends(given.history, old):
            fixed.append(
                f"--history is {old['text']}, and another one must begin with all its points"
            )
        if fixed:
            self.exit(2, f"--resume: a run goes on as it began: {', '.join(fixed)}\n")
        return given


def parser(description, until, rate=USUAL["rate"], loops=True):
    """A parser with the common options, to which a scene adds its own.

    :param until: default displacement to stop at [mm]
    :param rate: default loading rate [mm/s]
    :param loops: whether the scene has ``--history``; its value is None in all others
    """
    p = Parser(
        prog="yade " + os.path.basename(sys.argv[0]),
        description=description,
        epilog=f"masonry {version}, commit {commit}",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    mm = lambda text: number(text, 0, 1000, above=True)
    p.add_argument(
        "--preset",
        choices=[BOUND, *PRESETS],
        help="blocks, divisions, subcontacts, rate and damping with a promise of error and time; "
        "an option given beside it wins, and drops the promise; bound is limit analysis alone, without a run",
    )
    end = p.add_mutually_exclusive_group()
    end.add_argument(
        "--until",
        metavar="MM",
        type=mm,
        default=until,
        help="displacement to stop at [mm]",
    )
    p.set_defaults(history=None)
    if loops:
        end.add_argument(
            "--history",
            metavar="SPEC",
            type=_history,
            help="loops in place of --until: amplitudes in mm with repeats, as 1,2x3,4, each cycle 0, +A, -A, 0; or a "
            "CSV file with a column displacement_mm",
        )
    p.add_argument(
        "--rate",
        metavar="MM_PER_S",
        type=lambda text: number(text, 1e-3, 1000),
        default=rate,
        help="loading rate [mm/s]",
    )
    p.add_argument(
        "--blocks",
        choices=["rigid", "deformable"],
        default=USUAL["blocks"],
        help="block model",
    )
    p.add_argument(
        "--divisions",
        metavar="N",
        type=lambda t: _count(t, 10),
        default=USUAL["divisions"],
        help="cells of a deformable half brick along its length, and as many along its height; a joint has points at both "
        "ends and in the middle of every cell's face",
    )
    p.add_argument(
        "--damping-kind",
        choices=["local", "combined"],
        default=USUAL["damping_kind"],
        help="local damping (the paper's eq. (3)) or combined damping, which does not brake a steady motion",
    )
    p.add_argument(
        "--subcontacts",
        metavar="N",
        type=lambda t: _count(t, 100),
        default=USUAL["subcontacts"],
        help="points along each joint of rigid units, at its ends and between them (Gauss-Lobatto); from three on rocking "
        "and rotational stiffness are exact, and a step costs in proportion",
    )
    p.add_argument(
        "--damping",
        metavar="A",
        type=lambda t: number(t, 0, 0.99),
        default=USUAL["damping"],
        help="damping constant, the paper's eq. (3) [-]",
    )
    p.add_argument(
        "--dt-fraction",
        metavar="F",
        type=lambda t: number(t, 1e-3, 1),
        default=USUAL["dt_fraction"],
        help="time step over its stable limit [-]",
    )
    p.add_argument(
        "--density-scaling",
        metavar="F",
        type=lambda t: number(t, 1e-6, 1e6),
        default=1.0,
        help="masses over their true values, weights kept [-]: a run as with the rate times sqrt(F), in time steps "
        "sqrt(F) as long",
    )
    p.add_argument(
        "--crack-surfaces",
        choices=["on", "off"],
        default="on",
        help="whether bricks can crack in half",
    )
    p.add_argument(
        "--joints",
        choices=["softening", "brittle", "cyclic"],
        default="softening",
        help="the paper's law, brittle Coulomb slip, or the cyclic law, which is made for loads that come back",
    )
    p.add_argument(
        "--joint-stiffness",
        choices=["joint", "masonry"],
        default="joint",
        help="joints of calcium-silicate masonry: stiffness by the paper's eq. (26), or that with which the masonry has "
        "the moduli of its table 2",
    )
    p.add_argument(
        "--set",
        metavar="JOINT.PROPERTY=VALUE",
        type=_setting,
        action="append",
        default=[],
        help="change a property of the bed, head, crack or support joints, in SI units; repeatable "
        "(help(MasonryJoint) lists them); where friction and residual friction are one value, they stay one",
    )
    p.add_argument(
        "--field",
        metavar="JOINT.PROPERTY=FIELD",
        type=_field,
        action="append",
        default=[],
        help="let a property vary from place to place, as in bed.cohesion=lognormal(cov=0.3,length=0.5,seed=1): a random "
        "field about its value, with a correlation length [m]; properties joined by + vary alike; repeatable",
    )
    p.add_argument(
        "--out",
        metavar="DIR",
        type=_folder,
        default=None,
        help="folder of the results (default: results/SCENE)",
    )
    p.add_argument(
        "--checkpoint-every",
        metavar="MINUTES",
        type=lambda t: number(t, 0, 1e6),
        default=5.0,
        help="wall-clock time between checkpoints [min]; there is one at the end, on Ctrl-C and on an error, too; with 0 "
        "there is none at all",
    )
    p.add_argument(
        "--resume",
        metavar="DIR",
        type=_folder,
        default=None,
        help="go on from the checkpoint in this folder of results, with the options of its run; only --until, "
        "--checkpoint-every, --vtk-every and --no-vtk can be changed, and --history can be extended",
    )
    p.add_argument(
        "--vtk-every",
        metavar="MM",
        type=mm,
        default=1.0,
        help="displacement between ParaView frames [mm]; with --history the path between them",
    )
    p.add_argument(
        "--quick",
        action="store_true",
        help="a tenth of every displacement and time, and wide brackets, to see whether the scene works",
    )
    p.add_argument(
        "--no-vtk",
        action="store_true",
        help="write no ParaView files and no crack figure",
    )
    p.add_argument(
        "--lean",
        action="store_true",
        help="for many runs: no ParaView files, no figures, no bound beside the run, and no checkpoint once it has ended; "
        "run.json has the numbers of the crack pattern of a wall and its failure mode",
    )
    return p


def check(args, joints, more=()):
    """Apply ``--set`` to the joints of a scene, and refuse options that do not go together.

    :param args: the parsed options
    :param joints: dict of MasonryJoint by name
    :param more: problems that the caller has found, to be told with the others
    :raises Refused: with all problems at once
    """
    problems = list(more)
    if args.blocks == "rigid" and args.divisions > 1:
        problems.append("--divisions: rigid units are not divided")
    try:
        applySettings(joints, args.set)
    except Refused as refused:
        problems.append(str(refused))
    if problems:
        raise Refused("\n".join(problems))


def units(cls):
    """Units of the properties of a class of the plugin: a dict of name -> unit, of those that have one."""
    return {p["name"]: p["unit"] for p in properties(cls) if p["unit"]}


def applySettings(joints, settings):
    """Give joints the values of ``--set``. Raises Refused with all problems at once.

    :param joints: dict of MasonryJoint by name
    :param settings: list of (joint, property, text of the value)
    """
    problems, changes = [], {}
    for name, attribute, text in settings:
        if name not in joints:
            problems.append(
                f"--set {name}.{attribute}: no joint '{name}', there are {', '.join(joints)}"
            )
            continue
        values = joints[name].dict()
        if attribute not in values or attribute in ("name", "jointSet", "direction"):
            close = [a for a in values if a.lower() == attribute.lower()]
            hint = f", did you mean {close[0]}?" if close else ""
            problems.append(
                f"--set {name}.{attribute}: a MasonryJoint has no such property{hint}"
            )
            continue
        try:
            changes.setdefault(name, {})[attribute] = _value(text, values[attribute])
        except ValueError:
            kind = {
                bool: "on or off",
                list: "rows as ratio:damage,ratio:damage,...",
            }.get(type(values[attribute]), "a number")
            problems.append(f"--set {name}.{attribute}={text}: must be {kind}")
    for name, change in changes.items():
        joint = joints[name]
        if joint.residualFriction == joint.friction and "friction" in change:
            # joints with one value of friction keep one
            change.setdefault("residualFriction", change["friction"])
        try:
            joint.updateAttrs(change)
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise Refused("\n".join(problems))


def _value(text, example):
    """The value that the text of a setting stands for, of the kind of ``example``. Raises ValueError if it is none."""
    if isinstance(example, bool):
        switches = {
            "on": True,
            "true": True,
            "1": True,
            "off": False,
            "false": False,
            "0": False,
        }
        if text.lower() not in switches:
            raise ValueError(text)
        return switches[text.lower()]
    if isinstance(example, list):
        rows = [tuple(float(v) for v in row.split(":")) for row in text.split(",")]
        if any(len(row) != 2 for row in rows):
            raise ValueError(text)
        return rows
    return float(text)
