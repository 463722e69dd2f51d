# SPDX-License-Identifier: GPL-2.0-or-later
"""Ties and springs: what they carry against statics, what a run says of them, and what is
refused."""

from hosted import *
from masonry.run import checkpoints
from masonry.units import GRAVITY
from masonry.numbers.frames import readFrame
from masonry_view.page.data import dataOf

WIDTH, DEPTH, HEIGHT = 0.4, 0.3, 1.6  # of a block [m]
BLOCK = WIDTH, DEPTH, HEIGHT
WEIGHT = WIDTH * DEPTH * HEIGHT * 2600 * GRAVITY  # [N]
BASE = "<base>"  # in a table: the platen below


def refused(text):
    return raises((Refused, ValueError), match=re.escape(text))


STONE = materials.dry(5.0, normalStiffness=1e11)


def block(tmp_path, *words, **settings):
    """A stiff block, which cannot slide on what it stands on."""
    return lean(tmp_path, bricks.stack(1, BLOCK), STONE, *words, **settings)


WALL = bricks.Wall(0.66, 0.243, halves=False)  # three courses


def at(height, x=WIDTH / 2):
    return (x, DEPTH / 2, height)


def test_limit_analysis_has_the_tie(tmp_path):
    scene, force, level = block(tmp_path, "--preset", "bound"), 500.0, 1.2
    scene.platen("bottom")
    scene.tie(at(level), anchor=at(level, -3.0), stiffness=1e7, strength=force)
    scene.tie(at(0.5), anchor=at(0.5, 3.0), stiffness=1e7, strength=force)  # slack
    found = scene.bound(towards=(1, 0, 0))
    expected = (WEIGHT * WIDTH / 2 + force * level) / (WEIGHT * HEIGHT / 2)
    assert found["factor"] == approx(expected, rel=1e-4)


def pulled(tmp_path, *words, most=1.0, **properties):
    """A block that a drive lifts against a tie: the rows of the push, the tie, and run.json."""
    scene = block(tmp_path, *words, rate=10)
    scene.platen("bottom")
    top = scene.handle(0, "top")
    tie = scene.tie(at(HEIGHT / 2), anchor=at(HEIGHT / 2 - 0.5), **properties)
    scene.settle()
    scene.push(top, most, direction=(0, 0, 1))
    scene.finish()
    return arrays(tmp_path), tie, readRun(tmp_path)["ties"][0]


def test_a_tie_is_elastic_then_yields(tmp_path, capsys):
    stiffness, strength = 4e6, 1e3
    rows, tie, run = pulled(tmp_path, stiffness=stiffness, strength=strength)
    moved = rows["tie0_elongation_mm"]
    expected = np.minimum(stiffness * 1e-6 * np.maximum(moved, 0), strength / 1e3)
    assert np.abs(rows["tie0_force_kN"] - expected).max() < 1e-8
    plastic = 1e-3 * moved[-1] - strength / stiffness
    assert run["state"] == "yielded"
    assert run["plastic_elongation_m"] == approx(plastic)
    lost = approx(strength * plastic, rel=1e-2)
    assert rows["dissipated_connectors_J"][-1] == lost
    stored = approx(strength**2 / (2 * stiffness))
    assert rows["elastic_connectors_J"][-1] == stored
    assert abs(rows["balance_error"]).max() < 1e-3
    assert capsys.readouterr().out.count("tie0 yields: between brick 0 at") == 1


def test_a_tie_breaks_at_its_strain(tmp_path, capsys):
    rows, tie, run = pulled(tmp_path, stiffness=4e6, breaking=1e-3)
    broken = rows["tie0_elongation_mm"] > 0.5
    assert (rows["tie0_force_kN"][broken] == 0).all() and broken.any()
    assert rows["tie0_force_kN"].max() == approx(2.0, rel=0.1)
    lost = approx(0.5 * 4e6 * 0.5e-3**2, rel=0.02)
    assert rows["dissipated_connectors_J"][-1] == lost
    assert run["state"] == "broken" and tie.force == 0
    assert abs(rows["balance_error"]).max() < 0.01
    assert "tie0 breaks" in capsys.readouterr().out


def test_a_checkpoint_may_know_more_ties_that_yielded_than_have_so_far(tmp_path):
    """A run that is resumed gets the state in which its stage began, and then that of the
    checkpoint."""
    scene = standing(tmp_path, WALL)
    scene.tie(3, anchor=(-1, 0.15, 0.2), stiffness=1e6, strength=100)
    scene.begin()
    said = scene.model.connectors.reported
    states = []
    for event in ("yields", "breaks"):
        said.add((event, "tie0"))
        states.append(checkpoints.stateOf(scene))
    said.clear()
    for state in states:
        checkpoints.putState(scene, state)
        assert checkpoints.stateOf(scene) == state


