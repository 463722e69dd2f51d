# SPDX-License-Identifier: GPL-2.0-or-later
"""A barrel vault beside compas_dem: builds the vault, writes it as a problem of compas_dem, runs
scripts/compas.py on it, as built and with supports half a millimetre farther apart, and compares
the results. It takes 20 s.

/usr/bin/python3 validation/barrel_vault/barrel_vault.py
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from masonry import bricks
from masonry.bricks.geometry import hull
from scipy.optimize import linprog

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), *2 * [os.pardir], "scripts")
DENSITY, FRICTION, GRAVITY = 2000, 0.5, 9.81
SPREAD = 0.5e-3  # [m]
THICKNESS, LENGTH, SPAN, RISE = 0.25, 3.0, 7.0, 0.1  # [m], of the middle of the shell
COURSES, ROWS = 9, 13
SHARE, NEAR = 0.02, 5.0  # limits of difference: of forces [-], of heights [mm]
#: What compas_dem has: weight of the free blocks and vertical reaction, thrust [kN], height of the
#: thrust over the inner edge of the joints from the left support to the crown [mm].
PUBLISHED = [80.156, 80.166, 175.97, 2.2, 124.2, 205.6, 246.3]


def vault():
    """The vault, its middle at x = 0 and its lowest corner at z = 0, and the numbers of the blocks
    that are held."""
    radius = RISE / 2 + SPAN**2 / (8 * RISE)
    angle = 2 * np.degrees(np.arcsin(SPAN / 2 / radius))
    inner = radius - THICKNESS / 2
    made = bricks.BarrelVault(THICKNESS, LENGTH, COURSES, ROWS, radius=inner, angle=angle)
    held = [n for n, block in enumerate(made) if block.course in (0, COURSES - 1)]
    return made.moved(dx=-(made.low[0] + made.high[0]) / 2, dz=-made.low[2]), held


def typed(kind, **data):
    return {"dtype": kind, "data": data}


def problem(blocks, held, moved=(), conditions=None, **contact):
    """A problem of compas_dem.

    :param held: numbers of blocks
    :param moved: pairs of the number of a held block and its displacement [m]
    :param conditions: further boundary conditions
    :param contact: of MohrCoulomb
    """
    elements, nodes = {}, {}
    for n, block in enumerate(blocks):
        vertex = {str(k): dict(zip("xyz", p)) for k, p in enumerate(block.corners)}
        face = {str(k): [*map(int, f)] for k, f in enumerate(hull(np.array(block.corners)))}
        mesh = typed("compas.datastructures/Mesh", attributes={}, vertex=vertex, face=face)
        own = dict(transformation=None, name="Block", material="stone", is_support=n in held)
        elements[f"block {n}"] = typed("compas_dem.elements/Block", geometry=mesh, **own)
        nodes[str(n)] = dict(element=f"block {n}")
    children = [dict(element=guid) for guid in elements]
    model = typed(
        "compas_dem.models/BlockModel",
        transformation=None,
        elements=elements,
        materials=dict(stone=typed("compas_dem.material/Stone", density=DENSITY)),
        tree=dict(root=dict(name="root", children=children)),
        graph=dict(node=nodes, edge={}),
    )
    rows = [dict(block_index=n, translation=[*by], rotation=[0, 0, 0]) for n, by in moved]
    said = {"gravity": True, "g": GRAVITY, "displacements": rows, **(conditions or {})}
    law = typed("compas_dem.interactions/MohrCoulomb", **{"mu": FRICTION, **contact})
    return typed(
        "compas_dem.problem/Problem",
        name="Problem",
        model=model,
        boundary_conditions=typed("compas_dem.problem/BoundaryConditions", **said),
        contact_properties=typed(
            "compas_dem.interactions/ContactProperties", contact_model=law, joint_model=None
        ),
    )


def solved(asked):
    """The graph of a problem after scripts/compas.py."""
    with tempfile.TemporaryDirectory() as folder:
        given, got = (os.path.join(folder, name) for name in ("problem.json", "results.json"))
        with open(given, "w") as file:
            json.dump(asked, file)
        words = ["yade", "-n", "-x", os.path.join(SCRIPTS, "compas.py"), given, got, "--lean"]
        subprocess.run(words, check=True, cwd=folder, stdout=subprocess.DEVNULL)
        with open(got) as file:
            return json.load(file)["data"]["model"]["data"]["graph"]


def edges(graph):
    """Both nodes of every contact, the lower one first, and its attributes."""
    for u, ends in graph["edge"].items():
        for v, edge in ends.items():
            if "force" in edge:
                yield *sorted((int(u), int(v))), edge


def measured(blocks, held, graph):
    """Weight, vertical reaction, thrust [kN], and heights of the thrust over inner edges [mm]."""
    free = [block for n, block in enumerate(blocks) if n not in held]
    reaction, forces, moments = 0.0, np.zeros((COURSES, 3)), np.zeros(COURSES)
    inner = {}
    for u, v, edge in edges(graph):
        reaction -= edge["force"][2] * ((u in held) - (v in held))
        one, other = blocks[u].course, blocks[v].course
        if one != other:  # the force on the block that is nearer to the right support
            course, sign = min(one, other), 1 if one > other else -1
            places, pushes = np.array(edge["contact_point"]), sign * np.array(edge["force_vector"])
            forces[course] += pushes.sum(axis=0)
            moments[course] += np.cross(places, pushes)[:, 1].sum()
            low = places[places[:, 2].argmin()]
            inner[course] = min(inner.get(course, (9, 0)), (low[2], low[0]))
    heights = []
    for course in range(COURSES // 2):
        z, x = inner[course]
        along, _, up = forces[course]
        heights.append(1e3 * ((moments[course] + x * up) / along - z))
    weight = 1e-3 * GRAVITY * DENSITY * bricks.Bricks(free).volume
    return [weight, 1e-3 * reaction, 1e-3 * forces[0][0], *heights]


def leastThrust(blocks):
    """Least thrust of rigid blocks without sliding [kN]: in each joint the moment about the inner
    edge turns one way, that about the outer edge the other way. There is no largest thrust, because
    a straight line lies within the vault.

    Unknown are the thrust H and H z, with its height z at the crown.
    """
    rows, most = [], []
    for course in range(1, (COURSES + 1) // 2):
        joint = [p for b in blocks if b.course == course for p in b.corners]
        radial = sorted({(round(x, 9), round(z, 9)) for x, _, z in joint})[:2]
        for sign, (x, z) in zip((-1, 1), sorted(radial, key=lambda p: p[1])):
            moment = 0.0
            for block in blocks:
                if course <= block.course <= COURSES // 2:
                    half = 0.5 if block.course == COURSES // 2 else 1.0
                    middle = np.mean(block.corners, axis=0)[0]
                    if half < 1:  # the left half of the keystone
                        middle = min(p[0] for p in block.corners) / 2
                    weight = half * GRAVITY * DENSITY * bricks.Bricks([block]).volume
                    moment += weight * (middle - x)
            rows.append([-sign * z, sign])  # sign (H z - H z0 - moment) <= 0
            most.append(sign * moment)
    return 1e-3 * linprog([1, 0], rows, most).x[0]


def main():
    blocks, held = vault()
    right = [n for n in held if blocks[n].middle[0] > 0]
    spread = [(n, (SPREAD, 0.0, 0.0)) for n in right]
    built, parted = (
        measured(blocks, held, solved(problem(blocks, held, moved))) for moved in ((), spread)
    )
    heads = ["weight of free blocks [kN]", "vertical reaction [kN]", "thrust [kN]"]
    heads += [f"height of the thrust, joint {n} [mm]" for n in range(1, 1 + COURSES // 2)]
    print("| | compas_dem | as built | supports 0.5 mm apart |\n|---|---|---|---|")
    for head, *row in zip(heads, PUBLISHED, built, parted):
        print(f"| {head} | " + " | ".join(f"{value:.3f}" for value in row) + " |")
    print(f"\nLeast thrust of rigid blocks: {leastThrust(blocks):.1f} kN")
    away = np.abs(np.subtract(parted, PUBLISHED))
    return int((away > [SHARE * f for f in PUBLISHED[:3]] + [NEAR] * (COURSES // 2)).any())


if __name__ == "__main__":
    sys.exit(main())
