# SPDX-License-Identifier: GPL-2.0-or-later
"""A dry groin vault on four piers, of which two move 5 mm away.

Every pier carries a quarter of the weight, 22.47 kN. Moments of half a vault about its crown allow
a thrust between 6.2 kN, from the top of the crown to the inner edges of the springings, and 13.1
kN; it falls from 9.1 to 7.3 kN. It takes about 3 s.
"""

from masonry import Scene, bricks, materials

vault = bricks.CrossVault(span=3.0, thickness=0.2, stones=13, rows=4, pier=0.4)
low = [(x, y, -0.3) for x in (-1.9, 1.5) for y in (-1.9, 1.5)]
piers = [bricks.block((x, y, z), (x + 0.4, y + 0.4, 0), "pier") for x, y, z in low]
stones = materials.dry(friction=0.7, normalStiffness=2e10)

scene = Scene("groin_vault", sum(piers, vault), stones, title="Groin vault on piers that spread")
held = [scene.hold(len(vault) + n, name=f"pier{n}") for n in range(4)]
scene.watch((0, 0, vault.high[2]), name="crown")
scene.settle()
scene.move(held[2:], x=5)  # [mm]
scene.settle()
print("thrust [kN]:", *(f"{scene.curve()[f'pier3_force_x_kN'][row]:.2f}" for row in (0, -1)))
scene.finish()
