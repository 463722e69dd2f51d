# SPDX-License-Identifier: GPL-2.0-or-later
"""A program that solves linear programmes for :mod:`masonry.limit.worker`, in a process of its own that can be ended.

It imports nothing of the package, so that it starts in a tenth of a second. It reads programmes from its standard input
and writes the answers to its standard output, one after the other, until the input ends. A programme is a line of
:data:`HEAD` and its arrays, column by column as Clp takes them; an answer is a line of a word, a number of bytes and a
text, and, after the word ``solved``, the variables and the multipliers of the rows that are equations.

Clp solves them, by its interior-point method, or HiGHS where the library of Clp is missing.
"""

import array
import ctypes
import mmap
import signal
import site
import sys

HEAD = "rows equations columns entries seconds".split()
INTS = 2  # the number of arrays of 32-bit integers, which come before the other arrays of a programme
INTERIOR_POINT = 4  # the number of this method in ClpSolve.hpp of Clp
NO_PRESOLVE = 1  # the number of the choice not to presolve in ClpSolve.hpp of Clp
FOREVER = 1e9  # a limit of time that Clp never reaches [s]
MISSED = 1e-7  # largest error of a row in a solution
STOPPED = 3  # the status of Clp when it has reached its limit of time
SIMPLEX = 1500  # number of variables from which on HiGHS uses its interior-point method
PARENT_ENDS = 1  # PR_SET_PDEATHSIG of Linux


def sizes(rows, columns, entries):
    """Numbers of the arrays of a programme: where columns begin, rows of the entries, the entries, limits and costs of the
    columns, limits of the rows."""
    return [columns + 1, entries, entries, columns, columns, columns, rows, rows]


def withClp(clp, head, arrays):
    """Solve a programme with the library of Clp. Returns the word of the answer, a text, and the bytes."""
    rows, equations, columns = (head[name] for name in HEAD[:3])
    numbers = ctypes.POINTER(ctypes.c_double)
    clp.Clp_newModel.restype = clp.ClpSolve_new.restype = ctypes.c_void_p
    for name in ("Clp_primalColumnSolution", "Clp_primalRowSolution", "Clp_dualRowSolution"):  # fmt: skip
        getattr(clp, name).restype = numbers
    model = ctypes.c_void_p(clp.Clp_newModel())
    try:
        clp.Clp_setLogLevel(model, 0)
        seconds = min(head["seconds"], FOREVER)
        clp.Clp_setMaximumSeconds(model, ctypes.c_double(seconds))
        places = [ctypes.c_void_p(one.buffer_info()[0]) for one in arrays]
        clp.Clp_loadProblem(model, columns, rows, *places)
        how = ctypes.c_void_p(clp.ClpSolve_new())
        clp.ClpSolve_setSolveType(how, INTERIOR_POINT, -1)
        clp.ClpSolve_setPresolveType(how, NO_PRESOLVE, -1)
        clp.Clp_initialSolveWithOptions(model, how)
        clp.ClpSolve_delete(how)
        if not clp.Clp_status(model):
            # Without its scaling, the solution may miss rows by more than the tolerance. The simplex method mends that.
            found = clp.Clp_primalRowSolution(model)[:rows]
            if any(not a - MISSED <= v <= b + MISSED for a, v, b in zip(arrays[-2], found, arrays[-1])):  # fmt: skip
                clp.Clp_scaling(model, 0)
                clp.Clp_setPrimalTolerance(model, ctypes.c_double(0.01 * MISSED))
                clp.Clp_primal(model, 0)
        status = clp.Clp_status(model)
        if status == STOPPED:
            return "late", "", b""
        if status:
            said = {1: "it has no solution", 2: "it has no end"}
            text = said.get(status, f"Clp ended with status {status}")
            return "unsolved", text, b""
        values = ctypes.string_at(clp.Clp_primalColumnSolution(model), 8 * columns)
        duals = ctypes.string_at(clp.Clp_dualRowSolution(model), 8 * equations)
        return "solved", "", values + duals
    finally:
        clp.Clp_deleteModel(model)


def withHighs(head, arrays):
    """Solve a programme with HiGHS. Returns as :func:`withClp`."""
    site.main()  # where the packages are; without it the program starts sooner
    import numpy as np
    from scipy.optimize import linprog
    from scipy.sparse import csc_matrix

    starts, rows, entries, low, high, cost, _, limits = map(np.array, arrays)
    equations, columns = head["equations"], head["columns"]
    whole = csc_matrix((entries, rows, starts), (head["rows"], columns)).tocsr()
    unequal = whole[equations:] if head["rows"] > equations else None
    found = linprog(
        cost,
        A_eq=whole[:equations],
        b_eq=limits[:equations],
        A_ub=unequal,
        b_ub=None if unequal is None else limits[equations:],
        bounds=np.column_stack([low, high]),
        method="highs-ds" if columns < SIMPLEX else "highs-ipm",
        options={"time_limit": head["seconds"]},
    )
    if found.status == 1:
        return "late", "", b""
    if found.status:
        return "unsolved", found.message.strip(), b""
    return "solved", "", found.x.tobytes() + found.eqlin.marginals.tobytes()


def answer(clp, buffer, line, stream):
    """Read the programme whose first line this is, and solve it. Returns as :func:`withClp`."""
    words = line.split()
    head = dict(zip(HEAD, [*map(int, words[:-1]), float(words[-1])]))
    arrays = []
    for size in sizes(head["rows"], head["columns"], head["entries"]):
        one = array.array("i" if len(arrays) < INTS else "d")
        one.frombytes(_read(stream, size * one.itemsize))
        arrays.append(one)
    mmap.mmap(-1, buffer).close()  # refused where there is too little memory
    return withClp(clp, head, arrays) if clp else withHighs(head, arrays)


def _read(stream, size):
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return data


def main(library, buffer):
    """Solve what comes, until the input ends.

    :param library: name of the library of Clp
    :param buffer: bytes that numerical libraries must be able to take at once
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the run hears it, and ends this
    ctypes.CDLL(None).prctl(PARENT_ENDS, signal.SIGKILL, 0, 0, 0)
    try:
        clp = ctypes.CDLL(library)
    except OSError:
        clp = None
    while line := sys.stdin.buffer.readline():
        try:
            word, text, data = answer(clp, buffer, line, sys.stdin.buffer)
        except EOFError:
            return
        except (MemoryError, ImportError, OSError) as error:
            reason = "there is too little memory for it"
            word, data = "failed", b""
            text = str(error) if isinstance(error, ModuleNotFoundError) else reason
        text = " ".join(text.split())
        sys.stdout.buffer.write(f"{word} {len(data)} {text}\n".encode() + data)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
