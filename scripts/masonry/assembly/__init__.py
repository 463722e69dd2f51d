# SPDX-License-Identifier: GPL-2.0-or-later
"""What YADE is given and what is read off it: blocks, joints, engines, loads, and the columns of
curve.csv.

- :mod:`masonry.assembly.blocks`: ``addBlock``; :mod:`masonry.assembly.engines`: ``engines`` and
  ``advance``;
  :mod:`masonry.assembly.connecting`: ``connect``: for scenes that are built body by body
- :mod:`masonry.assembly.structure`: what a scene is in YADE; of it :mod:`masonry.assembly.loading`:
  loads and drives,
  :mod:`masonry.assembly.connectors`: ties and springs, :mod:`masonry.assembly.supports`: what holds
      it,
  :mod:`masonry.assembly.scheme`: damping, masses and time step, :mod:`masonry.assembly.motion`: how
      its blocks move
- :mod:`masonry.assembly.period`: the first period of a structure
- :mod:`masonry.assembly.columns`: what a row of curve.csv holds
- :mod:`masonry.assembly.window`: the scene in YADE's own 3-D view while it runs
- :mod:`masonry.assembly.threads`: how many threads YADE has in plain Python
- :mod:`masonry.assembly.ports`: the ports that YADE opens when it starts
"""
