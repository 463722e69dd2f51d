# SPDX-License-Identifier: GPL-2.0-or-later
"""Joints that are about to yield get more points: what they take over, and that the rest of a run
does not notice."""

from hosted import *
from masonry.model.engines import functorLoop
from test_checkpoint import bits
from test_joint_loop import panel

LENGTH, WIDTH, HEIGHT = UNIT
AREA = LENGTH * WIDTH
JOINT = dict(
    **dict(normalStiffness=1e11, shearStiffness=4e10),
    **dict(tensileStrength=0.1e6, modeIFractureEnergy=16),
    **dict(cohesion=0.2e6, modeIIFractureEnergy=160),
    **dict(friction=0.6, residualFriction=0.6),
    **dict(compressiveStrength=8e6, compressiveFractureEnergy=20000),
    **dict(elasticLimitRatio=0.5, peakRatio=20),
)


def couplet(refine=3, inPlane=True, subcontacts=3, rows=None, **properties):
    """Two bricks on each other, the lower one fixed; the upper one moves as :func:`move` says."""
    O.reset()
    unit = unitMaterial(young=1e13, poisson=0.2)
    _, top = pile(material=unit, inPlane=inPlane)
    load = MasonryLoad(body=top, point=(LENGTH / 2, WIDTH / 2, HEIGHT), damped=True, label="load")
    around = dict(damping=0.7, gravity=(0, 0, 0), inPlane=inPlane, loads=[load])
    around.update(subcontacts=subcontacts, rows=rows)
    engines([MasonryJoint(**{**JOINT, **properties})], **around)
    joint = connect()[0]
    loop().points = refine
    O.dt = 0.5 * O.bodies[top].state.mass ** 0.5 / math.sqrt(4 * 1e11 * AREA)
    return joint


def press(force, lever=0.0, shear=0.0):
    """Load the upper brick: a force down [N] at a lever [m] from the middle, and one along x
    [N]."""
    load = engine("load")
    load.force = Vector3(shear, 0, -force)
    load.point = (LENGTH / 2 + lever, WIDTH / 2, HEIGHT)


def resultants(joint):
    """Normal and shear force [N] of the joint's stresses, and their moments about both middle lines
    [N m]."""
    area, stress = np.array(joint.geom.areas), np.array(joint.phys.stress)
    lever = np.array(joint.geom.centres)[:, :2] - (LENGTH / 2, WIDTH / 2)
    return np.array([*area @ stress[:, :2], *(area * stress[:, 0]) @ lever])


def energies(kind):
    return sum(v for name, v in balance().items() if name.startswith(kind))


def ramp(force, lever=0.0, shear=0.0, start=0.0, parts=100, steps=20):
    """Let the load grow from a share of it, and come to rest."""
    for n in range(1, parts + 1):
        share = start + (1 - start) * n / parts
        press(share * force, lever, share * shear)
        run(steps)
    run(500)


LAWS = mark.parametrize("law", ["softening", "cyclic"])


@LAWS
@mark.parametrize("points", [5, 12, 13])
def test_an_elastic_joint_keeps_force_moment_and_energy(law, points):
    results = []
    for refine in (3, points):
        joint = couplet(law=law)
        ramp(60e3, 0.015, 4e3)
        assert not any(max(list(d)) for d in joint.phys.damage)
        assert 0.92 * 4e6 < -np.array(joint.phys.stress)[:, 0].min() < 4e6
        loop().points = refine
        run(10)
        results.append((resultants(joint), energies("elastic"), len(joint.geom.areas)))
        assert abs(loop().refiningEnergy) < 1e-12 * energies("elastic")
    (one, stored, few), (other, kept, many) = results
    assert (few, many) == (3, points)
    assert np.abs(one - other).max() < 1e-9 * np.abs(one[0])
    assert stored == approx(kept, rel=1e-9)


def test_a_joint_gets_its_points_at_nine_tenths_of_the_limit_of_its_cap():
    joint = couplet(refine=12)
    for share, count in ((0.85, 3), (0.95, 12)):
        ramp(share * 4e6 * AREA, start=share - 0.05)
        assert len(joint.geom.areas) == count
    assert loop().refinedJoints == 1


