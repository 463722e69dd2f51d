# SPDX-License-Identifier: GPL-2.0-or-later
"""``--set`` and ``--field`` of ties, springs, fibre layers, beams and floors: what they change, and
what is refused."""

from hosted import *
from masonry.materials import fields

WIDTH, DEPTH, HEIGHT = 0.4, 0.3, 1.6  # of a block [m]
LEVEL = 1.2  # of the tie [m]


def tied(tmp_path, *words):
    """A tall block on a platen on springs, with a tie, and a wall of two bricks with a fibre layer
    beside it."""
    stack = bricks.stack(1, (WIDTH, DEPTH, HEIGHT)) + bricks.stack(3, (0.4, 0.3, 0.2)).moved(2)
    stones = materials.dry(5.0, normalStiffness=1e11)
    scene = lean(tmp_path, stack, stones, *words, plane=False)
    base = scene.platen("bottom", springs={"x": 5e7})
    at = lambda x: (x, DEPTH / 2, LEVEL)
    tie = scene.tie(at(0.2), anchor=at(-3.0), stiffness=1e7, strength=500.0, name="wire")
    soil = scene.spring((2.2, 0.15, 0.5), stiffness=(0, 3e6, 0), name="soil")
    layer = scene.overlay(
        (0, -1, 0), stiffness=4e6, strength=40e3, gauge=0.2, strain=0.02, name="textile"
    )
    return scene, base, tie, soil, layer


def test_values_of_the_command_line_replace_those_of_the_scene(tmp_path):
    words = "wire.strength=1e3 wire.stiffness=2e7 wire.prestress=100 soil.stiffness_y=4e6 "
    words += "base_spring.stiffness_x=6e7 textile.stiffness=8e6 textile.strain=0.01"
    words = [f"--set={word}" for word in words.split()]
    scene, _, tie, soil, layer = tied(tmp_path, *words)
    before = layer.ties[0].stiffness
    scene.settle()
    assert (tie.strength, tie.stiffness, tie.prestress) == (1e3, 2e7, 100)
    assert soil.stiffness == (0, 4e6, 0)
    assert layer.ties[0].stiffness == approx(2 * before, rel=1e-12)
    assert {one.breaking for one in layer.ties} == {0.01}
    ties = ofKind(MasonryTies)
    assert ties.strength[0] == 1e3 and ties.stiffness[0] == 2e7
    assert ties.rest[0] == approx(-100 / 2e7)
    scene.finish()
    run = readRun(tmp_path)
    assert run["ties"][0]["strength_N"] == 1e3
    assert run["overlays"][0]["stiffness_N_per_m"] == 8e6
    stiffness = {one["name"]: one["stiffness_N_per_m"] for one in run["springs"]}
    assert stiffness == {"base_spring": [6e7, 0, 0], "soil": [0, 4e6, 0]}


def test_a_field_gives_each_bundle_and_each_tie_its_own_value(tmp_path):
    names = "textile.strength+wire.strength+bed.friction"
    field = f"--field={names}=lognormal(cov=0.3,length=0,seed=4)"
    scene, _, tie, _, layer = tied(tmp_path, field)
    before = [one.strength for one in layer.ties]
    scene.settle()
    shares = [one.strength / b for one, b in zip(layer.ties, before)]
    assert len(set(shares)) == len(shares) and tie.strength != 500
    factor = fields.lognormal(0.3, 0, 4)
    assert tie.strength == approx(500 * factor(-1.4, DEPTH / 2, LEVEL))
    assert shares[0] == approx(factor(*layer.ties[0].place()))


@mark.parametrize(
    "word, text",
    [
        ("--set=wyre.strength=1", "no joint, beam, tie, spring or fibre layer 'wyre', there are "),
        (
            "--set=wire.stength=1",
            (
                "a tie has no such property, there are stiffness, strength, prestress, slack,"
                " breaking, did you mean 'strength'?"
            ),
        ),
        ("--set=wire.strength=-2", "wire: strength -2.0 N must be above 0"),
        ("--set=wire.strength=much", "--set wire.strength=much: must be a number"),
        ("--set=wire.prestress=600", "wire: prestress 600 N must be below its strength, 500 N"),
        ("--set=soil.stiffness_x=1", "a spring has no such property, there are stiffness_y"),
        ("--set=soil.stiffness=1", "did you mean 'stiffness_y'?"),
        (
            "--set=textile.gauge=1",
            "a fibre layer has no such property, there are stiffness, strength, strain",
        ),
        ("--field=wyre.strength=lognormal(cov=0.3,length=0,seed=4)", "no property 'wyre.strength'"),
        (
            "--field=wire.length=lognormal(cov=0.3,length=0,seed=4)",
            "wire.length: a tie has no such property",
        ),
        (
            "--field=wire.breaking=lognormal(cov=0.3,length=0,seed=4)",
            "wire: breaking was not given, so nothing can vary about it",
        ),
    ],
)
def test_what_cannot_be_set_is_refused(tmp_path, capsys, word, text):
    scene, *_ = tied(tmp_path, word)
    with raises(SystemExit):
        scene.settle()
    said = capsys.readouterr().err.strip()
    assert len(said.splitlines()) == 1 and text in said
    if "wyre" in word and "--set" in word:
        names = "bed support base_spring soil textile wire".split()
        assert all(name in said for name in names)


