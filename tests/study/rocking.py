# SPDX-License-Identifier: GPL-2.0-or-later
"""A free block of 0.25 × 1 m for incremental dynamic analysis. A line a run is added to the file
ended.txt beside the table."""

import os

from masonry import Scene, bricks, materials

scene = Scene(
    "rocking",
    bricks.stack(1, (0.25, 0.25, 1.0)),
    materials.dry(friction=5, normalStiffness=4e10),
    dt_fraction=0.4,
)
scene.platen("bottom")
scene.watch((0, 0, 1.0), name="corner")
scene.settle()
scene.shake([0.0, 1.0, 0.0], every=0.1, unit="m/s²", after=1.2)
scene.finish()
if "YADE_BATCH" in os.environ:
    table = os.environ["YADE_BATCH"].rpartition(":")[0]
    with open(os.path.join(os.path.dirname(table), "ended.txt"), "a") as f:
        f.write(os.path.basename(scene.results.directory) + "\n")
