# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene does when the structure falls and ``Scene(..., collapse="follow")`` asks for it: it
goes on until the rubble is at rest, and says what fell, when and where it lies."""

import csv
import math
from dataclasses import dataclass
from typing import Any

from yade import O, Vector3

from ..model.bodies import placeOf
from ..model.motion import REST
from .. import folders
from ..units import GRAVITY
from ..terminal import say
from .answers import FALL, FALLEN_AT_REST, FALLEN_MOVING, Answer

CHECK_INTERVAL = 0.05  # time from row to row, over √(side/g) of the largest block [-]
FRAME = 4  # rows from frame to frame
REST_SPEED_RATIO = 0.1  # largest Motion.fastest() of rubble at rest [-]
CONSECUTIVE_CHECKS = 40  # that find the rubble at rest, before it is said to be
LONGEST = 20.0  # time after which it is given up, over √(2h/g) of the height of what is built [-]
TABLE = "fallen.csv"


@dataclass
class Falling:
    """What the stage remembers."""

    begun: float = -1.0  # when the collapse was noticed [s]
    rows: int = 0  # so far
    step: float = 0.0  # the time step now [s]
    nextFrame: int = 0  # number of the row after which a frame is due
    quiet: int = 0  # rows with the rubble at rest, one after the other


def followFall(scene: Any, tilted: bool) -> str:
    """Go on with what falls until it is at rest. Returns how that ended.

    Loads stay, also the gravity of a ground that is ``tilted``; another horizontal acceleration
    ends when the first block has fallen. Drives and supports stand still. The numerical damping of
    the options acts on what stands, not on what no joint holds.
    """
    model, running, box = scene.model, scene.running, scene.description
    at = running.stage(FALL, Falling())
    if at.begun < 0:
        at.begun = O.time
        if not running.isResumed:
            running.frame()  # whose cracks are drawn
    # what stands comes to rest; blocks that are loose are not damped so
    model.scheme.dampByOptions()
    model.letFall()
    model.scheme.followStep()
    at.step = at.step or O.dt
    gravity, height = abs(box.gravity) or GRAVITY, box.high[2] - box.low[2]
    small = math.sqrt(max(map(box.size, range(len(box.bricks)))) / gravity)
    interval = CHECK_INTERVAL * small
    longest = LONGEST * (math.sqrt(2 * height / gravity) + small)
    most = max(CONSECUTIVE_CHECKS, int(longest / interval))
    while at.rows < most and at.quiet < CONSECUTIVE_CHECKS:
        running.advance(max(1, round(interval / at.step)))
        at.step = O.dt
        at.rows += 1
        running.record()
        missing, _ = model.supports.unrest()
        rests = missing < REST and model.motion.fastest() < REST_SPEED_RATIO
        at.quiet = at.quiet + 1 if rests else 0
        if at.rows >= at.nextFrame:
            running.frame()
            at.nextFrame = at.rows + FRAME
        fallen = len(model.fallen())
        if fallen and not tilted:
            model.scheme.setGravity(-model.gravity * Vector3.UnitZ)
        running.show(
            at.rows / most,
            lambda: f"{O.time - at.begun:.3f} s, {fallen} blocks have fallen",
            at.quiet == CONSECUTIVE_CHECKS or at.rows == most,
        )
    running.flush()
    past = sum(not model.onGround(index) for index in model.fallen())
    if past:
        say(
            f"warning: {past} blocks have left the ground over its edge and were stopped there; the"
            " rubble and the impact energy are those of all others; ground(level, reach=...) makes"
            " it larger"
        )
    if at.quiet < CONSECUTIVE_CHECKS:
        say(
            f"note: the rubble is not at rest after {O.time - at.begun:.2f} s:"
            f" {100 * missing:.2f} % of its weight is missing at the supports, and the fastest"
            f" block moves at {100 * model.motion.fastest():.2g} % of the speed of one that falls"
        )
    return FALLEN_AT_REST if at.quiet == CONSECUTIVE_CHECKS else FALLEN_MOVING


def cornersNow(model: Any, index: int) -> list[Any]:
    """Where the corners of a block are now [m]."""
    corners = model.description.bricks[index].corners
    return [placeOf(model.ids[index], corner) for corner in corners]


def volume(model: Any, index: int) -> float:
    """Volume of a block [m³]."""
    body = O.bodies[model.ids[index]]
    return float(body.state.mass / body.mat.density)


def answers(scene: Any, ended: str, begun: float) -> list[Answer]:
    """What fell, when, how fast, and where it lies, by how the fall ended and when the collapse was
    noticed [s]."""
    model, box = scene.model, scene.description
    fallen, atRest = model.fallen(), ended == FALLEN_AT_REST
    masses = [O.bodies[body].state.mass for body in model.ids]
    mass = sum(masses[index] for index in fallen)
    when = "" if atRest else f"{ended}: "
    what = (
        "blocks that have turned by 60°, or moved by their diameter and come down by half their"
        " thickness, since the scene was built"
    )
    built = "since the scene was built"
    rest = "from then on until all was at rest"
    found = [
        ("fallen_blocks", "-", len(fallen), f"{when}{what}, of {len(masses)}"),
        (
            "fallen_share",
            "-",
            mass / (sum(masses) or 1.0),
            f"{when}mass of these over that of all blocks",
        ),
        ("noticed_at", "s", begun, f"when the collapse was noticed, {built}"),
        ("time_to_rest", "s", O.time - begun if atRest else None, rest),
    ]
    first = min((one["fell"] for one in fallen.values()), default=None)
    lost = [index for index in fallen if not model.onGround(index)]
    if lost:
        how = f"{when}fallen blocks that went over the edge of the ground and were stopped there"
        found.append(("left_the_ground", "-", len(lost), f"{how}; what follows is without them"))
    fallen = {index: one for index, one in fallen.items() if index not in lost}
    if first is not None:
        found.append(
            ("first_fall", "s", first, f"when the first block had fallen, {built}"),
        )
    if fallen:
        mass = sum(masses[index] for index in fallen)
        energy = sum(one["most"] for one in fallen.values())
        bulk = sum(volume(model, index) for index in fallen)
        corners = [c for index in fallen for c in cornersNow(model, index)]
        low, high = ([f(values) for values in zip(*corners)] for f in (min, max))
        ground = box.ground().box[1][2]
        reach = max(max(0.0, box.low[i] - low[i], high[i] - box.high[i]) for i in range(2))
        lies = f"{when}of the corners of the fallen blocks"
        extent = f"{lies}, from the first to the last"
        without = f"{when}of the fallen blocks, without what lies between them"
        beside = f"{lies}: how far they lie beside the box around what was built"
        loose = "sum of the largest kinetic energy that every fallen block had since it came loose"
        found += [
            ("fallen_mass", "kg", mass, f"{when}of the fallen blocks"),
            ("rubble_volume", "m³", bulk, without),
            ("rubble_length_x", "m", high[0] - low[0], extent),
            ("rubble_length_y", "m", high[1] - low[1], extent),
            ("rubble_height", "m", high[2] - ground, f"{lies}, above the ground"),
            ("rubble_reach", "m", reach, beside),
            ("impact_energy", "J", energy, f"{when}{loose}"),
        ]
    return [Answer(*one) for one in found]


#: Columns of fallen.csv.
HEADS = (
    "block brick part x_m y_m z_m mass_kg volume_m3 loose_at_s fallen_at_s largest_kinetic_energy_J"
    " at_s now_x_m now_y_m now_z_m moved_m turned_deg speed_m_per_s"
).split()


def writeTable(scene: Any) -> None:
    """Write fallen.csv: a row for every fallen block. Raises Unwritable."""
    model, box = scene.model, scene.description
    rows = []
    for index, fall in model.fallen().items():
        state, block = O.bodies[model.ids[index]].state, box.bricks[index]
        turn = (state.ori * state.refOri.conjugate()).toAxisAngle()[1]
        rows.append(
            [
                index,
                block.brick,
                block.part,
                *box.middle(index),
                state.mass,
                volume(model, index),
                fall["since"],
                fall["fell"],
                fall["most"],
                fall["at"],
                *state.pos,
                (state.pos - state.refPos).norm(),
                math.degrees(turn),
                state.vel.norm(),
            ]
        )
    path = scene.results.path(TABLE)
    text = lambda v: f"{v:.9g}" if isinstance(v, float) else v
    with folders.writing(path), open(path, "w", newline="") as file:
        csv.writer(file).writerows([HEADS, *([text(v) for v in row] for row in rows)])
