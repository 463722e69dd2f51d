"""TUD-COMP-1: slender calcium-silicate wall, cantilever, 0.70 MPa. Tables 1 and 2 of the paper."""

from masonry import options, walls
from masonry.loading import push, settle
from masonry.run import Run

args = options.parser(__doc__, until=40).parse_args()

wall = walls.Wall(
    name="wall_comp1",
    title="TUD-COMP-1: 1.1 × 2.76 m, cantilever, 0.70 MPa",
    halfUnits=10,
    precompression=0.70e6,  # [Pa] on the top course
    loadHeight=3.19,  # [m] above the base: shear ratio × width
)

with Run(wall.name, args) as run:
    model = run.build(walls.WallModel(wall, args))  # bricks between two blocks
    settle(run, model)  # gravity and precompression, until the wall is at rest
    push(run, model)  # the upper block to --until or along --history, a row every 0.01 mm
raise SystemExit(run.status)
