# SPDX-License-Identifier: GPL-2.0-or-later
"""What a script says of its options holds unless the command line gives them, however they are
read."""

from usual import *
from masonry import Scene, bricks, materials
from masonry.run.presets import PRESETS
from masonry.scene import options

#: Options with two values, as words and as Python has them.
VALUES = {
    "rate": (7.0, 100.0),
    "until": (3.0, 4.0),
    "damping": (0.3, 0.5),
    "points": ("4", "5"),
    "joints": ("brittle", "cyclic"),
    "crack_surfaces": ("off", "on"),
    "vtk_every": (0.5, 2.0),
    "record": ("one.AT2", "other.AT2"),
    "scale": (2.0, 0.5),
}


forms = mark.parametrize("form", ["own", "list"])


def made(form, words, **usual):
    """The options of a scene: of a list of words, or of a parser of its own."""
    if form == "own":
        parser = options.parser("own", until=30, rate=5)
        parser.add_argument("--level", type=int, default=3, help="of its load")
        words = parser.parse_args(words)
    blocks, stones = bricks.stack(2, (0.2, 0.1, 0.1)), materials.dry(0.5)
    return Scene("said", blocks, stones, arguments=words, **usual).args


def wordsOf(chosen):
    return [f"--{o.replace('_', '-')}={v}" for o, v in chosen.items()]


chosen = some.sets(some.sampled_from(sorted(VALUES)))


@given(form=some.sampled_from(["own", "list"]), script=chosen, line=chosen)
@settings(max_examples=100)
def test_the_script_holds_and_the_command_line_wins(form, script, line):
    said = {option: VALUES[option][0] for option in script}
    typed = {option: VALUES[option][1] for option in line}
    plain = vars(made(form, []))
    args = made(form, wordsOf(typed), **said)
    assert {o: vars(args)[o] for o in VALUES} == {**{o: plain[o] for o in VALUES}, **said, **typed}
    assert set(vars(args)) == set(plain)  # what a checkpoint and run.json hold


@forms
def test_one_note_says_what_the_command_line_wins_over(form, capsys):
    made(
        form,
        ["--rate", "7", "--damping", "0.5", "--until", "2"],
        rate=100,
        damping=0.3,
        joints="brittle",
    )
    said = capsys.readouterr().out
    assert (
        said == "note: the command line wins: --rate 7.0, --damping 0.5; the scene has rate 100.0,"
        " damping 0.3\n"
    )
    made(form, ["--rate", "100"], rate=100)
    assert not capsys.readouterr().out


@forms
@mark.parametrize(
    "words, usual, until, path",
    [
        ([], {"history": "1,2"}, None, "1,2"),
        (["--until", "3"], {"history": "1,2"}, 3, None),
        (["--history", "1,2x2"], {"until": 3}, None, "1,2x2"),
        (["--history", "1,2x2"], {"history": "1"}, None, "1,2x2"),
        ([], {"until": 4}, 4, None),
    ],
)
def test_until_and_history_exclude_each_other(form, words, usual, until, path):
    args = made(form, words, **usual)
    assert args.until == until and (args.history and args.history["text"]) == path


@forms
def test_settings_of_the_script_come_before_those_of_the_command_line(form):
    args = made(form, ["--set", "bed.friction=0.4"], set=["bed.friction=0.3", "bed.cohesion=0"])
    assert [value for *_, value in args.set] == ["0.3", "0", "0.4"]


@forms
def test_a_preset_wins_over_the_script_and_says_so(form, capsys):
    args = made(form, ["--preset", "fast", "--damping", "0.7"], rate=50, damping=0.3)
    assert (args.rate, args.damping) == (PRESETS["fast"]["rate"], 0.7)
    assert args.overrides == ["damping"]
    said = capsys.readouterr().out
    assert "note: --preset fast: rate is 100.0, the scene has 50.0" in said
    args = made(form, [], preset="accurate")
    assert {o: getattr(args, o) for o in PRESETS["accurate"]} == PRESETS["accurate"]
    assert args.overrides == []


