# SPDX-License-Identifier: GPL-2.0-or-later
"""Prisms under a load that lies beside their axis: what a strain gradient does to their strength.

yade -n -x validation/open_tests/eccentric_prisms.py [--only NAME ...]

N is the largest load at an eccentricity e in the thickness t, N0 that of an even stress fc. The
edge stress is that of linear stresses without tension under N, over fc.
"""

import os
import sys

import numpy as np
from scipy.optimize import brentq

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # yade leaves it out
from common import finished, main, words  # noqa: E402
import panels  # noqa: E402
from masonry import Scene, bricks, materials  # noqa: E402

L, T, H = UNIT = bricks.walls.UNIT
PLACES = {"0": 0.0, "t/12": 1 / 12, "t/6": 1 / 6, "t/4": 1 / 4, "t/3": 1 / 3}
EDGES = "t/6", "t/3"
SLIP = 0.01  # most by which the load leaves its place until the peak [t]
X = np.linspace(-0.5, 0.5, 19000)  # places in the thickness [t]
SOLID = np.ones(len(X))
#: A hollow block of 190 mm with mortar on its face shells of 32 mm alone.
SHELLS = np.where(np.abs(X) > 0.5 - 32 / 190, 1.0, 0.0)


def section(e, widths=SOLID, plastic=True):
    """N/N0 of a plane section without tension at e [t]: plastic, or linear until its edge has
    fc."""
    if not e:
        return 1.0

    def stress(depth):  # of the compressed zone
        deep = 1 - (0.5 - X) / depth
        return widths * (np.clip(deep * len(X), 0, 1) if plastic else np.maximum(deep, 0))

    depth = brentq(lambda depth: (stress(depth) * (X - e)).sum(), 1e-3, 1e6)
    return stress(depth).sum() / widths.sum()


def prism(e, masonry, options=(), shear=0.0, courses=4, halves=False):
    """N/N0 of a stack of bricks, or of pairs of half bricks, between platens. The upper one moves
    and turns freely under a load at e [t], with a shear force of ``shear`` times it at mid-height.
    """
    bed, half = masonry.joints["bed"], courses * H / 2
    fc = bed.compressiveStrength
    closure = fc * (bed.peakRatio / bed.normalStiffness + H / masonry.unit.young)
    reach = 1.5e3 * (courses - 1) * closure  # [mm] within a second
    more = words("prism", "--rate", f"{reach:g}", *options)
    blocks = bricks.stack(courses, UNIT)
    if halves:
        blocks = blocks.cut((L / 2, 0, 0), (1, 0, 0))
    scene = Scene("prism", blocks, masonry, gravity=0, arguments=more)
    scene.platen("bottom")
    place = (L * (0.5 + e), T / 2, half)
    top = scene.platen("top", rotation="free", point=place, height=0.05)
    scene.settle()
    scene.push(top, reach, direction=(shear, 0, -1))
    curve = {name: np.abs(values) for name, values in finished(scene)[1].items()}
    peak = curve["base_N_kN"].argmax()
    N, V, M = (curve[f"base_{name}"][peak] for name in ("N_kN", "V_x_kN", "M_y_kNm"))
    lever = abs(M - V * half) / N / L
    if abs(lever - e) > SLIP:
        raise ValueError(f"the load is at {lever:.3f} t and should be at {e:.3f} t")
    return 1e3 * N / (fc * L * T)


def calciumSilicate(poisson=0.16, **bed):
    """The paper's masonry with other properties of its bed joints."""
    found = materials.calciumSilicate()
    found.unit.poisson = poisson
    found.joints["bed"].set(**bed)
    return found


def weak():
    """Weak stone masonry, all assumed."""
    known = dict(E=1.5e9, fc=3e6, unit_E=20e9, ft=0.1e6, fv0=0.15e6, friction=0.6, density=2000)
    return materials.masonry(unit=(L, T, H - 0.01), joint=0.01, **known)


def cells(loadAt, widths=SOLID):
    """Cells of a row: ``loadAt`` gives N/N0 at e [t]."""
    loads = {name: loadAt(e) for name, e in PLACES.items()}
    edges = [loads[name] / section(PLACES[name], widths, plastic=False) for name in EDGES]
    return [f"{value:.2f}" for value in (*loads.values(), *edges)]


def runs(*options, make=calciumSilicate, rig={}, **bed):
    return lambda: cells(lambda e: prism(e, make(**bed), options, **rig))


DEFORMABLE = "--blocks", "deformable", "--divisions", "2"
STRAIGHT = dict(elasticLimitRatio=0.95, peakRatio=1.1)  # nearly no hardening
SHEARED = dict(rig=dict(shear=1 / 3, courses=2))
CASES = {
    "by hand, linear": lambda: cells(lambda e: section(e, plastic=False)),
    "by hand, plastic": lambda: cells(section),
    "by hand, plastic, face shells": lambda: cells(lambda e: section(e, SHELLS), SHELLS),
    "rigid, as by default": runs(),
    **{f"rigid, {n} points": runs("--points", n) for n in ("3", "5", "8", "64")},
    "rigid half bricks": runs(rig=dict(halves=True)),
    "deformable": runs(*DEFORMABLE),
    "deformable, Poisson's ratio 0.4": runs(*DEFORMABLE, poisson=0.4),
    "rigid, four times Gc": runs(compressiveFractureEnergy=60e3),
    "rigid, straight to the peak": runs(compressiveFractureEnergy=1.1e3, **STRAIGHT),
    "deformable, straight and brittle": runs(
        *DEFORMABLE, compressiveFractureEnergy=250, **STRAIGHT
    ),
    "rigid, clay of the panel": runs(make=panels.masonryOf, unit_ft=None),
    "rigid, weak stone": runs(make=weak),
    "rigid, shear force N/3": runs(**SHEARED),
    "rigid, shear force N/3, capShear 0": runs(capShear=0, **SHEARED),
}

if __name__ == "__main__":
    names = [f"N/N0 at {name}" for name in PLACES] + [f"edge stress at {name}" for name in EDGES]
    sys.exit(main(__doc__, names, CASES))
