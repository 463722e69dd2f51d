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
from ..units import GRAVITY
from ..errors import Unwritable
from ..terminal import say
from .answers import FALL, FALLEN_AT_REST, FALLEN_MOVING, Answer

LOOK = 0.05  # time between two looks and rows, over √(side/g) of the largest block [-]
FRAME = 4  # looks from one frame to the next
# speed of the fastest block of rubble at rest, over that of one that falls [-]: see
# Motion.fastest()
REST_SPEED_RATIO = 0.1
CONSECUTIVE_CHECKS = (
    40  # so many looks one after the other find the rubble at rest before it is said to be
)
#: After which it is given up, over √(2h/g) of the height of what is built [-].
LONGEST = 20.0
TABLE = "fallen.csv"


@dataclass
class Falling:
    """What the stage remembers."""

    begun: float = -1.0  # when the collapse was noticed [s]
    looks: int = 0  # so far
    nextFrame: int = 0  # number of the look after which a frame is due
    quiet: int = 0  # looks that found the rubble at rest, one after the other


def followFall(scene: Any, tilted: bool) -> str:
    """Go on with what falls until it is at rest. Loads stay, but for a horizontal acceleration,
    which ends when the first block has fallen; drives and supports stand still, and the numerical
    damping of the options acts on what stands, not on what no joint holds. The gravity of a ground
    that is tilted stays. Returns how that ended.
    """
    model, running, box = scene.model, scene.running, scene.description
    at = running.stage(FALL, Falling())
    if at.begun < 0:
        at.begun = O.time
        if not running.isResumed:
            running.frame()  # whose cracks are drawn
    # what stands comes to rest; blocks that are loose are not damped so
    model.scheme.dampByOptions()
    model.scheme.keepStable()
    model.letFall()
    gravity, height = abs(box.gravity) or GRAVITY, box.high[2] - box.low[2]
    small = math.sqrt(max(map(box.size, range(len(box.bricks)))) / gravity)
    every = max(1, round(LOOK * small / O.dt))
    longest = LONGEST * (math.sqrt(2 * height / gravity) + small)
    most = max(CONSECUTIVE_CHECKS, int(longest / (every * O.dt)))
    while at.looks < most and at.quiet < CONSECUTIVE_CHECKS:
        running.advance(every)
        at.looks += 1
        running.record()
        missing, _ = model.supports.unrest()
        rests = missing < REST and model.motion.fastest() < REST_SPEED_RATIO
        at.quiet = at.quiet + 1 if rests else 0
        if at.looks >= at.nextFrame:
            running.frame()
            at.nextFrame = at.looks + FRAME
        fallen = len(model.fallen())
        if fallen and not tilted:
            model.scheme.setGravity(-model.gravity * Vector3.UnitZ)
        running.show(
            at.looks / most,
            lambda: f"{O.time - at.begun:.3f} s, {fallen} blocks have fallen",
            at.quiet == CONSECUTIVE_CHECKS or at.looks == most,
        )
    running.flush()
    ground = box.ground().box[1][2]
    past = sum(O.bodies[body].state.pos[2] < ground for body in model.ids)
    if past:
        say(
            f"warning: {past} blocks have gone past the edge of the ground and fall on, so the"
            " impact energy and the extent of the rubble mean nothing"
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
    what = "blocks that have turned by 60° or moved by their diameter since the scene was built"
    found = [
        Answer("fallen_blocks", "-", len(fallen), f"{when}{what}, of {len(masses)}"),
        Answer(
            "fallen_share",
            "-",
            mass / (sum(masses) or 1.0),
            f"{when}mass of these over that of all blocks",
        ),
        Answer(
            "noticed_at", "s", begun, "when the collapse was noticed, since the scene was built"
        ),
        Answer(
            "time_to_rest",
            "s",
            O.time - begun if atRest else None,
            "from then on until all was at rest",
        ),
    ]
    if not fallen:
        return found
    first = min(one["fell"] for one in fallen.values())
    energy = sum(one["most"] for one in fallen.values())
    corners = [c for index in fallen for c in cornersNow(model, index)]
    low, high = ([f(values) for values in zip(*corners)] for f in (min, max))
    ground = box.ground().box[1][2]
    beyond = [max(0.0, box.low[i] - low[i], high[i] - box.high[i]) for i in range(2)]
    lies = f"{when}of the corners of the fallen blocks"
    return [
        *found,
        Answer("fallen_mass", "kg", mass, f"{when}of the fallen blocks"),
        Answer(
            "rubble_volume",
            "m³",
            sum(volume(model, index) for index in fallen),
            f"{when}of the fallen blocks, without what lies between them",
        ),
        Answer("rubble_length_x", "m", high[0] - low[0], f"{lies}, from the first to the last"),
        Answer("rubble_length_y", "m", high[1] - low[1], f"{lies}, from the first to the last"),
        Answer("rubble_height", "m", high[2] - ground, f"{lies}, above the ground"),
        Answer(
            "rubble_reach",
            "m",
            max(beyond),
            f"{lies}: how far they lie beside the box around what was built",
        ),
        Answer(
            "impact_energy",
            "J",
            energy,
            (
                f"{when}sum of the largest kinetic energy that every fallen block had since it came"
                " loose"
            ),
        ),
        Answer(
            "first_fall", "s", first, "when the first block had fallen, since the scene was built"
        ),
    ]


#: Columns of fallen.csv: name, and the value of a block from its index and its fall.
HEADS = (
    "block",
    "brick",
    "part",
    "x_m",
    "y_m",
    "z_m",
    "mass_kg",
    "volume_m3",
    "loose_at_s",
    "fallen_at_s",
    "largest_kinetic_energy_J",
    "at_s",
    "now_x_m",
    "now_y_m",
    "now_z_m",
    "moved_m",
    "turned_deg",
    "speed_m_per_s",
)


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
    try:
        with open(path, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(HEADS)
            writer.writerows(
                [[f"{v:.9g}" if isinstance(v, float) else v for v in row] for row in rows]
            )
    except OSError as error:
        raise Unwritable(f"{path} cannot be written: {error.strerror}") from None
