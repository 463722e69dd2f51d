# SPDX-License-Identifier: GPL-2.0-or-later
"""Solves linear programmes by the interior-point method of Clp.

A solver cannot be interrupted from Python while it works. So a copy of this process does it, which
can be ended at any moment: by Ctrl-C or SIGTERM, when its time is over, and when it fails.

HiGHS, which scipy has, takes 4 to 6 times as long for a wall in its plane with 1,000 to 3,000
joints, and more than 25 times as long in space, where forces can be shared in many ways among many
points: its way to a corner of the solution takes most of the time.
"""

import ctypes

import numpy as np

from masonry.background import Failed, Task
from masonry.errors import Refused

LIBRARY = "libClp.so.1"
INTERIOR_POINT, NO_PRESOLVE = 4, 1  # numbers of these choices in ClpSolve.hpp of Clp
ROW_TOLERANCE = 1e-7  # largest error of a row in a solution
STOPPED = 3  # the status of Clp when it has reached its time limit
LONGEST = 1e9  # time limit that Clp takes [s]
GRACE = 1.0  # time between the end of the solver's own limit and that of its process [s]


class Unsolved(Exception):
    """The programme has no solution, or none was found; the text says what the solver says."""


class SolverTimeout(Unsolved):
    """The time of the solver is over."""


def solve(whole, limits, seconds):
    """Solve a linear programme in a copy of the process.

    :param whole: its matrix (csc)
    :param limits: least and largest value of each variable, what is made as small as possible, and
        the same two of each row
    :returns: the variables, and the multipliers of the rows
    :raises Unsolved:
    :raises Refused: if Clp is missing, or its process has failed
    """
    seconds = min(seconds, LONGEST)
    task = Task(lambda: [_solved(whole, limits, seconds)])
    try:
        if not task.ready(seconds=seconds + GRACE):
            raise SolverTimeout
        return task.result()
    except Failed as failed:
        raise Refused(f"limit analysis: of its solver, {failed}") from None
    finally:
        task.end()


def _solved(whole, limits, seconds):
    try:
        clp = ctypes.CDLL(LIBRARY)
    except OSError:
        raise Refused(
            f"limit analysis needs {LIBRARY}, which is not installed: apt-get install"
            " --no-install-recommends coinor-libclp1"
        ) from None
    clp.Clp_newModel.restype = clp.ClpSolve_new.restype = ctypes.c_void_p
    count, columns = whole.shape
    arrays = [np.ascontiguousarray(a, np.int32) for a in (whole.indptr, whole.indices)]
    arrays += [np.ascontiguousarray(a, np.float64) for a in (whole.data, *limits)]
    model = ctypes.c_void_p(clp.Clp_newModel())
    clp.Clp_setLogLevel(model, 0)
    clp.Clp_setMaximumSeconds(model, ctypes.c_double(seconds))
    places = [ctypes.c_void_p(one.ctypes.data) for one in arrays]
    clp.Clp_loadProblem(model, columns, count, *places)
    how = ctypes.c_void_p(clp.ClpSolve_new())
    clp.ClpSolve_setSolveType(how, INTERIOR_POINT, -1)
    clp.ClpSolve_setPresolveType(how, NO_PRESOLVE, -1)
    clp.Clp_initialSolveWithOptions(model, how)

    def values(name, size):
        find = getattr(clp, name)
        find.restype = ctypes.POINTER(ctypes.c_double)
        return np.array(find(model)[:size])

    if not clp.Clp_status(model):
        # Without its scaling, the solution may miss rows by more than the tolerance. The simplex
        # method mends that.
        found = values("Clp_primalRowSolution", count)
        if not (
            (arrays[-2] - ROW_TOLERANCE <= found) & (found <= arrays[-1] + ROW_TOLERANCE)
        ).all():
            clp.Clp_scaling(model, 0)
            clp.Clp_setPrimalTolerance(model, ctypes.c_double(0.01 * ROW_TOLERANCE))
            clp.Clp_primal(model, 0)
    status = clp.Clp_status(model)
    if status == STOPPED:
        raise SolverTimeout
    if status:
        reasons = {1: "it has no solution", 2: "it has no end"}
        raise Unsolved(reasons.get(status, f"Clp ended with status {status}"))
    return values("Clp_primalColumnSolution", columns), values("Clp_dualRowSolution", count)
