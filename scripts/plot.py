# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves of runs and of measured CSV files over each other, in one picture.

    /usr/bin/python3 scripts/plot.py results/wall_comp4 results/wall_comp6 --out walls.png
    /usr/bin/python3 scripts/plot.py results/wall_comp4 --csv test.csv:displacement:force
    /usr/bin/python3 scripts/plot.py results/shaken --x time_s --y top_mm
"""

from masonry_view.comparison import main

if __name__ == "__main__":
    raise SystemExit(main())
