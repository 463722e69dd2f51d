# SPDX-License-Identifier: GPL-2.0-or-later
"""Folders that others may have packed, as results, studies and checkpoints are: what is written in
them stays in them.

An archive keeps symbolic links. So a file in such a folder is opened for writing by :func:`inside`
or :func:`replaced` alone, which write through no link, and :func:`check` names all links of a
folder before anything is written there. ``scripts/SHARING.md`` says what may be shared.
"""

import contextlib
import errno
import os

from .errors import Unwritable, refuse

MOST = 5  # names that are listed


def check(*folders):
    """Refuse folders that hold symbolic links, all at once. A folder that is missing holds none.

    A folder itself may be reached through a link: its user has named it.

    :raises Refused: if there are any; an OSError if a folder cannot be listed
    """
    problems = []
    for folder in folders:
        names = []
        with contextlib.suppress(FileNotFoundError), os.scandir(folder) as entries:
            names = sorted(f"{e.name}, a symbolic link" for e in entries if e.is_symlink())
        if names:
            named = ", ".join(names[:MOST]) + " and more" * (len(names) > MOST)
            problems.append(
                f"{folder} holds {named}: nothing is written where a name can lead elsewhere;"
                " remove these, or name another folder"
            )
    refuse(problems)


def inside(path, flags):
    """The ``opener`` of Python's ``open`` for a file that is written in such a folder.

    :raises OSError: with the reason; also if the path is a symbolic link
    """
    try:
        return os.open(path, flags | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    except OSError as error:
        if error.errno != errno.ELOOP:
            raise
        raise OSError(error.errno, "it is a symbolic link", path) from None


@contextlib.contextmanager
def replaced(path, mode="w", **settings):
    """A file to write, which takes the place of ``path`` when it is whole and on the disk; else
    ``path`` stays as it is.

    It is ``path + ".new"`` until then, and is removed after an error.

    :param mode: and ``settings``: as in Python's ``open``
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
    """Let an OSError in a block that writes be :class:`masonry.errors.Unwritable`.

    :param what: is written: the path of a file, or ``to FOLDER``
    """
    try:
        yield
    except OSError as error:
        raise Unwritable(f"cannot write {what}: {error.strerror}") from None
