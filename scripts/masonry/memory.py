# SPDX-License-Identifier: GPL-2.0-or-later
"""Memory of numerical libraries under a limit of the system (``ulimit -v``), and Python's search
for unused objects."""

import contextlib
import gc
import mmap
from typing import Iterator

#: Bytes that must be free: OpenBLAS takes 128 MB with its first product of matrices, and asks for
#: them without end where it gets none.
BUFFER = 160 << 20
FULL = (
    "there is too little memory for this run: a larger limit (ulimit -v) or a smaller scene helps"
)
LARGE = 128  # rows of matrices whose product takes the buffer


def reserve():
    """Let numerical libraries take their buffer now, not in the middle of a run. Raises
    MemoryError."""
    try:
        mmap.mmap(-1, BUFFER).close()
    except OSError:
        raise MemoryError(FULL) from None
    import numpy as np

    one = np.ones((LARGE, LARGE))
    one @ (one + one)


@contextlib.contextmanager
def withoutCollector() -> Iterator[None]:
    """Stop Python's search for unused circles of objects during a block, or a function that this
    decorates. Where many thousands of records are made it takes half of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
