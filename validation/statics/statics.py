# SPDX-License-Identifier: GPL-2.0-or-later
"""Statics as an oracle: every kind of stage × target × direction × block model × law, held against
Newton's laws.

yade -n -x validation/statics/statics.py [--sample N --seed S] [--only STAGE] [--out FILE]

In every scene a small wall goes through one stage after ``settle``. Then one more step is taken
without damping, so that the accelerations of all bodies and nodes are known, and

- the forces of supports, drives and loads and the weights must give mass times acceleration, and
  their moments about the origin the change of the angular momentum;
- the force columns of curve.csv must have the same sum, and the work of what was pushed must be
  that of the ledger;
- what is answered as a peak must be in the curve, and the bound must not be below what stood.

The table says of each cell how many checks passed, or why the scene refuses it.
"""

import argparse
import contextlib
import io
import itertools
import os
import random
import tempfile

import numpy as np
from masonry import COLLAPSED, Scene, bricks, materials
from masonry.errors import Refused
from masonry.numbers.columns import Reading
from yade import O

STAGES = (
    "settle push cycle drive lean tilt accelerate load growForce wind growPressure press growStress"
    " move release hold shake run"
).split()
TARGETS = "free held guided driven handle brick".split()
DIRECTIONS = {
    "x": (1, 0, 0),
    "-x": (-1, 0, 0),
    "y": (0, 1, 0),
    "-z": (0, 0, -1),
    "xz": (0.8, 0, -0.6),
    "xy": (0.6, 0.8, 0),
}
MODELS = "rigid", "deformable"
LAWS = "softening", "cyclic", "brittle"
#: Stages for which a direction means nothing.
WITHOUT_DIRECTION = {"settle", "press", "growStress", "hold", "run"}
ROUND_OFF = 1e-9  # of the largest force, or moment
ALLOWED = 0.02  # of a bound, as in a run
WORK = 0.03  # of the work of a push: rows are summed by the trapezium rule


class Wrong(AssertionError):
    """A check of a scene that failed."""


def cells():
    """All cells: tuples of stage, target, direction, model and law."""
    for stage, target, model, law in itertools.product(STAGES, TARGETS, MODELS, LAWS):
        directions = ["x"] if stage in WITHOUT_DIRECTION else DIRECTIONS
        for direction in directions:
            yield stage, target, direction, model, law


def build(cell, folder):
    """A wall of two bricks by three courses under a platen, and the target of the cell."""
    stage, kind, direction, model, law = cell
    plane = not DIRECTIONS[direction][1]
    wall = bricks.Wall(0.44, 0.243, halves=False)
    words = [
        "--lean",
        "--out",
        folder,
        "--blocks",
        model,
        "--joints",
        law,
        "--rate",
        "20",
    ]
    scene = Scene("statics", wall, materials.calciumSilicate(), plane=plane, arguments=words)
    base = scene.platen("bottom")
    guided, drive = ("x" if kind == "guided" else ""), ("xz" if kind == "driven" else "")
    rotation = "free" if kind == "free" else "held"
    top = scene.platen("top", rotation=rotation, height=0.05, guided=guided, drive=drive)
    if kind != "driven":
        scene.press(top, 0.2e6)
    target = top
    if kind == "handle":
        target = scene.handle((0.11, 0.05, 0.2), name="handle")
    if kind == "brick":
        target = scene.hold((0.11, 0.05, 0.12), name="brick")
    scene.watch((0.4, 0.05, 0.2), name="watched")
    scene._entered = True  # errors are raised, and do not end the program
    return scene, base, top, target


