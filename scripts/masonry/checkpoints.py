"""Checkpoints: the state of a scene on disk, from which a run goes on as if it had never stopped.

:func:`saveCheckpoint` and :func:`loadCheckpoint` serve any scene. A run in stages leaves its checkpoints by them, and
:func:`readProgress` reads what such a checkpoint tells of the run.
"""

import json
import os

from ._masonry import loadScene, savedText, saveScene
from .errors import Refused

NAME = "run.checkpoint"  # in the folder of a run


def saveCheckpoint(path, extra=None):
    """Save the state of the scene in a file, so that :func:`loadCheckpoint` goes on from it bit for bit.

    Saved are the time, the bodies, the joints, and the engines of this plugin. Other engines, for example a PyRunner,
    stay as the script makes them. The new file is written beside the old one, brought to the disk, and renamed: a kill
    or a full disk at any moment leaves one of the two, whole.

    :param path: file to write; ``path + ".new"`` is beside it for a moment
    :param extra: what your script must know to go on: anything that JSON can hold
    :raises ValueError: if a number of the state is not finite; nothing is written then
    :raises OSError: if the file cannot be written; the old one stays
    """
    data = saveScene(json.dumps(extra, allow_nan=False))
    beside = path + ".new"
    try:
        with open(beside, "wb") as f:
            f.write(data)
            f.flush()
            os.fsync(f.fileno())
        os.replace(beside, path)
    except OSError:
        if os.path.lexists(beside):
            os.remove(beside)
        raise
    folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def loadCheckpoint(path):
    """Give the scene, built by the same script with the same parameters, the state of a checkpoint.

    :returns: the ``extra`` of :func:`saveCheckpoint`
    :raises ValueError: if the file is damaged, or of another scene or version; the scene stays as it is
    :raises OSError: if it cannot be read
    """
    return _read(path, loadScene)


def readCheckpoint(path):
    """The ``extra`` of a checkpoint alone, of a file that is whole. Raises what :func:`loadCheckpoint` raises."""
    return _read(path, savedText)


def _read(path, textOf):
    with open(path, "rb") as f:
        data = f.read()
    try:
        return json.loads(textOf(data))
    except ValueError as error:
        raise ValueError(f"{path} {error}") from None


def readProgress(directory):
    """What the checkpoint in the folder of a run tells of it.

    It is a dict: ``scene``, the name; ``options``; ``at``, how far the run has come; ``rows`` of curve.csv;
    ``seconds`` of wall-clock time; ``build``, ``YADE`` and ``threads`` that the checkpoint was made with.

    :raises Refused: if no run can be taken up there
    """
    path = os.path.join(directory, NAME)
    try:
        told = readCheckpoint(path)
    except (OSError, ValueError) as error:
        raise Refused(f"--resume: {error}") from None
    known = dict(scene=str, options=dict, at=dict, rows=list, seconds=float)
    if not isinstance(told, dict) or any(
        not isinstance(told.get(key), kind) for key, kind in known.items()
    ):
        raise Refused(f"--resume: {path} was not left by a run in stages")
    return told
