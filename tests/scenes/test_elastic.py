# SPDX-License-Identifier: GPL-2.0-or-later
"""The first settle() where all joints stay elastic, and where they do not."""

from hosted import *
from masonry.model.engines import advance


def settled(folder, wall, stones, pressure, **settings):
    """A scene after its first settle(), and that stage in run.json."""
    scene = standing(folder, wall, stones, **settings)
    top = scene.platen("top", rotation="free")
    scene.press(top, pressure)  # [Pa]
    assert scene.settle(longest=0.001) == AT_REST  # however little time there is
    return scene, scene.running.state.stages[0]


@mark.parametrize("blocks, plane", [("rigid", True), ("rigid", False), ("deformable", True)])
def test_elastic_joints_are_in_equilibrium_after_one_solution(tmp_path, blocks, plane):
    """Steps that follow do not move the bricks, and the balance counts the work of the loads."""
    wall, settings = bricks.Wall(0.66, 0.486), dict(blocks=blocks, mass_scaling="auto")
    if not plane:
        settings["plane"] = False
    scene, stage = settled(tmp_path, wall, materials.calciumSilicate(), 0.2e6, **settings)
    assert stage["solved"] and scene.running.state.steps < 150
    model = scene.model
    missing, moving = model.supports.unrest()
    assert missing < 1e-8 and moving < 1e-12
    sunk = model.supports.moved(scene.targets["top"])[0][2]
    advance(2000)
    assert model.supports.moved(scene.targets["top"])[0][2] == approx(sunk, rel=1e-7)
    energy = model.energy.balance()
    assert abs(energy["error"]) < 1e-5 and energy["dissipated_shear"] == 0
    scene.finish()


def test_points_that_open_without_loss_are_in_the_balance_of_a_solution(tmp_path):
    """Points without strength open over a brick that is held, so the first move is corrected."""
    wall, settings = bricks.Wall(0.44, 0.243, halves=False), dict(blocks="deformable", plane=False)
    scene = standing(tmp_path, wall, materials.calciumSilicate(), joints="brittle", **settings)
    scene.press(scene.platen("top", rotation="held", height=0.05), 0.2e6)
    scene.hold((0.11, 0.05, 0.12))
    scene.settle()
    assert scene.running.state.stages[0]["solved"]
    # the error is 0.017 if forces after a move do not count
    assert abs(scene.model.energy.balance()["error"]) < 1e-5
    scene.finish()


def test_joints_that_open_are_settled_by_steps(tmp_path):
    """The upper of two dry blocks overhangs beyond the middle third."""
    corners = [
        bricks.boxCorners((x, 0, z), (x + 0.3, 0.2, z + 0.2)) for x, z in ((0, 0), (0.11, 0.2))
    ]
    pile = bricks.Bricks([bricks.Block(c, n) for n, c in enumerate(corners)])
    scene = standing(tmp_path, pile, materials.dry(friction=0.6))
    assert scene.settle() == AT_REST
    assert not scene.running.state.stages[0]["solved"] and scene.running.state.steps > 500
    assert scene.model.supports.unrest()[0] < 5e-3
    scene.finish()