def act(scene, cell, target, base):
    """Carry out the stage of a cell. Returns how it ended."""
    stage, _, name, _, _ = cell
    direction = DIRECTIONS[name]
    vector = lambda size: tuple(size * v for v in direction)
    axis = max(range(3), key=lambda i: abs(direction[i]))
    along = {"xyz"[axis]: 0.05 * direction[axis]}
    if stage == "settle":
        return scene.settle()
    if stage == "push":
        return scene.push(target, 0.08, direction=direction)
    if stage == "cycle":
        return scene.cycle(target, [0.05], direction=direction)
    if stage == "drive":
        return scene.drive(target, **along)
    if stage == "lean":
        return scene.lean(0.1, towards=direction)
    if stage == "tilt":
        return scene.tilt(10, towards=direction, rate=200)
    if stage == "accelerate":
        return scene.accelerate(0.3, towards=direction, rate=10)
    if stage == "load":
        return scene.load(target, vector(300))
    if stage == "growForce":
        return scene.grow({target: vector(500)}, over=0.05)
    if stage == "wind":
        return scene.wind(2e3, direction)
    if stage == "growPressure":
        return scene.grow({}, pressure=3e3, towards=direction, over=0.05)
    if stage == "press":
        return scene.press(target, 0.3e6)
    if stage == "growStress":
        return scene.grow({target: 0.1e6}, over=0.05)
    if stage == "move":
        return scene.move(target if target.fixed else base, **along, rate=5)
    if stage == "release":
        return scene.release(target, "xyz"[axis])
    if stage == "hold":
        return scene.hold(target, "x")
    if stage == "shake":
        wave = [0.0, 1.0, 2.0, 0.0, -2.0, -1.0, 0.0]
        return scene.shake(wave, 0.005, direction=direction, damping=0.5)
    return scene.run(0.02)


# -- Newton's laws ---------------------------------------------------------------------------------


def _momenta(model):
    """Mass, place, velocity, angular momentum about its centre, and factor on the inertia, which
    adds no weight, of every body and node that moves."""
    zones, found = model.zones, []
    factors = dict(enumerate(model.scheme.integrator.inertiaFactors))
    divided = set(zones.bodies) if zones else set()
    for body in O.bodies:
        state = body.state
        if body.id in divided:
            first, end = zones.nodesOf(body.id)
            for node in range(first, end):
                place = zones.referencePoint(body.id, node) + zones.displacements[node]
                found.append((zones.masses[node], place, zones.velocities[node], np.zeros(3), 1))
            continue
        turn = np.array([list(row) for row in _rows(state.ori.toRotationMatrix())])
        own = turn.T @ np.array(state.angVel)
        spin = turn @ (np.array(state.inertia) * own)
        found.append((state.mass, state.pos, state.vel, spin, factors.get(body.id, 1)))
    return [(m, np.array(r), np.array(v), np.array(s), f) for m, r, v, s, f in found]


def _rows(matrix):
    return [[matrix[i, k] for k in range(3)] for i in range(3)]


def stepped(scene):
    """Take a step without damping. Returns its sums: forces and moments of what acts from outside,
    and what they change."""
    model = scene.model
    model.scheme.damp(0.0, scene.args.damping_kind)
    model.scheme.integrator.damping = 0.0  # of rigid bodies beside deformable ones
    before = _momenta(model)
    loads = [load for label, load in model.loading.loads.items() if label != "push"]
    points = [np.array(load.point) + np.array(load.displacement()) for load in loads]
    places = {t.name: np.array(O.bodies[t.body].state.pos) for t in model.supports.held}
    gravity = np.array(model.scheme.now)
    O.step()
    after = _momenta(model)
    force, moment, change, spin = (np.zeros(3) for _ in range(4))
    size = arm = 0.0
    for (m, r, v, s, factor), (_, _, v2, s2, _) in zip(before, after):
        weight, inertial = m * gravity, factor * m * (v2 - v) / O.dt
        force += weight
        moment += np.cross(r, weight)
        change += inertial
        spin += np.cross(r, inertial) + factor * (s2 - s) / O.dt
        size, arm = max(size, np.abs(weight).max()), max(arm, np.abs(r).max())
    for load, point in zip(loads, points):
        one = np.array(load.force) + load.reaction * np.array(load.direction.normalized())
        force += one
        moment += np.cross(point, one)
        size = max(size, np.abs(one).max())
    for (
        target
    ) in model.supports.held:  # what holds them takes all that acts on them along these axes
        state = O.bodies[target.body].state
        on, twist = np.array(O.forces.f(target.body)), np.array(O.forces.t(target.body))
        on = on + state.mass * gravity
        blocked = np.array([axis in state.blockedDOFs for axis in "xyzXYZ"])
        support = np.where(blocked[:3], -on, 0)
        force += support
        moment += np.cross(places[target.name], support)
        moment += np.where(blocked[3:], -twist, 0)
        size = max(size, np.abs(on).max())
    if model.description.plane:
        force[1] = change[1] = moment[0] = moment[2] = spin[0] = spin[2] = 0
    return force, moment, change, spin, size, size * max(arm, 1e-3)


