# SPDX-License-Identifier: GPL-2.0-or-later
"""Opens all files of runs in ParaView's own Python, and colours the last frame by every array:

    pvbatch tests/view/colour_frames.py RUN...

Writes a picture of every array, RUN/pictures/<kind>-<array>.png, and prints a line of JSON per
frame: its run, kind, number, points, cells, and the lowest and the highest value of every component
of every array.
"""

import glob
import json
import os
import sys

import paraview.simple as pv

view = pv.CreateView("RenderView")
view.ViewSize, view.UseColorPaletteForBackground, view.Background = (400, 300), 0, (1, 1, 1)
view.OrientationAxesVisibility = 0
camera = view.GetActiveCamera()
of = lambda run: glob.glob(run + "/*.pvd") + glob.glob(run + "/mechanism_*.vtu")
for run, path in ((run, path) for run in sys.argv[1:] for path in of(run)):
    kind = os.path.basename(path)[:-4]
    frames = pv.OpenDataFile(path)
    for number, time in enumerate(getattr(frames, "TimestepValues", None) or [0]):
        frames.UpdatePipeline(time)
        about = frames.GetDataInformation()
        found = dict(points=about.GetNumberOfPoints(), cells=about.GetNumberOfCells(), ranges={})
        data = {"POINTS": frames.PointData, "CELLS": frames.CellData}
        arrays = [(place, some[name]) for place, some in data.items() for name in some.keys()]
        for _, array in arrays:
            parts = range(array.GetNumberOfComponents())
            found["ranges"][array.Name] = [array.GetRange(part) for part in parts]
        print(json.dumps(dict(run=run, kind=kind, number=number, **found)))
    view.ViewTime = time
    shown = pv.Show(frames, view)
    shown.PointSize, shown.LineWidth = 5, 3
    camera.SetPosition(0.4, -1, 0.3)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    pv.ResetCamera(view)
    for place, array in arrays:
        pv.ColorBy(shown, (place, array.Name))
        file = os.path.join(run, "pictures", f"{kind}-{array.Name}.png")
        pv.SaveScreenshot(file, view, ImageResolution=view.ViewSize)
    pv.Delete(frames)
