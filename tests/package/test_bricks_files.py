# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks from files of every format, and what is refused in them."""

import struct

from usual import *

from masonry.bricks import Arch, Bricks, Dome, Wall, fromFile, stack
from masonry.bricks.geometry import boxCorners, hull
import meshio

#: 27 blocks: a wall whose blocks touch at faces of different size, an arch, and a keystone with
#: many corners.
ARCH, DOME = Arch(0.3, 0.5, 9, radius=1.0).moved(dx=2), Dome(1, 0.2, 2, 5).moved(dx=6)
MODEL = Wall(0.66, 0.243) + ARCH + DOME


def surfaces(blocks):
    return [(np.array(b.corners), hull(b.corners)) for b in blocks]


def oneMesh(blocks):
    points, faces = [], []
    for corners, own in surfaces(blocks):
        faces += [tuple(n + len(points) for n in face) for face in own]
        points += [tuple(map(float, c)) for c in corners]
    return points, faces


def writeObj(path, blocks, word="g", relative=False):
    """A group or an object for each block; numbers of corners from the first one on, or back from
    the last."""
    start, lines = 1, []
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        first, end = (-len(corners), "") if relative else (start, "//1")
        lines += [f"{word} block {n}"] * (not relative)
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
        lines += ["f " + " ".join(f"{k + first}{end}" for k in f) for f in faces]
        start += len(corners)
    path.write_text("\n".join(lines))


def writeMesh(path, points, faces):
    text = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
    text += ["f " + " ".join(str(n + 1) for n in face) for face in faces]
    path.write_text("\n".join(text))


def writeOff(path, blocks):
    points, faces = oneMesh(blocks)
    lines = ["OFF # a comment", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points]
    lines += [f"{len(f)} " + " ".join(map(str, f)) for f in faces]
    path.write_text("\n".join(lines))


def triangles(faces):
    return [(f[0], a, b) for f in faces for a, b in zip(f[1:], f[2:])]


def writeStl(path, blocks):
    lines = []
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        lines.append(f"solid block {n}")
        for triangle in triangles(faces):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corners.tolist()[k]) for k in triangle]
            lines += ["endloop", "endfacet"]
        lines.append("endsolid")
    path.write_text("\n".join(lines))


def writeByMeshio(path, blocks):
    points, faces = oneMesh(blocks)
    cells = [("triangle", np.array(triangles(faces), "i4"))]
    meshio.Mesh(np.array(points), cells).write(path, binary="bytes" in path.name)


def writeJson(path, blocks):
    nodes = {}
    for n, (corners, faces) in enumerate(surfaces(blocks)):
        places = [{a: v for a, v in zip("xyz", c) if v} for c in corners.tolist()]
        mesh = dict(attributes={"name": f"block {n}"})
        mesh["default_vertex_attributes"] = dict.fromkeys("xyz", 0.0)
        mesh["vertex"] = {str(k): place for k, place in enumerate(places)}
        mesh["face"] = {str(k): list(f) for k, f in enumerate(faces)}
        block = dict(dtype="compas_assembly.datastructures/Block", data=mesh)
        nodes[str(n)] = dict(block=block)
    kind = "compas_assembly.datastructures/Assembly"
    path.write_text(json.dumps(dict(dtype=kind, data=dict(graph=dict(node=nodes)))))


FORMATS = {
    "grouped.obj": writeObj,
    "plain.obj": lambda path, blocks: writeMesh(path, *oneMesh(blocks)),
    "relative.obj": lambda path, blocks: writeObj(path, blocks, relative=True),
    "many.off": writeOff,
    "text.stl": writeStl,
    "bytes.stl": writeByMeshio,
    "text.ply": writeByMeshio,
    "bytes.ply": writeByMeshio,
    "assembly.json": writeJson,
}


@mark.parametrize("name", FORMATS)
def test_every_format_gives_the_blocks_that_were_written(tmp_path, name):
    """Blocks that touch are distinguished also where all surfaces stand in one mesh. STL as bytes
    has single precision."""
    FORMATS[name](tmp_path / name, MODEL)
    read = fromFile(tmp_path / name)
    assert len(read) == len(MODEL) == len({b.brick for b in read})
    for one, two in zip(read, MODEL):
        assert len(one.corners) == len(two.corners)
        assert (*one.low, *one.high) == approx((*two.low, *two.high), abs=2e-6)
    assert read.volume == approx(MODEL.volume, rel=1e-5)
    assert [j[:2] for j in read.joints()] == [j[:2] for j in MODEL.joints()]
    named = name in ("grouped.obj", "text.stl", "assembly.json")
    assert read[5].part == ("block" if named else name.split(".")[0])
    assert {b.kind for b in read} == {"block"}


