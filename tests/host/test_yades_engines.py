# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's own engines beside ours, and the check in YADE's form."""

import builtins

from hosted import *
from yade import plot, timing, utils


def standing(friction, **settings):
    """A block on a held one, without bond; returns its id and the weight that friction carries
    [N]."""
    _, upper = pile(size=(0.6, 0.3, 0.3), material=MasonryMat(density=2500))
    bond = dict(tensileStrength=0, cohesion=0, cap=False)
    joint = MasonryJoint(friction=friction, residualFriction=friction, **bond)
    engines([joint], damping=0.3, **settings)
    connect()
    return upper, 0.6 * 0.3 * 0.3 * 2500 * G


def test_connect_chooses_the_time_step_that_a_script_has_not():
    """Of the 1e-8 s that YADE begins with, a wall would need days; one that the script has chosen
    stays."""
    standing(0.5)
    assert O.dt == approx(0.5 * criticalTimeStep()[0], rel=0.02)
    O.reset()
    O.dt = 2e-5
    standing(0.5)
    assert O.dt == 2e-5


def test_forces_motions_and_records_of_yades_engines_hold_beside_ours(tmp_path, capfd):
    """A force of YADE's that grows to 0.6 of the weight moves a block where friction is 0.5: it
    slides from there on. Its work, and that of a motion of YADE's, are in the energy balance."""
    block, weight = standing(0.5)
    push = ForceEngine(ids=[block], force=(0, 0, 0))
    rows = []

    def grow():
        push.force = (weight * min(0.6, 3 * O.time), 0, 0)
        rows.append((push.force[0] / weight, O.bodies[block].state.displ()[0]))

    builtins.grow = grow  # where a PyRunner finds it
    moved = TranslationEngine(ids=[0], velocity=1e-3, translationAxis=(0, 1, 0))
    recorder = VTKRecorder(fileName=str(tmp_path / "yade-"), recorders=["boxes"], iterPeriod=500)
    ours = list(O.engines)
    runner = PyRunner(command="grow()", iterPeriod=20)
    O.engines = [ours[0], runner, push, moved, *ours[1:], recorder]
    run(int(0.25 / O.dt))
    del builtins.grow
    slides = next(force for force, displacement in rows if displacement > 1e-5)
    assert 0.5 <= slides < 0.55
    assert rows[-1][1] > 1e-3
    assert O.bodies[0].state.displ()[1] == approx(1e-3 * O.time, rel=0.01)
    assert list(tmp_path.glob("yade-*"))
    assert balance()["dissipated_shear"] > 0.5 * weight * 1e-3
    assert imbalance() < 1e-3
    assert "warning" not in capfd.readouterr().err


#: What YADE loads a body with, as a function that gives an engine, or None.
LOADS = {
    "permanent force": lambda b, f, m: O.forces.setPermF(b, f),
    "permanent torque": lambda b, f, m: O.forces.setPermT(b, m),
    "ForceEngine": lambda b, f, m: ForceEngine(ids=[b], force=f),
    "TorqueEngine": lambda b, f, m: TorqueEngine(ids=[b], moment=m),
    "addF of a PyRunner": lambda b, f, m: runner(lambda: O.forces.addF(b, f)),
    "addT of a PyRunner": lambda b, f, m: runner(lambda: O.forces.addT(b, m)),
}


def runner(act):
    """A PyRunner that calls a function in every step."""
    builtins.act = act
    return PyRunner(command="act()", iterPeriod=1)


@mark.parametrize(
    "load, functors",
    [*((load, False) for load in LOADS), ("permanent force", True), ("permanent torque", True)],
)
def test_the_work_of_what_yade_loads_a_body_with_is_its_force_times_the_way(load, functors, capfd):
    """On a free block, without gravity, so that it is the kinetic energy, too."""
    free = addBlock(box((1, 0, 0)), unitMaterial())
    pile()
    engines([MasonryJoint(elastic=True)], damping=0, gravity=(0, 0, 0), functors=functors)
    connect()
    force, moment = Vector3(20, -10, 30), Vector3(0, 0.3, 0)
    engine_, ours = LOADS[load](free, force, moment), list(O.engines)
    O.engines = ours[:1] + [engine_] * (engine_ is not None) + ours[1:]
    run(2000)
    builtins.act = None
    state = O.bodies[free].state
    moved = force.dot(state.displ()) if "orque" not in load and "addT" not in load else 0
    turned = 0 if moved else moment.dot(state.rot())
    assert balance()["external"] == approx(moved + turned, rel=2e-3) and moved + turned > 1e-6
    assert balance()["kinetic"] == approx(moved + turned, rel=2e-3)
    assert imbalance() < 1e-9 and "warning" not in capfd.readouterr().err


@mark.parametrize("functors, place", [(False, 2), (True, 1), (True, 2)])
@mark.parametrize("by", ["ForceEngine", "PyRunner"])
def test_work_that_is_not_counted_is_said_and_ends_no_run(capfd, functors, place, by):
    """Behind the loop of the joints, and with functors, forces of YADE's engines are not apart from
    those of joints."""
    block, weight = standing(0.5, functors=functors)
    ours, force = list(O.engines), Vector3(0.6 * weight, 0, 0)
    added = LOADS["ForceEngine" if by == "ForceEngine" else "addF of a PyRunner"]
    O.engines = [*ours[:place], added(block, force, None), *ours[place:]]
    run(3000)
    assert O.bodies[block].state.displ()[0] > 1e-3
    assert capfd.readouterr().err.count(f"the work of {by} is not counted") == 1


@mark.slow
def test_tables_tags_plots_and_timing_are_those_of_yade(tmp_path, monkeypatch):
    table = tmp_path / "table"
    table.write_text("friction\n0.3\n0.4\n", encoding="utf-8")
    monkeypatch.setenv("YADE_BATCH", f"{table}:3")
    assert utils.readParamsFromTable(friction=0.5) == 1
    from yade.params.table import friction

    standing(friction)
    plot.reset()
    record = lambda: plot.addData(t=O.time, **balance())  # noqa: E731
    monkeypatch.setattr(builtins, "record", record, raising=False)
    O.engines += [PyRunner(command="record()", iterPeriod=10, initRun=True)]
    monkeypatch.setattr(O, "timingEnabled", True)
    timing.reset()
    run(100)
    assert friction == 0.4 and O.tags["params"] == "friction=0.4"
    assert len(plot.data["t"]) == len(plot.data["kinetic"]) == 10
    ours = [e for e in O.engines if type(e).__name__.startswith("Masonry")]
    assert len(ours) > 2 and all(e.execCount == 100 and e.execTime > 0 for e in ours)


@mark.slow
def test_the_check_in_yades_form_passes_and_names_what_is_wrong(tmp_path):
    path = os.path.join(ROOT, "tests", "host", "checkMasonryJoint.py")
    again = tmp_path / "checkMasonryJoint.py"
    with open(path, encoding="utf-8") as file:
        again.write_text(file.read().replace("4400.0", "4300.0"), encoding="utf-8")
    ends = [runProgram(str(p), check=False) for p in (path, again)]
    assert ends[0].returncode == 0, ends[0].stderr
    assert "YadeCheckError: largest force [N]: 43" in ends[1].stderr
    assert ends[1].returncode == 1
