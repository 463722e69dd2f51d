# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a structure stands, and which way it looks, changes no number of a run but those of
places."""

import functools

from hosted import *
from masonry.numbers import quantities

#: What is done to the bricks, and to a horizontal direction of a load.
PLACES = {
    "far away": (lambda b: b.moved(7.3, -3.1, 2.2), lambda x, y: (x, y, 0)),
    "a unit to the left": (lambda b: b.moved(-0.22), lambda x, y: (x, y, 0)),
    "turned about": (lambda b: b.turned(180), lambda x, y: (-x, -y, 0)),
}
HERE = (lambda b: b, lambda x, y: (x, y, 0))
#: Entries of run.json that no quantity lists.
MORE = ["collapsed", "failure_mode", "recorded_height_m", "drift_height_m", "base_weight"]
#: Numbers with noise: what is left where others cancel, and what belongs to the machine.
NOISE = {"energy_balance_error", "energy_made", "wall corner_m", "wall pushed_towards"} | {
    one.key for one in quantities.QUANTITIES if one.group == "cost"
}


def pushedWall(folder, stand, towards):
    blocks = stand(bricks.Wall(length=0.88, height=0.81))
    scene = lean(folder, blocks, materials.calciumSilicate(), rate=20)
    _, top = scene.platen("bottom"), scene.platen("top", rotation="free")
    scene.press(top, 2e4)
    scene.settle()
    scene.push(top, 0.6, direction=towards(1, 0))
    scene.finish()


def leaningArch(folder, stand, towards):
    blocks = bricks.Arch(
        thickness=0.15, depth=0.3, stones=7, radius=0.925, angle=157.5, skewback=0.2
    )
    stones = materials.dry(friction=0.7, normalStiffness=1e11)
    scene = lean(folder, stand(blocks), stones)
    for brick, name in ((7, "left"), (8, "right")):
        scene.hold(brick, name=name)
    scene.settle()
    scene.accelerate(1.0, towards=towards(1, 0))
    scene.finish()


def fallingStack(folder, stand, towards):
    blocks = stand(bricks.stack(5, (0.2, 0.25, 0.2)))
    scene = standing(folder, blocks, materials.dry(0.7), collapse="follow", plane=False)
    scene.settle()
    scene.lean(0.4, towards=towards(1, 0))
    scene.finish()


SCATTER = {pushedWall: 0.03, leaningArch: 1e-6, fallingStack: 0.02}
#: Where rubble lies, and when it is at rest, hang on round-off in every impact.
OF_RUBBLE = re.compile(r"\d+ (rubble_(length|height|reach).*|time_to_rest)").fullmatch


@functools.cache
def here(build, folder):
    return answers(build, folder, *HERE)


def answers(build, folder, stand, towards):
    """All numbers of a run: the quantities, those of its joints and pattern, and the answers of its
    stages."""
    O.reset()
    build(folder, stand, towards)
    run = readRun(folder)
    measured = {key: run[key] for key in [*quantities.BY_KEY, *MORE] if key in run}
    stages = {f"{n} {one['name']}": one["value"] for n, one in enumerate(run["answers"])}
    wall = {f"wall {key}": value for key, value in run.get("wall", {}).items()}
    found = {**measured, **stages, **wall}
    # a crack in what falls is as wide as it was when the run happened to end
    noise = [*NOISE, *(["largest_crack_mm"] if run["collapsed"] else [])]
    return {k: v for k, v in found.items() if k not in noise and not OF_RUBBLE(k)}


@mark.parametrize("place", PLACES)
@mark.parametrize("build", [pushedWall, leaningArch, fallingStack])
def test_no_number_depends_on_the_place(tmp_path_factory, build, place):
    folder = tmp_path_factory.getbasetemp() / "here" / build.__name__
    folder.parent.mkdir(exist_ok=True)
    expected = here(build, str(folder))
    found = answers(build, str(tmp_path_factory.mktemp("there")), *PLACES[place])
    assert found.keys() == expected.keys() and len(found) >= 4
    for key in found:
        # round-off grows where joints crack, and more where blocks fall
        near = approx(expected[key], rel=SCATTER[build], abs=1e-4, nan_ok=True)
        assert found[key] == near, f"{key}: {found[key]}, here {expected[key]}"