def checkNewton(scene):
    """Forces and moments from outside against the change of momentum and angular momentum."""
    force, moment, change, spin, size, couple = stepped(scene)
    model = scene.model
    away = np.abs(force - change).max() / size
    if not away < ROUND_OFF:
        raise Wrong(f"forces {force} N from outside, mass times acceleration {change} N")
    # a step turns bodies about where they stood: the second order of the rotation in a step
    # remains; forces on the faces of deformable units go to their nodes as these stood when the
    # unit was whole
    away = np.abs(moment - spin).max() / couple
    if not away < (1e-4 if model.zones else 1e-6):
        raise Wrong(f"moments {moment} N m from outside, change of angular momentum {spin} N m")


def checkColumns(scene):
    """The force columns against weights, loads and mass times acceleration: a second sum, of what
    the user reads."""
    model, plane = scene.model, scene.description.plane
    before = _momenta(model)
    O.step()
    after = _momenta(model)
    reading = Reading(model)
    values = {c.head: c.value(reading) for c in scene.columns}
    held = {
        t.body
        for t in model.supports.held
        if not set("xyz") - set(O.bodies[t.body].state.blockedDOFs)
    }
    gravity = np.array(model.scheme.now)
    named = {t.body: t for t in scene.targets.values()}
    # the vertical column of a platen that no drive holds along z is the force of its joints, so its
    # weight and loads are not missing
    pressed = {
        b
        for b, t in named.items()
        if t.box and not t.fixed and "z" not in t.drives and f"{t.name}_force_z_kN" in values
    }
    counts = lambda body: np.array([1, 1, body not in pressed])
    bodies = [*_owners(model)]
    free = [n for n, body in enumerate(bodies) if body not in held]
    need = sum(
        counts(bodies[n])
        * before[n][0]
        * (gravity - before[n][4] * (after[n][2] - before[n][2]) / O.dt)
        for n in free
    )
    size = np.abs(need).max()
    handles = {t.body for t in named.values() if t.brick is not None and t.loaded and not t.fixed}
    for label, load in model.loading.loads.items():
        if label == "push":
            continue
        size = max(size, load.force.norm(), abs(load.reaction))
        if load.body not in handles:
            need = need + counts(load.body) * np.array(load.force)
            recorded = named[load.body].drives if load.body in named else ""
            if load.driven and not any(abs(load.direction["xyz".index(a)]) > 0.5 for a in recorded):
                need = need + counts(load.body) * load.reaction * np.array(
                    load.direction.normalized()
                )
    for i, axis in enumerate("xyz"):
        if plane and axis == "y":
            continue
        total = 0.0
        for target in scene.targets.values():
            divided = model.zones and target.body in model.zones.bodies
            on = "" if divided else O.bodies[target.body].state.blockedDOFs
            column = f"{target.name}_force_{axis}_kN"
            if column in values:
                total += 1e3 * values[column]
                if axis in on and target.body not in held and target.body not in handles:
                    # the weight of a guided platen along the guide is carried there, and the column
                    # leaves it out
                    total += O.bodies[target.body].state.mass * gravity[i]
            elif axis in on and target.body not in held:
                raise Wrong(f"{target.name} is held along {axis} and has no column")
        if not abs(total - need[i]) < 1e-7 * max(size, 1e-3):
            raise Wrong(
                f"force columns along {axis} sum up to {total} N, statics needs {need[i]} N"
            )


def _owners(model):
    """Body of every entry of :func:`_momenta`."""
    zones = model.zones
    divided = set(zones.bodies) if zones else set()
    for body in O.bodies:
        if body.id in divided:
            first, end = zones.nodesOf(body.id)
            yield from [body.id] * (end - first)
        else:
            yield body.id


# -- what a run says -------------------------------------------------------------------------------


