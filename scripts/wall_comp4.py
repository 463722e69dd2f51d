"""TUD-COMP-4: squat calcium-silicate wall, double clamped, 0.50 MPa. Tables 1 and 2 of the paper.

The wall is 4.0 m long, 18.18 units; it is built of 36 half units, 3.96 m.
"""

from masonry import options, walls
from masonry.loading import push, settle
from masonry.run import Run

args = options.parser(__doc__, until=12).parse_args()

wall = walls.Wall(
    name="wall_comp4",
    title="TUD-COMP-4: 4.0 × 2.76 m, double clamped, 0.50 MPa",
    halfUnits=36,
    precompression=0.50e6,  # [Pa] on the top course
)

with Run(wall.name, args) as run:
    model = run.build(walls.WallModel(wall, args))  # bricks between two blocks
    settle(run, model)  # gravity and precompression, until the wall is at rest
    push(run, model)  # the upper block to --until or along --history, a row every 0.01 mm
raise SystemExit(run.status)
