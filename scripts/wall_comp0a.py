"""TUD-COMP-0a: slender calcium-silicate wall, double clamped, 0.70 MPa. Paper tables 1 and 2."""

from masonry import options, walls

wall = walls.Wall(
    name="wall_comp0a",
    title="TUD-COMP-0a: 1.1 × 2.76 m, double clamped, 0.70 MPa",
    halfUnits=10,
    precompression=0.70e6,  # [Pa]
)
raise SystemExit(walls.test(wall, options.parser(__doc__, until=40).parse_args()))
