# SPDX-License-Identifier: GPL-2.0-or-later
"""Selective mass scaling in the engine loop: the time step, energy, bricks that crack, checkpoints
and threads."""

from hosted import *

X, Y, Z = 0.11, 0.102, 0.081  # half a brick [m]


def bricks(scaling, damping=0.3, strength=0.3e6, plane=True, kind="combined", pieces=2):
    """Two bricks of two halves each on a plate, and a plate on top that pulls the right half up and
    breaks a brick."""
    O.reset()
    mat, stiff = unitMaterial(), unitMaterial(young=1e16, jointSet="plate")
    put = lambda low, high, m: addBlock(corners(low, high), m, inPlane=plane)
    hold(put((0, 0, -0.05), (2 * X, Y, 0), stiff))
    places = [(i * X, k * Z) for k in (0, 1) for i in range(pieces)]
    units = [put((x, 0, z), (x + X, Y, z + Z), mat) for x, z in places]
    top = put((0, 0, 2 * Z), (2 * X, Y, 2 * Z + 0.05), stiff)
    O.bodies[top].state.blockedDOFs = "xyXZ" if plane else "xyXYZ"
    load = MasonryLoad(body=top, point=(2 * X, Y / 2, 2 * Z), driven=True)
    load.direction = (0, 0, 1)
    mesh = dict(bodies=units, divisions=[2, 1, 2], blocked="y" if plane else "")
    zones = MasonryZones(damping=damping, dampingKind=kind, massScaling=scaling, **mesh)
    bed = MasonryJoint(name="bed", elastic=True)
    plate = MasonryJoint(name="plate", jointSet="plate", elastic=True)
    stiffness = dict(normalStiffness=3e12, shearStiffness=1.3e12, cap=False)
    bond = dict(tensileStrength=strength, cohesion=5e5)
    crack = MasonryJoint(name="crack", monolithic=True, **stiffness, **bond)
    around = dict(damping=damping, inPlane=plane, loads=[load], zones=zones)
    engines([plate, bed, crack], **around)
    connect(lambda one, two, geom: crack if abs(geom.normal[0]) > 0.9 else None)
    return load, zones


def test_bricks_of_three_units_are_refused():
    with raises(ValueError, match="body 2 has two joints that are monolithic"):
        bricks(20, pieces=3)


def started(*words, velocity=5e-3, **more):
    """The bricks while the plate is pulled up."""
    load, zones = bricks(*words, **more)
    O.dt = 0.8 * criticalTimeStep()[0]
    load.velocity = velocity
    return zones


def cracked():
    """How many bricks have lost energy in their crack surface."""
    cracks = [i.phys for i in O.interactions if i.phys.joint.name == "crack"]
    return sum(any(phys.dissipated) for phys in cracks)


def test_the_time_step_grows_by_the_root_until_rigid_motions_limit_it():
    limits = {}
    for scaling in (0, 1, 3, 1e8):
        bricks(scaling)
        limits[scaling] = criticalTimeStep()[0]
    assert limits[1] / limits[0] == approx(2**0.5, rel=0.1)
    assert limits[0] < limits[1] < limits[3] < limits[1e8]


@PLANES
def test_the_balance_is_an_identity_while_bricks_crack(plane):
    started(20, plane=plane)
    for _ in range(4):
        run(1000)
        assert imbalance() < 1e-6
    if plane:
        assert cracked() > 0


@PLANES
def test_a_change_of_the_scaling_in_motion_is_booked(plane):
    zones = started(0, plane=plane)
    for scaling in (0, 20, 3, 0, 20):
        before = balance()["damping"]
        zones.massScaling = scaling
        run(300)
        assert imbalance() < 1e-6
        assert balance()["damping"] != before


def test_a_state_of_rest_is_the_same_with_any_masses():
    found = []
    for scaling in (0, 20):
        zones = started(scaling, damping=0.8, velocity=0)
        run(int(0.05 / O.dt))
        found.append([u[2] for u in zones.displacements])
    size = max(map(abs, found[0]))
    assert max(abs(a - b) for a, b in zip(*found)) < 0.01 * size


@mark.parametrize("threads", [1, 2])
def test_a_run_resumed_before_or_after_a_crack_is_the_same(tmp_path, threads):
    def state(zones):
        motion = zones.displacements, zones.velocities
        return [[tuple(v) for v in part] for part in motion], balance()

    zones = started(20)
    whole, counts = [], []
    for part in range(8):
        saveCheckpoint(str(tmp_path / f"{part}"), {})
        run(500)
        whole.append(state(zones))
        counts.append(cracked())
    assert counts[0] == 0 < counts[-1]
    first = next(n for n, count in enumerate(counts) if count)
    for part in {0, max(0, first - 1), first, min(7, first + 1)}:
        zones = started(20)
        loadCheckpoint(str(tmp_path / f"{part}"))
        run(500)
        assert state(zones) == whole[part]
