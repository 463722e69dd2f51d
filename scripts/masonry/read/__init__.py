# SPDX-License-Identifier: GPL-2.0-or-later
"""What reads the files of a run, and needs no YADE.

- :mod:`masonry.read.files`: curve.csv and run.json; :mod:`masonry.read.frames`: the frames for
  ParaView
- :mod:`masonry.read.curves`, :mod:`masonry.read.loops`: numbers of a curve, and of loops
- :mod:`masonry.read.quantities`: the one list of numbers of a run; :mod:`masonry.read.run_data`:
  what they are found from
- :mod:`masonry.read.bilinear`: the bilinear curve of a push, and its drifts, as a program, too
- :mod:`masonry.read.cracks`: where joints are cracked and crushed, and how a wall gave way
- :mod:`masonry.read.measure`: all numbers of a run, as a program, too
- :mod:`masonry.read.figures`: its figures, as a program, too; :mod:`masonry.read.curve_figure` and
  :mod:`masonry.read.elevation` draw them on :mod:`masonry.read.drawing`, as
  :mod:`masonry.read.views` sees a structure, in the style of :mod:`masonry.read.painting`
- :mod:`masonry.read.shown`: a run and its curve in a notebook, and its columns as arrays
- :mod:`masonry.read.comparison`: figures of several runs
- :mod:`masonry.read.model`: the model of the 3-D picture, how blocks move and what joints do in all
  frames. Of it are made
  :mod:`masonry.read.page`, a page that shows it in any browser and in a notebook; and
  :mod:`masonry.read.viewer`, the window of ParaView, in which
      :mod:`masonry.read.paraview_macro` works
- :mod:`masonry.read.report`: all of a run on one page, as a program, too;
  :mod:`masonry.read.postprocess`: the program beside a run that draws its figures and writes this;
  :mod:`masonry.read.pages`: pages from templates
"""
