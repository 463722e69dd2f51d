# SPDX-License-Identifier: GPL-2.0-or-later
"""Held loads beside limit analysis: lets a load grow on thirteen structures, and prints and writes
the brackets.

yade -n -x validation/held_loads/held_loads.py [--only NAME ...] [--quick] [--out FILE]

A held load must be in a bracket of 1 %, lie between 0.94 of limit analysis without dilatancy and
1.02 of the associated one, and move by less than 1 % if the load grows at a third of the rate.
"""

import argparse
import contextlib
import io
import os
import sys
import tempfile
import time

from masonry import Scene, bricks, materials

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [os.path.dirname(HERE)]  # yade leaves it out
from masonry_limit.beside_run import Bounds  # noqa: E402
from studies import head, line  # noqa: E402

#: Share of limit analysis without dilatancy and of the associated one [-].
LEAST, MOST = 0.94, 1.02
HEAD = [
    "structure",
    "held",
    "not held",
    "associated",
    "without dilatancy",
    "held over them",
    "slower",
    "steps of the search over those of the growth",
    "CPU s",
]


def strip(stiffness):
    """Ten courses of bricks in two wythes' thickness, pushed out of plane."""
    wall = bricks.Wall(0.88, 0.81, unit=(0.44, 0.22, 0.081), halves=False)
    dry = materials.dry(friction=0.6, normalStiffness=stiffness)
    return wall, dry, dict(plane=False), (0, 1, 0), 0.6, 0.3


def bonded(courses, units, friction, stiffness):
    """A wall of dry blocks in running bond, in its plane."""
    wall = bricks.Wall(0.2 * units, 0.1 * courses, unit=(0.2, 0.1, 0.1), halves=False)
    dry = materials.dry(friction=friction, normalStiffness=stiffness)
    return wall, dry, {}, (1, 0, 0), 1.0, 0.3


def corner():
    """An L of two walls, accelerated across one."""
    blocks = bricks.Corner(1.1, 1.1, 1.134, halves=False)
    return blocks, materials.dry(friction=0.6), {}, (1, 0, 0), 0.4, 0.2


def arch():
    """Oppenheim's arch of seven voussoirs."""
    blocks = bricks.Arch(
        thickness=0.15, depth=0.3, stones=7, radius=0.925, angle=157.5, skewback=0.2
    )
    dry = materials.dry(friction=0.7, normalStiffness=1e11)
    return blocks, dry, {}, (1, 0, 0), 0.6, 0.2


def dome():
    """The gallery's dome."""
    blocks = bricks.Dome(radius=2.0, thickness=0.25, courses=8, stones=16, oculus=0.4)
    dry = materials.dry(friction=0.7, normalStiffness=2e10)
    return blocks, dry, {}, (1, 0, 0), 1.2, 0.2


#: By name: function without arguments, and whether the ground tilts. Courses × units of walls in
#: bond.
CASES = {
    "strip, 1e9 Pa/m": (lambda: strip(1e9), False),
    "strip, 1e10 Pa/m": (lambda: strip(1e10), False),
    "strip, 1e11 Pa/m": (lambda: strip(1e11), False),
    "strip on a tilting ground, 1e9 Pa/m": (lambda: strip(1e9), True),
    "corner": (corner, False),
    "dry-stone wall on a tilting ground": (lambda: bonded(10, 5, 0.65, 2e10), True),
    "bond 8 × 12, 0.6": (lambda: bonded(8, 12, 0.6, 1e11), False),
    "bond 12 × 10, 0.7": (lambda: bonded(12, 10, 0.7, 1e11), False),
    "bond 16 × 8, 0.5, soft": (lambda: bonded(16, 8, 0.5, 1e10), False),
    "bond 20 × 6, 0.65, soft": (lambda: bonded(20, 6, 0.65, 1e10), False),
    "bond 30 × 4, 0.7": (lambda: bonded(30, 4, 0.7, 1e11), False),
    "arch": (arch, False),
    "dome": (dome, False),
}
QUICK = ["strip, 1e10 Pa/m", "arch"]