@forms
@mark.parametrize(
    "words, overrides",
    [
        ([], []),
        (["--rate", "100", "--damping", "0.8"], []),  # what the preset has
        (["--rate", "20"], ["rate"]),
        (["--until", "3"], []),  # what the script has
        (["--joints", "softening"], []),  # what everybody has
        (["--joints", "cyclic", "--until", "4"], ["joints"]),  # how far is free
    ],
)
def test_only_what_differs_from_preset_and_script_goes_beside_a_preset(form, words, overrides):
    args = made(form, words, preset="fast", until=3.0)
    assert args.rate == (20 if "rate" in overrides else 100)
    assert args.overrides == overrides


@forms
def test_keywords_are_checked_with_all_problems_at_once(form):
    wrong = dict(
        joints="britle",
        rate=-50,
        rat=3,
        lean=1,
        resume="x",
        points=2.5,
        out=[],
        damping=True,
        set="bed=1",
        until=1,
        history="1",
    )
    with raises(Refused) as refused:
        made(form, [], **wrong)
    said = str(refused.value)
    for part in """\
scene said: joints: 'britle' must be one of softening, cyclic, brittle, did you mean 'brittle'?
rate: -50.0 mm/s must be at least 0.001 and at most 1000
no option rat; did you mean rate?
lean: 1 must be True or False
no option resume; --resume is for the command line alone
points: '2.5' must be a whole number
out: [] must be a number or a text
damping: True must be a number or a text
set: 'bed=1' must read JOINT.PROPERTY=VALUE
until and history: give one of them""".splitlines():
        assert part in said, part


def test_options_of_a_parser_serve_several_scenes():
    args = options.parser("own", until=30, rate=5).parse_args([])
    blocks, stones = bricks.stack(2, (0.2, 0.1, 0.1)), materials.dry(0.5)
    Scene("one", blocks, stones, arguments=args, rate=50, preset="accurate")
    assert args.rate == 50 and args.blocks == "deformable"
    Scene("two", blocks, stones, arguments=args, damping=0.3)
    assert (args.rate, args.blocks, args.damping, args.preset) == (5, "rigid", 0.3, None)


def test_an_option_of_the_scene_itself_can_be_a_keyword():
    assert made("own", [], level=5).level == 5
    with raises(Refused, match="no option level; there are accuracy, added_inertia, "):
        made("list", [], level=5)


SCENE = """
from masonry import Scene, bricks, materials
from masonry.scene.options import parser
import clay

args = parser("own", until=1).parse_args()
blocks, stone = bricks.stack(2, clay.SIZE), materials.dry(0.5)
scene = Scene("resumed", blocks, stone, arguments=args, damping=0.7, plane=True)
scene.platen("bottom")
scene.settle()
scene.run(0.01)
scene.finish()
"""


def test_a_module_beside_the_scene_is_found_and_its_run_is_resumed(tmp_path):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "scenes" / "scene.py").write_text(SCENE)
    (tmp_path / "scenes" / "clay.py").write_text("SIZE = (0.2, 0.1, 0.1)\n")
    # a module of this name is never taken from there
    (tmp_path / "scenes" / "token.py").write_text("raise RuntimeError('taken')\n")
    path, here = os.path.join("..", "scenes", "scene.py"), tmp_path / "elsewhere"
    run = lambda *words, **more: runProgram(path, *words, cwd=here, **more)
    run("--no-vtk", "--out", "r")
    curve = (here / "r" / "curve.csv").read_bytes()
    run("--resume", "r")
    assert (here / "r" / "curve.csv").read_bytes() == curve
    other = run("--resume", "r", "--damping", "0.2", check=False)
    assert other.returncode == 2 and "--damping is 0.7" in other.stderr


def test_an_option_that_a_scene_requires():
    parser = options.parser("own", until=30)
    parser.add_argument("--wall", required=True)
    assert parser.parse_args(["--wall", "3"]).wall == "3"
    with raises(SystemExit):
        parser.parse_args([])
