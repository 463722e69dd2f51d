# SPDX-License-Identifier: GPL-2.0-or-later
"""How the options of a scene are read: from the command line, presets, a run that is resumed, and
keywords of ``Scene``, over which the command line wins."""

import argparse
import difflib
import os
import re

from ..arguments import asFloat, flag, isNumber, oneOf, shown
from ..background import reportRefusal
from ..errors import NotResumed, Refused, refuse
from ..terminal import say, escapeControls
from ..run import batch
from ..run.checkpoints import Saved
from ..run.option_table import OPTIONS, asOption, optionsWith
from ..run.presets import PRESETS
from . import history

#: Options of the run at hand, which no script can give.
OF_THE_RUN = {"help", *OPTIONS} - optionsWith("ofScript")
#: Names that a scene takes beside its options.
BESIDE = "title plane gravity columns functors arguments allowGaps collapse".split()


class Options(argparse.Namespace):
    """The options that a :class:`Parser` has read.

    Not in ``vars``: the ``parser``; ``given``, those of the command line, or None in a run that is
    resumed; ``defaults``, those of the parser; ``replaced``, what :func:`keep` has changed."""

    __slots__ = ("parser", "given", "defaults", "replaced")

    def __init__(self, parser, **options):
        super().__init__(**options)
        self.parser, self.given, self.defaults, self.replaced = parser, None, {}, {}


class Parser(argparse.ArgumentParser):
    """A parser that reports all wrong options at once, and takes whole names only.

    Options that are not given are those of ``--preset``, or those of the run that is resumed, which
    refuses others, but for those in ``free``. ``overrides`` of the parsed options lists those that
    differ from the preset, or from the default.
    """

    #: The parser that read the command line last, and its options.
    last = None, None

    def __init__(self, **settings):
        super().__init__(allow_abbrev=False, **settings)
        self.problems = []
        self.raises = False  # wrong options raise Refused, and end no program
        self.free = optionsWith("free")
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

    def _print_message(self, message, file=None):
        super()._print_message(escapeControls(message or ""), file)

    def error(self, message):
        refused = Refused("\n".join([*self.problems, message]))
        if self.raises:
            raise refused
        reportRefusal(refused)
        super().error("\n  ".join([*self.problems, message]))

    def _refuse(self, refused):
        reportRefusal(refused)
        self.exit(2, f"{refused}\n")

    def refusals(self, words):
        """The options that words give, or None, and sentences on why they are refused."""
        self.raises = True
        try:
            return self._parsed(words, None), []
        except Refused as refused:
            return None, str(refused).splitlines()
        finally:
            self.raises = False

    def parse_args(self, args=None, namespace=None):
        """The options of the command line, or those of a row of a table of ``yade-batch``."""
        whole = args is None
        if whole:
            try:
                args = batch.present()
            except batch.Done as done:
                self.exit(0, f"{done} has the results of this row\n")
            except Refused as refused:
                self._refuse(refused)
        found = self._parsed(args, namespace)
        if whole:
            Parser.last = self, found
        return found

    def _parsed(self, args, namespace):
        if namespace is None:
            namespace = Options(self)
        found = super().parse_args(args, namespace)
        if found.resume is not None:
            return self._resumed(args, found.resume)
        nothing = argparse.Namespace(**{action.dest: None for action in self._actions})
        given = vars(super().parse_args(args, nothing))
        given = {name: value for name, value in given.items() if value is not None}
        defaults = {**vars(found), **{name: self.get_default(name) for name in given}}
        presetOptions = {**defaults, **PRESETS.get(found.preset, {})}
        vars(found).update(presetOptions, **given)
        if isinstance(found, Options):
            found.given, found.defaults = given, defaults
        if found.history:
            found.until = None
        found.overrides = _overrides(given, presetOptions)
        return found

    def _checkKnown(self, known, folder):
        """Refuse options of a checkpoint that this scene cannot have."""
        acting = {action.dest for action in self._actions}
        names = {*acting, *self._defaults, "overrides"}
        wrong = [asOption(name) for name in known if name not in names]
        for name in set(self._defaults) - acting:
            if known.get(name) != self._defaults[name]:
                wrong.append(f"{asOption(name)} {known.get(name)!r}")
        lacks = acting - {"help", "out", "resume", *known}
        wrong += [f"no {asOption(name)}" for name in sorted(lacks)]
        if wrong:
            raise NotResumed(
                f"--resume: {folder} was left by another scene or version: {', '.join(wrong)}"
            )

    def _resumed(self, args, folder):
        try:
            saved = Saved(folder)
            known = saved.options
            self._checkKnown(known, folder)
        except Refused as refused:
            self._refuse(refused)
        known["set"] = [tuple(setting) for setting in known["set"]]
        known["out"] = folder
        start = Options(self, **{**known, "set": [], "field": []})
        given = super().parse_args(args, start)
        given.set = given.set or known["set"]
        given.field = given.field or known["field"]
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
            why = f"--resume: a run goes on as it began: {', '.join(fixed)}"
            self._refuse(NotResumed(why))
        given.saved = saved
        return given