def test_a_joint_that_cannot_crush_gets_its_points_before_it_cracks():
    joint = couplet(refine=12, cap=False)
    ramp(-0.85 * 0.1e6 * AREA)
    assert len(joint.geom.areas) == 3
    ramp(-0.95 * 0.1e6 * AREA, start=0.85)
    assert len(joint.geom.areas) == 12
    assert not any(max(list(d)) for d in joint.phys.damage)


@LAWS
def test_a_cracked_joint_takes_its_crack_along_and_the_balance_closes(law):
    joint = couplet(law=law)
    ramp(12e3, 0.09, 1e3)  # cracked at the far edge
    before = [list(d)[0] for d in joint.phys.damage]
    assert before[0] > 0.1 and before[2] == 0
    lost = energies("dissipated")
    loop().points = 12
    ramp(18e3, 0.09, 1.5e3, start=2 / 3)
    after = [list(d)[0] for d in joint.phys.damage]
    assert len(after) == 12
    assert after[0] >= before[0] and after[-1] == 0
    assert after == sorted(after, reverse=True)  # the crack goes in from one edge
    now = balance()
    assert now["refining"] == loop().refiningEnergy != 0
    assert abs(now["error"]) < 1e-6
    assert energies("dissipated") > lost


# -- a panel: several joints are refined one after the other ---------------------------------------

CASES = {
    "softening": {},
    "cyclic": dict(law="cyclic", shearStiffnessLoss=0.3),
    "cannot crush": dict(cap=False, tensileStrength=0.4e6, cohesion=0.8e6),
    "damped": dict(stiffnessDamping=1e-6),
}


def pushed(refine=12, case="softening", stiffnessDamping=0.0, **more):
    """A panel that is pressed and torn, whose joints have one row of three points."""
    given = {**CASES[case], **more}
    stiffnessDamping = given.pop("stiffnessDamping", stiffnessDamping)
    strength = dict(compressiveStrength=4e6, compressiveFractureEnergy=12000)
    interactions = panel(False, damping=0.3, rows=1, **{**strength, **given})
    loop().points = refine
    if stiffnessDamping:
        loop().stiffnessDamping = stiffnessDamping
        O.dt *= 0.5
    return interactions


def end(interactions):
    sizes = [len(i.geom.areas) for i in interactions]
    return bits(interactions), sizes, loop().refiningEnergy, loop().refinedJoints


@mark.parametrize("case", CASES)
def test_a_run_that_was_saved_goes_on_in_the_same_bits(case, tmp_path):
    path = str(tmp_path / "c")
    interactions = pushed(case=case)
    run(120)
    whole = end(interactions)
    counts = set()
    for at in (5, 15, 25, 45):
        interactions = pushed(case=case)
        run(at)
        counts.add(loop().refinedJoints)
        saveCheckpoint(path)
        there = end(interactions)
        run(120 - at)
        assert end(interactions) == whole

        loadCheckpoint(path)  # back, to fewer points
        assert end(interactions) == there
        run(120 - at)
        assert end(interactions) == whole

        interactions = pushed(case=case)
        loadCheckpoint(path)  # into a new scene, where no joint was refined
        assert end(interactions) == there
        run(120 - at)
        assert end(interactions) == whole
    assert len(counts) > 2 and whole[3] < len(interactions)


def test_joints_keep_their_points_to_the_bit_when_others_are_refined(tmp_path):
    """Points of joints of one size are kept once, where they differ by round-off; those of two
    sizes are not. When all of the second size have got other points, those of the first must stay
    what they were, or no earlier state could be loaded. The same holds when all of the first size
    have got points, and go back to those that they were made with.
    """
    O.reset()
    unit, path = unitMaterial(young=1e13, poisson=0.2), str(tmp_path / "c")
    top = [
        pile(34, x=x, size=(LENGTH, wide * WIDTH, HEIGHT), material=unit, inPlane=True)[-1]
        for wide, x in ((1, 0.1), (2, 1.0))
    ]
    few, load = (
        MasonryLoad(body=body, point=(x + LENGTH / 2, wide * WIDTH / 2, 34 * HEIGHT), label=name)
        for body, x, wide, name in zip(top, (0.1, 1), (1, 2), ("few", "load"))
    )
    joints = join(
        MasonryJoint(**JOINT),
        gravity=(0, 0, 0),
        damping=0.7,
        inPlane=True,
        loads=[few, load],
        subcontacts=3,
    )
    loop().points = 12
    run(1)
    shapes = lambda: [
        np.array([i.geom.areas, *np.transpose(i.geom.centres)]).tobytes() for i in joints
    ]
    before, whole = bits(joints), shapes()
    saveCheckpoint(path)
    load.force = Vector3(0, 0, -0.95 * 4e6 * 2 * AREA)
    run(3000)
    assert loop().refinedJoints == 33
    assert sum(a == b for a, b in zip(shapes(), whole)) == 33
    half, later = str(tmp_path / "h"), shapes()
    saveCheckpoint(half)
    for _ in range(2):
        few.force = Vector3(0, 0, -0.95 * 4e6 * AREA)
        run(3000)
        assert loop().refinedJoints == 66
        loadCheckpoint(half)
        assert shapes() == later
    loadCheckpoint(path)
    assert bits(joints) == before and shapes() == whole


