# SPDX-License-Identifier: GPL-2.0-or-later
"""Spectral acceleration against closed forms of the linear oscillator, and against Newmark's method."""

from usual import *
from masonry.scene.spectrum import spectralAcceleration


@pytest.mark.parametrize("period", [0.05, 0.3, 1.0, 4.0])
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_a_step_overshoots_by_the_logarithmic_decrement(period, damping):
    """ω² max|u| = a (1 + exp(-πζ/√(1-ζ²))), reached after half a period."""
    values = [2.0] * (int(3 * period / 0.005) + 3)
    expected = 2 * (1 + math.exp(-math.pi * damping / math.sqrt(1 - damping**2)))
    found = spectralAcceleration(values, 0.005, period, damping)
    assert found == pytest.approx(expected, rel=5e-4) and found <= expected * (1 + 1e-9)


def test_a_sine_in_resonance_grows_by_pi_in_every_period():
    """Without damping ω² u = (ωt cos ωt - sin ωt)/2, whose amount after n periods is nπ."""
    period, every = 0.5, 1e-3
    for periods in (1, 3, 6):
        time = every * np.arange(int(periods * period / every) + 1)
        values = np.sin(2 * math.pi * time / period)
        found = spectralAcceleration(values, every, period, 0.0)
        assert found == pytest.approx(periods * math.pi, rel=1e-3)


def test_a_stiff_oscillator_follows_the_ground_and_a_slow_one_stays():
    """The limit of short periods is the largest acceleration; that of long ones is ω² times the largest displacement."""
    every = 0.01
    time = every * np.arange(201)
    place = lambda t: 0.1 * np.sin(math.pi * t / 2) ** 4 * ((t > 0) & (t < 2))
    values = (place(time - every) - 2 * place(time) + place(time + every)) / every**2
    stiff = spectralAcceleration(values, every, 0.02)
    assert stiff == pytest.approx(abs(values).max(), rel=0.01)
    slow = spectralAcceleration(values, every, 100.0, 0.0)
    assert slow == pytest.approx((2 * math.pi / 100) ** 2 * 0.1, rel=0.02)


def test_the_largest_displacement_after_the_record_counts():
    """A pulse of a hundredth of the period: u = v/ω sin ωt, with its largest a quarter of a period after the pulse."""
    found = spectralAcceleration([5.0] * 11, 1e-3, 1.0, 0.0)
    assert found == pytest.approx(2 * math.pi * 0.05, rel=2e-3)


def newmark(values, every, period, damping):
    """ω² max|u| by Newmark's method of constant mean acceleration, in two hundred steps a period or more."""
    parts = math.ceil(200 * every / period)
    step, omega = every / parts, 2 * math.pi / period
    n = np.arange((len(values) - 1) * parts + 1) / parts
    a = np.concatenate([np.interp(n, np.arange(len(values)), values), np.zeros(int(period / step) + 1)])  # fmt: skip
    u = v = largest = 0.0
    acceleration = -a[0]
    for one in a[1:]:
        early = u + step * v + step**2 / 4 * acceleration
        fast = v + step / 2 * acceleration
        acceleration = (-one - 2 * damping * omega * fast - omega**2 * early) / (1 + damping * omega * step + (omega * step) ** 2 / 4)  # fmt: skip
        u, v = early + step**2 / 4 * acceleration, fast + step / 2 * acceleration
        largest = max(largest, abs(u))
    return omega**2 * largest


@given(
    values=some.lists(some.floats(-10, 10), min_size=3, max_size=40),
    period=some.sampled_from([0.05, 0.2, 0.7]),
    damping=some.sampled_from([0.0, 0.05, 0.2]),
)
@settings(max_examples=25, deadline=None)
def test_newmark_finds_the_same(values, period, damping):
    values = [*values, 0.0]
    expected = newmark(values, 0.02, period, damping)
    found = spectralAcceleration(values, 0.02, period, damping)
    assert found == pytest.approx(expected, rel=5e-3, abs=1e-9)
