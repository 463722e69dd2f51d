# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry-joint wall on a base that gives way, in the history of its test: the hypothesis that the
rig did.

yade -n -x validation/dry_joint_walls/rig.py --rig 37 --out
results/validation/dry_joint_walls/rig_37

37 kN/mm is the stiffness that makes the start of the plain model's curve that of the test
(README.md, Loops); it was not measured. ``--rig 0`` is a base that does not give way. Prints the
stiffness of the first cycle, both peaks, and the work of the cycles beside those of the test.
"""

import os
import sys

import numpy as np
from masonry import Scene, bricks, materials
from masonry.numbers import columns
from masonry.numbers import loops
from masonry.scene import options

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
import measured  # noqa: E402
import compare_loops  # noqa: E402

WALL = "WS2175"
BLOCK, LOAD_HEIGHT = (0.200, 0.200, 0.150), 1.325  # [m], as of scripts/gallery/wall_dry.py

parser = options.parser(__doc__, until=30, rate=compare_loops.RATE)
parser.add_argument(
    "--rig",
    metavar="KN_PER_MM",
    type=float,
    default=37.0,
    help="stiffness of the base along x (default: 37); 0: held",
)
parser.set_defaults(crack_surfaces="off", points="6,6", history=measured.historyPath(WALL))
args = parser.parse_args()
if args.blocks == "deformable":
    args.points = None  # their joints have the points of their cells

level = measured.levelOf(WALL)
scene = Scene(
    "dry_wall_on_a_rig",
    bricks.Wall(1.0, 1.2, BLOCK),
    materials.dryGranite(level, BLOCK[2]),
    title=f"{WALL} on a base of {args.rig:g} kN/mm" if args.rig else WALL,
    columns=columns.heads(columns.PUSH),
    arguments=args,
)
scene.platen("bottom", springs={"x": 1e6 * args.rig} if args.rig else None)
top = scene.platen("top", rotation="free", upTo=LOAD_HEIGHT, recorded=LOAD_HEIGHT, drive="x")
scene.press(top, level * 1e3 / BLOCK[1], riding=False)
scene.settle(damping="local", record=False)
scene.push(top)
scene.finish()

moved, force = compare_loops.calculated(scene.results.directory)
own = loops.cycles(moved, force, measured.THRESHOLD)[0]
(test, _), *_ = measured.cycles(WALL)
print(f"{WALL}: test, calculated")
print(
    f"stiffness of the first cycle kN/mm: {test.stiffness_kN_per_mm:.1f},"
    f" {own.stiffness_kN_per_mm:.1f}"
)
ends = measured.peaks(level)[WALL]
print(f"V+, V- kN: {ends[0]:.1f}, {ends[1]:.1f}; {force.max():.1f}, {-force.min():.1f}")
cycles = compare_loops.pairs(WALL, moved, force)
for low, high in compare_loops.RANGES:
    work = np.array([c.work for c in cycles if low <= c.amplitude < high])
    if len(work):
        test, own = work.mean(axis=0)
        print(f"work J a cycle, {low:g} to {high:g} mm: {test:.0f}, {own:.0f} ({own / test:.2f})")
