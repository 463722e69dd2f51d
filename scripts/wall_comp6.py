"""TUD-COMP-6: squat calcium-silicate wall, cantilever, 0.50 MPa. Paper tables 1 and 2.

The wall is 4.0 m long, 18.18 units; it is built of 36 half units, 3.96 m.
"""

from masonry import options, walls

wall = walls.Wall(
    name="wall_comp6",
    title="TUD-COMP-6: 4.0 × 2.76 m, cantilever, 0.50 MPa",
    halfUnits=36,
    precompression=0.50e6,  # [Pa]
    loadHeight=3.20,  # [m] h0, shear ratio × width above the base
)
raise SystemExit(walls.test(wall, options.parser(__doc__, until=25).parse_args()))
