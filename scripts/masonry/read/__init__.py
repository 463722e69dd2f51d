# SPDX-License-Identifier: GPL-2.0-or-later
"""What reads the files of a run, and needs no YADE.

- :mod:`masonry.read.files`: curve.csv and run.json; :mod:`masonry.read.frames`: the frames for ParaView
- :mod:`masonry.read.curves`, :mod:`masonry.read.loops`: numbers of a curve, and of loops
- :mod:`masonry.read.bilinear`: the bilinear curve of a push, and its drifts, as a program, too
- :mod:`masonry.read.cracks`: where joints are cracked and crushed, and how a wall gave way
- :mod:`masonry.read.measure`: all numbers of a run, as a program, too
- :mod:`masonry.read.figures`: its figures, as a program, too; :mod:`masonry.read.curve_figure`,
  :mod:`masonry.read.crack_figure` and :mod:`masonry.read.views` draw them on :mod:`masonry.read.drawing`
- :mod:`masonry.read.block_figure`: a picture of blocks before a run; :mod:`masonry.read.shown`: a run and its curve in a
  notebook, and its columns as arrays
- :mod:`masonry.read.comparison`: figures of several runs
- :mod:`masonry.read.viewer`: its pictures and films by ParaView, which :mod:`masonry.read.viewer_scene` draws
- :mod:`masonry.read.motion`: how its blocks move and what its joints do in all frames; :mod:`masonry.read.page`: a page that
  shows that in any browser, and in a notebook; :mod:`masonry.read.gltf`: a 3-D model of it
- :mod:`masonry.read.report`: all of a run on one page, as a program, too; :mod:`masonry.read.crew`: the program beside a run that
  draws its figures and writes this; :mod:`masonry.read.escaping`: what stands in files is text in a page
"""
