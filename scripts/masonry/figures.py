"""Figures of a run, made from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry.figures results/wall_comp4`` draws curve.png and, if there are ParaView files, cracks.png.
This module needs no YADE.
"""

import glob
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from . import loops
from .errors import Refused
from .results import filesOf, onFolder, readCurve, readRun

MAGNIFICATION = 30  # of displacements in cracks.png, as in figure 6 of the paper (see yade_plugin/law/README.md)
CRACK = 0.05e-3  # [m] opening or slip from which a joint is drawn as cracked
CRUSHED = 0.5e-3  # [m] plastic closure from which a joint is drawn as crushed


def readFrame(directory, kind, number=-1):
    """A frame of blocks or joints as a dict: ``points`` [m], ``cells`` (lists of point numbers), and every data array."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    paths = sorted(glob.glob(os.path.join(directory, kind + "_*.vt?")))
    if not paths:
        raise Refused(f"no file {kind}_*.vt? in {directory}")
    path = paths[number]
    vtkObject.GlobalWarningDisplayOff()  # VTK would print many lines
    reader = (
        vtkXMLPolyDataReader() if kind == "joints" else vtkXMLUnstructuredGridReader()
    )
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    if not data.GetNumberOfPoints() or not data.GetNumberOfCells():
        raise Refused(f"cannot read {path}: it holds no frame")
    frame = {"points": vtk_to_numpy(data.GetPoints().GetData())}
    for arrays in (data.GetPointData(), data.GetCellData()):
        for i in range(arrays.GetNumberOfArrays()):
            frame[arrays.GetArrayName(i)] = vtk_to_numpy(arrays.GetArray(i))
    cells = data.GetPolys() if kind == "joints" else data.GetCells()
    offsets, corners = vtk_to_numpy(cells.GetOffsetsArray()), vtk_to_numpy(
        cells.GetConnectivityArray()
    )
    frame["cells"] = np.split(corners, offsets[1:-1])
    return frame


def _save(figure, path, dpi):
    """Write a picture, whole or not at all."""
    try:
        figure.savefig(path, dpi=dpi)
    except OSError:
        if os.path.exists(path):
            os.remove(path)
        raise
    plt.close(figure)


def curve(directory):
    """Draw curve.png: the base shear and, below it, the energies over the displacement.

    Loops have axes through zero and their envelope in bold, and their energies are drawn over the length of the way.
    """
    run, data = readRun(directory), readCurve(directory)
    looped, x = "history" in run, np.array(data["displacement_mm"])
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(7, 7), sharex=not looped, height_ratios=[3, 2]
    )
    base = np.array(data["base_shear_kN"])
    top.plot(x, base, color="black", lw=0.7 if looped else 1.2, label="base")
    top.plot(
        x,
        data["top_shear_kN"],
        color="tab:orange",
        lw=0.4 if looped else 0.6,
        label="loaded point",
        zorder=1,
    )
    peaks = [(run["displacement_at_peak_mm"], run["peak_base_shear_kN"])]
    if looped:
        for rows, label in zip(loops.envelope(x), ("envelope", None)):
            top.plot(x[rows], base[rows], color="tab:blue", lw=1.8, label=label)
        peaks.append(
            (
                run["displacement_at_negative_peak_mm"],
                run["negative_peak_base_shear_kN"],
            )
        )
        top.axhline(0, color="0.3", lw=0.8, zorder=0)
        top.axvline(0, color="0.3", lw=0.8, zorder=0)
        top.margins(y=0.12)
    else:
        top.set_ylim(0, 1.15 * run["peak_base_shear_kN"])
    for at, peak in peaks:
        top.plot(at, peak, "o", color="tab:red", ms=5)
        top.annotate(
            f"{peak:.1f} kN at {at:.2f} mm",
            (at, peak),
            textcoords="offset points",
            xytext=(6, 8) if peak >= 0 else (-6, -14),
            ha="right" if looped and at > 0 else "left",
        )
    top.set_ylabel("shear [kN]")
    top.set_title(run["title"])
    top.legend(loc="lower right")
    top.grid(alpha=0.3)
    displacement = (
        f"displacement {run['wall']['measure_height_m']:.3g} m above the base [mm]"
    )
    if looped:
        top.set_xlabel(displacement)
    over = np.append(0, np.cumsum(np.abs(np.diff(x)))) if looped else x
    start = {k: data[k][0] for k in data if k.endswith("_J")}
    since = lambda name: np.array(data[name + "_J"]) - start[name + "_J"]
    work = since("external") + since("gravity")
    stack = [
        (
            "elastic",
            sum(
                since("elastic_" + m)
                for m in ("units", "tension", "shear", "compression")
            ),
        ),
        ("tension", since("dissipated_tension")),
        ("shear", since("dissipated_shear")),
        ("compression", since("dissipated_compression")),
        ("damping", since("damping")),
    ]
    for name, values in stack:
        bottom.plot(over, values, lw=1, label=name)
    bottom.plot(over, work, color="black", lw=1, ls="--", label="work done")
    bottom.set_xlabel(
        "length of the way there and back [mm]" if looped else displacement
    )
    bottom.set_ylabel("energy since the push began [J]")
    bottom.legend(fontsize=8)
    bottom.grid(alpha=0.3)
    figure.tight_layout()
    _save(figure, os.path.join(directory, "curve.png"), 110)


def _faces(blocks, displaced):
    """Outlines of the blocks' front faces, corners in order around: arrays of (x, z)."""
    corners = {}
    for body, cell in zip(blocks["body"], blocks["cells"]):
        corners.setdefault(body, set()).update(cell)
    outlines = []
    for nodes in map(np.array, map(sorted, corners.values())):
        points = blocks["points"][nodes]
        low, high = points.min(axis=0), points.max(axis=0)
        near = 1e-6 * (high - low).max()
        front = points[:, 1] < low[1] + near
        rim = (np.abs(points[:, [0, 2]] - low[[0, 2]]) < near) | (
            np.abs(points[:, [0, 2]] - high[[0, 2]]) < near
        )
        keep = nodes[front & rim.any(axis=1)]
        reference = blocks["points"][keep][:, [0, 2]]
        around = (reference - reference.mean(axis=0)) / (high - low)[[0, 2]]
        order = np.argsort(np.arctan2(around[:, 1], around[:, 0]))
        shift = (
            MAGNIFICATION * blocks["displacement"][keep][:, [0, 2]] if displaced else 0
        )
        outlines.append((reference + shift)[order])
    return outlines


