# SPDX-License-Identifier: GPL-2.0-or-later
"""Points of the joints of a scene: ``--points``, in the plane along a joint, in space along each
side of its face."""

from hosted import *

#: The points of Gauss and Lobatto between 0 and 1.
RULES = {3: [0, 0.5, 1], 5: [0, 0.5 - (3 / 28) ** 0.5, 0.5, 0.5 + (3 / 28) ** 0.5, 1]}


def strip(folder, *words, plane=False, courses=6):
    """A pile of bricks between platens that cannot turn, pressed by 0.2 MPa."""
    blocks = bricks.stack(courses, UNIT)
    scene = standing(folder, blocks, materials.calciumSilicate(), *words, plane=plane)
    guided = "x" if plane else "xy"
    scene.press(scene.platen("top", rotation="held", guided=guided), 0.2e6)
    return scene


def bedPoints(scene):
    """The points of a bed joint between two bricks [m]."""
    scene.begin()
    ids = scene.model.ids
    pair = {ids[2], ids[3]}
    (joint,) = (i for i in scene.model.interactions if {i.id1, i.id2} == pair)
    scene.finish()
    return joint.geom.centres


def apart(values):
    """Different values, but for round-off."""
    return sorted({round(v, 9) for v in values})


@mark.parametrize("words, count", [((), 3), (("--points", "5"), 3), (("--points", "5,5"), 5)])
def test_joints_in_space_begin_with_points_along_both_sides(tmp_path, words, count):
    points = bedPoints(strip(tmp_path, *words))
    assert len(points) == count**2
    for axis in (0, 1):
        places = apart((p[axis] - points[0][axis]) / UNIT[axis] for p in points)
        expected = [v + min(places) for v in RULES[count]]
        assert places == approx(expected, abs=1e-8)


def test_a_scene_in_the_plane_has_one_row(tmp_path):
    points = bedPoints(strip(tmp_path, "--points", "5,5", plane=True))
    assert len(points) == 5 and len(apart(p[1] for p in points)) == 1


def test_a_strip_that_bends_cracks_at_a_force_that_settles_with_more_points(tmp_path):
    """With three rows the middle of a joint, with two thirds of its area, cracks at once, and a
    quarter too late."""
    peaks = {}
    for points in (None, "3", "5", "9,9"):
        words = ["--points", points] if points else []
        bent = strip(tmp_path / str(points), *words, courses=8)
        middle = bent.handle(4, name="middle")
        bent.settle()
        bent.push(middle, 0.4, direction=(0, 1, 0))
        bent.finish()
        peaks[points] = readRun(tmp_path / str(points))["peak_base_shear_kN"]
    assert peaks[None] == approx(peaks["9,9"], rel=0.03)
    assert 1.15 < peaks["3"] / peaks["9,9"] < 1.4
    assert peaks["5"] == approx(peaks["9,9"], rel=0.03)


@mark.parametrize(
    "words, plane, message",
    [
        (
            ("--points", "5", "--blocks", "deformable"),
            False,
            "--points 5: joints of deformable units have the points of",
        ),
        (("--points", "2"), False, "--points: 2 must be a whole number from 3 to 100"),
        (("--points", "12,4,4"), True, "'12,4,4' must be one or two whole numbers"),
        (
            ("--points", "5,6"),
            True,
            "'5,6': a joint cannot have fewer points from when it yields than before",
        ),
    ],
)
def test_points_that_do_nothing_are_refused(tmp_path, capsys, words, plane, message):
    with raises(SystemExit) as refused:
        refusing = strip(tmp_path, *words, plane=plane)
        refusing.settle()
    assert refused.value.code == 2
    assert message in str(refused.value) + capsys.readouterr().err


@mark.parametrize("divisions", ["1", "2"])
def test_deformable_units_have_points_at_faces_and_thirds(tmp_path, divisions):
    words = "--blocks", "deformable", "--divisions", divisions
    points = bedPoints(strip(tmp_path, *words))
    places = apart(p[1] / UNIT[1] for p in points)
    assert [v - min(places) for v in places] == approx([0, 1 / 3, 2 / 3, 1])
