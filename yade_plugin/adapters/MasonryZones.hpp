// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/units/Zones.hpp"

namespace masonry {

class MasonryZones : public EngineAdapter<MasonryZones>, public Zones {
    MASONRY_CLASS(MasonryZones, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Units;
    static constexpr const char* doc =
        "Deformable units: blocks divided into tetrahedral zones of linear elastic material, with their masses at the "
        "nodes (paper §2, eqs. (1)-(7)). Their joints act at points of the faces of cells, between which displacements "
        "are those of the faces' triangles: three along every face where the unit is held across the joint, else the "
        "corners and the centroid of each triangle. A unit whose nodes are held in one direction, and which is a right "
        "prism along it, as a brick in a wall in its plane, is a plane unit: its nodes stand in its middle plane "
        "alone, its zones are triangles in plane stress as thick as the unit, four to a cell, and points of joints "
        "stand in the middle plane. Other units that are held so keep their tetrahedra; both can meet in a joint. A "
        "unit remains one body with the shape of its block; its position and orientation follow the centre of mass and "
        "the mean rotation. Strains are taken as small in axes that turn with the unit. Stands after the loop of the "
        "joints; integrators of rigid bodies do not move these bodies. Give this engine to "
        "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.zones before joints are made.";

    template <class Visit> static void attributes(Visit&& visit) {
        using Z = MasonryZones;
        visit("bodies", &Z::bodies, described("Ids of the deformable units; their material is MasonryMat"), Given);
        visit("divisions", &Z::divisions,
              number("-", "Cells of a hexahedral unit in the directions nearest to x, y and z, each of twelve zones, "
                          "or four in a plane unit; "
                          "default 1, 1, 1")
                  .atLeast(1)
                  .atMost(100),
              Given);
        visit("massScaling", &Z::massScaling,
              number("-",
                     "Selective mass scaling for states of rest: 1 + massScaling is the factor on the masses in all "
                     "motions of a unit but rigid ones, which keep their true inertia, so that deformation is "
                     "slower and the time step longer. The two units of a brick with a monolithic crack surface "
                     "count as one until the surface yields. 0: true masses")
                  .atLeast(0));
        visit("damping", &Z::damping,
              number("-", "Damping constant alpha").atLeast(0).atMost(0.99).source("paper eq. (3): 0.8"));
        visit(
            "dampingKind", &Z::dampingKind,
            described(
                "'combined': alpha abs(F) (sgn(dF/dt) - sgn(v)) / 2, which also calms vibration about a steady motion; "
                "'local': -alpha abs(F) sgn(v), paper eq. (3), which leaves that vibration and resists the motion"));
        visit("blocked", &Z::blocked,
              described("Directions in which the nodes are held: 'y' for a wall loaded in its plane, in plane stress"));
        visit("gravity", &Z::gravity,
              number("m/s²", "Gravity: that of the integrator, which this engine takes over in every step. Another "
                             "value that is set during a run is refused"));
        visit("kinetic", &Z::kinetic, number("J", "Kinetic energy of the nodes"), ReadOnly);
        visit("elastic", &Z::elastic, number("J", "Elastic energy of the zones"), ReadOnly);
        visit("gravityWork", &Z::fallen, number("J", "Work of gravity since the first step"), ReadOnly);
        visit("dampingWork", &Z::damped,
              number("J", "Energy taken by damping so far, and what kinetic energy has fallen by when scaled masses "
                          "changed: when massScaling was set, and when a brick cracked"),
              ReadOnly);
        visit("displacements", computed(&Z::displacements, &Z::setDisplacements),
              number("m", "Displacements of all nodes since the reference state"), ReadOnly);
        visit("velocities", computed(&Z::velocities, &Z::setVelocities), number("m/s", "Velocities of all nodes"),
              ReadOnly);
        visit("lastForces", computed(&Z::lastForces, &Z::setLastForces),
              number("N", "Forces on all nodes in the last step"), Hidden);
        visit("pendingDamping", &Z::pendingDamped, number("J", "Damping of the last step"), Hidden);
        GravityWork::describe<Z>(visit);
        visit("moved", &Z::moved, number("kg m", "Sum of mass times displacement of all nodes"), Hidden);
        visit("scaledBy", &Z::scaledBy, number("-", "massScaling in the last step"), Hidden);
        visit("splitBricks", &Z::splitBricks,
              described("First bodies of bricks whose monolithic crack surface has yielded while masses were scaled"),
              Hidden);
        visit("laidOut", &Z::laidOut, described("Divisions and bodies for which the nodes were numbered"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("nodesOf", &MasonryZones::nodesOf, py::args("body"), "Numbers (first, beyond) of a unit's nodes.")
            .def("referencePoint", &MasonryZones::referencePoint, py::args("body", "node"),
                 "Place of a node of a unit in the reference state [m].")
            .def("setVelocity", &MasonryZones::setVelocityOf, py::args("node", "velocity"),
                 "Set the velocity of a node [m/s] from which the next step starts.")
            .add_property("masses", &MasonryZones::masses, "Masses of all nodes [kg].");
    }

    using Zones::problems;
    void postLoad();
    void step(SceneStore&);

private:
    py::tuple nodesOf(int body);
    Vector3r referencePoint(int body, int node);
    void setVelocityOf(int node, const Vector3r& velocity);
    py::list masses();
};

} // namespace masonry

MASONRY_DECLARE(MasonryZones)
