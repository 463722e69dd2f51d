# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands of a script, noted as data: a run that is resumed can be compared with the script
that began it."""

import contextlib
import functools
import inspect
import math
from dataclasses import dataclass
from typing import Any, Callable, Concatenate, ParamSpec, Protocol, TypeVar, overload

from ..background import refuseScript
from ..errors import NotResumed, Refused

P = ParamSpec("P")
Q = ParamSpec("Q")
R = TypeVar("R")
S = TypeVar("S", covariant=True)

RESULT = "result"  # the command that keeps a number of the script's own
PUSHES = "push", "cycle", "follow"  # to the first of them --until and --history apply
SHAKES = ("shake",)  # to the first of them --record and --scale apply


@dataclass
class Call:
    """A command as the script gave it, for a run that goes on in the same process.

    :param command: function of the scene and the arguments
    """

    command: Callable
    args: tuple
    settings: dict
    record: Any = None  # what it returned, if it describes
    refused: bool = False  # and the script went on


def describes(act: Callable[Concatenate[Any, P], R]) -> Callable[Concatenate[Any, P], R]:
    """A command that describes a scene: it comes before the first stage, and is noted.

    :param act: function of a :class:`masonry.scene.description.Description` and the arguments
    """

    @functools.wraps(act)
    def command(scene: Any, *args: P.args, **settings: P.kwargs) -> R:
        if scene.model:
            raise Refused(
                f"{act.__name__}() must come before the first stage: the scene is built already"
            )
        try:
            record = act(scene.description, *args, **settings)
        except Refused as refused:
            raise refuseScript(refused) from None
        scene.calls.append(Call(command, args, settings, record))
        scene.script.note(act, scene, args, settings)
        return record

    return command


class Either(Protocol[P, S, Q]):
    """A command with other arguments after the first stage than before it."""

    @overload
    # mypy: both may be called without arguments
    def __call__(self, *args: P.args, **settings: P.kwargs) -> S:  # type: ignore[misc]
        ...

    @overload
    def __call__(self, *args: Q.args, **settings: Q.kwargs) -> str:
        ...


class EitherCommand(Protocol[P, S, Q]):
    """Such a command in the class of a scene."""

    def __get__(self, scene: Any, cls: Any = None) -> Either[P, S, Q]:
        ...


def either(
    describes: Callable[Concatenate[Any, P], S],
    stage: Callable[Concatenate[Any, Q], str],
) -> EitherCommand[P, S, Q]:
    """A command that describes before the first stage, and is a stage after it."""

    @functools.wraps(describes)
    def command(scene: Any, *args: Any, **settings: Any) -> Any:
        present: Any = stage if scene.model else describes
        return present(scene, *args, **settings)

    first, later = map(inspect.getdoc, (describes, stage))
    command.__doc__ = f"{first}\n\nAfter the first stage: {later}"
    typed: Any = command
    return typed


def argumentsOf(act, first, args, settings):
    """What the user gives to a command, by the names of its parameters, with the defaults of the
    others."""
    bound = inspect.signature(act).bind(first, *args, **settings)
    bound.apply_defaults()
    return dict(list(bound.arguments.items())[1:])


def asData(value):
    """A value as JSON can hold it: targets and recorded joints by their names."""
    if value is None or isinstance(value, (bool, str, int)):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else repr(value)
    if callable(value):
        return "a function"
    if isinstance(value, dict):
        return {str(asData(key)): asData(one) for key, one in value.items()}
    if isinstance(getattr(value, "name", None), str):
        return value.name
    with contextlib.suppress(TypeError):
        return [asData(one) for one in value]
    try:
        return asData(float(value))
    except (TypeError, ValueError):
        return repr(value)


class Script:
    """The commands that the script has given so far. ``commands`` is a list of pairs, which
    checkpoints keep: the name of a command, and its arguments as a dict of data."""

    def __init__(self):
        self.commands = []
        self.aside = False  # whether no option of the command line is for the commands that follow
        self._asides = set()  # places of these
        self._extendable = []  # for each command, the arguments that set its end

    def note(self, act, first, args, settings):
        self.add(act.__name__, asData(argumentsOf(act, first, args, settings)))

    def add(self, word, arguments, extendable=()):
        """Add a command and its arguments as data; ``extendable`` names those that set its end."""
        (self._asides.add if self.aside else self._asides.discard)(len(self.commands))
        self.commands.append([word, arguments])
        self._extendable.append(set(extendable))

    def isFirst(self, kinds):
        """Whether the last command is the first of some kinds for which there are options."""
        return self._placesOf(kinds) == [len(self.commands) - 1]

    def has(self, kinds):
        """Whether there was such a command, or those that follow are none."""
        return self.aside or bool(self._placesOf(kinds))

    def _placesOf(self, kinds):
        words = enumerate(word for word, _ in self.commands)
        return [at for at, word in words if word in kinds and at not in self._asides]

    def compare(self, before):
        """Refuse a script that differs from that of the run that is resumed. Returns whether it
        goes farther.

        :param before: ``commands`` of that run, up to its checkpoint. The last stage among them may
            go farther now
        """
        last = max((n for n, (word, _) in enumerate(before) if word != RESULT), default=-1)
        extended = False
        for at, (was, now) in enumerate(zip(before, self.commands)):
            if was == now:
                continue
            (name, old), (other, new) = was, now
            may = self._extendable[at] if at == last else set()
            changed = {n for n in {**old, **new} if old.get(n) != new.get(n)}
            if name != other or not changed <= may:
                raise NotResumed(
                    f"--resume: a run goes on as it began: the script said {_spoken(*was)}, now it"
                    f" says {_spoken(*now)}"
                )
            extended = True
        return extended


def _spoken(name, arguments):
    return f"{name}({', '.join(f'{n}={v!r}' for n, v in arguments.items())})"
