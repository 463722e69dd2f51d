# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in the window of ParaView, in a ready state, or in a browser.

    /usr/bin/python3 scripts/view.py results/wall_comp4
    /usr/bin/python3 scripts/view.py results/wall_comp4 --at 12mm
    /usr/bin/python3 scripts/view.py results/wall_comp4 --html wall.html
"""

from masonry_view.viewer import main

if __name__ == "__main__":
    raise SystemExit(main())
