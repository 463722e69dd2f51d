# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs YADE's own yade-batch without its HTTP server: ``python3 -P -m masonry.study.yadebatch /usr/bin/yade-batch ...``

yade-batch serves a page, with an unauthenticated stop of every job, on all interfaces, and has no option against that. Here
it finds no port for it and goes on without. It also looks every half second only whether a core is free, which for runs of
some seconds is much; here it looks twenty times a second. When its caller is gone, all its jobs are asked to stop.
"""

import http.server
import os
import signal
import sys
import threading
import time

LOOK_EVERY = 0.05  # [s]


class Closed:
    """Stands for the server: there is no port."""

    def __init__(self, address, handler):
        raise OSError("no port is opened")


def watch(caller):
    """Stop all jobs when the caller is gone: they are in the group of this process."""
    while os.getppid() == caller:
        pause(0.5)
    os.killpg(0, signal.SIGTERM)


pause = time.sleep

if __name__ == "__main__":
    setattr(http.server, "HTTPServer", Closed)
    time.sleep = lambda seconds: pause(min(seconds, LOOK_EVERY))
    threading.Thread(target=watch, args=[os.getppid()], daemon=True).start()
    sys.argv = sys.argv[1:]
    with open(sys.argv[0], encoding="utf-8") as f:
        code = compile(f.read(), sys.argv[0], "exec")
    exec(code, globals())  # YADE wants to find its names in the main module
