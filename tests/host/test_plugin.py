# SPDX-License-Identifier: GPL-2.0-or-later
"""The plugin in the running YADE: registration, dispatch, joints between polyhedra, saving."""

import yade
from hosted import *
from masonry import classes, touchingPairs
from yade import utils


def randomTurn(seed):
    rng = random.Random(seed)
    return Quaternion(*[rng.gauss(0, 1) for _ in range(4)]).normalized()


def pair(turn=Quaternion.Identity, offset=(0, 0, UNIT[2]), joints=None, **kw):
    """A fixed brick and a free one on it; returns the interaction."""
    for place in ((0, 0, 0), offset):
        addBlock(box(place, turn=turn), unitMaterial())
    hold(0)
    (interaction,) = join(joints, gravity=(0, 0, 0), **kw)
    return interaction


def drive(velocity):
    """Drive the top of the upper brick sideways; returns the load."""
    point = (0.11, 0.051, 0.162)
    given = dict(driven=True, velocity=velocity, label="load")
    return insert(MasonryLoad(body=1, point=point, **given))


# -- registration -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", classes)
def test_a_class_stands_in_yade_with_docs_keywords_and_dict(name):
    cls = getattr(yade.wrapper, name)
    assert re.match("Masonry|(Ig2|Ip2|Law2|Gl1|GlExtra)_", name)
    assert len(cls.__doc__) > 60
    instance = cls()
    own = {k: v for k, v in cls.__dict__.items() if isinstance(v, property)}
    for attribute, value in own.items():
        assert len(value.__doc__) > 10, attribute
    assert cls(**{}).dict().keys() == instance.dict().keys()
    with pytest.raises(AttributeError, match="nonsense"):
        cls(nonsense=1)
    with pytest.raises(ValueError, match="keyword arguments only"):
        cls(1)


def test_every_member_of_the_joint_properties_is_described_once():
    """Adding a property is its member and its description: none is forgotten, none is described twice."""
    path = os.path.join(ROOT, "yade_plugin", "law", "common", "JointProperties.hpp")
    header = open(path).read()
    struct = header[header.index("struct JointProperties {") :]
    struct = struct[: struct.index("\n};")]
    member = r"^    (?:double|bool|std::string|std::vector<TableRow>) (\w+)(?: = .*)?;"
    members = re.findall(member, struct, re.MULTILINE)
    described = [p["name"] for p in MasonryJoint.properties()]
    assert len(members) > 20
    assert sorted(described) == sorted([*members, "jointSet", "direction"])
    assert set(described) == set(MasonryJoint().dict())


@pytest.mark.parametrize("name", classes)
def test_the_description_of_an_attribute_is_what_its_docs_say(name):
    cls = getattr(yade.wrapper, name)
    report = cls.properties()
    assert len({p["name"] for p in report}) == len(report)
    for p in report:
        doc = getattr(cls, p["name"]).__doc__
        assert doc.startswith(p["meaning"]) and len(p["meaning"]) > 3
        assert not p["unit"] or f"[{p['unit']}]" in doc
        assert not p["source"] or p["source"] in doc
        assert p["low"] <= p["high"] and p["usual_low"] <= p["usual_high"]
        value = getattr(cls(), p["name"])
        if isinstance(value, float):
            assert p["unit"], p["name"]
            assert ":ydefault:`" in doc or cls not in (MasonryMat, MasonryJoint)
            assert p["low"] <= value <= p["high"], p["name"]


def test_tables_of_the_user_are_kept_and_used():
    joint = MasonryJoint(tensionTable=[(1, 0), (3, 0.5), (9, 1)])
    assert (
        joint.tensionTable == [(1, 0), (3, 0.5), (9, 1)] == joint.softening()["tension"]
    )
    assert len(MasonryJoint().softening()["tension"]) == 201
    brittle = joint.brittleCoulomb()
    assert not brittle.cap and len(brittle.softening()["shear"]) == 2 and joint.cap


# -- joints -----------------------------------------------------------------------------------------------------------


def test_every_joint_is_found_once_and_no_other():
    mat = MasonryMat(density=1800)
    for course in range(3):
        for column in range(3):
            addBlock(box((0.22 * column + 0.11 * (course % 2), 0, 0.081 * course)), mat)
    pairs = touchingPairs()
    assert len(pairs) == len(set(pairs)) == 3 * 2 + 2 * 5
    assert all(a < b for a, b in pairs)


