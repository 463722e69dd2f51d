# SPDX-License-Identifier: GPL-2.0-or-later
"""The options that all scenes share: one row an option. The command line, ``--help``, the manual,
keywords of ``Scene``, presets, the check of a run that is resumed, studies and run.json read these
rows. No YADE is needed."""

import argparse
import contextlib
from dataclasses import dataclass, replace
from typing import Annotated, Any

from ..arguments import Validator, flag, number, oneOf, text, whole


@dataclass(frozen=True)
class Option:
    """An option of all scenes."""

    name: str  # as Python has it: dt_fraction is --dt-fraction
    validator: Validator = text  # of its values, as in masonry.arguments
    default: Any = None  # None: the scene says it, or there is none
    value: str | None = None  # what stands for its value in --help
    several: bool = False  # whether it can be given several times
    chosen: bool = False  # whether presets and --accuracy choose it
    harmless: bool = False  # whether it leaves the promise of a preset alone
    free: bool = False  # whether a run that is resumed may have another value
    ofStudy: bool = True  # whether a row of a study may have it
    ofScript: bool = True  # whether Scene has it as a keyword
    meaning: str = ""  # what --help says

    def means(self, meaning: str) -> "Option":
        return replace(self, meaning=meaning)

    @property
    def unit(self) -> str:
        return getattr(self.validator, "unit", "")

    def addTo(self, parser: Any, read: Any = None) -> None:
        """Add it to a parser of argparse, or to a group of one.

        :param read: function of a text in place of :func:`reading`
        """
        settings: dict[str, Any] = {"help": self.meaning, "default": self.default}
        if self.validator is flag:
            settings.update(action="store_true", default=False)
        elif hasattr(self.validator, "choices"):
            settings.update(choices=[*self.validator.choices])
        else:
            settings.update(metavar=self.value, type=read or reading(self.validator))
        if self.several:
            settings.update(action="append", default=[])
        parser.add_argument(asOption(self.name), **settings)


def reading(validator: Validator) -> Any:
    """The function by which argparse reads the values of a validator from texts."""

    def read(text):
        value = text
        with contextlib.suppress(ValueError):
            value = getattr(validator, "of", str)(text)
        try:
            return validator(value)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return read


def asOption(name: str) -> str:
    """The name of an option as the user writes it."""
    return "--" + name.replace("_", "-")


# -- validators ------------------------------------------------------------------------------------

FEWEST = 3  # points along a side: two give three times the true rotational stiffness, one none


def points(value: Any, context: Any = None) -> str:
    """Validator of ``--points``: one number of points, or two, the second not above the first."""
    along = whole(FEWEST, 100)
    numbers = [along(int(n) if n.isdecimal() else n) for n in str(value).split(",")]
    if len(numbers) > 2:
        raise ValueError(f"{value!r} must be one or two whole numbers")
    if numbers[-1] > numbers[0]:
        raise ValueError(
            f"{value!r}: a joint cannot have fewer points from when it yields than before"
        )
    return value


def massScaling(value: Any, context: Any = None) -> Any:
    """Validator of ``--mass-scaling``: a number, or ``auto``."""
    return value if value == "auto" else number("", 0, 1e6)(value)


vars(massScaling).update(of=float)


def folder(value: Any, context: Any = None) -> str:
    if not (isinstance(value, str) and value.strip()):
        raise ValueError("must not be empty")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{value!r} is not UTF-8") from None
    return value


millimetres = number("mm", 0, 1000, above=True)
rate, damping = number("mm/s", 1e-3, 1000), number("", 0, 0.99)
#: What stages take that an option gives otherwise.
Rate = Annotated[float, rate]
Damping = Annotated[float, damping]

# -- the table -------------------------------------------------------------------------------------

