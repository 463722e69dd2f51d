# SPDX-License-Identifier: GPL-2.0-or-later
"""Rigid blocks that meet without a joint: they fall, rest, slide, collide, rock and lie in
heaps."""

from hosted import *

from contact_motion import heap, rest, slope
from contact_scenes import box, ground, prepare
from contact_steps import MEETINGS as TURNS, energy as kinetic

STIFF = 1e10  # Pa/m
ABOUT_Y = Vector3(0, 1, 0)


def contacts(**properties):
    return MasonryContacts(**{"normalStiffness": STIFF, "friction": 0.5, **properties})


def test_a_block_rests_on_an_incline_just_below_the_angle_of_friction():
    angle = math.radians(26)  # 26.6° is the angle
    turn = Quaternion(ABOUT_Y, angle)
    ground(turn, (8, 2, 0.4))
    depth = 1800 * UNIT[2] * G * math.cos(angle) / STIFF  # to which its weight presses it
    s = O.bodies[box(UNIT, turn * Vector3(0, 0, UNIT[2] / 2 - depth), turn)].state
    prepare()
    until(0.5)
    there = Vector3(s.pos)
    until(2.5)
    # A creep of 1e-6 m in 60 s would be 3e-8 m here.
    assert (s.pos - there).norm() < 1e-12
    assert imbalance() < 0.01


@mark.parametrize("case", [rest, slope])
def test_a_brick_falls_rests_and_slides_as_by_hand(case):
    assert all(row.met is not False for row in case(quick=True))


def test_a_bar_that_turns_meets_what_lay_beside_it():
    """Its end goes down by 12.5 mm, onto a block 10 mm below, while its middle stays where it is:
    pairs are looked for anew."""
    bar = box((1, 0.05, 0.05))
    box((0.1, 0.1, 0.1), (0.45, 0, -0.085))
    contacts = prepare(1e-9, gravity=(0, 0, 0))
    O.step()
    assert contacts.touching() == 0
    O.bodies[bar].state.ori = Quaternion(ABOUT_Y, 0.025) * O.bodies[bar].state.ori
    O.step()
    assert contacts.touching() == 1


#: Turn of the second cube, and how far energy may be off, over what there is.
MEETINGS = {kind: (turn, 1e-3) for kind, turn in TURNS.items()}
#: Faces that are turned by so little that the whole face comes within few steps.
MEETINGS |= {f"tilted by {a}°": (Quaternion(ABOUT_Y, math.radians(a)), 3e-3) for a in (0.1, 1)}

#: Speed [m/s], share of it along the face, offset along the face [m] and density of the second cube
#: [kg/m³].
APPROACHES = [
    (1, 0, (0, 0), 1800),
    (3, 0, (0, 0), 1800),
    (0.01, 0, (0, 0), 18000),
    (1, 0.7, (0.03, 0.01), 180),
]


def meeting(turn, approach, step, phase):
    """Two cubes without gravity, damping and friction. The first meets the second two to three
    steps later."""
    speed, along, aside, density = approach
    edge = 0.1
    one = O.bodies[box((edge,) * 3)].state
    reach = 0.5 * edge * sum(abs(x) for x in turn.toRotationMatrix().row(0))
    other = O.bodies[box((edge,) * 3, (0.05 + reach, *aside), turn, density=density)].state
    contacts = prepare(step, gravity=(0, 0, 0), restitution=1, friction=0)
    other.pos += Vector3((2 + phase) * speed * O.dt, 0, 0)
    one.vel = Vector3(speed, 0, along * speed)
    return contacts, one, other


@mark.parametrize("kind", MEETINGS)
def test_two_cubes_that_meet_keep_momentum_and_energy_at_any_time_step(kind):
    turn, bound = MEETINGS[kind]
    cases = [(s, APPROACHES[n % 4], 0.618 * n % 1) for n, s in enumerate(np.linspace(0.02, 1, 30))]
    cases += [(1, a, phase) for a in APPROACHES for phase in (0, 0.4, 0.8)]
    for step, approach, phase in cases:
        O.reset()
        contacts, one, other = meeting(turn, approach, step, phase)
        before, momentum = kinetic(), one.mass * one.vel
        while contacts.touching() or other.vel[0] <= one.vel[0]:
            O.run(100 if kind == "faces" else 3000, True)
        assert (
            one.mass * one.vel + other.mass * other.vel - momentum
        ).norm() < 1e-12 * momentum.norm()
        after = kinetic()
        assert abs(after / before - 1) < bound, (step, approach, phase)
        assert abs(balance()["error"] - (1 - after / before)) < 2e-4


def test_the_balance_of_faces_that_meet_holds_in_every_step_between():
    for phase in (0.1, 0.5, 0.9):
        O.reset()
        contacts, one, other = meeting(Quaternion.Identity, APPROACHES[0], 0.9, phase)
        pressed = 0
        for _ in range(12):
            O.step()
            pressed += contacts.touching()
            assert imbalance() < 1e-3
        assert pressed >= 2 and contacts.touching() == 0


@mark.parametrize("restitution", [0.3, 0.7])
def test_faces_that_meet_have_the_given_restitution(restitution):
    one = O.bodies[box((0.1, 0.1, 0.1))].state
    other = O.bodies[box((0.1, 0.1, 0.1), (0.105, 0, 0))].state
    prepare(0.02, gravity=(0, 0, 0), restitution=restitution)
    one.vel = Vector3(1, 0, 0)
    until(0.02)
    assert other.vel[0] - one.vel[0] == approx(restitution, rel=0.01)
    assert imbalance() < 1e-3