def test_points_that_a_joint_gets_do_not_depend_on_those_beside_it():
    """Equal faces at different heights differ by round-off. A run that is resumed, in which other
    joints have got points before, must give each joint the same ones."""

    def lowest(units):
        O.reset()
        unit = unitMaterial(young=1e13, poisson=0.2)
        top = pile(units, x=0.1, material=unit, inPlane=True)[-1]
        load = MasonryLoad(body=top, point=(0.1 + LENGTH / 2, WIDTH / 2, units * HEIGHT))
        load.force = Vector3(0, 0, -0.95 * 4e6 * AREA)
        around = dict(gravity=(0, 0, 0), damping=0.7, inPlane=True, loads=[load], subcontacts=3)
        joints = join(MasonryJoint(**JOINT), **around)
        loop().points = 12
        run(2000)
        assert loop().refinedJoints == units - 1
        return [(i.geom.areas, i.geom.centres) for i in joints[:7]]

    assert lowest(8) == lowest(34)


def test_a_checkpoint_of_another_scene_leaves_the_points_alone(tmp_path):
    path = str(tmp_path / "c")
    pushed()
    run(240)
    assert loop().refinedJoints > 0
    saveCheckpoint(path)
    interactions = pushed(compressiveFractureEnergy=13000)
    run(1)
    before = end(interactions)
    with raises(ValueError, match="is of another scene: its joints are others"):
        loadCheckpoint(path)
    assert end(interactions) == before


def test_a_scene_that_yade_saves_keeps_the_points(tmp_path):
    path = str(tmp_path / "scene.xml")
    pushed()
    run(200)
    O.save(path)
    areas = lambda: [len(i.geom.areas) for i in O.interactions]
    there, count = areas(), loop().refinedJoints
    run(50)
    ends = O.bodies[1].state.pos
    O.load(path)
    assert areas() == there and loop().refinedJoints == count > 0
    run(50)
    assert (O.bodies[1].state.pos - ends).norm() == 0


def test_any_number_of_threads_gives_the_same_bits():
    ends = []
    for threads in (1, 2, 3):
        allowThreads(threads, True)
        interactions = pushed(size=8)
        run(250)
        ends.append(end(interactions))
    allowThreads(1)
    assert ends[0][3] > 3 and ends[1] == ends[0] == ends[2]


def test_a_panel_with_points_that_come_late_is_one_that_has_had_them_from_the_beginning():
    lost, turned = {}, {}
    for name, (refine, few) in {"few": (3, 3), "refined": (12, 3), "many": (3, 12)}.items():
        pushed(refine, size=6, subcontacts=few)
        run(1000)
        lost[name] = energies("dissipated_compression")
        turned[name] = O.bodies[-1].state.rot()[1]
    for found in (lost, turned):
        assert abs(found["few"] / found["many"] - 1) > 0.3
        # joints that slide before they are about to crush do so at three points
        assert found["refined"] == approx(found["many"], rel=0.02)


