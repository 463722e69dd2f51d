# SPDX-License-Identifier: GPL-2.0-or-later
"""Bilinear curve, capacity and demand of runs: ``/usr/bin/python3 -m masonry_capacity results/WALL
...``."""

import argparse
import re
import sys

from masonry import memory
from masonry.errors import Refused
from masonry.terminal import say
from .bilinear_curve import RULES, lines
from masonry.numbers.files import program
from masonry.numbers.quantities import Number
from . import n2
from .report import CAPACITY, DOMAIN, assess, assessDomain
from .spectra import PARAMETERS, UNITS, elastic, readSpectrum

#: Options that belong to the spectrum of EN 1998-1, and to one from a file.
OF_CODE, OF_FILE = ("type", "ground", "ag"), ("unit", "corner")


def parser():
    p = argparse.ArgumentParser(
        prog="python3 -m masonry_capacity",
        description=(
            "The bilinear curve and the drifts of a push and, for a spectrum, the target"
            " displacement by the N2 method of EN 1998-1:2004, annex B. Writes capacity.json and"
            " capacity.png to every folder."
        ),
        epilog=(
            "Mass and factor of the equivalent system are given here, or the script of the run says"
            ' them: scene.result("equivalent_mass", 30e3, "kg") and'
            ' scene.result("participation_factor", 1.0).'
        ),
    )
    p.add_argument("result", nargs="*", metavar="FOLDER", help="folder of results")
    p.add_argument(
        "--rule",
        choices=list(RULES),
        default="en1998",
        help=(
            "of the bilinear curve: that of annex B.3 (default), or the convention for masonry"
            " walls"
        ),
    )
    p.add_argument(
        "--mechanism",
        metavar="MM",
        type=float,
        help=(
            "with en1998, displacement at which the plastic mechanism forms; else that of the peak"
        ),
    )
    p.add_argument(
        "--column",
        metavar="NAME",
        help=(
            "displacement of curve.csv that the curve has, as roof_x_mm, with its --height; else"
            " that of the pushed point"
        ),
    )
    p.add_argument(
        "--height",
        metavar="M",
        type=float,
        help="of the recorded point above the base, for drifts, where run.json does not have it",
    )
    p.add_argument(
        "--out", metavar="DIR", help="folder of the files, for one FOLDER; else that folder"
    )
    g = p.add_argument_group("equivalent system")
    g.add_argument("--mass", metavar="KG", type=float, help="equivalent mass m*")
    g.add_argument(
        "--gamma",
        metavar="G",
        type=float,
        help="transformation factor, 1 for one mass at the loaded point",
    )
    g.add_argument("--masses", metavar="KG,KG", help="masses of the storeys, in place of both")
    g.add_argument(
        "--shape", metavar="PHI,PHI", help="their displacements over that of the recorded point"
    )
    g = p.add_argument_group("spectrum of EN 1998-1:2004")
    g.add_argument(
        "--type",
        type=int,
        choices=list(PARAMETERS),
        help="1, or 2 where only earthquakes of a surface-wave magnitude up to 5.5 count",
    )
    g.add_argument("--ground", choices=list("ABCDE"), help="ground type")
    g.add_argument(
        "--ag",
        metavar="NUMBER+UNIT",
        help=(
            "reference peak ground acceleration on ground of type A, with its unit: 0.15g, or"
            " 1.5m/s2"
        ),
    )
    g.add_argument(
        "--importance", metavar="G", type=float, default=1.0, help="importance factor (default 1)"
    )
    g.add_argument(
        "--damping",
        metavar="PERCENT",
        type=float,
        default=5.0,
        help="viscous damping (default 5 %%)",
    )
    g = p.add_argument_group("another spectrum")
    g.add_argument("--spectrum", metavar="FILE", help="two columns: period [s] and acceleration")
    g.add_argument("--unit", choices=list(UNITS), help="of its accelerations")
    g.add_argument(
        "--corner",
        metavar="S",
        type=float,
        help="TC, upper limit of the periods with constant acceleration",
    )
    p.add_argument(
        "--limited", action="store_true", help="take at most 3 det*, which annex B allows"
    )
    p.add_argument(
        "--iterate",
        action="store_true",
        help=(
            "let the plastic mechanism form at the target displacement, by the iteration of annex B"
        ),
    )
    p.add_argument(
        "--domain",
        metavar="FOLDER",
        help=(
            "in place of all that: the N-V domain of a scene that says scene.domain(...), with the"
            " peaks of the other folders as points; writes domain.json and domain.png"
        ),
    )
    return p


def numbers(text, option):
    """The numbers of an option, apart by commas. Raises Refused."""
    try:
        return [float(one) for one in text.split(",")]
    except ValueError:
        raise Refused(
            f"{option} {text!r} must be numbers with commas between them, as 20e3,15e3"
        ) from None


