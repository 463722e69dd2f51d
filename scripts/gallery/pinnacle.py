# SPDX-License-Identifier: GPL-2.0-or-later
"""A pinnacle of six drums, read from a file: a horizontal acceleration grows until it falls.

It tips about the edge of its foot between 0.587 and 0.589 g; by hand at 0.588 g. It takes about
3 s.
"""

import os
import sys

from masonry import Scene, bricks, materials

here = os.path.dirname(os.path.abspath(sys.argv[0]))
drums = bricks.fromFile(os.path.join(here, "pinnacle.obj")).named("pinnacle")

scene = Scene("pinnacle", drums, materials.dry(friction=0.7, normalStiffness=2e10))
scene.platen("bottom")
scene.watch(drums.high, name="tip")
scene.settle()
scene.accelerate(0.8, rate=0.4)  # [g], [g/s]
print(f"holds {scene.factor:.3f} g")
scene.finish()