@pytest.mark.parametrize("seed", range(5))
def test_a_joint_in_any_orientation_has_the_overlap_as_area(seed):
    turn = randomTurn(seed)
    geom = pair(turn, offset=(0.07, 0.03, UNIT[2]), subcontacts=3, rows=2).geom
    assert len(geom.areas) == 6
    assert sum(geom.areas) == pytest.approx((0.22 - 0.07) * (0.102 - 0.03), rel=1e-9)
    assert (geom.normal - turn * Vector3(0, 0, 1)).norm() < 1e-9


@pytest.mark.parametrize("seed", range(3))
def test_a_joint_takes_the_face_that_connect_has_found_as_the_functor_alone_finds_it(
    seed,
):
    geometry = lambda g: (g.normal, g.tangent, g.polygon, g.centres, g.areas)
    offset = (0.07, 0.03, UNIT[2])
    connected = geometry(pair(randomTurn(seed), offset, functors=True).geom)
    O.interactions.erase(0, 1)
    O.interactions.eraseNonReal()
    assert geometry(utils.createInteraction(0, 1).geom) == connected


def test_no_face_that_was_found_outlives_connect():
    def fail(body1, body2, geom):
        raise KeyError("rule")

    pile(3)
    engines([MasonryJoint()], functors=True)
    with pytest.raises(KeyError):
        connect(fail)  # at the first joint, so the face of the second one is not taken
    O.bodies[2].state.pos += Vector3(0, 0, 1)
    with pytest.raises(ValueError, match="bodies 1 and 2 share no face"):
        utils.createInteraction(1, 2)


def test_direction_joint_set_and_the_users_rule_choose_the_joint():
    unit = unitMaterial()
    support = unitMaterial(jointSet="support")
    addBlock(box((0, 0, -0.081), (0.44, 0.102, 0.081)), support)
    for corner in ((0, 0, 0), (0.22, 0, 0), (0, 0, 0.081), (0.22, 0, 0.081)):
        addBlock(box(corner), unit)
    special = MasonryJoint(name="special")
    engines(
        [
            MasonryJoint(name="support", jointSet="support", elastic=True),
            MasonryJoint(name="bed", direction=(0, 0, 1)),
            MasonryJoint(name="head", direction=(-1, 0, 0)),
        ]
    )
    connect(lambda b1, b2, geom: special if {b1.id, b2.id} == {3, 4} else None)
    pairs = (0, 1), (0, 2), (1, 2), (1, 3), (2, 4), (3, 4)
    names = [O.interactions[pair].phys.joint.name for pair in pairs]
    assert names == ["support", "support", "head", "bed", "bed", "special"]


def test_rigid_units_are_lumped_in_series():
    phys = pair().phys
    # See yade_plugin/law/README.md, rigid units.
    assert phys.normalStiffness == pytest.approx(5.04e10, rel=1e-3)
    assert phys.shearStiffness == pytest.approx(2.17e10, rel=2e-3)


# -- mechanics --------------------------------------------------------------------------------------------------------


def kick(turn=Quaternion.Identity, steps=400, **kw):
    interaction = pair(turn, damping=0, subcontacts=3, rows=3, **kw)
    s = O.bodies[1].state
    s.vel = turn * Vector3(0.001, 0.0007, -0.002)
    spin(s, turn * Vector3(0.01, -0.02, 0.015))
    run(steps)
    return interaction


def test_a_turned_scene_gives_the_turned_answer():
    straight = kick()
    stresses, position = straight.phys.stress, O.bodies[1].state.pos
    O.reset()
    turn = Quaternion(0.3, -0.5, 0.7, 0.4).normalized()
    again = kick(turn)
    assert (O.bodies[1].state.pos - turn * position).norm() < 1e-12
    size = max(s.norm() for s in stresses)
    assert size > 1e3
    ends = [sorted(s[0] for s in each) for each in (stresses, again.phys.stress)]
    assert np.abs(np.subtract(*ends)).max() < 1e-5 * size


def test_forces_and_torques_of_a_joint_balance():
    kick(steps=100)
    f = [O.forces.f(i, True) for i in (0, 1)]
    t = [O.forces.t(i, True) for i in (0, 1)]
    arm = [O.bodies[i].state.pos for i in (0, 1)]
    # The bodies moved at the end of the last step, after the forces were found. No other difference may remain.
    moved = O.bodies[1].state.vel.norm() * O.dt
    assert f[0].norm() > 10
    assert (f[0] + f[1]).norm() < 1e-9 * f[0].norm()
    rest = t[0] + t[1] + arm[0].cross(f[0]) + arm[1].cross(f[1])
    assert rest.norm() < 2 * moved * f[0].norm()


