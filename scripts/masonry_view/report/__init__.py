# SPDX-License-Identifier: GPL-2.0-or-later
"""The report of a run: one file, report.html, that any browser opens without a server or a network.
No YADE is needed::

    /usr/bin/python3 -m masonry_view.report results/wall_comp4  # writes report.html there
    /usr/bin/python3 -m masonry_view.report results/wall_comp4 -o wall.html

A run writes it at its end, but with ``--lean`` and when it is interrupted. From a script::

    from masonry_view import report

    report.write(report.read("results/wall_comp4"), "wall.html")

Every number has its unit, what it is, and its source. What the files lack is said to be missing,
with the reason. The turning picture is that of :mod:`masonry_view.page`; without the Debian package
libjs-three a sentence stands in its place.
"""

from masonry.arguments import FilePath, validated
from masonry.errors import Refused
from .. import pages
from ..page.library import three
from ..pages import rendered
from . import response, structure, trust
from .pieces import missing as absent
from .record import Record

NAME = "report.html"  # in the folder of a run

#: The parts of a report in their order: the name of the place, the heading, and a function of the
#: record.
PARTS = (
    ("built", "What was built", structure.built),
    ("loaded", "How it was held and loaded", structure.loaded),
    ("curve", "The curve", response.curve),
    ("found", "Drifts and other numbers", response.found),
    ("bound", "The bound by limit analysis", response.bound),
    ("energy", "Where the work went", response.energy),
    ("cycles", "Equivalent damping of cycles", response.cycles),
    ("base", "Forces at the base", response.base),
    ("picture", "The structure in 3-D", trust.pictures),
    ("trust", "How far to trust it", trust.trust),
)


@validated
def read(directory: FilePath) -> Record:
    """Read the files of a run. Raises Refused if it has no run.json."""
    return Record(directory)


def page(record: Record) -> str:
    library, licence = _library(record)
    parts = [(place, heading, _made(part, record)) for place, heading, part in PARTS]
    return rendered(
        "report/report.html",
        title=record.title,
        head=_made(structure.origin, record) + _made(structure.head, record),
        parts=parts,
        image=record.image,
        library=library,
        licence=licence,
    )


def _library(record):
    """What the 3-D picture needs in the page. Where it is missing, the record has no picture, and
    says why."""
    if record.picture:
        try:
            return three()
        except Refused as missing:
            record.picture = None
            record.missing = (
                "three.js is not installed, which draws it. The Debian package is libjs-three;"
                f" then python3 -m masonry_view.report writes the report again. {missing}"
            )
    return [], ""


def _made(part, record):
    """The pieces of a part; a sentence if the files do not have what it needs."""
    found = []
    try:
        for piece in part(record):
            found.append(piece)
    except Refused as refused:
        found.append(absent(str(refused)))
    except (LookupError, AttributeError, TypeError, ValueError, ArithmeticError) as problem:
        found.append(
            absent(
                "This part is not whole: a file of the run is damaged or of another version, or the"
                f" report has a fault of its own ({type(problem).__name__}: {problem})."
            )
        )
    return found


def write(record: Record, path: FilePath) -> None:
    """Write :func:`page` to a file, whole or not at all. Raises OSError, also if its name is that
    of a symbolic link."""
    pages.write(path, page(record))
