# SPDX-License-Identifier: GPL-2.0-or-later
"""A house of two storeys of dry stone: weights on its piers by hand and in a run, then the
acceleration that it carries along ± x and ± y, and along the weakest of these also with floors
whose mass is 5 % off their middle.

It ends with a table of runs beside bounds of limit analysis: from 0.414 g along y, of at most
0.452 g, to 0.505 g against x, of at most 0.555 g. It takes about five minutes.
"""

from masonry import Scene, bricks, materials
from masonry.scene.options import parser

args = parser(__doc__, until=None).parse_args()
TOWARDS = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0)}
lintel = bricks.Lintel(bearing=0.4, height=0.4)
door, window, small = (
    bricks.Opening(x, z, 1.2, 2.0 - z, lintel) for x, z in ((1.4, 0), (1.4, 0.8), (1.0, 0.8))
)
ground = bricks.Storey(2.4, front=[door], back=[window], left=[small], span="x")
upper = bricks.Storey(2.4, front=[window], back=[window], span="y", ring=0.2)
table: dict[tuple[str, float], float] = {}
rows = ["towards  mass off   in the run    bound"]


def push(side, off):
    """The acceleration that was held [g], with the mass of the floors off their middle by a share
    of the plan."""
    house = bricks.House(4.0, 3.2, [ground, upper], unit=(0.8, 0.4, 0.4), eccentricity=(off, off))
    stones = materials.dry(friction=0.6, density=2200)
    house.withFloors(stones, shear=1e6, mass=[300, 150])  # [N/m], [kg/m²] of the floor and the roof
    scene = Scene("storeys", house, stones, arguments=args)
    scene.platen("bottom")
    weights = house.weights(stones)
    piers = {
        name: scene.section(house.heights[0], name, name.replace(" ", "_")) for name in weights
    }
    scene.settle()
    if not table:
        for name, weight in weights.items():
            print(
                f"{name:16}{weight:7.1f} kN by hand{-piers[name].forces()[0][2] / 1e3:7.1f} kN in"
                " the run"
            )
    scene.accelerate(1.0, towards=TOWARDS[side], within=0.05)
    scene.finish()
    table[side, off] = scene.factor
    found = scene.bounds.entries.values()  # nothing with --lean
    bound = "".join(f"{one['factor']:8.3f} g" for one in found if "factor" in one) or "none"
    rows.append(f"{side:>8} {off:8.0%} {scene.factor:8.3f} g {bound:>10}")


for side in TOWARDS:
    push(side, 0)
weakest = min(table, key=lambda case: table[case])[0]
for off in (0.05, -0.05):
    push(weakest, off)
print("\n".join(rows))
