# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a structure is a whole wall in running bond in the x-z plane, of which crack patterns are measured."""


def wallOf(description, loading):
    """The entry ``wall`` of run.json, or None if the structure is no such wall, or if no platen pushes it.

    :param description: :class:`masonry.scene.description.Description`
    :param loading: :class:`masonry.assembly.loading.Loading`, which knows what is pushed, and where to
    """
    target = loading.target
    low, high = description.low, description.high
    sides = [
        [f(p[i] for p in block.corners) for i in range(3)]
        for block in description.bricks
        for f in (min, max)
    ]
    sizes = [[b - a for a, b in zip(*pair)] for pair in zip(sides[::2], sides[1::2])]
    height, half = sizes[0][2], min(size[0] for size in sizes)
    length, courses = high[0] - low[0], round((high[2] - low[2]) / height)
    columns = round(length / half)
    steps = [round(size[0] / half) for size in sizes]
    odd = [
        n
        for size, n in zip(sizes, steps)
        if abs(size[0] - n * half) > 1e-6 * half or n > 2
    ]
    if (
        not description.plane
        or not (description.halves or {1, 2} == set(steps))
        or target.brick is not None
        or loading.push.others
        or odd
        or any(abs(size[2] - height) > 1e-6 * height for size in sizes)
        or sum(steps) != courses * columns
        or any(len(block.corners) != 8 for block in description.bricks)
    ):
        return None
    return {
        "corner_m": [low[0], low[2]],
        "length_m": length,
        "height_m": high[2] - low[2],
        "thickness_m": high[1] - low[1],
        "courses": courses,
        "half_units": columns,
        "unit_m": [2 * half, high[1] - low[1], height],
        "precompression_Pa": target.pressed or 0.0,
        "load_height_m": None if "Y" in target.freedom else target.point[2] - low[2],
        "measure_height_m": target.recorded[2] - low[2],
        "pushed_towards": -1 if loading.direction[0] < 0 else 1,
        "load_line_fixed": not target.riding,
    }
