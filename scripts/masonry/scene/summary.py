# SPDX-License-Identifier: GPL-2.0-or-later
"""What is built, held, loaded and watched, in words for run.json; and whether it is a wall in
running bond."""

import collections
import math
import statistics

from ..bricks import Bricks, summary
from ..materials import loadingBlock
from ..terminal import say
from ..units import GRAVITY

MAX_SIZES = 4  # of blocks that are listed


def sizes(description):
    """What is built: pairs of texts, what and how much."""
    counts = summary(Bricks(description.bricks))
    kinds = ", ".join(f"{count} {kind}" for kind, count in counts["kinds"].items())
    by = lambda low, high, unit: " × ".join(f"{unit * (b - a):.4g}" for a, b in zip(low, high))
    blocks = collections.Counter(by(b.low, b.high, 1e3) for b in description.bricks)
    most = blocks.most_common(MAX_SIZES)
    sizes = "; ".join(f"{count} of {text} mm" for text, count in most)
    size = by(counts["low_m"], counts["high_m"], 1)
    yield "blocks", f"{counts['blocks']:,} in {counts['bricks']:,} bricks ({kinds})"
    if len(counts["parts"]) > 1:
        parts = counts["parts"].items()
        yield "parts", ", ".join(f"{name}: {count:,} blocks" for name, count in parts)
    if counts["courses"]:
        yield "courses", f"{counts['courses']}"
    yield "size", f"{size} m (x × y × z), {counts['volume_m3']:.4g} m³"
    yield "sizes of blocks", sizes + "; and others" * (len(blocks) > len(most))
    yield "moves", "in the x-z plane" if description.plane else "in space"
    yield "block model", "deformable" if description.deformable else "rigid"


def properties(description, masonry):
    """Values by the names in :data:`masonry.run.presets.RANGE`, which tell whether a scene is like
    the walls on which a preset was measured; None for a scene in space."""
    if not description.plane:
        return None
    length, _, height = (b - a for a, b in zip(description.low, description.high))
    boxes = {}  # of whole bricks, of which there may be two halves
    for block in description.bricks:
        low, high = boxes.get(block.brick, (block.low, block.high))
        boxes[block.brick] = tuple(map(min, low, block.low)), tuple(map(max, high, block.high))
    medianSize = lambda axis: statistics.median(
        high[axis] - low[axis] for low, high in boxes.values()
    )
    pressed = [t.pressed for t in description.targets.values() if t.pressed]
    bed = masonry.joints["bed"]
    of = lambda name: getattr(bed, name, 0.0)
    return {
        "length over height": length / height,
        "courses": height / medianSize(2),
        "bricks in the length": length / medianSize(0),
        "pressure at the top [MPa]": 1e-6 * sum(pressed),
        "tensile strength of bed joints [MPa]": 1e-6 * of("tensileStrength"),
        "cohesion of bed joints [MPa]": 1e-6 * of("cohesion"),
        "friction of bed joints": of("friction"),
    }


def held(description):
    """What is held, loaded and watched before the first stage: pairs of a name and a text."""
    for target in description.targets.values():
        where = "platen" if target.box else f"brick {target.brick}"
        where = where if target.joined else "a line of springs" if target.line else "the ground"
        what = [f"{where}, {_freedom(target.freedom or '')}"]
        if target.pressed:
            what.append(f"pressed by {1e-6 * target.pressed:.4g} MPa" + _machine(target))
        if target.force:
            what.append("dead load ({:.6g}, {:.6g}, {:.6g}) N".format(*target.force))
        if target.drives:
            what.append(f"a drive holds it along {', '.join(target.drives)}")
        yield target.name, "; ".join(what)
    platens = [t for t in description.targets.values() if t.box and t.joined]
    if platens:
        weights = ", ".join(f"{t.name} {1e-3 * weightOf(t):.4g} kN" for t in platens)
        yield "weight of platens", f"{weights}; they are rigid: only their support joints give way"
    if description.winds:
        force = [sum(w.force[i] for w in description.winds) for i in range(3)]
        yield "pressure on faces", "({:.4g}, {:.4g}, {:.4g}) N in all".format(*force)
    sections = [one for one in description.sections if not one.isBase]
    recorded = [*description.joints, *description.drifts, *sections]
    if recorded:
        yield "recorded, too", ", ".join(one.name for one in recorded)


