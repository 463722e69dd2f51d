# SPDX-License-Identifier: GPL-2.0-or-later
"""What all parts of the package share: checks of arguments, and what they need of the machine: other processes, files and folders, memory,
other packages, YADE itself, and notebooks."""
