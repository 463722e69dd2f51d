# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawn stones become a wall whose joints lie in the middle of the mortar, whatever file they come
from."""

import json
import math
from collections import Counter

from hosted import *
from masonry import bricks, materials
from masonry.bricks.stones import mortar, polygons
import ezdxf


def front(block):
    face = np.array([c for c in block.corners if c[1] == 0])[:, [0, 2]]
    return face[np.argsort(np.arctan2(*(face - face.mean(axis=0)).T[::-1]))]


def shrunk(ring, gap, size):
    """A convex polygon without half a gap at all sides but those of the wall."""
    along = np.roll(ring, -1, axis=0) - ring
    inward = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    middles = ring + along / 2
    at = np.isclose(middles, 0) | np.isclose(middles, size)
    offsets = (inward * ring).sum(axis=1) + np.where(at.any(axis=1), 0, gap / 2)
    return np.array(
        [np.linalg.solve(inward[[n - 1, n]], offsets[[n - 1, n]]) for n in range(len(ring))]
    )


def drawn(wall, gap):
    return [shrunk(front(b), gap, (wall.length, wall.height)) for b in wall]


def asCsv(path, rings):
    lines = [
        f"{n},{x!r},{z!r}"
        for n, ring in enumerate(rings)
        for x, z in np.asarray(ring, float).tolist()
    ]
    path.write_text("\n".join(["stone,x,z", *lines]))


def asSvg(path, rings):
    # down is positive, in mm, in a group that is moved
    paths = ""
    for n, ring in enumerate(rings):
        corners = (f"{1e3 * x - 7!r},{5 - 1e3 * z!r}" for x, z in np.asarray(ring).tolist())
        paths += f'<path id="s{n}" d="M {" ".join(corners)} z"/>'
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><g transform="translate(7 -5)'
        f' scale(0.001)">{paths}</g></svg>'
    )


def asGeoJson(path, rings):
    polygons = [[[*map(list, ring), list(ring[0])]] for ring in np.asarray(rings, object)]
    features = [
        dict(type="Feature", properties={}, geometry=dict(type="Polygon", coordinates=p))
        for p in polygons
    ]
    path.write_text(json.dumps(dict(type="FeatureCollection", features=features)))


def asDxf(path, rings):
    document = ezdxf.new()
    for ring in rings:
        document.modelspace().add_lwpolyline(
            np.asarray(ring).tolist(), close=True, dxfattribs={"layer": "stones"}
        )
    document.modelspace().add_circle((3, 3), 1)
    document.saveas(path)


FORMATS = {".csv": asCsv, ".svg": asSvg, ".geojson": asGeoJson, ".dxf": asDxf}


@mark.parametrize("seed", range(8))
def test_a_wall_that_is_drawn_with_mortar_comes_back(tmp_path, seed):
    ending, gap = sorted(FORMATS)[seed % 4], 0.005 + 0.0025 * seed
    wall = bricks.StoneWall(1.2, 0.9, (0.3, 0.3, 0.18), "irregular", seed=seed)
    rings = drawn(wall, gap)
    path = tmp_path / f"stones{ending}"
    FORMATS[ending](path, rings)
    layer = "stones" if ending == ".dxf" else None
    back = bricks.fromOutlines(path, thickness=0.3, mortar=0.03, layer=layer)
    assert back.volume == approx(wall.volume, rel=1e-9)
    assert back.high == approx((1.2, 0.3, 0.9), abs=1e-9)
    assert not [p for p in back.problems() if "odd size" not in p and "sliver" not in p]
    assert len({b.brick for b in back}) == len(wall)
    assert back.mortar == approx(gap, abs=0.03 / 16)
    tolerance = 0.03 / 4
    for n, ring in enumerate(rings):
        parts = [front(b) for b in back if b.brick == n]
        grid = np.stack(
            np.meshgrid(*np.linspace(ring.min(axis=0), ring.max(axis=0), 60).T), axis=-1
        ).reshape(-1, 2)
        own = grid[polygons.inside(grid, ring)]
        kept = np.any([polygons.inside(own, part) for part in parts], axis=0)
        lost = (1 - kept.mean()) * polygons.area(ring)
        perimeter = np.linalg.norm(np.roll(ring, 1, axis=0) - ring, axis=1).sum()
        assert lost < tolerance / 2 * perimeter


def read(tmp_path, rings, mortar=0.02, **settings):
    asCsv(tmp_path / "stones.csv", rings)
    return bricks.fromOutlines(tmp_path / "stones.csv", thickness=0.2, mortar=mortar, **settings)


def box(x, z, width, height):
    return [(x, z), (x + width, z), (x + width, z + height), (x, z + height)]


def test_joints_of_bricks_lie_in_the_middle_of_the_mortar(tmp_path):
    wall = bricks.Wall(1.0, 0.5, unit=(0.25, 0.2, 0.1), halves=False)
    back = read(tmp_path, drawn(wall, 0.012))
    assert len(back) == len(wall) and len(back.joints()) == len(wall.joints())
    for one, other in zip(wall, back):
        assert np.allclose(one.low, other.low, atol=1e-3) and np.allclose(
            one.high, other.high, atol=1e-3
        )
    assert back.unit == approx(((5 - 17 * 0.012) / 22, 0.2, 0.1 - (14 + 8 / 2) * 0.012 / 22))


def test_stones_that_touch_are_two_blocks(tmp_path):
    rings = [[(x, 0), (x + 1, 0), (x + 1, 0.5), (x, 0.5)] for x in (0.0, 1.0)]
    back = read(tmp_path, rings)
    assert len(back) == 2 and back.volume == approx(1.0 * 0.2)


def test_mortar_of_two_thicknesses_and_the_stiffness_of_its_joints(tmp_path):
    back = read(tmp_path, [box(0, 0, 1, 0.2), box(0, 0.21, 1, 0.2), box(0, 0.44, 1, 0.2)], 0.04)
    assert back.mortar == approx(0.02, rel=0.02)
    assert back.thickness(0.5, 0.1, 0.205) == approx(0.01, rel=0.02)
    assert back.thickness(0.5, 0.1, 0.425) == approx(0.03, rel=0.02)
    stone = materials.masonry(
        E=1e9,
        unit_E=2e10,
        fc=2e6,
        fv0=1e5,
        friction=0.6,
        ft=5e4,
        unit=(1, 0.2, 0.2),
        joint=back.mortar,
        density=2200,
    )
    kn, Gc = stone.joints["bed"].normalStiffness, stone.joints["bed"].compressiveFractureEnergy
    rule = back.withMortar(stone).rule(dict(enumerate(back)))
    for z, factor in ((0.205, 2), (0.425, 2 / 3)):
        geom = SimpleNamespace(centres=[(0.5, 0.1, z)], normal=(0, 0, 1))
        joint = rule(SimpleNamespace(id=0), SimpleNamespace(id=1), geom)
        assert joint.normalStiffness == approx(factor * kn, rel=0.03)
        assert joint.compressiveFractureEnergy == approx(Gc / factor, rel=0.03)


def test_a_stone_that_is_not_convex_is_several_blocks_of_one_brick(tmp_path):
    ell = [(0, 0), (1, 0), (1, 0.3), (0.4, 0.3), (0.4, 0.6), (0, 0.6)]
    back = read(tmp_path, [ell, box(0.41, 0.31, 0.59, 0.29)])
    assert sorted(Counter(b.brick for b in back).values()) == [1, 2]
    assert not back.problems()
    assert back.volume == approx(0.6 * 0.2, rel=1e-9)


def test_a_window_stays_open_and_is_named(tmp_path, capsys):
    wall = bricks.Wall(2.0, 1.0, unit=(0.25, 0.2, 0.1), halves=False)
    rings = [
        r
        for r in drawn(wall, 0.01)
        if not (0.6 < r.mean(axis=0)[0] < 1.4 and 0.3 < r.mean(axis=0)[1] < 0.7)
    ]
    back = read(tmp_path, rings)
    area = 4.0 * 0.2 * 0.5 - back.volume
    assert 0.2 * 0.8 * 0.3 < area < 0.2 * 0.9 * 0.5
    assert re.search(r"a hole of .* near \(\d\.\d+, 0\.5\d+\) m", capsys.readouterr().out)


ROW = [box(0, 0, 0.3, 0.2), box(0.31, 0, 0.3, 0.2), box(0.62, 0, 0.3, 0.2)]


@mark.parametrize(
    "more, what, left",
    [
        ([box(0.605, 0.05, 0.01, 0.004)], r"3 near \(0.610, 0.052\) m is a sliver", 3),
        ([box(0.9, 0, 0.3, 0.2)], r"2 and 3 overlap by 0.02 m near \(0.9\d+, 0.\d+\) m", 4),
        ([box(0.35, 0.05, 0.1, 0.1)], r"3 near \(0.400, 0.100\) m lies within 1", 3),
        (ROW[:1], "3 .* lies within 0", 3),
    ],
)
def test_what_can_be_mended(tmp_path, capsys, more, what, left):
    with raises(ValueError, match=f"(?s){what}.*mend=True does so"):
        read(tmp_path, ROW + more)
    back = read(tmp_path, ROW + more, mend=True)
    assert re.search(f"note: fromOutlines: {what}", capsys.readouterr().out)
    assert len(back) == left and not back.problems()
    assert back.volume == approx((back.high[0] - back.low[0]) * 0.2 * 0.2)


def test_an_open_line_is_closed(tmp_path):
    path = tmp_path / "stones.svg"
    path.write_text(
        '<svg><polyline id="a" points="0,0 1,0 1,1 0,1"/><rect id="b" x="1.01" width="1"'
        ' height="1"/></svg>'
    )
    with raises(ValueError, match=r"a is open between \(0.000, 0.000\) m and \(0.000, 1.000\) m"):
        bricks.fromOutlines(path, thickness=0.2, mortar=0.02)
    back = bricks.fromOutlines(path, thickness=0.2, mortar=0.02, mend=True)
    assert len(back) == 2 and len(back.joints()) == 1


def test_paths_of_svg_in_groups(tmp_path):
    path = tmp_path / "stones.svg"
    path.write_text(
        '<svg><g id="x"><path d="M0 0H9V9H0Z"/></g><g id="y" transform="matrix(0 1 1 0 0 0)"><path'
        ' d="m1,1 h2 v-1l-2 0zm2.01 0 l0-1 1 0 0 1z"/></g></svg>'
    )
    back = bricks.fromOutlines(path, thickness=0.2, mortar=0.02, layer="y")
    assert back.high == approx((1, 0.2, 3.01)) and len(back) == 2


@mark.parametrize(
    "name, text, what",
    [
        ("a.svg", "<svg>", "cannot be read"),
        ("a.csv", "1,0,0\n1,1,1\n1,1,0\n1,0,1", r"1 crosses itself near \(0.500, 0.500\) m"),
        ("a.csv", "s,0,0\ns,1", "line 2"),
        ("a.csv", "s,0,O\ns,1,0\ns,1,1", "line 1: 'O' is not a number"),
        ("a.csv", "s,0,0\ns,0,0\ns,0,0", "outline s has not three corners"),
        ("a.csv", "s,x,y,z\ns,0,0,0", "the columns s, x, y, z must be a name, x and z"),
        ("a.svg", '<svg><rect width="50%" height="2"/></svg>', "width '50%' is no length"),
        ("a.svg", '<svg><rect width="1e300" height="1e300"/></svg>', "more than 2000000 points"),
        (
            "a.csv",
            "s,0,0\ns,480,0\ns,480,280",
            "a stone of 480 m must be at most 1000 times mortar",
        ),
        ("a.svg", '<svg><rect id="r" width="-1" height="1"/></svg>', "rect r: its width or height"),
        ("a.svg", '<svg><polygon id="p" points="0,0 1,0 1"/></svg>', "p: its points are not pairs"),
        ("a.svg", '<svg><path id="p" d="M0,0 L4"/></svg>', "path p: 'L' takes 2 numbers each"),
        ("a.svg", '<svg><path id="p" d="M0,0 K4"/></svg>', "path p has the command 'K'"),
        ("a.svg", "<svg><text>9</text></svg>", "no outlines, only 1 text"),
        ("a.geojson", f'{{"type": "Polygon", "coordinates": [{"["*2000}]}}', "cannot be read"),
        ("a.geojson", '{"type": "Polygon", "coordinates": [[[null, 0]]]}', "corner 0 is no place"),
        ("a.geojson", '{"type": "Polygon", "coordinates": []}', "feature 0 has no ring"),
        ("a.geojson", '{"type": "Feature", "geometry": null}', "1 features without geometry"),
        (
            "a.geojson",
            '{"type": "Polygon", "coordinates": [[[7.1, 46], [7.101, 46], [7.1, 46.001]]]}',
            "is in degrees of longitude and latitude",
        ),
        (
            "a.geojson",
            '{"type": "Polygon", "coordinates": [[[0,0,0],[9,0,0],[9,9,0],[0,9,5]]]}',
            "the drawing is not in one plane",
        ),
        ("a.csv", "stone,x,z", "no outlines"),
        ("a.geojson", '{"type": "Point", "coordinates": [0, 0]}', "feature 0 is a Point"),
        ("a.dxf", "nonsense", "cannot be read"),
        ("a.txt", "", "must end with one of"),
    ],
)
def test_what_is_refused(tmp_path, name, text, what):
    (tmp_path / name).write_text(text)
    with raises(ValueError, match=what):
        bricks.fromOutlines(tmp_path / name, thickness=0.2, mortar=0.02)


WIDTH, HEIGHT = 480, 280
PLACES = [(500 * i, 300 * j) for j in range(3) for i in range(3)]


def outline(x=0, z=0):
    return [(x, z), (x + WIDTH, z), (x + WIDTH, z + HEIGHT), (x, z + HEIGHT)]


def asInsert(space, place):
    space.add_blockref("STONE", place)


def asMirroredInsert(space, place):
    x, z = place
    space.add_blockref("STONE", (x + WIDTH, z), dxfattribs=dict(xscale=-1))


def asLines(space, place):
    ring = outline(*place)
    for one, other in zip(ring, ring[1:] + ring[:1]):
        space.add_line(other, one)


def asLineAndPolyline(space, place):
    ring = outline(*place)
    space.add_lwpolyline(ring)
    space.add_line(ring[0], ring[-1])


def asHatch(space, place):
    space.add_hatch().paths.add_polyline_path(outline(*place), is_closed=True)


def asFilledOutline(space, place):
    space.add_lwpolyline(outline(*place), close=True)
    asHatch(space, place)


def asFace(space, place):
    space.add_3dface([(*point, 0) for point in outline(*place)])


def asSolid(space, place):
    a, b, c, d = outline(*place)
    space.add_solid([a, b, d, c])


@mark.parametrize(
    "draw",
    [
        *(asInsert, asMirroredInsert, asLines, asLineAndPolyline),
        *(asHatch, asFilledOutline, asFace, asSolid),
    ],
)
@mark.parametrize("unit, scale", [(4, None), (0, 0.001)])
def test_entities_of_dxf_that_draw_one_stone(tmp_path, capsys, draw, unit, scale):
    document = ezdxf.new("R2010")
    document.units = unit
    space = document.modelspace()
    document.blocks.new("STONE").add_lwpolyline(outline(), close=True)
    document.layers.add("off").off()
    for place in PLACES[:8]:
        space.add_lwpolyline(outline(*place), close=True)
    draw(space, PLACES[8])
    space.add_text("a wall")
    space.add_lwpolyline(outline(3000, 0), close=True, dxfattribs=dict(layer="off"))
    document.saveas(tmp_path / "a.dxf")
    wall = bricks.fromOutlines(tmp_path / "a.dxf", thickness=0.3, mortar=0.025, scale=scale)
    assert len({block.brick for block in wall}) == 9
    assert wall.volume == approx(1.48 * 0.88 * 0.3)
    assert "left out: 1 LWPOLYLINE in hidden layers, 1 TEXT" in capsys.readouterr().out


def test_what_dxf_has_of_a_wall_and_cannot_be_read_is_named(tmp_path):
    document = ezdxf.new("R2010")
    document.modelspace().add_lwpolyline(outline(), close=True)
    with document.modelspace().add_mesh().edit_data() as mesh:
        mesh.vertices, mesh.faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]
    document.saveas(tmp_path / "a.dxf")
    with raises(ValueError, match="1 MESH would be left out: make them outlines"):
        bricks.fromOutlines(tmp_path / "a.dxf", thickness=0.3, mortar=0.025)


RECTS = "".join(
    f'<rect id="r{n}" x="{x}" y="{z}" width="480" height="280"/>' for n, (x, z) in enumerate(PLACES)
)


@mark.parametrize(
    "body, head",
    [
        (RECTS, 'width="1480mm" viewBox="0 0 1480 880"'),
        (RECTS.replace('width="480"', 'width="480px"'), ""),
        (f'<g transform="rotate(90)">{RECTS}</g>', ""),
        (f'<g style="display:none">{RECTS.replace("480", "9")}</g>{RECTS}', ""),
        (f'<g visibility="hidden">{RECTS.replace("480", "9")}</g>{RECTS}', ""),
        (f'<symbol id="s">{RECTS}</symbol><use xlink:href="#s"/>', ""),
        (f'<defs>{RECTS}</defs>{"".join(f"""<use href="#r{n}"/>""" for n in range(9))}', ""),
        (f'<svg x="7" y="8">{RECTS}</svg>', ""),
        (
            "".join(
                f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}"/>'
                for x, z in PLACES
                for (a, b), (c, d) in zip(outline(x, z), outline(x, z)[1:] + outline(x, z)[:1])
            ),
            "",
        ),
        (RECTS.replace('width="480"', 'width="480" rx="0"'), ""),
    ],
)
def test_elements_of_svg_that_draw_nine_stones(tmp_path, body, head):
    names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    (tmp_path / "a.svg").write_text(f"<svg {names} {head}>{body}<text>a wall</text></svg>")
    scale = None if head else 0.001
    wall = bricks.fromOutlines(tmp_path / "a.svg", thickness=0.3, mortar=0.025, scale=scale)
    assert len({block.brick for block in wall}) == 9
    assert wall.volume == approx(1.48 * 0.88 * 0.3)


def test_curves_of_svg_are_chords(tmp_path):
    (tmp_path / "a.svg").write_text('<svg><circle id="c" r="1"/></svg>')
    wall = bricks.fromOutlines(tmp_path / "a.svg", thickness=1, mortar=0.02, tolerance=0.001)
    assert wall.volume == approx(math.pi, rel=0.01)  # flat where it meets its box


def test_a_wall_in_space_is_that_in_its_plane(tmp_path):
    plane = tmp_path / "plane.geojson"
    asGeoJson(plane, [0.001 * np.array(outline(*place), float) for place in PLACES])
    data = json.loads(plane.read_text())
    for feature in data["features"]:
        for ring in feature["geometry"]["coordinates"]:
            ring[:] = [[4e5 + 0.6 * x, 5e6 + 0.8 * x, 400 + z] for x, z in ring]
    (tmp_path / "space.geojson").write_text(json.dumps(data))
    made = [
        bricks.fromOutlines(tmp_path / f"{name}.geojson", thickness=0.3, mortar=0.025)
        for name in ("plane", "space")
    ]
    assert [len(wall.joints()) for wall in made] == [12, 12]
    for one, other in zip(*made):
        assert np.array(other.corners).mean(axis=0) == approx(np.array(one.corners).mean(axis=0))


@mark.parametrize("flip", [(-1, 1), (1, -1), (-1, -1)])
@mark.parametrize("seed", [3, 5])
def test_a_mirrored_drawing_gives_the_mirrored_wall(tmp_path, flip, seed):
    """Also in another order of stones and corners, and in mm."""
    wall = bricks.StoneWall(1.5, 1.0, (0.3, 0.2, 0.2), "irregular", seed=seed)
    rings = drawn(wall, 0.015)
    asCsv(tmp_path / "one.csv", rings)
    asCsv(tmp_path / "other.csv", [np.roll(1000 * ring * flip, 2, axis=0) for ring in rings[::-1]])
    one, other = (
        bricks.fromOutlines(tmp_path / f"{name}.csv", thickness=0.2, mortar=0.02, scale=scale)
        for name, scale in (("one", 1), ("other", 0.001))
    )
    size = np.array([one.length, 0, one.height])
    keep, sign = np.array([flip[0], 1, flip[1]]) < 0, np.array([flip[0], 1, flip[1]])
    expected = sorted(
        sorted(tuple(np.round(np.where(keep, size, 0) + sign * c, 7)) for c in block.corners)
        for block in one
    )
    found = sorted(sorted(tuple(np.round(c, 7)) for c in block.corners) for block in other)
    assert len(found) == len(expected)
    assert np.array(sum(found, [])) == approx(np.array(sum(expected, [])), abs=1e-6)


@given(some.lists(some.floats(0.3, 1.0), min_size=4, max_size=14))
@settings(max_examples=30, deadline=None)
def test_convex_parts_make_up_the_polygon(radii):
    turn = 2 * np.pi * np.arange(len(radii)) / len(radii)
    ring = np.array(radii)[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    parts = polygons.convexParts(ring)
    assert sum(map(polygons.area, parts)) == approx(polygons.area(ring), rel=1e-4)
    assert all((polygons.turns(part) > 0).all() for part in parts)


@mark.parametrize(
    "wall",
    [
        bricks.Wall(0.88, 0.36, unit=(0.22, 0.1, 0.06), halves=False),
        bricks.Arch(2.0, 0.3, 9, radius=1.0),
        bricks.StoneWall(1.2, 0.9, (0.3, 0.3, 0.18), "irregular", seed=3),
        bricks.Dome(2, 0.3, 4, 8),
    ],
    ids=["wall", "arch", "stones", "dome"],
)
def test_solids_with_mortar_between_them_meet_in_its_middle(tmp_path, wall):
    lines, start = [], 1
    for block in wall:
        small = mortar._grown(*_inset(np.array(block.corners), 0.005))
        faces = bricks.geometry.hull(small)
        lines += [f"g {start}", *("v {!r} {!r} {!r}".format(*c) for c in small)]
        lines += ["f " + " ".join(str(start + k) for k in face) for face in faces]
        start += len(small)
    (tmp_path / "a.obj").write_text("\n".join(lines))
    apart, back = (bricks.fromFile(tmp_path / "a.obj", mortar=m) for m in (0.0, 0.012))
    assert not apart.joints() and not back.problems()
    assert len(back.joints()) == len(wall.joints())
    for one, other in zip(wall.joints(), back.joints()):
        assert abs(np.array(one.normal) @ other.normal) > 1 - 1e-6
        assert abs((np.array(one.middle) - other.middle) @ one.normal) < 1e-6


def _inset(corners, by):
    """Arguments with which a solid is drawn smaller on all sides [m]."""
    solids = bricks.geometry.Solids([corners])
    group = solids.groups[0]
    planes = {
        (0, n): (normal, offset - by)
        for n, (normal, offset) in enumerate(zip(group.normals[0], group.offsets[0]))
    }
    return solids, 0, corners, planes
