# SPDX-License-Identifier: GPL-2.0-or-later
"""The plugin finds the same joints between blocks as the plain records do."""

from hosted import *
from masonry.bricks import *

HOLE = Opening(0.66, 0.405, 0.44, 0.405, Lintel(0.22, 0.162))

STRUCTURES = {
    "running": lambda: Wall(2.2, 1.62, openings=[HOLE]),
    "english": lambda: Wall(1.1, 0.405, bond="english", wythes=2),
    "flemish": lambda: Wall(1.21, 0.405, bond="flemish", wythes=2),
    "header": lambda: Wall(1.1, 0.405, bond="header", wythes=2),
    "leaves": lambda: Wall(0.88, 0.324, wythes=3, collar=0.01),
    "corner": lambda: Corner(1.1, 0.88, 0.405),
    "tee": lambda: Tee(1.76, 0.88, 0.77, 0.405),
    "room": lambda: Room(1.1, 0.88, 0.324),
    "tiles": lambda: stack(10, (0.3, 0.3, 0.03)),
    "mortar": lambda: sum(
        block((0, 0, z), (0.22, 0.1, z + h)) for z, h in ((0, 0.08), (0.08, 0.005), (0.085, 0.08))
    ),
    "thin stones": lambda: Arch(0.4, 0.3, 150, radius=1.0),
    "arch": lambda: Arch(0.2, 0.3, 15, span=3.0, angle=90, skewback=0.25),
    "vault": lambda: BarrelVault(0.2, 2.0, 11, 4, span=3.0, angle=120),
    "dome": lambda: Dome(3.0, 0.3, 5, 12),
    "staggered dome": lambda: Dome(3.0, 0.3, 5, 6, oculus=0.5, staggered=True),
    "turned": lambda: Wall(0.88, 0.324).turned(33, "x").turned(20).moved(5e3, 2e3, 90),
    "cut": lambda: stack(3, (1, 1, 1)).cut((0.5, 0.5, 1.5), (1, 0.3, 0.4)),
}


@mark.parametrize("name", STRUCTURES)
def test_the_plugin_joins_the_same_blocks_without_a_word(scene, name, capsys):
    blocks = STRUCTURES[name]()
    assert all("odd size" in p or "sliver" in p for p in blocks.problems())
    material = unitMaterial()
    number = {addBlock(b.corners, material): n for n, b in enumerate(blocks)}
    engines([MasonryJoint(elastic=True)])
    found = {tuple(sorted((number[i.id1], number[i.id2]))) for i in connect()}
    assert found == {j[:2] for j in blocks.joints()}
    assert "warning" not in capsys.readouterr().out
    masses = [scene.bodies[body].state.mass for body in number]
    assert min(masses) > 0
    assert sum(masses) == approx(1800 * blocks.volume, rel=1e-6)
