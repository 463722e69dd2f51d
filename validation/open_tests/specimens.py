# SPDX-License-Identifier: GPL-2.0-or-later
"""Small specimens in simulated tests: do they give back the properties that the joints were given?

yade -n -x validation/open_tests/specimens.py [--only NAME ...]

Triplet (EN 1052-3), bond wrench (EN 1052-5), wallettes in four-point bending (EN 1052-2) and
diagonal compression (ASTM E519) of the calcium-silicate masonry of masonry.materials.
"""

import os
import sys
from dataclasses import replace

import numpy as np

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import boundOf, finished, main, section, torque, words  # noqa: E402
import panels  # noqa: E402
from masonry import MasonryJoint, MasonryMat, Scene, bricks, materials  # noqa: E402

L, T, H = UNIT = bricks.walls.UNIT
BED = materials.calciumSilicate().joints["bed"]
POINTS = "--points", "16,16"


# -- triplet ---------------------------------------------------------------------------------------


def triplet():
    """Cohesion [MPa] and friction [-] by the line through the peaks of three bricks at 0.2, 0.6 and
    1.0 MPa, and the inputs."""
    stresses, peaks = (0.2, 0.6, 1.0), []
    for stress in stresses:
        scene = Scene(
            "triplet",
            bricks.stack(3, UNIT),
            materials.calciumSilicate(),
            gravity=0,
            arguments=words("triplet", "--rate", "5"),
        )
        scene.platen("bottom")
        top = scene.platen("top", guided="x")
        middle = scene.handle(1, name="middle")
        scene.press(top, 1e6 * stress)
        scene.settle()
        scene.push(middle, 0.3)
        found, _ = finished(scene)
        area = 1e3 * 2 * L * T  # of both joints, for kN to MPa
        peaks.append(found["peak_at_both_ends_kN"] / area)
    slope, cohesion = np.polyfit(stresses, peaks, 1)
    given = [f"{1e-6 * BED.cohesion:g}, {BED.friction:g}"]
    return ["cohesion MPa, friction", f"{cohesion:.4f}, {slope:.4f}", *given]


# -- bond wrench -----------------------------------------------------------------------------------


def wrench(blocks):
    """Flexural strength of a bond by a wrench with an arm of 1 m, over its direct tensile strength:
    run, and integral."""
    arm, size = 1.0, (T, L, H)  # [m] bent about the long side
    stack = bricks.stack(2, size)
    scene = Scene(
        "wrench",
        stack,
        materials.calciumSilicate(),
        gravity=0,
        arguments=words(
            "wrench",
            "--blocks",
            blocks,
            "--rate",
            "5",
            *(POINTS if blocks == "rigid" else ("--divisions", "6")),
        ),
    )
    scene.platen("bottom")
    top = scene.platen("top", rotation="free", upTo=H + arm)
    scene.settle()
    scene.push(top, 3)
    found, _ = finished(scene)
    strength = found["peak_at_both_ends_kN"] * 1e3 * arm * 6 / (L * T**2)
    ft, stiffness = BED.tensileStrength, 1 / (1 / BED.normalStiffness + lumped())
    own = section(ft, BED.modeIFractureEnergy, stiffness, T)
    return [(strength / 1e6, strength / ft, own / ft)]


def lumped():
    """What two rigid bricks add to the compliance of their joint [m/Pa]."""
    return H / materials.calciumSilicate().unit.young


# -- wallettes -------------------------------------------------------------------------------------


def wallette(parallel, bound=False, masonry=None, unit=UNIT, most=0.6e6):
    """Flexural strength in four-point bending [MPa]: the load that is held, or limit analysis,
    which grows to ``most`` [Pa].

    ``parallel``: the plane of failure is that of bed joints. Lines of half bricks are held and
    loaded at their middles, three courses, or three half bricks, apart from each other.
    """
    courses, halves = (10, 4) if parallel else (6, 10)
    L, T, H = unit
    axis, step = (2, H) if parallel else (0, L / 2)
    places = [step * (n + 0.5) for n in (0, 3, 6, 9)]
    blocks = bricks.Wall(halves * L / 2, courses * H, unit=unit)
    on = lambda b, place: abs(b.middle[axis] - place) < 0.1 * step
    blocks = bricks.Bricks(
        replace(b, part="line") if on(b, places[1]) or on(b, places[2]) else b for b in blocks
    )
    scene = Scene(
        "wallette",
        blocks,
        masonry or materials.calciumSilicate(),
        gravity=0,
        plane=False,
        arguments=words("wallette", *(("--preset", "bound") if bound else ())),
    )
    for n, block in enumerate(blocks):
        if on(block, places[0]) or on(block, places[3]):
            scene.hold(n, axes="xyz" if on(block, places[0]) else "y")
    scene.settle()
    arm = 3 * step
    share = step * arm * 6 / T**2  # stress over pressure, as M = pressure · step · arm
    scene.grow({}, pressure=most / share, towards=(0, 1, 0), part="line", over=0.5, within=0.02)
    if bound:
        scene.finish()
        return 1e-3 * share * boundOf(scene)
    found = scene.factor
    scene.finish()
    return 1e-3 * share * found


