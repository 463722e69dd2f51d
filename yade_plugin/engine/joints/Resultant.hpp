// SPDX-License-Identifier: GPL-2.0-or-later
// What joints transmit together: the resultant of their forces about a point.
#pragma once
#include "JointView.hpp"

namespace masonry {

struct Resultant {
    Vector3r force = Vector3r::Zero();  // [N]
    Vector3r moment = Vector3r::Zero(); // about the point [N m]
};

// Resultant of a joint's forces on its first body, global axes, about a point in space [m]. The stresses are those of
// the last step, with those of JointDamping; the forces act in the middle of every subcontact's jump, at the present
// places of both bodies.
Resultant resultantOf(const yade::Scene&, const yade::Interaction&, const Vector3r& about);

// The sum over several interactions of the present scene, each times its sign, as a tuple of force and moment. The
// second body of a joint is under the opposite force: -1 stands for that. Throws std::invalid_argument if one of them
// is no joint.
boost::python::tuple resultant(const boost::python::list& interactions, const boost::python::list& signs,
                               const Vector3r& about);

} // namespace masonry
