# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes whose collapse is followed to the ground: what they say of it, against what stands in
YADE, and how they go on."""

from hosted import *
import functools
from masonry.units import GRAVITY
from masonry_view.elevation import frameOfCracks
from masonry.numbers.frames import readFrame
from masonry.stages import falling

DENSITY = 2200
SIDE = 0.3  # [m] of a cubic half stone
#: Gives the folder, blocks, stones and words of a scene whose collapse is followed.
following = functools.partial(lean, plane=False, collapse="follow")


def stones(friction=0.6, stiffness=2e9):
    return materials.dry(friction, stiffness, density=DENSITY)


def column(tmp_path, *words, **settings):
    """A narrow dry wall of six stones that can turn over along y."""
    wall = bricks.Wall(2 * SIDE, 4 * SIDE, unit=(2 * SIDE, SIDE, SIDE), halves=False)
    scene = following(tmp_path, wall, stones(), *words, **settings)
    scene.platen("bottom")
    return scene


@pytest.fixture(scope="module")
def fallen(tmp_path_factory):
    """The column after an acceleration that it cannot bear, and its rows."""
    scene = column(tmp_path_factory.mktemp("fallen"))
    scene.args.lean = False  # frames are compared
    scene.settle()
    scene.lasted = scene.lean(0.4, towards=(0, 1, 0))
    states = [O.bodies[b].state for b in scene.model.ids]
    scene.places = [np.array(s.pos) for s in states]
    scene.turns = [s.ori * s.refOri.conjugate() for s in states]
    scene.finish()
    return scene, arrays(scene.results.directory)


def answer(scene, name):
    return next(a["value"] for a in scene.answers if a["name"] == name)


def test_what_fell_lies_on_the_ground_at_rest(fallen):
    scene, rows = fallen
    assert scene.lasted == COLLAPSED and scene.collapsed
    assert readRun(scene.results.directory)["ended"] == "collapsed and at rest"
    mass = 4 * 2 * SIDE**3 * DENSITY
    assert answer(scene, "fallen_blocks") == 6 and answer(scene, "fallen_share") == 1
    assert answer(scene, "fallen_mass") == approx(mass)
    assert answer(scene, "rubble_volume") == approx(8 * SIDE**3)
    # one layer on the ground, which carries all of it
    assert answer(scene, "rubble_height") == approx(SIDE, rel=1e-3)
    assert rows["ground_force_z_kN"][-1] == approx(-1e-3 * mass * GRAVITY, rel=5e-3)
    assert rows["base_force_z_kN"][-1] == 0
    ground = scene.targets["ground"].box[1][2]
    assert all(place[2] == approx(ground + SIDE / 2, abs=1e-5) for place in scene.places)
    reach = max(place[1] for place in scene.places) + SIDE / 2 - SIDE
    assert answer(scene, "rubble_reach") == approx(reach, rel=0.01)


def test_the_base_section_has_what_contacts_carry(fallen):
    """All that stands on the base passes through it, whether by joints or by contacts, and later to
    the ground. The force of a joint that turns is along the mean of both faces. A joint is handed
    over from 1° on, which is looked at every tenth step: after up to 2°, hence 1 - cos 1°."""
    _, rows = fallen
    for force, axis in (("N", "z"), ("V_y", "y")):
        carried = rows[f"base_force_{axis}_kN"] + rows[f"ground_force_{axis}_kN"]
        assert rows[f"base_{force}_kN"] == approx(carried, rel=1.5e-4, abs=1e-4)
    assert rows["handed_joints"][-1] > 0


def test_energies_of_the_fall(fallen):
    scene, rows = fallen
    work = rows["gravity_J"][-1]
    lost = rows["friction_contacts_J"][-1] + rows["damping_contacts_J"][-1]
    assert lost == approx(work, rel=0.02)
    assert np.abs(rows["balance_error"]).max() < 0.02
    # every stone is fastest before it strikes, and not all of them at once
    assert rows["kinetic_J"].max() <= answer(scene, "impact_energy") < 1.5 * work


def test_the_table_has_a_row_for_every_fallen_block(fallen):
    scene, _ = fallen
    rows = list(csv.DictReader(open(scene.results.path("fallen.csv"))))
    assert [int(row["block"]) for row in rows] == list(range(6))
    first = min(float(row["fallen_at_s"]) for row in rows)
    assert answer(scene, "first_fall") == approx(first, rel=1e-8)
    # those that lay below turn over once, about any axis; how far the upper ones roll on depends on
    # how they strike the ground
    fronts = [(turn * Vector3.UnitY)[2] for turn in scene.turns[:4]]
    assert fronts == approx([-1] * 4, abs=1e-3)
    for row, place, turn in zip(rows, scene.places, scene.turns):
        now = [float(row[f"now_{axis}_m"]) for axis in "xyz"]
        assert now == approx(place, rel=1e-6, abs=1e-6)
        assert float(row["loose_at_s"]) < float(row["fallen_at_s"])
        turned = math.degrees(2 * math.acos(min(1, abs(turn[3]))))
        assert float(row["turned_deg"]) == approx(turned, abs=1e-3)
        # no stone is faster than one that falls from the top, and slides at 0.4 g as long
        fell = math.sqrt(2 * GRAVITY * 5 * SIDE)
        assert (
            0 < float(row["largest_kinetic_energy_J"]) < 0.5 * float(row["mass_kg"]) * 3 * fell**2
        )


def test_cracks_are_those_of_the_moment_when_the_collapse_was_noticed(fallen):
    scene, _ = fallen
    folder = scene.results.directory
    number = frameOfCracks(readRun(folder), folder)
    noticed = answer(scene, "noticed_at")
    assert readCurve(folder)["time_s"][-1] > noticed + 1
    moved = readFrame(folder, "blocks", number)["displacement"]
    assert 0 < np.abs(moved).max() < SIDE / 2
    assert np.abs(readFrame(folder, "blocks", -1)["displacement"]).max() > SIDE


def test_an_acceleration_that_the_column_bears_leaves_it_as_without_follow(tmp_path):
    found = []
    for collapse in ("end", "follow"):
        scene = column(tmp_path, collapse=collapse)
        scene.settle()
        time = O.dt
        assert scene.lean(0.1, towards=(0, 1, 0)) == AT_REST
        found.append((time, scene.results.column("gravity_J"), bits()))
    assert found[0][1:] == found[1][1:] or found[0][0] != found[1][0]


def test_a_shaken_wall_goes_on_while_its_top_falls(tmp_path):
    scene = column(tmp_path)
    scene.settle()
    pulse = [0, 12.0, 12.0, 12.0, 0, -12.0, -12.0, 0] + 20 * [0.0]
    assert scene.shake(pulse, 0.05, direction=(0, 1, 0)) == COLLAPSED
    assert scene.ended.startswith(COLLAPSED)
    fell = [one["fell"] for one in scene.model.fallen().values()]
    assert min(fell) < answer(scene, "noticed_at")
    times = scene.results.column("time_s")
    assert answer(scene, "time_of_collapse") == approx(min(fell) - times[1], abs=0.05)
    # the shake is not damped, and when the fall is noticed no joint holds a stone any more
    damped, noticed = scene.results.column("damping_J"), answer(scene, "noticed_at")
    shaken = max(d for d, t in zip(damped, times) if t <= noticed)
    assert shaken == approx(damped[1], rel=1e-6) and damped[-1] == approx(shaken, rel=1e-6)


@mark.parametrize(
    "settings, message",
    [
        (dict(collapse="go on"), "collapse 'go on' must be one of end, follow"),
        (dict(functors=True), "leave functors=False"),
        (dict(blocks="deformable"), "choose --blocks rigid"),
        (dict(density_scaling=4), "blocks fall in real time, with true masses"),
    ],
)
def test_what_does_not_go_together_is_refused(tmp_path, capsys, settings, message):
    with raises((Refused, SystemExit)) as end:
        column(tmp_path, **settings).settle()
    assert message in str(end.value) + capsys.readouterr().err


def test_contact_takes_the_bed_joint_and_what_set_says(tmp_path, capsys):
    for words, friction in (["--set=contact.restitution=0.2"], 0.6), (
        ["--set=contact.friction=0.3"],
        0.3,
    ):
        scene = column(tmp_path, *words)
        scene.begin()
        contacts = scene.model.contacts
        assert (contacts.friction, contacts.normalStiffness) == (friction, 2e9)
        assert contacts.tangentialRatio == approx(0.4)
        assert (contacts.restitution == 0.2) == (friction == 0.6)
        letGo()
    with raises(SystemExit):
        column(tmp_path, "--set=contact.friction=11").settle()
    assert "friction 11.0 - must be at least 0 and at most 10" in capsys.readouterr().err


def test_a_support_that_moved_stands_still_in_the_fall(tmp_path):
    """The right one of two stones on which a third one lies is drawn from under it."""
    side = bricks.block((0, 0, 0), (SIDE, SIDE, SIDE))
    lintel = bricks.block((0.8 * SIDE, 0, SIDE), (1.7 * SIDE, SIDE, 1.5 * SIDE))
    scene = following(
        tmp_path, side + side.moved(1.5 * SIDE) + lintel, stones(0.3, 1e8), allowGaps=True
    )
    scene.hold(0, name="still")
    moved = scene.hold(1, name="ground")  # a name that the ground itself would have
    scene.settle()
    assert scene.move(moved, x=300, rate=500) == COLLAPSED
    assert scene.ended == "collapsed and at rest"
    column = scene.results.column
    rows = [n for n, t in enumerate(column("time_s")) if t > answer(scene, "noticed_at") + 0.01]
    assert np.ptp([column("ground_x_mm")[n] for n in rows]) == 0
    assert column("ground2_force_z_kN")[-1] < 0 and answer(scene, "fallen_blocks") == 1


def test_the_ground_where_the_scene_has_it(tmp_path):
    scene = column(tmp_path)
    scene.ground(level=-1.0)
    scene.settle()
    scene.lean(0.55, towards=(-1, 0, 0))  # 0.5 overturns it, 0.6 lets it slide
    corners = [c for n in scene.model.fallen() for c in falling.cornersNow(scene.model, n)]
    assert min(c[2] for c in corners) == approx(-1, abs=0.01)
    # on the low side, too, and along x, to the farthest corner
    reach = -min(c[0] for c in corners)
    assert answer(scene, "rubble_reach") == approx(reach, rel=1e-3) and reach > SIDE
    with raises(Refused, match="ground: level 1 m must be at most -0.2 m"):
        column(tmp_path).ground(1.0)
    with raises(Refused, match="only a scene with collapse='follow'"):
        column(tmp_path, collapse="end").ground(-1.0)


def test_a_tilt_stays_when_the_block_that_it_overturned_lies(tmp_path):
    """It turns over at 14°, where the tangent is 0.25, and lies on the slope, since friction is
    0.6: the force on the ground has that share along y to the last, and all of the weight. After an
    acceleration, which ends, it would press straight down.
    """
    scene = following(tmp_path, bricks.stack(1, (SIDE, SIDE, 4 * SIDE)), stones())
    scene.platen("bottom")
    scene.settle()
    assert scene.tilt(20, towards=(0, 1, 0), rate=5, within=0.3) == COLLAPSED
    assert scene.ended == "collapsed and at rest"
    y, z = (
        1e3
        * sum(scene.results.column(f"{name}_force_{axis}_kN")[-1] for name in ("base", "ground"))
        for axis in "yz"
    )
    slope = scene.results.column("load_factor")[-1]
    assert slope > 0.25 and y == approx(-slope * z, rel=0.01)
    weight = 4 * SIDE**3 * DENSITY * GRAVITY
    assert math.hypot(y, z) == approx(weight, rel=0.01)


def test_without_follow_the_run_ends_where_it_fell(tmp_path):
    scene = column(tmp_path, collapse="end")
    scene.settle()
    assert scene.lean(0.4, towards=(0, 1, 0)) == COLLAPSED
    assert scene.ended == COLLAPSED and "ground" not in scene.targets
    assert not [a for a in scene.answers if a["stage"] == "fall"]


def test_what_is_released_keeps_its_momentum_and_nothing_brakes_its_flight(tmp_path):
    """A block without joints, which falls by half a metre; the settling brakes it until its
    collapse is noticed."""
    made = bricks.block((0, 0, 0.5), (SIDE, SIDE, 0.7)) + bricks.stack(2, (SIDE,) * 3).moved(dx=3)
    for stage in ("run", "settle"):
        scene = following(tmp_path / stage, made, stones(), plane=None, allowGaps=True)
        scene.ground(0.0)
        block = scene.hold(0, name="block")
        scene.hold(1, name="pier")
        scene.settle()
        scene.release(block, "xyzXYZ")
        scene.run(1.0) if stage == "run" else scene.settle()
        energy = O.bodies[block.body].state.mass * GRAVITY * 0.5
        column = scene.results.column
        braked = max(column("damping_J"))
        assert braked < (1e-3 if stage == "run" else 0.05) * energy
        # in flight, and after impacts of three steps each; a run warns from 1 % on
        errors, impacts = map(np.abs, (column("balance_error"), column("damping_contacts_J")))
        assert max(errors[impacts == 0]) < 1e-3 and max(errors) < 1e-2
        kinetic = max(fall["most"] for fall in scene.model.fallen().values())
        assert kinetic == approx(energy - braked, rel=0.01)
        [fall] = scene.model.fallen().values()
        if stage == "run":  # it strikes the ground after the time of a free fall
            lasts = math.sqrt(2 * 0.5 / G)
            assert fall["at"] - fall["since"] == approx(lasts, rel=0.02)
            assert fall["since"] < fall["fell"] < fall["at"]
            # what strikes the ground takes the momentum of the weight, whatever the time step
            weight, last = (
                O.bodies[block.body].state.mass * GRAVITY,
                O.bodies[block.body].state.vel[2],
            )
            lasted = column("time_s")[-1] - fall["since"]
            impulse = -weight * (lasted + last / GRAVITY)
            assert column("ground_impulse_z_Ns")[-1] == approx(impulse, rel=1e-2)


def thrown(folder, speed, *words, reach=None):
    """The uppermost of three cubes gets a horizontal velocity [m/s], which takes it off."""
    scene = following(folder, bricks.stack(3, (0.4,) * 3), materials.dry(0.6), *words)
    scene.hold(0)
    top = scene.watch(2, name="top")
    scene.ground(0.0, reach=reach)
    scene.settle()
    O.bodies[top.body].state.vel = (speed, 0, 0)
    scene.model.energy.given()
    scene.run(4)
    scene.finish()
    return scene


def test_what_leaves_the_ground_is_stopped_and_counted_apart(tmp_path, capsys):
    scene = thrown(tmp_path, 14, reach=2.0)
    assert "1 blocks have left the ground" in capsys.readouterr().out
    assert scene.ended == "collapsed and at rest"
    assert answer(scene, "left_the_ground") == answer(scene, "fallen_blocks") == 1
    names = {a["name"] for a in scene.answers}
    assert not names & {"rubble_reach", "rubble_height", "impact_energy"}
    assert arrays(tmp_path)["top_z_mm"][-1] > -2000
    assert imbalance() < 1e-3


@mark.parametrize("speed", [3, 14])
def test_the_ground_is_as_large_as_a_fall_needs_and_its_answers_hold_for_other_steps(
    tmp_path, speed
):
    """The cube has the energy that it was given and that of its fall when it strikes, less what
    friction took while it slid off; it slides no farther than both take it, v²/(2 μ g)."""
    found = {}
    for share in ("0.8", "0.4"):
        scene = thrown(tmp_path / share, speed, "--dt-fraction", share)
        assert scene.ended == "collapsed and at rest"
        names = "impact_energy", "rubble_height", "fallen_mass"
        found[share] = [answer(scene, name) for name in names]
        begun = scene.running.state.stages[1]["first_row"]
        found[share].append(answer(scene, "first_fall") - arrays(tmp_path / share)["time_s"][begun])
        mass, reach = answer(scene, "fallen_mass"), answer(scene, "rubble_reach")
        energy = mass * (0.5 * speed**2 + 0.8 * G)
        assert 0.8 * energy < answer(scene, "impact_energy") < 1.001 * energy
        assert 0.4 < reach < speed**2 / (2 * 0.6 * G) + 2 * speed + 2
    assert found["0.4"] == approx(found["0.8"], rel=0.02)


def test_what_slid_and_stands_has_not_fallen(tmp_path):
    """A block slides 0.8 m over a slab, by Coulomb's law: v = (a - μ g) T, which μ g brakes."""
    made = bricks.block((-3, -0.5, -0.2), (3, 0.5, 0), part="slab")
    made += bricks.block((-0.2, -0.2, 0), (0.2, 0.2, 0.1), part="block")
    scene = following(tmp_path, made, stones(0.3, 1e10))
    scene.hold((0, 0, -0.1), name="slab")
    scene.watch((0, 0, 0.05), name="block")
    scene.settle()
    assert scene.shake([6.0] * 51 + [0.0], 0.01, after=1.0) == DONE
    slip = 0.5 * (6 - 0.3 * G) * 0.505**2 * 6 / (0.3 * G)
    assert scene.results.column("block_x_mm")[-1] == approx(-1e3 * slip, rel=0.02)
    assert scene.model.fallen() == {} and not scene.collapsed


@mark.parametrize("peak, isNear", [(4.1, True), (3.2, False)])
def test_a_block_that_nearly_overturned_is_said_to_be_near_the_edge(peak, isNear, tmp_path, capfd):
    """Half a sine of 0.3 s takes its centroid 0.84 of the way to its edge, or 0.21; at 4.4 m/s² it
    falls."""
    scene = following(tmp_path, bricks.stack(2, (0.2, 0.2, 1.0)), materials.dry(1.0), plane=None)
    scene.hold(0)
    scene.watch(1, name="block")
    scene.settle()
    pulse = [peak * math.sin(math.pi * n / 60) for n in range(61)]  # [m/s²]
    assert scene.shake(pulse, 0.005, direction=(1, 0, 0), after=0.8) != COLLAPSED
    assert ("near the edge of a fall" in capfd.readouterr().out) == isNear
