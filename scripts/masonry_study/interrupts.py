# SPDX-License-Identifier: GPL-2.0-or-later
"""Ctrl-C while OpenTURNS works: every call of it installs a handler of its own, which aborts the
process.

So the signal is blocked while OpenTURNS can be at work, a thread takes it, and the process ends in
order; nothing is being written then. A program calls :func:`block` before it imports NumPy, whose
threads would else take the signal, and :func:`unblock` when OpenTURNS is over.
"""

import contextlib
import os
import signal
import sys
import threading

from masonry.terminal import say

STATUS = 130  # exit status after Ctrl-C
CTRL_C = {signal.SIGINT}


def block():
    """Let Ctrl-C wait until :func:`unblock` or :func:`watched`."""
    signal.pthread_sigmask(signal.SIG_BLOCK, CTRL_C)


def unblock(handler=signal.default_int_handler):
    """Let Ctrl-C be a KeyboardInterrupt again, also one that came since :func:`block`."""
    signal.signal(signal.SIGINT, handler)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, CTRL_C)


@contextlib.contextmanager
def watched(text):
    """End the process in order at Ctrl-C in the block, with a text and exit status 130. Other
    threads than the main one have no handlers: there nothing is changed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before, over = signal.getsignal(signal.SIGINT), threading.Event()
    block()
    watcher = threading.Thread(target=_watch, args=[text, over], daemon=True)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        signal.pthread_kill(watcher.ident, signal.SIGINT)  # wakes it
        watcher.join()
        unblock(before)


def _watch(text, over):
    signal.sigwait(CTRL_C)
    if over.is_set():
        return
    say(text)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(STATUS)
