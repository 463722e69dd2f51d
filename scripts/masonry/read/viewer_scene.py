# SPDX-License-Identifier: GPL-2.0-or-later
"""What ParaView shows of runs, made inside pvpython: :mod:`masonry.read.viewer` starts this as a program with one word, a job.

The job is a JSON file: ``path``, a folder of Python modules to look in first, or None; ``views``, a list of what
:func:`masonry.read.viewer.sceneOf` returns; ``size`` of the picture, and one of ``picture``, ``film`` and ``state``, the file
to write; ``rate``, frames of the film a second.
"""

import json
import sys

sys.path.pop(0)  # the modules beside this one are not those that ParaView looks for

BRICK, EDGE, SLID = (0.93, 0.82, 0.67), (0.35, 0.27, 0.2), (0.12, 0.36, 0.66)
OPENINGS = (0, 1, 0.78, 0.2), (0.35, 0.95, 0.35, 0.1), (0.7, 0.78, 0.05, 0.1), (1, 0.35, 0, 0.2)  # fmt: skip


def build(pv, view, scene):
    """Fill a view with a run: bricks with edges, cracks by opening, legend, scale, title and time."""
    black = dict(Color=(0, 0, 0))
    view.UseColorPaletteForBackground = 0
    view.Background = (1, 1, 1)
    view.OrientationAxesVisibility = 1
    view.OrientationAxesLabelColor = (0, 0, 0)
    read = (
        pv.OpenDataFile if scene["still"] else lambda path: pv.PVDReader(FileName=path)
    )
    bricks = read(scene["blocks"])
    moved = pv.WarpByVector(registrationName="bricks", Input=bricks)
    moved.Vectors = ["POINTS", "displacement"]
    moved.ScaleFactor = scene["magnification"]
    shown = pv.Show(moved, view)
    shown.ColorArrayName = ["POINTS", ""]
    shown.Representation = "Surface"
    shown.DiffuseColor = shown.AmbientColor = BRICK
    shown.Ambient, shown.Diffuse, shown.Specular = 0.42, 0.62, 0.0
    skin = pv.ExtractSurface(registrationName="skin", Input=moved)
    edges = pv.FeatureEdges(registrationName="edges", Input=skin, FeatureAngle=20)
    edges.ManifoldEdges = edges.NonManifoldEdges = edges.BoundaryEdges = 0
    drawn = pv.Show(edges, view)
    drawn.ColorArrayName = ["POINTS", ""]
    drawn.DiffuseColor = drawn.AmbientColor = EDGE
    drawn.LineWidth, drawn.Ambient, drawn.Diffuse = scene["line"], 1.0, 0.0
    drawn.Position = scene["forward"]  # else faces would hide parts of them

    joints = read(scene["joints"])
    warped = pv.WarpByVector(registrationName="joints moved", Input=joints)
    warped.Vectors = ["POINTS", "displacement"]
    warped.ScaleFactor = scene["magnification"]
    crack, least = scene["crack"], scene["damaged"]
    open_ = f"(opening > {crack}) * (opening > 0.5 * mag(slide))"
    hurt = f"(max(damage_tension, damage_shear) > {least})"
    last = warped
    for name, formula in (
        ("opening [mm]", "1000 * opening"),
        ("open", f"{open_} * {hurt}"),
        ("slid", f"(1 - {open_}) * (mag(slide) > {crack}) * {hurt}"),
    ):
        last = pv.Calculator(registrationName=name, Input=last)
        last.AttributeType, last.ResultArrayName = "Cell Data", name
        last.Function = formula
    colours = pv.GetColorTransferFunction("opening [mm]")
    colours.ColorSpace = "Lab"
    colours.AutomaticRescaleRangeMode = "Never"
    for kind in ("slid", "open"):
        chosen = pv.Threshold(registrationName=kind + " joints", Input=last)
        chosen.Scalars = ["CELLS", kind]
        chosen.LowerThreshold, chosen.UpperThreshold = 0.5, 1.5
        chosen.ThresholdMethod = "Between"
        frame = pv.ExtractEdges(registrationName=kind + " rims", Input=chosen)
        tubes = pv.Tube(registrationName=kind + " cracks", Input=frame)
        tubes.Radius, tubes.NumberofSides = scene["tube"], 8
        tubes.Scalars, tubes.Vectors = ["POINTS", ""], ["POINTS", ""]
        drawn = pv.Show(tubes, view)
        drawn.Position = scene["forward"]
        faces = pv.Show(chosen, view)
        for thing in (drawn, faces):
            thing.Ambient, thing.Diffuse, thing.Specular = 0.5, 0.6, 0.0
            if kind == "open":
                pv.ColorBy(thing, ("CELLS", "opening [mm]"))
                thing.LookupTable = colours
                thing.SetScalarBarVisibility(view, True)
            else:
                thing.ColorArrayName = ["POINTS", ""]
                thing.DiffuseColor = thing.AmbientColor = SLID
    if "connectors" in scene:
        bars = read(scene["connectors"])
        pulled = pv.WarpByVector(registrationName="ties moved", Input=bars)
        pulled.Vectors = ["POINTS", "displacement"]
        pulled.ScaleFactor = scene["magnification"]
        rods = pv.Tube(registrationName="ties", Input=pulled)
        rods.Radius, rods.NumberofSides = scene["tube"], 8
        rods.Scalars, rods.Vectors = ["POINTS", ""], ["POINTS", ""]
        drawn = pv.Show(rods, view)
        drawn.ColorArrayName = ["POINTS", ""]
        drawn.DiffuseColor = drawn.AmbientColor = (0.2, 0.2, 0.2)
        drawn.Position = scene["forward"]
    # drawing has set the range of colours to that of the frame
    colours.RGBPoints = [
        v for share, *rgb in OPENINGS for v in (share * scene["widest_mm"], *rgb)
    ]
    bar = pv.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "opening [mm]", ""
    bar.TitleColor = bar.LabelColor = (0, 0, 0)
    bar.TitleFontSize, bar.LabelFontSize = 17, 15
    bar.WindowLocation, bar.Position = "Any Location", (0.87, 0.28)
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.45, 14
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.3g", "%.3g"
    bar.DrawTickMarks, bar.DrawTickLabels = 1, 1

    ruler = pv.Ruler(registrationName="scale")
    ruler.Point1, ruler.Point2 = scene["scale"]
    drawn = pv.Show(ruler, view)
    drawn.LabelFormat, drawn.NumberOfTicks = f"{scene['scale_m']:g} m", 2
    drawn.AxisColor = drawn.Color = (0, 0, 0)
    drawn.AxisLineWidth, drawn.FontSize = 2.0, 17
    title = pv.Text(registrationName="title", Text=scene["title"])
    drawn = pv.Show(title, view)
    drawn.WindowLocation, drawn.FontSize = "Upper Center", 17
    drawn.Color, drawn.Justification = black["Color"], "Center"
    if scene["still"]:
        time = pv.Text(registrationName="time", Text=f"{scene['time']:.3f} s")
    else:
        time = pv.AnnotateTimeFilter(registrationName="time", Input=bricks)
        time.Format = "{time:.3f} s"
    drawn = pv.Show(time, view)
    drawn.WindowLocation, drawn.FontSize = "Lower Right Corner", 17
    drawn.Color = black["Color"]

    view.CameraParallelProjection = 1
    view.CameraPosition = scene["eye"]
    view.CameraFocalPoint = view.CenterOfRotation = scene["middle"]
    view.CameraViewUp = scene["up"]
    view.CameraParallelScale = scene["half_height"]
    pv.SetActiveSource(moved)


