# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in 3-D in any browser: a page that is one file and needs no server, no network and no
ParaView. No YADE is needed.

::

    from masonry.numbers import page

    page.write("results/wall_comp4", "wall.html")  # a page, as scripts/view.py --html writes it
    page.show("results/wall_comp4")                # in a notebook: the picture

A page with more than this on it takes :func:`assets` once and :func:`fragment` for every picture.
The drawing is that of three.js of the Debian package libjs-three, which goes into the page with its
licence; ``viewer.js`` and ``viewer.css`` beside this module are ours. :mod:`masonry_view.page.data`
turns frames into numbers for them, and :mod:`masonry_view.page.library` finds three.js.
"""

import html
from typing import Annotated

from masonry.arguments import FilePath, number, validated, whole
from .. import pages
from masonry.numbers.frames import FrameNumber
from ..pages import rendered
from .data import dataOf
from .library import three

#: A factor on displacements.
Factor = Annotated[float, number("-", 0)]

HEIGHT = 620  # of a picture in a notebook [pixels]


def assets() -> str:
    """What a page with pictures needs once, before the first of them: style, three.js with its
    licence, and the viewer.

    :returns: HTML, some 0.9 MB
    :raises Refused: if three.js is not installed, with the package that has it
    """
    library, licence = three()
    return rendered("page/assets.html", library=library, licence=licence)


@validated
def fragment(
    directory: FilePath, number: FrameNumber | None = None, magnification: Factor | None = None
) -> str:
    """The picture of a run as an element ``<div class="masonry-view">`` with its data, for a page
    that has :func:`assets`.

    It is as wide as what it stands in, and 70 % of that high. All frames of the run are in it.

    :param directory: folder of results
    :param number: of the frame that is shown first, from 0; None: the last one
    :param magnification: of displacements at first [-]; None: as in cracks.png. The page has a
        slider for it
    :returns: HTML
    :raises Refused: if the folder has no frames or is no folder of results
    """
    head, numbers = dataOf(directory, number, magnification)
    return rendered("page/fragment.html", head=head, numbers=numbers)


@validated
def page(
    directory: FilePath, number: FrameNumber | None = None, magnification: Factor | None = None
) -> str:
    """A whole page with the picture of a run; parameters and errors as in :func:`fragment` and
    :func:`assets`."""
    library, licence = three()
    head, numbers = dataOf(directory, number, magnification)
    return rendered("page/page.html", head=head, numbers=numbers, library=library, licence=licence)


@validated
def write(
    directory: FilePath,
    path: FilePath,
    number: FrameNumber | None = None,
    magnification: Factor | None = None,
) -> None:
    """Write :func:`page` to a file, whole or not at all; the other parameters and errors are those
    of :func:`page`.

    :raises OSError: if the file cannot be written, or if its name is that of a symbolic link
    """
    pages.write(path, page(directory, number, magnification))


class Picture:
    """A page that a notebook shows in a frame of its own, which may run the script of the page and
    nothing else: it does not reach the notebook. ``page`` is the whole page, a text."""

    def __init__(self, directory, page, height):
        self.page, self._directory, self._height = page, directory, height

    def __repr__(self):
        return f"<the 3-D picture of {self._directory}; a notebook shows it>"

    def _repr_html_(self):
        return (
            f'<iframe sandbox="allow-scripts" style="width:100%;height:{self._height}px;border:0" '
            f'title="3-D picture" srcdoc="{html.escape(self.page)}"></iframe>'
        )


@validated
def show(
    directory: FilePath,
    number: FrameNumber | None = None,
    height: Annotated[int, whole(200, 5000)] = HEIGHT,
) -> Picture:
    """The picture of a run for a notebook, which shows what the last line of a cell returns.

    :param height: of the picture [pixels], 200 to 5000; the others, and the errors, are those of
        :func:`fragment`
    :returns: a :class:`Picture`
    """
    return Picture(directory, page(directory, number), height)
