# SPDX-License-Identifier: GPL-2.0-or-later
"""How far the answer of two walls moves when an assumed value of the joint law moves over its
plausible range.

/usr/bin/python3 validation/sensitivity/tornado.py [--draw]

Runs what is missing in results/validation/sensitivity, one run after another, prints the table of
all runs and draws tornado.png beside itself; --draw leaves out what was not run. Rigid units.
"""

import os
import sys
from collections import namedtuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from masonry_view.measure import measure

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from studies import RESULTS, done, nameOf, readCase, runMissing, table

#: Walls and their options: the rate moves the peak of COMP-4 by less than 0.5 %; COMP-1 peaks at 22
#: mm and then holds.
WALLS = {
    "COMP-4": ("wall_comp4", ["--rate", "40", "--vtk-every", "100"]),
    "COMP-1": ("wall_comp1", ["--until", "25", "--no-vtk"]),
}

#: ``low`` and ``high`` are options of a scene, "" the default; ``why`` tells where the range comes
#: from.
Row = namedtuple("Row", "name default low high why")
ENDS = "low", "high"


def bonds(*settings):
    """Options that set properties of bed and head joints alike."""
    return " ".join(f"--set {joint}.{s}" for joint in ("bed", "head") for s in settings)


def joint(name, *settings):
    return " ".join(f"--set {name}.{s}" for s in settings)


STIFF, SOFTER = "normalStiffness=1.157e11", "shearStiffness=4.986e10"  # of the modulus of table 2

