# SPDX-License-Identifier: GPL-2.0-or-later
"""Panels out of their plane by AS 3700, against its mechanism by numbers."""

from usual import *
from masonry_capacity import panelPressure

UNIT = LENGTH, THICK, HIGH = 0.24, 0.11, 0.086  # [m]


def test_the_example_of_think_brick_australia():
    """4 × 3 m, f'mt 0.2 MPa, f'ut 0.8 MPa, capacity reduction factor 0.6: 1.11 kPa."""
    hinged, _ = panelPressure(4, 3, UNIT, 0.2e6, 0.8e6)
    assert 0.6e-3 * hinged == approx(1.11, abs=0.005)


@mark.parametrize("length, height", [(2.0, 3.0), (4.0, 2.5), (6.0, 2.5)])
@mark.parametrize("stress", [0.0, 0.1e6, 1e6])
def test_its_coefficients_are_the_virtual_work_of_its_mechanism(length, height, stress):
    """Diagonal cracks rise by G on 1; the deflection is 1 in the middle, plane between cracks."""
    G = 2 * HIGH / LENGTH
    across = min(length / 2, height / 2 / G)  # of a diagonal crack
    up = G * across
    x, z = ((np.arange(1000) + 0.5) / 1000 * size for size in (length, height))
    x, z = np.minimum(x, length - x) / across, np.minimum(z, height - z) / up
    volume = np.minimum(np.minimum(x[:, None], z), 1).mean() * length * height
    bond, fd = 0.6, 1e-6 * stress  # [MPa]
    strength = min(2 * bond**0.5 * min(1 + fd / bond, 2), 0.44 * 3.5 + 0.56 * bond)
    bending = 1e6 * strength * THICK**2 / 6  # [N] of a vertical crack
    B, root = HIGH / (1 + G * G) ** 0.5, (1 + G * G) ** 0.5
    modulus = 2 * (B * THICK) ** 2 / (3 * THICK + 1.8 * B) / (LENGTH * root)
    diagonal = 1e6 * (2.25 * bond**0.5 + 0.15 * fd) * modulus
    # rotations: of the four diagonals about themselves, of the crack in the middle, of both edges
    inside = 4 * diagonal * (G + 1 / G) + bending * (height - 2 * up) * 2 / across
    edges = 2 * bending * height / across
    found = panelPressure(length, height, UNIT, 0.6e6, 3.5e6, stress)
    assert found == approx((inside / volume, (inside + edges) / volume), rel=1e-3)


@mark.parametrize(
    "changed, message",
    [
        (dict(length=0), "length 0 m must be above 0"),
        (dict(unit=(0.2, 0.1)), "unit (0.2, 0.1) must be a length, thickness and height"),
        (dict(flexural=0), "flexural 0 Pa must be above 0"),
        (dict(stress=-1), "stress -1 Pa must be at least 0"),
    ],
)
def test_what_is_wrong_is_refused(changed, message):
    values = dict(length=4, height=3, unit=UNIT, flexural=0.2e6, rupture=0.8e6)
    with raises(ValueError, match=re.escape(message)):
        panelPressure(**{**values, **changed})
