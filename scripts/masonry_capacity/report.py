# SPDX-License-Identifier: GPL-2.0-or-later
"""Capacity and demand of a run, as files in its folder: capacity.json and capacity.png, or
domain.json and domain.png."""

import json
import os
import sys
from functools import partial
from typing import Annotated, Any, Sequence

from masonry import folders
from masonry.arguments import FilePath, listOf, path, validated
from masonry.errors import Refused
from masonry.terminal import say
from masonry.packages import Missing
from . import bilinear_curve
from . import figure, n2
from .domains import Domain, domain

#: Files that are written.
CAPACITY, DOMAIN = ("capacity.json", "capacity.png"), ("domain.json", "domain.png")
#: What the equivalent system of a wall is, as the report says it.
ASSUMED = (
    "The structure is taken as one mass on a spring that follows the bilinear curve: it moves in"
    " one shape, that of the push, and keeps it after it yields. Of a wall that is pushed at its"
    " top the mass is what the wall holds back in an earthquake, floors and masonry at the height"
    " of the loaded point, with a factor of 1; it is not the mass that presses the wall, unless"
    " that also moves with it."
)


@validated
def assess(
    directory: FilePath,
    spectrum: n2.Elastic | None = None,
    system: n2.System | None = None,
    rule: bilinear_curve.Rule = "en1998",
    mechanism: bilinear_curve.Mechanism | None = None,
    limited: bool = False,
    iterate: bool = False,
    height: bilinear_curve.Height | None = None,
    out: FilePath | None = None,
    column: str | None = None,
) -> dict[str, Any]:
    """Write capacity.json and capacity.png of a run: the bilinear curve of its push, its drifts
    and, for a spectrum, the target displacement by the N2 method. Returns what capacity.json has.

    :param directory: folder of results
    :param spectrum: of :func:`masonry_capacity.elastic` or :func:`masonry_capacity.readSpectrum`;
        None: no demand
    :param system: of :func:`masonry_capacity.equivalent` or :func:`masonry_capacity.ofMasses`;
        None: that of the run, :func:`masonry_capacity.ofRun`
    :param rule: of the bilinear curve, and ``mechanism``: as in
        :func:`masonry_capacity.bilinear_curve.bilinear`
    :param limited: as in :func:`masonry_capacity.demand`
    :param iterate: whether the plastic mechanism forms at the target displacement,
        :func:`masonry_capacity.iterated`
    :param height: as in :func:`masonry_capacity.bilinear_curve.drifts`
    :param out: folder of both files; None: ``directory``
    :param column: as in :func:`masonry_capacity.bilinear_curve.pushover`
    :returns: dict with ``scene``, ``title``, ``rule``, ``numbers`` (a list of dicts), ``notes``,
        and with a spectrum ``spectrum``, ``holds``, ``verdict`` and ``assumed``
    :raises Refused: if the run has no whole push, or if something is missing for the demand;
        nothing is written then
    """
    if iterate and (rule != "en1998" or mechanism is not None or not spectrum):
        raise Refused(
            "iterate: it is of the rule en1998 with a spectrum, and finds the mechanism itself:"
            " leave rule= and mechanism= away"
        )
    push = bilinear_curve.pushover(directory, column)
    if spectrum:
        system = system or n2.ofRun(push.run, push.directory)
    if iterate:
        needs = n2.iterated(push, system, spectrum, limited)
        curve = needs.curve
    else:
        curve = bilinear_curve.ofRun(push, rule, mechanism=mechanism)
        needs = n2.demand(curve, system, spectrum, limited) if spectrum else None
    numbers, notes = curve.numbers(), list(curve.notes)
    try:
        numbers += bilinear_curve.drifts(push, height)
    except Refused as refused:
        notes.append(str(refused))
    found = {"scene": push.run.get("scene"), "title": push.run.get("title"), "rule": rule}
    if needs:
        numbers += needs.numbers()
        notes += needs.notes
        found.update(
            spectrum=needs.spectrum.name,
            holds=needs.holds,
            verdict=needs.verdict(),
            assumed=ASSUMED,
        )
    found.update(numbers=[one.entry() for one in numbers], notes=notes)
    draw = partial(figure.capacity, push, needs) if needs else partial(figure.forces, push, curve)
    _write(out or directory, CAPACITY, found, draw)
    return found


@validated
def assessDomain(
    directory: FilePath,
    runs: Annotated[Sequence[FilePath], listOf(path, 0)] = (),
    out: FilePath | None = None,
) -> Domain:
    """Write domain.json and domain.png: the N-V domain of a scene, with runs as points. Returns the
    domain.

    :param directory: folder of results, and ``runs``: as in :func:`masonry_capacity.domain`
    :param out: folder of both files; None: ``directory``
    :raises Refused: as in :func:`masonry_capacity.domain`; nothing is written then
    """
    found = domain(directory, runs)
    _write(out or directory, DOMAIN, found.entries(), partial(figure.domain, found))
    return found


def _write(folder, names, entries, draw):
    """Write a JSON file and a picture. Raises Refused if the disk refuses."""
    path, picture = (os.path.join(folder, name) for name in names)
    try:
        os.makedirs(folder, exist_ok=True)
        folders.check(folder)
        with folders.replaced(path) as file:
            json.dump(entries, file, indent=2, allow_nan=False)
            file.write("\n")
        try:
            draw(picture)
        except Missing as missing:
            say(f"the picture is not drawn: {missing}", sys.stderr)
    except OSError as error:
        raise Refused(f"cannot write to {folder}: {error.strerror}") from None
