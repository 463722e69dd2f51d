# SPDX-License-Identifier: GPL-2.0-or-later
"""What draws and shows a run, from the files in its folder; none of it needs YADE.

- :mod:`masonry_view.figures`: the figures of a run, as a program, too;
  :mod:`masonry_view.curve_figure`, :mod:`masonry_view.elevation` and :mod:`masonry_view.mechanism`
  draw them, as :mod:`masonry_view.views` sees a structure, in the style of
  :mod:`masonry_view.painting`
- :mod:`masonry_view.report`: all of a run on one page, as a program, too;
  :mod:`masonry_view.postprocess`: the program beside a run that draws its figures and writes this;
  :mod:`masonry_view.pages`: pages from templates
- :mod:`masonry_view.measure`: all numbers of a run, as a program
- :mod:`masonry_view.comparison`: figures of several runs
- :mod:`masonry_view.model`: the model of the 3-D picture, how blocks move and what joints do in all
  frames; :mod:`masonry_view.page`: a page that shows it in any browser and in a notebook
- :mod:`masonry_view.viewer`: the run in ParaView, in which :mod:`masonry_view.paraview_macro` works
- :mod:`masonry_view.notebook` and :mod:`masonry_view.notebook_scene`: a run, its curve and a scene
  in a notebook
"""

from masonry.wings import folderOf

__path__ = folderOf(__name__)
