# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a run, from its rows and its files; only the columns need YADE.

- :mod:`masonry.numbers.columns`: columns of curve.csv
- :mod:`masonry.numbers.files`: curve.csv and run.json, read again; :mod:`masonry.numbers.frames`:
  the frames for ParaView
- :mod:`masonry.numbers.curves`, :mod:`masonry.numbers.loops`: numbers of a curve, and of loops
- :mod:`masonry.numbers.cracks`: where joints are cracked and crushed, and how a wall gave way
- :mod:`masonry.numbers.quantities`: the one list of numbers of a run;
  :mod:`masonry.numbers.run_data`: what they are found from
- :mod:`masonry.numbers.drawing`: how a figure is written
"""
