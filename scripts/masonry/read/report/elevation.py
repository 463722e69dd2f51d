# SPDX-License-Identifier: GPL-2.0-or-later
"""A drawing of what was built, as SVG: the blocks of the first frame before they moved. This module needs no YADE."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..escaping import Html, tag
from ..files import filesOf
from ..frames import readFrame
from ..motion import Motion
from ..views import hull, viewOf
from .pieces import written

WIDE, HIGHEST = 720, 460  # of the structure in the drawing, in its own units
RIM = 46
MOST_LABELS = 12  # names of blocks in the drawing
HATCHING = Html(
    '<defs><pattern id="hatching" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<rect width="7" height="7" class="platen plain"/><path d="M0 0v7" class="stroke"/></pattern></defs>'
)
CRACK_SURFACE = "crack"  # the kind of joint between the halves of a brick


def drawing(motion: Motion) -> tuple[Html, str]:
    """The drawing, and a sentence on how it is seen.

    Blocks that lie behind others are drawn first. What is not masonry, as platens, is grey.
    """
    with filesOf(motion.directory):
        joints = readFrame(motion.directory, "joints", motion.numbers[0])
        views = motion.run.get("views") or {}
        sight = next(iter(views.values()), None)
        view = viewOf(motion.points[motion.framed], joints["normal"], joints["area"], sight)  # fmt: skip
    flat = np.column_stack([motion.points @ view.right, motion.points @ view.up])
    framed = flat[motion.framed]
    low, high = framed.min(axis=0), framed.max(axis=0)
    size = np.maximum(high - low, 1e-9)
    scale = min(WIDE / size[0], HIGHEST / size[1])
    wide, tall = scale * size
    place = np.column_stack(
        [RIM + scale * (flat[:, 0] - low[0]), 12 + scale * (high[1] - flat[:, 1])]
    )
    unit = _units(motion, joints)[motion.owner]
    order = np.argsort(unit, kind="stable")
    starts = np.append(0, np.flatnonzero(np.diff(unit[order])) + 1)
    members = np.split(order, starts[1:])  # points of every unit
    depth = [(motion.points[points] @ view.towards).mean() for points in members]
    named = _named(motion)
    paths: list[list[Any]] = []  # of units of one kind that follow each other
    labels = []
    for number in np.argsort(np.round(depth, 6), kind="stable"):
        points = members[number]
        corners = hull(place[points].round(2))
        block = motion.owner[points[0]]
        if not motion.framed[points].any():
            continue
        kind = "brick" if motion.brick[block] else "platen"
        names = [named[b] for b in np.unique(motion.owner[points]) if b in named]
        if names:
            kind = "held" if any(held for _, held in names) else "named"
            middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
            labels.append((middle, ", ".join(name for name, _ in names)))
        if not paths or paths[-1][0] != kind:
            paths.append([kind, []])
        text = "L".join(f"{x:.1f} {y:.1f}".replace(".0 ", " ") for x, y in corners)
        paths[-1][1].append(f"M{text}Z")
    parts = [HATCHING]
    parts += [tag("path", d="".join(found), class_=kind) for kind, found in paths]
    if len(labels) <= MOST_LABELS:
        parts += [
            tag("text", name, x=f"{x:.1f}", y=f"{y + 4:.1f}", text_anchor="middle", class_="said")
            for (x, y), name in labels
        ]  # fmt: skip
    bricks = flat[motion.brick[motion.owner]] if motion.brick.any() else flat
    parts += _dimensions(bricks, low, high, scale, tall)
    about = _sentence(motion, view, bricks, unit)
    box = f"0 0 {wide + 2 * RIM + 30:.0f} {tall + 60:.0f}"
    return tag("svg", tag("title", "What was built"), tag("desc", about), *parts, viewBox=box, role="img", aria_label=about, class_="elevation"), about  # fmt: skip


def _named(motion):
    """Of the blocks that are held, loaded or watched: their names and whether they are held, by their numbers."""
    numbers = {int(body): n for n, body in enumerate(motion.bodies)}
    return {
        numbers[one["body"]]: (str(one["name"]), bool(one.get("held")))
        for one in motion.run.get("targets") or []
        if one.get("body") in numbers
    }


def _units(motion, joints):
    """For every block the number of its unit: blocks on both sides of a crack surface are the halves of one brick."""
    found = np.arange(len(motion.bodies))
    kinds = motion.run.get("kinds") or []
    if CRACK_SURFACE not in kinds:
        return found
    inside = joints["kind"] == kinds.index(CRACK_SURFACE)
    pairs = np.unique(np.searchsorted(motion.bodies, joints["bodies"][inside]), axis=0)
    for a, b in pairs[(pairs < len(found)).all(axis=1)]:
        found[found == found[b]] = found[a]
    return found


def _dimensions(bricks, low, high, scale, tall):
    """Lines with the length and the height of the masonry [m]."""
    start, end = bricks.min(axis=0), bricks.max(axis=0)
    across = [RIM + scale * (v - low[0]) for v in (start[0], end[0])]
    up = [12 + scale * (high[1] - v) for v in (start[1], end[1])]
    below, beside = tall + 26, RIM + scale * (high[0] - low[0]) + 18
    length, height = (f"{written(v, 4)} m" for v in end - start)
    middle = sum(up) / 2
    yield tag("path", d=f"M{across[0]:.1f} {below:.1f}H{across[1]:.1f}M{across[0]:.1f} {below - 5:.1f}v10M{across[1]:.1f} {below - 5:.1f}v10", class_="measure")  # fmt: skip
    yield tag("path", d=f"M{beside:.1f} {up[0]:.1f}V{up[1]:.1f}M{beside - 5:.1f} {up[0]:.1f}h10M{beside - 5:.1f} {up[1]:.1f}h10", class_="measure")  # fmt: skip
    yield tag("text", length, x=f"{sum(across) / 2:.1f}", y=f"{below + 18:.1f}", text_anchor="middle", class_="tick")  # fmt: skip
    yield tag("text", height, x=f"{beside + 16:.1f}", y=f"{middle:.1f}", transform=f"rotate(-90 {beside + 16:.1f} {middle:.1f})", text_anchor="middle", class_="tick")  # fmt: skip


def _sentence(motion, view, bricks, unit):
    """What the drawing shows."""
    size = np.ptp(bricks, axis=0)
    if view.name:
        seen = view.name
    else:
        axis = int(np.argmax(np.abs(view.towards)))
        exact = abs(view.towards[axis]) > 1 - 1e-6
        sign = "-" if view.towards[axis] > 0 else "+"
        seen = f"in the direction {sign}{'xyz'[axis]}" if exact else "from its front"
    count = len(np.unique(unit[motion.brick[motion.owner]]))
    others = " Platens are grey." if (~motion.brick).any() else ""
    if motion.run.get("targets"):
        others = " What is held is hatched; what is loaded or watched is grey."
    return (
        f"The {count:,} units of the masonry as built, seen {seen}: {written(size[0])} m wide and {written(size[1])} m high."
        f"{others}"
    )
