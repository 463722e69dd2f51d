# SPDX-License-Identifier: GPL-2.0-or-later
"""A panel under a load as large as its weight, held at foot and top, accelerated out of its plane.

A strip of thickness t and height h under a load O in the middle of its top, which weighs W and
cracks at the share ξ of its height, falls at (t/h)/ξ·(2 + (O/W)(1 + 1/(1 - ξ))). With O = W the
least is 9 t/h, at ξ = 2/3: 0.343 g; by second order on beds of 2e11 Pa/m, whose edges give way,
0.305 g. The run cracks there and falls at 0.297 to 0.300 g, in half a minute.

``--four-edges`` holds a panel with bond at its vertical edges, too, with a quarter of the usual
fracture energies and with all: hinged 12.6 and 19.0 kPa (AS 3700: 13.2), clamped 24.2 and 27.5
(22.7). It takes about three minutes.
"""

from masonry import AT_REST, Scene, bricks, materials
from masonry.scene.options import parser
from masonry_capacity import panelPressure

words = parser(__doc__, until=None)
words.add_argument("--four-edges", action="store_true", help="a panel with bond")
args = words.parse_args()


def standing(wall, masonry, stress, height, edges=()):
    scene = Scene("panel", wall, masonry, plane=False, arguments=args)
    scene.platen("bottom")
    scene.press(scene.platen("top", rotation="free", guided="xy", height=0.02), stress)
    for n, axes in edges:
        scene.hold(n, axes=axes)
    scene.watch((0.22, 0, height), name="middle")
    scene.view((1, 0, 0))
    scene.settle()
    return scene


if args.four_edges:
    brick, joint, unit = (0.23, 0.11, 0.076), 0.01, (0.24, 0.11, 0.086)  # [m]
    ft, fv0, stress = 0.3e6, 0.42e6, 20e3  # [Pa]
    known: dict = dict(E=3.5e9, unit_E=50e9, fc=16e6, friction=0.6, density=1900, unit_ft=2e6)
    wall = bricks.Wall(1.92, 1.29, unit=unit)
    ends = [n for n, b in enumerate(wall) if min(b.low[0], 1.92 - b.high[0]) < 1e-6]
    code = panelPressure(1.92, 1.29, unit, flexural=1.5 * ft, rupture=3e6, stress=stress)
    for edges, axes, pressure in zip(("hinged", "clamped"), ("y", "yZ"), code):
        found = []
        for share in (0.25, 1.0):
            known |= dict(GfI=share * 0.029e-3 * ft, GfII=share * 0.093e-3 * fv0)  # [J/m²]
            masonry = materials.masonry(unit=brick, joint=joint, ft=ft, fv0=fv0, **known)
            scene = standing(wall, masonry, stress, 0.64, [(n, axes) for n in ends])
            scene.accelerate(30.0, towards=(0, 1, 0), rate=40, within=0.02)
            found.append(1e-3 * scene.factor * 9.81 * 1900 * 0.11)
            scene.finish()
        print(f"{edges}: {found[0]:.3g} to {found[1]:.3g} kPa; AS 3700 {pressure / 1e3:.3g} kPa")
else:
    weight = 2600 * 9.81 * 2.673  # [Pa] at the foot
    wall = bricks.Wall(0.44, 2.673, halves=False)
    scene = standing(wall, materials.dry(normalStiffness=2e11), weight, 1.35)
    isHeld = lambda g: scene.lean(g, towards=(0, 1, 0)) == AT_REST
    low, high = scene.bracket(isHeld, 0.2, 0.6, within=0.02)
    print(f"stands at {low:.4f} g, falls at {high:.4f} g; 9 t/h is {9 * 0.102 / 2.673:.4f}")
    scene.lean(1.02 * high, towards=(0, 1, 0))  # to see how
    scene.finish()