def _machine(target):
    friction, stiffness = f"{target.friction:.4g} of friction", target.stiffness
    follows = f"{1e-6 * stiffness:.4g} kN/mm of uplift"
    found = [friction] * (target.friction > 0) + [follows] * (stiffness > 0)
    return f", by a machine with {' and '.join(found)}" if found else ""


def weightOf(platen):
    """[N]"""
    size = math.prod(b - a for a, b in zip(*platen.box))
    return GRAVITY * loadingBlock().density * size if platen.weight is None else platen.weight


def notePlatens(description, masonry):
    """Say what platens weigh that act on the structure, and what gives way."""
    moving = [
        t for t in description.targets.values() if t.box and not t.fixed and description.gravity
    ]
    for platen in moving:
        own = f", as {loadingBlock().density:g} kg/m³" if platen.weight is None else ""
        stiffness = masonry.joints["support"].normalStiffness
        say(
            f"platen {platen.name}: weighs {1e-3 * weightOf(platen):.4g} kN{own}, which weight="
            f" changes; rigid, on a support joint of {stiffness:.4g} Pa/m"
        )


def _freedom(freedom):
    every = {"along": "xyz", "about": "XYZ"}
    axes = {how: [a for a in of if a in freedom] for how, of in every.items()}
    held = [f"{how} {', '.join(of).lower()}" for how, of in axes.items() if of]
    if set(freedom) >= {*"xyzXYZ"}:
        return "held"
    return f"held {' and '.join(held)}" if held else "free"


def noteCourse(description):
    course = description.materials.course
    heights = {block.high[2] - block.low[2] for block in description.bricks}
    if course and not any(abs(h - course) < 0.01 * course for h in heights):
        sizes = ", ".join(f"{1e3 * h:.4g}" for h in sorted(heights)[:5])
        say(
            f"note: the joints are for courses of {1e3 * course:.4g} mm, mortar included, and the"
            f" bricks have {sizes} mm: give bricks the same unit= and joint= as the materials"
        )


def wallOf(description, loading):
    """The entry ``wall`` of run.json, for crack patterns, or None if the structure is no whole wall
    in running bond in the x-z plane that a platen pushes.

    :param loading: :class:`masonry.model.loading.Loading`
    """
    target, bricks = loading.target, description.bricks
    if not target.box:
        return None
    (left, front, bottom), (right, back, top) = description.low, description.high
    boxes = [[(min(c), max(c)) for c in zip(*block.corners)] for block in bricks]
    sizes = [[high - low for low, high in box] for box in boxes]
    height, half = sizes[0][2], min(size[0] for size in sizes)
    courses, columns = round((top - bottom) / height), round((right - left) / half)
    steps = [round(size[0] / half) for size in sizes]
    if (
        not description.plane
        or not (description.halves or {1, 2} == set(steps))
        or max(steps) > 2
        or any(abs(size[0] - n * half) > 1e-6 * half for size, n in zip(sizes, steps))
        or any(abs(size[2] - height) > 1e-6 * height for size in sizes)
        or sum(steps) != courses * columns
        or any(len(block.corners) != 8 for block in bricks)
    ):
        return None
    return {
        "corner_m": [left, bottom],
        "length_m": right - left,
        "height_m": top - bottom,
        "thickness_m": back - front,
        "courses": courses,
        "half_units": columns,
        "unit_m": [2 * half, back - front, height],
        "precompression_Pa": target.pressed or 0.0,
        "load_height_m": None if "Y" in target.freedom else target.point[2] - bottom,
        "measure_height_m": loading.control.recorded[2] - bottom,
        "pushed_towards": -1 if loading.push.direction[0] < 0 else 1,
        "load_line_fixed": not target.riding,
    }