def cracks(directory):
    """Draw cracks.png: the deformed wall, magnified, over the undeformed one.

    Cracks are red, joints that slid are blue, and crushed spots are black.
    """
    run = readRun(directory)
    blocks, joints = readFrame(directory, "blocks"), readFrame(directory, "joints")
    figure, axes = plt.subplots(figsize=(9, 8))
    axes.add_collection(
        PolyCollection(_faces(blocks, False), facecolor="0.9", edgecolor="0.8", lw=0.3)
    )
    axes.add_collection(
        PolyCollection(
            _faces(blocks, True), facecolor="#f3e3c8", edgecolor="0.45", lw=0.35
        )
    )

    slide = np.linalg.norm(joints["slide"], axis=1)
    segments = {"open": [], "slid": []}
    spots, sizes = [], []
    for i, cell in enumerate(joints["cells"]):
        points = joints["points"][cell] + MAGNIFICATION * joints["displacement"][cell]
        points = points[:, [0, 2]]
        if joints["crushing"][i] > CRUSHED:
            spots.append(points.mean(axis=0))
            sizes.append(joints["crushing"][i])
        kind = (
            "open"
            if joints["opening"][i] > max(CRACK, 0.5 * slide[i])
            else "slid"
            if slide[i] > CRACK
            else None
        )
        if kind and max(joints["damage_tension"][i], joints["damage_shear"][i]) > 0.05:
            far = np.linalg.norm(points[:, None] - points[None], axis=2)
            a, b = np.unravel_index(np.argmax(far), far.shape)
            segments[kind].append(points[[a, b]])
    axes.add_collection(
        LineCollection(segments["slid"], color="tab:blue", lw=1.6, label="slid")
    )
    axes.add_collection(
        LineCollection(segments["open"], color="tab:red", lw=1.8, label="open")
    )
    if spots:
        spots = np.array(spots)
        axes.scatter(
            spots[:, 0],
            spots[:, 1],
            s=12 + 8e3 * np.array(sizes),
            color="black",
            marker="X",
            lw=0,
            label="crushed",
            zorder=5,
        )
    axes.autoscale()
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("z [m]")
    axes.set_title(
        f"{run['title']}\nat {run['displacement_end_mm']:.1f} mm, displacements × {MAGNIFICATION}; "
        f"open or slid more than {1e3 * CRACK:g} mm, crushed more than {1e3 * CRUSHED:g} mm",
        fontsize=10,
    )
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    figure.tight_layout()
    _save(figure, os.path.join(directory, "cracks.png"), 90)


def draw(directory):
    """All figures that the files of a run allow."""
    with filesOf(directory):
        curve(directory)
        if glob.glob(os.path.join(directory, "joints_*.vtp")):
            cracks(directory)


if __name__ == "__main__":
    sys.exit(onFolder(draw, sys.argv[1:]))
