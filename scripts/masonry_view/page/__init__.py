# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in 3-D in any browser: a page that is one file and needs no server and no network. No YADE
is needed.

::

    from masonry_view import page

    page.write("results/wall_comp4", "wall.html")  # a page, as scripts/view.py writes it
    page.show("results/wall_comp4")                # in a notebook: the picture

``viewer.js`` and ``viewer.css`` beside this module draw with three.js of the Debian package
libjs-three, which goes into the page with its licence (:mod:`masonry_view.page.library`);
:mod:`masonry_view.page.data` turns frames into numbers for them.
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


@validated
def page(
    directory: FilePath, number: FrameNumber | None = None, magnification: Factor | None = None
) -> str:
    """A whole page with the picture of a run in all of its frames, some 1 MB of HTML.

    :param directory: folder of results
    :param number: of the frame that is shown first, from 0; None: the last one
    :param magnification: of displacements at first [-]; None: as in cracks.png. The page has a
        slider for it
    :raises Refused: if the folder has no frames or is no folder of results, or if three.js is not
        installed, with the package that has it
    """
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
    """Write a :func:`page` to a file, whole or not at all. Raises OSError, also if its name is that
    of a symbolic link."""
    pages.write(path, page(directory, number, magnification))


class Picture:
    """A page that a notebook shows in a frame, whose script does not reach the notebook."""

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
    """The picture of a run for a notebook, which shows what the last line of a cell returns. Errors
    as in :func:`page`.

    :param height: of the picture [pixels]
    """
    return Picture(directory, page(directory, number), height)
