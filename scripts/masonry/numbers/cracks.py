# SPDX-License-Identifier: GPL-2.0-or-later
"""Where joints are cracked, open, slid or crushed, and how a wall gave way.

Joints are a frame, a dict of arrays, of a file (:func:`masonry.numbers.frames.readFrame`) or of a
scene in YADE (``MasonryVtkRecorder().joints()``).
"""

import math
from typing import Any, Sequence

import numpy as np

Grid = dict[str, np.ndarray]  # as layOut gives it
Entries = dict[str, Any]
CRACK = 0.05e-3  # opening or slide of a cracked joint [m]
CRUSHED = 0.5e-3  # plastic closure of a crushed joint [m]
DAMAGED = 0.05  # damage in tension or shear of a cracked joint [-]
CRACK_SURFACE = "crack"  # the kind of joint between the halves of a brick
NEAR = 3  # courses to either side of the diagonal that are near it
OUTER = 2  # courses at base and top that do not count for the diagonal, as they crack by rocking


def widths(frame: Entries) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How far every subcontact is open or slid.

    :returns: three arrays: the larger of opening and slide [m]; whether it is open, by more than
        CRACK and half of its slide; and whether it is cracked: damaged in tension or shear, and
        open or slid by more than CRACK
    """
    slide = np.linalg.norm(frame["slide"], axis=1)
    opened = frame["opening"] > np.maximum(CRACK, 0.5 * slide)
    damaged = np.maximum(frame["damage_tension"], frame["damage_shear"]) > DAMAGED
    cracked = damaged & (opened | (slide > CRACK))
    return np.maximum(frame["opening"], slide), opened, cracked


def widest(joints: Any) -> tuple[float, Any, Any, dict[str, float]]:
    """The widest crack: the largest opening of a point of any joint, without its slide.

    :param joints: of each an identifier, its groups, the openings of its points [m], negative where
        it is closed, and the points [m]
    :returns: opening [m], point and identifier (0.0, None and None if no joint is open), and the
        largest opening of every group [m]
    """
    found, groups = (0.0, None, None), {}
    for name, own, openings, points in joints:
        at = int(np.argmax(openings))
        groups.update({one: max(groups.get(one, 0.0), openings[at]) for one in own})
        if openings[at] > found[0]:
            found = float(openings[at]), points[at], name
    return *found, groups


#: Classes 0 to 5 of visible damage by the width of cracks [mm] (Burland, Broms and De Mello 1977,
#: BRE Digest 251).
CLASSES = {
    0.1: "negligible",
    1: "very slight",
    5: "slight",
    15: "moderate",
    25: "severe",
    math.inf: "very severe",
}


def damageClass(width: float) -> int:
    """The damage class of a crack by its width [mm], 0 to 5 (:data:`CLASSES`)."""
    return sum(width > limit for limit in CLASSES)


def crushed(frame: Entries) -> np.ndarray:
    return frame["crushing"] > CRUSHED


#: Arrays of a frame for a pattern, beside its cells.
NEEDED = [
    "area",
    "bodies",
    "crushing",
    "damage_compression",
    "joint_dissipated",
    "normal",
    "opening",
    "points",
    "slide",
]


def layOut(frame: Entries, wall: Entries) -> tuple[Entries, Grid]:
    """Joints of a frame on the grid of the brickwork.

    :param wall: the entry ``wall`` of run.json
    :returns: two dicts of arrays, from the base up and from left to right: of bed joints (courses -
        1, half units), and of upright joints, which are head joints and cracks of bricks (courses,
        half units - 1). Each has ``opening`` and ``slide``, means over a joint [m]; ``shear``,
        dissipated energy [J]; ``crushing``, volume of plastic closure [m³]; and ``past``, area that
        closed past the peak of its compression curve [m²]. The first has ``beds``, too, the same
        with the bed joints to the support and to the loading block (courses + 1, half units)
    """
    half, height = wall["unit_m"][0] / 2, wall["unit_m"][2]
    left, foot = wall.get("corner_m", (0.0, 0.0))
    courses, columns = wall["courses"], wall["half_units"]
    names = ("opening", "slide", "shear", "crushing", "past")
    beds = {name: np.zeros((courses + 1, columns)) for name in names}
    upright = {name: np.zeros((courses, columns - 1)) for name in names}
    _, first, joint = np.unique(frame["bodies"], axis=0, return_index=True, return_inverse=True)
    area = frame["area"]
    total = lambda values: np.bincount(joint, area * values)
    centres = centresOf(frame["points"], frame["cells"])
    whole = total(1)
    x = (total(centres[:, 0]) / whole - left) / half
    z = (total(centres[:, 2]) / whole - foot) / height
    values = {
        "opening": total(frame["opening"]) / whole,
        "slide": total(np.linalg.norm(frame["slide"], axis=1)) / whole,
        "shear": frame["joint_dissipated"][first, 1],
        "crushing": total(frame["crushing"]),
        "past": total(frame["damage_compression"] > 0),
    }
    flat = np.abs(frame["normal"][first, 2]) > 0.5
    row = np.where(flat, np.rint(z), np.floor(z)).astype(int)
    # a platen and a whole brick share a joint of two half units
    long = np.where(flat, np.rint(whole / (half * wall["unit_m"][1])), 1).astype(int)
    first = np.where(flat, np.rint(x - long / 2), np.rint(x) - 1).astype(int)
    up, flat = ~flat, flat & (row >= 0) & (row <= courses)
    for name in names:
        for n in range(long.max(initial=1)):
            has = flat & (long > n)
            share = long[has] if name in ("shear", "crushing", "past") else 1
            beds[name][row[has], first[has] + n] = values[name][has] / share
        upright[name][row[up], first[up]] = values[name][up]
    return {**{name: beds[name][1:-1] for name in names}, "beds": beds}, upright


def centresOf(points: np.ndarray, cells: Sequence[np.ndarray]) -> np.ndarray:
    """Means of the corners of every cell (cells, 3) [m].

    :param points: corners (n, 3) [m]
    :param cells: the numbers of the corners of each
    """
    counts = np.fromiter(map(len, cells), int, len(cells))
    sums = np.add.reduceat(points[np.concatenate(cells)], np.cumsum(counts) - counts)
    return sums / counts[:, None]


def diagonalReach(bed: np.ndarray, upright: np.ndarray) -> int:
    """Size of the largest diagonal crack that falls to the right through the brickwork [courses,
    half units].

    A crack goes from an upright joint of a course to those of the course below, straight down or to
    either side along cracked bed joints. Its reach is the smaller number of courses and half units
    that it crosses: 0 of a bed joint cracked from side to side and of a vertical split, nearly the
    shorter side of the wall of a crack from corner to corner.

    :param bed: which bed joints are cracked, bool (courses - 1, columns)
    :param upright: which upright joints are cracked, bool (courses, columns - 1)
    """
    lines = np.arange(upright.shape[1])
    starts: np.ndarray = np.empty((0, 2), int)
    reached: np.ndarray = np.empty((0, len(lines)), bool)
    reach = 0
    for course in reversed(range(len(upright))):
        if len(starts):
            run = np.append(0, np.cumsum(~bed[course, 1:-1]))
            reached = (reached @ (run[:, None] == run)) & upright[course]
            right = np.where(reached, lines, -1).max(axis=1)
            size = np.minimum(starts[:, 0] - course, right - starts[:, 1])
            reach = max(reach, int(size.max()))
        here = lines[upright[course]]
        starts = np.vstack([starts, np.column_stack([0 * here + course, here])])
        reached = np.vstack([reached, here[:, None] == lines])
    return reach


def acrossDiagonal(shape: Sequence[int], upright: bool) -> np.ndarray:
    """Height of joints above the diagonal from corner to corner [courses], NaN in the outer
    courses."""
    rows, columns = np.indices(shape)
    level = rows + (0.5 if upright else 1.0)
    place = columns + (1.0 if upright else 0.5)
    courses, length = shape[0] + (not upright), shape[1] + upright
    inner = (level >= OUTER) & (level <= courses - OUTER)
    return np.where(inner, level - courses * (1 - place / length), np.nan)


def narrowestBand(positions: np.ndarray, weights: np.ndarray, share: float = 0.5) -> float:
    """Width of the narrowest interval of positions with a share of the sum of weights, above 0."""
    order = np.argsort(positions)
    positions, held = positions[order], np.append(0, np.cumsum(weights[order]))
    # up to the first position at which enough is held since each start
    ends = np.searchsorted(held, held[:-1] + share * held[-1] * (1 - 1e-12)) - 1
    starts = np.flatnonzero(ends < len(positions))
    return float((positions[ends[starts]] - positions[starts]).min())


def diagonal(bed: Grid, upright: Grid) -> Entries:
    """Numbers of the diagonal crack; ``bed`` and ``upright`` as in :func:`layOut`. A number without
    inner joints (outside the two lowest and two highest courses), or without their energy, is left
    out.

    - diagonal_energy_share [-]: of the energy lost in shear by inner joints, that of joints within
      three courses of the corner-to-corner diagonal
    - diagonal_joint_share [-]: of the inner joints, those: the energy share if the whole wall
      sheared alike
    - diagonal_band_courses: height of the narrowest band parallel to the diagonal with half of that
      energy; small for one localised crack, large for several or for one along a bed joint
    - diagonal_reach [courses, half units]: :func:`diagonalReach` of a stepped crack, whose upright
      joints are open and whose bed joints are open or slid, more than CRACK each
    - parallel_cracks [-]: mean number of upright joints of an inner course open more than CRACK:
      the diagonal cracks that a horizontal line crosses
    """
    energies = bed["shear"], upright["shear"]
    places = [acrossDiagonal(e.shape, e is energies[1]) for e in energies]
    energy, position = (np.concatenate([*map(np.ravel, v)]) for v in (energies, places))
    energy, position = (v[np.isfinite(position)] for v in (energy, position))
    near, lost, numbers = np.abs(position) < NEAR, energy.sum(), {}
    gaping = upright["opening"] > CRACK
    cracked = np.maximum(bed["opening"], bed["slide"]) > CRACK
    if len(position):
        share = energy[near].sum() / lost if lost > 0 else 0.0
        numbers = {"diagonal_energy_share": share, "diagonal_joint_share": near.mean()}
    if lost > 0:
        numbers["diagonal_band_courses"] = narrowestBand(position, energy)
    numbers["diagonal_reach"] = diagonalReach(cracked, gaping)
    if len(inner := gaping[OUTER:-OUTER]):
        numbers["parallel_cracks"] = inner.sum(axis=1).mean()
    return numbers


def flexure(bed: Grid) -> Entries:
    """Numbers of the flexural cracks in the lower half of the wall (base) and in the upper one
    (top), which enter a wall at the ends of its bed joints.

    - flexural_cracks_base, _top: bed joints open more than CRACK at a side of the wall
    - flexural_opening_base_mm, _top_mm: of the widest
    - flexural_course_base, _top: courses from the widest to the base, or the top; not of a wall of
      one course
    """
    side = np.maximum(bed["opening"][:, 0], bed["opening"][:, -1])
    middle = (len(side) + 1) // 2
    numbers = {}
    for name, openings in (("base", side[:middle]), ("top", side[: -middle - 1 : -1])):
        numbers["flexural_cracks_" + name] = int((openings > CRACK).sum())
        numbers[f"flexural_opening_{name}_mm"] = 1e3 * openings.max(initial=0)
        if len(openings):
            numbers["flexural_course_" + name] = int(openings.argmax()) + 1
    return numbers


def crushing(bed: Grid) -> Entries:
    """Numbers of crushing in the bed joints.

    - crushed_volume_cm3: integral of the plastic closure
    - crushed_share_toe, crushed_share_top_left [-]: of it, in the quarter of the length and of the
      height at the bottom right, and at the top left; 1/16 each if evenly crushed; 0 if not crushed
    - past_peak_area_cm2: area that closed past the peak of its compression curve
    """
    volume = bed["crushing"]
    high, long = (n // 4 for n in volume.shape)
    whole = volume.sum()
    share = lambda part: part.sum() / whole if whole > 0 else 0.0
    return {
        "crushed_volume_cm3": 1e6 * whole,
        "crushed_share_toe": share(volume[:high, -long:]),
        "crushed_share_top_left": share(volume[-high:, :long]),
        "past_peak_area_cm2": 1e4 * bed["past"].sum(),
    }


def sliding(bed: Grid) -> Entries:
    """Numbers of the bed joint, from side to side of the wall, with most energy lost in shear, also
    of those to the support and to the loading block.

    - sliding_course: courses from the base
    - sliding_energy_share [-]: of the energy lost in shear by all bed joints
    - slid_share [-]: of its length, that slid more than CRACK
    - slid_mm: median slide over its length
    """
    energy, slide = bed["beds"]["shear"].sum(axis=1), bed["beds"]["slide"]
    course, whole = int(energy.argmax()), energy.sum()
    return {
        "sliding_course": course,
        "sliding_energy_share": energy[course] / whole if whole > 0 else 0.0,
        "slid_share": (slide[course] > CRACK).mean(),
        "slid_mm": 1e3 * np.median(slide[course]),
    }


def patternNumbers(bed: Grid, upright: Grid) -> Entries:
    """Numbers of the crack pattern of a wall, of :func:`layOut`."""
    found = {**diagonal(bed, upright), **flexure(bed), **crushing(bed), **sliding(bed)}
    return {name: np.asarray(value).item() for name, value in found.items()}


#: Numbers of a pattern, and the functions that find them.
MEASURED = {
    **dict.fromkeys(
        (
            "diagonal_energy_share",
            "diagonal_joint_share",
            "diagonal_band_courses",
            "diagonal_reach",
            "parallel_cracks",
        ),
        "masonry.numbers.cracks.diagonal",
    ),
    **{
        f"flexural_{what}": "masonry.numbers.cracks.flexure"
        for end in ("base", "top")
        for what in (f"cracks_{end}", f"opening_{end}_mm", f"course_{end}")
    },
    **dict.fromkeys(
        ("crushed_volume_cm3", "crushed_share_toe", "crushed_share_top_left", "past_peak_area_cm2"),
        "masonry.numbers.cracks.crushing",
    ),
    **dict.fromkeys(
        ("sliding_course", "sliding_energy_share", "slid_share", "slid_mm"),
        "masonry.numbers.cracks.sliding",
    ),
    "failure_mode": "masonry.numbers.cracks.failureMode",
}


def pattern(frame: Entries, wall: Entries, looped: bool = False) -> Entries:
    """Numbers of the crack pattern of a wall, seen from the side from which it is pushed to the
    right; ``frame``, with the arrays NEEDED, and ``wall`` as in :func:`layOut`.

    :param looped: whether the wall was pushed back, too: then there are also the numbers of the
        diagonal and of crushing of the wall seen from behind, with ``_mirrored`` at the end
    """
    bed, upright = layOut(frame, wall)
    if wall.get("pushed_towards", 1) < 0:
        bed, upright = mirrored(bed), mirrored(upright)
    found = patternNumbers(bed, upright)
    if looped:
        bed, upright = mirrored(bed), mirrored(upright)
        other = {**diagonal(bed, upright), **crushing(bed)}
        found.update((f"{n}_mirrored", np.asarray(v).item()) for n, v in other.items())
    return found


#: Shares of the length and of the energy in shear of a sliding bed joint [-].
SLID = 0.9, 0.5


def failureMode(
    numbers: Entries,
    wall: Entries,
    grows: bool = False,
    lost: bool = False,
) -> str:
    """How a wall gave way, from its crack pattern at the end: the first name that applies.

    - ``none yet``: the force of the push still grows at its end
    - ``bed sliding``: one bed joint slid along nine tenths of the length of the wall, by more than
      bed joints opened at its sides, and lost half of the energy of bed joints in shear
    - ``diagonal cracking``: a stepped crack reaches over half of the shorter side of the wall, in
      courses or half units
    - ``toe crushing``: bed joints of more than one half unit closed past the peak of their
      compression curve
    - ``rocking``: a bed joint opened at a side of the wall by more than CRACK, and by more than bed
      joints slid
    - ``partial cracking``: bed joints opened or slid by more than CRACK
    - ``other``: the wall has lost force
    - ``none``: the wall is not cracked, and has lost no force

    :param numbers: of :func:`patternNumbers`
    :param wall: the entry ``wall`` of run.json
    :param grows: see :func:`masonry.numbers.curves.stillGrows`; False of a history
    :param lost: whether the force of the push has fallen after its peak
    """
    if grows:
        return "none yet"
    opened = max(numbers[f"flexural_opening_{side}_mm"] for side in ("base", "top"))
    shares = numbers["slid_share"], numbers["sliding_energy_share"]
    if shares[0] >= SLID[0] and shares[1] >= SLID[1] and numbers["slid_mm"] > opened:
        return "bed sliding"
    if numbers["diagonal_reach"] >= 0.5 * min(wall["courses"], wall["half_units"]):
        return "diagonal cracking"
    half = 1e4 * wall["unit_m"][0] / 2 * wall["unit_m"][1]  # [cm²]
    if numbers["past_peak_area_cm2"] > half:
        return "toe crushing"
    if opened > max(1e3 * CRACK, numbers["slid_mm"]):
        return "rocking"
    cracked = max(opened, numbers["slid_mm"]) > 1e3 * CRACK
    return "partial cracking" if cracked else "other" if lost else "none"


def mirrored(joints: Entries) -> Entries:
    return {
        name: mirrored(values) if name == "beds" else values[:, ::-1]
        for name, values in joints.items()
    }
