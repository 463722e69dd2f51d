# SPDX-License-Identifier: GPL-2.0-or-later
"""What supports carry along a wall that is loaded across."""

from hosted import *

BRITTLE = materials.masonry(
    unit=(0.19, 0.1, 0.09),
    joint=0.01,
    E=5e9,
    unit_E=2e10,
    fc=2e7,
    ft=5e4,
    fv0=2e5,
    friction=0.8,
    density=2000,
)


def beam(folder, axes="xyzXYZ", turned=False, gravity=0):
    """Seven bricks beside each other along x, or y, of which the ends are held."""
    made = bricks.Bricks()
    for n in range(7):
        corners = (0.2 * n, 0, 0), (0.2 * n + 0.2, 0.1, 0.1)
        made += bricks.block(*((y, x, z) if turned else (x, y, z) for x, y, z in corners))
    scene = lean(folder, made, BRITTLE, plane=False, gravity=gravity)
    for n in (0, 6):
        scene.hold(n, axes=axes)
    scene.settle()
    return scene


def said(scene, folder):
    """Thrust [kN] and share that a scene answers, and how often a note says so."""
    scene.finish()
    run = readRun(folder)
    values = {a["name"]: a["value"] for a in run["answers"]}
    notes = [one for one in run["notes"] if "arching" in one["text"]]
    return values.get("thrust_held"), values.get("arching_share_held"), len(notes)


QUICKLY = dict(rate=50, within=0.1)


@mark.parametrize(
    "stage, towards, how",
    [
        ("accelerate", (0, 1, 0), QUICKLY),
        ("accelerate", (1, 0, 0), QUICKLY),
        ("lean", (0, -1, 0), {}),
    ],
)
def test_cracked_bricks_between_abutments_carry_all_by_arching(tmp_path, stage, towards, how):
    """F L/8 = N r: a load F on five bricks, a clear span of 1 m, a rise of at most 0.1 m."""
    scene = beam(tmp_path, turned=towards[0])
    getattr(scene, stage)(20.0, towards=towards, **how)
    thrust, share, notes = said(scene, tmp_path)
    load = 20.0 * 9.81e-3 * 5 * 2000 * 0.002  # [kN]
    assert load / 0.8 * 0.9 <= thrust < 2 * load / 0.8
    assert share == approx(min(1, 0.8 * thrust / load), rel=1e-3) and notes == 1


@mark.parametrize("axes, towards", [("yz", (0, 1, 0)), ("yzZ", (0, 1, 0)), ("xyzXYZ", (1, 0, 0))])
def test_edges_that_are_held_out_of_the_plane_and_loads_in_it_have_no_note(tmp_path, axes, towards):
    scene = beam(tmp_path, axes)
    scene.lean(0.2, towards=towards)
    assert said(scene, tmp_path) == (None, None, 0)


def test_the_thrust_of_what_a_wall_carried_before_does_not_count(tmp_path):
    """A flat arch under its weight, and a small load across."""
    scene = beam(tmp_path, gravity=200)
    before, _ = scene.model.supports.alongWall((0, 1, 0))
    scene.lean(0.1, towards=(0, 1, 0))
    assert before > 100 and said(scene, tmp_path) == (None, None, 0)
