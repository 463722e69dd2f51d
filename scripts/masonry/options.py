"""Command-line options that all scenes share."""

import argparse
import math
import os
import re
import sys


#: Options that trade accuracy for time, the same for all walls; a scene of one's own may take them from here.
PRESETS = {
    "fast": {"blocks": "rigid", "divisions": 1, "subcontacts": 4, "rate": 100.0},
    "balanced": {"blocks": "deformable", "divisions": 2, "rate": 100.0},
    "accurate": {"blocks": "deformable", "divisions": 2, "rate": 50.0},
}
for _preset in PRESETS.values():
    _preset.update(damping=0.8, damping_kind="combined", dt_fraction=0.8)

#: Most that a preset's peak and work over the push differ from a fine and slow run [-], and how far that was pushed
#: [mm] and takes [s] with ``yade -j2`` on two idle server cores, by wall. Measured in validation/trade.
PROMISES = {
    "fast": {
        "peak_error": 0.03,
        "work_error": 0.04,
        "walls": {
            "wall_comp0a": (30, 8),
            "wall_comp1": (30, 8),
            "wall_comp4": (12, 8),
            "wall_comp6": (16, 9),
        },
    },
    "balanced": {
        "peak_error": 0.02,
        "work_error": 0.04,
        "walls": {
            "wall_comp0a": (30, 30),
            "wall_comp1": (30, 30),
            "wall_comp4": (12, 40),
            "wall_comp6": (16, 50),
        },
    },
    "accurate": {
        "peak_error": 0.02,
        "work_error": 0.02,
        "walls": {
            "wall_comp0a": (30, 60),
            "wall_comp1": (30, 60),
            "wall_comp4": (12, 90),
            "wall_comp6": (16, 120),
        },
    },
}

#: Options that leave a preset's promise alone.
HARMLESS = {"preset", "until", "out", "vtk_every", "no_vtk", "checkpoint_every"}


class Refused(ValueError):
    """Input that cannot be run, with all problems at once."""


def number(text, low=-math.inf, high=math.inf, above=False):
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


def _folder(text):
    if not text.strip():
        raise argparse.ArgumentTypeError("must not be empty")
    return text


