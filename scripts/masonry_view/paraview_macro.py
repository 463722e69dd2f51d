# SPDX-License-Identifier: GPL-2.0-or-later
"""Shows a run in ParaView: a macro for its Python, which needs nothing of this project.
scripts/view.py starts it in ParaView's window with the environment variable MASONRY_VIEW, the path
of a JSON file: ``folder``, ``title``, ``magnification`` of displacements, ``ground``: ids of the
bodies of the ground, ``platens``: those of all other bodies that are no masonry, ``widest_mm``:
opening at the end of the colours, ``crack`` [m] and ``damaged`` [-] as in masonry.numbers.cracks,
``colours`` by name, ``bounds`` of the scale, the camera: ``middle``, ``towards`` the viewer and
``half_height`` [m], ``time`` of the frame that is shown [s], and ``size`` of the view [pixels].
"""

import json
import os

import paraview.simple as pv

OPENINGS = (0, 1, 0.78, 0.2), (0.35, 0.95, 0.35, 0.1), (0.7, 0.78, 0.05, 0.1), (1, 0.35, 0, 0.2)


def moved(run, kind, vector="displacement"):
    """The frames of a kind of file, with displacements."""
    reader = pv.PVDReader(FileName=os.path.join(run["folder"], kind + ".pvd"))
    warped = pv.WarpByVector(Input=reader, Vectors=["POINTS", vector])
    warped.ScaleFactor = run["magnification"]
    return warped


def chosen(source, name, formula):
    """The cells of which a formula is true."""
    calculator = pv.Calculator(Input=source, AttributeType="Cell Data")
    calculator.ResultArrayName, calculator.Function = name, formula
    cells = pv.Threshold(registrationName=name, Input=calculator)
    cells.Scalars, cells.ThresholdMethod = ["CELLS", name], "Between"
    cells.LowerThreshold, cells.UpperThreshold = 0.5, 1.5
    return cells


def drawn(source, view, colour, width=None):
    """Draw something in one colour; lines as wide as given [pixels]."""
    shown = pv.Show(source, view)
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = colour
    shown.Ambient, shown.Diffuse, shown.Specular = (1, 0, 0) if width else (0.42, 0.62, 0)
    if width:
        shown.LineWidth = width
    return shown


def shift(shown, vector):
    """Move what is drawn; ParaView 5.13 has another name for it."""
    known = shown.ListProperties()
    setattr(shown, "Translation" if "Translation" in known else "Position", vector)


def build(view, run):
    """Fill a view with a run."""
    blocks, towards = moved(run, "blocks"), run["towards"]
    nearer = [0.003 * run["half_height"] * v for v in towards]  # lines lie before faces
    colours = run["colours"]
    among = lambda ids: "+".join(f"(body=={one})" for one in ids) or "body*0"
    others = {"ground": among(run["ground"]), "platen": among(run["platens"])}
    formulas = {"brick": f"1-({others['ground']})-({others['platen']})", **others}
    for name, formula in formulas.items():
        part = chosen(blocks, name, formula)
        drawn(part, view, colours[name])
        edges = pv.FeatureEdges(Input=pv.ExtractSurface(Input=part), FeatureAngle=20)
        edges.ManifoldEdges = edges.NonManifoldEdges = edges.BoundaryEdges = 0
        shift(drawn(edges, view, colours["mortar"], 1), nearer)

    # joints on the faces of both of their blocks
    isOpen = f"(opening > {run['crack']}) * (opening > 0.5 * mag(slide))"
    hurt = f"(max(damage_tension, damage_shear) > {run['damaged']})"
    slid = f"(1 - {isOpen}) * (mag(slide) > {run['crack']}) * {hurt}"
    ramp = pv.GetColorTransferFunction("opening [mm]")
    ramp.AutomaticRescaleRangeMode = "Never"
    for vector in ("displacement", "second_displacement"):
        joints = pv.Calculator(Input=moved(run, "joints", vector), AttributeType="Cell Data")
        joints.ResultArrayName, joints.Function = "opening [mm]", "1000 * opening"
        for name, formula in (("slid joints", slid), ("open joints", f"{isOpen} * {hurt}")):
            cells = chosen(joints, name, formula)
            rims = pv.ExtractEdges(Input=cells)
            for thing in (
                drawn(cells, view, colours["slid"]),
                drawn(rims, view, colours["slid"], 3),
            ):
                shift(thing, nearer)
                if name == "open joints":
                    thing.ColorArrayName, thing.LookupTable = ["CELLS", "opening [mm]"], ramp
    if os.path.exists(os.path.join(run["folder"], "connectors.pvd")):
        shift(drawn(moved(run, "connectors"), view, colours["mortar"], 4), nearer)
    ramp.RGBPoints = [v for share, *rgb in OPENINGS for v in (share * run["widest_mm"], *rgb)]
    bar = pv.GetScalarBar(ramp, view)
    bar.Title, bar.ComponentTitle, bar.Visibility = "opening [mm]", "", 1
    bar.TitleColor = bar.LabelColor = (0, 0, 0)
    bar.WindowLocation, bar.Position = "Any Location", (0.87, 0.28)
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.45, 14
    number = "{:.3g}" if pv.GetParaViewVersion() >= (6, 1) else "%.3g"
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, number, number

    time = pv.AnnotateTimeFilter(Input=blocks, Format="{time:.3f} s")
    title = pv.Text(Text=run["title"])
    for text, place in ((title, "Upper Center"), (time, "Lower Right Corner")):
        shown = pv.Show(text, view)
        shown.WindowLocation, shown.FontSize, shown.Color = place, 17, (0, 0, 0)
        shown.Justification = "Center"
    view.UseColorPaletteForBackground, view.Background = 0, (1, 1, 1)
    view.OrientationAxesLabelColor = (0, 0, 0)
    grid = view.AxesGrid  # the scale
    grid.Visibility, grid.ShowGrid, grid.GridColor = 1, 0, (0.5, 0.5, 0.5)
    grid.UseCustomBounds, grid.CustomBounds = 1, run["bounds"]
    for axis in "XYZ":
        setattr(grid, axis + "Title", "")
        setattr(grid, axis + "LabelColor", (0, 0, 0))
    view.CameraParallelProjection, view.CameraViewUp = 1, (0, 0, 1)
    view.CameraFocalPoint = view.CenterOfRotation = run["middle"]
    view.CameraPosition = [m + 8 * run["half_height"] * t for m, t in zip(run["middle"], towards)]
    view.CameraParallelScale = run["half_height"]


def main():
    with open(os.environ["MASONRY_VIEW"]) as file:
        run = json.load(file)
    pv._DisableFirstRenderCameraReset()
    layout, view = pv.CreateLayout(name="masonry"), pv.CreateView("RenderView")
    layout.SetSize(*run["size"])
    view.ViewSize = run["size"]
    pv.AssignViewToLayout(view=view, layout=layout, hint=0)
    pv.SetActiveView(view)
    build(view, run)
    animation = pv.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    animation.AnimationTime = run["time"]
    pv.RenderAllViews()


main()