_ROWS = (
    # choices: masonry.run.presets
    Option("preset", harmless=True).means(
        "blocks, divisions, points, rate, damping and mass scaling for speed or accuracy; fast has"
        " a promise of its error, which an option given beside it drops; bound is limit analysis"
        " alone, without a run"
    ),
    Option("accuracy", number("%", 0, 50, above=True), value="PERCENT", harmless=True).means(
        "of a push: peak and work within this half-width [%%], by the cheapest block model, mesh"
        " and rate that reach it; cheaper runs beside it, on all cores, show the error, which the"
        " results have. It says nothing of the crack pattern, of the end of the curve, and of"
        " materials and real walls"
    ),
    Option("until", millimetres, value="MM", harmless=True, free=True).means(
        "displacement to stop at [mm]"
    ),
    Option("history", value="SPEC", free=True).means(
        "loops in place of --until: amplitudes in mm with repeats, as 1,2x3,4, each cycle 0, +A,"
        " -A, 0; or a CSV file with a column displacement_mm"
    ),
    Option("record", folder, value="FILE").means(
        "file of PEER (AT2) or ESM, or a text that has times and a unit, in place of the record of"
        " the scene's first shake(), with its factor"
    ),
    Option("scale", number("", -1e6, 1e6), 1.0, "S").means(
        "how many times as strong the scene's first shake() is [-]"
    ),
    Option("rate", rate, 20.0, "MM_PER_S", chosen=True).means("loading rate [mm/s]"),
    Option("blocks", oneOf("rigid", "deformable"), "rigid", chosen=True).means("block model"),
    Option("divisions", whole(1, 10), 1, "N", chosen=True).means(
        "cells of a deformable half brick along its length, and as many along its height, one"
        " through its thickness; in the x-z plane a joint has points at both ends and in the middle"
        " of every cell's face, in space at the corners and in the middle of both triangles of that"
        " face, so through the thickness at its faces and thirds, whatever N"
    ),
    Option("damping_kind", oneOf("local", "combined"), default="combined", chosen=True).means(
        "local damping (the paper's eq. (3)), which brakes a push, as validation/trade"
        " measures, or combined damping, which does not brake a steady motion"
    ),
    Option("points", points, value="N", chosen=True).means(
        "points along a joint of rigid units from when it is about to yield or, dry or cracked, to"
        " open, at its ends and between them (Gauss-Lobatto), in space along each side of its face"
        " that does; None: 8, 5 in space, and 14 where it opens on a compliant bed. Until"
        " then a joint has three, with which an elastic joint is exact; N,M gives all joints M"
        " points from the beginning. How few are enough: validation/sensitivity"
    ),
    Option("damping", damping, 0.8, "A", chosen=True).means(
        "damping constant, the paper's eq. (3) [-]"
    ),
    Option("dt_fraction", number("", 1e-3, 1), 0.8, "F", chosen=True).means(
        "time step over its stable limit [-], if not given 0.95 in shake and run without damping;"
        " above 0.94 combined damping may brake the push"
    ),
    Option("density_scaling", number("", 1e-6, 1e6), 1.0, "F").means(
        "masses over their true values, weights kept [-]: a run as with the rate times sqrt(F), in"
        " time steps sqrt(F) as long"
    ),
    Option("mass_scaling", massScaling, 0.0, "BETA", chosen=True).means(
        "selective mass scaling of deformable units in all stages but shake and run: 1 + BETA is"
        " the factor on the masses in every motion of a brick but rigid ones, which keep their"
        " inertia, so that the time step is longer [-]; auto: as much as the time step that the"
        " joints allow between rigid bricks can use; none if all units are rigid"
    ),
    Option("added_inertia", number("", 0, 0.1), 0.05, "SHARE").means(
        "inertia without a weight that may be added to the few rigid blocks that set the time step,"
        " over that of all blocks, in stages that are not in real time and follow no collapse, if"
        " it makes the step at least 1.3 times as long [-]; 0: none. With the default peak, work"
        " and bracket changed by 0.2 %% at most in three scenes of the gallery"
    ),
    Option("crack_surfaces", oneOf("on", "off"), default="on").means(
        "whether bricks can crack in half. on: each is two blocks with a crack surface between"
        " them; off: it is one block"
    ),
    # choices: the laws of the plugin
    Option("joints").means("law of the joints"),
    Option("set", value="NAME.PROPERTY=VALUE", several=True, ofStudy=False).means(
        "change a property of the bed, head, crack or support joints, in SI units; repeatable"
        " (help(masonry.MasonryJoint) lists them); where friction and residual friction are one"
        " value, they stay one. NAME can be a tie, springs, a fibre layer or a beam, too, as in"
        " wire.strength=2e3"
    ),
    Option("field", value="NAME.PROPERTY=FIELD", several=True, ofStudy=False).means(
        "let a property vary from place to place, as in"
        " bed.cohesion=lognormal(cov=0.3,length=0.5,seed=1): a random field about its value, with a"
        " correlation length [m]; properties joined by + vary alike; repeatable"
    ),
    Option("out", folder, value="DIR", harmless=True, ofStudy=False).means(
        "folder of the results (default: results/SCENE)"
    ),
    Option(
        "checkpoint_every",
        number("min", 0, 1e6),
        5.0,
        "MINUTES",
        harmless=True,
        free=True,
    ).means(
        "wall-clock time between checkpoints [min]; there is one at the end, on Ctrl-C and on an"
        " error, too; with 0 there is none at all"
    ),
    Option("resume", folder, value="DIR", ofStudy=False, ofScript=False).means(
        "go on from the checkpoint in this folder of results, with the options of its run; only"
        " --until, --checkpoint-every, --vtk-every, --no-vtk and --lean can be changed, and"
        " --history can be extended"
    ),
    Option("vtk_every", millimetres, 1.0, "MM", harmless=True, free=True, ofStudy=False).means(
        "displacement between ParaView frames [mm]; with --history the path between them"
    ),
    Option("ratios", flag, harmless=True).means(
        "let curve.png and the report show a push over its drift [%%], with the force over the"
        " vertical force at the base, as the push begins, on the right"
    ),
    Option("quick", flag).means(
        "a tenth of every displacement, time and load that grows, and wide brackets, to see whether"
        " the scene works"
    ),
    Option("no_vtk", flag, harmless=True, free=True, ofStudy=False).means(
        "write no ParaView files and no crack figure"
    ),
    Option("lean", flag, harmless=True, free=True, ofStudy=False).means(
        "for many runs: no ParaView files, no figures, no bound beside the run, and no checkpoint"
        " once it has ended; run.json has the numbers of the crack pattern of a wall and its"
        " failure mode"
    ),
)

OPTIONS = {one.name: one for one in _ROWS}  # all options by their names


def optionsWith(trait: str) -> set[str]:
    """Names of the options that have a trait of :class:`Option`, such as ``"harmless"``."""
    return {name for name, one in OPTIONS.items() if getattr(one, trait)}


#: Units of the options that have one; defaults of those that a preset chooses. A scene may have
#: another rate.
UNITS = {name: one.unit for name, one in OPTIONS.items() if one.unit}
USUAL = {name: one.default for name, one in OPTIONS.items() if one.chosen}
