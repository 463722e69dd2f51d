# SPDX-License-Identifier: GPL-2.0-or-later
"""A slab that slides: a main shock of a peak of ``--main`` [m/s²] moves it before the record
does."""

from masonry import Scene, bricks, materials
from masonry.scene import options

EVERY = 0.002  # [s]
pulse = [0.0] * 5 + [1.0] * 50 + [0.0] * 75

parser = options.parser(__doc__, until=None)
parser.add_argument("--main", type=float, default=0)
args = parser.parse_args()
stone = materials.dry(friction=0.3, normalStiffness=1e11, shearStiffness=1e9, density=2000)
scene = Scene("slab", bricks.block((0, 0, 0), (1, 1, 0.2)), stone, arguments=args)
scene.platen("bottom")
scene.watch(0, name="slab")
scene.settle()
scene.shakeAgain([pulse], EVERY, scales=[args.main], unit="m/s²")
[moved] = [a["value"] for a in scene.answers if a["name"] == "residual_slab_x"]
scene.result("damage", int(abs(moved) > 5), how=f"it slid by {moved:.3g} mm")
scene.shake(pulse, EVERY, unit="m/s²")
scene.finish()
