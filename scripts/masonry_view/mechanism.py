# SPDX-License-Identifier: GPL-2.0-or-later
"""mechanism.png: the mechanism of limit analysis that a run has left in mechanism.json."""

import json
import os

import numpy as np
from masonry.errors import Refused
from masonry.numbers import drawing
from masonry.numbers.files import filesOf, readText

from .elevation import Structure, figureOf

FILE, FIGURE = "mechanism.json", "mechanism.png"
DPI = 90
SEAM = 1  # number of the kind of joints that are crack surfaces


def isThere(directory):
    """Whether a folder has a mechanism."""
    return os.path.exists(os.path.join(directory, FILE))


def draw(directory):
    """Draw the mechanism in the style of the crack figure. Raises Refused."""
    path = os.path.join(directory, FILE)
    try:
        found = json.loads(readText(path))
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    with filesOf(directory):
        _draw(found, os.path.join(directory, FIGURE))


def _draw(found, path):
    blocks, joints = (_asFrame(found[name]) for name in ("blocks", "joints"))
    masonry = {body for part in found["parts"].values() for body in part}
    shades = {int(b): "platen" for b in blocks["body"] if masonry and b not in masonry}
    with drawing.style():
        structure = Structure(
            blocks, joints, found["parts"], shades, viewDirections=found["views"], seams=(SEAM,)
        )
        drawing.save(figureOf(structure, found["title"], 1), path, DPI)


def _asFrame(entries):
    """Blocks or joints as :func:`masonry.numbers.frames.readFrame` gives them."""
    frame = {name: np.array(values) for name, values in entries.items() if name != "cells"}
    return {**frame, "cells": [np.array(cell) for cell in entries["cells"]]}