ROWS = [
    Row("rate 20…100 mm/s", "", "--rate 20", "--rate 100", "numerical choices alone"),
    Row("points where a joint yields 3…12", 8, "--points 3", "--points 12", "the same"),
    Row(
        "time step 0.76…0.78 of its limit",
        0.8,
        "--dt-fraction 0.76",
        "--dt-fraction 0.78",
        "chance",
    ),
    Row(
        "stiffness by the modulus of table 2",
        "eq. (26)",
        " ".join(
            (
                joint("bed", STIFF, SOFTER, "peakRatio=23.64"),
                joint("head", "normalStiffness=1.865e10", "shearStiffness=8.038e9"),
                joint("head", "peakRatio=3.811"),
                joint("support", STIFF, SOFTER),
            )
        ),
        "",
        "table 2: 3174 MPa across bed and 2212 MPa across head joints",
    ),
    Row(
        "softening by rate, crushing with shear on the cap",
        "the paper's",
        "",
        "--joints cyclic " + bonds("compressionStiffnessLoss=0", "bondLossByCrushing=0"),
        "the cyclic law without its losses",
    ),
    # what the paper leaves open: yade_plugin/law/README.md, parameters
    Row(
        "GfI 8…32 J/m²",
        16,
        bonds("modeIFractureEnergy=8"),
        bonds("modeIFractureEnergy=32"),
        "half (the authors' other rule) and double",
    ),
    Row(
        "GfII 80…320 J/m²",
        160,
        bonds("modeIIFractureEnergy=80"),
        bonds("modeIIFractureEnergy=320"),
        "half (the authors' other rule) and double",
    ),
    Row(
        "GfI and GfII together",
        "16, 160",
        bonds("modeIFractureEnergy=8", "modeIIFractureEnergy=80"),
        bonds("modeIFractureEnergy=32", "modeIIFractureEnergy=320"),
        "both follow from one strength in either rule",
    ),
    Row(
        "linear softening",
        "exponential",
        "",
        bonds("tensionTable=1:0,1072.6:1", "shearTable=1:0,3821.5:1"),
        "another shape with the same two energies",
    ),
    Row(
        "residual friction 0.30…0.43",
        0.43,
        bonds("residualFriction=0.30"),
        "",
        "0.7 of the peak value; at most the peak value",
    ),
    Row(
        "residual cohesion 0…0.033 MPa",
        0,
        "",
        bonds("residualCohesion=0.033e6"),
        "0 at least; 0.3 of the peak value",
    ),
    Row(
        "dilatancy 0…0.1, lasting",
        0,
        "",
        bonds("dilatancy=0.1"),
        "0 at least; a joint that climbs 0.1 mm a mm of slip",
    ),
    Row(
        "dilatancy 0…0.4, passing",
        0,
        "",
        bonds("dilatancy=0.4", "dilatancyDecay=1e4"),
        "0 at least; friction at most, worn off by 0.1 mm of slip",
    ),
    Row(
        "residual compression 0.1…0.4 fc",
        0.2,
        bonds("residualStrengthRatio=0.1"),
        bonds("residualStrengthRatio=0.4"),
        "half and double",
    ),
    Row(
        "elastic limit 0.2…0.4 fc",
        0.3,
        bonds("elasticLimitRatio=0.2"),
        bonds("elasticLimitRatio=0.4"),
        "the paper says 30 to 40 %; 20 % to the other side",
    ),
    Row(
        "cap Css 4…16",
        9,
        bonds("capShear=4"),
        bonds("capShear=16"),
        "largest shear stress of the cap fc/2 and fc/4, not fc/3",
    ),
    Row(
        "cap Cnn 0.8…1.25",
        1,
        bonds("capNormal=0.8"),
        bonds("capNormal=1.25"),
        "uniaxial strength 12 % higher and 11 % lower",
    ),
    Row(
        "cap Cn −0.75…0.75 MPa",
        0,
        bonds("capLinear=-0.75e6"),
        bonds("capLinear=0.75e6"),
        "a tenth of fc to either side; positive widens",
    ),
    Row(
        "cap's peak at ucp + uel",
        "ucp",
        "",
        bonds("peakRatio=68.8"),
        "paper eq. (18) to the letter: n grows by fel/fcp",
    ),
    # stiffnesses
    Row(
        "ks ½…2",
        "kn/(2(1+ν))",
        bonds("shearStiffness=0.7225e11"),
        bonds("shearStiffness=2.89e11"),
        "eq. (26) has the unit's ν for mortar: half and double",
    ),
    Row(
        "kn ½…2, same ucp",
        "3.352e11 Pa/m",
        bonds("normalStiffness=1.676e11", "peakRatio=34.25"),
        bonds("normalStiffness=6.704e11", "peakRatio=137"),
        "Em is a rule of thumb: half and double",
    ),
    Row(
        "support stiffness ⅓…3",
        "as bed",
        joint("support", "normalStiffness=1.117e11", "shearStiffness=0.4817e11"),
        joint("support", "normalStiffness=1.006e12", "shearStiffness=4.335e11"),
        "the paper says stiff and elastic, no more",
    ),
    # head joints
    Row(
        "head bond ½…1",
        "as bed",
        joint(
            "head",
            "tensileStrength=0.05e6",
            "cohesion=0.055e6",
            "modeIFractureEnergy=8",
            "modeIIFractureEnergy=80",
        ),
        "",
        "head joints are not as well filled as bed joints",
    ),
    Row(
        "head friction 0.3…0.6",
        0.43,
        joint("head", "friction=0.3", "residualFriction=0.3"),
        joint("head", "friction=0.6", "residualFriction=0.6", "tensileStrength=0.1e6"),
        "the table has one value for both",
    ),
    # brick crack surfaces: yade_plugin/law/README.md, crack surfaces
    Row(
        "brick ft 0.75…1.6 MPa",
        1.5,
        joint("crack", "tensileStrength=0.75e6"),
        joint("crack", "tensileStrength=1.6e6"),
        "half; with more than 1.61 softening snaps back between rigid halves",
    ),
    Row(
        "brick GfI 52…120 J/m²",
        60,
        joint("crack", "modeIFractureEnergy=52"),
        joint("crack", "modeIFractureEnergy=120"),
        "with less softening snaps back between rigid halves; double",
    ),
    Row(
        "brick cohesion 1.5…3.06 MPa",
        3,
        joint("crack", "cohesion=1.5e6"),
        joint("crack", "cohesion=3.06e6"),
        "half; with more softening snaps back between rigid halves",
    ),
    Row(
        "brick GfII 480…1000 J/m²",
        500,
        joint("crack", "modeIIFractureEnergy=480"),
        joint("crack", "modeIIFractureEnergy=1000"),
        "with less softening snaps back between rigid halves; double",
    ),
    Row(
        "brick friction 0.6…1",
        0.75,
        joint("crack", "friction=0.6", "residualFriction=0.6"),
        joint("crack", "friction=1", "residualFriction=1"),
        "31° to 45°",
    ),
    Row(
        "brick surface kn, ks ⅓…3",
        "10 × bed",
        joint("crack", "normalStiffness=1.117e12", "shearStiffness=0.4817e12"),
        joint("crack", "normalStiffness=1.006e13", "shearStiffness=4.335e12"),
        "a number that only has to be high",
    ),
    Row(
        "no brick crack surfaces",
        "on",
        "--crack-surfaces off",
        "",
        "bricks that cannot crack",
    ),
    # measured values, the paper's table 2, beside them for scale
    Row(
        "measured: friction ∓10 %",
        0.43,
        bonds("friction=0.387", "residualFriction=0.387"),
        bonds("friction=0.473", "residualFriction=0.473"),
        "scatter of a triplet test",
    ),
    Row(
        "measured: cohesion ∓20 %",
        "0.11 MPa",
        bonds("cohesion=0.088e6"),
        bonds("cohesion=0.132e6"),
        "scatter of a triplet test",
    ),
    Row(
        "measured: ft ∓20 %",
        "0.10 MPa",
        bonds("tensileStrength=0.08e6"),
        bonds("tensileStrength=0.12e6"),
        "scatter of a bond test",
    ),
    Row(
        "measured: fc ∓10 %, same ucp, Gc ∓10 %",
        "7.55, 5.93 MPa",
        joint(
            "bed",
            "compressiveStrength=6.795e6",
            "peakRatio=76.11",
            "compressiveFractureEnergy=13500",
        )
        + " "
        + joint(
            "head",
            "compressiveStrength=5.337e6",
            "peakRatio=76.11",
            "compressiveFractureEnergy=28350",
        ),
        joint(
            "bed",
            "compressiveStrength=8.305e6",
            "peakRatio=62.27",
            "compressiveFractureEnergy=16500",
        )
        + " "
        + joint(
            "head",
            "compressiveStrength=6.523e6",
            "peakRatio=62.27",
            "compressiveFractureEnergy=34650",
        ),
        "scatter of a prism test",
    ),
]


