# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls at the extremes: one axis of the input at a time, from a small wall of calcium silicate.

yade -n -x validation/stability/stability.py [AXIS ...]

Runs every point of every axis with rigid and with deformable units, draws map.png beside itself,
and prints the table. At every point, every hundred steps and at every row of the curve: all numbers
are finite, no yield surface is passed, nothing heals; the energy balance closes and no dissipated
energy falls, or the run says so.
"""

import os
import sys
import tempfile
import time

import numpy as np
from masonry.errors import Collapsed, Refused
from yade import O

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
from observed import BLOCKS, UNIT, Observed, Point  # noqa: E402
from studies import table  # noqa: E402

ROUND_OFF = 1e-12  # of yield functions over the size of what they carry
# of the work done: largest error of the balance, largest energy made; a run with more says so
SHARE = 0.01


def undampedSteps(observed, ratio):
    """Steps of the first period, over which the velocity of a drive grows without numerical
    damping: the limit of the time step is larger then by the root of 1 + α, so a step above that of
    the damped run may be below it.
    """
    if ratio >= (1 + observed.args.damping) ** 0.5:
        return 0
    swings = observed.running.state.freeVibrations.values()
    return max((swing[0] or 0 for swing in swings), default=0) / O.dt


def run(point, blocks):
    """Run a point. Returns a dict: its verdict ('green', 'warned' or 'failed'), why, and its
    numbers."""
    began, found, m, settled = time.perf_counter(), {}, None, 0
    with tempfile.TemporaryDirectory() as folder:
        try:
            m = Observed(point, blocks, folder)
            m.rest()
            settled = O.iter
            m.pushOn()
            found.update(verdict="green", why="collapsed" if m.collapsed else "")
        except Collapsed as collapse:
            found.update(verdict="green", why=f"collapsed: {collapse}")
        except (Refused, ValueError) as refused:
            late = m and O.iter  # a refusal comes before the first step
            found.update(verdict="failed" if late else "warned", why="refused: " + str(refused))
        except RuntimeError as stopped:
            # of an engine; all but a time step over the limit is our failure
            said = "the time step is" in str(stopped) and " sets" in str(stopped)
            took = O.iter - settled
            fine = said and point.dt and point.dt > 1 and took <= 100 + undampedSteps(m, point.dt)
            found.update(verdict="warned" if fine else "failed")
            found.update(why=f"after {took} steps: {stopped}")
        except AssertionError as broken:
            found.update(verdict="failed", why=str(broken))
    if m:
        m.finished, energy = True, m.model.energy
        found.update(m.worst, steps=O.iter)
        found.update(balance=energy.largestError, made=energy.largestMade)
        if m.results.rows:
            found["peak_kN"] = max(m.results.column("base_shear_kN"))
        problems = [
            f"{what} {found[what]:.1e}"
            for what, bound in (("yield", ROUND_OFF), ("healed", 0))
            if found[what] > bound
        ]
        off = [f"{n} {100 * found[n]:.1f} %" for n in ("balance", "made") if found[n] > SHARE]
        if problems and found["verdict"] != "warned":
            found.update(verdict="failed", why="; ".join(problems))
        elif off and found["verdict"] == "green":
            found.update(verdict="warned", why=", ".join(off) + ", and the run says so")
    found["seconds"] = time.perf_counter() - began
    return found


def exponential(decay, rows):
    """An exponential softening table of so many segments, which ends in damage 1."""
    x = np.linspace(0, 11.5, rows + 1)
    damage = np.append(1 - np.exp(-x[:-1]), 1)
    return [(1 + a / decay, d) for a, d in zip(x.tolist(), damage.tolist())]


def softening(rows):
    """Tables of the calcium-silicate bed joint (yade_plugin/law/README.md, softening tables) with
    so many rows, for all joints."""
    kn, ks, ft, cp, GfI, GfII = 3.352e11, 1.445e11, 0.1e6, 0.11e6, 16, 160
    tables = dict(
        tensionTable=exponential(ft**2 / (kn * GfI), rows),
        shearTable=exponential(cp**2 / (ks * GfII), rows),
    )
    return dict(joints={"all": tables})


def crushing(strength, **more):
    """Compressive strength [Pa] of bed and head joints, their energies so that the curves keep
    their shapes."""
    energy = lambda gc, fc: dict(
        compressiveStrength=strength,
        compressiveFractureEnergy=gc * (strength / fc) ** 2,
    )
    joints = {"bed": energy(15000, 7.55e6), "head": energy(31500, 5.93e6)}
    for values in joints.values():
        values.update(more)
    return dict(joints=joints)


def strengths(value):
    """All strengths [Pa] at once; a cap without strength is none."""
    bond = dict(tensileStrength=value, cohesion=value)
    if value == 0:
        return dict(joints={"all": dict(bond, cap=False)})
    return dict(joints={**crushing(value, **bond)["joints"], "crack": bond})


def size(scale):
    """Bricks `scale` times as large, pushed as far over their size."""
    return dict(wall=dict(unit=tuple(scale * u for u in UNIT)), until=scale)


def shape(aspect):
    """Half bricks of the same area, `aspect` times as long as high."""
    area = UNIT[0] / 2 * UNIT[2]
    long, high = (area * aspect) ** 0.5, (area / aspect) ** 0.5
    return dict(wall=dict(unit=(2 * long, UNIT[1], high)))


def friction(value):
    """Friction of all joints; tensile strength goes along with the apex of the cone."""
    bond = dict(friction=value, residualFriction=value)
    if value > 1:
        bond["tensileStrength"] = 0.1e6 / value
    return dict(joints={"all": bond})


def stiffness(contrast):
    """Crack surfaces `contrast` times as stiff as bed joints; masses go along, so that the steps
    are as many."""
    k = dict(normalStiffness=contrast * 3.352e11, shearStiffness=contrast * 1.445e11)
    return dict(joints={"crack": k}, words=f"--density-scaling {max(1, contrast / 10)!r}")


def losing(value, name="shearStiffnessLoss"):
    """The cyclic law with this loss of stiffness in bed and head joints, in two cycles that
    crush."""
    values = {name: value}
    return dict(
        cycles(0.4, "cyclic"),
        joints={"bed": values, "head": values},
        wall=dict(precompression=2e6),
    )


def cycles(amplitude, law):
    """Two cycles of an amplitude [mm]."""
    rate = min(100, 20 * amplitude**0.5 + 10)
    return dict(words=f"--joints {law} --history {amplitude}x2", rate=rate, until=None)


def drawn(seed):
    """Values drawn from all over the axes at once."""
    dice = np.random.default_rng(seed)
    power = lambda low, high: float(10 ** dice.uniform(low, high))
    mu, shape = power(-2, 0), power(-1, 1) ** 0.5
    joint = dict(
        tensileStrength=power(0, 6),
        modeIFractureEnergy=power(-3, 3),
        cohesion=power(6, 8),
        modeIIFractureEnergy=power(0, 4),
        friction=mu,
        residualFriction=mu * dice.uniform(),
    )
    joint["dilatancy"] = joint["residualFriction"] * dice.uniform()
    joints = crushing(power(5, 8), capShear=power(-1, 2))["joints"]
    joints = {
        "all": joint,
        **joints,
        "crack": stiffness(power(0, 3))["joints"]["crack"],
    }
    kind = dice.choice(["local", "combined"])
    return dict(
        joints=joints,
        words=(
            f"--damping {dice.uniform(0, 0.95)!r} --damping-kind {kind} --density-scaling"
            f" {power(0, 4)!r}"
        ),
        wall=dict(
            precompression=power(3, 5.5),
            courses=int(dice.integers(1, 8)),
            unit=(UNIT[0] * shape, UNIT[1], UNIT[2] / shape),
        ),
    )


def points(values, make):
    return [Point(value, **make(value)) for value in values]


DT = [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.2, 1.5]
AXES = {
    "time step / limit": points(DT, lambda v: dict(dt=v)),
    "time step / limit, COMP-4": points(
        [0.5, 0.95, 0.99, 1.02, 1.5], lambda v: dict(dt=v, whole=True, until=0.2)
    ),
    "stiffness of crack / bed joint": points([1, 10, 1e2, 1e3, 1e4, 1e5, 1e6], stiffness),
    "density scaling": points(
        [1, 10, 1e2, 1e3, 1e4, 1e5, 1e6], lambda v: dict(words=f"--density-scaling {v}")
    ),
    "combined damping": points(
        [0, 0.1, 0.3, 0.5, 0.8, 0.95, 0.99], lambda v: dict(words=f"--damping {v}")
    ),
    "local damping": points(
        [0, 0.1, 0.3, 0.5, 0.8, 0.95, 0.99],
        lambda v: dict(words=f"--damping {v} --damping-kind local"),
    ),
    "rate, mm/s": points([0.1, 1, 10, 100, 1000], lambda v: dict(rate=v, until=0.05 * v**0.5)),
    "rate, mm/s, COMP-4": points(
        [10, 100, 1000], lambda v: dict(rate=v, until=0.02 * v**0.5, whole=True)
    ),
    "all strengths, Pa": points([0, 1, 1e3, 1e6, 1e9, 1e12], strengths),
    "fracture energies / usual": points(
        [1e-6, 1e-3, 1, 1e3, 1e6],
        lambda v: dict(
            joints={"all": dict(modeIFractureEnergy=16 * v, modeIIFractureEnergy=160 * v)}
        ),
    ),
    "friction": points([0, 0.1, 0.43, 1, 2], friction),
    "dilatancy / friction": points(
        [0, 0.1, 0.25, 0.5, 1], lambda v: dict(joints={"all": dict(dilatancy=0.43 * v)})
    ),
    "rows of the softening tables": [
        Point("brittle", "--joints brittle"),
        *points([1, 10, 100, 1000, 10000], softening),
    ],
    "cap, Css": points(
        [0, 1, 9, 100, 1000],
        lambda v: dict(joints={"bed": dict(capShear=v), "head": dict(capShear=v)}),
    ),
    "compressive strength, MPa": points([0.1, 0.3, 1, 10, 100, 1000], lambda v: crushing(v * 1e6)),
    "precompression / fc": points(
        [0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99],
        lambda v: dict(wall=dict(precompression=v * 7.55e6)),
    ),
    "half brick, length / height": points([0.02, 0.1, 0.3, 1, 3, 10, 50], shape),
    "courses": points([1, 2, 10, 50, 200], lambda v: dict(wall=dict(courses=v), until=0.2)),
    "size / usual": points([1 / 220, 0.01, 0.1, 1, 10 / 0.22], size),
    "gravity": [Point("off", gravity=False), Point("on")],
    "points along a joint": points([3, 4, 6, 10, 30], lambda v: dict(words=f"--points {v}")),
    "loss of shear stiffness, cyclic law": points([0, 0.3, 0.6, 0.9, 0.99], losing),
    "loss of stiffness by crushing": points(
        [0, 0.25, 0.5, 0.75, 0.99], lambda v: losing(v, "compressionStiffnessLoss")
    ),
    "cycles of so many mm, the paper's law": points(
        [0.05, 0.2, 1, 3], lambda v: cycles(v, "softening")
    ),
    "cycles of so many mm, the cyclic law": points(
        [0.05, 0.2, 1, 3], lambda v: cycles(v, "cyclic")
    ),
}


def runAll(axes):
    """Run axes by name; everything found, by axis and block model, as lists of dicts."""
    found = {}
    for axis in axes:
        for blocks in BLOCKS:
            for point in AXES[axis]:
                result = {"value": point.value, **run(point, blocks)}
                found.setdefault(axis, {}).setdefault(blocks, []).append(result)
                print(
                    (
                        f"{axis:32} {blocks:10} {shown(point.value):8} {result['verdict']:7}"
                        f" {result['seconds']:6.1f} s {result['why']}"
                    ),
                    flush=True,
                )
    return found


def shown(value):
    return value if isinstance(value, str) else f"{value:.3g}"


HEADS = "axis, range, points, green, warned, failed, balance, F over size, made / work"


def rows(found):
    """Numbers of every axis, over both block models."""
    for axis, models in found.items():
        all = [p for results in models.values() for p in results]
        verdicts = [p["verdict"] for p in all]
        worst = lambda name: f"{max(p.get(name, 0) for p in all):.0e}"
        values = [shown(p["value"]) for p in models[BLOCKS[0]]]
        counts = [verdicts.count(v) for v in ("green", "warned", "failed")]
        yield [
            axis,
            f"{values[0]}–{values[-1]}",
            len(all),
            *counts,
            *map(worst, ("balance", "yield", "made")),
        ]


def draw(found, path):
    """The map: a row an axis, above rigid and below deformable units, a square a point."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    colors = {"green": "tab:green", "warned": "gold", "failed": "tab:red"}
    figure, axes = plt.subplots(figsize=(9, 0.42 * len(found) + 0.8))
    for row, (axis, models) in enumerate(found.items()):
        for half, blocks in enumerate(BLOCKS):
            for column, p in enumerate(models[blocks]):
                axes.barh(
                    row + 0.36 * half,
                    0.9,
                    0.34,
                    left=column,
                    color=colors[p["verdict"]],
                )
                if half == 0:
                    axes.text(
                        column + 0.45,
                        row,
                        shown(p["value"]),
                        ha="center",
                        va="center",
                        size=6,
                    )
    axes.set_yticks([row + 0.18 for row in range(len(found))], list(found), size=7)
    axes.invert_yaxis()
    axes.set_xticks([])
    for side in axes.spines.values():
        side.set_visible(False)
    handles = [plt.Rectangle((0, 0), 1, 1, color=c) for c in colors.values()]
    names = ["stable", "refused or stopped with a reason", "failed"]
    axes.legend(
        handles,
        names,
        ncol=3,
        loc="lower right",
        bbox_to_anchor=(1, 1),
        fontsize=7,
        frameon=False,
    )
    axes.set_title("above rigid, below deformable units", size=7, loc="left")
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main(names):
    found = runAll(names or list(AXES))
    print(table(HEADS.split(", "), rows(found)))
    if not names:
        draw(found, os.path.join(HERE, "map.png"))
    results = [p for models in found.values() for r in models.values() for p in r]
    return not any(p["verdict"] == "failed" for p in results)


if __name__ == "__main__":
    raise SystemExit(not main(sys.argv[1:]))