# -- torsion ---------------------------------------------------------------------------------------

LEVER = 0.2  # [m] of the bars that twist the upper brick


def joined(masonry, kind, material, like):
    """A masonry with blocks of a kind of their own material, which elastic joints, as stiff as
    another joint, hold together and to the bricks."""
    seat = dict(
        elastic=True, normalStiffness=like.normalStiffness, shearStiffness=like.shearStiffness
    )
    masonry.joints["seat"] = MasonryJoint(name="seat", **seat)
    masonry.units[kind] = material
    masonry.choose = lambda one, two, geom: (
        "seat" if one and two and kind in (one.kind, two.kind) else None
    )
    return masonry


def torsion(stress, most=1e3):
    """Cells of two clay bricks that overlap by half a unit, the upper one twisted about the
    vertical until the torque [N m] is not held, by bars at both of its ends."""
    length, thick, high = panels.UNIT
    sides, masonry = (length / 2, thick), panels.masonryOf()
    bed = masonry.joints["bed"]
    blocks = bricks.stack(2, (*sides, high))
    for x in (-LEVER, sides[0]):
        low, top = (x, 0, 1.25 * high), (x + LEVER, thick, 1.75 * high)
        blocks += bricks.block(low, top, part="bar", kind="bar")
    steel = MasonryMat(label="bar", young=200e9, poisson=0.0, density=7850)
    scene = Scene(
        "torsion",
        blocks,
        joined(masonry, "bar", steel, bed),
        gravity=0,
        plane=False,
        arguments=words("torsion", *POINTS),
    )
    scene.platen("bottom")
    if stress:
        scene.press(scene.platen("top", rotation="free", height=0.02), stress)
    bars = [scene.handle(n) for n in (2, 3)]
    scene.settle()
    force = most / (sides[0] + LEVER)
    scene.grow(dict(zip(bars, ((0, -force, 0), (0, force, 0)))), over=0.5, within=0.01)
    found = most * scene.factor
    scene.finish()
    short, long = sorted(sides)
    elastic = (short * long) ** 2 / (3 * long + 1.8 * short)  # [m³] Saint-Venant, as in AS 3700
    willis = (1.6 * panels.WRENCH + 0.9 * stress) * elastic
    own = torque(bed, sides, stress)
    return rowOf("torque N m", found, f"integral {own:.4g}", f"Willis {willis:.4g}")


# -- diagonal compression --------------------------------------------------------------------------

SIDES, SHOE, PLATE = (
    (1.1, 1.134),
    0.152,
    0.05,
)  # [m] of the panel, of the shoes and their thickness


def shoe(corner, sign):
    """Two plates around a corner, 152 mm on both sides: blocks that an elastic joint holds
    together."""
    (x, z), reach = corner, sign * SHOE
    lying = sorted((x - reach, x + sign * PLATE)), sorted((z, z + sign * PLATE))
    standing = sorted((x, x + sign * PLATE)), sorted((z - reach, z))
    box = lambda xs, zs: bricks.block(
        (xs[0], 0, zs[0]), (xs[1], T, zs[1]), part="shoe", kind="shoe"
    )
    return box(*lying) + box(*standing)


