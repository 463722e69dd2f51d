# SPDX-License-Identifier: GPL-2.0-or-later
"""What a script can do to a scene that runs: it takes effect, or an error says why not. Nothing
ends the process."""

import gc

from hosted import *

SIDE = 0.1  # [m]


def cube(x=0.0, z=0.0):
    return box((x, 0, z), (SIDE, SIDE, SIDE))


def stack(number=3, zones=(), lone=False, functors=False, reset=True):
    """Cubes on each other, the lowest of which is fixed, and a load on the highest. Returns the
    joints."""
    if reset:
        O.reset()
    O.materials.append(MasonryMat(young=5e9, poisson=0.2, density=1800))
    for level in range(number):
        addBlock(cube(z=SIDE * level), O.materials[0])
    if lone:
        addBlock(cube(x=1), O.materials[0])
    hold(0)
    load = MasonryLoad(body=number - 1, point=(0.05, 0.05, SIDE * number), force=(0, 0, -10))
    joint = MasonryJoint(name="j", normalStiffness=1e10, shearStiffness=5e9, elastic=True)
    zones = MasonryZones(bodies=list(zones)) if zones else None
    return join(joint, 0.3, loads=[load], zones=zones, functors=functors)


def steps(count=2):
    run(count)


def refused(message, act=steps):
    with raises((ValueError, RuntimeError), match=message):
        act()


# -- no crash --------------------------------------------------------------------------------------


def test_bodies_that_are_gone_are_reported():
    stack()
    steps()
    O.bodies.clear()
    refused("joint holds body 0 does not exist", criticalTimeStep)
    refused("has lost body 0: erase its interaction, too, or call O.reset")
    stack()
    steps()
    O.bodies[1].state = None
    refused("body 1 has no State", lambda: steps(10))  # looked at in every tenth


def test_a_lone_deformable_block_that_is_erased_is_reported():
    stack(2, zones=[2], lone=True)
    steps()
    O.bodies.erase(2)
    refused("body 2 does not exist")


def test_units_without_their_engine_are_reported():
    stack(zones=[1])
    steps()
    for change in (lambda: setattr(zones, "dead", True), lambda: setattr(O, "engines", others)):
        *others, zones = O.engines
        change()
        for act in (criticalTimeStep, steps):
            refused("needs its MasonryZones in O.engines, and not dead", act)
        zones.dead = False
        O.engines = [*others, zones]
        steps()


def test_a_load_whose_body_is_changed_within_the_step_is_reported():
    stack()
    again = PyRunner(command="O.engines[2].body = 99", iterPeriod=1, initRun=True)
    O.engines = [*O.engines[:3], again, *O.engines[3:]]
    refused("MasonryLoad.body 99 does not exist")


def test_a_joint_of_no_scene_has_no_points():
    assert MasonryJointPhys().yielding == [] and MasonryJointGeom().jumps == []


@mark.parametrize("which", ["loop", "load", "all"])
def test_an_engine_in_a_parallel_engine_is_reported(which, capfd):
    """Threads of the host cannot pass an error on: an engine that follows does, and the error
    stream has it anyway."""
    stack()
    reset, loop, load, *others = O.engines
    inside = {"loop": [loop], "load": [load], "all": [loop, load, *others]}[which]
    outside = [e for e in (loop, load, *others) if e not in inside]
    after = [ParallelEngine(inside), *outside]
    O.engines = [reset, *(after if which != "load" else [loop, *after[:1], *others])]
    if which == "all":
        steps()
        assert O.bodies[2].state.vel == Vector3.Zero
    else:
        refused("stands in a ParallelEngine")
    assert capfd.readouterr().err.count("stands in a ParallelEngine") == 1
    O.engines = [reset, loop, load, *others]
    steps()


# -- no silence ------------------------------------------------------------------------------------


def replaceState(body):
    old = O.bodies[body].state
    new = O.bodies[body].mat.newAssocState()
    for name in ("mass", "inertia", "pos", "ori", "refPos", "refOri"):
        setattr(new, name, getattr(old, name))
    O.bodies[body].state = new
    gc.collect()
    return new