def test_files_and_functors_take_joints_with_other_numbers_of_points(tmp_path):
    interactions = pushed()
    run(240)
    sizes = [len(i.geom.areas) for i in interactions]
    assert len(set(sizes)) == 2
    recorder = MasonryVtkRecorder(directory=str(tmp_path))
    found = recorder.joints()
    assert len(found["area"]) == sum(sizes)
    assert sum(found["area"]) == approx(sum(sum(i.geom.areas) for i in interactions))

    functors = functorLoop(loop().geometry, loop().physics)
    kept = [e for e in O.engines if isinstance(e, (MasonryLoad, MasonryEnergy))]
    O.engines = [ForceResetter(), functors, *kept, engine("integrator")]
    run(20)
    # the functors refine none
    assert [len(i.geom.areas) for i in interactions] == sizes
    # without MasonryJointLoop nobody has the energy that joints got when they were refined
    assert imbalance() < 2e-3


# -- joints in space -------------------------------------------------------------------------------


def bent(points, across, force, parts, **how):
    """The couplet in space, pressed by a force that grows, off its middle by so much [m] along both
    sides of the joint."""
    joint = couplet(points, inPlane=False, **how)
    x, y = across
    engine("load").point = Vector3(LENGTH / 2 + x, WIDTH / 2 + y, HEIGHT)
    for n in range(1, parts + 1):
        engine("load").force = Vector3(0, 0, -force * n / parts)
        run(20)
    return joint


@LAWS
@mark.parametrize("points", [4, 5, 8])
def test_an_elastic_joint_in_space_keeps_force_moments_and_energy(law, points):
    found = {}
    for count in (3, points):
        joint = bent(3, (0.01, -0.004), 0.56e5, 100, law=law)
        assert not any(max(list(d)) for d in joint.phys.damage)
        loop().points = count
        run(10)
        assert len(joint.geom.areas) == count**2
        found[count] = [*resultants(joint), energies("elastic")]
        assert abs(loop().refiningEnergy) < 1e-12 * energies("elastic")
    assert found[points][:4] == approx(found[3][:4], abs=1e-9 * 0.56e5)
    assert found[points][4] == approx(found[3][4], rel=1e-9)


@LAWS
def test_a_joint_that_bends_across_is_as_one_that_has_had_its_points_from_the_beginning(law):
    """The crack goes through the thickness of the wall; with three rows the joint turns
    otherwise."""
    turned, errors = {}, {}
    for name, few, points in (("few", 3, 3), ("refined", 3, 9), ("many", 9, 9)):
        bent(points, (0, 0.025), 60e3, 200, subcontacts=few, rows=few, law=law)
        turned[name] = O.bodies[1].state.rot()[0]
        errors[name] = imbalance()
    assert abs(turned["few"] / turned["many"] - 1) > 0.03
    assert turned["refined"] == approx(turned["many"], rel=0.005)
    assert errors["refined"] < max(3 * errors["many"], 1e-6)


def test_joints_that_have_not_their_stiffness_keep_their_points():
    """With two points along a side a joint is three times too stiff against rotation: more would
    change that."""
    couplet(5, inPlane=False, rows=2, cap=False)
    run(20)
    ramp(-0.95 * 0.1e6 * AREA)
    assert loop().refinedJoints == 0


def test_without_a_word_joints_get_eight_points_and_five_a_side_in_space():
    for inPlane, count in ((True, 8), (False, 25)):
        joint = couplet(0, inPlane=inPlane, cap=False)
        ramp(-0.95 * 0.1e6 * AREA)
        assert len(joint.geom.areas) == count


# -- dry joints that open --------------------------------------------------------------------------


