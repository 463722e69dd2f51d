# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in YADE: blocks, joints, engines and loads.

- :mod:`masonry.model.bodies`: ``addBlock``; :mod:`masonry.model.engines`: ``engines`` and
  ``advance``; :mod:`masonry.model.connecting`: ``connect``: for scenes that are built body by body
- :mod:`masonry.model.structure`: all of a scene; its parts :mod:`masonry.model.loading`, with
  :mod:`masonry.model.load_names`; :mod:`masonry.model.connectors`: ties and springs;
  :mod:`masonry.model.restraints`: supports; :mod:`masonry.model.scheme`: damping, masses and time
  step; :mod:`masonry.model.motion`: falling blocks;
  :mod:`masonry.model.overturning`: how near what stands is to overturning
- :mod:`masonry.model.arrays`: the scene as arrays, for limit analysis
- :mod:`masonry.model.period`: the first period of a structure
- :mod:`masonry.model.window`: YADE's own 3-D view
- :mod:`masonry.model.threads`, :mod:`masonry.model.ports`: threads and ports of YADE
"""
