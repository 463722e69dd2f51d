# SPDX-License-Identifier: GPL-2.0-or-later
"""Gravity, and the units in which accelerations may be given."""

GRAVITY = 9.81  # [m/s²]
#: Units in which accelerations may be given, in m/s².
ACCELERATION_UNITS = {"m/s²": 1.0, "g": GRAVITY, "cm/s²": 0.01}
