# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks from files of every format, and what is refused in them."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some

from masonry.bricks import Arch, Bricks, Dome, Wall, fromFile, stack
from masonry.bricks.geometry import hull

import meshio

#: 27 blocks: a wall whose blocks touch at faces of different size, an arch, and a keystone with many corners.
MODEL = (
    Wall(0.66, 0.243)
    + Arch(0.3, 0.5, 9, radius=1.0).moved(dx=2)
    + Dome(1, 0.2, 2, 5).moved(dx=6)
)


def surfaces(blocks):
    """Corners and outward faces of each block."""
    return [(np.array(b.corners), hull(b.corners)) for b in blocks]


def oneMesh(blocks):
    """All corners in one list, and all faces with numbers in it."""
    points, faces = [], []
    for corners, own in surfaces(blocks):
        faces += [tuple(n + len(points) for n in face) for face in own]
        points += [tuple(map(float, c)) for c in corners]
    return points, faces


def triangles(faces):
    return [(f[0], a, b) for f in faces for a, b in zip(f[1:], f[2:])]


def writeObj(path, blocks, word="g"):
    start, lines = 1, []
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        lines.append(f"{word} block {n}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
        lines += ["f " + " ".join(f"{k + start}//1" for k in f) for f in faces]
        start += len(corners)
    path.write_text("\n".join(lines))


def writePlainObj(path, blocks, points=None, faces=None, digits=9):
    if points is None:
        points, faces = oneMesh(blocks)
    text = [f"v {x:.{digits}f} {y:.{digits}f} {z:.{digits}f}" for x, y, z in points]
    text += ["f " + " ".join(str(n + 1) for n in face) for face in faces]
    path.write_text("\n".join(text))


def writeRelativeObj(path, blocks):
    lines = []
    for corners, faces in surfaces(blocks):
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
        lines += ["f " + " ".join(f"{k - len(corners)}" for k in f) for f in faces]
    path.write_text("\n".join(lines))


def writeOff(path, blocks):
    points, faces = oneMesh(blocks)
    lines = ["OFF # a comment", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points]
    lines += [f"{len(f)} " + " ".join(map(str, f)) for f in faces]
    path.write_text("\n".join(lines))


def writeStl(path, blocks):
    lines = []
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        lines.append(f"solid block {n}")
        for triangle in triangles(faces):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += [
                "vertex {!r} {!r} {!r}".format(*corners[k].tolist()) for k in triangle
            ]
            lines += ["endloop", "endfacet"]
        lines.append("endsolid")
    path.write_text("\n".join(lines))


def byMeshio(binary):
    def write(path, blocks):
        points, faces = oneMesh(blocks)
        mesh = meshio.Mesh(
            np.array(points), [("triangle", np.array(triangles(faces), "i4"))]
        )
        mesh.write(path, binary=binary)

    return write


def writeJson(path, blocks):
    nodes = {}
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        mesh = dict(
            attributes={"name": f"block {n}"},
            default_vertex_attributes={"x": 0.0, "y": 0.0, "z": 0.0},
            vertex={
                str(k): {a: v for a, v in zip("xyz", c.tolist()) if v}
                for k, c in enumerate(corners)
            },
            face={str(k): list(f) for k, f in enumerate(faces)},
        )
        block = dict(dtype="compas_assembly.datastructures/Block", data=mesh)
        nodes[str(n)] = dict(block=block)
    path.write_text(
        json.dumps(
            dict(
                dtype="compas_assembly.datastructures/Assembly",
                data=dict(graph=dict(node=nodes)),
            )
        )
    )


FORMATS = {
    "grouped.obj": writeObj,
    "plain.obj": writePlainObj,
    "relative.obj": writeRelativeObj,
    "many.off": writeOff,
    "text.stl": writeStl,
    "bytes.stl": byMeshio(True),
    "text.ply": byMeshio(False),
    "bytes.ply": byMeshio(True),
    "assembly.json": writeJson,
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_blocks_that_were_written(tmp_path, name):
    """Blocks that touch are distinguished also where all surfaces stand in one mesh. STL as bytes has single precision."""
    FORMATS[name](tmp_path / name, MODEL)
    read = fromFile(tmp_path / name)
    assert len(read) == len(MODEL) == len({b.brick for b in read})
    for one, two in zip(read, MODEL):
        assert np.array(sorted(one.corners)) == pytest.approx(
            np.array(sorted(two.corners)), abs=2e-6
        ) or (
            np.allclose(one.low, two.low, atol=2e-6)
            and np.allclose(one.high, two.high, atol=2e-6)
        )
        assert len(one.corners) == len(two.corners)
    assert read.volume == pytest.approx(MODEL.volume, rel=1e-5)
    assert [j[:2] for j in read.joints()] == [j[:2] for j in MODEL.joints()]
    named = name in ("grouped.obj", "text.stl", "assembly.json")
    assert read[5].part == ("block 5" if named else name.split(".")[0])
    assert {b.kind for b in read} == {"block"}


def test_objects_of_obj_are_groups_and_millimetres_are_scaled(tmp_path):
    writeObj(tmp_path / "a.obj", stack(2, (400.0, 200.0, 100.0)), "o")
    read = fromFile(tmp_path / "a.obj", scale=0.001, kind="brick")
    assert read.high == pytest.approx((0.4, 0.2, 0.2)) and read[1].part == "block 1"
    assert {b.kind for b in read} == {"brick"}


def test_faces_may_all_run_clockwise(tmp_path):
    points, faces = oneMesh(MODEL)
    writePlainObj(tmp_path / "a.obj", None, points, [f[::-1] for f in faces])
    assert fromFile(tmp_path / "a.obj").volume == pytest.approx(MODEL.volume)


def test_points_inside_faces_and_edges_are_no_corners(tmp_path):
    """The top of a cube in four squares about its middle, whose outer points lie on the edges of the sides."""
    points, faces = oneMesh(stack(1, (1.0, 1.0, 1.0)))
    at = lambda p: points.index(p)
    sides = []
    for face in faces:
        ring = []
        for n, m in zip(face, face[1:] + face[:1]):
            ring.append(n)
            if (
                points[n][2] == points[m][2] == 1.0
            ):  # an edge at the top gets a point in its middle
                middle = tuple((a + b) / 2 for a, b in zip(points[n], points[m]))
                if middle not in points:
                    points.append(middle)
                ring.append(at(middle))
        sides.append(tuple(ring))
    (top,) = [f for f in sides if len(f) == 8]
    sides.remove(top)
    points.append((0.5, 0.5, 1.0))
    k = top.index(at((0.5, 0.0, 1.0)))
    top = top[k:] + top[:k]
    for n in range(0, 8, 2):
        sides.append((top[n], top[n + 1], top[(n + 2) % 8], len(points) - 1))
    writePlainObj(tmp_path / "a.obj", None, points, sides)
    (block,) = fromFile(tmp_path / "a.obj")
    assert sorted(block.corners) == sorted(stack(1, (1.0, 1.0, 1.0))[0].corners)


def notConvex():
    """A prism over an L, as one solid."""
    ell = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    points = [(x, y, float(z)) for z in (0, 1) for x, y in ell]
    faces = [tuple(range(5, -1, -1)), tuple(range(6, 12))]
    faces += [(n, (n + 1) % 6, (n + 1) % 6 + 6, n + 6) for n in range(6)]
    return points, faces


def test_a_solid_that_is_not_convex_is_refused_with_its_face(tmp_path):
    path = tmp_path / "ell.obj"
    writePlainObj(path, None, *notConvex())
    with pytest.raises(
        ValueError,
        match=r"ell, solid 0, face 4 at \(1.500, 1.000, 0.500\) m: the solid reaches 1 m beyond",
    ):
        fromFile(path)


def test_an_open_solid_is_refused_with_its_face(tmp_path):
    points, faces = oneMesh(stack(1, (1.0, 1.0, 1.0)))
    writePlainObj(tmp_path / "a.obj", None, points, faces[:-1])
    with pytest.raises(
        ValueError, match=r"a, face \d: an edge at .* the solid is open"
    ):
        fromFile(tmp_path / "a.obj")
    writePlainObj(tmp_path / "b.obj", None, points, [*faces[:-1], faces[-1][::-1]])
    with pytest.raises(ValueError, match="or its faces run in different senses"):
        fromFile(tmp_path / "b.obj")


def test_a_bent_face_is_refused(tmp_path):
    points, faces = oneMesh(stack(1, (1.0, 1.0, 1.0)))
    points[-1] = (1.0, 1.0, 1.1)
    writePlainObj(tmp_path / "a.obj", None, points, faces)
    with pytest.raises(
        ValueError, match="a, solid 0, face . at .* bent by 0.0.* m, not plane"
    ):
        fromFile(tmp_path / "a.obj")


@pytest.mark.parametrize(
    "name, text, said",
    [
        ("a.obj", "", "no faces, so no solids"),
        ("a.obj", "v 0 0 0\nf 1 2 3", "line 2: face with point 2, of 1 so far"),
        ("a.obj", "v 0 0 nan", "line 1: 0 0 nan is no point of three finite numbers"),
        ("a.obj", "v 0 0", "line 1: 0 0 is no point"),
        ("a.obj", "v 0 0 0\nf 1 1 1", "no faces"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "the solid is open"),
        ("a.off", "COFF\n", "COFF is a variant"),
        ("a.off", "hello", "does not start with OFF"),
        ("a.off", "OFF\n8 6 0\n0 0 0", "8 points and 6 faces are told"),
        ("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 7", "a face with points"),
        ("a.stl", "hello", "neither text that starts with solid"),
        ("a.stl", "solid a\nvertex 0 0 0\nendsolid", "a facet without three points"),
        ("a.stl", "solid a\nvertex 0 0 0", "solid a has no end"),
        ("a.ply", "hello", "meshio: "),
        ("a.json", "{", "cannot be read"),
        ("a.json", "{}", "no mesh"),
        (
            "a.json",
            '{"vertex": {"0": {"x": 0}}, "face": {"0": [0, 1, 2]}}',
            "face 0 has a vertex 1 that is none",
        ),
        (
            "a.json",
            '{"vertex": {"0": {"x": "high"}}, "face": {}}',
            "no point of three finite numbers",
        ),
        ("a.step", "", "must end with one of .obj"),
        ("missing.obj", None, "no such file"),
    ],
)
def test_a_file_without_solids_is_refused(tmp_path, name, text, said):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=said):
        fromFile(tmp_path / name)


def test_a_corner_beyond_all_masonry_is_refused(tmp_path):
    path = tmp_path / "far.obj"
    writePlainObj(path, stack(2, (0.4, 0.2, 0.1)))
    lines = path.read_text().splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("v "))
    lines[first] = "v 1e300 0 0"
    path.write_text("\n".join(lines))
    with pytest.raises(
        ValueError, match="a coordinate of 1e[+]300 m is above 1e[+]06 m"
    ):
        fromFile(path)


@settings(
    max_examples=150,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(some.data())
def test_a_damaged_file_is_read_or_refused(tmp_path, data):
    """A character of a good file is replaced or left out: either blocks come out, or ValueError."""
    name = data.draw(
        some.sampled_from([n for n in FORMATS if not n.startswith("bytes.stl")])
    )
    path = tmp_path / name
    FORMATS[name](path, stack(2, (0.4, 0.2, 0.1)))
    content = bytearray(path.read_bytes())
    at = data.draw(some.integers(0, len(content) - 1))
    content[at : at + 1] = data.draw(some.binary(max_size=2))
    path.write_bytes(content)
    try:
        assert isinstance(fromFile(path), Bricks)
    except ValueError as error:
        assert str(path) in str(error)
