# SPDX-License-Identifier: GPL-2.0-or-later
"""How many threads steps use: as many as there are cores, at most four, or as many as ``yade -j2``
or ``OMP_NUM_THREADS`` says, where they are quicker.

The plugin measures steps on one thread and on more, and takes the quicker number: small scenes and
busy machines gain nothing by threads. The numbers of a run do not depend on it, to the last bit.
"""

import contextlib
import ctypes
import os
import re

from .._masonry import allowThreads
from .._masonry import threads as records

#: Whether every step uses all threads, for tests and benchmarks.
ALWAYS = os.environ.get("MASONRY_THREADS") == "always"

MAX_THREADS = 4  # unless the user says another number

_allowed = _ofYade = 1
_asked = False


def _isAsked():
    """Whether the user says how many threads, by an option of ``yade`` or by ``OMP_NUM_THREADS`` in
    the first environment of the process: without the option ``yade`` sets that variable to 1."""
    with open("/proc/self/cmdline", "rb") as words, open("/proc/self/environ", "rb") as names:
        options = words.read().partition(b"\0-x\0")[0]
        return bool(
            re.search(rb"\0(-\w*j|--thr|--cor)", options)
            or re.search(rb"(^|\0)OMP_NUM_THREADS=", names.read())
        )


def limit(count=0):
    """Give steps their threads, and YADE's own engines one if the user says nothing. ``import
    masonry`` does this.

    :param count: of threads; 0: as the user says

    In plain Python OpenMP takes all cores, whose threads wait by spinning: on a busy machine a step
    then takes hundreds of times as long.
    """
    global _allowed, _ofYade, _asked
    with contextlib.suppress(AttributeError):  # a YADE without OpenMP
        openmp = ctypes.CDLL(None)
        if count or "OMP_NUM_THREADS" not in os.environ:
            openmp.omp_set_num_threads(count or 1)
        _ofYade = openmp.omp_get_max_threads()
    _asked = bool(count) or _isAsked()
    _allowed = _ofYade if _asked else min(MAX_THREADS, len(os.sched_getaffinity(0)))
    allowThreads(_allowed, ALWAYS)


def allowed():
    """The largest number of threads that steps may use."""
    return _allowed


def ofYade():
    """The number of threads of YADE's own engines, on which the last digits of forces depend."""
    return _ofYade


def beginScene(host):
    """Count steps by threads anew before ``O.reset()``.

    :param host: whether YADE's own engines may use several threads: for each of them YADE has a
        column of forces, which it sums in every step
    """
    with contextlib.suppress(AttributeError):
        ctypes.CDLL(None).omp_set_num_threads(_ofYade if host else 1)
    allowThreads(_allowed, ALWAYS)


def used():
    """Steps on each number of threads; ``microseconds_per_step`` is the mean time of their loops
    over joints and bodies."""
    return [
        {
            "threads": r["threads"],
            "steps": r["steps"],
            "microseconds_per_step": 1e6 * r["time"] / r["steps"] if r["steps"] else None,
        }
        for r in records()
    ]


def remark():
    """A sentence if the user allows more threads than most steps used, else None."""
    each = [r for r in used() if r["steps"]]
    taken = sum(r["steps"] for r in each)
    if not _asked or _allowed == 1 or not taken:
        return None
    most = max(each, key=lambda r: r["steps"])
    if most["threads"] == _allowed or most["steps"] < 0.5 * taken:
        return None
    each.remove(most)
    others = [f"{r['microseconds_per_step']:.0f} µs on {r['threads']}" for r in each]
    return (
        f"{_allowed} threads were allowed, and {100 * most['steps'] / taken:.0f} % of the steps"
        f" used {most['threads']}, which was quicker: a step took"
        f" {most['microseconds_per_step']:.0f} µs"
        + (f", and {', '.join(others)}" if others else "")
    )
