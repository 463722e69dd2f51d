# SPDX-License-Identifier: GPL-2.0-or-later
"""The files of MasonryVtkRecorder hold, column by column, what Python reads of the same instant."""

import references
from hosted import *
from masonry.read.frames import asFrame, readFrame
from test_joint_loop import CASES, panel
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

REGIMES = ["elastic", "opening", "slipping", "crushing"]


def written(folder, name):
    """Columns of cells and of points, places of points, and for each cell the numbers of its points."""
    kind = vtkXMLPolyDataReader if name == "joints" else vtkXMLUnstructuredGridReader
    reader = kind()
    ending = "vtp" if name == "joints" else "vtu"
    reader.SetFileName(str(folder / f"{name}_0000.{ending}"))
    reader.Update()
    data = reader.GetOutput()
    columns = lambda of: {
        of.GetArrayName(n): vtk_to_numpy(of.GetArray(n))
        for n in range(of.GetNumberOfArrays())
    }
    corners, types = [], []
    for n in range(data.GetNumberOfCells()):
        # VTK gives the same object for every cell, with other contents.
        cell = data.GetCell(n)
        corners.append([cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())])
        types.append(cell.GetCellType())
    return (
        columns(data.GetCellData()),
        columns(data.GetPointData()),
        vtk_to_numpy(data.GetPoints().GetData()),
        corners,
        types,
    )


@pytest.fixture(params=CASES)
def frame(request, tmp_path):
    """A panel whose joints have opened, slipped and crushed, and the folder with its frame."""
    interactions = panel(False, **CASES[request.param])
    run(400)
    recorder = MasonryVtkRecorder(directory=str(tmp_path))
    recorder()
    yield interactions, tmp_path, recorder
    O.reset()


def test_joints_without_a_file_are_those_of_the_file(frame):
    """What is measured of a run that leaves no frames is measured of the same numbers."""
    _, folder, recorder = frame
    ofFile, now = readFrame(str(folder), "joints"), asFrame(recorder.joints())
    assert ofFile.keys() == now.keys()
    for name in ofFile.keys() - {"cells"}:
        assert np.array_equal(ofFile[name], now[name]), name
    assert all(map(np.array_equal, ofFile["cells"], now["cells"]))
    assert len(ofFile["cells"]) == len(now["cells"]) > 10


def test_every_column_of_the_joints_is_that_of_python(frame):
    joints, folder, recorder = frame
    cells, _, _, _, _ = written(folder, "joints")
    joints = [O.interactions[i.id1, i.id2] for i in O.interactions]
    rows = [(i, n) for i in joints for n in range(len(i.geom.areas))]
    assert len(cells["area"]) == len(rows)
    once = {}  # each attribute of each joint is read once only, because that is slow

    def of(i, part, name):
        key = (i.id1, i.id2, name)
        if key not in once:
            once[key] = getattr(getattr(i, part), name)
        return once[key]

    expected = {
        "area": lambda i, n: of(i, "geom", "areas")[n],
        "opening": lambda i, n: of(i, "geom", "jumps")[n][0],
        "slip": lambda i, n: of(i, "phys", "slip")[n],
        "slide": lambda i, n: of(i, "geom", "jumps")[n][1] * i.geom.tangent
        + of(i, "geom", "jumps")[n][2] * i.geom.normal.cross(i.geom.tangent),
        "normal": lambda i, n: i.geom.normal,
        "normal_stress": lambda i, n: of(i, "phys", "stress")[n][0],
        "shear_stress": lambda i, n: math.hypot(*list(of(i, "phys", "stress")[n])[1:]),
        "shear_traction": lambda i, n: of(i, "phys", "stress")[n][1] * i.geom.tangent
        + of(i, "phys", "stress")[n][2] * i.geom.normal.cross(i.geom.tangent),
        "damage_tension": lambda i, n: of(i, "phys", "damage")[n][0],
        "damage_shear": lambda i, n: of(i, "phys", "damage")[n][1],
        "damage_compression": lambda i, n: of(i, "phys", "damage")[n][2],
        "joint_dissipated": lambda i, n: of(i, "phys", "dissipated"),
        "regime": lambda i, n: REGIMES.index(of(i, "phys", "regime")[n]),
        "bodies": lambda i, n: (i.id1, i.id2),
    }
    for name, value in expected.items():
        there = cells[name]
        here = np.array([np.array(value(i, n), dtype=float) for i, n in rows])
        size = np.abs(here).max()
        assert size > 0, name
        assert np.abs(there - here).max() <= 1e-12 * size, name
    # Python does not show crushing and dilation by themselves. Of a closed joint they follow from sigma = kn (opening +
    # crushing - dilation), where the dilation is at most dilatancy times slip. A joint of the cyclic law may have lost stiffness.
    crushed = cells["crushing"]
    assert crushed.min() >= 0 and crushed.max() > 0
    for k, (i, _) in enumerate(rows):
        joint = i.phys.joint
        if joint.elastic or joint.law == "cyclic" or cells["normal_stress"][k] >= 0:
            continue
        kn = i.phys.normalStiffness
        dilation = cells["opening"][k] + crushed[k] - cells["normal_stress"][k] / kn
        most = i.phys.joint.dilatancy * cells["slip"][k]
        assert -1e-12 < dilation < most + 1e-12  # [m], round-off of a jump
    kinds = [i.phys.joint.name for i, _ in rows]
    names = dict(zip(cells["kind"], kinds))
    assert [names[k] for k in cells["kind"]] == kinds and len(names) == 2
    assert set(cells) == {*expected, "crushing", "kind"}