def folder(wall, row=None, end=None):
    """Folder of a run's results; without a row, or at an end without options, that of the run with
    all defaults."""
    name = f"{row.name} {end}" if row and getattr(row, end) else "default"
    return os.path.join(RESULTS, "validation", "sensitivity", wall, nameOf(name).replace("-", "_"))


def runAll():
    runMissing(
        [
            (scene, options + getattr(row, end, "").split(), folder(wall, row, end))
            for wall, (scene, options) in WALLS.items()
            for row, end in [(None, ""), *((r, e) for r in ROWS for e in ENDS)]
            if not row or getattr(row, end)
        ]
    )


def numbers(wall, row=None, end=None):
    """Measured numbers of a run, or None if it was not run."""
    out = folder(wall, row, end)
    return measure(out) if done(out) else None


#: From this reach on the crack of COMP-4 goes along its diagonal.
DIAGONAL = readCase("wall_comp4")["rigid"]["limits"]["diagonal_reach"][0]

#: What is shown: title and name of the number.
SHOWN = {"peak": "peak_base_shear_kN", "force at the end": "base_shear_end_kN"}


def lines(ranges):
    """Changes of peak and end force in percent and reach of the diagonal crack, low and high: a
    line a row."""
    for row in ROWS:
        cells = [row.name, row.default, row.why]
        for wall in WALLS:
            low, high, base = ranges[wall, row]
            for name in SHOWN.values():
                changes = (100 * (r[name] / base[name] - 1) for r in (low, high))
                cells.append(", ".join(f"{change:+.1f}" for change in changes))
        low, high, _ = ranges["COMP-4", row]
        yield [*cells, f"{low['diagonal_reach']}, {high['diagonal_reach']}"]


def draw(ranges):
    """tornado.png: a bar a value, from low to high, as change from the default in percent; longest
    on top.

    A bar is hatched where the wall does not crack along its diagonal any more.
    """
    panels = [(wall, title) for title in SHOWN for wall in WALLS]
    change = lambda wall, row, title: [
        100 * (r[SHOWN[title]] / ranges[wall, row][2][SHOWN[title]] - 1)
        for r in ranges[wall, row][:2]
    ]
    reach = lambda row: max(abs(v) for p in panels for v in change(p[0], row, p[1]))
    rows = sorted(ROWS, key=reach)
    figure, axes = plt.subplots(1, len(panels), figsize=(13, 0.27 * len(rows) + 1.3), sharey=True)
    for axis, (wall, title) in zip(axes, panels):
        for y, row in enumerate(rows):
            for end, color, value, result in zip(
                ("low", "high"),
                ("tab:blue", "tab:red"),
                change(wall, row, title),
                ranges[wall, row],
            ):
                slides = result.get("diagonal_reach", DIAGONAL) < DIAGONAL
                hatch = "/////" if slides else None
                if getattr(row, end):
                    axis.barh(y, value, color=color, height=0.7, alpha=0.7, hatch=hatch)
        axis.axvline(0, color="black", lw=0.8)
        base = ranges[wall, rows[0]][2][SHOWN[title]]
        axis.set_title(f"{wall}, {title}\n{base:.1f} kN with defaults", fontsize=10)
        axis.set_xlabel("change [%]")
        axis.grid(axis="x", alpha=0.3)
    axes[0].margins(y=0.01)
    axes[0].set_yticks(range(len(rows)), [row.name for row in rows], fontsize=8)
    figure.suptitle(
        "blue: lower end of the range, red: upper end; hatched: no crack along the diagonal; rigid"
        " units"
    )
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "tornado.png"), dpi=90)


if __name__ == "__main__":
    if sys.argv[1:] != ["--draw"]:
        runAll()
    ranges = {
        (wall, row): [*(numbers(wall, row, end) for end in ENDS), base]
        for wall in WALLS
        for base in [numbers(wall)]
        for row in ROWS
    }
    ROWS = [row for row in ROWS if all(all(ranges[w, row]) for w in WALLS)]
    heads = [f"{wall} {title} %" for wall in WALLS for title in ("peak", "end")]
    heads = ["value", "default", "why this range", *heads, "COMP-4 reach"]
    print(table(heads, lines(ranges)))
    draw(ranges)
