# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of arguments, before a command does anything. Type hints say what a parameter takes::

    Stress = Annotated[float, number("Pa", 0, 1e12)]

    @validated
    def press(description: Any, platen: MovingPlaten, stress: Stress, riding: bool = True): ...

A hint is ``Annotated`` with a validator: a function of a value and of its context, the first
argument of the command (the scene or its description). It returns the value as the command uses it,
or raises ValueError, whose text completes "NAME ": "-1 Pa must be at least 0". Validators of
numbers have their ``unit``, and ``of``, the type of Python; those of some texts have ``choices``.
Texts, switches and functions need none; hints of other types without one are not checked.
"""

import ast
import collections.abc
import contextlib
import difflib
import functools
import inspect
import math
import os
from numbers import Integral, Real
from types import UnionType
from typing import Annotated, Any, Callable, Sequence, TypeVar, Union
from typing import cast, get_args, get_origin, get_type_hints

import numpy as np

from .errors import Refused, refuse

#: Type hints of what a user gives.
Numbers = Union[Sequence[float], np.ndarray[Any, Any]]
Axes = Union[str, Sequence[str]]
Validator = Callable[..., Any]

F = TypeVar("F", bound=Callable[..., Any])

LONGEST_NAME, LONGEST_TEXT = 100, 1000  # characters
SHORTEST, LONGEST = 1e-100, 1e100  # lengths of a direction [-]
SHOWN = 80  # characters of a value in a message


def shown(value):
    """A value as a message has it, cut to :data:`SHOWN`."""
    try:
        text = repr(value[:LONGEST_TEXT] if isinstance(value, str) else value)
    except Exception:  # of a class of the user's own
        text = object.__repr__(value)
    text = " ".join(text.split())  # of a matrix, in one line
    return text if len(text) < SHOWN else text[: SHOWN - 3] + "..."


def nearest(name, names):
    """The end of a sentence, ``, did you mean 'x'?``, or nothing."""
    close = difflib.get_close_matches(str(name)[:SHOWN], [str(n) for n in names], 1)
    return f", did you mean {close[0]!r}?" if close else ""


class ByName(dict):
    """A dict by names, which raises Refused with those that it has."""

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what

    def __missing__(self, name):
        there = ", ".join(map(str, self)) or "none"
        raise Refused(f"no {self.what} {name!r}{nearest(name, self)}; there are {there}")


# -- validators ------------------------------------------------------------------------------------


def isNumber(value):
    """Whether a value is a real number. True and False are not."""
    own = type(value)
    return own is float or own is not bool and isinstance(value, Real)


def asFloat(value):
    """A real number as a float or int of Python, or infinity if there is no float so large."""
    if type(value) in (int, float) and abs(value) < 2**1000:
        return value
    try:
        found = float(value)
    except OverflowError:
        return math.inf
    return int(value) if isinstance(value, Integral) else found


def require(value, condition, expectation):
    """Return a value if a condition holds, else raise ValueError."""
    if not condition:
        raise ValueError(f"{shown(value)} must be {expectation}")
    return value


def number(unit="", low=-math.inf, high=math.inf, above=False, below=False):
    """Validator of a finite number.

    :param above: whether it must be above ``low``, not at least; ``below``: below ``high``
    """
    bounds = []
    if low > -math.inf:
        bounds.append(f"{'above' if above else 'at least'} {low:g}")
    if high < math.inf:
        bounds.append(f"{'below' if below else 'at most'} {high:g}")
    bounds, of = " and ".join(bounds), unit and f" {unit}"
    if low == -high > -math.inf:
        bounds = f"from {low:g} to {high:g}"

    def take(value, context=None):
        require(value, isNumber(value), f"a number{bounds and ' '}{bounds}{of}")
        found = asFloat(value)
        if not math.isfinite(found):
            raise ValueError(f"{shown(value)}{of} must be a finite number{bounds and ' '}{bounds}")
        outside = above and found == low or below and found == high
        if outside or not low <= found <= high:
            raise ValueError(f"{shown(value)}{of} must be {bounds}")
        return found

    vars(take).update(unit=unit, of=float)
    return take


def whole(low=0, high=None):
    """Validator of a whole number."""
    bounds = f"at least {low}" if high is None else f"from {low} to {high}"

    def take(value, context=None):
        fine = isinstance(value, Integral) and not isinstance(value, bool)
        fine = fine and low <= value and (high is None or value <= high)
        return int(require(value, fine, f"a whole number {bounds}"))

    vars(take).update(of=int)
    return take


def flag(value, context=None):
    """Validator of True and False."""
    return bool(require(value, isinstance(value, (bool, np.bool_)), "True or False"))


def text(value, context=None):
    """Validator of a text that can be printed and written to a file."""
    require(value, isinstance(value, str) and value.strip(), "a text")
    fine = len(value) <= LONGEST_TEXT and value.replace("\n", " ").isprintable()
    expected = f"a text of characters that can be printed, at most {LONGEST_TEXT} of them"
    return require(value, fine, expected)


def label(value, context=None):
    """Validator of a :func:`text`, or of an empty one."""
    return value if isinstance(value, str) and not value else text(value)


def name(value, context=None):
    """Validator of a name that begins names of columns."""
    fine = isinstance(value, str) and value.isidentifier() and len(value) <= LONGEST_NAME
    expected = f"a name of letters, digits and underscores, at most {LONGEST_NAME} of them"
    return require(value, fine, expected)


def names(value, context=None):
    """Validator of a text, or of a list of texts."""
    return text(value) if isinstance(value, str) else listOf(text)(value)


def path(value, context=None):
    """Validator of the name of a file."""
    with contextlib.suppress(TypeError, UnicodeEncodeError):
        found = os.fspath(value)
        size = len(os.fsencode(found)) if isinstance(found, str) else 0
        if 0 < size < 4096 and "\0" not in found:
            return found
    return require(value, False, "the name of a file")


def function(value, context=None):
    """Validator of a function."""
    return require(value, callable(value), "a function")


def oneOf(*choices):
    """Validator of one of some texts."""

    def take(value, context=None):
        fine = isinstance(value, str) and value in choices
        close = nearest(value, choices) if isinstance(value, str) and not fine else ""
        return require(value, fine, f"one of {', '.join(choices)}{close}")

    vars(take).update(choices=choices)
    return take


def isA(cls, what=None):
    """Validator of an object of a class or of one of several.

    :param what: a name for it; None: the names of the classes
    """
    classes = cls if isinstance(cls, tuple) else (cls,)
    what = what or " or ".join(one.__name__ for one in classes)
    return lambda value, context=None: require(value, isinstance(value, cls), f"a {what}")


def byName(validator, *needed):
    """Validator of a dict from names to values that another validator takes; some are needed."""

    def take(value, context=None):
        fine = isinstance(value, dict) and all(isinstance(n, str) for n in value)
        require(value, fine, "a dict by name")
        missing = [n for n in needed if n not in value]
        if missing:
            raise ValueError(f"{shown(value)} must have {', '.join(map(repr, missing))}")
        problems = []
        for one, thing in value.items():
            try:
                validator(thing)
            except ValueError as error:
                problems.append(f"{one!r}: {error}")
        if problems:
            raise ValueError("; ".join(problems))
        return value

    return take


def axes(letters, none=False):
    """Validator of some axes, as ``"xz"``: letters without repeats, or a list of them; ``none``: or
    of none."""

    def take(value, context=None):
        fine = isinstance(value, (str, list, tuple, set, frozenset))
        fine = fine and all(isinstance(a, str) and a in [*letters] for a in value)
        fine = fine and len({*value}) == len(value) and (none or value)
        require(value, fine, f"some of the axes {letters!r}, each once")
        return "".join(sorted(value) if isinstance(value, (set, frozenset)) else value)

    return take


def isListed(value):
    """Whether a value is a list, a tuple, an array or the like. Texts and dicts are not."""
    if isinstance(value, (str, bytes, bytearray, dict, type)):
        return False
    return hasattr(value, "__len__") and hasattr(value, "__getitem__")


def items(value):
    """The values of what :func:`isListed`, else None."""
    if type(value) in (list, tuple):
        return [*value]
    if not isListed(value):
        return None
    try:
        return [value[n] for n in range(len(value))]
    except Exception:  # arrays without dimensions, classes of the user's own
        return None


def vector(unit="", most=1e100):
    """Validator of three finite numbers, none larger than ``most``."""
    of = unit and f" {unit}"
    bound = f" of at most {most:g}{of}" if most < 1e100 else ""

    def take(value, context=None):
        found = items(value)
        fine = found is not None and len(found) == 3 and all(map(isNumber, found))
        numbers = tuple(map(asFloat, found)) if fine else ()
        fine = fine and all(abs(v) <= most for v in numbers)  # NaN is not
        require(value, fine, f"three finite numbers{bound}")
        return numbers

    return take


def series(value, context=None):
    """Validator of a list of numbers in one dimension, as an array."""
    with contextlib.suppress(TypeError, ValueError, OverflowError):
        found = np.asarray(value, float)
        if found.ndim == 1:
            return found
    return require(value, False, "a list of numbers")


def direction(level=False):
    """Validator of a direction, if ``level`` a horizontal one: three numbers that are not all 0."""
    three = vector()

    def take(value, context=None):
        value = three(value)
        fine = SHORTEST <= math.hypot(*value) <= LONGEST
        require(value, fine, "a direction, whose length is not zero")
        return require(value, not (level and value[2]), "a horizontal direction")

    return take


def listOf(validator, least=1):
    """Validator of a list of values that another validator takes."""

    def take(value, context=None):
        found = items(value)
        expected = f"a list with at least {least} value{'s' * (least > 1)}"
        require(value, found is not None and len(found) >= least, expected)
        for n, one in enumerate(found):
            try:
                found[n] = validator(one, context)
            except ValueError as error:
                raise ValueError(f"(value {n} of the list) {error}") from None
        return found

    return take


def orNone(validator):
    """Validator of None, or of what another one takes."""
    return lambda value, context=None: None if value is None else validator(value, context)


def orFunction(validator):
    """Validator of a function that gives the value later, or of what another one takes."""
    return lambda value, context=None: value if callable(value) else validator(value, context)


# -- hints -----------------------------------------------------------------------------------------

Name = Annotated[str, name]
Names = Annotated[Union[str, Sequence[str]], names]
FilePath = Annotated[Union[str, os.PathLike[str]], path]
Series = Annotated[Numbers, series]
Direction = Annotated[Numbers, direction()]
Level = Annotated[Numbers, direction(level=True)]
Freedoms = Annotated[Axes, axes("xyzXYZ")]

#: Validators of hints that need not name one.
PLAIN = {bool: flag, str: text}


def validatorOf(hint: Any) -> Validator | None:
    """The validator of a type hint; None: it is not checked."""
    if get_origin(hint) is Annotated:
        return get_args(hint)[1]
    if get_origin(hint) in (Union, UnionType):
        one, *others = [a for a in get_args(hint) if a is not type(None)]
        found = None if others else validatorOf(one)
        return found and orNone(found)
    if getattr(get_origin(hint), "__name__", "") == "Callable":
        return function
    return PLAIN.get(hint)


class _WithoutKinds(ast.NodeTransformer):
    """Leaves of ``Annotated[type, validator]`` the type."""

    def visit_Subscript(self, node):
        self.generic_visit(node)
        isAnnotated = isinstance(node.value, ast.Name) and node.value.id == "Annotated"
        return node.slice.elts[0] if isAnnotated else node


def typeOf(hint: Any) -> Any:
    """A type hint, perhaps a text, without its validators."""
    if isinstance(hint, str):
        return ast.unparse(_WithoutKinds().visit(ast.parse(hint)))
    if get_origin(hint) is Annotated:
        return typeOf(get_args(hint)[0])
    if get_origin(hint) in (Union, UnionType):
        return Union[tuple(map(typeOf, get_args(hint)))]
    if get_origin(hint) is collections.abc.Sequence:
        return Sequence[typeOf(get_args(hint)[0])]  # type: ignore[misc]
    return hint


def validated(act: F) -> F:
    """Let a function, or a class, check its arguments by the validators of its hints. All problems
    of a call are in one error, :class:`Refused`, and an unknown argument is answered with the
    nearest name.

    A function gets ``validators``, which returns these by name, and ``checked``, a function of its
    positional and its named arguments that gives both as validators return them.
    """
    if isinstance(act, type):
        setattr(act, "__init__", validated(vars(act)["__init__"]))
        return cast(F, act)
    signature = inspect.signature(act)
    called = act.__qualname__.removesuffix(".__init__").rpartition(".")[2]

    @functools.cache  # its hints name classes that are made later
    def validators() -> dict[str, Validator]:
        hints = get_type_hints(act, include_extras=True)
        hints.pop("return", None)
        return {n: found for n, hint in hints.items() if (found := validatorOf(hint))}

    def checked(args, settings):
        return _checked(called, signature, validators(), args, settings)

    @functools.wraps(act)
    def command(*args: Any, **settings: Any) -> Any:
        args, settings = checked(args, settings)
        return act(*args, **settings)

    parameters = [p.replace(annotation=typeOf(p.annotation)) for p in signature.parameters.values()]
    typed = signature.replace(parameters=parameters)  # what help() shows
    vars(command).update(validators=validators, checked=checked, __signature__=typed)
    return cast(F, command)


def _checked(command, signature, validators, args, settings):
    parameters, problems = signature.parameters, []
    more = {n for n, p in parameters.items() if p.kind in (p.VAR_POSITIONAL, p.VAR_KEYWORD)}
    known = {n: v for n, v in settings.items() if more or n in parameters}
    offered = [n for n in parameters if n not in more | {"self", "scene", "description"}]
    for unknown in settings.keys() - known.keys():
        close = nearest(unknown, offered) or f"; there are {', '.join(offered)}"
        problems.append(f"{command}: no argument {unknown!r}{close}")
    try:
        bound = signature.bind_partial(*args, **known)
    except TypeError as error:  # too many, or one of them twice
        problems.append(f"{command}: {error}; it takes {', '.join(offered)}")
        raise Refused("\n".join(problems)) from None
    context = args[0] if args else None
    given = bound.arguments
    needed = [n for n, p in parameters.items() if p.default is p.empty]
    missing = [n for n in needed if n not in {*given, *more}]
    if missing:
        problems.append(f"{command}: {', '.join(missing)} must be given")
    for one in [n for n in given if n in validators]:
        many = parameters[one].kind is inspect.Parameter.VAR_POSITIONAL
        validator = listOf(validators[one], 0) if many else validators[one]
        try:
            found = validator(given[one], context)
            given[one] = tuple(found) if many else found
        except ValueError as error:
            problems.append(f"{command}: {one} {error}")
    refuse(problems)
    return bound.args, bound.kwargs
