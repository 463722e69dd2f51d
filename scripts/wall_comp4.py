"""TUD-COMP-4: squat calcium-silicate wall, double clamped, 0.50 MPa. Paper tables 1 and 2.

The wall is 4.0 m long, 18.18 units; it is built of 36 half units, 3.96 m.
"""

from masonry import options, walls

wall = walls.Wall(
    name="wall_comp4",
    title="TUD-COMP-4: 4.0 × 2.76 m, double clamped, 0.50 MPa",
    halfUnits=36,
    precompression=0.50e6,  # [Pa]
)
raise SystemExit(walls.test(wall, options.parser(__doc__, until=12).parse_args()))
