# SPDX-License-Identifier: GPL-2.0-or-later
"""Supports that move together along a profile, a soil without tension, and how wide cracks are."""

from hosted import *

DENSITY = 2400.0  # [kg/m³]
STONE = materials.dry(friction=0.7, normalStiffness=1e11, density=DENSITY)


def footed(folder, count):
    """A rigid beam on held footings of 0.5 m, which are returned, in a scene at rest."""
    beam = bricks.block((0, 0, 0), (0.5 * count, 0.2, 0.4), part="beam")
    rest = bricks.block((0, 0, -0.2), (0.5, 0.2, 0))
    blocks = sum((rest.moved(0.5 * n) for n in range(count)), beam)
    scene = lean(folder, blocks, STONE, rate=20)
    footings = [scene.hold(n + 1, name=f"f{n}") for n in range(count)]
    watched = scene.watch(0, name="beam")
    scene.settle()
    return scene, footings, watched


def test_a_rigid_beam_follows_supports_that_move_on_a_slope(tmp_path):
    """Footings that sink by 4 mm at every metre turn it by 4 mrad. They do not turn themselves, so
    it rests on their right corners, of which that of the second, which sinks by 3 mm, is in the
    middle."""
    scene, footings, _ = footed(tmp_path, 4)
    scene.move(footings, z=lambda x, y, z: -4 * x)
    scene.settle()
    curve = scene.curve()
    sunk = [curve[f"f{n}_z_mm"][-1] for n in range(4)]
    assert sunk == approx([-1, -3, -5, -7], rel=1e-6)
    assert curve["beam_z_mm"][-1] == approx(-3, abs=0.02)
    assert curve["beam_rotation_mrad"][-1] == approx(4, abs=0.02)


def test_a_lost_pier_leaves_its_load_to_the_others(tmp_path):
    scene, footings, _ = footed(tmp_path, 3)
    scene.move([footings[1]], z=-5)
    scene.settle()
    half = -0.5e-3 * DENSITY * G * 1.5 * 0.2 * 0.4
    ends = [scene.curve()[f"f{n}_force_z_kN"][-1] for n in range(3)]
    assert ends == approx([half, 0, half], rel=0.01, abs=1e-3)


def test_the_gap_under_a_beam_is_a_crack_of_every_row_and_of_its_groups(tmp_path):
    """A footing that sinks by 7 mm below a stiff beam leaves a gap of 7 mm: damage of class 3."""
    scene, footings, _ = footed(tmp_path, 3)
    scene.move([footings[1]], z=-7)
    scene.finish()
    run, curve = readRun(tmp_path), scene.curve()
    widest = run["largest_crack_mm"]
    assert widest == approx(7, rel=0.01)
    assert run["damage_class"] == 3
    groups = dict.fromkeys(("bed", "part beam", "part block"), widest)
    assert run["largest_cracks_mm"] == groups
    crack = curve["largest_crack_mm"]
    # it is looked for every 300 steps, in which the footing sinks by up to 20 mm/s
    late = 301 * run["time_step_s"] * 20
    gap = crack + curve["f1_z_mm"]
    assert (gap > -late - 0.05).all() and (gap < 0.05).all() and len(set(crack)) > 5


@mark.parametrize(
    "last, z, message",
    [
        (
            4,
            -5,
            "value 3 of the list.*a platen or brick of this scene that is held from its beginning",
        ),
        (3, lambda x, y, z: 0.0, "must not be zero"),
        (3, lambda x, y, z: "far", "'far' must be a number"),
    ],
)
def test_what_cannot_be_moved_is_refused(tmp_path, last, z, message):
    scene, footings, beam = footed(tmp_path, 3)
    with raises(ValueError, match=message):
        scene.move([*footings, beam][:last], z=z)


# -- a soil without tension ------------------------------------------------------------------------

SIDE, HIGH, SOIL = 2.0, 3.0, 1e8  # [m], [m], [N/m]


WEIGHT = DENSITY * G * SIDE * HIGH * 1.0  # [N]


def tower(folder, plane=None):
    scene = lean(folder, bricks.stack(1, (SIDE, 1.0, HIGH)), STONE, plane=plane)
    scene.platen("bottom", springs={"z": SOIL}, uplift=True, height=0.01)
    top = scene.handle((SIDE / 2, 0.5, HIGH), name="top")
    scene.settle()
    return scene, top


@mark.parametrize("plane", [None, False])
def test_a_tower_on_a_soil_without_tension_turns_as_by_hand(tmp_path, plane):
    """With the eccentricity e = H h/W beyond the kern, the soil carries on c = 3 (b/2 - e) with a
    triangle of stresses: W = k/b θ c²/2."""
    scene, top = tower(tmp_path, plane)
    weight, e = WEIGHT * (1 + 0.01 / HIGH), 0.6 * SIDE / 2
    assert scene.load(top, (weight * e / HIGH, 0, 0)) == AT_REST
    turned = abs(scene.curve()["top_rotation_mrad"][-1])
    # of the load above the soil; the weight, in the middle of that, leans with the tower
    above, theta = HIGH + 0.01, 0.0
    for _ in range(20):
        c = 3 * (SIDE / 2 - e * above / HIGH - theta * above / 2)
        theta = 2 * weight * SIDE / (SOIL * c**2)
    assert turned == approx(1e3 * theta, rel=0.01 if plane is None else 0.03)
    assert turned > 1.5 * 1e3 * 12 * weight * e / (SOIL * SIDE**2)  # with tension


def test_a_soil_without_tension_that_shakes_lets_the_tower_rock(tmp_path):
    """A pulse beyond b/h lifts one edge; the soil only ever pushes, and carries the weight at the
    end."""
    scene, top = tower(tmp_path)
    pulse = [0.5 * G * math.sin(math.pi * n / 50) for n in range(51)]
    scene.shake([*pulse, *(-a for a in pulse)], every=0.01, after=0.5)
    scene.settle(longest=5)
    force = scene.curve()["base_force_z_kN"]
    assert np.abs(scene.curve()["top_rotation_mrad"]).max() > 4
    assert force.max() <= 1e-9
    assert force[-1] == approx(-1e-3 * WEIGHT, rel=0.02)