@mark.parametrize("lift", [1e-3, 1.0], ids=["near", "far"])
def test_what_friction_has_stored_is_lost_when_the_blocks_part(lift):
    """A brick lies 10 µm deep and is shifted by 1 µm, below the limit of friction: k A s²/2 is
    stored. It is lost at once when the brick is lifted, be it so little that both remain a pair of
    neighbours, or so far that they are none.
    """
    depth, slip = 1e-5, 1e-6
    ground()
    s = O.bodies[box(UNIT, (0, 0, UNIT[2] / 2 - depth))].state
    contacts = prepare(1e-9, gravity=(0, 0, 0))
    O.step()
    s.pos += Vector3(slip, 0, 0)
    O.step()
    stored = 0.5 * contacts.tangentialRatio * STIFF * UNIT[0] * UNIT[1] * slip**2
    assert balance()["friction_contacts"] == approx(0, abs=1e-3 * stored)
    s.pos += Vector3(0, 0, lift)
    O.step()
    assert contacts.touching() == 0
    assert balance()["friction_contacts"] == approx(stored, rel=1e-3)


def test_threads_and_a_checkpoint_in_flight_change_no_bit(tmp_path):
    def built():
        O.reset()
        heap(12, abreast=1)
        prepare(0.8, normalStiffness=1e9, restitution=0.3)

    built()
    allowThreads(1)
    O.run(6000, True)
    file = str(tmp_path / "heap.checkpoint")
    assert next(e for e in O.engines if "Contacts" in type(e).__name__).touching() > 3
    saveCheckpoint(file)
    O.run(4000, True)
    expected = bits()
    built()
    allowThreads(2, True)
    try:
        O.run(10000, True)
    finally:
        allowThreads(1)
    assert bits() == expected
    built()
    loadCheckpoint(file)
    O.run(4000, True)
    assert bits() == expected


@mark.parametrize(
    "wrong, message",
    [
        (dict(normalStiffness=0), "normalStiffness 0 Pa/m must be given"),
        (dict(friction=-1), "friction -1 must be given"),
        (dict(restitution=1.5), "restitution 1.5 must be 0.1 to 1"),
        (dict(bodies=[0, 7]), "body 7 does not exist"),
        (dict(bodies=[0, 0]), "body 0 stands in bodies twice"),
    ],
)
def test_what_cannot_be_is_refused(wrong, message):
    ground()
    for act in (O.step, criticalTimeStep):
        with raises(ValueError, match=message):
            O.engines = [ForceResetter(), contacts(**wrong), MasonryIntegrator()]
            act()


def test_the_time_step_that_follows_knows_the_present_stiffness_and_masses():
    """It falls with the root of stiffness over mass, by 10 and by 2."""
    ground()
    s = O.bodies[box(UNIT, (0, 0, UNIT[2] / 2))].state
    contacts = prepare(normalStiffness=1e8)
    there = O.dt
    contacts.follow(0.8)
    assert O.dt == there  # no pair is known yet
    O.run(2, True)
    before = O.dt
    contacts.normalStiffness *= 100
    O.step()
    near = dict(rel=1e-3)  # the part of the faces that is near follows the present places
    assert O.dt == approx(before / 10, **near)
    s.mass, s.inertia = s.mass / 4, s.inertia / 4
    contacts.follow(0.8)
    assert O.dt == approx(before / 20, **near)


@mark.parametrize("share", [5, -1, math.nan])
def test_a_time_step_that_would_not_be_stable_is_not_followed(share):
    ground()
    contacts = prepare()
    with raises(ValueError, match=f"follow: share {share} must be at least 0 and at most 1"):
        contacts.follow(share)


def test_the_engine_stands_after_the_resetter_and_refuses_deformable_units():
    ground()
    box(UNIT, (0, 0, 0.2))
    O.engines = [contacts(), MasonryIntegrator()]
    with raises(ValueError, match="must stand after a ForceResetter"):
        O.step()
    O.engines = [ForceResetter(), *O.engines, MasonryZones(bodies=[1])]
    with raises(ValueError, match="body 1 is a deformable unit"):
        O.step()


@mark.skipif("Polyhedra" not in globals(), reason="this YADE has no Polyhedra")
@mark.parametrize("shapes", ["both", "upper"])
def test_polyhedra_of_yade_are_blocks_too(shapes):
    from yade import polyhedra_utils

    def run(*polyhedra):
        O.reset()
        for n, poly in enumerate(polyhedra):
            size, middle = (0.2, 0.1, 0.1), (0.02 * n, 0, 0.1001 * n)
            if poly:
                low, high = (np.array(middle) + side * np.array(size) / 2 for side in (-1, 1))
                mat = unitMaterial()
                O.bodies.append(polyhedra_utils.polyhedra(mat, v=corners(low, high)))
            else:
                box(size, middle)
        hold(0)
        contacts = prepare()
        O.run(4000, True)
        assert contacts.touching() == 1
        return [tuple(b.state.pos) for b in O.bodies]

    expected = run(False, False)
    found = run(shapes == "both", True)
    assert np.abs(np.array(found) - expected).max() < 1e-9


def test_the_program_of_the_benchmark_prints_its_table():
    program = os.path.join(ROOT, "validation", "benchmark", "heap.py")
    words = ["--blocks", "2", "--seconds", "0.02", "--only", "engine"]
    run = ran([sys.executable, program, *words], timeout=60)
    assert "| time reached, s | 0.02 |" in run.stdout, run.stderr
    # Two bricks of 3.27 kg that have fallen by 2 mm
    assert "| potential energy lost, J | 0.1 |" in run.stdout