def test_prestress_grows_in_settle_and_its_work_is_counted(tmp_path):
    """The tie and the weight press the block down by u on a support of stiffness K: (P - k u) + W =
    K u."""
    scene, force = block(tmp_path), 2e3
    scene.platen("bottom")
    scene.watch(0, "top")
    tie = scene.tie(at(HEIGHT), anchor=at(-0.5), stiffness=1e6, prestress=force)
    assert scene.settle() == AT_REST
    (joint,) = scene.model.interactions
    support = joint.phys.normalStiffness * WIDTH * DEPTH
    down = (force + WEIGHT) / (1e6 + support)
    assert tie.force == approx(force - 1e6 * down, rel=1e-4)
    scene.run(0.05, damping=0.5)
    rows = scene.curve()
    pressed = approx(-1e-3 * (WEIGHT + tie.force), rel=1e-4)
    assert rows["base_force_z_kN"][-1] == pressed
    stored = approx(tie.force**2 / 2e6, rel=1e-4)
    assert rows["elastic_connectors_J"][-1] == stored
    assert rows["external_J"][-1] == approx(force**2 / 2e6, rel=0.02)
    assert abs(rows["balance_error"][-1]) < 1e-3


def test_columns_of_a_platen_on_springs(tmp_path):
    kx, turning, level = 2e6, 3e6, 1.5
    scene = block(tmp_path, rate=1)
    scene.platen("bottom", springs={"x": kx, "Y": turning}, height=0.2)
    top = scene.handle(at(level), "top")
    scene.settle()
    scene.push(top, 0.05)
    rows = scene.curve()
    shear = rows["base_shear_kN"][-1]
    moment = shear * (level + 0.2)  # over the springs, at the outer side of the platen
    assert rows["base_spring_moment_y_kNm"][-1] == approx(moment, rel=0.05)
    assert rows["base_force_x_kN"][-1] == approx(shear, rel=1e-6)
    assert abs(rows["balance_error"]).max() < 1e-3


def test_a_spring_period_is_its_closed_form(tmp_path):
    """Of a block and its platen on a spring along x alone: T = 2π √(m / k)."""
    scene = block(tmp_path)
    base = scene.platen("bottom", springs={"x": 4e5})
    scene.watch(0, "top")
    scene.settle()
    state = O.bodies[base.body].state
    mass = WEIGHT / GRAVITY + state.mass
    for body in O.bodies:
        body.state.vel = (0.01, 0, 0)
    scene.model.energy.given()
    period = 2 * math.pi * math.sqrt(mass / 4e5)
    scene.run(2 * period, damping=0.0)
    moved, times = scene.curve()["base_x_mm"], scene.curve()["time_s"]
    assert moved.max() == approx(10 * period / (2 * math.pi), rel=0.01)
    downs = [t for t, a, b in zip(times[1:], moved, moved[1:]) if a > 0 >= b]
    assert downs[1] - downs[0] == approx(period, rel=0.02)


def test_a_tie_sets_the_time_step_where_it_is_stiffest(tmp_path):
    limits = []
    for n, stiffness in enumerate((1e3, 1e13)):
        scene = block(tmp_path / str(n))
        scene.platen("bottom")
        scene.tie(at(1.2), anchor=at(1.2, -3.0), stiffness=stiffness)
        assert scene.settle() == AT_REST
        limits.append(scene.model.scheme.limit)
        letGo()
    mass = WEIGHT / GRAVITY
    assert limits[1] < 2 / math.sqrt(1e13 / mass) * 1.35 < 0.1 * limits[0]


@mark.parametrize(
    "word, settings, text",
    [
        ("tie", dict(), "tie: give either other or anchor"),
        ("tie", dict(other=BASE, prestress=5, slack=0.1), "exclude each other"),
        ("tie", dict(other=BASE, prestress=50, strength=20), "its strength, 20 N"),
        ("tie", dict(other=0), "are on one brick"),
        ("tie", dict(anchor=(0, 0, 3), name="base"), "there is a 'base' already"),
        ("settle", dict(other=BASE), "must come before the first stage"),
        ("spring", dict(stiffness=(0, 0, 0)), "a stiffness must be above 0"),
        ("spring", dict(stiffness=(0, 1e6, 0)), "the scene is in the x-z plane"),
        ("platen", dict(where="top", springs={"x": 1}), "for the one at the bottom"),
        ("platen", dict(where="bottom", springs={"q": 1}), "axes xyzXYZ"),
    ],
)
def test_what_makes_no_sense_is_refused(tmp_path, word, settings, text):
    scene = block(tmp_path)
    base = scene.platen("bottom")
    settings = {n: base if v == BASE else v for n, v in settings.items()}
    place = () if word == "platen" else (at(1),)
    if word == "settle":
        scene.settle()
    if word in ("tie", "settle"):
        word, settings = "tie", {"stiffness": 1e6, **settings}
    with refused(text):
        getattr(scene, word)(*place, **settings)