def leaning(
    stiffness,
    lever=(0.04, 0.0),
    load=2.5e3,
    law="softening",
    inPlane=True,
    most=0,
    wall=False,
    bracket=0.0,
    **bond,
):
    """The points of the joints of a column of five dry blocks of 0.2 × 0.2 × 0.1 m, which an
    eccentric load presses; beside it a block that is bonded to all of them, by 100 Pa times
    ``bracket``."""
    O.reset()
    unit = unitMaterial(young=1e6 * stiffness, poisson=0.2)
    if wall:  # a structure beside it
        pile(2, x=5, size=(9, 0.2, 0.1), material=unit, inPlane=inPlane)
    top = pile(6, size=(0.2, 0.2, 0.1), material=unit, inPlane=inPlane)[-1]
    kinds = []
    if bracket:
        beside = unitMaterial(young=1e6 * stiffness, poisson=0.2, jointSet="bracket")
        addBlock(box((0.2, 0, 0), (0.1, 0.2, 0.6)), beside, inPlane=inPlane)
        glue = dict(tensileStrength=1e2 * bracket, modeIFractureEnergy=1e-4 * bracket**2)
        glue.update(cohesion=1e3 * bracket, modeIIFractureEnergy=1e-2 * bracket**2, cap=False)
        glue.update(normalStiffness=stiffness, shearStiffness=stiffness, jointSet="bracket")
        kinds.append(MasonryJoint(name="glue", **glue))
    head = MasonryLoad(body=top, point=(0.1 + lever[0], 0.1 + lever[1], 0.6), damped=True)
    dry = dict(tensileStrength=0, cohesion=0, friction=2, residualFriction=2, cap=False, law=law)
    dry.update(normalStiffness=stiffness, shearStiffness=stiffness, **bond)
    around = dict(gravity=(0, 0, 0), damping=0.7, inPlane=inPlane, subcontacts=3)
    joints = join([*kinds, MasonryJoint(**dry)], loads=[head], **around)
    loop().points = most
    head.force = Vector3(0, 0, -load)
    run(3000)
    return [j for j in joints if j.geom.centres[0][0] < 1 and j.geom.normal[2] ** 2 > 0.5]


@LAWS
def test_dry_joints_get_points_where_a_compliant_bed_opens(law):
    for stiffness, count in ((1e9, 14), (1e12, 3)):
        joints = leaning(stiffness, law=law)
        assert {len(j.geom.areas) for j in joints} == {count}
        assert min(max(s[0] for s in j.phys.stress) for j in joints) >= -1e-3  # they are open
    assert {len(j.geom.areas) for j in leaning(1e9, (0.01, 0.0), law=law)} == {3}  # closed
    assert {len(j.geom.areas) for j in leaning(1e9, law=law, most=3)} == {3}
    assert {len(j.geom.areas) for j in leaning(1e12, law=law, most=12)} == {12}  # as was asked for


def test_a_joint_whose_bond_has_cracked_gets_the_points_of_a_dry_one():
    bond = dict(tensileStrength=1e2, modeIFractureEnergy=1e-4)
    bond.update(cohesion=1e3, modeIIFractureEnergy=1e-2)
    assert {len(j.geom.areas) for j in leaning(1e9, **bond)} == {14}
    assert {len(j.geom.areas) for j in leaning(1e12, **bond)} == {8}


@mark.parametrize("bracket", [1, 1e4])
def test_a_bond_bridges_dry_joints_also_when_it_has_cracked(bracket):
    assert {len(j.geom.areas) for j in leaning(1e9, bracket=bracket)} == {3}


def test_a_structure_beside_a_column_does_not_count():
    assert {len(j.geom.areas) for j in leaning(1e9, wall=True)} == {14}


def test_what_continuous_beds_would_hold_less_is_estimated():
    """By the lean at which a linear bed and the weight on it turn a structure over:
    1.8·(σ·H/(kn·W²))^(1/3)."""
    leaning(1e9)
    assert loop().overestimate == 0  # its joints have their points
    leaning(1e12)
    atRest = 1.8 * (2.5e3 / 0.04 * 0.5 / 1e12 / 0.04) ** (1 / 3)
    # the load is put on at once, which presses joints up to twice as much
    assert atRest < loop().overestimate < 2 ** (1 / 3) * atRest


@mark.parametrize(
    "lever, counts", [((0.04, 0), (14, 3)), ((0, 0.04), (3, 14)), ((0.03, 0.03), (8, 8))]
)
def test_in_space_they_get_them_along_the_sides_that_open(lever, counts, tmp_path):
    path = str(tmp_path / "c")
    joints = leaning(1e9, lever, inPlane=False)
    sides = lambda j: tuple(len({round(c[d], 6) for c in j.geom.centres}) for d in (0, 1))
    assert {sides(j) for j in joints} == {counts}
    saveCheckpoint(path)
    there = bits(joints)
    run(20)
    after = bits(joints)
    joints = leaning(1e9, lever, inPlane=False, load=1.0)
    assert {len(j.geom.areas) for j in joints} == {9}
    loadCheckpoint(path)
    assert bits(joints) == there
    run(20)
    assert bits(joints) == after
