# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of capacity and demand, and of an N-V domain, by matplotlib without a window."""

import math

import numpy as np

from masonry.arguments import FilePath
from masonry.numbers import drawing
from .bilinear_curve import Bilinear, Pushover
from .n2 import Demand
from .domains import Domain

DPI = 110
CURVE, IDEAL, SPECTRUM, TARGET = "0.45", "tab:blue", "tab:green", "tab:red"


def _corners(curve):
    """Displacements and forces of a bilinear curve."""
    moved = [0, curve.yieldDisplacement, curve.ultimateDisplacement]
    return np.array(moved), np.array([0, curve.yieldForce, curve.yieldForce])


def forces(push: Pushover, curve: Bilinear, path: FilePath) -> None:
    """Draw the curve of a push and its bilinear one: force over displacement. Writes a PNG file."""
    ends = f"du {curve.ultimateDisplacement:.4g} mm{'' if curve.reached else ' (not reached)'}"
    label = (
        f"bilinear, {curve.rule}: Vy {curve.yieldForce:.4g} kN, dy"
        f" {curve.yieldDisplacement:.3g} mm,\n{ends}, ductility {curve.ductility:.3g}"
    )
    with drawing.picture(path, 7, 4.6, DPI) as figure:
        axes = figure.subplots()
        axes.plot(push.displacement, push.force, color=CURVE, lw=1.0, label="the push")
        axes.plot(*_corners(curve), color=IDEAL, lw=1.8, label=label)
        axes.set_ylim(bottom=min(0, 1.1 * float(push.force.min())))
        axes.set_title(str(push.run.get("title", "")))
        labels = "displacement [mm]", "force carried at both ends [kN]"
        drawing.finish(axes, *labels, fontsize=9)


def capacity(push: Pushover, found: Demand, path: FilePath) -> None:
    """Draw capacity and demand of the equivalent system: acceleration over displacement. Writes a
    PNG file."""
    gamma, mass, spectrum = found.system.gamma, found.system.mass, found.spectrum
    asAcceleration = lambda force: 1e3 * force / gamma / mass
    with drawing.picture(path, 7, 5.2, DPI) as figure:
        axes = figure.subplots()
        sd = 1e3 * spectrum.accelerations * (spectrum.periods / (2 * math.pi)) ** 2
        axes.plot(sd, spectrum.accelerations, color=SPECTRUM, lw=1.4, label="elastic spectrum")
        axes.plot(
            push.displacement / gamma,
            asAcceleration(push.force),
            color=CURVE,
            lw=1.0,
            label="the push",
        )
        moved, force = _corners(found.curve)
        axes.plot(
            moved / gamma,
            asAcceleration(force),
            color=IDEAL,
            lw=1.8,
            label=f"bilinear, {found.curve.rule}",
        )
        elastic = found.elasticDisplacement, found.elasticAcceleration
        axes.plot(
            [0, elastic[0]],
            [0, elastic[1]],
            color="0.3",
            lw=0.8,
            ls=(0, (4, 3)),
            label=f"T* = {found.period:.3g} s",
        )
        target = found.equivalentDisplacement
        axes.axvline(target, color=TARGET, lw=1.0, ls=(0, (6, 3)))
        height = min(found.strength, found.strength * found.ductility)
        axes.plot(target, height, "o", color=TARGET, ms=6, label=f"demand dt* = {target:.4g} mm")
        axes.set_xlim(0, 1.25 * max(target, moved[-1] / gamma, elastic[0]))
        axes.set_ylim(0, 1.1 * max(spectrum.accelerations.max(), asAcceleration(push.force).max()))
        axes.set_title(f"{push.run.get('title', '')}\n{spectrum.name}", fontsize=9)
        drawing.finish(
            axes, "displacement of the equivalent system [mm]", "acceleration [m/s²]", fontsize=9
        )


def domain(found: Domain, path: FilePath) -> None:
    """Draw an N-V domain, and runs as points. Writes a PNG file."""
    with drawing.picture(path, 7, 4.6, DPI) as figure:
        axes = figure.subplots()
        for key, label, dash in (
            ("largest", "limit analysis, at most", "-"),
            ("withoutDilatancy", "limit analysis, without dilatancy", (0, (5, 3))),
        ):
            points = [
                (one.normal, getattr(one, key))
                for one in found.bounds
                if getattr(one, key) is not None
            ]
            if points:
                axes.plot(*zip(*points), marker=".", color=IDEAL, ls=dash, label=label)
        for n, run in enumerate(found.runs):
            axes.plot(
                run.normal, run.shear, "o", color=TARGET, ms=6, label="runs" if n == 0 else None
            )
            axes.annotate(
                run.name,
                (run.normal, run.shear),
                textcoords="offset points",
                xytext=(6, -10),
                fontsize=8,
            )
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
        drawing.finish(
            axes, "normal force at the base, compression [kN]", "shear force [kN]", fontsize=9
        )