def test_a_state_that_replaces_another_counts_within_ten_steps():
    joints = stack(lone=True)
    steps(3)
    state = replaceState(2)
    state.pos = state.pos + Vector3(0, 0, 1e-6)
    state.vel = Vector3(0, 0, -1e-3)
    steps(8)
    assert max(jump[0] for jump in joints[1].geom.jumps) > 0.9e-6
    lone = replaceState(3)
    lone.vel = Vector3(1e-3, 0, 0)
    before = lone.pos
    steps(10)
    assert (lone.pos - before)[0] == approx(1e-3 * O.dt, rel=1e-6)


@FUNCTORS
def test_what_joints_were_made_with_cannot_be_changed(functors):
    joints = stack(zones=() if functors else (1,), functors=functors)
    joint, mat = joints[0].phys.joint, O.bodies[1].mat
    geometry = O.engines[1].geomDispatcher.functors[0] if functors else O.engines[1].geometry
    before = joints[0].phys.normalStiffness
    changes = [(joint, "normalStiffness", 1e7), (joint, "shearStiffness", 1e7)]
    changes += [(mat, "young", 1e6), (mat, "poisson", 0.3)]
    changes += [(geometry, "subcontacts", 7), (geometry, "rows", 2)]
    for thing, name, value in changes:
        old = getattr(thing, name)
        refused(f"{name} .* would have no effect", lambda: setattr(thing, name, value))
        assert getattr(thing, name) == old
        setattr(thing, name, old)
    joint.cohesion = 1e6  # takes effect
    steps()
    assert joints[0].phys.normalStiffness == before
    O.reset()  # the next scene can have other values
    joint.normalStiffness, mat.young, geometry.subcontacts = 1e7, 1e6, 7


def test_values_can_be_mended_after_a_connect_that_was_refused():
    joint = MasonryJoint(name="k", elastic=True)
    O.materials.append(MasonryMat(young=5e9, poisson=0.2, density=1800))
    for level in range(2):
        addBlock(cube(z=SIDE * level), O.materials[0])
    engines([joint])
    refused("rule must return a MasonryJoint", lambda: connect(lambda *pair: 5))
    joint.normalStiffness, O.materials[0].young = 1e10, 6e9
    assert len(connect()) == 1


def test_what_cannot_be_followed_is_reported():
    stack(4)
    O.bodies.clump([2, 3])
    refused("body 2 belongs to clump 4, which would not move as one")
    stack()
    O.periodic = True
    refused("O.periodic: ")


def test_zones_of_another_scene_leave_the_blocks_of_the_present_one_alone():
    stack(zones=[1])
    zones = O.engines[-1]
    steps()
    nodes = len(zones.displacements)
    O.switchScene()
    try:
        stack(reset=False)
        zones.damping = 0.5  # the units are divided anew
        zones.nodesOf(1)
        assert len(zones.displacements) == nodes
        assert O.bodies[1].state.blockedDOFs == ""
        steps(100)
        assert O.bodies[1].state.pos[2] < 1.5 * SIDE
    finally:
        O.switchScene()


def test_a_python_class_of_joints_is_a_joint():
    class Mortar(MasonryJoint):
        pass

    O.materials.append(MasonryMat(young=5e9))
    for level in range(2):
        addBlock(cube(z=SIDE * level), O.materials[0])
    engines([Mortar(name="mortar", elastic=True)])
    (made,) = connect()
    assert made.phys.joint.name == "mortar"


# -- files -----------------------------------------------------------------------------------------


def test_frames_that_somebody_removed_are_not_listed(tmp_path):
    stack()
    recorder = MasonryVtkRecorder(directory=str(tmp_path))
    for _ in range(3):
        steps()
        recorder()
    os.remove(tmp_path / "blocks_0001.vtu")
    recorder.collect()
    listed = (tmp_path / "blocks.pvd").read_text()
    assert "blocks_0000.vtu" in listed and "blocks_0001.vtu" not in listed
    assert "blocks_0002.vtu" in listed
    assert "joints_0001.vtp" in (tmp_path / "joints.pvd").read_text()
