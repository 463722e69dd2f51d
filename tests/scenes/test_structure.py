# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of one's own: stages, how they end, closed forms of what they measure, and what they
refuse."""

from hosted import *
from masonry.run.results import Results
from small_wall import SMALL, carryOut, parsed

STONE = 2600 * 9.81  # [N/m³]


THREE = bricks.stack(3, (0.4, 0.3, 0.2))
TWO = bricks.stack(2, (0.4, 0.3, 0.2))


def last(scene, name):
    return scene.results.column(name)[-1]


def small(folder, *words, press=1e5, push=0.05):
    """Three stones that are pressed and pushed."""
    words = ["--no-vtk", "--out", str(folder), *words]
    scene = Scene("small", THREE, materials.dry(), arguments=words)
    scene.platen("bottom")
    top = scene.platen("top")
    scene.press(top, press)
    scene.settle()
    scene.rowsAtRest = len(scene.results.column("time_s"))
    scene.push(top, push)
    return scene, top


def test_the_drive_stops_when_its_stage_ends(tmp_path):
    scene, top = small(tmp_path)
    scene.run(0.05)
    answer = next(a for a in scene.answers if a["name"].endswith("_x_at_the_end"))
    assert answer["unit"] == "mm"
    assert answer["value"] == approx(last(scene, "top_x_mm"))
    scene.lean(0.02)
    assert last(scene, "top_x_mm") == approx(0.05, abs=0.01)


def test_a_platen_presses_what_it_touches(tmp_path):
    blocks = bricks.Corner(1.1, 0.88, 0.486, halves=False)
    scene = standing(tmp_path, blocks, materials.dry(normalStiffness=5e10))
    scene.press(scene.platen("top", part="wall"), 1e5)
    assert scene.settle() == AT_REST
    tops = [b for b in blocks.top() if b.part == "wall"]
    area = sum((b.high[0] - b.low[0]) * (b.high[1] - b.low[1]) for b in tops)
    carried = -1e3 * last(scene, "base_force_z_kN")
    assert carried == approx(1e5 * area + STONE * blocks.volume, rel=6e-3)


def test_a_guided_platen_has_its_share_of_the_force(tmp_path):
    scene = standing(tmp_path, THREE)
    scene.press(scene.platen("top", guided="x"), 1e5)
    scene.settle()
    assert scene.lean(0.2) == AT_REST
    both = last(scene, "base_force_x_kN") + last(scene, "top_force_x_kN")
    assert both == approx(1e-3 * 0.2 * STONE * 0.4 * 0.3 * 0.6, rel=0.01)
    assert last(scene, "base_shear_kN") == approx(both, rel=1e-6)


def test_a_resumed_script_has_the_same_words_and_rows(tmp_path, capsys):
    whole, _ = small(tmp_path)
    whole.finish()
    assert 0 < whole.rowsAtRest < len(whole.results.rows)
    with raises(SystemExit, match="2"):
        small(tmp_path, "--resume", str(tmp_path), press=2e5)
    assert "the script said" in capsys.readouterr().err
    scene, _ = small(tmp_path, "--resume", str(tmp_path), push=0.08)  # farther
    assert scene.rowsAtRest == whole.rowsAtRest
    assert last(scene, "displacement_mm") == approx(0.08, abs=0.01)


def test_two_scenes_at_once_are_refused(tmp_path):
    one, _ = small(tmp_path / "one")
    small(tmp_path / "two")
    with raises(ValueError, match="scene small is gone"):
        one.lean(0.1)


def varied(scene):
    scene.platen("bottom")
    scene.masonry.vary("bed.cohesion", lambda x, y, z: 0.3)
    scene.settle()


def notGrown(scene):
    scene.platen("bottom")
    top = scene.platen("top")
    scene.press(top, 1e5)
    scene.push(top, 1)


@mark.parametrize(
    "act, message",
    [
        (lambda s: s.platen("bottom", rotation="free"), "the bottom is fixed"),
        (lambda s: s.press(s.platen("bottom"), 1), "'base' must be a platen .* moves"),
        (lambda s: s.press(s.platen("top"), 0, friction=0.1), "machine must be above 0"),
        (lambda s: s.hold(99), "where 99: there are 3 bricks"),
        (lambda s: s.hold((9, 9, 9)), "no brick is near"),
        (lambda s: [s.hold(n, name="a") for n in (0, 1)], "two targets of the name"),
        (lambda s: s.load(s.platen("top"), (0, 9, 0)), "is in the x-z plane"),
        (lambda s: s.hold(0, axes="y"), "no block moves along y"),
        (lambda s: s.wind(0, (1, 0, 0)), "pressure 0 Pa must be other than 0"),
        (notGrown, r"the loads on top grow in settle\(\)"),
        (varied, r"vary: at \(.*\) m: joint \"bed\": tensile"),
    ],
)
def test_wrong_words_before_the_first_stage_are_refused(tmp_path, act, message):
    with raises(ValueError, match=message):
        act(lean(tmp_path, THREE, materials.calciumSilicate()))


@mark.parametrize(
    "act, message",
    [
        (lambda s, t: s.bracket(lambda f: True, 0.2, 0.3), "carries 0.3, the upper"),
        (lambda s, t: s.bracket(lambda f: True, 0.3, 0.2), "below high 0.2"),
        (lambda s, t: s.push(t, 0.1, direction=(0, 1, 0)), "in the x-z plane"),
        (lambda s, t: s.watch(0), "must come before the first stage"),
        (lambda s, t: s.grow({t: (0, 0, 0)}), "force must not be zero"),
        (lambda s, t: s.wind(9, (0, 0, 1)), "must be a horizontal direction"),
    ],
)
def test_wrong_stages_are_refused(tmp_path, act, message):
    with raises(ValueError, match=message):
        act(*small(tmp_path))


def test_nothing_held_and_wind_on_deformable_bricks_are_refused(tmp_path):
    with raises(SystemExit, match="2"):
        lean(tmp_path, TWO).settle()
    with raises(Refused, match="wind: it loads rigid bricks"):
        lean(tmp_path, TWO, blocks="deformable").wind(500, (1, 0, 0))


def test_a_block_that_is_tilted_beyond_its_diagonal_falls(tmp_path):
    block = bricks.stack(1, (0.25, 0.25, 0.5))
    scene = standing(tmp_path, block, materials.dry(friction=5, normalStiffness=1e10))
    scene.settle()
    assert scene.tilt(45, rate=3) == COLLAPSED
    assert scene.factor == approx(0.5, rel=0.01)
    assert scene.run(0.1) == COLLAPSED
    scene.stepBack()
    assert scene.lean(0.48) == AT_REST
    assert scene.lean(0.52) == COLLAPSED
    scene.stepBack()
    scene.finish()
    assert readRun(tmp_path)["collapse"] is None


def test_a_property_varies_from_place_to_place(tmp_path):
    masonry = materials.calciumSilicate().vary("bed.cohesion", lambda x, y, z: 1 + z)
    scene = standing(tmp_path, bricks.Wall(0.44, 0.81), masonry)
    scene.begin()
    beds = [i for i in O.interactions if i.phys.joint.name == "bed"]
    found = {i.geom.polygon[0][2]: i.phys.joint.cohesion for i in beds}
    assert len(found) >= 9
    for height, cohesion in found.items():
        assert cohesion == approx(0.11e6 * (1 + height), rel=5.1e-3)


# -- supports that go, wind, drift, pushes that go on, records -------------------------------------


def test_a_support_is_released_and_the_other_one_carries_all(tmp_path):
    """A stone on two legs, which stand on held stones; a third one in the middle takes the weight
    when one leg goes."""
    leg, beam = bricks.stack(1, (0.2,) * 3), bricks.block((0, 0, 0.2), (1.0, 0.2, 0.4))
    blocks = sum([leg, leg.moved(0.4), leg.moved(0.8), beam])
    scene = lean(tmp_path, blocks, materials.dry(normalStiffness=1e10))
    left, middle, right = (scene.hold(n, name=f"leg{n}") for n in range(3))
    assert scene.settle() == AT_REST
    carried = lambda name: -last(scene, f"{name}_force_z_kN")
    assert carried("leg2") > 0.1
    scene.release(right, "xyzXYZ")
    scene.run(0.2, damping=0.3)  # of the vibration after the sudden end
    weight = 1e-3 * STONE * 1.0 * 0.2 * 0.2
    # the leg has fallen off, and hangs on nothing: the joint has no tensile strength
    assert carried("leg0") + carried("leg1") == approx(weight, rel=1e-5)
    assert last(scene, "leg2_z_mm") < -50
    with raises(ValueError, match="release: leg2 is not held along x"):
        scene.release(right, "x")


def test_loads_stay_when_a_structure_settles_again(tmp_path):
    scene, top = small(tmp_path)
    before = scene.model.loading.loads["top_press"].force[2]
    assert scene.settle() == AT_REST
    assert scene.model.loading.loads["top_press"].force[2] == before < 0


def test_a_drive_that_is_released_leaves_a_force(tmp_path):
    scene = standing(tmp_path, TWO, gravity=0)
    top = scene.platen("top", drive="xz")
    scene.pressJoint(top, scene.joint(0, 1), -1e5)
    scene.run(0.05)
    assert last(scene, "joint0_normal_stress_MPa") == approx(-0.1, rel=1e-3)
    assert last(scene, "base_force_z_kN") == approx(-12, rel=1e-3)
    with raises(ValueError, match="top has drives along x, z alone, not along"):
        scene.push(top, 1, direction=(1, 0, 1))


def test_a_second_push_in_another_direction_does_not_let_go(tmp_path):
    scene = standing(tmp_path, TWO, plane=False)
    top = scene.platen("top")
    scene.press(top, 1e5)
    scene.settle()
    scene.push(top, 0.02)
    with raises(ValueError, match="would let go of it to push along"):
        scene.push(top, 0.02, direction=(0, 1, 0))


def test_a_push_goes_on_from_where_the_one_before_began(tmp_path):
    scene, top = small(tmp_path)
    scene.push(top, 0.08, continued=True)
    assert last(scene, "displacement_mm") == approx(0.08, abs=0.01)
    assert len(scene.running.state.stages) == 3
    assert last(scene, "top_x_mm") == approx(0.08, abs=0.01)
    scene.push(top, 0.03)
    assert last(scene, "top_x_mm") == approx(0.11, abs=0.01)
    with raises(ValueError, match="continued: top has not been pushed along"):
        scene.push(top, 1, direction=(-1, 0, 0), continued=True)


def test_storey_drift_is_the_difference_of_two_floors(tmp_path):
    blocks = bricks.stack(4, (0.4, 0.3, 0.2))
    scene = lean(tmp_path, blocks, materials.dry(normalStiffness=1e8))
    base, top = scene.platen("bottom"), scene.platen("top")
    floor = scene.watch((0.2, 0.15, 0.4), name="floor")
    scene.drift(base, floor, name="first"), scene.drift(floor, top)
    with raises(ValueError, match="drift: base at z = -0.2 m must be above top"):
        scene.drift(top, base)
    scene.press(top, 1e5)
    scene.settle()
    scene.push(top, 0.1)
    names = "first_x_mm floor_x_mm top_x_mm top_drift_x_mm top_drift_x_mrad"
    first, below, above, drift, angle = (last(scene, name) for name in names.split())
    assert first == below > 0
    assert drift == approx(above - below)
    assert angle == approx(drift / 0.6)


def test_wind_overturns_a_wall_at_the_pressure_of_statics(tmp_path):
    """A wall t thick and h high falls over its edge at the pressure ρ g t²/h; its joints are
    stiff."""
    blocks = bricks.Wall(0.44, 0.81, halves=False)
    limit = STONE * 0.102**2 / 0.81
    for share, ends in ((0.96, AT_REST), (1.04, COLLAPSED)):
        stiff = materials.dry(normalStiffness=2e12)
        scene = standing(tmp_path, blocks, stiff, plane=False)
        pressed = share * limit * 0.44 * 0.81
        assert scene.wind(share * limit, towards=(0, 1, 0)) == approx((0, pressed, 0), abs=1e-9)
        assert scene.settle(longest=4) == ends
        assert scene.model.energy.largestError < 1e-3
        if ends == AT_REST:
            assert last(scene, "base_force_y_kN") == approx(1e-3 * pressed, rel=0.01)
            letGo()
    with raises(SystemExit, match="1"):  # since it fell in settle()
        scene.finish()


@mark.parametrize("stage", ["tilt", "accelerate"])
def test_scaled_masses_leave_the_weight_of_a_structure_that_leans(tmp_path, stage):
    """Four times the masses under a fourth of gravity weigh the same, and feel a fourth of the
    acceleration."""
    scene = standing(tmp_path, THREE, density_scaling=4)
    scene.settle()
    angle = math.atan(0.1)
    if stage == "tilt":
        scene.tilt(math.degrees(angle), rate=5)
    else:
        scene.accelerate(0.1, rate=0.2)
    weight = 1e-3 * STONE * 0.4 * 0.3 * 0.6  # [kN]
    weight *= math.cos(angle) if stage == "tilt" else 1
    assert last(scene, "base_force_z_kN") == approx(-weight, rel=0.02)
    assert last(scene, "base_force_x_kN") == approx(0.1 * weight, rel=0.05)
    assert scene.factor == approx(0.1, rel=0.01)
    scene.finish()
    material = readRun(tmp_path)["unit_material"]
    assert material["density_kg_per_m3"] == approx(2600)


def test_columns_are_read_as_often_in_a_run_of_many_rows(tmp_path, monkeypatch):
    """A column is a list that is made anew whenever it is asked for, so asking for it row by row
    takes hours in long loops."""
    counts = []
    for until in ("0.02", "0.2"):
        asked, read = [], Results.column
        monkeypatch.setattr(
            Results, "column", lambda self, head: asked.append(head) or read(self, head)
        )
        carryOut(
            SMALL,
            parsed("--lean", "--rate", "50", "--until", until, "--out", str(tmp_path / until)),
        )
        monkeypatch.undo()
        counts.append(len(asked))
    assert counts[1] <= counts[0] + 5


def test_a_platen_below_edges_alone_is_refused(tmp_path):
    dome = bricks.Dome(3.0, 0.25, courses=4, stones=8, angle=90, oculus=0.4)
    with raises(ValueError, match="no horizontal side of a brick lies at the"):
        standing(tmp_path, dome)


def test_a_name_that_is_not_there_is_refused_with_those_that_are(tmp_path):
    scene = standing(tmp_path, THREE)
    scene.settle()
    with raises(Refused, match="no target 'bas', did you mean 'base'.; there are base"):
        scene.targets["bas"]
    with raises(Refused, match="no column 'time'; there are time_s,"):
        scene.results.column("time")


@mark.parametrize("where, levels", [("bottom", (0.0, -0.3)), ("top", (0.9, 0.0))])
def test_a_platen_is_at_the_side_of_its_part(tmp_path, where, levels):
    """A wall beside a road that lies deeper; each of them has a platen at its own side."""
    wall = bricks.Wall(0.88, 0.9, (0.44, 0.3, 0.3), halves=False)
    road = bricks.stack(1, (2.0, 0.3, 0.3), part="road").moved(1.5, 0, -0.3)
    scene = lean(tmp_path, wall + road, plane=False)
    for part, level in zip(("wall", "road"), levels):
        target = scene.platen(where, part=part, name=f"{part}_side")
        low, high = target.box
        assert (high if where == "bottom" else low)[2] == approx(level)


@mark.parametrize("plane", [True, False], ids=["plane", "space"])
def test_what_moves_in_its_plane_is_seen_there_also_if_it_is_deep(tmp_path, plane):
    scene = standing(tmp_path, bricks.stack(2, (0.3, 1.0, 0.5)), plane=plane)
    scene.begin()
    assert scene.description.views == ({"stack": [0, 1, 0]} if plane else {})


def test_a_wall_that_a_push_lets_go_swings_back_and_has_not_fallen(tmp_path):
    runs = []
    for lets in (False, True):
        wall = bricks.Wall(1.0, 1.5, unit=(0.25, 0.12, 0.1), halves=False)
        stones = materials.dry(friction=0.7, density=2000, normalStiffness=5e9)
        scene = standing(tmp_path, wall, stones)
        top = scene.platen("top", rotation="free")
        scene.press(top, 0.05e6)
        scene.settle()
        scene.push(top, 30)
        if lets:
            scene.release(top, "x")
            assert scene.settle() == AT_REST
            assert abs(last(scene, "top_x_mm")) < 3
        scene.finish()
        ofPush = re.compile("peak|end_|push_work|sudden|force_drop").search
        runs.append({k: v for k, v in readRun(tmp_path).items() if ofPush(k)})
    assert len(runs[0]) > 8 and runs[1] == runs[0]