def checkWork(scene, first):
    """The work of what was pushed, from its columns, against the ledger's work of the loads."""
    column = scene.results.column
    top, moved = (np.array(column(n)[first:]) for n in ("top_shear_kN", "displacement_mm"))
    done = np.array(column("external_J")[first:])
    if len(top) < 5:
        raise Wrong(f"a push has {len(top)} rows")
    work = float(np.sum(0.5 * (top[1:] + top[:-1]) * np.diff(moved)))
    size = float(np.sum(np.abs(0.5 * (top[1:] + top[:-1]) * np.diff(moved))))
    press = scene.model.loading.loads.get("top_press")
    if press:  # which does work, too, and keeps its force
        work += 1e-3 * press.force[2] * (column("top_z_mm")[-1] - column("top_z_mm")[first])
    between = float(
        np.sum(np.abs(0.5 * np.diff(top) * np.diff(moved)))
    )  # where it falls between two rows
    if not abs(work - (done[-1] - done[0])) <= WORK * size + between + 1e-6:
        raise Wrong(
            f"work of the push {work} J by its columns, {done[-1] - done[0]} J in the ledger"
        )


def checkAnswers(scene):
    """Peaks are in the curve, and no bound is below what stood."""
    rows, column = scene.running.results, scene.results.column
    for answer in scene.answers:
        if answer["name"] == "peak":
            carried = [min(*both) for both in zip(column("base_shear_kN"), column("top_shear_kN"))]
            at = carried.index(max(carried))
            where = next(a["value"] for a in scene.answers if a["name"] == "displacement_at_peak")
            if column("displacement_mm")[at] != where:
                raise Wrong(f"the peak is not at {where} mm in the curve")
    for what, factor in scene.running.state.held.items():
        entry = scene.bounds.entries.get(what, {})
        if "factor" in entry and factor > (1 + ALLOWED) * entry["factor"]:
            raise Wrong(f"{what}: {factor} was held, the bound is {entry['factor']}")
    error = column("balance_error")[-1] if rows.rows else 0.0
    if not abs(error) < 0.01 and not scene.model.energy.warned:
        raise Wrong(f"the energy balance is off by {error}")


def carryOut(cell):
    """Carry out a cell. Returns None if all holds, or the sentence with which the scene refuses it.
    Raises Wrong."""
    with tempfile.TemporaryDirectory() as folder:
        scene = None
        try:
            scene, base, top, target = build(cell, os.path.join(folder, "run"))
            scene.settle()
            first = len(scene.results.rows)
            ended = act(scene, cell, target, base)
            scene.running.flush()
            checkAnswers(scene)
            if cell[0] in ("push", "cycle") and ended != COLLAPSED:
                checkWork(scene, first)
            if ended != COLLAPSED:
                checkNewton(scene)
                checkColumns(scene)
            return None
        except (Refused, ValueError) as refused:
            return str(refused)
        finally:
            if scene:
                scene.finished = True
                if scene.running:
                    scene.running.release()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sample", type=int, help="so many cells, drawn at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=STAGES)
    parser.add_argument("--out", help="file of the table")
    args = parser.parse_args()
    chosen = [cell for cell in cells() if args.only in (None, cell[0])]
    if args.sample:
        chosen = random.Random(args.seed).sample(chosen, args.sample)
    table, refusals, wrong = {}, {}, []
    for cell in chosen:
        said = io.StringIO()
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                refusal = carryOut(cell)
        except Exception as error:
            wrong.append(f"{', '.join(cell)}: {type(error).__name__}: {error}")
            print(wrong[-1], flush=True)
            refusal = "wrong"
        key = cell[0], cell[1]
        passed, no, bad = table.get(key, (0, 0, 0))
        table[key] = (
            passed + (refusal is None),
            no + (refusal not in (None, "wrong")),
            bad + (refusal == "wrong"),
        )
        if refusal not in (None, "wrong"):
            refusals.setdefault((cell[0], refusal), []).append(cell)
    lines = ["| stage | " + " | ".join(TARGETS) + " |", "|---" * (len(TARGETS) + 1) + "|"]
    for stage in STAGES:
        found = [table.get((stage, target)) for target in TARGETS]
        if any(found):
            texts = [
                (
                    ""
                    if f is None
                    else f"{f[0]} hold"
                    + f", {f[1]} refused" * (f[1] > 0)
                    + f", **{f[2]} wrong**" * (f[2] > 0)
                )
                for f in found
            ]
            lines.append(f"| {stage} | " + " | ".join(texts) + " |")
    lines.append("")
    for (stage, text), refused in sorted(refusals.items()):
        lines.append(f"- {stage}, {len(refused)} cells: {text}")
    print(*lines, sep="\n")
    if args.out:
        with open(args.out, "w") as f:
            print(*lines, sep="\n", file=f)
    print(f"{len(chosen)} cells, {len(wrong)} wrong")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
