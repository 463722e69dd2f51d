# SPDX-License-Identifier: GPL-2.0-or-later
"""What numerical libraries take of the memory, which a limit of the system (``ulimit -v``) can
refuse."""

import mmap

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