def test_a_cell_of_a_joint_lies_around_its_subcontact_and_has_its_area(frame):
    joints, folder, _ = frame
    cells, _, places, corners, _ = written(folder, "joints")
    row = 0
    for i in O.interactions:
        whole = 0.0
        for centre in i.geom.centres:
            points = [Vector3(*places[p]) for p in corners[row]]
            # In the plane of the joint.
            assert all(abs((p - centre).dot(i.geom.normal)) < 1e-9 for p in points)
            middle = sum(points, Vector3.Zero) / len(points)
            doubled = sum(
                (
                    (a - middle).cross(b - middle)
                    for a, b in zip(points, points[1:] + points[:1])
                ),
                Vector3.Zero,
            )
            whole += 0.5 * doubled.norm()
            row += 1
        assert whole == pytest.approx(sum(i.geom.areas), rel=1e-6)
    assert row == len(corners)


def test_the_points_of_a_joint_move_with_each_of_its_two_blocks(frame):
    """With a deformable unit a point of a joint moves as its nodes do; the jump is what opens and slides there."""
    _, folder, _ = frame
    _, points, places, corners, _ = written(folder, "joints")
    zones = next((e for e in O.engines if isinstance(e, MasonryZones)), None)
    deformable = set(zones.bodies) if zones else set()

    def moved(s, place):
        return s.pos + s.ori * s.refOri.conjugate() * (place - s.refPos) - place

    row, size = 0, np.abs(points["displacement"]).max()
    assert size > 1e-5
    for i in O.interactions:
        axes = i.geom.normal, i.geom.tangent, i.geom.normal.cross(i.geom.tangent)
        between, mean = np.zeros(3), np.zeros(3)
        for jump, area in zip(i.geom.jumps, i.geom.areas):
            sides = [np.array([points[n][p] for p in corners[row]]) for n in ("displacement", "second_displacement")]  # fmt: skip
            for body, side in zip((i.id1, i.id2), sides):
                if body not in deformable:
                    expected = [moved(O.bodies[body].state, Vector3(*places[p])) for p in corners[row]]  # fmt: skip
                    assert np.abs(side - expected).max() < 1e-9 * size
            # a point need not stand in the middle of its cell: means over the joint are compared
            between += area * (sides[1] - sides[0]).mean(axis=0) @ np.transpose(axes)
            mean += area * np.array(jump)
            row += 1
        if {i.id1, i.id2} & deformable:  # rigid ones are held to their motion above
            assert np.abs(between - mean).max() < 0.02 * size * sum(i.geom.areas)