def systemOf(args):
    """The equivalent system of the options, or None if they do not give one. Raises Refused."""
    pairs = ("mass", "gamma"), ("masses", "shape")
    given = [[name for name in pair if getattr(args, name) is not None] for pair in pairs]
    if all(given):
        raise Refused("give either --mass and --gamma or --masses and --shape")
    for pair, names in zip(pairs, given):
        if len(names) == 1:
            missing = next(name for name in pair if name not in names)
            raise Refused(f"--{names[0]}: --{missing} is missing, and it is not guessed")
    if given[0]:
        return n2.equivalent(args.mass, args.gamma)
    if given[1]:
        return n2.ofMasses(numbers(args.masses, "--masses"), numbers(args.shape, "--shape"))
    return None


def spectrumOf(args):
    """The spectrum of the options, or None if they do not give one. Raises Refused."""
    code = [name for name in OF_CODE if getattr(args, name) is not None]
    if args.spectrum is not None:
        if code:
            raise Refused(
                f"--spectrum: leave --{', --'.join(code)} away, which are of the spectrum of EN"
                " 1998-1"
            )
        if args.unit is None:
            raise Refused(f"--spectrum: --unit is missing; it is one of {', '.join(UNITS)}")
        return readSpectrum(args.spectrum, args.unit, args.corner)
    stray = [name for name in OF_FILE if getattr(args, name) is not None]
    if stray:
        raise Refused(f"--{', --'.join(stray)}: it is of --spectrum FILE, which is missing")
    if not code:
        return None
    missing = [name for name in OF_CODE if name not in code]
    if missing:
        raise Refused(f"--{', --'.join(code)}: --{', --'.join(missing)} must be given, too")
    found = re.fullmatch(r"([0-9.eE+-]+?)\s*(g|m/s²|m/s2|cm/s²|cm/s2)", args.ag.strip())
    try:
        value, unit = float(found[1]), found[2]  # type: ignore[index]
    except (TypeError, ValueError):
        raise Refused(
            f"--ag {args.ag!r} must be a number with its unit, as 0.15g or 1.5m/s2"
        ) from None
    return elastic(value, unit, args.type, args.ground, args.importance, args.damping)


def _show(folder, found, out):
    say(f"{folder}: {found['title'] or found['scene'] or ''}")
    say("\n".join(lines([Number(**one) for one in found["numbers"]], found["notes"])))
    if "verdict" in found:
        say(f"spectrum: {found['spectrum']}")
        say(found["assumed"])
        say(f"{folder}: {found['verdict']}")
    else:
        say("no spectrum, so no demand: --type, --ground and --ag, or --spectrum give one")
    say(f"written: {', '.join(CAPACITY)} in {out or folder}")


def _showDomain(folder, found, out):
    say(f"{'normal kN':>12}{'at most kN':>14}{'without dilatancy kN':>24}  exact")
    for one in found.bounds:
        other = "-" if one.withoutDilatancy is None else f"{one.withoutDilatancy:.4g}"
        say(f"{one.normal:12.4g}{one.largest:14.4g}{other:>24}  {'yes' if one.exact else 'no'}")
    for run in found.runs:
        say(
            f"{run.name}: {run.shear:.4g} kN at {run.displacement:.4g} mm under {run.normal:.4g} kN"
            f" ({run.source})"
        )
        try:
            most = found.shear(run.normal)
        except Refused as refused:
            say(f"note: {run.name}: {refused}")
        else:
            say(f"{run.name}: {100 * run.shear / most:.3g} % of the upper bound, {most:.4g} kN")
    for note in found.notes:
        say(f"note: {note}")
    say(f"written: {', '.join(DOMAIN)} in {out or folder}")


@program
def main(words=None):
    """The program. Returns its exit status."""
    args = parser().parse_args(words)
    memory.reserve()
    if args.domain is not None:
        _showDomain(args.domain, assessDomain(args.domain, args.result, args.out), args.out)
        return 0
    if not args.result:
        raise Refused("name one folder of results at least, for example results/wall_comp4")
    if args.out and len(args.result) > 1:
        raise Refused(f"--out {args.out}: it is for one folder, not {len(args.result)}")
    spectrum, system, status = spectrumOf(args), systemOf(args), 0
    for folder in args.result:
        try:
            found = assess(
                folder,
                spectrum,
                system,
                args.rule,
                args.mechanism,
                args.limited,
                args.iterate,
                args.height,
                args.out,
                args.column,
            )
        except Refused as problem:
            say(problem, sys.stderr)
            status = 2
        else:
            _show(folder, found, args.out)
    return status


if __name__ == "__main__":
    sys.exit(main())
