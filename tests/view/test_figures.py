# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of any run: what is drawn where, from frames of real joints and from curves made up for
it."""

from usual import *
from made_runs import axis, writeRun
from masonry_view import curve_figure, elevation, figures
from masonry.numbers import drawing, frames
from masonry.numbers.files import readRun
from masonry_view.elevation import Structure
from masonry.bricks.geometry import Solids, boxCorners
from masonry_view.painting import CRACKS, SHADES, fromBackToFront, rgb
from masonry_view.views import MAGNIFICATIONS, magnificationOf, spaceViewOf, viewOf
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex

L, T, H = 0.2, 0.1, 0.08  # [m] of a brick


@pytest.fixture
def drawn(monkeypatch):
    found = {}
    monkeypatch.setattr(
        drawing, "save", lambda figure, path, dpi: found.update({os.path.basename(path): figure})
    )
    return found


# -- curve.png -------------------------------------------------------------------------------------


def test_a_history_over_time_shows_all_values_and_needs_no_energies(tmp_path, drawn):
    t = np.linspace(0, 2, 101)
    rows = np.column_stack([t, np.sin(9 * t), -3 * np.sin(9 * t)])
    entry = {
        "x": axis("time_s", "time [s]"),
        "y": [axis("top_mm", "top"), axis("base_kN", "base")],
        "y_label": "both",
    }
    entry["bounds"] = [{"y": 5, "text": "bound"}]
    curve_figure.curve(writeRun(tmp_path, ["time_s", "top_mm", "base_kN"], rows, figure=entry))
    (top,) = drawn["curve.png"].axes
    low, high = top.get_ylim()
    assert low < -2.99 and high > 5
    labelled = {line.get_label(): line for line in top.lines}
    assert labelled["top"].get_ydata() == approx(rows[:, 1], abs=1e-8)
    assert labelled["base"].get_ydata() == approx(rows[:, 2], abs=1e-8)
    assert top.get_xlabel() == "time [s]" and top.get_ylabel() == "both"
    assert "bound" in [text.get_text() for text in top.texts]


def test_what_energies_there_are_is_drawn_since_the_first_row(tmp_path, drawn):
    x = np.arange(5.0)
    rows = np.column_stack([x, -x, 10 + x, 3 * x, x, 2 * x])
    columns = ["u_mm", "f_kN", "external_J", "elastic_shear_J", "elastic_tension_J", "viscous_J"]
    curve_figure.curve(
        writeRun(tmp_path, columns, rows, figure={"x": axis("u_mm"), "y": [axis("f_kN")]})
    )
    top, bottom = drawn["curve.png"].axes
    assert top.get_ylim()[0] < -4 and top.get_ylim()[1] >= 0
    lines = {line.get_label(): list(line.get_ydata()) for line in bottom.lines}
    assert lines == {
        "elastic": [0, 4, 8, 12, 16],
        "viscous": [0, 2, 4, 6, 8],
        "work done": [0, 1, 2, 3, 4],
    }


def test_one_row_has_a_point_and_no_energies(tmp_path, drawn):
    entry = {"x": axis("u_mm"), "y": [axis("f_kN")]}
    curve_figure.curve(
        writeRun(tmp_path, ["u_mm", "f_kN", "external_J"], [[1, 2, 3]], figure=entry)
    )
    (top,) = drawn["curve.png"].axes
    (line,) = [line for line in top.lines if line.get_marker() == "o"]
    assert line.get_xydata().tolist() == [[1, 2]]


def test_what_cannot_be_drawn_is_refused_in_a_sentence(tmp_path):
    columns, rows = ["u_mm", "f_kN"], [[0, 0], [1, 1]]
    with raises(Refused, match='run.json has no entry "figure".*older version'):
        figures.draw(writeRun(tmp_path, columns, rows))
    entry = {"x": axis("v_mm"), "y": [axis("f_kN")]}
    with raises(Refused, match="curve.csv has no column v_mm, it has u_mm, f_kN"):
        figures.draw(writeRun(tmp_path, columns, rows, figure=entry))
    with raises(Refused, match="not the files of a finished run"):
        figures.draw(writeRun(tmp_path, columns, rows, figure={"x": axis("u_mm")}))


# -- how a part is seen ----------------------------------------------------------------------------


def boxPoints(length, thickness, height, angle=0.0):
    """Corners of a box that is turned in plan [rad]."""
    points = np.array(boxCorners((0, 0, 0), (length, thickness, height)))
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)])


@mark.parametrize("degrees", [0, 30, 90, 117, 180])
def test_a_wall_at_any_angle_is_seen_from_its_front(degrees):
    angle = math.radians(degrees)
    along = np.array([math.cos(angle), math.sin(angle), 0])
    normals = np.array([along, (0, 0, 1)])
    view = viewOf(boxPoints(3, 0.1, 2.5, angle), normals, np.ones(2))
    assert abs(view.right @ along) == approx(1)
    assert view.right[0] > 1e-9 or view.right[1] > 0
    assert view.up == approx([0, 0, 1])
    assert view.towards == approx(np.cross(view.right, view.up))
    points = boxPoints(3, 0.1, 2.5, angle) - view.start
    assert np.ptp(points @ view.right) == approx(3)


def test_a_low_arch_is_seen_from_its_side_and_a_dome_from_above():
    angles = np.linspace(0.4, math.pi - 0.4, 20)
    ring = np.column_stack([-np.sin(angles), 0 * angles, np.cos(angles)])
    points = boxPoints(5, 1.5, 0.6)  # deeper than high
    view = viewOf(points, ring, np.ones(20))
    assert view.towards == approx([0, -1, 0]) and view.right[0] == 1
    dome = boxPoints(4, 4, 2)
    joints = np.array([(1, 0, 0), (0, 1, 0), (0.6, 0, 0.8), (0, 0.6, 0.8)])
    view = viewOf(dome, joints, np.ones(4))
    assert view.towards == approx([0, 0, 1]) and view.labels == ["x [m]", "y [m]"]
    # two wythes with a collar joint are still a wall
    view = viewOf(boxPoints(3, 0.2, 2), np.eye(3), np.ones(3))
    assert view.towards == approx([0, -1, 0])


def test_a_drum_in_a_file_with_seven_digits_is_seen_along_an_axis():
    # four rectangles around an octagon are as small
    at = np.arange(np.pi / 8, 6.3, np.pi / 4)
    foot = 0.3 * np.stack([np.cos(at), np.sin(at), 0 * at], axis=1)
    drum = np.concatenate([foot, foot + (0, 0, 1)]).astype(np.float32).astype(float)
    for noise in (1e-8, -1e-8):
        view = viewOf(drum * (1, 1 + noise, 1), np.zeros((0, 3)), np.zeros(0))
        assert view.labels == ["x [m]", "z [m]"]


def test_the_direction_of_sight_can_be_reported():
    view = viewOf(boxPoints(3, 0.1, 2.5), np.eye(3), np.ones(3), direction=(0, -2, 0))
    assert view.towards == approx([0, 1, 0])
    assert view.right == approx([-1, 0, 0])


def test_a_structure_in_space_is_seen_from_above_at_the_side_to_which_it_moved():
    wall = boxPoints(3, 0.2, 2)
    for away in (-1.0, 1.0):
        moved = wall[:, 2:] * (0, away, 0)
        towards = spaceViewOf(np.array([0, -1.0, 0]), wall, moved).towards
        assert towards[1] * away > 0.5 and towards[2] > 0.3
        assert np.linalg.norm(towards) == approx(1)
    # where most of it moved is nearer than the rest
    moved = wall[:, :1] * (0, -0.1, 0)
    assert spaceViewOf(np.array([0, -1.0, 0]), wall, moved).towards[0] > 0.3


def jointFrame(opening, closed=0.0, slide=0.0):
    """Two points of a joint that has cracked: an open one and a closed one [m]."""
    one = np.ones(2)
    return {
        "opening": np.array([opening, -closed]),
        "slide": slide * np.eye(2, 3),
        "damage_tension": one,
        "damage_shear": one,
        "bodies": np.array([[0, 1], [0, 1]]),
    }


def test_the_magnification_is_the_usual_one_unless_that_is_absurd():
    of = lambda frame, moved: magnificationOf(
        frame, np.full((100, 3), moved / 3**0.5), [boxPoints(3, T, H)]
    )
    assert of(jointFrame(1e-3), 12e-3) == of(jointFrame(1e-4), 0.3e-3) == MAGNIFICATIONS[0]
    assert of(jointFrame(1e-3), 1.0) == 1
    # rigid motion and shortening alone are true to scale, however small; so is what has no joints
    assert of(jointFrame(1e-6), 1e-6) == of(jointFrame(1e-6), 0.05) == of(None, 1e-3) == 1
    for closed in (1e-4, 1e-3, 5e-3):
        assert of(jointFrame(1e-3, closed), 5e-3) * closed <= H / 4
    assert of(jointFrame(0, 0, 1e-3), 12e-3) == MAGNIFICATIONS[0]
    # a block in the air is drawn near to where it is
    for gap in (1e-3, 5e-3, H / 4):
        assert of(jointFrame(gap, -gap), 5e-3) == next(m for m in MAGNIFICATIONS if m * gap <= H)


# -- what hides what -------------------------------------------------------------------------------


@mark.parametrize(
    "towards", [(0.5, -0.75, 0.4), (-0.5, -0.75, 0.4), (0, -1, 0), (0.3, 0.9, 0.2), (0, 0, 1)]
)
def test_blocks_are_drawn_after_those_that_they_hide(towards):
    """A wall of two wythes in bond, of bricks of two lengths, on a slab that is wider than all of
    them."""
    bricks = [boxCorners((-1, -1, -0.1), (2, 1, 0))]
    for z in range(5):
        for y in range(2):
            ends = [0, *np.arange(0.1 + 0.1 * ((z + y) % 2), 1, 0.2), 1]
            bricks += [
                boxCorners((a, 0.1 * y, 0.08 * z), (b, 0.1 * y + 0.1, 0.08 * z + 0.08))
                for a, b in zip(ends, ends[1:])
            ]
    towards = np.array(towards) / np.linalg.norm(towards)
    right = np.cross((0, 0, 1), towards) if towards[2] < 1 else np.array([1.0, 0, 0])
    right /= np.linalg.norm(right)
    sight = np.array([right, np.cross(towards, right), towards])
    order = fromBackToFront(Solids(bricks), sight)
    assert sorted(order) == list(range(len(bricks)))
    place = {n: at for at, n in enumerate(order)}
    boxes = np.array([(np.min(b, axis=0), np.max(b, axis=0)) for b in bricks])
    hidden = 0
    rays = np.random.default_rng(1).uniform((-0.2, -0.2, 0), (1.2, 0.4, 0.4), (400, 3))
    for ray in rays:  # where a line of sight goes into each box and out of it
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.sort((boxes - ray) / towards, axis=1)
        enter, exit_ = np.nanmax(ends[:, 0], axis=1), np.nanmin(ends[:, 1], axis=1)
        inside = (boxes[:, 0] < ray) & (ray < boxes[:, 1]) | (np.abs(towards) > 1e-9)
        met = np.flatnonzero((exit_ - enter > 1e-6) & inside.all(axis=1))
        for a in met:
            for b in met:
                if enter[a] >= exit_[b] - 1e-9:  # a is nearer to the viewer
                    hidden += 1
                    assert place[a] > place[b], (bricks[a], bricks[b])
    assert hidden > 50


def test_the_ground_and_the_stones_have_colours_of_other_brightness():
    shades = [rgb(SHADES[name]) for name in ("brick", "platen", "ground")]
    bright = sorted(np.array(shades) @ (0.299, 0.587, 0.114))
    assert min(np.diff(bright)) > 20


# -- frames and cracks.png of real blocks ----------------------------------------------------------


def box(low, high):
    from masonry import MasonryMat, addBlock

    brick = MasonryMat(young=4.8e9, poisson=0.16, density=1800)
    return addBlock(boxCorners(low, high), brick)


def couplet(scene, folder, **message):
    """A brick that is pulled off another one, and the folder of its results."""
    box((0, 0, 0), (L, T, H))
    pull(scene, folder, box((0, 0, H), (L, T, 2 * H)), (0, 0, 1.0))
    return writeShort(folder, **message)


def writeShort(folder, **message):
    return writeRun(folder, ["time_s", "f_kN"], [[0, 0], [1, 1]], **message)


def pull(scene, folder, body, velocity, most=2e-3):
    from masonry import MasonryJoint, connect, engines
    from yade.wrapper import MasonryVtkRecorder

    for b in scene.bodies:
        b.state.blockedDOFs = "xyzXYZ"
    engines([MasonryJoint(name="bed", cap=False, tensileStrength=0.1e6)], rows=3)
    connect()
    scene.bodies[body].state.vel = velocity
    speed = np.linalg.norm(velocity)
    scene.dt = min(1e-5, most / speed / 50)
    for _ in range(round(most / speed / scene.dt)):
        scene.step()
    MasonryVtkRecorder(directory=str(folder))()


def test_the_reader_reads_what_vtk_reads(scene, tmp_path):
    io = pytest.importorskip("vtkmodules.vtkIOXML")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    couplet(scene, tmp_path)
    for kind, reader, ending in (
        ("blocks", io.vtkXMLUnstructuredGridReader(), "vtu"),
        ("joints", io.vtkXMLPolyDataReader(), "vtp"),
    ):
        reader.SetFileName(str(tmp_path / f"{kind}_0000.{ending}"))
        reader.Update()
        data, frame = reader.GetOutput(), frames.readFrame(tmp_path, kind)
        expected = {"points": vtk_to_numpy(data.GetPoints().GetData())}
        for of in (data.GetPointData(), data.GetCellData()):
            for n in range(of.GetNumberOfArrays()):
                expected[of.GetArrayName(n)] = vtk_to_numpy(of.GetArray(n))
        assert set(frame) == {*expected, "cells"}
        for name, values in expected.items():
            assert np.array_equal(frame[name], values), name
        cells = data.GetCells() if kind == "blocks" else data.GetPolys()
        corners = vtk_to_numpy(cells.GetConnectivityArray())
        assert np.array_equal(np.concatenate(frame["cells"]), corners)
        assert len(frame["cells"]) == data.GetNumberOfCells()
    assert frames.frameTimes(tmp_path) == [approx(scene.time)]


def test_frames_are_in_the_order_of_their_numbers_and_damage_is_refused(scene, tmp_path):
    couplet(scene, tmp_path)
    whole = (tmp_path / "joints_0000.vtp").read_bytes()
    for number in (9999, 10000):
        (tmp_path / f"joints_{number:04d}.vtp").write_bytes(whole)
    last = frames.framePaths(tmp_path, "joints")[-1]
    assert last.endswith("joints_10000.vtp")
    for broken in (
        whole[: len(whole) // 2],
        whole.replace(b"Polys>", b"Verts>"),
        whole[:-200] + whole[-120:],
    ):
        (tmp_path / "joints_10000.vtp").write_bytes(broken)
        with raises(Refused, match="joints_10000.vtp: it holds no frame"):
            frames.readFrame(tmp_path, "joints")


def polygonsOf(axes):
    """All that is drawn of blocks and cracks: polygons with the colours of their faces and
    edges."""
    (all_,) = [c for c in axes.collections if isinstance(c, PolyCollection) and len(c.get_paths())]
    shapes = [path.vertices[:-1] for path in all_.get_paths()]
    faces, edges = all_.get_facecolors(), all_.get_edgecolors()
    look = lambda colours, n: to_hex(colours[n]) if colours[n][3] else "none"
    return [(shape, look(faces, n), look(edges, n)) for n, shape in enumerate(shapes)]


def crackLines(axes):
    """Lines of cracks by kind: arrays of pairs of ends."""
    return {
        kind: np.array([shape for shape, _, edge in polygonsOf(axes) if edge == colour])
        for kind, colour in CRACKS.items()
    }


def crackFaces(axes):
    return [shape for shape, _, edge in polygonsOf(axes) if edge == "none"]


def test_an_open_joint_is_drawn_on_the_faces_of_both_blocks(scene, tmp_path, drawn):
    """Two wythes of two bricks under one lintel, which is lifted: its joint opens over both."""
    for n in (0, 1):
        for m in (0, 1):
            box((m * L, n * T, 0), ((m + 1) * L, (n + 1) * T, H))
    lintel = box((0, 0, H), (2 * L, 2 * T, 3 * H))
    pull(scene, tmp_path, lintel, (0, 0, 1.0))
    elevation.cracks(writeShort(tmp_path))
    figure = drawn["cracks.png"]
    (axes,) = figure.axes
    lines = crackLines(axes)
    assert not len(lines["slid"])
    # what was lifted, magnified; both faces from end to end
    lifted = H + 30 * 2e-3
    for face in (H, lifted):
        ends = lines["open"][np.abs(lines["open"][:, 0, 1] - face) < 0.05 * (lifted - H)]
        assert (ends[..., 0].min(), ends[..., 0].max()) == approx((0, 2 * L))
    assert axes.get_xlabel() == "x [m]" and axes.get_ylabel() == "z [m]"
    assert "displacements × 30" in figure._suptitle.get_text()


def test_the_seam_in_a_brick_of_two_halves_is_no_mortar_joint(scene, tmp_path, drawn):
    box((0, 0, 0), (L, T, H))
    pull(scene, tmp_path, box((L, 0, 0), (2 * L, T, H)), (1.0, 0, 0), most=1e-6)
    for kinds, places in ((["bed"], 0), (["crack"], 1)):
        elevation.cracks(writeShort(tmp_path, kinds=kinds))
        (axes,) = drawn["cracks.png"].axes
        seams = [shape for shape, _, edge in polygonsOf(axes) if edge == SHADES["brick"]]
        assert len({tuple(shape[:, 0].round(4)) for shape in seams}) == places
        assert "no joint is cracked, true to scale" in drawn["cracks.png"]._suptitle.get_text()


def test_drawn_blocks_overlap_by_their_closure_and_no_more(scene, tmp_path, drawn):
    """A brick that is pushed along its bed joint and into it, so that the joint slides and
    closes."""
    lower = box((0, 0, 0), (3 * L, T, H))
    pull(scene, tmp_path, box((L, 0, H), (2 * L, T, 2 * H)), (1.0, 0, -0.02))
    folder = writeShort(tmp_path)
    elevation.cracks(folder)
    (axes,), title = drawn["cracks.png"].axes, drawn["cracks.png"]._suptitle.get_text()
    assert "displacements ×" in title, title
    magnification = int(re.search(r"displacements × (\d+)", title)[1])
    closed = -frames.readFrame(folder, "joints")["opening"].min()
    assert closed > 0.03e-3 and magnification > 1
    bricks = [shape for shape, face, _ in polygonsOf(axes) if face == SHADES["brick"]]
    low, high = sorted((shape[:, 1] for shape in bricks), key=np.mean)
    overlap = low.max() - high.min()
    assert overlap == approx(magnification * closed, rel=0.01)
    assert overlap <= H / 4 and lower == 0


def test_a_corner_has_an_elevation_for_each_wall_and_what_parts_them_is_seen_in_space(
    scene, tmp_path, drawn
):
    """A wall along x and one along y that butts against it and is pulled away along y."""
    high = 4 * H
    front = [box((n * L, 0, 0), ((n + 1) * L, T, high)) for n in (0, 1)]
    side = [box((0, T, 0), (T, T + 4 * L, high))]
    pull(scene, tmp_path, side[0], (0, 1.0, 0))
    parts = {"front": front, "side": side}
    draw = lambda **message: elevation.cracks(writeShort(tmp_path, parts=parts, **message))
    named = lambda: {axes.get_title().split(" ")[0]: axes for axes in drawn["cracks.png"].axes}
    draw()
    panels = named()
    assert [panels[n].get_xlabel() for n in parts] == ["x [m]", "y [m]"]
    assert "viewer" not in panels["side"].get_title()
    lines = crackLines(panels["side"])["open"]
    places = lines[:, :, 0].mean(axis=1)
    # the other face of the joint is behind the end of the front wall
    assert set(places.round(3)) == {round(T + 30 * 2e-3, 3)}
    assert not crackFaces(panels["front"])  # which looks away from the viewer

    # a ground that has moved with everything is taken off
    draw(reference_body=side[0])
    panels = named()
    assert "moved up to 2 mm towards the viewer" in panels["front"].get_title()
    # the points of the joint, five a side, on the block whose face looks to the viewer
    assert len(crackFaces(panels["in"])) == 25 and not panels["in"].axison
    for axes in panels.values():  # nothing is cut off
        (x, *_), (y, *_) = limits = np.sort([axes.get_xlim(), axes.get_ylim()])
        corners = np.concatenate([shape for shape, _, _ in polygonsOf(axes)])
        assert (corners > (x, y)).all() and (corners < limits[:, 1]).all()


def made(*boxes):
    points = np.concatenate([boxCorners(*ends) for ends in boxes]).astype(float)
    cells = np.arange(len(points)).reshape(-1, 8)
    return {"points": points, "displacement": 0 * points, "body": range(len(boxes)), "cells": cells}


def test_a_facade_has_one_elevation_with_all_parts_in_it():
    """Two walls along x, 3 m apart, a floor that bears on both, and a footing below the first."""
    bricks = [
        ((n, y, z), (n + 1, y + 0.3, z + 1)) for y in (0, 3) for n in range(4) for z in (0, 1.2)
    ]
    floor, footing = ((0, 0.1, 1), (4, 3.2, 1.2)), ((0, -0.2, -0.3), (4, 0.5, 0))
    parts = {"front": range(8), "back": range(8, 16), "floor": [16], "footing": [17]}
    found = elevation.elevationsOf(Structure(made(*bricks, floor, footing), None, parts))
    assert [(one.name, set(one.bodies)) for one in found] == [
        ("front", {*range(8), 16, 17}),
        ("back", {*range(8, 16), 16}),
    ]


def test_a_wall_of_two_storeys_has_one_elevation_and_a_mass_on_a_floor_none():
    brick = lambda n, y, z: ((n, y, z), (n + 1, y + 0.3, z + 1))
    bricks = [brick(n, y, z) for y in (0, 3) for z in (0, 2) for n in range(12)]
    parts = {
        f"{side} {storey}": range(24 * i + 12 * k, 24 * i + 12 * k + 12)
        for i, side in enumerate(("front", "back"))
        for k, storey in enumerate((1, 2))
    }
    mass = made(*bricks, ((0, 1, 3), (12, 1.3, 3.3)))
    found = elevation.elevationsOf(Structure(mass, None, {**parts, "mass": [48]}))
    assert [one.name for one in found] == ["front", "back"]


def test_a_picture_names_its_moment_as_it_is(tmp_path):
    """Three frames of a run that fell: the collapse was noticed at the first, the first block had
    fallen at the second."""
    sets = "".join(f'<DataSet timestep="{t}"/>' for t in (0.5, 1.0, 1.5))
    (tmp_path / "joints.pvd").write_text(f"<VTKFile><Collection>{sets}</Collection></VTKFile>")
    entry = {"x": axis("u_mm", "displacement of ridge [mm]"), "y": [axis("f_kN")]}
    folder = writeRun(tmp_path, ["time_s", "u_mm", "f_kN"], [[0, 0, 0], [2, 20, 1]], figure=entry)
    run = readRun(folder)
    of = lambda n: elevation.whenOf(run, folder, n)
    assert of(0) == "during the run: t = 0.5 s, displacement of ridge = 5.0 mm"
    assert of(2) == "at the end: t = 1.5 s, displacement of ridge = 15.0 mm"
    assert elevation.frameOfCracks(run, folder) == 2
    fall = lambda name, value: {"stage": "fall", "name": name, "value": value}
    run["answers"] = [fall("first_fall", 1.02), fall("noticed_at", 0.49)]
    assert elevation.frameOfCracks(run, folder) == 0
    assert of(0).startswith("when the collapse was noticed: t = 0.5 s")
    assert of(1).startswith("when the first block had fallen: t = 1 s")
    assert of(2).startswith("at the end: ")


def test_bodies_that_are_not_there_are_refused(scene, tmp_path):
    couplet(scene, tmp_path)
    for message, words in (
        ({"parts": {"all": [0, 7]}}, r"names bodies \[7\]"),
        ({"reference_body": 9}, r"names bodies \[9\]"),
        ({"parts": {"all": []}}, "parts: all has no bodies"),
    ):
        with raises(Refused, match=words):
            elevation.cracks(writeRun(tmp_path, ["time_s"], [[0], [1]], **message))


# -- inside YADE -----------------------------------------------------------------------------------

INSIDE = """
import sys
import masonry, masonry_view.figures
import matplotlib
from yade import plot
before = dict(matplotlib.rcParams), matplotlib.get_backend()
masonry_view.figures.draw({folder!r})
after = dict(matplotlib.rcParams), matplotlib.get_backend()
assert before == after, "settings of matplotlib were changed"
loaded = [name for name in sys.modules if name.startswith(("vtk", "paraview"))]
assert not loaded, "VTK's Python was loaded"
try:
    masonry_view.figures.draw("nowhere")
