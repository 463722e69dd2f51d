# SPDX-License-Identifier: GPL-2.0-or-later
"""The folder of a run belongs to one run at a time: its lock, and which files are those of a run.
This module needs no YADE."""

import contextlib
import errno
import fcntl
import json
import os
import re
import socket

from .. import folders
from ..errors import FolderLocked
from ..numbers.files import readWhole

#: Files that a run writes, and those that are drawn of it; * is a number.
FILES = (
    "curve.csv curve.png cracks.png run.json report.html run.checkpoint shakes.csv travel.csv "
    "piers.csv errors.log view.html capacity.json capacity.png domain.json domain.png blocks.pvd "
    "joints.pvd connectors.pvd mechanism.json mechanism.png mechanism_blocks.vtu "
    "mechanism_joints.vtu blocks_*.vtu joints_*.vtp connectors_*.vtp"
).split()
#: Those of them that show how far a run has come: they go when it goes on.
DRAWN = {"curve.png", "cracks.png", "report.html"}
OUR_FILES = re.compile(
    "(%s)(\\.new)?" % "|".join(re.escape(f).replace(r"\*", r"\d+") for f in FILES)
)
LOCK = "run.lock"  # in the folder of a run while it goes on, and after it was killed
NO_LOCKS = {errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS}  # of the file system


class Lock:
    """Keeps a folder for one run. The system takes the lock from a process that ends in any way.

    The file ``run.lock`` says who holds it. After a kill it stays, and says that the files beside
    it are those of a run. Where the file system has no locks, its text alone counts.

    :raises FolderLocked: if another run holds the folder; the message names its host and process
    :raises OSError: if the folder cannot be written
    """

    _held = {}  # by this process: file by path

    def __init__(self, directory, scene):
        self.path = os.path.join(os.path.realpath(directory), LOCK)
        # A scene of this process that did not finish is gone: YADE has one at a time.
        if self.path in Lock._held:
            Lock._held[self.path].release()
        self._file = self._open()
        try:
            #: whether the files in the folder are those of a run: it was killed, or it is this one
            self.ours = bool(self._file.read())
            record = dict(scene=scene, host=socket.gethostname(), process=os.getpid())
            self._file.seek(0)
            self._file.truncate()
            self._file.write(json.dumps(record).encode())
            self._file.flush()
        except BaseException:
            self._file.close()
            raise
        Lock._held[self.path] = self

    def _open(self):
        """The file, locked; a new one, if another run has removed it between two of our calls."""
        while True:
            how = os.O_RDWR | os.O_CREAT
            file = open(folders.inside(self.path, how), "r+b", buffering=0)
            try:
                try:
                    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    self._refuse(_object(file.read()))
                except OSError as error:
                    if error.errno not in NO_LOCKS:
                        raise
                    # then the text alone counts, if the run that wrote it may be alive
                    record = _object(file.read())
                    if record and not _isGone(record):
                        self._refuse(record)
                    file.seek(0)
                with contextlib.suppress(FileNotFoundError):
                    if os.path.samestat(os.fstat(file.fileno()), os.stat(self.path)):
                        return file
            except BaseException:
                file.close()
                raise
            file.close()

    def _refuse(self, record):
        who = "another run"
        if record:
            known = {"scene": "?", "host": "?", "process": "?", **record}
            who = "a run of {scene} on host {host}, process {process},".format(**known)
        raise FolderLocked(
            f"{who} is writing to {os.path.dirname(self.path)}: wait for its end, or name another"
            f" folder with --out; if it is gone, remove {LOCK} there"
        )

    @classmethod
    def forget(cls):
        """Let go of all locks in a copy of the process; the process itself keeps them."""
        for lock in cls._held.values():
            lock._file.close()
        cls._held.clear()

    def release(self):
        """Let others have the folder. The file goes, unless it must say whose the others are."""
        if Lock._held.get(self.path) is self:
            del Lock._held[self.path]
        if self._file.closed:
            return
        folder = os.path.dirname(self.path)
        with contextlib.suppress(OSError):
            names = [name for name in os.listdir(folder) if OUR_FILES.fullmatch(name)]
            if not (self.ours and names) or recorded(folder):
                os.remove(self.path)
        self._file.close()


os.register_at_fork(after_in_child=Lock.forget)


def isLocked(directory):
    """Whether a run is writing to a folder now, as far as its lock tells."""
    try:
        file = open(os.path.join(directory, LOCK), "rb", opener=folders.inside)
    except OSError:
        return False
    with file:
        record = _object(file.read())
        if _isGone(record):
            return (
                False  # a lock that is tried for a moment would be in the way of a run that begins
            )
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            return bool(record)
        return False


def _isGone(record):
    """Whether the process that a lock names was one of this host, and is over."""
    process = f"/proc/{record.get('process')}"
    return record.get("host") == socket.gethostname() and not os.path.exists(process)


def _object(data):
    try:
        record = json.loads(data)
    except ValueError:
        record = None
    return record if isinstance(record, dict) else {}


def recorded(directory):
    """run.json of a folder, if a run of ours left it; else an empty dict."""
    try:
        record = _object(readWhole(os.path.join(directory, "run.json")))
    except OSError:
        return {}
    ours = isinstance(record.get("columns"), dict) and "scene" in record
    return record if ours else {}
