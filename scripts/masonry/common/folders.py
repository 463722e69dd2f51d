# SPDX-License-Identifier: GPL-2.0-or-later
"""Folders that others may have packed: what is written in them stays in them, and what is read from
them is data.

Results, studies and checkpoints are handed on as folders, and an archive keeps symbolic links. A
file in such a folder is opened by :func:`inside` or :func:`replaced` alone, which write through no
link, and :func:`check` names all links of a folder before anything is written there.
``scripts/README.md`` says what may be shared.
"""

import contextlib
import errno
import json
import os
import stat

from ..basics import Unwritable, refuse

MOST = 5  # names that are listed


def check(*folders):
    """Refuse folders that hold symbolic links, pipes or devices, all at once. A folder that is
    missing holds none.

    A folder itself may be reached through a link: its user has named it.

    :raises Refused: if there are any; an OSError if a folder cannot be listed
    """
    problems = []
    for folder in folders:
        names = []
        with contextlib.suppress(FileNotFoundError), os.scandir(folder) as entries:
            for entry in entries:
                if entry.is_symlink():
                    names.append(f"{entry.name}, a symbolic link")
                elif not (entry.is_file() or entry.is_dir()):
                    names.append(f"{entry.name}, no regular file")
        if names:
            named = ", ".join(sorted(names)[:MOST]) + " and more" * (len(names) > MOST)
            problems.append(
                f"{folder} holds {named}: nothing is written where a name can lead elsewhere;"
                " remove these, or name another folder"
            )
    refuse(problems)


def inside(path, flags):
    """The ``opener`` of Python's ``open`` for a file in such a folder: a regular one, because a
    pipe or a device has no end.

    What is written is reached through no symbolic link, and has no second name (a hard link): that
    would change, too.

    :raises OSError: with the reason
    """
    writes = flags & (os.O_WRONLY | os.O_RDWR)
    safe = os.O_NONBLOCK | os.O_CLOEXEC | (os.O_NOFOLLOW if writes else 0)
    try:
        number = os.open(path, flags & ~os.O_TRUNC | safe, 0o666)
    except OSError as error:
        why = {errno.ELOOP: "it is a symbolic link", errno.ENXIO: "it is no regular file"}.get(
            error.errno
        )
        if not why:
            raise
        raise OSError(error.errno, why, path) from None
    found = os.fstat(number)
    wrong = ""
    if writes and found.st_nlink > 1:
        wrong = "it has a second name, a hard link"
    if not stat.S_ISREG(found.st_mode):
        wrong = "it is no regular file"
    if wrong:
        os.close(number)
        raise OSError(errno.EINVAL, wrong, path)
    if flags & os.O_TRUNC:
        os.ftruncate(number, 0)
    return number


@contextlib.contextmanager
def replaced(path, mode="w", **settings):
    """A file to write, which takes the place of ``path`` when it is whole and on the disk; else
    ``path`` stays as it is.

    It is ``path + ".new"`` until then, and is removed after an error.

    :param mode: and ``settings``: as in Python's ``open``
    :raises OSError: if it cannot be written, or if ``path`` is a symbolic link or no regular file
    """
    path = os.fspath(path)
    temporary = path + ".new"
    if os.path.lexists(path) and not stat.S_ISREG(os.lstat(path).st_mode):
        raise OSError(errno.EINVAL, "it is a symbolic link or no regular file", path)
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
    """Let an OSError in a block that writes be :class:`masonry.basics.Unwritable`.

    :param what: is written: the path of a file, or ``to FOLDER``
    """
    try:
        yield
    except OSError as error:
        raise Unwritable(f"cannot write {what}: {error.strerror}") from None


def fromJson(data):
    """The value that a JSON text or its bytes stand for.

    :raises ValueError: if it is not one, also if it is nested too deeply or is no text
    """
    try:
        return json.loads(data)
    except RecursionError:
        raise ValueError("its brackets are nested too deeply") from None
    except MemoryError:
        raise ValueError("it is too large for the memory") from None
