# SPDX-License-Identifier: GPL-2.0-or-later
"""Checkpoints: the state of a scene on disk, from which a run goes on as if it had never stopped.

:func:`saveCheckpoint` and :func:`loadCheckpoint` serve any scene. A run in stages leaves its
checkpoints by them; :mod:`masonry.run.run_state` is what such a checkpoint tells of the run.
"""

import contextlib
import json
import os
from typing import Any

from .._masonry import loadScene, saveScene, savedText
from ..arguments import FilePath, shown, validated
from ..folders import replaced
from ..numbers.files import readWhole

NAME = "run.checkpoint"  # in the folder of a run
LARGEST = 1e100  # no number of a run is beyond; its square can be computed


@validated
def saveCheckpoint(path: FilePath, extra: Any = None) -> None:
    """Save the state of the scene in a file, so that :func:`loadCheckpoint` goes on from it bit for
    bit.

    Saved are the time, the bodies, the joints, and the engines of this plugin. Other engines, for
    example a PyRunner, stay as the script makes them. The new file is written beside the old one,
    brought to the disk, and renamed: a kill or a full disk at any moment leaves one of the two,
    whole.

    :param path: file to write; ``path + ".new"`` is beside it for a moment
    :param extra: what your script must know to go on: anything that JSON can hold
    :raises ValueError: if a number of the state is not finite; nothing is written then
    :raises OSError: if the file cannot be written, or one of both is a symbolic link; the old one
        stays
    """
    try:
        kept = json.dumps(extra, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(
            f"saveCheckpoint: extra {shown(extra)} must be what JSON can hold: {error}"
        ) from None
    data = saveScene(kept)
    with replaced(path, "wb") as f:
        f.write(data)
    folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


@validated
def loadCheckpoint(path: FilePath) -> Any:
    """Give the scene, built by the same script with the same parameters, the state of a checkpoint.

    :returns: the ``extra`` of :func:`saveCheckpoint`
    :raises ValueError: if the file is damaged, or of another scene or version; the scene stays as
        it is
    :raises OSError: if it cannot be read
    """
    data, extra = readState(path)  # first, so that a wrong one changes nothing
    with _says(path):
        loadScene(data)
    return extra


@validated
def readCheckpoint(path: FilePath) -> Any:
    """The ``extra`` of a checkpoint alone, of a file that is whole. Raises what
    :func:`loadCheckpoint` raises."""
    return readState(path)[1]


def readState(path: FilePath) -> tuple[bytes, Any]:
    """The bytes of a checkpoint, as ``loadScene`` takes them, and its ``extra``. Raises as
    :func:`readCheckpoint`."""
    with _says(path):
        data = readWhole(path)
        return data, json.loads(savedText(data))


@contextlib.contextmanager
def _says(path):
    """Let every error in the contents of a checkpoint be a ValueError that names the file."""
    try:
        yield
    except MemoryError:
        raise ValueError(f"{path} is too large for the memory") from None
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{path} {error}") from None


def alike(value: Any, example: Any) -> bool:
    """Whether a value that JSON gave is of the kind of another one.

    An int is a counter, from 0 on; a float is any number up to LARGEST; a list or tuple has as many
    values, each of the kind of its counterpart, and an empty one stands for any list; None stands
    for None and for a list of finite numbers.
    """
    if example is None:
        listed = isinstance(value, list)
        return value is None or listed and alike(value, [0.0] * len(value))
    if isinstance(example, (list, tuple)):
        fits = lambda: len(value) == len(example) and all(map(alike, value, example))
        return isinstance(value, list) and (not example or fits())
    if isinstance(example, (bool, str, dict)):
        return isinstance(value, type(example))
    if isinstance(example, int):
        return type(value) is int and 0 <= value < 2**63
    return type(value) in (int, float) and abs(value) <= LARGEST
