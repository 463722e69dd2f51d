# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall in the history of its test, on a base that gives way or under a press as of a testing
machine: hypotheses on the rig.

yade -n -x validation/dry_joint_walls/rig.py --rig 37 --out
results/validation/dry_joint_walls/rig_37

37 kN/mm is the stiffness that makes the start of the plain model's curve that of the test
(README.md, Loops); it was not measured. ``--rig 0`` is a base that does not give way.
``--friction``, ``--uplift`` and ``--guides`` are those of ``scene.press``. Prints the stiffness of
the first cycle, both peaks, and the work of the cycles beside those of the test.
"""

import os
import sys

import numpy as np
from masonry import Scene, bricks, materials
from masonry.numbers import columns
from masonry.numbers import loops
from masonry.scene import options

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
FOLDERS = [HERE, os.path.dirname(HERE), os.path.join(os.path.dirname(HERE), "stone_walls")]
sys.path[:0] = FOLDERS  # yade leaves it out
import measured  # noqa: E402
import compare_loops  # noqa: E402
import rules  # noqa: E402
import studies  # noqa: E402

BLOCK, LOAD_HEIGHT = (0.200, 0.200, 0.150), 1.325  # [m], as of scripts/gallery/wall_dry.py

parser = options.parser(__doc__, until=30, rate=compare_loops.RATE)
parser.add_argument(
    "--rig",
    metavar="KN_PER_MM",
    type=float,
    default=37.0,
    help="stiffness of the base along x (default: 37); 0: held",
)
parser.add_argument(
    "--wall", metavar="NAME", default="WS2175", help="as WS2175, or the one in mortar, WI2175"
)
parser.add_argument("--friction", metavar="F", type=float, default=0.0, help="of the press")
parser.add_argument(
    "--uplift", metavar="KN_PER_MM", type=float, default=0.0, help="stiffness of the press"
)
parser.add_argument(
    "--guides", metavar="KN_PER_MM", type=float, help="of the press (default: nearly rigid)"
)
parser.set_defaults(crack_surfaces="off", points="6,6")
WALL = parser.parse_args().wall
parser.set_defaults(history=measured.historyPath(WALL))
args = parser.parse_args()
if args.blocks == "deformable":
    args.points = None  # their joints have the points of their cells

level = measured.levelOf(WALL)
if WALL == measured.DRIVEN:
    (row,) = (one for one in rules.read().values() if one.name.replace(".", "") == WALL)
    guess = rules.Guess(row, *rules.CHOSEN, 0)
    structure = guess.bricks(bricks), guess.masonry(materials)
else:
    structure = bricks.Wall(1.0, 1.2, BLOCK), materials.dryGranite(level, BLOCK[2])
scene = Scene(
    "dry_wall_on_a_rig",
    *structure,
    title=f"{WALL} on a base of {args.rig:g} kN/mm" if args.rig else WALL,
    columns=columns.heads(columns.PUSH),
    arguments=args,
)
scene.platen("bottom", springs={"x": 1e6 * args.rig} if args.rig else None)
top = scene.platen("top", rotation="free", upTo=LOAD_HEIGHT, recorded=LOAD_HEIGHT, drive="x")
guides = args.guides and 1e6 * args.guides
machine = dict(friction=args.friction, stiffness=1e6 * args.uplift, guides=guides)
scene.press(top, level * 1e3 / BLOCK[1], riding=False, **machine)
scene.settle(damping="local", record=False)
scene.push(top)
scene.finish()

moved, force = compare_loops.calculated(scene.results.directory)
own = loops.cycles(moved, force, measured.THRESHOLD)[0]
(test, _), *_ = measured.cycles(WALL)
there = measured.curve(WALL)[1]
ends = measured.peaks(level).get(WALL) or (there.max(), -there.min())
heads = ["base of kN/mm", "stiffness of the first cycle kN/mm", "V+, V− kN"]
first = ["test", f"{test.stiffness_kN_per_mm:.1f}", f"{ends[0]:.1f}, {ends[1]:.1f}"]
second = [f"{args.rig:g}", f"{own.stiffness_kN_per_mm:.1f}"]
second += [f"{force.max():.1f}, {-force.min():.1f}"]
cycles = compare_loops.pairs(WALL, moved, force)
for low, high in compare_loops.RANGES:
    work = np.array([c.work for c in cycles if low <= c.amplitude < high])
    if len(work):
        test, own = work.mean(axis=0)
        heads.append(f"work J a cycle, {low:g}–{high:g} mm")
        first.append(f"{test:.0f}")
        second.append(f"{own:.0f} ({own / test:.2f})")
print(studies.table(heads, [first, second]))