class Parser(argparse.ArgumentParser):
    """Tells all wrong options at once, and takes no part of a name for the whole.

    Takes the options that ``--preset`` names for those that are not given, or those of a run that is resumed.
    ``overrides`` of the parsed options lists those that were given and differ from the preset's or from the default.
    Options that would change a resumed run are refused.
    """

    def __init__(self, **settings):
        super().__init__(allow_abbrev=False, **settings)
        self.problems = []
        self.free = {"until", "checkpoint_every", "vtk_every", "no_vtk"}  # when resumed
        # argparse knows no exponents: -5e-1 would be an option
        self._negative_number_matcher = re.compile(
            r"-(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$|-(inf|nan)$", re.IGNORECASE
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
        found = super().parse_args(args, namespace)
        if found.resume is not None:
            return self._resumed(args, found.resume)
        nothing = argparse.Namespace(**{action.dest: None for action in self._actions})
        given = vars(super().parse_args(args, nothing))
        given = {name: value for name, value in given.items() if value is not None}
        usual = {**vars(super().parse_args([])), **PRESETS.get(found.preset, {})}
        vars(found).update(usual, **given)
        found.overrides = [
            name
            for name, value in given.items()
            if name not in HARMLESS and value != usual[name]
        ]
        return found

    def _resumed(self, args, folder):
        from .checkpoints import readRun

        try:
            known = readRun(folder)["options"]
        except Refused as refused:
            self.exit(2, f"{refused}\n")
        known["set"] = [tuple(setting) for setting in known.get("set", [])]
        known["out"] = folder
        start = argparse.Namespace(**{**known, "set": []})
        given = super().parse_args(args, start)
        given.set = given.set or known["set"]
        fixed = [
            f"--{name.replace('_', '-')} is {value}"
            for name, value in known.items()
            if name not in self.free and getattr(given, name) != value
        ]
        if fixed:
            self.exit(2, f"--resume: a run goes on as it began: {', '.join(fixed)}\n")
        return given


def presetOf(args, wall):
    """What run.json says of ``--preset``, for a wall's name: None without one, or a dict.

    Keys: ``name``; ``overrides``, options given beside it; ``promise``, None if there are any or if the wall is none
    of those that it was measured on, else ``peak_error`` and ``work_error`` [-], ``until_mm`` and ``seconds``.
    """
    if not args.preset:
        return None
    entry, promise = {"name": args.preset, "overrides": args.overrides}, None
    known = PROMISES[args.preset]
    if not args.overrides and wall in known["walls"]:
        until, seconds = known["walls"][wall]
        promise = {name: known[name] for name in ("peak_error", "work_error")}
        promise.update(until_mm=until, seconds=seconds)
    return {**entry, "promise": promise}


def presetNote(preset, wall):
    """The same as a line to read."""
    name, promise = preset["name"], preset["promise"]
    if promise:
        return (
            f"preset {name}: promises the peak within {100 * promise['peak_error']:g} % and the work over "
            f"{promise['until_mm']:g} mm within {100 * promise['work_error']:g} % of a fine and slow run, "
            f"in about {promise['seconds']:g} s"
        )
    reason = ", ".join("--" + o.replace("_", "-") for o in preset["overrides"])
    reason = reason and f"{reason} beside it"
    return f"preset {name} without its promise: {reason or f'not measured on {wall}'}"


def parser(description, until, rate=20.0):
    """Parser with the common options; a scene adds its own.

    :param until: default displacement to stop at [mm]
    :param rate: default loading rate [mm/s]
    """
    p = Parser(
        prog="yade " + os.path.basename(sys.argv[0]),
        description=description,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    mm = lambda text: number(text, 0, 1000, above=True)
    p.add_argument(
        "--preset",
        choices=list(PRESETS),
        help="blocks, divisions, subcontacts, rate and damping with a promise of error and time; "
        "an option beside it goes before the preset's",
    )
    p.add_argument(
        "--until",
        metavar="MM",
        type=mm,
        default=until,
        help="displacement to stop at [mm]",
    )
    p.add_argument(
        "--rate",
        metavar="MM_PER_S",
        type=lambda text: number(text, 1e-3, 1000),
        default=rate,
        help="loading rate [mm/s]",
    )
    p.add_argument(
        "--blocks", choices=["rigid", "deformable"], default="rigid", help="block model"
    )
    p.add_argument(
        "--divisions",
        metavar="N",
        type=lambda t: _count(t, 10),
        default=1,
        help="cells of a deformable half brick along its length; along its height as many; its joints have a point at "
        "every node",
    )
    p.add_argument(
        "--damping-kind",
        choices=["local", "combined"],
        default="combined",
        help="local (paper eq. (3)) or combined damping, which does not brake a steady motion",
    )
    p.add_argument(
        "--subcontacts",
        metavar="N",
        type=lambda t: _count(t, 100),
        default=4,
        help="points along each joint of rigid units",
    )
    p.add_argument(
        "--damping",
        metavar="A",
        type=lambda t: number(t, 0, 0.99),
        default=0.8,
        help="damping constant, paper eq. (3) [-]",
    )
    p.add_argument(
        "--dt-fraction",
        metavar="F",
        type=lambda t: number(t, 1e-3, 1),
        default=0.8,
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
        choices=["softening", "brittle"],
        default="softening",
        help="the full law, or brittle Coulomb slip",
    )
    p.add_argument(
        "--set",
        metavar="JOINT.PROPERTY=VALUE",
        type=_setting,
        action="append",
        default=[],
        help="change a property of the bed, head, crack or support joints, in SI units; repeatable "
        "(help(MasonryJoint) lists them)",
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
        help="wall-clock time between checkpoints [min]; there is one at the end, too, on Ctrl-C and on an error; 0: "
        "none at all",
    )
    p.add_argument(
        "--resume",
        metavar="DIR",
        type=_folder,
        default=None,
        help="go on from the checkpoint in this folder of results, with the options of its run; only --until, "
        "--checkpoint-every, --vtk-every and --no-vtk can be changed",
    )
    p.add_argument(
        "--vtk-every",
        metavar="MM",
        type=mm,
        default=1.0,
        help="displacement between ParaView frames [mm]",
    )
    p.add_argument(
        "--no-vtk",
        action="store_true",
        help="write no ParaView files and no crack figure",
    )
    return p


def check(args, joints, more=()):
    """Apply ``--set`` to a dict of MasonryJoint objects and raise Refused for options that do not go together.

    :param more: problems found by the caller, told with the others
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
    """Units of a class's attributes, as their docs give them: dict of attribute -> text between the first brackets."""
    docs = {
        name: value.__doc__
        for name, value in vars(cls).items()
        if isinstance(value, property)
    }
    return {
        name: doc[doc.index("[") + 1 : doc.index("]")]
        for name, doc in docs.items()
        if "[" in doc
    }


def applySettings(joints, settings):
    """Apply ``--set`` to a dict of MasonryJoint objects; raises Refused with all problems at once."""
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
        try:
            joints[name].updateAttrs(change)
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise Refused("\n".join(problems))


def _value(text, example):
    """The value that a setting's text stands for, of the kind of ``example``; ValueError if it is none."""
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
