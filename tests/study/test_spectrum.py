# SPDX-License-Identifier: GPL-2.0-or-later
"""Spectral acceleration against closed forms of the linear oscillator."""

from usual import *
from masonry_study.spectrum import spectralAcceleration


@mark.parametrize("period", [0.05, 0.3, 1.0, 4.0])
@mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_a_step_overshoots_by_the_logarithmic_decrement(period, damping):
    """ω² max|u| = a (1 + exp(-πζ/√(1-ζ²))), reached after half a period."""
    values = [2.0] * (int(3 * period / 0.005) + 3)
    expected = 2 * (1 + math.exp(-math.pi * damping / math.sqrt(1 - damping**2)))
    found = spectralAcceleration(values, 0.005, period, damping)
    assert found == approx(expected, rel=5e-4) and found <= expected * (1 + 1e-9)


def test_a_sine_in_resonance_grows_by_pi_in_every_period():
    """Without damping ω² u = (ωt cos ωt - sin ωt)/2, whose amount after n periods is nπ."""
    period, every = 0.5, 1e-3
    for periods in (1, 3, 6):
        time = every * np.arange(int(periods * period / every) + 1)
        values = np.sin(2 * math.pi * time / period)
        found = spectralAcceleration(values, every, period, 0.0)
        assert found == approx(periods * math.pi, rel=1e-3)


def test_a_stiff_oscillator_follows_the_ground_and_a_slow_one_stays():
    """The limit of short periods is the largest acceleration; that of long ones is ω² times the
    largest displacement."""
    every = 0.01
    time = every * np.arange(201)
    place = lambda t: 0.1 * np.sin(math.pi * t / 2) ** 4 * ((t > 0) & (t < 2))
    values = (place(time - every) - 2 * place(time) + place(time + every)) / every**2
    stiff = spectralAcceleration(values, every, 0.02)
    assert stiff == approx(abs(values).max(), rel=0.01)
    slow = spectralAcceleration(values, every, 100.0, 0.0)
    assert slow == approx((2 * math.pi / 100) ** 2 * 0.1, rel=0.02)


def test_the_largest_displacement_after_the_record_counts():
    """A pulse of a hundredth of the period: u = v/ω sin ωt, with its largest a quarter of a period
    after the pulse."""
    found = spectralAcceleration([5.0] * 11, 1e-3, 1.0, 0.0)
    assert found == approx(2 * math.pi * 0.05, rel=2e-3)
