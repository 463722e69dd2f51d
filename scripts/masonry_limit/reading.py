# SPDX-License-Identifier: GPL-2.0-or-later
"""The assembly of the scene that stands in YADE."""

from masonry.model import arrays

from .assembly import Assembly


def read() -> Assembly:
    """The blocks and joints of the scene in YADE, as they stand now: an :class:`Assembly`; see
    :func:`masonry.model.arrays.blocksAndJoints`. Raises Refused if there are no joints."""
    return Assembly(**arrays.blocksAndJoints())
