# SPDX-License-Identifier: GPL-2.0-or-later
"""What numerical libraries take of the memory, which a limit of the system (``ulimit -v``) can
refuse; and Python's search for unused objects, which is stopped while many are made."""

import contextlib
import gc
import mmap
from typing import Iterator

#: Bytes that numerical libraries must be able to take at once: OpenBLAS takes a buffer of 128 MB
#: with its first product of matrices, of which it uses little. Where it gets none it asks for it
#: again without end.
BUFFER = 160 << 20
#: What is said when there is too little.
FULL = (
    "there is too little memory for this run: a larger limit (ulimit -v) or a smaller scene helps"
)
LARGE = 128  # rows of matrices for whose product the buffer is taken in any case


def reserve():
    """Let numerical libraries take what they need, so that a limit is found at once and not in the
    middle of a run.

    :raises MemoryError: if they cannot; they would try for ever
    """
    try:
        mmap.mmap(-1, BUFFER).close()
    except OSError:
        raise MemoryError(FULL) from None
    import numpy as np

    one = np.ones((LARGE, LARGE))
    one @ (one + one)


@contextlib.contextmanager
def withoutCollector() -> Iterator[None]:
    """Let Python look for unused circles of objects only when a block is over. It may decorate a
    function, too.

    Each look goes through all objects of YADE and numpy. A block that makes many thousands of
    records starts dozens of looks, which find nothing and take half of its time.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
