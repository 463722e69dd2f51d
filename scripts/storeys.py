# SPDX-License-Identifier: GPL-2.0-or-later
"""A house of two storeys: weight on its piers by hand and in the run, and the acceleration that it carries along ± x and ± y, also
with an accidental eccentricity of its floors of 5 %.

It ends with a table of both. Accelerations are the bound of limit analysis, and for the weakest direction a run. It takes about
a minute.
"""

from masonry import Scene, bricks, materials

lintel = bricks.Lintel(bearing=0.3, height=0.3)
door, window = (bricks.Opening(1.8, z, 1.2, h, lintel) for z, h in ((0, 1.8), (0.9, 0.9)))
storeys = [
    bricks.Storey(2.4, front=[door], back=[window], left=[window], span="x"),
    bricks.Storey(2.4, front=[window], back=[window], left=[window], span="y", ring=0.2),
]


def build(name, eccentricity=(0, 0), **options):
    house = bricks.House(4.8, 4.8, storeys, unit=(0.6, 0.3, 0.3), eccentricity=eccentricity)
    stone = house.withFloors(materials.dry(friction=0.6, density=2200), shear=1e6, mass=[300, 150])  # roof: 150 kg/m²
    scene = Scene(name, house, stone, arguments=["--lean", *options.get("arguments", [])])
    scene.platen("bottom")
    return house, stone, scene


house, stone, scene = build("storeys")
sections = {pier: scene.section(house.heights[0], part=pier, name=pier.replace(" ", "_")) for pier in house.piers[0]}
scene.settle()
for pier, weight in house.weights(stone).items():
    print(f"{pier:20}{weight:8.1f} kN by hand {-sections[pier].forces()[0][2] / 1e3:8.1f} kN in the run")
scene.accelerate(1.0, towards=(1, 0, 0))
scene.finish()