def test_objects_of_obj_are_groups_and_millimetres_are_scaled(tmp_path):
    writeObj(tmp_path / "a.obj", stack(2, (400.0, 200.0, 100.0)), "o")
    read = fromFile(tmp_path / "a.obj", scale=0.001, kind="brick")
    assert read.high == approx((0.4, 0.2, 0.2)) and read[1].part == "block"
    assert {b.kind for b in read} == {"brick"}


@mark.parametrize(
    "names, parts",
    [
        (("Stone#1", "Stone#2"), ("Stone", "Stone")),
        (("Mesh_0", "pier"), ("Mesh_0", "pier")),
        (("1", "2"), ("1", "2")),
        (("a 1", "a 1"), ("a 1", "a 1")),
    ],
)
def test_groups_of_one_stone_each_are_one_part(tmp_path, names, parts):
    text = ""
    for n, (name, block) in enumerate(zip(names, stack(2, (0.4, 0.2, 0.1)))):
        text += f"o {name}\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in block.corners)
        text += "".join(
            "f " + " ".join(str(8 * n + k + 1) for k in face) + "\n"
            for face in hull(np.array(block.corners))
        )
    (tmp_path / "a.obj").write_text(text)
    assert tuple(block.part for block in fromFile(tmp_path / "a.obj")) == parts


@given(angles=some.tuples(*2 * [some.floats(0, 1.5)]), digits=some.sampled_from([3, 4]))
@settings(max_examples=40, deadline=None)
def test_stones_in_space_with_few_decimals_have_plane_faces(tmp_path_factory, angles, digits):
    (c, s), (k, t) = [(math.cos(a), math.sin(a)) for a in angles]
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, k, -t], [0, t, k]]
    box = np.array(boxCorners((0, 0, 0), (0.6, 0.4, 0.3))) @ turn.T
    path = tmp_path_factory.mktemp("round") / "a.obj"
    lines = [f"v {x:.{digits}f} {y:.{digits}f} {z:.{digits}f}" for x, y, z in box]
    faces = ["f " + " ".join(str(n + 1) for n in face) for face in hull(box)]
    path.write_text("\n".join(lines + faces))
    [block] = fromFile(path)
    assert len(block.corners) == 8
    away = np.linalg.norm(box[:, None] - np.array(block.corners), axis=2)
    assert away.min(axis=1).max() < 2 * 10.0**-digits
    with raises(ValueError, match="bent by .* m, not plane|reaches"):
        twisted = box.copy()
        twisted[0] += 0.02
        path.write_text("\n".join([f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in twisted] + faces))
        fromFile(path)


def plyBytes(listed="vertex_indices", colours=(), order="<"):
    corners = boxCorners((0, 0, 0), (1, 1, 1))
    triangles = [(f[0], a, b) for f in hull(np.array(corners)) for a, b in zip(f[1:], f[2:])]
    name = {"<": "little", ">": "big"}[order]
    head = [f"ply\nformat binary_{name}_endian 1.0\ncomment by hand\nelement vertex 8"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += [f"element face {len(triangles)}", f"property list uchar int {listed}"]
    head += [f"property uchar {colour}" for colour in colours]
    body = b"".join(struct.pack(f"{order}3f", *p) for p in corners)
    body += b"".join(struct.pack(f"{order}B3i", 3, *t) + bytes(len(colours)) for t in triangles)
    return "\n".join([*head, "end_header\n"]).encode() + body


def stlBytes(more=b"", title=b"made by CAD"):
    corners = boxCorners((0, 0, 0), (1, 1, 1))
    triangles = [(f[0], a, b) for f in hull(np.array(corners)) for a, b in zip(f[1:], f[2:])]
    flat = [[c for n in t for c in corners[n]] for t in triangles]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *points, 0) for points in flat)
    return title.ljust(80) + struct.pack("<I", len(flat)) + body + more