def test_a_tie_with_the_name_of_a_joint_is_refused(tmp_path):
    scene, *_ = tied(tmp_path)
    with raises(Refused, match="there is a 'bed' already"):
        scene.tie((0.2, 0.1, 1), anchor=(5, 0.1, 1), stiffness=1e6, name="bed")


def sag(tmp_path, *words):
    """Sag of a cantilever [m]."""
    made = bricks.Beam((0, 0, 0), 2.0, 0.1, 0.2, pieces=9, name="ring")
    stones = materials.dry(0.6).withBeam(made, young=10e9, density=500)
    scene = lean(tmp_path, made, stones, *words, gravity=0.0)
    scene.hold(0)
    tip = scene.handle(8)
    scene.load(tip, (0, 0, -1e3))
    scene.settle()
    return -scene.model.supports.moved(tip)[0][2]


def test_a_beam_twice_as_stiff_sags_half_as_much_also_among_deformable_bricks(tmp_path):
    found = []
    for words in ([], ["--set=ring.young=20e9"], ["--blocks=deformable"]):
        found.append(sag(tmp_path, *words))
        letGo()
    # settle() ends within 1 % of rest
    assert found[0] == approx(2 * found[1], rel=0.01) == approx(found[2], rel=0.01)


@mark.parametrize(
    "word, text",
    [
        ("--set=ring.normalStiffness=1e9", "has no such property, there are young, de"),
        ("--set=ring.young=0", "ring: young 0.0 Pa must be above 0"),
        ("--field=ring.young=lognormal(cov=0.3,length=0,seed=4)", "has its young and"),
        ("--field=ring.x=lognormal(cov=0.3,length=0,seed=4)", "its density all over"),
    ],
)
def test_what_has_no_effect_on_a_beam_is_refused(tmp_path, capsys, word, text):
    with raises(SystemExit):
        sag(tmp_path, word)
    assert text in capsys.readouterr().err


STUDY = """
from masonry_study import Study, field, lognormal, normal

study = Study(scene="scene.py", runs=3, seed=1, vary={vary})
"""
SCENE = """
from masonry import Scene, bricks, materials

stack = bricks.stack(1, (0.4, 0.3, 1.6))
scene = Scene("tied", stack, materials.dry(5.0, normalStiffness=1e11))
scene.platen("bottom")
scene.tie((0.2, 0.15, 1.2), anchor=(-3, 0.15, 1.2), stiffness=1e7, strength=500.0, name="wire")
scene.settle()
scene.accelerate(0.5, towards=(1, 0, 0))
scene.finish()
"""


def prepared(tmp_path, vary):
    """The process that prepares a study of a block with a tie, and its table."""
    (tmp_path / "scene.py").write_text(SCENE)
    (tmp_path / "study.py").write_text(STUDY.replace("{vary}", vary))
    out = str(tmp_path / "out")
    command = [sys.executable, "-m", "masonry_study", "study.py", "--out", out]
    done = subprocess.run([*command, "--prepare"], cwd=tmp_path, capture_output=True, text=True)
    table = os.path.join(out, "table.txt")
    return done, open(table).read() if os.path.exists(table) else ""


def test_studies_vary_ties(tmp_path):
    done, table = prepared(
        tmp_path, '{"wire.strength": lognormal(500, 0.2), "wire.stiffness": field(cov=0.1)}'
    )
    assert done.returncode == 0, done.stderr
    head = table.splitlines()[0]
    assert "wire.strength" in head and "field:wire.stiffness" in head.replace("!", "")


@mark.parametrize(
    "vary, text",
    [
        (
            '{"wire.strength": normal(500, 0.5)}',
            (
                "gives impossible values in 2.3 % of all rows: it must be at least 0 and at most"
                " 1e+15 N"
            ),
        ),
        (
            '{"wyre.strength": lognormal(500, 0.2)}',
            (
                "no joint, beam, tie, spring or fibre layer 'wyre', there are bed, support, crack,"
                " wire"
            ),
        ),
    ],
)
def test_studies_name_what_a_tie_cannot_have(tmp_path, vary, text):
    done, table = prepared(tmp_path, vary)
    assert done.returncode != 0 and not table
    assert text in " ".join(done.stderr.split())
