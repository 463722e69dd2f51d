# SPDX-License-Identifier: GPL-2.0-or-later
"""How the command line of a scene is read: presets, and the options of a run that is resumed."""

import argparse
import re

from ..common.background import reportRefusal
from ..basics import NotResumed, Refused, plain
from ..run import batch
from ..run.run_state import Saved
from ..run.options import asOption, those
from ..run.presets import PRESETS
from . import history


class Options(argparse.Namespace):
    """The options that a :class:`Parser` has read.

    Beside the options there are, and no part of what ``vars`` gives: ``parser``, which has read them; ``given``, those of the
    command line, as a dict, or None in a run that is resumed; ``defaults``, those of the parser; ``replaced``, what
    :func:`masonry.scene.keywords.keep` has changed.
    """

    __slots__ = ("parser", "given", "defaults", "replaced")

    def __init__(self, parser, **options):
        super().__init__(**options)
        self.parser, self.given, self.defaults, self.replaced = parser, None, {}, {}


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
        self.raises = False  # whether wrong options raise Refused, and end no program
        self.free = those("free")
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
        super()._print_message(plain(message or ""), file)

    def error(self, message):
        refused = Refused("\n".join([*self.problems, message]))
        if self.raises:
            raise refused
        reportRefusal(refused)
        super().error("\n  ".join([*self.problems, message]))

    def _refuse(self, refused):
        """End the program, with what is refused."""
        reportRefusal(refused)
        self.exit(2, f"{refused}\n")

    def refusals(self, words):
        """The options that words give, or None, and why they are refused, a list of sentences."""
        self.raises = True
        try:
            return self._parsed(words, None), []
        except Refused as refused:
            return None, str(refused).splitlines()
        finally:
            self.raises = False

    def parse_args(self, args=None, namespace=None):
        """The options of the command line, or, in a run of ``yade-batch``, those of a row of its table: masonry.run.batch."""
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
        defaults = self._withoutWords()
        presetOptions = {**defaults, **PRESETS.get(found.preset, {})}
        vars(found).update(presetOptions, **given)
        if isinstance(found, Options):
            found.given, found.defaults = given, defaults
        if found.history:
            found.until = None
        found.overrides = [
            name
            for name, value in given.items()
            if name not in those("harmless") and value != presetOptions[name]
        ]
        return found

    def _withoutWords(self):
        """The values of all options that are not given; of those that a scene requires None."""
        required = [action for action in self._actions if action.required]
        for action in required:
            action.required = False
        try:
            return vars(super().parse_args([]))
        finally:
            for action in required:
                action.required = True

    def _checkKnown(self, known, folder):
        """Refuse options of a checkpoint that this scene could not have had."""
        acting = {action.dest for action in self._actions}
        names = acting | set(self._defaults)
        wrong = [asOption(name) for name in known if name not in names | {"overrides"}]
        for name in set(self._defaults) - acting:
            if known.get(name) != self._defaults[name]:
                wrong.append(f"{asOption(name)} {known.get(name)!r}")
        asked = acting - {"help", "out", "resume"}
        wrong += [f"no {asOption(name)}" for name in sorted(asked - known.keys())]
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