def test_no_energy_is_made_by_ties_in_a_shaken_wall(tmp_path):
    scene = standing(tmp_path, WALL, plane=False)
    rng = np.random.default_rng(5)
    for n in range(8):
        one, other = rng.choice(len(WALL), 2, replace=False)
        scene.tie(
            int(one),
            int(other),
            stiffness=10 ** rng.uniform(5, 7),
            strength=10 ** rng.uniform(0, 2),
            compression=bool(n % 2),
        )
    scene.settle()
    times = np.arange(0, 0.5, 0.005)
    assert scene.shake(list(9 * np.sin(30 * times)), every=0.005) != COLLAPSED
    rows = scene.curve()
    assert abs(rows["balance_error"]).max() < 0.01
    lost = rows["dissipated_connectors_J"]
    assert lost[-1] > 0 and (np.diff(lost) > -1e-3 * lost[-1]).all()


def test_fibres_cross_the_joints_of_one_face_only(tmp_path):
    scene = standing(tmp_path, WALL, plane=False)
    layer = dict(stiffness=1e7, strength=1e4, gauge=0.1)
    both = scene.overlay((0, 1, 0), **layer)
    joints = WALL.joints()
    assert len(both.ties) == 2 * len(joints)
    level = sum(abs(joint.normal[2]) > 0.9 for joint in joints)
    upright = scene.overlay((0, -1, 0), **layer, fibres="vertical", name="other")
    assert len(upright.ties) == 2 * level
    # a level crack crosses the layer over all of the wall's length, with the strength and the
    # stiffness of that
    crack = [one for one in upright.ties if abs(one.place()[2] - 0.081) < 1e-9]
    assert sum(one.strength for one in crack) == approx(1e4 * 0.66)
    assert sum(one.stiffness for one in crack) == approx(1e7 * 0.66 / 0.1)
    front = max(c[1] for block in WALL for c in block.corners)
    assert {round(end.point[1] - front, 12) for t in both.ties for end in t.ends} == {0}
    with refused("no joint ends at a face"):
        scene.overlay((0, 0, 1), **layer, fibres="vertical")
    scene.settle()


def test_a_layer_on_a_part_leaves_the_others_bare(tmp_path):
    left, right = (
        bricks.stack(3, (0.2, 0.1, 0.1)).moved(dx).named(name)
        for dx, name in ((0, "left"), (0.2, "right"))
    )
    scene = lean(tmp_path, left + right, plane=False)
    layer = lambda part: scene.overlay(
        (0, -1, 0), stiffness=1e7, strength=1e4, gauge=0.1, part=part
    )
    # two bed joints of the part, and none of the joints between both parts
    assert {one.brick for tie in layer("right").ties for one in tie.ends} == {3, 4, 5}
    assert len(layer("left").ties) == 4 and len(layer(None).ties) > 8


def test_a_spring_between_two_blocks_turns_nothing_as_a_whole(tmp_path):
    """Its force and the opposite one have one line, at a point that is the middle of neither block:
    the moment at the base is that of the load alone."""
    twins = bricks.stack(1, BLOCK) + bricks.stack(1, BLOCK).moved(2 * WIDTH)
    scene = standing(tmp_path, twins, STONE)
    scene.load(scene.handle(at(1.5)), (400, 0, 0))
    spring = scene.spring(at(1.3), 1, stiffness=(1e8, 0, 0))
    assert scene.settle() == AT_REST
    # its force would have an arm of 0.5 m between that point and the middle of the other block
    assert spring.force[0] < -100
    moment = scene.curve()["base_M_y_kNm"][-1]
    assert moment == approx(1.5 * 0.4, rel=0.01)


