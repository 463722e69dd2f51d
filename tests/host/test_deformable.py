# SPDX-License-Identifier: GPL-2.0-or-later
"""Deformable units in the engine loop: closed forms and energy."""

from hosted import *
from elastic_cases import deflection, frequency

E, NU = 4.8e9, 0.16


@mark.slow
def test_a_bar_s_wave_speed_converges_to_theory_at_second_order():
    pairs = [frequency(cells) for cells in (8, 16)]
    errors = [abs(measured / theory - 1) for theory, measured in pairs]
    assert errors[1] < 0.01
    assert errors[0] / errors[1] > 3  # order 2: a factor of 4


@mark.slow
def test_a_cantilever_s_deflection_converges_to_theory():
    # Zones of constant strain are too stiff in bending. The relative error falls with the square of
    # their size.
    pairs = [deflection(cells) for cells in (1, 2)]
    coarse, fine = (theory / measured - 1 for theory, measured in pairs)
    assert 0 < fine < 1
    assert coarse / fine > 2.5  # order 2: a factor of 4


def kept(*parts):
    return sum(value for name, value in balance().items() if name.startswith(parts))


def couplet(joint, divisions=(2, 1, 1)):
    """Two bricks between rigid plates, the upper plate driven; returns the load."""
    O.reset()
    mat, plate = unitMaterial(), unitMaterial(young=1e16, jointSet="plate")
    x, y, z = UNIT
    put = lambda low, high, of: addBlock(corners(low, high), of, inPlane=True)
    hold(put((0, 0, -0.05), (x, y, 0), plate))
    units = [put((0, 0, k * z), (x, y, (k + 1) * z), mat) for k in (0, 1)]
    top = put((0, 0, 2 * z), (x, y, 2 * z + 0.05), plate)
    O.bodies[top].state.blockedDOFs = "xyXYZ"
    load = MasonryLoad(body=top, direction=(0, 0, 1), driven=True)
    load.point = (x / 2, y / 2, 2 * z)
    zones = MasonryZones(bodies=units, divisions=divisions, blocked="y")
    zones.gravity = (0, 0, 0)
    around = dict(gravity=(0, 0, 0), inPlane=True, loads=[load], zones=zones)
    rigid = dict(elastic=True, normalStiffness=1e14, shearStiffness=1e14)
    plates = MasonryJoint(name="plate", jointSet="plate", **rigid)
    join([plates, joint], 0.8, **around)
    return load


def joint():
    return next(i for i in O.interactions if i.phys.joint.name == "bed")


def carried():
    return np.average([s[0] for s in joint().phys.stress], weights=joint().geom.areas)


def pull(load, distance, duration):
    """Drive the plate over a distance; the mean normal stress in the joint at every step [Pa]."""
    load.velocity = distance / duration
    return np.array([(O.step(), carried())[1] for _ in range(int(duration / O.dt))])


@mark.slow
def test_two_deformable_bricks_pulled_apart_carry_ft_and_take_the_mode_I_energy():
    load = couplet(MasonryJoint(name="bed"))
    assert pull(load, 8e-6, 0.02).max() == approx(0.1e6, rel=0.005)
    load = couplet(MasonryJoint(name="bed"))
    pull(load, 3e-3, 0.05)
    b = balance()
    assert b["dissipated_tension"] / (UNIT[0] * UNIT[1]) == approx(16, rel=0.01)
    assert abs(b["error"]) < 1e-4


def test_bricks_that_slide_on_each_other_keep_momentum_and_energy():
    units = pile()
    O.bodies[0].state.blockedDOFs = ""
    zones = MasonryZones(bodies=units, divisions=[2, 1, 1], damping=0)
    join(share=0.3, gravity=(0, 0, 0), damping=0, zones=zones)
    place = {}
    for unit, sign in zip(units, (1, -1)):
        for n in range(*zones.nodesOf(unit)):
            place[n] = zones.referencePoint(unit, n)
            zones.setVelocity(n, sign * Vector3(5, 1, 0.02))

    def momenta():
        p, spin = Vector3.Zero, Vector3.Zero
        rows = zip(zones.masses, zones.displacements, zones.velocities)
        for n, (mass, u, v) in enumerate(rows):
            p += mass * v
            spin += mass * (place[n] + u).cross(v)
        return p, spin

    O.step()
    p0, spin0 = momenta()
    start = balance()["kinetic"]
    moved = lambda: next(iter(O.interactions)).geom.jumps[0][1]
    while abs(moved()) < 0.01 and O.time < 0.005:
        O.step()
    assert abs(moved()) >= 0.01
    p1, spin1 = momenta()
    assert (p1 - p0).norm() < 1e-9
    assert (spin1 - spin0).norm() < 2e-3 * spin0.norm()
    assert balance()["dissipated_shear"] > 0.03 * start
    there = kept("kinetic", "elastic", "dissipated")
    assert there == approx(start, rel=1e-4)


@mark.slow
def test_the_stiffness_of_a_pair_is_that_of_bricks_and_joint_in_series():
    elastic = MasonryJoint(name="bed", elastic=True)
    load = couplet(elastic, divisions=(2, 1, 2))
    pull(load, -2e-6, 0.02)
    load.velocity = 0
    run(20000)
    area = UNIT[0] * UNIT[1]
    series = area / (2 * UNIT[2] / E + 1 / elastic.normalStiffness)
    # The plates hold the ends of the bricks sideways. That can only make them stiffer, by a part of
    # nu².
    assert 1 < load.reaction / (series * load.displacement()[2]) < 1 + 2 * NU**2
