# SPDX-License-Identifier: GPL-2.0-or-later
"""The files of MasonryVtkRecorder hold, column by column, what Python reads of the same instant."""

from hosted import *
from masonry.numbers.frames import asFrame, readFrame
from test_joint_loop import CASES, panel
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

REGIMES = ["elastic", "opening", "slipping", "crushing"]


@pytest.fixture(params=CASES)
def frame(request, tmp_path):
    """A panel whose joints have opened, slipped and crushed, and the folder with its frame."""
    interactions = panel(False, **CASES[request.param])
    run(400)
    recorder = MasonryVtkRecorder(directory=str(tmp_path))
    recorder()
    return interactions, tmp_path, recorder


def test_joints_without_a_file_are_those_of_the_file(frame):
    _, folder, recorder = frame
    ofFile, now = readFrame(folder, "joints"), asFrame(recorder.joints())
    assert ofFile.keys() == now.keys()
    for name in ofFile.keys() - {"cells"}:
        assert np.array_equal(ofFile[name], np.float32(now[name])), name  # files are rounded
    assert all(map(np.array_equal, ofFile["cells"], now["cells"]))
    assert len(ofFile["cells"]) == len(now["cells"]) > 10


def test_every_column_of_the_joints_is_that_of_python(frame):
    _, _, recorder = frame
    cells = asFrame(recorder.joints())
    joints = [O.interactions[i.id1, i.id2] for i in O.interactions]
    rows = [(i, n) for i in joints for n in range(len(i.geom.areas))]
    assert len(cells["area"]) == len(rows)
    expected = {}
    for i in joints:
        jumps, stress = np.array(i.geom.jumps), np.array(i.phys.stress)
        tangent = i.geom.tangent
        sides = np.array([tangent, i.geom.normal.cross(tangent)])
        every = [[1.0]] * len(jumps)  # what all points of a joint have
        of = {"area": i.geom.areas, "opening": jumps[:, 0], "slip": i.phys.slip}
        of.update(slide=jumps[:, 1:] @ sides, normal=every * np.array(i.geom.normal))
        of.update(normal_stress=stress[:, 0], shear_traction=stress[:, 1:] @ sides)
        of["shear_stress"] = np.hypot(*stress[:, 1:].T)
        for n, mode in enumerate(("tension", "shear", "compression")):
            of["damage_" + mode] = np.array(i.phys.damage)[:, n]
        of["joint_dissipated"] = every * np.array(i.phys.dissipated)
        of["regime"] = [REGIMES.index(regime) for regime in i.phys.regime]
        of["bodies"] = every * np.array((i.id1, i.id2))
        for name, values in of.items():
            expected.setdefault(name, []).extend(values)
    for name, values in expected.items():
        here = np.array(values, dtype=float)
        size = np.abs(here).max()
        assert size > 0, name
        assert np.abs(cells[name] - here).max() <= 1e-12 * size, name
    # Python does not show crushing and dilation by themselves. Of a closed joint they follow from
    # sigma = kn (opening + crushing - dilation), where the dilation is at most dilatancy times
    # slip. A joint of the cyclic law may have lost stiffness.
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
    others = {"points", "cells", "displacement", "second_displacement"}
    assert set(cells) - others == {*expected, "crushing", "kind"}


def test_a_cell_of_a_joint_lies_around_its_subcontact_and_has_its_area(frame):
    _, _, recorder = frame
    frame = asFrame(recorder.joints())
    places, corners = frame["points"], frame["cells"]
    row = 0
    for i in O.interactions:
        whole = 0.0
        for centre in i.geom.centres:
            points = [Vector3(*places[p]) for p in corners[row]]
            # In the plane of the joint.
            assert all(abs((p - centre).dot(i.geom.normal)) < 1e-9 for p in points)
            middle = sum(points, Vector3.Zero) / len(points)
            arms = [point - middle for point in points]
            pairs = zip(arms, arms[1:] + arms[:1])
            whole += 0.5 * sum((a.cross(b) for a, b in pairs), Vector3.Zero).norm()
            row += 1
        assert whole == approx(sum(i.geom.areas), rel=1e-6)
    assert row == len(corners)


def test_the_points_of_a_joint_move_with_each_of_its_two_blocks(frame):
    """With a deformable unit a point of a joint moves as its nodes do; the jump is what opens and
    slides there."""
    _, _, recorder = frame
    points = asFrame(recorder.joints())
    places, corners = points["points"], points["cells"]
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
            sides = [
                np.array([points[n][p] for p in corners[row]])
                for n in ("displacement", "second_displacement")
            ]
            for body, side in zip((i.id1, i.id2), sides):
                if body not in deformable:
                    expected = [
                        moved(O.bodies[body].state, Vector3(*places[p])) for p in corners[row]
                    ]
                    assert np.abs(side - expected).max() < 1e-9 * size
            # a point need not stand in the middle of its cell: means over the joint are compared
            between += area * (sides[1] - sides[0]).mean(axis=0) @ np.transpose(axes)
            mean += area * np.array(jump)
            row += 1
        if {i.id1, i.id2} & deformable:  # rigid ones are held to their motion above
            assert np.abs(between - mean).max() < 0.02 * size * sum(i.geom.areas)


