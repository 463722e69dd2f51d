# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene is, in words: what is built, and what is held, loaded and watched. Notebooks show it, and run.json has it."""

import collections
import statistics

from ..basics import say
from ..bricks import Bricks, summary

MOST_SIZES = 4  # of blocks that are listed


def sizes(description):
    """What is built: pairs of texts, what and how much."""
    bricks = Bricks(description.bricks)
    found = summary(bricks)
    kinds = ", ".join(f"{count} {kind}" for kind, count in found["kinds"].items())
    size = " × ".join(f"{b - a:.4g}" for a, b in zip(found["low_m"], found["high_m"]))
    blocks = collections.Counter(_size(block) for block in description.bricks)
    most = blocks.most_common(MOST_SIZES)
    sizes = "; ".join(f"{count} of {text} mm" for text, count in most)
    sizes += "; and others" * (len(blocks) > len(most))
    yield "blocks", f"{found['blocks']:,} in {found['bricks']:,} bricks ({kinds})"
    if len(found["parts"]) > 1:
        parts = found["parts"].items()
        yield "parts", ", ".join(f"{name}: {count:,} blocks" for name, count in parts)
    if found["courses"]:
        yield "courses", f"{found['courses']}"
    yield "size", f"{size} m (x × y × z), {found['volume_m3']:.4g} m³"
    yield "sizes of blocks", sizes
    yield "moves", "in the x-z plane" if description.plane else "in space"
    model = "deformable" if description.deformable else "rigid"
    yield "block model", model


def _size(block):
    return " × ".join(f"{1e3 * (b - a):.4g}" for a, b in zip(block.low, block.high))


def properties(description, masonry):
    """What decides whether a scene is like the walls on which a preset was measured: values by the names in
    :data:`masonry.run.presets.RANGE`; None for a scene in space.

    :param masonry: its materials
    """
    if not description.plane:
        return None
    length, _, height = (b - a for a, b in zip(description.low, description.high))
    boxes = {}  # of whole bricks, of which there may be two halves
    for block in description.bricks:
        low, high = boxes.get(block.brick, (block.low, block.high))
        boxes[block.brick] = tuple(map(min, low, block.low)), tuple(map(max, high, block.high))  # fmt: skip
    medianSize = lambda axis: statistics.median(high[axis] - low[axis] for low, high in boxes.values())  # fmt: skip
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
    """What is held, loaded and watched before the first stage: pairs of texts, its name and what is done to it."""
    for target in description.targets.values():
        where = (
            "the ground"
            if not target.joined
            else "platen"
            if target.box
            else f"brick {target.brick}"
        )
        what = [f"{where}, {_freedom(target)}"]
        if target.pressed:
            what.append(f"pressed by {1e-6 * target.pressed:.4g} MPa")
        if target.force:
            what.append("dead load ({:.6g}, {:.6g}, {:.6g}) N".format(*target.force))
        if target.drives:
            what.append(f"a drive holds it along {', '.join(target.drives)}")
        yield target.name, "; ".join(what)
    if description.winds:
        force = [sum(w.force[i] for w in description.winds) for i in range(3)]
        yield "pressure on faces", "({:.4g}, {:.4g}, {:.4g}) N in all".format(*force)
    recorded = [thing.name for thing in (*description.joints, *description.drifts, *[one for one in description.sections if not one.isBase])]  # fmt: skip
    if recorded:
        yield "recorded, too", ", ".join(recorded)


def _freedom(target):
    """What a target can do, in words."""
    freedom = target.freedom or ""
    along = [axis for axis in "xyz" if axis in freedom]
    about = [axis.lower() for axis in "XYZ" if axis in freedom]
    if len(along + about) == 6:
        return "held"
    held = [f"along {', '.join(along)}"] * bool(along)
    held += [f"about {', '.join(about)}"] * bool(about)
    return f"held {' and '.join(held)}" if held else "free"


def noteCourse(description):
    """Say that the bricks are not those for which the stiffness of the joints was made."""
    course = description.materials.course
    heights = {block.high[2] - block.low[2] for block in description.bricks}
    if course and not any(abs(h - course) < 0.01 * course for h in heights):
        sizes = ", ".join(f"{1e3 * h:.4g}" for h in sorted(heights)[:5])
        say(
            f"note: the joints are for courses of {1e3 * course:.4g} mm, mortar included, and the bricks have {sizes} mm: "
            "give bricks the same unit= and joint= as the materials"
        )
