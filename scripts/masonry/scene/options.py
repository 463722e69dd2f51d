# SPDX-License-Identifier: GPL-2.0-or-later
"""Options of the command line that all scenes share."""

import argparse
import os
import sys
from dataclasses import replace

from .. import notebook
from .._masonry import commit, version
from ..arguments import oneOf, shown
from ..model.engines import LAWS
from ..background import reportRefusal
from ..errors import Interrupted, Refused, refuse
from ..terminal import say
from ..run import accuracy, batch, option_table
from ..run.option_table import USUAL, reading
from ..run.presets import BOUND, PRESETS
from ..materials import fields
from . import history
from .ground import readRecord
from .parsing import Parser, checked, keep
from ..materials.settings import scatterAll, setting

#: The options of a scene: the table with the laws of the plugin and the presets.
OPTIONS = {
    **option_table.OPTIONS,
    "preset": replace(option_table.OPTIONS["preset"], validator=oneOf(BOUND, *PRESETS)),
    "joints": replace(
        option_table.OPTIONS["joints"],
        validator=oneOf(*LAWS, "brittle"),
        default=next(iter(LAWS)),
        meaning="; ".join([*(law["meaning"] for law in LAWS.values()), "brittle Coulomb slip"]),
    ),
}


#: How the texts of options are read.
READ = {
    "history": reading(history.parse),
    "field": reading(lambda text: fields.read(text) and text),
    "set": reading(setting),
}


def parser(description, until, rate=USUAL["rate"], loops=True):
    """A parser with the common options; a scene adds its own.

    :param until: default displacement to stop at [mm]
    :param rate: default loading rate [mm/s]
    :param loops: whether the scene has ``--history``
    """
    program = "yade" if hasattr(sys, "yade_argv") else "python3"
    p = Parser(
        prog=f"{program} {os.path.basename((sys.argv or ['SCENE'])[0])}",
        description=description,
        epilog=(
            'The paper is Y. P. Oktiovan et al., "Prediction of the In-Plane Response of Masonry'
            ' Walls Using a Piecewise Softening Contact Model Within the Distinct Element Method"'
            " (TU Delft repository). Its law was first published in Computers & Structures 303"
            f" (2024) 107499, doi 10.1016/j.compstruc.2024.107499. masonry {version}, commit"
            f" {commit}"
        ),
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    for name, option in OPTIONS.items():
        if name == "until":
            end = p.add_mutually_exclusive_group()
            replace(option, default=until).addTo(end)
        elif name == "history" and not loops:
            p.set_defaults(history=None)
        elif name == "rate":
            replace(option, default=rate).addTo(p)
        else:
            option.addTo(end if name == "history" else p, READ.get(name))
    return p


def ofScene(name, arguments, sceneOptions):
    """The options of a scene. Raises Refused with all problems.

    :param arguments: what a parser found; a list of words; or None: those of the command line
    :param sceneOptions: those of the script: :func:`masonry.scene.parsing.keep`
    """
    if arguments is None and (not sys.argv or notebook.isHere()):
        arguments = []  # words of a kernel, or of YADE's importer, are not the scene's
    if not isinstance(arguments, argparse.Namespace):
        words = arguments if isinstance(arguments, (list, tuple, type(None))) else [arguments]
        must = f"scene {name}: arguments must be a list of words"
        if isinstance(arguments, str):
            raise Refused(f"{must}, such as {arguments.split()!r}, got {arguments!r}")
        for wrong in (one for one in words or () if not isinstance(one, str)):
            raise Refused(f"{must}, got {shown(wrong)}")
        own = parser(getattr(sys.modules.get("__main__"), "__doc__", None), until=None)
        own.set_defaults(**checked(own, name, sceneOptions))
        arguments = own.parse_args(words)
    keep(arguments, name, sceneOptions)
    return arguments


def check(args, masonry, connectors, more=()):
    """Apply ``--set`` and ``--field``. Refuse, with all problems, options that do not go together,
    and materials that lack something.

    :param masonry: the :class:`masonry.materials.Masonry` for these options
    :param connectors: ties, springs and fibre layers by name
    :param more: problems that the caller has found
    """
    problems = [*more]
    if args.blocks == "rigid" and args.divisions > 1:
        problems.append("--divisions: rigid units are not divided")
    if args.mass_scaling not in (0, "auto") and args.blocks == "rigid":
        problems.append("--mass-scaling: rigid units have no deformation to slow")
    if args.points and args.blocks == "deformable":
        problems.append(
            f"--points {args.points}: joints of deformable units have the points of their cells;"
            " --divisions makes more of them"
        )

    def attempt(before, act, *arguments):
        try:
            act(*arguments)
        except ValueError as error:
            problems.append(f"{before}{error}")

    attempt("", masonry.apply, args.set, connectors)
    if args.record is not None:
        attempt("--record: ", readRecord, batch.beside(args.record), None, args.scale)
    for text in args.field:
        attempt(f"--field {text}: ", scatterAll, connectors, *fields.read(text))
    refuse(problems + masonry.missing())


def askAccuracy(name, args):
    """:func:`masonry.run.accuracy.ask`; ends the script where there is no answer."""
    _, ofLine = Parser.last
    fromLine = ofLine is args and sys.argv and os.path.isfile(sys.argv[0])
    script = sys.argv[0] if fromLine else None
    try:
        return accuracy.ask(name, args, script, sys.argv[1:])
    except Refused as refused:
        if notebook.isHere():
            raise
        reportRefusal(refused)
        say(refused, sys.stderr)
        raise SystemExit(2) from None
    except Interrupted:
        say("interrupted: the runs that are over are kept, and the same command goes on")
        raise SystemExit(130) from None
