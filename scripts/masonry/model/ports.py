# SPDX-License-Identifier: GPL-2.0-or-later
"""The ports that the program ``yade`` opens when it starts: a Python prompt, whose short password
stands in the log, and XML-RPC without a password. Both listen on every address of the machine."""

import gc
import socket
import socketserver
import sys
import threading


def close():
    """Close both. Importing :mod:`masonry` does this; ``yade.remote.runServers()`` opens them
    again."""
    remote = sys.modules.get("yade.remote")
    if not remote:
        return
    for server in [o for o in gc.get_objects() if _isOpen(o, remote)]:
        ends = threading.Thread(target=server.shutdown)
        try:
            ends.start()
        except RuntimeError:  # a limit of the system: no further thread
            server.shutdown()  # takes half a second
        else:
            # wake it
            server.socket.shutdown(socket.SHUT_RDWR)
            ends.join()
        server.server_close()


def _isOpen(thing, remote):
    """Whether an object is one of YADE's servers, and listens."""
    if not issubclass(type(thing), socketserver.TCPServer):
        return False
    ours = (
        thing.RequestHandlerClass is remote.PythonConsoleSocketEmulator
        or type(getattr(thing, "instance", None)) is remote.InfoProvider
    )
    return ours and thing.socket.fileno() >= 0
