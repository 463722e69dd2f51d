# SPDX-License-Identifier: GPL-2.0-or-later
"""Options of the command line that all scenes share."""

import argparse
import os
import sys

from .. import notebook
from .._masonry import commit, version
from ..arguments import shown
from ..assembly.engines import LAWS
from ..basics import Refused
from ..run.presets import BOUND, PRESETS, USUAL
from . import keywords
from .parsing import (
    DAMPINGS,
    RATES,
    Parser,
    count,
    field,
    folder,
    massScaling,
    number,
    pathOf,
    points,
)
from .fields import read as readField
from .settings import scatterAll, setting

#: The largest half-width that --accuracy takes [%]: what is less certain is no number.
MOST_PERCENT = 50


def parser(description, until, rate=USUAL["rate"], loops=True):
    """A parser with the common options, to which a scene adds its own.

    :param until: default displacement to stop at [mm]
    :param rate: default loading rate [mm/s]
    :param loops: whether the scene has ``--history``; its value is None in all others
    """
    program = "yade" if hasattr(sys, "yade_argv") else "python3"
    p = Parser(
        prog=f"{program} {os.path.basename((sys.argv or ['SCENE'])[0])}",
        description=description,
        epilog=f"masonry {version}, commit {commit}",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    mm = lambda text: number(text, 0, 1000, above=True)
    p.add_argument(
        "--preset",
        choices=[BOUND, *PRESETS],
        help="blocks, divisions, points, rate, damping and mass scaling with a promise of error and time; "
        "an option given beside it wins, and drops the promise; bound is limit analysis alone, without a run",
    )
    p.add_argument(
        "--accuracy",
        metavar="PERCENT",
        type=lambda text: number(text, 0, MOST_PERCENT, above=True),
        default=None,
        help="of a push: peak and work within this half-width [%%], by the cheapest block model, mesh and rate that reach it; "
        "cheaper runs beside it, on all cores, show the error, which the results have. It says nothing of the crack pattern, "
        "of the end of the curve, and of materials and real walls",
    )
    end = p.add_mutually_exclusive_group()
    end.add_argument(
        "--until",
        metavar="MM",
        type=mm,
        default=until,
        help="displacement to stop at [mm]",
    )
    p.set_defaults(history=None)
    if loops:
        end.add_argument(
            "--history",
            metavar="SPEC",
            type=pathOf,
            help="loops in place of --until: amplitudes in mm with repeats, as 1,2x3,4, each cycle 0, +A, -A, 0; or a "
            "CSV file with a column displacement_mm",
        )
    p.add_argument(
        "--record",
        metavar="FILE",
        type=folder,
        default=None,
        help="file of PEER (AT2) or ESM, or a text that has times and a unit, in place of the record of the scene's first shake(), with its factor",
    )
    p.add_argument(
        "--scale",
        metavar="S",
        type=lambda text: number(text, -1e6, 1e6),
        default=1.0,
        help="how many times as strong the scene's first shake() is [-]",
    )
    p.add_argument(
        "--rate",
        metavar="MM_PER_S",
        type=lambda text: number(text, *RATES),
        default=rate,
        help="loading rate [mm/s]",
    )
    p.add_argument(
        "--blocks",
        choices=["rigid", "deformable"],
        default=USUAL["blocks"],
        help="block model",
    )
    p.add_argument(
        "--divisions",
        metavar="N",
        type=lambda t: count(t, 10),
        default=USUAL["divisions"],
        help="cells of a deformable half brick along its length, and as many along its height, one through its thickness; "
        "in the x-z plane a joint has points at both ends and in the middle of every cell's face, in space at the corners "
        "and in the middle of both triangles of that face, so through the thickness at its faces and thirds, whatever N",
    )
    p.add_argument(
        "--units",
        choices=["plane", "space"],
        default="plane",
        help="deformable units of a scene in the x-z plane: triangles in plane stress in the middle plane of every brick, or "
        "tetrahedra whose nodes are held along y, as in versions before 3.0, which cost twice as much; a block that is no "
        "right prism along y has tetrahedra in any case. In space all units have tetrahedra, and this has no effect",
    )
    p.add_argument(
        "--damping-kind",
        choices=["local", "combined"],
        default=USUAL["damping_kind"],
        help="local damping (the paper's eq. (3)) or combined damping, which does not brake a steady motion",
    )
    p.add_argument(
        "--points",
        metavar="N",
        type=points,
        default=USUAL["points"],
        help="points along a joint of rigid units from when it is about to yield, at its ends and between them "
        "(Gauss-Lobatto), in space along each side of its face; None: 8, and 5 in space. Until then a joint has three, with "
        "which an elastic joint is exact; N,M gives all joints M points from the beginning. How few are enough: "
        "validation/convergence",
    )
    p.add_argument(
        "--damping",
        metavar="A",
        type=lambda t: number(t, *DAMPINGS),
        default=USUAL["damping"],
        help="damping constant, the paper's eq. (3) [-]",
    )
    p.add_argument(
        "--dt-fraction",
        metavar="F",
        type=lambda t: number(t, 1e-3, 1),
        default=USUAL["dt_fraction"],
        help="time step over its stable limit [-]; above 0.94 combined damping may brake the push",
    )
    p.add_argument(
        "--density-scaling",
        metavar="F",
        type=lambda t: number(t, 1e-6, 1e6),
        default=1.0,
        help="masses over their true values, weights kept [-]: a run as with the rate times sqrt(F), in time steps "
        "sqrt(F) as long",
    )
    p.add_argument(
        "--mass-scaling",
        metavar="BETA",
        type=massScaling,
        default=0.0,
        help="selective mass scaling of deformable units in all stages but shake and run: 1 + BETA is the factor on the masses "
        "in every motion of a brick but rigid ones, which keep their inertia, so that the time step is longer [-]; auto: as "
        "much as the time step that the joints allow between rigid bricks can use; none if all units are rigid",
    )
    p.add_argument(
        "--crack-surfaces",
        choices=["on", "whole", "off"],
        default="on",
        help="whether bricks can crack in half. on: each is two blocks with a crack surface between them; whole: it is one "
        "block until the stress in the plane of its crack surface reaches the surface's strength, and two from then on; "
        "off: it is one block",
    )
    p.add_argument(
        "--joints",
        choices=[*LAWS, "brittle"],
        default=next(iter(LAWS)),
        help="; ".join(
            [*(law["meaning"] for law in LAWS.values()), "brittle Coulomb slip"]
        ),
    )
    p.add_argument(
        "--joint-stiffness",
        choices=["joint", "masonry"],
        default="joint",
        help="joints of calcium-silicate masonry: stiffness by the paper's eq. (26), or that with which the masonry has "
        "the moduli of its table 2",
    )
    p.add_argument(
        "--set",
        metavar="NAME.PROPERTY=VALUE",
        type=setting,
        action="append",
        default=[],
        help="change a property of the bed, head, crack or support joints, in SI units; repeatable "
        "(help(masonry.MasonryJoint) lists them); where friction and residual friction are one value, they stay one. NAME can "
        "be a tie, springs, a fibre layer or a beam, too, as in wire.strength=2e3",
    )
    p.add_argument(
        "--field",
        metavar="NAME.PROPERTY=FIELD",
        type=field,
        action="append",
        default=[],
        help="let a property vary from place to place, as in bed.cohesion=lognormal(cov=0.3,length=0.5,seed=1): a random "
        "field about its value, with a correlation length [m]; properties joined by + vary alike; repeatable",
    )
    p.add_argument(
        "--out",
        metavar="DIR",
        type=folder,
        default=None,
        help="folder of the results (default: results/SCENE)",
    )
    p.add_argument(
        "--checkpoint-every",
        metavar="MINUTES",
        type=lambda t: number(t, 0, 1e6),
        default=5.0,
        help="wall-clock time between checkpoints [min]; there is one at the end, on Ctrl-C and on an error, too; with 0 "
        "there is none at all",
    )
    p.add_argument(
        "--resume",
        metavar="DIR",
        type=folder,
        default=None,
        help="go on from the checkpoint in this folder of results, with the options of its run; only --until, "
        "--checkpoint-every, --vtk-every and --no-vtk can be changed, and --history can be extended",
    )
    p.add_argument(
        "--vtk-every",
        metavar="MM",
        type=mm,
        default=1.0,
        help="displacement between ParaView frames [mm]; with --history the path between them",
    )
    p.add_argument(
        "--quick",
        action="store_true",
        help="a tenth of every displacement, time and load that grows, and wide brackets, to see whether the scene works",
    )
    p.add_argument(
        "--no-vtk",
        action="store_true",
        help="write no ParaView files and no crack figure",
    )
    p.add_argument(
        "--lean",
        action="store_true",
        help="for many runs: no ParaView files, no figures, no bound beside the run, and no checkpoint once it has ended; "
        "run.json has the numbers of the crack pattern of a wall and its failure mode",
    )
    return p


def ofScene(name, arguments, usual):
    """The options of a scene: those of its own parser, or of the common one.

    :param arguments: what a parser found; a list of words; or None: those of the command line
    :param usual: what the script says, which holds unless the command line gives the same option: :mod:`.keywords`
    :raises Refused: with all problems
    """
    if arguments is None and (not sys.argv or notebook.isHere()):
        arguments = []  # words of a kernel, or of YADE's importer, are not the scene's
    if isinstance(arguments, str):
        raise Refused(
            f"scene {name}: arguments must be a list of words, such as {arguments.split()!r}, got {arguments!r}"
        )
    if isinstance(arguments, (list, tuple)):
        wrong = [one for one in arguments if not isinstance(one, str)]
        if wrong:
            raise Refused(f"scene {name}: arguments must be a list of words, got {shown(wrong[0])}")  # fmt: skip
    if arguments is None or isinstance(arguments, (list, tuple)):
        main = sys.modules.get("__main__")
        own = parser(getattr(main, "__doc__", None), until=None)
        own.set_defaults(**keywords.checked(own, name, usual))
        arguments = own.parse_args(arguments)
    keywords.keep(arguments, name, usual)
    return arguments


def check(args, masonry, more=(), plane=False, connectors=None):
    """Apply ``--set`` to what is in a scene, and ``--field`` to ties, springs and fibre layers. Refuse options that do not go
    together, and materials that lack something.

    :param args: the parsed options
    :param masonry: :class:`masonry.scene.materials.Masonry` for these options
    :param plane: whether blocks move in the x-z plane only
    :param more: problems that the caller has found, to be named with the others
    :param connectors: ties, springs and fibre layers by name
    :raises Refused: with all problems at once
    """
    problems = list(more)
    if args.blocks == "rigid" and args.divisions > 1:
        problems.append("--divisions: rigid units are not divided")
    if args.mass_scaling not in (0, "auto") and args.blocks == "rigid":
        problems.append("--mass-scaling: rigid units have no deformation to slow")
    if args.points and args.blocks == "deformable":
        problems.append(
            f"--points {args.points}: joints of deformable units have the points of their cells; --divisions makes more of them"
        )
    connectors = connectors or {}
    try:
        masonry.apply(args.set, connectors)
    except Refused as refused:
        problems.append(str(refused))
    for text in args.field:
        try:
            scatterAll(connectors, *readField(text))
        except ValueError as error:
            problems.append(f"--field {text}: {error}")
    problems += masonry.missing()
    if problems:
        raise Refused("\n".join(problems))
