# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs in ParaView: a window in a ready state, or a picture and a film without a display; in a
browser.

/usr/bin/python3 scripts/view.py results/wall_comp4
/usr/bin/python3 scripts/view.py results/wall_comp4 --picture wall.png --at 12mm
/usr/bin/python3 scripts/view.py results/wall_comp4 --film wall.avi
/usr/bin/python3 scripts/view.py results/wall_comp4 --html wall.html
"""

from masonry.read.viewer import main

if __name__ == "__main__":
    raise SystemExit(main())
