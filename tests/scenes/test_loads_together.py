# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads of several commands on one structure: each stays when another comes, in any order, and the
supports carry the sum of all."""

import random

from hosted import *

SIDE, HEIGHT, PLATEN = 0.3, 0.6, 0.1  # of the stack and of the platen on it [m]
AREA, STONE = SIDE**2, materials.dry(friction=0.9, normalStiffness=1e11, density=2600)
HEAD = 0.06, HEIGHT + PLATEN  # where the platen is loaded: from the middle, and its height [m]
FACE = SIDE * HEIGHT  # [m²] on which a wind presses
MIDDLE = 0.5 * HEIGHT


def stack(folder, springs=None, **settings):
    """Three stones between platens, the upper of which is loaded beside its middle."""
    scene = lean(folder, bricks.stack(3, (SIDE, SIDE, HEIGHT / 3)), STONE, **settings)
    scene.platen("bottom", springs=springs)
    point = (SIDE / 2 + HEAD[0], SIDE / 2, HEAD[1])
    return scene, scene.platen("top", rotation="free", point=point, height=PLATEN)


def letGoWith(scene, top):
    """A push that ends with a force of 120 N in place of the drive."""
    scene.push(top, 0.002, rate=1)
    scene.release(top, "x", force=(120, 0, 0))
    return scene.settle(longest=4)


def atRest(command):
    """A command that brings the structure to rest."""

    def act(scene, top):
        assert command(scene, top) == AT_REST

    return act


#: Of each command what it does, the load that it sets or adds to, whether it adds, and its force
#: along x and z [N] at a place from the middle of the base [m]. A press has the weight of its
#: platen in it, and accelerations act on all masses.
COMMANDS = {
    "press": (lambda s, t: s.press(t, 3e4), "press", False, (0, -3e4 * AREA), (0, HEAD[1])),
    "press more": (lambda s, t: s.press(t, 4e4), "press", False, (0, -4e4 * AREA), (0, HEAD[1])),
    "grow a press": (lambda s, t: s.grow({t: 1e4}), "grown", True, (0, -1e4 * AREA), (0, HEAD[1])),
    "load": (lambda s, t: s.load(t, (150, 0, -900)), "dead", False, (150, -900), HEAD),
    "load less": (lambda s, t: s.load(t, (-80, 0, -500)), "dead", False, (-80, -500), HEAD),
    "grow a load": (lambda s, t: s.grow({t: (90, 0, -400)}), "grown", True, (90, -400), HEAD),
    "release": (letGoWith, "dead", True, (120, 0), HEAD),
    "wind": (lambda s, t: s.wind(600, (1, 0, 0)), "wind", False, (600 * FACE, 0), (0, MIDDLE)),
    "suction": (lambda s, t: s.wind(-300, (1, 0, 0)), "wind", False, (-300 * FACE, 0), (0, MIDDLE)),
    "pressure": (
        lambda s, t: s.pressure(500, (-1, 0, 0)),
        "pressure",
        False,
        (-500 * FACE, 0),
        (0, MIDDLE),
    ),
    "grow a pressure": (
        lambda s, t: s.grow({}, pressure=400, towards=(-1, 0, 0)),
        "grown",
        True,
        (-400 * FACE, 0),
        (0, MIDDLE),
    ),
    "lean": (lambda s, t: s.lean(0.05), "acceleration", False, 0.05, None),
    "accelerate": (lambda s, t: s.accelerate(0.03, rate=0.1), "acceleration", True, 0.03, None),
    "travel": (
        lambda s, t: AT_REST if s.travel(500, [(0.1, 0.1, 1)]) == DONE else MOVING,
        "travel",
        True,
        (0, 0),
        HEAD,
    ),
}


class Expected:
    """The sum of loads that act, by what sets them."""

    def __init__(self, scene):
        self.stones = [O.bodies[n].state.mass for n in scene.model.ids]
        self.platen = O.bodies[scene.targets["top"].body].state.mass
        self.loads = {}

    def take(self, command):
        _, key, adds, force, place = COMMANDS[command]
        if place is None:  # g on stones and platen, which stand above each other
            stone = sum(self.stones)
            turning = stone * MIDDLE + self.platen * (HEIGHT + PLATEN / 2)
            more = force * G * np.array([stone + self.platen, 0, turning])
        else:
            (x, z), (away, high) = force, place
            more = np.array([x, z + (key == "press") * self.platen * G, high * x - away * z])
        self.loads[key] = more + (self.loads.get(key, 0) if adds else 0)

    def check(self, scene, after):
        weight = G * (sum(self.stones) + self.platen)
        found = [1e3 * scene.curve()[f"base_{n}"][-1] for n in ("V_x_kN", "N_kN", "M_y_kNm")]
        need = sum(self.loads.values(), np.array([0, -weight, 0]))
        assert found == approx(need, abs=0.006 * weight), (after, self.loads)
        held = [1e3 * last(scene, f"base_force_{a}_kN") for a in "xz"]
        assert held == approx(need[:2], abs=0.006 * weight), (after, self.loads)
        assert scene.model.energy.largestError < 1e-3
        # all supports, also springs and ties, carry all loads
        carried = scene.model.supports.carried()
        assert [-carried[0], -carried[2]] == approx(need[:2], abs=0.006 * weight), after


def last(scene, column):
    return scene.results.column(column)[-1]


def carryOut(scene, top, expected, commands):
    for n, command in enumerate(commands):
        assert COMMANDS[command][0](scene, top) == AT_REST, commands[: n + 1]
        expected.take(command)
        expected.check(scene, commands[: n + 1])


@mark.parametrize("first", COMMANDS)
def test_the_base_carries_the_sum_of_all_loads_in_any_order(tmp_path, first):
    others = [name for name in COMMANDS if name != first]
    random.Random(first).shuffle(others)
    scene, top = stack(tmp_path)
    scene.settle()
    carryOut(scene, top, Expected(scene), [first, *others, first])


@mark.parametrize(
    "settings", [dict(plane=False), dict(springs={"x": 1e8, "Y": 1e7})], ids=["space", "springs"]
)
def test_the_base_carries_the_sum_of_all_loads_in_space_and_on_springs(tmp_path, settings):
    scene, top = stack(tmp_path, **settings)
    scene.settle()
    order = "press grow_a_load load wind release load_less travel grow_a_press press_more"
    carryOut(scene, top, Expected(scene), [one.replace("_", " ") for one in order.split()])


def test_what_a_tie_takes_is_missing_at_the_base_alone(tmp_path):
    scene, top = stack(tmp_path)
    scene.tie(2, anchor=(-1, SIDE / 2, 0.5), stiffness=1e7, name="rod")
    scene.settle()
    scene.press(top, 3e4)
    for load, total in (
        (lambda: scene.load(top, (150, 0, 0)), 150),
        (lambda: scene.grow({top: (90, 0, 0)}), 240),
        (lambda: scene.load(top, (50, 0, 0)), 140),
    ):
        assert load() == AT_REST
        assert -scene.model.supports.carried()[0] == approx(total, rel=0.01)
    assert 1e3 * last(scene, "base_force_x_kN") < 0.95 * total


@mark.parametrize("described", [["press"], ["load"], ["load", "press"], ["press", "load"]])
def test_loads_of_stages_replace_their_like_of_the_description_alone(tmp_path, described):
    scene, top = stack(tmp_path)
    for command in described:
        COMMANDS[command][0](scene, top)
    scene.wind(200, (1, 0, 0))  # which stays
    assert scene.settle() == AT_REST
    expected = Expected(scene)
    expected.loads["described"] = 200 * FACE * np.array([1, 0, MIDDLE])
    for command in described:
        expected.take(command)
    expected.check(scene, described)
    carryOut(scene, top, expected, [*described, "wind", "load less", "press more", "release"])


def test_a_record_acts_beside_accelerations_that_stay(tmp_path):
    scene, top = stack(tmp_path)
    scene.settle()
    gravity = lambda: list(scene.model.scheme.now)
    scene.tilt(2, rate=10)
    scene.accelerate(0.02, rate=0.1)
    tilt = math.radians(2)
    before = [G * (math.sin(tilt) + 0.02), 0, -G * math.cos(tilt)]
    assert gravity() == approx(before)
    scene.tilt(1, rate=10)  # turns the acceleration, too
    turned = Quaternion(Vector3.UnitY, -math.radians(1)) * Vector3(*before)
    assert gravity() == approx(list(turned))
    first = len(scene.results.rows)
    scene.shake([0, 1, 0], 0.01, unit="m/s²", after=0.01)
    assert gravity() == approx(list(turned))
    acceleration = G * np.array(scene.results.column("acceleration_x_g")[first:])
    assert acceleration.min() == approx(turned[0] - 1, abs=0.05)
    assert acceleration[-1] == approx(turned[0])
    scene.shake([0, 1], 0.01, unit="m/s²")  # does not end at 0
    assert gravity() == approx(list(turned))
    scene.run(0.01)
    assert gravity() == approx(list(turned))
    assert scene.lean(0) == AT_REST  # in place of all of them
    assert gravity() == approx([0, 0, -G])


@mark.parametrize(
    "supports, loads, message",
    [
        (lambda s, t: s.push(t, 0.002, rate=1), lambda s, t: s.load(t, (1, 0, 0)), "along x"),
        (lambda s, t: s.push(t, 0.002, rate=1), lambda s, t: s.grow({t: (1, 0, 0)}), "along x"),
        (lambda s, t: s.hold(t, "z"), lambda s, t: s.press(t, 1e5), "top is held along z"),
        (lambda s, t: s.hold(t, "z"), lambda s, t: s.grow({t: 1e5}), "top is held along z"),
        (lambda s, t: s.hold(t, "z"), lambda s, t: s.load(t, (1, 0, -1)), "top is held along z"),
        (
            lambda s, t: [s.hold(s.targets[f"brick{n}"]) for n in range(3)],
            lambda s, t: s.wind(100, (1, 0, 0)),
            "all bricks that it loads are held",
        ),
    ],
)
def test_a_load_that_a_support_or_a_drive_takes_is_refused(tmp_path, supports, loads, message):
    scene, top = stack(tmp_path)
    for n in range(3):
        scene.handle(n)
    scene.settle()
    supports(scene, top)
    with raises(ValueError, match=message):
        loads(scene, top)


@mark.parametrize("how", [dict(guided="x"), dict(drive="x")])
def test_a_support_that_takes_a_described_load_is_named(tmp_path, how, capsys):
    scene = standing(tmp_path, bricks.stack(2, (SIDE, SIDE, 0.2)), STONE)
    top = scene.platen("top", **how)
    scene.load(top, (10, 0, -10))
    scene.settle()
    assert "warning: load: top is held along x by a support or a drive" in capsys.readouterr().out
    assert abs(last(scene, "base_V_x_kN")) < 1e-6
    scene.release(top, "x")
    scene.settle()
    assert last(scene, "base_V_x_kN") == approx(0.01, rel=0.01)


def test_a_tilt_without_gravity_is_refused(tmp_path):
    scene, top = stack(tmp_path, gravity=0)
    scene.load(top, (0, 0, -1000))
    scene.settle()
    with raises(ValueError, match="tilt: there is no gravity that turns"):
        scene.tilt(10)


@mark.parametrize(
    "one, other", [("pier 1", "pier-1"), ("a", "all"), ("ä", "a\u0308"), ("p#1", "p 1")]
)
def test_parts_whose_names_are_nearly_the_same_have_winds_of_their_own(tmp_path, one, other):
    pier = bricks.stack(2, (0.2, 0.2, 0.2))
    scene = standing(tmp_path, pier.named(one) + pier.moved(1.0, 0, 0).named(other), STONE)
    scene.settle()
    for wind, part, total in ((300, one, 300), (700, other, 1000), (100, None, 1200)):
        assert scene.wind(wind, (1, 0, 0), part=part) == AT_REST
        assert last(scene, "base_V_x_kN") == approx(1e-3 * total * 0.08, rel=0.01)


@mark.parametrize("seed", [None, 5, 6])
def test_a_load_on_a_joint_is_shared_by_its_bricks_however_they_are_numbered(tmp_path, seed):
    blocks = [*bricks.Wall(0.88, 0.243, halves=False)]
    if seed:
        random.Random(seed).shuffle(blocks)
    soft = materials.dry(0.6, 5e9, density=1800)
    scene = standing(tmp_path, bricks.Bricks(blocks), soft)
    left, right = (
        scene.watch((x, 0.05, 0.22), name=n) for x, n in ((0.33, "left"), (0.55, "right"))
    )
    between = scene.handle((0.44, 0.05, 0.2))  # of two that are as near: that of the lower x
    scene.settle()
    began = [last(scene, f"{n}_z_mm") for n in ("left", "right")]
    assert scene.travel(2e3, [(0.44, 0.051, 1)]) == DONE
    at = scene.results.column("load_factor").index(1.0)
    sunk = [scene.results.column(f"{n}_z_mm")[at] - b for n, b in zip(("left", "right"), began)]
    assert sunk[0] == approx(sunk[1], rel=0.01) and sunk[0] < -1e-3
    assert between.body == left.body
    moved = next(a["value"] for a in scene.answers if a["name"] == "largest_displacement")
    assert moved == approx(-0.0798353, rel=1e-4)