def test_the_points_of_blocks_move_as_bodies_and_nodes_do(frame):
    _, folder, _ = frame
    cells, points, places, corners, types = written(folder, "blocks")
    zones = next((e for e in O.engines if isinstance(e, MasonryZones)), None)
    deformable = list(zones.bodies) if zones else []
    first = 0
    size = max(np.abs(points["displacement"]).max(), 1e-9)
    for body in deformable:
        low, beyond = zones.nodesOf(body)
        for node in range(low, beyond):
            assert (
                Vector3(*places[first]) - zones.referencePoint(body, node)
            ).norm() < 1e-9
            moved = Vector3(*points["displacement"][first]) - zones.displacements[node]
            assert moved.norm() < 1e-9 * size
            speed = Vector3(*points["velocity"][first]) - zones.velocities[node]
            assert speed.norm() < 1e-9
            first += 1
    for b in O.bodies:
        if b.id in deformable:
            continue
        s = b.state
        for corner in b.shape.v:
            reference = s.refPos + s.refOri * corner
            now = s.pos + s.ori * corner
            assert (Vector3(*places[first]) - reference).norm() < 1e-9
            moved = Vector3(*points["displacement"][first]) - (now - reference)
            assert moved.norm() < 1e-9 * size
            speed = s.vel + s.angVel.cross(s.ori * corner)
            assert (Vector3(*points["velocity"][first]) - speed).norm() < 1e-9
            first += 1
    assert first == len(places)
    tetrahedra = [k for k, kind in enumerate(types) if kind == 10]
    assert bool(tetrahedra) == bool(deformable)
    assert {int(cells["body"][k]) for k in tetrahedra} == set(deformable)
    assert sorted(set(map(int, cells["body"]))) == [b.id for b in O.bodies]


@pytest.mark.parametrize(
    "turn", [Quaternion.Identity, references.TURN], ids=["straight", "turned"]
)
def test_stresses_of_zones_are_those_of_a_brick_that_is_pressed(scene, tmp_path, turn):
    """A deformable brick between plates under pressure p carries -p along it and nothing else, in the global axes."""
    from masonry import (
        MasonryJoint,
        MasonryLoad,
        MasonryMat,
        addBlock,
        connect,
        criticalTimeStep,
        engines,
    )

    plate = MasonryMat(density=1800, young=1e16, jointSet="plate")
    mat = MasonryMat(density=1800, young=4.8e9, poisson=0.0)
    put = lambda low, high, m: addBlock(references.box(low, high, turn), m)
    base = put((0, 0, -0.05), (0.22, 0.1, 0), plate)
    unit = put((0, 0, 0), (0.22, 0.1, 0.08), mat)
    top = put((0, 0, 0.08), (0.22, 0.1, 0.13), plate)
    O.bodies[base].state.blockedDOFs = "xyzXYZ"
    O.bodies[top].state.blockedDOFs = "XYZ"
    up, pressure = turn * Vector3(0, 0, 1), 0.4e6
    load = MasonryLoad(
        body=top, point=O.bodies[top].state.pos, force=-pressure * 0.022 * up
    )
    zones = MasonryZones(bodies=[unit], damping=0.8)
    engines([MasonryJoint(elastic=True)], gravity=(0, 0, 0), loads=[load], zones=zones)
    connect()
    O.dt = 0.8 * criticalTimeStep()[0]
    for _ in range(6000):
        O.step()
        O.bodies[top].state.vel *= 0.995  # the loaded plate has no damping of its own
    MasonryVtkRecorder(directory=str(tmp_path))()
    cells, _, _, _, _ = written(tmp_path, "blocks")
    axes = np.array(turn.toRotationMatrix())
    expected = axes @ np.diag([0, 0, -pressure]) @ axes.T
    own = cells["body"] == unit
    assert own.sum() == 12
    for six, principal in zip(cells["stress"][own], cells["principal_stress"][own]):
        there = np.array(
            [
                [six[0], six[3], six[5]],
                [six[3], six[1], six[4]],
                [six[5], six[4], six[2]],
            ]
        )
        assert np.abs(there - expected).max() < 0.01 * pressure
        assert np.abs(np.sort(principal) - [-pressure, 0, 0]).max() < 0.01 * pressure
    assert np.abs(cells["stress"][~own]).max() == 0


#: What only files of ties and springs have.
OF_CONNECTORS = {"force", "tension", "elongation", "condition"}


def test_every_column_is_described_and_says_its_unit(frame):
    _, folder, _ = frame
    described = MasonryVtkRecorder.fields()
    seen = set()
    for name, kind, ending in (
        ("joints", vtkXMLPolyDataReader, "vtp"),
        ("blocks", vtkXMLUnstructuredGridReader, "vtu"),
    ):
        reader = kind()
        reader.SetFileName(str(folder / f"{name}_0000.{ending}"))
        reader.Update()
        data = reader.GetOutput()
        for columns in (data.GetCellData(), data.GetPointData()):
            for n in range(columns.GetNumberOfArrays()):
                column = columns.GetArray(n)
                unit = column.GetInformation().Get(vtkDataArray.UNITS_LABEL())
                about = described[column.GetName()]
                assert f"[{unit}]" in about if unit else "[" not in about
                seen.add(column.GetName())
    assert seen == set(described) - OF_CONNECTORS