def main(path):
    with open(path) as f:
        job = json.load(f)
    if job["path"]:
        sys.path.insert(0, job["path"])
    import paraview.simple as pv

    pv._DisableFirstRenderCameraReset()
    wide, high = job["size"]
    count = len(job["views"])
    layout = pv.CreateLayout(name="masonry")
    layout.SetSize(wide, high)
    place = 0
    for n, scene in enumerate(job["views"]):
        view = pv.CreateView("RenderView")
        view.ViewSize = (wide // count, high)
        pv.AssignViewToLayout(view=view, layout=layout, hint=place)
        pv.SetActiveView(view)
        build(pv, view, scene)
        if n + 1 < count:
            place = layout.SplitHorizontal(layout.GetViewLocation(view), 1 / (count - n)) + 1  # fmt: skip
    animation = pv.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    animation.AnimationTime = job["views"][0]["time"]
    pv.RenderAllViews()
    if job["picture"]:
        pv.SaveScreenshot(job["picture"], layout, ImageResolution=(wide, high))
    if job["film"]:
        pv.SaveAnimation(
            job["film"], layout, ImageResolution=(wide, high), FrameRate=job["rate"]
        )
    if job["state"]:
        pv.SaveState(job["state"])


if __name__ == "__main__":
    main(sys.argv[1])
