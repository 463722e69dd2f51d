# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that a script gives to a scene as keywords: they hold unless the command line gives the same option."""

import argparse
import difflib
import os

from ..common.arguments import flag, isNumber, oneOf, plain, shown
from ..basics import Refused, refuse, say
from ..run.options import OPTIONS, asOption, those
from ..run.presets import PRESETS
from .parsing import Options

#: What a script cannot say: it is about the run at hand.
OF_THE_RUN = {"help", *OPTIONS} - those("ofScript")


#: Names that a scene takes beside its options.
BESIDE = "title plane gravity columns functors arguments allowGaps collapse".split()


def checked(parser, name, options):
    """The values of keywords, of the kind that the command line would give. Raises Refused with all problems.

    :param parser: :class:`masonry.scene.parsing.Parser` whose options they are
    :param name: of the scene
    :param options: dict of option -> value
    """
    actions = {a.dest: a for a in parser._actions if a.dest not in OF_THE_RUN}
    found, problems = {}, []
    for option, value in options.items():
        if option not in actions:
            close = difflib.get_close_matches(option, [*actions, *BESIDE], 1)
            hint = (
                f"did you mean {close[0]}?"
                if close
                else "there are " + ", ".join(sorted(actions))
            )
            if option in OF_THE_RUN:
                hint = f"{asOption(option)} is for the command line alone"
            problems.append(f"no option {option}; {hint}")
            continue
        try:
            found[option] = _value(actions[option], value)
        except (argparse.ArgumentTypeError, ValueError) as error:
            problems.append(f"{option}: {error}")
    if options.get("until") is not None and options.get("history") is not None:
        problems.append("until and history: give one of them")
    refuse([f"scene {name}: {one}" for one in problems])
    return found


def _value(action, value):
    """The value of an option from that of a keyword. Raises ValueError or argparse.ArgumentTypeError."""
    if value is None and (action.default is None or action.dest == "until"):
        return None
    if action.choices:
        return oneOf(*action.choices)(value)
    if action.nargs == 0:
        return flag(value)
    if isinstance(action.default, list):
        if isinstance(value, str):
            value = [value]
        if not isinstance(value, (list, tuple)):
            raise ValueError(f"{shown(value)} must be a list of texts")
        return [_typed(action, one) for one in value]
    return _typed(action, value)


def _typed(action, value):
    """A value as the type of an option makes it of a text."""
    if isNumber(value):
        value = str(plain(value))
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, str):
        raise ValueError(f"{shown(value)} must be a number or a text")
    return action.type(value) if action.type else value


def keep(args, name, options):
    """Let options have the values that a script gives as keywords, but for those that the command line gives.

    A line on the terminal names the others. A preset wins over what the script says of the options that it chooses, and says so. Options of a
    run that is resumed are those with which it began, and stay.

    :param args: :class:`masonry.scene.parsing.Options`, which are changed
    :param name: of the scene
    :param options: dict of option -> value
    :raises Refused: with all problems
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
    for option, value in options.items():
        if isinstance(value, list):  # what the command line adds comes last
            now[option] = [*value, *given.get(option, [])]
    # by which
    beaten = {o: o for o, value in options.items() if given.get(o, value) != value}
    ends = {"until": "history", "history": "until"}  # of which there is one
    for option, other in ends.items():
        if given.get(option) is not None:
            now.update({option: given[option], other: None})
            if options.get(other) is not None:
                beaten[other] = option
        elif options.get(option) is not None and other not in given:
            now[other] = None
    expected = {**args.defaults, **first}
    now["overrides"] = [
        option
        for option, value in given.items()
        if option not in those("harmless") and value != expected[option]
    ]
    args.replaced = {option: getattr(args, option) for option in now}
    vars(args).update(now)
    beaten = {o: by for o, by in beaten.items() if not isinstance(options[o], list)}
    if beaten:
        words = dict.fromkeys(beaten.values())
        ofLine = ", ".join(f"{asOption(o)} {_said(given[o])}" for o in words)
        ofScene = ", ".join(f"{o} {_said(options[o])}" for o in beaten)
        say(f"note: the command line wins: {ofLine}; the scene has {ofScene}")
    for option in preset:
        if (
            option not in given
            and options.get(option, preset[option]) != preset[option]
        ):
            say(
                f"note: --preset {chosen}: {option} is {preset[option]}, the scene has {options[option]}"
            )


def _said(value):
    return value["text"] if isinstance(value, dict) else str(value)