def test_a_block_that_turns_about_axes_of_its_own_keeps_its_energy():
    turn = Quaternion(0.3, -0.5, 0.7, 0.4).normalized()
    pair(turn, joints=MasonryJoint(elastic=True), damping=0, subcontacts=3, rows=3)
    s, w = O.bodies[1].state, Vector3(0.05, -0.02, 0.08)
    spin(s, w)
    O.dt *= 0.2
    start = 0.5 * w.dot(s.angMom)
    for _ in range(20):
        run(200)
        b = balance()
        stored = sum(b["elastic_" + mode] for mode in ("tension", "compression", "shear"))  # fmt: skip
        assert b["kinetic"] + stored == pytest.approx(start, rel=5e-3)


def test_damping_takes_what_is_lost():
    pair(damping=0.5)
    O.engines[-1].gravity = (0, 0, -9.81)
    run(3000)
    b = balance()
    weight, area = O.bodies[1].state.mass * 9.81, 0.22 * 0.102
    sag = weight / (area * O.interactions[0, 1].phys.normalStiffness)
    assert b["gravity"] == pytest.approx(weight * sag, rel=1e-3)
    assert b["elastic_compression"] == pytest.approx(0.5 * weight * sag, rel=1e-3)
    assert b["damping"] == pytest.approx(0.5 * weight * sag, rel=1e-3)
    assert abs(b["error"]) < 1e-6


def test_a_driven_point_keeps_its_velocity_while_the_block_turns():
    pair(inPlane=True, damping=0.8)
    O.bodies[1].state.blockedDOFs = "yXZ"
    load = drive(0.002)
    run(2000)
    assert load.displacement()[0] == pytest.approx(0.002 * O.time, rel=1e-4)
    assert abs(O.bodies[1].state.angVel[1]) > 1e-4
    assert abs(balance()["error"]) < 1e-5


@pytest.mark.parametrize("damping", [0, 0.3, 0.8, 0.95])
@pytest.mark.parametrize("fraction", [0.8, 0.95, 0.99])
def test_the_time_step_bound_holds_with_damping(damping, fraction):
    pair(joints=MasonryJoint(elastic=True), damping=damping)
    O.engines[-1].gravity = (0, 0, -9.81)
    O.dt = fraction * criticalTimeStep()[0]
    weight, phys = O.bodies[1].state.mass * 9.81, O.interactions[0, 1].phys
    sag = weight / (0.22 * 0.102 * phys.normalStiffness)
    # In the leapfrog scheme the vibration about the static place has the amplitude sag / sqrt(1 - fraction²). Damping
    # makes it smaller.
    swing = 1.05 * sag / math.sqrt(1 - fraction**2)
    for _ in range(5000):
        O.step()
        assert abs(O.bodies[1].state.pos[2] - 1.5 * UNIT[2] + sag) < swing
    if damping:
        assert O.bodies[1].state.pos[2] - 1.5 * UNIT[2] == pytest.approx(-sag, rel=1e-3)


# -- saving -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("extension", [".xml", ".yade.gz"])
def test_a_run_saved_in_the_middle_goes_on_as_if_nothing_had_happened(
    tmp_path, extension
):
    table = [(1, 0), (40, 0.6), (400, 1)]
    pair(
        joints=MasonryJoint(name="mine", tensionTable=table), inPlane=True, damping=0.3
    )
    O.bodies[1].state.blockedDOFs = "yXZ"
    drive(0.01)
    run(2000)
    path = str(tmp_path / ("run" + extension))
    O.save(path)

    def state():
        phys, jumps = O.interactions[0, 1].phys, O.interactions[0, 1].geom.jumps
        known = phys.stress, phys.damage, phys.slip, phys.regime, phys.dissipated, jumps
        return O.time, O.iter, engine("load").reaction, *known, balance()

    run(2000)
    there = state()
    assert any(d[0] > 0 for d in there[4])
    O.load(path)
    joint, mat = O.interactions[0, 1].phys.joint, O.bodies[1].mat
    assert (joint.name, joint.tensionTable) == ("mine", table)
    assert (mat.young, mat.density) == (4.8e9, 1800)
    run(2000)
    assert state() == there
