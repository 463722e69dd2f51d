# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawn stones become a wall whose joints lie in the middle of the mortar, whatever file they come
from."""

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
        (
            "a.svg",
            '<svg><path id="p" d="M 0 0 C 1 1 2 2 3 3 Z"/></svg>',
            "path p has the command 'C', a curve",
        ),
        ("a.svg", '<svg><circle id="p" r="1"/></svg>', "circle p is a curve"),
        (
            "a.svg",
            '<svg><g transform="rotate(3)"><rect width="1" height="1"/></g></svg>',
            "rotate is not known",
        ),
        ("a.svg", "<svg>", "cannot be read"),
        ("a.csv", "1,0,0\n1,1,1\n1,1,0\n1,0,1", r"1 crosses itself near \(0.500, 0.500\) m"),
        ("a.csv", "s,0,0\ns,1", "line 2"),
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
