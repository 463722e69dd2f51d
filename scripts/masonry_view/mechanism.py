# SPDX-License-Identifier: GPL-2.0-or-later
"""mechanism.png: the mechanism of limit analysis that a run has left in mechanism.json."""

import json
import os

import numpy as np
from masonry.errors import Refused
from masonry.numbers import drawing
from masonry.numbers.cracks import CRACK_SURFACE
from masonry.numbers.files import filesOf, readText

from .elevation import figureOf, structureOf

FILE, FIGURE = "mechanism.json", "mechanism.png"
DPI = 90
#: Kinds of joints by their numbers in the file.
KINDS = "", CRACK_SURFACE


def isThere(directory):
    return os.path.exists(os.path.join(directory, FILE))


def draw(directory):
    """Draw the mechanism in the style of the crack figure. Raises Refused."""
    path = os.path.join(directory, FILE)
    try:
        found = {"kinds": KINDS, **json.loads(readText(path))}
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    with filesOf(directory), drawing.style():
        blocks, joints = (_asFrame(found[name]) for name in ("blocks", "joints"))
        figure = figureOf(structureOf(found, blocks, joints, directory), found["title"], 1)
        drawing.save(figure, os.path.join(directory, FIGURE), DPI)


def _asFrame(entries):
    """Blocks or joints as :func:`masonry.numbers.frames.readFrame` gives them."""
    frame = {name: np.array(values) for name, values in entries.items() if name != "cells"}
    return {**frame, "cells": [np.array(cell) for cell in entries["cells"]]}