@mark.parametrize(
    "name, content",
    [
        ("a.ply", plyBytes()),
        ("a.ply", plyBytes("vertex_index")),
        ("a.ply", plyBytes(colours=("red", "green", "blue"))),
        ("a.ply", plyBytes(order=">")),
        ("a.stl", stlBytes()),
        ("a.stl", stlBytes(b"\0\0")),
        ("a.stl", stlBytes(title=b"solid made by CAD")),
    ],
)
def test_files_as_programs_write_them(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    [block] = fromFile(tmp_path / name)
    assert (block.low, block.high) == ((0, 0, 0), (1, 1, 1))
    (tmp_path / name).write_bytes(content[:-20])
    with raises(ValueError) as refused:
        fromFile(tmp_path / name)
    assert str(refused.value).isprintable()


def test_faces_may_all_run_clockwise(tmp_path):
    points, faces = oneMesh(MODEL)
    writeMesh(tmp_path / "a.obj", points, [f[::-1] for f in faces])
    assert fromFile(tmp_path / "a.obj").volume == approx(MODEL.volume)


def test_points_inside_faces_and_edges_are_no_corners(tmp_path):
    """The top of a cube in four squares about its middle, whose outer points lie on the edges of
    the sides."""
    ring = [(0, 0), (0.5, 0), (1, 0), (1, 0.5), (1, 1), (0.5, 1), (0, 1), (0, 0.5)]
    points = [(x, y, 1) for x, y in ring] + [(x, y, 0) for x, y in ring[::2]]
    faces = [(11, 10, 9, 8)]
    for n in range(4):
        faces += [(8 + n, 8 + (n + 1) % 4, (2 * n + 2) % 8, 2 * n + 1, 2 * n)]
    faces += [(n, n + 1, 12, (n - 1) % 8) for n in range(0, 8, 2)]
    writeMesh(tmp_path / "a.obj", [*points, (0.5, 0.5, 1)], faces)
    (block,) = fromFile(tmp_path / "a.obj")
    assert sorted(block.corners) == sorted(stack(1, (1.0, 1.0, 1.0))[0].corners)


CUBE = oneMesh(stack(1, (1.0, 1.0, 1.0)))
ELL = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
#: A prism over an L, as one solid.
ENDS = [(5, 4, 3, 2, 1, 0), (6, 7, 8, 9, 10, 11)]
SIDES = [(n, (n + 1) % 6, (n + 1) % 6 + 6, n + 6) for n in range(6)]
PRISM = [(x, y, float(z)) for z in (0, 1) for x, y in ELL], ENDS + SIDES
NOT_CONVEX = r"a, solid 0, face 4 at \(1.500, 1.000, 0.500\) m: the solid reaches 1 m"


@mark.parametrize(
    "points, faces, said",
    [
        (*PRISM, NOT_CONVEX),
        (CUBE[0], CUBE[1][:-1], r"a, face \d: an edge at .* the solid is open"),
        (CUBE[0], [*CUBE[1][:-1], CUBE[1][-1][::-1]], "run in different senses"),
        ([*CUBE[0][:-1], (1, 1, 1.1)], CUBE[1], "a, solid 0, face . .* bent by 0"),
        ([(1e300, 0, 0), *CUBE[0][1:]], CUBE[1], "of 1e[+]300 m is above 1e[+]06 m"),
    ],
)
def test_what_is_no_convex_solid_is_refused(tmp_path, points, faces, said):
    writeMesh(tmp_path / "a.obj", points, faces)
    with raises(ValueError, match=said):
        fromFile(tmp_path / "a.obj")


@mark.parametrize(
    "name, text, said",
    [
        ("a.obj", "", "no faces, so no solids"),
        ("a.obj", "v 0 0 0\nf 1 2 3", "line 2: face with point 2, of 1 so far"),
        ("a.obj", "v 0 0 nan", "line 1: 0 0 nan is no point of three finite numbers"),
        ("a.obj", "v 0 0", "line 1: 0 0 is no point"),
        ("a.obj", "v 0 0 0\nf 1 1 1", "no faces"),
        ("a.off", "COFF\n", "COFF is a variant"),
        ("a.off", "hello", "does not start with OFF"),
        ("a.off", "OFF\n8 6 0\n0 0 0", "8 points and 6 faces are told"),
        ("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 7", "a face with points"),
        ("a.stl", "hello", "neither text that starts with solid"),
        ("a.stl", "solid a\nvertex 0 0 0\nendsolid", "a facet without three points"),
        ("a.stl", "solid a\nvertex 0 0 0", "solid a has no end"),
        ("a.ply", "hello", "does not start with ply"),
        ("a.ply", "ply\n", "its head has no end"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n1",
            "its faces have no vertex_indices",
        ),
        ("a.json", "{", "cannot be read"),
        ("a.json", "{}", "no mesh"),
        ("a.json", '{"vertex": {"0": {}}, "face": {"0": [0, 1]}}', "vertex 1 that is"),
        ("a.json", '{"vertex": {"0": {"x": "high"}}, "face": {}}', "no point of three"),
        ("a.step", "", "must end with one of .obj"),
        ("missing.obj", None, "no such file"),
    ],
)
def test_a_file_without_solids_is_refused(tmp_path, name, text, said):
    if text is not None:
        (tmp_path / name).write_text(text)
    with raises(ValueError, match=said):
        fromFile(tmp_path / name)


@settings(max_examples=150)
@given(some.data())
def test_a_damaged_file_is_read_or_refused(tmp_path_factory, data):
    name = data.draw(some.sampled_from(sorted(FORMATS.keys() - {"bytes.stl"})))
    path = tmp_path_factory.mktemp("damaged") / name
    FORMATS[name](path, stack(2, (0.4, 0.2, 0.1)))
    content = bytearray(path.read_bytes())
    at = data.draw(some.integers(0, len(content) - 1))
    content[at : at + 1] = data.draw(some.binary(max_size=2))
    path.write_bytes(content)
    try:
        assert isinstance(fromFile(path), Bricks)
    except ValueError as error:
        assert str(path) in str(error)
