# SPDX-License-Identifier: GPL-2.0-or-later
"""A run, from its options to its results.

- :mod:`masonry.run.run`: a run in stages; :mod:`masonry.run.run_state`: how far it has come;
  :mod:`masonry.run.ending`: how it ends
- :mod:`masonry.run.results`: the files that a run leaves, and the keys of run.json;
  :mod:`masonry.run.lock`: whose folder it is
- :mod:`masonry.run.checkpoints`: the state of a scene and of a run on disk
- :mod:`masonry.run.readings`: rows of curve.csv; :mod:`masonry.run.frame_writer`: frames for
  ParaView; :mod:`masonry.run.drawing_program`: the program that draws figures;
  :mod:`masonry.run.signals`: Ctrl-C
- :mod:`masonry.run.option_table`: the options that all scenes share; :mod:`masonry.run.presets`:
  those that trade accuracy for time; :mod:`masonry.run.accuracy`: a push whose error is found
- :mod:`masonry.run.batch`: rows of a table for ``yade-batch``
- :mod:`masonry.run.progress`: a run on the terminal
"""
