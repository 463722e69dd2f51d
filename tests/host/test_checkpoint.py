# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene's state on disk and back: to the last bit, whole or not at all, and never into another
scene."""

import struct
import zlib

from hosted import *
from masonry._masonry import loadScene, saveScene
from test_joint_loop import CASES, panel, state


def bits(interactions):
    """All numbers in which two runs could differ, as bytes."""
    values = [O.iter, O.time, O.dt, *balance().values()]
    for b in O.bodies:
        values += [*O.forces.f(b.id, True), *O.forces.t(b.id, True), *b.state.vel]
        values += [*b.state.angVel, *b.state.angMom]
    parts = [np.array(values)] + list(state(interactions).values())
    return b"".join(p.tobytes() for p in parts)


def damped(case, functors=False):
    """A panel with combined damping, which remembers the forces of the step before."""
    interactions = panel(functors, damping=0.3, **CASES[case])
    if not functors:
        O.engines[4].dampingKind = "combined"
    return interactions


@mark.parametrize(
    "case, functors",
    [(case, False) for case in CASES] + [("rigid", True), ("deformable", True)],
)
def test_a_scene_built_anew_goes_on_bit_for_bit(case, functors, tmp_path):
    path = str(tmp_path / "c")
    interactions = damped(case, functors)
    run(400)
    end = bits(interactions)

    interactions = damped(case, functors)
    run(200)
    saveCheckpoint(path, {"stage": "push", "at": [1 / 3, None]})
    there = bits(interactions)
    run(200)
    assert bits(interactions) == end  # saving changes nothing

    interactions = damped(case, functors)
    assert loadCheckpoint(path) == {"stage": "push", "at": [1 / 3, None]}
    assert bits(interactions) == there
    run(200)
    assert bits(interactions) == end
    assert state(interactions)["damage"].max(axis=0).min() > 0.01

    # Loaded into a scene that has run on, which then continues without being read first.
    loadCheckpoint(path)
    run(200)
    assert bits(interactions) == end


def test_what_a_script_changes_in_engines_is_kept(tmp_path):
    path = str(tmp_path / "c")
    panel(False, "deformable")
    load, zones = O.engines[2], O.engines[5]
    load.velocity, load.driven, load.dead = 0.125, False, True
    zones.damping, zones.dampingKind = 0.4, "local"
    O.forces.setPermF(1, Vector3(1, 2, 3))
    O.forces.setPermT(1, Vector3(0.3, 0.1, 0.2))
    O.bodies[0].state.isDamped = False
    O.dt *= 0.5
    dt = O.dt
    run(3)
    force = Vector3(O.forces.f(1, True))
    saveCheckpoint(path)
    panel(False, "deformable")
    assert loadCheckpoint(path) is None
    load, zones = O.engines[2], O.engines[5]
    assert (load.velocity, load.driven, load.dead) == (0.125, False, True)
    assert (zones.damping, zones.dampingKind) == (0.4, "local")
    assert (O.iter, O.dt) == (3, dt)
    assert O.forces.permF(1) == Vector3(1, 2, 3)
    assert O.forces.permT(1) == Vector3(0.3, 0.1, 0.2)
    assert not O.bodies[0].state.isDamped
    assert (O.forces.f(1, True) - force).norm() < 1e-12 * force.norm()


def test_what_a_stage_changes_in_the_integrator_of_the_host_is_kept():
    panel(True)
    integrator = O.engines[-1]
    assert type(integrator) is NewtonIntegrator
    integrator.damping, integrator.gravity = 0.25, (1, 2, 3)
    state = saveScene("")
    integrator.damping, integrator.gravity = 0, (0, 0, -1)
    loadScene(state)
    assert (integrator.damping, integrator.gravity) == (0.25, Vector3(1, 2, 3))


def test_a_checkpoint_of_another_scene_is_refused_and_changes_nothing(tmp_path):
    path = str(tmp_path / "c")
    panel(False)
    run(50)
    saveCheckpoint(path)

    def refused(message, change=lambda made: None, **other):
        interactions = panel(False, **other)
        run(20)
        change(interactions)
        before = bits(interactions)
        with raises(ValueError, match=f"{path} is of another scene: {message}"):
            loadCheckpoint(path)
        assert bits(interactions) == before

    def other(interactions):
        joint = next(i.phys.joint for i in interactions if i.phys.joint.name == "weak")
        joint.cohesion *= 1.0000001

    def heavier(interactions):
        O.bodies[1].state.mass *= 1.01

    def wider(interactions):
        O.bodies[1].state.inertia *= 1.01

    def stiffer(interactions):
        known = O.bodies[1].mat
        O.bodies[1].mat = MasonryMat(**{**known.dict(), "young": 1.01 * known.young})

    refused("its blocks are others", size=6)
    refused(
        "its engines are MasonryJointLoop, .*, here .*, MasonryZones",
        blocks="deformable",
    )
    refused("its joints are others, or have other properties", other)
    refused("its blocks are others", heavier)
    refused("its blocks are others", wider)
    panel(False, "deformable")
    run(50)
    saveCheckpoint(path)
    # neither masses nor the stiffnesses of joints change with it
    refused("its blocks are others", stiffer, blocks="deformable")


@pytest.fixture
def saved(tmp_path):
    path = str(tmp_path / "c")
    panel(False)
    run(10)
    saveCheckpoint(path, "text")
    with open(path, "rb") as file:  # as files were before they were compressed
        data = zlib.decompress(file.read())
    with open(path, "wb") as file:
        file.write(data)
    return path, data


def test_a_damaged_file_is_refused_in_words(saved):
    path, data = saved
    half = len(data) // 2
    flip = lambda data, at: data[:at] + bytes([data[at] ^ 4]) + data[at + 1 :]
    flipped, small = flip(data, half), zlib.compress(data)
    for wrong, message in (
        (data[:half], "is cut short: "),
        (flipped, "is damaged: its bytes do not give the sum"),
        (small[:-9], "is cut short: "),
        (flip(small, len(small) // 2), "is damaged: "),
        (b"time_s\n", "is no masonry checkpoint"),
        (data.replace(b"format 3", b"format 9"), "is of another version of the plugin"),
    ):
        open(path, "wb").write(wrong)
        for read in (loadCheckpoint, readCheckpoint):
            with raises(ValueError, match=f"{path} {message}"):
                read(path)
    with raises(FileNotFoundError):
        loadCheckpoint(path + "x")


def sealed(data, name, change):
    """A checkpoint with one of its arrays or texts changed, and a checksum that fits."""
    at = data.index(name.encode())
    size = struct.unpack("<Q", data[at - 8 : at])[0]
    at += len(name)
    value = change(data[at : at + size])
    assert len(value) == size
    data = data[:at] + value + data[at + size : -8]
    sum = 0xCBF29CE484222325
    for byte in data:
        sum = (sum ^ byte) * 0x100000001B3 % 2**64
    return data + struct.pack("<Q", sum)


@mark.parametrize(
    "name, message",
    [
        ("scene.step", "does not fit this scene, at 'scene.step'"),
        ("scene.joints", "damaged at the regime of a joint"),
        ("scene.time", "is damaged: no finite number at 'scene.time'"),
        ("engine 4 MasonryIntegrator.damping", "damping 1e\\+300 must be 0 to 0.99"),
    ],
)
def test_hostile_numbers_under_a_right_sum_are_refused(saved, name, message):
    path, data = saved
    value = {"scene.time": float("nan"), "scene.step": -7.0}.get(name, 1e300)
    change = lambda old: old[:-8] + struct.pack("<d", value)
    open(path, "wb").write(sealed(data, name, change))
    interactions = panel(False)
    run(30)
    before = bits(interactions)
    with raises(ValueError, match=message):
        loadCheckpoint(path)
    assert bits(interactions) == before
    run(5)


def test_text_that_is_no_json_is_refused(saved):
    path, data = saved
    open(path, "wb").write(sealed(data, "extra", lambda old: b"{" * len(old)))
    with raises(ValueError, match=f"{path} "):
        readCheckpoint(path)


def test_a_disk_that_is_full_leaves_the_old_checkpoint(saved, monkeypatch):
    path, data = saved
    run(10)
    with monkeypatch.context() as full:
        full.setattr(os, "fsync", noSpace)
        with raises(OSError, match="No space left on device"):
            saveCheckpoint(path)
    assert open(path, "rb").read() == data and not os.path.lexists(path + ".new")
    saveCheckpoint(path)
    assert readCheckpoint(path) is None


@mark.parametrize("end", ["", ".new"])
def test_a_checkpoint_is_written_through_no_link(saved, end):
    path, data = saved
    other = path + ".other"
    with open(other, "wb") as f:
        f.write(b"of the user")
    if end == "":
        os.remove(path)
    os.symlink(other, path + end)
    with raises(OSError, match="symbolic link"):
        saveCheckpoint(path)
    assert os.path.lexists(path + end)
    assert open(other, "rb").read() == b"of the user"


def test_a_state_that_has_left_finite_numbers_is_not_saved(saved):
    path, data = saved
    O.bodies[1].state.vel = Vector3(0, float("nan"), 0)
    with raises(ValueError, match="left finite numbers, at 'scene.bodies'"):
        saveCheckpoint(path)
    with raises(ValueError):
        saveCheckpoint(path, float("nan"))
    with raises(ValueError, match="extra {1, 2} must be what JSON can hold"):
        saveCheckpoint(path, {1, 2})
    assert open(path, "rb").read() == data
    assert os.listdir(os.path.dirname(path)) == ["c"]
    loadCheckpoint(path)  # and the good one takes the scene back
    run(5)


def test_a_recorder_goes_on_with_its_series(tmp_path):
    def recorded():
        panel(False)
        O.engines += [MasonryVtkRecorder(directory=str(tmp_path), stepPeriod=10)]

    path = str(tmp_path / "c")
    recorded()
    run(25)
    saveCheckpoint(path)
    run(20)
    series = (tmp_path / "joints.pvd").read_text()
    last = (tmp_path / "joints_0004.vtp").read_bytes()
    os.remove(tmp_path / "joints_0004.vtp")
    recorded()
    loadCheckpoint(path)
    run(20)
    assert (tmp_path / "joints.pvd").read_text() == series
    assert (tmp_path / "joints_0004.vtp").read_bytes() == last
