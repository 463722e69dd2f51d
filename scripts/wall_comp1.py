"""TUD-COMP-1: slender calcium-silicate wall, cantilever, 0.70 MPa. Paper tables 1 and 2."""

from masonry import options, walls

wall = walls.Wall(
    name="wall_comp1",
    title="TUD-COMP-1: 1.1 × 2.76 m, cantilever, 0.70 MPa",
    halfUnits=10,
    precompression=0.70e6,  # [Pa]
    loadHeight=3.19,  # [m] h0, shear ratio × width above the base
)
raise SystemExit(walls.test(wall, options.parser(__doc__, until=40).parse_args()))
