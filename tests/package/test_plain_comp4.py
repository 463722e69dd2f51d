# SPDX-License-Identifier: GPL-2.0-or-later
"""The plain program of COMP-4, written without the plugin, finds what the plugin finds."""

from usual import *
import plain

UNTIL, RATE = 1, 20  # [mm], [mm/s]


def test_the_plugin_pushes_comp4_as_the_plain_program_does():
    """Until 1 mm joints open and slip, and the force is three quarters of the peak. The force is
    that on the loading block, whose mass and ramp the programs do not have in common."""
    _, _, peak, work = plain.plain(plain.build(), UNTIL, RATE, plane=False)
    words = ["--points", "3"]  # as the plain program has
    _, _, ownPeak, ownWork = plain.plugin(UNTIL, RATE, words)
    assert peak > 85, "the wall has hardly been pushed"
    assert ownPeak == approx(peak, rel=0.01)
    assert ownWork == approx(work, rel=0.02)