def diagonal(bound=False):
    """The force along the diagonal of a panel [kN]: a run, or limit analysis."""
    panel = bricks.Wall(SIDES[0], SIDES[1])
    blocks = panel + shoe((0, 0), -1) + shoe(SIDES, 1)
    steel = MasonryMat(label="steel", young=200e9, poisson=0.0, density=7850)
    masonry = joined(materials.calciumSilicate(), "shoe", steel, BED)
    more = ("--preset", "bound") if bound else ("--rate", "5")
    scene = Scene("diagonal", blocks, masonry, gravity=0, arguments=words("diagonal", *more))
    for n in (-4, -3):
        scene.hold(len(blocks) + n)
    pushed = scene.handle((SIDES[0] + PLATE / 2, T / 2, SIDES[1] + PLATE / 2), name="shoe")
    scene.settle()
    scene.push(pushed, 1.5, direction=(-SIDES[0], 0, -SIDES[1]))
    if bound:
        scene.finish()
        return boundOf(scene)
    return finished(scene)[0]["peak_at_both_ends_kN"]


def firstSlip():
    """Force [kN] at which bed joints in the middle would slip, by Frocht's elastic stresses 0.5 P/A
    and -1.62 P/A at 45 degrees."""
    normal, shear = (0.5 - 1.62) / 2, (0.5 + 1.62) / 2
    area = T * sum(SIDES) / 2
    return 1e-3 * BED.cohesion * area / (shear + normal * BED.friction)


def rowOf(what, measured, *others):
    """Cells: what, measured, and texts of what it is compared with."""
    return [what, f"{measured:.4g}", "; ".join(others)]


def bent(parallel):
    """Cells of a wallette."""
    aim = dict(most=0.6e6 if parallel else 2e6)
    held, most = wallette(parallel, **aim), wallette(parallel, bound=True, **aim)
    return rowOf(
        "flexural strength MPa",
        held,
        f"limit analysis {most:.4g}",
        *others(parallel, BED, lumped(), T),
    )


def others(parallel, bed, soft, depth):
    """What the flexural strength across bed joints is compared with, as a list of texts."""
    stiffness = 1 / (1 / bed.normalStiffness + soft)
    own = section(bed.tensileStrength, bed.modeIFractureEnergy, stiffness, depth)
    return [f"integral {1e-6 * own:.4g}"] if parallel else []


def bentClay(parallel, **changed):
    """Cells of a wallette of the brickwork of panels.py, beside AS 3700: stepped and straight
    cracks."""
    masonry = panels.masonryOf(**changed)
    held = wallette(parallel, masonry=masonry, unit=panels.UNIT, most=2e6 if parallel else 4e6)
    bond, rupture = 1e-6 * panels.WRENCH, 1e-6 * panels.RUPTURE
    texts = [f"AS 3700 stepped {2 * bond**0.5:.3g}, straight {0.44 * rupture + 0.56 * bond:.3g}"]
    if parallel:
        soft = panels.UNIT[2] / masonry.unit.young
        texts = [
            f"bond wrench {bond:g}",
            *others(True, masonry.joints["bed"], soft, panels.UNIT[1]),
        ]
    return rowOf("flexural strength MPa", held, *texts)


def wrenched():
    """Cells of the bond wrench."""
    _, ratio, own = wrench("rigid")[0]
    return rowOf("flexural over direct tensile strength", ratio, f"integral {own:.4g}")


def compressed():
    """Cells of the diagonal compression."""
    force, most = diagonal(), diagonal(bound=True)
    stress = 0.707 * force / (1e3 * T * sum(SIDES) / 2)
    return rowOf(
        "force kN",
        force,
        f"first slip {firstSlip():.3g}",
        f"limit analysis {most:.4g}",
        f"ASTM shear stress {stress:.3g} MPa",
    )


CASES = {
    "triplet": triplet,
    "bond wrench": wrenched,
    "wallette, parallel": lambda: bent(True),
    "wallette, perpendicular": lambda: bent(False),
    "diagonal compression": compressed,
    "torsion of an overlap": lambda: torsion(0.0),
    "torsion of an overlap at 0.1 MPa": lambda: torsion(0.1e6),
    "torsion of an overlap at 0.5 MPa": lambda: torsion(0.5e6),
    "clay wallette, parallel": lambda: bentClay(True),
    "clay wallette, perpendicular": lambda: bentClay(False),
    "clay wallette, perpendicular, bricks do not crack": lambda: bentClay(False, unit_ft=None),
    "clay wallette, perpendicular, cohesion 0.7 of ft": lambda: bentClay(False, cohesion=0.7),
}

if __name__ == "__main__":
    sys.exit(main(__doc__, ["what", "run", "given, or compared with"], CASES))
