# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that a script names in stages to come: they are read before the first step, so that hours
of other stages are not lost on one that cannot be read.

Nothing of the script is carried out for this. Its text is searched for calls of :data:`READERS`
whose arguments are constants, or names that the script gives a value once, and has given it.
"""

import ast
import collections
import inspect
import os
import sys
from typing import Any

from ..errors import Refused
from ..numbers.files import readText
from ..terminal import say
from .push import follow, readableHistory
from .shake import readable, readableAll, shake, shakeAgain

PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
#: Commands with files, and the function that reads these, which takes the same arguments.
READERS: dict[str, tuple[Any, Any]] = {
    "shake": (shake, readable),
    "shakeAgain": (shakeAgain, readableAll),
    "follow": (follow, readableHistory),
}


def lookAhead(scene: Any) -> None:
    """Raise Refused for a file that cannot be read, and warn of one that is not there yet."""
    frame = sys._getframe()
    while frame.f_back and frame.f_code.co_filename.startswith(PACKAGE):
        frame = frame.f_back
    try:
        tree = ast.parse(readText(frame.f_code.co_filename))
    except (OSError, SyntaxError, ValueError):
        return  # of no file
    nodes = [*ast.walk(tree)]
    names = [n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)]
    once = {name for name, count in collections.Counter(names).items() if count == 1}
    values = {n: v for n, v in {**frame.f_globals, **frame.f_locals}.items() if n in once}
    for call in nodes:
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute)):
            continue
        if call.func.attr not in READERS or call.lineno < frame.f_lineno:
            continue
        command, read = READERS[call.func.attr]
        try:
            args = [_valueOf(node, values) for node in call.args]
            settings = {one.arg or "": _valueOf(one.value, values) for one in call.keywords}
            inspect.signature(command).bind(scene, *args, **settings)
        except (LookupError, TypeError):
            continue  # known when the script comes there
        _read(scene, call, read, args, settings)


def _read(scene, call, read, args, settings):
    named = ("accelerations", "records", "path")
    files = {*_texts([args[:2], [v for n, v in settings.items() if n in named]])}
    missing = sorted(path for path in files if not os.path.exists(path))
    if missing:
        say(
            f"warning: line {call.lineno}: {call.func.attr}: {', '.join(missing)}: no such file yet"
        )
    elif files:
        try:
            read(scene, *args, **settings)
        except ValueError as refused:
            raise Refused(f"line {call.lineno}: {refused}") from None


def _texts(value):
    """The texts in nested lists."""
    if isinstance(value, (list, tuple)):
        for one in value:
            yield from _texts(one)
    elif isinstance(value, (str, os.PathLike)):
        yield os.fspath(value)


def _valueOf(node, values):
    """The value of an argument. Raises LookupError if it is not known."""
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, (ast.List, ast.Tuple)):
        return [_valueOf(one, values) for one in node.elts]
    if isinstance(node, ast.Name):
        return values[node.id]
    raise LookupError
