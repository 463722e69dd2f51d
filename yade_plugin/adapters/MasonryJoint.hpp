// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "engine/joints/PropertySet.hpp"

namespace masonry {

class MasonryJoint : public Adapter<MasonryJoint, yade::Serializable>, public PropertySet, public Assumptions {
    MASONRY_CLASS(MasonryJoint, Serializable)
    static constexpr const char* doc =
        "Properties of one kind of joint (bed, head, crack, support, or any name), shared by all joints of that kind. "
        "Defaults: bed joint of the calcium-silicate walls (paper table 2); the sources of values that the paper does "
        "not give say [decided]. Wrong values raise one ValueError that names all problems.";

    std::string jointSet;
    Vector3r direction = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        JointProperties::describe(visit);
        visit("jointSet", &MasonryJoint::jointSet,
              described("Applies to pairs with a unit of this MasonryMat.jointSet; empty: to any"));
        visit("direction", &MasonryJoint::direction,
              described("Applies to joints whose normal lies within 30° of this direction, either sense; zero: any"));
    }

    MasonryJoint() { postLoad(); }
    void postLoad();

    // Whether a joint with this unit normal, between units of these MasonryMat.jointSet, is of this kind.
    bool appliesTo(const std::string& set1, const std::string& set2, const Vector3r& normal) const;

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("compressionCurve", &MasonryJoint::compressionCurve, py::args("closures"),
                "Compressive strength [Pa] at each largest closure [m] of a list (paper eqs. (18) to (25)).")
            .def("softening", &MasonryJoint::softening,
                 "The rows (displacement ratio, damage) in use: {'tension': [...], 'shear': [...]}.")
            .def("brittleCoulomb", &MasonryJoint::brittle,
                 "The same joint as a brittle Coulomb slip joint: tension to zero and cohesion to its residual at the "
                 "first yield, no cap. Returns a new object.")
            .def("laws", &MasonryJoint::listOfLaws,
                 "The laws that a joint can follow, the default one first: a list of dicts with name (the value of "
                 "`law`), meaning, functor (the name of its class of Law2 functors) and properties (the names of the "
                 "properties that it reads beside the stiffnesses).")
            .staticmethod("laws");
    }

private:
    py::list compressionCurve(const std::vector<double>& closures) const;
    py::dict softening() const;
    static py::list listOfLaws();
    shared_ptr<MasonryJoint> brittle() const;
};

} // namespace masonry

MASONRY_DECLARE(MasonryJoint)