def grown(name, slower=1.0):
    """A scene in which the load of a case has grown, with its memory: (scene, memory, processor
    time [s])."""
    make, tilts = CASES[name]
    blocks, dry, settings, towards, most, rate = make()
    words = ["--no-vtk", "--lean", "--out", tempfile.mkdtemp(prefix="held_loads")]
    scene = Scene("held_loads", blocks, dry, arguments=words, **settings)
    if name == "arch":
        scene.hold(7, name="one"), scene.hold(8, name="other")
    else:
        scene.platen("bottom")
    highest = max(range(len(blocks)), key=lambda n: max(p[2] for p in blocks[n].corners))
    scene.watch(highest, name="top")
    scene.settle()
    began = time.process_time()
    if tilts:
        scene.tilt(40, towards=towards, rate=10 / slower)
    else:
        scene.accelerate(most, towards=towards, rate=rate / slower)
    return scene, scene.running.memory, time.process_time() - began


def limits(name):
    """Limit analysis of a case at rest: associated, and without dilatancy, or the same if that is
    exact."""
    make, tilts = CASES[name]
    blocks, dry, settings, towards, _, _ = make()
    words = ["--preset", "bound", "--out", tempfile.mkdtemp(prefix="held_loads")]
    scene = Scene("held_loads", blocks, dry, arguments=words, **settings)
    if name == "arch":
        scene.hold(7), scene.hold(8)
    else:
        scene.platen("bottom")
    scene.settle()
    lower = Bounds.SMALL if scene.description.plane else 0
    entry = scene.bounds.lean(towardsOf(towards), tilts, lowerUpTo=lower)
    scene.finished = True
    scene.running.release()
    return entry["factor"], entry.get("without_dilatancy", entry["factor"])


def towardsOf(direction):
    """A direction as a unit vector."""
    from yade import Vector3

    return Vector3(*direction).normalized()


def row(name, slow=True):
    """Cells of the table for a case, and whether it meets its aims."""
    most, least = limits(name)
    scene, at, seconds = grown(name)
    scene.finish()
    held, lost = at.held.factor, at.failure.factor
    search = scene.running.state.steps - scene.running.state.stages[-1]["steps"] - at.done
    moved = 0.0
    if slow:
        slower, again, _ = grown(name, slower=3.0)
        slower.finish()
        moved = again.held.factor / held - 1
    met = (
        lost - held <= 0.0101 * lost and LEAST * least <= held <= MOST * most and abs(moved) < 0.01
    )
    cells = [name, f"{held:.4f}", f"{lost:.4f}", f"{most:.4f}", f"{least:.4f}"]
    cells.append(f"{held / most:.3f}, {held / least:.3f}")
    cells.append(f"{100 * moved:+.2f} %" if slow else "")
    cells += [f"{search / at.done:.2f}", f"{seconds:.1f}"]
    return cells, met


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", choices=list(CASES), default=None)
    parser.add_argument(
        "--quick", action="store_true", help="two of the structures, without the slower growth"
    )
    parser.add_argument("--out", default=None, help="file of the table")
    args = parser.parse_args()
    names, lines, missed = args.only or (QUICK if args.quick else list(CASES)), [head(HEAD)], []
    print(*lines, sep="\n", flush=True)
    for name in names:
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            cells, met = row(name, slow=not args.quick)
        lines.append(line(cells if met else [cells[0] + ", **missed**", *cells[1:]]))
        print(lines[-1], flush=True)
        missed += [] if met else [name]
    if args.out:
        with open(args.out, "w") as f:
            print(*lines, sep="\n", file=f)
    print(f"{len(names) - len(missed)} of {len(names)} met their aims")
    raise SystemExit(1 if missed else 0)


if __name__ == "__main__":
    main()
