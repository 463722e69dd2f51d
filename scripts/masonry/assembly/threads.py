# SPDX-License-Identifier: GPL-2.0-or-later
"""How many threads YADE has in plain Python."""

import contextlib
import ctypes
import os


def limit():
    """Give YADE one thread if nobody has said how many. Importing :mod:`masonry` does this.

    The program ``yade`` sets ``OMP_NUM_THREADS``, 1 by default. After ``import yade`` in plain Python it is not set, and OpenMP
    takes all cores, whose threads wait by spinning: on a busy machine a step then takes hundreds of times as long.
    """
    if "OMP_NUM_THREADS" not in os.environ:
        with contextlib.suppress(AttributeError):  # a YADE without OpenMP
            ctypes.CDLL(None).omp_set_num_threads(1)