def _overrides(given, expected):
    """Names of given options that drop the promise of a preset."""
    harmless = optionsWith("harmless")
    return [o for o, v in given.items() if o not in harmless and v != expected[o]]


# -- keywords of a scene ---------------------------------------------------------------------------


def checked(parser, name, options):
    """Keywords of a scene as values that the command line would give. Raises Refused with all
    problems.

    :param parser: :class:`Parser` whose options they are
    :param options: values by option
    """
    actions = {a.dest: a for a in parser._actions if a.dest not in OF_THE_RUN}
    found, problems = {}, []
    for option, value in options.items():
        if option in actions:
            try:
                found[option] = _value(actions[option], value)
            except (argparse.ArgumentTypeError, ValueError) as error:
                problems.append(f"{option}: {error}")
            continue
        hint = "there are " + ", ".join(sorted(actions))
        for close in difflib.get_close_matches(option, [*actions, *BESIDE], 1):
            hint = f"did you mean {close}?"
        if option in OF_THE_RUN:
            hint = f"{asOption(option)} is for the command line alone"
        problems.append(f"no option {option}; {hint}")
    if options.get("until") is not None and options.get("history") is not None:
        problems.append("until and history: give one of them")
    refuse([f"scene {name}: {one}" for one in problems])
    return found


def _value(action, value):
    if value is None and (action.default is None or action.dest == "until"):
        return None
    if action.choices:
        return oneOf(*action.choices)(value)
    if action.nargs == 0:
        return flag(value)
    if not isinstance(action.default, list):
        return _typed(action, value)
    value = [value] if isinstance(value, str) else value
    if not isinstance(value, (list, tuple)):
        raise ValueError(f"{shown(value)} must be a list of texts")
    return [_typed(action, one) for one in value]


def _typed(action, value):
    if isNumber(value):
        value = str(asFloat(value))
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, str):
        raise ValueError(f"{shown(value)} must be a number or a text")
    return action.type(value) if action.type else value


def keep(args, name, options):
    """Let options have the values that a script gives as keywords. The command line and presets
    win, and a note says so. Options of a run that is resumed stay. Raises Refused with all
    problems.

    :param args: :class:`Options`, which are changed
    :param options: values by option
    """
    if not isinstance(args, Options):
        if options:
            raise Refused(
                f"scene {name}: arguments that go with {', '.join(options)} must be those of "
                "masonry.scene.options.parser(...).parse_args(), or a list of words"
            )
        return
    vars(args).update(args.replaced)  # by another scene with the same options
    args.replaced, given = {}, args.given
    options = checked(args.parser, name, options)
    if given is None or not options:
        return
    chosen = given.get("preset", options.get("preset", args.preset))
    preset = PRESETS.get(chosen, {})
    first = {**options, **preset}
    now = {option: given.get(option, value) for option, value in first.items()}
    # keywords that do not hold, and the options that do
    beaten = {o: o for o, value in options.items() if given.get(o, value) != value}
    for option, value in options.items():
        if isinstance(value, list):  # what the command line adds comes last
            now[option] = [*value, *given.get(option, [])]
            beaten.pop(option, None)
    # only one of these two options is kept
    for option, other in (("until", "history"), ("history", "until")):
        if given.get(option) is not None:
            now.update({option: given[option], other: None})
            if options.get(other) is not None:
                beaten[other] = option
        elif options.get(option) is not None and other not in given:
            now[other] = None
    now["overrides"] = _overrides(given, {**args.defaults, **first})
    args.replaced = {option: getattr(args, option) for option in now}
    vars(args).update(now)
    text = lambda value: value["text"] if isinstance(value, dict) else str(value)
    if beaten:
        words = dict.fromkeys(beaten.values())
        ofLine = ", ".join(f"{asOption(o)} {text(given[o])}" for o in words)
        ofScene = ", ".join(f"{o} {text(options[o])}" for o in beaten)
        say(f"note: the command line wins: {ofLine}; the scene has {ofScene}")
    for option, value in preset.items():
        if option not in given and options.get(option, value) != value:
            say(f"note: --preset {chosen}: {option} is {value}, the scene has {options[option]}")
