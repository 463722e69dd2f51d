# SPDX-License-Identifier: GPL-2.0-or-later
"""The plugin in the running YADE: registration, dispatch, joints between polyhedra, saving."""

import pydoc

import masonry
import yade
from hosted import *
from masonry import _masonry, classes
from masonry.scene import options
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


# -- registration ----------------------------------------------------------------------------------


@mark.parametrize("name", classes)
def test_a_class_stands_in_yade_with_docs_keywords_and_dict(name):
    cls = getattr(yade.wrapper, name)
    assert re.match("Masonry|(Ig2|Ip2|Law2|Gl1|GlExtra)_", name)
    assert len(cls.__doc__) > 60
    instance = cls()
    own = {k: v for k, v in cls.__dict__.items() if isinstance(v, property)}
    for attribute, value in own.items():
        assert len(value.__doc__) > 10, attribute
    assert cls(**{}).dict().keys() == instance.dict().keys()
    with raises(AttributeError, match="nonsense"):
        cls(nonsense=1)
    with raises(ValueError, match="keyword arguments only"):
        cls(1)


def test_every_member_of_the_joint_properties_is_described_once():
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


@mark.parametrize("name", classes)
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
    table = [(1, 0), (3, 0.5), (9, 1)]
    joint = MasonryJoint(tensionTable=table)
    assert joint.tensionTable == table == joint.softening()["tension"]
    assert len(MasonryJoint().softening()["tension"]) == 201
    brittle = joint.brittleCoulomb()
    assert not brittle.cap and len(brittle.softening()["shear"]) == 2 and joint.cap


def test_plugin_package_and_help_name_one_version_and_the_help_of_a_scene_the_commit():
    assert _masonry.version == masonry.__version__
    assert masonry.__version__ in pydoc.render_doc(masonry, renderer=pydoc.plaintext)
    last = options.parser("a wall", until=12).format_help().splitlines()[-1]
    assert last == f"masonry {masonry.__version__}, commit {masonry.commit}"


# -- joints ----------------------------------------------------------------------------------------


@mark.parametrize("seed", range(5))
def test_a_joint_in_any_orientation_has_the_overlap_as_area(seed):
    turn = randomTurn(seed)
    geom = pair(turn, offset=(0.07, 0.03, UNIT[2]), subcontacts=3, rows=2).geom
    assert len(geom.areas) == 6
    assert sum(geom.areas) == approx((0.22 - 0.07) * (0.102 - 0.03), rel=1e-9)
    assert (geom.normal - turn * Vector3(0, 0, 1)).norm() < 1e-9


@mark.parametrize("seed", range(3))
def test_connect_finds_the_face_that_the_functor_finds(seed):
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
    with raises(KeyError):
        connect(fail)  # at the first joint, so the face of the second one is not taken
    O.bodies[2].state.pos += Vector3(0, 0, 1)
    with raises(ValueError, match="bodies 1 and 2 share no face"):
        utils.createInteraction(1, 2)


def test_direction_joint_set_and_the_users_rule_choose_the_joint():
    unit = unitMaterial()
    support = unitMaterial(jointSet="support")
    addBlock(box((0, 0, -0.081), (0.44, 0.102, 0.081)), support)
    for corner in ((0, 0, 0), (0.22, 0, 0), (0, 0, 0.081), (0.22, 0, 0.081)):
        addBlock(box(corner), unit)
    special = MasonryJoint(name="special")
    held = MasonryJoint(name="support", jointSet="support", elastic=True)
    bed = MasonryJoint(name="bed", direction=(0, 0, 1))
    engines([held, bed, MasonryJoint(name="head", direction=(-1, 0, 0))])
    connect(lambda b1, b2, geom: special if {b1.id, b2.id} == {3, 4} else None)
    pairs = (0, 1), (0, 2), (1, 2), (1, 3), (2, 4), (3, 4)
    names = [O.interactions[pair].phys.joint.name for pair in pairs]
    assert names == ["support", "support", "head", "bed", "bed", "special"]


def test_rigid_units_are_lumped_in_series():
    phys = pair().phys
    # See yade_plugin/law/README.md, rigid units.
    assert phys.normalStiffness == approx(5.04e10, rel=1e-3)
    assert phys.shearStiffness == approx(2.17e10, rel=2e-3)


# -- mechanics -------------------------------------------------------------------------------------


def test_a_turned_scene_gives_the_turned_answer():
    found = []
    for turn in (Quaternion.Identity, Quaternion(0.3, -0.5, 0.7, 0.4).normalized()):
        O.reset()
        joint = pair(turn, damping=0, subcontacts=3, rows=3)
        s = O.bodies[1].state
        s.vel = turn * Vector3(0.001, 0.0007, -0.002)
        spin(s, turn * Vector3(0.01, -0.02, 0.015))
        run(400)
        normal = np.sort([stress[0] for stress in joint.phys.stress])
        found.append((turn.conjugate() * s.pos, normal))
    (place, stresses), (turned, again) = found
    assert (place - turned).norm() < 1e-12
    assert np.abs(stresses - again).max() < 1e-5 * np.abs(stresses).max() > 0.01


# -- saving ----------------------------------------------------------------------------------------


@mark.parametrize("extension", [".xml", ".yade.gz"])
@mark.parametrize("law", ["softening", "cyclic"])
def test_a_run_saved_in_the_middle_goes_on_the_same(tmp_path, law, extension):
    table = [(1, 0), (40, 0.6), (400, 1)]
    joint = MasonryJoint(name="mine", law=law, tensionTable=table)
    pair(joints=joint, inPlane=True, damping=0.3)
    O.bodies[1].state.blockedDOFs = "yXZ"
    driven = dict(point=(0.11, 0.051, 0.162), driven=True, velocity=0.01)
    insert(MasonryLoad(body=1, label="load", **driven))
    run(2000)
    path = str(tmp_path / ("run" + extension))
    O.save(path)

    def state():
        looks = lambda s: (list(s.v), s.triangles, s.volume, s.inertia, s.color)
        phys, jumps = O.interactions[0, 1].phys, O.interactions[0, 1].geom.jumps
        known = phys.stress, phys.damage, phys.slip, phys.regime, phys.dissipated, jumps
        shapes = [looks(b.shape) for b in O.bodies]
        return O.time, engine("load").reaction, *known, balance(), shapes

    run(2000)
    there = state()
    assert any(d[0] > 0 for d in there[3])
    O.load(path)
    joint, mat = O.interactions[0, 1].phys.joint, O.bodies[1].mat
    assert (joint.name, joint.law, joint.tensionTable) == ("mine", law, table)
    assert (mat.young, mat.density) == (4.8e9, 1800)
    run(2000)
    assert state() == there
