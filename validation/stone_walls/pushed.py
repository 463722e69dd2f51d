# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall of a database on its platens, pushed until it has lost half of its force."""

import math

from masonry import Scene, bricks, materials

LOST = 0.5  # share of the peak at which a push ends [-]
STEP = 0.25  # drift from one look at the force to the next [%]
# of a wall whose modulus is 1 GPa [mm/s]; with its root for others, as the period of a soft wall is
# longer
RATE = 30


def carryOut(name, guess, args, farthest=4.0, side=1):
    """Build a wall, load it and push it.

    :param name: of the scene
    :param guess: :class:`rules.Guess`
    :param args: options of the scene
    :param farthest: drift at which a push ends [%]
    :param side: 1 or -1, of a push
    """
    row = guess.row
    args.points = guess.points
    scene = Scene(
        name,
        guess.bricks(bricks),
        guess.masonry(materials),
        title=f"{row.campaign} {row.name}",
        arguments=args,
    )
    scene.platen("bottom")
    above = dict(rotation="held") if row.clamped else dict(rotation="free", upTo=row.arm)
    top = scene.platen("top", recorded=row.height, **above)
    scene.press(top, guess.pressure, riding=False)
    scene.settle(damping="local", record=False)
    rate = RATE * math.sqrt(guess.E / 1e9)
    peak = 0.0
    for n in range(1, 1 + round(farthest / STEP)):
        away = 1e1 * STEP * n * row.height  # [mm]
        ended = scene.push(top, away, direction=(side, 0, 0), rate=rate, continued=n > 1)
        force = scene.results.column("base_shear_kN")[-1]  # along the push
        peak = max(peak, force)
        if ended == "collapsed" or force < LOST * peak:
            break
    scene.finish()
