# SPDX-License-Identifier: GPL-2.0-or-later
"""A picture of blocks as they are built, before anything has moved. This module needs no YADE."""

import numpy as np

from .crack_figure import Picture, page
from .views import outline, viewOf

#: Colours of the blocks that are no plain bricks, by the label of the legend.
SHADES = {"held": "0.45", "loaded": "#9fc3e6", "watched": "#c7e0b4"}


def figureOf(parts, title, sights=None):
    """A figure of blocks, to be drawn and saved in :func:`masonry.read.drawing.style`, each part in a panel of its own.

    :param parts: dict of part -> list of blocks, each a pair of its corners (x, y, z) [m] and a key of :data:`SHADES`, or None
    :param title: above the picture
    :param sights: directions of sight by part
    """
    sights = sights or {}
    pictures = {n: _picture(blocks, sights.get(n)) for n, blocks in parts.items()}
    return page(pictures, title)


def _picture(blocks, sight):
    corners = [np.array(list(map(tuple, points)), float) for points, _ in blocks]
    plain = [c for c, (_, shade) in zip(corners, blocks) if shade is None]
    nothing = np.zeros((0, 3)), np.zeros(0)  # no joints decide from where it is seen
    view = viewOf(np.concatenate(plain or corners), *nothing, sight)
    to = np.column_stack([view.right, view.up])
    faces = []
    for points, (_, shade) in zip(corners, blocks):
        flat, depth = (points - view.start) @ to, points @ view.towards
        colour = (shade, SHADES[shade]) if shade else None
        faces.append((depth.max(), flat[outline(flat, depth)], colour))
    faces.sort(key=lambda face: face[0])  # from the back to the front
    outlines = [face for _, face, _ in faces]
    shades = [colour for _, _, colour in faces]
    return Picture(view, outlines, outlines, {}, {}, [], shades)
