# SPDX-License-Identifier: GPL-2.0-or-later
"""Folders that may come from others, as results, studies and checkpoints: nothing is written
through a symbolic link in them.

Files there are written by :func:`inside` or :func:`replaced` alone, after :func:`check` has refused
the links of a folder. ``scripts/SHARING.md`` says what may be shared.
"""

import contextlib
import errno
import os

from .errors import Unwritable, refuse

MAX_NAMES = 5  # of links in a message


def check(*folders):
    """Refuse folders that hold symbolic links, all at once; a folder itself may be a link, or
    missing. Raises OSError if one cannot be listed."""
    problems = []
    for folder in folders:
        names = []
        with contextlib.suppress(FileNotFoundError), os.scandir(folder) as entries:
            names = sorted(f"{e.name}, a symbolic link" for e in entries if e.is_symlink())
        if names:
            named = ", ".join(names[:MAX_NAMES]) + " and more" * (len(names) > MAX_NAMES)
            problems.append(
                f"{folder} holds {named}: nothing is written where a name can lead elsewhere;"
                " remove these, or name another folder"
            )
    refuse(problems)


def inside(path, flags):
    """The ``opener`` of Python's ``open`` for such a file. Raises OSError, also for a symbolic
    link."""
    try:
        return os.open(path, flags | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    except OSError as error:
        if error.errno != errno.ELOOP:
            raise
        raise OSError(error.errno, "it is a symbolic link", path) from None


@contextlib.contextmanager
def replaced(path, mode="w", **settings):
    """A file to write, ``path + ".new"``, which replaces ``path`` when it is whole and on the disk,
    and is removed after an error. Parameters as in Python's ``open``.

    :raises OSError: if it cannot be written, or if ``path`` is a symbolic link
    """
    path = os.fspath(path)
    temporary = path + ".new"
    if os.path.islink(path):
        raise OSError(errno.ELOOP, "it is a symbolic link", path)
    with open(temporary, mode, opener=inside, **settings) as file:
        try:
            yield file
            file.flush()
            os.fsync(file.fileno())
            os.replace(temporary, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.remove(temporary)
            raise


@contextlib.contextmanager
def writing(what):
    """Turn an OSError of a block into :class:`masonry.errors.Unwritable`.

    :param what: is written: the path of a file, or ``to FOLDER``
    """
    try:
        yield
    except OSError as error:
        raise Unwritable(f"cannot write {what}: {error.strerror}") from None