except masonry.errors.Refused as error:
    print("refused:", error)
"""


def test_a_script_of_yade_draws_without_harm(scene, tmp_path):
    entry = {"x": axis("time_s"), "y": [axis("f_kN")]}
    folder = couplet(scene, tmp_path, figure=entry)
    script = tmp_path / "inside.py"
    script.write_text(INSIDE.format(folder=folder))
    run = runProgram(str(script))
    assert "refused: cannot read nowhere/run.json" in run.stdout
    inside = {n: (tmp_path / n).read_bytes() for n in ("curve.png", "cracks.png")}
    for name, data in inside.items():
        assert data.startswith(b"\x89PNG")
        os.remove(tmp_path / name)
    # the same pictures without YADE
    run = ran([sys.executable, "-m", "masonry_view.figures", folder])
    assert run.returncode == 0, run.stderr
    assert inside == {name: (tmp_path / name).read_bytes() for name in inside}


def test_figures_are_drawn_into_no_folder_with_links(tmp_path):
    rows = [[0.1 * n, n] for n in range(5)]
    entry = {"x": axis("time_s"), "y": [axis("top_mm")], "y_label": "top"}
    folder = writeRun(tmp_path / "run", ["time_s", "top_mm"], rows, figure=entry)
    picture = tmp_path / "run" / "curve.png"
    (tmp_path / "other").write_text("of the user")
    picture.symlink_to("../other")
    command = [sys.executable, "-m", "masonry_view.figures", folder]
    done = ran(command, timeout=60)
    assert done.returncode == 2 and "curve.png" in done.stderr
    assert done.stderr.count("\n") == 1
    assert (tmp_path / "other").read_text() == "of the user"
    with raises(OSError):  # a picture by itself goes through no link, either
        drawing.save(drawing.empty(1, 1), str(picture), 50)
    picture.unlink()
    assert subprocess.run(command).returncode == 0 and picture.stat().st_size > 1000


def test_texts_of_a_run_steer_no_terminal(tmp_path):
    (tmp_path / "run.json").write_text('{"a": "\\u001b[2J"}')
    (tmp_path / "curve.csv").write_text("time_s\n\x1b[2J\n")
    command = [sys.executable, "-m", "masonry_view.figures", str(tmp_path)]
    done = ran(command)
    assert done.returncode == 2 and "\\x1b[2J" in done.stderr
    assert "\x1b" not in done.stdout + done.stderr