def test_the_points_of_blocks_move_as_bodies_and_nodes_do(frame):
    _, folder, _ = frame
    found = readFrame(folder, "blocks")
    zones = next((e for e in O.engines if isinstance(e, MasonryZones)), None)
    deformable = list(zones.bodies) if zones else []
    reference, moved, speed = [], [], []
    for body in deformable:
        nodes = range(*zones.nodesOf(body))
        reference += [zones.referencePoint(body, node) for node in nodes]
        moved += [zones.displacements[node] for node in nodes]
        speed += [zones.velocities[node] for node in nodes]
    rigid = [b for b in O.bodies if b.id not in deformable]
    for s, corner in [(b.state, corner) for b in rigid for corner in b.shape.v]:
        reference.append(s.refPos + s.refOri * corner)
        moved.append(s.pos + s.ori * corner - reference[-1])
        speed.append(s.vel + s.angVel.cross(s.ori * corner))
    size = max(np.abs(found["displacement"]).max(), 1e-9)
    for name, expected, apart in (
        ("points", reference, 1e-9),
        ("displacement", moved, 1e-9 * size),
        ("velocity", speed, 1e-9),
    ):
        rounded = np.float32(expected)  # as a file has them
        assert np.linalg.norm(found[name] - rounded, axis=1).max() < apart
    bodies = [*map(int, found["body"])]
    ofZones = {body for body, cell in zip(bodies, found["cells"]) if len(cell) == 4}
    assert ofZones == set(deformable) and {*bodies} == {b.id for b in O.bodies}


@mark.parametrize("turn", [Quaternion.Identity, IN_SPACE], ids=["straight", "turned"])
def test_stresses_of_zones_are_those_of_a_brick_that_is_pressed(tmp_path, turn):
    """A deformable brick between plates under pressure p carries -p along it and nothing else, in
    the global axes."""
    plate, mat = unitMaterial(young=1e16, jointSet="plate"), unitMaterial(poisson=0.0)
    put = lambda z, height, m: addBlock(box((0, 0, z), (0.22, 0.1, height), turn), m)
    hold(put(-0.05, 0.05, plate))
    unit, top = put(0, 0.08, mat), put(0.08, 0.05, plate)
    O.bodies[top].state.blockedDOFs = "XYZ"
    force, pressure = turn * Vector3(0, 0, -0.4e6 * 0.022), 0.4e6
    load = MasonryLoad(body=top, point=O.bodies[top].state.pos, force=force)
    zones = MasonryZones(bodies=[unit], damping=0.8)
    around = dict(gravity=(0, 0, 0), loads=[load], zones=zones)
    join(MasonryJoint(elastic=True), 0.8, **around)
    for _ in range(6000):
        O.step()
        O.bodies[top].state.vel *= 0.995  # the loaded plate has no damping of its own
    MasonryVtkRecorder(directory=str(tmp_path))()
    cells = readFrame(tmp_path, "blocks")
    axes = np.array(turn.toRotationMatrix())
    expected = axes @ np.diag([0, 0, -pressure]) @ axes.T
    own = cells["body"] == unit
    assert own.sum() == 12
    for six, principal in zip(cells["stress"][own], cells["principal_stress"][own]):
        there = six[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
        assert np.abs(there - expected).max() < 0.01 * pressure
        assert np.abs(np.sort(principal) - [-pressure, 0, 0]).max() < 0.01 * pressure
    assert np.abs(cells["stress"][~own]).max() == 0


#: What only files of ties and springs have.
OF_CONNECTORS = {"force", "tension", "elongation", "condition"}


def test_every_column_is_described_and_says_its_unit(frame):
    _, folder, _ = frame
    described = MasonryVtkRecorder.fields()
    seen = set()
    for path, reader in (
        ("blocks_0000.vtu", vtkXMLUnstructuredGridReader()),
        ("joints_0000.vtp", vtkXMLPolyDataReader()),
    ):
        reader.SetFileName(str(folder / path))
        reader.Update()
        parts = reader.GetOutput().GetCellData(), reader.GetOutput().GetPointData()
        for part, n in [(p, n) for p in parts for n in range(p.GetNumberOfArrays())]:
            column = part.GetArray(n)
            unit = column.GetInformation().Get(vtkDataArray.UNITS_LABEL())
            about = described[column.GetName()]
            assert f"[{unit}]" in about if unit else "[" not in about
            seen.add(column.GetName())
    assert seen == set(described) - OF_CONNECTORS
