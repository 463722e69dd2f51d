# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that are shaken: the record and its strength from the command line, and what a run says of
a record."""

from hosted import *
from masonry.run.run import Run
from masonry.stages.shake import displacements

EVERY = 0.005
RECORD = [3 * math.sin(0.6 * n) * math.sin(math.pi * n / 60) for n in range(61)]


def block(folder, *words, **settings):
    """A block on a dry joint, at rest."""
    stones = materials.dry(0.2, normalStiffness=1e10)
    scene = standing(folder, bricks.stack(1, (0.3,) * 3), stones, *words, **settings)
    scene.watch((0, 0, 0.3), name="top")
    scene.settle()
    return scene


def shaken(folder, *words, **settings):
    """What a column of the block that is shaken holds."""
    scene = block(folder, *words)
    scene.shake(**{"accelerations": RECORD, "every": EVERY, **settings})
    scene.finish()
    return scene.results.column("top_x_mm")


@mark.parametrize("functors", [False, True])
def test_steps_have_the_impulse_of_the_record(tmp_path, monkeypatch, functors):
    """Each step has the acceleration of its middle, which is the mean where that changes evenly."""
    accelerations, advance = [], Run.advance

    def one(run, steps):
        for _ in range(steps):
            advance(run, 1)
            accelerations.append(engine("integrator").gravity[0])

    scene = block(tmp_path, functors=functors)
    monkeypatch.setattr(Run, "advance", one)
    scene.shake([3.0, 0.0], every=0.02, after=0.01)
    felt = [a for a in accelerations if a]
    assert felt == accelerations[: len(felt)]
    assert sum(felt) * O.dt == approx(-0.5 * 3.0 * 0.02, rel=1e-4)
    assert len(felt) * O.dt == approx(0.02, abs=O.dt)
    assert engine("integrator").gravity[0] == 0


def test_answers_have_the_sign_of_the_largest_displacement_and_the_first_fall():
    columns = {"top_x_mm": [1.0, -3.0, 2.0], "time_s": [5.0, 6.0, 7.0]}
    model = SimpleNamespace(fallen=lambda: {3: {"fell": 6.5}, 1: {"fell": 6.25}})
    scene = SimpleNamespace(collapsed=True, model=model)
    scene.description = SimpleNamespace(
        targets={1: SimpleNamespace(name="top", fixed=False)}, drifts=[]
    )
    found = displacements(scene, columns.get)
    assert [answer.value for answer in found] == [-3.0, 2.0, 1.25]


@pytest.fixture
def peer(tmp_path):
    """A record of the format of PEER that is twice as strong as RECORD, in g."""
    lines = [
        "PEER",
        "none",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {len(RECORD)}, DT= {EVERY} SEC",
    ]
    path = tmp_path / "strong.AT2"
    path.write_text("\n".join(lines + [repr(2 * a / 9.81) for a in RECORD]))
    return str(path)


def test_the_command_line_replaces_the_record_with_its_factor_and_unit(tmp_path, peer):
    listed = shaken(tmp_path / "a", accelerations=peer, every=None)
    one = shaken(tmp_path / "b", "--record", peer, unit="cm/s²", scale=100)
    assert one == listed
    half = shaken(tmp_path / "c", "--record", peer, "--scale", "0.5", scale=100)
    assert half == shaken(tmp_path / "d", accelerations=peer, every=None, scale=0.5)
    assert half != listed
    # and without another record the scale is that of the scene's own
    weaker = shaken(tmp_path / "e", "--scale", "0.5", scale=2)
    assert weaker == shaken(tmp_path / "f")


def test_three_components_act_at_once(tmp_path):
    """Each by itself is what the one record is along its direction, and the vertical one is felt by
    the base."""
    paths = {name: str(tmp_path / name) for name in ("some", "none", "up")}
    for name, factor in (("some", 1), ("none", 0), ("up", 0.5)):
        (tmp_path / name).write_text(
            "# unit: m/s²\n" + "".join(f"{factor * a!r}\n" for a in RECORD)
        )

    def run(column, *three, **settings):
        scene = block(tmp_path / "".join(three), plane=False)
        scene.shake([paths[n] for n in three] or RECORD, EVERY, **settings)
        scene.finish()
        return scene.results.column(column)

    alone = run("top_y_mm", direction=(0, 1, 0))
    assert max(map(abs, alone)) > 0.03
    assert run("top_y_mm", "none", "some", "none") == alone
    assert run("top_y_mm", "some", "none", "none", direction=(0, 1, 0)) == alone
    forces = run("base_force_z_kN", "none", "none", "up")
    ratios = [force / forces[0] for force in forces]
    for end in (min, max):
        assert end(ratios) == approx(1 + end(RECORD) * 0.5 / 9.81, abs=0.02)
    with raises(ValueError, match="the scene is in the x-z plane"):
        shaken(tmp_path / "e", accelerations=[paths["some"]] * 3)


def test_a_record_of_the_command_line_that_is_wrong_is_refused_at_once(tmp_path):
    path = tmp_path / "short.AT2"
    path.write_text("ACCELERATION IN UNITS OF G\nNPTS= 5, DT= 0.01 SEC\n0.1 0.2\n")
    with raises(SystemExit, match="2"):
        shaken(tmp_path / "a", "--record", str(path))


def test_samples_that_steps_pass_over_are_named(tmp_path, capsys):
    shaken(tmp_path / "a", accelerations=[0.0, 2.0] * 1000, every=1e-6)
    said = capsys.readouterr().out
    assert "longer than the time between samples, 1e-06 s, so that some samples" in said
    shaken(tmp_path / "b")
    assert "between samples" not in capsys.readouterr().out


def test_only_the_first_shake_is_replaced(tmp_path, peer, capsys):
    scene = block(tmp_path / "a", "--scale", "0")
    scene.shake(RECORD, EVERY)
    scene.shake(RECORD, EVERY)
    first, second = (
        a["value"] for a in scene.answers if a["name"] == "largest_displacement_of_top_x"
    )
    assert abs(first) < 1e-6 and abs(second) > 0.01
    scene.finish()
    scene = block(tmp_path / "b", "--record", peer)
    assert "not used" not in capsys.readouterr().out
    scene.finish()
    assert "--record was not used: the scene was not shaken" in capsys.readouterr().out


def test_a_record_that_drifts_is_named_with_its_numbers(tmp_path, capsys):
    shaken(tmp_path / "a", accelerations=[2.0] * 21)
    said = capsys.readouterr().out
    assert (
        "note: shake: the record drifts: its velocity at the end is 0.2 m/s, 100 % of its largest"
        in said
    )
