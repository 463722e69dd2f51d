# SPDX-License-Identifier: GPL-2.0-or-later
"""What YADE is given and what is read off it: blocks, joints, engines and loads.

- :mod:`masonry.model.bodies`: ``addBlock``; :mod:`masonry.model.engines`: ``engines`` and
  ``advance``; :mod:`masonry.model.connecting`: ``connect``: for scenes that are built body by body
- :mod:`masonry.model.structure`: what a scene is in YADE; of it :mod:`masonry.model.loading`: loads
  and drives, with their names in :mod:`masonry.model.load_names`; :mod:`masonry.model.connectors`:
  ties and springs; :mod:`masonry.model.restraints`: what holds it; :mod:`masonry.model.scheme`:
  damping, masses and time step; :mod:`masonry.model.motion`: how its blocks move
- :mod:`masonry.model.arrays`: the scene in YADE as arrays, for limit analysis
- :mod:`masonry.model.period`: the first period of a structure
- :mod:`masonry.model.window`: the scene in YADE's own 3-D view while it runs
- :mod:`masonry.model.threads`: how many threads YADE has in plain Python;
  :mod:`masonry.model.ports`: the ports that YADE opens when it starts
"""
