# SPDX-License-Identifier: GPL-2.0-or-later
"""What a record takes: about 500 bricks are shaken by noise.

    yade -n -x validation/benchmark/shaken_facade.py --lean --preset fast --seconds 10 --peak 0.2
    yade -n -x validation/benchmark/shaken_facade.py --lean --preset fast --seconds 2 --pier

A façade of two storeys, whose bricks can crack in half, moves in its plane; with ``--pier`` a pier
of two wythes in English bond, 1.26 x 2.6 m, whose bricks do not crack, moves in space, across its
plane.
"""

import time

import numpy as np
from scipy import signal

from masonry import Scene, bricks, materials
from masonry.scene import options
from yade import O

EVERY = 0.005  # [s]


def noise(seed, seconds):
    """Accelerations of white noise, filtered between 0.5 and 12 Hz; the peak is 1. Its
    displacements are under a bell, so that the ground begins and ends at rest."""
    count = round(seconds / EVERY) + 1
    band = signal.butter(2, (0.5, 12), "bandpass", fs=1 / EVERY, output="sos")
    white = np.random.default_rng(seed).standard_normal(count)
    place = signal.sosfiltfilt(band, np.cumsum(np.cumsum(signal.sosfiltfilt(band, white))))
    place *= np.sin(np.pi * np.arange(count) / (count - 1)) ** 4
    accelerations = np.diff(np.pad(place, 1), 2)
    return (accelerations / abs(accelerations).max()).tolist()


parser = options.parser(__doc__, until=None)
parser.add_argument("--seconds", type=float, default=10, help="length of the record [s]")
parser.add_argument("--peak", type=float, default=0.2, help="peak acceleration [g]")
parser.add_argument("--seed", type=int, default=1, help="of the noise")
parser.add_argument("--pier", action="store_true", help="shake the pier in place of the façade")
args = parser.parse_args()


def facade():
    """The façade, and the place of what is watched."""
    opening = lambda x, z, height: bricks.Opening(x, z, 0.66, height, bricks.Lintel(0.22, 0.25))
    openings = [opening(x, z, h) for x in (0.66, 2.2) for z, h in ((0, 2.0), (3.25, 1.25))]
    wall = bricks.Wall(3.52, 5.0, unit=(0.22, 0.25, 0.125), openings=openings)
    scene = Scene("shaken_facade", wall, materials.calciumSilicate(), arguments=args)
    return scene, (1.76, 0, 5.0)


def pier():
    """The pier, and the place of what is watched."""
    wall = bricks.Wall(1.26, 2.6, unit=(0.21, 0.1, 0.065), bond="english", wythes=2)
    scene = Scene("shaken_pier", wall, materials.calciumSilicate(), plane=False, arguments=args)
    return scene, (0.63, 0.1, 2.6)


scene, top = (pier if args.pier else facade)()
scene.platen("bottom")
scene.press(scene.platen("top", rotation="free"), 0.1e6)  # [Pa], the roof
scene.watch(top, name="roof")
scene.settle()
began = time.perf_counter(), time.process_time(), O.time
direction = (0, 1, 0) if args.pier else (1, 0, 0)
scene.shake(
    noise(args.seed, args.seconds),
    EVERY,
    direction=direction,
    scale=args.peak,
    unit="g",
)
shaken = O.time - began[2]
took = (time.perf_counter() - began[0]) / shaken
worked = (time.process_time() - began[1]) / shaken
print(
    f"{len({b.brick for b in scene.description.bricks})} bricks, {scene.ended}: a second of the"
    f" record takes {took:.2f} s, of which the core works {worked:.2f} s; 20 records of"
    f" {args.seconds:g} s at 6 levels on two cores that do nothing else:"
    f" {20 * 6 * args.seconds * worked / 2 / 3600:.2f} h"
)
scene.finish()