def test_ends_that_a_script_moves_are_where_it_moved_them(tmp_path):
    """A tie is fixed at half the height, then at the top: what the block, which a drive turned,
    stretches it by."""
    scene = block(tmp_path, rate=20)
    scene.platen("bottom")
    top = scene.handle(at(HEIGHT / 2), "top")
    tie = scene.tie(at(HEIGHT / 4), anchor=at(HEIGHT / 4, 3.0), stiffness=1e3)
    scene.settle()
    scene.push(top, 2)
    low = tie.elongation
    engine = scene.description.connectors[0].engine
    engine.updateAttrs({"points1": [at(HEIGHT)], "points2": [at(HEIGHT, 3.0)]})
    O.step()
    assert tie.elongation / low == approx(4, rel=0.01)
    twice = {
        name: 2 * list(getattr(engine, name))
        for name in ("bodies1", "points1", "bodies2", "points2")
    }
    with refused("stiffness must have a number for each of the 2 connectors, got 1"):
        engine.updateAttrs(twice)
    of = {
        "stiffness": [1e3] * 2,
        "strength": [1e300] * 2,
        "breaking": [1e300] * 2,
        "compression": [0] * 2,
        "rest": [0.0] * 2,
    }
    engine.updateAttrs({**twice, **of})
    O.step()
    assert engine.elongations[1] == engine.elongations[0] == tie.elongation


def test_ties_pull_the_same_with_functors(tmp_path):
    found = []
    for functors in (False, True):
        scene = standing(tmp_path / str(functors), WALL, functors=functors)
        scene.tie(1, anchor=(-1, 0, 0.2), stiffness=3e6, prestress=200)
        scene.spring(3, stiffness=(1e5, 0, 0))
        top = scene.handle(3, "top")
        scene.settle()
        scene.push(top, 1)
        rows = scene.curve()
        assert abs(rows["balance_error"]).max() < 1e-3
        at = lambda n: np.interp((0.3, 0.6, 0.9), rows["displacement_mm"], rows[n])
        found.append([*at("tie0_force_kN"), *at("spring0_force_x_kN")])
        letGo()
    assert found[0] == approx(found[1], rel=0.01)
    assert min(map(abs, found[0])) > 0.01


def test_bricks_at_ties_of_deformable_walls_are_said_to_be_rigid(tmp_path, capsys):
    scene = standing(tmp_path, WALL, blocks="deformable")
    scene.tie(1, anchor=(-1, 0, 0.2), stiffness=1e6)
    scene.settle()
    assert f"1 of {len(WALL)} bricks are rigid, because ties" in capsys.readouterr().out


def test_frames_have_ties_and_springs(tmp_path):
    scene = lean(tmp_path, WALL)
    scene.args.lean = False
    scene.platen("bottom", springs={"x": 1e7})
    tie = scene.tie(3, anchor=(-1, 0, 0.2), stiffness=3e6, strength=100)
    scene.tie(2, 3, stiffness=3e6)
    top = scene.handle(3, "top")
    scene.settle()
    scene.push(top, 2)
    scene.finish()
    frame = readFrame(tmp_path, "connectors")
    assert [len(cell) for cell in frame["cells"]] == [1, 2, 2]
    assert set(frame) - {"points", "cells"} <= set(MasonryVtkRecorder.fields())
    assert frame["condition"].tolist() == [0, 1, 0] and tie.state == "yielded"
    inSingle = lambda number: approx(number, rel=2**-24)  # frames have seven digits
    assert frame["tension"][1] == inSingle(tie.force)
    assert np.linalg.norm(frame["force"][1]) == inSingle(tie.force)
    assert frame["elongation"][1] == inSingle(tie.elongation)
    spring = scene.description.connectors[0]
    assert frame["force"][0] == inSingle(spring.force)
    one, other = frame["points"][frame["cells"][1]] + frame["displacement"][frame["cells"][1]]
    after = np.linalg.norm(other - one) - tie.length
    # bodies have moved on by half a step
    assert after == approx(tie.elongation, rel=0.005)
    head, _ = dataOf(str(tmp_path))
    arrays = head["arrays"]
    assert arrays["tiePoints"]["count"] == 12
    assert arrays["tieCondition"]["row"] == 2 and arrays["tieMoved"]["row"] == 12


@mark.parametrize("stiffness", [2e5, 1e8])
def test_a_structure_that_sinks_into_soft_soil_has_not_fallen(tmp_path, stiffness):
    scene = lean(tmp_path, bricks.stack(4, (0.5, 0.5, 0.5)))
    base = scene.platen("bottom", springs={"z": stiffness})
    assert scene.settle() == AT_REST
    mass = sum(O.bodies[body].state.mass for body in [*scene.model.ids, base.body])
    sunk = -1e-3 * scene.curve()["base_z_mm"][-1]
    assert sunk * stiffness == approx(GRAVITY * mass, rel=0.01)
